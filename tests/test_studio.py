"""A scene in Studio: the water that the panel sets, and what the panel shows."""

import math
import socket
import subprocess
import sys
import warnings

import mujoco
import numpy as np
import pytest

from buoyancy_mj import Water, hydrostatics
from buoyancy_mj.drawing.looks import DAYLIGHT
from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.errors import BuoyancyWarning, DrawingError, ModelError, WaterError
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.scene import read_scene
from buoyancy_mj.studio import deeds, library
from buoyancy_mj.studio.basin import Basin
from buoyancy_mj.studio.dry_copy import make_dry_spec
from buoyancy_mj.studio.model_files import (
    inspect_file,
    keep_own_water,
    scene_of_file,
    write_verdict,
)
from buoyancy_mj.studio.readings import Traces, list_forces, list_rows
from buoyancy_mj.studio.readouts import Reader
from buoyancy_mj.studio.sea_state import (
    JONSWAP,
    PIERSON_MOSKOWITZ,
    REGULAR,
    SCENE,
    SPECTRA,
    STILL,
    SeaState,
    describe_water,
)
from buoyancy_mj.studio.twin import Twin
from buoyancy_mj.studio.view import check_port, check_window

FLOAT = """<mujoco><option timestep="0.005"/><worldbody>
<body name="float" pos="0.3 0 0.1"><freejoint/>
<geom type="box" size="0.5 0.3 0.2" mass="72"/></body></worldbody></mujoco>"""


@pytest.fixture
def path(tmp_path):
    file = tmp_path / "float.xml"
    file.write_text(FLOAT)
    return file


@pytest.fixture
def basin(path):
    return Basin(scene_of_file(path)[0])


def set_sea(basin, **fields):
    own = basin.scene.water
    basin.put_into(describe_water(basin.water).change(**fields).make_water(own))


# the water


@pytest.mark.parametrize("level", [-0.4, 0.0, 0.7])
def test_a_float_rests_at_the_level_that_the_panel_sets(basin, level):
    set_sea(basin, level=level)
    deeds.rest(basin, "float")
    assert basin.data.qpos[2] == pytest.approx(level + 0.2 - 0.12, abs=1e-9)


def test_a_float_comes_up_in_denser_water_at_once(basin):
    deeds.rest(basin, "float")
    basin.advance(mujoco.mj_step)
    set_sea(basin, density=1200.0)
    basin.advance(mujoco.mj_step)
    # 20 % more buoyancy than weight
    assert basin.data.qacc[2] == pytest.approx(0.2 * 9.81, rel=0.02)


@pytest.mark.parametrize("spectrum", SPECTRA)
def test_each_spectrum_gives_the_waves_that_it_says(spectrum):
    own = Water(waves=SeaState(spectrum=REGULAR).make_water(Water()).waves)
    sea = SeaState(spectrum=spectrum, height=0.8, period=5.0, heading=30.0, seed=3)
    rows = sea.make_water(own).rows
    if spectrum == STILL:
        assert len(rows) == 0
    elif spectrum == SCENE:
        assert rows == pytest.approx(own.rows)
    else:
        height = (
            2.0 * rows[0, 0]
            if spectrum == REGULAR
            else 4.0 * np.sqrt(0.5 * (rows[:, 0] ** 2).sum())
        )
        assert height == pytest.approx(0.8)
        assert np.arctan2(rows[:, 2], rows[:, 1]) == pytest.approx(math.radians(30.0))


def test_a_slider_of_still_water_makes_waves_and_a_seed_makes_a_sea():
    assert SeaState().change(height=1.0).spectrum == REGULAR
    assert SeaState().change(seed=4).spectrum == JONSWAP
    assert SeaState(spectrum=PIERSON_MOSKOWITZ).change(height=1.0).spectrum == PIERSON_MOSKOWITZ
    assert SeaState().change(level=1.0).spectrum == STILL


@pytest.mark.parametrize("name", ["auv_waves", "auv_current", "auv_sea_state_2", "fleet"])
def test_the_numbers_of_a_scene_give_its_own_water_back(name):
    water = read_scene(catalog.scene_path(name)).water
    again = describe_water(water).make_water(water)
    assert again.rows == pytest.approx(water.rows)
    assert again.current_rows == pytest.approx(water.current_rows, abs=1e-12)
    assert (again.density, again.level) == (water.density, water.level)


def test_water_that_cannot_be_leaves_the_water_that_acts(basin):
    before = basin.buoyancy
    with pytest.raises(WaterError):
        set_sea(basin, height=3.0, period=0.8)
    assert basin.buoyancy is before


# the vehicle


def test_a_dropped_float_hangs_over_the_surface(basin):
    set_sea(basin, level=0.2)
    deeds.drop(basin, "float", 0.5)
    assert basin.frame().draft == pytest.approx(-0.5)
    assert not basin.data.qvel.any()


