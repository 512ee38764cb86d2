"""How fast it is, as ratios measured side by side in one run.

    .venv/bin/python scripts/bench.py [--quick] [--save F.json] [--compare F.json]

Medians over repeats on one core: a submersion against trimesh's capped slice and against scipy's
convex hull of the wet vertices on the same mesh and poses; the tree of moments against the plain
way; a step of a scene with water against
the same step without; the real-time factor of `auv_waves`.
"""

import argparse
import json
import statistics
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from unittest import mock

import mujoco
import numpy as np
import trimesh
from rich.console import Console
from rich.table import Table
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from buoyancy_mj import RegularWave, Simulation, TriMesh, Water, catalog, exact, read_scene, submerge, tree
from buoyancy_mj.recording import Recording

POSES = [(np.array([0.0, 0.0, 0.2 * np.sin(i)]), Rotation.random(random_state=i).as_matrix()) for i in range(5)]


def median_time(call: Callable[[int], object], least: float) -> float:
    """Median time of one call [s], over repeats that take `least` seconds together."""
    call(0)
    times: list[float] = []
    while sum(times) < least or len(times) < 5:
        started = time.perf_counter()
        call(len(times) % len(POSES))
        times.append(time.perf_counter() - started)
    return statistics.median(times)


def submersions(subdivisions: int, least: float) -> dict[str, float]:
    """Times [s] of one submersion of a sphere by us and by others."""
    solid = trimesh.creation.icosphere(subdivisions=subdivisions)
    mesh = TriMesh(solid.vertices, solid.faces)
    wave = Water(waves=RegularWave(0.1, wavelength=10.0))

    def by_trimesh(i: int) -> tuple[float, np.ndarray]:
        position, turn = POSES[i]
        wet = trimesh.Trimesh(solid.vertices @ turn.T + position, solid.faces, process=False).slice_plane(
            [0, 0, 0], [0, 0, -1], cap=True
        )
        return wet.volume, wet.center_mass

    def by_hull(i: int) -> float:
        position, turn = POSES[i]
        points = solid.vertices @ turn.T + position
        return float(ConvexHull(points[points[:, 2] < 0.0]).volume)

    return {
        "triangles": float(len(solid.faces)),
        "still": median_time(lambda i: submerge(mesh, *POSES[i]), least),
        "waves": median_time(lambda i: submerge(mesh, *POSES[i], wave, 0.3), least),
        "trimesh": median_time(by_trimesh, least),
        "hull": median_time(by_hull, least),
    }


def tree_ratios(triangles: int, least: float) -> dict[str, float]:
    """Times with the tree over those of the plain way, of a ball and of a plate that lies in the surface, its worst case."""
    ball = trimesh.creation.icosphere(subdivisions=round(np.log2(triangles / 20) / 2), radius=0.5)
    plate = trimesh.creation.box([0.8, 0.6, 0.01])
    while len(plate.faces) < triangles / 2:
        plate = plate.subdivide()
    still, waves = Water(), Water(waves=RegularWave(0.05, wavelength=5.0))
    rows = {}
    for name, solid, turns in (("ball", ball, [turn for _, turn in POSES]), ("plate", plate, [np.eye(3)] * len(POSES))):
        for surface, water in (("still", still), ("waves", waves)):
            way = {few: tree_or_plain(TriMesh(solid.vertices, solid.faces), water, few) for few in (0, 10**9)}
            # turn about, so that both see the same machine
            times = {few: [] for few in way}
            started = time.perf_counter()
            while time.perf_counter() - started < 2.0 * least:
                for turn in turns:
                    for few, hulls in way.items():
                        before = time.perf_counter()
                        hulls.submerge(np.zeros((1, 3)), turn.reshape(1, 9), 0.0)
                        times[few].append(time.perf_counter() - before)
            rows[f"{name}, {surface}"] = statistics.median(times[0]) / statistics.median(times[10**9])
    return {"triangles": float(len(ball.faces))} | rows


def tree_or_plain(mesh: TriMesh, water: Water, few: int) -> exact.PackedHulls:
    """A mesh with a tree (few = 0) or with one leaf."""
    with mock.patch.multiple(tree, FEW=few):
        return exact.PackedHulls([mesh], [0], [0], water)


