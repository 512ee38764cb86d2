"""A verdict on each geom of a model: whether it displaces water, and why."""

import dataclasses
from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import ModelError
from buoyancy_mj.hulls.bodies import find_moving_bodies
from buoyancy_mj.hulls.names import geom_kind
from buoyancy_mj.hulls.patterns import match_geoms, read_words
from buoyancy_mj.hulls.selection import CUSTOM_TEXTS, Selection

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
    has any, otherwise its visual ones. `selection.geoms`, or the model's text 'buoyancy_geoms',
    chooses otherwise. Planes, height fields, signed distance fields and geoms that cannot move
    never displace.

    Args:
        model: any model.
        selection: the user's choice.
        bodies: indices of the bodies whose geoms may displace; None for all.

    Returns:
        One verdict for each geom, in the order of the model.

    Raises:
        ModelError: no geom is left, or a pattern matches none.
    """
    # some geoms can never displace water
    moving = find_moving_bodies(model)
    refusals = {
        g: reason for g in range(model.ngeom) if (reason := _refuse(model, g, moving, bodies))
    }
    candidates = [g for g in range(model.ngeom) if g not in refusals]

    # the others by the user's words, by the model's, or by their contacts
    words = read_words(model, selection, "geoms")
    if words is None:
        reasons = _choose_by_contacts(model, candidates)
        reason_left_out = "visual; its body has collision geoms"
    else:
        by = f"chosen by the model's '{CUSTOM_TEXTS['geoms']}'"
        reasons = _choose_by_words(
            model, candidates, words, by if selection.geoms is None else "chosen"
        )
        reason_left_out = "not among those chosen"
    if not reasons:
        raise ModelError(
            "no geom of this model displaces water: it has no mesh, box, sphere, ellipsoid, "
            "capsule or cylinder on a body that can move; "
            "give the vehicle such a geom, and its body a joint"
        )

    return tuple(
        Verdict(g, g in reasons, reasons.get(g) or refusals.get(g) or reason_left_out)
        for g in range(model.ngeom)
    )


def _refuse(
    model: mujoco.MjModel, geom: int, moving: NDArray[np.bool_], bodies: Sequence[int] | None
) -> str:
    """Why a geom can never displace water; '' if it can."""
    body = int(model.geom_bodyid[geom])
    if model.geom_type[geom] not in SOLID_TYPES:
        return f"a {geom_kind(model, geom)} bounds no volume"
    if not moving[body]:
        return "its body cannot move"
    if bodies is not None and body not in bodies:
        return "its body is not in this water"
    return ""


def _choose_by_words(
    model: mujoco.MjModel, geoms: Sequence[int], words: Sequence[str], by: str
) -> dict[int, str]:
    """The geoms that words match, and why; the first word that matches a geom is its reason."""
    return {g: f"{by}: {word}" for word in reversed(words) for g in match_geoms(model, geoms, word)}


def _choose_by_contacts(model: mujoco.MjModel, geoms: Sequence[int]) -> dict[int, str]:
    """The collision geoms of each body, or the visual ones of a body that has none; and why."""
    collides = {g for g in geoms if model.geom_contype[g] or model.geom_conaffinity[g]}
    bodies_that_collide = {int(model.geom_bodyid[g]) for g in collides}
    return {
        g: "collision geom" if g in collides else "visual; its body has no collision geoms"
        for g in geoms
        if g in collides or int(model.geom_bodyid[g]) not in bodies_that_collide
    }
