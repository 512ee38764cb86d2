"""How fast it is, as ratios measured side by side in one run.

    .venv/bin/python scripts/bench.py [--quick] [--only NAME ...] [--plot F.png] [--save F.json] [--compare F.json]

Medians over repeats: a submersion by the public call against trimesh's capped slice, scipy's convex
hull of the wet vertices, manifold3d's trim and, where it is installed (pip install '.[bench]'),
Capytaine's immersed_part, on the same meshes and poses; the tree of moments against the plain way;
a step of a scene with water against the same step without; a sea of 64 waves against one; batches
on one thread and on two; the real-time factor of `auv_waves`; the time from a fresh interpreter to
the first step; hydrostatics against Capytaine's, rest poses, righting arms and whole inspections.
"""

import argparse
import dataclasses
import json
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from unittest import mock

import manifold3d
import mujoco
import numpy as np
import trimesh
from mujoco import batch
from rich.console import Console
from rich.table import Table
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from buoyancy_mj import (
    JonswapSea,
    RegularWave,
    Scene,
    Simulation,
    TriMesh,
    Water,
    equilibrium,
    hydrostatics,
    read_scene,
    repair,
    righting_arm,
    submerge,
)
from buoyancy_mj.meshes import tree  # fmt: skip
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.assembly import assemble
from buoyancy_mj.statics.balance import find_balance
from buoyancy_mj.statics.vessel import build_vessel
from buoyancy_mj.submersion import exact
from buoyancy_mj.viz.recording import Recording

try:
    import capytaine
except ImportError:
    capytaine = None

TURNS = [Rotation.random(random_state=i).as_matrix() for i in range(5)]
PEERS = ("trimesh", "scipy hull", "manifold3d", "Capytaine")
LARGE = 5_000
"""Triangles from which exponents are fitted."""


def median_time(call: Callable[[int], object], least: float, fewest: int = 5) -> float:
    """Median time of one call [s], over repeats that take `least` seconds together."""
    call(0)
    times: list[float] = []
    while sum(times) < least or len(times) < fewest:
        started = time.perf_counter()
        call(len(times) % len(TURNS))
        times.append(time.perf_counter() - started)
    return statistics.median(times)


# a submersion ---------------------------------------------------------------------------------------


def solids(quick: bool) -> list[tuple[str, trimesh.Trimesh]]:
    """Meshes by name, about a metre in size, the smallest of each first."""
    made = [("sphere", trimesh.creation.icosphere(n)) for n in ((2, 4) if quick else range(2, 8))]
    cone = trimesh.creation.revolve(
        [[0, -0.5], [0.5, -0.5], [0.05, 0.0], [0.5, 0.5], [0, 0.5]], sections=32
    )
    torus = trimesh.creation.torus(0.6, 0.2, major_sections=32, minor_sections=16)
    part = Simulation(read_scene(catalog.scenes()["auv_drop_still"])).hulls[0].mesh
    hull = trimesh.Trimesh(part.vertices / part.radius, part.faces, process=False)
    for name, solid in (
        ("hourglass", cone.subdivide()),
        ("torus", torus),
        ("AUV pressure hull", hull),
    ):
        for _ in range(1 if quick else 5):
            made.append((name, solid))
            solid = solid.subdivide()
    return [(name, solid) for name, solid in made if len(solid.faces) <= 330_000]