def scene_step(name: str, least: float) -> dict[str, float]:
    """Times [s] of one step of a scene with and without water."""
    simulation = Simulation(read_scene(catalog.scenes()[name]))
    for _ in range(100):
        simulation.step()
    wet = median_time(lambda i: simulation.step(), least)
    dry = median_time(lambda i: mujoco.mj_step(simulation.model, simulation.data), least)
    return {"with": wet, "without": dry}


def real_time_factors(name: str) -> dict[str, float]:
    """Simulated over wall time of a whole scene, without and with a recording at its rate."""
    factors = {}
    with tempfile.TemporaryDirectory() as folder:
        for label in ("headless", "recorded"):
            simulation = Simulation(read_scene(catalog.scenes()[name]))
            recording = Recording(simulation, Path(folder) / "run.rrd") if label == "recorded" else None
            for frame in simulation.frames():
                if recording:
                    recording.add(frame)
            summary = simulation.summary()
            if recording:
                recording.close(summary)
            factors[label] = summary.real_time_factor
    return factors


def flat(results: dict, prefix: str = "") -> dict[str, float]:
    """Nested results as one table."""
    rows = {}
    for key, value in results.items():
        rows |= flat(value, f"{prefix}{key}/") if isinstance(value, dict) else {prefix + key: value}
    return rows


def main() -> None:
    """Measure, print, save, compare."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer sizes and repeats")
    parser.add_argument("--save", type=Path, help="write the measurements to this JSON file")
    parser.add_argument("--compare", type=Path, help="set them beside those of this JSON file")
    options = parser.parse_args()
    least = 0.05 if options.quick else 0.5
    console = Console()

    sizes = [submersions(n, least) for n in ((2, 4) if options.quick else (2, 3, 4, 5, 6))]
    table = Table(title="one submersion of a sphere, median")
    for column in ("triangles", "still water", "waves", "trimesh slice", "x", "scipy hull", "x"):
        table.add_column(column, justify="right")
    for row in sizes:
        table.add_row(
            f"{row['triangles']:,.0f}",
            f"{row['still'] * 1e6:,.0f} us",
            f"{row['waves'] * 1e6:,.0f} us",
            f"{row['trimesh'] * 1e6:,.0f} us",
            f"{row['trimesh'] / row['still']:,.0f}",
            f"{row['hull'] * 1e6:,.0f} us",
            f"{row['hull'] / row['still']:,.0f}",
        )
    console.print(table)

    trees = [tree_ratios(20 * 4**n, least) for n in ((4,) if options.quick else (4, 5, 6))]
    table = Table(title="time with the tree over time without, same mesh and poses")
    for column in trees[0]:
        table.add_column(column, justify="right")
    for row in trees:
        table.add_row(f"{row['triangles']:,.0f}", *(f"{row[column]:.2f}" for column in row if column != "triangles"))
    console.print(table)

    steps = {name: scene_step(name, least) for name in ("auv_drop_still", "auv_waves")}
    for name, step in steps.items():
        ratio = step["with"] / step["without"]
        console.print(
            f"step of {name}: {step['with'] * 1e6:.0f} us with water, {step['without'] * 1e6:.0f} us without, {ratio:.1f} x"
        )
    factors = real_time_factors("auv_waves")
    console.print(
        f"auv_waves: {factors['headless']:.1f} x real time headless, {factors['recorded']:.1f} x recorded at 60 Hz"
    )

    results = {
        "submersion": {f"{row['triangles']:.0f}": row for row in sizes},
        "tree": {f"{row['triangles']:.0f}": row for row in trees},
        "step": steps,
        "real_time": factors,
    }
    if options.compare:
        before = flat(json.loads(options.compare.read_text()))
        for key, value in flat(results).items():
            if key in before and not key.endswith("triangles"):
                console.print(f"{key}: {value:.4g}, was {before[key]:.4g}, {value / before[key]:.2f} x")
    if options.save:
        options.save.write_text(json.dumps(results, indent=2) + "\n")


if __name__ == "__main__":
    main()
