"""Waves on a current: their lengths, what is blocked, and a body that drifts along."""

import math
from collections.abc import Callable, Sequence

import mujoco
import numpy as np

from buoyancy_mj.sea.currents import CurrentProfile, effective_current
from buoyancy_mj.sea.dispersion import GRAVITY, Dispersion, wavenumber
from buoyancy_mj.sea.water import Water
from buoyancy_mj.sea.waves import RegularWave
from buoyancy_mj.validation.case import Case, Row
from buoyancy_mj.validation.runs import build_body, follow, place
from buoyancy_mj.validation.signals import amplitude

# lengths, and what is blocked

OMEGA = 2.0 * math.pi / 8.0
"""Angular frequency of the waves, as seen at rest [rad/s]."""


def _compare_lengths() -> Sequence[Row]:
    """Compare wavenumbers, the shortest periods that run, and the mean of a profile."""
    rows = []
    for current, published in ((-2.0, 0.098300), (-1.0, 0.075561), (1.0, 0.054462)):
        quantity = f"wavenumber of 8 s in deep water, current {current:+g} m/s [rad/m]"
        rows.append(Row(quantity, published, wavenumber(OMEGA, current=current), 2e-5))

    # the shortest period that runs
    for current, depth, published in ((-3.1226, math.inf, 8.0), (-0.5, 0.5, 1.2811)):
        water = "deep water" if math.isinf(depth) else f"{depth:g} m of water"
        dispersion = Dispersion((current, 0.0, 0.0), depth, GRAVITY, (OMEGA, 2.0 * OMEGA))
        shortest = 2.0 * math.pi / dispersion.highest_frequency(0.0)
        quantity = f"shortest period against {-current:g} m/s in {water} [s]"
        rows.append(Row(quantity, published, shortest, 1e-4))

    # U = 1 + z / h
    profile = CurrentProfile((0.0, 1.0), ((1.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
    for kh, published in ((2.0, 0.75899), (5.0, 0.90001)):
        felt = float(effective_current(profile, np.array([kh]), 1.0)[0, 0])
        quantity = f"current that a wave feels in a linear profile, over U(0), kh = {kh:g}"
        rows.append(Row(quantity, published, felt, 2e-5))
    return rows


# the orbit of a neutral sphere that drifts along

POSITION = (0.0, 0.0, -1.0)
"""Where the sphere starts [m]."""
RADIUS = 0.05
"""Radius of the sphere [m]."""
HEIGHT = 0.002
"""Amplitude of the waves [m]."""


def _compare_drifter() -> Sequence[Row]:
    """Compare the orbit of a sphere that drifts with the current with that of the water."""
    return [
        Row(
            f"its orbit over the water's, {name}, current {speed:+g} m/s",
            1.0,
            _orbit_ratio(speed, read),
            0.02,
        )
        for speed in (1.0, -0.6)
        for name, read in (
            ("along the wave", lambda data: float(data.qpos[0])),
            ("upright", lambda data: float(data.qpos[2])),
        )
    ]


def _orbit_ratio(speed: float, read: Callable[[mujoco.MjData], float]) -> float:
    """Amplitude of a neutral sphere in waves of 2.5 s on a current, over that of the water."""
    water = Water(waves=RegularWave(HEIGHT, period=2.5), current=(speed, 0.0, 0.0))
    _, k, _, omega, *_ = water.rows[0]
    # as who drifts along sees it
    sigma = omega - k * speed
    model = build_body(
        f'<geom type="sphere" size="{RADIUS}"/>',
        mass=water.density * 4 / 3 * math.pi * RADIUS**3,
        inertia=(1e-3, 1.1e-3, 1e-3),
    )
    place(model, POSITION)
    velocity = water.velocity(POSITION, 0.0)

    # it starts with the water's velocity
    def start(data: mujoco.MjData) -> None:
        data.qvel[:3] = velocity

    times, values = follow(
        model,
        water,
        2 * math.pi / sigma,
        read=read,
        start=start,
        pressure="froude-krylov",
        added_mass="estimate",
        damping=None,
    )
    return amplitude(times, values, sigma) / (HEIGHT * math.exp(k * POSITION[2]))


CASES = (
    Case(
        "waves_on_current",
        "Lengths of waves on a current",
        "Peregrine 1976, *Interaction of water waves and currents*: (omega - kU)^2 = gk tanh kh; "
        "Kirby and Chen 1989, *Surface waves on vertically sheared flows*",
        "Wavenumbers are solved for the frequency that an observer at rest sees, and compared with "
        "the roots of the quadratic equation of deep water. A current blocks what would need a "
        "group velocity below zero.",
        _compare_lengths,
    ),
    Case(
        "drifting_sphere",
        "A neutral sphere that drifts with a current follows the water's orbit",
        "Galilei: who drifts along sees still water, with waves of the frequency omega - kU",
        "A sphere of 5 cm radius starts with the water's velocity, 1 m under waves of 2 mm "
        "amplitude and 2.5 s, and moves for a period without drag.",
        _compare_drifter,
        loads=("buoyancy", "wave_pressure", "added_mass: estimated"),
    ),
)
"""In the order of the page."""
