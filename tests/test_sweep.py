"""Sweeps: a row is what a run of its own gives, after any interruption, and failures are rows."""

import csv
import errno
import os
import shlex
import signal
import subprocess
import sys
import time

import numpy as np
import pyarrow.parquet
import pytest
import trimesh
from typer.testing import CliRunner

from buoyancy_mj import SceneError, Simulation, SweepError, read_scene
from buoyancy_mj.cli import app
from buoyancy_mj.scenes import catalog, journal, places, variations
from buoyancy_mj.scenes.ranges import FieldRange, draws, grid, parse_range
from buoyancy_mj.scenes.sweep import Sweep

QUICK = ("duration=0.3",)


def plan(
    tmp_path, *over, scene="hourglass_drop_waves", name="out.csv", settings=QUICK, values=None
):
    fields = [parse_range(text) for text in over]
    return Sweep(
        catalog.scenes()[scene],
        settings,
        tuple(f.key for f in fields),
        tuple(values or grid(fields)),
        tmp_path / name,
    )


def read(path):
    with path.open() as file:
        return list(csv.DictReader(file))


# what rows hold -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("scene", "over"),
    [
        (
            "hourglass_drop_waves",
            ["water.waves.0.amplitude=0.05:0.3:2", "start.position.2=0.3:0.6:2"],
        ),
        ("auv_waves", ["water.waves.0.phase=0:3:2", "mass=20:30:2", "cog_shift.2=-0.03:0.03:2"]),
        (
            "auv_waves",
            [
                "water.waves.0.frequency=0.3:0.6:2",
                "water.waves.0.direction=0:1:2",
                "start.roll=0:0.5:2",
            ],
        ),
        ("auv_pool", ["start.position.2=-1.6:-0.2:2", "mass=25:60:2"]),
    ],
)
def test_each_row_is_what_a_run_of_its_own_gives(scene, over, tmp_path):
    wanted = plan(tmp_path, *over, scene=scene, settings=("duration=0.6",))
    rows = list(wanted.run())
    assert [row["status"] for row in rows] == ["done"] * len(wanted.values)
    for row in rows:
        settings = [f"{key}={row[key]}" for key in wanted.keys]
        alone = Simulation(read_scene(wanted.path, [*wanted.settings, *settings]))
        for _ in range(alone.steps):
            alone.step()
        alone.frame()
        summary = alone.summary().values()
        for name in (
            "mass",
            "displacement",
            "net_weight",
            "peak_draft",
            "final_draft",
            "heave_range",
            "simulated_time",
        ):
            assert float(row[name]) == pytest.approx(summary[name], rel=1e-12, abs=1e-12), name
        assert int(float(row["contact_steps"])) == summary["contact_steps"]
        assert row["first_contact"] == (
            "" if summary["first_contact"] is None else str(summary["first_contact"])
        )


def test_the_bottom_is_felt_in_a_sweep_too(tmp_path):
    rows = list(
        plan(
            tmp_path,
            "mass=20:60:2",
            scene="auv_pool",
            settings=("duration=2", "start.position.2=-1.0"),
        ).run()
    )
    assert [int(row["contact_steps"]) > 0 for row in rows] == [False, True]


def test_one_thread_and_two_give_the_same_rows(tmp_path):
    rows = [
        list(plan(tmp_path, "start.position.2=0.3:0.9:5", name=f"{n}.csv").run(n)) for n in (1, 2)
    ]
    assert rows[0] == rows[1]


def test_draws_lie_between_their_ends_and_come_again_with_their_seed():
    over = [FieldRange("a", 1.0, 2.0, 0), FieldRange("b", -3.0, 5.0, 0)]
    values = np.array(draws(over, 500, 7))
    assert (values >= [1.0, -3.0]).all()
    assert (values <= [2.0, 5.0]).all()
    assert values.mean(axis=0) == pytest.approx([1.5, 1.0], abs=0.3)
    assert draws(over, 500, 7) == [tuple(row) for row in values]
    assert draws(over, 500, 8) != [tuple(row) for row in values]


