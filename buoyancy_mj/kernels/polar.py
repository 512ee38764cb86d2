"""Lift and drag of a foil by its angle of attack, over the full circle.

Along the chord towards the leading edge a foil moves with c = cos a, and against its normal with
s = sin a, where a is the angle of attack. Attached flow is thin aerofoil theory on a finite span,
with Hoerner's cross-flow; beyond stall the foil is a flat plate. Coefficients are over
1/2 rho V^2 times the area.
"""

import math

import numpy as np

from buoyancy_mj.kernels.compiling import njit

SLOPE, CAMBER, INDUCED, CROSSFLOW, LOST, STALL, BLEND, PROFILE, PLATE, TIPS = range(10)
"""Columns of a section: lift slope of the finite span [1/rad]; sine of the angle of zero lift;
induced drag over lift squared; cross-flow over the square of s; the part of the leading edge's
suction that is lost; the angle of stall, and half the width over which it comes [rad]; drag of the
section along the flow; drag of a plate across the flow, without tips; and by how much tips lower
it."""
SECTION = 10
"""How many columns."""


@njit(cache=True, error_model="numpy", inline="always")
def coefficients(section, c, s):
    """Lift and drag coefficient, and the part of the force along the normal that is camber's.

    Attached lift is a_s s c, which is a_s a for small angles, less what the zero-lift angle takes;
    both hold for flow from behind too (the theorem of reverse flow, Heaslet and Spreiter 1953).
    Drag is induced by lift (Prandtl 1918). Cross-flow adds a force along the normal (Whicker and
    Fehlner 1958, after Hoerner). Edges that are sharp lose their suction, and the force is along
    the normal. From stall on all this gives way to a plate's normal force.
    """
    stalled = stalled_share(section, c, s)
    attached = 1.0 - stalled

    # attached flow
    straight = section[SLOPE] * s * c
    cambered = -section[SLOPE] * section[CAMBER] * c * abs(c)
    across = section[CROSSFLOW] * s * abs(s)
    suction = section[LOST] * (straight * s - section[INDUCED] * straight * straight * c)
    lift = straight + cambered + across * c - suction * s
    drag = section[INDUCED] * (straight + cambered) ** 2 + across * s + suction * c

    # a plate beyond stall
    normal = plate(section, s) * s
    lift = attached * lift + stalled * normal * c
    drag = attached * drag + stalled * normal * s + section[PROFILE]
    return lift, drag, attached * cambered * c


@njit(cache=True, error_model="numpy", inline="always")
def arm(section, c, s, spin):
    """Where the force of a foil without camber acts, as a part of the chord before its middle.

    In attached flow it is a quarter, on the side of the edge that leads (thin aerofoil theory), but
    for cross-flow, which acts at the middle. Of a plate beyond stall it is 3/4 c / (4 + pi s)
    (Rayleigh 1876). `spin` is the part of the square of the speed that rotation about the span has,
    beside c and s: a foil that only turns has its force at the middle.
    """
    stalled = stalled_share(section, c, s)
    size = abs(s)

    # the force along the normal over s
    straight = (1.0 - stalled) * section[SLOPE]
    across = (1.0 - stalled) * section[CROSSFLOW] * size
    normal = stalled * plate(section, s)
    total = straight * (c * c + spin) + across + normal
    moment = 0.25 * straight * c * abs(c) + normal * 0.75 * c / (4.0 + math.pi * size)
    return moment / total if total > 0.0 else 0.0


@njit(cache=True, error_model="numpy", inline="always")
def plate(section, s):
    """Normal force of a plate over s: measured by Hoerner (1965), in the form of Lindenburg (2000,
    ECN-RX-01-004).
    """
    return section[PLATE] * (1.0 / (0.56 + 0.44 * abs(s)) - section[TIPS])


@njit(cache=True, error_model="numpy", inline="always")
def stalled_share(section, c, s):
    """How far the flow has parted from a foil, from 0 to 1: smooth over the width of its stall."""
    angle = math.atan2(abs(s), abs(c))
    share = 0.5 + 0.5 * (angle - section[STALL]) / section[BLEND]
    share = min(max(share, 0.0), 1.0)
    return share * share * (3.0 - 2.0 * share)


@njit(cache=True, error_model="numpy")
def sweep(section, angles):
    """Lift, drag and moment coefficient at angles of attack (n,) [rad], as (n, 3).

    The moment is about the quarter of the chord, positive where it raises the leading edge.
    """
    out = np.empty((angles.shape[0], 3))
    for i in range(angles.shape[0]):
        c, s = math.cos(angles[i]), math.sin(angles[i])
        lift, drag, cambered = coefficients(section, c, s)
        at = arm(section, c, s, 0.0)
        out[i, 0], out[i, 1] = lift, drag
        out[i, 2] = (at - 0.25) * (lift * c + drag * s) - at * cambered
    return out
