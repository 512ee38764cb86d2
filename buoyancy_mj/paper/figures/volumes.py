"""Figures of volumes and areas of bodies at rest."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from buoyancy_mj.paper.figures.axes import COLOURS, REFERENCE, finish, new_figure, numbers
from buoyancy_mj.paper.study import Result, Table


def draw_volume(result: Result) -> Figure:
    """Draw volume against dz, and below it the error."""
    table = result.tables["volume"]
    figure, (above, below) = new_figure(2, 1, height=7.0, sharex=True)
    dz = numbers(table, "dz [m]")
    for name, colour in COLOURS.items():
        if f"{name} [m^3]" in table:
            style = REFERENCE if name == "closed form" else {"color": colour, "lw": 1.3}
            above.plot(dz, 1e3 * numbers(table, f"{name} [m^3]"), label=name, **style)
        if f"{name}, error [% of the whole]" in table:
            error = numbers(table, f"{name}, error [% of the whole]")
            below.plot(dz, error, color=colour, label=name)
    above.set(ylabel="submerged volume [l]", title="hourglass, lowered upright into still water")
    below.set(xlabel="dz, immersion of the base [m]", ylabel="error [% of the whole volume]")
    finish(above, below)
    return figure


def draw_areas(result: Result) -> Figure:
    """Draw areas of cross-sections against z."""
    figure, (left, right) = new_figure(1, 2, width=10.0)
    _draw_hourglass_areas(left, result.tables["areas_hourglass"])
    _draw_auv_areas(right, result.tables["areas_auv"])
    finish(left, right)
    return figure


def _draw_hourglass_areas(axes: Axes, table: Table) -> None:
    """Draw areas of the mesh beside the closed form."""
    z = numbers(table, "z [m]")
    closed_form = 1e4 * numbers(table, "closed form [m^2]")
    areas = 1e4 * numbers(table, "sections [m^2]")
    axes.plot(closed_form, z, label="closed form", **REFERENCE)
    axes.plot(areas, z, color=COLOURS["sections"], label="sections of the mesh")
    axes.set(title="hourglass", xlabel="area of the section [cm^2]", ylabel="z [m]")


def _draw_auv_areas(axes: Axes, table: Table) -> None:
    """Draw areas of the AUV's parts, stacked."""
    parts = [name for name in table if name != "z [m]"]
    ends = 1e4 * np.cumsum([numbers(table, name) for name in parts], axis=0)
    starts = np.vstack([0.0 * ends[:1], ends[:-1]])
    z = numbers(table, "z [m]")
    for name, start, end in zip(parts, starts, ends, strict=True):
        axes.fill_betweenx(z, start, end, label=name.removesuffix(" [m^2]"), alpha=0.7)
    axes.set(
        title="AUV, level, its meshes stacked", xlabel="area of the section [cm^2]", ylabel="z [m]"
    )