def test_a_grid_has_all_combinations_the_last_field_fastest():
    assert grid([FieldRange("a", 0.0, 1.0, 2), FieldRange("b", 5.0, 7.0, 3)]) == [
        (0.0, 5.0), (0.0, 6.0), (0.0, 7.0), (1.0, 5.0), (1.0, 6.0), (1.0, 7.0)
    ]  # fmt: skip


# going on -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["out.csv", "out.parquet"])
def test_what_is_there_is_not_run_again(name, tmp_path, monkeypatch):
    monkeypatch.setattr(places, "BATCH_SIZE", 2)
    wanted = plan(tmp_path, "start.position.2=0.3:0.9:6", name=name)
    whole = list(plan(tmp_path, "start.position.2=0.3:0.9:6", name="whole.csv").run())
    made = []
    monkeypatch.setattr(
        variations, "Simulation", lambda scene, **_: made.append(scene) or Simulation(scene)
    )
    going = wanted.run()
    for _ in range(3):
        next(going)
    # as a kill would leave it
    going.close()
    journal = tmp_path / ("out.csv" if name == "out.csv" else "out.partial.csv")
    assert len(read(journal)) == 3
    with journal.open("a") as file:
        file.write("3,hourglass_drop_waves 1234,0.6")
    rows = list(wanted.run())
    assert len(made) == 7
    assert sorted(rows, key=lambda row: int(row["run"])) == whole
    assert len(list(wanted.run())) == 6
    assert len(made) == 7
    if name == "out.parquet":
        assert not journal.exists()
        table = pyarrow.parquet.read_table(wanted.out)
        assert table["peak_draft"].to_pylist() == [float(row["peak_draft"]) for row in whole]


@pytest.mark.long
@pytest.mark.slow
def test_a_sweep_that_is_killed_goes_on(tmp_path):
    out = tmp_path / "out.csv"
    over = ["--over", "start.position.2=0.1:0.9:100"]
    command = [
        sys.executable,
        "-m",
        "buoyancy_mj",
        "sweep",
        "hourglass_drop_waves",
        *over,
        "--out",
        str(out),
        "--duration",
        "1",
    ]
    running = subprocess.Popen(command)
    while not out.exists() or len(out.read_bytes().splitlines()) < 3:
        assert running.poll() is None
        time.sleep(0.02)
    running.send_signal(signal.SIGKILL)
    running.wait()
    before = len(read(out))
    assert before < 100
    done = subprocess.run([*command, "--duration", "10"], capture_output=True, text=True)
    assert "holds runs of another scene, or with other flags" in done.stderr
    assert subprocess.run(command).returncode == 0
    assert sorted(int(row["run"]) for row in read(out)) == list(range(100))


def test_more_draws_of_the_same_seed_go_on_from_fewer(tmp_path):
    over = [FieldRange("mass", 15.0, 25.0, 0)]
    few, more = (plan(tmp_path, "mass=15:25", values=draws(over, count, 3)) for count in (2, 4))
    first = list(few.run())
    assert list(more.run())[:2] == first
    assert len(read(more.out)) == 4


# failures -----------------------------------------------------------------------------------------


def test_runs_that_fail_are_rows_with_the_reason(tmp_path):
    rows = list(plan(tmp_path, "water.waves.0.amplitude=-0.1:0.1:3").run())
    assert [row["status"] for row in rows] == ["failed", "done", "done"]
    assert "amplitude is -0.1; it must be at least 0" in rows[0]["reason"]
    rows = list(plan(tmp_path, "start.velocity.0=0:1e150:2", name="fast.csv").run())
    assert [row["status"] for row in rows] == ["done", "failed"]
    assert "the simulation diverged at" in rows[1]["reason"]
    assert "try a smaller timestep (now 0.01 s)" in rows[1]["reason"]
    assert rows[1]["peak_draft"] == ""


def test_what_the_engine_refuses_is_a_reason_too(tmp_path):
    text = """<mujoco><option><flag sleep="enable"/></option>
    <worldbody><body><freejoint/><geom size=".1"/></body></worldbody></mujoco>"""
    (tmp_path / "sleepy.xml").write_text(text)
    rows = list(
        plan(
            tmp_path,
            "start.position.2=0:1:2",
            settings=(*QUICK, f'vehicle="{tmp_path}/sleepy.xml"'),
        ).run()
    )
    assert all("lets bodies at rest sleep" in row["reason"] for row in rows)


