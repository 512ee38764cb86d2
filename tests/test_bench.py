"""The benchmarks run, and find what they say that they measure; how fast is not asked here."""

import importlib
import json
import subprocess
import sys
from pathlib import Path

import mujoco
import numpy as np
import pytest

from buoyancy_mj import equilibrium

ROOT = Path(__file__).parent.parent
NAMES = ("submersion", "tree", "caches", "sea", "profile", "vehicle", "statics", "memory")


@pytest.fixture
def modules(monkeypatch):
    """Modules of the folder scripts, by their names."""
    monkeypatch.syspath_prepend(str(ROOT / "scripts"))
    return importlib.import_module


@pytest.mark.long
@pytest.mark.slow
def test_benchmarks_measure_print_and_save(tmp_path):
    # one process for all, since the packages beside which they measure are slow to import
    command = [sys.executable, "scripts/bench.py", "--quick", "--only", *NAMES]
    command += ["--save", str(tmp_path / "saved.json"), "--plot", str(tmp_path / "speed.png")]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    for printed in (
        "one submersion",
        "by the tree",
        "right after another",
        "eight thrusters",
        "water's part of a step",
        "where a step goes",
        "hull, 1,",
        "memory of auv_waves",
    ):
        assert printed in done.stdout
    saved = json.loads((tmp_path / "saved.json").read_text())
    assert list(saved["results"]) == list(NAMES)
    assert all(saved["results"].values())
    assert saved["machine"]["vectors"]
    assert (tmp_path / "speed.png").stat().st_size > 10_000

    # the parts of a step
    for row in saved["results"]["profile"].values():
        assert {"engine", "sea", "walk", "pressure", "drag", "added mass", "projection"} <= set(row)


# a run beside an earlier one ----------------------------------------------------------------------


def compare(modules, results, earlier, again):
    """The changes, where each benchmark that is measured again gives what `again` has of it."""
    comparison = modules("benchmarks.comparison")
    asked = []

    def measure(name):
        asked.append(name)
        return again[name]

    return comparison.compare(results, earlier, measure), asked


def test_what_is_slower_each_time_is_flagged(modules):
    earlier = {"step": {"auv": {"with": 10.0, "without": 5.0}}, "tree": {"ball": 1.0}}
    results = {"step": {"auv": {"with": 11.0, "without": 5.0}}, "tree": {"ball": 1.04}}
    again = {"step": {"auv": {"with": 10.9, "without": 4.9}}}
    changes, asked = compare(modules, results, earlier, again)
    assert asked == ["step", "step"]
    lines = list(modules("benchmarks.comparison").describe_changes(changes))
    assert lines[0] == "SLOWER 1.09 x  step/auv/with: 10.9, was 10"
    assert lines[1] == "2 of 3 values are within 5%; the middle one is 1.04 x as slow"
    assert len(lines) == 2


def test_what_is_slower_once_rings_no_alarm(modules):
    earlier = {"step": {"with": 10.0, "without": 5.0}}
    results = {"step": {"with": 13.0, "without": 5.0}}
    changes, asked = compare(modules, results, earlier, {"step": {"with": 10.2, "without": 6.0}})
    assert asked == ["step"]
    assert modules("benchmarks.comparison").find_slower(changes) == []
    assert results == {"step": {"with": 10.2, "without": 5.0}}


def test_less_is_worse_where_more_is_better(modules):
    earlier = {"real_time": {"headless": 100.0}, "batch": {"auv": {"2 threads": 50.0}}}
    results = {"real_time": {"headless": 80.0}, "batch": {"auv": {"2 threads": 60.0}}}
    changes, _ = compare(modules, results, earlier, {"real_time": {"headless": 90.0}})
    slower = modules("benchmarks.comparison").find_slower(changes)
    assert [(change.name, change.now) for change in slower] == [("real_time/headless", 90.0)]


def test_numbers_of_triangles_and_differences_are_not_compared(modules):
    earlier = {"statics": {"ball": {"triangles": 10}}, "profile": {"auv": {"sea": 1.0}}}
    results = {"statics": {"ball": {"triangles": 20}}, "profile": {"auv": {"sea": 2.0}}}
    assert compare(modules, results, earlier, {}) == ([], [])


