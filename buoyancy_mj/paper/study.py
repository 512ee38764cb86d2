"""The parts of a study: its computation, its tables, the claims that it checks, its figure."""

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Column = Sequence[str] | Sequence[float] | NDArray[np.float64]
"""The values of one column of a table."""
Table = Mapping[str, Column]
"""Columns of one length by name, with units in brackets."""


@dataclasses.dataclass(frozen=True)
class Claim:
    """One claim of the paper beside what is measured here."""

    statement: str
    """The claim, in a few words."""
    published: str
    """The paper's number."""
    measured: str
    """The number measured here, and on which bodies."""
    verdict: str
    """"yes", "no" or "in part", from `judge`."""


@dataclasses.dataclass(frozen=True)
class Result:
    """The outcome of a study."""

    tables: Mapping[str, Table]
    """The tables by name; each becomes NAME.csv."""
    claims: tuple[Claim, ...] = ()
    """The claims that the study checks."""


@dataclasses.dataclass(frozen=True)
class Study:
    """A part of the reproduction that can run by itself."""

    name: str
    """One word: the value of `--only`, and the name of the picture."""
    title: str
    """One line."""
    measure: Callable[[bool], Result]
    """The computation; it is coarse and quick if its argument is True."""
    draw: Callable[[Result], "Figure"] | None = None
    """The figure, if the study has one."""
    caption: str = ""
    """What the figure shows."""


def judge(whole: bool, part: bool = False) -> str:
    """Return the verdict on a claim: "yes", "in part" or "no".

    Args:
        whole: whether the claim holds for all bodies and methods that it names.
        part: whether it holds for some of them.
    """
    if whole:
        return "yes"
    return "in part" if part else "no"


def tabulate(names: Sequence[str], rows: Sequence[Sequence[Any]]) -> Table:
    """Turn rows into a table with columns of these names."""
    return {name: list(column) for name, column in zip(names, zip(*rows, strict=True), strict=True)}
