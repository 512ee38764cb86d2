"""Centres of gravity and buoyancy, and the forces on a vehicle, in a recording."""

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.viz.framing import arrow_scale
from buoyancy_mj.viz.log import Log
from buoyancy_mj.viz.plots import COLOURS, NEUTRAL


def draw_centres(log: Log, vehicle: Vehicle, frame: Frame, name: str = "") -> None:
    """Draw a centre of gravity, and the centres of buoyancy of all hulls and of each.

    Args:
        log: draws.
        vehicle: the vehicle.
        frame: the instant.
        name: what tells the vehicle from others; '' for the only one.
    """
    seen = frame.vehicles[vehicle.name]
    wet = vehicle.rows[frame.loads.hull.volume[vehicle.rows] > 0.0]
    total = seen.centre_of_buoyancy[None] if len(wet) else np.zeros((0, 3))
    for part, points, cause, radius in (
        ("gravity", [seen.centre_of_mass], "weight", 0.02),
        ("buoyancy_of_hulls", frame.loads.hull.centroid[wet], "buoyancy", 0.01),
        ("buoyancy", total, "buoyancy", 0.02),
    ):
        spheres = rr.Points3D(points, colors=[COLOURS[cause]], radii=[radius * vehicle.length])
        log(_entity("centres", name, part), spheres)


def draw_forces(log: Log, vehicle: Vehicle, frame: Frame, name: str = "") -> None:
    """Draw an arrow for each force, half as long as the vehicle for its weight.

    Args:
        log: draws.
        vehicle: the vehicle.
        frame: the instant.
        name: what tells the vehicle from others; '' for the only one.
    """
    size = vehicle.length
    seen = frame.vehicles[vehicle.name]
    centre = seen.centre_of_mass
    origin = seen.centre_of_buoyancy if seen.volume > 0.0 else centre
    scale = arrow_scale([vehicle], vehicle.root)
    down = np.array([0.0, 0.0, -vehicle.weight])
    _draw_arrow(log, _entity("forces", name, "weight"), centre, scale * down, size)
    for cause, force in seen.forces.items():
        _draw_arrow(log, _entity("forces", name, cause), origin, scale * force, size)


def _entity(kind: str, vehicle: str, part: str) -> str:
    """The entity of something that belongs to a vehicle; it ends with what it shows."""
    owner = [rr.escape_entity_path_part(vehicle)] if vehicle else []
    return "/".join(["world", kind, *owner, part])


def _draw_arrow(
    log: Log, entity: str, origin: NDArray[np.float64], vector: NDArray[np.float64], size: float
) -> None:
    """Draw an arrow from a point (3,) [m] along a vector (3,) [m]."""
    arrow = rr.Arrows3D(
        origins=[origin],
        vectors=[vector],
        colors=[COLOURS.get(entity.rsplit("/", 1)[-1], NEUTRAL)],
        radii=[0.012 * size],
    )
    log(entity, arrow)
