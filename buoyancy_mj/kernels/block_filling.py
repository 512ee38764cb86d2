"""The head of waves in a block, at some of its points, and the polynomial that is fitted to them.

What waves sum up to at a height where the water stood in still water is a polynomial in x, y and
that height: with its Laplacian zero, all of it follows from two layers, its value on a level and
its slope there. The head follows from these sums, see `waves.head`. It goes on above the surface
and below the bottom as smoothly as the waves do, so that a block which these cut is as good as
others; nobody asks for it there.
"""

import math

from buoyancy_mj.kernels.blocks import (
    AWAY,
    BEND,
    BOTTOM,
    DEPTH,
    ETA,
    FALL,
    FLAT,
    FOUND,
    HEAD,
    INSTANT,
    LESS,
    MIDDLE_X,
    MIDDLE_Y,
    MIDDLE_Z,
    NUMBERS,
    OVER,
    POWERS,
    REACH,
    SAMPLES,
    SHALLOW,
    SOLID,
    SQUARE,
    STILL,
    STRAIN,
    TAYLOR,
    TIDAL,
    TIDE,
    UP,
    WAVE_DEGREE,
    WHOLE,
    K,
    X,
    Y,
    Z,
)
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.polynomials import (
    deepen,
    differentiate,
    in_plane,
    in_space,
    on_powers,
)
from buoyancy_mj.kernels.series import exponential
from buoyancy_mj.kernels.still_water import settle
from buoyancy_mj.kernels.tiles import set_phases, sum_products


@njit(cache=True, error_model="numpy", _nrt=False)
def fill(sea, blocks, store, b, x, y, z, time):
    """Find the head of waves in a block: at its points, and from there its polynomial.

    Args:
        sea: `Tiles.waves`.
        blocks: `Blocks`.
        store: `BlockStore`; written.
        b: the place in it.
        x: middle of the block, as y and z from the still level [m].
        y: see x.
        z: see x.
        time: [s].
    """
    layout, reach, room = blocks.layout, blocks.layout[REACH], store.room
    many, sums, solid, found = sea.shape[1], store.sums, store.solid, store.found
    set_phases(sea, many, x, y, time, sums)
    _set_layer(blocks.waves, sums, 0, WAVE_DEGREE, solid, 0)
    for n in range(SAMPLES):
        for c in range(3):
            room[c, n] = reach * blocks.points[c, n]
    for n in range(SAMPLES):
        room[ETA, n] = in_plane(solid, 0, WAVE_DEGREE, room[X, n], room[Y, n])

    # about the height at which the water in the middle stood in still water
    still = _guess(z, solid[0], layout[FALL], layout[DEPTH])
    _set_sums(blocks, sums, store.line, solid, still)
    _set_heads(layout, store, z, still, _sum_tide(blocks, sums))
    for i in range(NUMBERS):
        found[b, HEAD + i] = sum_products(blocks.fit, i, room, FOUND, SAMPLES)
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
def _set_heads(layout, store, z, still, tide):
    """Write the heads of waves at the points to row FOUND."""
    line, solid, room = store.line, store.solid, store.room
    eta, guess, away = room[ETA], room[STILL], room[AWAY]
    for n in range(SAMPLES):
        guess[n] = _guess(z + room[Z, n], eta[n], layout[FALL], layout[DEPTH])
        away[n] = guess[n] - still
        room[OVER, n] = room[BEND, n] = 0.0
        room[LESS, n] = on_powers(line, POWERS, away[n])
    _set_values_and_slopes(solid, SOLID, store.slope, room, room[UP], room[STRAIN])
    if layout[SHALLOW] > 0.0:
        _set_values_and_slopes(solid, 2 * SOLID, store.slope, room, room[OVER], room[BEND])
    whole = layout[WHOLE]
    for n in range(SAMPLES):
        room[FOUND, n] = settle(
            z + room[Z, n], guess[n], room[UP, n], room[STRAIN, n], room[OVER, n],
            room[BEND, n], tide, room[LESS, n], whole,
        )  # fmt: skip


@njit(cache=True, error_model="numpy", _nrt=False, fastmath={"contract"})
def _set_values_and_slopes(solid, start, slope, room, out, out_slope):
    """Write what a polynomial, from `start` on, is at the points, and its slope along z."""
    differentiate(solid, start, WAVE_DEGREE, slope)
    x, y, z = room[X], room[Y], room[AWAY]
    for n in range(SAMPLES):
        out[n] = in_space(solid, start, WAVE_DEGREE, x[n], y[n], z[n])
    for n in range(SAMPLES):
        out_slope[n] = in_space(slope, 0, WAVE_DEGREE - 1, x[n], y[n], z[n])


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
