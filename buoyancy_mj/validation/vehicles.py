"""Vehicles of the literature: terminal speeds, restoring, periods."""

import math
from collections.abc import Sequence

import mujoco
import numpy as np

from buoyancy_mj.loads.added_mass import ellipsoid_added_mass
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.specs import read_spec
from buoyancy_mj.sea.water import Water
from buoyancy_mj.statics.hydrostatics import hydrostatics
from buoyancy_mj.validation.case import Case, Row, body, follow, numeric, period

VON_BENZON = (
    "von Benzon et al. 2022, *An Open-Source Benchmark Simulator: Control of a BlueROV2 Underwater Robot*, J. Mar. Sci. "
    "Eng. 10(12):1898; what follows from its parameters in closed form"
)
FOSSEN = "Fossen 2021, *Handbook of Marine Craft Hydrodynamics and Motion Control*, and its Python Vehicle Simulator"


def _bluerov2(density: float, *, push: float = 0.0, dof: int = 2, duration: float = 40.0) -> float:
    """Its terminal speed [m/s] along an axis; pushed, it is held upright and straight, as by its autopilot."""
    spec = read_spec(catalog.models()["bluerov2_heavy"])
    spec.body("bluerov2_heavy").pos = [0.0, 0.0, -50.0]
    if push:
        for key in spec.keys:
            spec.delete(key)
        spec.delete(spec.joints[0])
        spec.body("bluerov2_heavy").add_joint(
            type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[1.0, 0.0, 0.0]
        )
    model = spec.compile()
    model.opt.timestep, model.opt.integrator = 0.01, mujoco.mjtIntegrator.mjINT_IMPLICITFAST

    def start(data: mujoco.MjData) -> None:
        data.xfrc_applied[1, dof] = push

    _, speeds = follow(
        model,
        Water(density=density),
        duration,
        read=lambda data: float(data.qvel[dof]),
        start=start,
    )
    return float(speeds[-1])


def _swing(
    model: mujoco.MjModel,
    dof: int,
    *,
    angle: float = 0.02,
    depth: float = -20.0,
    duration: float = 60.0,
) -> float:
    """Period [s] of a free body turned a little about one of its axes, without drag."""

    def start(data: mujoco.MjData) -> None:
        data.qpos[2] = depth
        data.qpos[3], data.qpos[3 + dof] = math.cos(0.5 * angle), math.sin(0.5 * angle)

    times, angles = follow(
        model,
        Water(density=1026.0),
        duration,
        read=lambda data: float(data.qpos[3 + dof]),
        start=start,
        drag=False,
    )
    return period(times, angles)


def _speeds() -> Sequence[Row]:
    rows = [
        Row("sinks in fresh water [m/s]", -0.0259, _bluerov2(1000.0), 0.01),
        Row("rises in sea water [m/s]", 0.0534, _bluerov2(1025.0), 0.01),
    ]
    rows += [
        Row(
            f"surge under {push:g} N [m/s]",
            speed,
            _bluerov2(1000.0, push=push, dof=0, duration=15.0),
            0.01,
        )
        for push, speed in ((10.0, 0.222), (40.0, 0.486), (100.0, 0.795))
    ]
    model = read_spec(catalog.models()["bluerov2_heavy"]).compile()
    # undamped, each motion by itself
    found = hydrostatics(model, qpos=[0, 0, -3, 1, 0, 0, 0]).natural_periods(
        [6.36, 7.12, 18.68, 0.189, 0.135, 0.222]
    )
    rows += [
        Row("period of roll [s]", 3.672, float(found[1]), 0.01),
        Row("period of pitch [s]", 3.311, float(found[2]), 0.01),
    ]
    return rows


def _remus() -> Sequence[Row]:
    # a prolate spheroid, its centre of gravity 2 cm under its middle
    radii = np.array([0.8, 0.095, 0.095])
    mass, moments = 31.029, (0.1120, 4.028, 4.028)
    added = ellipsoid_added_mass(radii, 1026.0)
    # the simulator's rule for roll, which a smooth spheroid would not have
    added[3] = 0.3 * moments[0]
    volume = mass / 1026.0
    scale = (volume / (4.0 / 3.0 * math.pi * float(radii.prod()))) ** (1.0 / 3.0)
    size = " ".join(repr(float(radius * scale)) for radius in radii)
    custom = numeric("added_mass", added.tolist())
    model = body(
        f'<geom type="ellipsoid" size="{size}"/>',
        mass=mass,
        inertia=moments,
        centre="0 0 -.02",
        custom=custom,
    )
    dry = body(
        f'<geom type="ellipsoid" size="{size}"/>', mass=mass, inertia=moments, centre="0 0 -.02"
    )
    return [
        Row("period of roll [s]", 0.9917, _swing(model, 1, duration=5.0), 0.02),
        Row("period of pitch [s]", 6.953, _swing(model, 2), 0.02),
        Row("period of roll without added mass [s]", 0.8523, _swing(dry, 1, duration=5.0), 0.02),
        Row("period of pitch without added mass [s]", 5.1107, _swing(dry, 2), 0.02),
    ]


