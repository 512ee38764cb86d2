"""Studies of bodies that move: forces and the centre of gravity over time."""

import dataclasses
from collections.abc import Iterator, Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.kernels import clip
from buoyancy_mj.loads.damping import Damping
from buoyancy_mj.paper import solids
from buoyancy_mj.paper.runs import FREQUENCY, SURFACES, run, scene_of, steps, swing
from buoyancy_mj.paper.statics import DENSITY, METHODS
from buoyancy_mj.paper.study import Claim, Result, listed, table_of, verdict
from buoyancy_mj.scenes.assembly import assemble
from buoyancy_mj.scenes.scene import Scene, Start
from buoyancy_mj.submersion.convex_hull import ConvexHull
from buoyancy_mj.submersion.methods import Method
from buoyancy_mj.submersion.submerge import submerge

SWING = 0.05
"""What the paper allows the centre of gravity on waves [m]."""


def force(quick: bool) -> Result:
    """Buoyancy against submersion, slowly lowered and in a drop; and how late it is when the body turns as it falls."""
    mesh = solids.hourglass()
    dz = np.linspace(0.0, 2.0 * solids.HALF_HEIGHT, 21 if quick else 81)
    places = [np.array([0.0, 0.0, solids.HALF_HEIGHT - t]) for t in dz]
    tilted = scene_of("hourglass_drop_still")
    upright = dataclasses.replace(tilted, start=Start(position=(0.0, 0.0, 0.35)))
    weight = DENSITY * 9.81
    slow = {
        "dz [m]": dz,
        "rho g V, closed form [N]": weight * solids.hourglass_volume(dz, solids.SECTIONS),
    }
    drop: dict[str, NDArray[np.float64]] = {}
    told, late = {}, {}
    for name in ("exact", "convex hull", "sections"):
        method = METHODS[name]
        slow[f"{name} [N]"] = weight * np.array(
            [solids.wet_volume([mesh], p, np.eye(3), method) for p in places]
        )
        moments = list(run(upright, method))
        drop.setdefault("time [s]", np.array([m.time for m in moments]))
        drop |= {
            f"{name}, dz [m]": np.array([m.draft for m in moments]),
            f"{name}, force [N]": np.array([m.force for m in moments]),
        }
        off = np.array([found - present for found, present in _against_present(tilted, method)])
        late[name] = (
            _longest(np.abs(off) > 0.01 * np.abs(slow[f"{name} [N]"]).max()) * tilted.timestep
        )
        told[name] = f"up to {np.abs(off).max():.2g} N off for {1e3 * late[name]:.0f} ms"
    return Result(
        {"force": slow, "force_in_a_drop": drop},
        (
            Claim(
                "the force adapts within 16 ms",
                "16 ms",
                f"against the force of the present pose, in a drop rolled by 20 degrees: {listed(told)}, where the time is "
                "that for which more than 1 % of the largest force is missing: the hull waits for its vertices to be sorted",
                verdict(max(late.values()) <= 0.016, min(late.values()) <= 0.016),
            ),
        ),
    )


def _against_present(scene: Scene, method: Method) -> Iterator[tuple[float, float]]:
    """Buoyancy [N] at each step of a scene, and what the method finds at the same pose without its past."""
    weight = scene.water.density * 9.81
    for buoyancy, data, wet in steps(scene, method):
        present = (
            dataclasses.replace(method, resort_every=0)
            if isinstance(method, ConvexHull)
            else method
        )
        found = sum(
            submerge(
                h.mesh, data.geom_xpos[h.geom], data.geom_xmat[h.geom].reshape(3, 3), method=present
            ).volume
            for h in buoyancy.hulls
        )
        yield weight * float(wet[:, clip.VOLUME].sum()), weight * found


