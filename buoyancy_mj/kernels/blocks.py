"""The pressure of a sea in cubic blocks of water, each with one polynomial of the head.

Blocks fill the space, as tiles cover the surface, see `tiles`: the first who asks for the pressure
in a block at an instant has it filled, all who ask after that evaluate its polynomial.

What waves sum up to at a height where the water stood in still water is a polynomial in x, y and
that height: with its Laplacian zero, all of it follows from two layers, its value on a level and
its slope there. The head itself, see `waves.head`, is found by these at some points of a block, and
its polynomial is fitted to them. The head goes on above the surface as smoothly as the waves do, so
that a block which the surface cuts is as good as others; nobody asks for it there.
"""

import math
from typing import Annotated, NamedTuple

from buoyancy_mj.kernels.arrays import Doubles
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.polynomials import (
    deepen,
    on_powers,
    set_at_many,
    set_in_space_at_many,
    size,
    size_in_space,
)
from buoyancy_mj.kernels.series import exponential
from buoyancy_mj.kernels.still_water import settle
from buoyancy_mj.kernels.tiles import set_phases, sum_products

SIDE, REACH, FALL, DEPTH, WHOLE, TIDAL, SHALLOW = range(7)
"""Numbers of `Blocks.layout`: side of a block [m]; half the side of the cube in which its
polynomial holds [m]; `still_water.decay` of the waves; the depth of the water; what the waves take
off the mean head at the still level; whether all the water rises and falls; whether any wave feels
the bottom."""
DEGREE = 4
"""Degree of the polynomial of the head."""
WAVE_DEGREE = 5
"""Degree of the polynomials of what waves sum up to."""
POWERS = 6
"""Degree of the polynomial of what the waves take off the mean head."""
NUMBERS = size_in_space.py_func(DEGREE)
"""Coefficients of the head."""
FLAT, BELOW = size.py_func(WAVE_DEGREE), size.py_func(WAVE_DEGREE - 1)
"""Coefficients of the upper and of the lower layer of a sum over the waves."""
SOLID = size_in_space.py_func(WAVE_DEGREE)
"""Coefficients of all its layers."""
K, BOTTOM, SQUARE, TIDE, TAYLOR = range(5)
"""Rows of `Blocks.waves`: wave number [rad/m]; `still_water.seabed`; k tanh(k h) a^2 / 2; the
amplitude of what raises all the water, else 0; and from TAYLOR on what the cosine or the sine of
the phase adds to each coefficient of a layer."""
SAMPLES = 64
"""Points at which the head in a block is found."""
ALONG, DOWN = 16, 4
"""Blocks along a side of the store, and along its height."""
MIDDLE_X, MIDDLE_Y, MIDDLE_Z, INSTANT, HEAD = range(5)
"""Columns of `BlockStore.found`: the middle of a block, from the still level [m], and the instant,
which say which block it is; and from HEAD on its polynomial, in parts of `REACH` from the middle.
"""
ETA, STILL, AWAY, UP, STRAIN, OVER, BEND, LESS, LINE, LEVEL, FOUND = range(11)
"""Rows of `BlockStore.room` at the points: the elevation; a guess of the height in still water, and
that from the middle; the water's rise and its slope, the rest of the head and its slope, and what
the waves take off the mean head, as in `still_water.settle`; two of scratch; the head."""


class Blocks(NamedTuple):
    """The waves of a sea as they make up blocks; they stand in the order of `tiles.Tiles`."""

    layout: Annotated[Doubles, (7,)]
    """Numbers `SIDE` to `SHALLOW`."""
    waves: Annotated[Doubles, (TAYLOR + FLAT, "w")]
    """Rows `K` to `TAYLOR` and behind."""
    points: Annotated[Doubles, (3, SAMPLES)]
    """Points of a block, in parts of `REACH` from the middle."""
    fit: Annotated[Doubles, (NUMBERS, SAMPLES)]
    """What the head at each of them adds to each coefficient."""


