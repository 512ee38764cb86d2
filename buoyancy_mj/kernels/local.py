"""The waves around a hull as polynomials, by which many of them cost little more than a few.

About the middle of a hull the elevation of a wave, A cos(k.x + phase), is a series in k.x, and the
series of all waves are one polynomial, of the degree that `planning` says; waves that are too short
for it stay as they are. Pressure follows from sums of waves at the height where the water stood in
still water, see `waves.head`. Each is a polynomial in x, y and that height: with its Laplacian
zero, all of it follows from two layers, its value on a level and its slope there.

All that is gathered for a hull stands in one row of numbers, which costs less to hand on than
several.
"""

import math

from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.planning import MOST, remainder
from buoyancy_mj.kernels.polynomials import (
    add_at_many,
    add_powers,
    add_series,
    deepen,
    on_powers,
    set_in_space_at_many,
    size,
    size_in_space,
    with_gradient,
)
from buoyancy_mj.kernels.still_water import decay, fade, seabed, settle, still_height
from buoyancy_mj.kernels.vectors import triple
from buoyancy_mj.kernels.waves import AMPLITUDE, DEPTH, KX, KY, OMEGA, PHASE, phase_at

FLAT = size.py_func(MOST)
"""Coefficients of a polynomial in x, y, at most."""
SOLID = size_in_space.py_func(MOST)
"""Coefficients of one in x, y, z, at most."""
COUNT, MANY, DEGREE, X, Y, MIDDLE, BOTTOM, FALL, TIDE, WHOLE, SHALLOW, SURFACE = range(12)
"""Columns of a row: how many waves are near, and are in all; the degree; the middle, and its height
in still water; the depth of the water; `still_water.decay` of the waves; what all the water rises,
and what the waves take off the mean head at the still level; the degree of the polynomial of REST,
0 if no wave in it feels the bottom; from SURFACE on the polynomial of the elevation."""
RISE = SURFACE + FLAT
"""First column of the polynomial of the water's rise, sum eta S in `waves.head`."""
REST = RISE + SOLID
"""First column of that of the rest of the head, sum eta (C - S); in deep water there is none."""
MEAN = REST + SOLID
"""First column of the polynomial, in the height, of what the waves take off the mean head."""
NEAR = MEAN + MOST + 1
"""First column of the near waves, which have `WAVE` numbers each, as in `kernels.waves`."""
WAVE = 7
HEAD, ETA, STILL, UP, STRAIN, OVER, BEND, LESS, ROOM = 3, 4, 5, 6, 7, 8, 9, 10, 14
"""Rows of a room for many places, after x and y from the middle and z from the still level: the
head or the elevation there; the elevation; a guess of the height in still water; the water's rise
and its slope, the rest of the head and its slope, and what the waves take off the mean head, all
as in `still_water.settle`; three rows of scratch; and how many rows there are."""
_SCRATCH = 11
"""First row of scratch."""


