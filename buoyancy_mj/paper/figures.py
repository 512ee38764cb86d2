"""The figures, one to one with the paper's; each is drawn from the tables that stand beside it."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

from buoyancy_mj.paper import solids
from buoyancy_mj.paper.study import Result, Table

COLOURS = {
    "closed form": "black",
    "exact": "tab:blue",
    "convex hull": "tab:red",
    "convex hull with cuts": "tab:orange",
    "sections": "tab:green",
    "sections, Simpson": "tab:olive",
    "sections, axis of the body": "tab:purple",
}
"""The methods, everywhere alike."""


def volume(result: Result) -> Figure:
    """Volume against dz, and below the error."""
    table = result.tables["volume"]
    figure, (above, below) = _figure(2, 1, height=7.0, sharex=True)
    dz = _numbers(table, "dz [m]")
    for name, colour in COLOURS.items():
        if f"{name} [m^3]" in table:
            wide, faint = (4.0, 0.3) if name == "closed form" else (1.3, 1.0)
            above.plot(
                dz,
                1e3 * _numbers(table, f"{name} [m^3]"),
                color=colour,
                label=name,
                lw=wide,
                alpha=faint,
            )
        if f"{name}, error [% of the whole]" in table:
            below.plot(
                dz, _numbers(table, f"{name}, error [% of the whole]"), color=colour, label=name
            )
    above.set(ylabel="submerged volume [l]", title="hourglass, lowered upright into still water")
    below.set(xlabel="dz, immersion of the base [m]", ylabel="error [% of the whole volume]")
    _finished(above, below)
    return figure


def force(result: Result) -> Figure:
    """Buoyancy against submersion, slowly and in a drop."""
    slow, drop = result.tables["force"], result.tables["force_in_a_drop"]
    figure, (axes,) = _figure(1, 1)
    axes.plot(
        _numbers(slow, "dz [m]"),
        _numbers(slow, "rho g V, closed form [N]"),
        color="black",
        lw=4,
        alpha=0.3,
        label="rho g V",
    )
    for name in ("exact", "convex hull", "sections"):
        axes.plot(
            _numbers(slow, "dz [m]"),
            _numbers(slow, f"{name} [N]"),
            color=COLOURS[name],
            lw=1,
            label=f"{name}, lowered slowly",
        )
        dz, found = _numbers(drop, f"{name}, dz [m]"), _numbers(drop, f"{name}, force [N]")
        axes.plot(
            dz[::4], found[::4], ".", ms=4, color=COLOURS[name], label=f"{name}, in a drop of 5 s"
        )
    axes.set(
        xlabel="dz, immersion of the base [m]",
        ylabel="buoyancy [N]",
        xlim=(-0.05, 0.5),
        title="hourglass, upright",
    )
    _finished(axes)
    return figure


def areas(result: Result) -> Figure:
    """Areas of cross-sections against z."""
    glass, auv = result.tables["areas_hourglass"], result.tables["areas_auv"]
    figure, (left, right) = _figure(1, 2, width=10.0)
    z = _numbers(glass, "z [m]")
    left.plot(
        1e4 * _numbers(glass, "closed form [m^2]"),
        z,
        color="black",
        lw=4,
        alpha=0.3,
        label="closed form",
    )
    left.plot(
        1e4 * _numbers(glass, "sections [m^2]"),
        z,
        color=COLOURS["sections"],
        label="sections of the mesh",
    )
    left.set(title="hourglass", xlabel="area of the section [cm^2]", ylabel="z [m]")
    parts = [name for name in auv if name != "z [m]"]
    stacked = 1e4 * np.cumsum([_numbers(auv, name) for name in parts], axis=0)
    height = _numbers(auv, "z [m]")
    for name, low, high in zip(
        parts, np.vstack([0.0 * stacked[:1], stacked[:-1]]), stacked, strict=True
    ):
        right.fill_betweenx(height, low, high, label=name.removesuffix(" [m^2]"), alpha=0.7)
    right.set(
        title="AUV, level, its meshes stacked", xlabel="area of the section [cm^2]", ylabel="z [m]"
    )
    _finished(left, right)
    return figure


def distributed(result: Result) -> Figure:
    """The AUV at rest in an oblique view, with the buoyancy of each of its meshes."""
    table = result.tables["distributed"]
    centroids = np.column_stack([_numbers(table, f"{axis} [m]") for axis in "xyz"])
    forces = _numbers(table, "force [N]")
    meshes = solids.auv()
    lift = [0.0, 0.0, centroids[0, 2] - meshes[0].centroid[2]]
    # y runs to the upper right, away from the eye
    oblique = np.array([[1.0, 0.0], [0.45, 0.3], [0.0, 1.0]])
    figure, (axes,) = _figure(1, 1, width=9.0, height=6.5)
    for mesh in meshes:
        triangles = (mesh.vertices + lift)[mesh.faces] @ oblique
        axes.add_collection(
            PolyCollection(list(triangles), facecolors="0.7", edgecolors="none", alpha=0.1)
        )
    sea = (
        np.array([[-0.4, -0.35, 0.0], [0.4, -0.35, 0.0], [0.4, 0.35, 0.0], [-0.4, 0.35, 0.0]])
        @ oblique
    )
    axes.add_collection(PolyCollection([sea], facecolors="tab:cyan", alpha=0.15))
    scale = 0.25 / forces.max()
    for i, ((x, z), force) in enumerate(zip(centroids @ oblique, forces, strict=True)):
        everything = i == len(forces) - 1
        colour, width, faint = ("tab:red", 4.0, 0.5) if everything else (COLOURS["exact"], 1.5, 1.0)
        arrow = {
            "arrowstyle": "-|>",
            "color": colour,
            "lw": width,
            "alpha": faint,
            "mutation_scale": 8,
        }
        axes.annotate("", (x, z + scale * force), (x, z), arrowprops=arrow)
        axes.plot(x, z, "o", ms=3, color=colour)
        if force > 10.0:
            text = f"all: {force:.1f} N" if everything else f"{table['mesh'][i]}: {force:.1f} N"
            axes.annotate(
                text,
                (x, z + scale * force),
                (6, -3),
                textcoords="offset points",
                fontsize=8,
                color=colour,
            )
    axes.set(
        xlim=(-0.55, 0.6),
        ylim=(-0.5, 0.25),
        aspect="equal",
        xlabel="x + 0.45 y [m]",
        ylabel="z + 0.3 y [m]",
    )
    axes.set_title(
        "buoyancy of the AUV's 15 meshes, and their resultant at the volume-weighted centroid",
        fontsize=10,
    )
    axes.grid(alpha=0.3)
    return figure


def cog(result: Result) -> Figure:
    """The centre of gravity's z over time, by vehicle and surface."""
    figure, axes = _figure(2, 3, width=12.0, height=7.0, sharex=True)
    places = iter(axes)
    for vehicle in ("hourglass", "auv"):
        table = result.tables[f"cog_{vehicle}"]
        time = _numbers(table, "time [s]")
        for surface in ("still", "moving level", "travelling wave"):
            place = next(places)
            for method in ("exact", "convex hull", "sections"):
                place.plot(
                    time,
                    _numbers(table, f"{surface}, {method} [m]"),
                    color=COLOURS[method],
                    lw=1.3,
                    label=method,
                )
            if surface != "still":
                place.plot(
                    time,
                    0.3 * np.sin(np.pi * time),
                    color="tab:cyan",
                    lw=1,
                    ls=":",
                    label="surface at the origin",
                )
            place.set(
                title=f"{'AUV' if vehicle == 'auv' else vehicle}, {surface}",
                xlabel="time [s]",
                ylabel="CoG z [m]",
            )
    _finished(*axes)
    return figure