def test_a_leant_float_has_the_heel_and_its_place(basin):
    deeds.rest(basin, "float")
    centre = basin.frame().centre_of_mass
    deeds.lean(basin, "float", 0.3, 0.1)
    frame = basin.frame()
    assert frame.attitude[:2] == pytest.approx([0.3, 0.1])
    assert frame.centre_of_mass == pytest.approx(centre)


def test_a_vehicle_on_a_hinge_cannot_be_dropped(tmp_path):
    file = tmp_path / "flap.xml"
    file.write_text(FLOAT.replace("<freejoint/>", '<joint type="hinge" axis="0 1 0"/>'))
    basin = Basin(scene_of_file(file)[0])
    with pytest.raises(ModelError, match="hangs on joints of its own"):
        deeds.drop(basin, "flap", 1.0)


def test_a_reset_leads_back_to_the_start(basin):
    start = basin.data.qpos.copy()
    for _ in range(20):
        basin.advance(mujoco.mj_step)
    basin.reset()
    assert basin.data.time == 0.0
    assert np.array_equal(basin.data.qpos, start)


# what the panel shows


def test_readouts_are_the_hydrostatics_of_the_pose(basin):
    deeds.rest(basin, "float")
    deeds.lean(basin, "float", 0.2, -0.1)
    one = Reader(basin).read().vehicles["float"]
    at = hydrostatics(basin.model, basin.water, basin.data.qpos)
    assert [one.draft, one.heel, one.trim] == pytest.approx([at.draft, at.heel, at.trim])
    assert [one.volume, one.displacement] == pytest.approx([at.volume, at.displacement])
    assert one.mass == pytest.approx(72.0)


def test_readouts_are_the_loads_by_cause():
    basin = Basin(read_scene(catalog.scene_path("auv_sea_state_2")))
    for _ in range(50):
        basin.advance(mujoco.mj_step)
    readout = Reader(basin).read()
    ((name, one),) = readout.vehicles.items()
    frame = basin.frame()
    loads = Buoyancy(basin.model, basin.scene).evaluate(frame.data)
    bodies = basin.vehicles[name].bodies
    assert set(one.forces) == set(loads.by_cause)
    for cause, rows in loads.by_cause.items():
        if cause != "added_mass":  # needs the accelerations of the pass
            assert one.forces[cause] == pytest.approx(rows[bodies, :3].sum(axis=0), abs=1e-6)
    sensors = [number for channel, number in readout.channels if channel.kind == "sensor"]
    assert sensors == pytest.approx(frame.data.sensordata.tolist(), nan_ok=True)


def test_the_panel_writes_each_number_with_its_unit(basin):
    deeds.rest(basin, "float")
    one = Reader(basin).read().vehicles["float"]
    assert dict(list_rows(one)) == {
        "draft": "0.1200 m",
        "heel": "+0.00 deg",
        "trim": "+0.00 deg",
        "volume": "72 l",
        "displacement": "72 kg",
        "mass": "72 kg",
    }
    assert ("buoyancy", "+0.0", "+0.0", "+706.3") in list_forces(one)


def test_traces_keep_half_a_minute_and_begin_anew_where_time_goes_back(basin):
    traces, reader = Traces(), Reader(basin)
    for time in (0.0, 1.0, 20.0, 40.0):
        basin.data.time = time
        traces.add(reader.read())
    assert traces.times() == [20.0, 40.0]
    (line,) = traces.lines("draft", "float")
    assert line == ("draft", pytest.approx([0.1, 0.1]))
    basin.data.time = 3.0
    traces.add(reader.read())
    assert traces.times() == [3.0]


# the dry copy


@pytest.mark.parametrize("name", ["auv_waves", "fleet", "sauvc_course"])
def test_a_dry_copy_has_no_plugin_and_the_same_bodies(name):
    basin = Basin(read_scene(catalog.scene_path(name)))
    dry = make_dry_spec(basin.scene).compile()
    assert basin.model.nplugin > 0
    assert (dry.nplugin, dry.nsensor) == (0, 0)
    wet = basin.model
    for kind in ("body", "geom", "joint", "actuator"):
        count = {"body": wet.nbody, "geom": wet.ngeom, "joint": wet.njnt, "actuator": wet.nu}[kind]
        names = [[getattr(model, kind)(i).name for i in range(count)] for model in (wet, dry)]
        assert names[0] == names[1]
    assert (dry.nq, dry.nv, dry.nu) == (wet.nq, wet.nv, wet.nu)