def submersions(solid: trimesh.Trimesh, least: float) -> dict[str, float]:
    """Times [s] of one submersion by us and by others, in five attitudes, the middle a little above or below the surface."""
    mesh = TriMesh(solid.vertices, solid.faces)
    wave = Water(waves=RegularWave(0.1, wavelength=10.0))
    places = [
        np.array([0.0, 0.0, 0.2 * np.sin(i)]) - turn @ solid.bounds.mean(axis=0)
        for i, turn in enumerate(TURNS)
    ]
    body = manifold3d.Manifold(
        manifold3d.Mesh64(np.array(solid.vertices), np.array(solid.faces, np.uint64))
    )

    def by_trimesh(i: int) -> tuple[float, np.ndarray]:
        turned = trimesh.Trimesh(
            solid.vertices @ TURNS[i].T + places[i], solid.faces, process=False
        )
        wet = turned.slice_plane([0, 0, 0], [0, 0, -1], cap=True)
        return wet.volume, wet.center_mass

    def by_hull(i: int) -> float:
        points = solid.vertices @ TURNS[i].T + places[i]
        return float(ConvexHull(points[points[:, 2] < 0.0]).volume)

    def by_manifold(i: int) -> float:
        return float(body.trim_by_plane(-TURNS[i][2], places[i][2]).volume())

    def by_capytaine(i: int) -> float:
        return float(
            capytaine.Mesh(vertices=solid.vertices @ TURNS[i].T + places[i], faces=solid.faces)
            .immersed_part()
            .volume
        )

    times = {
        "triangles": float(len(solid.faces)),
        "still": median_time(lambda i: submerge(mesh, places[i], TURNS[i]), least),
        "waves": median_time(lambda i: submerge(mesh, places[i], TURNS[i], wave, 0.3), least),
        "trimesh": median_time(by_trimesh, least),
        "scipy hull": median_time(by_hull, least),
        "manifold3d": median_time(by_manifold, least),
    }
    if capytaine is not None and len(solid.faces) < 100_000:
        times["Capytaine"] = median_time(
            by_capytaine, least, fewest=1 if len(solid.faces) > 10_000 else 3
        )
    packed = exact.PackedHulls([mesh], [0], [0], Water())
    arrays = [*packed.hulls, *packed.scratch.cut, packed.results, mesh.vertices, mesh.faces]
    times["bytes per triangle"] = sum(values.nbytes for values in arrays) / len(solid.faces)
    return times


def exponent(rows: list[dict[str, float]], column: str) -> float:
    """Of the power law through times against triangles, from `LARGE` ones up."""
    points = np.log(
        [
            (row["triangles"], row[column])
            for row in rows
            if column in row and row["triangles"] >= LARGE
        ]
    )
    return float(np.polyfit(*points.T, 1)[0]) if len(points) > 1 else float("nan")


def tree_ratios(triangles: int, least: float) -> dict[str, float]:
    """Times with the tree over those of the plain way, of a ball and of a plate that lies in the surface, its worst case."""
    ball = trimesh.creation.icosphere(subdivisions=round(np.log2(triangles / 20) / 2), radius=0.5)
    plate = trimesh.creation.box([0.8, 0.6, 0.01])
    while len(plate.faces) < triangles / 2:
        plate = plate.subdivide()
    swell = RegularWave(0.05, wavelength=5.0)
    still, waves = Water(), Water(waves=swell)
    # when it passes through the level in the middle
    now = 0.25 * swell.period
    rows = {}
    for name, solid, turns in (("ball", ball, TURNS), ("plate", plate, [np.eye(3)] * len(TURNS))):
        for surface, water in (("still", still), ("waves", waves)):
            mesh = TriMesh(solid.vertices, solid.faces)
            # as it is chosen, and without the choice
            ways = [exact.PackedHulls([mesh], [0], [0], water)]
            with mock.patch.object(tree, "FEW", 10**9):
                ways.append(exact.PackedHulls([mesh], [0], [0], water))
            # turn about, so that both see the same machine
            times: list[list[float]] = [[], []]
            started = time.perf_counter()
            while time.perf_counter() - started < 2.0 * least:
                for turn in turns:
                    for way, hulls in enumerate(ways):
                        before = time.perf_counter()
                        hulls.submerge(np.zeros((1, 3)), turn.reshape(1, 9), now)
                        times[way].append(time.perf_counter() - before)
            rows[f"{name}, {surface}"] = statistics.median(times[0]) / statistics.median(times[1])
    return {"triangles": float(len(ball.faces))} | rows


# steps, batches, runs -------------------------------------------------------------------------------


def scene_steps(name: str, *settings: str) -> dict[str, float]:
    """`steps_of` a scene that ships."""
    return steps_of(read_scene(catalog.scenes()[name], settings))


def steps_of(scene: Scene) -> dict[str, float]:
    """Mean time of one step [s] over the whole of a scene, with its water (compiled) and without."""
    times = {}
    for label, afloat in (("with", True), ("without", False)):
        best = np.inf
        for _ in range(3):
            model, data, _ = assemble(scene, afloat=afloat)
            mujoco.mj_forward(model, data)
            steps = round(scene.duration / scene.timestep)
            started = time.perf_counter()
            mujoco.mj_step(model, data, steps)
            best = min(best, (time.perf_counter() - started) / steps)
        times[label] = best
    return times


