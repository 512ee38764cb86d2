"""Currents by depth and by time: their tables, their files, and what they do to a body."""

import mujoco
import numpy as np
import pytest

from buoyancy_mj import (
    Buoyancy,
    CurrentProfile,
    CurrentSeries,
    SceneError,
    Water,
    WaterError,
)
from buoyancy_mj.scenes.scene import read_scene, scene_from_table
from buoyancy_mj.settings.config import parse_plugin_config, write_plugin_config
from buoyancy_mj.settings.settings import Settings

PROFILE = CurrentProfile((0.0, 2.0, 10.0), ((1.0, 0.0, 0.0), (0.5, 0.2, 0.0), (0.0, 0.0, 0.0)))
SERIES = CurrentSeries((0.0, 10.0, 15.0), ((0.0, 0.0, 0.0), (1.0, -0.5, 0.0), (1.0, 0.0, 0.1)))


def test_a_profile_is_straight_between_its_depths_and_held_beyond_them():
    water = Water(level=0.5, current=PROFILE)
    depths = np.array([-1.0, 0.0, 1.0, 2.0, 6.0, 10.0, 30.0])
    points = np.column_stack([np.zeros(7), np.zeros(7), 0.5 - depths])
    for c in range(3):
        expected = np.interp(depths, PROFILE.depths, np.array(PROFILE.velocities)[:, c])
        assert water.velocity(points, 3.0)[:, c] == pytest.approx(expected, abs=1e-15)
    assert water.acceleration(points, 3.0) == pytest.approx(np.zeros((7, 3)), abs=0.0)


@pytest.mark.parametrize("time", [-1.0, 0.0, 2.5, 10.0, 12.0, 15.0, 99.0])
def test_a_series_is_straight_between_its_times_and_held_beyond_them(time):
    water, p = Water(current=SERIES), np.array([0.3, 0.2, -1.0])
    expected = [np.interp(time, SERIES.times, np.array(SERIES.velocities)[:, c]) for c in range(3)]
    assert water.velocity(p, time) == pytest.approx(expected, abs=1e-15)
    rate = (
        (0.1, -0.05, 0.0)
        if 0.0 <= time < 10.0
        else (0.0, 0.1, 0.02)
        if 10.0 <= time < 15.0
        else (0.0, 0.0, 0.0)
    )
    assert water.acceleration(p, time) == pytest.approx(rate, abs=1e-15)


def ball(drag=50.0, added=0.0):
    """A neutrally buoyant ball of 10 cm, 1 m deep."""
    mass = 1000.0 * 4.0 / 3.0 * np.pi * 0.001
    return mujoco.MjModel.from_xml_string(f"""<mujoco>
        <option timestep="0.01" integrator="implicitfast"/><custom>
        <numeric name="quadratic_damping:b" data="{drag} {drag} {drag} 0 0 0"/>
        <numeric name="added_mass:b" data="{added} {added} {added} 0 0 0"/></custom>
        <worldbody><body name="b" pos="0 0 -1"><freejoint/>
        <geom type="sphere" size="0.1" mass="{mass}"/></body></worldbody>
        </mujoco>""")


@pytest.mark.parametrize("native", [False, True])
def test_a_body_is_carried_by_the_current_at_its_depth(native):
    model = ball()
    data = mujoco.MjData(model)
    with Buoyancy(model, Water(current=PROFILE)).installed(native=native):
        mujoco.mj_step(model, data, 6000)
    u, v = 0.75, 0.1
    # half way between the first two rows, and still neutral but for its facets
    assert data.qvel[:2] == pytest.approx([u, v], rel=0.05)
    assert np.hypot(*data.qvel[:2]) < np.hypot(u, v)


@pytest.mark.parametrize("native", [False, True])
def test_a_current_that_gathers_speed_takes_added_mass_along(native):
    # without drag the water's acceleration a acts on the added mass A of a body of mass m:
    # A a / (m + A)
    model = ball(drag=0.0, added=2.0)
    data = mujoco.MjData(model)
    mass = float(model.body_mass[1])
    with Buoyancy(model, Water(current=SERIES)).installed(native=native):
        mujoco.mj_step(model, data, 500)
    assert data.qvel[:2] == pytest.approx(
        np.array([0.1, -0.05]) * 5.0 * 2.0 / (mass + 2.0), rel=1e-3
    )


