"""Objectives: a function of fields of a scene, for SciPy and for other processes."""

import csv
import pickle

import numpy as np
import pytest
from scipy.optimize import differential_evolution

from buoyancy_mj import BuoyancyWarning, SceneError, Simulation, SweepError, objective, read_scene
from buoyancy_mj.scenes import catalog, variations

QUICK = ["duration=0.05"]
STILL = "hourglass_drop_still"


def lowest_draft(**options):
    """The draft at the end of a short run, over the height from which it begins."""
    return objective(STILL, ["start.position.2=0.2:0.9"], "final_draft", settings=QUICK, **options)


def test_a_number_is_that_of_a_run_of_its_own():
    function = objective(
        STILL, ["start.position.2=0.2:0.9", "mass=10:20"], "peak_draft", settings=QUICK
    )
    assert function.keys == ("start.position.2", "mass")
    assert function.bounds == [(0.2, 0.9), (10.0, 20.0)]
    x = [0.31, 12.5]
    path = catalog.scenes()[STILL]
    alone = Simulation(
        read_scene(path, [*QUICK, *(f"{k}={v}" for k, v in zip(function.keys, x, strict=True))])
    )
    for _ in range(alone.steps):
        alone.step()
    alone.frame()
    assert function(x) == pytest.approx(alone.summary().values()["peak_draft"], rel=1e-12)


def test_columns_of_parameters_are_runs_side_by_side():
    function = lowest_draft()
    one_by_one = [function([height]) for height in (0.3, 0.5, 0.7)]
    assert lowest_draft()([[0.3, 0.5, 0.7, 0.3]]).tolist() == [*one_by_one, one_by_one[0]]
    assert function.best["start.position.2"] == 0.7
    assert len(function.rows) == 3


@pytest.mark.slow
def test_differential_evolution_finds_a_draft():
    function = objective(
        STILL,
        ["start.position.2=0.2:0.9"],
        lambda row: abs(row["final_draft"] + 0.4),
        settings=QUICK,
    )
    best = differential_evolution(
        function, function.bounds, vectorized=True, updating="deferred", seed=1, popsize=5,
        maxiter=5, polish=False,
    )  # fmt: skip
    assert best.fun == function(best.x) < 0.02
    assert function.best["final_draft"] == pytest.approx(-0.4, abs=0.02)


def test_what_was_run_is_not_run_again_also_by_another_process(tmp_path, monkeypatch):
    out = tmp_path / "rows.csv"
    with lowest_draft(out=out) as function:
        numbers = function([[0.3, 0.5]])
    made = []
    monkeypatch.setattr(
        variations, "Simulation", lambda scene, **_: made.append(scene) or Simulation(scene)
    )
    with lowest_draft(out=out) as function:
        assert function([[0.5, 0.3]]).tolist() == numbers[::-1].tolist()
        assert not made
        function([[0.3, 0.4]])
        assert len(made) == 1
        with pytest.raises(SweepError, match="another sweep is writing"):
            lowest_draft(out=out)
    with out.open() as file:
        assert [row["run"] for row in csv.DictReader(file)] == ["0", "1", "2"]


def test_an_objective_that_is_sent_to_another_process_gives_the_same_numbers(tmp_path):
    function = lowest_draft()
    sent = pickle.loads(pickle.dumps(function))
    assert sent.bounds == function.bounds
    assert sent([0.4]) == function([0.4])
    with (
        lowest_draft(out=tmp_path / "rows.csv") as kept,
        pytest.raises(SweepError, match=r"leave out= out to send it to others"),
    ):
        pickle.dumps(kept)


def test_a_run_that_fails_counts_as_inf_and_is_told_once():
    function = objective(STILL, ["mass=-10:20"], "peak_draft", settings=QUICK)
    with pytest.raises(SweepError, match="no run of the objective is done"):
        function.best  # noqa: B018
    with pytest.warns(BuoyancyWarning, match=r"counts as inf: .*mass is -1.0; it must be above 0"):
        assert function([-1.0]) == np.inf
    assert function([[-1.0, -2.0]]).tolist() == [np.inf, np.inf]


@pytest.mark.parametrize(
    ("over", "minimise", "told"),
    [
        (["mass=1:2:3"], "peak_draft", "has a number of values, which an optimiser does not use"),
        (["mass=2:1"], "peak_draft", "over mass=2:1 has no room; give KEY=a:b with a below b"),
        (["mass=1:2", "mass=1:2"], "peak_draft", "a field is given twice: mass, mass"),
        ([], "peak_draft", r"over is \[\]; give a list of 'KEY=a:b'"),
        ("mass=1:2", "peak_draft", "over is 'mass=1:2'; give a list"),
        (["mass=1:2"], "peek_draft", "minimise is 'peek_draft'; did you mean 'peak_draft'?"),
    ],
)
def test_an_objective_that_makes_no_sense_is_reported(over, minimise, told):
    with pytest.raises(SweepError, match=told):
        objective(STILL, over, minimise)


def test_what_cannot_be_minimised_is_reported(tmp_path):
    with pytest.raises(SceneError, match="unknown key 'mas'"):
        objective(STILL, ["mas=1:2"], "peak_draft")
    with pytest.raises(SweepError, match=r"rows go to a file that ends in \.csv"):
        lowest_draft(out=tmp_path / "rows.parquet")
    with pytest.raises(SweepError, match=r"--on is 'moon'"):
        lowest_draft(on="moon")
    function = objective(STILL, ["mass=10:20"], "first_contact", settings=QUICK)
    with pytest.raises(SweepError, match=r"the run with mass=12 has None to minimise; give a func"):
        function([12.0])
    with pytest.raises(
        SweepError, match=r"x is .*; it must be numbers of shape \(1,\) or \(1, n\)"
    ):
        function([1.0, 2.0])
