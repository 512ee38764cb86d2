"""All cases: run, and written as a page with tables and pictures."""

import os
import platform
from collections.abc import Callable, Mapping, Sequence
from importlib.metadata import version
from pathlib import Path

from buoyancy_mj.errors import BuoyancyError, choices
from buoyancy_mj.validation import flows, spheres, vehicles
from buoyancy_mj.validation.case import Case, Row

CASES: Mapping[str, Case] = {
    case.name: case for part in (spheres, vehicles, flows) for case in part.CASES
}
"""By name."""
PICTURES = "validation"
"""Folder of the pictures, beside the page."""


def validate(
    folder: Path, only: Sequence[str] = (), begin: Callable[[Case], None] = lambda case: None
) -> dict[str, Sequence[Row]]:
    """Run cases; without `only`, write the page 'validation.md' and its pictures.

    Raises:
        BuoyancyError: there is no such case, or the folder cannot be written to.
    """
    for name in only:
        if name not in CASES:
            raise BuoyancyError(f"there is no case '{name}'; {choices(name, CASES)}")
    found = {}
    for name, case in CASES.items():
        if not only or name in only:
            begin(case)
            found[name] = case.run()
    if not only:
        try:
            (folder / PICTURES).mkdir(parents=True, exist_ok=True)
            for name, case in CASES.items():
                if case.draw is not None:
                    case.draw().savefig(
                        folder / PICTURES / f"{name}.png", dpi=110, metadata={"Software": None}
                    )
            (folder / "validation.md").write_text(page(found))
        except OSError as error:
            raise BuoyancyError(f"cannot write the validation to '{folder}': {error}") from error
    return found


def page(found: Mapping[str, Sequence[Row]]) -> str:
    """The page, in Markdown."""
    rows = [row for case in found.values() for row in case]
    passed = sum(row.passes for row in rows)
    machine = (
        f"{os.cpu_count()} cores, Python {platform.python_version()}, MuJoCo {version('mujoco')}"
    )
    parts = [_PAGE.format(count=len(rows), passed=passed, machine=machine)]
    for name, results in found.items():
        case = CASES[name]
        parts.append(f"## {case.title}\n\nPublished: {case.source}. Here: {case.what}\n")
        parts.append(
            "| quantity | published | here | difference | allowed | verdict |\n| --- | ---: | ---: | ---: | ---: | --- |"
        )
        parts += [f"| {' | '.join(cells(row))} |" for row in results]
        failed = sum(not row.passes for row in results)
        if failed:
            parts.append(f"\n{failed} of {len(results)} fail. {case.reason}")
        if case.draw is not None:
            parts.append(f"\n![{case.title}]({PICTURES}/{name}.png)")
        parts.append(f"\n`buoyancy-mj validate --only {name}`\n")
    return "\n".join(parts).rstrip() + "\n"


def cells(row: Row) -> tuple[str, ...]:
    """A row as text."""
    if row.absolute:
        apart, allowed = f"{row.difference:+.3g}", f"{row.allowed:.3g}"
    else:
        apart, allowed = f"{100 * row.difference:+.2g} %", f"{100 * row.allowed:.2g} %"
    return (
        row.quantity,
        f"{row.published:.4g}",
        f"{row.ours:.4g}",
        apart,
        allowed,
        "holds" if row.passes else "**fails**",
    )


_PAGE = """# Against the world

Published experiments, benchmarks and closed forms beside what comes out here, written by

    scripts/validate

with its pictures; last on {machine}. {passed} of {count} rows hold. What fails stays, with its reason.
"""
