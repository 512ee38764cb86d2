"""How water fills a mesh: volume, first and second moments by level, as curves of the volume."""

import dataclasses
import functools
from collections.abc import Sequence

import numpy as np
import scipy
from numpy.typing import NDArray

from buoyancy_mj.kernels import fills
from buoyancy_mj.kernels.arrays import conform
from buoyancy_mj.kernels.fills import Fills
from buoyancy_mj.meshes.mesh import TriMesh

LEVELS = 48
"""Layers into which the height of a tank is cut, thinner at its ends."""
_PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
"""Second moments x x, y y, z z, x y, x z, y z."""
_POINTS = np.array([
    [0.108103018168070, 0.445948490915965, 0.445948490915965, 0.223381589678011],
    [0.445948490915965, 0.108103018168070, 0.445948490915965, 0.223381589678011],
    [0.445948490915965, 0.445948490915965, 0.108103018168070, 0.223381589678011],
    [0.816847572980459, 0.091576213509771, 0.091576213509771, 0.109951743655322],
    [0.091576213509771, 0.816847572980459, 0.091576213509771, 0.109951743655322],
    [0.091576213509771, 0.091576213509771, 0.816847572980459, 0.109951743655322],
])  # fmt: skip
"""Barycentric points over a triangle and their weights, exact to the fourth degree (Dunavant 1985,
Int. J. Numer. Meth. Eng. 21, 1129)."""