@pytest.mark.parametrize(
    "text",
    [
        "mass",
        "mass=1",
        "mass=1:2:0",
        "mass=a:b:3",
        "mass=1:2:3:4",
        "=1:2:3",
        "mass=0:inf:3",
        "mass=1:2:x",
    ],
)
def test_a_span_that_is_none_is_reported(text):
    with pytest.raises(SweepError, match="it must be KEY=a:b:n, n values from a to b"):
        parse_range(text)


def test_sweeps_that_make_no_sense_are_reported(tmp_path):
    with pytest.raises(
        SweepError, match=r"has no number of values; add it \(:n\), or give --draws"
    ):
        grid([parse_range("mass=1:2")])
    with pytest.raises(SweepError, match=r"results go to a file that ends in \.csv or \.parquet"):
        plan(tmp_path, "mass=1:2:2", name="out.txt")
    with pytest.raises(SweepError, match="a field is given twice: mass, mass"):
        plan(tmp_path, "mass=1:2:2", "mass=1:2:2")
    list(plan(tmp_path, "mass=20:21:2").run())
    with pytest.raises(
        SweepError,
        match="holds other columns than this sweep has; give another --out, or remove it",
    ):
        list(plan(tmp_path, "start.yaw=0:1:2").run())
    with pytest.raises(SweepError, match="holds runs of another scene, or with other flags"):
        list(plan(tmp_path, "mass=20:21:2", settings=("duration=0.4",)).run())
    for other in ("mass=20:22:2", "mass=20:20:1"):
        with pytest.raises(
            SweepError, match="holds runs with other values; give another --out, or remove it"
        ):
            list(plan(tmp_path, other).run())
    with pytest.raises(SceneError, match="unknown key 'mas'; did you mean 'mass'"):
        list(plan(tmp_path, "mas=20:21:2", name="new.csv").run())
    (tmp_path / "folder.csv").mkdir()
    with pytest.raises(SweepError, match="cannot keep results in"):
        list(plan(tmp_path, "mass=20:21:2", name="folder.csv").run())
    (tmp_path / "broken.parquet").write_text("no table")
    with pytest.raises(SweepError, match="cannot read the results in"):
        list(plan(tmp_path, "mass=20:21:2", name="broken.parquet").run())


def test_the_command_tells_how_many_failed(tmp_path):
    out = tmp_path / "rows.csv"
    arguments = [
        *shlex.split(
            f"sweep hourglass_drop_still --over mass=-100:100:3 --duration 0.1 --out {out}"
        )
    ]
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code == 3, result.output
    assert "3 runs, 2 failed" in result.output
    assert result.stderr == (
        "note: 2 of 3 runs failed; the first is run 0: scene 'hourglass_drop_still': "
        "mass is -100.0; it must be above 0\n"
    )
    assert [row["status"] for row in read(out)] == ["failed", "failed", "done"]
    result = CliRunner().invoke(app, [*arguments[:3], "mass=1:2", *arguments[4:]])
    assert result.exit_code == 1


def test_a_sweep_whose_runs_all_fail_fails(tmp_path):
    out = tmp_path / "rows.csv"
    arguments = ["sweep", "hourglass_drop_still", "--over", "mass=-2:-1:2", "--out", str(out)]
    for _ in range(2):
        result = CliRunner().invoke(app, arguments)
        assert result.exit_code == 1
        assert result.stdout.replace("\n", "") == f"2 runs, 2 failed: {out}"
        assert result.stderr == (
            "error: all 2 runs failed; the first: scene 'hourglass_drop_still': "
            "mass is -2.0; it must be above 0\n"
        )


MESH = """<mujoco><asset><mesh name="block" file="block.obj"/></asset>
<worldbody><body><freejoint/><geom type="mesh" mesh="block" density="500"/></body></worldbody>
</mujoco>"""
BLOCK = trimesh.creation.box((0.4, 0.3, 0.2)).export(file_type="obj")


