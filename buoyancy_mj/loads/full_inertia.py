"""Room for added mass in MuJoCo's mass matrix, made before a model is compiled.

Where the centre of mass of a body is its origin, and its principal axes are its own, MuJoCo keeps
the diagonal of its inertia alone (`mjModel.body_simple`). Added mass has elements beside it, and so
has the inertia of a body whose centre of mass is shifted later.
"""

from collections.abc import Iterable, Mapping

import mujoco
from numpy.typing import ArrayLike

from buoyancy_mj.hulls.custom import split_quantity

QUANTITY = "added_mass"
"""Quantity of the model's numerics 'added_mass:BODY'."""
ESTIMATES = ("estimate", "mesh", "ellipsoid")
"""Ways to estimate the added mass of bodies for which the model states none."""


def keep_full_inertia(bodies: Iterable[mujoco.MjsBody]) -> None:
    """Have MuJoCo keep the whole inertia of bodies, as `<body simple="false">` does.

    Masses and inertias stay the same, and so does all motion, to round-off.
    """
    for body in bodies:
        body.simple = False


def make_room(spec: mujoco.MjSpec, source: str | Mapping[str, ArrayLike] | None) -> None:
    """Have MuJoCo keep the whole inertia of all bodies that move, if any may get added mass.

    Args:
        spec: the model, with its bodies.
        source: where added mass comes from, see `loads.added_mass.resolve_added_mass`.
    """
    if source == "model":
        splits = [split_quantity(numeric.name) for numeric in spec.numerics]
        has_any = any(split is not None and split[0] == QUANTITY for split in splits)
    else:
        has_any = len(source) > 0 if isinstance(source, Mapping) else source in ESTIMATES
    if has_any:
        # a body without joints may be attached with one
        world = spec.worldbody
        keep_full_inertia(b for b in spec.bodies[1:] if b.joints or b.parent == world)
