"""Responses as tables of at most 80 columns."""

import math
from collections.abc import Iterator

import numpy as np
from rich.table import Table

from buoyancy_mj.responses.extremes import Sea
from buoyancy_mj.responses.responses import Responses
from buoyancy_mj.responses.tracks import MOTIONS

FEW = 3
"""Headings up to which each has a table of its own; more share one, unless all are asked for."""
FAINTEST = 0.002
"""Size below which a response is none, and has no phase."""


def list_tables(
    responses: Responses, sea: Sea | None, duration: float, *, all_rows: bool
) -> Iterator[Table]:
    """The tables that tell of responses: of each heading or their peaks, and of a sea."""
    if all_rows or len(responses.headings) <= FEW:
        for h in range(len(responses.headings)):
            yield from _list_heading(responses, h)
    else:
        yield _make_peaks(responses)
    if sea is not None:
        yield from _list_sea(responses, sea, duration)


def _start_table(title: str, *columns: str) -> Table:
    """A narrow table, its numbers to the right."""
    table = Table(title=title, title_justify="left", box=None, padding=(0, 1), pad_edge=False)
    for column in columns:
        table.add_column(column, justify="right", no_wrap=True)
    return table


def _list_heading(responses: Responses, h: int) -> Iterator[Table]:
    """Tables of one heading: size and phase of the six motions, then of what else there is."""
    heading = math.degrees(responses.headings[h])
    names = responses.names
    for first in range(0, len(names), len(MOTIONS)):
        columns = range(first, min(first + len(MOTIONS), len(names)))
        table = _start_table(
            f"heading {heading:.4g} deg: size and lag [deg]",
            "T [s]",
            *(f"{names[c]}\n{_unit(responses, c)}" for c in columns),
        )
        for p in np.argsort(responses.periods):
            cells = (_cell(responses, h, int(p), c) for c in columns)
            table.add_row(f"{responses.periods[p]:.4g}{_mark_natural(responses, int(p))}", *cells)
        yield table


def _make_peaks(responses: Responses) -> Table:
    """The largest response from each heading, and its period."""
    columns = range(min(len(responses.names), len(MOTIONS)))
    table = _start_table(
        "largest response, and its period [s]; --all has every row",
        "heading\n[deg]",
        *(f"{responses.names[c]}\n{_unit(responses, c)}" for c in columns),
    )
    for h, heading in enumerate(responses.headings):
        cells = []
        for c in columns:
            p = int(responses.normal_sizes[h, :, c].argmax())
            size = responses.normal_sizes[h, p, c]
            mark = "" if responses.sure[h, p, c] else "*"
            is_none = size < FAINTEST
            cells.append("-" if is_none else f"{_show(size)}{mark} @{responses.periods[p]:.3g}")
        table.add_row(f"{math.degrees(heading):.4g}", *cells)
    return table


def _list_sea(responses: Responses, sea: Sea, duration: float) -> Iterator[Table]:
    """Significant and most probable largest amplitudes in a sea, from each heading."""
    count = min(len(responses.names), len(MOTIONS))
    scales = [180.0 / math.pi if unit == "rad" else 1.0 for unit in responses.units[:count]]
    units = ["deg" if unit == "rad" else unit for unit in responses.units[:count]]
    found = responses.in_sea(sea, duration)
    titles = {
        "significant": "significant amplitude",
        "largest": f"most probable largest amplitude in {duration / 3600.0:.3g} h",
    }
    where = f"in a sea of {sea.significant_height:.3g} m at {sea.peak_period:.3g} s"
    for field, title in titles.items():
        table = _start_table(
            f"{title}\n{where}",
            "heading\n[deg]",
            *(f"{name}\n[{unit}]" for name, unit in zip(responses.names, units, strict=False)),
        )
        values = np.array([[getattr(one, field) for one in row[:count]] for row in found]) * scales
        # none where no wave moves it
        is_none = responses.normal_sizes[:, :, :count].max(axis=1) < FAINTEST
        for heading, row, none in zip(responses.headings, values, is_none, strict=True):
            cells = ("-" if no else f"{x:.3g}" for x, no in zip(row, none, strict=True))
            table.add_row(f"{math.degrees(heading):.4g}", *cells)
        yield table


def _unit(responses: Responses, c: int) -> str:
    """What stands under the name of a response."""
    unit = responses.units[c]
    return "/slope" if unit == "rad" else f"[{unit}/m]"


def _cell(responses: Responses, h: int, p: int, c: int) -> str:
    """Size and phase of one response; a star where it is not sure."""
    size = responses.normal_sizes[h, p, c]
    if size < FAINTEST:
        return "-"
    mark = " " if responses.sure[h, p, c] else "*"
    return f"{_show(size)}{mark}{math.degrees(responses.phases[h, p, c]):4.0f}"


def _show(size: float) -> str:
    """A size with three decimals, or fewer where it is large."""
    return f"{size:.3f}" if size < 10.0 else f"{size:.4g}"


def _mark_natural(responses: Responses, p: int) -> str:
    """The letters of those motions whose natural period is nearest to a period, of all."""
    letters = ""
    for letter, natural in zip("hrp", responses.natural_periods, strict=True):
        inside = responses.periods.min() <= natural <= responses.periods.max()
        if inside and int(np.abs(responses.periods - natural).argmin()) == p:
            letters += letter
    return f" {letters}" if letters else ""
