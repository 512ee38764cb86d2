"""Recordings that the site shows live: the viewer, its page, and the button on a picture."""

import contextlib
import functools
import re
import threading
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from types import SimpleNamespace

import numpy as np
import pytest

from buoyancy_mj import Recorder, Simulation, read_scene
from buoyancy_mj.scenes import catalog
from tests.scripts import ROOT, script

VIEWER = (ROOT / "scripts" / "viewer.html").read_text()


@pytest.fixture
def hook(tmp_path, monkeypatch):
    """The hook of the site, where the recording of guide/swim.png has been made."""
    pytest.importorskip("mkdocs", reason="the extra 'docs' is not installed")
    module = script("site_recordings")
    monkeypatch.setattr(module, "LIVE", tmp_path / "live")
    for name in ("guide/swim.rrd", "viewer/index.html"):
        path = tmp_path / "live" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    return module


def give(hook, content, page="guide/deep/page.html"):
    return hook.on_page_content(content, SimpleNamespace(file=SimpleNamespace(dest_uri=page)))


def test_a_picture_of_a_recording_gets_a_button_that_opens_it_in_the_viewer(hook):
    shown = give(hook, '<p><img alt="it swims" src="../swim.png" /></p>')
    assert '<img alt="it swims" src="../swim.png" />' in shown
    assert 'data-viewer="../../live/viewer/index.html?url=../guide/swim.rrd" hidden' in shown


def test_other_pictures_stay_as_they_are(hook):
    for content in ('<img src="../other.png">', '<img src="https://a.b/swim.png">', "<p>swim</p>"):
        assert give(hook, content) == content


def test_the_site_has_the_recordings_and_the_viewer(hook, tmp_path):
    files = hook.on_files([], SimpleNamespace(site_dir=str(tmp_path / "site")))
    assert [file.src_uri for file in files] == ["live/guide/swim.rrd", "live/viewer/index.html"]


def test_the_viewers_page_lets_it_ask_nothing_of_other_servers():
    (policy,) = re.findall(r'Content-Security-Policy" content="([^"]*)"', VIEWER)
    assert policy.startswith("default-src 'self'")
    assert "http" not in policy
    assert "*" not in policy
    assert "http" not in VIEWER.replace("http-equiv", "")


def test_rerun_has_the_viewer_inside_that_the_page_starts(tmp_path):
    script("make_recordings").fetch_viewer(tmp_path)
    code = (tmp_path / "re_viewer.js").read_text()
    assert (tmp_path / "re_viewer_bg.wasm").read_bytes()[:4] == b"\0asm"
    assert (tmp_path / "index.html").read_text() == VIEWER
    assert "class WebHandle" in code
    for name in re.findall(r"viewer\.(\w+)\(", VIEWER):
        assert re.search(rf"^\s+{name}\(", code, re.MULTILINE), name


@pytest.mark.long
def test_a_browser_shows_the_recording_and_asks_no_other_server(tmp_path):
    pytest.importorskip("websockets", reason="the extra 'test' is not installed")
    from tests import browser

    if browser.find_browser() is None:
        pytest.skip("there is no Chromium")
    script("make_recordings").fetch_viewer(tmp_path / "viewer")
    simulation = Simulation(read_scene(catalog.scenes()["hourglass_drop_still"], ["duration=0.5"]))
    with Recorder(simulation.model, simulation.data, tmp_path / "run.rrd") as recorder:
        for _ in range(10):
            simulation.advance(5)
            recorder.record()
    with serve(tmp_path) as address, browser.Browser((1200, 800)) as page:
        page.open(f"{address}/viewer/index.html?url=../run.rrd")
        gone = "document.getElementById('said') === null"
        assert browser.wait_for(lambda: page.evaluate(gone), 60.0)
        colours = browser.wait_for(lambda: count_colours(page.shoot()), 60.0)
        assert colours
        names = "performance.getEntriesByType('resource').map(each => each.name).join(' ')"
        asked = page.evaluate(names).split()
        assert f"{address}/run.rrd" in asked
        assert all(name.startswith(address) for name in asked)


def count_colours(picture):
    """How many colours a picture has, or None for so few that nothing is shown yet."""
    colours = len(np.unique(picture.reshape(-1, 3), axis=0))
    return colours if colours > 500 else None


@contextlib.contextmanager
def serve(folder):
    """The address of a server that gives the files of a folder."""
    handler = functools.partial(SimpleHTTPRequestHandler, directory=str(folder))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}"
        server.shutdown()
