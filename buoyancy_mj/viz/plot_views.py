"""How tabs of plots are laid out, with ranges of their axes on which labels can be read."""

from collections.abc import Iterable, Mapping, Sequence

import rerun.blueprint as rrb

from buoyancy_mj.viz.tabs import Extents, Plot, Tab
from buoyancy_mj.viz.ticks import choose_end, choose_range

SPECTRA = "Spectra"
"""Name of the tab of spectra."""
WIDTH, HEIGHT = 800.0, 806.0
"""Size of a tab in a window of 1600 x 900 [pixels]."""
FRAME_WIDTH, FRAME_HEIGHT = 40.0, 46.0
"""What title and labels take of a view [pixels]."""
ONE_COLUMN = 5
"""Most plots that stand in one column."""
FREE = 0.17
"""Part of the axis of time that stays free for the legend, which would cover lines elsewhere."""

Times = tuple[float, float]
"""First and last time of a run [s]."""


def lay_out_tabs(
    of_vehicles: Mapping[str, Iterable[Tab]],
    of_instruments: Iterable[Tab],
    extents: Extents,
    times: Times | None,
) -> list[rrb.Container]:
    """Lay out all tabs: those of the only vehicle, or one with tabs for each of several.

    Args:
        of_vehicles: tabs of each vehicle, by its name.
        of_instruments: tabs of sensors and controls.
        extents: what the lines reach; empty where that is not known.
        times: what the run spans; None where that is not known.
    """

    def lay_out(tabs: Iterable[Tab]) -> list[rrb.Container]:
        """Lay out some of them."""
        return [_lay_out_tab(tab, extents, times) for tab in tabs]

    instruments = lay_out(of_instruments)
    if len(of_vehicles) > 1:
        vehicles = [rrb.Tabs(*lay_out(tabs), name=name) for name, tabs in of_vehicles.items()]
        return [*vehicles, *instruments]
    (tabs,) = of_vehicles.values()
    first, *others = lay_out(tabs)
    return [first, *instruments, *others]


def _lay_out_tab(tab: Tab, extents: Extents, times: Times | None) -> rrb.Container:
    """Lay out a tab."""
    columns = 1 if len(tab.plots) <= ONE_COLUMN else 2
    rows = -(-len(tab.plots) // columns)
    width, height = WIDTH / columns - FRAME_WIDTH, HEIGHT / rows - FRAME_HEIGHT
    views = [_lay_out_plot(plot, extents, times, width, height) for plot in tab.plots]
    if columns == 1:
        return rrb.Vertical(*views, name=tab.name)
    return rrb.Grid(*views, grid_columns=columns, name=tab.name)


def lay_out_spectra(plots: Mapping[str, Sequence[str]]) -> rrb.Container:
    """Lay out the tab of spectra: the entities of each plot by its title."""
    views = [
        rrb.BarChartView(
            origin="/",
            contents=[f"+ /{entity}" for entity in entities],
            name=title,
            plot_legend=rrb.PlotLegend(corner=rrb.Corner2D.RightTop, visible=len(entities) > 1),
        )
        for title, entities in plots.items()
    ]
    return rrb.Vertical(*views, name=SPECTRA)


def _lay_out_plot(
    plot: Plot, extents: Extents, times: Times | None, width: float, height: float
) -> rrb.TimeSeriesView:
    """Lay out one plot, whose axes have a width and a height [pixels]."""
    known = [extents[entity] for entity in plot.entities if entity in extents]
    axis_x = axis_y = None
    if known:
        low, high = min(low for low, _ in known), max(high for _, high in known)
        axis_y = rrb.ScalarAxis(range=choose_range(low, high, height))
    if times is not None:
        end = choose_end(*times, FREE, width)
        axis_x = rrb.TimeAxis(view_range=_time_range(times[0], end))
    return rrb.TimeSeriesView(
        origin="/",
        contents=[f"+ /{entity}" for entity in plot.entities],
        name=plot.title,
        axis_x=axis_x,
        axis_y=axis_y,
        plot_legend=rrb.PlotLegend(corner=rrb.Corner2D.RightTop, visible=True),
    )


def _time_range(begin: float, end: float) -> rrb.TimeRange:
    """A range of simulated time [s]."""
    return rrb.TimeRange(
        start=rrb.TimeRangeBoundary.absolute(seconds=begin),
        end=rrb.TimeRangeBoundary.absolute(seconds=end),
    )