# what the pages show ------------------------------------------------------------------------------


@pytest.mark.slow
def test_the_pages_show_the_runs_that_are_saved(modules):
    pages, runs, bench = modules("benchmarks.pages"), modules("benchmarks.runs"), modules("bench")
    saved = runs.read_runs()
    for page in pages.PAGES:
        text = page.read_text()
        assert "<!-- written by scripts/bench.py: " in text
        assert text == pages.render(text, saved, bench.ROWS), "run scripts/bench.py --pages"


def test_a_block_has_a_column_for_each_machine(modules):
    pages, rows, runs = (modules(f"benchmarks.{name}") for name in ("pages", "rows", "runs"))

    def give(results):
        yield rows.Row("a step", rows.describe_time(results), results / 1e-6, "as long", first=True)
        yield rows.Row("a day", "24 h")

    known = [
        runs.Run({"processor": "One", "vectors": "AVX2", "day": "2026-11-27"}, {"step": 2.5e-6}),
        runs.Run({"processor": "Other", "vectors": "NEON", "cores": "4"}, {"step": 0.0421}),
    ]
    marks = "<!-- written by scripts/bench.py: {} -->\nold\n<!-- end -->\n"
    text = "before\n" + marks.format("first") + "between\n" + marks.format("machines") + "after\n"
    assert pages.render(text, known, {"step": give}).splitlines() == [
        "before",
        "<!-- written by scripts/bench.py: first -->",
        "",
        "| measured | One, AVX2 | Other, NEON | the factor is | `--only` |",
        "| --- | ---: | ---: | --- | --- |",
        "| a step | 2.5 us, 2.5 x | 42 ms, 42,100 x | as long | `step` |",
        "",
        "<!-- end -->",
        "between",
        "<!-- written by scripts/bench.py: machines -->",
        "",
        "- One, AVX2: day 2026-11-27",
        "- Other, NEON: cores 4",
        "",
        "<!-- end -->",
        "after",
    ]


def test_a_run_that_measured_some_keeps_the_others(modules, tmp_path):
    runs = modules("benchmarks.runs")
    path = tmp_path / "bench" / "one.json"
    runs.save_run(path, runs.Run({"processor": "One"}, {"step": 1.0, "sea": 2.0}), keep=True)
    runs.save_run(path, runs.Run({"processor": "One"}, {"sea": 3.0}), keep=True)
    assert runs.read_run(path).results == {"step": 1.0, "sea": 3.0}


# what is measured ---------------------------------------------------------------------------------


def test_the_catamaran_of_4_m_floats_as_the_one_that_ships(modules, tmp_path):
    model = mujoco.MjModel.from_xml_path(str(modules("benchmarks.catamaran").write_model(tmp_path)))
    small = mujoco.MjModel.from_xml_path(str(ROOT / "models" / "catamaran" / "catamaran.xml"))
    assert model.body_mass.sum() == pytest.approx(2.5**3 * small.body_mass.sum(), rel=1e-5)
    floats, floated = equilibrium(model), equilibrium(small)
    assert floats.hydrostatics.waterplane_area == pytest.approx(
        2.5**2 * floated.hydrostatics.waterplane_area, rel=1e-3
    )
    assert floats.hydrostatics.mass == pytest.approx(2.5**3 * floated.hydrostatics.mass, rel=1e-5)


def test_stretches_start_from_the_states_of_one_run(modules):
    stretches = modules("benchmarks.stretches")
    model = mujoco.MjModel.from_xml_string(
        "<mujoco><worldbody><body><freejoint/><geom size='.1'/></body></worldbody></mujoco>"
    )
    plan = stretches.Plan(starts=3, apart=10, steps=1, rounds=1)
    starts = stretches.find_starts(model, mujoco.MjData(model), plan)
    assert [start.time for start in starts] == pytest.approx([0.0, 0.02, 0.04])
    falls = [stretches.forward(model, start).qpos[2] for start in starts]
    assert np.diff(falls).max() < 0.0
    course = stretches.Course(model, starts)
    times = stretches.time_steps({"one": course, "other": course}, plan)
    assert list(times) == ["one", "other"]
