"""Centres of gravity and buoyancy, and the forces on the vehicle, in a recording."""

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.viz.log import Log
from buoyancy_mj.viz.plots import COLOURS, NEUTRAL


def draw_centres(log: Log, frame: Frame, size: float) -> None:
    """Draw the centre of gravity, and the centres of buoyancy of all hulls and of each.

    Args:
        log: draws.
        frame: the instant.
        size: length of the vehicle [m].
    """
    loads = frame.loads
    wet = loads.hull.volume > 0.0
    total = loads.total.centroid[None] if wet.any() else np.zeros((0, 3))
    for name, points, cause, radius in (
        ("gravity", [frame.centre_of_mass], "weight", 0.02),
        ("buoyancy_of_hulls", loads.hull.centroid[wet], "buoyancy", 0.01),
        ("buoyancy", total, "buoyancy", 0.02),
    ):
        spheres = rr.Points3D(points, colors=[COLOURS[cause]], radii=[radius * size])
        log(f"world/centres/{name}", spheres)


def draw_forces(log: Log, frame: Frame, size: float, weight: float) -> None:
    """Draw an arrow for each force, half as long as the vehicle for its weight.

    Args:
        log: draws.
        frame: the instant.
        size: length of the vehicle [m].
        weight: weight of the vehicle [N].
    """
    loads = frame.loads
    centre = frame.centre_of_mass
    is_wet = bool((loads.hull.volume > 0.0).any())
    origin = loads.total.centroid if is_wet else centre
    scale = 0.5 * size / weight if weight > 0.0 else 0.0
    _draw_arrow(log, "weight", centre, scale * np.array([0.0, 0.0, -weight]), size)
    for cause, rows in loads.by_cause.items():
        _draw_arrow(log, cause, origin, scale * rows[:, :3].sum(axis=0), size)


def _draw_arrow(
    log: Log, cause: str, origin: NDArray[np.float64], vector: NDArray[np.float64], size: float
) -> None:
    """Draw an arrow from a point (3,) [m] along a vector (3,) [m]."""
    arrow = rr.Arrows3D(
        origins=[origin],
        vectors=[vector],
        colors=[COLOURS.get(cause, NEUTRAL)],
        radii=[0.012 * size],
    )
    log(f"world/forces/{cause}", arrow)
