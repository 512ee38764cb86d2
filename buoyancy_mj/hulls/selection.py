"""`Selection`: which geoms of a model displace water, and as what, as the user chooses it."""

import dataclasses
import glob
import shlex
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from buoyancy_mj.errors import ModelError, describe

CUSTOM_TEXTS: Mapping[str, str] = {
    "geoms": "buoyancy_geoms",
    "hull": "buoyancy_hull",
    "fill": "buoyancy_fill",
}
"""MJCF `<custom><text>` by which a vehicle chooses for itself, by the field of `Selection`."""
_GAPS = " \t\r\n,"
"""Characters between the words of a text."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Selection:
    """Which geoms of a model displace water, and as what.

    A pattern is a name glob such as 'hull*', or 'group:2'. '!PATTERN' takes geoms out again. Each
    field takes several patterns as a sequence, or as one text, in which blanks or commas stand
    between them; there quotes keep a pattern with a blank together, as in "'my hull' pod".

    None leaves the choice to the model: to its `<custom>` texts 'buoyancy_geoms', 'buoyancy_hull'
    and 'buoyancy_fill', or to the defaults.

    Raises:
        ModelError: a field is empty, or holds something else than texts.

    Example:
        `Selection(geoms=["hull*", "pod"], fill="frame=0.1")`
    """

    geoms: str | Sequence[str] | None = None
    """Which geoms displace water: patterns. By default the collision geoms of each body, or its
    visual ones if it has none."""
    hull: str | Sequence[str] | None = None
    """Which of them displace as their convex hull: 'PATTERN=convex', or 'convex' for all."""
    fill: str | Sequence[str] | None = None
    """Which of them flood, and the part of their volume that displaces: 'PATTERN=0.1'."""

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            if value is not None:
                object.__setattr__(self, field.name, _parse_field(value, field.name))


def rename_patterns(selection: Selection, prefix: str, suffix: str) -> Selection:
    """A selection for a model in which all names got a prefix and a suffix."""
    before, after = glob.escape(prefix), glob.escape(suffix)

    def rename(word: str) -> str:
        sign = "!" if word.startswith("!") else ""
        pattern = word.removeprefix("!")
        return word if pattern.startswith("group:") else f"{sign}{before}{pattern}{after}"

    def rename_assignment(word: str) -> str:
        pattern, equals, value = word.rpartition("=")
        return f"{rename(pattern)}={value}" if equals else word

    return Selection(
        geoms=None if selection.geoms is None else [rename(word) for word in selection.geoms],
        hull=None if selection.hull is None else list(map(rename_assignment, selection.hull)),
        fill=None if selection.fill is None else list(map(rename_assignment, selection.fill)),
    )


def split_words(text: str, what: str) -> tuple[str, ...]:
    """The words of a text, between blanks or commas; quotes keep a word with a blank together.

    Args:
        text: the text.
        what: how messages call it.

    Raises:
        ModelError: a quote is opened and not closed.
    """
    lexer = shlex.shlex(text, posix=True, punctuation_chars=False)
    lexer.whitespace = _GAPS
    lexer.whitespace_split = True
    lexer.commenters = lexer.escape = ""
    try:
        return tuple(lexer)
    except ValueError:
        raise ModelError(
            f"{what} is {describe(text)}, whose quote is not closed; close it, "
            "or put a name with a quote in it between quotes of the other kind"
        ) from None


def join_words(words: Iterable[str]) -> str:
    """A text from which `split_words` makes the same words again."""
    return " ".join(_quote(word) if set(word) & set(_GAPS + "'\"") else word for word in words)


def add_geom(text: str, name: str) -> str:
    """A text 'buoyancy_geoms' that chooses one more geom, by its name."""
    words = split_words(text, "the choice of geoms")
    if all(word.startswith("!") for word in words):
        # the default choice has the geom already
        return text
    return join_words([*words, glob.escape(name)])


def _quote(word: str) -> str:
    """A word between quotes; those inside it stand between quotes of the other kind."""
    inside = word.replace("'", "'\"'\"'")
    return f"'{inside}'"


def _parse_field(value: Any, name: str) -> tuple[str, ...]:
    """The words of a field: those of one text, or each item of a sequence as it is."""
    if isinstance(value, str):
        words = split_words(value, name)
    elif isinstance(value, Iterable) and not isinstance(value, bytes | bytearray | Mapping):
        words = tuple(value)
    else:
        words = (value,)
    if not all(isinstance(word, str) for word in words):
        raise ModelError(
            f"{name} is {describe(value)}; it must be a pattern, as 'hull*', or a list of patterns"
        )
    if not all(word.strip() for word in words) or not words:
        raise ModelError(
            f"an empty choice of {name} displaces nothing; "
            "give name globs or group:N, or leave it out"
        )
    return words