def test_a_file_that_is_missing_stops_a_sweep_and_fails_no_run(tmp_path, monkeypatch):
    monkeypatch.setattr(places, "BATCH_SIZE", 1)
    (tmp_path / "block.xml").write_text(MESH)
    mesh = tmp_path / "block.obj"
    mesh.write_text(BLOCK)
    vehicle = f'vehicle="{tmp_path}/block.xml"'
    wanted = plan(tmp_path, "start.position.2=0:1:3", settings=("duration=0.05", vehicle))
    going = wanted.run()
    next(going)
    mesh.unlink()
    with pytest.raises(SweepError) as told:
        next(going)
    assert str(told.value) == (
        f"the sweep stopped: MuJoCo cannot compile '{tmp_path}/block.xml': Error: Error opening "
        f"file 'block.obj'; '{wanted.out}' holds 1 row, and the same command goes on from there"
    )
    mesh.write_text(BLOCK)
    assert [row["status"] for row in wanted.run()] == ["done"] * 3


@pytest.mark.parametrize("content", [None, "<mujoco><worldbody>"])
def test_an_environment_that_cannot_be_read_stops_a_sweep_and_leaves_no_file(tmp_path, content):
    file = tmp_path / "around.xml"
    if content is not None:
        file.write_text(content)
    wanted = plan(tmp_path, "mass=20:21:2", settings=(f'environment="{file}"',))
    told = (
        r"stopped: (there is no environment|MuJoCo cannot read) .*around.xml'.*; no run was done$"
    )
    with pytest.raises(SweepError, match=told):
        list(wanted.run())
    assert not wanted.out.exists()


def test_memory_that_runs_out_stops_a_sweep_and_fails_no_run(tmp_path, monkeypatch):
    def too_much(*_):
        raise MemoryError("Unable to allocate 3 TiB")

    monkeypatch.setattr(places, "BATCH_SIZE", 1)
    wanted = plan(tmp_path, "mass=20:21:2")
    going = wanted.run()
    next(going)
    with monkeypatch.context() as patched:
        patched.setattr(variations, "run_simulations", too_much)
        with pytest.raises(SweepError) as told:
            next(going)
    assert str(told.value) == (
        f"the sweep stopped: Unable to allocate 3 TiB; '{wanted.out}' holds 1 row, and the same "
        "command goes on from there"
    )
    assert [row["status"] for row in wanted.run()] == ["done"] * 2


class FullDisk:
    """A file that takes a few more letters, and then no more."""

    def __init__(self, file, room):
        self._file, self._room = file, room

    def __getattr__(self, name):
        return getattr(self._file, name)

    def write(self, content):
        if not self._room:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        written = self._file.write(content[: self._room])
        self._room -= written
        return written


@pytest.mark.parametrize("name", ["out.csv", "out.parquet"])
def test_a_full_disk_stops_a_sweep_at_a_whole_row(name, tmp_path, monkeypatch):
    opened = journal._open_locked
    monkeypatch.setattr(
        journal, "_open_locked", lambda *a, **k: FullDisk(opened(*a, **k), room=1800)
    )
    wanted = plan(tmp_path, "start.position.2=0.3:0.9:6", name=name)
    kept = tmp_path / ("out.csv" if name == "out.csv" else "out.partial.csv")
    rows = []
    with pytest.raises(SweepError) as told:
        rows.extend(wanted.run())
    monkeypatch.undo()
    held = read(kept)
    assert 0 < len(held) < 6
    assert kept.read_bytes().endswith(b"\n")
    assert str(told.value) == (
        f"cannot write to '{kept}': No space left on device; '{kept}' holds {len(held)} "
        f"row{'' if len(held) == 1 else 's'}, and the same command goes on from there"
    )
    assert [row["run"] for row in wanted.run()] == ["0", "1", "2", "3", "4", "5"]


def test_a_full_disk_under_a_table_leaves_its_rows(tmp_path, monkeypatch):
    def full(_, path):
        path.write_bytes(b"half")
        raise OSError(errno.ENOSPC, "No space left on device")

    wanted = plan(tmp_path, "mass=20:21:2", name="out.parquet")
    with monkeypatch.context() as patched:
        patched.setattr(pyarrow.parquet, "write_table", full)
        with pytest.raises(SweepError, match=r"cannot write '.*out.parquet': .*No space left"):
            list(wanted.run())
    assert [path.name for path in tmp_path.iterdir()] == ["out.partial.csv"]
    assert len(list(wanted.run())) == 2
    assert [path.name for path in tmp_path.iterdir()] == ["out.parquet"]


