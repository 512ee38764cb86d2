"""How a sea is laid out in tiles and blocks: how large they are, and what each wave adds to them.

A wave of amplitude a and components kx, ky leaves at most

    4 a ((|kx| + |ky|) b / 2)^(n + 1) / (n + 1)!

out of a polynomial of degree n in a square of sides 2 b, fitted at Chebyshev's points: the first
term left out of its series in Chebyshev's polynomials (Abramowitz and Stegun 1964, 9.1.44), which
is the largest and alone counts.
"""

import functools
import itertools
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.kernels import blocks, tiles
from buoyancy_mj.kernels.blocks import Blocks
from buoyancy_mj.kernels.still_water import decay, seabed
from buoyancy_mj.kernels.tiles import Tiles
from buoyancy_mj.kernels.waves import AMPLITUDE, DEPTH, KX, KY, PHASE

ACCURACY = 1e-6
"""The part of a hull's radius that tiles may leave out of the elevation in all."""
FEW = 4
"""Waves up to which they are summed one by one."""
OVERLAP = 1.5
"""Side of a tile over half the side of the square in which its polynomial holds."""
_POINTS = 12
"""Chebyshev's points along a side of a tile, at which polynomials are fitted."""
_ASKED = 2000
"""How often the elevation is asked for in a pass, about."""


def lay_tiles(waves: NDArray[np.float64], radii: Sequence[float]) -> Tiles:
    """Lay a sea out in tiles.

    All that they leave out of the elevation is within `ACCURACY` of the smallest radius.

    Args:
        waves: of the sea (w, 7), see `kernels.waves`.
        radii: of the hulls (h,) [m].
    """
    rows = waves[_order(waves), AMPLITUDE : PHASE + 1].T.copy()
    amplitudes, k = np.abs(rows[AMPLITUDE]), np.hypot(rows[KX], rows[KY])
    allowed = ACCURACY * min(radii)
    held, reach = _plan(rows, allowed, max(radii))
    shares = np.zeros((tiles.NUMBERS, len(k)))
    shares[:, :held] = _fit(rows[:, :held], reach)
    layout = np.zeros(11)
    layout[[tiles.SIDE, tiles.REACH, tiles.HELD]] = OVERLAP * reach, reach, held
    layout[[tiles.PER_SIDE, tiles.PER_REACH]] = 1.0 / (OVERLAP * reach), 1.0 / reach
    layout[tiles.HEIGHT : tiles.TWIST + 1] = [(amplitudes * k**n).sum() for n in range(4)]
    if amplitudes.any():
        layout[tiles.TURNING] = mean_wave_number(amplitudes, k)
    if held:
        layout[tiles.ROUNDING] = allowed * (tiles.DEGREE / reach) ** 2
    return Tiles(layout, np.concatenate([rows, shares]))


def mean_wave_number(amplitudes: NDArray[np.float64], k: NDArray[np.float64]) -> float:
    """The wave number [rad/m] of one wave that is as steep in its eighth derivatives as all waves.

    Args:
        amplitudes: of the waves (w,), not all 0 [m].
        k: their wave numbers (w,) [rad/m].
    """
    return float((amplitudes @ k**8 / amplitudes.sum()) ** (1 / 8))


def _order(waves: NDArray[np.float64]) -> NDArray[np.intp]:
    """The order of the waves, the longest first."""
    return np.argsort(np.hypot(waves[:, KX], waves[:, KY]), kind="stable")


def _plan(rows: NDArray[np.float64], allowed: float, radius: float) -> tuple[int, float]:
    """How many waves tiles hold, and half the width of the squares [m] in which they do.

    What costs least over a hull of a radius [m].
    """
    many = rows.shape[1]
    if many <= FEW:
        return 0, 1.0
    power = tiles.DEGREE + 1

    # the width that the first waves allow (waves,)
    reaches = np.abs(rows[KX]) + np.abs(rows[KY])
    left = np.cumsum(np.abs(rows[AMPLITUDE]) * reaches**power)
    with np.errstate(divide="ignore"):
        halves = 2.0 * (0.25 * allowed * math.factorial(power) / left) ** (1.0 / power)
    halves = np.minimum(halves, 4.0 * radius)

    # about how long it takes [ns] to fill all tiles over the hull, and to ask for elevations
    held = np.arange(1, many + 1)
    count = (1.0 + 2.0 * radius / (OVERLAP * halves)) ** 2
    cost = count * (200.0 + 6.0 * held) + _ASKED * (5.0 + 15.0 * (many - held))
    least = int(np.argmin(cost))
    if cost[least] > _ASKED * 15.0 * many:
        return 0, 1.0
    return int(held[least]), float(halves[least])


