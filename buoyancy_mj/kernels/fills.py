"""How water lies in a tank: its moments by how full the tank is, and its level surface.

The moments are integrals of x, y, z, x x, y y, z z, x y, x z and y z over the water, in the frame
of the body, as the water stands when the tank's own vertical is the world's. Between knots of
volume they are cubic polynomials, which is exact for boxes and upright cylinders.
"""

from typing import Annotated, NamedTuple

from buoyancy_mj.kernels.arrays import Doubles, Words
from buoyancy_mj.kernels.compiling import inner, njit
from buoyancy_mj.kernels.triangles import cut, moments
from buoyancy_mj.kernels.vectors import triple

X, Y, Z, XX, YY, ZZ, XY, XZ, YZ, MOMENTS = range(10)
"""Moments, in the order of `Fills.pieces`, and how many."""
COEFFICIENTS = 4
"""Of each piece, the highest power first."""
_CLOSE = 1e-13
"""Part of the whole volume to which a level is found."""
_TRIES = 60
"""Halvings of the height of a tank at most."""


class Fills(NamedTuple):
    """The shapes of tanks."""

    volumes: Annotated[Doubles, ("n",)]
    """Volume of each [m^3]."""
    knots: Annotated[Doubles, ("k",)]
    """Volumes of water at which the pieces of each begin, one tank after the other [m^3]."""
    pieces: Annotated[Doubles, ("k", 36)]
    """The moments from one knot to the next: four coefficients of the volume from the knot on, for
    each moment after the other; nothing behind the last knot of a tank."""
    knot_starts: Annotated[Words, ("n + 1",)]
    """Where the knots of each begin, and the end of all."""
    vertices: Annotated[Doubles, ("v", 3)]
    """Of all meshes, each in the frame of its geom [m]."""
    faces: Annotated[Words, ("f", 3)]
    """Indices into the vertices."""
    areas: Annotated[Doubles, ("f", 3)]
    """Vector area of each face [m^2]."""
    vertex_starts: Annotated[Words, ("n + 1",)]
    """Where the vertices of each begin, and the end of all."""
    face_starts: Annotated[Words, ("n + 1",)]
    """Where the faces of each begin, and the end of all."""


@inner
def set_moments(fills, n, volume, out):
    """Write the moments (9,) of a volume of water in a tank to `out`."""
    low = _find_piece(fills, n, volume)
    x, piece = volume - fills.knots[low], fills.pieces[low]
    for m in range(MOMENTS):
        c = COEFFICIENTS * m
        out[m] = ((piece[c] * x + piece[c + 1]) * x + piece[c + 2]) * x + piece[c + 3]


@inner
def set_growth(fills, n, volume, out):
    """Write how the moments (9,) grow with the volume of water in a tank to `out`."""
    low = _find_piece(fills, n, volume)
    x, piece = volume - fills.knots[low], fills.pieces[low]
    for m in range(MOMENTS):
        c = COEFFICIENTS * m
        out[m] = (3.0 * piece[c] * x + 2.0 * piece[c + 1]) * x + piece[c + 2]


@njit(cache=True, error_model="numpy", inline="always")
def _find_piece(fills, n, volume):
    """The piece of a tank's moments that a volume of water lies on."""
    knots, low, high = fills.knots, fills.knot_starts[n], fills.knot_starts[n + 1] - 1
    while high - low > 1:
        middle = (low + high) // 2
        if volume < knots[middle]:
            high = middle
        else:
            low = middle
    return low


@inner
def set_matrix(volume, moments_, density, out):
    """Write the inertia of water with some moments, as a rigid body, to `out`, row by row (36,).

    It is along the axes of the body, about its origin: translation first.
    """
    out[:] = 0.0
    mass = density * volume
    sx, sy, sz = density * moments_[X], density * moments_[Y], density * moments_[Z]
    for i in range(3):
        out[7 * i] = mass
    out[4], out[5], out[9] = sz, -sy, -sz
    out[11], out[15], out[16] = sx, sy, -sx
    out[19], out[20], out[24] = -sz, sy, sz
    out[26], out[30], out[31] = -sx, -sy, sx
    out[21] = density * (moments_[YY] + moments_[ZZ])
    out[28] = density * (moments_[XX] + moments_[ZZ])
    out[35] = density * (moments_[XX] + moments_[YY])
    out[22] = out[27] = -density * moments_[XY]
    out[23] = out[33] = -density * moments_[XZ]
    out[29] = out[34] = -density * moments_[YZ]


