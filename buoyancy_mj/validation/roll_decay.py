"""The roll decay of a ship model, KVLCC2 as tested at SSPA: periods and amplitudes."""

import functools
import math
from collections.abc import Sequence

import mujoco
import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from buoyancy_mj.loads.damping import Damping
from buoyancy_mj.plotting.style import new_figure
from buoyancy_mj.sea.water import Water
from buoyancy_mj.statics.hydrostatics import hydrostatics
from buoyancy_mj.validation.case import Case, Row
from buoyancy_mj.validation.runs import follow, numeric

SCALE = 68.0
"""Of the ship to the model."""
LENGTH, BREADTH, DRAFT, DEPTH = 320 / SCALE, 58 / SCALE, 20.8 / SCALE, 30 / SCALE
"""Of the model [m]."""
VOLUME = 312653 / SCALE**3
"""Displaced volume of the model [m^3]."""
KG, GM, RADIUS_OF_GYRATION = 18.6 / SCALE, 5.73 / SCALE, 23.2 / SCALE
"""Centre of gravity above the keel, metacentric height, and radius of gyration in roll [m]."""
DENSITY = 1000.0
"""Density of the water [kg/m^3]."""
MASS = DENSITY * VOLUME
"""Of the model [kg]."""
PERIOD = 2.547
"""Measured period of small rolling [s]."""
FULLNESS = (1.645, 8.204)
"""Exponents n of the waterlines 1 - |2 x / L|^n, at the keel and at the draft and above.

With them the hull has the displacement of the model, and at its KG its GM."""
INERTIA_RATIO = 1.167
"""Inertia in roll in the water over that in air: the square of the measured periods, 2.547 s and
2.358 s. Linear potential flow (Capytaine 3, 936 panels of this hull) has 1.143."""
HEAVE_ADDED_MASS, HEAVE_DAMPING = 1.55 * MASS, 2807.0
"""Of the hull at the period of roll [kg, N s/m], by the same potential flow."""
DAMPING_RATIO = (0.001369, 0.0007123)
"""Damping ratio in roll, and its slope by the amplitude [1/deg], that fit run 21337."""
SPEED = 0.959
"""Of the model in run 21340, as measured [m/s]."""
AT_REST = {13.3: 7.903, 26.0: 6.463, 38.7: 5.461, 51.5: 4.699, 64.2: 4.066}
"""Amplitude [deg] by time since the release [s], half the way from one peak to the next: run 21338,
without speed."""
UNDER_WAY = {13.3: 6.132, 26.1: 4.036, 38.8: 2.730, 51.5: 1.816}
"""The same of run 21340."""
UNDER_WAY_RATIOS = {4.0: 0.0130, 6.0: 0.0136, 8.0: 0.0142}
"""Damping ratio by amplitude [deg] that fits that run."""
RELEASES = {21338: -10.428, 21340: -9.864}
"""Angles of release of the runs [deg]."""


