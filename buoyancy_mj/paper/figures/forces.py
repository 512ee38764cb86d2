"""Figures of forces."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

from buoyancy_mj.paper import solids
from buoyancy_mj.paper.figures.axes import COLOURS, REFERENCE, finish, new_figure, numbers
from buoyancy_mj.paper.study import Result
from buoyancy_mj.plotting.style import SKY, VERMILLION

_OBLIQUE = np.array([[1.0, 0.0], [0.45, 0.3], [0.0, 1.0]])
"""Projection (3, 2) in which y runs to the upper right, away from the eye."""
_SEA = np.array([[-0.4, -0.35, 0.0], [0.4, -0.35, 0.0], [0.4, 0.35, 0.0], [-0.4, 0.35, 0.0]])
"""Corners of the piece of still water around the AUV [m]."""


def draw_force(result: Result) -> Figure:
    """Draw buoyancy against submersion, slowly and in a drop."""
    slow = result.tables["force"]
    drop = result.tables["force_in_a_drop"]
    figure, (axes,) = new_figure(1, 1)
    dz = numbers(slow, "dz [m]")
    axes.plot(dz, numbers(slow, "rho g V, closed form [N]"), label="rho g V", **REFERENCE)
    for name in ("exact", "convex hull", "sections"):
        forces = numbers(slow, f"{name} [N]")
        axes.plot(dz, forces, color=COLOURS[name], lw=1, label=f"{name}, lowered slowly")

        # every fourth step of the drop
        drafts = numbers(drop, f"{name}, dz [m]")[::4]
        forces = numbers(drop, f"{name}, force [N]")[::4]
        label = f"{name}, in a drop of 5 s"
        axes.plot(drafts, forces, ".", ms=4, color=COLOURS[name], label=label)
    axes.set(
        xlabel="dz, immersion of the base [m]",
        ylabel="buoyancy [N]",
        xlim=(-0.05, 0.5),
        title="hourglass, upright",
    )
    finish(axes)
    return figure


def draw_distributed(result: Result) -> Figure:
    """Draw the AUV at rest in an oblique view, with the buoyancy of each of its meshes."""
    table = result.tables["distributed"]
    centroids = np.column_stack([numbers(table, f"{axis} [m]") for axis in "xyz"])
    forces = numbers(table, "force [N]")
    figure, (axes,) = new_figure(1, 1, width=9.0, height=6.5)

    # the vehicle and the sea
    rise = np.array([0.0, 0.0, centroids[0, 2] - solids.auv()[0].centroid[2]])
    for mesh in solids.auv():
        triangles = list((mesh.vertices + rise)[mesh.faces] @ _OBLIQUE)
        axes.add_collection(
            PolyCollection(triangles, facecolors="0.7", edgecolors="none", alpha=0.1)
        )
    axes.add_collection(PolyCollection([_SEA @ _OBLIQUE], facecolors=SKY, alpha=0.15))

    # the forces, the last of them that of all meshes
    scale = 0.25 / forces.max()
    *meshes, everything = zip(table["mesh"], centroids @ _OBLIQUE, forces, strict=True)
    for name, point, force in meshes:
        _draw_force(axes, point, force, scale, name, COLOURS["exact"], 1.5, 1.0)
    _, point, force = everything
    _draw_force(axes, point, force, scale, "all", VERMILLION, 4.0, 0.5)

    axes.set(
        xlim=(-0.55, 0.6),
        ylim=(-0.5, 0.25),
        aspect="equal",
        xlabel="x + 0.45 y [m]",
        ylabel="z + 0.3 y [m]",
    )
    axes.set_title(
        "buoyancy of the AUV's 15 meshes, and their resultant at the volume-weighted centroid"
    )
    return figure


def _draw_force(
    axes: Axes,
    point: NDArray[np.float64],
    force: float,
    scale: float,
    name: str,
    colour: str,
    width: float,
    alpha: float,
) -> None:
    """Draw an arrow upward from a point (2,), and name it beside its head unless it is small."""
    x, z = point
    head = (x, z + scale * force)
    arrow = {"arrowstyle": "-|>", "color": colour, "lw": width, "alpha": alpha, "mutation_scale": 8}
    axes.annotate("", head, (x, z), arrowprops=arrow)
    axes.plot(x, z, "o", ms=3, color=colour)
    if force > 10.0:
        style: dict[str, Any] = {"textcoords": "offset points", "fontsize": 8, "color": colour}
        axes.annotate(f"{name}: {force:.1f} N", head, (6, -3), **style)


def draw_rest(result: Result) -> Figure:
    """Draw the force less its mean at the end of a drop."""
    figure, all_axes = new_figure(1, 2, width=11.0)
    for axes, vehicle in zip(all_axes, ("hourglass", "AUV"), strict=True):
        table = result.tables[f"rest_{vehicle.lower()}"]
        time = numbers(table, "time before the end [s]")
        for method in ("convex hull", "sections", "exact"):
            forces = numbers(table, f"{method} [N]")
            label = f"{method}, standard deviation {forces.std():.2g} N"
            axes.plot(time, forces - forces.mean(), color=COLOURS[method], lw=1.2, label=label)
        axes.set(
            title=vehicle, xlabel="time before the end [s]", ylabel="buoyancy less its mean [N]"
        )
        axes.set_yscale("symlog", linthresh=0.5)
    finish(*all_axes)
    return figure
