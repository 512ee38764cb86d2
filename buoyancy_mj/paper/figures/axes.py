"""What the figures share: colours of the methods, grids of axes, legends."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from buoyancy_mj.paper.study import Table

COLOURS = {
    "closed form": "black",
    "exact": "tab:blue",
    "convex hull": "tab:red",
    "convex hull with cuts": "tab:orange",
    "sections": "tab:green",
    "sections, Simpson": "tab:olive",
    "sections, axis of the body": "tab:purple",
}
"""Colours of the methods, the same in all figures."""
REFERENCE: dict[str, Any] = {"color": COLOURS["closed form"], "lw": 4, "alpha": 0.3}
"""Style of a closed form: a broad grey line under the others."""


def new_figure(
    rows: int, columns: int, width: float = 7.5, height: float = 5.0, *, sharex: bool = False
) -> tuple[Figure, list[Axes]]:
    """Make a figure, and its axes row by row."""
    figure = Figure(figsize=(width, height), layout="constrained")
    return figure, list(np.ravel(figure.subplots(rows, columns, sharex=sharex, squeeze=False)))


def finish(*all_axes: Axes) -> None:
    """Draw grids everywhere, and a legend on the first axes, and on the last if theirs differs."""
    for axes in all_axes:
        axes.grid(alpha=0.3)

    first = all_axes[0]
    last = all_axes[-1]
    first.legend(fontsize=8, framealpha=0.6)
    if last.get_legend_handles_labels()[1] != first.get_legend_handles_labels()[1]:
        last.legend(fontsize=8, framealpha=0.6)


def numbers(table: Table, name: str) -> NDArray[np.float64]:
    """A column of a table as an array."""
    return np.asarray(table[name], float)