def build_hull(
    stations: int = 60, levels: int = 16
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """A hull of vertical sides above the draft, its origin amidships in the waterline.

    Returns:
        Its vertices (n, 3) [m] and faces (m, 3).
    """
    x = np.sin(np.linspace(-0.5 * math.pi, 0.5 * math.pi, stations + 1))
    heights = np.append(np.linspace(0.0, DRAFT, levels + 1), DEPTH)
    exponents = np.interp(heights, (0.0, DRAFT), FULLNESS)
    breadths = 0.5 * BREADTH * (1.0 - np.abs(x[:, None]) ** exponents)

    # rings around the hull: port side downwards, then starboard side upwards
    ring = np.concatenate([breadths[:, ::-1], -breadths], axis=1)
    z = np.concatenate([heights[::-1], heights])
    vertices = np.stack(
        np.broadcast_arrays(0.5 * LENGTH * x[:, None], ring, z - DRAFT), axis=-1
    ).reshape(-1, 3)
    # at the ends both sides are one edge
    corners = np.arange(len(vertices)).reshape(stations + 1, len(z))
    corners[[0, -1], len(heights) :] = corners[[0, -1], len(heights) - 1 :: -1]
    a, b = corners[:-1], corners[1:]
    c, d = np.roll(b, -1, axis=1), np.roll(a, -1, axis=1)
    faces = np.concatenate([np.stack([a, c, d], axis=-1), np.stack([a, b, c], axis=-1)])
    faces = faces.reshape(-1, 3)
    kept = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    return vertices, faces[kept]


def build_model(ratio: tuple[float, float]) -> mujoco.MjModel:
    """Build the ship at its draft, with a damping ratio in roll and its slope [1/deg]."""
    # coefficients scale with the wet part of the hull
    waterplane = LENGTH * BREADTH * FULLNESS[1] / (FULLNESS[1] + 1.0)
    wet = VOLUME / (VOLUME + waterplane * (DEPTH - DRAFT))
    inertia = MASS * RADIUS_OF_GYRATION**2
    omega = 2.0 * math.pi / PERIOD
    critical = 2.0 * INERTIA_RATIO * inertia * omega / wet
    added_mass = [0.0, 0.0, HEAVE_ADDED_MASS / wet, (INERTIA_RATIO - 1.0) * inertia / wet, 0.0, 0.0]
    # quadratic damping c |w| w takes per cycle as much as a linear 8 / (3 pi) omega a c
    quadratic = critical * math.degrees(ratio[1]) * 3.0 * math.pi / (8.0 * omega)
    custom = (
        numeric("added_mass", added_mass)
        + numeric("linear_damping", [0.0, 0.0, 0.0, critical * ratio[0], 0.0, 0.0])
        + numeric("quadratic_damping", [0.0, 0.0, 0.0, quadratic, 0.0, 0.0])
        + numeric("radiation_damping", [HEAVE_DAMPING, 0.0, 0.0])
    )
    lengthwise = MASS * (80 / SCALE) ** 2
    spec = mujoco.MjSpec.from_string(f"""
        <mujoco>
          <option timestep="0.01" integrator="RK4"/>
          <custom>{custom}</custom>
          <worldbody>
            <body name="b">
              <freejoint/>
              <inertial pos="0 0 {KG - DRAFT!r}" mass="{MASS!r}"
                diaginertia="{inertia!r} {lengthwise!r} {lengthwise!r}"/>
            </body>
          </worldbody>
        </mujoco>""")
    vertices, faces = build_hull()
    spec.add_mesh(name="hull", uservert=vertices.ravel(), userface=faces.ravel())
    spec.body("b").add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname="hull")
    return spec.compile()


def predict_lift() -> float:
    """Damping ratio in roll by the hull's lift at `SPEED`, by Ikeda's method.

    B = rho / 2 U L T k_N l_0 l_R (1 - 1.4 OG / l_R + 0.7 OG^2 / (l_0 l_R)), with l_0 = 0.3 T and
    l_R = 0.5 T, OG from the level down to the centre of gravity, and
    k_N = 2 pi T / L + chi (4.1 B / L - 0.045), chi = 0.3 for full midship sections (ITTC
    7.5-02-07-04.5, after Ikeda, Himeno and Tanaka 1978).
    """
    lever, arm, down = 0.3 * DRAFT, 0.5 * DRAFT, DRAFT - KG
    slope = 2.0 * math.pi * DRAFT / LENGTH + 0.3 * (4.1 * BREADTH / LENGTH - 0.045)
    about = 1.0 - 1.4 * down / arm + 0.7 * down**2 / (lever * arm)
    damping = 0.5 * DENSITY * SPEED * LENGTH * DRAFT * slope * lever * arm * about
    omega = 2.0 * math.pi / PERIOD
    return damping / (2.0 * INERTIA_RATIO * MASS * RADIUS_OF_GYRATION**2 * omega)


