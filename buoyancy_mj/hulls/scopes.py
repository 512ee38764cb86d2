"""Scopes: which geoms and bodies of a joined model came from which file, and their names there.

MuJoCo puts a prefix and a suffix around all names of a file that it attaches, those of `<custom>`
among them. So the name of a text, 'rov1_buoyancy_geoms', tells by what names its file goes:
'rov1_...'. What has the name of no attached file belongs to the base.
"""

import dataclasses
from collections.abc import Iterable, Sequence

import mujoco

from buoyancy_mj.hulls.bodies import find_moving_bodies
from buoyancy_mj.hulls.names import body_name, unnamed_geom
from buoyancy_mj.hulls.replicas import find_originals


@dataclasses.dataclass(frozen=True)
class Scope:
    """What came from one file: everything whose name has a prefix and a suffix."""

    prefix: str = ""
    """What stands before each name of the file."""
    suffix: str = ""
    """What stands behind it."""

    def has(self, name: str) -> bool:
        """Whether a name is one of the file's."""
        affixed = name.startswith(self.prefix) and name.endswith(self.suffix)
        return affixed and len(name) >= self.length

    def own_name(self, name: str) -> str:
        """A name of the file's as the file itself has it."""
        return name[len(self.prefix) : len(name) - len(self.suffix)]

    @property
    def length(self) -> int:
        """Length of the prefix and the suffix; the longer, the closer to what they are around."""
        return len(self.prefix) + len(self.suffix)

    @property
    def separates(self) -> bool:
        """Whether signs such as '_', '-' or '/' part its prefix and its suffix from the names.

        Otherwise other names may have them by chance.
        """
        return not (self == BASE or self.prefix[-1:].isalnum() or self.suffix[:1].isalnum())

    def is_in(self, model: mujoco.MjModel) -> bool:
        """Whether a moving body has all its names in this scope."""
        for body in find_moving_bodies(model).nonzero()[0]:
            names = [str(model.body(body).name), *_names_in_body(model, int(body))]
            names = [name for name in names if name]
            if names and all(map(self.has, names)):
                return True
        return False


BASE = Scope()
"""The file that others were attached to."""


def find_scope(name: str, keyword: str) -> Scope | None:
    """The scope of a name that holds a keyword, by what stands around it; None if it does not."""
    before, found, after = name.rpartition(keyword)
    return Scope(before, after) if found else None


def explain_missing(scope: Scope) -> str:
    """The tail of a message on a word that finds nothing: what helps in an attached file."""
    if scope == BASE:
        return ""
    return "; if only a part of its file was attached, delete the word from the spec before that"


def find_slash_scopes(model: mujoco.MjModel, scopes: Iterable[Scope]) -> set[Scope]:
    """Scopes of prefixes that end in a slash, 'environment/', which names of moving bodies have.

    A slash tells of an attached file even where that file states nothing. An unnamed body goes by
    its geoms.

    Args:
        model: any model.
        scopes: those that state anything; a slash in their suffixes is no prefix.
    """
    names = []
    for body in find_moving_bodies(model).nonzero()[0]:
        name = str(model.body(body).name)
        names += [name] if name else _names_in_body(model, int(body))
    known = {BASE, *scopes}
    stems = [name.removesuffix(_find_owner([name], known).suffix) for name in names]
    return {Scope(stem[: stem.rindex("/") + 1]) for stem in stems if "/" in stem}


@dataclasses.dataclass(frozen=True)
class Belongings:
    """The scope of each geom of a model, and the names by which its file calls it."""

    scopes: tuple[Scope, ...]
    """By the index of the geom."""
    names: tuple[tuple[str, ...], ...]
    """By the index of the geom. A copy that `<replicate>` made has its original's name too."""


def assign_geoms(model: mujoco.MjModel, scopes: Iterable[Scope]) -> Belongings:
    """Find the scope of each geom, and its names there.

    The longest prefix and suffix win. An unnamed geom belongs to its body's scope; an unnamed body
    to that of its geoms and joints, or to that of its parent.

    Args:
        model: any model.
        scopes: all scopes but the base.
    """
    possible = {BASE, *scopes}

    # the bodies, parents first
    body_names = [str(model.body(body).name) for body in range(model.nbody)]
    copies = find_originals(body_names)
    body_scopes = [BASE]
    for body in range(1, model.nbody):
        name = body_names[body]
        signs = [name, *copies[name]] if name else _names_in_body(model, body)[:1]
        parent = body_scopes[model.body_parentid[body]]
        body_scopes.append(_find_owner(signs, possible) if signs else parent)

    # the geoms, which may begin or end like another file's by chance where no sign parts the names
    geom_names = [str(model.geom(geom).name) for geom in range(model.ngeom)]
    copies = find_originals(geom_names)
    sure = {scope for scope in possible if scope == BASE or scope.separates}
    geom_scopes = [
        _find_owner([name, *copies[name]], sure | {own}) if name else own
        for name, own in zip(
            geom_names, (body_scopes[body] for body in model.geom_bodyid), strict=True
        )
    ]

    # their names there
    own_bodies = _find_own_names(body_names, body_scopes)
    own_geoms = _find_own_names(geom_names, geom_scopes)
    for geom, body in enumerate(model.geom_bodyid):
        if not geom_names[geom]:
            # the file knows an unnamed body by another index, unless it is the base
            fallback = body_name(model, body) if body_scopes[body] == BASE else "body ?"
            bodies = own_bodies[body] or [body_names[body] or fallback]
            own_geoms[geom] = [f"{own}/{unnamed_geom(model, geom)}" for own in bodies]
    return Belongings(tuple(geom_scopes), tuple(map(tuple, own_geoms)))


def _find_owner(names: Sequence[str], scopes: Iterable[Scope]) -> Scope:
    """The scope with the longest prefix and suffix that one of the names has."""
    owners = [scope for scope in scopes if any(map(scope.has, names))]
    return max(owners, key=lambda scope: (scope.length, scope.prefix))


def _names_in_body(model: mujoco.MjModel, body: int) -> list[str]:
    """The names of the geoms and joints of a body."""
    kinds = (
        (model.geom, model.body_geomadr[body], model.body_geomnum[body]),
        (model.joint, model.body_jntadr[body], model.body_jntnum[body]),
    )
    names = [str(get(first + i).name) for get, first, count in kinds for i in range(count)]
    return [name for name in names if name]


def _find_own_names(names: Sequence[str], scopes: Sequence[Scope]) -> list[list[str]]:
    """What the scope of each name calls it, and the originals of which it may be a copy."""
    copies = find_originals(names)
    stripped = [
        [scope.own_name(full) for full in (name, *copies.get(name, ())) if scope.has(full)]
        for name, scope in zip(names, scopes, strict=True)
    ]
    inside = {
        scope: find_originals(
            own
            for group, other in zip(stripped, scopes, strict=True)
            if other == scope
            for own in group
        )
        for scope in set(scopes)
    }
    return [
        list(dict.fromkeys(n for own in group for n in (own, *inside[scope].get(own, ()))))
        for group, scope in zip(stripped, scopes, strict=True)
    ]
