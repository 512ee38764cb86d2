"""Recordings, as `rerun` reads them back."""

import os
import re
import resource
import shlex
import subprocess
import sys
import time

import numpy as np
import pytest
from typer.testing import CliRunner

from buoyancy_mj import DivergenceError, RecordingError, Simulation, read_scene
from buoyancy_mj.cli import app
from buoyancy_mj.scenes import catalog
from buoyancy_mj.viz import recording as recording_module
from buoyancy_mj.viz.bodies import BodyDrawing
from buoyancy_mj.viz.recording import Recording
from buoyancy_mj.viz.rrd import RrdFile

SHORT = ["duration=0.5", "record_rate=30"]


def rerun(*arguments):
    return subprocess.run(
        [sys.executable, "-m", "rerun_cli", "rrd", *arguments],
        capture_output=True,
        text=True,
        check=False,
    )


def recorded(path, scene="hourglass_drop_waves", settings=SHORT, frames=None):
    simulation = Simulation(read_scene(catalog.scenes()[scene], settings))
    recording = Recording(simulation, path)
    for i, frame in enumerate(simulation.frames()):
        if i == frames:
            return simulation, recording
        recording.add(frame)
    recording.close(simulation.summary())
    return simulation, recording


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    path = tmp_path_factory.mktemp("recording") / "run.rrd"
    simulation, _ = recorded(path, settings=["duration=1.5", "record_rate=30"])
    return path, simulation, rerun("print", "-vv", str(path)).stdout


def test_a_recording_verifies(whole):
    done = rerun("verify", str(whole[0]))
    assert done.returncode == 0, done.stderr


def entities(text):
    return {
        entity.replace("\\", "")
        for entity in re.findall(r"/(?:world|plots|scene|summary)[^\s:,]*", text)
    }


def test_it_holds_everything_that_was_promised(whole):
    found = entities(whole[2])
    for entity in (
        "/world/bodies/hourglass",
        "/world/bodies/hourglass/glass",
        "/world/water",
        "/world/waterline",
        "/world/centres/gravity",
        "/world/centres/buoyancy",
        "/world/centres/buoyancy_of_hulls",
        "/world/forces/weight",
        "/world/forces/buoyancy",
        "/world/forces/drag",
        "/plots/volume/total",
        "/plots/volume/hulls/glass",
        "/plots/force/buoyancy",
        "/plots/force/drag",
        "/plots/force/weight",
        "/plots/height/centre_of_gravity",
        "/plots/height/surface",
        "/plots/attitude/roll",
        "/plots/attitude/pitch",
        "/plots/attitude/yaw",
        "/plots/energy/total",
        "/scene",
        "/summary",
    ):
        assert entity in found, entity


def test_it_stands_on_the_timeline_of_simulated_time(whole):
    assert "sim_time" in whole[2]


def test_the_scene_file_and_the_summary_are_in_it(whole):
    content = whole[0].read_bytes()
    assert len(content) > 10_000
    assert "TextDocument" in whole[2]


def test_a_partial_name_is_not_left_behind(whole):
    assert [path.name for path in whole[0].parent.iterdir()] == ["run.rrd"]


def test_a_run_that_breaks_off_leaves_what_was_recorded(tmp_path):
    path = tmp_path / "run.rrd"
    simulation, recording = recorded(path, frames=8)
    left = recording.close(simulation.summary(), complete=False)
    assert left == path
    assert rerun("verify", str(path)).returncode == 0
    assert "/world/bodies/hourglass" in entities(rerun("print", "-vv", str(path)).stdout)


def test_a_whole_recording_is_not_replaced_by_a_piece(tmp_path):
    path = tmp_path / "run.rrd"
    recorded(path)
    before = path.read_bytes()
    simulation, recording = recorded(path, frames=3)
    assert path.read_bytes() == before
    left = recording.close(simulation.summary(), complete=False)
    assert left == tmp_path / "run.partial.rrd"
    assert path.read_bytes() == before
    assert rerun("verify", str(left)).returncode == 0


