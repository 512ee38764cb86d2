"""`Recorder`: a loop of one's own, recorded without being disturbed."""

import contextlib
import csv
import subprocess
import sys
import tomllib

import mujoco
import numpy as np
import pytest
from rerun.chunk import RrdReader

from buoyancy_mj import (
    Buoyancy,
    DivergenceError,
    ModelError,
    Recorder,
    RecordingError,
    RegularWave,
    Water,
    add_water,
    water_in,
)
from buoyancy_mj.engine.forward import forward_without_control
from buoyancy_mj.hulls.bodies import find_moving_bodies
from buoyancy_mj.scenes.run import find_run
from buoyancy_mj.viz import rrd
from buoyancy_mj.viz.contacts import find_force
from buoyancy_mj.viz.tendons import find_path
from buoyancy_mj.viz.thrusters import ThrusterDrawing

WATER = Water(waves=RegularWave(0.1, period=2.0))
VEHICLE = """<mujoco><option timestep="0.01"/>
<worldbody>
  <geom name="floor" type="plane" size="5 5 1" pos="0 0 -1"/>
  <site name="anchor" pos="1 0.2 -0.9"/>
  <body name="rov" pos="0 0 -0.4" euler="10 5 20"><freejoint/>
    <geom name="hull" type="box" size=".3 .2 .1" density="950"/>
    <site name="port" pos="-.3 .2 0" euler="0 80 10"/>
    <site name="starboard" pos="-.3 -.2 0" euler="0 70 -10"/>
    <site name="imu"/>
  </body>
  <body name="stone" pos="0.5 0.8 -0.9"><freejoint/>
    <geom name="stone" size=".1" density="2500"/>
  </body>
</worldbody>
<tendon><spatial name="tether" width="0.01"><site site="anchor"/><site site="imu"/></spatial>
</tendon>
<actuator>
  <motor name="port" site="port" gear="0 0 1 0 0 .1"/>
  <general name="starboard" site="starboard" gear="0 0 2 0 0 0" dyntype="filter" dynprm=".2"/>
</actuator>
<sensor><accelerometer name="acceleration" site="imu"/><framepos name="place" objtype="site"
  objname="imu"/><clock/></sensor>
</mujoco>"""


def make(text=VEHICLE, water=WATER):
    """A model that brings its own water, and its data."""
    spec = mujoco.MjSpec.from_string(text)
    add_water(spec, water)
    model = spec.compile()
    return model, mujoco.MjData(model)


def step(model, data, until):
    """Drive, and give the data after each step."""
    while data.time < until - 1e-9:
        data.ctrl[:] = 5.0 * np.sin(3.0 * data.time), 4.0
        mujoco.mj_step(model, data)
        yield data


def read_recording(path):
    """The columns of each entity that come with time, by its path; the rows in order of time."""
    entities = {}
    for chunk in RrdReader(str(path)).stream().to_chunks():
        if not chunk.is_static:
            columns = chunk.to_record_batch().to_pydict()
            rows = entities.setdefault(chunk.entity_path, {})
            for name, values in columns.items():
                rows.setdefault(name.rpartition(":")[2], []).extend(values)
    return entities


def read_table(path):
    """The columns of a table of CSV."""
    with path.open(newline="") as file:
        header, *rows = csv.reader(file)
    return dict(zip(header, np.array(rows, float).reshape(-1, len(header)).T, strict=True))


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """A run of a vehicle that pushes, on a tether, beside a stone on the bottom."""
    folder = tmp_path_factory.mktemp("own")
    model, data = make()
    with Recorder(model, data, folder / "run.rrd", series=folder / "run.csv", rate=20.0) as own:
        own.record()
        for _ in step(model, data, 1.0):
            own.record()
    assert own.paths == (folder / "run.rrd", folder / "run.csv")
    return model, data, folder, read_recording(folder / "run.rrd"), read_table(folder / "run.csv")


