"""Bodies in a flow: drag and added mass against tables, terminal speeds, wave forces, orbits."""

import functools
import math
from collections.abc import Callable, Sequence

import mujoco
import numpy as np
from matplotlib.figure import Figure
from scipy.special import h1vp

from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.hulls.geoms import find_hulls
from buoyancy_mj.loads.added_mass import estimate_added_mass as added_mass_of
from buoyancy_mj.loads.damping import Damping
from buoyancy_mj.loads.damping_arrays import resolve_damping as damping_of
from buoyancy_mj.sea.water import Water
from buoyancy_mj.sea.waves import RegularWave
from buoyancy_mj.validation.case import Case, Row, amplitude, body, follow, numeric

_CYLINDER = '<geom type="cylinder" size=".1 {half}"/>'
WHITE: dict[str, tuple[str, int, float, float]] = {
    "cube, face on": ('<geom type="box" size=".1 .1 .1"/>', 0, 0.04, 1.07),
    "square plate across the flow": ('<geom type="box" size=".1 .1 .002"/>', 2, 0.04, 1.18),
    "disk across the flow": (_CYLINDER.format(half=0.002), 2, math.pi * 0.01, 1.17),
    "cylinder along the flow, as long as wide": (
        _CYLINDER.format(half=0.1),
        2,
        math.pi * 0.01,
        0.90,
    ),
    "cylinder along the flow, 4 times": (_CYLINDER.format(half=0.4), 2, math.pi * 0.01, 0.87),
    "cylinder across the flow, as long as wide": (_CYLINDER.format(half=0.1), 0, 0.04, 0.64),
    "cylinder across the flow, 2 times": (_CYLINDER.format(half=0.2), 0, 0.08, 0.68),
    "cylinder across the flow, 5 times": (_CYLINDER.format(half=0.5), 0, 0.2, 0.74),
    "cylinder across the flow, 10 times": (_CYLINDER.format(half=1.0), 0, 0.4, 0.82),
    "sphere, laminar": ('<geom type="sphere" size=".1"/>', 0, math.pi * 0.01, 0.47),
    "ellipsoid along the flow, 2 times, laminar": (
        '<geom type="ellipsoid" size=".2 .1 .1"/>',
        0,
        math.pi * 0.01,
        0.27,
    ),
    "ellipsoid along the flow, 4 times, laminar": (
        '<geom type="ellipsoid" size=".4 .1 .1"/>',
        0,
        math.pi * 0.01,
        0.25,
    ),
}
"""Geom, axis of the flow, frontal area [m^2], measured drag coefficient; at Reynolds numbers from 1e4."""
DNV: dict[str, tuple[str, int, float, float]] = {
    "square prism along its axis, as long as wide": ('<geom type="box" size=".1 .1 .1"/>', 2, 8e-3, 0.68),
    "square prism along its axis, 2 times": ('<geom type="box" size=".1 .1 .2"/>', 2, 16e-3, 0.36),
    "square prism along its axis, 4 times": ('<geom type="box" size=".1 .1 .4"/>', 2, 32e-3, 0.19),
    "square prism along its axis, 10 times": ('<geom type="box" size=".1 .1 1"/>', 2, 80e-3, 0.08),
    "cylinder across its axis, 1.2 times as long as wide": (_CYLINDER.format(half=0.12), 0, math.pi * 2.4e-3, 0.62),
    "cylinder across its axis, 2.5 times": (_CYLINDER.format(half=0.25), 0, math.pi * 5e-3, 0.78),
    "cylinder across its axis, 5 times": (_CYLINDER.format(half=0.5), 0, math.pi * 10e-3, 0.90),
    "cylinder across its axis, 9 times": (_CYLINDER.format(half=0.9), 0, math.pi * 18e-3, 0.96),
    "spheroid along its axis, 2 times as long as wide": (
        '<geom type="ellipsoid" size=".2 .1 .1"/>', 0, 4 / 3 * math.pi * 2e-3, 0.21,
    ),
    "spheroid along its axis, 5 times": ('<geom type="ellipsoid" size=".5 .1 .1"/>', 0, 4 / 3 * math.pi * 5e-3, 0.059),
    "spheroid across its axis, 2 times": ('<geom type="ellipsoid" size=".2 .1 .1"/>', 2, 4 / 3 * math.pi * 2e-3, 0.702),
    "sphere": ('<geom type="sphere" size=".1"/>', 0, 4 / 3 * math.pi * 1e-3, 0.5),
}  # fmt: skip
"""Geom, axis of the motion, reference volume [m^3], added mass coefficient."""
STOUTNESS = (0.05, 0.1, 0.2, 0.3, 0.5)
"""Wave number times radius, of the fixed cylinders."""


