"""What a part of the reproduction is made of: tables, claims of the paper beside them, and a figure."""

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Column = Sequence[str] | Sequence[float] | NDArray[np.float64]
"""Values of one column of a table."""
Table = Mapping[str, Column]
"""Columns of one length by name, units in brackets."""


@dataclasses.dataclass(frozen=True)
class Claim:
    """One claim of the paper, and what is found here."""

    claim: str
    """What is said."""
    paper: str
    """The paper's number."""
    measured: str
    """The number found here, and on what."""
    holds: str
    """"yes", "no" or "in part"."""


@dataclasses.dataclass(frozen=True)
class Result:
    """What a study found."""

    tables: Mapping[str, Table]
    """By name; each becomes NAME.csv."""
    claims: tuple[Claim, ...]
    """The claims that it checks."""


@dataclasses.dataclass(frozen=True)
class Study:
    """A part of the reproduction that can be run by itself."""

    name: str
    """One word: that of `--only`, and of the picture."""
    title: str
    """One line."""
    run: Callable[[bool], Result]
    """The computation; True for a coarse, quick one."""
    draw: Callable[[Result], "Figure"] | None = None
    """Its figure, if it has one."""
    caption: str = ""
    """What the figure shows."""


def verdict(whole: bool, part: bool = False) -> str:
    """Whether a claim holds, in a word."""
    return "yes" if whole else "in part" if part else "no"


def table_of(names: Sequence[str], rows: Sequence[Sequence[Any]]) -> Table:
    """A table by its rows."""
    return {name: list(column) for name, column in zip(names, zip(*rows, strict=True), strict=True)}


def percent(value: float, *, sign: bool = False) -> str:
    """A fraction as a percentage, with as many digits as it deserves."""
    value = 0.0 if abs(value) < 1e-9 else value
    size = abs(100.0 * value)
    digits = ".0f" if size >= 10.0 else ".1f" if size >= 0.1 else ".1g"
    return f"{100.0 * value:{'+' if sign else ''}{digits}} %"


def listed(values: Mapping[str, str]) -> str:
    """Values, each with what it is of behind it."""
    return ", ".join(f"{value} ({name})" for name, value in values.items())
