"""What slows bodies down by the waves that they make."""

import math

import numpy as np

from buoyancy_mj.kernels.clip import CX, VOLUME, WATERPLANE_AREA
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.damping import (
    HEAVE,
    PITCH,
    ROLL,
    WATERPLANE,
    apparent_mass,
    relative_velocity,
)
from buoyancy_mj.kernels.rigid import rigid_body
from buoyancy_mj.kernels.waves import add_velocity
from buoyancy_mj.kernels.wrenches import add_wrench


@njit(cache=True, error_model="numpy")
def add_radiation(
    damping,
    bodies,
    sea,
    time,
    timestep,
    wet,  # (h, 8) submersion of the hulls
    centres,
    out,
    first,  # row of `damping`, and one past the last
    last,
):
    """Add the damping of heave, roll and pitch by the waves that a body makes.

    It scales with the waterplane of the body.

    At the centroid of what is wet, on the velocity there relative to the waves, held as for
    `add_drag`.
    """
    water, v, radiation = np.empty(3), np.empty(6), damping.radiation
    rate = 1.0 / timestep if timestep > 0.0 else math.inf
    for n in range(first, last):
        b = damping.bodies[n]
        if not centres[b, VOLUME] > 0.0 or not radiation[n, WATERPLANE] > 0.0:
            continue
        area = 0.0
        for h in damping.hulls[damping.hull_starts[n] : damping.hull_starts[n + 1]]:
            area += wet[h, WATERPLANE_AREA]
        share = min(max(area / radiation[n, WATERPLANE], 0.0), 1.0)
        if share == 0.0:
            continue

        # the velocity relative to the waves
        r, at = bodies.xmat[b], centres[b, CX:]
        water[:] = 0.0
        add_velocity(sea.waves, at[0], at[1], at[2] - sea.level, time, water)
        relative_velocity(bodies, b, at, water, v)
        heave = r[6] * v[0] + r[7] * v[1] + r[8] * v[2]

        # the force against it, held
        mass, inertias = rigid_body(damping, bodies, n)
        apparent = apparent_mass(mass, inertias, at, bodies.xipos[b])
        up = -min(share * radiation[n, HEAVE], apparent * rate) * heave
        roll = -min(share * radiation[n, ROLL], inertias[0] * rate) * v[3]
        pitch = -min(share * radiation[n, PITCH], inertias[1] * rate) * v[4]
        f = up * r[6], up * r[7], up * r[8], roll, pitch, 0.0
        add_wrench(r, at, bodies.xipos[b], f, out[b])
