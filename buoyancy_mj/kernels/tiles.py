"""The surface of a sea of many waves in square tiles, each with one polynomial of the elevation.

Tiles lie side by side on the still level, wherever a hull is. The first who asks for the elevation
in a tile at an instant has it filled: one sum over the waves. All who ask after that evaluate its
polynomial. It depends on the tile, the waves and the instant alone, so that whoever asks, and in
whichever order, finds the same.

The polynomial holds in a square somewhat wider than its tile. What lies about a place of the tile
can thereby be evaluated by one polynomial at once.

Waves that are too short for tiles, and all where they are few, stand last and are summed one by
one. `submersion.sea_tiles` chooses the size of the tiles.
"""

import math
from typing import Annotated, NamedTuple

from buoyancy_mj.kernels.arrays import Doubles
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.polynomials import in_plane, size
from buoyancy_mj.kernels.series import turn

SIDE, REACH, HELD, TURNING, HEIGHT, STEEPNESS, CURVATURE, TWIST, ROUNDING = range(9)
PER_SIDE, PER_REACH = 9, 10
"""Numbers of `Tiles.layout`: side of a tile [m]; half the side of the square in which its
polynomial holds [m]; how many waves tiles hold; the wave number by which ways are divided into
panels, see `strips.waterplane_moments` [rad/m]; sums of a, a k, a k^2 and a k^3 over all waves,
which bound elevation, slope, curvature and its change; what the tiles leave out of second
derivatives [1/m]; and one over the first two [1/m]."""
AMPLITUDE, KX, KY, OMEGA, PHASE, SHARES = range(6)
"""Rows of `Tiles.waves`: as the columns of `kernels.waves`; and from SHARES on what the cosine or
the sine of the phase of each wave in the middle of a tile adds to each coefficient, the cosine to
those of even degree, the sine to the others."""
ALONG = 16
"""Tiles along one side of the store; those that are as many tiles apart share a place in it."""
TILES = ALONG * ALONG
"""Tiles that are kept."""
DEGREE = 8
"""Degree of the polynomials."""
NUMBERS = size.py_func(DEGREE)
"""Coefficients of each."""
RUN = 64
"""Places at which elevations are found together, at most."""
LANES = 8
"""Places that a processor takes at once, or a multiple of that."""
MIDDLE_X, MIDDLE_Y, INSTANT, FLAT = range(4)
"""Columns of `TileStore.found`: the middle of the tile [m], and the instant, which say which tile
it is; and from FLAT on its polynomial, in parts of `REACH` from the middle."""


class Tiles(NamedTuple):
    """The waves of a sea, the longest first, and how they make up tiles."""

    layout: Annotated[Doubles, (11,)]
    """Numbers `SIDE` to `PER_REACH`."""
    waves: Annotated[Doubles, (SHARES + NUMBERS, "w")]
    """Rows `AMPLITUDE` to `SHARES` and behind."""


class TileStore(NamedTuple):
    """The tiles that are known, for one thread; new ones are zero."""

    found: Annotated[Doubles, (TILES, FLAT + NUMBERS)]
    """Columns `MIDDLE_X` to `FLAT` and behind."""
    phases: Annotated[Doubles, (2, "w")]
    """Cosines and sines in the middle of a tile; scratch."""
    room: Annotated[Doubles, (3, RUN)]
    """Places in a tile, in parts of `REACH` from its middle, and the elevations there; scratch."""


@njit(cache=True, error_model="numpy", inline="always")
def find_tile(tiles, store, x, y, time):
    """The tile at a place, as its row in a store."""
    layout, found = tiles.layout, store.found
    side, per_side = layout[SIDE], layout[PER_SIDE]
    i, j = math.floor(x * per_side), math.floor(y * per_side)
    t = (int(i) & (ALONG - 1)) * ALONG + (int(j) & (ALONG - 1))
    mx, my = (i + 0.5) * side, (j + 0.5) * side
    if found[t, MIDDLE_X] != mx or found[t, MIDDLE_Y] != my or found[t, INSTANT] != time:
        _fill(tiles, store, t, mx, my, time)
    return t