def test_currents_stand_in_scenes_and_in_models(tmp_path):
    for current in (PROFILE, SERIES, (0.1, 0.2, 0.3)):
        texts = write_plugin_config(Settings(water=Water(current=current)))
        assert parse_plugin_config(texts, "here").water.current == current
    table = {
        "kind": "profile",
        "depths": [0, 2, 10],
        "velocities": [[1, 0, 0], [0.5, 0.2, 0], [0, 0, 0]],
    }
    scene = scene_from_table({"title": "t", "vehicle": "hourglass", "water": {"current": table}})
    assert scene.water.current == PROFILE
    # a file, beside the scene
    (tmp_path / "tide.csv").write_text(
        "time, u, v, w\n# s, m/s\n0, 0, 0, 0\n10, 1, -0.5, 0\n15, 1, 0, 0.1\n"
    )
    (tmp_path / "a.toml").write_text(
        'title = "t"\nvehicle = "hourglass"\n[water.current]\nkind = "series"\nfile = "tide.csv"\n'
    )
    assert read_scene(tmp_path / "a.toml").water.current == SERIES


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: CurrentProfile((0.0, 0.0), ((0, 0, 0), (1, 0, 0))),
            "must grow from row to row; 0 follows 0",
        ),
        (
            lambda: CurrentProfile((0.0, 1.0), ((0, 0, 0),)),
            r"it has 2 depths, and velocities of shape \(1, 3\)",
        ),
        (
            lambda: CurrentProfile((0.0, 1.0), ((0, 0, 0), (np.nan, 0, 0))),
            r"velocities of the current hold .*nan.* in row 1",
        ),
        (lambda: CurrentSeries((), ()), "it has 0 times"),
        (
            lambda: CurrentSeries((0.0, np.nan), ((0, 0, 0), (1, 0, 0))),
            "times of the current hold nan in row 1",
        ),
        (
            lambda: CurrentSeries("ab", 3),
            r"the current's times is 'ab'; it must be numbers of shape \(n,\)",
        ),
        (
            lambda: CurrentProfile((0.0, 1.0), (1.0, 0.0, 0.0)),
            r"velocities is \(1.0, 0.0, 0.0\), of shape \(3,\); it must be numbers of shape "
            r"\(n, 3\)",
        ),
        (lambda: Water(current=(1.0, np.nan, 0.0)), "it must be three finite numbers"),
    ],
)
def test_impossible_currents_are_refused(make, message):
    with pytest.raises(WaterError, match=message):
        make()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("0, 1\n", "line 1 of '.*' is '0, 1'; needed are 3 or 4 finite numbers"),
        ("t,u,v\n0,1,nan\n", "line 2 of '.*' is '0,1,nan'; needed are 3 or 4 finite numbers"),
        ("0,1,2\nx,1,2\n", "line 2 of '.*' is 'x,1,2'; needed are numbers"),
        ("time,u,v\n", "holds no current"),
        ("0,1,2\n0,1,2\n", "must grow from row to row"),
    ],
)
def test_files_that_hold_no_current_are_refused(tmp_path, text, message):
    path = tmp_path / "current.csv"
    path.write_text(text)
    with pytest.raises(WaterError, match=message):
        CurrentSeries.read(path)


def test_a_missing_file_and_an_unknown_kind_are_refused(tmp_path):
    with pytest.raises(WaterError, match="cannot be read"):
        CurrentSeries.read(tmp_path / "none.csv")
    for current, message in (
        (
            {"kind": "tidal"},
            "kind is 'tidal'; .*possible: profile, series, or a list of 3 numbers instead",
        ),
        ({"kind": "series", "file": "none.csv"}, "cannot be read"),
        ({"kind": "series", "file": 3}, "a series has a file, a text, and nothing else"),
        ({"kind": "profile", "depths": [0]}, "'velocities' is missing"),
    ):
        with pytest.raises(SceneError, match=message):
            scene_from_table(
                {"title": "t", "vehicle": "hourglass", "water": {"current": current}},
                folder=tmp_path,
            )
