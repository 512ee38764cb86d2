"""Studies of forces: how late they are, whether one resultant replaces them, how still they get."""

import dataclasses
from collections.abc import Iterator

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.kernels import clip
from buoyancy_mj.paper import solids
from buoyancy_mj.paper.methods import BASIC_METHODS, SPECIFIC_WEIGHT
from buoyancy_mj.paper.runs import load_scene, run, run_steps
from buoyancy_mj.paper.study import Claim, Column, Result, Table, judge, tabulate
from buoyancy_mj.paper.wording import itemize
from buoyancy_mj.scenes.assembly import assemble
from buoyancy_mj.scenes.scene import Scene
from buoyancy_mj.scenes.scene_vehicle import Start
from buoyancy_mj.submersion.convex_hull import ConvexHull
from buoyancy_mj.submersion.methods import Method
from buoyancy_mj.submersion.submerge import submerge


def measure_force(quick: bool) -> Result:
    """Measure buoyancy against submersion, and how late it is when the body turns as it falls."""
    mesh = solids.hourglass()
    dz, positions = solids.immersions(21 if quick else 81)
    tilted = load_scene("hourglass_drop_still")
    tilted = dataclasses.replace(tilted, duration=1.5 if quick else tilted.duration)
    upright = dataclasses.replace(tilted, start=Start(position=(0.0, 0.0, 0.35)))

    exact = SPECIFIC_WEIGHT * solids.hourglass_volume(dz, solids.SIDES)
    slow = {"dz [m]": dz, "rho g V, closed form [N]": exact}
    drop: dict[str, NDArray[np.float64]] = {}
    errors: dict[str, str] = {}
    delays: dict[str, float] = {}
    for name, method in BASIC_METHODS.items():
        # lowered slowly
        forces = SPECIFIC_WEIGHT * np.array(
            [solids.submerged_volume([mesh], p, solids.UPRIGHT, method) for p in positions]
        )
        slow[f"{name} [N]"] = forces

        # dropped upright
        moments = list(run(upright, method))
        drop.setdefault("time [s]", np.array([m.time for m in moments]))
        drop[f"{name}, dz [m]"] = np.array([m.draft for m in moments])
        drop[f"{name}, force [N]"] = np.array([m.force for m in moments])

        # dropped with a roll
        error = np.abs([force - present for force, present in _present_forces(tilted, method)])
        delays[name] = _longest_run(error > 0.01 * np.abs(forces).max()) * tilted.timestep
        errors[name] = f"up to {error.max():.2g} N off for {1e3 * delays[name]:.0f} ms"
    claim = Claim(
        "the force adapts within 16 ms",
        "16 ms",
        "in a drop rolled by 20 degrees, beside the force of the present pose: "
        f"{itemize(errors)}. Each time is how long more than 1 % of the largest force is missing: "
        "the hull waits for its vertices to be sorted",
        judge(max(delays.values()) <= 0.016, min(delays.values()) <= 0.016),
    )
    return Result({"force": slow, "force_in_a_drop": drop}, (claim,))


def _present_forces(scene: Scene, method: Method) -> Iterator[tuple[float, float]]:
    """Buoyancy [N] at each step of a scene, and that of the same pose without the method's past."""
    present = method
    if isinstance(method, ConvexHull):
        present = dataclasses.replace(method, resort_every=0)

    specific_weight = scene.water.density * 9.81
    for buoyancy, data, submersions in run_steps(scene, method):
        volume = 0.0
        for hull in buoyancy.hulls:
            rotation = data.geom_xmat[hull.geom].reshape(3, 3)
            position = data.geom_xpos[hull.geom]
            volume += submerge(hull.mesh, position, rotation, method=present).volume
        force = specific_weight * float(submersions[:, clip.VOLUME].sum())
        yield force, specific_weight * volume


