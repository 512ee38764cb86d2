"""`Course`: way-points, and a reference that moves from one to the next."""

import dataclasses
import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import ControlError
from buoyancy_mj.values import read_array, set_number
from buoyancy_mj.vehicle.control.motion import Motion

LEAD = 1.0
"""Distance [m] by which the reference may be ahead of the vehicle; then it waits."""
LEAD_ANGLE = 0.7
"""The same for the heading [rad]."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Waypoint:
    """A place to pass, and how long to stay there.

    Raises:
        ControlError: a value that is no finite number, or a radius that is not positive.
    """

    position: tuple[float, float]
    """Where (2,) [m], world frame."""
    depth: float | None = None
    """Depth below the still surface [m]; None keeps that of before."""
    heading: float | None = None
    """Angle of the bow about the vertical from x [rad], to which it turns on the way; None keeps
    that of before."""
    radius: float = 0.3
    """Distance [m] within which the place is reached."""
    stay: float = 0.0
    """Time [s] that the vehicle stays within the radius before it goes on."""

    def __post_init__(self) -> None:
        position = read_array(ControlError, "position", self.position, (2,))
        object.__setattr__(self, "position", tuple(position.tolist()))
        for name in ("depth", "heading"):
            if getattr(self, name) is not None:
                set_number(self, ControlError, name)
        set_number(self, ControlError, "radius", above=0.0)
        set_number(self, ControlError, "stay", least=0.0)


class Reference(NamedTuple):
    """Where a vehicle should be now."""

    position: NDArray[np.float64]
    """Place of the root body's origin (3,) [m], world frame."""
    velocity: NDArray[np.float64]
    """How the place moves (3,) [m/s], world frame."""
    heading: float
    """Angle about the vertical [rad]."""
    turning: float
    """How it turns [rad/s]."""


class Course:
    """Way-points, followed one after the other along straight lines; the last one is held.

    Args:
        waypoints: where to go; None in a depth or heading keeps that of before.
        position: where the course begins (3,) [m], world frame.
        heading: heading there [rad].
        level: height of the still surface [m].
        speed: along the lines [m/s].
        turn_rate: how fast the heading changes [rad/s].
        adrift: along which axes of the world (3,) the place is that of the vehicle, wherever it is.
    """

    def __init__(
        self,
        waypoints: Sequence[Waypoint],
        position: NDArray[np.float64],
        heading: float,
        *,
        level: float,
        speed: float,
        turn_rate: float,
        adrift: Sequence[bool] = (False, False, False),
    ) -> None:
        self.passed = 0
        """Number of way-points that were passed."""
        self._waypoints = tuple(waypoints)
        self._speed, self._turn_rate = speed, turn_rate
        self._adrift = np.array(adrift)
        self._inside: float | None = None
        self._position, self._heading = position.copy(), heading

        # depths and headings are carried on
        self._targets: list[tuple[NDArray[np.float64], float]] = []
        height = float(position[2])
        for waypoint in waypoints:
            height = height if waypoint.depth is None else level - waypoint.depth
            heading = heading if waypoint.heading is None else waypoint.heading
            self._targets.append((np.array([*waypoint.position, height]), heading))
        if not self._targets:
            self._targets.append((position.copy(), heading))

    def advance(self, motion: Motion, time: float, timestep: float) -> Reference:
        """Move on by a timestep [s], to a time [s], as far as the vehicle follows."""
        self._pass_waypoint(motion, time)
        target, heading = self._targets[min(self.passed, len(self._targets) - 1)]
        target = np.where(self._adrift, motion.position, target)
        self._position = np.where(self._adrift, motion.position, self._position)

        # along the line, unless the vehicle is far behind
        way = target - self._position
        stride = min(float(np.linalg.norm(way)), self._speed * timestep)
        if np.linalg.norm(self._position - motion.position) > LEAD or stride == 0.0:
            step = np.zeros(3)
        else:
            step = stride * way / np.linalg.norm(way)
        self._position = self._position + step

        # the short way round
        turn = wrap(heading - self._heading)
        most = self._turn_rate * timestep
        turn = min(max(turn, -most), most)
        if abs(wrap(self._heading - motion.heading)) > LEAD_ANGLE:
            turn = 0.0
        self._heading += turn
        moving, turning = (step / timestep, turn / timestep) if timestep > 0.0 else (step, 0.0)
        return Reference(self._position, moving, self._heading, turning)

    def _pass_waypoint(self, motion: Motion, time: float) -> None:
        """Go on to the next way-point if the vehicle was at this one for long enough."""
        if self.passed >= len(self._waypoints):
            return
        waypoint, (target, _) = self._waypoints[self.passed], self._targets[self.passed]
        away = np.where(self._adrift, 0.0, motion.position - target)
        if np.linalg.norm(away) > waypoint.radius:
            self._inside = None
            return
        if self._inside is None:
            self._inside = time
        # the small part forgives the rounding of times
        if time - self._inside >= waypoint.stay - 1e-9:
            self.passed += 1
            self._inside = None


def wrap(angle: float) -> float:
    """The same angle [rad] between -pi and pi."""
    return math.remainder(angle, math.tau)
