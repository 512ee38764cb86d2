"""Drag and added mass of simple bodies: the estimates beside published tables."""

import functools
import math
from collections.abc import Sequence
from typing import NamedTuple

import mujoco
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from buoyancy_mj.hulls.geoms import find_hulls
from buoyancy_mj.loads.added_mass_estimates import estimate_added_mass
from buoyancy_mj.loads.damping import Damping
from buoyancy_mj.loads.damping_arrays import resolve_damping
from buoyancy_mj.plotting.style import new_figure
from buoyancy_mj.validation.case import Case, Row
from buoyancy_mj.validation.runs import build_body

DENSITY = 1000.0
"""Density of the water [kg/m^3]; the coefficients do not depend on it."""


class Body(NamedTuple):
    """A body of a table."""

    geom: str
    """MJCF of the geom."""
    axis: int
    """Axis of the flow or motion, 0, 1 or 2; 3, 4 and 5 turn about them."""
    reference: float
    """Frontal area [m^2] of a drag coefficient; of an added mass coefficient what the density is
    multiplied by, mostly a volume [m^3]."""
    coefficient: float
    """The published coefficient."""


def _box(x: float, y: float, z: float) -> str:
    return f'<geom type="box" size="{x} {y} {z}"/>'


def _plate(half_length: float) -> str:
    return _box(0.1, half_length, 1e-4)


def _cylinder(half_length: float) -> str:
    return f'<geom type="cylinder" size=".1 {half_length}"/>'


def _ellipsoid(length: float) -> str:
    return f'<geom type="ellipsoid" size="{length} .1 .1"/>'


_SPHERE = '<geom type="sphere" size=".1"/>'
_DISK_AREA = math.pi * 0.01
_BALL_VOLUME = 4 / 3 * math.pi * 1e-3

DRAG_COEFFICIENTS = {
    "cube, face on": Body(_box(0.1, 0.1, 0.1), 0, 0.04, 1.07),
    "square plate across the flow": Body(_box(0.1, 0.1, 0.002), 2, 0.04, 1.18),
    "disk across the flow": Body(_cylinder(0.002), 2, _DISK_AREA, 1.17),
    "cylinder along the flow, as long as wide": Body(_cylinder(0.1), 2, _DISK_AREA, 0.90),
    "cylinder along the flow, half as long": Body(_cylinder(0.05), 2, _DISK_AREA, 1.1),
    "cylinder along the flow, 2 times as long": Body(_cylinder(0.2), 2, _DISK_AREA, 0.85),
    "cylinder along the flow, 4 times as long": Body(_cylinder(0.4), 2, _DISK_AREA, 0.87),
    "cylinder along the flow, 7 times as long": Body(_cylinder(0.7), 2, _DISK_AREA, 0.99),
    "cylinder across the flow, as long as wide": Body(_cylinder(0.1), 0, 0.04, 0.64),
    "cylinder across the flow, 2 times as long": Body(_cylinder(0.2), 0, 0.08, 0.68),
    "cylinder across the flow, 5 times as long": Body(_cylinder(0.5), 0, 0.2, 0.74),
    "cylinder across the flow, 10 times as long": Body(_cylinder(1.0), 0, 0.4, 0.82),
    "sphere, laminar": Body(_SPHERE, 0, _DISK_AREA, 0.47),
    "ellipsoid along the flow, 2 times as long as wide, laminar": Body(
        _ellipsoid(0.2), 0, _DISK_AREA, 0.27
    ),
    "ellipsoid along the flow, 4 times as long, laminar": Body(
        _ellipsoid(0.4), 0, _DISK_AREA, 0.25
    ),
}
"""Measured at Reynolds numbers from 1e4: White's table 7.3, but for cylinders along the flow half
as long as wide (Munson) and 2 and 7 times as long (Matthews)."""

ADDED_MASS_COEFFICIENTS = {
    "cube": Body(_box(0.1, 0.1, 0.1), 2, 8e-3, 0.6383),
    "square prism along its axis, 2 times as long as wide": Body(
        _box(0.1, 0.1, 0.2), 2, 16e-3, 0.335
    ),
    "square prism along its axis, 4 times as long": Body(_box(0.1, 0.1, 0.4), 2, 32e-3, 0.173),
    "square prism along its axis, 5 times as long": Body(_box(0.1, 0.1, 0.5), 2, 40e-3, 0.140),
    "square prism along its axis, 10 times as long": Body(_box(0.1, 0.1, 1.0), 2, 80e-3, 0.0711),
    "square prism across its axis, 2 times as long": Body(_box(0.1, 0.1, 0.2), 0, 16e-3, 0.833),
    "square prism across its axis, 4 times as long": Body(_box(0.1, 0.1, 0.4), 0, 32e-3, 0.984),
    "square prism across its axis, 5 times as long": Body(_box(0.1, 0.1, 0.5), 0, 40e-3, 1.020),
    "cube about its centre, over a^5": Body(_box(0.1, 0.1, 0.1), 5, 32e-5, 0.0392),
    "square plate across the flow": Body(_plate(0.1), 2, math.pi * 2e-3, 0.579),
    "rectangular plate across the flow, 2 times as long as wide": Body(
        _plate(0.2), 2, math.pi * 4e-3, 0.757
    ),
    "rectangular plate across the flow, 8 times as long": Body(
        _plate(0.8), 2, math.pi * 16e-3, 0.934
    ),
    "disc across the flow, over r^3": Body(_cylinder(0.0001), 2, 1e-3, 8 / 3),
    "cylinder across its axis, 1.2 times as long as wide": Body(
        _cylinder(0.12), 0, 0.24 * _DISK_AREA, 0.62
    ),
    "cylinder across its axis, 2.5 times as long": Body(_cylinder(0.25), 0, 0.5 * _DISK_AREA, 0.78),
    "cylinder across its axis, 5 times as long": Body(_cylinder(0.5), 0, 1.0 * _DISK_AREA, 0.90),
    "cylinder across its axis, 9 times as long": Body(_cylinder(0.9), 0, 1.8 * _DISK_AREA, 0.96),
    "spheroid along its axis, 2 times as long as wide": Body(
        _ellipsoid(0.2), 0, 2 * _BALL_VOLUME, 0.21
    ),
    "spheroid along its axis, 5 times as long": Body(_ellipsoid(0.5), 0, 5 * _BALL_VOLUME, 0.059),
    "spheroid across its axis, 2 times as long": Body(_ellipsoid(0.2), 2, 2 * _BALL_VOLUME, 0.702),
    "sphere": Body(_SPHERE, 0, _BALL_VOLUME, 0.5),
}
"""In potential flow. The cube: Sihvola et al. 2004, *IEEE Trans. Antennas Propag.* 52, 2226, whose
polarizability for a permittivity of 0, -1.6383, is minus one minus this. Prisms, and the cube that
turns: Capytaine 3.0 with its `free_surface` at infinity, on panels graded towards the edges,
extrapolated. The disc: Lamb 1932, art. 102. All others: DNV-RP-C205, table D-2.
"""


