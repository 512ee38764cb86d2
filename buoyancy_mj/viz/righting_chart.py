"""`RightingChart`: righting arms over heel in a recording, with their angles of vanishing."""

import math
from collections.abc import Mapping, Sequence

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from buoyancy_mj.statics.righting import RightingArm
from buoyancy_mj.viz.palette import Colour, hue

ENTITY = "righting"
TITLE = "righting arm GZ [m] over heel [degrees]"
WIDTH, HEIGHT, MARGIN = 1.9, 1.0, 0.17
"""Size of the chart, and of the space around it, in units of the view."""
DROP = 0.035
"""How far a name hangs under its place, likewise."""
ROW, ASIDE = 0.1, 0.35
"""Height of a row of names over the chart, and least space from one's middle to the edge."""
INK, GRID, BACKGROUND = (215, 215, 215), (70, 78, 90), (24, 30, 40)
"""Colours of axes, of the lines behind curves and of the paper."""
HEELS = 30.0
"""Distance of ticks [degrees]."""
MOST = 6
"""Most steps between ticks of the arms."""


class RightingChart:
    """The righting arms of vessels.

    Args:
        arms: each by the name of its vessel.
    """

    def __init__(self, arms: Mapping[str, RightingArm]) -> None:
        self._arms = arms
        low = min(float(arm.gz.min()) for arm in arms.values())
        high = max(float(arm.gz.max()) for arm in arms.values())
        self._step = _choose_step(max(high, 0.0) - min(low, 0.0))
        self._low = math.floor(min(low, 0.0) / self._step + 1e-9) * self._step
        self._high = math.ceil(max(high, self._step) / self._step - 1e-9) * self._step
        heels = np.degrees(np.concatenate([arm.heel for arm in arms.values()]))
        self._first = HEELS * math.floor(heels.min() / HEELS + 1e-9)
        self._last = HEELS * math.ceil(heels.max() / HEELS - 1e-9)

    def draw(self, stream: rr.RecordingStream) -> None:
        """Draw axes, curves, and what is to be read off them."""
        self._draw_axes(stream)
        for number, (name, arm) in enumerate(self._arms.items()):
            entity = f"{ENTITY}/{rr.escape_entity_path_part(name)}"
            colour = hue(number)
            points = zip(np.degrees(arm.heel), arm.gz, strict=True)
            curve = [self._place(*point) for point in points]
            strip = rr.LineStrips2D([curve], colors=[colour], radii=rr.Radius.ui_points(1.5))
            stream.log(entity, strip, static=True)
            self._draw_marks(stream, f"{entity}/marks", colour, self._list_marks(name, arm), number)

    def view(self) -> rrb.Spatial2DView:
        """The view that shows it."""
        bounds = rrb.VisualBounds2D(
            x_range=[-MARGIN, WIDTH + 0.5 * MARGIN],
            y_range=[-2.0 * ROW * len(self._arms), HEIGHT + 0.8 * MARGIN],
        )
        paper = rrb.Background(color=BACKGROUND)
        return rrb.Spatial2DView(origin=ENTITY, name=TITLE, visual_bounds=bounds, background=paper)

    def _draw_axes(self, stream: rr.RecordingStream) -> None:
        """Draw lines at round numbers, and these."""
        heels = np.arange(self._first, self._last + 0.5 * HEELS, HEELS).tolist()
        arms = np.arange(self._low, self._high + 0.5 * self._step, self._step).tolist()
        across = [[self._place(self._first, arm), self._place(self._last, arm)] for arm in arms]
        upright = [[self._place(heel, self._low), self._place(heel, self._high)] for heel in heels]
        is_zero = [abs(arm) < 1e-9 for arm in arms]
        lines = rr.LineStrips2D(
            across + upright,
            colors=[INK if zero else GRID for zero in is_zero] + [GRID] * len(upright),
            radii=rr.Radius.ui_points(0.6),
        )
        stream.log(f"{ENTITY}/axes", lines, static=True)
        digits = max(0, -math.floor(math.log10(self._step)))
        places = [[-0.6 * MARGIN, self._place(0.0, arm)[1] - DROP] for arm in arms]
        places += [[self._place(heel, self._low)[0], HEIGHT] for heel in heels]
        numbers = rr.Points2D(
            places,
            labels=[f"{arm:.{digits}f}" for arm in arms] + [f"{heel:.0f}\u00b0" for heel in heels],
            colors=[INK],
            radii=[0.0],
            show_labels=True,
        )
        stream.log(f"{ENTITY}/axes/numbers", numbers, static=True)

    def _place(self, heel: float, arm: float) -> list[float]:
        """Where a heel [degrees] and an arm [m] are in the view."""
        x = WIDTH * (heel - self._first) / (self._last - self._first)
        return [x, HEIGHT * (self._high - arm) / (self._high - self._low)]

    def _list_marks(self, name: str, arm: RightingArm) -> list[tuple[float, float, str]]:
        """The largest arm, and where stability ends: heel [degrees], arm [m] and a name."""
        owner = f"{name}: " if len(self._arms) > 1 else ""
        heel, most = math.degrees(arm.maximum[0]), arm.maximum[1]
        marks = [(heel, most, f"{owner}largest, {most:.3g} m at {heel:.0f} degrees")]
        if math.isfinite(arm.vanishing):
            end = math.degrees(arm.vanishing)
            marks.append((end, 0.0, f"{owner}stability vanishes at {end:.0f} degrees"))
        return marks

    def _draw_marks(
        self,
        stream: rr.RecordingStream,
        entity: str,
        colour: Colour,
        marks: Sequence[tuple[float, float, str]],
        number: int,
    ) -> None:
        """Draw points, and a line from each to its name over the chart, in a row of its own."""
        spots = np.array([self._place(heel, arm) for heel, arm, _ in marks])
        rows = 2 * number + np.arange(len(marks))
        # whole in the view, at the end of the line
        ends = np.column_stack([spots[:, 0], -ROW * rows])
        across = np.clip(spots[:, 0], ASIDE, WIDTH - ASIDE)
        places = np.column_stack([across, -ROW * (rows + 0.5) - DROP])
        points = rr.Points2D(spots, colors=[colour], radii=rr.Radius.ui_points(4.0))
        stream.log(entity, points, static=True)
        lines = rr.LineStrips2D(
            np.stack([spots, ends], axis=1), colors=[colour], radii=rr.Radius.ui_points(0.5)
        )
        stream.log(f"{entity}/lines", lines, static=True)
        names = rr.Points2D(
            places,
            labels=[name for *_, name in marks],
            colors=[colour],
            radii=[0.0],
            show_labels=True,
        )
        stream.log(f"{entity}/names", names, static=True)


def _choose_step(span: float) -> float:
    """The least round distance of ticks that makes `MOST` steps at most: 1, 2 or 5."""
    wanted = max(span, 1e-9) / MOST
    decade = 10.0 ** math.floor(math.log10(wanted))
    return min(step * decade for step in (1.0, 2.0, 5.0, 10.0) if step * decade >= wanted)
