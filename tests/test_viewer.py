import os
import subprocess
import sys

import mujoco
import numpy as np
import pytest

from buoyancy_mj.viz.viewer import _find_eye


def test_the_eye_of_a_free_camera_is_where_mujoco_has_it():
    model = mujoco.MjModel.from_xml_string("<mujoco/>")
    scene, camera = mujoco.MjvScene(model, maxgeom=10), mujoco.MjvCamera()
    camera.lookat[:], camera.distance, camera.azimuth, camera.elevation = [1, 2, 3], 5, 140, -20
    option, every = mujoco.MjvOption(), mujoco.mjtCatBit.mjCAT_ALL.value
    mujoco.mjv_updateScene(model, mujoco.MjData(model), option, None, camera, every, scene)
    middle = np.mean([eye.pos for eye in scene.camera], axis=0)
    assert _find_eye(camera) == pytest.approx(middle, abs=1e-5)


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
