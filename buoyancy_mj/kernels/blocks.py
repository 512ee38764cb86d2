"""The pressure of a sea in cubic blocks of water, each with one polynomial of the head.

Blocks fill the space, as tiles cover the surface, see `tiles`: the first who asks for the pressure
in a block at an instant has it filled, all who ask after that evaluate its polynomial.

The polynomial is fitted to the head at some points of the block, see `block_filling`.
"""

import math
from typing import Annotated, NamedTuple

from buoyancy_mj.kernels.arrays import Doubles
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.polynomials import in_space, size, size_in_space

SIDE, REACH, FALL, DEPTH, WHOLE, TIDAL, SHALLOW = range(7)
"""Numbers of `Blocks.layout`: side of a block [m]; half the side of the cube in which its
polynomial holds [m]; `still_water.decay` of the waves; the depth of the water; what the waves take
off the mean head at the still level; whether all the water rises and falls; whether any wave feels
the bottom."""
DEGREE = 5
"""Degree of the polynomial of the head."""
WAVE_DEGREE = 6
"""Degree of the polynomials of what waves sum up to."""
POWERS = 8
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
SAMPLES = 72
"""Points at which the head in a block is found."""
ALONG, DOWN = 16, 4
"""Blocks along a side of the store, and along its height."""
MIDDLE_X, MIDDLE_Y, MIDDLE_Z, INSTANT, HEAD = range(5)
"""Columns of `BlockStore.found`: the middle of a block, from the still level [m], and the instant,
which say which block it is; and from HEAD on its polynomial, in parts of `REACH` from the middle.
"""
X, Y, Z, ETA, STILL, AWAY, UP, STRAIN, OVER, BEND, LESS, FOUND, ROOM = range(13)
"""Rows of `BlockStore.room`, and how many: places; the elevation there; a guess of the height in
still water, and that from the middle; the water's rise and its slope, the rest of the head and its
slope, and what the waves take off the mean head, as in `still_water.settle`; the head."""


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
    room: Annotated[Doubles, (ROOM, SAMPLES)]
    """Rows `X` to `FOUND` at places; scratch."""
    solid: Annotated[Doubles, (3 * SOLID,)]
    """Polynomials of the elevation, of the rise and of the rest of the head; scratch."""
    slope: Annotated[Doubles, (SOLID,)]
    """The slope of one of the latter along z; scratch."""
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


@njit(cache=True, error_model="numpy", _nrt=False, fastmath={"contract"})
def set_heads_in(found, b, room, count):
    """Write the head of a block at `count` places, rows `X` to `Z` of the room, to row `FOUND`.

    They are in parts of `REACH` from its middle.
    """
    polynomial = found[b]
    for n in range(count):
        room[FOUND, n] = in_space(polynomial, HEAD, DEGREE, room[X, n], room[Y, n], room[Z, n])