@njit(cache=True, error_model="numpy", _nrt=False)
def _fill(tiles, store, t, x, y, time):
    """Sum the waves up in a tile, whose middle is given."""
    found, phases, held = store.found, store.phases, int(tiles.layout[HELD])
    set_phases(tiles.waves, held, x, y, time, phases)
    i = 0
    for m in range(DEGREE + 1):
        for n in range(DEGREE + 1 - m):
            found[t, FLAT + i] = sum_products(tiles.waves, SHARES + i, phases, (m + n) & 1, held)
            i += 1
    found[t, MIDDLE_X], found[t, MIDDLE_Y], found[t, INSTANT] = x, y, time


@njit(cache=True, error_model="numpy", _nrt=False)
def set_phases(waves, count, x, y, time, out):
    """Write cosine and sine of the phases of the first `count` waves at a place, to two rows."""
    for w in range(count):
        late = waves[PHASE, w] - waves[OMEGA, w] * time
        out[0, w], out[1, w] = turn(waves[KX, w] * x + waves[KY, w] * y + late)


@njit(cache=True, error_model="numpy", _nrt=False, fastmath={"reassoc", "contract"})
def sum_products(a, i, b, j, count):
    """The sum of the products of the first `count` numbers of two rows, in any order."""
    total = 0.0
    for w in range(count):
        total += a[i, w] * b[j, w]
    return total


@njit(cache=True, error_model="numpy", _nrt=False, fastmath={"contract"})
def tangent_in(tiles, store, t, x, y):
    """The elevation of a tile at a place, and its gradient."""
    scale, found = tiles.layout[PER_REACH], store.found
    u, v = (x - found[t, MIDDLE_X]) * scale, (y - found[t, MIDDLE_Y]) * scale
    i = FLAT + NUMBERS
    total = along = across = 0.0
    for m in range(DEGREE, -1, -1):
        row = change = 0.0
        for _ in range(DEGREE - m + 1):
            i -= 1
            change = change * v + row
            row = row * v + found[t, i]
        along = along * u + total
        total = total * u + row
        across = across * u + change
    return total, along * scale, across * scale


@njit(cache=True, error_model="numpy", _nrt=False)
def second_derivatives_in(tiles, store, t, x, y):
    """The second derivatives of the elevation of a tile at a place: xx, xy, yy."""
    scale, found = tiles.layout[PER_REACH], store.found
    u, v = (x - found[t, MIDDLE_X]) * scale, (y - found[t, MIDDLE_Y]) * scale
    i = FLAT + NUMBERS
    total = across = xx = xy = yy = along = 0.0
    for m in range(DEGREE, -1, -1):
        row = change = bend = 0.0
        for _ in range(DEGREE - m + 1):
            i -= 1
            bend = bend * v + change
            change = change * v + row
            row = row * v + found[t, i]
        xx = xx * u + along
        along = along * u + total
        total = total * u + row
        xy = xy * u + across
        across = across * u + change
        yy = yy * u + bend
    square = scale * scale
    return 2.0 * xx * square, xy * square, 2.0 * yy * square


@njit(cache=True, error_model="numpy", _nrt=False)
def add_elevations(tiles, store, place, x, y, count, time, out):
    """Add the elevations of tiles at `count` places x, y from a place to `out`.

    As many as follow each other near one tile are found together.
    """
    (x0, y0), scale, room, first = place, tiles.layout[PER_REACH], store.room, 0
    while first < count:
        t = find_tile(tiles, store, x0 + x[first], y0 + y[first], time)
        mx, my, n = store.found[t, MIDDLE_X] - x0, store.found[t, MIDDLE_Y] - y0, 0
        while n < RUN and first + n < count:
            u, v = (x[first + n] - mx) * scale, (y[first + n] - my) * scale
            if abs(u) > 1.0 or abs(v) > 1.0:
                break
            room[0, n], room[1, n] = u, v
            n += 1

        # the last ones may be of no use
        _set_at_many(store.found, t, room, (n + LANES - 1) // LANES * LANES)
        for i in range(n):
            out[first + i] += room[2, i]
        first += n


@njit(cache=True, error_model="numpy", _nrt=False, fastmath={"contract"})
def _set_at_many(found, t, room, count):
    """Write the polynomial of a tile at `count` places to the last row of the room."""
    polynomial = found[t]
    for n in range(count):
        room[2, n] = in_plane(polynomial, FLAT, DEGREE, room[0, n], room[1, n])
