"""Vehicles and an environment, joined into one MuJoCo model that stands at its start."""

import contextlib
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import mujoco
import numpy as np

from buoyancy_mj.engine.c_functions import raise_causes
from buoyancy_mj.engine.checks import skips_passive
from buoyancy_mj.engine.plugin import add_water
from buoyancy_mj.environments.missions import MISSIONS
from buoyancy_mj.environments.sauvc.arena import sauvc_arena
from buoyancy_mj.errors import BuoyancyWarning, EngineError, ModelError, SceneError
from buoyancy_mj.loads.coefficients import add_coefficients
from buoyancy_mj.loads.full_inertia import keep_full_inertia, make_room
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.dry_land import remove_dry_land
from buoyancy_mj.scenes.parts import Afloat, Part, choose_free, find_afloat
from buoyancy_mj.scenes.scene import INTEGRATORS, Scene
from buoyancy_mj.scenes.scene_vehicle import ENVIRONMENT, EQUILIBRIUM, SceneVehicle
from buoyancy_mj.scenes.specs import attach_spec, compile_spec, read_spec
from buoyancy_mj.scenes.start import place_vehicle, settle_vehicle
from buoyancy_mj.scenes.vehicles import read_vehicle, remove_water
from buoyancy_mj.settings.config import has_texts


class Assembly(NamedTuple):
    """A scene as MuJoCo runs it."""

    model: mujoco.MjModel
    """The vehicles and their environment."""
    data: mujoco.MjData
    """Their state at the start."""
    afloat: tuple[Afloat, ...]
    """What of the vehicles floats, and what floats together."""


def assemble(scene: Scene, *, with_water: bool = False) -> Assembly:
    """Make the model of a scene, and its data at the start.

    The only vehicle's file is the base: its options, names, keyframes and custom elements stay. Of
    several vehicles each is attached to the world under the prefix 'NAME/', and the options of the
    first hold. The body of a vehicle gets a free joint if it has none, and the environment is
    attached under the prefix 'environment/'. The scene's water replaces the water that a file
    brings.

    Args:
        scene: what to assemble.
        with_water: whether the scene's water becomes a part of the model. It does not where MuJoCo
            would skip it there, see `skips_passive`, nor where it has no texts, see `has_texts`.

    Raises:
        ModelError: a file is missing, MuJoCo refuses it, or it has no body that could float; with
            water, also what `Buoyancy` raises.
        SceneError: the start names a keyframe that does not exist, or a shift of the centre of
            gravity does not say of which body.
    """
    spec, parts = join_files(scene)

    # what the scene decides
    spec.option.timestep = scene.timestep
    spec.option.integrator = INTEGRATORS[scene.integrator.lower()]
    make_room(spec, scene.added_mass)
    for part in parts:
        if any(part.entry.cog_shift):
            keep_full_inertia(spec.bodies[body] for body in part.bodies)
    if with_water and has_texts(scene) and not skips_passive(spec.option.disableflags):
        # where the plugin cannot be, a warning on import has said so
        with contextlib.suppress(EngineError):
            add_water(spec, scene)

    # the model, and the masses of its vehicles
    model = compile_spec(spec, _path_of(scene))
    afloat = find_afloat(model, parts, scene.selection)
    set_afloat = [
        choose_free(model, [group for group in afloat if group.part is part]) for part in parts
    ]
    with raise_causes():
        for part, groups in zip(parts, set_afloat, strict=True):
            _set_mass(model, part, groups)
        data = mujoco.MjData(model)

    # the start
    for part, groups in zip(parts, set_afloat, strict=True):
        place_vehicle(model, data, part)
        if part.entry.start.at == EQUILIBRIUM:
            bodies = np.concatenate([group.bodies for group in groups])
            settle_vehicle(model, data, scene, bodies.tolist())
    return Assembly(model, data, afloat)


def join_files(scene: Scene) -> tuple[mujoco.MjSpec, tuple[Part, ...]]:
    """The vehicles in their environment, not yet compiled, and what came from which file.

    Raises:
        ModelError: a file is missing, MuJoCo refuses it, or it has no body that could float.
    """
    if scene.vehicle is not None:
        (entry,) = scene.entries
        spec = _read_entry(scene, entry)
        actuators = range(len(spec.actuators))
        parts = [Part(entry, "", range(1, len(spec.bodies)), actuators)]
    else:
        spec = mujoco.MjSpec()
        parts = [_attach_entry(spec, scene, entry) for entry in scene.entries]
    if scene.environment is not None:
        path = catalog.environment_path(scene.environment, scene.folder)
        environment = _read_environment(scene, path)
        attach_spec(spec, _path_of(scene), environment, path, f"{ENVIRONMENT}/")
    return spec, tuple(parts)


