"""`GateWatch`: when a vehicle has passed a gate as a whole, between updates too."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Passage(NamedTuple):
    """One way of the whole vehicle through a gate."""

    gate: str
    """Name of the gate."""
    time: float
    """When the last of the vehicle was through [s]."""
    direction: int
    """1 away from the start, -1 back towards it."""
    heading: float
    """Cosine of the angle from the way through the gate, away from the start, to the bow."""


class GateWatch:
    """Follow each corner of a vehicle through the plane of a gate.

    A corner crosses the plane where the straight line from its place in one update to that in the
    next does. The vehicle has passed when all its corners have come from one side to the other
    through the opening; who turns back on the way, or brings a corner past a post or over the bar,
    has not.

    Args:
        name: name of the gate.
        half: half width and half height (2,) [m] of its opening.
    """

    def __init__(self, name: str, half: NDArray[np.float64]) -> None:
        self._name = name
        self._half = half
        self._side = 0
        self._through: NDArray[np.int64] | None = None

    def is_far(self, distance: float, radius: float) -> bool:
        """Whether a vehicle of a radius [m] is clear of the plane, where it was at last.

        Args:
            distance: of its middle from the plane [m], positive beyond the gate.
            radius: of a ball that holds it [m].
        """
        return abs(distance) > radius and self._side == (1 if distance > 0.0 else -1)

    def follow(
        self,
        before: NDArray[np.float64],
        now: NDArray[np.float64],
        times: tuple[float, float],
        heading: float,
    ) -> Passage | None:
        """Follow the corners of the vehicle from one update to the next.

        Args:
            before: their places (n, 3) [m] in the gate's frame in the update before; x away from
                the start, y to port, z up, from the middle of the opening.
            now: their places (n, 3) [m] now.
            times: of both updates (2,) [s].
            heading: cosine of the angle between the bow and the gate's x axis.
        """
        if self._through is None:
            self._through = np.zeros(len(now), np.int64)

        # which corners have crossed the plane, and where
        is_beyond = now[:, 0] >= 0.0
        crossed = is_beyond != (before[:, 0] >= 0.0)
        share = np.zeros(len(now))
        share[crossed] = before[crossed, 0] / (before[crossed, 0] - now[crossed, 0])
        places = before[:, 1:] + share[:, None] * (now[:, 1:] - before[:, 1:])
        inside = crossed & (np.abs(places) <= self._half).all(axis=1)
        self._through[inside] += np.where(is_beyond[inside], 1, -1)

        # the vehicle is on one side again
        if is_beyond.any() != is_beyond.all():
            return None
        side = 1 if is_beyond[0] else -1
        is_passed = self._side == -side and bool((self._through == side).all())
        self._side = side
        self._through[:] = 0
        if not is_passed:
            return None
        time = times[0] + float(share.max()) * (times[1] - times[0])
        return Passage(self._name, time, side, heading)