# what is there already ----------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["out.csv", "out.parquet"])
def test_two_sweeps_do_not_write_one_file(name, tmp_path):
    going = plan(tmp_path, "mass=20:21:2", name=name).run()
    next(going)
    kept = tmp_path / ("out.csv" if name == "out.csv" else "out.partial.csv")
    with pytest.raises(SweepError) as told:
        next(plan(tmp_path, "mass=20:21:2", name=name).run())
    assert str(told.value) == (
        f"another sweep is writing '{kept}'; wait for its end, or give another --out"
    )
    assert [row["status"] for row in going] == ["done"]


@pytest.mark.parametrize("name", ["out.csv", "out.parquet"])
def test_a_sweep_onto_a_link_writes_the_same_file_as_one_onto_its_target(name, tmp_path):
    (tmp_path / "links").mkdir()
    (tmp_path / "links" / name).symlink_to(tmp_path / name)
    going = plan(tmp_path, "mass=20:21:2", name=name).run()
    next(going)
    linked = plan(tmp_path / "links", "mass=20:21:2", name=name)
    with pytest.raises(SweepError, match=r"^another sweep is writing '"):
        next(linked.run())
    assert len(list(going)) == 1
    assert len(list(linked.run())) == 2
    assert (tmp_path / "links" / name).is_symlink()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["links", name]


@pytest.mark.parametrize("name", ["out.csv", "out.parquet"])
def test_results_onto_what_is_no_file_are_refused(name, tmp_path):
    out = tmp_path / name
    os.mkfifo(out)
    with pytest.raises(SweepError) as told:
        next(plan(tmp_path, "mass=20:21:2", name=name).run())
    assert str(told.value) == (
        f"cannot keep results in '{out}': it is no regular file; give another --out"
    )
    assert [path.name for path in tmp_path.iterdir()] == [name]


@pytest.mark.parametrize("content", ["precious", "precious\nlines\n", "run,scene\n", "\xff"])
@pytest.mark.parametrize("name", ["out.csv", "out.partial.csv"])
def test_a_file_that_is_no_sweep_is_left_alone(name, content, tmp_path):
    file = tmp_path / name
    file.write_bytes(content.encode("latin-1"))
    out = name.replace(".partial.csv", ".parquet")
    with pytest.raises(SweepError, match=r"give another --out, or remove it$"):
        next(plan(tmp_path, "mass=20:21:2", name=out).run())
    assert file.read_bytes() == content.encode("latin-1")


def test_a_link_in_place_of_a_journal_is_not_followed(tmp_path):
    (tmp_path / "out.partial.csv").symlink_to("elsewhere.csv")
    with pytest.raises(SweepError, match=r"cannot keep results in '.*out.partial.csv'"):
        next(plan(tmp_path, "mass=20:21:2", name="out.parquet").run())
    assert not (tmp_path / "elsewhere.csv").exists()


def test_a_table_of_somebody_else_is_not_replaced(tmp_path):
    out = tmp_path / "out.parquet"
    pyarrow.parquet.write_table(pyarrow.table({"mine": pyarrow.array([], "int64")}), out)
    before = out.read_bytes()
    with pytest.raises(SweepError, match="holds other columns than this sweep has"):
        next(plan(tmp_path, "mass=20:21:2", name="out.parquet").run())
    assert out.read_bytes() == before


def test_a_reason_is_one_line(tmp_path, monkeypatch):
    reason = 'two\nlines,\u2028and "quotes"'
    monkeypatch.setattr(variations, "run_simulations", lambda some, _: [(n, reason) for n in some])
    wanted = plan(tmp_path, "mass=20:21:2")
    rows = list(wanted.run())
    assert [row["reason"] for row in rows] == ['two lines, and "quotes"'] * 2
    assert list(wanted.run()) == rows
