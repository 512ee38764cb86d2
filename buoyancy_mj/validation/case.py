"""What a case is: rows of what is published and what is computed, and perhaps a picture."""

import dataclasses
from collections.abc import Callable, Sequence

from matplotlib.figure import Figure


@dataclasses.dataclass(frozen=True)
class Row:
    """One quantity, published and computed."""

    quantity: str
    """Name of the quantity, with its unit in brackets."""
    published: float
    """The published value."""
    computed: float
    """The value computed here."""
    tolerance: float
    """Largest difference with which the row holds, in the terms of `difference`."""
    absolute: bool = False
    """Whether differences are in the quantity's unit; otherwise they are parts of `published`."""

    @property
    def difference(self) -> float:
        """Computed less published value, over the size of the published one unless `absolute`."""
        difference = self.computed - self.published
        return difference if self.absolute else difference / abs(self.published)

    @property
    def holds(self) -> bool:
        """Whether the difference is within the tolerance."""
        return abs(self.difference) <= self.tolerance


@dataclasses.dataclass(frozen=True)
class Case:
    """A published experiment, benchmark or closed form."""

    name: str
    """One word: the value of `--only`, and the name of the picture."""
    title: str
    """One line."""
    source: str
    """Where the published values stand."""
    setup: str
    """How they are computed here."""
    run: Callable[[], Sequence[Row]]
    """Computes the rows."""
    reason: str = ""
    """Why rows fail, where some do."""
    draw: Callable[[], Figure] | None = None
    """Draws the picture, if the case has one."""
    loads: tuple[str, ...] = ()
    """The loads that act in the runs, each as a name of `Loads.by_cause` and perhaps what of it, as
    "drag: estimated"; () for a case that runs nothing in water."""
