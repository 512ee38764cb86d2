"""`Layout`: where the props of an arena stand, as the rulebook draws them or drawn by a seed."""

import dataclasses
import math
import random
from collections.abc import Mapping, Sequence

from buoyancy_mj.environments.sauvc.pool import LENGTH, WIDTH
from buoyancy_mj.errors import SceneError
from buoyancy_mj.values import read_whole_number

COLOURS = ("red", "yellow", "blue")
"""Colours of the flares that carry a ball."""
GATE_X = 16.0 - 0.5 * LENGTH
"""Where the gate of the final stands along the pool [m]: 16 m from the wall of the start."""
QUALIFICATION_GATE_X = 10.0 - 0.5 * LENGTH
"""Where the qualification gates hang along the pool [m]: 10 m from the wall of the start."""
LANES = {"port": 4.0, "starboard": -4.0}
"""Middles of the two lanes of the qualification across the pool [m], as its figure has them."""
DRUM_X = 11.7
"""Where the drums stand along the pool [m]: in the last 2 m, their middles 0.8 m from the wall."""
DRUM_YS = (4.8, 2.4, 0.0, -2.4)
"""Where the drums stand across the pool [m], from port to starboard, as the figure has them."""

_ORANGE_ZONE = (4.0 - 0.5 * LENGTH, 8.0 - 0.5 * LENGTH)
_FLARE_ZONE = (8.0 - 0.5 * LENGTH, GATE_X)
_FROM_WALL = 1.0
"""Least distance of a flare from a side wall, assumed [m]: a vehicle gets round it."""
_FROM_EDGE = 0.5
"""Least distance of a flare from the ends of its zone, assumed [m]."""
_APART = 2.0
"""Least distance between two flares, assumed [m]: a vehicle can bump one alone."""
_BEFORE_GATE = 2.0
"""Length and half width of the water before the gate that is kept free of flares, assumed [m]."""
_TRIES = 10_000


@dataclasses.dataclass(frozen=True, kw_only=True)
class Layout:
    """Where the props of the final stand.

    x runs along the pool from the start, y to port; the origin is the middle of the pool.
    """

    start: tuple[float, float] = (-11.6, 1.2)
    """Middle of the start zone (2,) [m]."""
    gate: float = -0.4
    """Middle of the gate across the pool [m]."""
    orange_flare: tuple[float, float] = (-6.2, 2.1)
    """Foot of the orange flare (2,) [m]."""
    flares: Mapping[str, tuple[float, float]] = dataclasses.field(
        default_factory=lambda: {"red": (1.1, 3.2), "yellow": (-0.7, -3.8), "blue": (-1.5, 2.5)}
    )
    """Foot of each flare that carries a ball (2,) [m], by its colour."""
    order: tuple[str, ...] = COLOURS
    """Colours of the flares in the order in which they are to be bumped."""
    blue_drum: int = 0
    """Which of the four drums is blue, counted from port."""
    pinger: int = 1
    """Which of them holds the pinger; a red one."""


def draw_layout(seed: int | None = None) -> Layout:
    """The layout of the rulebook's figure, or one drawn within the bounds that it sets.

    The gate stands anywhere on its line, the orange flare anywhere 4 to 8 m from the wall of the
    start, the others anywhere from there to the gate, and the drums are in any order. Assumed are
    distances: of flares from walls and from each other, and of flares from the way into the gate.

    Args:
        seed: any whole number of 0 or more; the same seed gives the same layout everywhere. None
            for the figure.

    Raises:
        SceneError: the seed is none.
    """
    if seed is None:
        return Layout()
    draw = random.Random(read_seed(seed))

    # what stands on lines
    reach = 0.5 * WIDTH - _FROM_WALL
    gate = draw.uniform(-reach, reach)
    order = draw.sample(COLOURS, 3)
    blue_drum, pinger = draw.sample(range(len(DRUM_YS)), 2)

    # flares, each in a free place of its zone
    orange = draw.uniform(*_ORANGE_ZONE), draw.uniform(-reach, reach)
    taken = [orange]
    for _ in COLOURS:
        taken.append(_draw_flare(draw, taken, gate))
    return Layout(
        gate=gate,
        orange_flare=orange,
        flares=dict(zip(COLOURS, taken[1:], strict=True)),
        order=tuple(order),
        blue_drum=blue_drum,
        pinger=pinger,
    )


def read_seed(seed: object, name: str = "seed") -> int:
    """A seed of layouts.

    Raises:
        SceneError: it is none; the message calls it `name`.
    """
    return read_whole_number(SceneError, name, seed, 0, 2**63 - 1)


def _draw_flare(
    draw: random.Random, taken: Sequence[tuple[float, float]], gate: float
) -> tuple[float, float]:
    """A place for a flare, away from those that are taken and from the way into the gate."""
    low, high = _FLARE_ZONE
    reach = 0.5 * WIDTH - _FROM_WALL
    for _ in range(_TRIES):
        place = draw.uniform(low + _FROM_EDGE, high - _FROM_EDGE), draw.uniform(-reach, reach)
        is_apart = all(math.dist(place, other) >= _APART for other in taken)
        is_in_the_way = high - place[0] < _BEFORE_GATE and abs(place[1] - gate) < _BEFORE_GATE
        if is_apart and not is_in_the_way:
            return place
    raise AssertionError("three flares always find room in a zone of 8 m by 14 m")
