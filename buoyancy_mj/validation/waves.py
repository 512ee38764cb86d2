"""Small bodies in waves: the force on a fixed one, and the motion of free ones."""

import math
from collections.abc import Callable, Sequence

import mujoco
import numpy as np
from scipy.special import h1vp

from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.sea.water import Water
from buoyancy_mj.sea.waves import RegularWave
from buoyancy_mj.validation.case import Case, Row
from buoyancy_mj.validation.runs import build_body, follow, numeric, place
from buoyancy_mj.validation.signals import amplitude

DENSITY = 1000.0
"""Density of the water [kg/m^3]."""


# the force on a fixed cylinder

RADIUS = 1.0
"""Radius a of the cylinder [m]."""
DEPTH = 0.5
"""Depth h of the water around it [m]."""
WAVENUMBERS = (0.05, 0.1, 0.2, 0.3, 0.5)
"""Wavenumbers times the radius, k a."""


def _compare_cylinder() -> Sequence[Row]:
    """Compare the force with diffraction theory, over rho g A a^2."""
    rows = []
    for ka in WAVENUMBERS:
        # MacCamy and Fuchs: 4 rho g A / k^2 tanh(kh) / |H1'(ka)|
        published = 4.0 / ka**2 * math.tanh(ka * DEPTH) / abs(h1vp(1, ka))
        quantity = f"force over rho g A a^2 at ka = {ka:g}"
        rows.append(Row(quantity, float(published), _cylinder_force(ka), 0.05))
    return rows


def _cylinder_force(ka: float) -> float:
    """Amplitude of the force on a fixed cylinder from the bottom up, over rho g A a^2."""
    height = 1e-3
    wave = RegularWave(height, wavelength=2 * math.pi * RADIUS / ka, depth=DEPTH)

    # the added mass of a disk is pi rho a^2 a metre; a quarter of the body is in the water
    added_mass = DENSITY * math.pi * RADIUS**2 * 2.0
    model = build_body(
        f'<geom type="cylinder" size="{RADIUS} 1" pos="0 0 {1.0 - DEPTH}"/>',
        mass=1.0,
        inertia=(1, 1, 1),
        joint='<joint type="slide" axis="1 0 0"/>',
        custom=numeric("added_mass", [added_mass, 0, 0, 0, 0, 0]),
    )

    # the force through a period, at rest
    buoyancy = Buoyancy(model, Water(waves=wave), pressure="froude-krylov", damping=None)
    data = mujoco.MjData(model)
    times = np.linspace(0.0, wave.period, 25)
    forces = []
    for data.time in times:
        mujoco.mj_forward(model, data)
        forces.append(buoyancy.evaluate(data).total.force[0])
    force = amplitude(times, np.array(forces), 2 * math.pi / wave.period)
    return force / (DENSITY * 9.81 * height * RADIUS**2)


# the orbit of a neutral sphere


def _compare_orbit() -> Sequence[Row]:
    """Compare the orbit of a small neutral sphere with that of the water at its depth."""
    radius = 0.002 * math.exp(-2 * math.pi / 6.0)
    along = _orbit_amplitude(lambda data: float(data.qpos[0]))
    upright = _orbit_amplitude(lambda data: float(data.qpos[2]))
    return [
        Row("its orbit over the water's, along the wave", 1.0, along / radius, 0.02),
        Row("its orbit over the water's, upright", 1.0, upright / radius, 0.02),
    ]


def _orbit_amplitude(read: Callable[[mujoco.MjData], float]) -> float:
    """Amplitude [m] of a small neutral sphere, 1 m deep in a wave of 2 mm and 6 m."""
    radius = 0.05
    position = [0.0, 0.0, -1.0]
    wave = RegularWave(0.002, wavelength=6.0)
    model = build_body(
        f'<geom type="sphere" size="{radius}"/>',
        mass=DENSITY * 4 / 3 * math.pi * radius**3,
        inertia=(1e-3, 1.1e-3, 1e-3),
    )
    place(model, position)
    velocity = Water(waves=wave).velocity(position, 0.0)

    # it starts with the water's velocity
    def start(data: mujoco.MjData) -> None:
        data.qvel[:3] = velocity

    times, values = follow(
        model,
        Water(waves=wave),
        wave.period,
        read=read,
        start=start,
        pressure="froude-krylov",
        added_mass="estimate",
        damping=None,
    )
    return amplitude(times, values, 2 * math.pi / wave.period)


# the heave of a float in long waves


def _compare_float() -> Sequence[Row]:
    """Compare the heave of a float with the limits of long waves, by model of pressure."""
    archimedes = "Archimedes' force, T = 10 T_n: 1 / (1 - k d)"
    rows = [Row(archimedes, 1.0101, _heave_response("archimedes", 10.0), 0.005)]
    for ratio in (5.0, 10.0):
        quantity = f"Froude-Krylov, T = {ratio:g} T_n: follows the surface"
        rows.append(Row(quantity, 1.0, _heave_response("froude-krylov", ratio), 0.01))
    return rows


def _heave_response(pressure: str, ratio: float) -> float:
    """Heave over wave amplitude of a small wall-sided float.

    Args:
        pressure: the model of wave pressure.
        ratio: of the wave's period to the natural period of the float.
    """
    draft = 0.1
    natural_period = 2 * math.pi * math.sqrt(draft / 9.81)
    wave = RegularWave(0.005, period=ratio * natural_period)
    model = build_body(
        f'<geom type="box" size=".1 .1 {draft}"/>',
        mass=DENSITY * 0.04 * draft,
        inertia=(0.1, 0.1, 0.1),
        joint='<joint type="slide" axis="0 0 1"/>',
        custom=numeric("radiation_damping", [6.0, 0, 0]),
    )
    times, heights = follow(
        model,
        Water(waves=wave),
        60.0 * natural_period,
        read=lambda data: float(data.qpos[0]),
        pressure=pressure,
        added_mass="none",
    )
    settled = times > 30.0 * natural_period
    return amplitude(times[settled], heights[settled], 2 * math.pi / wave.period) / 0.005


CASES = (
    Case(
        "fixed_cylinder",
        "Wave force on a fixed vertical cylinder",
        "MacCamy and Fuchs 1954, *Wave forces on piles: a diffraction theory*, which experiments "
        "confirm (Chakrabarti and Tam 1975)",
        "A cylinder of 1 m radius stands on the bottom in 0.5 m of water. The force is the "
        "Froude-Krylov force, plus the water's acceleration times the added mass of a disk, whose "
        "coefficient is 1.",
        _compare_cylinder,
        "A constant added mass knows no scattered waves.",
        loads=("buoyancy", "wave_pressure", "added_mass"),
    ),
    Case(
        "small_sphere",
        "A small neutral sphere follows the water's orbit",
        "Kelvin: the water exerts (1 + C_A) rho V a, and the inertia of the sphere with its added "
        "mass is the same",
        "A sphere of 5 cm radius starts with the water's velocity, 1 m under waves of 2 mm "
        "amplitude and 6 m length, and moves for a period without drag.",
        _compare_orbit,
        loads=("buoyancy", "wave_pressure", "added_mass: estimated"),
    ),
    Case(
        "long_waves",
        "A float in long waves",
        "Newman 1977, *Marine Hydrodynamics*, ch. 6; in deep water k d = (T_n / T)^2",
        "A wall-sided float of 10 cm draft only heaves, with a little damping, in waves of 5 mm "
        "amplitude.",
        _compare_float,
        loads=(
            "buoyancy",
            "wave_pressure: in two of the rows",
            "drag: estimated",
            "radiation: in heave",
        ),
    ),
)
"""In the order of the page."""