def _longest(flags: NDArray[np.bool_]) -> int:
    """Length of the longest run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(int)))
    return int(np.max(edges[1::2] - edges[::2], initial=0))


def distributed(quick: bool) -> Result:
    """Buoyancy of each mesh of the AUV at rest, and whether the meshes' forces act like their resultant."""
    scene = scene_of("auv_drop_still")
    scene = dataclasses.replace(
        scene, start=Start(position=(0.0, 0.0, -0.12)), duration=1.0 if quick else 20.0
    )
    model, data, _ = assemble(scene)
    buoyancy = Buoyancy(model, scene.water)
    with buoyancy.installed():
        mujoco.mj_step(model, data, round(scene.duration / scene.timestep))
    mujoco.mj_forward(model, data)
    loads = buoyancy.evaluate(data)
    rows = [
        *zip(
            loads.names, loads.hull.volume, loads.hull.centroid, loads.hull.force[:, 2], strict=True
        )
    ]
    rows.append(
        (
            "all",
            float(loads.total.volume),
            loads.total.centroid,
            float(loads.hull.force[:, 2].sum()),
        )
    )
    # the same on waves, at each step of a run: what the joints feel
    apart = strongest = 0.0
    waves = dataclasses.replace(scene_of("auv_waves"), duration=0.5 if quick else 5.0)
    for name in ("exact", "convex hull", "sections"):
        for each, one in (_joint_forces(*step) for step in steps(waves, METHODS[name])):
            apart, strongest = (
                max(apart, float(np.abs(each - one).max())),
                max(strongest, float(np.abs(each).max())),
            )
    names = ["mesh", "volume [m^3]", "x [m]", "y [m]", "z [m]", "force [N]"]
    table = table_of(
        names, [(name, float(v), *map(float, centroid), float(f)) for name, v, centroid, f in rows]
    )
    return Result(
        {"distributed": table},
        (
            Claim(
                "forces of several meshes of one body, or their resultant at the volume-weighted centroid",
                "act alike",
                f"over {waves.duration:g} s of the AUV on waves, by all three methods, the joint's forces differ by "
                f"{apart:.1g} of up to {strongest:.0f} N and N m",
                verdict(apart < 1e-9 * strongest),
            ),
        ),
    )


def cog(quick: bool) -> Result:
    """The centre of gravity's z over 5 s at 0.01 s, on still water and on both kinds of waves."""
    tables: dict[str, dict[str, NDArray[np.float64]]] = {}
    swings: dict[tuple[str, str], float] = {}
    for vehicle, name in (("hourglass", "hourglass_drop_waves"), ("AUV", "auv_waves")):
        columns: dict[str, NDArray[np.float64]] = {}
        for surface, water in SURFACES.items():
            scene = dataclasses.replace(scene_of(name), water=water, duration=1.0 if quick else 5.0)
            for method in ("exact", "convex hull", "sections"):
                moments = list(run(scene, METHODS[method]))
                columns.setdefault("time [s]", np.array([m.time for m in moments]))
                heights = np.array([m.height for m in moments])
                columns[f"{surface}, {method} [m]"] = heights
                if method == "exact":
                    swings[vehicle, surface] = swing(heights, scene.timestep)
        tables[f"cog_{vehicle.lower()}"] = columns
    told = ", ".join(
        f"{swings[v, s]:.2f} m ({v}, {s})"
        for v in ("hourglass", "AUV")
        for s in SURFACES
        if s != "still"
    )
    return Result(
        tables,
        (
            Claim(
                "the centre of gravity oscillates within 0.05 m on the waves, as our scenes have them",
                "within 0.05 m",
                f"half the range of its z over the last wave of 5 s: {told}",
                verdict(max(s for (_, name), s in swings.items() if name != "still") < SWING),
            ),
        ),
    )


def oscillation(quick: bool) -> Result:
    """Which mass, damping and kind of wave keep the hourglass's centre of gravity within 0.05 m."""
    whole = DENSITY * solids.hourglass().volume
    fractions = (0.4, 0.73) if quick else (0.2, 0.4, 0.5, 0.6, 0.73, 0.9, 0.99)
    rates = (0.0, 30.0) if quick else (0.0, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0)
    rows = []
    for surface in ("moving level", "travelling wave"):
        for damping in (Damping(), None):
            for fraction in fractions:
                for rate in rates:
                    scene = dataclasses.replace(
                        scene_of("hourglass_drop_waves"),
                        water=SURFACES[surface],
                        damping=damping,
                        # the base touches the water
                        start=Start(position=(0.0, 0.0, solids.HALF_HEIGHT)),
                    )
                    moments = list(run(scene, METHODS["exact"], mass=fraction * whole, rate=rate))
                    half_range = swing(np.array([m.height for m in moments]), scene.timestep)
                    last = moments[-round(1.0 / FREQUENCY / scene.timestep) :]
                    rows.append(
                        (
                            surface,
                            "estimated" if damping else "none",
                            fraction,
                            rate,
                            half_range,
                            max(m.force for m in last),
                        )
                    )
    names = [
        "surface",
        "drag of the water",
        "mass over displacement",
        "damping [1/s]",
        "swing [m]",
        "largest force [N]",
    ]
    # in the water during the last wave, not flung out of it
    within = [row for row in rows if row[4] < SWING and row[5] > 0.0]
    always = listed({f"mass {part:g}": f"{_least(rows, part):g} /s" for part in fractions})
    sooner = [
        f"{surface}, drag {drag}, mass {part:g}, {rate:g} /s"
        for surface, drag, part, rate, *_ in within
        if rate < _least(rows, part)
    ]
    free = [row[4] for row in rows if row[3] == 0.0]
    return Result(
        {"oscillation": table_of(names, rows)},
        (
            Claim(
                "the centre of gravity oscillates within 0.05 m on the waves, for some mass, damping and wave",
                "within 0.05 m",
                f"{len(within)} of {len(rows)} combinations do. On both kinds of waves, with the water's drag or not, a "
                "damping against the world, as physics engines offer and water does not, gives it from "
                f"{always} on (mass over displacement); below that only: {'; '.join(sooner) or 'none'}. Without such a "
                f"damping the swing is {min(free):.2f} to {max(free):.2f} m",
                verdict(len(within) == len(rows), bool(within)),
            ),
        ),
    )


