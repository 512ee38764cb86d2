"""`portray`: a sea in a notebook: what it is, how its surface moves, and its spectrum."""

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.displays.charts import draw_chart
from buoyancy_mj.displays.tables import write_table

if TYPE_CHECKING:
    from buoyancy_mj.sea.water import Water

PERIODS = 3.0
"""How many periods of a regular wave are drawn."""
SPAN = 60.0
"""How long the surface of an irregular sea is drawn [s]."""
BANDS = 48
"""Bands of frequencies in which the spectrum is drawn."""


def portray(water: "Water") -> str:
    """A water as HTML: a table and, of waves, charts.

    Args:
        water: the sea.
    """
    rows = [
        ("density", f"{water.density:g} kg/m^3"),
        ("still level", f"{water.level:g} m"),
        *((f"wave {n}", repr(wave)) for n, wave in enumerate(water.waves)),  # type: ignore[arg-type]
        ("current", _describe_current(water)),
    ]
    amplitude, omega = np.abs(water.rows[:, 0]), np.abs(water.rows[:, 3])
    moving = (amplitude > 0.0) & (omega > 0.0)
    charts = ""
    if moving.any():
        frequencies = omega[moving] / (2.0 * math.pi)
        energies = 0.5 * amplitude[moving] ** 2
        charts = _draw_surface(water, frequencies)
        if len(np.unique(frequencies)) > 1:
            charts += _draw_spectrum(frequencies, energies)
    return write_table("Water", rows, below=charts)


def _describe_current(water: "Water") -> str:
    """A uniform current as a velocity; any other as what it is."""
    current = water.current
    if isinstance(current, tuple):
        return f"({', '.join(f'{value:g}' for value in current)}) m/s" if any(current) else "none"
    return repr(current)


def _draw_surface(water: "Water", frequencies: NDArray[np.float64]) -> str:
    """The height of the surface at the origin, over time."""
    is_regular = len(np.unique(frequencies)) == 1
    times = np.linspace(0.0, PERIODS / frequencies[0] if is_regular else SPAN, 600)
    heights = water.elevation(0.0, 0.0, times)
    return draw_chart(times, {"surface": heights}, "time [s]", "surface at x = y = 0 [m]")


def _draw_spectrum(frequencies: NDArray[np.float64], energies: NDArray[np.float64]) -> str:
    """The spectrum: variance in bands of frequency over their width."""
    ends = np.linspace(0.0, 1.02 * float(frequencies.max()), BANDS + 1)
    totals, _ = np.histogram(frequencies, ends, weights=energies)
    density = totals / np.diff(ends)
    # as steps
    across, up = np.repeat(ends, 2)[1:-1], np.repeat(density, 2)
    return draw_chart(across, {"spectrum": up}, "frequency [Hz]", "spectrum [m^2/Hz]")
