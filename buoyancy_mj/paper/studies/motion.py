"""Studies of the centre of gravity over time, on waves of the paper's height and frequency."""

import dataclasses
import itertools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.loads.damping import Damping
from buoyancy_mj.paper import solids
from buoyancy_mj.paper.methods import BASIC_METHODS, DENSITY
from buoyancy_mj.paper.runs import SURFACES, load_scene, run, steps_per_period, swing
from buoyancy_mj.paper.study import Claim, Result, judge, tabulate
from buoyancy_mj.paper.wording import itemize
from buoyancy_mj.scenes.scene_vehicle import Start

SWING_LIMIT = 0.05
"""What the paper allows the centre of gravity on waves [m]."""


def measure_cog(quick: bool) -> Result:
    """Measure the centre of gravity's z over 5 s at 0.01 s, on still water and on waves."""
    tables: dict[str, dict[str, NDArray[np.float64]]] = {}
    swings: dict[str, float] = {}
    for vehicle, name in (("hourglass", "hourglass_drop_waves"), ("AUV", "auv_waves")):
        columns: dict[str, NDArray[np.float64]] = {}
        for surface, water in SURFACES.items():
            scene = load_scene(name)
            scene = dataclasses.replace(scene, water=water, duration=0.5 if quick else 5.0)
            for label, method in BASIC_METHODS.items():
                moments = list(run(scene, method))
                columns.setdefault("time [s]", np.array([m.time for m in moments]))
                heights = np.array([m.height for m in moments])
                columns[f"{surface}, {label} [m]"] = heights
                if label == "exact" and surface != "still":
                    swings[f"{vehicle}, {surface}"] = swing(heights, scene.timestep)
        tables[f"cog_{vehicle.lower()}"] = columns
    claim = Claim(
        "the centre of gravity oscillates within 0.05 m on the waves, as our scenes have them",
        "within 0.05 m",
        "half the range of its z over the last wave of 5 s: "
        + itemize({name: f"{value:.2f} m" for name, value in swings.items()}),
        judge(max(swings.values()) < SWING_LIMIT),
    )
    return Result(tables, (claim,))


class Combination(NamedTuple):
    """One run of the hourglass on waves, a row of the table."""

    surface: str
    """One of `SURFACES`."""
    drag: str
    """Drag of the water: "estimated" or "none"."""
    mass: float
    """Mass over displacement."""
    damping_rate: float
    """Damping against the world [1/s]."""
    swing: float
    """Half the range of the centre of gravity's z over the last wave [m]."""
    largest_force: float
    """Largest buoyancy during that wave [N]."""

    @property
    def is_calm(self) -> bool:
        """Whether it stays within the limit, in the water and not flung out of it."""
        return self.swing < SWING_LIMIT and self.largest_force > 0.0


_HEADER = (
    "surface",
    "drag of the water",
    "mass over displacement",
    "damping [1/s]",
    "swing [m]",
    "largest force [N]",
)
"""Names of the columns of `Combination`."""


def measure_oscillation(quick: bool) -> Result:
    """Find the masses, dampings and waves with which the centre of gravity stays within 0.05 m."""
    masses = (0.4, 0.73) if quick else (0.2, 0.4, 0.5, 0.6, 0.73, 0.9, 0.99)
    rates = (0.0, 30.0) if quick else (0.0, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0)
    surfaces = ("moving level", "travelling wave")
    rows = [
        _run_combination(surface, damping, mass, rate)
        for surface, damping, mass, rate in itertools.product(
            surfaces, (Damping(), None), masses, rates
        )
    ]
    return Result({"oscillation": tabulate(_HEADER, rows)}, (_check_oscillation(rows, masses),))


def _run_combination(
    surface: str, damping: Damping | None, mass: float, damping_rate: float
) -> Combination:
    """Run the hourglass on waves, from a start at which its base touches the water."""
    start = Start(position=(0.0, 0.0, solids.HALF_HEIGHT))
    scene = dataclasses.replace(
        load_scene("hourglass_drop_waves"), water=SURFACES[surface], damping=damping, start=start
    )
    displacement = DENSITY * solids.hourglass().volume
    moments = list(run(scene, BASIC_METHODS["exact"], mass * displacement, damping_rate))

    last_wave = moments[-steps_per_period(scene.timestep) :]
    return Combination(
        surface,
        "estimated" if damping else "none",
        mass,
        damping_rate,
        swing(np.array([m.height for m in moments]), scene.timestep),
        max(m.force for m in last_wave),
    )


def _check_oscillation(rows: Sequence[Combination], masses: Sequence[float]) -> Claim:
    """Check the claim that the swing stays within its limit."""
    calm = [row for row in rows if row.is_calm]

    # the damping that always gives it, and where less does
    least = {mass: _least_damping(rows, mass) for mass in masses}
    always = itemize({f"mass {mass:g}": f"{rate:g} /s" for mass, rate in least.items()})
    sooner = [
        f"{row.surface}, drag {row.drag}, mass {row.mass:g}, {row.damping_rate:g} /s"
        for row in calm
        if row.damping_rate < least[row.mass]
    ]
    undamped = [row.swing for row in rows if row.damping_rate == 0.0]
    return Claim(
        "the centre of gravity oscillates within 0.05 m on the waves, "
        "for some mass, damping and wave",
        "within 0.05 m",
        f"{len(calm)} of {len(rows)} combinations do. Damping against the world, which physics "
        "engines offer and water does not, is enough on both kinds of waves, with the water's "
        f"drag or without, from these rates up, by mass over displacement: {always}. "
        f"Below them only these combinations do: {'; '.join(sooner) or 'none'}. Without such "
        f"damping the swing is {min(undamped):.2f} to {max(undamped):.2f} m",
        judge(len(calm) == len(rows), bool(calm)),
    )


def _least_damping(rows: Sequence[Combination], mass: float) -> float:
    """Damping [1/s] from which on a mass is calm on both surfaces, with the water's drag or not."""
    same_mass = [row for row in rows if row.mass == mass]
    largest_failing = max((row.damping_rate for row in same_mass if not row.is_calm), default=-1.0)
    enough = [row.damping_rate for row in same_mass if row.damping_rate > largest_failing]
    return min(enough, default=np.inf)
