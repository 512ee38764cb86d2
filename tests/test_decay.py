"""Free decays: known equations are given back, and published ones, beside the natural periods."""

import csv
import json
import math

import numpy as np
import pytest
import scipy
from typer.testing import CliRunner

from buoyancy_mj import ResponseError, decay
from buoyancy_mj.cli import app
from buoyancy_mj.responses.decay_charts import make_decay_figure
from buoyancy_mj.responses.decay_fits import find_peaks, fit_decay

BOX = """<mujoco><option timestep="0.002"/><custom>
<numeric name="linear_damping:box" data="0 0 60 0 0 0"/>
<numeric name="quadratic_damping:box" data="0 0 400 0 0 0"/>
<numeric name="added_mass:box" data="0 0 100 0 0 0"/></custom>
<worldbody><body name="box"><freejoint/><geom type="box" size="0.4 0.3 0.2" mass="96"/></body>
</worldbody></mujoco>"""

QUICK = ["added_mass=ellipsoid"]
"""Settings for added mass that is found at once."""


@pytest.mark.parametrize(("linear", "quadratic"), [(0.2, 0.0), (0.0, 0.6), (0.15, 0.4)])
def test_the_damping_of_an_equation_is_given_back(linear, quadratic):
    omega = 2.0

    def accelerate(_, state):
        x, v = state
        return v, -linear * v - quadratic * abs(v) * v - omega**2 * x

    times = np.arange(0.0, 50.0, 0.02)
    solved = scipy.integrate.solve_ivp(
        accelerate, (0.0, 50.0), (1.0, 0.0), t_eval=times, rtol=1e-9, atol=1e-12
    )
    fit = fit_decay(find_peaks(times, solved.y[0]))
    assert fit.linear == pytest.approx(linear, abs=1e-4)
    assert fit.quadratic == pytest.approx(quadratic, abs=1e-3)
    assert fit.omega == pytest.approx(omega, rel=1e-4)


def test_a_box_gives_back_the_damping_and_the_added_mass_that_its_model_states(tmp_path):
    path = tmp_path / "box.xml"
    path.write_text(BOX)
    found = decay(path, "heave", 0.05, settings=["integrator='rk4'", "timestep=0.004"])
    # what is stated holds for the whole box, of which half is wet
    assert found.added_mass == pytest.approx(50.0, rel=0.03)
    assert found.given_added_mass == pytest.approx(50.0, rel=1e-6)
    assert found.stiffness == pytest.approx(1000.0 * 9.81 * 0.8 * 0.6)
    period = 2.0 * math.pi * math.sqrt((96.0 + 50.0) / found.stiffness)
    assert found.natural_period == pytest.approx(period)
    assert found.fit.period == pytest.approx(period, rel=0.01)
    assert found.linear_damping == pytest.approx(30.0, rel=0.05)
    assert found.quadratic_damping == pytest.approx(200.0, rel=0.06)


def test_the_sphere_of_oes_task_10_has_the_period_that_six_codes_have():
    # data of IEA OES Task 10: 4.36 to 4.46 s, let go 1 m up
    settings = ["damping={kind='none', radiation=true}"]
    found = decay("oes_sphere", "heave", 1.0, settings=settings)
    assert 4.36 <= found.fit.period <= 4.46
    assert found.fit.period == pytest.approx(found.natural_period, rel=0.01)
    assert found.dry_period == pytest.approx(3.662, abs=2e-3)
    # the damping that the model states, which fades a little as the waterplane does
    assert found.linear_damping == pytest.approx(92_800.0, rel=0.03)


def test_a_roll_is_let_go_about_the_centre_of_gravity_and_stays_a_roll():
    found = decay("catamaran", "roll", settings=QUICK)
    assert found.values[0] == pytest.approx(math.radians(10.0))
    assert found.fit.period == pytest.approx(found.natural_period, rel=0.01)
    assert found.added_mass == pytest.approx(found.given_added_mass, rel=0.03)
    assert found.fit.quadratic > 0.0


