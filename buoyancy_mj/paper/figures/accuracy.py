"""Figures of the error of the submerged volume."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, NullFormatter

from buoyancy_mj.paper.figures.axes import COLOURS, finish, new_figure, numbers
from buoyancy_mj.paper.study import Result

_LEAST = 1e-3
"""Errors below this [%] are drawn as this, on axes that are logarithmic."""
_LIMITS = (8e-4, 1e3)
"""Ends of those axes [%]."""


def draw_tilt(result: Result) -> Figure:
    """Draw errors against tilt."""
    table = result.tables["tilt"]
    figure, all_axes = new_figure(1, 2, width=11.0)
    tilt = numbers(table, "tilt [deg]")
    for axes, body in zip(all_axes, ("hourglass", "AUV"), strict=True):
        for name, colour in COLOURS.items():
            if f"{body}, {name}, error [%]" in table:
                error = np.maximum(np.abs(numbers(table, f"{body}, {name}, error [%]")), _LEAST)
                axes.semilogy(tilt, error, ".-", color=colour, label=name)
        _mark_claims(axes)
        label = "size of the error of the submerged volume [%]"
        axes.set(title=body, xlabel="tilt [deg]", ylabel=label, ylim=_LIMITS)
    finish(*all_axes)
    return figure


def _mark_claims(axes: Axes) -> None:
    """Draw lines at the errors and the tilt that the paper claims."""
    style: dict[str, Any] = {
        "textcoords": "offset points",
        "ha": "right",
        "fontsize": 8,
        "color": "0.4",
    }
    for limit in (3.0, 10.0):
        axes.axhline(limit, color="0.5", ls="--", lw=0.8)
        axes.annotate(f"{limit:g} %", (90, limit), (0, 2), **style)
    axes.axvline(45.0, color="0.8", lw=0.8)


def draw_density(result: Result) -> Figure:
    """Draw errors against the number of vertices."""
    table = result.tables["density"]
    bodies = np.array(table["body"])
    figure, all_axes = new_figure(2, 3, width=12.0, height=7.0)
    for axes, body in zip(all_axes, dict.fromkeys(bodies.tolist()), strict=True):
        rows = bodies == body
        vertices = numbers(table, "vertices")[rows]
        for name, colour in COLOURS.items():
            if f"{name}, error [%]" in table:
                error = np.maximum(np.abs(numbers(table, f"{name}, error [%]"))[rows], _LEAST)
                axes.loglog(vertices, error, "o-", ms=4, color=colour, label=name)
        axes.set(title=body, xlabel="vertices", ylabel="size of the error [%]", ylim=_LIMITS)
        # three numbers that stand apart, over however little of a decade
        low, high = axes.get_xlim()
        axes.xaxis.set_major_locator(FixedLocator(np.geomspace(1.2 * low, high / 1.2, 3).tolist()))
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.0f}"))
        axes.xaxis.set_minor_formatter(NullFormatter())
    finish(*all_axes)
    return figure
