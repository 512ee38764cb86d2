"""Foils: sections over the full circle, plates and wings of finite span, and a glider."""

import math
from collections.abc import Sequence

import mujoco

from buoyancy_mj.loads.foils import Foil
from buoyancy_mj.sea.water import Water
from buoyancy_mj.validation.case import Case, Row
from buoyancy_mj.validation.runs import follow

NACA_0015 = {
    10: (0.832, 0.023),
    20: (0.458, 0.282),
    45: (1.05, 1.075),
    90: (0.09, 1.80),
    135: (-0.93, 1.085),
    170: (-0.85, 0.14),
}
"""Lift and drag coefficient by angle of attack [degrees], Sheldahl and Klimas, at Re 160,000."""
PLATE = {3: (0.15, 0.02), 6: (0.30, 0.03), 10: (0.50, 0.08), 15: (0.70, 0.18), 20: (0.75, 0.28)}
"""Lift and drag coefficient by angle of attack [degrees], Pelletier and Mueller, at Re 140,000."""
GLIDE, SPEED, LIFT, DRAG_AT_ZERO, DRAG_BY_LIFT = math.radians(-25.0), 0.3, 132.5, 2.15, 25.0
"""Slope of the glide [rad], speed [m/s], and lift and drag of Graver's glider over the square of
the speed: lift per angle [kg/(m rad)], drag [kg/m], and drag per angle squared [kg/(m rad^2)]."""
_AREA, _SPAN = 0.05, 0.75
"""Wing of the glider [m^2], [m]: any that has its polar will do."""


def _compare_section() -> Sequence[Row]:
    """Lift and drag of a section in plane flow, from all sides."""
    foil = Foil(walls=2, thickness=0.15, stall=10.0, drag=0.013)
    return _compare_polar(foil, NACA_0015, tolerance=0.15)


def _compare_plate() -> Sequence[Row]:
    """Lift and drag of a flat plate of aspect ratio 2."""
    foil = Foil(aspect=2.0, thickness=0.02, stall=18.0, suction=0.0, drag=0.015)
    return _compare_polar(foil, PLATE, tolerance=0.1)


def _compare_polar(
    foil: Foil, published: dict[int, tuple[float, float]], tolerance: float
) -> list[Row]:
    """A row for the lift and one for the drag at each angle."""
    rows = []
    for angle, (lift, drag) in published.items():
        found = foil.coefficients(math.radians(angle))[0]
        rows.append(Row(f"C_L at {angle} degrees", lift, float(found[0]), tolerance, absolute=True))
        rows.append(Row(f"C_D at {angle} degrees", drag, float(found[1]), tolerance, absolute=True))
    return rows


def _compare_slopes() -> Sequence[Row]:
    """Lift by the span of a foil."""
    fins = Foil(aspect=2.21, lift_slope=0.9 * 2.0 * math.pi)
    wing = Foil(aspect=6.366, crossflow=0.0).coefficients(math.radians(5.71))[0]
    return [
        Row("fins of the REMUS 100, lift slope [1/rad]", 3.117, _slope(fins), 0.2),
        Row("elliptic wing, C_L at 5.71 degrees", 0.4765, float(wing[0]), 0.05),
    ]


def _slope(foil: Foil) -> float:
    """Lift slope at zero lift [1/rad]."""
    angle = 1e-5
    low, high = foil.coefficients([-angle, angle])[:, 0]
    return float(high - low) / (2.0 * angle)


def equilibrium_glide(slope: float) -> tuple[float, float]:
    """Angle of attack [rad] and net mass [kg] of the glider at `SPEED`, by the slope [rad].

    Leonard and Graver (2001): drag over lift is minus the tangent of the slope, so that the angle
    is the root of K_D a^2 + K_L tan(x) a + K_D0 = 0 that is nearer to 0; and the net weight holds
    lift and drag.
    """
    tangent = math.tan(slope)
    root = math.sqrt(1.0 - 4.0 * DRAG_BY_LIFT * DRAG_AT_ZERO / (LIFT * tangent) ** 2)
    angle = LIFT * tangent / (2.0 * DRAG_BY_LIFT) * (-1.0 + root)
    drag = DRAG_AT_ZERO + DRAG_BY_LIFT * angle**2
    weight = (drag * -math.sin(slope) + LIFT * angle * math.cos(slope)) * SPEED**2
    return angle, weight / 9.81


