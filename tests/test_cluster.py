"""Sweeps on a cluster: chunks, bundles of files, and a local Ray of two processes."""

import csv
import importlib.util
import math
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import trimesh

from buoyancy_mj import SweepError
from buoyancy_mj.scenes import catalog, cluster, places, worker
from buoyancy_mj.scenes.bundle import describe_software, pack, unpack
from buoyancy_mj.scenes.cluster import chunk_size
from buoyancy_mj.scenes.scene_files import list_scene_files
from buoyancy_mj.scenes.sweep import Sweep
from buoyancy_mj.scenes.variations import vary

needs_ray = pytest.mark.skipif(
    importlib.util.find_spec("ray") is None,
    reason="Ray is not installed: pip install 'buoyancy_mj[ray]'",
)
BLOCK = trimesh.creation.box((0.4, 0.3, 0.2)).export(file_type="obj")
MODEL = """<mujoco><compiler meshdir="{meshdir}"/>
<asset><mesh name="block" file="block.obj"/></asset>
<worldbody><include file="body.xml"/></worldbody></mujoco>"""
BODY = (
    """<mujoco><body><freejoint/><geom type="mesh" mesh="block" density="500"/></body></mujoco>"""
)
SCENE = """title = "A block"
vehicle = "{vehicle}"
duration = 0.1
[water.current]
kind = "series"
file = "current.csv"
"""


def write_scene(folder, vehicle="models/block.xml", meshdir="meshes"):
    """A scene whose files lie in several folders."""
    for name, text in (
        ("scenes/block.toml", SCENE.format(vehicle=vehicle)),
        ("scenes/current.csv", "0.0, 0.5, 0.0\n1.0, 0.0, 0.5\n"),
        ("scenes/models/block.xml", MODEL.format(meshdir=meshdir)),
        ("scenes/models/body.xml", BODY),
        ("scenes/models/meshes/block.obj", BLOCK),
    ):
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return folder / "scenes" / "block.toml"


# chunks -------------------------------------------------------------------------------------------


def list_chunks(runs, cores, run_time):
    """Sizes of all chunks of a sweep, one after the other."""
    sizes = []
    while runs:
        sizes.append(min(runs, chunk_size(runs, cores, run_time)))
        runs -= sizes[-1]
    return sizes


def test_chunks_shrink_towards_the_end_down_to_one_run():
    sizes = list_chunks(10_000, 100, 0.1)
    assert sizes[0] == 10_000 // (cluster.SHARE * 100)
    assert sizes == sorted(sizes, reverse=True)
    assert sizes[-100:] == [1] * 100


def test_chunks_are_long_enough_that_one_process_can_give_them_to_all_cores():
    sizes = list_chunks(1_000_000, 10_000, 0.1)
    assert min(sizes[:-1]) * 0.1 >= 10_000 * cluster.GIVING_TIME


def test_a_chunk_takes_no_longer_than_its_time_and_is_one_run_at_first():
    assert chunk_size(1_000_000, 10, math.inf) == 1
    assert chunk_size(1_000_000, 10, 2.0) == cluster.CHUNK_TIME / 2.0
    assert chunk_size(1_000_000, 10, 60.0) == 1
    assert chunk_size(1_000_000, 10, 1e-6) == cluster.MOST_RUNS


# bundles ------------------------------------------------------------------------------------------


def test_files_of_a_scene_are_found_through_includes_and_folders(tmp_path):
    scene = write_scene(tmp_path)
    names = [str(path.relative_to(tmp_path / "scenes")) for path in list_scene_files(scene)]
    assert names == [
        "block.toml",
        "current.csv",
        "models/block.xml",
        "models/body.xml",
        "models/meshes/block.obj",
    ]


def test_files_of_a_controller_and_its_neighbours_are_found(tmp_path):
    scene = write_scene(tmp_path)
    for name in ("steer.py", "gains.py"):
        (tmp_path / name).write_text("")
    found = list_scene_files(scene, ['control={kind="file", file="../steer.py:update"}'])
    assert {tmp_path / "steer.py", tmp_path / "gains.py"} <= set(found)


def test_files_of_a_urdf_are_found_wherever_their_package_is(tmp_path):
    robot = """<robot name="b"><link name="b"><visual><geometry>
    <mesh filename="package://boat/meshes/block.obj"/></geometry></visual></link></robot>"""
    mesh = tmp_path / "boat" / "meshes" / "block.obj"
    mesh.parent.mkdir(parents=True)
    mesh.write_text(BLOCK)
    (tmp_path / "boat" / "boat.urdf").write_text(robot)
    scene = write_scene(tmp_path, vehicle="../boat/boat.urdf")
    assert mesh in list_scene_files(scene)


@pytest.mark.parametrize("absolute", [False, True])
def test_a_bundle_gives_the_same_rows_where_its_files_are_not(tmp_path, absolute):
    home, away = tmp_path / "home", tmp_path / "away"
    meshes = home / "scenes" / "models" / "meshes"
    scene = write_scene(home, meshdir=str(meshes) if absolute else "meshes")
    settings = (f"vehicle={home}/scenes/models/block.xml",) if absolute else ()
    values = {0: (0.0,), 1: (0.1,), 2: (math.inf,)}
    here = vary(scene, settings, ("start.position.2",), list(values.values()), trust=False)
    wanted = list(here.run(values))
    packed = pack(here)
    assert unpack(packed) == here
    shutil.rmtree(home)
    there = unpack(packed, away)
    assert there.path == away / scene.relative_to("/")
    assert list(there.run(values)) == wanted
    assert [row["status"] for row in wanted] == ["failed", "done", "done"]


