"""One regular wave: a vehicle runs in it until it answers the same from window to window."""

import math
import threading
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.responses.harmonics import fit_harmonics
from buoyancy_mj.responses.stations import Station
from buoyancy_mj.responses.stepping import Stepper
from buoyancy_mj.responses.subject import Subject
from buoyancy_mj.responses.tracks import MOTIONS, Track

SAMPLES = 40
"""Samples in a period of the wave."""
LEAST_WINDOW = 2
"""Whole wave periods in a window, at least."""
NATURAL_PERIODS = 2.0
"""Natural periods in a window, at least, as far as `MOST_WINDOW` allows."""
MOST_WINDOW = 20
"""Whole wave periods in a window, at most."""
SETTLED = 0.005
"""Change from a window to the next, as a part of the response, below which it is settled."""
SMALLEST = 0.1
"""Response, over the wave's amplitude or slope, below which changes are parts of this."""
MOST_WINDOWS = 30
"""Windows after which a response that changes still is taken as it is, and marked."""


class Channels(NamedTuple):
    """What is measured beside the six motions."""

    points: tuple[tuple[float, float, float], ...] = ()
    """Points fixed to the root body (3,) [m], in its frame."""
    columns: tuple[int, ...] = ()
    """Indices of sensor values."""


class RegularResponse(NamedTuple):
    """What a vehicle answers to one regular wave."""

    transfer: NDArray[np.complex128]
    """Motion over elevation (c,) [m/m, rad/m, or the sensor's unit per m]."""
    changes: NDArray[np.float64]
    """Change of each from the last window but one to the last, as a part of the response (c,)."""
    periods: int
    """How many wave periods it took."""
    turned: float
    """How far the vehicle's mean heading is off the one that was asked for [rad]."""

    @property
    def settled(self) -> NDArray[np.bool_]:
        """Whether the transient of each has died down (c,)."""
        return self.changes <= SETTLED


def choose_steps(period: float, timestep: float) -> tuple[int, float]:
    """Steps from one sample to the next, and a timestep [s] of which a period is a whole number.

    Args:
        period: of the wave [s].
        timestep: the longest [s].
    """
    steps = max(1, math.ceil(period / (SAMPLES * timestep) - 1e-9))
    return steps, period / (SAMPLES * steps)


def measure_regular(
    subject: Subject,
    steps: int,
    channels: Channels,
    stop: threading.Event | None = None,
    *,
    hold: bool = True,
) -> RegularResponse:
    """Step a vehicle in the one wave of its water until two windows agree.

    A window is a whole number of wave periods, `LEAST_WINDOW` or more, and `NATURAL_PERIODS` of
    heave, roll and pitch long.

    Args:
        subject: the vehicle, at its start.
        steps: from one sample to the next, see `choose_steps`.
        channels: what is measured beside the six motions.
        stop: set by another thread where this shall end.
        hold: whether a `Station` holds the vehicle.

    Raises:
        DivergenceError: the simulation left the finite numbers.
    """
    ((amplitude, kx, ky, omega, phase, *_),) = subject.simulation.buoyancy.water.rows
    period = 2.0 * math.pi / omega
    station = Station(subject, period, SAMPLES) if hold else None
    stepper = Stepper(subject, steps, station, channels.columns, stop)
    window = choose_window(period, subject.natural_periods)
    slope = math.hypot(kx, ky)
    count = len(MOTIONS) + 3 * len(channels.points) + len(channels.columns)
    transfer, changes = np.full(count, math.inf + 0j), np.full(count, math.inf)
    taken, turned = 0, 0.0
    while not (changes <= SETTLED).all() and taken < MOST_WINDOWS * window:
        track = stepper.take(window * SAMPLES)
        taken += window
        theta = _follow_phase(track, kx, ky, omega, phase)
        found, _ = fit_harmonics(track.motions(subject.centre, channels.points), theta)
        last, transfer = transfer, found / amplitude
        changes = _compare(transfer, last, slope)
        turned = float(track.headings.mean()) - subject.at_start.heading
    return RegularResponse(transfer, changes, taken, math.remainder(turned, 2.0 * math.pi))


def _compare(
    now: NDArray[np.complex128], last: NDArray[np.complex128], slope: float
) -> NDArray[np.float64]:
    """Change of each response as a part of it, or of `SMALLEST` where that is more.

    Sensors have units of their own, and so a part of what all values of sensors come to.
    """
    sizes = np.abs(now)
    scale = np.full(len(now), SMALLEST)
    scale[3:6] *= slope
    scale[6:] = SMALLEST * sizes[6:].max(initial=0.0) + 1e-12
    with np.errstate(invalid="ignore"):
        changes = np.abs(now - last) / np.maximum(sizes, scale)
    return np.asarray(np.nan_to_num(changes, nan=math.inf), float)


def choose_window(period: float, natural_periods: Sequence[float] | NDArray[np.float64]) -> int:
    """Whole wave periods in a window, so that what swings freely by itself shows as a change."""
    own = [float(value) for value in natural_periods if math.isfinite(value)]
    wanted = math.ceil(NATURAL_PERIODS * max(own, default=0.0) / period)
    return min(max(LEAST_WINDOW, wanted), MOST_WINDOW)


def _follow_phase(
    track: Track, kx: float, ky: float, omega: float, phase: float
) -> NDArray[np.float64]:
    """Phase of the wave (n,) [rad] at the vehicle's origin, as that drifts on the mean."""
    still = phase - omega * track.times
    _, slow = fit_harmonics(track.positions[:, :2], still)
    return np.asarray(slow @ [kx, ky] + still, float)
