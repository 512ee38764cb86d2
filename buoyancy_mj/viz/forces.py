"""`ForceDrawing`: the centres of a vehicle and the forces on it, in a recording."""

from collections.abc import Sequence

import numpy as np
import rerun as rr

from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.viz.framing import arrow_scale
from buoyancy_mj.viz.log import Log
from buoyancy_mj.viz.palette import COLOURS, NEUTRAL

_CENTRES = {
    "gravity": ("weight", 0.02),
    "buoyancy_of_hulls": ("buoyancy", 0.01),
    "buoyancy": ("buoyancy", 0.02),
}
"""The force whose colour each centre has, and its radius over the length of the vehicle."""


class ForceDrawing:
    """The centres of gravity and of buoyancy of a vehicle, and an arrow for each force.

    Args:
        vehicle: the vehicle.
        name: what tells it from others; '' for the only one.
        causes: names of the loads that act.
    """

    def __init__(self, vehicle: Vehicle, name: str, causes: Sequence[str]) -> None:
        self._vehicle, self._causes = vehicle, tuple(causes)
        self._centres = {part: _entity("centres", name, part) for part in _CENTRES}
        self._forces = {
            cause: _entity("forces", name, cause) for cause in ("weight", *self._causes)
        }
        # the weight of a vehicle is half as long as the vehicle
        self._scale = arrow_scale([vehicle], vehicle.root)
        self._weight = np.array([[0.0, 0.0, -self._scale * vehicle.weight]])

    def draw_static(self, log: Log) -> None:
        """Draw what stays the same: colours and radii."""
        length = self._vehicle.length
        for part, (cause, radius) in _CENTRES.items():
            style = rr.Points3D.from_fields(colors=[COLOURS[cause]], radii=[radius * length])
            log.keep(self._centres[part], style)
        for cause, entity in self._forces.items():
            colour = COLOURS.get(cause, NEUTRAL)
            log.keep(entity, rr.Arrows3D.from_fields(colors=[colour], radii=[0.012 * length]))

    def draw(self, log: Log, frame: Frame) -> None:
        """Draw one frame: the centres, those of wet hulls too, and the forces."""
        seen, hull = frame.vehicles[self._vehicle.name], frame.loads.hull
        wet = self._vehicle.rows[hull.volume[self._vehicle.rows] > 0.0]
        gravity = seen.centre_of_mass[None]
        buoyancy = seen.centre_of_buoyancy[None] if len(wet) else np.zeros((0, 3))
        log.draw(self._centres["gravity"], rr.Points3D, positions=gravity)
        log.draw(self._centres["buoyancy_of_hulls"], rr.Points3D, positions=hull.centroid[wet])
        log.draw(self._centres["buoyancy"], rr.Points3D, positions=buoyancy)

        # forces
        origin = seen.centre_of_buoyancy[None] if seen.volume > 0.0 else gravity
        log.draw(self._forces["weight"], rr.Arrows3D, origins=gravity, vectors=self._weight)
        for cause in self._causes:
            vector = self._scale * seen.forces[cause][None]
            log.draw(self._forces[cause], rr.Arrows3D, origins=origin, vectors=vector)


def _entity(kind: str, vehicle: str, part: str) -> str:
    """The entity of something that belongs to a vehicle; it ends with what it shows."""
    owner = [rr.escape_entity_path_part(vehicle)] if vehicle else []
    return "/".join(["world", kind, *owner, part])
