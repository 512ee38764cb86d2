"""`Vessel`: what floats together, as one rigid body on still water; and `Afloat`, its balance in one pose."""

import dataclasses
import functools
from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from buoyancy_mj.errors import ModelError, choices
from buoyancy_mj.hulls.geoms import find_hulls
from buoyancy_mj.hulls.hull import Hull
from buoyancy_mj.hulls.selection import body_name
from buoyancy_mj.kernels import clip, waterplane
from buoyancy_mj.kernels.multibody import downward_gravity
from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.sea.water import Water
from buoyancy_mj.submersion.exact import PackedHulls

_FREE = int(mujoco.mjtJoint.mjJNT_FREE)
PLAUSIBLE = 1e-4, 1e4
"""Displaced over own mass, fully under water, of anything real: a lead weight has 0.09, an airship in water 800."""


@dataclasses.dataclass(frozen=True, eq=False)
class Vessel:
    """A kinematic tree of a model that has hulls, its joints held where they are.

    Its axes are those of its root body, their origin is its centre of gravity.
    """

    model: mujoco.MjModel
    """The model."""
    qpos: NDArray[np.float64]
    """The coordinates at which its joints are held (nq,)."""
    root: int
    """Index of its root body."""
    water: Water
    """The sea; waves and current are left aside."""
    gravity: float
    """Downward acceleration [m/s^2]."""
    mass: float
    """Of all bodies of the tree [kg]."""
    inertia: NDArray[np.float64]
    """About the centre of gravity, in the vessel's axes (3, 3) [kg m^2]."""
    root_from_vessel: NDArray[np.float64]
    """Centre of gravity in the frame of the root body (3,) [m]."""
    position: NDArray[np.float64]
    """Where `qpos` has the centre of gravity (3,) [m], world frame."""
    rotation: NDArray[np.float64]
    """And how it turns the vessel: world_from_vessel (3, 3)."""
    names: tuple[str, ...]
    """Names of the hulls (h)."""
    bodies: tuple[int, ...]
    """Bodies of the hulls (h)."""
    solids: tuple[TriMesh, ...]
    """The hulls, each in a frame of its own."""
    places: NDArray[np.float64]
    """Origins of those frames in the vessel's axes (h, 3) [m]."""
    turns: NDArray[np.float64]
    """And their rotations, vessel_from_hull (h, 3, 3)."""
    fills: NDArray[np.float64]
    """Part of each hull's volume that displaces (h,)."""
    sites: dict[str, NDArray[np.float64]]
    """Named sites on it, each (3,) [m], in the vessel's axes."""

    @functools.cached_property
    def meshes(self) -> tuple[TriMesh, ...]:
        """The hulls, in the vessel's axes."""
        return tuple(
            solid.transformed(turn, place)
            for solid, turn, place in zip(self.solids, self.turns, self.places, strict=True)
        )

    @functools.cached_property
    def volume(self) -> float:
        """Volume of water displaced fully submerged [m^3]."""
        return float(self.fills @ [solid.volume for solid in self.solids])

    @functools.cached_property
    def centroid(self) -> NDArray[np.float64]:
        """Centre of buoyancy fully submerged, in the vessel's axes (3,) [m]."""
        shares = self.fills * [solid.volume for solid in self.solids]
        middles = [
            turn @ solid.centroid + place
            for solid, turn, place in zip(self.solids, self.turns, self.places, strict=True)
        ]
        return shares @ middles / self.volume

    @functools.cached_property
    def radius(self) -> float:
        """Distance of the farthest point of its hulls from the centre of gravity [m]."""
        return float(np.sqrt(np.square(self.points).sum(axis=1).max()))

    @functools.cached_property
    def points(self) -> NDArray[np.float64]:
        """Vertices of all hulls, in the vessel's axes (n, 3) [m]."""
        return np.vstack([mesh.compact[0] for mesh in self.meshes])

    @property
    def free(self) -> bool:
        """Whether its root has a free joint."""
        return _is_free(self.model, self.root)

    @property
    def weight(self) -> float:
        """Of all bodies [N]."""
        return self.mass * self.gravity

    def at(self, position: ArrayLike, rotation: ArrayLike) -> "Afloat":
        """The vessel with its centre of gravity at a place (3,) [m], turned by world_from_vessel (3, 3)."""
        origin, turn = np.asarray(position, float), np.ascontiguousarray(rotation, float)
        places, turns = origin + self.places @ turn.T, (turn @ self.turns).reshape(-1, 9)
        wet = self._packed.submerge(places, turns, 0.0)
        volumes = wet[:, clip.VOLUME]
        volume = float(volumes.sum())
        arm = np.zeros(3)
        if volume > 0.0:
            held = volumes > 0.0
            arm = volumes[held] @ (wet[held, clip.CENTROID] - origin) / volume
        cut = self._packed.waterplanes(places, turns, origin)
        lowest, highest = (
            cut[:, waterplane.LOWEST].min(axis=0),
            cut[:, waterplane.HIGHEST].max(axis=0),
        )
        extents = np.concatenate([lowest, highest])
        return Afloat(
            self,
            origin,
            turn,
            volume,
            arm,
            float(wet[:, clip.WETTED_AREA].sum()),
            cut[:, waterplane.INTEGRALS].sum(axis=0),
            extents,
        )

    def qpos_at(self, afloat: "Afloat") -> NDArray[np.float64]:
        """Coordinates of the model (nq,) that bring the vessel there.

        Raises:
            ModelError: its root has no free joint.
        """
        if not self.free:
            raise ModelError(
                f"body '{body_name(self.model, self.root)}' hangs on joints and is not free to float; give it a <freejoint/>"
            )
        joint = int(self.model.body_jntadr[self.root])
        qpos, start = self.qpos.copy(), int(self.model.jnt_qposadr[joint])
        qpos[start : start + 3] = afloat.position - afloat.rotation @ self.root_from_vessel
        qpos[start + 3 : start + 7] = Rotation.from_matrix(afloat.rotation).as_quat(
            scalar_first=True
        )
        return qpos

    @functools.cached_property
    def _packed(self) -> PackedHulls:
        level = Water(density=self.water.density, level=self.water.level)
        rows = np.arange(len(self.solids))
        return PackedHulls(self.solids, rows, rows, level, fills=self.fills)


