"""The surface of a sea of many waves in square tiles, each with one polynomial of the elevation.

Tiles lie side by side on the still level, wherever a hull is. The first who asks for the elevation
in a tile at an instant has it filled: one sum over the waves. All who ask after that evaluate its
polynomial. It depends on the tile, the waves and the instant alone, so that whoever asks, and in
whichever order, finds the same.

The polynomial holds in a square somewhat wider than its tile. What lies about a place of the tile
can thereby be evaluated by one polynomial at once.

Waves that are too short for tiles, and all where they are few, stand last and are summed one by
one. `submersion.sea_tables` chooses the size of the tiles and the degree of the polynomials.
"""

import math
from typing import Annotated, NamedTuple

from buoyancy_mj.kernels.arrays import Doubles
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.polynomials import LARGEST, size
from buoyancy_mj.kernels.series import turn

SIDE, REACH, HELD, DEGREE, TURNING, HEIGHT, STEEPNESS, CURVATURE, TWIST, ROUNDING = range(10)
PER_SIDE, PER_REACH = 10, 11
"""Numbers of `Tiles.layout`: side of a tile [m]; half the side of the square in which its
polynomial holds [m]; how many waves tiles hold; the degree of their polynomials; the wave number by
which ways are divided into panels, see `swell.waterplane_moments` [rad/m]; sums of a, a k, a k^2
and a k^3 over all waves, which bound elevation, slope, curvature and its change; and what the tiles
leave out of second derivatives [1/m]; and one over the first two [1/m]."""
AMPLITUDE, KX, KY, OMEGA, PHASE, SHARES = range(6)
"""Rows of `Tiles.waves`: as the columns of `kernels.waves`; and from SHARES on what the cosine or
the sine of the phase of each wave in the middle of a tile adds to each coefficient, the cosine to
those of even degree, the sine to the others."""
ALONG = 16
"""Tiles along one side of the store; those that are as many tiles apart share a place in it."""
TILES = ALONG * ALONG
"""Tiles that are kept."""
NUMBERS = size.py_func(LARGEST)
"""Coefficients of a polynomial, at most."""
MIDDLE_X, MIDDLE_Y, INSTANT, FLAT = range(4)
"""Columns of `TileStore.found`: the middle of the tile [m], and the instant, which say which tile
it is; and from FLAT on its polynomial, in parts of `REACH` from the middle."""


class Tiles(NamedTuple):
    """The waves of a sea, the longest first, and how they make up tiles."""

    layout: Annotated[Doubles, (12,)]
    """Numbers `SIDE` to `PER_REACH`."""
    waves: Annotated[Doubles, (SHARES + NUMBERS, "w")]
    """Rows `AMPLITUDE` to `SHARES` and behind."""


class TileStore(NamedTuple):
    """The tiles that are known, for one thread; new ones are zero."""

    found: Annotated[Doubles, (TILES, FLAT + NUMBERS)]
    """Columns `COLUMN` to `FLAT` and behind."""
    phases: Annotated[Doubles, (2, "w")]
    """Cosines and sines in the middle of a tile; scratch."""


@njit(cache=True, error_model="numpy", inline="always")
def find_tile(layout, waves, found, phases, x, y, time):
    """The tile at a place, as its row in the store; the arrays are of `Tiles` and `TileStore`."""
    side, per_side = layout[SIDE], layout[PER_SIDE]
    i, j = math.floor(x * per_side), math.floor(y * per_side)
    t = (int(i) & (ALONG - 1)) * ALONG + (int(j) & (ALONG - 1))
    mx, my = (i + 0.5) * side, (j + 0.5) * side
    if found[t, MIDDLE_X] != mx or found[t, MIDDLE_Y] != my or found[t, INSTANT] != time:
        _fill(layout, waves, found, phases, t, mx, my, time)
    return t


@njit(cache=True, error_model="numpy", _nrt=False)
def _fill(layout, waves, found, phases, t, x, y, time):
    """Sum the waves up in a tile, whose middle is given."""
    held, degree = int(layout[HELD]), int(layout[DEGREE])
    set_phases(waves, held, x, y, time, phases)
    i = 0
    for m in range(degree + 1):
        for n in range(degree + 1 - m):
            found[t, FLAT + i] = sum_products(waves, SHARES + i, phases, (m + n) & 1, held)
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


@njit(cache=True, error_model="numpy", inline="always")
def elevation_in(layout, found, t, x, y):
    """The elevation of a tile at a place."""
    scale = layout[PER_REACH]
    u, v = (x - found[t, MIDDLE_X]) * scale, (y - found[t, MIDDLE_Y]) * scale
    return _value(found, t, int(layout[DEGREE]), u, v)


