"""The heaving sphere of IEA OES Task 10, and Hulme's coefficients for it."""

import functools
import math
from collections.abc import Sequence
from typing import NamedTuple

import mujoco
import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from buoyancy_mj.loads.damping import Damping
from buoyancy_mj.plotting.style import new_figure
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.specs import read_spec
from buoyancy_mj.sea.water import Water
from buoyancy_mj.sea.waves import RegularWave
from buoyancy_mj.validation.case import Case, Row
from buoyancy_mj.validation.runs import follow
from buoyancy_mj.validation.signals import amplitude, crossings

TASK_10 = (
    "Wendt et al. 2019, *Ocean Energy Systems Wave Energy Modelling Task: Modelling, "
    "Verification and Validation of Wave Energy Converters*, J. Mar. Sci. Eng. 7(11):379, "
    "and the data of IEA OES Task 10"
)


def _load_sphere(timestep: float = 0.01) -> mujoco.MjModel:
    """Load the sphere of 10 m that ships, with a timestep [s]."""
    model = read_spec(catalog.models()["oes_sphere"]).compile()
    model.opt.timestep = timestep
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    return model


# coefficients


def _compare_coefficients() -> Sequence[Row]:
    """Compare the coefficients in the model with Hulme's, at the sphere's natural frequency."""
    displacement = 1000.0 * 2.0 / 3.0 * math.pi * 5.0**3
    omega = 1.427
    model = _load_sphere()
    added_mass = model.numeric("added_mass:oes_sphere").data[2]
    damping = model.numeric("radiation_damping:oes_sphere").data[0]
    return [
        Row(
            "added mass in heave, half wet, over 2/3 pi rho R^3",
            0.4284,
            float(0.5 * added_mass / displacement),
            2e-3,
        ),
        Row(
            "damping in heave over 2/3 pi rho R^3 omega",
            0.2484,
            float(damping / displacement / omega),
            2e-3,
        ),
    ]


# decay


class Decay(NamedTuple):
    """A published decay of the heave of the sphere."""

    crossings: tuple[float, float, float]
    """When it crosses the still level [s]."""
    trough: float
    """Its first trough [m]."""
    crest: float
    """The crest after that [m]."""
    source: str
    """Whose it is."""


DECAYS = {
    1.0: Decay((1.14, 3.39, 5.555), -0.88, 0.641, "six linear codes, the middle of their range"),
    5.0: Decay((1.312, 3.830, 6.143), -4.216, 2.928, "NREL, viscous"),
}
"""By the height from which it falls [m]."""


_UNDRAGGED = Damping(viscous=None)
"""Radiation damping alone, as the codes have it."""