def _of(geom: str) -> mujoco.MjModel:
    return body(geom, mass=1.0, inertia=(0.1, 0.1, 0.1))


@functools.cache
def drag_coefficients() -> dict[str, float]:
    """The estimate's, for the bodies of `WHITE`."""
    found = {}
    for name, (geom, axis, area, _) in WHITE.items():
        model = _of(geom)
        quadratic = damping_of(Damping(), model, find_hulls(model), 1000.0).quadratic[0, axis]
        found[name] = float(quadratic / (0.5 * 1000.0 * area))
    return found


@functools.cache
def added_mass_coefficients() -> dict[str, float]:
    """The estimate's, for the bodies of `DNV`."""
    return {
        name: float(added_mass_of(find_hulls(_of(geom)), 1000.0)[axis, axis] / (1000.0 * volume))
        for name, (geom, axis, volume, _) in DNV.items()
    }


def _white() -> Sequence[Row]:
    return [
        Row(f"C_D, {name}", WHITE[name][3], ours, 0.2) for name, ours in drag_coefficients().items()
    ]


def _dnv() -> Sequence[Row]:
    return [
        Row(f"C_A, {name}", DNV[name][3], ours, 0.15)
        for name, ours in added_mass_coefficients().items()
    ]


def _fall(model: mujoco.MjModel, *, drag: bool = True) -> float:
    """Terminal speed [m/s] downward."""
    _, speeds = follow(model, Water(), 12.0, read=lambda data: float(data.qvel[2]), drag=drag)
    return -float(speeds[-1])


def _deep(geom: str, mass: float, custom: str = "") -> mujoco.MjModel:
    model = body(geom, mass=mass, inertia=(0.1, 0.12, 0.14), custom=custom)
    model.body_pos[1] = [0.0, 0.0, -100.0]
    model.qpos0[2] = -100.0
    return model


def _terminal() -> Sequence[Row]:
    volume = 4 / 3 * math.pi * 1e-3
    net = (6.0 - 1000.0 * volume) * 9.81
    sphere = math.sqrt(net / (0.5 * 1000.0 * 0.47 * math.pi * 0.01))
    along = '<geom type="ellipsoid" size=".1 .1 .2"/>'
    net = (10.0 - 1000.0 * 4 / 3 * math.pi * 2e-3) * 9.81
    long = math.sqrt(net / (0.5 * 1000.0 * 0.27 * math.pi * 0.01))
    return [
        Row(
            "sphere of 20 cm and 6 kg, C_D 0.47 [m/s]",
            sphere,
            _fall(_deep('<geom type="sphere" size=".1"/>', 6.0)),
            0.1,
        ),
        Row(
            "ellipsoid of 40 x 20 cm and 10 kg, end on, C_D 0.27 [m/s]",
            long,
            _fall(_deep(along, 10.0)),
            0.1,
        ),
    ]


def _engine() -> Sequence[Row]:
    rows = []
    for name, size, mass, published in (
        ("sphere of 20 cm, 5 kg", (0.1, 0.1, 0.1), 5.0, 1.76709),
        ("ellipsoid .3 .2 .1, 40 kg, flat on", (0.3, 0.2, 0.1), 40.0, 2.04046),
        ("ellipsoid .3 .2 .1, 40 kg, end on", (0.1, 0.2, 0.3), 40.0, 2.49905),
    ):
        a, b, c = size
        geom = f'<geom type="ellipsoid" size="{a} {b} {c}" fluidshape="ellipsoid"/>'
        theirs = _deep(geom, mass)
        theirs.opt.density = 1000.0
        data = mujoco.MjData(theirs)
        while data.time < 12.0:
            mujoco.mj_step(theirs, data)
        rows.append(
            Row(f"the engine's own fluid, {name} [m/s]", published, -float(data.qvel[2]), 1e-5)
        )
        # its coefficients, stated: blunt 0.5 of the projected area, slender 0.25 of what the largest is larger
        shown, most = math.pi * a * b, math.pi * max(a * b, b * c, a * c)
        quadratic = 1000.0 * (0.5 * shown + 0.25 * (most - shown))
        buoyant = mass + 1000.0 * 4 / 3 * math.pi * a * b * c
        ours = _deep(geom, buoyant, numeric("quadratic_damping", [0, 0, quadratic, 0, 0, 0]))
        rows.append(Row(f"its coefficients here, {name} [m/s]", published, _fall(ours), 1e-3))
    return rows


