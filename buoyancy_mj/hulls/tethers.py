"""What keeps bodies that float together from floating freely: joints, welds, connects."""

from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.hulls.bodies import Bond, list_bonds
from buoyancy_mj.hulls.names import body_name


class Tether(NamedTuple):
    """What keeps a body from floating freely."""

    body: str
    """Name of the body."""
    how: str
    """What holds it, as what is said of the body."""
    mend: str
    """How to let it float."""


def list_roots(model: mujoco.MjModel, bodies: NDArray[np.int64]) -> list[int]:
    """Root bodies of the kinematic trees to which bodies belong, in the order of the model."""
    return [int(model.tree_bodyadr[tree]) for tree in np.unique(model.body_treeid[bodies])]


def has_free_joint(model: mujoco.MjModel, body: int) -> bool:
    """Whether the first joint of a body is a free joint."""
    joint = int(model.body_jntadr[body])
    return joint >= 0 and int(model.jnt_type[joint]) == int(mujoco.mjtJoint.mjJNT_FREE)


def find_tether(model: mujoco.MjModel, bodies: NDArray[np.int64]) -> Tether | None:
    """What keeps the bodies of a vessel from floating freely; None if nothing does.

    Args:
        model: their model.
        bodies: their indices.
    """
    for bond in list_bonds(model):
        fixed = [body for body in bond.bodies if model.body_treeid[body] < 0]
        held = [body for body in bond.bodies if body in bodies]
        if fixed and held:
            to = "the world" if fixed[0] == 0 else f"'{body_name(model, fixed[0])}'"
            return Tether(
                body=body_name(model, held[0]),
                how=f"is held to {to} by {_name_bond(model, bond) or 'a ' + _kind(model, bond)}",
                mend="leave that out, or set its active='false'",
            )
    for root in list_roots(model, bodies):
        if not has_free_joint(model, root):
            return Tether(body_name(model, root), "hangs on joints", "give it a <freejoint/>")
    return None


def list_springs(model: mujoco.MjModel, bodies: NDArray[np.int64]) -> list[str]:
    """What pulls at the bodies of a vessel from outside: tendons that are not slack, and springs.

    Args:
        model: their model.
        bodies: their indices.
    """
    pulls = [
        f"tendon '{model.tendon(tendon).name}'"
        for tendon in range(model.ntendon)
        if len(set(np.isin(_find_tendon_bodies(model, tendon), bodies).tolist())) == 2
        and (
            model.tendon_limited[tendon]
            or model.tendon_stiffness[tendon]
            or model.tendon_stiffnesspoly[tendon].any()
        )
    ]
    joints = [int(model.body_jntadr[root]) for root in list_roots(model, bodies)]
    return pulls + [
        f"the spring of joint '{model.joint(joint).name}'"
        for joint in joints
        if model.jnt_stiffness[joint] or model.jnt_stiffnesspoly[joint].any()
    ]


def _find_tendon_bodies(model: mujoco.MjModel, tendon: int) -> NDArray[np.int64]:
    """Bodies of the sites through which a tendon runs."""
    path = slice(
        int(model.tendon_adr[tendon]), int(model.tendon_adr[tendon] + model.tendon_num[tendon])
    )
    sites = model.wrap_objid[path][model.wrap_type[path] == mujoco.mjtWrap.mjWRAP_SITE]
    return np.asarray(model.site_bodyid[sites], np.int64)


def describe_bond(model: mujoco.MjModel, bond: Bond) -> str:
    """A weld or a connect by its kind and its name, or by its bodies."""
    one, other = (body_name(model, body) for body in bond.bodies)
    return _name_bond(model, bond) or f"the {_kind(model, bond)} of '{one}' to '{other}'"


def _name_bond(model: mujoco.MjModel, bond: Bond) -> str:
    """Kind and name of a weld or a connect; '' if it has no name."""
    name = str(model.equality(bond.equality).name)
    return f"{_kind(model, bond)} '{name}'" if name else ""


def _kind(model: mujoco.MjModel, bond: Bond) -> str:
    """'weld' or 'connect'."""
    is_weld = model.eq_type[bond.equality] == mujoco.mjtEq.mjEQ_WELD
    return "weld" if is_weld else "connect"
