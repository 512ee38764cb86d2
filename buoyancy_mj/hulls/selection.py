"""Which geoms of a model displace water, and as what: the defaults, the vehicle's own choice, the user's."""

import dataclasses
import fnmatch
import math
from collections.abc import Sequence

import mujoco

from buoyancy_mj.errors import ModelError, choices

GEOMS, HULL, FILL = "buoyancy_geoms", "buoyancy_hull", "buoyancy_fill"
"""Names of the MJCF `<custom><text>` with which a vehicle chooses for itself."""
HULLS = ("mesh", "convex")
"""What a geom may displace as: its own mesh, or its convex hull."""
SOLIDS = tuple(
    int(getattr(mujoco.mjtGeom, f"mjGEOM_{name}"))
    for name in ("MESH", "BOX", "SPHERE", "ELLIPSOID", "CYLINDER", "CAPSULE")
)
"""Types of geoms that bound a volume."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Selection:
    """Which geoms of a model displace water, and as what.

    A pattern is a name glob such as 'hull*', or 'group:2'. Each field takes one text or several, and
    None leaves the choice to the model: to its `<custom>` texts 'buoyancy_geoms', 'buoyancy_hull' and
    'buoyancy_fill', or to the defaults.

    Example:
        `Selection(geoms=["hull*", "pod"], fill="frame=0.1")`
    """

    geoms: str | Sequence[str] | None = None
    """Which geoms displace water: patterns. By default the collision geoms of each body, or its visual ones if it has none."""
    hull: str | Sequence[str] | None = None
    """Which of them displace as their convex hull: 'PATTERN=convex', or 'convex' for all."""
    fill: str | Sequence[str] | None = None
    """Which of them flood, and the part of their volume that displaces: 'PATTERN=0.1'."""

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            if value is not None:
                words = (value,) if isinstance(value, str) else tuple(map(str, value))
                object.__setattr__(self, field.name, words)


@dataclasses.dataclass(frozen=True)
class Verdict:
    """A geom, and whether it displaces water."""

    geom: int
    """Its index in the model."""
    displaces: bool
    """Whether it does."""
    reason: str
    """Why, or why not."""


def judge_geoms(
    model: mujoco.MjModel,
    selection: Selection = Selection(),
    bodies: Sequence[int] | None = None,
) -> tuple[Verdict, ...]:
    """Judge every geom of a model: does it displace water, and why.

    The collision geoms of each moving body (contype or conaffinity not zero) displace water if it has
    any, otherwise its visual ones. `selection.geoms`, or the model's text 'buoyancy_geoms', chooses
    otherwise. Planes, height fields, signed distance fields and geoms that cannot move never displace.

    Args:
        model: any model.
        selection: the user's choice.
        bodies: indices of the bodies whose geoms may displace; None for all.

    Raises:
        ModelError: no geom is left, or a pattern matches none.
    """
    refused = {g: reason for g in range(model.ngeom) if (reason := _refusal(model, g, bodies))}
    solid = [g for g in range(model.ngeom) if g not in refused]
    words = _words(model, GEOMS, selection.geoms, "geoms")
    if words is not None:
        by = "chosen" if selection.geoms is not None else f"chosen by the model's '{GEOMS}'"
        chosen = {
            g: f"{by}: {word}" for word in reversed(words) for g in _matching(model, solid, word)
        }
        left = "not among those chosen"
    else:
        collides = {g: bool(model.geom_contype[g] or model.geom_conaffinity[g]) for g in solid}
        bodies_that_collide = {model.geom_bodyid[g] for g in solid if collides[g]}
        chosen = {g: "collision geom" for g in solid if collides[g]}
        chosen |= {
            g: "visual; its body has no collision geoms"
            for g in solid
            if _body(model, g) not in bodies_that_collide
        }
        left = "visual; its body has collision geoms"
    if not chosen:
        raise ModelError(
            "no geom of this model displaces water: it has no mesh, box, sphere, ellipsoid, capsule or cylinder "
            "on a body that can move; give the vehicle such a geom, and its body a joint"
        )
    return tuple(
        Verdict(g, g in chosen, chosen.get(g) or refused.get(g) or left) for g in range(model.ngeom)
    )


def parse_shapes(
    model: mujoco.MjModel, geoms: Sequence[int], hull: str | Sequence[str] | None
) -> dict[int, str]:
    """Of each of `geoms`, one of `HULLS`; by words 'PATTERN=convex', or 'convex' for all.

    Raises:
        ModelError: a word that makes no sense, or a pattern that matches none.
    """
    found: dict[int, str] = {}
    for word, value, matching in _assigned(model, geoms, HULL, hull, "hull"):
        if value not in HULLS:
            raise ModelError(f"hull '{word}' asks for '{value}'; {choices(value, HULLS)}")
        found |= dict.fromkeys(matching, value)
    return found


def parse_fills(
    model: mujoco.MjModel, geoms: Sequence[int], fill: str | Sequence[str] | None
) -> dict[int, float]:
    """Of those of `geoms` that are flooded, the part of their volume that displaces; by words 'PATTERN=0.1'.

    Raises:
        ModelError: a part that is not above 0 and at most 1, or a pattern that matches none.
    """
    found: dict[int, float] = {}
    for word, value, matching in _assigned(model, geoms, FILL, fill, "fill"):
        try:
            part = float(value)
        except ValueError:
            part = math.nan
        if not 0.0 < part <= 1.0:
            raise ModelError(
                f"fill '{word}' is no part of a volume: it must be above 0 and at most 1, as in 'frame=0.1'"
            )
        found |= dict.fromkeys(matching, part)
    return found


def geom_name(model: mujoco.MjModel, geom: int) -> str:
    """The geom's own name, or one made of its body, type and index."""
    name = model.geom(geom).name
    if name:
        return str(name)
    return f"{body_name(model, int(model.geom_bodyid[geom]))}/{geom_kind(model, geom)} {geom}"


