"""A `Vessel` from a model: its bodies, its mass, its hulls, its sites."""

import math
import warnings
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import BuoyancyWarning, ModelError, choices, describe
from buoyancy_mj.hulls.bodies import group_floating_bodies
from buoyancy_mj.hulls.geoms import find_hulls
from buoyancy_mj.hulls.gravity import find_weighing_masses, read_gravity
from buoyancy_mj.hulls.hull import Hull
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.hulls.selection import Selection
from buoyancy_mj.hulls.tethers import describe_bond, find_tether, has_free_joint, list_roots
from buoyancy_mj.sea.water import Water
from buoyancy_mj.statics.filling import fill_vessel
from buoyancy_mj.statics.joined_trees import find_open_bond, join_trees, locate_trees
from buoyancy_mj.statics.vessel import Vessel, VesselHull
from buoyancy_mj.statics.weights import steiner

_NEGLIGIBLE = 1e-9
"""Part of the mass of a vessel, and of its size, below which a weight or its moment is rounding."""
_WORTH_TELLING = 1e-3
"""How far a weld must bring a body from where the model draws it to be told of [m, rad]."""


def build_vessel(
    model: mujoco.MjModel,
    water: Water | None = None,
    qpos: ArrayLike | None = None,
    *,
    body: str | None = None,
    selection: Selection = Selection(),
    ballast: Mapping[str, float] | ArrayLike | None = None,
) -> Vessel:
    """Build a vessel of a model: what floats together, by its joints, welds and connects.

    Args:
        model: any MuJoCo model with bodies that displace water.
        water: the sea, whose still level alone counts; fresh water with its level at z = 0 if None.
        qpos: coordinates of the model (nq,), or of the root's free joint alone (7,); `model.qpos0`
            if None.
        body: name of a root body, where several float; the first that floats freely and has hulls
            if None. Of a vessel of several trees it may be the root of any.
        selection: which geoms displace water, and as what.
        ballast: what tanks, compartments and bladders hold: volumes [m^3] by name, or the states of
            actuators (na,), as `data.act`; None for empty.

    Raises:
        ModelError: coordinates are of the wrong size or not finite, no such body floats, the body
            has no mass, its welds contradict each other, gravity compensation turns it, there is
            no gravity or it is not along -z, or no geom displaces water.
        MeshError: a mesh bounds no volume.
    """
    hulls = find_hulls(model, selection)
    return build_vessel_from_hulls(model, hulls, water, qpos, body=body, ballast=ballast)


def build_vessel_from_hulls(
    model: mujoco.MjModel,
    hulls: Sequence[Hull],
    water: Water | None = None,
    qpos: ArrayLike | None = None,
    *,
    body: str | None = None,
    ballast: Mapping[str, float] | ArrayLike | None = None,
) -> Vessel:
    """Build a vessel of a model with hulls at hand; see `build_vessel`."""
    if not isinstance(water, Water | None):
        raise ModelError(f"water is {describe(water)}; it must be a Water, as Water(density=1025)")
    gravity = read_gravity(model, required=True)
    bodies, root = _find_vessel(model, [hull.body for hull in hulls], body)
    tether = find_tether(model, bodies)
    coordinates, pose = _read_qpos(model, qpos, root)

    # the model in the pose of its coordinates, and in the shape that its welds demand
    data = mujoco.MjData(model)
    data.qpos[:] = coordinates
    freedoms = 0 if tether is not None else _join_trees(model, data, bodies, root)
    mujoco.mj_kinematics(model, data)

    frame = _Frame(data.xpos[root].copy(), data.xmat[root].reshape(3, 3).T.copy())
    masses = _add_up_masses(model, data, bodies, frame)
    vessel = Vessel(
        model=model,
        qpos=data.qpos.copy(),
        root=root,
        bodies=bodies,
        trees=locate_trees(model, data, bodies, root),
        freedoms=freedoms,
        tether=tether,
        water=water or Water(),
        gravity=gravity,
        mass=masses.weighing,
        carried_mass=masses.whole - masses.weighing,
        inertia=masses.inertia,
        centre_of_mass=masses.centre_of_mass - masses.centre_of_gravity,
        centre_of_gravity=masses.centre_of_gravity,
        position=frame.origin + frame.root_from_world.T @ masses.centre_of_gravity,
        rotation=frame.root_from_world.T.copy(),
        hulls=tuple(
            VesselHull(
                name=hull.name,
                mesh=hull.mesh,
                position=frame.express(data.geom_xpos[hull.geom]) - masses.centre_of_gravity,
                rotation=frame.root_from_world @ data.geom_xmat[hull.geom].reshape(3, 3),
                fill=hull.fill,
            )
            for hull in hulls
            if hull.body in bodies
        ),
        sites={
            str(model.site(i).name): frame.express(data.site_xpos[i]) - masses.centre_of_gravity
            for i in range(model.nsite)
            if model.site(i).name and model.site_bodyid[i] in bodies
        },
    )
    filled = fill_vessel(vessel, data, frame.origin, frame.root_from_world, ballast)
    return filled if pose is None else _move_root(filled, pose)


class _Frame(NamedTuple):
    """The frame of the root body."""

    origin: NDArray[np.float64]
    """Its origin (3,) [m], world frame."""
    root_from_world: NDArray[np.float64]
    """Its rotation (3, 3)."""

    def express(self, point: NDArray[np.float64]) -> NDArray[np.float64]:
        """A point (3,) [m] of the world in this frame."""
        return np.asarray(self.root_from_world @ (point - self.origin), float)


