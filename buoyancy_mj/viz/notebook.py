"""`show_run`: a run inside a notebook, in Rerun's viewer or as charts."""

import contextlib
import importlib
import io
import os
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

from buoyancy_mj.errors import SceneError
from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.scenes.portrait import draw_motions, portray
from buoyancy_mj.scenes.simulation import Simulation
from buoyancy_mj.scenes.summary import Summary
from buoyancy_mj.viz.recording import Recording

WIDTH, HEIGHT = "auto", 640
"""Size of the viewer: as wide as the cell, and so many pixels high."""
HINT = "pip install 'buoyancy_mj[notebook]' shows runs in three dimensions here"
"""What stands under the charts."""
_ASSET = "RERUN_NOTEBOOK_ASSET"
"""Environment variable that says where Rerun's notebook has its viewer from."""


class Motions(NamedTuple):
    """What charts show of a run, frame by frame."""

    times: list[float]
    """Times [s]."""
    heights: dict[str, list[float]]
    """Heights [m], by their names."""
    angles: dict[str, list[float]]
    """Angles [rad], by their names."""


class RunCharts:
    """A run that is over, as a notebook shows it without a viewer: its summary and charts.

    Args:
        summary: the run in a few numbers.
        motions: how its vehicles moved.
    """

    def __init__(self, summary: Summary, motions: Motions) -> None:
        self.summary = summary
        """The run in a few numbers."""
        self.motions = motions
        """How its vehicles moved."""

    def __repr__(self) -> str:
        lines = [": ".join(filter(None, row)) for row in self.summary.rows()]
        return "\n".join([self.summary.scene, *lines])

    def _repr_html_(self) -> str:
        """How a notebook shows it."""
        return portray(self.summary, f"{draw_motions(*self.motions)}<div><code>{HINT}</code></div>")


def show_run(simulation: Simulation) -> Any:
    """Run a scene to its end, and make what a notebook shows of it.

    Args:
        simulation: the scene, which has not run yet.

    Returns:
        Rerun's viewer with the recording, if the extra `notebook` is installed; `RunCharts`
        otherwise. Neither needs a network.

    Raises:
        SceneError: the scene has run already.
    """
    if simulation.data.time > 0.0:
        raise SceneError(
            f"the scene has run to {simulation.data.time:.4g} s; to show it, make another "
            "Simulation, whose show() runs it"
        )
    viewer = _make_viewer()
    if viewer is None:
        motions = _collect_motions(simulation.frames())
        return RunCharts(simulation.summary(with_periods=True), motions)
    with tempfile.TemporaryDirectory(prefix="buoyancy_mj-") as folder:
        recording = Recording(simulation, Path(folder, "run.rrd"))
        for frame in simulation.frames():
            recording.add(frame)
        path = recording.close(simulation.summary(with_periods=True))
        assert path is not None
        # it waits there until the viewer has started
        viewer.send_rrd(path.read_bytes())
    return viewer


def _make_viewer() -> Any:
    """Rerun's viewer for notebooks; None if it is not installed."""
    # the viewer that is installed, and not one from a server
    os.environ.setdefault(_ASSET, "inline")
    try:
        # it says so
        with contextlib.redirect_stdout(io.StringIO()):
            widgets = importlib.import_module("rerun_notebook")
    except ImportError:
        return None
    return widgets.Viewer(width=WIDTH, height=HEIGHT)


def _collect_motions(frames: Iterable[Frame]) -> Motions:
    """Height, roll and pitch of each vehicle over time, and the surface over the only one."""
    motions = Motions([], {}, {})
    for frame in frames:
        motions.times.append(frame.time)
        several = len(frame.vehicles) > 1
        for name, one in frame.vehicles.items():
            of = f" {name}" if several else ""
            height = name if several else "centre of gravity"
            motions.heights.setdefault(height, []).append(float(one.centre_of_mass[2]))
            for angle, value in zip(("roll", "pitch"), one.attitude.tolist(), strict=False):
                motions.angles.setdefault(f"{angle}{of}", []).append(value)
            if not several:
                motions.heights.setdefault("surface", []).append(one.elevation)
    return motions