def test_what_does_not_swing_says_so(tmp_path):
    path = tmp_path / "box.xml"
    path.write_text(BOX.replace("0 0 60 0 0 0", "0 0 40000 0 0 0"))
    with pytest.raises(ResponseError, match="it is damped too much to swing; let it go from"):
        decay(path, "heave", 0.05)


def test_what_nothing_restores_is_refused(tmp_path):
    path = tmp_path / "sunk.xml"
    ball = '<geom type="sphere" size="0.1" density="1000"/>'
    path.write_text(
        f'<mujoco><worldbody><body pos="0 0 -3"><freejoint/>{ball}</body></worldbody></mujoco>'
    )
    with pytest.raises(ResponseError, match="nothing restores the heave of 'sunk' where it rests"):
        decay(path, "heave", 0.1)


def test_the_command_tells_and_writes(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    words = ["decay", "catamaran", "--motion", "roll", "--from", "8", "--set", *QUICK]
    done = CliRunner().invoke(app, [*words, "--csv", "roll.csv", "--plot", "roll.png"])
    assert done.exit_code == 0, done.output
    assert "roll let go from 8 degrees" in done.stdout
    assert max(map(len, done.stdout.splitlines())) <= 80
    with (tmp_path / "roll.csv").open() as file:
        first = next(csv.DictReader(file))
    assert float(first["roll [rad]"]) == pytest.approx(math.radians(8.0))
    assert (tmp_path / "roll.png").read_bytes().startswith(b"\x89PNG")
    told = json.loads(CliRunner().invoke(app, [*words, "--json"]).stdout)
    assert told["motion"] == "roll"
    assert told["period"] == pytest.approx(told["natural_period"], rel=0.01)


def test_the_picture_marks_the_fit_beside_the_motion():
    figure = make_decay_figure(decay("catamaran", "pitch", 0.1, settings=QUICK))
    left, right = figure.axes
    assert "statics" in left.get_title(loc="left") + left.get_title()
    assert right.get_ylabel() == "damping, % of critical"


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--motion", "yaw"], "there is no decay of 'yaw'; possible: heave, pitch, roll"),
        (["--from", "0"], "the start of a decay is 0, where the vehicle rests; give another"),
        (["--csv", "a.txt"], "--csv is 'a.txt'; its name must end in .csv"),
    ],
)
def test_a_wrong_flag_is_one_sentence(words, said):
    done = CliRunner().invoke(app, ["decay", "oes_sphere", *words])
    assert done.exit_code == 1
    assert said in done.stderr.replace("\n", " ")


@pytest.mark.parametrize(
    ("start", "message"),
    [
        (200.0, "the start of the roll is 200 degrees; it must be less than half a turn"),
        (150.0, "the roll came to an end 180 degrees away from its rest; let it go from nearer"),
    ],
)
def test_a_vehicle_that_turns_over_has_no_decay(tmp_path, start, message):
    path = tmp_path / "box.xml"
    path.write_text(
        '<mujoco><worldbody><body name="box"><freejoint/>'
        '<geom type="box" size=".5 .3 .2" mass="100"/></body></worldbody></mujoco>'
    )
    with pytest.raises(ResponseError, match=message):
        decay(path, "roll", math.radians(start), settings=["added_mass=none"])


def test_what_has_little_freeboard_keeps_its_top_out_of_the_water(tmp_path):
    path = tmp_path / "spar.xml"
    path.write_text(
        '<mujoco><worldbody><body name="spar" pos="0 0 -4"><freejoint/>'
        '<geom type="cylinder" size=".5 5.5"/>'
        '<inertial pos="0 0 -2" mass="7853.98" diaginertia="9e4 9e4 1e3"/>'
        "</body></worldbody></mujoco>"
    )
    found = decay(path, settings=["added_mass=none", "water.density=1000"])
    assert found.start == pytest.approx(0.5, abs=0.01)  # half of 11 m less the draft of 10 m