def _longest_run(flags: NDArray[np.bool_]) -> int:
    """Length of the longest run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(int)))
    return int(np.max(edges[1::2] - edges[::2], initial=0))


def measure_distributed(quick: bool) -> Result:
    """Measure the buoyancy of each mesh of the AUV, and whether a resultant acts alike."""
    table = _forces_at_rest(1.0 if quick else 20.0)

    # what the joint feels at each step of a run on waves, by all methods
    scene = dataclasses.replace(load_scene("auv_waves"), duration=0.2 if quick else 5.0)
    difference = largest = 0.0
    for method in BASIC_METHODS.values():
        for step in run_steps(scene, method):
            each, resultant = _joint_forces(*step)
            difference = max(difference, float(np.abs(each - resultant).max()))
            largest = max(largest, float(np.abs(each).max()))
    claim = Claim(
        "forces of several meshes of one body, or their resultant at the volume-weighted centroid",
        "act alike",
        f"over {scene.duration:g} s of the AUV on waves, by all three methods, the joint's forces "
        f"differ by {difference:.1g} of up to {largest:.0f} N and N m",
        judge(difference < 1e-9 * largest),
    )
    return Result({"distributed": table}, (claim,))


def _forces_at_rest(duration: float) -> Table:
    """Volumes, centroids and forces of the AUV's meshes after a while on still water."""
    scene = dataclasses.replace(
        load_scene("auv_drop_still"), start=Start(position=(0.0, 0.0, -0.12)), duration=duration
    )

    # let it settle
    model, data, _ = assemble(scene)
    buoyancy = Buoyancy(model, scene.water)
    with buoyancy.installed():
        mujoco.mj_step(model, data, round(scene.duration / scene.timestep))
    mujoco.mj_forward(model, data)

    # one row for each mesh, and one for all
    loads = buoyancy.evaluate(data)
    forces = loads.hull.force[:, 2]
    rows: list[tuple[str | float, ...]] = [
        (name, float(volume), *centroid.tolist(), float(force))
        for name, volume, centroid, force in zip(
            loads.names, loads.hull.volume, loads.hull.centroid, forces, strict=True
        )
    ]
    total = loads.total
    rows.append(("all", float(total.volume), *total.centroid.tolist(), float(forces.sum())))
    return tabulate(["mesh", "volume [m^3]", "x [m]", "y [m]", "z [m]", "force [N]"], rows)


def _joint_forces(
    buoyancy: Buoyancy, data: mujoco.MjData, submersions: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Generalized forces (nv,) on a free body: of its meshes one by one, and of their resultant."""
    (body,) = buoyancy.bodies.tolist()
    upward = np.array([0.0, 0.0, buoyancy.water.density * buoyancy.gravity])

    def apply(volume: float, centroid: NDArray[np.float64], out: NDArray[np.float64]) -> None:
        mujoco.mj_applyFT(buoyancy.model, data, volume * upward, np.zeros(3), centroid, body, out)

    # one by one
    each = np.zeros(buoyancy.model.nv)
    wet = submersions[submersions[:, clip.VOLUME] > 0.0]
    volumes = wet[:, clip.VOLUME]
    centroids = wet[:, clip.CENTROID]
    for volume, centroid in zip(volumes, centroids, strict=True):
        apply(volume, centroid, each)

    # the resultant
    resultant = np.zeros(buoyancy.model.nv)
    if len(wet):
        apply(volumes.sum(), volumes @ centroids / volumes.sum(), resultant)
    return each, resultant


def measure_rest(quick: bool) -> Result:
    """Measure the force once a drop on still water has come to rest."""
    duration = 3.2 if quick else 60.0
    tables: dict[str, dict[str, Column]] = {}
    late: dict[str, float] = {}
    early: dict[str, float] = {}
    for vehicle, name in (("hourglass", "hourglass_drop_still"), ("AUV", "auv_drop_still")):
        columns: dict[str, Column] = {}
        for method in BASIC_METHODS:
            # the hulls of the AUV are slow to compute, and show the same sooner
            slow = (vehicle, method) == ("AUV", "convex hull")
            scene = load_scene(name)
            scene = dataclasses.replace(scene, duration=min(duration, 20.0) if slow else duration)
            forces = np.array([moment.force for moment in run(scene, BASIC_METHODS[method])])

            # the last 2 s, and those while it still bobs
            columns[f"{method} [N]"] = forces[-200:]
            columns["time before the end [s]"] = scene.timestep * np.arange(-199.0, 1.0)
            late[f"{vehicle}, {method}, {scene.duration:g} s"] = float(forces[-200:].std())
            bobbing = forces[round(3.0 / scene.timestep) : round(5.0 / scene.timestep)]
            early[f"{vehicle}, {method}"] = float(bobbing.std())
        tables[f"rest_{vehicle.lower()}"] = columns
    calm = max(late.values()) < 0.5
    claim = Claim(
        "standard deviation of the force at rest",
        "below 0.5 N",
        "over the last 2 s: "
        + itemize({name: f"{value:.2g} N" for name, value in late.items()})
        + "; over 3 to 5 s, still bobbing: "
        + itemize({name: f"{value:.2g} N" for name, value in early.items()}),
        judge(calm and max(early.values()) < 0.5, calm),
    )
    return Result(tables, (claim,))
