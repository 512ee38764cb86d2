"""Figures of the centre of gravity over time."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from buoyancy_mj.paper.figures.axes import COLOURS, finish, new_figure, numbers
from buoyancy_mj.paper.study import Result
from buoyancy_mj.plotting.style import INK, SKY


def draw_cog(result: Result) -> Figure:
    """Draw the centre of gravity's z over time, by vehicle and surface."""
    figure, all_axes = new_figure(2, 3, width=12.0, height=7.0, sharex=True)
    panels = [
        (vehicle, surface)
        for vehicle in ("hourglass", "AUV")
        for surface in ("still", "moving level", "travelling wave")
    ]
    for axes, (vehicle, surface) in zip(all_axes, panels, strict=True):
        table = result.tables[f"cog_{vehicle.lower()}"]
        time = numbers(table, "time [s]")
        for method in ("exact", "convex hull", "sections"):
            heights = numbers(table, f"{surface}, {method} [m]")
            axes.plot(time, heights, color=COLOURS[method], lw=1.3, label=method)
        if surface != "still":
            level = 0.3 * np.sin(np.pi * time)
            axes.plot(time, level, color=SKY, lw=1, ls=":", label="surface at the origin")
        axes.set(title=f"{vehicle}, {surface}", xlabel="time [s]", ylabel="CoG z [m]")
    finish(*all_axes)
    return figure


def draw_oscillation(result: Result) -> Figure:
    """Draw the swing of the centre of gravity by mass and damping."""
    table = result.tables["oscillation"]
    surfaces = np.array(table["surface"])
    drags = np.array(table["drag of the water"])
    masses = numbers(table, "mass over displacement")
    rates = numbers(table, "damping [1/s]")
    swings = numbers(table, "swing [m]")

    figure, all_axes = new_figure(2, 2, width=10.0, height=8.0)
    panels = [
        (surface, drag)
        for surface in dict.fromkeys(surfaces.tolist())
        for drag in dict.fromkeys(drags.tolist())
    ]
    for axes, (surface, drag) in zip(all_axes, panels, strict=True):
        rows = (surfaces == surface) & (drags == drag)
        _draw_grid(axes, masses[rows], rates[rows], swings[rows])
        axes.set(
            xlabel="damping against the world [1/s]",
            ylabel="mass over displacement",
            title=f"{surface}, drag of the water: {drag}",
        )
    figure.suptitle(
        "half the range of the CoG's z over the last wave [m]; bold: within 0.05 m", fontsize=10
    )
    return figure


def _draw_grid(
    axes: Axes,
    masses: NDArray[np.float64],
    rates: NDArray[np.float64],
    swings: NDArray[np.float64],
) -> None:
    """Draw swings as coloured cells, masses upward and damping rates to the right."""
    rows = np.unique(masses)
    columns = np.unique(rates)
    grid = swings.reshape(len(rows), len(columns))
    # light is small, so that letters on it are dark
    axes.grid(visible=False)
    axes.imshow(grid, cmap="cividis_r", vmin=0.0, vmax=0.3, origin="lower", aspect="auto")
    style: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": 8}
    for (i, j), value in np.ndenumerate(grid):
        weight = "bold" if value < 0.05 else "normal"
        colour = INK if value < 0.15 else "white"
        axes.text(j, i, f"{value:.2f}", weight=weight, color=colour, **style)
    axes.set_xticks(range(len(columns)), [f"{rate:g}" for rate in columns])
    axes.set_yticks(range(len(rows)), [f"{mass:g}" for mass in rows])