@dataclasses.dataclass(frozen=True, eq=False)
class FillCurve:
    """The moments of the water in a tank, by its volume: cubic between knots."""

    knots: NDArray[np.float64]
    """Volumes from 0 to the whole (k,) [m^3]."""
    pieces: NDArray[np.float64]
    """Coefficients from each knot to the next (k - 1, 9, 4), the highest power first, of the
    integrals of x, y, z, x x, y y, z z, x y, x z, y z."""

    def moments(self, volume: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """First (3,) [m^4] and second moments (3, 3) [m^5] of a volume [m^3] of water."""
        i = int(np.clip(np.searchsorted(self.knots, volume, "right") - 1, 0, len(self.pieces) - 1))
        values = self.pieces[i] @ (volume - self.knots[i]) ** np.arange(3, -1, -1)
        return values[:3], _square(values[3:])


def measure_fill(mesh: TriMesh, up: NDArray[np.float64]) -> FillCurve:
    """Measure how a mesh fills from its lowest point on.

    Args:
        mesh: a tank.
        up: the vertical along the axes of the mesh (3,).
    """
    heights = mesh.vertices @ up
    low, high = float(heights.min()), float(heights.max())
    shares = 0.5 * (1.0 - np.cos(np.pi * np.arange(1, LEVELS) / LEVELS))
    rows = [np.zeros(10)]
    rows += [integrate_below(mesh, up, low + share * (high - low)) for share in shares]
    rows.append(integrate_below(mesh, up, high))
    table = np.array(rows)

    # knots where nothing lies between two levels are one
    kept = np.concatenate([[True], np.diff(table[:, 0]) > 1e-9 * table[-1, 0]])
    curve = scipy.interpolate.CubicSpline(table[kept, 0], table[kept, 1:])
    return FillCurve(table[kept, 0], np.moveaxis(curve.c, 0, -1))


class TankShape:
    """A tank in which water levels out.

    Args:
        mesh: of the tank.
    """

    def __init__(self, mesh: TriMesh) -> None:
        self._packed = conform(pack_fills([mesh], [True]))

    def find_level(
        self, up: NDArray[np.float64], volume: float
    ) -> tuple[float, NDArray[np.float64]]:
        """Height [m] of the surface along `up` (3,), and the centroid (3,) [m], of some water.

        Args:
            up: the vertical along the axes of the mesh (3,).
            volume: of the water [m^3].
        """
        x, y, z = map(float, up)
        level, _, *centroid = fills.find_level(self._packed, 0, x, y, z, volume)
        return level, np.array(centroid)


def pack_fills(
    meshes: Sequence[TriMesh],
    filled: Sequence[bool],
    knots: Sequence[NDArray[np.float64]] = (),
    pieces: Sequence[NDArray[np.float64]] = (),
) -> Fills:
    """Tanks as kernels read them.

    Args:
        meshes: of the tanks (n).
        filled: whether each is filled with water; of others the volume alone is kept (n).
        knots: see `Fills.knots`; without any, levels alone can be found.
        pieces: see `Fills.pieces`.
    """
    whole = [mesh if has else None for mesh, has in zip(meshes, filled, strict=True)]
    starts = np.cumsum([0, *(len(mesh.vertices) if mesh else 0 for mesh in whole)])
    kept = [(mesh, start) for mesh, start in zip(whole, starts[:-1], strict=True) if mesh]
    counts = [len(one) for one in knots] or [0] * len(meshes)
    return Fills(
        volumes=np.array([mesh.volume for mesh in meshes]),
        knots=np.concatenate([np.zeros(0), *knots]),
        pieces=np.concatenate([np.zeros((0, 36)), *pieces]),
        knot_starts=np.cumsum([0, *counts]),
        vertices=np.concatenate([np.zeros((0, 3)), *(mesh.vertices for mesh, _ in kept)]),
        faces=np.concatenate(
            [np.zeros((0, 3), np.int64), *(mesh.faces + start for mesh, start in kept)]
        ),
        areas=np.concatenate([np.zeros((0, 3)), *(mesh.area_vectors for mesh, _ in kept)]),
        vertex_starts=starts,
        face_starts=np.cumsum([0, *(len(mesh.faces) if mesh else 0 for mesh in whole)]),
    )


def integrate_below(mesh: TriMesh, up: NDArray[np.float64], level: float) -> NDArray[np.float64]:
    """Integrals (10,) of 1, x, y, z, x x, y y, z z, x y, x z, y z over what lies below a level.

    By Gauss each integral of f is that of -F n_up over the surface below, F the integral of f from
    a point straight up to the level: f is a polynomial along that way.

    Args:
        mesh: a closed mesh.
        up: the vertical along the axes of the mesh (3,).
        level: height along it [m].
    """
    corners, weights = _cut_triangles(mesh, up, level)
    points = np.einsum("qc,tcx->tqx", _POINTS[:, :3], corners)
    depths = level - points @ up
    areas = -weights[:, None] * _POINTS[:, 3]

    # along the way up by Simpson's rule, exact for squares
    totals = np.zeros(10)
    for share, part in ((0.0, 1 / 6), (0.5, 4 / 6), (1.0, 1 / 6)):
        x = points + (share * depths)[..., None] * up
        values = [np.ones_like(depths), *np.moveaxis(x, -1, 0)]
        values += [x[..., i] * x[..., j] for i, j in _PAIRS]
        totals += part * np.array([(areas * depths * value).sum() for value in values])
    return totals


def _cut_triangles(
    mesh: TriMesh, up: NDArray[np.float64], level: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Corners (t, 3, 3) and signed areas seen from above (t,) of what lies below a level.

    Of a triangle with one corner above, the whole counts less its upper part.
    """
    order = np.argsort(mesh.vertices[mesh.faces] @ up, axis=1)
    corners = np.take_along_axis(mesh.vertices[mesh.faces], order[:, :, None], axis=1)
    heights, flux = corners @ up, mesh.area_vectors @ up
    below = heights < level
    whole = below[:, 1] & (flux != 0.0)
    lower = below[:, 0] & ~below[:, 1] & (flux != 0.0)
    upper = whole & ~below[:, 2]

    # the small triangles at the lowest and at the highest corner of those that are cut
    small_low, share_low = _cut_corner(corners[lower], heights[lower], level, 0)
    small_high, share_high = _cut_corner(corners[upper], heights[upper], level, 2)
    triangles = np.concatenate([corners[whole], small_low, small_high])
    return triangles, np.concatenate(
        [flux[whole], flux[lower] * share_low, -flux[upper] * share_high]
    )


def _cut_corner(
    corners: NDArray[np.float64], heights: NDArray[np.float64], level: float, at: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The part of triangles at one corner that a level cuts off, and its share of the area."""
    others = [i for i in range(3) if i != at]
    tip, tip_height = corners[:, at], heights[:, at]
    shares = (level - tip_height)[:, None] / (heights[:, others] - tip_height[:, None])
    ends = tip[:, None] + shares[..., None] * (corners[:, others] - tip[:, None])
    return np.concatenate([tip[:, None], ends], axis=1), shares.prod(axis=1)


def _square(second: NDArray[np.float64]) -> NDArray[np.float64]:
    """Second moments as a matrix (3, 3)."""
    matrix = np.zeros((3, 3))
    for (i, j), value in zip(_PAIRS, second, strict=True):
        matrix[i, j] = matrix[j, i] = value
    return matrix


@functools.lru_cache(maxsize=64)
def find_fill(mesh: TriMesh, up: tuple[float, float, float]) -> FillCurve:
    """`measure_fill`, once for each mesh."""
    return measure_fill(mesh, np.array(up))
