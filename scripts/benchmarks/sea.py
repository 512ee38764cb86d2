"""The water's part of a step on still water, in one wave and in many, by models of pressure."""

import dataclasses
import math
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import mujoco
from rich.table import Table

from benchmarks import catamaran
from benchmarks.rows import Row, describe_time
from benchmarks.stretches import Course, Plan, find_starts, time_steps
from buoyancy_mj import JonswapSea, RegularWave, Scene, Start, Water, read_scene
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.assembly import assemble

QUICK = Plan(starts=8, apart=50, steps=3, rounds=3)
THOROUGH = Plan(starts=20, apart=40, steps=5, rounds=10)
"""Over 4 and 8 s."""
STILL, ONE, FEW, MANY = "still water", "1 wave", "64 waves", "260 waves"
"""The seas; each with waves has the same energy."""
ARCHIMEDES, PRESSURE = "archimedes", "froude-krylov"
"""The models of pressure."""

Results = dict[str, dict[str, dict[str, float]]]
"""The water's part of a step [s] by vehicle, by what acts and by sea."""


class Case(NamedTuple):
    """A vehicle in seas."""

    scenes: dict[str, Scene]
    """The scenes by what acts, their water still."""
    height: float
    """Significant wave height [m]."""
    period: float
    """Peak period [s]."""
    seas: tuple[str, ...]
    """The seas in which it is measured."""


def list_cases(folder: Path) -> dict[str, Case]:
    """The AUV in sea state 2, and a catamaran of 4 m in waves that are 25 m long at the peak.

    Drag acts in all of them, as by default. Added mass acts in the scene of the AUV, and on the
    catamaran beside the pressure of waves.

    Args:
        folder: where the model of the catamaran goes.
    """
    auv = read_scene(catalog.scenes()["auv_sea_state_2"])
    boat = Scene(
        title="a catamaran of 4 m",
        vehicle=str(catamaran.write_model(folder)),
        water=Water(density=1025.0),
        start=Start(at="equilibrium"),
    )
    return {
        "auv_sea_state_2": Case(
            {
                pressure: dataclasses.replace(auv, pressure=pressure)
                for pressure in (ARCHIMEDES, PRESSURE)
            },
            height=0.3,
            period=3.5,
            seas=(STILL, ONE, FEW, MANY),
        ),
        "catamaran of 4 m": Case(
            {
                ARCHIMEDES: boat,
                f"{PRESSURE}, added mass": dataclasses.replace(
                    boat, pressure=PRESSURE, added_mass="ellipsoid"
                ),
            },
            height=0.5,
            period=4.0,
            seas=(STILL, ONE, FEW),
        ),
    }


def enter_sea(scene: Scene, case: Case, sea: str) -> Scene:
    """The scene in one of the seas."""
    waves = {
        STILL: (),
        ONE: RegularWave(case.height / math.sqrt(8.0), period=case.period),
        FEW: JonswapSea(case.height, case.period, components=64, spreading=10.0, seed=1),
        MANY: JonswapSea(case.height, case.period, components=260, spreading=10.0, seed=1),
    }
    return dataclasses.replace(scene, water=dataclasses.replace(scene.water, waves=waves[sea]))


def measure(quick: bool) -> Results:
    """Measure both vehicles."""
    plan = QUICK if quick else THOROUGH
    with tempfile.TemporaryDirectory() as folder:
        return {name: _measure_case(case, plan) for name, case in list_cases(Path(folder)).items()}


def _measure_case(case: Case, plan: Plan) -> dict[str, dict[str, float]]:
    """What a step takes longer than without water, from the same states [s]."""
    courses = {}
    for acting, scene in case.scenes.items():
        bare, _, _ = assemble(dataclasses.replace(scene, start=Start()))
        for sea in case.seas:
            model, data, _ = assemble(enter_sea(scene, case, sea), with_water=True)
            mujoco.mj_forward(model, data)
            starts = find_starts(model, data, plan)
            courses[acting, sea, "wet"] = Course(model, starts)
            courses[acting, sea, "bare"] = Course(bare, starts)
    times = time_steps(courses, plan)
    return {
        acting: {sea: times[acting, sea, "wet"] - times[acting, sea, "bare"] for sea in case.seas}
        for acting in case.scenes
    }


def describe(results: Results) -> Iterator[Table | str]:
    """Describe all seas in a table, and in a line what each vehicle pays for waves."""
    seas = (STILL, ONE, FEW, MANY)
    table = Table(title="the water's part of a step, processor time; factors are against 1 wave")
    for column in ("vehicle", "acting", *seas):
        table.add_column(column, justify="right")
    for name, rows in results.items():
        for acting, row in rows.items():
            table.add_row(name, acting, *(_describe_time(row, sea) for sea in seas))
    yield table

    for name, rows in results.items():
        (_, plain), (label, full) = rows.items()
        factors = [f"{label} takes {full[FEW] / plain[FEW]:.2f} x of {ARCHIMEDES} in {FEW}"]
        factors.append(f"{full[FEW] / plain[ONE]:.2f} x of {ARCHIMEDES} in {ONE}")
        if MANY in plain:
            both = " and ".join(f"{row[MANY] / row[FEW]:.2f} x" for row in (plain, full))
            factors.append(f"{MANY} take {both} of {FEW}")
        yield f"{name}: {', '.join(factors)}"


def _describe_time(row: dict[str, float], sea: str) -> str:
    """A time, and how often as long it is as in one wave."""
    if sea not in row:
        return ""
    return f"{row[sea] * 1e6:,.1f} us, {row[sea] / row[ONE]:.2f} x"


def rows(results: Results) -> Iterator[Row]:
    """What many waves cost, and what the pressure of waves does."""
    for name, found in results.items():
        (_, plain), (full_label, full) = found.items()
        where = f"water in a step of {name.replace('auv_sea_state_2', '`auv_sea_state_2`')}"
        what = f"{where}, {FEW}"
        yield Row(
            f"{what}, {ARCHIMEDES}",
            describe_time(plain[FEW]),
            plain[FEW] / plain[ONE],
            f"as long as in {ONE}",
            first=name == "auv_sea_state_2",
        )
        yield Row(
            f"{what}, {full_label}",
            describe_time(full[FEW]),
            full[FEW] / plain[FEW],
            f"as long as {ARCHIMEDES}",
        )
        if MANY in plain:
            for label, row in found.items():
                yield Row(
                    f"{where}, {MANY}, {label}",
                    describe_time(row[MANY]),
                    row[MANY] / row[FEW],
                    f"as long as in {FEW}",
                )