def test_a_loop_of_ones_own_leaves_a_recording_that_verifies(recorded):
    folder = recorded[2]
    assert sorted(path.name for path in folder.iterdir()) == ["run.csv", "run.rrd"]
    command = [sys.executable, "-m", "rerun", "rrd", "verify", str(folder / "run.rrd")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_it_holds_what_the_recording_of_a_scene_holds(recorded):
    assert {
        "/world/bodies/rov",
        "/world/bodies/stone",
        "/world/water",
        "/world/centres/rov/gravity",
        "/world/forces/rov/buoyancy",
        "/world/forces/stone/drag",
        "/plots/rov/height/centre_of_gravity",
        "/plots/rov/energy/total",
        "/plots/stone/volume/hulls/stone",
    } <= recorded[3].keys()


def test_it_holds_sensors_controls_thrusters_tendons_and_contacts(recorded):
    assert {
        "/instruments/sensor/acceleration/x",
        "/instruments/sensor/place/z",
        "/instruments/sensor/sensor\\ 2",
        "/instruments/control/port",
        "/instruments/force/starboard",
        "/instruments/activation/starboard",
        "/world/thrusters",
        "/world/tendons",
        "/world/contacts/points",
        "/world/contacts/forces",
    } <= recorded[3].keys()


def test_instruments_have_a_tab_with_a_plot_for_each_kind_and_unit(recorded):
    reader = RrdReader(str(recorded[2] / "run.rrd"))
    names = []
    for chunk in reader.stream(store=reader.blueprints()[0]).to_chunks():
        for column, values in chunk.to_record_batch().to_pydict().items():
            names += [one for (one,) in values] if column.endswith(":display_name") else []
    assert {
        "rov", "stone", "Sensors and controls", "sensors [m/s^2]", "sensors [m]", "sensors [s]",
        "controls [own units]", "actuator forces [N]", "activations [own units]",
    } <= set(names)  # fmt: skip
    assert "summary" not in names


def test_the_water_of_the_loop_is_told_as_the_plugin_would_state_it(recorded):
    texts = tomllib.loads(find_run(*recorded[:2]).text)
    assert texts["waves"] == "regular amplitude=0.1 period=2.0"


def test_frames_come_at_the_rate_and_each_at_exactly_its_time(recorded):
    times = recorded[4]["time [s]"]
    assert times == pytest.approx(np.arange(21) / 20.0, abs=1e-9)
    for entity in ("/world/thrusters", "/instruments/sensor/place/z", "/world/bodies/rov"):
        found = [one.total_seconds() for one in recorded[3][entity]["sim_time"]]
        assert found == pytest.approx(times, abs=1e-6)


def test_the_recording_and_the_table_hold_the_same_numbers(recorded):
    entities, table = recorded[3:]
    for entity, column in (
        ("sensor/acceleration/x", "acceleration.x [m/s^2]"),
        ("sensor/place/z", "place.z [m]"),
        ("control/port", "port.control"),
        ("force/starboard", "starboard.force [N]"),
        ("activation/starboard", "starboard.activation"),
        ("sensor/sensor\\ 2", "sensor 2 [s]"),
    ):
        found = np.array(entities[f"/instruments/{entity}"]["scalars"])[:, 0]
        assert found == pytest.approx(table[column], abs=0.0), column
    # at exactly this time, not a step late
    assert table["sensor 2 [s]"] == pytest.approx(table["time [s]"], abs=0.0)
    assert table["port.control"] == pytest.approx(table["port.force [N]"], abs=0.0)
    assert np.ptp(table["starboard.activation"]) > 1.0


def test_the_arrows_of_thrusters_are_what_the_engine_pushes_with(recorded):
    model, data, *_ = recorded
    again = mujoco.MjData(model)
    again.qpos[:], again.act[:] = data.qpos, data.act
    again.ctrl[:] = 3.0, -2.0
    mujoco.mj_forward(model, again)
    drawing = ThrusterDrawing(find_run(model, again), 1.0)
    total = drawing.find_forces(again).sum(axis=0)
    # the free joint's first three generalized forces are the force in the world
    assert total == pytest.approx(again.qfrc_actuator[:3], abs=1e-12)
    assert np.abs(total).max() > 1.0


def test_a_reference_site_gives_the_axes_of_a_thruster_and_a_torque_alone_no_arrow():
    text = VEHICLE.replace('name="port" site="port"', 'name="port" site="port" refsite="anchor"')
    text = text.replace('name="anchor"', 'name="anchor" euler="30 40 50"')
    model, data = make(text.replace('gear="0 0 2 0 0 0"', 'gear="0 0 0 0 0 2"'))
    data.ctrl[:] = 3.0, -2.0
    mujoco.mj_forward(model, data)
    forces = ThrusterDrawing(find_run(model, data), 1.0).find_forces(data)
    assert forces.shape == (1, 3)
    assert forces[0] == pytest.approx(data.qfrc_actuator[:3], abs=1e-12)
    assert np.linalg.norm(forces[0]) == pytest.approx(3.0)


def test_the_arrows_of_contacts_are_what_holds_the_stone(recorded):
    model, data, *_ = recorded
    again = mujoco.MjData(model)
    again.qpos[:] = data.qpos
    mujoco.mj_forward(model, again)
    moves = find_moving_bodies(model)
    found = [find_force(model, again, i, moves) for i in range(again.ncon)]
    stone = model.body("stone").id
    assert [body for _, body in found] == [stone]
    dof = model.body_dofadr[stone]
    assert found[0][0] == pytest.approx(again.qfrc_constraint[dof : dof + 3], abs=1e-9)
    assert found[0][0][2] > 10.0


def test_a_tendon_is_drawn_along_its_path_and_parted_by_pulleys():
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><worldbody><site name="a" pos="1 0 0"/><site name="b" pos="2 1 0"/>
        <geom name="drum" type="sphere" size=".3" pos=".5 .1 0"/>
        <body><joint name="h"/><geom size=".1"/><site name="c"/></body></worldbody><tendon>
        <spatial name="t"><site site="c"/><geom geom="drum"/><site site="a"/><pulley divisor="2"/>
        <site site="a"/><site site="b"/></spatial>
        <fixed name="f"><joint joint="h" coef="1"/></fixed></tendon></mujoco>"""
    )
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    around, straight = find_path(data, 0)
    assert len(straight) == 2
    assert len(around) == 4
    lengths = [np.linalg.norm(np.diff(path, axis=0), axis=1) for path in (around, straight)]
    # the arc around the drum is a chord in the picture
    assert lengths[0].sum() + 0.5 * lengths[1].sum() == pytest.approx(data.ten_length[0], rel=1e-2)
    assert find_path(data, 1) == []


@pytest.mark.filterwarnings("ignore:RRD file has no footer")
def test_nothing_is_logged_for_what_a_model_does_not_have(tmp_path, monkeypatch):
    monkeypatch.setattr(rrd, "_add_footer", lambda *_: None)
    text = """<mujoco><worldbody><body name="box"><freejoint/>
    <geom type="box" size=".2 .2 .2" density="500"/></body></worldbody></mujoco>"""
    model, data = make(text)
    with Recorder(model, data, tmp_path / "run.rrd") as recorder:
        recorder.record()
    names = " ".join(read_recording(tmp_path / "run.rrd"))
    assert "/world/bodies/box" in names
    for name in ("instruments", "thrusters", "tendons", "contacts"):
        assert name not in names


WAYS = ["plugin", "qfrc_passive", "xfrc_applied", "control"]
"""How water acts: as a part of the model, installed, or called by hand as mjcb_control."""


@contextlib.contextmanager
def acting(way, controller=None):
    """A vehicle in water that acts in one of `WAYS`, after a controller of one's own.

    Gives the model, its data, the water, and what tells a recorder of the water.
    """
    if way == "plugin":
        model, data = make()
        water = water_in(model)
    else:
        model = mujoco.MjModel.from_xml_string(VEHICLE)
        data = mujoco.MjData(model)
        water = Buoyancy(model, WATER)

    def steer_in_water(model, data):
        if controller is not None:
            controller(model, data)
        water(model, data)

    mujoco.set_mjcb_control(steer_in_water if way == "control" else controller)
    by_hand = {"buoyancy": water} if way == "control" else {}
    installed = way in ("qfrc_passive", "xfrc_applied")
    try:
        with water.installed(through=way) if installed else contextlib.nullcontext():
            yield model, data, water, by_hand
    finally:
        mujoco.set_mjcb_control(None)


def run_with_controller(way, series=None):
    """The states of a run of 40 steps, and the times at which its controller was called."""
    calls, states = [], []

    def steer(_, data):
        calls.append(data.time)
        data.ctrl[:] = len(calls) % 7, 2.0

    with acting(way, steer) as (model, data, _, by_hand):
        recorder = Recorder(model, data, series=series, **by_hand) if series else None
        for _ in range(40):
            mujoco.mj_step(model, data)
            if recorder is not None:
                recorder.record()
            states.append([*data.qpos, *data.qvel, *data.act, *data.sensordata])
            states.append(data.xfrc_applied.ravel())
        if recorder is not None:
            recorder.close()
    return np.concatenate(states), calls


@pytest.mark.parametrize("way", WAYS)
def test_a_loop_runs_bit_for_bit_as_without_a_recorder_and_calls_its_controller_as_often(
    tmp_path, way
):
    alone, calls = run_with_controller(way)
    recorded, calls_recorded = run_with_controller(way, tmp_path / "run.csv")
    assert np.array_equal(alone, recorded)
    assert calls == calls_recorded
    assert len(read_table(tmp_path / "run.csv")["time [s]"]) == 40


@pytest.mark.parametrize("way", WAYS)
def test_a_pass_without_the_control_callback_is_that_of_mj_forward(way):
    with acting(way) as (model, data, water, _):
        model.opt.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
        other = mujoco.MjData(model)
        data.ctrl[:] = other.ctrl[:] = 3.0, 4.0
        mujoco.mj_forward(model, data)
        forward_without_control(other, water)
        for name in (
            "qacc", "sensordata", "qfrc_passive", "qfrc_constraint", "energy", "xfrc_applied"
        ):  # fmt: skip
            assert np.array_equal(getattr(data, name), getattr(other, name)), name
        assert np.array_equal(water.loads(other).xfrc, water.loads(data).xfrc)
        assert np.abs(water.loads(other).xfrc).max() > 1.0


def record_nothing(model, data, **options):
    with pytest.raises(ModelError) as told:
        Recorder(model, data, "run.rrd", **options)
    return str(told.value)


def test_a_model_without_water_or_with_two_is_refused_and_one_of_another_model():
    model = mujoco.MjModel.from_xml_string(VEHICLE)
    data = mujoco.MjData(model)
    water = Buoyancy(model, WATER)
    assert record_nothing(model, data) == (
        "no water acts on this model: give it its own with add_water before it is compiled, enter "
        "`with buoyancy.installed():` first, or say which (buoyancy=...)"
    )
    with water.installed(), Buoyancy(model, bodies=[1]).installed():
        assert record_nothing(model, data) == (
            "2 waters act on this model: say which (buoyancy=...)"
        )
    other = mujoco.MjModel.from_xml_string(VEHICLE)
    assert record_nothing(other, data) == (
        "data is of another model; make it of this one, mujoco.MjData(model)"
    )
    assert record_nothing(other, mujoco.MjData(other), buoyancy=water) == (
        "buoyancy is of another model; make it of this one, Buoyancy(model, ...)"
    )
    assert "it must be a Buoyancy" in record_nothing(model, data, buoyancy=WATER)
    assert "it must be a mujoco.MjModel" in record_nothing("rov.xml", data)
    assert "it must be the mujoco.MjData" in record_nothing(model, None)
    with water.installed():
        assert find_run(model, data).buoyancy is water


@pytest.mark.parametrize(
    ("path", "options", "message"),
    [
        ("run.mp4", {}, "the recording is 'run.mp4'; the name of a recording ends in .rrd"),
        (None, {"series": "run.txt"}, "the series is 'run.txt'; the name of a series ends in .csv"),
        (None, {}, "there is nothing to record to; give a file"),
        (None, {"series": 3}, "the series is 3; it must be the name of a file"),
        ("run.rrd", {"rate": 0.0}, "rate is 0.0; it must be above 0"),
        ("run.rrd", {"rate": "fast"}, "rate is 'fast'; it must be a finite number"),
        ("folder.rrd", {"series": "a.csv"}, "cannot write 'folder.rrd': it is a folder"),
        (None, {"series": "folder.rrd/../folder.csv"}, "it is a folder"),
    ],
)
def test_bad_places_and_rates_are_one_sentence_and_leave_nothing(
    tmp_path, monkeypatch, path, options, message
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder.rrd").mkdir()
    (tmp_path / "folder.csv").mkdir()
    before = set(tmp_path.rglob("*"))
    with pytest.raises(RecordingError) as told:
        Recorder(*make(), path, **options)
    assert message in str(told.value)
    assert "\n" not in str(told.value)
    assert set(tmp_path.rglob("*")) == before


def test_whatever_ends_the_loop_what_was_recorded_stays_and_the_error_says_where(tmp_path):
    model, data = make()
    path, table = tmp_path / "run.rrd", tmp_path / "run.csv"
    table.write_text("a whole one\n")

    def loop():
        with Recorder(model, data, path, series=table) as recorder:
            for _ in step(model, data, 0.05):
                recorder.record()
            raise KeyboardInterrupt("enough")

    with pytest.raises(KeyboardInterrupt) as told:
        loop()
    assert str(told.value) == "enough"
    # a piece does not replace a whole table
    kept = tmp_path / "run.partial.csv"
    assert table.read_text() == "a whole one\n"
    assert told.value.__notes__ == [
        f"what was recorded is in '{path}'",
        f"what was recorded is in '{kept}'",
    ]
    assert len(read_table(kept)["time [s]"]) == 5
    assert len(read_recording(path)["/world/bodies/rov"]["sim_time"]) == 5


def test_a_time_that_goes_back_and_a_closed_recorder_are_told(tmp_path):
    model, data = make()
    with Recorder(model, data, series=tmp_path / "run.csv") as recorder:
        for _ in step(model, data, 0.03):
            recorder.record()
        mujoco.mj_resetData(model, data)
        with pytest.raises(RecordingError) as told:
            recorder.record()
    assert str(told.value) == (
        "the time went back from 0.03 s to 0 s; make a Recorder for each run, as after mj_resetData"
    )
    assert recorder.close() == (tmp_path / "run.csv",)
    with pytest.raises(RecordingError, match="this recorder is closed; make another one"):
        recorder.record()
    assert len(read_table(tmp_path / "run.csv")["time [s]"]) == 3


def test_a_state_that_is_not_finite_ends_the_run_and_keeps_what_was_before(tmp_path):
    model, data = make()
    with Recorder(model, data, series=tmp_path / "run.csv") as recorder:
        mujoco.mj_step(model, data)
        recorder.record()
        data.qvel[2] = np.nan
        with pytest.raises(DivergenceError, match=r"a velocity is nan at 0.01 s, so there is"):
            recorder.record()
    assert len(read_table(tmp_path / "run.csv")["time [s]"]) == 1
