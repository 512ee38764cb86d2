"""An irregular sea: transfer functions by cross-spectra of the motions with the elevation."""

import math
import threading
from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from buoyancy_mj.responses.regular import Channels
from buoyancy_mj.responses.responses import LEAST_ENERGY, SURE
from buoyancy_mj.responses.stations import Station
from buoyancy_mj.responses.stepping import Stepper
from buoyancy_mj.responses.subject import Subject
from buoyancy_mj.responses.tracks import Track

RATE = 24
"""Samples in a peak period of the sea, or in the shortest period that is asked for, a third."""
SEGMENT = 20.0
"""Length of a segment of Welch's method, in peak periods."""
LENGTH = 300.0
"""Length of a run, in peak periods."""
LEAD = 20.0
"""What is left out at its beginning, in peak periods."""
SMOOTH = 4.0
"""Peak periods over which the drift is smoothed."""
COMPONENTS = 200
"""Waves of the sea, at least, so that its lines stand close together."""


class IrregularResponse(NamedTuple):
    """What a vehicle answers to an irregular sea."""

    transfer: NDArray[np.complex128]
    """Motion over elevation at each period (p, c)."""
    coherence: NDArray[np.float64]
    """Squared coherence of motion and elevation (p, c)."""
    sure: NDArray[np.bool_]
    """Whether each can be trusted (p, c)."""
    turned: float
    """How far the vehicle's mean heading is off the one that was asked for [rad]."""


def choose_steps(peak_period: float, shortest: float, timestep: float) -> tuple[int, float]:
    """Steps from one sample to the next, and the timestep [s].

    Args:
        peak_period: of the sea [s].
        shortest: period that is asked for [s].
        timestep: the longest [s].
    """
    between = min(peak_period / RATE, shortest / (RATE / 3))
    steps = max(1, math.ceil(between / timestep - 1e-9))
    return steps, between / steps


def measure_irregular(
    subject: Subject,
    steps: int,
    peak_period: float,
    periods: NDArray[np.float64],
    channels: Channels,
    stop: threading.Event | None = None,
    *,
    hold: bool = True,
    length: float = LENGTH,
) -> IrregularResponse:
    """Step a vehicle through the sea of its water, and compare it with the elevation.

    H = S_ex / S_ee by Welch's method, and the squared coherence is |S_ex|^2 / (S_ee S_xx) (Bendat
    and Piersol 2010, 6.1). The elevation is that at the vehicle's origin, as it drifts.

    Args:
        subject: the vehicle, at its start.
        steps: from one sample to the next.
        peak_period: of the sea [s].
        periods: at which the transfer functions are read off (p,) [s].
        channels: what is measured beside the six motions.
        stop: set by another thread where this shall end.
        hold: whether a `Station` holds the vehicle.
        length: of the run, in peak periods.

    Raises:
        DivergenceError: the simulation left the finite numbers.
    """
    between = steps * subject.simulation.model.opt.timestep
    samples = round(peak_period / between)
    station = Station(subject, samples * between, samples) if hold else None
    stepper = Stepper(subject, steps, station, channels.columns, stop)
    stepper.take(round(LEAD * peak_period / between))
    track = stepper.take(round(length * peak_period / between))

    # the elevation where the vehicle is on the mean
    elevation = _follow_elevation(subject, track, round(SMOOTH * peak_period / between))
    motions = track.motions(subject.centre, channels.points)
    options = {"fs": 1.0 / between, "nperseg": round(SEGMENT * peak_period / between)}
    signal = scipy.signal
    frequencies, waves = signal.welch(elevation, detrend="linear", **options)
    cross = np.array([signal.csd(elevation, x, detrend="linear", **options)[1] for x in motions.T])
    own = np.array([signal.welch(x, detrend="linear", **options)[1] for x in motions.T])

    # read off between the lines; SciPy's sign of time is the other one
    wanted = 1.0 / periods
    with np.errstate(invalid="ignore", divide="ignore"):
        transfer = np.nan_to_num(np.conj(cross / waves))
        coherence = np.clip(np.nan_to_num(np.abs(cross) ** 2 / (waves * own)), 0.0, 1.0)
    transfer = np.array([np.interp(wanted, frequencies, one) for one in transfer]).T
    coherence = np.array([np.interp(wanted, frequencies, one) for one in coherence]).T
    energy = np.interp(wanted, frequencies, waves) / waves.max()
    sure = (coherence >= SURE) & (energy >= LEAST_ENERGY)[:, None]
    turned = float(track.headings.mean()) - subject.at_start.heading
    return IrregularResponse(transfer, coherence, sure, math.remainder(turned, 2.0 * math.pi))


def _follow_elevation(subject: Subject, track: Track, width: int) -> NDArray[np.float64]:
    """Elevation of the sea (n,) [m] at the vehicle's origin, as that drifts on the mean."""
    smooth = track.positions[:, :2]
    for _ in range(2):
        smooth = scipy.ndimage.uniform_filter1d(smooth, width, axis=0)
    water = subject.simulation.buoyancy.water
    above = water.elevation(smooth[:, 0], smooth[:, 1], track.times) - water.level
    return np.asarray(above, float)
