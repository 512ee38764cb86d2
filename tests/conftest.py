"""What several tests share."""

import mujoco
import pytest


@pytest.fixture(autouse=True)
def no_callback_is_left_behind():
    """Callbacks are global to the process: every test ends without one."""
    yield
    left = mujoco.get_mjcb_control()
    mujoco.set_mjcb_control(None)
    assert left is None
