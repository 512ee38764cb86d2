"""A run as a table: its columns, their order, and what is left of a run that breaks off."""

import csv
import errno
import os
import shlex

import mujoco
import numpy as np
import pyarrow.parquet
import pytest
from typer.testing import CliRunner

from buoyancy_mj import Recorder, RecordingError, Simulation, Water, add_water, read_scene
from buoyancy_mj.cli import app
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.series import Series
from buoyancy_mj.scenes.series_file import Column, SeriesFile

AWKWARD = np.array([[0.0, np.nan], [0.1, np.inf], [1.0 / 3.0, -np.inf], [-0.0, 5e-324]])
COLUMNS = (Column("time", "s"), Column('a "b",\nc', ""))
PARTS = """<mujoco><worldbody>
<body name="rov" pos="0 0 -.2"><freejoint/><geom type="box" size=".3 .2 .1" density="600"/>
  <body name="arm" pos=".4 0 0"><joint axis="0 1 0"/><geom type="box" size=".1 .05 .05"/></body>
</body></worldbody>
<sensor><subtreelinvel name="velocity" body="rov"/><subtreecom name="centre" body="rov"/>
<frameangvel name="spin" objtype="xbody" objname="rov"/><clock name="rov"/><clock name="rov.draft"/>
</sensor></mujoco>"""


def read_csv(path):
    with path.open(newline="") as file:
        header, *rows = csv.reader(file)
    return header, np.array(rows, float).reshape(-1, len(header))


def write(path, columns=COLUMNS, rows=AWKWARD):
    file = SeriesFile(path, columns)
    for row in rows:
        file.add(row)
    return file


def test_numbers_of_csv_and_of_parquet_are_those_that_were_written(tmp_path):
    header, rows = read_csv(write(tmp_path / "a.csv").close(complete=True))
    assert header == ["time [s]", 'a "b",\nc']
    assert np.array_equal(rows, AWKWARD, equal_nan=True)
    table = pyarrow.parquet.read_table(write(tmp_path / "a.parquet").close(complete=True))
    assert table.column_names == header
    assert table.schema.field(0).metadata == {b"unit": b"s"}
    found = np.array([column.to_numpy() for column in table.columns]).T
    assert np.array_equal(found, AWKWARD, equal_nan=True)
    assert np.signbit(found[3, 0])
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.csv", "a.parquet"]


@pytest.mark.parametrize("end", ["csv", "parquet"])
def test_a_table_without_rows_has_its_columns(tmp_path, end):
    path = write(tmp_path / f"a.{end}", rows=()).close(complete=True)
    if end == "csv":
        header, rows = read_csv(path)
        assert len(rows) == 0
    else:
        table = pyarrow.parquet.read_table(path)
        header = table.column_names
        assert table.num_rows == 0
    assert header == ["time [s]", 'a "b",\nc']


@pytest.mark.parametrize("end", ["csv", "parquet"])
def test_each_row_is_on_the_disk_before_the_next_one(tmp_path, end):
    file = write(tmp_path / f"a.{end}")
    partial = tmp_path / "a.partial.csv"
    assert np.array_equal(read_csv(partial)[1], AWKWARD, equal_nan=True)
    file.close(complete=False)
    assert [path.name for path in tmp_path.iterdir()] == [f"a.{end}"]


@pytest.mark.parametrize("end", ["csv", "parquet"])
def test_a_piece_does_not_replace_a_whole_table_and_a_whole_one_does(tmp_path, end):
    path = tmp_path / f"a.{end}"
    path.write_text("old")
    kept = write(path).close(complete=False)
    assert kept == tmp_path / "a.partial.csv"
    assert path.read_text() == "old"
    assert len(read_csv(kept)[1]) == len(AWKWARD)
    assert write(path).close(complete=True) == path
    assert path.read_bytes() != b"old"
    assert kept.exists()


@pytest.mark.parametrize("end", ["csv", "parquet"])
def test_a_full_disk_is_told_and_leaves_whole_rows(tmp_path, monkeypatch, end):
    file = SeriesFile(tmp_path / f"a.{end}", COLUMNS)
    file.add(AWKWARD[0])
    left = tmp_path / ("a.csv" if end == "csv" else "a.partial.csv")
    write, room = os.write, [3]

    def fill(descriptor, piece):
        if not room:
            raise OSError(errno.ENOSPC, "No space left on device")
        return write(descriptor, piece[: room.pop()])

    monkeypatch.setattr(os, "write", fill)
    with pytest.raises(RecordingError) as told:
        file.add(AWKWARD[1])
    assert str(told.value) == (
        f"the series broke off: No space left on device; what was written is in '{left}'"
    )
    assert file.closed
    assert len(read_csv(left)[1]) == 1


def test_bad_places_are_one_sentence_each(tmp_path):
    (tmp_path / "folder.csv").mkdir()
    (tmp_path / "file").write_text("")
    for name, message in (
        ("a.xlsx", "the name of a series ends in .csv or .parquet"),
        ("a", "the name of a series ends in .csv or .parquet"),
        ("folder.csv", "it is a folder; choose another place for the series"),
        ("file/a.csv", "choose another place for the series"),
    ):
        with pytest.raises(RecordingError) as told:
            SeriesFile(tmp_path / name, COLUMNS)
        assert message in str(told.value)
        assert "\n" not in str(told.value)
    first = write(tmp_path / "a.csv")
    with pytest.raises(RecordingError, match=r"another run is writing '.*a.partial.csv'"):
        SeriesFile(tmp_path / "a.csv", COLUMNS)
    first.close(complete=True)