def test_a_whole_recording_is_replaced_by_a_whole_one(tmp_path):
    path = tmp_path / "run.rrd"
    path.write_text("old")
    recorded(path)
    assert rerun("verify", str(path)).returncode == 0
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.slow
@pytest.mark.long
def test_a_process_that_is_killed_leaves_a_file_that_opens(tmp_path):
    command = [
        sys.executable,
        "-m",
        "buoyancy_mj",
        *shlex.split("run auv_waves --duration 10000 --record run.rrd"),
    ]
    process = subprocess.Popen(
        command, cwd=tmp_path, stderr=subprocess.DEVNULL, start_new_session=True
    )
    partial = tmp_path / "run.partial.rrd"
    while not (partial.exists() and partial.stat().st_size > 2_000_000):
        assert process.poll() is None
        time.sleep(0.1)
    process.kill()
    process.wait(timeout=600)
    assert "/world/bodies/sauvc_auv" in entities(rerun("print", "-vv", str(partial)).stdout)
    # and another run may take its place
    recorded(tmp_path / "run.rrd")
    assert rerun("verify", str(tmp_path / "run.rrd")).returncode == 0


FULL_DISK = """
import resource, sys
from pathlib import Path
from buoyancy_mj import RecordingError, Simulation, read_scene
from buoyancy_mj.scenes import catalog
from buoyancy_mj.viz import recording as module
module.FLUSH_EVERY = 0.02
Recording = module.Recording
simulation = Simulation(read_scene(catalog.scenes()["auv_waves"], ["duration=8"]))
recording = Recording(simulation, Path(sys.argv[1]))
# a file may not grow beyond this: writing fails as on a full disk
resource.setrlimit(resource.RLIMIT_FSIZE, (3_000_000, 3_000_000))
try:
    for frame in simulation.frames():
        recording.add(frame)
except RecordingError as error:
    print(error)
"""


@pytest.mark.skipif(not hasattr(resource, "RLIMIT_FSIZE"), reason="needs limits on file sizes")
def test_a_full_disk_ends_the_recording_at_a_whole_message_and_says_so(tmp_path):
    path = tmp_path / "run.rrd"
    done = subprocess.run(
        [sys.executable, "-c", FULL_DISK, str(path)],
        capture_output=True,
        text=True,
        check=False,
        timeout=600,
    )
    assert (
        f"the recording broke off: File too large; what was written is in '{path}'" in done.stdout
    ), done.stderr
    assert path.stat().st_size <= 3_000_000
    assert "/world/bodies/sauvc_auv" in entities(rerun("print", "-vv", str(path)).stdout)


def test_a_place_that_is_no_folder_is_reported(tmp_path):
    (tmp_path / "file").write_text("")
    simulation = Simulation(read_scene(catalog.scenes()["hourglass_drop_still"], SHORT))
    with pytest.raises(
        RecordingError,
        match=r"cannot write '.*run.rrd': .*; choose another place \(--record\)",
    ):
        Recording(simulation, tmp_path / "file" / "run.rrd")


def test_what_is_no_regular_file_is_not_replaced(tmp_path):
    simulation = Simulation(read_scene(catalog.scenes()["hourglass_drop_still"], SHORT))
    path = tmp_path / "run.rrd"
    os.mkfifo(path)
    with pytest.raises(RecordingError) as told:
        Recording(simulation, path)
    assert str(told.value) == (
        f"cannot write '{path}': it is no regular file; choose another place (--record)"
    )
    assert path.is_fifo()


def test_every_load_of_a_sea_is_plotted_by_its_cause(tmp_path):
    path = tmp_path / "run.rrd"
    recorded(path, "auv_sea_state_2", ["duration=0.1"])
    found = entities(rerun("print", "-vv", str(path)).stdout)
    for cause in ("weight", "buoyancy", "wave_pressure", "drag", "added_mass"):
        assert f"/plots/force/{cause}" in found, cause
    recorded(path, "sphere_decay", ["duration=0.1"])
    assert "/plots/force/radiation" in entities(rerun("print", "-vv", str(path)).stdout)


FLEET = """
title = "Two"
duration = 0.1
[[vehicles]]
model = "hourglass"
name = "first"
[[vehicles]]
model = "hourglass"
name = "other"
start.position = [1.0, 0.0, 0.0]
"""