@njit(cache=True, error_model="numpy")
def find_level(fills, n, up0, up1, up2, volume):
    """The level surface of a volume of water in a tank.

    Newton's method, held between bounds: the derivative of the volume is the surface.

    Args:
        fills: `Fills`.
        n: index of the tank.
        up0: the vertical along the axes of the geom, as the two behind it.
        up1: see `up0`.
        up2: see `up0`.
        volume: [m^3].

    Returns:
        Height of the surface over the origin of the geom [m], its area [m^2], and the centroid of
        the water (3) in the frame of the geom [m].
    """
    vertices, whole = fills.vertices, fills.volumes[n]
    first = fills.vertex_starts[n]
    low = high = _height(vertices, first, up0, up1, up2)
    for i in range(first + 1, fills.vertex_starts[n + 1]):
        z = _height(vertices, i, up0, up1, up2)
        low, high = min(low, z), max(high, z)
    level = low + (high - low) * min(max(volume / whole, 0.0), 1.0)
    found = _measure_below(fills, n, up0, up1, up2, level)
    for _ in range(_TRIES):
        excess = found[0] - volume
        if abs(excess) <= _CLOSE * whole:
            break
        if excess > 0.0:
            high = level
        else:
            low = level
        step = level - excess / found[1] if found[1] > 0.0 else low
        level = step if low < step < high else 0.5 * (low + high)
        found = _measure_below(fills, n, up0, up1, up2, level)
    return level, found[1], found[2], found[3], found[4]


@njit(cache=True, error_model="numpy", inline="always")
def _height(vertices, i, up0, up1, up2):
    """Height of a vertex [m]."""
    return up0 * vertices[i, 0] + up1 * vertices[i, 1] + up2 * vertices[i, 2]


@inner
def _measure_below(fills, n, up0, up1, up2, level):
    """Volume of a tank below a level, the area of the surface there, and the centroid (3).

    With the depth d = level - height, int x_i dV = - int (x_i + up_i d / 2) d n_up dA over the
    side below, as in `clip`.
    """
    vertices, faces, areas = fills.vertices, fills.faces, fills.areas
    volume = mx = my = mz = square = surface = 0.0
    for f in range(fills.face_starts[n], fills.face_starts[n + 1]):
        j, k, o = faces[f, 0], faces[f, 1], faces[f, 2]
        wj = level - _height(vertices, j, up0, up1, up2)
        wk = level - _height(vertices, k, up0, up1, up2)
        wo = level - _height(vertices, o, up0, up1, up2)
        if wj <= 0.0 and wk <= 0.0 and wo <= 0.0:
            continue
        a = up0 * areas[f, 0] + up1 * areas[f, 1] + up2 * areas[f, 2]
        p, q, s = (
            (*triple(vertices, j, 0), wj),
            (*triple(vertices, k, 0), wk),
            (*triple(vertices, o, 0), wo),
        )
        if wj > 0.0 and wk > 0.0 and wo > 0.0:
            part, fraction = moments(a, p, q, s), 1.0
        else:
            part, fraction, _, _ = cut(a, p, q, s, wj, wk, wo)
        volume -= part[0]
        mx, my, mz = mx - part[1], my - part[2], mz - part[3]
        square -= part[4]
        surface -= fraction * a
    if not volume > 0.0:
        return 0.0, max(surface, 0.0), 0.0, 0.0, 0.0
    half = 0.5 * square
    return (
        volume,
        max(surface, 0.0),
        (mx + up0 * half) / volume,
        (my + up1 * half) / volume,
        (mz + up2 * half) / volume,
    )