def test_reasons_name_the_files_of_the_machine_from_which_the_sweep_was_started(tmp_path):
    home, away = tmp_path / "home", tmp_path / "away"
    scene = write_scene(home)
    (home / "scenes/models/body.xml").write_text(BODY.replace("<freejoint/>", "<freejoint/>" * 2))
    here = vary(scene, (), ("start.yaw",), [(0.0,)], trust=False)
    packed = pack(here)
    shutil.rmtree(home)
    (row,) = unpack(packed, away).run({0: (0.0,)})
    assert str(home / "scenes/models/block.xml") in row["reason"]
    assert str(away) not in row["reason"]


def test_what_ships_is_not_in_a_bundle_and_must_be_the_same():
    here = vary(catalog.scenes()["auv_waves"], (), ("mass",), [(20.0,)], trust=False)
    packed = pack(here)
    assert packed.files == ()
    assert "scenes/auv_waves.toml" in dict(packed.shipped)
    assert unpack(packed) == here
    others = tuple((name, "0" * 8) for name, _ in packed.shipped)
    with pytest.raises(SweepError, match=r"has another 'models/.*' than the one from which"):
        unpack(packed._replace(shipped=others))
    with pytest.raises(SweepError, match=r"has buoyancy_mj .*, and the sweep was started with new"):
        unpack(packed._replace(software="new"))
    assert describe_software().startswith("buoyancy_mj ")


def test_a_machine_compiles_for_a_scene_once_for_each_software(tmp_path, monkeypatch):
    here = vary(catalog.scenes()["auv_waves"], (), ("mass",), [(20.0,)], trust=False)
    built = []
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.setattr(worker, "Simulation", lambda *_, **__: built.append(1))
    for software, count in (("old", 1), ("old", 1), ("new", 2), ("new", 2)):
        # as in a process that has just started
        monkeypatch.setattr(worker, "_compiled", set())
        monkeypatch.setattr(worker, "describe_software", lambda software=software: software)
        worker._compile_in_turn(here, (20.0,))
        assert len(built) == count


# places -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("on", ["moon", "ray:", "ray://host", "ray://:1", "ray://a:b", 3])
def test_a_place_that_is_none_is_reported(on):
    with pytest.raises(SweepError, match=r"--on is .*; it must be local, ray, or ray://HOST:PORT"):
        places.find_place(on)


def test_threads_and_ray_exclude_each_other():
    with pytest.raises(SweepError, match=r"--threads is 2 beside --on ray, where each run has one"):
        places.find_place("ray", 2)


def test_ray_that_is_not_installed_is_reported(monkeypatch):
    monkeypatch.setitem(sys.modules, "ray", None)
    with pytest.raises(SweepError, match=r"pip install 'buoyancy_mj\[ray\]'"):
        places.find_place("ray")


# Ray ----------------------------------------------------------------------------------------------


def read(path):
    with path.open() as file:
        return list(csv.DictReader(file))


def find_workers():
    """Processes of workers of Ray."""
    found = []
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            words = (entry / "cmdline").read_bytes()
        except OSError:
            continue
        if words.startswith(b"ray::run_chunk"):
            found.append(int(entry.name))
    return found


@needs_ray
@pytest.mark.long
@pytest.mark.slow
def test_rows_on_ray_are_those_of_this_machine_though_a_worker_is_killed(tmp_path):
    ray = pytest.importorskip("ray")
    plans = [
        Sweep.over("auv_waves", ["mass=20:26:40"], tmp_path / name, settings=["duration=2"])
        for name in ("local.csv", "ray.csv")
    ]
    rows = list(plans[0].run())
    os.environ["RAY_AUTH_MODE"] = "disabled"
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
    try:
        going = plans[1].run(on="ray")
        first = next(going)
        victims = find_workers()
        os.kill(victims[0], signal.SIGKILL)
        seen = [first, *going]
    finally:
        ray.shutdown()
    assert sorted(seen, key=lambda row: int(row["run"])) == rows
    assert (tmp_path / "ray.csv").read_bytes() == (tmp_path / "local.csv").read_bytes()


@needs_ray
@pytest.mark.long
@pytest.mark.slow
def test_a_sweep_on_ray_that_is_killed_goes_on_locally(tmp_path):
    out = tmp_path / "out.csv"
    command = [sys.executable, "-m", "buoyancy_mj", "sweep", "hourglass_drop_waves"]
    command += ["--over", "start.position.2=0.1:0.9:200", "--duration", "1", "--out", str(out)]
    (tmp_path / "trimesh.py").write_text("raise SystemExit('a file of the working folder')")
    running = subprocess.Popen([*command, "--on", "ray"], cwd=tmp_path)
    while not out.exists() or len(out.read_bytes().splitlines()) < 3:
        assert running.poll() is None
        time.sleep(0.02)
    running.send_signal(signal.SIGINT)
    assert running.wait(60) == 130
    assert len(read(out)) < 200
    assert subprocess.run(command, cwd=tmp_path, check=False).returncode == 0
    assert [int(row["run"]) for row in read(out)] == list(range(200))
