"""`Legend`: what the arrows in the picture mean, each in its colour, and how long they are."""

from collections.abc import Iterator

import rerun as rr
import rerun.blueprint as rrb

from buoyancy_mj.scenes.run import Run
from buoyancy_mj.viz import contacts, thrusters
from buoyancy_mj.viz.log import Log
from buoyancy_mj.viz.palette import COLOURS, NEUTRAL, Colour

ENTITY = "legend"
GAP, WIDTH, HEIGHT = 4.0, 124.0, 5.0
"""Space between two names, and width and height of a row, in widths of a letter."""
DROP = 2.0
"""How far a name hangs under its place, likewise."""
PAPER, BACKGROUND = (235, 235, 235), (24, 30, 40)
"""Colours of what is no arrow, and behind the names."""


class Legend:
    """Names under the picture, in one row or in several.

    Args:
        run: the run.
        cell: side of the squares on the sea and on floors [m].
    """

    def __init__(self, run: Run, cell: float) -> None:
        x, row = 0.0, 0
        self._places, self._names, self._colours = [], [], []
        for name, colour in _list_names(run, cell):
            if x + len(name) > WIDTH:
                x, row = 0.0, row + 1
            self._places.append([x + 0.5 * len(name), HEIGHT * (row + 0.5) - DROP])
            self._names.append(name)
            self._colours.append(colour)
            x += len(name) + GAP
        self.rows = row + 1
        """Number of its rows."""

    def draw_static(self, log: Log) -> None:
        """Draw it."""
        names = rr.Points2D(
            self._places,
            labels=self._names,
            colors=self._colours,
            radii=[0.0],
            show_labels=True,
        )
        log.keep(ENTITY, names)

    def view(self) -> rrb.Spatial2DView:
        """The view that shows it."""
        bounds = rrb.VisualBounds2D(x_range=[-GAP, WIDTH + GAP], y_range=[0.0, HEIGHT * self.rows])
        return rrb.Spatial2DView(
            origin=ENTITY,
            name="arrows",
            titlebar=False,
            visual_bounds=bounds,
            background=rrb.Background(color=BACKGROUND),
        )


def _list_names(run: Run, cell: float) -> Iterator[tuple[str, Colour]]:
    """What stands in the legend, with its colour."""
    for cause in ("weight", *run.buoyancy.causes):
        yield cause.replace("_", " "), COLOURS.get(cause, NEUTRAL)
    if len(thrusters.find_thrusters(run.model)):
        yield f"thrust, {thrusters.LONGER:g} x as long", thrusters.COLOUR
    yield "contact", contacts.COLOUR
    vehicles = list(run.vehicles.values())
    if len(vehicles) == 1:
        length, weight = 0.5 * vehicles[0].length, vehicles[0].weight
        yield f"an arrow of {length:.3g} m is {weight:.3g} N", PAPER
    else:
        yield "half as long as a vehicle is its weight", PAPER
    yield f"squares of {cell:g} m", PAPER
