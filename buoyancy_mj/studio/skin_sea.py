"""`SkinSea`: the sea as a skin on bones, for browsers, which draw what stands in a model alone."""

import mujoco
import numpy as np
import scipy
from numpy.typing import NDArray

from buoyancy_mj.drawing.looks import Look
from buoyancy_mj.drawing.ripples import paint_ripples
from buoyancy_mj.drawing.sea_mesh import Band, split_waves
from buoyancy_mj.sea.water import Water
from buoyancy_mj.studio.grids import list_faces

CELLS = 4
"""Number of cells along the radius; by so many the surface is moved at a time."""
CORE = 6
"""Number of cells of one width from the middle to each side: the radius, and half a move."""
GROWTH = (1.3,) * 5 + (1.8, 2.1, 2.1, 2.1, 2.1)
"""Width of each cell beyond them over that of the one before; splines fold where it is 3."""
PIXELS = 256
"""Pixels along a side of the ripples."""
PARTS = 2
"""Number of triangles' edges along a cell."""
NAME = "sea"


class SkinSea:
    """A surface of cubic B-splines over a square of bones, which are mocap bodies.

    Args:
        spec: receives the bones and skins, as its last bodies.
        radius: distance from the middle within which the surface is exact [m].
        look: colours of the sea.
    """

    def __init__(self, spec: mujoco.MjSpec, radius: float, look: Look) -> None:
        width = radius / CELLS
        half = np.cumsum(width * np.cumprod([*np.ones(CORE), *GROWTH]))
        self._knots = np.concatenate([-half[::-1], [0.0], half])
        cells = np.gradient(self._knots)
        cells = np.maximum(cells[:, None], cells).ravel()
        cells[cells < 1.01 * width] = 0.0
        self._order = np.argsort(cells, kind="stable")
        self._cells = cells[self._order]
        self._water: Water | None = None
        self._bands: list[Band] = []
        self._move = radius
        count = len(self._knots)
        self.first = sum(bool(body.mocap) for body in spec.bodies)
        """Index of the first bone among mocap bodies."""
        self._add_bones(spec, count)
        self._add_skins(spec, count, look)

    def place(self, water: Water, centre: NDArray[np.float64], time: float) -> NDArray[np.float64]:
        """Positions of the bones (n, 3) [m] that lay the skin on a sea around a point.

        Waves fade where the bones stand too far apart for them.

        Args:
            water: the sea.
            centre: the middle of the surface (2,) [m], world frame.
            time: [s].
        """
        if water is not self._water:
            self._water, self._bands = water, split_waves(water, self._cells)
        middle = np.round(centre / self._move) * self._move
        x, y = np.meshgrid(self._knots + middle[0], self._knots + middle[1], indexing="ij")
        z = np.full_like(x, water.level)
        for band in self._bands:
            some = self._order[: len(band.weights)]
            heights = band.water.elevation(x.flat[some], y.flat[some], time)
            z.flat[some] += band.weights * heights
        return np.stack([_filter(axis) for axis in (x, y, z)], axis=-1).reshape(-1, 3)

    def _add_bones(self, spec: mujoco.MjSpec, count: int) -> None:
        """Add the bones."""
        self._names = [f"{NAME}/{i}" for i in range(count * count)]
        for name in self._names:
            spec.worldbody.add_body(name=name, mocap=True)

    def _add_skins(self, spec: mujoco.MjSpec, count: int, look: Look) -> None:
        """Add the skins, one for each side."""
        weights = _spline_weights(count)
        rest = self._knots[:, None] * np.ones(count)
        bind = np.stack([_filter(rest), _filter(rest.T), np.zeros_like(rest)], -1).reshape(-1, 3)
        vertices = weights @ bind
        side = PARTS * (count - 1) + 1
        faces = list_faces(side, side)
        ripples = spec.add_texture(name=f"{NAME}/ripples", type=mujoco.mjtTexture.mjTEXTURE_2D)
        ripples.width = ripples.height = PIXELS
        ripples.nchannel = 3
        ripples.data = paint_ripples(PIXELS, look.ripple).tobytes()
        # whole squares of ripples in a move
        squares = vertices[:, :2] * max(1, round(self._move / look.ripple_length)) / self._move
        columns = scipy.sparse.csc_array(weights)
        ids = np.split(columns.indices, columns.indptr[1:-1])
        shares = np.split(columns.data, columns.indptr[1:-1])
        for side_seen, turned, shade in (
            ("above", faces, look.above),
            ("below", faces[:, ::-1], look.below),
        ):
            rgba = (*shade.colour, shade.opacity)
            material = spec.add_material(name=f"{NAME}/{side_seen}", rgba=rgba)
            material.roughness, material.metallic = shade.roughness, 0.0
            material.textures[int(mujoco.mjtTextureRole.mjTEXROLE_NORMAL)] = ripples.name
            skin = spec.add_skin(name=f"{NAME}/{side_seen}", material=material.name)
            skin.vert = vertices.ravel()
            skin.texcoord = squares.ravel()
            skin.face = turned.ravel()
            skin.bodyname = self._names
            skin.bindpos = bind.ravel()
            skin.bindquat = np.tile([1.0, 0.0, 0.0, 0.0], len(bind))
            skin.vertid = [list(map(int, chosen)) for chosen in ids]
            skin.vertweight = [list(map(float, chosen)) for chosen in shares]


def _filter(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Coefficients (n, n) of the cubic spline that goes through values (n, n)."""
    found: NDArray[np.float64] = scipy.ndimage.spline_filter(values, order=3, mode="mirror")
    return found


def _spline_weights(count: int) -> scipy.sparse.csr_array:
    """Weights (vertices, bones) of cubic B-splines over a square of `count` bones each way."""
    places = np.arange(PARTS * (count - 1) + 1) / PARTS
    base = np.minimum(places.astype(int), count - 2)
    t = places - base
    parts = np.array(
        [(1 - t) ** 3, 3 * t**3 - 6 * t**2 + 4, -3 * t**3 + 3 * t**2 + 3 * t + 1, t**3]
    )
    matrix = np.zeros((len(places), count))
    for offset, part in zip((-1, 0, 1, 2), parts / 6.0, strict=True):
        # mirrored at the ends
        bone = np.abs(base + offset)
        bone = np.where(bone > count - 1, 2 * (count - 1) - bone, bone)
        np.add.at(matrix, (np.arange(len(places)), bone), part)
    line = scipy.sparse.csr_array(matrix)
    return scipy.sparse.csr_array(scipy.sparse.kron(line, line))
