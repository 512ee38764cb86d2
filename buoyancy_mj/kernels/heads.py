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
    few = sea.tiles.layout[HELD] == 0.0
    if sea.dynamic and not few:
        _ask_blocks(sea, places, count)
        return
    for first in range(0, count, SAMPLES):
        some = min(SAMPLES, count - first)
        if sea.dynamic:
            _sum_waves(sea, places, first, some)
        else:
            _find_depths(sea, places, first, some)


@njit(cache=True, error_model="numpy", _nrt=False)
def _find_depths(sea, places, first, count):
    """Write the depth under the surface at up to `SAMPLES` places from `first` on."""
    layout, waves, room, time = sea.tiles.layout, sea.tiles.waves, sea.known_blocks.room, sea.time
    held = int(layout[HELD])
    for n in range(count):
        room[X, n], room[Y, n] = places[X, first + n], places[Y, first + n]
        room[ETA, n] = 0.0
    if held > 0:
        found, phases = sea.known_tiles.found, sea.known_tiles.phases
        add_elevations(
            layout, waves, found, phases, (0.0, 0.0), room[X], room[Y], count, time, room[ETA]
        )
    _add_waves(waves, held, room, count, time)
    for n in range(count):
        places[HEAD, first + n] = room[ETA, n] - places[Z, first + n]


@njit(cache=True, error_model="numpy", _nrt=False)
def _add_waves(waves, first, room, count, time):
    """Add the elevations of waves from `first` on at places to row `ETA`."""
    for w in range(first, waves.shape[1]):
        kx, ky, amplitude = waves[KX, w], waves[KY, w], waves[AMPLITUDE, w]
        late = waves[PHASE, w] - waves[OMEGA, w] * time
        for n in range(count):
            cosine, _ = turn(kx * room[X, n] + ky * room[Y, n] + late)
            room[ETA, n] += amplitude * cosine


@njit(cache=True, error_model="numpy", _nrt=False)
def _ask_blocks(sea, places, count):
    """Write the head at places by the blocks in which they lie.

    As many as follow each other near one block are found together.
    """
    blocks, store, waves, time = sea.blocks, sea.known_blocks, sea.tiles.waves, sea.time
    layout, found = blocks.layout, store.found
    bottom, reach, first = -layout[DEPTH], layout[REACH], 0
    while first < count:
        x, y, z = places[X, first], places[Y, first], places[Z, first]
        last = first + 1
        if z < bottom:
            _sum_waves(sea, places, first, 1)
        else:
            b, mx, my, mz = find_block(layout, x, y, z)
            if not is_known(found, b, mx, my, mz, time):
                fill(waves, blocks, store, b, mx, my, mz, time)
            while last < count and _is_near(places, last, mx, my, mz, reach, bottom):
                last += 1
            set_heads_in(layout, found, b, places, first, last)
        first = last


@njit(cache=True, error_model="numpy", inline="always")
def _is_near(places, n, x, y, z, reach, bottom):
    """Whether the polynomial of a block whose middle is given holds at a place."""
    level = abs(places[X, n] - x) <= reach and abs(places[Y, n] - y) <= reach
    return level and abs(places[Z, n] - z) <= reach and places[Z, n] >= bottom


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
    _add_waves(waves, 0, room, count, time)
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