@njit(cache=True, error_model="numpy")
def gather(waves, x, y, z, eta, time, radius, degree, limit, bottom_degree, dynamic, near):
    """Bring the waves around a place, given from the still level, into a row `near`.

    The degrees and the limit are the `planning.plan` of a hull there.

    Waves that the polynomials do not hold are copied as they are; all others go into that of the
    surface, and with `dynamic` into that of the pressure. The row has NEAR numbers, and `WAVE` for
    each wave; `eta` is the elevation over the place.
    """
    many = waves.shape[0]
    near[:NEAR] = 0.0
    count, layer = 0, size(degree)
    fall, depth = _set_whole(waves, near) if dynamic else (0.0, math.inf)
    still = still_height(z, eta, fall, depth)
    for w in range(many):
        amplitude, kx, ky = triple(waves, w, AMPLITUDE)
        phase = phase_at(waves, w, x, y, time)
        crest, slope = amplitude * math.cos(phase), amplitude * math.sin(phase)
        k = math.sqrt(kx * kx + ky * ky)
        if k == 0.0:
            near[TIDE] += crest

        # too short a wave
        if remainder(waves, w, radius) > limit:
            for c in range(WAVE):
                near[NEAR + WAVE * count + c] = waves[w, c]
            count += 1
            continue

        # the others
        add_series(near, SURFACE, degree, crest, slope, kx, ky)
        if not dynamic:
            continue
        bottom = seabed(k, waves[w, DEPTH])
        wide, narrow, tanh = fade(k, bottom, still)
        a, b = narrow, k * wide
        add_series(near, RISE, degree, a * crest, a * slope, kx, ky)
        add_series(near, RISE + layer, degree - 1, b * crest, b * slope, kx, ky)

        # sinh^2 is half of cosh less one
        square = 0.5 * k * tanh * amplitude * amplitude
        half = 0.5 * square * (wide * wide + narrow * narrow)
        add_powers(near, MEAN, half, square * wide * narrow, 2.0 * k)
        near[MEAN] += square * narrow * narrow - half
        if bottom > 0.0:
            near[SHALLOW], n = bottom_degree, bottom_degree
            a, b = wide * tanh - narrow, k * (narrow * tanh - wide)
            add_series(near, REST, n, a * crest, a * slope, kx, ky)
            add_series(near, REST + size(n), n - 1, b * crest, b * slope, kx, ky)
    if dynamic:
        deepen(near, RISE, degree)
    if near[SHALLOW] > 0.0:
        deepen(near, REST, bottom_degree)

    near[COUNT], near[MANY], near[DEGREE] = count, many, degree
    near[X], near[Y], near[MIDDLE], near[BOTTOM], near[FALL] = x, y, still, depth, fall


@njit(cache=True, error_model="numpy")
def _set_whole(waves, near):
    """Write column WHOLE of a row.

    Returns `still_water.decay` of all waves, and the depth of the water.
    """
    energy = weighted = whole = 0.0
    depth = math.inf
    for w in range(waves.shape[0]):
        amplitude, kx, ky = triple(waves, w, AMPLITUDE)
        k, square = math.sqrt(kx * kx + ky * ky), amplitude * amplitude
        bottom = seabed(k, waves[w, DEPTH])
        energy += square
        weighted += square * k
        whole += 0.5 * square * k * (1.0 - bottom) / (1.0 + bottom)
        depth = min(depth, waves[w, DEPTH])
    near[WHOLE] = whole
    return decay(weighted / energy if energy > 0.0 else 0.0, depth), depth


@njit(cache=True, error_model="numpy")
def surface(near, x, y, time):
    """Elevation at a place, of what was gathered, and its gradient."""
    eta = along = across = 0.0
    if near[COUNT] < near[MANY]:
        dx, dy = x - near[X], y - near[Y]
        eta, along, across = with_gradient(near, SURFACE, int(near[DEGREE]), dx, dy)
    for w in range(int(near[COUNT])):
        i = NEAR + WAVE * w
        phase = _phase(near, i, x, y, time)
        slope = near[i + AMPLITUDE] * math.sin(phase)
        eta += near[i + AMPLITUDE] * math.cos(phase)
        along -= near[i + KX] * slope
        across -= near[i + KY] * slope
    return eta, along, across


@njit(cache=True, error_model="numpy", inline="always")
def _phase(near, i, x, y, time):
    """Phase at a place of the near wave whose numbers begin at column i."""
    return near[i + KX] * x + near[i + KY] * y - near[i + OMEGA] * time + near[i + PHASE]


@njit(cache=True, error_model="numpy")
def elevations(near, room, count, time):
    """Write the elevations at `count` places, rows 0 and 1 of a room, to row HEAD."""
    eta = room[HEAD]
    for v in range(count):
        eta[v] = 0.0
    if near[COUNT] < near[MANY]:
        degree = int(near[DEGREE])
        row, total = room[_SCRATCH], room[_SCRATCH + 1]
        add_at_many(near, SURFACE, degree, room[0], room[1], count, row, total, eta)
    for w in range(int(near[COUNT])):
        i = NEAR + WAVE * w
        kx, ky, phase = near[i + KX], near[i + KY], _phase(near, i, near[X], near[Y], time)
        for v in range(count):
            eta[v] += near[i + AMPLITUDE] * math.cos(kx * room[0, v] + ky * room[1, v] + phase)


