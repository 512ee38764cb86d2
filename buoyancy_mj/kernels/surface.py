"""The surface of a sea at a place: its elevation and tangent, and bounds around there.

That is what tiles hold of it, and the waves that are summed one by one.
"""

import math

from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.tiles import (
    AMPLITUDE,
    CURVATURE,
    HEIGHT,
    HELD,
    KX,
    KY,
    OMEGA,
    PHASE,
    ROUNDING,
    STEEPNESS,
    TWIST,
    find_tile,
    second_derivatives_in,
    tangent_in,
)


@njit(cache=True, error_model="numpy", _nrt=False)
def tangent_at(tiles, store, x, y, time):
    """The elevation of all waves at a place, and its gradient."""
    held, waves = int(tiles.layout[HELD]), tiles.waves
    eta = along = across = 0.0
    if held > 0:
        t = find_tile(tiles, store, x, y, time)
        eta, along, across = tangent_in(tiles, store, t, x, y)
    for w in range(held, waves.shape[1]):
        amplitude, kx, ky = waves[AMPLITUDE, w], waves[KX, w], waves[KY, w]
        angle = kx * x + ky * y - waves[OMEGA, w] * time + waves[PHASE, w]
        slope = amplitude * math.sin(angle)
        eta += amplitude * math.cos(angle)
        along -= kx * slope
        across -= ky * slope
    return eta, along, across


@njit(cache=True, error_model="numpy", _nrt=False)
def swing(tiles, store, x, y, time, radius):
    """Elevation at a place, and bounds within a radius: how much it differs, and is curved."""
    held, waves = int(tiles.layout[HELD]), tiles.waves
    eta = along = across = hxx = hxy = hyy = 0.0
    if held > 0:
        t = find_tile(tiles, store, x, y, time)
        eta, along, across = tangent_in(tiles, store, t, x, y)
        hxx, hxy, hyy = second_derivatives_in(tiles, store, t, x, y)
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
    layout = tiles.layout
    bent = math.sqrt(hxx * hxx + 2.0 * hxy * hxy + hyy * hyy) + layout[ROUNDING]
    curvature = min(layout[CURVATURE], bent + layout[TWIST] * radius)
    steepness = min(layout[STEEPNESS], math.hypot(along, across) + curvature * radius)
    return eta, min(2.0 * layout[HEIGHT], steepness * radius), curvature
