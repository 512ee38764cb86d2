"""Copies that `<replicate>` made: their names are those of the original and an index."""

import re
from collections.abc import Iterable, Mapping

_ENDING = re.compile(r"[\W_\d]*\d")
"""What `<replicate>` puts behind a name: perhaps a separator, and an index; nested, both again."""


def find_originals(names: Iterable[str]) -> Mapping[str, tuple[str, ...]]:
    """The names from which `<replicate>` may have made some of these, by the name of each copy.

    'pod0' and 'pod1' are copies of 'pod', with a separator 'pod-0' and 'pod-1'. The copies of an
    original begin at 0, and it is not there itself.
    """
    existing = {name for name in names if name}
    stems = {name: _stems(name) for name in existing}
    originals = {
        stem
        for name, possible in stems.items()
        for stem in possible
        if stem not in existing and not set(name[len(stem) :]) & set("123456789")
    }
    return {name: tuple(s for s in possible if s in originals) for name, possible in stems.items()}


def _stems(name: str) -> list[str]:
    """All beginnings of a name that leave a possible ending."""
    return [name[:i] for i in range(1, len(name)) if _ENDING.fullmatch(name, i)]
