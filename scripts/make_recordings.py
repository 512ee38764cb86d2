"""Make what the site shows live: recordings, and Rerun's web viewer to open them.

    .venv/bin/python scripts/make_recordings.py

scripts/docs calls it before mkdocs, whose hook site_recordings.py takes what lies in build/live.
Each picture of a recording that make_pictures.py makes has its recording here, with 20 frames in
a second. The viewer is that of the Rerun which is installed: its command has it inside, and
serves it. So nothing comes from another server, and nothing of it is kept with the sources.
"""

import shutil
import socket
import subprocess
import sys
import tempfile
import time
import urllib.request
from collections.abc import Callable
from pathlib import Path

from make_pictures import FILES, RECORDINGS, run_in
from page_files import write_page_files

ROOT = Path(__file__).resolve().parent.parent
LIVE = ROOT / "build" / "live"
"""Where it all goes."""
VIEWER = ("re_viewer.js", "re_viewer_bg.wasm")
"""The viewer, as Rerun serves it."""
PAGE = ROOT / "scripts" / "viewer.html"
"""The page that starts it."""
RATE = 20
"""Frames in a second of simulated time, of recordings for the site [Hz]."""
PATIENCE = 30.0
"""Time until Rerun serves [s]."""


def main() -> None:
    """Make all anew."""
    shutil.rmtree(LIVE, ignore_errors=True)
    with tempfile.TemporaryDirectory() as folder:
        write_page_files(FILES, Path(folder))
        for picture, (command, *words) in RECORDINGS.items():
            path = LIVE / Path(picture).with_suffix(".rrd")
            path.parent.mkdir(parents=True, exist_ok=True)
            rate = [f"--set=record_rate={RATE}"] if command == "run" else []
            run_in(Path(folder), command, *words, *rate, f"--record={path}")
            print(f"{path.relative_to(ROOT)}: {path.stat().st_size:,} bytes")
    fetch_viewer(LIVE / "viewer")


def fetch_viewer(folder: Path) -> None:
    """Take the viewer out of Rerun's command."""
    folder.mkdir(parents=True, exist_ok=True)
    ports = [_find_port(), _find_port()]
    command = [str(Path(sys.executable).with_name("rerun")), "--serve-web"]
    command += ["--port", str(ports[0]), "--web-viewer-port", str(ports[1])]
    server = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        for name in VIEWER:
            url = f"http://127.0.0.1:{ports[1]}/{name}"
            (folder / name).write_bytes(_try(lambda url=url: urllib.request.urlopen(url).read()))
    finally:
        server.terminate()
        server.wait(10)
    shutil.copy(PAGE, folder / "index.html")


def _try(get: Callable[[], bytes]) -> bytes:
    """What a server gives, once it serves."""
    end = time.monotonic() + PATIENCE
    while True:
        try:
            return get()
        except OSError:
            if time.monotonic() > end:
                raise
            time.sleep(0.1)


def _find_port() -> int:
    """A port that nobody uses."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


if __name__ == "__main__":
    main()