@functools.cache
def decay(
    height: float, damping: Damping = _UNDRAGGED
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times (n,) [s] and heights (n,) [m] of the sphere after its release at a height [m]."""

    def start(data: mujoco.MjData) -> None:
        data.qpos[2] = height

    return follow(
        _load_sphere(),
        Water(),
        20.0,
        read=lambda data: float(data.qpos[2]),
        start=start,
        damping=damping,
    )


def _compare_decay(height: float, damping: Damping = _UNDRAGGED) -> Sequence[Row]:
    """Compare the decay after a release at a height [m]."""
    published = DECAYS[height]
    times, heights = decay(height, damping)

    # the level is crossed in time
    rows = [
        Row(f"{ordinal} crossing of the level [s] ({published.source})", expected, time, 0.07)
        for ordinal, expected, time in zip(
            ("first", "second", "third"),
            published.crossings,
            crossings(times, heights)[:3].tolist(),
            strict=True,
        )
    ]

    # trough and crest
    lowest = int(heights.argmin())
    trough = float(heights[lowest])
    crest = float(heights[lowest:].max())
    tolerance = 0.15 * height
    rows.append(Row("first trough [m]", published.trough, trough, tolerance, absolute=True))
    rows.append(Row("crest after it [m]", published.crest, crest, tolerance, absolute=True))
    return rows


def _draw_decay() -> Figure:
    """Draw the heave beside the published crossings, troughs and crests."""
    figure = new_figure(9.0, 3.8)
    for axes, (height, published) in zip(figure.subplots(1, 2), DECAYS.items(), strict=True):
        axes.plot(*decay(height), label="here")
        axes.plot(published.crossings, np.zeros(3), "kx", label=published.source)
        label = "their first trough and crest"
        axes.axhline(published.trough, color="0.5", linestyle=":", label=label)
        axes.axhline(published.crest, color="0.5", linestyle=":")
        axes.set(
            xlabel="time [s]", ylabel="heave [m]", xlim=(0.0, 12.0), title=f"let go {height:g} m up"
        )
        axes.legend()
    return figure


# response

PERIODS = (3.0, 4.0, 4.4, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0)
"""Periods of the waves [s]."""
LINEAR_RESPONSE = (0.108, 1.043, 1.865, 1.493, 1.147, 1.060, 1.029, 1.015, 1.008, 1.004)
"""Heave over wave amplitude at the `PERIODS`, by linear potential flow (Capytaine)."""
NONLINEAR_RESPONSE = (0.117, 0.991, 1.766, 1.526, 1.155, 1.063, 1.031, 1.019, 1.012, 1.008)
"""Heave over wave amplitude at the `PERIODS`, by MARIN's nonlinear code in the benchmark."""


@functools.cache
def response(pressure: str) -> tuple[float, ...]:
    """Heave over wave amplitude at each of the `PERIODS`, by a model of wave pressure."""
    responses = []
    for wave_period in PERIODS:
        times, heights = follow(
            _load_sphere(wave_period / 40.0),
            Water(waves=RegularWave(0.05, period=wave_period)),
            24.0 * wave_period,
            read=lambda data: float(data.qpos[2]),
            pressure=pressure,
        )

        # once the start has died down
        settled = times > 16.0 * wave_period
        heave = amplitude(times[settled], heights[settled], 2.0 * math.pi / wave_period)
        responses.append(heave / 0.05)
    return tuple(responses)


def _compare_response() -> Sequence[Row]:
    """Compare the heave in waves with linear potential flow."""
    return [
        Row(f"heave over amplitude at {wave_period:g} s", published, computed, 0.1)
        for wave_period, published, computed in zip(
            PERIODS, LINEAR_RESPONSE, response("froude-krylov"), strict=True
        )
    ]


def _draw_response() -> Figure:
    """Draw the heave in waves by all models of wave pressure."""
    figure = new_figure(6.0, 4.0)
    axes = figure.subplots()
    axes.plot(PERIODS, LINEAR_RESPONSE, "k--", label="linear potential flow")
    axes.plot(PERIODS, NONLINEAR_RESPONSE, "k^", label="MARIN, nonlinear")
    for pressure in ("froude-krylov", "hydrostatic", "archimedes"):
        axes.plot(PERIODS, response(pressure), "o-", markersize=3, label=f"here, {pressure}")
    axes.set(xlabel="period of the wave [s]", ylabel="heave over amplitude", ylim=(0.0, 4.0))
    axes.legend()
    return figure


CASES = (
    Case(
        "sphere_coefficients",
        "Hulme's hemisphere: the coefficients of `models/oes_sphere`",
        "Hulme 1982, *The wave forces acting on a floating hemisphere undergoing forced periodic "
        "oscillations*, J. Fluid Mech. 121, at ka = 1.0",
        "The coefficients are read from the numerics of the model.",
        _compare_coefficients,
    ),
    Case(
        "sphere_decay_1m",
        "A sphere of 10 m released 1 m above its rest",
        TASK_10,
        "`models/oes_sphere` has one added mass and one damping, those at its natural period. "
        "The codes have them by frequency. Viscous drag is left out, as it is in the codes.",
        lambda: _compare_decay(1.0),
        loads=("buoyancy", "radiation", "added_mass"),
    ),
    Case(
        "sphere_decay_5m",
        "The sphere released 5 m above its rest, just out of the water",
        TASK_10,
        "The model is the same, without viscous drag.",
        lambda: _compare_decay(5.0),
        "Added mass and damping are those of small motions. A share by volume gathers the water's "
        "mass later than the sphere's first touch does, and so the sphere is early.",
        _draw_decay,
        ("buoyancy", "radiation", "added_mass"),
    ),
    Case(
        "sphere_decay_5m_dragged",
        "The same with the estimated drag",
        TASK_10,
        "The model is the same, and the estimate of drag acts, as it does where nothing is said.",
        lambda: _compare_decay(5.0, Damping()),
        "The estimate of drag, which is one for flow that has separated, takes energy that the "
        "sphere in the benchmark keeps.",
        loads=("buoyancy", "drag: estimated", "radiation", "added_mass"),
    ),
    Case(
        "sphere_response",
        "The heave of the sphere in regular waves",
        f"{TASK_10}; here beside linear potential flow by Capytaine",
        "The waves have an amplitude of 5 cm, and the pressure is that of Froude and Krylov. The "
        "same constant coefficients give the reaction to the water's acceleration and velocity in "
        "the middle of the wet part.",
        _compare_response,
        "Scattered waves follow from the acceleration at one point and the added mass at ka = 1. "
        "That is too coarse where waves are short beside the sphere, or where it resonates with "
        "little damping.",
        _draw_response,
        ("buoyancy", "wave_pressure", "drag: estimated", "radiation", "added_mass"),
    ),
)
"""In the order of the page."""
