"""`Vessel`: the bodies that float together, as one rigid body, its joints held."""

import dataclasses
import fnmatch
import functools
from collections.abc import Sequence
from typing import TYPE_CHECKING

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import EquilibriumError, ModelError, choices
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.hulls.tethers import Tether, has_free_joint
from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.sea.water import Water
from buoyancy_mj.statics.joined_trees import JoinedTree
from buoyancy_mj.submersion.exact import PackedHulls
from buoyancy_mj.submersion.hull_set import HullSet

if TYPE_CHECKING:
    from buoyancy_mj.statics.tanks import VesselTank

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
    """The bodies of a model that float together, as one rigid body: their joints are held.

    They are a kinematic tree, or several that welds and connects hold together. The vessel's axes
    are those of its root body, their origin is its centre of gravity. That is the point through
    which its weight acts: what gravity compensation carries (`gravcomp`) weighs nothing.
    """

    model: mujoco.MjModel
    """The model."""
    qpos: NDArray[np.float64]
    """Coordinates of the model (nq,) that hold the joints."""
    root: int
    """Index of the root body."""
    bodies: NDArray[np.int64]
    """Indices of all its bodies (b,)."""
    trees: tuple[JoinedTree, ...]
    """Its kinematic trees."""
    freedoms: int
    """Number of ways in which its connects leave the trees free to move against each other."""
    tether: Tether | None
    """What keeps it from floating freely; None if nothing does."""
    water: Water
    """The sea; statics use its density and its still level alone."""
    gravity: float
    """Downward acceleration [m/s^2]."""
    mass: float
    """Mass that weighs [kg]: that of all bodies, less what gravity compensation carries."""
    carried_mass: float
    """Mass that gravity compensation carries [kg]."""
    inertia: NDArray[np.float64]
    """Inertia of all bodies about their centre of mass, in the vessel's axes (3, 3) [kg m^2]."""
    centre_of_mass: NDArray[np.float64]
    """Centre of mass in the vessel's axes (3,) [m]: their origin, without gravity compensation."""
    centre_of_gravity: NDArray[np.float64]
    """Centre of gravity in the frame of the root body (3,) [m]."""
    position: NDArray[np.float64]
    """Centre of gravity at `qpos` (3,) [m], world frame."""
    rotation: NDArray[np.float64]
    """world_from_vessel at `qpos` (3, 3)."""
    hulls: tuple[VesselHull, ...]
    """The hulls (h)."""
    sites: dict[str, NDArray[np.float64]]
    """Positions of its named sites in the vessel's axes, each (3,) [m]."""
    tanks: "tuple[VesselTank, ...]" = ()
    """Its tanks and compartments with a free surface. The centre of gravity counts their water
    where it lies while the vessel is upright."""

    @property
    def name(self) -> str:
        """Name of the root body."""
        return body_name(self.model, self.root)

    @property
    def weight(self) -> float:
        """Weight of all bodies [N], less what gravity compensation carries."""
        return self.mass * self.gravity

    @property
    def whole_mass(self) -> float:
        """Mass of all bodies [kg], that which gravity compensation carries too."""
        return self.mass + self.carried_mass

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
        """Whether it floats freely: its trees have free joints, and nothing holds it to a place."""
        return self.tether is None

    def check_free(self) -> None:
        """Refuse a vessel that does not float freely.

        Raises:
            ModelError: joints, a weld or a connect hold it.
        """
        if self.tether is not None:
            raise ModelError(
                f"body '{self.tether.body}' {self.tether.how} and is not free to float; "
                f"{self.tether.mend}"
            )

    def check_weight(self) -> None:
        """Refuse a vessel that no water could hold down.

        Raises:
            EquilibriumError: gravity compensation carries all of it, or more.
        """
        if not self.mass > 0.0:
            raise EquilibriumError(
                f"'{self.name}' comes to rest nowhere: gravity compensation carries "
                f"{self.carried_mass:.4g} kg of its {self.whole_mass:.4g} kg, "
                "and the water lifts it out; "
                "take gravcomp='...' out of its bodies, or weigh it down (see ballast)"
            )

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
            ModelError: joints, a weld or a connect hold the vessel.
        """
        self.check_free()
        return self._place_trees(position, rotation)

    def moved_to(self, position: NDArray[np.float64], rotation: NDArray[np.float64]) -> "Vessel":
        """A copy of the vessel in a pose, be it free to go there or not.

        Args:
            position: of the centre of gravity (3,) [m], world frame.
            rotation: world_from_vessel (3, 3).
        """
        qpos = self._place_trees(position, rotation)
        return dataclasses.replace(self, qpos=qpos, position=position, rotation=rotation)

    def _place_trees(
        self, position: NDArray[np.float64], rotation: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Coordinates of the model (nq,) with the free joints of all trees moved to a pose."""
        from scipy.spatial.transform import Rotation

        qpos = self.qpos.copy()
        origin = position - rotation @ self.centre_of_gravity
        for tree in self.trees:
            if not has_free_joint(self.model, tree.root):
                continue
            start = int(self.model.jnt_qposadr[self.model.body_jntadr[tree.root]])
            turned = Rotation.from_matrix(rotation @ tree.rotation)
            qpos[start : start + 3] = origin + rotation @ tree.position
            qpos[start + 3 : start + 7] = turned.as_quat(scalar_first=True)
        return qpos
