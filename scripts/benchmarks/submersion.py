"""One submersion by the public call, against other packages on the same meshes and poses."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import trimesh
from numpy.typing import NDArray
from rich.table import Table

from benchmarks.peers import CALLS, PEERS, Poses, capytaine
from benchmarks.rows import Row, describe_time
from benchmarks.timing import ATTITUDES, time_calls
from buoyancy_mj import RegularWave, Simulation, TriMesh, Water, read_scene, submerge
from buoyancy_mj.scenes import catalog
from buoyancy_mj.submersion import exact
from buoyancy_mj.submersion.hull_set import HullSet

LARGE = 5_000
"""Triangles from which exponents are fitted."""
SHOWN = 81_920
"""Triangles of the sphere that the pages show."""
_MOST = 330_000
"""Triangles of the largest mesh, at most."""

Times = dict[str, float]
"""Times [s] of one mesh by who computes, its number of triangles and bytes per triangle."""
Results = dict[str, dict[str, Times]]
"""Times by shape and by number of triangles."""


def measure(quick: bool) -> Results:
    """Measure all meshes."""
    results: Results = {}
    for shape, solid in _solids(quick):
        times = _measure_solid(solid, quick)
        results.setdefault(shape, {})[f"{len(solid.faces)}"] = times
    return results


def _solids(quick: bool) -> list[tuple[str, trimesh.Trimesh]]:
    """Meshes by shape, about a metre in size, the smallest of each first."""
    solids = [("sphere", trimesh.creation.icosphere(n)) for n in ((2, 4) if quick else range(2, 8))]

    # an hourglass, a ring and a part of a vehicle
    cones = trimesh.creation.revolve(
        [[0, -0.5], [0.5, -0.5], [0.05, 0.0], [0.5, 0.5], [0, 0.5]], sections=32
    )
    torus = trimesh.creation.torus(0.6, 0.2, major_sections=32, minor_sections=16)
    part = Simulation(read_scene(catalog.scenes()["auv_drop_still"])).hulls[0].mesh
    hull = trimesh.Trimesh(part.vertices / part.radius, part.faces, process=False)

    # each subdivided
    shapes = (("hourglass", cones.subdivide()), ("torus", torus), ("AUV pressure hull", hull))
    for shape, solid in shapes:
        finer = solid
        for _ in range(1 if quick else 5):
            solids.append((shape, finer))
            finer = finer.subdivide()
    return [(shape, solid) for shape, solid in solids if len(solid.faces) <= _MOST]


def _measure_solid(solid: trimesh.Trimesh, quick: bool) -> Times:
    """Measure a mesh in five attitudes, its middle a little above or below the surface."""
    mesh = TriMesh(solid.vertices, solid.faces)
    wave = Water(waves=RegularWave(0.1, wavelength=10.0))
    middle = solid.bounds.mean(axis=0)
    positions = [
        np.array([0.0, 0.0, 0.2 * np.sin(i)]) - turn @ middle for i, turn in enumerate(ATTITUDES)
    ]
    poses = Poses(solid, positions, ATTITUDES)

    calls = {
        "still": lambda i: submerge(mesh, positions[i], ATTITUDES[i]),
        "waves": lambda i: submerge(mesh, positions[i], ATTITUDES[i], wave, 0.3),
        "trimesh": poses.by_trimesh,
        "scipy hull": poses.by_scipy,
        "manifold3d": poses.by_manifold,
    }
    if capytaine is not None and len(solid.faces) < 100_000:
        calls["Capytaine"] = poses.by_capytaine
    slow = {"Capytaine": 1 if len(solid.faces) > 10_000 else 3}
    times = {"triangles": float(len(solid.faces))} | time_calls(calls, quick, slow)
    times["bytes per triangle"] = _bytes(mesh) / len(solid.faces)
    return times


def _bytes(mesh: TriMesh) -> int:
    """Memory of a mesh, of what is packed of it, and of where it is cut."""
    packed = exact.PackedHulls(HullSet([mesh]), Water())
    parts = packed.hulls, packed.scratch.cut, packed.results, mesh.vertices, mesh.faces
    return sum(values.nbytes for values in _list_arrays(parts))


def _list_arrays(parts: tuple[Any, ...]) -> Iterator[NDArray[Any]]:
    """The arrays of tuples in tuples."""
    for part in parts:
        if isinstance(part, tuple):
            yield from _list_arrays(part)
        elif isinstance(part, np.ndarray):
            yield part


def exponent(rows: list[Times], column: str) -> float:
    """The exponent of the power law through times against triangles, from `LARGE` ones up."""
    large = [row for row in rows if column in row and row["triangles"] >= LARGE]
    if len(large) < 2:
        return float("nan")
    points = np.log([(row["triangles"], row[column]) for row in large])
    return float(np.polyfit(*points.T, 1)[0])


def describe(results: Results) -> Iterator[Table | str]:
    """Describe all meshes in a table, and the exponents of each shape."""
    table = Table(title="one submersion, processor time; factors are against still water")
    for column in ("mesh", "triangles", "still water", "waves", *PEERS, "bytes per triangle"):
        table.add_column(column, justify="right")
    for shape, rows in results.items():
        for row in rows.values():
            times = (f"{row[surface] * 1e6:,.0f} us" for surface in ("still", "waves"))
            factors = (
                f"{row[peer] / row['still']:,.0f} x" if peer in row else "" for peer in PEERS
            )
            size = f"{row['bytes per triangle']:.0f}"
            table.add_row(shape, f"{row['triangles']:,.0f}", *times, *factors, size)
    yield table

    for shape, rows in results.items():
        still, waves = (exponent(list(rows.values()), surface) for surface in ("still", "waves"))
        yield (
            f"{shape}: time grows as triangles^{still:.2f} on still water, ^{waves:.2f} in waves, "
            f"from {LARGE:,} up"
        )


def rows(results: Results) -> Iterator[Row]:
    """What the largest sphere that all know takes, against the others."""
    spheres = list(results.get("sphere", {}).values())
    for row in spheres:
        if row["triangles"] == SHOWN:
            what = f"submersion of a sphere of {SHOWN:,} triangles"
            still = describe_time(row["still"])
            for peer in PEERS:
                if peer in row:
                    factor = row[peer] / row["still"]
                    first = peer == "trimesh"
                    yield Row(what, still, factor, f"as fast as {CALLS[peer]}", first)
            factor = row["waves"] / row["still"]
            yield Row(
                f"{what}, in a wave",
                describe_time(row["waves"]),
                factor,
                "as long as on still water",
            )
    for surface, name in (("still", "on still water"), ("waves", "in a wave")):
        exponents = [exponent(list(sizes.values()), surface) for sizes in results.values()]
        if np.isfinite(exponents).all():
            span = " to ".join(dict.fromkeys(f"n^{f(exponents):.2f}" for f in (min, max)))
            yield Row(f"growth of time with triangles, {name}", span)
    sizes = [row["bytes per triangle"] for sizes in results.values() for row in sizes.values()]
    yield Row("memory of a mesh and its tree", f"{min(sizes):.0f} to {max(sizes):.0f} B a triangle")
