"""Where a run is watched in Rerun: a viewer here, one elsewhere, and a page for a browser."""

import re
import shlex
import signal
import socket
import subprocess
import sys
import time
import urllib.request

import mujoco
import pytest

from buoyancy_mj import Recorder, RecordingError, Water, add_water
from buoyancy_mj.viz import viewer_process, viewers
from buoyancy_mj.viz.viewer_process import ViewerProcess, listens
from buoyancy_mj.viz.viewers import Viewers, read_address


def make():
    """A box in water, and its data."""
    spec = mujoco.MjSpec.from_string(
        """<mujoco><worldbody><body name="box"><freejoint/>
        <geom type="box" size=".2 .2 .2" density="500"/></body></worldbody></mujoco>"""
    )
    add_water(spec, Water())
    model = spec.compile()
    return model, mujoco.MjData(model)


def find_ports():
    """The first of two ports beside each other that are free."""
    while True:
        with socket.socket() as one, socket.socket() as other:
            one.bind(("127.0.0.1", 0))
            port = one.getsockname()[1]
            try:
                other.bind(("127.0.0.1", port + 1))
            except OSError:
                continue
            return port


def ends(port):
    """Whether what listens on a port ends before long."""
    end = time.monotonic() + 10.0
    while listens(port) and time.monotonic() < end:
        time.sleep(0.05)
    return not listens(port)


@pytest.mark.parametrize(
    ("text", "url"),
    [
        ("lab.local", "rerun+http://lab.local:9876/proxy"),
        ("localhost:1234", "rerun+http://localhost:1234/proxy"),
        ("rerun+http://10.0.0.7:9876/proxy", "rerun+http://10.0.0.7:9876/proxy"),
        ("rerun+https://host", "rerun+https://host:9876/proxy"),
        ("[::1]:99", "rerun+http://[::1]:99/proxy"),
    ],
)
def test_the_address_of_a_viewer_is_a_host_and_a_port_or_a_url(text, url):
    assert read_address(text).url == url


@pytest.mark.parametrize("text", ["", "a b", "host:port", "http://host:9876", "host/elsewhere"])
def test_what_is_no_address_is_refused_with_one_that_is(text):
    with pytest.raises(RecordingError, match=r"it must be HOST:PORT, as localhost:9876, or a URL"):
        Viewers(connect=text)


@pytest.mark.parametrize("port", [0, -1, 65535, 70000])
def test_a_port_that_cannot_be_is_refused(port):
    with pytest.raises(RecordingError, match="a whole number from 1 to 65534"):
        Viewers(serve=port)


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="displays are X11's")
@pytest.mark.parametrize("display", ["", ":7777", "unix:7777.0", "nonsense", "127.0.0.1:7777"])
def test_without_a_display_a_run_ends_before_it_is_made(display, monkeypatch):
    for name in ("WAYLAND_DISPLAY", "WAYLAND_SOCKET"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("DISPLAY", display)
    monkeypatch.setattr(viewers, "PORT", find_ports())
    with pytest.raises(RecordingError, match=r"there is no display; serve a page .*\(--serve\)"):
        Viewers(live=True).check()


def test_a_viewer_that_does_not_listen_is_told_at_once():
    port = find_ports()
    with pytest.raises(RecordingError, match=rf"no Rerun viewer listens at localhost:{port}; sta"):
        Viewers(connect=f"localhost:{port}").check()


def test_a_program_that_does_not_start_says_why():
    port = find_ports()
    with pytest.raises(RecordingError, match=r"could be started: unexpected argument '--no-such'"):
        ViewerProcess(["--no-such", "--port", str(port)], [port], "do something else")


def test_a_run_is_served_as_a_page_and_another_one_joins_it(tmp_path):
    port = find_ports()
    model, data = make()
    with Recorder(model, data, tmp_path / "run.rrd", serve=port) as recorder:
        recorder.record()
    with urllib.request.urlopen(f"http://localhost:{port}/") as page:
        assert b"Rerun" in page.read()
    assert recorder.page == (
        f"http://localhost:{port}/?url=rerun%2Bhttp://localhost:{port + 1}/proxy"
    )
    assert (tmp_path / "run.rrd").stat().st_size > 10_000

    # one more on the same page, and one from elsewhere
    for place in ({"serve": port}, {"connect": f"localhost:{port + 1}"}):
        with Recorder(model, data, **place) as other:
            other.record()
    with pytest.raises(RecordingError, match=f"port {port + 1} of this machine is taken already"):
        Recorder(model, data, serve=port + 1)


@pytest.mark.long
def test_a_served_run_goes_on_serving_until_ctrl_c_and_leaves_nothing_behind(tmp_path):
    port = find_ports()
    words = f"run hourglass_drop_still --duration 0.2 --no-record --serve --serve-port {port}"
    with subprocess.Popen(
        [sys.executable, "-m", "buoyancy_mj", *shlex.split(words)],
        cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    ) as process:  # fmt: skip
        said = ""
        while "until Ctrl-C" not in said:
            said = process.stderr.readline()
            assert said, process.stdout.read()
        assert listens(port)
        assert listens(port + 1)
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=60) == 0
        assert re.search("net weight", process.stdout.read())
    assert ends(port)
    assert ends(port + 1)


def test_patience_is_longer_than_a_viewer_needs_and_is_not_waited_for(monkeypatch):
    monkeypatch.setattr(viewer_process, "PATIENCE", 0.2)
    port = find_ports()
    with pytest.raises(RecordingError, match="it did not answer in time"):
        ViewerProcess(["--serve-grpc", "--port", str(port)], [1], "do something else")
    assert ends(port)