@pytest.mark.parametrize("skin", [False, True])
def test_a_twin_shares_the_state_and_hands_back_what_the_window_changes(skin):
    basin = Basin(read_scene(catalog.scene_path("auv_waves")))
    twin = Twin(basin, DAYLIGHT, skin=skin)
    for _ in range(10):
        basin.advance(mujoco.mj_step)
    twin.take(basin)
    mujoco.mj_forward(twin.model, twin.data)
    assert twin.data.xpos[: basin.model.nbody] == pytest.approx(basin.frame().data.xpos)
    twin.data.ctrl[2], twin.data.qpos[2], twin.data.xfrc_applied[1, 0] = 5.0, 0.7, 9.0
    twin.give(basin)
    assert (basin.data.ctrl[2], basin.data.qpos[2]) == (5.0, 0.7)
    assert basin.data.xfrc_applied[1, 0] == 9.0


@pytest.mark.parametrize("name", ["auv_waves", "auv_sea_state_2"])
def test_the_sea_of_a_browser_stands_a_millimetre_off_the_sea_that_acts_at_most(name):
    basin = Basin(read_scene(catalog.scene_path(name)))
    twin = Twin(basin, DAYLIGHT, skin=True)
    centre = np.array([3.2, -1.7])
    twin.data.mocap_pos[twin.sea.first :] = twin.sea.place(basin.water, centre, 1.3)
    mujoco.mj_forward(twin.model, twin.data)
    options = mujoco.MjvOption()
    options.skingroup[:] = 1
    scene = mujoco.MjvScene(twin.model, 1000)
    mujoco.mjv_updateScene(
        twin.model, twin.data, options, None, mujoco.MjvCamera(),
        int(mujoco.mjtCatBit.mjCAT_ALL), scene,
    )  # fmt: skip
    drawn = np.array(scene.skinvert, float).reshape(-1, 3)[: twin.model.nskinvert]
    near = np.linalg.norm(drawn[:, :2] - centre, axis=1) < twin.radius
    x, y, z = drawn[near].T
    assert near.sum() > 100
    assert z == pytest.approx(basin.water.elevation(x, y, 1.3), abs=1e-3)


# models


def test_a_model_without_water_is_judged_as_inspect_judges_it(path):
    _, is_wet = scene_of_file(path)
    assert not is_wet
    (first, *_) = write_verdict(inspect_file(path))
    assert first.startswith("float: floats: 168 kg reserve, draft 0.12 m, stable")


def test_a_model_stands_in_its_scene_where_its_file_has_it(path):
    basin = Basin(scene_of_file(path)[0])
    assert basin.data.qpos == pytest.approx([0.3, 0.0, 0.1, 1.0, 0.0, 0.0, 0.0])


def test_a_model_with_water_keeps_it(tmp_path):
    file = tmp_path / "wet.xml"
    wet = """<extension><plugin plugin="buoyancy_mj.water"><instance name="sea">
    <config key="density" value="1025"/><config key="level" value="0.4"/></instance></plugin>
    </extension><worldbody>"""
    file.write_text(FLOAT.replace("<worldbody>", wet))
    scene, is_wet = scene_of_file(file)
    assert is_wet
    assert (scene.water.density, scene.water.level) == (1025.0, 0.4)
    with warnings.catch_warnings(), keep_own_water():
        warnings.simplefilter("error", BuoyancyWarning, append=True)
        assert Basin(scene).water.density == 1025.0


# what a machine lacks


def test_a_port_that_is_taken_is_one_sentence():
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(DrawingError, match=rf"served at 127\.0\.0\.1:{port}: .*give"):
            check_port("127.0.0.1", port)


def test_a_host_that_is_elsewhere_is_one_sentence():
    with pytest.raises(DrawingError, match=r"no page can be served at 192\.0\.2\.1:8080"):
        check_port("192.0.2.1", 8080)


def test_no_display_is_one_sentence(monkeypatch):
    monkeypatch.setattr("buoyancy_mj.studio.view.has_display", lambda: False)
    with pytest.raises(DrawingError, match="needs a display, and there is none here; give --web"):
        check_window()


def test_no_vulkan_is_one_sentence(monkeypatch):
    pytest.importorskip("mujoco.studio.window")
    monkeypatch.setattr("buoyancy_mj.studio.view.has_display", lambda: True)
    monkeypatch.setattr("buoyancy_mj.drawing.filament.graphics.count_devices", lambda: 0)
    with pytest.raises(DrawingError, match="through Vulkan, and there is none here; install"):
        check_window()


def test_no_studio_is_one_sentence(monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco.studio.app", None)
    with pytest.raises(DrawingError, match=r"cannot be loaded: .*; pip install mujoco-studio, or"):
        library.load_studio()


@pytest.mark.parametrize(
    ("flags", "message"),
    [
        (["--renderer", "vulkan"], "--renderer is 'vulkan'; possible: classic, studio"),
        (["--renderer", "classic", "--web"], "--web needs --renderer studio"),
    ],
)
def test_renderers_that_do_not_go_together_are_refused(flags, message):
    found = subprocess.run(
        [sys.executable, "-m", "buoyancy_mj", "view", "auv_waves", *flags],
        capture_output=True, text=True,
    )  # fmt: skip
    assert found.returncode == 1
    assert message in " ".join(found.stderr.split())
