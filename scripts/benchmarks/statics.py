"""Vehicles at rest: hydrostatics, equilibria, righting arms, and a whole inspection."""

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import trimesh
from scipy.spatial.transform import Rotation

from benchmarks.peers import capytaine
from benchmarks.rows import Row, describe_time
from benchmarks.timing import ATTITUDES, time_calls
from buoyancy_mj import TriMesh, equilibria, equilibrium, hydrostatics, repair, righting_arm
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.specs import read_spec
from buoyancy_mj.statics.building import build_vessel
from buoyancy_mj.statics.descent import find_balance
from buoyancy_mj.statics.vessel import Vessel

Results = dict[str, dict[str, float]]
"""Times [s] by vehicle and by what is computed, and numbers of triangles."""


def measure(quick: bool) -> Results:
    """Measure the AUV, a ball, and a hull of 100,000 triangles, or if quick a hull of 1,500."""
    with tempfile.TemporaryDirectory() as folder:
        return {
            name: _measure_vehicle(path, quick)
            for name, path in _write_vehicles(Path(folder), quick).items()
            if name == "hull" or not quick
        }


def _write_vehicles(folder: Path, quick: bool) -> dict[str, Path]:
    """Write the ball and the hull as MJCF files beside meshes."""
    ball = trimesh.creation.icosphere(4, radius=0.5)
    hull = _double_ended_hull(28, 14) if quick else _double_ended_hull(224, 112)
    paths = {"sauvc_auv": catalog.models()["sauvc_auv"]}
    for name, mesh, mass in (
        ("ball", ball, 250.0),
        ("hull", trimesh.Trimesh(hull.vertices, hull.faces, process=False), 50.0),
    ):
        mesh.export(folder / f"{name}.obj")
        paths[name] = folder / f"{name}.xml"
        paths[name].write_text(f"""
            <mujoco>
              <asset><mesh name="{name}" file="{name}.obj"/></asset>
              <worldbody>
                <body name="{name}">
                  <freejoint/>
                  <inertial pos="0 0 -.1" mass="{mass}" diaginertia="9 9 9"/>
                  <geom type="mesh" mesh="{name}"/>
                </body>
              </worldbody>
            </mujoco>""")
    return paths


def _double_ended_hull(stations: int, rows: int) -> TriMesh:
    """A double-ended hull with a flat deck, of points from stem to stem and from keel to deck."""
    # vertices of one side
    u, v = np.meshgrid(np.linspace(-1.0, 1.0, stations), np.linspace(0.0, 1.0, rows), indexing="ij")
    breadth = 0.25 * (1.0 - u**2) * (1.0 - (1.0 - v) ** 2)
    side = np.stack([u, breadth, 0.3 * v - 0.2], axis=-1).reshape(-1, 3)

    # triangles of that side
    i, j = np.meshgrid(np.arange(stations - 1), np.arange(rows - 1), indexing="ij")
    a = (i * rows + j).ravel()
    b = a + rows
    shell = np.vstack([np.column_stack([a, b + 1, b]), np.column_stack([a, a + 1, b + 1])])

    # triangles between both sides' upper edges
    n = len(side)
    edge = rows * np.arange(stations) + rows - 1
    p = edge[:-1]
    q = edge[1:]
    deck = np.vstack([np.column_stack([p, p + n, q]), np.column_stack([q, p + n, q + n])])

    vertices = np.vstack([side, side * [1.0, -1.0, 1.0]])
    hull, _ = repair(vertices, np.vstack([shell, shell[:, ::-1] + n, deck]))
    return hull


def _measure_vehicle(path: Path, quick: bool) -> dict[str, float]:
    """Measure what the statics compute from a model, and the whole command `inspect`."""
    model = read_spec(path).compile()
    vessel = build_vessel(model)
    starts = [
        [*model.qpos0[:3], *Rotation.from_euler("x", 0.1 + 0.1 * i).as_quat(scalar_first=True)]
        for i in range(len(ATTITUDES))
    ]
    calls = {
        "hydrostatics": lambda i: hydrostatics(model, qpos=starts[i]),
        "equilibrium": lambda i: equilibrium(model, start=starts[i]),
        "once more from the same vessel": lambda i: find_balance(vessel, ATTITUDES[i]),
        "every equilibrium": lambda _: equilibria(model),
        "righting arm": lambda _: righting_arm(model),
    }
    triangles = float(sum(len(mesh.faces) for mesh in vessel.meshes))
    if capytaine is not None and triangles < 20_000:
        calls["Capytaine"] = _capytaine_of(vessel)
    times = {"triangles": triangles} | time_calls(calls, quick)

    # the command
    before = os.times()
    command = [sys.executable, "-m", "buoyancy_mj", "inspect", str(path)]
    subprocess.run(command, check=True, capture_output=True)
    after = os.times()
    times["inspect"] = sum(after[2:4]) - sum(before[2:4])
    return times


def _capytaine_of(vessel: Vessel) -> Callable[[int], object]:
    """Capytaine's hydrostatics of all meshes joined."""
    parts = [mesh.transformed(vessel.rotation, vessel.position) for mesh in vessel.meshes]
    firsts = np.cumsum([0] + [len(part.vertices) for part in parts])
    mesh = capytaine.Mesh(
        vertices=np.vstack([part.vertices for part in parts]),
        faces=np.vstack([part.faces + n for part, n in zip(parts, firsts, strict=False)]),
    )
    body = capytaine.FloatingBody(
        mesh=mesh,
        dofs=capytaine.rigid_body_dofs(rotation_center=vessel.position),
        center_of_mass=vessel.position,
        mass=vessel.mass,
    )
    return lambda _: body.compute_hydrostatics(rho=1000.0, g=9.81)


def describe(results: Results) -> Iterator[str]:
    """Describe each vehicle in a line."""
    for name, row in results.items():
        times = ", ".join(
            f"{what} {1e3 * seconds:,.1f} ms"
            for what, seconds in row.items()
            if what not in ("triangles", "Capytaine")
        )
        yield f"{name}, {row['triangles']:,.0f} triangles: {times}"
        if "Capytaine" in row:
            factor = row["Capytaine"] / row["hydrostatics"]
            yield f"    Capytaine's hydrostatics take {factor:,.0f} x as long"


def rows(results: Results) -> Iterator[Row]:
    """What the statics of the AUV and of the hull take."""
    for name, called in _SHOWN.items():
        row = results.get(name)
        if row is None:
            continue
        factor = row["Capytaine"] / row["hydrostatics"] if "Capytaine" in row else None
        relation = "as fast as Capytaine's" if name == "sauvc_auv" else ""
        yield Row(f"hydrostatics of {called}", describe_time(row["hydrostatics"]), factor, relation)
        for what in ("equilibrium", "every equilibrium", "righting arm", "inspect"):
            yield Row(
                f"{what} of {called}".replace("inspect of", "`inspect` for"),
                describe_time(row[what]),
            )


_SHOWN = {"sauvc_auv": "`sauvc_auv`", "hull": "a hull of 99,456 triangles"}
"""What the pages show, and how they call it."""
