"""Studio's page in a real browser."""

import contextlib
import os
import re
import subprocess
import sys

import numpy as np
import pytest

from tests.browser import Browser, find_browser, wait_for

pytestmark = pytest.mark.skipif(find_browser() is None, reason="there is no Chromium")
SIZE = (1000, 640)
SIDES = 215
"""Width of each of Studio's panels [pixels]."""
BRIGHT = 90.0
"""What the sea is brighter than under the horizon, where there is but the dark deep without it."""
NAME = (8, 84, 110, 101)
"""Left, top, right and bottom of the name of the waves, in the tab of the sea [pixels]."""
SLIDER = (50.0, 119.0)
"""Middle of the slider of the waves' height, in the tab of the sea [pixels]."""


@pytest.fixture
def page(tmp_path):
    """A scene on still water, served to a browser that has opened it."""
    pytest.importorskip("mujoco.studio.web_viewer", reason="mujoco-studio is not installed")
    log = tmp_path / "log"
    with contextlib.ExitStack() as stack:
        out = stack.enter_context(log.open("w"))
        server = subprocess.Popen(
            [sys.executable, "-m", "buoyancy_mj", "view", "auv_drop_still", "--web",
             "--set", 'start.at="equilibrium"'],
            stdout=out, stderr=subprocess.STDOUT, env=os.environ | {"HOME": str(tmp_path)},
        )  # fmt: skip
        stack.callback(server.wait, 30)
        stack.callback(server.terminate)
        said = re.compile(r"open (http://127\.0\.0\.1:\d+/)")
        found = wait_for(lambda: said.search(log.read_text()), 120)
        assert found, log.read_text()
        browser = stack.enter_context(Browser(SIZE))
        browser.open(found[1])
        yield browser


def take_sea(browser):
    """The picture between the panels, once the sea mirrors the sky there; None before."""
    picture = browser.shoot()[60:-90, SIDES:-SIDES].astype(float)
    return picture if picture[80:110].mean() > BRIGHT else None


@pytest.mark.long
def test_the_wave_slider_moves_the_sea_that_a_browser_shows(page):
    count = "document.querySelectorAll('canvas').length"
    assert wait_for(lambda: page.evaluate(count) or None, 60) == 1
    calm = wait_for(lambda: take_sea(page), 120)
    assert calm is not None, page.console
    named = take_name(page)
    # where everything is drawn by the processor, a page may be slow to see where the mouse is
    x, y = SLIDER
    for patience in (1.0, 3.0, 6.0, 12.0):
        page.drag((x, y), (x + 25.0, y), patience)
        if differs(take_name(page), named):
            break
    assert differs(take_name(page), named), "the waves are still called still"
    assert wait_for(lambda: differs(take_sea(page), calm), 120)


def take_name(browser):
    """What the panel calls the waves, as a picture."""
    left, top, right, bottom = NAME
    return browser.shoot()[top:bottom, left:right].astype(float)


def differs(picture, other):
    """Whether a picture is there, and differs from another by far."""
    return picture is not None and bool(np.abs(picture - other).mean() > 3.0)
