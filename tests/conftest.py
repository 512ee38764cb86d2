"""What several tests share."""

import atexit
import os
import shutil
import signal
import tempfile

import mujoco
import pytest
from hypothesis import HealthCheck, settings

# no test depends on how fast the machine is, nor on whether its kernels are compiled already
settings.register_profile(
    "any machine", deadline=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("any machine")

# what runs in the background, or under nohup, ignores signals, and so would all that it starts
for number, default in (
    (signal.SIGINT, signal.default_int_handler),
    (signal.SIGTERM, signal.SIG_DFL),
):
    if signal.getsignal(number) is signal.SIG_IGN:
        signal.signal(number, default)

# what is computed once for each shape is kept as long as the tests run, for all their processes
if "BUOYANCY_MJ_CACHE" not in os.environ:
    os.environ["BUOYANCY_MJ_CACHE"] = tempfile.mkdtemp(prefix="buoyancy_mj-tests-")
    atexit.register(shutil.rmtree, os.environ["BUOYANCY_MJ_CACHE"], ignore_errors=True)

CALLBACKS = {
    "mjcb_control": (mujoco.get_mjcb_control, mujoco.set_mjcb_control),
    "mjcb_passive": (mujoco.get_mjcb_passive, mujoco.set_mjcb_passive),
}


@pytest.fixture(autouse=True)
def no_callback_is_left_behind():
    """Callbacks are global to the process: every test ends without one."""
    yield
    left = [name for name, (get, _) in CALLBACKS.items() if get() is not None]
    for _, put in CALLBACKS.values():
        put(None)
    assert not left


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """What takes long is slow too."""
    for item in items:
        if item.get_closest_marker("long"):
            item.add_marker("slow")