def _otter() -> Sequence[Row]:
    # two wall-sided floats with its waterplane 0.75 m^2, its moments I_T = BM_T nabla and I_L, and its displacement
    volume, area, metacentric = 0.0780488, 0.75, (1.2325, 3.111255)
    across, along = 1.537912 * volume, 3.416667 * volume
    length = math.sqrt(12.0 * along / area)
    breadth = 0.5 * area / length
    out = math.sqrt((across - area * breadth**2 / 12.0) / area)
    draft = volume / area
    gravity_above = 0.5 * draft + 1.537912 - metacentric[0]
    mass = 1025.0 * volume
    # inertia and added mass together, of the diagonal periods that it publishes
    whole = (
        7541.44 * (0.8407 / (2 * math.pi)) ** 2,
        967.27 * (1.0079 / (2 * math.pi)) ** 2,
        2441.71 * (0.8575 / (2 * math.pi)) ** 2,
    )
    floats = "".join(
        f'<geom type="box" size="{0.5 * length!r} {0.5 * breadth!r} .2" pos="0 {side * out!r} {0.2 - draft!r}"/>'
        for side in (-1.0, 1.0)
    )
    rows = []
    model = body(
        floats,
        mass=mass,
        inertia=(whole[1], 1.05 * whole[1], whole[1]),
        centre=f"0 0 {gravity_above - draft!r}",
        joint="<freejoint/>",
    )
    found = hydrostatics(model, Water(density=1025.0), qpos=[0, 0, 0, 1, 0, 0, 0])
    stiffness = found.stiffness
    rows += [
        Row("stiffness of heave [N/m]", 7541.44, float(stiffness[2, 2]), 0.005),
        Row("stiffness of roll [N m]", 967.27, float(stiffness[3, 3]), 0.005),
        Row("stiffness of pitch [N m]", 2441.71, float(stiffness[4, 4]), 0.005),
    ]
    for name, joint, inertia, published, place in (
        ("heave", '<joint type="slide" axis="0 0 1"/>', whole[0], 0.8407, 0.01),
        (
            "roll",
            f'<joint type="hinge" axis="1 0 0" pos="0 0 {gravity_above - draft!r}"/>',
            whole[1],
            1.0079,
            0.02,
        ),
        (
            "pitch",
            f'<joint type="hinge" axis="0 1 0" pos="0 0 {gravity_above - draft!r}"/>',
            whole[2],
            0.8575,
            0.02,
        ),
    ):
        moments = (whole[1], whole[2], max(whole[1], abs(whole[2] - whole[1]) + 1.0))
        # of heave alone the added mass is told apart; it scales with what is wet of the floats
        beyond = (inertia - mass) * 0.4 / draft if name == "heave" else 0.0
        custom = numeric("added_mass", [0, 0, beyond, 0, 0, 0])
        single = body(
            floats,
            mass=mass,
            inertia=moments,
            centre=f"0 0 {gravity_above - draft!r}",
            joint=joint,
            custom=custom,
        )

        def start(data: mujoco.MjData, value: float = place) -> None:
            data.qpos[0] = value

        times, values = follow(
            single,
            Water(density=1025.0),
            6.0,
            read=lambda data: float(data.qpos[0]),
            start=start,
            drag=False,
        )
        rows.append(
            Row(f"period of {name} [s]", published, period(times, values - values.mean()), 0.02)
        )
    return rows


CASES = (
    Case(
        "bluerov2_heavy",
        "BlueROV2 Heavy: terminal speeds and periods",
        VON_BENZON,
        "`models/bluerov2_heavy`, stepped until its speed no longer changes; periods from its hydrostatics, undamped.",
        _speeds,
    ),
    Case(
        "remus_100",
        "REMUS 100: periods of roll and pitch",
        f"{FOSSEN}, `remus100.py`; periods coupled with sway and heave, and without added mass about the middle",
        "A prolate spheroid of its length, diameter and mass with Lamb's added mass, and 0.3 of its inertia in roll; free, "
        "turned by a degree, without drag.",
        _remus,
    ),
    Case(
        "otter",
        "Otter: stiffness and periods",
        f"{FOSSEN}, `otter.py`; each motion by itself",
        "Two wall-sided floats with its displacement, and the area and the moments of its waterplane; its centre of gravity "
        "at its metacentric height; its inertias and added masses together. Periods from a decay of 1 cm or a degree.",
        _otter,
    ),
)
"""In the order of the page."""
