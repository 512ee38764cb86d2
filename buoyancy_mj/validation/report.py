"""All cases: run them, and write a page with tables and pictures."""

import os
import platform
from collections.abc import Callable, Mapping, Sequence
from importlib.metadata import version
from pathlib import Path

from buoyancy_mj.errors import BuoyancyError, choices
from buoyancy_mj.files import replace_file, require_own
from buoyancy_mj.plotting.style import save_figure, use_style
from buoyancy_mj.validation import (
    bluerov2_heavy,
    coefficients,
    currents,
    depths,
    entries,
    foils,
    oes_sphere,
    otter,
    remus_100,
    roll_decay,
    terminal_speeds,
    thrusters,
    waves,
)
from buoyancy_mj.validation.case import Case, Row

_MODULES = (
    oes_sphere,
    bluerov2_heavy,
    remus_100,
    otter,
    roll_decay,
    coefficients,
    entries,
    foils,
    terminal_speeds,
    thrusters,
    waves,
    currents,
    depths,
)
CASES: Mapping[str, Case] = {case.name: case for module in _MODULES for case in module.CASES}
"""The cases by name, in the order of the page."""
HEADER = ("quantity", "published", "here", "difference", "allowed", "verdict")
"""Header of the tables of rows."""
PAGE = "validation.md"
"""Name of the page."""
PICTURES = "validation"
"""Folder of the pictures, beside the page."""


def validate(
    folder: Path, only: Sequence[str] = (), begin: Callable[[Case], None] = lambda _: None
) -> dict[str, Sequence[Row]]:
    """Run cases; if all run, write the page 'validation.md' and its pictures.

    Args:
        folder: where page and pictures go.
        only: names of cases; empty for all.
        begin: called with each case before it runs.

    Returns:
        The rows by the name of their case.

    Raises:
        BuoyancyError: there is no such case, or the folder cannot be written to.
    """
    for name in only:
        if name not in CASES:
            raise BuoyancyError(f"there is no case '{name}'; {choices(name, CASES)}")

    if not only:
        # before anything runs, for that takes minutes
        _check_page(folder / PAGE)
    results = {}
    for name, case in CASES.items():
        if not only or name in only:
            begin(case)
            results[name] = case.run()
    if not only:
        _write(folder, results)
    return results


def _check_page(page: Path) -> None:
    """Refuse to replace a page that somebody else has written."""
    try:
        require_own(page, _TITLE)
    except OSError as error:
        raise BuoyancyError(
            f"cannot write '{page}': {error.strerror}; choose another folder (--out)"
        ) from error


def _write(folder: Path, results: Mapping[str, Sequence[Row]]) -> None:
    """Write the page and its pictures."""
    try:
        for name, case in CASES.items():
            if case.draw is not None:
                picture = folder / PICTURES / f"{name}.png"
                with use_style():
                    save_figure(case.draw(), picture)
        with replace_file(folder / PAGE) as part:
            part.write_text(render_page(results))
    except OSError as error:
        raise BuoyancyError(f"cannot write the validation to '{folder}': {error}") from error


def render_page(results: Mapping[str, Sequence[Row]]) -> str:
    """Write the page in Markdown, from rows by the name of their case."""
    rows = [row for case_rows in results.values() for row in case_rows]
    holding = sum(row.holds for row in rows)
    machine = (
        f"{os.cpu_count()} cores, Python {platform.python_version()}, MuJoCo {version('mujoco')}"
    )
    parts = [_HEAD.format(count=len(rows), holding=holding, machine=machine)]
    parts += [_render_case(CASES[name], case_rows) for name, case_rows in results.items()]
    return "\n".join(parts).rstrip() + "\n"


def _render_case(case: Case, rows: Sequence[Row]) -> str:
    """Write the section of a case: sources, table, reason, picture and command."""
    lines = [
        f"## {case.title}\n",
        f"Published: {case.source}.\n",
        f"Here: {case.setup}\n",
        *([f"Acting: {_name_loads(case)}.\n"] if case.loads else []),
        f"| {' | '.join(HEADER)} |",
        "| --- | ---: | ---: | ---: | ---: | --- |",
    ]
    lines += [f"| {' | '.join(format_row(row))} |" for row in rows]
    failing = sum(not row.holds for row in rows)
    if failing:
        lines.append(f"\n{failing} of {len(rows)} fail. {case.reason}")
    if case.draw is not None:
        lines.append(f"\n![{case.title}]({PICTURES}/{case.name}.png)")
    lines.append(f"\n`buoyancy-mj validate --only {case.name}`\n")
    return "\n".join(lines)


def _name_loads(case: Case) -> str:
    """The loads of a case in words, as "buoyancy, drag (estimated)"."""
    parts = [load.replace("_", " ").partition(": ") for load in case.loads]
    return ", ".join(f"{name} ({what})" if what else name for name, _, what in parts)


def format_row(row: Row) -> tuple[str, ...]:
    """The cells of a row as text, in the order of `HEADER`."""
    if row.absolute:
        difference = f"{row.difference:+.3g}"
        tolerance = f"{row.tolerance:.3g}"
    else:
        difference = f"{100 * row.difference:+.2g} %"
        tolerance = f"{100 * row.tolerance:.2g} %"
    return (
        row.quantity,
        f"{row.published:.4g}",
        f"{row.computed:.4g}",
        difference,
        tolerance,
        "holds" if row.holds else "**fails**",
    )


_TITLE = "# Against the world"
"""The first line of the page."""
_HEAD = (
    f"{_TITLE}\n"
    + """
This page sets published experiments, benchmarks and closed forms beside what this package computes.
The page and its pictures are written by

    scripts/validate

The last run was on {machine}. {holding} of {count} rows hold. Those that fail stay on the page,
with the reason below their table.
"""
)
