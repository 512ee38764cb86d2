"""What is measured: a scene or a bare model, in water of one's choice, with what it weighs."""

import dataclasses
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import BuoyancyWarning, ResponseError
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.added_inertia import measure_added_mass
from buoyancy_mj.scenes.overrides import apply_setting
from buoyancy_mj.scenes.scene import Scene, read_scene, scene_from_table
from buoyancy_mj.scenes.scene_vehicle import EQUILIBRIUM, name_from_file
from buoyancy_mj.scenes.simulation import Simulation
from buoyancy_mj.sea.currents import is_still
from buoyancy_mj.sea.waves import Wave
from buoyancy_mj.statics.building import build_vessel_from_hulls
from buoyancy_mj.statics.floating_pose import pose_vessel
from buoyancy_mj.statics.hydrostatics import Hydrostatics, compute_hydrostatics

DEFAULTS: dict[str, Any] = {
    "pressure": "froude-krylov",
    "added_mass": "estimate",
    "start": {"at": EQUILIBRIUM},
}
"""What a model that comes without a scene is measured with: waves that fade with depth, and the
added mass of its meshes where it states none."""


class Subject(NamedTuple):
    """A vehicle in a simulation, ready to be stepped."""

    simulation: Simulation
    """The simulation, at its start."""
    root: int
    """Index of the vehicle's root body."""
    centre: NDArray[np.float64]
    """Its centre of gravity in the frame of the root body (3,) [m]."""
    at_start: Hydrostatics
    """Its hydrostatics at the start."""
    freeboard: float
    """How far its highest point is over the surface at the start [m]; 0 under it."""
    tether: str
    """What keeps it from floating freely; '' if nothing does."""
    added_mass: NDArray[np.float64]
    """Added mass at the start about the centre of gravity (6, 6), in the axes of `at_start`."""

    @property
    def natural_periods(self) -> NDArray[np.float64]:
        """Undamped periods of heave, roll and pitch with the added mass (3,) [s]."""
        return self.at_start.natural_periods(self.added_mass)


def read_subject(name: str | Path, settings: Sequence[str] = ()) -> Scene:
    """Read what is to be measured.

    Args:
        name: a model or a scene: a file, or the name of one that ships. A model is put into still
            water at rest, with `DEFAULTS`.
        settings: texts KEY=VALUE laid over the scene, as for `--set`.

    Raises:
        SceneError, ModelError: there is no such file, or a setting makes no sense.
    """
    text = str(name)
    if text in catalog.scenes() or text.endswith(".toml"):
        return read_scene(catalog.scene_path(text), settings)
    path = catalog.model_path(text).resolve()
    stem = name_from_file(str(path))
    vehicle = text if text in catalog.models() else str(path)
    table = {"title": stem, "vehicle": vehicle, **DEFAULTS, "start": dict(DEFAULTS["start"])}
    for setting in settings:
        apply_setting(table, setting)
    return scene_from_table(table, where=f"model '{stem}'", stem=stem)


def prepare(
    scene: Scene,
    waves: Sequence[Wave] = (),
    *,
    timestep: float | None = None,
    trust: bool = False,
) -> Subject:
    """Put the vehicle of a scene into waves, in the place of those of the scene.

    Args:
        scene: the scene.
        waves: the waves.
        timestep: MuJoCo's timestep [s]; that of the scene if None.
        trust: whether to run the Python files that the scene names as controllers.

    Raises:
        ResponseError: the scene has several vehicles, a current or a referee.
        ModelError, SceneError: what `Simulation` raises.
    """
    check_scene(scene)
    simulation = Simulation(
        dataclasses.replace(
            scene,
            water=dataclasses.replace(scene.water, waves=tuple(waves)),
            timestep=timestep or scene.timestep,
        ),
        trust=trust,
    )
    if len(simulation.vehicles) > 1:
        raise ResponseError(
            f"{len(simulation.vehicles)} vehicles float ({', '.join(simulation.vehicles)}), and "
            "one is measured at a time; put each into a file or a scene of its own"
        )

    # what floats, as statics see it
    model, data = simulation.model, simulation.data
    vehicle = simulation.vehicle
    with warnings.catch_warnings():
        # the simulation has told of it
        warnings.simplefilter("ignore", BuoyancyWarning)
        vessel = build_vessel_from_hulls(
            model,
            simulation.buoyancy.hulls,
            simulation.buoyancy.water,
            data.qpos,
            body=str(model.body(vehicle.root).name) or None,
            ballast=data.act,
        )
    at_start = compute_hydrostatics(pose_vessel(vessel, vessel.position, vessel.rotation))
    low, high = vessel.heights(vessel.rotation)
    tether = "" if vessel.tether is None else f"'{vessel.tether.body}' {vessel.tether.how}"
    return Subject(
        simulation=simulation,
        root=vessel.root,
        centre=vessel.centre_of_gravity,
        at_start=at_start,
        freeboard=max(high - low - at_start.draft, 0.0),
        tether=tether,
        added_mass=measure_added_mass(model, vessel, at_start, data.qpos, data.act),
    )


def check_scene(scene: Scene) -> None:
    """Refuse a scene whose vehicle cannot be measured.

    Raises:
        ResponseError: it has several vehicles, a current or a referee.
    """
    if len(scene.entries) > 1:
        names = ", ".join(str(entry.name) for entry in scene.entries)
        raise ResponseError(
            f"the scene has {len(scene.entries)} vehicles ({names}), and one is measured at a "
            "time; take a scene of one, or its model alone"
        )
    if not is_still(scene.water.current):
        raise ResponseError(
            "the scene has a current, which would carry the vehicle away from the waves that it "
            "is measured in; leave it out (--set 'water.current=[0,0,0]')"
        )
    if scene.mission is not None:
        raise ResponseError(
            f"the scene has the mission '{scene.mission}', which a referee watches step by step; "
            "take the model alone"
        )