@functools.cache
def _exponents(degree: int) -> tuple[tuple[int, int], ...]:
    """Exponents of x and y, in the order of the coefficients."""
    return tuple((m, n) for m in range(degree + 1) for n in range(degree + 1 - m))


@functools.cache
def _fitting() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Chebyshev's points in a square (p, 2), and what values there make of coefficients (c, p)."""
    line = np.cos((np.arange(_POINTS) + 0.5) * math.pi / _POINTS)
    points = np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1).reshape(-1, 2)
    powers = [points[:, 0] ** m * points[:, 1] ** n for m, n in _exponents(tiles.DEGREE)]
    return points, np.linalg.pinv(np.column_stack(powers))


def _fit(rows: NDArray[np.float64], reach: float) -> NDArray[np.float64]:
    """What each wave adds to the coefficients of a tile, see `Tiles.waves`."""
    points, fit = _fitting()
    phases = points @ (reach * rows[[KX, KY]])
    odd = np.array([sum(pair) % 2 == 1 for pair in _exponents(tiles.DEGREE)])[:, None]
    fitted: NDArray[np.float64] = np.where(odd, -(fit @ np.sin(phases)), fit @ np.cos(phases))
    fitted *= rows[AMPLITUDE]
    return fitted


# blocks


BLOCK = 0.72
"""Half the side of the cube in which the polynomial of a block holds, times the wave number whose
sixth derivatives are as large as those of all waves."""


def lay_blocks(waves: NDArray[np.float64], radii: Sequence[float]) -> Blocks:
    """Lay the water under a sea out in blocks; the waves stand in the order of its tiles.

    Args:
        waves: of the sea (w, 7), see `kernels.waves`.
        radii: of the hulls (h,) [m]; blocks are no larger than three fourths of the largest.
    """
    rows = waves[_order(waves)]
    square, k = rows[:, AMPLITUDE] ** 2, np.hypot(rows[:, KX], rows[:, KY])
    steep = ((square @ k**12) / square.sum()) ** (1.0 / 12.0) if square.any() else 0.0
    reach = min(BLOCK / steep if steep else math.inf, 0.5 * max(radii))
    bottoms = np.array([seabed.py_func(*pair) for pair in zip(k, rows[:, DEPTH], strict=True)])
    tanh = (1.0 - bottoms) / (1.0 + bottoms)
    mean = float(square @ k / square.sum()) if square.any() else 0.0
    depth = float(rows[:, DEPTH].min(initial=math.inf))
    layout = np.zeros(7)
    layout[[blocks.SIDE, blocks.REACH]] = OVERLAP * reach, reach
    layout[[blocks.FALL, blocks.DEPTH]] = decay.py_func(mean, depth), depth
    layout[blocks.WHOLE] = 0.5 * square @ (k * tanh)
    layout[[blocks.TIDAL, blocks.SHALLOW]] = not k.all(), bottoms.any()
    taylor = [
        (-1.0 if (m + n) % 4 in (1, 2) else 1.0)
        / (math.factorial(m) * math.factorial(n))
        * rows[:, KX] ** m
        * rows[:, KY] ** n
        * rows[:, AMPLITUDE]
        for m, n in _exponents(blocks.WAVE_DEGREE)
    ]
    tide = np.where(k == 0.0, rows[:, AMPLITUDE], 0.0)
    points, fit = _block_fitting()
    table = np.array([k, bottoms, 0.5 * square * k * tanh, tide, *taylor])
    return Blocks(layout, table.reshape(blocks.TAYLOR + blocks.FLAT, len(k)), points, fit)


@functools.cache
def _block_fitting() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Points in a cube (3, p), and what values there make of coefficients (c, p).

    The points are as symmetric as the cube. Of all such they leave the least in the mean over waves
    of all directions whose wave number is `BLOCK` over `blocks.REACH`.
    """
    orbits = np.array(
        [
            [0.895, 0.575, 0.0],
            [0.853, 0.853, 0.359],
            [0.447, 0.447, 0.447],
            [0.459, 0.459, 0.459],
            [0.792, 0.792, 0.792],
        ]
    )
    turned = orbits[:, list(itertools.permutations(range(3)))].reshape(-1, 1, 3)
    signs = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
    points = np.unique((turned * signs + 0.0).reshape(-1, 3), axis=0).T
    powers = [
        points[2] ** p * points[0] ** m * points[1] ** n
        for p in range(blocks.DEGREE + 1)
        for m, n in _exponents(blocks.DEGREE - p)
    ]
    return points, np.linalg.pinv(np.column_stack(powers))
