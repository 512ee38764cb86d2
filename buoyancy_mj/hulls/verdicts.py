"""A verdict on each geom of a model: whether it displaces water, and why."""

import dataclasses
import warnings
from collections.abc import Collection, Iterable, Mapping, Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import BuoyancyWarning, ModelError, describe
from buoyancy_mj.hulls.bodies import find_moving_bodies
from buoyancy_mj.hulls.names import body_name, geom_kind
from buoyancy_mj.hulls.patterns import Pool, pool_of_file, pool_of_model
from buoyancy_mj.hulls.selection import Selection
from buoyancy_mj.hulls.statements import check_statements
from buoyancy_mj.hulls.words import FileWords, check_custom_names, read_file_words

SOLID_TYPES = tuple(
    int(getattr(mujoco.mjtGeom, f"mjGEOM_{name}"))
    for name in ("MESH", "BOX", "SPHERE", "ELLIPSOID", "CYLINDER", "CAPSULE")
)
"""Types of geoms that bound a volume."""


@dataclasses.dataclass(frozen=True)
class Verdict:
    """A geom, and whether it displaces water."""

    geom: int
    """Its index in the model."""
    displaces: bool
    """Whether it displaces water."""
    reason: str
    """Why, or why not."""


def judge_geoms(
    model: mujoco.MjModel,
    selection: Selection = Selection(),
    bodies: Sequence[int] | None = None,
) -> tuple[Verdict, ...]:
    """Judge every geom of a model: does it displace water, and why.

    The collision geoms of each moving body (contype or conaffinity not zero) displace water if it
    has any, otherwise its visual ones. `selection.geoms` chooses otherwise for the whole model, and
    a file's text 'buoyancy_geoms' for what came from that file. Planes, height fields, signed
    distance fields and geoms that cannot move never displace.

    A moving body that the choice of a file leaves out is told as a `BuoyancyWarning`.

    Args:
        model: any model.
        selection: the user's choice.
        bodies: indices of the bodies whose geoms may displace; None for all.

    Returns:
        One verdict for each geom, in the order of the model.

    Raises:
        ModelError: no geom is left, or a pattern or anything else in `<custom>` finds nothing to
            hold for.
    """
    check_model(model)
    if not isinstance(selection, Selection):
        raise ModelError(
            f"selection is {describe(selection)}; "
            "it must be Selection(geoms=..., hull=..., fill=...)"
        )
    check_custom_names(model)

    # some geoms can never displace water, others do not displace this one
    moving = find_moving_bodies(model)
    refusals = {g: why for g in range(model.ngeom) if (why := _refuse(model, g, moving))}
    outside = {
        g: "its body is not in this water"
        for g in range(model.ngeom)
        if g not in refusals and bodies is not None and model.geom_bodyid[g] not in bodies
    }

    # the others by the user's words, by those of their files, or by their contacts
    words = read_file_words(model)
    candidates = [g for g in range(model.ngeom) if g not in refusals]
    if selection.geoms is not None:
        pool = pool_of_model(model, refusals | outside)
        default = _choose_by_contacts(model, candidates)
        reasons = _choose_by_words(pool, selection.geoms, "chosen", default)
        check_statements(model, words, selection, candidates, refusals)
    else:
        reasons = _choose_by_files(model, words, candidates, refusals)
        check_statements(model, words, selection, list(reasons), refusals)
        _tell_left_out(model, words, set(candidates) - outside.keys(), reasons)

    # in this water
    reasons = {g: reason for g, reason in reasons.items() if g not in outside}
    if not reasons:
        raise _nothing_displaces(candidates, outside)
    left_out = _explain_left_out(words, selection, candidates)
    return tuple(
        Verdict(g, g in reasons, reasons.get(g) or (refusals | outside | left_out)[g])
        for g in range(model.ngeom)
    )


def check_model(model: mujoco.MjModel) -> None:
    """Refuse what is no compiled model, such as a path or a spec.

    Raises:
        ModelError: it is none.
    """
    if not isinstance(model, mujoco.MjModel):
        raise ModelError(
            f"model is {describe(model)}; it must be an MjModel, as "
            "mujoco.MjModel.from_xml_path('my_auv.xml') or spec.compile() gives it"
        )