def rest(quick: bool) -> Result:
    """The force once a drop on still water has come to rest."""
    duration = 5.0 if quick else 60.0
    tables = {}
    spread: dict[str, float] = {}
    early: dict[str, float] = {}
    for vehicle, name in (("hourglass", "hourglass_drop_still"), ("AUV", "auv_drop_still")):
        columns: dict[str, NDArray[np.float64]] = {}
        for method in ("exact", "convex hull", "sections"):
            # the hulls of the AUV take a while, and say the same sooner
            lasts = min(duration, 20.0) if (vehicle, method) == ("AUV", "convex hull") else duration
            scene = dataclasses.replace(scene_of(name), duration=lasts)
            moments = list(run(scene, METHODS[method]))
            forces = np.array([m.force for m in moments])
            columns[f"{method} [N]"] = forces[-200:]
            columns["time before the end [s]"] = scene.timestep * np.arange(-199.0, 1.0)
            spread[f"{vehicle}, {method}, {scene.duration:g} s"] = float(forces[-200:].std())
            early[f"{vehicle}, {method}"] = float(
                forces[round(3.0 / scene.timestep) : round(5.0 / scene.timestep)].std()
            )
        tables[f"rest_{vehicle.lower()}"] = columns
    return Result(
        tables,
        (
            Claim(
                "standard deviation of the force at rest",
                "below 0.5 N",
                "over the last 2 s: "
                + listed({name: f"{value:.2g} N" for name, value in spread.items()})
                + "; over 3 to 5 s, still bobbing: "
                + listed({name: f"{value:.2g} N" for name, value in early.items()}),
                verdict(
                    max(spread.values()) < 0.5 and max(early.values()) < 0.5,
                    max(spread.values()) < 0.5,
                ),
            ),
        ),
    )


def _least(rows: Sequence[tuple[str, str, float, float, float, float]], part: float) -> float:
    """Damping [1/s] from which on a mass stays within the swing on both surfaces, with the water's drag and without."""
    failing = [
        rate
        for _, _, fraction, rate, half_range, force in rows
        if fraction == part and not (half_range < SWING and force > 0.0)
    ]
    rates = sorted({rate for _, _, fraction, rate, *_ in rows if fraction == part})
    return next((rate for rate in rates if rate > max(failing, default=-1.0)), np.inf)


def _joint_forces(
    buoyancy: Buoyancy, data: mujoco.MjData, wet: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """What the joint of a free body feels (nv,) of the forces of its meshes, one by one, and of their resultant."""
    (body,) = buoyancy.bodies.tolist()
    each, one = np.zeros((2, buoyancy.model.nv))
    some = wet[wet[:, clip.VOLUME] > 0.0]
    upward = np.array([0.0, 0.0, buoyancy.water.density * buoyancy.gravity])

    def apply(volume: float, centroid: NDArray[np.float64], out: NDArray[np.float64]) -> None:
        mujoco.mj_applyFT(buoyancy.model, data, volume * upward, np.zeros(3), centroid, body, out)

    for row in some:
        apply(row[clip.VOLUME], row[clip.CENTROID], each)
    if len(some):
        whole = some[:, clip.VOLUME].sum()
        apply(whole, some[:, clip.VOLUME] @ some[:, clip.CENTROID] / whole, one)
    return each, one
