"""What the figures share: colours of the methods, axes, legends."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from buoyancy_mj.paper.study import Table
from buoyancy_mj.plotting.style import BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILLION

COLOURS = {
    "closed form": "black",
    "exact": BLUE,
    "convex hull": VERMILLION,
    "convex hull with cuts": ORANGE,
    "sections": GREEN,
    "sections, Simpson": SKY,
    "sections, axis of the body": PURPLE,
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
    """Draw a legend on the first axes, and on the last if theirs differs."""
    first = all_axes[0]
    last = all_axes[-1]
    first.legend()
    if last.get_legend_handles_labels()[1] != first.get_legend_handles_labels()[1]:
        last.legend()


def numbers(table: Table, name: str) -> NDArray[np.float64]:
    """A column of a table as an array."""
    return np.asarray(table[name], float)
