"""A vehicle and an environment, joined into one MuJoCo model that stands at its start."""

import contextlib
from typing import NamedTuple

import mujoco

from buoyancy_mj.engine.c_functions import pop_error
from buoyancy_mj.engine.checks import skips_passive
from buoyancy_mj.engine.plugin import add_water
from buoyancy_mj.errors import EngineError
from buoyancy_mj.loads.coefficients import add_coefficients
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.scene import EQUILIBRIUM, INTEGRATORS, Scene
from buoyancy_mj.scenes.specs import attach_spec, compile_spec
from buoyancy_mj.scenes.start import place_vehicle, settle_vehicle
from buoyancy_mj.scenes.vehicles import read_vehicle, remove_dry_land
from buoyancy_mj.settings.config import has_texts

ENVIRONMENT = "environment/"
"""Prefix of the environment's names in a joined model; the vehicle's names stay as they are."""


class Assembly(NamedTuple):
    """A scene as MuJoCo runs it."""

    model: mujoco.MjModel
    """The vehicle and its environment."""
    data: mujoco.MjData
    """Their state at the start."""
    bodies: int
    """Number of bodies that are the world or the vehicle's; the first of the model are these."""


def assemble(scene: Scene, *, with_water: bool = False) -> Assembly:
    """Make the model of a scene, and its data at the start.

    The vehicle's file is the base: its options, names, keyframes and custom elements stay. Its body
    gets a free joint if it has none, and the environment is attached to the world under the prefix
    'environment/'. The scene's water replaces the water that the vehicle's file brings.

    Args:
        scene: what to assemble.
        with_water: whether the scene's water becomes a part of the model. It does not where MuJoCo
            would skip it there, see `skips_passive`, nor where it has no texts, see `has_texts`.

    Raises:
        ModelError: a file is missing, MuJoCo refuses it, or it has no body that could float; with
            water, also what `Buoyancy` raises.
        SceneError: the start names a keyframe that does not exist.
    """
    spec, bodies = _join_files(scene)

    # what the scene decides
    spec.option.timestep = scene.timestep
    spec.option.integrator = INTEGRATORS[scene.integrator.lower()]
    if with_water and has_texts(scene) and not skips_passive(spec.option.disableflags):
        # where the plugin cannot be, a warning on import has said so
        with contextlib.suppress(EngineError):
            add_water(spec, scene)

    # the model and its mass
    model = compile_spec(spec, catalog.model_path(scene.vehicle, scene.folder))
    _set_mass(model, scene, bodies)
    try:
        data = mujoco.MjData(model)
    except mujoco.FatalError as error:
        raise pop_error() or error from None

    # the start
    place_vehicle(model, data, scene.start, bodies)
    if scene.start.at == EQUILIBRIUM:
        settle_vehicle(model, data, scene, bodies)
    return Assembly(model, data, bodies)


def _join_files(scene: Scene) -> tuple[mujoco.MjSpec, int]:
    """The vehicle in its environment, not yet compiled, and the number of bodies without it."""
    path = catalog.model_path(scene.vehicle, scene.folder)
    spec = read_vehicle(path)
    remove_dry_land(spec, path, scene.water.level)
    if scene.coefficients is not None:
        add_coefficients(spec, scene.coefficients.read(scene.folder))
    bodies = len(spec.bodies)
    if scene.environment is not None:
        environment = catalog.environment_path(scene.environment, scene.folder)
        attach_spec(spec, path, environment, ENVIRONMENT)
    return spec, bodies


def _set_mass(model: mujoco.MjModel, scene: Scene, bodies: int) -> None:
    """Give the vehicle, the first `bodies` of the model, the scene's mass and centre of gravity."""
    if scene.mass is not None:
        factor = scene.mass / model.body_mass[1:bodies].sum()
        model.body_mass[1:bodies] *= factor
        model.body_inertia[1:bodies] *= factor
    if any(scene.cog_shift):
        model.body_ipos[1] += scene.cog_shift
        # the sameframe shortcuts hold no longer
        model.body_sameframe[1] = int(mujoco.mjtSameFrame.mjSAMEFRAME_NONE)
        model.body_simple[1] = 0
    if scene.mass is not None or any(scene.cog_shift):
        mujoco.mj_setConst(model, mujoco.MjData(model))
