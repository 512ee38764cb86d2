"""What a page says that its code prints, beside what it prints."""

import re

import pytest

NUMBER = r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?"


def compare(printed, said):
    """The words are the same, and the numbers are to 5 %, or to two of their last digit."""
    assert re.split(NUMBER, printed) == re.split(NUMBER, said)
    for now, then in zip(re.findall(NUMBER, printed), re.findall(NUMBER, said), strict=True):
        decimals = len(then.partition(".")[2]) if "e" not in then else 0
        assert float(now) == pytest.approx(float(then), rel=0.05, abs=2.0 * 10.0**-decimals)