@njit(cache=True, error_model="numpy", _nrt=False)
def _value(found, t, degree, u, v):
    """A tile's polynomial, by Horner's rule."""
    i = FLAT + size(degree)
    total = 0.0
    for m in range(degree, -1, -1):
        row = 0.0
        for _ in range(degree - m + 1):
            i -= 1
            row = row * v + found[t, i]
        total = total * u + row
    return total


@njit(cache=True, error_model="numpy", inline="always")
def tangent_in(layout, found, t, x, y):
    """The elevation of a tile at a place, and its gradient."""
    scale = layout[PER_REACH]
    u, v = (x - found[t, MIDDLE_X]) * scale, (y - found[t, MIDDLE_Y]) * scale
    e, along, across = _value_and_slope(found, t, int(layout[DEGREE]), u, v)
    return e, along * scale, across * scale


@njit(cache=True, error_model="numpy", _nrt=False)
def _value_and_slope(found, t, degree, u, v):
    """A tile's polynomial and its gradient, by Horner's rule."""
    i = FLAT + size(degree)
    total = along = across = 0.0
    for m in range(degree, -1, -1):
        row = change = 0.0
        for _ in range(degree - m + 1):
            i -= 1
            change = change * v + row
            row = row * v + found[t, i]
        along = along * u + total
        total = total * u + row
        across = across * u + change
    return total, along, across


@njit(cache=True, error_model="numpy", _nrt=False)
def second_derivatives_in(layout, found, t, x, y):
    """The second derivatives of the elevation of a tile at a place: xx, xy, yy."""
    scale = layout[PER_REACH]
    u, v = (x - found[t, MIDDLE_X]) * scale, (y - found[t, MIDDLE_Y]) * scale
    degree = int(layout[DEGREE])
    i = FLAT + size(degree)
    total = across = xx = xy = yy = along = 0.0
    for m in range(degree, -1, -1):
        row = change = bend = 0.0
        for _ in range(degree - m + 1):
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


@njit(cache=True, error_model="numpy", inline="always")
def is_near(layout, found, t, x, y):
    """Whether the polynomial of a tile holds at a place."""
    reach = layout[REACH]
    return abs(x - found[t, MIDDLE_X]) <= reach and abs(y - found[t, MIDDLE_Y]) <= reach


@njit(cache=True, error_model="numpy", _nrt=False)
def four_elevations(layout, waves, found, phases, xs, ys, time):
    """Elevations at four places, which the processor finds side by side.

    They are given in pairs of neighbours, as on a line; all may be in one tile.
    """
    (x0, x1, x2, x3), (y0, y1, y2, y3) = xs, ys
    t = find_tile(layout, waves, found, phases, x1, y1, time)
    near = is_near(layout, found, t, x0, y0) and is_near(layout, found, t, x2, y2)
    if not (near and is_near(layout, found, t, x3, y3)):
        e1 = elevation_in(layout, found, t, x1, y1)
        t = find_tile(layout, waves, found, phases, x0, y0, time)
        e0 = elevation_in(layout, found, t, x0, y0)
        t = find_tile(layout, waves, found, phases, x2, y2, time)
        e2 = elevation_in(layout, found, t, x2, y2)
        t = find_tile(layout, waves, found, phases, x3, y3, time)
        return e0, e1, e2, elevation_in(layout, found, t, x3, y3)

    scale, mx, my = layout[PER_REACH], found[t, MIDDLE_X], found[t, MIDDLE_Y]
    u0, u1, u2, u3 = (x0 - mx) * scale, (x1 - mx) * scale, (x2 - mx) * scale, (x3 - mx) * scale
    v0, v1, v2, v3 = (y0 - my) * scale, (y1 - my) * scale, (y2 - my) * scale, (y3 - my) * scale
    degree = int(layout[DEGREE])
    i = FLAT + size(degree)
    e0 = e1 = e2 = e3 = 0.0
    for m in range(degree, -1, -1):
        r0 = r1 = r2 = r3 = 0.0
        for _ in range(degree - m + 1):
            i -= 1
            c = found[t, i]
            r0, r1, r2, r3 = r0 * v0 + c, r1 * v1 + c, r2 * v2 + c, r3 * v3 + c
        e0, e1, e2, e3 = e0 * u0 + r0, e1 * u1 + r1, e2 * u2 + r2, e3 * u3 + r3
    return e0, e1, e2, e3


