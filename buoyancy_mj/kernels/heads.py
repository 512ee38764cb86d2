"""The head of the water at places that wait: under the surface, or under waves, few or many.

Few waves are summed at each place, several places at once; many stand in blocks, see `blocks`.
"""

from typing import NamedTuple

from buoyancy_mj.kernels.block_filling import fill
from buoyancy_mj.kernels.blocks import (
    BEND,
    BOTTOM,
    DEPTH,
    ETA,
    FALL,
    FOUND,
    LESS,
    OVER,
    REACH,
    SAMPLES,
    SQUARE,
    STILL,
    STRAIN,
    TIDE,
    UP,
    WHOLE,
    Blocks,
    BlockStore,
    K,
    X,
    Y,
    Z,
    find_block,
    is_known,
    set_heads_in,
)
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.series import turn
from buoyancy_mj.kernels.still_water import fade, settle, still_height
from buoyancy_mj.kernels.tiles import (
    AMPLITUDE,
    HELD,
    KX,
    KY,
    LANES,
    OMEGA,
    PHASE,
    Tiles,
    TileStore,
    add_elevations,
)

HEAD = 3
"""Row of places behind x, y and z from the still level: the head there [m]."""


class Sea(NamedTuple):
    """What is known of the sea around hulls, and of an instant."""

    tiles: Tiles
    """The surface."""
    known_tiles: TileStore
    """What is known of it."""
    blocks: Blocks
    """The pressure."""
    known_blocks: BlockStore
    """What is known of it."""
    time: float
    """[s]."""
    dynamic: bool
    """Whether the pressure is that of waves, or hydrostatic under their surface."""


@njit(cache=True, error_model="numpy", _nrt=False)
def set_heads(sea, places, count):
    """Write the head at `count` places, rows 0 to 2 of them, to row `HEAD`."""
    if not sea.dynamic:
        set_depths(sea, places, count)
    elif sea.tiles.layout[HELD] > 0.0:
        _ask_blocks(sea, places, count)
    else:
        for first in range(0, count, SAMPLES):
            _sum_waves(sea, places, first, min(SAMPLES, count - first))


@njit(cache=True, error_model="numpy", _nrt=False)
def set_depths(sea, places, count):
    """Write the depth under the surface at `count` places, rows 0 to 2 of them, to row `HEAD`."""
    tiles, time, x, y, depths = sea.tiles, sea.time, places[X], places[Y], places[HEAD]
    held = int(tiles.layout[HELD])
    for n in range(count):
        depths[n] = -places[Z, n]
    if held > 0:
        add_elevations(tiles, sea.known_tiles, (0.0, 0.0), x, y, count, time, depths)
    _add_waves(tiles.waves, held, x, y, count, time, depths)


@njit(cache=True, error_model="numpy", _nrt=False)
def _add_waves(waves, first, x, y, count, time, out):
    """Add the elevations of waves from `first` on at places x, y to `out`."""
    for w in range(first, waves.shape[1]):
        kx, ky, amplitude = waves[KX, w], waves[KY, w], waves[AMPLITUDE, w]
        late = waves[PHASE, w] - waves[OMEGA, w] * time
        for n in range(count):
            cosine, _ = turn(kx * x[n] + ky * y[n] + late)
            out[n] += amplitude * cosine


@njit(cache=True, error_model="numpy", _nrt=False)
def _ask_blocks(sea, places, count):
    """Write the head at places by the blocks in which they lie.

    As many as follow each other near one block are found together.
    """
    layout, store, time = sea.blocks.layout, sea.known_blocks, sea.time
    bottom, scale, room, first = -layout[DEPTH], 1.0 / layout[REACH], store.room, 0
    while first < count:
        x, y, z = places[X, first], places[Y, first], places[Z, first]
        if z < bottom:
            _sum_waves(sea, places, first, 1)
            first += 1
            continue
        b, mx, my, mz = find_block(layout, x, y, z)
        if not is_known(store.found, b, mx, my, mz, time):
            fill(sea.tiles.waves, sea.blocks, store, b, mx, my, mz, time)
        n = 0
        while n < SAMPLES and first + n < count:
            u, v = (places[X, first + n] - mx) * scale, (places[Y, first + n] - my) * scale
            w = (places[Z, first + n] - mz) * scale
            if max(abs(u), abs(v), abs(w)) > 1.0 or places[Z, first + n] < bottom:
                break
            room[X, n], room[Y, n], room[Z, n] = u, v, w
            n += 1

        # the last ones may be of no use
        set_heads_in(store.found, b, room, (n + LANES - 1) // LANES * LANES)
        for i in range(n):
            places[HEAD, first + i] = room[FOUND, i]
        first += n


@njit(cache=True, error_model="numpy", _nrt=False)
def _sum_waves(sea, places, first, count):
    """Write `waves.head` at up to `SAMPLES` places from `first` on."""
    waves, blocks, room, time = sea.tiles.waves, sea.blocks, sea.known_blocks.room, sea.time
    numbers, fall, depth = blocks.waves, blocks.layout[FALL], blocks.layout[DEPTH]
    for n in range(count):
        for c in range(3):
            room[c, n] = places[c, first + n]
        room[ETA, n] = room[UP, n] = room[STRAIN, n] = room[OVER, n] = room[BEND, n] = 0.0
        room[LESS, n] = 0.0

    # the elevation, and by it a guess of the height in still water
    _add_waves(waves, 0, room[X], room[Y], count, time, room[ETA])
    for n in range(count):
        room[STILL, n] = still_height(room[Z, n], room[ETA, n], fall, depth)

    # what the waves sum up to there
    tide = 0.0
    for w in range(waves.shape[1]):
        kx, ky = waves[KX, w], waves[KY, w]
        late, amplitude = waves[PHASE, w] - waves[OMEGA, w] * time, waves[AMPLITUDE, w]
        k, bottom, square = numbers[K, w], numbers[BOTTOM, w], numbers[SQUARE, w]
        cosine, _ = turn(late)
        tide += numbers[TIDE, w] * cosine
        for n in range(count):
            cosine, _ = turn(kx * room[X, n] + ky * room[Y, n] + late)
            wide, narrow, tanh = fade(k, bottom, room[STILL, n])
            crest = amplitude * cosine
            room[UP, n] += crest * narrow
            room[STRAIN, n] += crest * k * wide
            room[OVER, n] += crest * (wide * tanh - narrow)
            room[BEND, n] += crest * k * (narrow * tanh - wide)
            room[LESS, n] += square * narrow * narrow
    whole = blocks.layout[WHOLE]
    for n in range(count):
        room[FOUND, n] = settle(
            room[Z, n], room[STILL, n], room[UP, n], room[STRAIN, n], room[OVER, n],
            room[BEND, n], tide, room[LESS, n], whole,
        )  # fmt: skip
    for n in range(count):
        places[HEAD, first + n] = room[FOUND, n]