@functools.cache
def estimate_drag_coefficients() -> dict[str, float]:
    """Estimate the drag coefficients of the bodies of `DRAG_COEFFICIENTS`, by name."""
    estimates = {}
    for name, body in DRAG_COEFFICIENTS.items():
        model = _build(body)
        damping = resolve_damping(Damping(), model, find_hulls(model), DENSITY)
        unit = 0.5 * DENSITY * body.reference
        estimates[name] = float(damping.quadratic[0, body.axis] / unit)
    return estimates


@functools.cache
def estimate_added_mass_coefficients() -> dict[str, float]:
    """Estimate the added mass coefficients of the bodies of `ADDED_MASS_COEFFICIENTS`, by name."""
    estimates = {}
    for name, body in ADDED_MASS_COEFFICIENTS.items():
        added_mass = estimate_added_mass(find_hulls(_build(body)), DENSITY).matrix
        estimates[name] = float(added_mass[body.axis, body.axis] / (DENSITY * body.reference))
    return estimates


def _build(body: Body) -> mujoco.MjModel:
    return build_body(body.geom, mass=1.0, inertia=(0.1, 0.1, 0.1))


def _compare_drag() -> Sequence[Row]:
    return [
        Row(f"C_D, {name}", DRAG_COEFFICIENTS[name].coefficient, estimate, 0.2)
        for name, estimate in estimate_drag_coefficients().items()
    ]


def _compare_added_mass() -> Sequence[Row]:
    return [
        Row(f"C_A, {name}", ADDED_MASS_COEFFICIENTS[name].coefficient, estimate, 0.03)
        for name, estimate in estimate_added_mass_coefficients().items()
    ]


def _draw() -> Figure:
    """Draw estimates against published coefficients of both tables."""
    figure = new_figure(9.0, 4.0)
    left, right = figure.subplots(1, 2)
    _draw_table(left, "C_D", DRAG_COEFFICIENTS, estimate_drag_coefficients())
    _draw_table(right, "C_A", ADDED_MASS_COEFFICIENTS, estimate_added_mass_coefficients())
    return figure


def _draw_table(
    axes: Axes, label: str, table: dict[str, Body], estimates: dict[str, float]
) -> None:
    """Draw estimates against published coefficients, and the line on which they agree."""
    published = [table[name].coefficient for name in estimates]
    axes.plot(published, list(estimates.values()), "o")
    top = 1.1 * max(*published, *estimates.values())
    axes.plot([0.0, top], [0.0, top], "k-", linewidth=1.0)
    axes.set(
        xlabel=f"{label} published",
        ylabel=f"{label} estimated here",
        xlim=(0.0, top),
        ylim=(0.0, top),
    )


CASES = (
    Case(
        "drag_table",
        "Measured drag coefficients of simple bodies, and the estimate",
        "White, *Fluid Mechanics*, 8th ed., table 7.3, after Hoerner 1965, *Fluid-Dynamic Drag*; "
        "cylinders along the flow half as long as wide by Munson et al., *Fundamentals of Fluid "
        "Mechanics*, 6th ed., fig. 9.20, and 2 and 7 times as long by Matthews, *Aeronautical "
        "Engineer's Data Book*, fig. 5.13",
        "`Silhouette()` estimates the coefficients from silhouettes and sides of each body.",
        _compare_drag,
        draw=_draw,
    ),
    Case(
        "added_mass_table",
        "Added mass of simple bodies in unbounded water, and the estimate",
        "potential flow: Sihvola et al. 2004 (cube), Capytaine on graded panels (prisms), Lamb "
        "1932 (disc), DNV-RP-C205, appendix D, table D-2 (plates, cylinders, spheroids)",
        '`added_mass="estimate"` solves the flow around each mesh by boundary elements. The table '
        "of DNV-RP-C205 has 0.68, 0.36, 0.19, 0.15 and 0.08 for the cube and the prisms along "
        "their axis, 6 to 13 % more than potential flow.",
        _compare_added_mass,
    ),
)
"""In the order of the page."""