@dataclasses.dataclass(frozen=True, eq=False)
class Afloat:
    """A vessel in one pose: what is wet of it, and the forces on it; about its centre of gravity, world axes."""

    vessel: Vessel
    """The vessel."""
    position: NDArray[np.float64]
    """Of its centre of gravity (3,) [m], world frame."""
    rotation: NDArray[np.float64]
    """world_from_vessel (3, 3)."""
    volume: float
    """Submerged volume [m^3]."""
    arm: NDArray[np.float64]
    """From the centre of gravity to the centre of buoyancy (3,) [m]; zero when dry."""
    wetted_area: float
    """Area under the surface [m^2]."""
    waterplane: NDArray[np.float64]
    """Integrals of 1, x, y, x x, x y, y y over the waterplane (6,), from the centre of gravity."""
    extents: NDArray[np.float64]
    """Lowest x, y and highest x, y of the waterline (4,) [m], from the centre of gravity; inf and -inf without one."""

    @property
    def energy(self) -> float:
        """Potential energy [J] of weight and buoyancy, from the level: `force` is minus its slope."""
        vessel, height = self.vessel, self.position[2] - self.vessel.water.level
        lift = vessel.water.density * vessel.gravity * self.volume
        return float(vessel.weight * height - lift * (height + self.arm[2]))

    @property
    def force(self) -> NDArray[np.float64]:
        """Upward force [N] and torques [N m] about x and y (3,): what drives heave, roll and pitch."""
        lift = self.vessel.water.density * self.vessel.gravity * self.volume
        return np.array([lift - self.vessel.weight, lift * self.arm[1], -lift * self.arm[0]])

    @property
    def stiffness(self) -> NDArray[np.float64]:
        """Restoring forces per heave [m] and turns about x and y [rad] (3, 3): minus the derivative of `force`.

        With u the displacement of the body, d/dt of the integral of f over what is wet is that of
        grad f . u, less f u_z over the waterplane (Reynolds' transport theorem); with f = 1, y, x that
        gives the matrix of Newman, Marine Hydrodynamics (1977), sec. 6.16, moments about the centre of gravity.
        """
        pressure = self.vessel.water.density * self.vessel.gravity
        a, ax, ay, axx, axy, ayy = self.waterplane
        lever = self.volume * self.arm[2]
        return pressure * np.array(
            [[a, ay, -ax], [ay, ayy + lever, -axy], [-ax, -axy, axx + lever]]
        )


def build_vessel(
    model: mujoco.MjModel,
    water: Water | None = None,
    qpos: ArrayLike | None = None,
    *,
    body: str | None = None,
    geoms: str | Sequence[str] | None = None,
    hull: str | Sequence[str] | None = None,
    fill: str | Sequence[str] | None = None,
) -> Vessel:
    """A vessel of a model.

    Args:
        model: any MuJoCo model with bodies that displace water.
        water: fresh and still at z = 0 if None; of waves only their still level counts.
        qpos: coordinates of the model (nq,), or of the root's free joint alone (7,); the model's own if None.
        body: name of the root body, where several float; None for the first that has hulls.
        geoms: which geoms displace water, see `Buoyancy`.
        hull: which of them as their convex hull, likewise.
        fill: and which displace in part, likewise.

    Raises:
        ModelError: coordinates of the wrong size or not finite, no such body, no mass, no gravity, gravity that is not
            along -z, no geom that displaces water.
        MeshError: a mesh that bounds no volume.
    """
    return build_vessel_from_hulls(
        model, find_hulls(model, geoms, hull=hull, fill=fill), water, qpos, body=body
    )