def geom_kind(model: mujoco.MjModel, geom: int) -> str:
    """'mesh', 'box', 'sphere', ..."""
    return mujoco.mjtGeom(int(model.geom_type[geom])).name.removeprefix("mjGEOM_").lower()


def body_name(model: mujoco.MjModel, body: int) -> str:
    """The body's own name, or one made of its index."""
    return str(model.body(body).name) or f"body {body}"


def _refusal(model: mujoco.MjModel, geom: int, bodies: Sequence[int] | None) -> str:
    """Why a geom can never displace water; '' if it can."""
    if model.geom_type[geom] not in SOLIDS:
        return f"a {geom_kind(model, geom)} bounds no volume"
    if not model.body_weldid[_body(model, geom)]:
        return "its body cannot move"
    if bodies is not None and _body(model, geom) not in bodies:
        return "its body is not in this water"
    return ""


def _body(model: mujoco.MjModel, geom: int) -> int:
    return int(model.geom_bodyid[geom])


def _words(
    model: mujoco.MjModel, text: str, given: str | Sequence[str] | None, what: str
) -> list[str] | None:
    """The user's words, or the vehicle's own, or none."""
    if given is not None:
        words = [
            word
            for part in ([given] if isinstance(given, str) else given)
            for word in _split(str(part))
        ]
        if not words:
            raise ModelError(
                f"an empty choice of {what} displaces nothing; give name globs or group:N, or leave it out"
            )
        return words
    texts = [i for i in range(model.ntext) if _text_name(model, i).rsplit("/", 1)[-1] == text]
    data = [
        bytes(model.text_data[model.text_adr[i] :][: model.text_size[i]]).split(b"\0")[0].decode()
        for i in texts
    ]
    return [word for text in data for word in _split(text)] or None


def _split(text: str) -> list[str]:
    return text.replace(",", " ").split()


def _text_name(model: mujoco.MjModel, text: int) -> str:
    return mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_TEXT, text) or ""


def _assigned(
    model: mujoco.MjModel,
    geoms: Sequence[int],
    text: str,
    given: str | Sequence[str] | None,
    what: str,
) -> list[tuple[str, str, list[int]]]:
    """Words PATTERN=VALUE, their values, and those of `geoms` that match; a value alone is for all."""
    words = _words(model, text, given, what) or []
    pairs = [(word, *(word.rsplit("=", 1) if "=" in word else ("*", word))) for word in words]
    return [(word, value, _matching(model, geoms, pattern)) for word, pattern, value in pairs]


def _matching(model: mujoco.MjModel, geoms: Sequence[int], pattern: str) -> list[int]:
    """Those of `geoms` whose name matches a glob, or whose group is N of 'group:N'."""
    if pattern.startswith("group:"):
        found = [g for g in geoms if str(model.geom_group[g]) == pattern.removeprefix("group:")]
    else:
        found = [g for g in geoms if fnmatch.fnmatchcase(geom_name(model, g), pattern)]
    if not found:
        names = {geom_name(model, g) for g in geoms} | {
            f"group:{model.geom_group[g]}" for g in geoms
        }
        raise ModelError(f"no moving geom matches '{pattern}'; {choices(pattern, names)}")
    return found