def tilt(result: Result) -> Figure:
    """Error against tilt."""
    table = result.tables["tilt"]
    figure, axes = _figure(1, 2, width=11.0)
    for place, body in zip(axes, ("hourglass", "AUV"), strict=True):
        for name, colour in COLOURS.items():
            if f"{body}, {name}, error [%]" in table:
                error = np.abs(_numbers(table, f"{body}, {name}, error [%]"))
                place.semilogy(
                    _numbers(table, "tilt [deg]"),
                    np.maximum(error, 1e-3),
                    ".-",
                    color=colour,
                    label=name,
                )
        for limit in (3.0, 10.0):
            place.axhline(limit, color="0.5", ls="--", lw=0.8)
            place.annotate(
                f"{limit:g} %",
                (90, limit),
                (0, 2),
                textcoords="offset points",
                ha="right",
                fontsize=8,
                color="0.4",
            )
        place.axvline(45.0, color="0.8", lw=0.8)
        place.set(
            title=body,
            xlabel="tilt [deg]",
            ylabel="size of the error of the submerged volume [%]",
            ylim=(8e-4, 1e3),
        )
    _finished(*axes)
    return figure


def density(result: Result) -> Figure:
    """Error against the number of vertices."""
    table = result.tables["density"]
    bodies = np.array(table["body"])
    figure, axes = _figure(2, 3, width=12.0, height=7.0)
    for place, body in zip(axes, dict.fromkeys(bodies.tolist()), strict=True):
        rows = bodies == body
        for name, colour in COLOURS.items():
            if f"{name}, error [%]" in table:
                error = np.abs(_numbers(table, f"{name}, error [%]"))[rows]
                place.loglog(
                    _numbers(table, "vertices")[rows],
                    np.maximum(error, 1e-3),
                    "o-",
                    ms=4,
                    color=colour,
                    label=name,
                )
        place.set(title=body, xlabel="vertices", ylabel="size of the error [%]", ylim=(8e-4, 1e3))
    _finished(*axes)
    return figure


