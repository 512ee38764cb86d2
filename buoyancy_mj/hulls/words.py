"""What the files of a model state in `<custom>` of their geoms, each for what came from it."""

import dataclasses
import difflib
import fnmatch
import functools
import re
from collections.abc import Iterable, Iterator
from typing import NamedTuple

import mujoco

from buoyancy_mj.errors import ModelError, choices
from buoyancy_mj.hulls.custom import (
    FOIL,
    QUANTITIES,
    read_all_numerics,
    read_all_texts,
    read_foil_texts,
    read_tuple_names,
    split_foil,
    split_quantity,
)
from buoyancy_mj.hulls.names import geom_name
from buoyancy_mj.hulls.scopes import (
    BASE,
    Belongings,
    Scope,
    assign_geoms,
    find_scope,
    find_slash_scopes,
)
from buoyancy_mj.hulls.selection import CUSTOM_TEXTS, split_words

_ALIKE, _ALIKE_FOIL = 0.8, 0.88
"""Likeness from which a name counts as a misspelt one of ours, as `difflib` measures it; the word
'foil' is short, and 'oil' is none of ours."""


class Choice(NamedTuple):
    """A text by which a file chooses among its geoms."""

    name: str
    """Its name in the model, as 'rov1_buoyancy_geoms'."""
    field: str
    """The field of `Selection` that it is for."""
    scope: Scope
    """What came from its file."""
    words: tuple[str, ...]
    """Its words."""

    @property
    def patterns(self) -> tuple[str, ...]:
        """Its words without their values, and without the sign of those that leave geoms out."""
        return tuple((word.rpartition("=")[0] or word).removeprefix("!") for word in self.words)


@dataclasses.dataclass(frozen=True, eq=False)
class FileWords:
    """The choices of all files of a model."""

    model: mujoco.MjModel
    """The model."""
    choices: tuple[Choice, ...]
    """In the order of the model's texts."""

    def of_field(self, field: str) -> Iterator[Choice]:
        """The choices for one field of `Selection`."""
        return (choice for choice in self.choices if choice.field == field)

    def find_geoms(self, scope: Scope) -> list[int]:
        """The geoms that belong to a scope."""
        return [geom for geom, owner in enumerate(self.belongings.scopes) if owner == scope]

    @functools.cached_property
    def belongings(self) -> Belongings:
        """Which geoms belong to which file.

        Scopes are those that state anything, and prefixes that end in a slash. Where a text names
        geoms behind such a slash itself, the slash is a part of the names in its file.
        """
        scopes = {choice.scope for choice in self.choices}
        for name in read_all_numerics(self.model):
            if quantity := split_quantity(name):
                scope = find_scope(name, f"{quantity[0]}:")
                assert scope is not None
                scopes.add(Scope(scope.prefix))
        for foil in read_foil_texts(self.model):
            scopes.add(Scope(foil.name.partition(f"{FOIL}:")[0]))
        slashes = find_slash_scopes(self.model, scopes) - scopes
        belongings = assign_geoms(self.model, (scopes | slashes) - {BASE})
        named = {scope for scope in slashes if self._names(scope, belongings)}
        if not named:
            return belongings
        return assign_geoms(self.model, (scopes | slashes) - named - {BASE})

    def _names(self, slash: Scope, belongings: Belongings) -> bool:
        """Whether a text has a pattern for what stands behind a slash.

        It begins with what stands before the slash, or it matches geoms there and none in the file
        of the text.
        """
        behind = [g for g, owner in enumerate(belongings.scopes) if owner == slash]
        for choice in self.choices:
            own = [g for g, owner in enumerate(belongings.scopes) if owner == choice.scope]
            names = [name for g in own for name in belongings.names[g]]
            full = [name for g in behind if choice.scope.has(name := geom_name(self.model, g))]
            others = [choice.scope.own_name(name) for name in full]
            for pattern in choice.patterns:
                if f"{choice.scope.prefix}{pattern}".startswith(slash.prefix):
                    return True
                if _finds(pattern, others) and not _finds(pattern, names):
                    return True
        return False


def _finds(pattern: str, names: Iterable[str]) -> bool:
    """Whether a glob matches one of some names."""
    return any(fnmatch.fnmatchcase(name, pattern) for name in names)


def read_file_words(model: mujoco.MjModel) -> FileWords:
    """Read the texts by which the files of a model choose among their geoms.

    Raises:
        ModelError: a text without a word, or with a quote that is not closed.
    """
    found = []
    for name, text in read_all_texts(model).items():
        for field, keyword in CUSTOM_TEXTS.items():
            if scope := find_scope(name, keyword):
                words = split_words(text, f"the text '{name}'")
                if not words:
                    raise ModelError(
                        f"the text '{name}' is empty; give it name globs or group:N, or remove it"
                    )
                found.append(Choice(name, field, scope, words))
    return FileWords(model, tuple(found))


