"""Bodies that fall through the water until their drag holds their weight."""

import math
from collections.abc import Sequence

import mujoco

from buoyancy_mj.sea.water import Water
from buoyancy_mj.validation.case import Case, Row
from buoyancy_mj.validation.runs import build_deep_body, follow, numeric

DURATION = 12.0
"""How long the bodies fall [s]."""
DENSITY = 1000.0
"""Density of the water [kg/m^3]."""
_DISK_AREA = math.pi * 0.01
"""Frontal area of the falling bodies [m^2]."""


def _fall(model: mujoco.MjModel) -> float:
    """Terminal speed [m/s] downward."""
    _, speeds = follow(model, Water(), DURATION, read=lambda data: float(data.qvel[2]))
    return -float(speeds[-1])


def _compare_estimate() -> Sequence[Row]:
    """Let a sphere and an ellipsoid fall with the drag that is estimated for them."""
    sphere = '<geom type="sphere" size=".1"/>'
    ellipsoid = '<geom type="ellipsoid" size=".1 .1 .2"/>'
    return [
        Row(
            "sphere of 20 cm and 6 kg, C_D 0.47 [m/s]",
            _terminal_speed(6.0, 4 / 3 * math.pi * 1e-3, 0.47),
            _fall(build_deep_body(sphere, 6.0)),
            0.1,
        ),
        Row(
            "ellipsoid of 40 x 20 cm and 10 kg, end on, C_D 0.27 [m/s]",
            _terminal_speed(10.0, 4 / 3 * math.pi * 2e-3, 0.27),
            _fall(build_deep_body(ellipsoid, 10.0)),
            0.1,
        ),
    ]


def _terminal_speed(mass: float, volume: float, drag_coefficient: float) -> float:
    """Terminal speed [m/s] of a body of a mass [kg], a volume [m^3] and a drag coefficient."""
    force = (mass - DENSITY * volume) * 9.81
    return math.sqrt(force / (0.5 * DENSITY * drag_coefficient * _DISK_AREA))


def _compare_engine() -> Sequence[Row]:
    """Let ellipsoids fall in MuJoCo's own fluid, and in this water with the same drag."""
    rows = []
    for name, size, mass, published in (
        ("sphere of 20 cm, 5 kg", (0.1, 0.1, 0.1), 5.0, 1.76709),
        ("ellipsoid .3 .2 .1, 40 kg, flat on", (0.3, 0.2, 0.1), 40.0, 2.04046),
        ("ellipsoid .3 .2 .1, 40 kg, end on", (0.1, 0.2, 0.3), 40.0, 2.49905),
    ):
        a, b, c = size
        geom = f'<geom type="ellipsoid" size="{a} {b} {c}" fluidshape="ellipsoid"/>'
        speed = _fall_in_engine(build_deep_body(geom, mass))
        rows.append(Row(f"the engine's own fluid, {name} [m/s]", published, speed, 1e-5))

        # in the water, as much heavier as it is buoyant
        damping = numeric("quadratic_damping", [0, 0, _engine_damping(a, b, c), 0, 0, 0])
        volume = 4 / 3 * math.pi * a * b * c
        model = build_deep_body(geom, mass + DENSITY * volume, damping)
        rows.append(Row(f"its coefficients here, {name} [m/s]", published, _fall(model), 1e-3))
    return rows


def _fall_in_engine(model: mujoco.MjModel) -> float:
    """Terminal speed [m/s] downward in the engine's own fluid."""
    model.opt.density = DENSITY
    data = mujoco.MjData(model)
    while data.time < DURATION:
        mujoco.mj_step(model, data)
    return -float(data.qvel[2])


def _engine_damping(a: float, b: float, c: float) -> float:
    """Quadratic damping [N s^2/m^2] along z of an ellipsoid in MuJoCo's ellipsoid model.

    Its default coefficients are 0.5 of the projected area (blunt), and 0.25 of the difference
    between that and the largest (slender).
    """
    projected = math.pi * a * b
    largest = math.pi * max(a * b, b * c, a * c)
    return DENSITY * (0.5 * projected + 0.25 * (largest - projected))


CASES = (
    Case(
        "terminal_speeds",
        "Terminal speeds by the estimate of drag",
        "the measured coefficients of White's table 7.3",
        f"The bodies are released at 100 m depth and fall for {DURATION:g} s.",
        _compare_estimate,
        loads=("buoyancy", "drag: estimated"),
    ),
    Case(
        "engine_fluid",
        "MuJoCo's own fluid",
        "MuJoCo 4.0.0, its ellipsoid model, which has drag and no buoyancy: terminal speeds "
        "computed with it",
        "The first row of each body is the engine alone. The second is this water, with the "
        "engine's drag set in the model, and the body as much heavier as it is buoyant.",
        _compare_engine,
        loads=("buoyancy", "drag: as the model states it"),
    ),
)
"""In the order of the page."""
