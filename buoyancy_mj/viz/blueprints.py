"""How the Rerun viewer is laid out for a run and for an inspection."""

from collections.abc import Mapping, Sequence

import numpy as np
import rerun.blueprint as rrb
from numpy.typing import NDArray

from buoyancy_mj.viz import motes, sea_surface, sky
from buoyancy_mj.viz.eye import ENTITY, Eye
from buoyancy_mj.viz.log import TIMELINE
from buoyancy_mj.viz.plots import list_plots

BACKGROUND = (24, 30, 40)
"""Colour behind an inspection."""
SURROUNDINGS = (sky.ENTITY, sea_surface.ENTITY, sea_surface.FAR, motes.ENTITY, ENTITY)
"""Entities that a pointer passes over."""
MOTION, INSTRUMENTS = "Motion and forces", "Sensors and controls"
"""Names of the tabs of plots."""
MOST_IN_COLUMN = 6
"""Most plots of instruments that stand in one column."""
MOST_IN_LEGEND = 4
"""Most lines of instruments that a legend names; more would cover the lines."""


def run_blueprint(
    title: str,
    eye: Eye,
    *,
    texts: Sequence[str],
    vehicles: Sequence[str],
    instruments: Mapping[str, Sequence[str]],
) -> rrb.Blueprint:
    """Lay out a run: the world and texts on the left, plots on the right, playing at once.

    Args:
        title: name of the view of the world.
        eye: whence it looks.
        texts: entities of the texts.
        vehicles: names of several vehicles, each of which has a tab of plots; none for one vehicle.
        instruments: entities of each plot of sensors and actuators, by its title; they have a tab
            of their own.
    """
    world = _world_view(title, eye.middle, eye.position, followed=ENTITY)
    below = rrb.Tabs(*(rrb.TextDocumentView(origin=text, name=text) for text in texts))
    tabs = [rrb.Vertical(*_plot_views(name), name=name) for name in vehicles]
    if not tabs:
        tabs = [rrb.Vertical(*_plot_views(), name=MOTION)]
    if instruments:
        views = [_instrument_view(title, paths) for title, paths in instruments.items()]
        columns = 1 if len(views) <= MOST_IN_COLUMN else 2
        tabs.append(rrb.Grid(*views, grid_columns=columns, name=INSTRUMENTS))
    plots = rrb.Tabs(*tabs) if len(tabs) > 1 else tabs[0]
    return rrb.Blueprint(
        rrb.Horizontal(
            rrb.Vertical(world, below, row_shares=[4, 1]),
            plots,
            column_shares=[3, 2],
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


def _plot_views(vehicle: str = "") -> list[rrb.TimeSeriesView]:
    """The plots of a vehicle; '' is the only one."""
    return [_plot_view(title, contents) for title, contents in list_plots(vehicle).items()]


def _plot_view(title: str, contents: Sequence[str]) -> rrb.TimeSeriesView:
    """A plot of the entities in `contents`; a leading '-' leaves an entity out."""
    has_hulls = any(path.endswith("/volume/**") for path in contents)
    return rrb.TimeSeriesView(
        origin="plots",
        contents=[path if path.startswith("-") else f"+ {path}" for path in contents],
        name=title,
        # a legend of all hulls would cover their lines
        plot_legend=_legend(visible=not has_hulls),
    )


def _legend(*, visible: bool) -> rrb.PlotLegend:
    """The legend of a plot, where lines are covered least."""
    return rrb.PlotLegend(corner=rrb.Corner2D.RightTop, visible=visible)


def _instrument_view(title: str, paths: Sequence[str]) -> rrb.TimeSeriesView:
    """A plot of numbers of one kind and unit."""
    return rrb.TimeSeriesView(
        origin="instruments",
        contents=[f"+ {path}" for path in paths],
        name=title,
        plot_legend=_legend(visible=len(paths) <= MOST_IN_LEGEND),
    )


def _side_panels() -> tuple[rrb.BlueprintPanel, rrb.SelectionPanel]:
    """The viewer's own panels, out of the way."""
    return rrb.BlueprintPanel(state="collapsed"), rrb.SelectionPanel(state="collapsed")
