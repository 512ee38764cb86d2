"""Scenes of the Singapore AUV Challenge: the shipped controller drives, the referee watches."""

import csv
import json

import mujoco
import numpy as np
import pytest
from typer.testing import CliRunner

from buoyancy_mj import ControlError, Scene, SceneError, Simulation, read_scene, sauvc_arena
from buoyancy_mj.cli import app
from buoyancy_mj.environments.sauvc.added_mass import Rod, state_rods
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.scene import scene_from_table
from buoyancy_mj.vehicle.control.course import Waypoint

QUICK = ("--set", "added_mass=model")
"""What nobody needs to wait for where only the report is looked at."""


def run_mission(name):
    """What the referee of a scene that ships reports at its end."""
    simulation = Simulation(read_scene(catalog.scene_path(name)))
    energies = [frame.energy.total for frame in simulation.frames()]
    assert np.isfinite(energies).all()
    assert simulation.summary().contact_steps == 0
    return simulation.mission.report


@pytest.mark.slow
@pytest.mark.parametrize("name", ["sauvc_qualification", "sauvc_qualification_waves"])
def test_the_shipped_controller_qualifies(name):
    report = run_mission(name)
    assert (report.points, report.ended) == (2, "qualified")
    passed = [event.detail for event in report.events if event.kind == "gate passed"]
    assert passed == [
        "gate_port, away from the start, bow first",
        "gate_port, back to the start, bow first",
    ]
    # 10 m there and 2 m back at 0.7 m/s, and a turn
    assert 15.0 < report.run_time < 25.0


@pytest.mark.slow
def test_the_shipped_controller_passes_the_gate_bumps_a_flare_and_drops_the_ball():
    report = run_mission("sauvc_course")
    assert report.ended == "surfaced"
    assert [points for _, points in report.score[:3]] == [15, 50, 20]
    kinds = [event.kind for event in report.events]
    order = ["gate passed", "flare touched", "ball fell", "ball in drum", "ended"]
    assert [kind for kind in kinds if kind in order] == order
    assert "gate touched" not in kinds
    assert report.points == pytest.approx(15 + 50 + 20 + 5 + 0.03 * (900.0 - report.run_time))


def test_a_run_prints_what_the_referee_has_seen(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    command = ["run", "sauvc_qualification", "--no-record", "--duration", "1.9", *QUICK, "--json"]
    done = CliRunner().invoke(app, command)
    assert done.exit_code == 0, done.stderr
    mission = json.loads(done.stdout)["mission"]
    assert (mission["points"], mission["ended"]) == (0, "")
    assert [event["kind"] for event in mission["events"]] == ["submerged", "left start"]


def test_the_table_of_a_run_has_the_events_and_the_points():
    command = ["run", "sauvc_qualification", "--no-record", "--duration", "1.9", *QUICK]
    done = CliRunner().invoke(app, command)
    assert done.exit_code == 0, done.stderr
    for words in ("mission: qualification", "left start: under water", "not yet"):
        assert words in done.stdout


def test_a_sweep_over_layouts_has_the_points(tmp_path):
    out = tmp_path / "layouts.csv"
    command = ["sweep", "sauvc_course", "--over", "layout=1:2:2", "--out", str(out), *QUICK]
    done = CliRunner().invoke(app, [*command, "--duration", "0.1"])
    assert done.exit_code == 0, done.stderr
    with out.open() as file:
        rows = list(csv.DictReader(file))
    assert [row["points"] for row in rows] == ["0", "0"]
    assert [float(row["mission_time"]) for row in rows] == [0.1, 0.1]


def test_a_layout_puts_the_props_where_its_seed_says():
    settings = ["layout=5", "added_mass=model"]
    model = Simulation(read_scene(catalog.scene_path("sauvc_course"), settings)).model
    arena = sauvc_arena("course", 5).compile()
    assert model.body("environment/gate").pos == pytest.approx(arena.body("gate").pos)


BARE = {"title": "a mission", "vehicle": "hourglass", "environment": "sauvc_qualification"}


@pytest.mark.parametrize(
    ("table", "message"),
    [
        (
            {"mission": "sauvc_final"},
            "unknown mission 'sauvc_final'; possible: sauvc_course, sauvc_qualification",
        ),
        ({"layout": -1}, "layout is -1; it must be a whole number from 0 to 9223372036854775807"),
        (
            {"layout": 1, "environment": "sauvc_pool"},
            "layout is 1, and the environment is 'sauvc_pool', of which there is one layout; leave "
            "layout out, or take another environment; did you mean 'sauvc_course'? possible: "
            "sauvc_course, sauvc_qualification",
        ),
    ],
)
def test_a_mission_that_makes_no_sense_is_refused(table, message):
    with pytest.raises(SceneError) as caught:
        scene_from_table(BARE | table)
    assert str(caught.value) == f"scene: {message}"


def test_several_vehicles_are_no_mission():
    vehicles = [{"model": "hourglass"}, {"model": "hourglass"}]
    table = {"title": "two", "vehicles": vehicles, "mission": "sauvc_course"}
    with pytest.raises(
        SceneError,
        match="mission is 'sauvc_course' beside 2 vehicles, and a referee watches one; leave one",
    ):
        scene_from_table(table)


def test_a_mission_in_another_environment_is_refused():
    scene = Scene(
        title="elsewhere",
        vehicle="hourglass",
        environment="sauvc_pool",
        mission="sauvc_course",
    )
    with pytest.raises(Exception, match="no arena of the challenge"):
        Simulation(scene)


def test_a_way_point_that_changes_no_actuator_is_refused():
    settings = ["added_mass=model", 'control.waypoints.0.controls={"environment/bal"=1.0}']
    with pytest.raises(
        ControlError,
        match=r"a way-point changes the control of 'environment/bal', which is no actuator beside "
        r"the thrusters; did you mean 'environment/ball'\? possible: environment/ball",
    ):
        Simulation(read_scene(catalog.scene_path("sauvc_course"), settings))


@pytest.mark.parametrize(
    ("controls", "message"),
    [
        (1.0, "controls is 1.0; it must be a table of numbers by the names of actuators"),
        ({"light": "on"}, "controls.light is 'on'; it must be a finite number"),
        ({"light": float("nan")}, "controls.light is nan; it must be a finite number"),
    ],
)
def test_controls_of_a_way_point_that_are_none_are_refused(controls, message):
    with pytest.raises(ControlError) as caught:
        Waypoint(position=(0.0, 0.0), controls=controls)
    assert str(caught.value) == message


def test_the_added_mass_of_a_rod_is_that_of_slender_bodies():
    spec = mujoco.MjSpec()
    state_rods(spec, "rod", [Rod((0.0, 0.0, 0.0), (0.0, 0.0, 2.0), 0.05)])
    matrix = np.array(spec.numerics[0].data).reshape(6, 6)
    a = 1000.0 * np.pi * 0.05**2
    assert np.diag(matrix) == pytest.approx([2 * a, 2 * a, 0, a * 8 / 3, a * 8 / 3, 0], abs=1e-12)
    # pushed at its foot along x it turns about y
    assert matrix[0, 4] == pytest.approx(2 * a * 1.0)
    assert matrix[1, 3] == pytest.approx(-2 * a * 1.0)
    np.testing.assert_allclose(matrix, matrix.T)
