"""Studio's window, opened on a screen that is not there, drawn and closed."""

import os
import shutil
import subprocess
import sys

import pytest

from tests.screen import open_screen

STARTS = 20
START = """
from mujoco.studio import messages

from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.scene import read_scene
from buoyancy_mj.studio import opening


class Leaving(opening.SeaPanel):
    frames = 0

    @messages.handler
    def on_update(self, _: messages.UpdateEvent) -> None:
        self.frames += 1
        if self.frames == 6:
            seen = self.viewer.picture.reshape(-1, 3).astype(float)
            red, _, blue = seen.mean(axis=0)
            print(f"the sea is {'blue' if blue > red + 20.0 else 'not blue'}", flush=True)
            self.viewer.dispatch(messages.ExitEvent())


opening.SeaPanel = Leaving
opening.WIDTH, opening.HEIGHT = 320, 240
opening.open_window(read_scene(catalog.scene_path("auv_waves")))
print("closed", flush=True)
"""


@pytest.mark.long
@pytest.mark.skipif(shutil.which("Xvfb") is None, reason="there is no Xvfb")
def test_a_window_opens_shows_the_sea_and_closes_twenty_times(tmp_path):
    pytest.importorskip("mujoco.studio.window", reason="mujoco-studio is not installed")
    from buoyancy_mj.drawing.filament.graphics import count_devices

    if not count_devices():
        pytest.skip("there is no Vulkan")
    code = "from buoyancy_mj.studio.library import load_studio\nload_studio()\n" + START
    with open_screen(tmp_path) as display:
        for _ in range(STARTS):
            found = subprocess.run(
                [sys.executable, "-c", code],
                capture_output=True, text=True, timeout=300,
                env=os.environ | {"DISPLAY": display, "HOME": str(tmp_path)},
            )  # fmt: skip
            assert found.returncode == 0, found.stderr[-2000:]
            assert "the sea is blue" in found.stdout
            assert found.stdout.rstrip().endswith("closed")