def _pile(stoutness: float) -> float:
    """Amplitude of the force on a fixed cylinder from the bottom up, over rho g A a^2."""
    radius, high = 1.0, 1e-3
    depth = 0.5
    wave = RegularWave(high, wavelength=2 * math.pi * radius / stoutness, depth=depth)
    model = body(
        f'<geom type="cylinder" size="{radius} 1" pos="0 0 {1.0 - depth}"/>',
        mass=1.0,
        inertia=(1, 1, 1),
        joint='<joint type="slide" axis="1 0 0"/>',
        # of a disk, pi rho a^2 a metre; a quarter of the body is in the water
        custom=numeric("added_mass", [1000.0 * math.pi * radius**2 * 2.0, 0, 0, 0, 0, 0]),
    )
    buoyancy = Buoyancy(model, Water(waves=wave), pressure="froude-krylov", damping=None)
    data = mujoco.MjData(model)
    forces, times = [], np.linspace(0.0, wave.period, 25)
    for data.time in times:
        mujoco.mj_forward(model, data)
        forces.append(buoyancy.evaluate(data).total.force[0])
    return amplitude(times, np.array(forces), 2 * math.pi / wave.period) / (
        1000.0 * 9.81 * high * radius**2
    )


def _maccamy_fuchs() -> Sequence[Row]:
    rows = []
    for ka in STOUTNESS:
        # 4 rho g A / k^2 tanh(kh) / |H1'(ka)|, over rho g A a^2
        exact = 4.0 / ka**2 * math.tanh(ka * 0.5) / abs(h1vp(1, ka))
        rows.append(Row(f"force over rho g A a^2 at ka = {ka:g}", float(exact), _pile(ka), 0.05))
    return rows


def _orbit(read: Callable[[mujoco.MjData], float], *, added_mass: str = "estimate") -> float:
    """Amplitude [m] of a small neutral sphere, 1 m deep in a wave of 2 mm and 6 m."""
    radius, wave = 0.05, RegularWave(0.002, wavelength=6.0)
    model = body(
        f'<geom type="sphere" size="{radius}"/>',
        mass=1000.0 * 4 / 3 * math.pi * radius**3,
        inertia=(1e-3, 1.1e-3, 1e-3),
    )
    model.body_pos[1] = [0.0, 0.0, -1.0]
    model.qpos0[2] = -1.0
    velocity = Water(waves=wave).velocity([0.0, 0.0, -1.0], 0.0)

    def start(data: mujoco.MjData) -> None:
        data.qvel[:3] = velocity

    times, values = follow(
        model,
        Water(waves=wave),
        wave.period,
        read=read,
        start=start,
        pressure="froude-krylov",
        added_mass=added_mass,
        drag=False,
    )
    return amplitude(times, values, 2 * math.pi / wave.period)


def _kelvin() -> Sequence[Row]:
    radius = 0.002 * math.exp(-2 * math.pi / 6.0)
    return [
        Row(
            "its orbit over the water's, along the wave",
            1.0,
            _orbit(lambda data: float(data.qpos[0])) / radius,
            0.02,
        ),
        Row(
            "its orbit over the water's, upright",
            1.0,
            _orbit(lambda data: float(data.qpos[2])) / radius,
            0.02,
        ),
    ]


def _floater(pressure: str, ratio: float) -> float:
    """Heave over amplitude of a small wall-sided float in a wave whose period is so many of its own."""
    draft = 0.1
    own = 2 * math.pi * math.sqrt(draft / 9.81)
    wave = RegularWave(0.005, period=ratio * own)
    mass = 1000.0 * 0.04 * draft
    model = body(
        f'<geom type="box" size=".1 .1 {draft}"/>',
        mass=mass,
        inertia=(0.1, 0.1, 0.1),
        joint='<joint type="slide" axis="0 0 1"/>',
        custom=numeric("radiation_damping", [6.0, 0, 0]),
    )
    times, heights = follow(
        model,
        Water(waves=wave),
        60.0 * own,
        read=lambda data: float(data.qpos[0]),
        pressure=pressure,
        added_mass="none",
    )
    late = times > 30.0 * own
    return amplitude(times[late], heights[late], 2 * math.pi / wave.period) / 0.005