class _Masses(NamedTuple):
    """Masses of a vessel, in the frame of its root body."""

    whole: float
    """Mass of all bodies [kg]."""
    weighing: float
    """Mass of all bodies, less what gravity compensation carries [kg]."""
    centre_of_mass: NDArray[np.float64]
    """Centre of mass (3,) [m]."""
    centre_of_gravity: NDArray[np.float64]
    """Point through which the weight acts (3,) [m]; of what weighs nothing, the centre of mass."""
    inertia: NDArray[np.float64]
    """Inertia about the centre of mass (3, 3) [kg m^2]."""


def _find_vessel(
    model: mujoco.MjModel, with_hulls: Sequence[int], name: str | None
) -> tuple[NDArray[np.int64], int]:
    """Bodies of a vessel and its root, by the name of one of its roots.

    If that is None, it is the first that floats freely, as a crane on a pier does not; the first of
    all where none does.
    """
    vessels = [
        bodies for bodies in group_floating_bodies(model) if np.isin(with_hulls, bodies).any()
    ]
    roots = {
        body_name(model, root): (bodies, root)
        for bodies in vessels
        for root in list_roots(model, bodies)
    }
    if name is None:
        free = [bodies for bodies in vessels if find_tether(model, bodies) is None]
        first = (free or vessels)[0]
        own = [body for body in with_hulls if body in first]
        name = body_name(model, list_roots(model, np.array(own))[0])
    if name not in roots:
        raise ModelError(f"no body '{name}' floats in this model; {choices(name, roots)}")
    return roots[name]


def _read_qpos(
    model: mujoco.MjModel, qpos: ArrayLike | None, root: int
) -> tuple[NDArray[np.float64], NDArray[np.float64] | None]:
    """Coordinates of the model (nq,), and the pose (7,) of the root's free joint if given alone."""
    if qpos is None:
        return model.qpos0.copy(), None
    try:
        values = np.asarray(qpos, float)
    except (TypeError, ValueError):
        values = np.full((), np.nan)
    free = has_free_joint(model, root)
    alone = free and values.shape == (7,)
    if not (alone or values.shape == (model.nq,)) or not np.isfinite(values).all():
        given = f"has shape {values.shape}" if values.ndim else f"is {describe(qpos)}"
        raise ModelError(
            f"qpos {given}; it must be {model.nq} finite coordinates of the model"
            + (", or position and quaternion (7,) of its free joint" if free else "")
        )
    return (model.qpos0.copy(), values) if alone else (values.copy(), None)


def _move_root(vessel: Vessel, pose: NDArray[np.float64]) -> Vessel:
    """A copy of a vessel, its root body moved to position and quaternion (7,)."""
    quaternion, matrix = pose[3:].copy(), np.empty(9)
    mujoco.mju_normalize4(quaternion)
    mujoco.mju_quat2Mat(matrix, quaternion)
    rotation = matrix.reshape(3, 3)
    position = pose[:3] + rotation @ vessel.centre_of_gravity
    return vessel.moved_to(position, rotation)


def _join_trees(
    model: mujoco.MjModel, data: mujoco.MjData, bodies: NDArray[np.int64], root: int
) -> int:
    """Bring data into the shape that welds and connects demand, and tell of what that means.

    Returns:
        The number of ways in which they leave the trees free to move against each other.
    """
    joining = join_trees(model, data, bodies, root)
    for move in joining.moves:
        if move.distance > _WORTH_TELLING or move.angle > _WORTH_TELLING:
            warnings.warn(
                f"welds and connects hold body '{body_name(model, move.root)}' "
                f"{round(move.distance, 6):.3g} m and {round(math.degrees(move.angle), 3):.3g} "
                f"degrees from where the model draws it beside '{body_name(model, root)}'; "
                "statics take it where they hold it",
                BuoyancyWarning,
                stacklevel=4,
            )

    found = find_open_bond(model, data, bodies)
    if found is not None:
        bond, gap = found
        warnings.warn(
            f"{describe_bond(model, bond)} is open by {gap:.3g} m or rad at these joint angles, "
            "and statics hold the joints as they are; give angles at which it closes",
            BuoyancyWarning,
            stacklevel=4,
        )
    return joining.freedoms


def _add_up_masses(
    model: mujoco.MjModel, data: mujoco.MjData, bodies: NDArray[np.int64], frame: _Frame
) -> _Masses:
    """Add up the masses of bodies, and what of them weighs."""
    masses = model.body_mass[bodies]
    mass = float(masses.sum())
    if not mass > 0.0:
        raise ModelError(
            f"body '{body_name(model, int(bodies[0]))}' and what hangs on it have a mass of "
            f"{mass:g} kg; give them a mass"
        )
    centres = (data.xipos[bodies] - frame.origin) @ frame.root_from_world.T
    centre = masses @ centres / mass

    # each body's own inertia, moved to the common centre (Steiner)
    inertia = np.zeros((3, 3))
    for body, m, arm in zip(bodies, masses, centres - centre, strict=True):
        axes = frame.root_from_world @ data.ximat[body].reshape(3, 3)
        inertia += axes * model.body_inertia[body] @ axes.T + m * steiner(arm)

    # what weighs
    weighing = find_weighing_masses(model)[bodies]
    moment = weighing @ (centres - centre)
    weight = float(weighing.sum())
    if abs(weight) > _NEGLIGIBLE * mass:
        return _Masses(mass, weight, centre, centre + moment / weight, inertia)
    if np.linalg.norm(moment) > _NEGLIGIBLE * mass * np.linalg.norm(centres - centre, axis=1).max():
        raise ModelError(
            f"gravity compensation leaves '{body_name(model, int(bodies[0]))}' no weight but a "
            f"turning moment of {np.linalg.norm(moment):.3g} kg m, so that it has no centre of "
            "gravity; correct gravcomp of its bodies"
        )
    return _Masses(mass, 0.0, centre, centre.copy(), inertia)
