"""Words that choose geoms: name globs and 'group:N', alone or with a value, 'PATTERN=VALUE'."""

import fnmatch
import math
from collections.abc import Iterable, Sequence

import mujoco

from buoyancy_mj.errors import ModelError, choices
from buoyancy_mj.hulls.custom import read_texts
from buoyancy_mj.hulls.names import geom_name
from buoyancy_mj.hulls.selection import CUSTOM_TEXTS, Selection

HULL_SHAPES = ("mesh", "convex")
"""What a geom may displace as: its own mesh, or its convex hull."""


def parse_shapes(
    model: mujoco.MjModel, geoms: Sequence[int], selection: Selection
) -> dict[int, str]:
    """One of `HULL_SHAPES` for those of `geoms` that the words 'PATTERN=convex' name.

    Raises:
        ModelError: an unknown shape, or a pattern that matches no geom.
    """
    shapes: dict[int, str] = {}
    for word, value, matches in _parse_assignments(model, geoms, selection, "hull"):
        if value not in HULL_SHAPES:
            raise ModelError(f"hull '{word}' asks for '{value}'; {choices(value, HULL_SHAPES)}")
        shapes |= dict.fromkeys(matches, value)
    return shapes


def parse_fills(
    model: mujoco.MjModel, geoms: Sequence[int], selection: Selection
) -> dict[int, float]:
    """The part of the volume that displaces for those of `geoms` that the words 'PATTERN=0.1' name.

    Raises:
        ModelError: a part that is not above 0 and at most 1, or a pattern that matches no geom.
    """
    fills: dict[int, float] = {}
    for word, value, matches in _parse_assignments(model, geoms, selection, "fill"):
        try:
            part = float(value)
        except ValueError:
            part = math.nan
        if not 0.0 < part <= 1.0:
            raise ModelError(
                f"fill '{word}' is no part of a volume: it must be above 0 and at most 1, "
                "as in 'frame=0.1'"
            )
        fills |= dict.fromkeys(matches, part)
    return fills


def read_words(model: mujoco.MjModel, selection: Selection, field: str) -> tuple[str, ...] | None:
    """The words of a field of the selection, or of the model's `<custom>`; None if neither has any.

    Raises:
        ModelError: the selection's field is empty.
    """
    choice: tuple[str, ...] | None = getattr(selection, field)
    if choice is None:
        return _split(read_texts(model, CUSTOM_TEXTS[field])) or None
    words = _split(choice)
    if not words:
        raise ModelError(
            f"an empty choice of {field} displaces nothing; "
            "give name globs or group:N, or leave it out"
        )
    return words


def match_geoms(model: mujoco.MjModel, geoms: Sequence[int], pattern: str) -> list[int]:
    """Those of `geoms` whose name matches a glob, or whose group is N of 'group:N'.

    Raises:
        ModelError: there is none.
    """
    if pattern.startswith("group:"):
        matches = [g for g in geoms if f"group:{model.geom_group[g]}" == pattern]
    else:
        matches = [g for g in geoms if fnmatch.fnmatchcase(geom_name(model, g), pattern)]
    if not matches:
        possible = {geom_name(model, g) for g in geoms}
        possible |= {f"group:{model.geom_group[g]}" for g in geoms}
        raise ModelError(f"no moving geom matches '{pattern}'; {choices(pattern, possible)}")
    return matches


def _parse_assignments(
    model: mujoco.MjModel, geoms: Sequence[int], selection: Selection, field: str
) -> list[tuple[str, str, list[int]]]:
    """Each word 'PATTERN=VALUE', its value, and its geoms; a value alone is for all of `geoms`."""
    assignments = []
    for word in read_words(model, selection, field) or ():
        pattern, value = word.rsplit("=", 1) if "=" in word else ("*", word)
        assignments.append((word, value, match_geoms(model, geoms, pattern)))
    return assignments


def _split(texts: Iterable[str]) -> tuple[str, ...]:
    """The words of texts, between blanks or commas."""
    return tuple(word for text in texts for word in text.replace(",", " ").split())