def _nothing_displaces(candidates: Collection[int], outside: Collection[int]) -> ModelError:
    """The error of a water without a geom."""
    if not candidates:
        return ModelError(
            "no geom of this model displaces water: it has no mesh, box, sphere, ellipsoid, "
            "capsule or cylinder on a body that can move; "
            "give the vehicle such a geom, and its body a joint"
        )
    if len(outside) == len(candidates):
        return ModelError(
            "no geom of the bodies in this water displaces it: none of them can move and has a "
            "mesh, box, sphere, ellipsoid, capsule or cylinder; let other bodies join this water"
        )
    return ModelError(
        "no geom of this model displaces water: the words that choose geoms leave out all; "
        "name one of them"
    )


def _refuse(model: mujoco.MjModel, geom: int, moving: NDArray[np.bool_]) -> str:
    """Why a geom can never displace water; '' if it can."""
    if model.geom_type[geom] not in SOLID_TYPES:
        return f"a {geom_kind(model, geom)} bounds no volume"
    return "" if moving[model.geom_bodyid[geom]] else "its body cannot move"


def _choose_by_words(
    pool: Pool, words: Collection[str], by: str, default: Mapping[int, str]
) -> dict[int, str]:
    """The geoms that words match, and why; the first word that matches a geom is its reason.

    A word '!PATTERN' takes geoms out again, whatever its place; out of the default choice if there
    are no other words.
    """
    chosen: dict[int, str] = {}
    if all(word.startswith("!") for word in words):
        chosen = {g: reason for g, reason in default.items() if g in pool.names}
    left_out: set[int] = set()
    for word in words:
        if word.startswith("!"):
            left_out.update(pool.match(word[1:]))
        else:
            chosen = dict.fromkeys(pool.match(word), f"{by}: {word}") | chosen
    return {g: reason for g, reason in chosen.items() if g not in left_out}


def _choose_by_files(
    model: mujoco.MjModel,
    words: FileWords,
    candidates: Sequence[int],
    refusals: Mapping[int, str],
) -> dict[int, str]:
    """The geoms that each file chooses of its own, or contacts where it is silent; and why."""
    default = reasons = _choose_by_contacts(model, candidates)
    for choice in words.of_field("geoms"):
        pool = pool_of_file(model, words, choice, refusals)
        by = f"chosen by the model's '{choice.name}'"
        chosen = _choose_by_words(pool, choice.words, by, default)
        reasons = {g: reason for g, reason in reasons.items() if g not in pool.names} | chosen
    return reasons


def _choose_by_contacts(model: mujoco.MjModel, geoms: Iterable[int]) -> dict[int, str]:
    """The collision geoms of each body, or the visual ones of a body that has none; and why."""
    collides = {g for g in geoms if model.geom_contype[g] or model.geom_conaffinity[g]}
    bodies_that_collide = {int(model.geom_bodyid[g]) for g in collides}
    return {
        g: "collision geom" if g in collides else "visual; its body has no collision geoms"
        for g in geoms
        if g in collides or int(model.geom_bodyid[g]) not in bodies_that_collide
    }


def _explain_left_out(
    words: FileWords, selection: Selection, candidates: Iterable[int]
) -> dict[int, str]:
    """Why a geom displaces nothing that could."""
    not_chosen = "not among those chosen"
    if selection.geoms is not None:
        return dict.fromkeys(candidates, not_chosen)
    left_out = dict.fromkeys(candidates, "visual; its body has collision geoms")
    for choice in words.of_field("geoms"):
        left_out |= dict.fromkeys(words.find_geoms(choice.scope), not_chosen)
    return left_out


def _tell_left_out(
    model: mujoco.MjModel, words: FileWords, candidates: set[int], reasons: Mapping[int, str]
) -> None:
    """Tell of moving bodies that displace nothing because a file's choice does not name them."""
    afloat = {int(model.body_weldid[model.geom_bodyid[g]]) for g in reasons}
    for choice in words.of_field("geoms"):
        pool = pool_of_file(model, words, choice, {})
        unnamed = [
            g
            for g in pool.names
            if g in candidates
            and not any(w[0] == "!" and pool.matches(g, w[1:]) for w in choice.words)
        ]
        bodies = {int(model.body_weldid[model.geom_bodyid[g]]) for g in unnamed} - afloat
        if bodies:
            names = ", ".join(f"'{body_name(model, body)}'" for body in sorted(bodies))
            warnings.warn(
                f"'{choice.name}' names no geom of {names}, which would displace water without it: "
                "name their geoms there, with '!' before them if they shall displace nothing, or "
                "attach them under a prefix that ends in '/' if they come from another file",
                BuoyancyWarning,
                stacklevel=4,
            )
