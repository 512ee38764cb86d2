import os
import subprocess
import sys

import mujoco
import numpy as np
import pytest

from buoyancy_mj import RegularWave, Water
from buoyancy_mj.viz.viewer import draw_surface

MODEL = mujoco.MjModel.from_xml_string("<mujoco/>")
CENTRE = np.array([3.0, -2.0, 0.5])


def tiles(water, maxgeom=1000, time=0.3):
    scene = mujoco.MjvScene(MODEL, maxgeom=maxgeom)
    draw_surface(scene, water, CENTRE, 4.0, time)
    return scene


def test_still_water_is_one_tile_with_its_top_at_the_level():
    scene = tiles(Water(level=0.2))
    assert scene.ngeom == 1
    tile = scene.geoms[0]
    assert tile.pos[2] + tile.size[2] == pytest.approx(0.2, abs=1e-6)
    assert tile.size[:2] == pytest.approx([2.0, 2.0])


def test_waves_are_tiles_that_lie_on_the_surface():
    water = Water(waves=RegularWave(0.2, period=2.0, direction=0.7))
    scene = tiles(water)
    assert scene.ngeom == 24 * 24
    for tile in scene.geoms[: scene.ngeom : 37]:
        normal = tile.mat[:, 2]
        top = tile.pos + normal * tile.size[2]
        assert float(water.elevation(top[0], top[1], 0.3)) == pytest.approx(top[2], abs=5e-3)
        h = 1e-4
        slope = [
            (
                water.elevation(top[0] + h * a, top[1] + h * b, 0.3)
                - water.elevation(top[0], top[1], 0.3)
            )
            / h
            for a, b in ((1, 0), (0, 1))
        ]
        assert -normal[:2] / normal[2] == pytest.approx(np.array(slope, float), abs=0.02)


def test_the_tiles_fit_the_scene_and_follow_the_vehicle():
    scene = tiles(Water(waves=RegularWave(0.2, period=2.0)), maxgeom=100)
    assert scene.ngeom == 100
    middles = np.array([tile.pos for tile in scene.geoms])
    assert middles[:, :2].mean(axis=0) == pytest.approx(CENTRE[:2], abs=0.4)


def test_drawing_again_replaces_what_was_drawn():
    scene = tiles(Water(waves=RegularWave(0.2, period=2.0)))
    draw_surface(scene, Water(), CENTRE, 4.0, 0.0)
    assert scene.ngeom == 1


def test_without_a_display_the_viewer_says_so():
    environment = {
        key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY")
    }
    done = subprocess.run(
        [sys.executable, "-m", "buoyancy_mj", "view", "hourglass_drop_still"],
        env=environment, capture_output=True, text=True, check=False, timeout=600,
    )  # fmt: skip
    assert done.returncode == 1
    assert done.stderr == (
        "error: MuJoCo's viewer needs a display, and there is none here; "
        "use 'run', which needs none\n"
    )