@pytest.fixture(scope="module")
def moving(tmp_path_factory):
    """A vehicle of two bodies that turns and moves, and its table."""
    spec = mujoco.MjSpec.from_string(PARTS)
    add_water(spec, Water(current=(0.5, 0.2, 0.0)))
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qvel[:] = 0.3, -0.2, 0.1, 0.4, -0.5, 0.6, 1.0
    path = tmp_path_factory.mktemp("series") / "run.csv"
    with Recorder(model, data, series=path) as recorder:
        for _ in range(5):
            mujoco.mj_step(model, data)
            recorder.record()
    header, rows = read_csv(path)
    return model, data, recorder, dict(zip(header, rows.T, strict=True))


def test_velocities_are_those_of_the_engines_own_sensors(moving):
    table = moving[3]
    for axis in "xyz":
        for ours, sensor, unit in (
            ("position", "centre", "m"),
            ("velocity", "velocity", "m/s"),
            ("angular_velocity", "spin", "rad/s"),
        ):
            found = table[f"rov.{ours}.{axis} [{unit}]"]
            assert found == pytest.approx(table[f"{sensor}.{axis} [{unit}]"], abs=1e-12)
            assert np.abs(found).max() > 1e-3


def test_loads_of_all_causes_add_up_to_the_whole_about_the_centre_of_gravity(moving):
    model, data, recorder, table = moving
    buoyancy = recorder._run.buoyancy
    mujoco.mj_forward(model, data)
    whole = buoyancy.evaluate(data).total
    for kind, unit, expected in (("force", "N", whole.force), ("torque", "N m", whole.torque)):
        parts = [
            [table[f"rov.{cause}.{kind}.{axis} [{unit}]"][-1] for axis in "xyz"]
            for cause in buoyancy.causes
        ]
        assert np.sum(parts, axis=0) == pytest.approx(expected, rel=1e-9, abs=1e-9)
        assert np.abs(expected).max() > 1e-2


def test_a_name_that_is_taken_gets_a_number(moving):
    assert {"rov [s]", "rov.draft [m]", "rov.draft [s]"} <= moving[3].keys()
    spec = mujoco.MjSpec.from_string(PARTS.replace('clock name="rov.draft"', 'clock name="time"'))
    add_water(spec)
    model = spec.compile()
    path = moving[2].paths[0].with_name("again.csv")
    with Recorder(model, mujoco.MjData(model), series=path) as recorder:
        recorder.record()
    header, _ = read_csv(path)
    assert header[0] == "time [s]"
    assert header[-1] == "time (2) [s]"


def test_the_columns_of_a_scene_are_stable_and_as_its_frames(tmp_path):
    found = []
    for name in ("a.csv", "b.csv"):
        settings = ["duration=0.1", "timestep=0.05"]
        simulation = Simulation(read_scene(catalog.scenes()["auv_waves"], settings))
        series = Series(simulation, tmp_path / name)
        seen = []
        for frame in simulation.frames():
            series.add(frame)
            force = frame.vehicles["sauvc_auv"].forces["buoyancy"]
            seen.append([frame.time, *frame.centre_of_mass, *frame.attitude, frame.draft, *force])
        header, rows = read_csv(series.close())
        found.append((header, rows))
        names = ["time [s]"]
        names += [f"sauvc_auv.position.{axis} [m]" for axis in "xyz"]
        names += [f"sauvc_auv.attitude.{angle} [rad]" for angle in ("roll", "pitch", "yaw")]
        names += ["sauvc_auv.draft [m]"]
        names += [f"sauvc_auv.buoyancy.force.{axis} [N]" for axis in "xyz"]
        columns = rows[:, [header.index(name) for name in names]]
        assert columns == pytest.approx(np.array(seen), abs=1e-12)
    assert found[0][0] == found[1][0]
    assert "vertical_front_port.force [N]" in found[0][0]
    assert "gyro.x [rad/s]" in found[0][0]


def test_a_command_writes_the_series_it_is_asked_for(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    line = "run hourglass_drop_still --duration 0.1 --timestep 0.05 --no-record"
    done = CliRunner().invoke(app, shlex.split(f"{line} --series out/run.parquet"))
    assert done.exit_code == 0, done.output
    assert "the series is in 'out/run.parquet'" in done.stdout
    table = pyarrow.parquet.read_table(tmp_path / "out" / "run.parquet")
    assert table.column("time [s]").to_pylist() == pytest.approx([0.0, 0.05, 0.1])
    done = CliRunner().invoke(app, shlex.split(f"{line} --series run.txt"))
    assert done.exit_code == 1
    assert done.stderr == (
        "error: --series is 'run.txt'; a series' name ends in .csv or .parquet\n"
    )


def test_a_command_that_breaks_off_says_where_its_series_is(tmp_path, monkeypatch):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(Simulation, "advance", interrupted)
    line = "run hourglass_drop_still --duration 0.1 --no-record --series run.csv"
    done = CliRunner().invoke(app, shlex.split(line))
    assert done.exit_code == 130
    assert done.stderr == "the series up to 0.00 s is in 'run.csv'\n"
    assert len(read_csv(tmp_path / "run.csv")[1]) == 1