class BlockStore(NamedTuple):
    """The blocks that are known, for one thread; new ones are zero."""

    found: Annotated[Doubles, (ALONG * ALONG * DOWN, HEAD + NUMBERS)]
    """Columns `MIDDLE_X` to `HEAD` and behind."""
    sums: Annotated[Doubles, (12, "w")]
    """Cosines and sines of the phases (2); these times what fades with depth (8), and its even and
    odd powers (2); scratch."""
    room: Annotated[Doubles, (14, SAMPLES)]
    """Points of a block in rows of their own (3), behind rows `ETA` to `FOUND`; scratch."""
    solid: Annotated[Doubles, (3 * SOLID,)]
    """Polynomials of the elevation, of the rise and of the rest of the head; scratch."""
    line: Annotated[Doubles, (POWERS + 1,)]
    """That of what the waves take off the mean head; scratch."""


@njit(cache=True, error_model="numpy", inline="always")
def find_block(layout, x, y, z):
    """Where the block at a place stands in the store, and its middle."""
    side = layout[SIDE]
    i, j, k = math.floor(x / side), math.floor(y / side), math.floor(z / side)
    b = ((int(i) & (ALONG - 1)) * ALONG + (int(j) & (ALONG - 1))) * DOWN + (int(k) & (DOWN - 1))
    return b, (i + 0.5) * side, (j + 0.5) * side, (k + 0.5) * side


@njit(cache=True, error_model="numpy", inline="always")
def is_known(found, b, x, y, z, time):
    """Whether the block with a middle stands in its place in the store."""
    same = found[b, MIDDLE_X] == x and found[b, MIDDLE_Y] == y and found[b, MIDDLE_Z] == z
    return same and found[b, INSTANT] == time


@njit(cache=True, error_model="numpy", _nrt=False)
def fill(sea, blocks, store, b, x, y, z, time, dynamic):
    """Find the head in a block: at its points, and from there its polynomial.

    Args:
        sea: `Tiles.waves`.
        blocks: `Blocks`.
        store: `BlockStore`; written.
        b: the place in it.
        x: middle of the block, as y and z from the still level [m].
        y: see x.
        z: see x.
        time: [s].
        dynamic: whether the pressure is that of waves, or hydrostatic under their surface.
    """
    layout, reach, room = blocks.layout, blocks.layout[REACH], store.room
    many, sums, solid, found = sea.shape[1], store.sums, store.solid, store.found
    set_phases(sea, many, x, y, time, sums)
    _set_layer(blocks.waves, sums, 0, WAVE_DEGREE, solid, 0)
    for n in range(SAMPLES):
        for c in range(3):
            room[c, n] = reach * blocks.points[c, n]
        room[3 + ETA, n] = 0.0
    eta = room[3 + ETA]
    set_at_many(
        solid, size(WAVE_DEGREE), WAVE_DEGREE, room[0], room[1], SAMPLES, room[3 + LINE], eta
    )
    if dynamic:
        still = _guess(z, solid[0], layout[FALL], layout[DEPTH])
        _set_sums(blocks, sums, store.line, solid, still)
        _set_heads(layout, store.line, solid, room, z, still, _sum_tide(blocks, sums))
    else:
        for n in range(SAMPLES):
            room[3 + FOUND, n] = eta[n] - z - room[2, n]
    for i in range(NUMBERS):
        found[b, HEAD + i] = sum_products(blocks.fit, i, room, 3 + FOUND, SAMPLES)
    found[b, MIDDLE_X], found[b, MIDDLE_Y], found[b, MIDDLE_Z] = x, y, z
    found[b, INSTANT] = time


@njit(cache=True, error_model="numpy", _nrt=False)
def _set_layer(waves, sums, first, degree, solid, start):
    """Sum cosines and sines, rows of sums from `first`, to the coefficients of a layer."""
    many = waves.shape[1]
    i = 0
    for m in range(WAVE_DEGREE + 1):
        for n in range(WAVE_DEGREE + 1 - m):
            if m + n <= degree:
                row = first + ((m + n) & 1)
                j = start + i - _beyond(m, degree)
                solid[j] = sum_products(waves, TAYLOR + i, sums, row, many)
            i += 1


@njit(cache=True, error_model="numpy", inline="always")
def _beyond(m, degree):
    """How many coefficients before x^m a layer of `WAVE_DEGREE` has more than one of a degree."""
    return m * (WAVE_DEGREE - degree)


