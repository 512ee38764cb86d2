"""Many vessels in one model and one sea: steps on one thread and on two, and without water."""

import time
from collections.abc import Iterator

import mujoco
import numpy as np
import trimesh
from numpy.typing import NDArray

from benchmarks.rows import Row
from buoyancy_mj import JonswapSea, Settings, Water, add_water

Results = dict[str, dict[str, float]]
"""Steps of a vessel per second [1/s], by what is stepped and by the clock; and the fleet."""
VESSELS, QUICK, WAVES = 500, 12, 260
"""Vessels of the fleet, and of a quick one; components of its sea."""
THREADS = (1, 2)
"""Numbers of threads that share the vessels."""
STEPS, ROUNDS = 5, 8
"""Steps that are timed together, and how often."""
TIMESTEP = 0.02
"""[s]."""
BERTH = 15.0
"""Distance between vessels [m]."""
DENSITY = 1025.0
"""Of the water [kg/m^3]."""
_CLOCKS = {
    "wall": time.perf_counter,
    "caller": time.thread_time,
    "process": time.process_time,
}
"""Clocks by name. The caller's own processor time is what steps take where each thread has a
processor to itself; all threads together take that of the process."""


def measure(quick: bool) -> Results:
    """Measure steps of the engine alone, and with water on some threads."""
    vessels = QUICK if quick else VESSELS
    models = {"engine": make_fleet(vessels, with_water=False)}
    models |= {f"{threads} threads": make_fleet(vessels, threads) for threads in THREADS}
    datas = {label: mujoco.MjData(model) for label, model in models.items()}
    most = {label: dict.fromkeys(_CLOCKS, 0.0) for label in models}
    # in turns, the best of each: others may be at work
    for _ in range(2 if quick else ROUNDS):
        for label, model in models.items():
            started = {name: clock() for name, clock in _CLOCKS.items()}
            mujoco.mj_step(model, datas[label], STEPS)
            for name, clock in _CLOCKS.items():
                rate = vessels * STEPS / (clock() - started[name])
                most[label][name] = max(most[label][name], rate)
    triangles = models["engine"].nmeshface / vessels
    return {**most, "fleet": {"vessels": float(vessels), "triangles": float(triangles)}}


def describe(results: Results) -> Iterator[str]:
    """Describe the engine's step in a line, and each number of threads in another."""
    vessels, triangles = results["fleet"]["vessels"], results["fleet"]["triangles"]
    yield (
        f"{vessels:.0f} vessels of {triangles:.0f} triangles in a sea of {WAVES} waves, at "
        f"{1.0 / TIMESTEP:.0f} Hz: {results['engine']['process']:,.0f} vessel steps a second by "
        "the engine alone"
    )
    real_time = vessels / TIMESTEP
    for threads in THREADS:
        rates = results[f"{threads} threads"]
        yield (
            f"with water on {threads} threads: {rates['wall']:,.0f} a second, "
            f"{rates['wall'] / real_time:.2f} x real time; by the caller's processor time "
            f"{rates['caller']:,.0f}, {rates['caller'] / real_time:.2f} x; by that of all threads "
            f"{rates['process']:,.0f}"
        )


def rows(results: Results) -> Iterator[Row]:
    """The fleet on each number of threads, against real time."""
    vessels = results["fleet"]["vessels"]
    for threads in THREADS:
        rate = results[f"{threads} threads"]["wall"]
        yield Row(
            f"{vessels:.0f} vessels in {WAVES} waves, threads: {threads}",
            f"{rate:,.0f} vessel steps/s",
            rate * TIMESTEP / vessels,
            "of real time",
        )


def make_fleet(vessels: int, threads: int = 1, *, with_water: bool = True) -> mujoco.MjModel:
    """Compile a model of different free vessels of 480 triangles each, in rows, without contacts.

    Args:
        vessels: how many.
        threads: on which the water works.
        with_water: whether there is any.
    """
    spec = mujoco.MjSpec()
    spec.option.timestep = TIMESTEP
    random = np.random.default_rng(1)
    side = int(np.ceil(np.sqrt(vessels)))
    for n in range(vessels):
        _add_vessel(spec, n, BERTH * np.array([n // side, n % side, 0.0]), random)
    if with_water:
        sea = JonswapSea(1.0, 6.0, components=WAVES, spreading=10.0, seed=1)
        water = Water(density=DENSITY, waves=sea)
        add_water(spec, Settings(water=water, added_mass="ellipsoid", threads=threads))
    return spec.compile()


def _add_vessel(
    spec: mujoco.MjSpec, n: int, place: NDArray[np.float64], random: np.random.Generator
) -> None:
    """Add an ellipsoid under a flat deck, of its own size, to float at its greatest breadth."""
    length, breadth, depth = random.uniform((4.0, 1.5, 0.8), (8.0, 2.5, 1.2))
    ball = trimesh.creation.uv_sphere(radius=1.0, count=[12, 12])
    vertices = ball.vertices * [0.5 * length, 0.5 * breadth, depth]
    vertices[:, 2] = np.minimum(vertices[:, 2], 0.5 * depth)
    spec.add_mesh(
        name=f"hull {n}",
        uservert=vertices.ravel(),
        userface=ball.faces.ravel(),
        inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_EXACT,
    )
    heading = random.uniform(0.0, 2.0 * np.pi)
    mass = DENSITY * np.pi / 6.0 * length * breadth * depth
    body = spec.worldbody.add_body(
        name=f"vessel {n}",
        pos=place,
        quat=[np.cos(heading / 2.0), 0.0, 0.0, np.sin(heading / 2.0)],
        mass=mass,
        ipos=[0.0, 0.0, -0.3 * depth],
        inertia=mass / 12.0 * np.array([breadth**2, length**2, length**2]),
        explicitinertial=True,
    )
    body.add_freejoint()
    body.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=f"hull {n}", contype=0, conaffinity=0)
