"""Waves under the surface: mean pressure, the force on a fixed sphere, the drift of a free one."""

import math
from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.sea.water import Water
from buoyancy_mj.sea.waves import RegularWave
from buoyancy_mj.validation.case import Case, Row
from buoyancy_mj.validation.runs import build_body, follow, place

DENSITY = 1000.0
"""Density of the water [kg/m^3]."""
GRAVITY = 9.81
"""[m/s^2]."""


# the force on a fixed sphere

RADIUS = 1.0
"""Radius of the fixed sphere [m]."""
PLACES = ((0.2, 1.5), (0.2, 2.0), (0.15, 2.8))
"""Steepness k A of the waves, and depth k d of the centre, which is two radii."""


def _compare_force() -> Sequence[Row]:
    """Compare mean lift and oscillation of the force with linear theory and Bernoulli's equation.

    The mean of Bernoulli's pressure is -1/2 rho (omega A)^2 e^(2 k z). Its integral over a ball is
    rho omega^2 k A^2 e^(-2 k d) V 3 (q cosh q - sinh q) / q^3 with q = 2 k R.
    """
    rows = []
    for steepness, depth in PLACES:
        k = depth / (2.0 * RADIUS)
        amplitude, volume = steepness / k, 4.0 / 3.0 * math.pi * RADIUS**3
        q = 2.0 * k * RADIUS
        ball = 3.0 * (q * math.cosh(q) - math.sinh(q)) / q**3
        lift = GRAVITY * (k * amplitude * math.exp(-depth)) ** 2 * volume * ball
        size = GRAVITY * k * amplitude * math.exp(-depth) * volume

        # through a period
        forces = _sphere_forces(RegularWave(amplitude, wavelength=2.0 * math.pi / k), depth / k)
        mean = forces.mean(axis=0)
        sizes = np.hypot(*(forces - mean).T)
        at = f"at k A = {steepness:g}, k d = {depth:g}"
        rows += [
            Row(f"mean lift over Bernoulli's, {at}", 1.0, mean[1] / lift, 0.2),
            Row(f"oscillating force over linear theory's, {at}", 1.0, sizes.mean() / size, 0.04),
            Row(
                f"how much its size changes, {at}",
                0.0,
                (sizes.max() - sizes.min()) / (2.0 * sizes.mean()),
                0.04,
                absolute=True,
            ),
        ]
    return rows


def _sphere_forces(wave: RegularWave, depth: float) -> NDArray[np.float64]:
    """Force along the wave and upright, over the density, on a sphere at a depth, less its lift.

    At 24 times of a period: (24, 2) [m^4/s^2].
    """
    model = build_body(f'<geom type="sphere" size="{RADIUS}"/>', mass=1.0, inertia=(1, 1, 1))
    place(model, [0.0, 0.0, -depth])
    data = mujoco.MjData(model)
    waters = [Water(density=DENSITY, waves=waves) for waves in ((), wave)]
    still, moving = (
        Buoyancy(model, water, pressure="froude-krylov", damping=None) for water in waters
    )
    mujoco.mj_forward(model, data)
    lift = still.evaluate(data).total.force
    forces = []
    for data.time in np.arange(24) / 24 * wave.period:
        mujoco.mj_forward(model, data)
        forces.append(moving.evaluate(data).total.force - lift)
    return np.array(forces)[:, [0, 2]] / DENSITY


# the mean pressure


def _compare_mean() -> Sequence[Row]:
    """Compare the mean of the pressure at a place with Bernoulli's."""
    wave = RegularWave(1.0, period=8.0)
    times = np.linspace(0.0, wave.period, 48, endpoint=False)
    water = Water(density=DENSITY, waves=wave)
    mean = np.mean([water.pressure([0.0, 0.0, -5.0], t, GRAVITY) for t in times])
    less = float(mean) - DENSITY * GRAVITY * 5.0
    return [Row("mean pressure less still water's, 5 m deep [Pa]", -164.5, less, 0.05)]


# the drift of a free sphere


def _compare_drift() -> Sequence[Row]:
    """Compare the drift of neutral spheres with Stokes', and with none upward."""
    _, up = _drift(0.05, 1.2, 1.0)
    rows = [Row("rise in 60 s, A = 0.05 m, T = 1.2 s, 1 m deep [m]", 0.0, up, 0.02, absolute=True)]
    for depth in (2.0, 5.0):
        # P30: .04939 m/s at the surface, times e^(2 k z)
        stokes = 0.04939 * math.exp(-2.0 * 0.06288 * depth)
        along, _ = _drift(1.0, 8.0, depth)
        quantity = f"drift along the wave, A = 1 m, T = 8 s, {depth:g} m deep [m/s]"
        rows.append(Row(quantity, stokes, along, 0.2))
    return rows


def _drift(amplitude: float, period: float, depth: float) -> tuple[float, float]:
    """Mean velocity along the wave [m/s], and rise in 60 s [m], of a small neutral sphere.

    It begins with the velocity of the water, where the surface passes its still level downward.
    """
    radius, position = 0.05, [0.0, 0.0, -depth]
    wave = RegularWave(amplitude, period=period, phase=-math.pi / 2)
    water = Water(density=DENSITY, waves=wave)
    model = build_body(
        f'<geom type="sphere" size="{radius}"/>',
        mass=DENSITY * 4 / 3 * math.pi * radius**3,
        inertia=(1e-3, 1.1e-3, 1e-3),
    )
    place(model, position)

    def start(data: mujoco.MjData) -> None:
        data.qvel[:3] = water.velocity(position, 0.0)

    times, places = follow(
        model,
        water,
        60.0,
        read=lambda data: data.qpos[[0, 2]].copy(),
        start=start,
        pressure="froude-krylov",
        added_mass="estimate",
        damping=None,
    )

    # from the mean of the first period to that of the last whole one
    whole = math.floor(times[-1] / period)
    first = places[times < period].mean(axis=0)
    last = places[(times >= (whole - 1) * period) & (times < whole * period)].mean(axis=0)
    along, up = last - first
    return float(along / ((whole - 1) * period)), float(up)


CASES = (
    Case(
        "mean_pressure",
        "The mean pressure under waves",
        "Longuet-Higgins and Stewart 1964, *Radiation stresses in water waves*: -rho <w^2>, which "
        "is Bernoulli's -1/2 rho <u^2> in deep water",
        "Waves of 1 m amplitude and 8 s.",
        _compare_mean,
    ),
    Case(
        "deep_sphere",
        "Wave force on a fixed sphere under water",
        "Closed forms: the Froude-Krylov force of linear theory is the weight of the displaced "
        "water times k A e^(-kd), whatever the phase; the lift is Bernoulli's mean pressure, "
        "integrated",
        "A sphere of 1 m radius, its centre two radii under the still level.",
        _compare_force,
        loads=("buoyancy", "wave_pressure"),
    ),
    Case(
        "stokes_drift",
        "A neutral sphere drifts with the waves, and not up or down",
        "Stokes 1847: A^2 omega k e^(2kz); Longuet-Higgins 1953",
        "A sphere of 5 cm radius starts with the water's velocity, in the middle of its orbit, and "
        "moves for a minute without drag.",
        _compare_drift,
        loads=("buoyancy", "wave_pressure", "added_mass: estimated"),
    ),
)
"""In the order of the page."""