@njit(cache=True, error_model="numpy", _nrt=False, fastmath={"reassoc", "contract"})
def _set_sums(blocks, sums, line, solid, still):
    """Sum up the waves about a height in still water: the rise, the rest, and the mean."""
    waves, many = blocks.waves, blocks.waves.shape[1]
    lost = 0.0
    for w in range(many):
        k, bottom = waves[K, w], waves[BOTTOM, w]
        down = exponential(k * still)
        echo, most = bottom / down, 1.0 - bottom
        wide, narrow, tanh = (down + echo) / most, (down - echo) / most, most / (1.0 + bottom)
        cosine, sine = sums[0, w], sums[1, w]
        sums[2, w], sums[3, w] = narrow * cosine, narrow * sine
        sums[4, w], sums[5, w] = k * wide * cosine, k * wide * sine
        over, bend = wide * tanh - narrow, k * (narrow * tanh - wide)
        sums[6, w], sums[7, w] = over * cosine, over * sine
        sums[8, w], sums[9, w] = bend * cosine, bend * sine

        # sinh^2 is half of cosh less one
        square = waves[SQUARE, w]
        half = 0.5 * square * (wide * wide + narrow * narrow)
        sums[10, w], sums[11, w] = half, square * wide * narrow
        lost += square * narrow * narrow - half
    _set_layer(waves, sums, 2, WAVE_DEGREE, solid, SOLID)
    _set_layer(waves, sums, 4, WAVE_DEGREE - 1, solid, SOLID + FLAT)
    deepen(solid, SOLID, WAVE_DEGREE)
    if blocks.layout[SHALLOW] > 0.0:
        _set_layer(waves, sums, 6, WAVE_DEGREE, solid, 2 * SOLID)
        _set_layer(waves, sums, 8, WAVE_DEGREE - 1, solid, 2 * SOLID + FLAT)
        deepen(solid, 2 * SOLID, WAVE_DEGREE)
    _set_mean(waves, sums, line)
    line[0] += lost


@njit(cache=True, error_model="numpy", _nrt=False, fastmath={"reassoc", "contract"})
def _set_mean(waves, sums, line):
    """Sum up what the waves take off the mean head, as a polynomial in the height."""
    many = waves.shape[1]
    for n in range(POWERS + 1):
        total, here, inverse = 0.0, 10 + (n & 1), 2.0 / (n + 1)
        for w in range(many):
            total += sums[here, w]
        line[n] = total

        # powers of 2 k z over factorials, once for the even and once for the odd
        for w in range(many):
            sums[10, w] *= inverse * waves[K, w]
            sums[11, w] *= inverse * waves[K, w]


@njit(cache=True, error_model="numpy", _nrt=False)
def _sum_tide(blocks, sums):
    """What all the water rises."""
    if blocks.layout[TIDAL] == 0.0:
        return 0.0
    return sum_products(blocks.waves, TIDE, sums, 0, blocks.waves.shape[1])


@njit(cache=True, error_model="numpy", _nrt=False)
def _set_heads(layout, line, solid, room, z, still, tide):
    """Write the heads of waves at the points to row FOUND."""
    eta, guess, away = room[3 + ETA], room[3 + STILL], room[3 + AWAY]
    for n in range(SAMPLES):
        guess[n] = _guess(z + room[2, n], eta[n], layout[FALL], layout[DEPTH])
        away[n] = guess[n] - still
        room[3 + OVER, n] = room[3 + BEND, n] = 0.0
        room[3 + LESS, n] = on_powers(line, POWERS, away[n])
    x, y, row, level = room[0], room[1], room[3 + LINE], room[3 + LEVEL]
    set_in_space_at_many(
        solid, SOLID, WAVE_DEGREE, x, y, away, SAMPLES, row, level,
        room[3 + UP], room[3 + STRAIN],
    )  # fmt: skip
    if layout[SHALLOW] > 0.0:
        set_in_space_at_many(
            solid, 2 * SOLID, WAVE_DEGREE, x, y, away, SAMPLES, row, level,
            room[3 + OVER], room[3 + BEND],
        )  # fmt: skip
    whole = layout[WHOLE]
    for n in range(SAMPLES):
        room[3 + FOUND, n] = settle(
            z + room[2, n], guess[n], room[3 + UP, n], room[3 + STRAIN, n], room[3 + OVER, n],
            room[3 + BEND, n], tide, room[3 + LESS, n], whole,
        )  # fmt: skip