@njit(cache=True, error_model="numpy")
def heads(near, room, count, time, dynamic):
    """Write `waves.head` at `count` places, rows 0 to 2 of a room, to row HEAD."""
    z, head = room[2], room[HEAD]
    elevations(near, room, count, time)
    if dynamic:
        _set_dynamic_heads(near, room, count, time)
    else:
        for v in range(count):
            head[v] -= z[v]


@njit(cache=True, error_model="numpy")
def _set_dynamic_heads(near, room, count, time):
    """Write the heads of waves to row HEAD, which holds the elevations."""
    z, head, eta, still = room[2], room[HEAD], room[ETA], room[STILL]
    rise, strain, rest, bend, mean = room[UP], room[STRAIN], room[OVER], room[BEND], room[LESS]
    fall, depth, tide, whole = near[FALL], near[BOTTOM], near[TIDE], near[WHOLE]
    for v in range(count):
        eta[v] = head[v]
        still[v] = still_height(z[v], eta[v], fall, depth)
        rise[v] = strain[v] = rest[v] = bend[v] = mean[v] = 0.0
    if near[COUNT] < near[MANY]:
        _add_held(near, room, count)
    for w in range(int(near[COUNT])):
        _add_near(near, NEAR + WAVE * w, room, count, time)
    for v in range(count):
        head[v] = settle(z[v], still[v], rise[v], strain[v], rest[v], bend[v], tide, mean[v], whole)


@njit(cache=True, error_model="numpy")
def _add_held(near, room, count):
    """Add the waves that the polynomials hold to rows UP to LESS, which are 0."""
    x, y, still, mean = room[0], room[1], room[STILL], room[LESS]
    row, level, away = room[_SCRATCH], room[_SCRATCH + 1], room[_SCRATCH + 2]
    degree, middle = int(near[DEGREE]), near[MIDDLE]
    for v in range(count):
        away[v] = still[v] - middle
        mean[v] = on_powers(near, MEAN, away[v])
    set_in_space_at_many(
        near, RISE, degree, x, y, away, count, row, level, room[UP], room[STRAIN]
    )  # fmt: skip
    if near[SHALLOW] > 0.0:
        degree = int(near[SHALLOW])
        set_in_space_at_many(
            near, REST, degree, x, y, away, count, row, level, room[OVER], room[BEND]
        )  # fmt: skip


@njit(cache=True, error_model="numpy")
def _add_near(near, i, room, count, time):
    """Add the near wave whose numbers begin at column i to rows UP to LESS."""
    x, y, eta, still, crest = room[0], room[1], room[ETA], room[STILL], room[_SCRATCH]
    rise, strain, rest, bend, mean = room[UP], room[STRAIN], room[OVER], room[BEND], room[LESS]
    amplitude, kx, ky = near[i + AMPLITUDE], near[i + KX], near[i + KY]
    k, phase = math.sqrt(kx * kx + ky * ky), _phase(near, i, near[X], near[Y], time)
    bottom = seabed(k, near[i + DEPTH])
    square = 0.5 * amplitude * amplitude * k * (1.0 - bottom) / (1.0 + bottom)

    # a single wave's elevation is known
    for v in range(count):
        crest[v] = eta[v]
    if near[MANY] > 1.0:
        for v in range(count):
            crest[v] = amplitude * math.cos(kx * x[v] + ky * y[v] + phase)

    for v in range(count):
        wide, narrow, _ = fade(k, bottom, still[v])
        rise[v] += crest[v] * narrow
        strain[v] += k * crest[v] * wide
        mean[v] += square * narrow * narrow
    if bottom > 0.0:
        for v in range(count):
            wide, narrow, tanh = fade(k, bottom, still[v])
            rest[v] += crest[v] * (wide * tanh - narrow)
            bend[v] += k * crest[v] * (narrow * tanh - wide)
