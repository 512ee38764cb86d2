"""Studies of what the methods cost: wall time, and the work that they count themselves."""

import dataclasses
import itertools
import time
from collections.abc import Callable, Mapping

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.paper import solids
from buoyancy_mj.paper.methods import ALL_METHODS, METHODS
from buoyancy_mj.paper.runs import load_scene
from buoyancy_mj.paper.study import Claim, Result, judge, tabulate
from buoyancy_mj.paper.wording import itemize, percent
from buoyancy_mj.scenes.scene import Scene
from buoyancy_mj.scenes.simulation import Simulation
from buoyancy_mj.sea.water import Water
from buoyancy_mj.submersion.convex_hull import ConvexHull
from buoyancy_mj.submersion.methods import Method

# wall time


def measure_timing(quick: bool) -> Result:
    """Measure the wall time of one update by each method, on vehicles that float as they rest."""
    rows: list[tuple[str | float, ...]] = []
    late: dict[str, dict[str, float]] = {}
    for vehicle, height in (("hourglass", -0.1), ("sauvc_auv", -0.17)):
        model = solids.load_model(vehicle)
        late[vehicle] = {}
        for name, method in ALL_METHODS.items():
            times = _update_times(model, method, height, 30 if quick else 300)
            rows.append((vehicle, name, *(1e3 * np.percentile(times, [50, 99, 100]))))
            late[vehicle][name] = float(np.percentile(times, 99))

    # all of them beside the paper's rate
    words = {
        vehicle: itemize({name: f"{1e3 * value:.2g} ms" for name, value in times.items()})
        for vehicle, times in late.items()
    }
    every = [value for times in late.values() for value in times.values()]
    claim = Claim(
        "updates at 60 Hz",
        "60 Hz, 16.7 ms each",
        f"99 % of the updates take less than these times. AUV of 15 meshes: {words['sauvc_auv']}; "
        f"hourglass: {words['hourglass']}",
        judge(max(every) < 1.0 / 60.0, min(every) < 1.0 / 60.0),
    )
    header = ["vehicle", "method", "median [ms]", "99 % below [ms]", "longest [ms]"]
    return Result({"timing": tabulate(header, rows)}, (claim,))


def _update_times(
    model: mujoco.MjModel, method: Method, height: float, repeats: int
) -> NDArray[np.float64]:
    """Wall times (n,) [s] of evaluations of a vehicle at the surface, one timestep apart."""
    data = mujoco.MjData(model)
    data.qpos[2] = height
    mujoco.mj_forward(model, data)
    buoyancy = Buoyancy(model, Water(), method=method)

    def evaluate_later() -> None:
        data.time += 0.01
        buoyancy.evaluate(data)

    return _wall_times(evaluate_later, repeats)


def _wall_times(call: Callable[[], None], repeats: int) -> NDArray[np.float64]:
    """Wall times (n,) [s] of calls, after two that compile and warm."""
    call()
    call()
    stamps = [time.perf_counter()]
    for _ in range(repeats):
        call()
        stamps.append(time.perf_counter())
    return np.array([after - before for before, after in itertools.pairwise(stamps)])


# work that the methods count

_UNSORTED = "convex hull, all vertices"
_SORTED = "convex hull, sorted every 10 steps"
VARIANTS: dict[str, Method] = {
    _UNSORTED: ConvexHull(resort_every=0),
    _SORTED: ConvexHull(),
    "convex hull, sorted every step": ConvexHull(resort_every=1),
    "sections": METHODS["sections"],
}
"""The methods whose work is counted."""
_COUNTS = {
    "calls": "steps",
    "vertices": "vertices to look at",
    "vertex_checks": "vertices looked at",
    "sorts": "sorts",
    "hulls": "hulls",
    "hull_points": "points of hulls",
    "sections": "sections",
    "crossings": "triangles that they meet",
}
"""Columns of the table by the names of the methods' counts."""
_ITERATIONS = ("vertex_checks", "hull_points", "sections")
"""The counts that add up to iterations."""


