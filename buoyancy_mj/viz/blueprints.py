"""How the Rerun viewer is laid out for a run and for an inspection."""

from collections.abc import Sequence

import numpy as np
import rerun.blueprint as rrb
from numpy.typing import NDArray

from buoyancy_mj.viz.eye import ENTITY
from buoyancy_mj.viz.legend import Legend
from buoyancy_mj.viz.log import TIMELINE
from buoyancy_mj.viz.righting_chart import RightingChart
from buoyancy_mj.viz.surroundings import Surroundings

BACKGROUND = (24, 30, 40)
"""Colour behind an inspection."""
ROW, HEADER = 23.0, 84.0
"""Height of a row of a text's table, and of what stands above it [pixels]."""
AWAY, RIGHT = np.array([-0.6, -1.3, 0.5]), np.array([1.3, -0.6, 0.0]) / np.hypot(1.3, 0.6)
"""Where the eye of an inspection is over the length of the vessel, and what it has on its right."""
LEGEND_ROW = 30.0
"""Height of a row of the legend [pixels]."""
WINDOW = 806.0
"""Height of what a window of 1600 x 900 shows of the layout [pixels]."""
MOST_TEXT = 0.4
"""Greatest part of it that texts take."""


def run_blueprint(
    title: str,
    surroundings: Surroundings,
    legend: Legend,
    *,
    texts: Sequence[str],
    rows: int,
    tabs: Sequence[rrb.Container | rrb.View],
) -> rrb.Blueprint:
    """Lay out a run: the world and texts on the left, plots on the right, playing at once.

    Args:
        title: name of the view of the world.
        surroundings: what is seen around the vehicles, and whence.
        legend: what arrows mean.
        texts: entities of the texts.
        rows: number of rows of the longest table in a text, all of which are to be seen.
        tabs: the plots.
    """
    eye, passive = surroundings.eye, surroundings.passive
    world = _world_view(title, eye.middle, eye.position, followed=ENTITY, passive=passive)
    below = rrb.Tabs(*(rrb.TextDocumentView(origin=text, name=text) for text in texts))
    text = min((ROW * rows + HEADER) / WINDOW, MOST_TEXT)
    names = LEGEND_ROW * legend.rows / WINDOW
    return rrb.Blueprint(
        rrb.Horizontal(
            rrb.Vertical(world, legend.view(), below, row_shares=[1.0 - text - names, names, text]),
            rrb.Tabs(*tabs),
            column_shares=[1, 1],
        ),
        rrb.TimePanel(timeline=TIMELINE, play_state="playing", state="collapsed"),
        *_side_panels(),
    )


def inspection_blueprint(
    title: str, look_at: NDArray[np.float64], size: float, chart: RightingChart | None
) -> rrb.Blueprint:
    """Lay out an inspection: the vessel on the left, its report and righting arms on the right.

    Args:
        title: name of the view of the vessel.
        look_at: point at which it looks (3,) [m].
        size: length of the vessel [m].
        chart: the righting arms; None without.
    """
    world = _world_view(title, look_at, look_at + size * AWAY)
    report = rrb.TextDocumentView(origin="report", name="report")
    shown = [report] if chart is None else [report, chart.view()]
    beside = rrb.Vertical(*shown, row_shares=[3, 2][: len(shown)])
    return rrb.Blueprint(
        rrb.Horizontal(world, beside, column_shares=[3, 2]),
        rrb.TimePanel(state="hidden"),
        *_side_panels(),
    )


def _world_view(
    title: str,
    look_at: NDArray[np.float64],
    eye: NDArray[np.float64],
    *,
    followed: str | None = None,
    passive: Sequence[str] = (),
) -> rrb.Spatial3DView:
    """A view in 3D from `eye` towards `look_at`, (3,) [m].

    Args:
        title: its name.
        look_at: a point in the middle of it.
        eye: where it is seen from.
        followed: the entity that it follows.
        passive: entities that a pointer passes over.
    """
    return rrb.Spatial3DView(
        origin="world",
        name=title,
        background=rrb.Background(color=BACKGROUND),
        line_grid=rrb.LineGrid3D(visible=False),
        eye_controls=rrb.EyeControls3D(
            position=eye, look_target=look_at, eye_up=[0, 0, 1], tracking_entity=followed
        ),
        overrides={entity: rrb.EntityBehavior(interactive=False) for entity in passive},
    )


def _side_panels() -> tuple[rrb.BlueprintPanel, rrb.SelectionPanel]:
    """The viewer's own panels, out of the way."""
    return rrb.BlueprintPanel(state="collapsed"), rrb.SelectionPanel(state="collapsed")