def seas(components: int) -> dict[str, dict[str, float]]:
    """Mean time that the water takes of a step [s], in one regular wave and in a sea of the same energy, by pressure."""
    scene = read_scene(catalog.scenes()["auv_sea_state_2"], ("duration=10",))
    times: dict[str, dict[str, float]] = {}
    for pressure in ("archimedes", "froude-krylov"):
        times[pressure] = {}
        for label, wave in (
            ("one wave", RegularWave(0.3 / np.sqrt(8.0), period=3.5)),
            ("sea", JonswapSea(0.3, 3.5, components=components, spreading=10.0)),
        ):
            water = dataclasses.replace(scene.water, waves=wave)
            step = steps_of(dataclasses.replace(scene, water=water, pressure=pressure))
            times[pressure][label] = step["with"] - step["without"]
    return times


def batches(name: str, count: int) -> dict[str, float]:
    """Simulated over wall time of a batch of a scene's model, on one thread and on two."""
    scene = read_scene(catalog.scenes()[name])
    model, data, _ = assemble(scene, afloat=True)
    factors = {}
    for threads in (1, 2):
        many = batch.Batch(model, count, nthread=threads)
        many.bind("qpos")[:] = data.qpos
        many.step(nstep=10)
        best = np.inf
        for _ in range(3):
            many.bind("qpos")[:] = data.qpos
            many.bind("qvel")[:] = 0.0
            started = time.perf_counter()
            many.step(nstep=100)
            best = min(best, time.perf_counter() - started)
        factors[f"{threads} threads"] = count * 100 * scene.timestep / best
    return factors


def real_time_factors(name: str) -> dict[str, float]:
    """Simulated over wall time of a whole scene, without and with a recording at its rate."""
    factors = {}
    with tempfile.TemporaryDirectory() as folder:
        for label in ("headless", "recorded"):
            simulation = Simulation(read_scene(catalog.scenes()[name]))
            recording = (
                Recording(simulation, Path(folder) / "run.rrd") if label == "recorded" else None
            )
            for frame in simulation.frames():
                if recording:
                    recording.add(frame)
            summary = simulation.summary()
            if recording:
                recording.close(summary)
            factors[label] = summary.real_time_factor
    return factors


def first_step() -> float:
    """Time [s] from a fresh interpreter, its kernels compiled before, through a scene's first step."""
    code = "from buoyancy_mj import *; from buoyancy_mj import catalog; "
    code += "Simulation(read_scene(catalog.scenes()['auv_waves'])).step()"
    times = []
    for _ in range(3):
        started = time.perf_counter()
        subprocess.run([sys.executable, "-c", code], check=True)
        times.append(time.perf_counter() - started)
    return statistics.median(times)


# statics --------------------------------------------------------------------------------------------


def vehicles(folder: Path) -> dict[str, Path]:
    """The AUV, a ball, and a hull of 100,000 triangles, as MJCF files."""
    ball = trimesh.creation.icosphere(4, radius=0.5)
    # a double-ended hull with a flat deck, some 100,000 triangles
    u, v = np.meshgrid(np.linspace(-1.0, 1.0, 224), np.linspace(0.0, 1.0, 112), indexing="ij")
    side = np.stack(
        [u, 0.25 * (1.0 - u**2) * (1.0 - (1.0 - v) ** 2), 0.3 * v - 0.2], axis=-1
    ).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(223), np.arange(111), indexing="ij")
    a = (i * 112 + j).ravel()
    shell = np.vstack(
        [np.column_stack([a, a + 113, a + 112]), np.column_stack([a, a + 1, a + 113])]
    )
    rim = 112 * np.arange(224) + 111
    p, q, n = rim[:-1], rim[1:], len(side)
    deck = np.vstack([np.column_stack([p, p + n, q]), np.column_stack([q, p + n, q + n])])
    faces = np.vstack([shell, shell[:, ::-1] + n, deck])
    hull, _ = repair(np.vstack([side, side * [1.0, -1.0, 1.0]]), faces)
    paths = {"sauvc_auv": catalog.models()["sauvc_auv"]}
    for name, mesh, mass in (
        ("ball", ball, 250.0),
        ("hull", trimesh.Trimesh(hull.vertices, hull.faces, process=False), 50.0),
    ):
        mesh.export(folder / f"{name}.obj")
        paths[name] = folder / f"{name}.xml"
        paths[name].write_text(
            f'<mujoco><asset><mesh name="{name}" file="{name}.obj"/></asset><worldbody><body name="{name}"><freejoint/>'
            f'<inertial pos="0 0 -.1" mass="{mass}" diaginertia="9 9 9"/><geom type="mesh" mesh="{name}"/></body>'
            "</worldbody></mujoco>"
        )
    return paths


