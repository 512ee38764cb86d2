"""A real browser without a window, driven by the DevTools protocol."""

import base64
import contextlib
import io
import itertools
import json
import os
import shutil
import signal
import subprocess
import tempfile
import time
import urllib.request
from pathlib import Path

import numpy as np
from PIL import Image
from websockets.sync.client import connect

NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")
FLAGS = (
    "--headless=new",
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--disable-dev-shm-usage",
    "--remote-debugging-port=0",
    "--remote-allow-origins=*",
    "about:blank",
)


def find_browser():
    """The path of a browser, or None."""
    return next(filter(None, map(shutil.which, NAMES)), None)


class Browser:
    """One page of a browser of its own, for the length of a `with` block.

    Args:
        size: width and height of the page [pixels].
    """

    def __init__(self, size):
        self._size = size
        self._stack = contextlib.ExitStack()
        self._numbers = itertools.count(1)
        self.console = []

    def __enter__(self):
        with self._stack:
            profile = Path(
                self._stack.enter_context(tempfile.TemporaryDirectory(ignore_cleanup_errors=True))
            )
            self._stack.enter_context(_run_browser(profile, self._size))
            port = wait_for(lambda: _read_port(profile / "DevToolsActivePort"), 60.0)
            with urllib.request.urlopen(f"http://127.0.0.1:{port}/json") as answer:
                (page,) = [page for page in json.load(answer) if page["type"] == "page"]
            connection = connect(page["webSocketDebuggerUrl"], max_size=None)
            self._socket = self._stack.enter_context(connection)
            self.call("Page.enable")
            self.call("Runtime.enable")
            width, height = self._size
            self.call(
                "Emulation.setDeviceMetricsOverride",
                width=width, height=height, deviceScaleFactor=1, mobile=False,
            )  # fmt: skip
            self._stack = self._stack.pop_all()
        return self

    def __exit__(self, *_):
        self._stack.close()

    def call(self, method, **params):
        """What a method of the protocol answers."""
        number = next(self._numbers)
        self._socket.send(json.dumps({"id": number, "method": method, "params": params}))
        while True:
            message = json.loads(self._socket.recv(timeout=120))
            if message.get("method") in ("Runtime.consoleAPICalled", "Runtime.exceptionThrown"):
                self.console.append(json.dumps(message["params"])[:400])
            if message.get("id") == number:
                assert "error" not in message, message
                return message["result"]

    def open(self, url):
        self.call("Page.navigate", url=url)

    def evaluate(self, expression):
        """The value of an expression on the page."""
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True)
        return result["result"].get("value")

    def shoot(self):
        """The page as it looks (height, width, 3)."""
        data = self.call("Page.captureScreenshot", format="png")["data"]
        return np.array(Image.open(io.BytesIO(base64.b64decode(data))).convert("RGB"))

    def drag(self, start, end, patience):
        """Drag the mouse from one point to another, each in pixels.

        Args:
            start: where it is pressed.
            end: where it is let go.
            patience: time that the page has for each step [s].
        """
        for kind, (x, y), buttons in (
            ("mouseMoved", start, 0),
            ("mousePressed", start, 1),
            ("mouseMoved", end, 1),
            ("mouseReleased", end, 0),
        ):
            self._mouse(kind, x, y, buttons)
            time.sleep(patience)

    def _mouse(self, kind, x, y, buttons):
        button = "none" if kind == "mouseMoved" and not buttons else "left"
        self.call(
            "Input.dispatchMouseEvent",
            type=kind,
            x=x,
            y=y,
            button=button,
            buttons=buttons,
            clickCount=int(kind != "mouseMoved"),
        )


@contextlib.contextmanager
def _run_browser(profile, size):
    """A browser that keeps its things in a folder; it ends with the block."""
    width, height = size
    process = subprocess.Popen(
        [find_browser(), f"--user-data-dir={profile}", f"--window-size={width},{height}", *FLAGS],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        env=os.environ | {"HOME": str(profile)}, start_new_session=True,
    )  # fmt: skip
    try:
        yield
    finally:
        # with all processes that it started
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait(20)


def wait_for(find, timeout):
    """What a function finds, asked again until it is neither None nor False."""
    end = time.monotonic() + timeout
    while time.monotonic() < end:
        found = find()
        if found is not None and found is not False:
            return found
        time.sleep(0.25)
    return find()


def _read_port(path):
    lines = path.read_text().split() if path.exists() else ()
    return int(lines[0]) if lines else None
