"""`Echoes`: beams of sound, and what they met; the rays themselves are the engine's."""

import math
from typing import Annotated, NamedTuple

from buoyancy_mj.kernels.arrays import Doubles, Int32s
from buoyancy_mj.kernels.compiling import inner, njit
from buoyancy_mj.kernels.vectors import triple
from buoyancy_mj.kernels.vehicle.motion import find_depth
from buoyancy_mj.kernels.waves import AMPLITUDE, K, tangent

MOST_STEPS = 200
NEAR, NEWTON_STEPS = 1e-3, 4
"""How near to the surface [m] Newton's steps begin, and how many are made."""


class Echoes(NamedTuple):
    """Beams from one site."""

    ray: int
    """Address of MuJoCo's mj_ray."""
    excluded: int
    """Index of the body that rays pass, the site's own; -1 for none."""
    root: int
    """Root of the kinematic tree that rays pass; 0 for none."""
    nearest: float
    """Least range [m]."""
    farthest: float
    """Greatest range [m]."""
    geom_bodies: Annotated[Int32s, ("g",)]
    """Body of each geom."""
    roots: Annotated[Int32s, ("b",)]
    """Root of each body."""
    beams: Annotated[Doubles, ("n", 3)]
    """Directions, site's axes."""
    ways: Annotated[Doubles, ("n", 3)]
    """Directions, world's axes."""
    ranges: Annotated[Doubles, ("n",)]
    """How far it is to what each met [m]; NaN for nothing."""
    met: Annotated[Int32s, ("n",)]
    """The body that each met."""
    point: Annotated[Doubles, (3,)]
    """Where a ray begins."""
    hit: Annotated[Int32s, (1,)]
    """The geom that it meets."""


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def find_end(echoes, beam, at, length):
    """The point at a distance along a beam [m]."""
    x, y, z = triple(echoes.ways, beam, 0)
    return at[0] + length * x, at[1] + length * y, at[2] + length * z


@inner
def drop_dry(echoes, equipment, sea, at):
    """Lose what was met in the air, and all where the site is in the air; whether that is wet."""
    is_wet = find_depth(sea, at, equipment.time) > 0.0
    for b in range(echoes.ranges.shape[0]):
        far = echoes.ranges[b]
        end = find_end(echoes, b, at, far)
        if not is_wet or not find_depth(sea, end, equipment.time) > 0.0:
            echoes.ranges[b] = math.nan
    return is_wet


@inner
def find_surface(sea, at, way, time, farthest):
    """How far it is along a ray to the surface of the water [m]; NaN for nothing within reach.

    No step is longer than the least way to the surface of waves that are as steep as they can be
    together, so that none is passed; Newton's steps end it.
    """
    steepness = 0.0
    for w in range(sea.waves.shape[1]):
        steepness += abs(sea.waves[AMPLITUDE, w]) * sea.waves[K, w]
    fastest = abs(way[2]) + steepness * math.hypot(way[0], way[1])
    if not fastest > 0.0:
        return math.nan

    # towards the surface
    far = 0.0
    for _ in range(MOST_STEPS):
        depth, _ = _look(sea, at, way, time, far)
        if abs(depth) < NEAR:
            break
        far += abs(depth) / fastest
        if not far <= farthest:
            return math.nan

    # onto it
    for _ in range(NEWTON_STEPS):
        depth, slope = _look(sea, at, way, time, far)
        if slope == 0.0:
            return math.nan
        far -= depth / slope
    depth, _ = _look(sea, at, way, time, far)
    return far if abs(depth) < NEAR and 0.0 <= far <= farthest else math.nan


@inner
def _look(sea, at, way, time, far):
    """The depth at a distance along a ray, and how fast it grows there."""
    x, y, z = at[0] + far * way[0], at[1] + far * way[1], at[2] + far * way[2]
    eta, along, across = tangent(sea.waves, x, y, time)
    return sea.level + eta - z, along * way[0] + across * way[1] - way[2]
