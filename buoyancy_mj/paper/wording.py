"""Numbers put into words, for the column "measured here"."""

from collections.abc import Mapping


def percent(value: float, *, sign: bool = False) -> str:
    """Write a fraction as a percentage, with as many digits as it deserves."""
    value = 0.0 if abs(value) < 1e-9 else value
    size = abs(100.0 * value)
    digits = ".0f" if size >= 10.0 else ".1f" if size >= 0.1 else ".1g"
    return f"{100.0 * value:{'+' if sign else ''}{digits}} %"


def itemize(values: Mapping[str, str]) -> str:
    """Join values with commas, each followed by its name in parentheses."""
    return ", ".join(f"{value} ({name})" for name, value in values.items())
