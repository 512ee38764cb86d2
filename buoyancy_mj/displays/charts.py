"""`draw_chart`: curves as a small chart of SVG, without a library."""

import html
import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00")
"""Colours of curves, which the colour-blind tell apart: Okabe and Ito, "Color universal design"
(2008)."""
WIDTH, HEIGHT = 420, 170
"""Size of a chart in pixels."""
_LEFT, _RIGHT, _TOP, _BOTTOM = 56, 10, 20, 34
_TICKS = 5
"""How many ticks an axis has, about."""
_MOST_POINTS = 600
"""Most points of a curve; more than these no screen shows."""


class _Axis(NamedTuple):
    """Where values of an axis lie in the picture."""

    low: float
    high: float
    start: float
    end: float

    def place(self, values: NDArray[np.float64] | float) -> NDArray[np.float64]:
        """Values in pixels."""
        share = (np.asarray(values) - self.low) / (self.high - self.low)
        placed: NDArray[np.float64] = self.start + share * (self.end - self.start)
        return placed

    def list_ticks(self) -> list[float]:
        """Round values along the axis."""
        rough = (self.high - self.low) / _TICKS
        power = 10.0 ** math.floor(math.log10(rough))
        step = power * next(n for n in (1.0, 2.0, 5.0, 10.0) if n * power >= 0.999 * rough)
        first, last = math.ceil(self.low / step - 1e-9), math.floor(self.high / step + 1e-9)
        return [n * step for n in range(first, last + 1)]


def draw_chart(x: ArrayLike, curves: Mapping[str, ArrayLike], across: str, up: str) -> str:
    """Draw curves over the same values.

    Args:
        x: values (n,) along the horizontal axis.
        curves: values (n,) of each curve, by its name.
        across: what the horizontal axis says, with its unit.
        up: what the vertical axis says, with its unit.
    """
    known = np.asarray(x, float)
    chosen = np.unique(np.linspace(0, len(known) - 1, min(len(known), _MOST_POINTS)).astype(int))
    known = known[chosen]
    values = {name: np.asarray(curve, float)[chosen] for name, curve in curves.items()}
    along = _Axis(*_bound([known]), _LEFT, WIDTH - _RIGHT)
    upward = _Axis(*_bound(list(values.values()), 0.05), HEIGHT - _BOTTOM, _TOP)
    parts = _draw_axes(along, upward, across, up)
    for n, curve in enumerate(values.values()):
        parts += _draw_curve(along.place(known), upward.place(curve), _style(n))
    picture = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" '
        f'viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="11" '
        f'fill="currentColor" role="img" aria-label="{html.escape(up)}">{"".join(parts)}</svg>'
    )
    names = list(curves) if len(curves) > 1 else []
    frame = f"display:inline-block;vertical-align:bottom;width:{WIDTH}px"
    return f'<div style="{frame}">{_name_curves(names)}{picture}</div>'


def _bound(some: Sequence[NDArray[np.float64]], margin: float = 0.0) -> tuple[float, float]:
    """Least and greatest of finite values, with a margin that is a part of their range."""
    every = np.concatenate(some)
    every = every[np.isfinite(every)]
    low, high = (float(every.min()), float(every.max())) if len(every) else (0.0, 1.0)
    if high - low <= 1e-12 * max(1.0, abs(high)):
        low, high = low - 0.5, high + 0.5
    room = margin * (high - low)
    return low - room, high + room


def _draw_axes(along: _Axis, upward: _Axis, across: str, up: str) -> list[str]:
    """Grid, numbers and names of both axes."""
    parts = []
    for tick in along.list_ticks():
        at = float(along.place(tick))
        parts.append(_draw_line(at, _TOP, at, HEIGHT - _BOTTOM))
        parts.append(_write(at, HEIGHT - _BOTTOM + 13, f"{tick:.4g}", "middle"))
    for tick in upward.list_ticks():
        at = float(upward.place(tick))
        parts.append(_draw_line(_LEFT, at, WIDTH - _RIGHT, at))
        parts.append(_write(_LEFT - 5, at + 4, f"{tick:.4g}", "end"))
    parts.append(_write(0.5 * (_LEFT + WIDTH), HEIGHT - 5, across, "middle"))
    parts.append(_write(4, 12, up, "start"))
    return parts


def _draw_line(x1: float, y1: float, x2: float, y2: float) -> str:
    """A line of the grid."""
    ends = f'x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}"'
    return f'<line {ends} stroke="currentColor" stroke-opacity="0.18"/>'


def _style(number: int) -> str:
    """How a curve is drawn: after all colours have been used they come again, dashed."""
    colour = COLOURS[number % len(COLOURS)]
    dashes = ' stroke-dasharray="5 3"' if number >= len(COLOURS) else ""
    return f'fill="none" stroke="{colour}" stroke-width="1.5"{dashes}'


def _draw_curve(x: NDArray[np.float64], y: NDArray[np.float64], style: str) -> list[str]:
    """A curve, which has gaps where it is not finite."""
    edges = np.flatnonzero(np.diff(np.r_[False, np.isfinite(y), False]))
    lines = []
    for start, end in edges.reshape(-1, 2):
        pairs = zip(x[start:end].tolist(), y[start:end].tolist(), strict=True)
        points = " ".join(f"{a:.1f},{b:.1f}" for a, b in pairs)
        lines.append(f'<polyline points="{points}" {style}/>')
    return lines


def _name_curves(names: Sequence[str]) -> str:
    """The names of curves, each behind a piece of it."""
    entries = (
        '<span style="margin-right:12px;white-space:nowrap"><svg width="22" height="8">'
        f'<path d="M0 4H18" {_style(n)}/></svg>{html.escape(name)}</span>'
        for n, name in enumerate(names)
    )
    return f'<div style="font-size:11px;padding-left:{_LEFT}px">{" ".join(entries)}</div>'


def _write(x: float, y: float, text: str, anchor: str, more: str = "") -> str:
    """A text."""
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"{more}>{html.escape(text)}</text>'
