"""What a start imports and compiles, and what it leaves until it is used."""

import subprocess
import sys

import pytest

import buoyancy_mj

HEAVY = ("trimesh", "rerun", "networkx", "pyarrow", "matplotlib", "rich")
"""Libraries that a start does not wait for."""
SCIPY = ("scipy.linalg", "scipy.optimize", "scipy.sparse", "scipy.spatial")
"""Parts of SciPy, which imports each when it is first used."""

FLOAT = """
import mujoco
model = mujoco.MjModel.from_xml_string('''
<mujoco>
  <extension><plugin plugin="buoyancy_mj.water"><instance name="sea"/></plugin></extension>
  <worldbody><body><freejoint/><geom size="0.3" density="500"/></body></worldbody>
</mujoco>''')
data = mujoco.MjData(model)
mujoco.mj_forward(model, data)
assert data.qfrc_passive[2] > 0.0
"""
"""Water in a model, for a process that knows the plugins."""


def imported_by(code):
    """Names of the modules that another process has imported after some code."""
    return modules_of("-c", f"{code}\nimport sys; print('MODULES', *sys.modules)")


def modules_of(*arguments):
    """The names of modules that another process prints at its end."""
    process = [sys.executable, *map(str, arguments)]
    done = subprocess.run(process, capture_output=True, text=True, check=True)
    return set(done.stdout.rpartition("MODULES")[2].split())


def test_an_import_waits_for_no_heavy_library():
    assert not imported_by("import buoyancy_mj") & {*HEAVY, "scipy", "numba"}


def test_the_first_name_waits_for_no_heavy_library_but_numba():
    modules = imported_by("from buoyancy_mj import Buoyancy")
    assert not modules & {*HEAVY, *SCIPY}
    # Numba's own machine code is first needed when a kernel runs
    assert "numba.np.arraymath" not in modules
    assert not [name for name in modules if name.startswith("buoyancy_mj.viz")]


def test_help_waits_for_neither_numba_nor_mujoco(tmp_path):
    command = tmp_path / "buoyancy-mj"
    command.write_text(
        "from buoyancy_mj.cli import app\n"
        "app(['--help'], standalone_mode=False)\n"
        "import sys; print('MODULES', *sys.modules)"
    )
    modules = modules_of(command)
    assert not modules & {*HEAVY, "scipy", "numpy", "numba", "mujoco"}


def test_a_process_that_the_command_spawns_knows_the_plugins():
    # it is given the arguments of the command
    code = "import sys; sys.argv = ['/usr/bin/buoyancy-mj', 'run']\nimport buoyancy_mj"
    assert "numba" in imported_by(code + FLOAT)


def test_the_plugins_are_known_after_an_import_alone():
    assert "numba" in imported_by("import mujoco, buoyancy_mj" + FLOAT)


def test_public_names_come_from_where_the_source_says():
    names = [name for name in dir(buoyancy_mj) if not name.startswith("_")]
    assert {"Buoyancy", "Water", "add_water", "submerge", "Recorder"} <= set(names)
    for name in names:
        assert getattr(buoyancy_mj, name) is getattr(buoyancy_mj, name)


def test_a_name_that_is_not_public_is_refused_as_python_does():
    with pytest.raises(AttributeError, match="module 'buoyancy_mj' has no attribute 'Bouyancy'"):
        buoyancy_mj.Bouyancy  # noqa: B018
