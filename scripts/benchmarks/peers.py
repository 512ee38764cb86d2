"""Other packages that compute a submersion, and what is installed of them."""

import manifold3d
import numpy as np
import trimesh
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

try:
    import capytaine
except ImportError:
    capytaine = None

CALLS = {
    "trimesh": "trimesh's capped slice",
    "scipy hull": "scipy's convex hull of the wet vertices",
    "manifold3d": "manifold3d's trim",
    "Capytaine": "Capytaine's immersed part",
}
"""What is called, by the names of the columns."""
PEERS = tuple(CALLS)
"""Names of the columns."""


class Poses:
    """A solid in several poses, submerged by others; each method takes the index of a pose."""

    def __init__(
        self,
        solid: trimesh.Trimesh,
        positions: list[NDArray[np.float64]],
        rotations: list[NDArray[np.float64]],
    ) -> None:
        self._solid = solid
        self._positions = positions
        self._rotations = rotations
        vertices = np.array(solid.vertices)
        self._manifold = manifold3d.Manifold(
            manifold3d.Mesh64(vertices, np.array(solid.faces, np.uint64))
        )

    def _vertices(self, i: int) -> NDArray[np.float64]:
        """Vertices (v, 3) [m] in the world frame."""
        return self._solid.vertices @ self._rotations[i].T + self._positions[i]

    def by_trimesh(self, i: int) -> tuple[float, NDArray[np.float64]]:
        """Volume and centroid of a slice with a cap."""
        turned = trimesh.Trimesh(self._vertices(i), self._solid.faces, process=False)
        wet = turned.slice_plane([0, 0, 0], [0, 0, -1], cap=True)
        return wet.volume, wet.center_mass

    def by_scipy(self, i: int) -> float:
        """Volume of the convex hull of the wet vertices."""
        points = self._vertices(i)
        return float(ConvexHull(points[points[:, 2] < 0.0]).volume)

    def by_manifold(self, i: int) -> float:
        """Volume of a trimmed manifold."""
        wet = self._manifold.trim_by_plane(-self._rotations[i][2], self._positions[i][2])
        return float(wet.volume())

    def by_capytaine(self, i: int) -> float:
        """Volume of an immersed part."""
        mesh = capytaine.Mesh(vertices=self._vertices(i), faces=self._solid.faces)
        return float(mesh.immersed_part().volume)