@njit(cache=True, error_model="numpy", _nrt=False)
def _add_at_many(layout, found, t, mx, my, scale, x, y, count, row, total, out):
    """Add a tile's polynomial, from its middle, at `count` places to `out`, by Horner's rule."""
    degree = int(layout[DEGREE])
    i = FLAT + size(degree)
    for n in range(count):
        total[n] = 0.0
    for m in range(degree, -1, -1):
        for n in range(count):
            row[n] = 0.0
        for _ in range(degree - m + 1):
            i -= 1
            c = found[t, i]
            for n in range(count):
                row[n] = row[n] * ((y[n] - my) * scale) + c
        for n in range(count):
            total[n] = total[n] * ((x[n] - mx) * scale) + row[n]
    for n in range(count):
        out[n] += total[n]


@njit(cache=True, error_model="numpy", _nrt=False)
def add_elevations(layout, waves, found, phases, place, x, y, count, time, row, total, out):
    """Add the elevations of tiles at `count` places x, y from a place to `out`.

    Where all are near the first, its tile answers for all at once, else four by four. `row` and
    `total` are scratch.
    """
    if count == 0:
        return
    x0, y0 = place
    t = find_tile(layout, waves, found, phases, x0 + x[0], y0 + y[0], time)
    mx, my, scale = found[t, MIDDLE_X] - x0, found[t, MIDDLE_Y] - y0, layout[PER_REACH]
    far = 0.0
    for n in range(count):
        far = max(far, max(abs(x[n] - mx), abs(y[n] - my)))
    if far <= layout[REACH]:
        _add_at_many(layout, found, t, mx, my, scale, x, y, count, row, total, out)
        return
    n = 0
    while n < count:
        # the last ones more than once
        i, j, k = min(n + 1, count - 1), min(n + 2, count - 1), min(n + 3, count - 1)
        xs = (x0 + x[n], x0 + x[i], x0 + x[j], x0 + x[k])
        ys = (y0 + y[n], y0 + y[i], y0 + y[j], y0 + y[k])
        e = four_elevations(layout, waves, found, phases, xs, ys, time)
        out[n] += e[0]
        if n + 1 < count:
            out[i] += e[1]
        if n + 2 < count:
            out[j] += e[2]
        if n + 3 < count:
            out[k] += e[3]
        n += 4


@njit(cache=True, error_model="numpy", _nrt=False)
def tangent_at(layout, waves, found, phases, x, y, time):
    """The elevation of all waves at a place, and its gradient."""
    held = int(layout[HELD])
    eta = along = across = 0.0
    if held > 0:
        t = find_tile(layout, waves, found, phases, x, y, time)
        eta, along, across = tangent_in(layout, found, t, x, y)
    for w in range(held, waves.shape[1]):
        amplitude, kx, ky = waves[AMPLITUDE, w], waves[KX, w], waves[KY, w]
        angle = kx * x + ky * y - waves[OMEGA, w] * time + waves[PHASE, w]
        slope = amplitude * math.sin(angle)
        eta += amplitude * math.cos(angle)
        along -= kx * slope
        across -= ky * slope
    return eta, along, across


@njit(cache=True, error_model="numpy", _nrt=False)
def swing(layout, waves, found, phases, x, y, time, radius):
    """Elevation at a place, and bounds within a radius: how much it differs, and is curved."""
    held = int(layout[HELD])
    eta = along = across = hxx = hxy = hyy = 0.0
    if held > 0:
        t = find_tile(layout, waves, found, phases, x, y, time)
        eta, along, across = tangent_in(layout, found, t, x, y)
        hxx, hxy, hyy = second_derivatives_in(layout, found, t, x, y)
    for w in range(held, waves.shape[1]):
        amplitude, kx, ky = waves[AMPLITUDE, w], waves[KX, w], waves[KY, w]
        angle = kx * x + ky * y - waves[OMEGA, w] * time + waves[PHASE, w]
        crest, slope = amplitude * math.cos(angle), amplitude * math.sin(angle)
        eta += crest
        along -= kx * slope
        across -= ky * slope
        hxx -= crest * kx * kx
        hxy -= crest * kx * ky
        hyy -= crest * ky * ky

    # the values at the place, and by how much they can differ elsewhere
    bent = math.sqrt(hxx * hxx + 2.0 * hxy * hxy + hyy * hyy) + layout[ROUNDING]
    curvature = min(layout[CURVATURE], bent + layout[TWIST] * radius)
    steepness = min(layout[STEEPNESS], math.hypot(along, across) + curvature * radius)
    return eta, min(2.0 * layout[HEIGHT], steepness * radius), curvature
