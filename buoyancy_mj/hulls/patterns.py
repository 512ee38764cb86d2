"""Patterns that choose geoms: name globs and 'group:N', alone or with a value, 'PATTERN=VALUE'."""

import dataclasses
import fnmatch
import math
from collections.abc import Iterator, Mapping, Sequence

import mujoco

from buoyancy_mj.errors import ModelError, choices
from buoyancy_mj.hulls.names import geom_name
from buoyancy_mj.hulls.scopes import BASE, Scope, explain_missing
from buoyancy_mj.hulls.selection import Selection
from buoyancy_mj.hulls.words import Choice, FileWords, read_file_words

HULL_SHAPES = ("mesh", "convex")
"""What a geom may displace as: its own mesh, or its convex hull."""


@dataclasses.dataclass(frozen=True, eq=False)
class Pool:
    """The geoms among which patterns choose."""

    model: mujoco.MjModel
    """Their model."""
    names: Mapping[int, Sequence[str]]
    """The names of each, by its index."""
    refusals: Mapping[int, str]
    """Why some of them, and of others, cannot be chosen."""
    source: str = ""
    """The name of the text that holds the patterns; '' for the user's."""
    scope: Scope = BASE
    """What came from the file of that text."""

    def matches(self, geom: int, pattern: str) -> bool:
        """Whether a name of a geom matches a glob, or its group is N of 'group:N'."""
        if pattern.startswith("group:"):
            return f"group:{self.model.geom_group[geom]}" == pattern
        return any(fnmatch.fnmatchcase(name, pattern) for name in self.names[geom])

    def match(self, pattern: str) -> list[int]:
        """The geoms that match a pattern and can be chosen.

        Raises:
            ModelError: there is none.
        """
        matches = [geom for geom in self.names if self.matches(geom, pattern)]
        chosen = [geom for geom in matches if geom not in self.refusals]
        if chosen:
            return chosen

        # say what matches and cannot be chosen, and what can
        free = [geom for geom in self.names if geom not in self.refusals]
        possible = {self.names[geom][0] for geom in free}
        possible |= {f"group:{self.model.geom_group[geom]}" for geom in free}
        of = f" of '{self.source}'" if self.source else ""
        but = "".join(
            f" ('{self.names[geom][0]}' does, but {self.refusals[geom]})" for geom in matches[:1]
        )
        raise ModelError(
            f"no moving geom matches '{pattern}'{of}{but}; {choices(pattern, possible)}"
            f"{'' if matches else explain_missing(self.scope)}"
        )


def pool_of_model(model: mujoco.MjModel, refusals: Mapping[int, str]) -> Pool:
    """All geoms of a model, by the names that messages use; the user chooses among these."""
    return Pool(model, {g: (geom_name(model, g),) for g in range(model.ngeom)}, refusals)


def pool_of_file(
    model: mujoco.MjModel, words: FileWords, choice: Choice, refusals: Mapping[int, str]
) -> Pool:
    """The geoms of the file that states a choice, by the names that the file has for them."""
    belongings = words.belongings
    names = {g: belongings.names[g] for g in words.find_geoms(choice.scope)}
    return Pool(model, names, refusals, choice.name, choice.scope)


def parse_shapes(
    model: mujoco.MjModel, geoms: Sequence[int], selection: Selection
) -> dict[int, str]:
    """One of `HULL_SHAPES` for those of `geoms` that the words 'PATTERN=convex' name.

    Raises:
        ModelError: an unknown shape, a pattern of the selection that matches no geom, or a word
            that later ones leave no geom.
    """
    shapes: dict[int, str] = {}
    assignments = list(_parse_assignments(model, geoms, selection, "hull"))
    for word, value, matches in assignments:
        if value not in HULL_SHAPES:
            raise ModelError(f"hull '{word}' asks for '{value}'; {choices(value, HULL_SHAPES)}")
        shapes |= dict.fromkeys(matches, value)
    _check_used("hull", assignments)
    return shapes


def parse_fills(
    model: mujoco.MjModel, geoms: Sequence[int], selection: Selection
) -> dict[int, float]:
    """The part of the volume that displaces for those of `geoms` that the words 'PATTERN=0.1' name.

    Raises:
        ModelError: a part that is not above 0 and at most 1, a pattern of the selection that
            matches no geom, or a word that later ones leave no geom.
    """
    fills: dict[int, float] = {}
    assignments = list(_parse_assignments(model, geoms, selection, "fill"))
    for word, value, matches in assignments:
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
    _check_used("fill", assignments)
    return fills


def split_assignment(word: str) -> tuple[str, str]:
    """The pattern and the value of 'PATTERN=VALUE'; a value alone is for all geoms."""
    pattern, equals, value = word.rpartition("=")
    return pattern if equals else "*", value


def _parse_assignments(
    model: mujoco.MjModel, geoms: Sequence[int], selection: Selection, field: str
) -> Iterator[tuple[str, str, list[int]]]:
    """Each word 'PATTERN=VALUE' of the user or of the files, its value, and its geoms."""
    refusals = {g: "it displaces nothing" for g in range(model.ngeom) if g not in set(geoms)}

    # of the user: each finds a geom
    if (chosen := getattr(selection, field)) is not None:
        pool = pool_of_model(model, refusals)
        for word in chosen:
            pattern, value = split_assignment(word)
            yield word, value, pool.match(pattern)
        return

    # of the files: `hulls.verdicts.judge_geoms` has seen to it that each finds one
    words = read_file_words(model)
    for choice in words.of_field(field):
        pool = pool_of_file(model, words, choice, refusals)
        for word in choice.words:
            pattern, value = split_assignment(word)
            yield word, value, [g for g in geoms if g in pool.names and pool.matches(g, pattern)]


def _check_used(field: str, assignments: Sequence[tuple[str, str, list[int]]]) -> None:
    """Refuse a word whose geoms all get another value from words after it."""
    last = {g: (word, value) for word, value, matches in assignments for g in matches}
    for word, value, matches in assignments:
        if matches and all(last[g][1] != value for g in matches):
            raise ModelError(
                f"{field} '{word}' holds for no geom, since '{last[matches[0]][0]}' after it names "
                "the same; leave one of them out"
            )
