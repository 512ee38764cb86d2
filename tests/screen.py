"""A screen that is not there, for windows."""

import contextlib
import os
import subprocess


@contextlib.contextmanager
def open_screen(folder):
    """The name of a display of Xvfb, which ends with the block."""
    read, write = os.pipe()
    with (folder / "screen").open("w") as log:
        process = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", "1400x900x24"],
            pass_fds=[write], stdout=log, stderr=subprocess.STDOUT,
        )  # fmt: skip
    os.close(write)
    try:
        with os.fdopen(read) as answer:
            yield f":{answer.readline().strip()}"
    finally:
        process.terminate()
        process.wait(30)
