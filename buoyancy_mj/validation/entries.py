"""Entries into water at constant speed: spheres by depth, wedges by deadrise."""

import functools
import math
from collections.abc import Sequence

import mujoco
import numpy as np
from matplotlib.figure import Figure

from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.plotting.style import new_figure
from buoyancy_mj.sea.water import Water
from buoyancy_mj.validation.case import Case, Row

DENSITY = 1000.0
"""Density of the water [kg/m^3]; the coefficients do not depend on it."""
SPHERE_COEFFICIENTS = {0.2: 0.96, 0.3: 0.94, 0.5: 0.77, 0.8: 0.44}
"""Slam coefficient F / (1/2 rho pi R^2 V^2) of a sphere without pile-up, by depth over radius."""
SPHERE_MASSES = {0.5: 0.6547, 1.0: 1.0472}
"""Added mass over rho R^3 of what is under the still level, by depth over radius."""
TOUCHES = {"without pile-up": 3.60, "with Wagner's pile-up": 6.62}
"""Slam coefficient of a sphere over the root of depth over radius, at first touch."""
WEDGE_FORCES = {10: 214.0, 20: 42.5, 30: 14.14, 40: 5.48}
"""Force on a wedge over rho V^3 t and length, by deadrise [degrees]: Zhao and Faltinsen."""
WAGNER = math.pi / 2.0
"""How much wider the wetted wedge is than it is at the still level, by Wagner."""


# spheres


@functools.cache
def sphere_force(depth: float) -> float:
    """Slam coefficient of a sphere of radius 1 m whose lowest point is at a depth [m]."""
    return _slam(_build('<geom type="sphere" size="1"/>', _sphere_mass(), top=1.0), depth) / (
        0.5 * DENSITY * math.pi
    )


@functools.cache
def sphere_added_mass(depth: float) -> float:
    """Added mass over rho of a sphere of radius 1 m whose lowest point is at a depth [m]."""
    model = _build('<geom type="sphere" size="1"/>', _sphere_mass(), top=1.0)
    data, buoyancy = _place(model, depth, 0.0)
    share = buoyancy.evaluate(data).total.volume / buoyancy.added_mass.volumes[0]
    return float(share) * _sphere_mass() / DENSITY


def _sphere_mass() -> float:
    """Added mass of a sphere of radius 1 m, fully wet [kg]: Lamb's half of what it displaces."""
    return 0.5 * DENSITY * 4.0 / 3.0 * math.pi


def _compare_sphere() -> Sequence[Row]:
    rows = [
        Row(f"slam coefficient at a depth of {depth:g} radii", published, sphere_force(depth), 0.1)
        for depth, published in SPHERE_COEFFICIENTS.items()
    ]
    rows += [
        Row(
            f"slam coefficient at 0.05 radii, {how}",
            root * math.sqrt(0.05),
            sphere_force(0.05),
            0.1,
        )
        for how, root in TOUCHES.items()
    ]
    rows += [
        Row(
            f"added mass over rho R^3 at {depth:g} radii", published, sphere_added_mass(depth), 0.02
        )
        for depth, published in SPHERE_MASSES.items()
    ]
    return rows


# wedges


@functools.cache
def wedge_force(deadrise: float, widening: float) -> float:
    """Force on a wedge over rho V^3 t and its length.

    Args:
        deadrise: angle [degrees] between its sides and the level.
        widening: of the wetted width by pile-up. The added mass is that of half a flat plate, as
            wide as the water then reaches (von Karman).
    """
    half, length = 1.0, 10.0
    height = half * math.tan(math.radians(deadrise))
    corners = [(0.0, 0.0), (half, height), (-half, height)]
    vertices = " ".join(f"{x} {y} {z}" for x in (-length / 2, length / 2) for y, z in corners)
    mass = 0.5 * DENSITY * math.pi * (widening * half) ** 2 * length
    model = _build('<geom type="mesh" mesh="wedge"/>', mass, 0.0, f'vertex="{vertices}"')

    # half in, at 1 m/s since the first touch
    depth = 0.5 * height
    return _slam(model, depth) / (DENSITY * depth * length)


