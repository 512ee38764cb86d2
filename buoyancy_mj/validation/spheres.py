"""The heaving sphere of IEA OES Task 10, and Hulme's coefficients that it has."""

import functools
import math
from collections.abc import Sequence

import mujoco
import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.specs import read_spec
from buoyancy_mj.sea.water import Water
from buoyancy_mj.sea.waves import RegularWave
from buoyancy_mj.validation.case import Case, Row, amplitude, crossings, follow

TASK_10 = (
    "Wendt et al. 2019, *Ocean Energy Systems Wave Energy Modelling Task: Modelling, Verification and Validation of Wave "
    "Energy Converters*, J. Mar. Sci. Eng. 7(11):379, and the data of IEA OES Task 10"
)
PERIODS = (3.0, 4.0, 4.4, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0)
"""Of the waves [s]."""
LINEAR_RESPONSE = (0.108, 1.043, 1.865, 1.493, 1.147, 1.060, 1.029, 1.015, 1.008, 1.004)
"""Heave over amplitude, linear potential flow (Capytaine)."""
NONLINEAR_RESPONSE = (0.117, 0.991, 1.766, 1.526, 1.155, 1.063, 1.031, 1.019, 1.012, 1.008)
"""The same, MARIN's nonlinear code, from the benchmark."""
DROPS = {
    1.0: (((1.14, 3.39, 5.555), (-0.88, 0.641)), "six linear codes, the middle of their range"),
    5.0: (((1.312, 3.830, 6.143), (-4.216, 2.928)), "NREL, viscous"),
}
"""By height [m]: when it crosses the level [s], and its first trough and crest [m]; and whose."""


@functools.cache
def decay(height: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times, and heights of the sphere let go at one."""

    def start(data: mujoco.MjData) -> None:
        data.qpos[2] = height

    return follow(_sphere(), Water(), 20.0, read=lambda data: float(data.qpos[2]), start=start)


@functools.cache
def response(pressure: str) -> tuple[float, ...]:
    """Heave over wave amplitude at each of the `PERIODS`."""
    found = []
    for seconds in PERIODS:
        wave = RegularWave(0.05, period=seconds)
        times, heights = follow(
            _sphere(0.02),
            Water(waves=wave),
            24.0 * seconds,
            read=lambda data: float(data.qpos[2]),
            pressure=pressure,
        )
        late = times > 16.0 * seconds
        found.append(amplitude(times[late], heights[late], 2.0 * math.pi / seconds) / 0.05)
    return tuple(found)


def _sphere(timestep: float = 0.01) -> mujoco.MjModel:
    model = read_spec(catalog.models()["oes_sphere"]).compile()
    model.opt.timestep, model.opt.integrator = timestep, mujoco.mjtIntegrator.mjINT_RK4
    return model


def _drop(height: float) -> Sequence[Row]:
    (levels, turns), whose = DROPS[height]
    times, heights = decay(height)
    found = crossings(times, heights)
    rows = [
        Row(f"crosses the level, {i}. time [s] ({whose})", published, float(found[i - 1]), 0.07)
        for i, published in enumerate(levels, 1)
    ]
    trough = int(heights.argmin())
    rows.append(
        Row("first trough [m]", turns[0], float(heights[trough]), 0.15 * height, absolute=True)
    )
    rows.append(
        Row(
            "first crest after it [m]",
            turns[1],
            float(heights[trough:].max()),
            0.15 * height,
            absolute=True,
        )
    )
    return rows


def _coefficients() -> Sequence[Row]:
    # the frequency is the sphere's own
    unit, omega = 1000.0 * 2.0 / 3.0 * math.pi * 5.0**3, 1.427
    model = _sphere()
    added = model.numeric("added_mass:oes_sphere").data[2]
    made = model.numeric("radiation_damping:oes_sphere").data[0]
    return [
        Row(
            "added mass in heave, half wet, over 2/3 pi rho R^3",
            0.4284,
            float(0.5 * added / unit),
            2e-3,
        ),
        Row(
            "damping in heave over that and the frequency", 0.2484, float(made / unit / omega), 2e-3
        ),
    ]


def _response() -> Sequence[Row]:
    return [
        Row(f"heave over amplitude at {seconds:g} s", published, ours, 0.1)
        for seconds, published, ours in zip(
            PERIODS, LINEAR_RESPONSE, response("froude-krylov"), strict=True
        )
    ]


def _draw_decay() -> Figure:
    figure = Figure(figsize=(9.0, 3.6), layout="constrained")
    for axes, height in zip(figure.subplots(1, 2), DROPS, strict=True):
        (levels, turns), whose = DROPS[height]
        axes.plot(*decay(height), label="here")
        axes.plot(levels, np.zeros(len(levels)), "kx", label=whose)
        axes.axhline(turns[0], color="0.5", linestyle=":", label="their first trough and crest")
        axes.axhline(turns[1], color="0.5", linestyle=":")
        axes.set(
            xlabel="time [s]", ylabel="heave [m]", xlim=(0.0, 12.0), title=f"let go {height:g} m up"
        )
        axes.legend(fontsize=7)
        axes.grid(alpha=0.3)
    return figure


def _draw_response() -> Figure:
    figure = Figure(figsize=(6.0, 4.0), layout="constrained")
    axes = figure.subplots()
    axes.plot(PERIODS, LINEAR_RESPONSE, "k--", label="linear potential flow")
    axes.plot(PERIODS, NONLINEAR_RESPONSE, "k^", label="MARIN, nonlinear")
    for pressure in ("froude-krylov", "hydrostatic", "archimedes"):
        axes.plot(PERIODS, response(pressure), "o-", markersize=3, label=f"here, {pressure}")
    axes.set(xlabel="period of the wave [s]", ylabel="heave over amplitude", ylim=(0.0, 4.0))
    axes.legend()
    axes.grid(alpha=0.3)
    return figure


CASES = (
    Case(
        "sphere_coefficients",
        "Hulme's hemisphere: the coefficients of `models/oes_sphere`",
        "Hulme 1982, *The wave forces acting on a floating hemisphere undergoing forced periodic oscillations*, J. Fluid "
        "Mech. 121, at ka = 1.0",
        "Read from the model, whose numerics state them.",
        _coefficients,
    ),
    Case(
        "sphere_decay_1m",
        "A sphere of 10 m let go 1 m above its rest",
        TASK_10,
        "`models/oes_sphere` with one added mass and one damping, at its own period; the codes have them by frequency.",
        lambda: _drop(1.0),
    ),
    Case(
        "sphere_decay_5m",
        "The same, let go 5 m up, just out of the water",
        TASK_10,
        "Likewise.",
        lambda: _drop(5.0),
        "Added mass and damping are those of small motions: the sphere enters without the mass that an entry gathers from "
        "its first touch on, and is early.",
        _draw_decay,
    ),
    Case(
        "sphere_response",
        "Its heave in regular waves",
        f"{TASK_10}; here beside linear potential flow by Capytaine",
        "Waves of 5 cm, Froude-Krylov pressure, and the reaction to the water's acceleration and velocity by the same "
        "constant coefficients, at the middle of what is wet.",
        _response,
        "Scattered waves are taken from the acceleration at one point with the added mass of ka = 1; where waves are "
        "short beside the sphere, or it resonates with little damping, that is too coarse.",
        _draw_response,
    ),
)
"""In the order of the page."""
