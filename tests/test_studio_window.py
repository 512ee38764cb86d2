"""MuJoCo's own Studio in a window, with a model that brings its water."""

import contextlib
import os
import shutil
import subprocess
import sys

import pytest

from tests.installed import install

STARTS = 20
SECONDS = 3.0
"""In which a window opens and draws, before its model is read."""
START = """
import collections.abc, runpy, typing_extensions

# Studio 4.0.0 asks Python 3.12 for it
collections.abc.Buffer = typing_extensions.Buffer
runpy.run_module("mujoco.studio.viewer", run_name="__main__", alter_sys=True)
"""
PLUGINS = f"""
import time
from mujoco.studio import messages, plugin

class Late(plugin.SimPlugin):
    @messages.handler(priority=messages.Priority.CRITICAL)
    def on_load(self, _: messages.LoadModelEvent) -> None:
        time.sleep({SECONDS})

class Leave(plugin.ViewerPlugin):
    frames = 0

    @messages.handler()
    def on_update(self, _: messages.UpdateEvent) -> None:
        self.frames += self.viewer.model.nbody > 1
        if self.frames == 5:
            print("drawn", flush=True)
            self.viewer.dispatch(messages.ExitEvent())
"""
BOX = """<mujoco>
  <extension><plugin plugin="buoyancy_mj.water"><instance name="sea"/></plugin></extension>
  <worldbody>
    <body><freejoint/><geom type="box" size="0.5 0.5 0.2" density="600"/></body>
  </worldbody>
</mujoco>"""


@contextlib.contextmanager
def display():
    """The name of an X display without a screen."""
    read, write = os.pipe()
    command = ["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x900x24"]
    with subprocess.Popen(command, pass_fds=[write], stderr=subprocess.DEVNULL) as server:
        os.close(write)
        try:
            with os.fdopen(read) as told:
                yield f":{told.readline().strip()}"
        finally:
            server.terminate()


@pytest.fixture
def start(tmp_path):
    """Shows a model in Studio until five frames are drawn; the process when it has ended."""
    if not shutil.which("Xvfb"):
        pytest.skip("there is no Xvfb for a window to open in")
    environment = install(tmp_path)
    (tmp_path / "plugins.py").write_text(PLUGINS)

    def show(mjcf):
        (tmp_path / "model.xml").write_text(mjcf)
        arguments = ["model.xml", "--plugins=plugins.py", "--gfx=opengl_headless"]
        return subprocess.run(
            [sys.executable, "-c", START, *arguments],
            env=environment | {"DISPLAY": name, "LIBGL_ALWAYS_SOFTWARE": "1"},
            cwd=tmp_path, capture_output=True, text=True, timeout=300,
        )  # fmt: skip

    with display() as name:
        yield show


@pytest.mark.long
def test_a_window_that_has_drawn_before_its_wet_model_is_read_lives_twenty_times(start):
    for _ in range(STARTS):
        done = start(BOX)
        if done.returncode == 1 and "ImportError" in done.stderr:
            pytest.skip(f"Studio does not start here: {done.stderr.splitlines()[-1]}")
        assert done.returncode == 0, done.stderr
        assert "drawn" in done.stdout
