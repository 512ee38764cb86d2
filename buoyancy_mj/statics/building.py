"""A `Vessel` from a model: its root body, its mass, its hulls, its sites."""

from collections.abc import Sequence
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import ModelError, choices
from buoyancy_mj.hulls.geoms import find_hulls
from buoyancy_mj.hulls.gravity import read_gravity
from buoyancy_mj.hulls.hull import Hull
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.hulls.selection import Selection
from buoyancy_mj.sea.water import Water
from buoyancy_mj.statics.vessel import Vessel, VesselHull, has_free_joint


def build_vessel(
    model: mujoco.MjModel,
    water: Water | None = None,
    qpos: ArrayLike | None = None,
    *,
    body: str | None = None,
    selection: Selection = Selection(),
) -> Vessel:
    """Build a vessel of a model.

    Args:
        model: any MuJoCo model with bodies that displace water.
        water: the sea, whose still level alone counts; fresh water with its level at z = 0 if None.
        qpos: coordinates of the model (nq,), or of the root's free joint alone (7,); `model.qpos0`
            if None.
        body: name of the root body, where several float; the first that has hulls if None.
        selection: which geoms displace water, and as what.

    Raises:
        ModelError: coordinates are of the wrong size or not finite, no such body floats, the body
            has no mass, there is no gravity or it is not along -z, or no geom displaces water.
        MeshError: a mesh bounds no volume.
    """
    return build_vessel_from_hulls(model, find_hulls(model, selection), water, qpos, body=body)


def build_vessel_from_hulls(
    model: mujoco.MjModel,
    hulls: Sequence[Hull],
    water: Water | None = None,
    qpos: ArrayLike | None = None,
    *,
    body: str | None = None,
) -> Vessel:
    """Build a vessel of a model with hulls at hand; see `build_vessel`."""
    gravity = read_gravity(model, required=True)
    root = _find_root(model, [hull.body for hull in hulls], body)

    # the model in the pose of its coordinates
    data = mujoco.MjData(model)
    data.qpos[:] = _complete_qpos(model, qpos, root)
    mujoco.mj_kinematics(model, data)

    frame = _Frame(data.xpos[root].copy(), data.xmat[root].reshape(3, 3).T.copy())
    mass, centre, inertia = _add_up_masses(model, data, root, frame)
    return Vessel(
        model=model,
        qpos=data.qpos.copy(),
        root=root,
        water=water or Water(),
        gravity=gravity,
        mass=mass,
        inertia=inertia,
        centre_of_gravity=centre,
        position=frame.origin + frame.root_from_world.T @ centre,
        rotation=frame.root_from_world.T.copy(),
        hulls=tuple(
            VesselHull(
                name=hull.name,
                mesh=hull.mesh,
                position=frame.express(data.geom_xpos[hull.geom]) - centre,
                rotation=frame.root_from_world @ data.geom_xmat[hull.geom].reshape(3, 3),
                fill=hull.fill,
            )
            for hull in hulls
            if model.body_rootid[hull.body] == root
        ),
        sites={
            str(model.site(i).name): frame.express(data.site_xpos[i]) - centre
            for i in range(model.nsite)
            if model.site(i).name and model.body_rootid[model.site_bodyid[i]] == root
        },
    )


class _Frame(NamedTuple):
    """The frame of the root body."""

    origin: NDArray[np.float64]
    """Its origin (3,) [m], world frame."""
    root_from_world: NDArray[np.float64]
    """Its rotation (3, 3)."""

    def express(self, point: NDArray[np.float64]) -> NDArray[np.float64]:
        """A point (3,) [m] of the world in this frame."""
        return np.asarray(self.root_from_world @ (point - self.origin), float)


def _find_root(model: mujoco.MjModel, bodies: Sequence[int], name: str | None) -> int:
    """Index of the root body of the named tree among those with hulls; of the first if None."""
    roots = {
        body_name(model, root): root
        for root in dict.fromkeys(int(model.body_rootid[body]) for body in bodies)
    }
    if name is None:
        return next(iter(roots.values()))
    if name not in roots:
        raise ModelError(f"no body '{name}' floats in this model; {choices(name, roots)}")
    return roots[name]


def _complete_qpos(model: mujoco.MjModel, qpos: ArrayLike | None, root: int) -> NDArray[np.float64]:
    """All coordinates of the model (nq,), from all of them or those of a free joint alone."""
    start: NDArray[np.float64] = model.qpos0.copy()
    if qpos is None:
        return start
    values = np.asarray(qpos, float)
    free = has_free_joint(model, root)

    # the free joint moves, the others stay where the model has them
    if values.shape == (7,) and free:
        address = int(model.jnt_qposadr[model.body_jntadr[root]])
        start[address : address + 7] = values
        values = start

    if values.shape != (model.nq,) or not np.isfinite(values).all():
        raise ModelError(
            f"qpos has shape {values.shape}; it must be {model.nq} finite coordinates of the model"
            + (", or position and quaternion (7,) of its free joint" if free else "")
        )
    return values


def _add_up_masses(
    model: mujoco.MjModel, data: mujoco.MjData, root: int, frame: _Frame
) -> tuple[float, NDArray[np.float64], NDArray[np.float64]]:
    """Mass [kg], centre of gravity (3,) [m] and inertia about it (3, 3) [kg m^2] of a tree.

    Centre and inertia are in the frame of the root body.
    """
    tree = np.flatnonzero(model.body_rootid == root)
    masses = model.body_mass[tree]
    mass = float(masses.sum())
    if not mass > 0.0:
        raise ModelError(
            f"body '{body_name(model, root)}' and what hangs on it have a mass of {mass:g} kg; "
            "give them a mass"
        )
    centres = (data.xipos[tree] - frame.origin) @ frame.root_from_world.T
    centre = masses @ centres / mass

    # each body's own inertia, moved to the common centre (Steiner)
    inertia = np.zeros((3, 3))
    for body, m, arm in zip(tree, masses, centres - centre, strict=True):
        axes = frame.root_from_world @ data.ximat[body].reshape(3, 3)
        inertia += axes * model.body_inertia[body] @ axes.T + m * steiner(arm)
    return mass, centre, inertia


def steiner(arm: NDArray[np.float64]) -> NDArray[np.float64]:
    """Inertia per mass (3, 3) [m^2] of a point at `arm` (3,) [m] about the origin (Steiner)."""
    return np.asarray(arm @ arm * np.eye(3) - np.outer(arm, arm), float)