def statics(path: Path, least: float) -> dict[str, float]:
    """Times [s] of what is asked of a vehicle at rest, everything included, and of a whole `inspect`."""
    model = catalog.read_spec(path).compile()
    vessel = build_vessel(model)
    times = {"triangles": float(sum(len(mesh.faces) for mesh in vessel.meshes))}
    starts = [
        [*model.qpos0[:3], *Rotation.from_euler("x", 0.1 + 0.1 * i).as_quat(scalar_first=True)]
        for i in range(len(TURNS))
    ]
    for name, call in (
        ("hydrostatics", lambda i: hydrostatics(model, qpos=starts[i])),
        ("equilibrium", lambda i: equilibrium(model, start=starts[i])),
        ("once more from the same vessel", lambda i: find_balance(vessel, TURNS[i])),
        ("every equilibrium", lambda i: equilibrium(model, all=True)),
        ("righting arm", lambda i: righting_arm(model)),
    ):
        times[name] = median_time(call, least, fewest=3)
    started = time.perf_counter()
    subprocess.run(
        [sys.executable, "-m", "buoyancy_mj", "inspect", str(path)], check=True, capture_output=True
    )
    times["inspect"] = time.perf_counter() - started
    if capytaine is not None and times["triangles"] < 4 * LARGE:
        parts = [mesh.transformed(vessel.rotation, vessel.position) for mesh in vessel.meshes]
        ends = np.cumsum([0] + [len(part.vertices) for part in parts])
        faces = np.vstack([part.faces + n for part, n in zip(parts, ends, strict=False)])
        whole = capytaine.Mesh(vertices=np.vstack([part.vertices for part in parts]), faces=faces)
        dofs = capytaine.rigid_body_dofs(rotation_center=vessel.position)
        body = capytaine.FloatingBody(
            mesh=whole, dofs=dofs, center_of_mass=vessel.position, mass=vessel.mass
        )
        times["Capytaine"] = median_time(
            lambda i: body.compute_hydrostatics(rho=1000.0, g=9.81), least, fewest=3
        )
    return times


# telling --------------------------------------------------------------------------------------------


def tell_submersions(console: Console, measured: dict[str, dict[str, dict[str, float]]]) -> None:
    """A table of all meshes, and the exponents of each shape."""
    table = Table(title="one submersion, median; factors are against still water")
    for column in ("mesh", "triangles", "still water", "waves", *PEERS, "bytes per triangle"):
        table.add_column(column, justify="right")
    for name, rows in measured.items():
        for row in rows.values():
            peers = [f"{row[peer] / row['still']:,.0f} x" if peer in row else "" for peer in PEERS]
            table.add_row(
                name, f"{row['triangles']:,.0f}", *(f"{row[w] * 1e6:,.0f} us" for w in ("still", "waves")), *peers,
                f"{row['bytes per triangle']:.0f}",
            )  # fmt: skip
    console.print(table)
    for name, rows in measured.items():
        slopes = [exponent(list(rows.values()), column) for column in ("still", "waves")]
        console.print(
            f"{name}: time grows as triangles^{slopes[0]:.2f} on still water, ^{slopes[1]:.2f} in waves, from {LARGE:,} up"
        )


def plot(path: Path, measured: dict[str, dict[str, dict[str, float]]]) -> None:
    """Time against triangles of the sphere, with the fitted exponents."""
    from matplotlib.figure import Figure

    rows = list(measured["sphere"].values())
    figure = Figure(figsize=(7, 4.5), layout="constrained")
    axes = figure.add_subplot()
    for column, label in (
        ("still", "still water"),
        ("waves", "in waves"),
        *((peer, peer) for peer in PEERS),
    ):
        points = [(row["triangles"], row[column] * 1e6) for row in rows if column in row]
        if points:
            fitted = exponent(rows, column)
            told = f"{label}, n^{fitted:.2f}" if np.isfinite(fitted) else label
            axes.loglog(
                *zip(*points, strict=True),
                marker="o",
                lw=2.5 if column in ("still", "waves") else 1.2,
                label=told,
            )
    axes.set(
        xlabel="triangles",
        ylabel="time of one submersion [us]",
        title="a sphere in random attitudes",
    )
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8)
    figure.savefig(path, dpi=110)


def flat(results: dict, prefix: str = "") -> dict[str, float]:
    """Nested results as one table."""
    rows = {}
    for key, value in results.items():
        rows |= flat(value, f"{prefix}{key}/") if isinstance(value, dict) else {prefix + key: value}
    return rows