@functools.cache
def decay(run: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times (n,) [s] and angles (n,) [deg] of the roll after the release of a run."""
    linear, slope = DAMPING_RATIO
    lift = predict_lift() if run == 21340 else 0.0
    angle = math.radians(RELEASES[run])

    def start(data: mujoco.MjData) -> None:
        data.qpos[3:7] = [math.cos(0.5 * angle), math.sin(0.5 * angle), 0.0, 0.0]

    times, quaternion = follow(
        build_model((linear + lift, slope)),
        Water(density=DENSITY),
        68.0,
        read=lambda data: float(math.atan2(data.qpos[4], data.qpos[3])),
        start=start,
        damping=Damping(),
    )
    return times, np.degrees(2.0 * quaternion)


def find_peaks(
    times: NDArray[np.float64], values: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times between peaks, and half the way from one to the next: (n,) each."""
    turns = np.flatnonzero(np.diff(values[:-1]) * np.diff(values[1:]) <= 0.0) + 1
    turns = np.append(0, turns)
    moments, peaks = times[turns], values[turns]
    return 0.5 * (moments[1:] + moments[:-1]), 0.5 * np.abs(np.diff(peaks))


def _find_period(run: int, first: float, last: float) -> float:
    """Mean period [s] between two times [s] of a run."""
    times, angles = decay(run)
    i = np.flatnonzero(angles[1:] * angles[:-1] < 0.0)
    crossed = times[i] - angles[i] * (times[i + 1] - times[i]) / (angles[i + 1] - angles[i])
    among = crossed[(crossed > first) & (crossed < last)]
    return float(2.0 * np.diff(among).mean())


def _compare() -> Sequence[Row]:
    """Compare the metacentric height, the periods and the amplitudes."""
    model = build_model(DAMPING_RATIO)
    rest = hydrostatics(model, Water(density=DENSITY))
    rows = [
        Row("metacentric height [m]", GM, rest.GMt, 0.005),
        Row("period from 10.4 to 8 deg [s]", 2.535, _find_period(21338, 0.0, 13.0), 0.01),
        Row("period from 5.5 to 4.6 deg [s]", PERIOD, _find_period(21338, 38.0, 51.0), 0.01),
    ]
    for run, amplitudes, speed, tolerance in (
        (21338, AT_REST, "without speed", 0.05),
        (21340, UNDER_WAY, f"at {SPEED:g} m/s", 0.2),
    ):
        middles, found = find_peaks(*decay(run))
        rows += [
            Row(
                f"amplitude {speed} after {time:g} s [deg]",
                published,
                float(np.interp(time, middles, found)),
                tolerance,
            )
            for time, published in amplitudes.items()
        ]

    # a peak comes each half period, and falls by exp(-pi zeta)
    _, found = find_peaks(*decay(21340))
    ratios = np.log(found[:-1] / found[1:]) / math.pi
    between = np.sqrt(found[:-1] * found[1:])
    rows += [
        Row(
            f"damping ratio at {SPEED:g} m/s and {amplitude:g} deg",
            published,
            float(np.interp(amplitude, between[::-1], ratios[::-1])),
            0.2,
        )
        for amplitude, published in UNDER_WAY_RATIOS.items()
    ]
    return rows


def _draw() -> Figure:
    """Draw the decays, and the measured amplitudes."""
    figure = new_figure(9.0, 3.8)
    both = ((21338, AT_REST, "without speed"), (21340, UNDER_WAY, f"at {SPEED:g} m/s"))
    for axes, (run, amplitudes, title) in zip(figure.subplots(1, 2), both, strict=True):
        axes.plot(*decay(run), linewidth=1.0, label="here")
        axes.plot(list(amplitudes), list(amplitudes.values()), "kx", label="measured amplitude")
        axes.set(xlabel="time [s]", ylabel="roll [deg]", title=title)
        axes.legend()
    return figure


CASES = (
    Case(
        "roll_decay",
        "KVLCC2: roll decay of a ship model of 994 kg",
        "roll decay tests at SSPA, 2018, runs 21337, 21338 and 21340 (MIT License, Copyright 2020 "
        "Martin Alexandersson: github.com/martinlarsalbert/"
        "Prediction-of-roll-motion-using-fully-nonlinear-potential-flow-and-Ikedas-method)",
        "A hull of vertical sides and pointed waterlines has the model's length, breadth, draft, "
        "displacement, centre of gravity and metacentric height. Its inertia in the water is the "
        "measured one, 1.167 of the dry (potential flow has 1.143), and its damping without speed "
        "is fitted to run 21337. Predicted are the restoring, which makes the period fall with the "
        "amplitude, run 21338, and the damping by the hull's lift at speed, by Ikeda's method "
        "(ITTC 7.5-02-07-04.5).",
        _compare,
        "Ikeda's method has a seventh too little damping at speed and small angles, and over 20 "
        "periods amplitudes gather that.",
        _draw,
        loads=(
            "buoyancy",
            "drag: roll damping as the model states it",
            "radiation: in heave",
            "added_mass: in heave and roll",
        ),
    ),
)
"""In the order of the page."""
