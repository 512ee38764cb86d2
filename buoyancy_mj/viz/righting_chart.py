"""`RightingChart`: righting arms over heel in a recording, with their angles of vanishing."""

import math
from collections.abc import Mapping

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from buoyancy_mj.statics.righting import RightingArm
from buoyancy_mj.viz.palette import hue

ENTITY = "righting"
TITLE = "righting arm GZ [m] over heel [degrees]"
WIDTH, HEIGHT, MARGIN = 1.9, 1.0, 0.16
"""Size of the chart, and of the space around it, in units of the view."""
DROP = 0.035
"""How far a name hangs under its place, likewise."""
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
            curve = [
                self._place(*point) for point in zip(np.degrees(arm.heel), arm.gz, strict=True)
            ]
            strip = rr.LineStrips2D([curve], colors=[colour], radii=rr.Radius.ui_points(1.5))
            stream.log(entity, strip, static=True)

            # the largest arm, and where stability ends
            owner = f"{name}: " if len(self._arms) > 1 else ""
            heel, most = math.degrees(arm.maximum[0]), arm.maximum[1]
            marks = [(heel, most, f"{owner}largest, {most:.3g} m at {heel:.0f} degrees")]
            if math.isfinite(arm.vanishing):
                end = math.degrees(arm.vanishing)
                marks.append((end, 0.0, f"{owner}stability vanishes at {end:.0f} degrees"))
            spots = rr.Points2D(
                [self._place(*mark[:2]) for mark in marks],
                colors=[colour],
                radii=rr.Radius.ui_points(4.0),
            )
            stream.log(f"{entity}/marks", spots, static=True)
            names = rr.Points2D(
                [self._place_name(*mark[:2], number) for mark in marks],
                labels=[mark[2] for mark in marks],
                colors=[colour],
                radii=[0.0],
                show_labels=True,
            )
            stream.log(f"{entity}/marks/names", names, static=True)

    def view(self) -> rrb.Spatial2DView:
        """The view that shows it."""
        bounds = rrb.VisualBounds2D(
            x_range=[-MARGIN, WIDTH + 0.5 * MARGIN],
            y_range=[-0.6 * MARGIN, HEIGHT + 0.8 * MARGIN],
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
        places = [[-0.5 * MARGIN, self._place(0.0, arm)[1] - DROP] for arm in arms]
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

    def _place_name(self, heel: float, arm: float, number: int) -> list[float]:
        """Where the name of a point stands, over it, whole in the chart."""
        x, y = self._place(heel, arm)
        return [min(max(x, 0.35), WIDTH - 0.35), max(y - 0.12 - 0.09 * number, 0.0)]


def _choose_step(span: float) -> float:
    """The least round distance of ticks that makes `MOST` steps at most: 1, 2 or 5."""
    wanted = max(span, 1e-9) / MOST
    decade = 10.0 ** math.floor(math.log10(wanted))
    return min(step * decade for step in (1.0, 2.0, 5.0, 10.0) if step * decade >= wanted)