def main() -> None:
    """Measure, print, save, compare."""
    sections = ("submersion", "tree", "step", "sea", "batch", "real_time", "first_step", "statics")
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer sizes and repeats")
    parser.add_argument(
        "--only", nargs="+", choices=sections, default=sections, help="measure these alone"
    )
    parser.add_argument("--plot", type=Path, help="draw time against triangles into this picture")
    parser.add_argument("--save", type=Path, help="write the measurements to this JSON file")
    parser.add_argument("--compare", type=Path, help="set them beside those of this JSON file")
    options = parser.parse_args()
    least = 0.05 if options.quick else 0.5
    console = Console(width=140)
    results: dict = {}

    if "submersion" in options.only:
        measured: dict[str, dict[str, dict[str, float]]] = {}
        for name, solid in solids(options.quick):
            measured.setdefault(name, {})[f"{len(solid.faces)}"] = submersions(solid, least)
        tell_submersions(console, measured)
        results["submersion"] = measured
        if options.plot:
            plot(options.plot, measured)
    if "tree" in options.only:
        trees = [
            tree_ratios(20 * 4**n, least) for n in ((4,) if options.quick else (2, 3, 4, 5, 6))
        ]
        table = Table(
            title="time by the tree where it is chosen, over time without, same mesh and poses"
        )
        for column in trees[0]:
            table.add_column(column, justify="right")
        for row in trees:
            table.add_row(
                f"{row['triangles']:,.0f}",
                *(f"{row[column]:.2f}" for column in row if column != "triangles"),
            )
        console.print(table)
        results["tree"] = {f"{row['triangles']:.0f}": row for row in trees}
    if "step" in options.only:
        results["step"] = {
            name: scene_steps(name) for name in ("auv_drop_still", "auv_pool", "auv_waves")
        }
        for kind in ("hydrostatic", "froude-krylov"):
            results["step"][f"auv_waves, {kind}"] = scene_steps("auv_waves", f'pressure="{kind}"')
        for name, step in results["step"].items():
            console.print(
                f"mean step of {name}: {step['with'] * 1e6:.1f} us with water, {step['without'] * 1e6:.1f} us without, "
                f"{step['with'] / step['without']:.1f} x"
            )
    if "sea" in options.only:
        results["sea"] = seas(64)
        for name, row in results["sea"].items():
            console.print(
                f"water's part of a step of auv_sea_state_2, {name}: {row['one wave'] * 1e6:.1f} us in one wave, "
                f"{row['sea'] * 1e6:.1f} us in 64, {row['sea'] / row['one wave']:.1f} x"
            )
    if "batch" in options.only:
        results["batch"] = {name: batches(name, 64) for name in ("auv_drop_still", "auv_waves")}
        for name, factors in results["batch"].items():
            console.print(
                f"64 of {name} in a batch: {factors['1 threads']:,.0f} x real time on one thread, "
                f"{factors['2 threads']:,.0f} x on two, {factors['2 threads'] / factors['1 threads']:.2f} x"
            )
    if "real_time" in options.only:
        results["real_time"] = real_time_factors("auv_waves")
        console.print(
            f"auv_waves: {results['real_time']['headless']:.1f} x real time headless, "
            f"{results['real_time']['recorded']:.1f} x recorded at 60 Hz"
        )
    if "first_step" in options.only:
        results["first_step"] = first_step()
        console.print(
            f"from a fresh interpreter through the first step of auv_waves: {results['first_step']:.2f} s"
        )
    if "statics" in options.only:
        with tempfile.TemporaryDirectory() as folder:
            results["statics"] = {
                name: statics(path, least) for name, path in vehicles(Path(folder)).items()
            }
        for name, row in results["statics"].items():
            told = ", ".join(
                f"{what} {1e3 * row[what]:,.1f} ms"
                for what in row
                if what not in ("triangles", "Capytaine")
            )
            console.print(f"{name}, {row['triangles']:,.0f} triangles: {told}")
            if "Capytaine" in row:
                console.print(
                    f"    Capytaine's hydrostatics take {row['Capytaine'] / row['hydrostatics']:,.0f} x as long"
                )

    if options.compare:
        before = flat(json.loads(options.compare.read_text()))
        for key, value in flat(results).items():
            if key in before and not key.endswith("triangles"):
                console.print(
                    f"{key}: {value:.4g}, was {before[key]:.4g}, {value / before[key]:.2f} x"
                )
    if options.save:
        options.save.write_text(json.dumps(results, indent=2) + "\n")


if __name__ == "__main__":
    main()
