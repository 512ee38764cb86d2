"""Where this package is installed, MuJoCo knows its plugins, and nobody imports it."""

import ctypes
import subprocess
import sys

import pytest

from buoyancy_mj import BuoyancyWarning, EngineError
from buoyancy_mj.engine import announcing, library
from buoyancy_mj.engine.announced import PLUGINS
from buoyancy_mj.engine.device_kinds import KINDS
from buoyancy_mj.vehicle.sensors.kinds import CHANNELS
from tests.installed import install

DRAFT = 0.24
"""Of the box, 0.4 m high and 0.6 times as dense as the water [m]."""
BOX = """<mujoco>
  <extension>
    <plugin plugin="buoyancy_mj.water">
      <instance name="sea"><config key="density" value="DENSITY"/></instance>
    </plugin>
    <plugin plugin="buoyancy_mj.depth"/>
    <plugin plugin="buoyancy_mj.thruster"/>
  </extension>
  <option timestep="0.01"/>
  <worldbody>
    <body>
      <freejoint/><geom type="box" size="0.5 0.5 0.2" density="600"/>
      <site name="keel" pos="0 0 -0.2"/>
    </body>
  </worldbody>
  <actuator>
    <plugin plugin="buoyancy_mj.thruster" site="keel" gear="0 0 1 0 0 0" actdim="1">
      <config key="preset" value="t200"/>
    </plugin>
  </actuator>
  <sensor><plugin name="draft" plugin="buoyancy_mj.depth" objtype="site" objname="keel"/></sensor>
</mujoco>"""
FLOAT = """
def float_box(model):
    data = mujoco.MjData(model)
    for _ in range(1000):
        mujoco.mj_step(model, data)
    return f"{data.sensor('draft').data[0]:.2f}"
"""


@pytest.fixture
def run(tmp_path):
    """Runs code in a process where this package is installed, beside a box.xml."""
    environment = install(tmp_path)
    (tmp_path / "box.xml").write_text(BOX.replace("DENSITY", "1000"))

    def run_code(code, *options, first="mujoco"):
        return subprocess.run(
            [sys.executable, *options, "-c", f"import {first}, mujoco\n{FLOAT}\n{code}"],
            env=environment, cwd=tmp_path, capture_output=True, text=True, timeout=300,
        )  # fmt: skip

    return run_code


def told(done):
    """What a process that ended well has printed."""
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    return done.stdout.split()


def test_a_box_floats_where_mujoco_alone_is_imported(run):
    code = "print(float_box(mujoco.MjModel.from_xml_path('box.xml')))"
    assert told(run(code, "-W", "error")) == [f"{DRAFT:.2f}"]


def test_it_is_the_same_where_this_package_is_imported_before_mujoco(run):
    code = "print(float_box(mujoco.MjModel.from_xml_path('box.xml')))"
    assert told(run(code, first="buoyancy_mj")) == [f"{DRAFT:.2f}"]


def test_a_model_of_a_binary_file_floats_and_is_pickled(run):
    save = "mujoco.mj_saveModel(mujoco.MjModel.from_xml_path('box.xml'), 'box.mjb')"
    told(run(save))
    load = """
import pickle
model = mujoco.MjModel.from_binary_path("box.mjb")
print(float_box(pickle.loads(pickle.dumps(model))))
"""
    assert told(run(load)) == [f"{DRAFT:.2f}"]


def test_importing_mujoco_waits_for_neither_numba_nor_scipy(run):
    modules = told(run("import sys; print(*sys.modules)"))
    assert "buoyancy_mj.engine.announcing" in modules
    assert not {"numba", "llvmlite", "scipy", "buoyancy_mj.kernels"} & {*modules}


def test_a_wrong_value_is_a_compile_error_of_the_first_model_too(run, tmp_path):
    (tmp_path / "box.xml").write_text(BOX.replace("DENSITY", "-1"))
    done = run("mujoco.MjModel.from_xml_path('box.xml')")
    assert done.returncode == 1
    assert "'sea': density is -1.0; it must be above 0" in done.stderr
    assert "ValueError" in done.stderr