def oscillation(result: Result) -> Figure:
    """Swing of the centre of gravity by mass and damping."""
    table = result.tables["oscillation"]
    surfaces, drags = np.array(table["surface"]), np.array(table["drag of the water"])
    masses, rates, swings = (
        _numbers(table, name) for name in ("mass over displacement", "damping [1/s]", "swing [m]")
    )
    figure, axes = _figure(2, 2, width=10.0, height=8.0)
    places = iter(axes)
    for surface in dict.fromkeys(surfaces.tolist()):
        for drag in dict.fromkeys(drags.tolist()):
            rows = (surfaces == surface) & (drags == drag)
            ticks, steps = np.unique(masses[rows]), np.unique(rates[rows])
            place, grid = next(places), swings[rows].reshape(len(ticks), len(steps))
            place.imshow(grid, cmap="RdYlGn_r", vmin=0.0, vmax=0.3, origin="lower", aspect="auto")
            for i, j in np.ndindex(*grid.shape):
                within = grid[i, j] < 0.05
                place.text(
                    j,
                    i,
                    f"{grid[i, j]:.2f}",
                    ha="center",
                    va="center",
                    fontsize=8,
                    weight="bold" if within else "normal",
                )
            place.set_xticks(range(len(steps)), [f"{step:g}" for step in steps])
            place.set_yticks(range(len(ticks)), [f"{tick:g}" for tick in ticks])
            place.set(
                xlabel="damping against the world [1/s]",
                ylabel="mass over displacement",
                title=f"{surface}, drag of the water: {drag}",
            )
    figure.suptitle(
        "half the range of the CoG's z over the last wave [m]; bold: within 0.05 m", fontsize=10
    )
    return figure


def rest(result: Result) -> Figure:
    """Force less its mean at the end of a drop."""
    figure, axes = _figure(1, 2, width=11.0)
    for place, vehicle in zip(axes, ("hourglass", "auv"), strict=True):
        table = result.tables[f"rest_{vehicle}"]
        for method in ("convex hull", "sections", "exact"):
            found = _numbers(table, f"{method} [N]")
            label = f"{method}, standard deviation {found.std():.2g} N"
            place.plot(
                _numbers(table, "time before the end [s]"),
                found - found.mean(),
                color=COLOURS[method],
                lw=1.2,
                label=label,
            )
        place.set(
            title="AUV" if vehicle == "auv" else vehicle,
            xlabel="time before the end [s]",
            ylabel="buoyancy less its mean [N]",
        )
        place.set_yscale("symlog", linthresh=0.5)
    _finished(*axes)
    return figure


def _figure(
    rows: int, columns: int, width: float = 7.5, height: float = 5.0, *, sharex: bool = False
) -> tuple[Figure, list[Axes]]:
    """A figure and its axes, row by row."""
    figure = Figure(figsize=(width, height), layout="constrained")
    return figure, list(np.ravel(figure.subplots(rows, columns, sharex=sharex, squeeze=False)))


def _finished(*axes: Axes) -> None:
    """Grids everywhere, a legend on the first."""
    for place in axes:
        place.grid(alpha=0.3)
    axes[0].legend(fontsize=8, framealpha=0.6)
    if axes[-1].get_legend_handles_labels()[1] != axes[0].get_legend_handles_labels()[1]:
        axes[-1].legend(fontsize=8, framealpha=0.6)


def _numbers(table: Table, name: str) -> NDArray[np.float64]:
    return np.asarray(table[name], float)
