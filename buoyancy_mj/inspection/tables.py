"""`Section`: a titled table of a report; and how numbers are written into its cells."""

import dataclasses
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

_WIDEST_WORD = 14
"""Letters of a word that a column must hold; longer words are broken."""


@dataclasses.dataclass(frozen=True)
class Section:
    """A table with a title, and sentences under it."""

    title: str
    """Its heading."""
    header: tuple[str, ...]
    """Names of the columns; none for a table of names and values."""
    rows: tuple[tuple[str, ...], ...]
    """Cells of each row."""
    notes: tuple[str, ...] = ()
    """Sentences under the table."""

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the columns, '' for those without one."""
        return self.header or ("",) * len(self.rows[0])

    def is_numeric(self, column: int) -> bool:
        """Whether a column holds numbers alone."""
        cells = [row[column].replace(",", "") for row in self.rows]
        return all(
            cell in ("", "-") or cell.lstrip("+-").replace(".", "").replace("e-", "").isdigit()
            for cell in cells
        )

    def measure_words(self, column: int) -> int:
        """Letters of the longest word of a column that is not to be broken."""
        words = [word for row in self.rows for word in row[column].split()]
        return min(_WIDEST_WORD, max(map(len, words), default=0))


def format_number(value: float) -> str:
    """Write a number with four digits; '-' for one that is not finite."""
    return f"{value:.4g}" if math.isfinite(value) else "-"


def format_numbers(values: Sequence[float] | NDArray[np.float64]) -> str:
    """Write numbers with commas between."""
    return ", ".join(map(format_number, values))


def format_point(values: NDArray[np.float64]) -> str:
    """Write a point [m] in parentheses, to a hundredth of a millimetre."""
    return "(" + ", ".join(f"{value:.4g}" for value in np.round(values, 5) + 0.0) + ")"


def format_degrees(angle: float, digits: int = 1) -> str:
    """Write an angle [rad] in degrees."""
    return f"{round(math.degrees(angle), digits) + 0.0:.{digits}f}"


def format_bound(angle: float) -> str:
    """Write an angle [rad] in degrees; 'none' for one that is not finite."""
    return f"{math.degrees(angle):.1f}" if math.isfinite(angle) else "none"