def test_threads_and_forked_children_ask_for_the_first_water_at_once(run):
    code = """
import os
from concurrent.futures import ThreadPoolExecutor

def load(_):
    return float_box(mujoco.MjModel.from_xml_path("box.xml"))

children = []
for _ in range(2 * hasattr(os, "fork")):
    children.append(os.fork())
    if children[-1] == 0:
        os._exit(int(load(0) != "0.24"))
with ThreadPoolExecutor(4) as threads:
    print(*threads.map(load, range(4)))
assert all(os.waitpid(child, 0)[1] == 0 for child in children)
"""
    assert told(run(code)) == [f"{DRAFT:.2f}"] * 4


def test_signals_before_the_first_line_leave_no_rubbish_in_the_model(run):
    code = """
import sys

def interrupt(frame, event, argument):
    # as signals do
    if frame.f_code.co_name == "_import_rest":
        raise KeyboardInterrupt

def go_on(raised):
    print(raised.exc_type.__name__)
    sys.setprofile(interrupt)

sys.unraisablehook = go_on
sys.setprofile(interrupt)
model = mujoco.MjModel.from_xml_path("box.xml")
sys.setprofile(None)
print(model.npluginstate, float_box(model))
"""
    *raised, states, draft = told(run(code))
    assert {*raised} == {"KeyboardInterrupt"}
    assert (states, draft) == ("5", f"{DRAFT:.2f}")


def test_what_the_import_raises_is_told_in_a_sentence(run, tmp_path):
    (tmp_path / "numba.py").write_text("raise ImportError('Numba knows no such processor')")
    done = run("mujoco.MjModel.from_xml_path('box.xml')")
    assert done.returncode == 1
    assert (
        "BuoyancyWarning: models cannot bring their own water here: Numba knows no such processor"
        in done.stderr
    )
    assert "ValueError: Error: engine error: plugin->init failed" in done.stderr


def test_importing_this_package_too_registers_nothing_twice(run):
    code = """
def count():
    from buoyancy_mj.engine import library
    import ctypes
    return library.function("mjp_pluginCount", ctypes.c_int)()

before = count()
import buoyancy_mj
buoyancy_mj.Buoyancy
print(count() - before)
"""
    assert told(run(code)) == ["0"]


def test_every_announced_plugin_is_one_in_the_end():
    assert announcing._compiled == {plugin.name for plugin in PLUGINS}
    assert {kind.plugin for kind in KINDS.values()} == announcing._compiled - {"buoyancy_mj.water"}
    assert {plugin.name for plugin in PLUGINS if plugin.numbers} == {*CHANNELS}


def test_a_plugin_that_was_announced_as_something_else_is_refused():
    with pytest.raises(ValueError, match=r"is not what engine\.announced says of it; correct it"):
        announcing.put_hooks(PLUGINS[0]._replace(keys=("density",)), {})


def test_a_mujoco_without_plugins_is_a_warning(monkeypatch):
    def fail(_):
        raise EngineError("MuJoCo 9 has no function mjp_getPlugin; take another")

    monkeypatch.setattr(announcing, "find_plugin", fail)
    with pytest.warns(BuoyancyWarning, match="cannot bring their own water here: MuJoCo 9 has no"):
        announcing.announce.__wrapped__()


def test_plugins_keep_the_numbers_by_which_files_name_them():
    count = library.function("mjp_pluginCount", ctypes.c_int)()
    at = library.function("mjp_getPluginAtSlot", ctypes.POINTER(ctypes.c_char_p), ctypes.c_int)
    names = [at(slot)[0].decode() for slot in range(count)]
    first = names.index("buoyancy_mj.water")
    assert names[first : first + len(PLUGINS)] == [plugin.name for plugin in PLUGINS]