def check_custom_names(model: mujoco.MjModel) -> None:
    """Refuse names in `<custom>` that are nearly ours, and ours in an element of another kind.

    Names of other people's are left alone.

    Raises:
        ModelError: there is one; the message has the right name, or the right element.
    """
    names = [("text", name) for name in read_all_texts(model)]
    names += [("numeric", name) for name in read_all_numerics(model)]
    names += [("tuple", name) for name in read_tuple_names(model)]
    for kind, name in names:
        needed = _kind_of_keyword(name)
        if needed and kind != needed:
            raise ModelError(
                f"'{name}' is a <{kind}> and is read only as a <{needed}>; make it one"
            )
        known = needed and _is_plausible(model, name)
        if not known and (near := _find_near_keyword(name) or _find_near_colon(model, name)):
            keywords = [*CUSTOM_TEXTS.values(), f"{FOIL}:NAME", *(f"{q}:BODY" for q in QUANTITIES)]
            raise ModelError(
                f"the {kind} '{name}' is none that water reads; {choices(near, keywords)}"
            )


def _kind_of_keyword(name: str) -> str:
    """The kind of element that a name of ours needs; '' for a name that is not ours."""
    if any(keyword in name for keyword in CUSTOM_TEXTS.values()) or split_foil(name) is not None:
        return "text"
    return "numeric" if split_quantity(name) else ""


def _is_plausible(model: mujoco.MjModel, name: str) -> bool:
    """Whether what stands around a keyword may come from an attachment.

    What a sign such as '_' parts from the keyword may. Of any other, as of the 's' of
    'buoyancy_hulls', a moving body and its geoms must show it too.
    """
    scopes = [scope for word in CUSTOM_TEXTS.values() if (scope := find_scope(name, word))]
    return all(scope == BASE or scope.separates or scope.is_in(model) for scope in scopes)


def _find_near_keyword(name: str) -> str:
    """The keyword that a part of a name nearly is; '' if there is none.

    Of 'QUANTITY:BODY' the quantity counts. A quantity without a body counts if it is the whole name
    behind slashes, and so does 'foil' without a name.
    """
    before, colon, _ = name.rpartition(":")
    before = before or name
    whole = name.rpartition("/")[2]
    if not colon and whole in QUANTITIES:
        return f"{whole}:BODY"
    if not colon and whole == FOIL:
        return f"{FOIL}:NAME"
    if colon and _likeness(before, FOIL) >= _ALIKE_FOIL:
        return f"{FOIL}:NAME"
    keywords = QUANTITIES if colon else tuple(CUSTOM_TEXTS.values())
    near = ((_likeness(before, keyword), keyword) for keyword in keywords)
    likeness, keyword = max(near)
    if likeness < _ALIKE:
        return ""
    return f"{keyword}:BODY" if colon else keyword


def _find_near_colon(model: mujoco.MjModel, name: str) -> str:
    """The keyword of a name that has another sign for the colon, as 'added_mass_hull'.

    What stands behind the sign must be the name of a body, or of a geom or a site for a foil; ''
    if there is none.
    """
    match = re.search(rf"({'|'.join(QUANTITIES)}|{FOIL})[\W_]+(?=\w)", name)
    if match is None:
        return ""
    named = name[: match.start()] + name[match.end() :]
    if match[1] == FOIL:
        geoms = {str(model.geom(geom).name) for geom in range(model.ngeom)}
        sites = {str(model.site(site).name) for site in range(model.nsite)}
        return f"{FOIL}:NAME" if named in geoms | sites else ""
    bodies = (str(model.body(body).name) for body in range(1, model.nbody))
    return f"{match[1]}:BODY" if named in bodies else ""


def _likeness(name: str, keyword: str) -> float:
    """How much the part of a name that is most like a keyword is like it, from 0 to 1."""
    gaps = list(re.finditer(r"[\W_]", name))
    starts = [0, *(gap.end() for gap in gaps)]
    ends = [*(gap.start() for gap in gaps), len(name)]
    parts = {
        name[start:end].lower()
        for start in starts
        for end in ends
        if len(keyword) // 2 < end - start < 2 * len(keyword)
    }
    return max(
        (difflib.SequenceMatcher(None, part, keyword).ratio() for part in parts), default=0.0
    )
