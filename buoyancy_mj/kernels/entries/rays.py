"""Rays of the engine's, from the beams of a sensor."""

import math

from numba import int64

from buoyancy_mj.kernels.compiling import inner
from buoyancy_mj.kernels.entries.pointers import call_number
from buoyancy_mj.kernels.vectors import rotate, triple
from buoyancy_mj.kernels.vehicle.sensors.water import find_site

MOST_HITS = 64
"""Parts of its own vehicle that a ray passes at most."""
PAST = 1e-6
"""How far behind a part of its own vehicle a ray begins anew [m]."""


@inner
def cast_rays(model, data, mount, echoes, equipment):
    """Find how far it is along each beam to the first geom of others, and whose it is."""
    at, axes = find_site(mount, equipment), equipment.sites.site_xmat[mount.site]
    for b in range(echoes.beams.shape[0]):
        x, y, z = triple(echoes.beams, b, 0)
        way = echoes.ways[b]
        way[0], way[1], way[2] = rotate(axes, x, y, z)
        echoes.ranges[b], echoes.met[b] = _cast(model, data, echoes, at, way)


@inner
def _cast(model, data, echoes, at, way):
    """How far it is along one beam to the first geom of others [m], and its body; NaN for none."""
    point, far = echoes.point, 0.0
    for _ in range(MOST_HITS):
        for axis in range(3):
            point[axis] = at[axis] + far * way[axis]
        step = call_number(
            echoes.ray,
            (
                model,
                data,
                int64(point.ctypes.data),
                int64(way.ctypes.data),
                int64(0),  # geoms of all groups
                int64(1),  # and those that never move
                int64(echoes.excluded),
                int64(echoes.hit.ctypes.data),
                int64(0),  # the normal is not wanted
            ),
        )
        far += step
        if step < 0.0 or far > echoes.farthest:
            break
        body = echoes.geom_bodies[echoes.hit[0]] if echoes.hit[0] >= 0 else 0
        if echoes.root == 0 or echoes.roots[body] != echoes.root:
            return far, body
        far += PAST
    return math.nan, 0
