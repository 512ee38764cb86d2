"""How the Rerun viewer is laid out for a run and for an inspection."""

from collections.abc import Sequence

import numpy as np
import rerun.blueprint as rrb
from numpy.typing import NDArray

from buoyancy_mj.viz import motes, sea_surface, sky
from buoyancy_mj.viz.eye import ENTITY, Eye
from buoyancy_mj.viz.log import TIMELINE

BACKGROUND = (24, 30, 40)
"""Colour behind an inspection."""
SURROUNDINGS = (sky.ENTITY, sea_surface.ENTITY, sea_surface.FAR, motes.ENTITY, ENTITY)
"""Entities that a pointer passes over."""
ROW, HEADER = 23.0, 84.0
"""Height of a row of a text's table, and of what stands above it [pixels]."""
WINDOW = 806.0
"""Height of what a window of 1600 x 900 shows of the layout [pixels]."""
MOST_TEXT = 0.5
"""Greatest part of it that texts take."""


def run_blueprint(
    title: str,
    eye: Eye,
    *,
    texts: Sequence[str],
    rows: int,
    tabs: Sequence[rrb.Container],
) -> rrb.Blueprint:
    """Lay out a run: the world and texts on the left, plots on the right, playing at once.

    Args:
        title: name of the view of the world.
        eye: whence it looks.
        texts: entities of the texts.
        rows: number of rows of the longest table in a text, all of which are to be seen.
        tabs: the plots.
    """
    world = _world_view(title, eye.middle, eye.position, followed=ENTITY)
    below = rrb.Tabs(*(rrb.TextDocumentView(origin=text, name=text) for text in texts))
    text = min((ROW * rows + HEADER) / WINDOW, MOST_TEXT)
    return rrb.Blueprint(
        rrb.Horizontal(
            rrb.Vertical(world, below, row_shares=[1.0 - text, text]),
            rrb.Tabs(*tabs),
            column_shares=[1, 1],
        ),
        rrb.TimePanel(timeline=TIMELINE, play_state="playing", state="collapsed"),
        *_side_panels(),
    )


def inspection_blueprint(
    title: str, look_at: NDArray[np.float64], size: float, *, righting: bool
) -> rrb.Blueprint:
    """Lay out an inspection: the vessel on the left, its report and righting arms on the right.

    Args:
        title: name of the view of the vessel.
        look_at: point at which it looks (3,) [m].
        size: length of the vessel [m].
        righting: whether there are righting arms.
    """
    world = _world_view(title, look_at, look_at + size * np.array([-0.6, -1.3, 0.5]))
    report = rrb.TextDocumentView(origin="report", name="report")
    arms = rrb.TimeSeriesView(origin="righting", name="GZ [m] over heel [degrees]")
    beside = rrb.Vertical(report, arms, row_shares=[3, 2]) if righting else rrb.Vertical(report)
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
) -> rrb.Spatial3DView:
    """A view in 3D from `eye` towards `look_at`, (3,) [m], which follows an entity."""
    return rrb.Spatial3DView(
        origin="world",
        name=title,
        background=rrb.Background(color=BACKGROUND),
        line_grid=rrb.LineGrid3D(visible=False),
        eye_controls=rrb.EyeControls3D(
            position=eye, look_target=look_at, eye_up=[0, 0, 1], tracking_entity=followed
        ),
        # what is everywhere is not to be pointed at
        overrides={entity: rrb.EntityBehavior(interactive=False) for entity in SURROUNDINGS},
    )


def _side_panels() -> tuple[rrb.BlueprintPanel, rrb.SelectionPanel]:
    """The viewer's own panels, out of the way."""
    return rrb.BlueprintPanel(state="collapsed"), rrb.SelectionPanel(state="collapsed")
