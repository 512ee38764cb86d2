"""`Vessel`: a kinematic tree with hulls, as one rigid body, its joints held."""

import dataclasses
import fnmatch
import functools
from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from buoyancy_mj.errors import ModelError, choices
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.sea.water import Water
from buoyancy_mj.submersion.exact import PackedHulls
from buoyancy_mj.submersion.hull_set import HullSet

PLAUSIBLE = 1e-4, 1e4
"""Least and greatest plausible mass of displaced water over mass, fully submerged.

A lead weight has 0.09, an airship in water 800."""


@dataclasses.dataclass(frozen=True, eq=False)
class VesselHull:
    """A hull, fixed to a vessel."""

    name: str
    """Name of the hull."""
    mesh: TriMesh
    """Mesh in the frame of the hull."""
    position: NDArray[np.float64]
    """Origin of the hull's frame in the vessel's axes (3,) [m]."""
    rotation: NDArray[np.float64]
    """vessel_from_hull (3, 3)."""
    fill: float
    """Part of the mesh's volume that displaces water."""

    @property
    def displaced_volume(self) -> float:
        """Volume of water that the hull displaces fully submerged [m^3]."""
        return self.fill * self.mesh.volume

    @property
    def centroid(self) -> NDArray[np.float64]:
        """Centroid of the hull's volume, in the vessel's axes (3,) [m]."""
        return np.asarray(self.rotation @ self.mesh.centroid + self.position, float)


@dataclasses.dataclass(frozen=True, eq=False)
class Vessel:
    """A kinematic tree of a model that has hulls, as one rigid body: its joints are held.

    The vessel's axes are those of its root body, their origin is its centre of gravity.
    """

    model: mujoco.MjModel
    """The model."""
    qpos: NDArray[np.float64]
    """Coordinates of the model (nq,) that hold the joints."""
    root: int
    """Index of the root body."""
    water: Water
    """The sea; statics use its density and its still level alone."""
    gravity: float
    """Downward acceleration [m/s^2]."""
    mass: float
    """Mass of all bodies of the tree [kg]."""
    inertia: NDArray[np.float64]
    """Inertia about the centre of gravity, in the vessel's axes (3, 3) [kg m^2]."""
    centre_of_gravity: NDArray[np.float64]
    """Centre of gravity in the frame of the root body (3,) [m]."""
    position: NDArray[np.float64]
    """Centre of gravity at `qpos` (3,) [m], world frame."""
    rotation: NDArray[np.float64]
    """world_from_vessel at `qpos` (3, 3)."""
    hulls: tuple[VesselHull, ...]
    """The hulls (h)."""
    sites: dict[str, NDArray[np.float64]]
    """Positions of the named sites of the tree in the vessel's axes, each (3,) [m]."""

    @property
    def name(self) -> str:
        """Name of the root body."""
        return body_name(self.model, self.root)

    @property
    def weight(self) -> float:
        """Weight of all bodies [N]."""
        return self.mass * self.gravity

    @property
    def specific_weight(self) -> float:
        """Weight of the water per volume, rho g [N/m^3]."""
        return self.water.density * self.gravity

    @functools.cached_property
    def meshes(self) -> tuple[TriMesh, ...]:
        """Meshes of the hulls in the vessel's axes (h)."""
        return tuple(hull.mesh.transformed(hull.rotation, hull.position) for hull in self.hulls)

    @functools.cached_property
    def fills(self) -> NDArray[np.float64]:
        """Part of each hull's volume that displaces water (h,)."""
        return np.array([hull.fill for hull in self.hulls])

    @functools.cached_property
    def volume(self) -> float:
        """Volume of water displaced fully submerged [m^3]."""
        return float(self.fills @ [hull.mesh.volume for hull in self.hulls])

    @property
    def reserve(self) -> float:
        """Mass [kg] that the vessel could carry fully submerged; negative where it sinks."""
        return self.water.density * self.volume - self.mass

    @functools.cached_property
    def centroid(self) -> NDArray[np.float64]:
        """Centre of buoyancy fully submerged, in the vessel's axes (3,) [m]."""
        volumes = np.array([hull.displaced_volume for hull in self.hulls])
        return np.asarray(volumes @ [hull.centroid for hull in self.hulls] / self.volume, float)

    @functools.cached_property
    def points(self) -> NDArray[np.float64]:
        """Vertices of all hulls in the vessel's axes (n, 3) [m]."""
        return np.vstack([mesh.compact[0] for mesh in self.meshes])

    @functools.cached_property
    def radius(self) -> float:
        """Distance of the farthest point of the hulls from the centre of gravity [m]."""
        return float(np.sqrt(np.square(self.points).sum(axis=1).max()))

    def heights(self, rotation: NDArray[np.float64]) -> tuple[float, float]:
        """Heights [m] of the lowest and the highest point of the hulls over the centre of gravity.

        Args:
            rotation: world_from_vessel (3, 3).
        """
        z = self.points @ rotation[2]
        return float(z.min()), float(z.max())

    @functools.cached_property
    def hull_positions(self) -> NDArray[np.float64]:
        """Origins of the hulls' frames in the vessel's axes (h, 3) [m]."""
        return np.array([hull.position for hull in self.hulls])

    @functools.cached_property
    def hull_rotations(self) -> NDArray[np.float64]:
        """vessel_from_hull of each hull (h, 3, 3)."""
        return np.array([hull.rotation for hull in self.hulls])

    @functools.cached_property
    def packed(self) -> PackedHulls:
        """The hulls, packed to be submerged in still water."""
        still = Water(density=self.water.density, level=self.water.level)
        return PackedHulls(HullSet([hull.mesh for hull in self.hulls], fills=self.fills), still)

    @property
    def free(self) -> bool:
        """Whether the root body has a free joint."""
        return has_free_joint(self.model, self.root)

    def match_sites(self, patterns: Sequence[str], optional: Sequence[str] = ()) -> list[str]:
        """Find the names of the sites that match globs, each once.

        Args:
            patterns: globs.
            optional: those of the globs that may match no site.

        Raises:
            ModelError: another glob matches no site.
        """
        names: dict[str, None] = {}
        for pattern in patterns:
            matching = [name for name in self.sites if fnmatch.fnmatchcase(name, pattern)]
            if not matching and pattern not in optional:
                raise ModelError(
                    f"no site of the vessel matches '{pattern}'; {choices(pattern, self.sites)}"
                )
            names |= dict.fromkeys(matching)
        return list(names)

    def qpos_at(
        self, position: NDArray[np.float64], rotation: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Coordinates of the model (nq,) that bring the vessel to a pose, its joints held.

        Args:
            position: of the centre of gravity (3,) [m], world frame.
            rotation: world_from_vessel (3, 3).

        Raises:
            ModelError: the root body has no free joint.
        """
        if not self.free:
            raise ModelError(
                f"body '{self.name}' hangs on joints and is not free to float; "
                "give it a <freejoint/>"
            )
        qpos = self.qpos.copy()
        start = int(self.model.jnt_qposadr[self.model.body_jntadr[self.root]])
        qpos[start : start + 3] = position - rotation @ self.centre_of_gravity
        qpos[start + 3 : start + 7] = Rotation.from_matrix(rotation).as_quat(scalar_first=True)
        return qpos


def has_free_joint(model: mujoco.MjModel, body: int) -> bool:
    """Whether the first joint of a body is a free joint."""
    joint = int(model.body_jntadr[body])
    return joint >= 0 and int(model.jnt_type[joint]) == int(mujoco.mjtJoint.mjJNT_FREE)
