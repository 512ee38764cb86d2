"""`Row`: one figure of the table that the pages show."""

from typing import NamedTuple


class Row(NamedTuple):
    """A figure, and what it is set beside."""

    what: str
    """What was measured."""
    value: str
    """How long it takes, or how large it is, with its unit."""
    factor: float | None = None
    """How many times that of something else; None if it stands alone."""
    relation: str = ""
    """How the factor is to be read, as 'as long as the engine alone'."""
    first: bool = False
    """Whether the first page shows it too."""

    @property
    def key(self) -> tuple[str, str]:
        """What it is, for the rows of several machines."""
        return self.what, self.relation

    @property
    def cell(self) -> str:
        """The figure in a table."""
        parts = [self.value] if self.value else []
        if self.factor is not None:
            parts.append(describe_factor(self.factor))
        return ", ".join(parts)


def describe_factor(factor: float) -> str:
    """A factor, as '1,157 x' or '2.5 x'."""
    digits = 0 if factor >= 20.0 else 1 if factor >= 2.0 else 2
    return f"{factor:,.{digits}f} x"


def describe_time(seconds: float) -> str:
    """A time in the unit that suits it, as '41 us'."""
    units = (("s", 1.0), ("ms", 1e-3), ("us", 1e-6))
    unit, size = next((pair for pair in units if seconds >= pair[1]), units[-1])
    value = seconds / size
    return f"{value:,.0f} {unit}" if value >= 20.0 else f"{value:.1f} {unit}"
