"""`VesselTank`: the water in a vessel's tanks and compartments, and its free surface."""

import dataclasses
import functools

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.kernels.clip import CENTROID
from buoyancy_mj.kernels.waterplane import INTEGRALS
from buoyancy_mj.meshes.fills import TankShape
from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.sea.water import Water
from buoyancy_mj.submersion.exact import PackedHulls
from buoyancy_mj.submersion.hull_set import HullSet


@dataclasses.dataclass(frozen=True, eq=False)
class VesselTank:
    """Water in a tank whose surface stays level as the vessel turns."""

    name: str
    """Name of its ballast."""
    mesh: TriMesh
    """Mesh of the tank in its own frame."""
    position: NDArray[np.float64]
    """Origin of that frame in the vessel's axes (3,) [m]."""
    rotation: NDArray[np.float64]
    """vessel_from_tank (3, 3)."""
    volume: float
    """Volume of the water [m^3]."""
    centroid: NDArray[np.float64]
    """Its centroid while the vessel is upright, in the vessel's axes (3,) [m]: there it counts to
    the vessel's centre of gravity."""

    @functools.cached_property
    def _shape(self) -> TankShape:
        return TankShape(self.mesh)

    @functools.cached_property
    def _packed(self) -> PackedHulls:
        return PackedHulls(HullSet([self.mesh]), Water())

    def settle(self, rotation: NDArray[np.float64]) -> "FreeSurface":
        """Let the water come to rest.

        Args:
            rotation: world_from_vessel (3, 3).
        """
        world_from_tank = rotation @ self.rotation
        level, _ = self._shape.find_level(world_from_tank[2], self.volume)

        # with the surface at the height of 0, and x and y of the tank's frame
        origin = np.array([[0.0, 0.0, -level]])
        frame = np.ascontiguousarray(world_from_tank).reshape(1, 9)
        wet = self._packed.submerge(origin, frame, 0.0)[0]
        area, x, y, xx, xy, yy = self._packed.waterplanes(origin, frame, np.zeros(3))[0, INTEGRALS]
        moments = np.zeros((2, 2))
        if area > 0.0:
            moments = np.array([[xx, xy], [xy, yy]]) - np.outer([x, y], [x, y]) / area
        centroid = wet[CENTROID] + [0.0, 0.0, level]
        return FreeSurface(
            shift=centroid + rotation @ (self.position - self.centroid), moments=moments
        )


@dataclasses.dataclass(frozen=True, eq=False)
class FreeSurface:
    """How the water of a tank lies in a pose."""

    shift: NDArray[np.float64]
    """From where its centroid counts to the vessel's centre of gravity to where it is (3,) [m]."""
    moments: NDArray[np.float64]
    """Second moments x x, x y; x y, y y of its surface about their centroid (2, 2) [m^4]."""
