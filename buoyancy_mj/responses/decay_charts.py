"""Chart of a free decay: the motion in time, and its damping over the amplitude."""

import math
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from buoyancy_mj.plotting.style import (
    BLUE,
    FAINT,
    INK,
    VERMILLION,
    new_figure,
    save_figure,
    use_style,
)
from buoyancy_mj.responses.decay import Decay

SWINGS = 14
"""Swings that are shown in time, at most."""


def draw_decay(decay: Decay, path: Path) -> None:
    """Draw a decay into a picture.

    Raises:
        OSError: the file cannot be written.
    """
    with use_style():
        save_figure(make_decay_figure(decay), path)


def make_decay_figure(decay: Decay) -> Figure:
    """The figure of `draw_decay`."""
    figure = new_figure(32.0 / 3.0, 6.0)
    left, right = figure.subplots(1, 2, width_ratios=[1.6, 1.0])
    _draw_motion(left, decay)
    _draw_damping(right, decay)
    return figure


def _unit(decay: Decay) -> tuple[float, str]:
    """Scale and unit in which the motion is shown."""
    return (1.0, "m") if decay.motion == "heave" else (180.0 / math.pi, "deg")


def _draw_motion(axes: Axes, decay: Decay) -> None:
    """The motion with its turning points, and the amplitude that the fit gives."""
    scale, unit = _unit(decay)
    fit, peaks = decay.fit, decay.peaks
    last = min(decay.times[-1], SWINGS * fit.period)
    shown = decay.times <= last
    axes.plot(decay.times[shown], scale * decay.values[shown], color=BLUE)
    inside = peaks.times <= last
    axes.plot(
        peaks.times[inside], scale * peaks.values[inside], "o", color=BLUE, label="turning points"
    )

    # the amplitude that obeys the fitted damping, around where the vehicle rests
    times = np.arange(0.0, last, 0.02 * fit.period)
    amplitude = np.empty(len(times))
    amplitude[0] = abs(decay.start)
    for i in range(1, len(times)):
        rate = fit.decrement(float(amplitude[i - 1])) / fit.period
        amplitude[i] = amplitude[i - 1] * math.exp(-rate * (times[i] - times[i - 1]))
    for sign, label in ((1.0, "amplitude by the fit"), (-1.0, None)):
        axes.plot(
            times, sign * scale * amplitude, "--", color=VERMILLION, linewidth=1.3, label=label
        )

    axes.axhline(0.0, color=FAINT, linewidth=0.8)
    axes.set_xlabel("time [s]")
    axes.set_ylabel(f"{decay.motion} out of rest [{unit}]")
    axes.set_title(
        f"{decay.title} let go in {decay.motion}: period {fit.period:.4g} s "
        f"(statics {decay.natural_period:.4g} s)"
    )
    axes.legend(loc="upper right")


def _draw_damping(axes: Axes, decay: Decay) -> None:
    """Damping ratio over the amplitude, measured and fitted."""
    scale, unit = _unit(decay)
    fit = decay.fit
    axes.plot(
        scale * fit.amplitudes, 50.0 / math.pi * fit.decrements, "o", color=BLUE, label="swings"
    )
    line = np.array([0.0, 1.05 * float(fit.amplitudes.max())])
    ratios = [100.0 * fit.damping_ratio(float(amplitude)) for amplitude in line]
    axes.plot(scale * line, ratios, "--", color=VERMILLION, label="linear and quadratic damping")
    measured = 50.0 / math.pi * fit.decrements
    axes.set_ylim(min(0.0, float(measured.min())), 1.15 * max(*ratios, float(measured.max()), 1e-3))
    axes.set_xlim(0.0, scale * float(line[1]))
    axes.set_xlabel(f"amplitude [{unit}]")
    axes.set_ylabel("damping, % of critical")
    axes.set_title("damping over amplitude", color=INK)
    axes.legend(loc="lower right")