def _glide() -> Sequence[Row]:
    """Let the glider sink at a pitch until its speed is steady."""
    angle, mass = equilibrium_glide(GLIDE)
    model = _build_glider(mass, pitch=GLIDE + angle)

    def read(index: int) -> float:
        _, speeds = follow(
            model, Water(), 40.0, read=lambda data: float(data.qvel[index]), damping=None
        )
        return float(speeds[-1])

    forward, up = read(0), read(1)
    return [
        Row(
            "angle of attack at a glide of -25 degrees [degrees]", 2.023, math.degrees(angle), 1e-3
        ),
        Row("net mass at 0.3 m/s [kg]", 0.04735, mass, 1e-3),
        Row(
            "slope of the glide, run [degrees]", -25.0, math.degrees(math.atan2(up, forward)), 0.01
        ),
        Row("speed of the glide, run [m/s]", 0.3, math.hypot(forward, up), 0.01),
    ]


def _build_glider(mass: float, pitch: float) -> mujoco.MjModel:
    """Build a glider that slides ahead and down at a pitch [rad], with a wing of its polar.

    Args:
        mass: by which it is heavier than its water [kg].
        pitch: nose up [rad].
    """
    slope = LIFT / (500.0 * _AREA)
    aspect = _SPAN**2 / _AREA
    # the section whose slope on that span is this, and Oswald's e
    inverse = 1.0 / aspect
    section = slope * math.sqrt(1.0 + 4.0 * inverse**2) / (1.0 - slope * inverse / math.pi)
    efficiency = slope**2 * inverse * 500.0 * _AREA / (math.pi * DRAG_BY_LIFT)
    words = (
        f"lift_slope={section!r} efficiency={efficiency!r} drag={DRAG_AT_ZERO / (500.0 * _AREA)!r} "
        "crossflow=0"
    )
    turn = f"{math.cos(0.5 * pitch)!r} 0 {-math.sin(0.5 * pitch)!r} 0"
    radius = 0.1
    volume = 4.0 / 3.0 * math.pi * radius**3
    return mujoco.MjModel.from_xml_string(f"""
        <mujoco>
          <option timestep="0.02" integrator="RK4"/>
          <custom><text name="foil:wing" data="{words}"/></custom>
          <worldbody>
            <body pos="0 0 -100" name="b">
              <joint type="slide" axis="1 0 0"/>
              <joint type="slide" axis="0 0 1"/>
              <geom type="sphere" size="{radius}" mass="{1000.0 * volume + mass!r}"/>
              <site name="wing" type="box" quat="{turn}"
                    size="{0.5 * _AREA / _SPAN!r} {0.5 * _SPAN!r} .002"/>
            </body>
          </worldbody>
        </mujoco>""")


CASES = (
    Case(
        "naca_0015",
        "A NACA 0015 over the full circle",
        "Sheldahl and Klimas 1981, *Aerodynamic Characteristics of Seven Symmetrical Airfoil "
        "Sections Through 180-Degree Angle of Attack*, SAND80-2114, at a Reynolds number of "
        "160,000",
        "A foil between two walls, 15 % thick. That it stalls at 10 degrees and has a drag of "
        "0.013 is stated, as the measured section does.",
        _compare_section,
        "Past its stall the section has less lift than the plate that it is taken for, which does "
        "not last: at 45 degrees the two are alike.",
    ),
    Case(
        "flat_plate",
        "A flat plate of aspect ratio 2",
        "Pelletier and Mueller 2000, *J. Aircraft* 37, 825, a plate of semi-aspect ratio 1 on a "
        "wall, at a Reynolds number of 140,000",
        "A foil with sharp edges, without suction. That it stalls at 18 degrees and has a drag of "
        "0.015 is stated.",
        _compare_plate,
    ),
    Case(
        "finite_span",
        "Lift of finite span",
        "Prestero 2001, MIT, for the fins of the REMUS 100, by Hoerner's formula with an effective "
        "aspect ratio of 2.21 and 0.9 times the slope of thin aerofoil theory; and Prandtl's "
        "lifting line for the elliptic wing",
        "The slope is that of the polar at zero lift, with the same section and aspect ratio. "
        "The formula here is Whicker and Fehlner's for rudders, lower where the span is short.",
        _compare_slopes,
    ),
    Case(
        "glider",
        "The equilibrium glide of an underwater glider",
        "Leonard and Graver 2001, *IEEE J. Oceanic Eng.* 26, 633, and Graver 2005, Princeton: the "
        "formula, with K_L 132.5, K_D0 2.15 and K_D 25",
        "A body with a wing of that polar slides ahead and down at the pitch of the formula, from "
        "rest, for 40 s. It is heavier than its water by the net mass.",
        _glide,
        loads=("buoyancy", "foil"),
    ),
)
"""In the order of the page."""