def _compare_wedges() -> Sequence[Row]:
    rows = []
    for deadrise, published in WEDGE_FORCES.items():
        flat = math.pi / math.tan(math.radians(deadrise)) ** 2
        rows += [
            Row(
                f"force, deadrise {deadrise} deg, no pile-up (von Karman)",
                flat,
                wedge_force(deadrise, 1.0),
                0.01,
            ),
            Row(
                f"force, deadrise {deadrise} deg, pile-up given (Zhao and Faltinsen)",
                published,
                wedge_force(deadrise, WAGNER),
                0.2,
            ),
        ]
    return rows


def _draw_wedges() -> Figure:
    """Draw the force on wedges beside published values."""
    figure = new_figure(6.0, 4.0)
    axes = figure.subplots()
    angles = list(WEDGE_FORCES)
    axes.plot(angles, list(WEDGE_FORCES.values()), "k^", label="Zhao and Faltinsen")
    for widening, label in ((1.0, "here, no pile-up"), (WAGNER, "here, Wagner's pile-up given")):
        axes.plot(angles, [wedge_force(a, widening) for a in angles], "o-", label=label)
    axes.set(xlabel="deadrise [deg]", ylabel="force over rho V^3 t and length", yscale="log")
    axes.legend()
    return figure


# the run


def _build(geom: str, added_mass: float, top: float, mesh: str = "") -> mujoco.MjModel:
    """Build a heavy body 'b' whose origin is `top` [m] above its lowest point, without weight."""
    asset = f'<asset><mesh name="wedge" {mesh}/></asset>' if mesh else ""
    return mujoco.MjModel.from_xml_string(f"""
        <mujoco>
          <option timestep="0.001" gravity="0 0 0"/>
          <custom>
            <numeric name="added_mass:b" data="0 0 {added_mass!r} 0 0 0"/>
            <numeric name="top" data="{top!r}"/>
          </custom>
          {asset}
          <worldbody>
            <body name="b">
              <freejoint/>
              <inertial pos="0 0 1e-5" mass="1e6" diaginertia="1e6 1e6 1e6"/>
              {geom}
            </body>
          </worldbody>
        </mujoco>""")


def _place(model: mujoco.MjModel, depth: float, speed: float) -> tuple[mujoco.MjData, Buoyancy]:
    """The body with its lowest point at a depth [m], sinking at a speed [m/s], in water."""
    data = mujoco.MjData(model)
    data.qpos[2] = model.numeric("top").data[0] - depth
    data.qvel[2] = -speed
    mujoco.mj_forward(model, data)
    return data, Buoyancy(model, Water(density=DENSITY), damping=None, slamming=True)


def _slam(model: mujoco.MjModel, depth: float) -> float:
    """Force of added mass and slamming on a body [N] that sinks at 1 m/s."""
    data, buoyancy = _place(model, depth, 1.0)
    causes = buoyancy.evaluate(data).by_cause
    return float(np.sum([causes[cause][1, 2] for cause in ("added_mass", "slamming")]))


CASES = (
    Case(
        "sphere_entry",
        "A sphere that enters still water",
        "added mass of the lens of a sphere and its mirror image, exact, after von Karman 1929, "
        "*The impact on seaplane floats during landing*, NACA TN 321; with pile-up after Wagner "
        "1932, *Uber Stoss- und Gleitvorgange an der Oberflache von Flussigkeiten*, ZAMM 12",
        "The sphere sinks at constant speed, with `slamming` on. Its added mass is Lamb's, 2/3 pi "
        "rho R^3 fully wet, and scales with the wet share of its volume.",
        _compare_sphere,
        "Half wet the sphere has gathered the right mass. But a share by volume gathers it evenly, "
        "and a cap does so from its first touch on, as the third power of its wetted radius.",
        loads=("buoyancy", "added_mass", "slamming"),
    ),
    Case(
        "wedge_entry",
        "Wedges that enter still water",
        "Zhao and Faltinsen 1993, *Water entry of two-dimensional bodies*, J. Fluid Mech. 246; "
        "von Karman 1929, NACA TN 321",
        "Long wedges sink at constant speed, with `slamming` on. The added mass of each is given: "
        "that of half a flat plate as wide as the wedge at the still level, and then as wide as "
        "the water reaches by Wagner 1932, pi / 2 wider. Forces are over rho V^3 t and length.",
        _compare_wedges,
        "Wagner's width is that of flat wedges: with deadrise the water rises less, and pushes "
        "sideways as well.",
        _draw_wedges,
        ("buoyancy", "added_mass", "slamming"),
    ),
)
"""In the order of the page."""