def test_each_of_several_vehicles_has_its_own_plots_centres_and_forces(tmp_path):
    (tmp_path / "two.toml").write_text(FLEET)
    simulation = Simulation(read_scene(tmp_path / "two.toml"))
    recording = Recording(simulation, tmp_path / "run.rrd")
    for frame in simulation.frames():
        recording.add(frame)
    recording.close(simulation.summary())
    text = rerun("print", "-vv", str(tmp_path / "run.rrd")).stdout
    found = entities(text)
    for name in ("first", "other"):
        for entity in (
            f"/plots/{name}/height/centre_of_gravity",
            f"/plots/{name}/energy/total",
            f"/plots/{name}/force/buoyancy",
            f"/plots/{name}/volume/hulls/{name}/glass",
            f"/world/centres/{name}/gravity",
            f"/world/forces/{name}/drag",
            f"/world/bodies/{name}/hourglass/{name}/glass",
        ):
            assert entity in found, entity
    assert "/plots/height/centre_of_gravity" not in found
    assert "/world/centres/gravity" not in found


def test_surroundings_are_drawn_and_not_plotted(tmp_path):
    (tmp_path / "harbour.xml").write_text(
        """<mujoco><worldbody>
        <body name="pier" pos="1 0 0"><geom name="wall" type="box" size=".1 1 1" mass="5"/></body>
        <body name="goal" mocap="true" pos="0 1 0"><geom name="ring" size=".1"/></body>
        <body name="boat"><freejoint/><geom name="hull" type="box" size=".2 .1 .1" mass="8"/></body>
        </worldbody></mujoco>"""
    )
    settings = ["duration=0.1", f"vehicle='{tmp_path / 'harbour.xml'}'"]
    simulation, _ = recorded(tmp_path / "run.rrd", settings=settings)
    found = entities(rerun("print", "-vv", str(tmp_path / "run.rrd")).stdout)
    assert {
        "/world/environment/wall",
        "/world/bodies/goal/ring",
        "/world/bodies/boat/hull",
    } <= found
    assert {name for name in found if "hulls" in name and "plots" in name} == {
        "/plots/volume/hulls/hull"
    }
    # the camera and the arrows have the size of the boat
    assert simulation.vehicle.length == pytest.approx(2.0 * np.hypot(0.2, np.hypot(0.1, 0.1)))


@pytest.mark.parametrize("scene", ["auv_pool", "auv_drop_still"])
def test_the_other_kinds_of_scene_record_too(tmp_path, scene):
    path = tmp_path / "run.rrd"
    recorded(path, scene, ["duration=0.1"])
    found = entities(rerun("print", "-vv", str(path)).stdout)
    assert "/world/bodies/sauvc_auv/frame" in found
    assert ("/world/environment/environment/floor_west" in found) == (scene == "auv_pool")


def test_names_may_hold_anything(tmp_path):
    (tmp_path / "odd.xml").write_text(
        """<mujoco><worldbody><body name="my boat/2"><freejoint/>
        <geom name="bow \u00e9 [1]" type="box" size=".2 .1 .1"
        density="300"/><geom type="box" size=".05 .05 .05" pos="0 0 .15" density="300"/>
        <geom name="total" type="box" size=".05 .05 .05" pos="0 0 -.15" density="300"/>
        </body></worldbody></mujoco>"""
    )
    recorded(tmp_path / "run.rrd", settings=["duration=0.1", f"vehicle='{tmp_path / 'odd.xml'}'"])
    assert rerun("verify", str(tmp_path / "run.rrd")).returncode == 0
    found = rerun("print", "-vv", str(tmp_path / "run.rrd")).stdout.replace("\\", "")
    assert "/world/bodies/my boat/2/bow \u00e9 [1]" in found
    assert "/plots/volume/hulls/total" in found
    assert "/plots/volume/hulls/my boat/2/box 1" in found


def test_two_runs_do_not_write_one_file(tmp_path):
    simulation, recording = recorded(tmp_path / "run.rrd", frames=3)
    with pytest.raises(
        RecordingError, match=r"another run is writing '.*run.partial.rrd'; choose another place"
    ):
        Recording(simulation, tmp_path / "run.rrd")
    assert recording.close(simulation.summary()) == tmp_path / "run.rrd"


def test_a_file_of_the_partial_name_and_what_a_link_leads_to_are_left_alone(tmp_path):
    (tmp_path / "target").write_text("precious")
    (tmp_path / "run.partial.rrd").symlink_to("target")
    (tmp_path / "run.partial-2.rrd").write_text("precious")
    _, recording = recorded(tmp_path / "run.rrd", frames=2)
    assert (tmp_path / "run.partial-3.rrd").stat().st_size > 10_000
    assert recording.close() == tmp_path / "run.rrd"
    assert rerun("verify", str(tmp_path / "run.rrd")).returncode == 0
    assert (tmp_path / "target").read_text() == "precious"
    assert (tmp_path / "run.partial-2.rrd").read_text() == "precious"
    assert not (tmp_path / "run.partial-3.rrd").exists()


