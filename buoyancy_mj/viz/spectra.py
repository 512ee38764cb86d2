"""`Spectra`: of the sea and of the motion of a run, as bars over frequency in its recording."""

from collections.abc import Iterable

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.viz.log import Log
from buoyancy_mj.viz.palette import COLOURS, hue
from buoyancy_mj.viz.ticks import choose_end

PLOTS = {
    "surface": ("surface", "m^2/Hz"),
    "heave": ("weight", "m^2/Hz"),
    "roll": ("roll", "degrees^2/Hz"),
    "pitch": ("pitch", "degrees^2/Hz"),
}
"""The colour and the unit of each spectrum."""
FEWEST = 32
"""Fewest frames of which there is a spectrum."""
SEGMENTS = 4
"""Number of spectra that are averaged, each of a half overlapping window, in a long run."""
LONG = 64.0
"""Length of a run from which on windows are averaged, in periods of the highest peak."""
SHOWN, AXIS = 0.99, 680.0
"""Part of the variance of each line that the axis of frequency shows, and its length [pixels]."""


class Spectra:
    """One-sided spectral densities of the elevation at each vehicle, and of its motion.

    Welch (1967), "The use of fast Fourier transform for the estimation of power spectra": windows
    of Hann, whose trend is taken off. A short run is one window.

    Args:
        vehicles: each vehicle, and what tells it from others.
    """

    def __init__(self, vehicles: Iterable[tuple[Vehicle, str]]) -> None:
        self._vehicles = [(vehicle.name, name) for vehicle, name in vehicles]
        self._times: list[float] = []
        self._rows: list[list[float]] = []

    @property
    def entities(self) -> dict[str, tuple[str, ...]]:
        """The entities of each plot, by its title."""
        return {
            f"{kind} [{unit}] over frequency [Hz]": tuple(
                _entity(kind, name) for _, name in self._vehicles
            )
            for kind, (_, unit) in PLOTS.items()
        }

    @property
    def known(self) -> bool:
        """Whether there are frames enough."""
        return len(self._times) >= FEWEST and self._times[-1] > self._times[0]

    def add(self, frame: Frame) -> None:
        """Keep the motion of one frame."""
        self._times.append(frame.time)
        row = []
        for vehicle, _ in self._vehicles:
            seen = frame.vehicles[vehicle]
            roll, pitch, _ = seen.attitude.tolist()
            row += [seen.elevation, float(seen.centre_of_mass[2]), roll, pitch]
        self._rows.append(row)

    def draw(self, log: Log) -> None:
        """Draw the spectra of what has been kept."""
        times, series = _resample(np.array(self._times), np.array(self._rows))
        series = series.reshape(len(times), -1, len(PLOTS))
        # roll and pitch, unwrapped, in degrees
        series[..., 2:] = np.degrees(np.unwrap(series[..., 2:], axis=0))
        frequencies, densities = estimate_spectra(times, series)
        # bars of several vehicles stand side by side
        width = frequencies[1] / len(self._vehicles)
        shown = _count_shown(frequencies, densities)
        for plot, (kind, (meaning, _)) in enumerate(PLOTS.items()):
            for i, (_, name) in enumerate(self._vehicles):
                bars = rr.BarChart(
                    densities[:shown, i, plot],
                    abscissa=frequencies[:shown] + i * width,
                    widths=np.full(shown, width),
                    color=hue(i) if name else COLOURS[meaning],
                )
                log.keep(_entity(kind, name), bars)


def estimate_spectra(
    times: NDArray[np.float64], series: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Estimate one-sided spectral densities of series, whose trends are taken off.

    Args:
        times: evenly spaced times (n,) [s].
        series: values (n, ...).

    Returns:
        Frequencies (m,) [Hz], and densities (m, ...) [unit^2/Hz] whose integral over frequency is
        the variance.
    """
    frequencies, densities = _average(times, series, len(times))
    peak = frequencies[np.argmax(densities.reshape(len(frequencies), -1).max(axis=1))]
    if peak * (times[-1] - times[0]) > LONG:
        return _average(times, series, 2 * len(times) // (SEGMENTS + 1))
    return frequencies, densities


def _average(
    times: NDArray[np.float64], series: NDArray[np.float64], length: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Average spectra over windows of a length, each of which begins amid the one before.

    As `scipy.signal.welch` has them, whose import takes longer than to record ten seconds.
    """
    step = length - length // 2
    begins = range(0, len(times) - length + 1, step)
    windows = np.stack([series[begin : begin + length] for begin in begins])

    # the trend of each
    at = np.arange(length) - 0.5 * (length - 1)
    slopes = np.tensordot(at, windows, (0, 1)) / (at @ at)
    trends = at.reshape(-1, *[1] * (series.ndim - 1)) * slopes[:, None]
    flat = windows - windows.mean(axis=1, keepdims=True) - trends

    # Hann's window
    shape = 0.5 - 0.5 * np.cos(2.0 * np.pi * np.arange(length) / length)
    between = times[1] - times[0]
    lines = np.fft.rfft(flat * shape.reshape(-1, *[1] * (series.ndim - 1)), axis=1)
    densities = 2.0 * between / (shape @ shape) * (np.abs(lines) ** 2).mean(axis=0)
    densities[0] *= 0.5
    if length % 2 == 0:
        densities[-1] *= 0.5
    return np.fft.rfftfreq(length, between), densities


def _count_shown(frequencies: NDArray[np.float64], densities: NDArray[np.float64]) -> int:
    """Number of frequencies that hold nearly all of the variance of each line.

    The axis goes on until it has labels enough.

    Args:
        frequencies: frequencies (m,) [Hz].
        densities: densities (m, ...).
    """
    sums = np.cumsum(densities.reshape(len(densities), -1), axis=0)
    last = int((sums < SHOWN * sums[-1]).sum(axis=0).max())
    end = choose_end(0.0, 1.1 * frequencies[last], 0.0, AXIS)
    return int(np.searchsorted(frequencies, end)) + 1


def _resample(
    times: NDArray[np.float64], rows: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Rows (n, m) at times (n,), and these at even steps where they are not."""
    even = np.linspace(times[0], times[-1], len(times))
    if np.abs(times - even).max() < 0.01 * (even[1] - even[0]):
        return even, rows
    return even, np.column_stack([np.interp(even, times, column) for column in rows.T])


def _entity(kind: str, vehicle: str) -> str:
    """The entity of a spectrum of a vehicle; '' is the only one."""
    owner = [rr.escape_entity_path_part(vehicle)] if vehicle else []
    return "/".join(["spectra", kind, *owner])
