"""Integrals over the waterplane of a hull of what the waves have beside their plane, in strips.

Each strip lies between a cut and the axis of the hull, through its middle along `swell.Rest.ahead`:
by Green's theorem they make up the waterplane. All is seen from above.
"""

import math

from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.cuts import MOST, P_X, P_Y, Q_X, Q_Y
from buoyancy_mj.kernels.swell import add_rest

# Gauss-Legendre points and weights between 0 and 1
_TWO = ((0.5 - math.sqrt(1.0 / 12.0), 0.5), (0.5 + math.sqrt(1.0 / 12.0), 0.5))
_THREE = (
    (0.5 - math.sqrt(0.15), 5.0 / 18.0),
    (0.5, 4.0 / 9.0),
    (0.5 + math.sqrt(0.15), 5.0 / 18.0),
)
_FOUR = (
    (0.06943184420297371, 0.17392742256872692),
    (0.33000947820757187, 0.32607257743127308),
    (0.66999052179242813, 0.32607257743127308),
    (0.93056815579702629, 0.17392742256872692),
)
# columns of `cuts` behind the ends: places, the rest there, and four integrals
_PLACE_X, _PLACE_Y, _REST, _ONES, _ALONG, _ACROSS, _UP = range(4 * MOST, 11 * MOST, MOST)


@njit(cache=True, error_model="numpy", _nrt=False)
def waterplane_moments(cuts, count, plane, rest, tiles, store, near):
    """Integrals of e, x e, y e and (plane + e / 2) e over the strips of `count` cuts.

    By Gauss's rule across, in panels of at most `swell.PANEL` / k, and along the cuts.
    """
    height, (gx, gy), (ax, ay) = plane.height, plane.slope, rest.ahead
    x, y, e = cuts[_PLACE_X : _PLACE_X + MOST], cuts[_PLACE_Y:_REST], cuts[_REST:_ONES]
    for n in range(count):
        cuts[_ONES + n] = cuts[_ALONG + n] = cuts[_ACROSS + n] = cuts[_UP + n] = 0.0
    for along, share in _TWO:
        for panel in range(rest.panels):
            for k in range(rest.points):
                out, weight = _THREE[k] if rest.points == 3 else _FOUR[k]
                u = (panel + out) / rest.panels
                part = weight * share / (rest.panels * u)
                for n in range(count):
                    px, qx = (1.0 - along) * cuts[P_X + n], along * cuts[Q_X + n]
                    py, qy = (1.0 - along) * cuts[P_Y + n], along * cuts[Q_Y + n]
                    # a part u of the way from the axis to the cut
                    far, aside = ax * (px + qx) + ay * (py + qy), ax * (py + qy) - ay * (px + qx)
                    cuts[_PLACE_X + n] = ax * far - ay * (u * aside)
                    cuts[_PLACE_Y + n] = ay * far + ax * (u * aside)
                    cuts[_REST + n] = 0.0
                add_rest(x, y, count, rest, tiles, store, near, e)
                for n in range(count):
                    aside = ax * cuts[_PLACE_Y + n] - ay * cuts[_PLACE_X + n]
                    e_dA = part * aside * cuts[_REST + n]
                    mean = height + 0.5 * cuts[_REST + n]
                    cuts[_ONES + n] += e_dA
                    cuts[_ALONG + n] += cuts[_PLACE_X + n] * e_dA
                    cuts[_ACROSS + n] += cuts[_PLACE_Y + n] * e_dA
                    cuts[_UP + n] += (
                        mean + gx * cuts[_PLACE_X + n] + gy * cuts[_PLACE_Y + n]
                    ) * e_dA

    # times how far each cut goes back along the axis, with the waterplane to its left
    i0 = ix = iy = iz = 0.0
    for n in range(count):
        back = ax * (cuts[P_X + n] - cuts[Q_X + n]) + ay * (cuts[P_Y + n] - cuts[Q_Y + n])
        i0 += back * cuts[_ONES + n]
        ix += back * cuts[_ALONG + n]
        iy += back * cuts[_ACROSS + n]
        iz += back * cuts[_UP + n]
    return i0, ix, iy, iz