def _read_environment(scene: Scene, path: Path) -> mujoco.MjSpec:
    """The surroundings, from their file or laid out anew, without water."""
    if scene.layout is not None and scene.environment is not None:
        return sauvc_arena(MISSIONS[scene.environment], scene.layout)
    environment = read_spec(path)
    remove_water(environment)
    return environment


def _attach_entry(spec: mujoco.MjSpec, scene: Scene, entry: SceneVehicle) -> Part:
    """Attach one of several vehicles to the world of a spec, under the prefix 'NAME/'."""
    own = _read_entry(scene, entry)
    is_first = len(spec.bodies) == 1
    _share_options(spec, own, entry, is_first=is_first)
    bodies, actuators = len(spec.bodies), len(spec.actuators)
    path = catalog.model_path(entry.model, scene.folder)
    if own.compiler.settotalmass > 0.0 and entry.mass is None:
        raise ModelError(
            f"'{path}' sets <compiler settotalmass>, which MuJoCo drops where it joins models; "
            f"give vehicle '{entry.name}' its mass in the scene instead"
        )
    attach_spec(spec, _path_of(scene), own, path, f"{entry.name}/")
    return Part(
        entry,
        f"{entry.name}/",
        range(bodies, len(spec.bodies)),
        range(actuators, len(spec.actuators)),
    )


def _read_entry(scene: Scene, entry: SceneVehicle) -> mujoco.MjSpec:
    """The file of a vehicle, ready for the scene's water."""
    path = catalog.model_path(entry.model, scene.folder)
    spec = read_vehicle(path)
    remove_dry_land(spec, path, scene.water.level, entry.start.position)
    if entry.coefficients is not None:
        add_coefficients(spec, entry.coefficients.read(scene.folder))
    return spec


def _share_options(
    spec: mujoco.MjSpec, own: mujoco.MjSpec, entry: SceneVehicle, *, is_first: bool
) -> None:
    """Let one set of MuJoCo's options hold for all vehicles, those of the first."""
    names = [name for name in dir(own.option) if not name.startswith("_")]
    lost = []
    for name in names:
        common = np.array(getattr(spec.option, name))
        if is_first:
            setattr(spec.option, name, getattr(own.option, name))
        elif not np.array_equal(common, getattr(own.option, name)):
            # the scene decides these two
            lost += [name] if name not in ("timestep", "integrator") else []
            setattr(own.option, name, common if common.ndim else common.item())
    if lost:
        warnings.warn(
            f"vehicle '{entry.name}' sets other options than the first vehicle "
            f"({', '.join(lost)}); those of the first hold for all",
            BuoyancyWarning,
            stacklevel=5,
        )


def _path_of(scene: Scene) -> Path:
    """The file that messages about the joined model name."""
    if scene.vehicle is not None:
        return catalog.model_path(scene.vehicle, scene.folder)
    return scene.folder / (f"{scene.stem}.toml" if scene.stem else scene.title)


def _set_mass(model: mujoco.MjModel, part: Part, afloat: Sequence[Afloat]) -> None:
    """Give what is set afloat of a part the mass and centre of gravity that the scene asks for."""
    mass, shift = part.entry.mass, part.entry.cog_shift
    if mass is not None:
        bodies = np.concatenate([group.bodies for group in afloat])
        factor = mass / model.body_mass[bodies].sum()
        model.body_mass[bodies] *= factor
        model.body_inertia[bodies] *= factor
    if any(shift):
        if len(afloat) > 1:
            names = ", ".join(f"'{group.name}'" for group in afloat)
            raise SceneError(
                f"cog_shift does not say which of {len(afloat)} floating bodies of "
                f"'{part.entry.model}' it shifts ({names}); put each into a file of its own, and "
                "these under [[vehicles]]"
            )
        root = afloat[0].root
        model.body_ipos[root] += shift
        # the sameframe shortcuts hold no longer
        model.body_sameframe[root] = int(mujoco.mjtSameFrame.mjSAMEFRAME_NONE)
        model.body_simple[root] = 0
    if mass is not None or any(shift):
        mujoco.mj_setConst(model, mujoco.MjData(model))