def build_vessel_from_hulls(
    model: mujoco.MjModel,
    hulls: Sequence[Hull],
    water: Water | None = None,
    qpos: ArrayLike | None = None,
    *,
    body: str | None = None,
) -> Vessel:
    """A vessel of a model, with these hulls; see `build_vessel`."""
    sea = water or Water()
    gravity = float(downward_gravity(model.opt.gravity, model.opt.disableflags))
    if not gravity > 0.0:
        x, y, z = model.opt.gravity
        raise ModelError(
            f"gravity is {x:g} {y:g} {z:g} or disabled; floating needs it along -z, "
            "as in gravity='0 0 -9.81'"
        )
    root = _root(model, [one.body for one in hulls], body)
    data = mujoco.MjData(model)
    data.qpos[:] = _coordinates(model, qpos, root)
    mujoco.mj_kinematics(model, data)
    tree = np.flatnonzero(model.body_rootid == root)
    masses = model.body_mass[tree]
    mass = float(masses.sum())
    if not mass > 0.0:
        raise ModelError(
            f"body '{body_name(model, root)}' and what hangs on it have a mass of {mass:g} kg; give them a mass"
        )
    # from here on in the axes of the root body
    turn = data.xmat[root].reshape(3, 3).T
    centres = (data.xipos[tree] - data.xpos[root]) @ turn.T
    centre = masses @ centres / mass
    inertia = np.zeros((3, 3))
    for b, m, c in zip(tree, masses, centres - centre, strict=True):
        axes = turn @ data.ximat[b].reshape(3, 3)
        inertia += axes * model.body_inertia[b] @ axes.T + m * (c @ c * np.eye(3) - np.outer(c, c))
    own = [one for one in hulls if model.body_rootid[one.body] == root]
    return Vessel(
        model=model,
        qpos=data.qpos.copy(),
        root=root,
        water=sea,
        gravity=gravity,
        mass=mass,
        inertia=inertia,
        root_from_vessel=centre,
        position=data.xpos[root] + turn.T @ centre,
        rotation=turn.T.copy(),
        names=tuple(one.name for one in own),
        bodies=tuple(one.body for one in own),
        solids=tuple(one.mesh for one in own),
        places=np.array(
            [turn @ (data.geom_xpos[one.geom] - data.xpos[root]) - centre for one in own]
        ),
        turns=np.array([turn @ data.geom_xmat[one.geom].reshape(3, 3) for one in own]),
        fills=np.array([one.fill for one in own]),
        sites={
            str(model.site(i).name): turn @ (data.site_xpos[i] - data.xpos[root]) - centre
            for i in range(model.nsite)
            if model.site(i).name and model.body_rootid[model.site_bodyid[i]] == root
        },
    )


def _root(model: mujoco.MjModel, bodies: Sequence[int], name: str | None) -> int:
    """The root body that floats."""
    roots = {
        body_name(model, int(model.body_rootid[body])): int(model.body_rootid[body])
        for body in bodies
    }
    if name is None:
        return next(iter(roots.values()))
    if name not in roots:
        raise ModelError(f"no body '{name}' floats in this model; {choices(name, roots)}")
    return roots[name]


def _coordinates(model: mujoco.MjModel, qpos: ArrayLike | None, root: int) -> NDArray[np.float64]:
    """All coordinates of the model."""
    if qpos is None:
        return model.qpos0.copy()
    given = np.asarray(qpos, float)
    joint, free = int(model.body_jntadr[root]), _is_free(model, root)
    if given.shape == (7,) and free and model.nq != 7:
        start, whole = int(model.jnt_qposadr[joint]), model.qpos0.copy()
        whole[start : start + 7] = given
        given = whole
    if given.shape != (model.nq,) or not np.isfinite(given).all():
        raise ModelError(
            f"qpos has shape {given.shape}; it must be {model.nq} finite coordinates of the model"
            + (", or position and quaternion (7,) of its free joint" if free else "")
        )
    return given


def _is_free(model: mujoco.MjModel, root: int) -> bool:
    joint = int(model.body_jntadr[root])
    return joint >= 0 and int(model.jnt_type[joint]) == _FREE
