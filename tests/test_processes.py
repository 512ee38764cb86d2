"""Water in several processes: forks while threads work, pickles, and the end of an interpreter."""

import os
import pickle
import subprocess
import sys

import mujoco
import numpy as np
import pytest

from buoyancy_mj import Buoyancy, Water, add_water, water_in

BODY = """<mujoco><option timestep="0.004"/><worldbody>
  <body name="one"><freejoint/><geom type="box" size=".3 .2 .1" mass="12"/></body>
</worldbody></mujoco>"""
FORK = """
import contextlib, os, signal, threading, time, warnings
import mujoco
from buoyancy_mj import Buoyancy, Water, add_water

warnings.simplefilter("ignore")

def made(kind, number):
    spec = mujoco.MjSpec.from_string(BODY)
    if kind in ("plugin", "new plugins"):
        add_water(spec, Water(density=900.0 + number))
    return spec.compile()

def ends_well(pid):
    for _ in range(1500):
        ended, status = os.waitpid(pid, os.WNOHANG)
        if ended:
            return status == 0
        time.sleep(0.01)
    os.kill(pid, signal.SIGKILL)
    os.waitpid(pid, 0)
    return False

def live(kind, models, done):
    number = 0
    while not done.is_set():
        number += 1
        model = made(kind, number) if kind == "new plugins" else models[number % 3]
        data = mujoco.MjData(model)
        for _ in range(20):
            mujoco.mj_step(model, data)

def fork(kind, models):
    done = threading.Event()
    threads = [threading.Thread(target=live, args=(kind, models, done)) for _ in range(4)]
    for thread in threads:
        thread.start()
    well = 0
    for _ in range(8):
        pid = os.fork()
        if pid == 0:
            data = mujoco.MjData(models[0])
            mujoco.mj_step(models[0], data)
            os._exit(int(not data.qacc[2] > 0.0))
        well += ends_well(pid)
    done.set()
    for thread in threads:
        thread.join()
    return well

for kind in ("compiled", "python", "plugin", "new plugins"):
    models = [made(kind, number) for number in range(3)]
    mujoco.mj_step(models[0], mujoco.MjData(models[0]))
    block = contextlib.nullcontext()
    if kind in ("compiled", "python"):
        block = Buoyancy(models[0]).installed(native=kind == "compiled")
    with block:
        print(kind, fork(kind, models), flush=True)
"""
READ = """
import pickle, sys
import mujoco
value = pickle.load(open(sys.argv[1], "rb"))
data = value if isinstance(value, mujoco.MjData) else mujoco.MjData(value)
mujoco.mj_step(data.model, data)
print(data.qacc[2] > 0.0)
"""
SPAWN = """
import multiprocessing
import mujoco
import buoyancy_mj

def lift(water):
    data = mujoco.MjData(water.model)
    with water.installed():
        mujoco.mj_step(water.model, data)
    return float(water.loads(data).total.force[2])

if __name__ == "__main__":
    water = buoyancy_mj.Buoyancy(mujoco.MjModel.from_xml_string(BODY))
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        print(pool.map(lift, [water])[0] == lift(water) > 0.0)
"""
IDLE = """
import threading
import mujoco
import buoyancy_mj

spec = mujoco.MjSpec.from_string(BODY)
buoyancy_mj.add_water(spec)
wet, dry = spec.compile(), mujoco.MjModel.from_xml_string(BODY)

def wait(model):
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data)
    ready.release()
    threading.Event().wait()

ready = threading.Semaphore(0)
block = buoyancy_mj.Buoyancy(dry).installed()
block.__enter__()
for model in (wet, dry):
    threading.Thread(target=wait, args=(model,), daemon=True).start()
    ready.acquire()
"""


def run(script, *arguments, tmp_path):
    """What a script prints in a process of its own."""
    file = tmp_path / "script.py"
    file.write_text(f"BODY = {BODY!r}\n{script}")
    done = subprocess.run(
        [sys.executable, str(file), *arguments], capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stderr
    assert "Error" not in done.stderr
    return done.stdout.strip()


def with_water():
    spec = mujoco.MjSpec.from_string(BODY)
    add_water(spec, Water(density=1025.0))
    return spec.compile()


@pytest.mark.long
@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
def test_children_that_are_forked_while_threads_work_in_water_are_well(tmp_path):
    told = run(FORK, tmp_path=tmp_path)
    assert told.splitlines() == ["compiled 8", "python 8", "plugin 8", "new plugins 8"]


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["model", "data"])
def test_a_pickle_with_water_is_read_where_the_package_is_not_imported(kind, tmp_path):
    model = with_water()
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data)
    file = tmp_path / "wet.pickle"
    file.write_bytes(pickle.dumps(model if kind == "model" else data))
    assert run(READ, str(file), tmp_path=tmp_path) == "True"


@pytest.mark.slow
def test_a_water_goes_to_a_spawned_process(tmp_path):
    assert run(SPAWN, tmp_path=tmp_path) == "True"


@pytest.mark.slow
def test_an_interpreter_ends_well_beside_idle_daemon_threads(tmp_path):
    assert run(IDLE, tmp_path=tmp_path) == ""


def test_pickled_data_go_on_as_the_original_with_records_of_their_own():
    model = with_water()
    data = mujoco.MjData(model)
    for _ in range(10):
        mujoco.mj_step(model, data)
    other = pickle.loads(pickle.dumps(data))
    for _ in range(10):
        mujoco.mj_step(model, data)
        mujoco.mj_step(other.model, other)
    assert np.array_equal(other.qpos, data.qpos)
    other.qpos[2] = 9.0
    mujoco.mj_forward(other.model, other)
    assert water_in(model).loads(data).total.volume > 0.0
    assert water_in(other.model).loads(other).total.volume == 0.0


def test_models_without_water_are_pickled_as_ever():
    model = mujoco.MjModel.from_xml_string(BODY)
    assert b"buoyancy_mj" not in pickle.dumps(model)
    assert pickle.loads(pickle.dumps(mujoco.MjData(model))).model.nq == 7
    assert b"buoyancy_mj" in pickle.dumps(Buoyancy(model))