def _long_waves() -> Sequence[Row]:
    rows = [
        Row(
            "Archimedes' force, T = 10 T_n: 1 / (1 - k d)",
            1.0101,
            _floater("archimedes", 10.0),
            0.005,
        )
    ]
    rows += [
        Row(
            f"Froude-Krylov, T = {ratio:g} T_n: follows the surface",
            1.0,
            _floater("froude-krylov", ratio),
            0.01,
        )
        for ratio in (5.0, 10.0)
    ]
    return rows


def _draw_tables() -> Figure:
    figure = Figure(figsize=(9.0, 4.0), layout="constrained")
    for axes, table, found, label in zip(
        figure.subplots(1, 2),
        (WHITE, DNV),
        (drag_coefficients(), added_mass_coefficients()),
        ("C_D", "C_A"),
        strict=True,
    ):
        published = [table[name][3] for name in found]
        axes.plot(published, list(found.values()), "o")
        top = 1.1 * max(*published, *found.values())
        axes.plot([0.0, top], [0.0, top], "k-", linewidth=1.0)
        axes.set(
            xlabel=f"{label} published",
            ylabel=f"{label} estimated here",
            xlim=(0.0, top),
            ylim=(0.0, top),
        )
        axes.grid(alpha=0.3)
    return figure


CASES = (
    Case(
        "drag_table",
        "Measured drag coefficients of simple bodies, and the estimate",
        "White, *Fluid Mechanics*, 8th ed., table 7.3, after Hoerner 1965, *Fluid-Dynamic Drag*",
        "`Silhouette()` from the silhouettes of each body.",
        _white,
        "The estimate knows how squarely faces meet the flow, not how the flow closes behind: what is long and "
        "rounded has less, and what is long and blunt a little less, than it says.",
        _draw_tables,
    ),
    Case(
        "added_mass_table",
        "Published added mass of simple bodies, and the estimate",
        "DNV-RP-C205, *Environmental Conditions and Environmental Loads*, appendix D, table D-2",
        '`added_mass="estimate"`: the ellipsoid with the second moments of each body\'s volume.',
        _dnv,
        "Edges gather more water than a smooth ellipsoid of the same moments: a cube has 0.68 where the sphere has 0.5.",
    ),
    Case(
        "terminal_speeds",
        "Terminal speeds by the estimate of drag",
        "the measured coefficients of White's table 7.3",
        "Let go at 100 m depth, for 12 s.",
        _terminal,
    ),
    Case(
        "engine_fluid",
        "MuJoCo's own fluid",
        "MuJoCo 4.0.0, its ellipsoid model, which has drag and no buoyancy: terminal speeds computed with it",
        "The engine alone; then this water, with the engine's drag stated and the body as much heavier as it is buoyant.",
        _engine,
    ),
    Case(
        "fixed_cylinder",
        "Wave force on a fixed vertical cylinder",
        "MacCamy and Fuchs 1954, *Wave forces on piles: a diffraction theory*, which experiments confirm (Chakrabarti and "
        "Tam 1975)",
        "A cylinder of 1 m radius from the bottom up in 0.5 m of water: Froude-Krylov force, and the added mass of a disk, "
        "1, times the water's acceleration.",
        _maccamy_fuchs,
        "A constant added mass knows no scattered waves.",
    ),
    Case(
        "small_sphere",
        "A small neutral sphere follows the water's orbit",
        "Kelvin; (1 + C_A) rho V a is the water's share, and the sphere's inertia with added mass the same",
        "5 cm of radius, 1 m under waves of 2 mm and 6 m, for a period, without drag.",
        _kelvin,
    ),
    Case(
        "long_waves",
        "A float in long waves",
        "Newman 1977, *Marine Hydrodynamics*, ch. 6; in deep water k d = (T_n / T)^2",
        "A wall-sided float of 10 cm draft that only heaves, in waves of 5 mm, with a little damping.",
        _long_waves,
    ),
)
"""In the order of the page."""