def test_a_link_in_place_of_a_recording_is_replaced_and_not_followed(tmp_path):
    (tmp_path / "target").write_text("precious")
    (tmp_path / "run.rrd").symlink_to("target")
    recorded(tmp_path / "run.rrd")
    assert (tmp_path / "target").read_text() == "precious"
    assert not (tmp_path / "run.rrd").is_symlink()


def test_ctrl_c_before_the_first_frame_leaves_nothing(tmp_path, monkeypatch):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(BodyDrawing, "draw_static", interrupted)
    with pytest.raises(KeyboardInterrupt):
        recorded(tmp_path / "run.rrd")
    assert list(tmp_path.iterdir()) == []


def test_ctrl_c_while_the_footer_is_added_leaves_a_recording_without(tmp_path, monkeypatch):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    simulation, recording = recorded(tmp_path / "run.rrd", frames=3)
    with monkeypatch.context() as patched:
        patched.setattr(subprocess, "run", interrupted)
        with pytest.raises(KeyboardInterrupt):
            recording.close(simulation.summary())
    assert [path.name for path in tmp_path.iterdir()] == ["run.rrd"]
    assert recording.closed
    assert "/world/bodies/hourglass" in entities(
        rerun("print", "-vv", str(tmp_path / "run.rrd")).stdout
    )


@pytest.mark.parametrize("when", ["a frame is added", "it is closed"])
def test_a_run_that_breaks_off_says_why_and_where_its_recording_is(tmp_path, monkeypatch, when):
    monkeypatch.chdir(tmp_path)
    target, name = {
        "a frame is added": (BodyDrawing, "draw"),
        "it is closed": (recording_module, "write_numbers"),
    }[when]
    calls = []
    original = getattr(target, name)

    def third(*arguments, **options):
        calls.append(1)
        if len(calls) == (3 if name == "draw" else 1):
            raise KeyboardInterrupt
        return original(*arguments, **options)

    monkeypatch.setattr(target, name, third)
    arguments = shlex.split("run hourglass_drop_still --duration 0.2 --record run.rrd")
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code == 130
    assert re.fullmatch(r"the recording up to 0\.\d\d s is in 'run.rrd'\n", result.stderr)
    assert rerun("verify", "run.rrd").returncode == 0


def test_a_full_disk_at_the_end_of_a_run_that_diverged_hides_neither(tmp_path, monkeypatch):
    def full(self):
        if self._file.size > 100_000:
            self.close(complete=False)
            raise RecordingError("the recording broke off: No space left on device; ...")
        return write(self)

    def diverges(*_):
        raise DivergenceError("the simulation diverged")

    write = RrdFile.write
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(RrdFile, "write", full)
    monkeypatch.setattr(Simulation, "advance", diverges)
    monkeypatch.setattr(recording_module, "FLUSH_EVERY", float("inf"))
    arguments = shlex.split("run hourglass_drop_still --duration 0.2 --record run.rrd")
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code == 1
    assert result.stderr == (
        "note: the recording broke off: No space left on device; ...\n"
        "error: the simulation diverged\n"
    )


@pytest.mark.slow
def test_a_live_viewer_that_cannot_open_is_reported_and_leaves_nothing(tmp_path):
    environment = {
        key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY")
    }
    command = [
        sys.executable,
        "-m",
        "buoyancy_mj",
        *shlex.split("run hourglass_drop_still --live --record out.rrd"),
    ]
    done = subprocess.run(
        command,
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=600,
    )
    assert done.returncode == 1
    assert "error: no Rerun viewer could be started" in done.stderr
    assert "Traceback" not in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_foils_that_are_sites_are_in_it(tmp_path):
    path = tmp_path / "run.rrd"
    settings = [*SHORT, "vehicle=glider", "start.position.2=-2"]
    recorded(path, "auv_drop_still", settings)
    found = entities(rerun("print", "-vv", str(path)).stdout)
    for name in ("hull", "wing_port", "wing_starboard", "fin"):
        assert f"/world/bodies/glider/{name}" in found, name
