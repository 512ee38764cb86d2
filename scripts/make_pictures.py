"""Make the pictures of README.md and docs, and the film that opens README.md.

    .venv/bin/python scripts/make_pictures.py [NAME ...]

Films and stills are drawn by `buoyancy-mj run`, see docs/guide/film.md. Pictures of recordings are
those that the Rerun viewer takes of itself, and one is of Studio's window; both are opened on a
screen that is not there, by Xvfb. Charts come from `buoyancy-mj respond` and `decay`, and others
from the scripts that measure what they show: bench.py, draw_house.py, reproduce_paper, and
`buoyancy-mj validate`.
"""

import argparse
import contextlib
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from page_files import write_page_files

ROOT = Path(__file__).resolve().parent.parent
MOST_BYTES = 4_000_000
"""Size of the largest of them."""
_ONLY = ("--no-record",)

FILMS: Mapping[str, Sequence[str]] = {
    "hero.webp": (
        "auv_sea_state_2", "--duration=6", "--fps=20", "--size=960x540", "--no-hud", *_ONLY,
    ),
}  # fmt: skip
"""Scenes and flags of `buoyancy-mj run` by the names of films in docs."""
STILLS: Mapping[str, Sequence[str]] = {
    "sauvc.png": ("sauvc_course", "--at=21.4", "--size=1280x720", *_ONLY),
    "fleet_at_sea.png": ("fleet", "--at=6", "--size=1280x720", *_ONLY),
    "under.png": ("bluerov2_heavy_station", "--at=4", "--camera=under", "--size=1280x720", *_ONLY),
    "first_hour/waves.webp": (
        "auv_waves", "--vehicle=minnow.xml", "--set=water.waves.0.amplitude=0.1", "--at=4",
        "--duration=5", "--size=1280x720", *_ONLY,
    ),
}  # fmt: skip
"""The same of stills."""
RECORDINGS: Mapping[str, Sequence[str]] = {
    "auv_waves.png": ("run", "auv_waves"),
    "fleet.png": ("run", "fleet"),
    "inspect.png": ("inspect", "sauvc_auv"),
    "first_hour/rest.webp": ("inspect", "minnow.xml", "--water", "density=1025"),
    "first_hour/dives.webp": ("run", "minnow.toml"),
}
"""Commands whose recordings are shown, by the names of the pictures in docs."""
FILES = ROOT / "docs" / "first_hour.md"
"""The page that has the files which commands name."""
CHARTS: Mapping[str, Sequence[str]] = {
    "responses.png": ("respond", "catamaran", "--periods=0.6:4:18", "--heading=0:180:5"),
    "decay.png": ("decay", "catamaran", "--motion=roll", "--from=10"),
}
"""Commands that plot, by the names of the pictures in docs."""
WINDOWS: Mapping[str, str] = {"studio.png": "auv_sea_state_2"}
"""Scenes that `buoyancy-mj view` shows, by the names of the pictures in docs."""
PATIENCE = 60.0
"""Time until a window is looked at [s]."""


def main() -> None:
    """Make the pictures that are asked for, or all."""
    every = [*FILMS, *STILLS, *RECORDINGS, *CHARTS, *WINDOWS]
    parser = argparse.ArgumentParser(description="Make the pictures of README.md and docs.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(every)}")
    asked = parser.parse_args().names or every
    if strange := [name for name in asked if name not in every]:
        parser.error(f"there is no picture '{strange[0]}'; there are {', '.join(every)}")
    for name in asked:
        path = ROOT / "docs" / name
        with tempfile.TemporaryDirectory() as folder:
            write_page_files(FILES, Path(folder))
            made = Path(folder) / Path(name).name
            _make(name, made)
            if made.stat().st_size > MOST_BYTES:
                sys.exit(f"{name} has {made.stat().st_size:,} bytes, and may have {MOST_BYTES:,}")
            shutil.copyfile(made, path)
        print(f"{path.relative_to(ROOT)}: {path.stat().st_size:,} bytes")


def _make(name: str, path: Path) -> None:
    """Make one picture, in a folder that has the files which commands name."""
    picture = path if name in FILMS else path.with_suffix(".png")
    if name in RECORDINGS:
        recording = path.with_suffix(".rrd")
        run_in(path.parent, *RECORDINGS[name], f"--record={recording}")
        viewer = Path(sys.executable).with_name("rerun")
        flags = ["--screenshot-to", str(picture), "--window-size", "1600x900", "--port", "auto"]
        # the pointer stands in the middle of the screen, and so outside of the window
        with _open_screen("6600x3800") as environment:
            command = [str(viewer), str(recording), *flags]
            # its notices are its log, and would cover plots
            environment["RUST_LOG"] = "off"
            subprocess.run(command, check=True, timeout=180, env=environment)
        _shrink(picture)
    elif name in CHARTS:
        run_in(path.parent, *CHARTS[name], f"--plot={path}")
    elif name in WINDOWS:
        _photograph_window(WINDOWS[name], path)
    elif name in FILMS:
        run_in(path.parent, "run", *FILMS[name], f"--video={path}")
    else:
        run_in(path.parent, "run", *STILLS[name], f"--screenshot={picture}")
    if picture != path:
        _shrink(picture, path)


def _shrink(picture: Path, path: Path | None = None) -> None:
    """Make a picture no larger than 1600 x 900, in its place or at another path."""
    from PIL import Image

    with Image.open(picture) as image:
        image.thumbnail((1600, 900))
        image.save(path or picture, quality=80, method=6)


def run_in(folder: Path, *arguments: str) -> None:
    """Run a command of buoyancy-mj in a folder."""
    command = [sys.executable, "-m", "buoyancy_mj", *arguments]
    subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)


def _photograph_window(scene: str, path: Path) -> None:
    """Take a picture of Studio's window with a scene in it."""
    from PIL import ImageGrab

    command = [sys.executable, "-m", "buoyancy_mj", "view", scene]
    with _open_screen("1280x800") as environment:
        # where Studio remembers what its window looked like
        environment["HOME"] = str(path.parent)
        process = subprocess.Popen(command, cwd=ROOT, env=environment)
        try:
            time.sleep(PATIENCE)
            ImageGrab.grab(xdisplay=environment["DISPLAY"]).save(path)
        finally:
            process.terminate()
            process.wait(30)


@contextlib.contextmanager
def _open_screen(size: str) -> Iterator[dict[str, str]]:
    """The environment of a process that has a screen of a size, which nobody sees."""
    if not shutil.which("Xvfb"):
        sys.exit("pictures of windows need a screen that is not there: apt install xvfb")
    read, write = os.pipe()
    command = ["Xvfb", "-displayfd", str(write), "-screen", "0", f"{size}x24"]
    with subprocess.Popen(command, pass_fds=[write], stderr=subprocess.DEVNULL) as server:
        os.close(write)
        try:
            with os.fdopen(read) as told:
                yield os.environ | {"DISPLAY": f":{told.readline().strip()}"}
        finally:
            server.terminate()


if __name__ == "__main__":
    main()