@njit(cache=True, error_model="numpy", inline="always")
def _guess(z, eta, fall, depth):
    """`still_water.still_height`, which goes on above the surface and below the bottom."""
    below, left = z - eta, 1.0
    if depth < math.inf:
        below *= depth / (depth + eta) if depth + eta > 0.0 else 1.0
        left = 1.0 + below / depth
    # a fraction in place of e^-x
    x = max(-fall * below, 0.0)
    left /= 1.0 + x * (1.0 + x * (0.5 + x * (1.0 / 6.0)))
    return below if below >= 0.0 else min(z - eta * left, 0.0)


@njit(cache=True, error_model="numpy", inline="always")
def head_at(sea, blocks, store, x, y, z, time, dynamic):
    """The head at a place; see `fill` for the arguments."""
    layout, found = blocks.layout, store.found
    b, mx, my, mz = find_block(layout, x, y, z)
    if not is_known(found, b, mx, my, mz, time):
        fill(sea, blocks, store, b, mx, my, mz, time, dynamic)
    return head_in(layout, found, b, x, y, z)


@njit(cache=True, error_model="numpy", _nrt=False)
def head_in(layout, found, b, x, y, z):
    """The head of a block at a place."""
    scale = 1.0 / layout[REACH]
    u, v = (x - found[b, MIDDLE_X]) * scale, (y - found[b, MIDDLE_Y]) * scale
    w = (z - found[b, MIDDLE_Z]) * scale
    i, total = HEAD + NUMBERS, 0.0
    for p in range(DEGREE, -1, -1):
        level = 0.0
        for m in range(DEGREE - p, -1, -1):
            row = 0.0
            for _ in range(DEGREE - p - m + 1):
                i -= 1
                row = row * v + found[b, i]
            level = level * u + row
        total = total * w + level
    return total


@njit(cache=True, error_model="numpy", _nrt=False)
def quadratic_in(layout, found, b, x, y, z, s):
    """The head of a block about a place, as a quadratic, by its values at 13 places up to s away.

    Returns its value, its gradient (3), and its coefficients of x^2, y^2, z^2, x y, x z and y z.
    """
    p = head_in(layout, found, b, x, y, z)
    px, nx = head_in(layout, found, b, x + s, y, z), head_in(layout, found, b, x - s, y, z)
    py, ny = head_in(layout, found, b, x, y + s, z), head_in(layout, found, b, x, y - s, z)
    pz, nz = head_in(layout, found, b, x, y, z + s), head_in(layout, found, b, x, y, z - s)
    xy = head_in(layout, found, b, x + s, y + s, z) + head_in(layout, found, b, x - s, y - s, z)
    xz = head_in(layout, found, b, x + s, y, z + s) + head_in(layout, found, b, x - s, y, z - s)
    yz = head_in(layout, found, b, x, y + s, z + s) + head_in(layout, found, b, x, y - s, z - s)
    return join_values(s, p, (px, nx, py, ny, pz, nz), (xy, xz, yz))


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def join_values(s, p, along, across):
    """A quadratic from its value p, those s away along each axis, and sums of two across."""
    px, nx, py, ny, pz, nz = along
    xy, xz, yz = across
    step, square = 0.5 / s, 0.5 / (s * s)
    return (
        p, (step * (px - nx), step * (py - ny), step * (pz - nz)),
        (
            square * (px + nx - 2.0 * p),
            square * (py + ny - 2.0 * p),
            square * (pz + nz - 2.0 * p),
            square * (xy - px - nx - py - ny + 2.0 * p),
            square * (xz - px - nx - pz - nz + 2.0 * p),
            square * (yz - py - ny - pz - nz + 2.0 * p),
        ),
    )  # fmt: skip