@dataclasses.dataclass(frozen=True)
class _Work:
    """What the variants do in one scene."""

    counts: Mapping[str, Mapping[str, int]]
    """Counts by variant."""
    volumes: Mapping[str, NDArray[np.float64]]
    """Submerged volumes (steps,) [m^3] by variant."""

    @property
    def hull_points(self) -> int:
        """Vertices that the hull method looks at, and points that it gives to Quickhull."""
        counts = self.counts[_SORTED]
        return counts["vertex_checks"] + counts["hull_points"]

    @property
    def fewer_sections(self) -> float:
        """Part by which sections are fewer than `hull_points`."""
        return 1.0 - self.counts["sections"]["sections"] / self.hull_points

    @property
    def more_triangles(self) -> float:
        """Triangles that the sections meet, over `hull_points`."""
        return self.counts["sections"]["crossings"] / self.hull_points

    @property
    def saved_checks(self) -> float:
        """Part of the looks at vertices that sorting saves."""
        checks = {name: self.counts[name]["vertex_checks"] for name in (_SORTED, _UNSORTED)}
        return 1.0 - checks[_SORTED] / checks[_UNSORTED]

    @property
    def volume_error(self) -> float:
        """Largest error of the volume that sorting brings, over the largest volume."""
        reference = self.volumes[_UNSORTED]
        return float(np.abs(self.volumes[_SORTED] - reference).max() / reference.max())


def measure_work(quick: bool) -> Result:
    """Count what the methods look at, in the paper's runs of 5 s at 0.01 s."""
    names = ["hourglass_drop_still", "hourglass_drop_waves"]
    if not quick:
        names.append("auv_drop_still")

    rows: list[tuple[str | float, ...]] = []
    works = {}
    for name in names:
        scene = dataclasses.replace(load_scene(name), duration=1.0 if quick else 5.0)
        followed = {variant: _follow(scene, method) for variant, method in VARIANTS.items()}
        works[name] = _Work(
            {variant: counts for variant, (_, counts) in followed.items()},
            {variant: volumes for variant, (volumes, _) in followed.items()},
        )
        for variant, counts in works[name].counts.items():
            columns = (float(counts.get(key, np.nan)) for key in _COUNTS)
            iterations = sum(counts.get(key, 0) for key in _ITERATIONS)
            rows.append((name, variant, *columns, float(iterations)))
    header = ["scene", "method", *_COUNTS.values(), "iterations"]
    claims = (_check_iterations(works), _check_sorting(works))
    return Result({"work": tabulate(header, rows)}, claims)


def _follow(scene: Scene, method: Method) -> tuple[NDArray[np.float64], Mapping[str, int]]:
    """Submerged volumes (steps,) [m^3] by a method at the poses of the exact run, and counts."""
    leader = Simulation(scene)
    follower = Buoyancy(leader.model, scene.water, method=method)
    data = mujoco.MjData(leader.model)
    volumes = np.empty(leader.steps)
    for step in range(leader.steps):
        # the same pose and time
        data.qpos[:] = leader.data.qpos
        data.time = leader.data.time
        mujoco.mj_kinematics(leader.model, data)
        mujoco.mj_comPos(leader.model, data)

        volumes[step] = follower.evaluate(data).hull.volume.sum()
        leader.step()
    return volumes, follower.packed.counts


def _check_iterations(works: Mapping[str, _Work]) -> Claim:
    """Check the claim that sections take fewer iterations than the hull."""
    fewer = itemize({name: percent(work.fewer_sections) for name, work in works.items()})
    more = itemize({name: f"{work.more_triangles:.2g} x" for name, work in works.items()})
    return Claim(
        "sections take fewer iterations than the hull",
        "40 % fewer",
        "the paper does not say what it counts. Cross-sections are fewer than the vertices that "
        f"are looked at and the points given to Quickhull, by {fewer}; but the triangles that they "
        f"meet are {more} as many. The wall times of the updates at 60 Hz weigh both fairly",
        judge(
            max(work.more_triangles for work in works.values()) < 0.6,
            min(work.fewer_sections for work in works.values()) >= 0.4,
        ),
    )


def _check_sorting(works: Mapping[str, _Work]) -> Claim:
    """Check the claim that sorting the vertices saves work."""
    saved = itemize({name: percent(work.saved_checks) for name, work in works.items()})
    errors = itemize({name: percent(work.volume_error) for name, work in works.items()})
    fewer = min(work.saved_checks for work in works.values()) > 0.0
    right = max(work.volume_error for work in works.values()) < 0.01
    return Claim(
        "sorting the vertices every 10 steps saves checks",
        "fewer",
        f"{saved} of them are saved; but between sorts a body turns, and its hull's volume is off "
        f"by up to {errors} of the largest",
        judge(fewer and right, fewer),
    )
