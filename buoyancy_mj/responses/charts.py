"""Charts of responses: size and phase over the period, a line for each heading."""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from buoyancy_mj.plotting.style import FAINT, new_figure, save_figure, use_style
from buoyancy_mj.responses.extremes import Sea, spectrum_of
from buoyancy_mj.responses.responses import Responses

COLUMNS = 3
"""Responses side by side."""
FAINTEST = 0.02
"""Part of a response's largest size below which its phase says nothing."""
_NATURAL = {"heave": 0, "roll": 1, "pitch": 2}
"""Which natural period belongs to which response."""


def draw_responses(responses: Responses, path: Path, sea: Sea | None = None) -> None:
    """Draw all responses into a picture, with natural periods, and the spectrum of a sea behind.

    Raises:
        OSError: the file cannot be written.
    """
    with use_style():
        save_figure(make_responses_figure(responses, sea), path)


def make_responses_figure(responses: Responses, sea: Sea | None = None) -> Figure:
    """The figure of `draw_responses`."""
    count = len(responses.names)
    rows = math.ceil(count / COLUMNS)
    figure = new_figure(32.0 / 3.0, 3.0 * rows)
    grid = figure.subplots(
        2 * rows,
        COLUMNS,
        sharex=True,
        squeeze=False,
        gridspec_kw={"height_ratios": [3.0, 1.15] * rows},
    )
    looks = choose_looks(len(responses.headings))
    for c in range(count):
        row, column = divmod(c, COLUMNS)
        above, below = grid[2 * row, column], grid[2 * row + 1, column]
        _draw_sizes(above, responses, c, looks)
        _draw_phases(below, responses, c, looks)
        if sea is not None:
            _shade_sea(above, responses, sea)
    for c in range(count, rows * COLUMNS):
        row, column = divmod(c, COLUMNS)
        grid[2 * row, column].axis("off")
        grid[2 * row + 1, column].axis("off")
    for axes in grid[-1]:
        axes.set_xlabel("wave period [s]")
    for row in range(rows):
        grid[2 * row + 1, 0].set_ylabel("lag [deg]")
    figure.align_ylabels(grid[:, 0])

    # one legend for all, over everything
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(
        handles, labels, loc="outside upper right", ncols=min(len(labels), 9), frameon=False
    )
    grid[0, 0].annotate(
        f"{responses.title}: response to waves from each heading",
        (0.012, 0.978),
        xycoords="figure fraction",
        va="center",
        fontsize=12,
        annotation_clip=False,
    ).set_in_layout(False)
    return figure


def choose_looks(count: int) -> list[dict[str, Any]]:
    """A colour for each of several lines, and another stroke where colours come again.

    Later lines are thinner, so that those under them show.
    """
    widths = np.linspace(3.4, 1.4, count) if count > 1 else np.array([2.0])
    colours = matplotlib.rcParams["axes.prop_cycle"].by_key()["color"]
    strokes = ("-", "--", ":", "-.")
    if count <= len(colours) * len(strokes):
        return [
            {
                "color": colours[i % len(colours)],
                "linestyle": strokes[i // len(colours)],
                "linewidth": width,
            }
            for i, width in enumerate(widths)
        ]
    shades = matplotlib.colormaps["cividis"](np.linspace(0.0, 1.0, count))
    return [{"color": shade, "linestyle": "-", "linewidth": 1.2} for shade in shades]


def _draw_sizes(axes: Axes, responses: Responses, c: int, looks: Sequence[dict[str, Any]]) -> None:
    """The size of a response over the period."""
    name, unit = responses.names[c], responses.units[c]
    sizes = responses.normal_sizes[:, :, c]
    order = np.argsort(responses.periods)
    periods = responses.periods[order]
    for heading, own, sure, look in zip(
        responses.headings, sizes, responses.sure[:, :, c], looks, strict=True
    ):
        label = f"{math.degrees(heading):.4g}°"
        marker = "o" if len(periods) < 40 else ""
        axes.plot(periods, own[order], marker=marker, markersize=2.8, label=label, **look)
        doubtful = ~sure[order]
        axes.plot(
            periods[doubtful], own[order][doubtful], "o", color="white",
            markeredgecolor=look["color"], markersize=5.0,
        )  # fmt: skip
    top = float(sizes.max(initial=0.0))
    axes.set_ylim(0.0, (1.25 if name in _NATURAL else 1.12) * max(top, 0.05))
    axes.set_title(f"{name} over wave slope" if unit == "rad" else f"{name} [{unit}/m]")
    _mark_natural_period(axes, responses, name, float(periods[0]), float(periods[-1]))


def _mark_natural_period(
    axes: Axes, responses: Responses, name: str, low: float, high: float
) -> None:
    """An upright line at the natural period; a word where it lies outside."""
    if name not in _NATURAL:
        return
    natural = float(responses.natural_periods[_NATURAL[name]])
    text = f"natural period {natural:.3g} s"
    if not math.isfinite(natural):
        text = "nothing restores"
    if low <= natural <= high:
        axes.axvline(natural, color=FAINT, linestyle=(0, (4, 2)), linewidth=1.2, zorder=1.0)
    axes.text(
        0.985, 0.96, text, transform=axes.transAxes, ha="right", va="top", fontsize=8, color=FAINT
    )


def _draw_phases(axes: Axes, responses: Responses, c: int, looks: Sequence[dict[str, Any]]) -> None:
    """By how much a response lags behind the crest, where there is one."""
    top = float(responses.normal_sizes[:, :, c].max(initial=0.0))
    order = np.argsort(responses.periods)
    for sizes, phases, look in zip(
        responses.normal_sizes[:, order, c], responses.phases[:, order, c], looks, strict=True
    ):
        shown = sizes > FAINTEST * top
        axes.plot(
            responses.periods[order][shown],
            np.degrees(phases[shown]),
            "o",
            markersize=2.8,
            color=look["color"],
        )
    axes.set_ylim(-200.0, 200.0)
    axes.set_yticks([-180, -90, 0, 90, 180], ["-180", "", "0", "", "180"])


def _shade_sea(axes: Axes, responses: Responses, sea: Sea) -> None:
    """The spectrum of a sea, as high as two fifths of the axes."""
    low, high = axes.get_xlim()
    periods: NDArray[np.float64] = np.linspace(
        responses.periods.min(), responses.periods.max(), 300
    )
    density = spectrum_of(sea, 2.0 * math.pi / periods)
    scaled = 0.4 * axes.get_ylim()[1] * density / max(float(density.max()), 1e-30)
    axes.fill_between(periods, scaled, color=FAINT, alpha=0.18, linewidth=0.0, zorder=0.5,
                      label="sea (scaled)")  # fmt: skip
    axes.set_xlim(low, high)
