"""Bodies that move as one: their mass, inertia and motion, and what of a wrench each of them gets.

Ten numbers stand for some bodies as one: mass, centre of mass, and inertia about it as xx, yy, zz,
xy, xz, yz, in the world's axes.
"""

from buoyancy_mj.kernels.compiling import inner, njit


@njit(cache=True, error_model="numpy")
def gather(bodies, members):
    """Mass, centre of mass and inertia about it, xx, yy, zz, xy, xz, yz, of bodies as one body.

    In the world's axes.
    """
    xipos = bodies.xipos
    mass = x = y = z = 0.0
    for b in members:
        m = bodies.body_mass[b]
        mass += m
        x += m * xipos[b, 0]
        y += m * xipos[b, 1]
        z += m * xipos[b, 2]
    if not mass > 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    x, y, z = x / mass, y / mass, z / mass
    xx = yy = zz = xy = xz = yz = 0.0
    for b in members:
        m, q = bodies.body_mass[b], bodies.ximat[b]
        i0, i1, i2 = bodies.body_inertia[b, 0], bodies.body_inertia[b, 1], bodies.body_inertia[b, 2]
        ax, ay, az = xipos[b, 0] - x, xipos[b, 1] - y, xipos[b, 2] - z
        xx += q[0] * q[0] * i0 + q[1] * q[1] * i1 + q[2] * q[2] * i2 + m * (ay * ay + az * az)
        yy += q[3] * q[3] * i0 + q[4] * q[4] * i1 + q[5] * q[5] * i2 + m * (ax * ax + az * az)
        zz += q[6] * q[6] * i0 + q[7] * q[7] * i1 + q[8] * q[8] * i2 + m * (ax * ax + ay * ay)
        xy += q[0] * q[3] * i0 + q[1] * q[4] * i1 + q[2] * q[5] * i2 - m * ax * ay
        xz += q[0] * q[6] * i0 + q[1] * q[7] * i1 + q[2] * q[8] * i2 - m * ax * az
        yz += q[3] * q[6] * i0 + q[4] * q[7] * i1 + q[5] * q[8] * i2 - m * ay * az
    return mass, x, y, z, xx, yy, zz, xy, xz, yz


@inner
def gather_group(damping, bodies, rows, parts):
    """Mass, centre of mass and inertia of a group, see `gather`; those of members in rows (k, 10).

    The inertia is about the centre of mass.
    """
    mass = x = y = z = 0.0
    for k in range(rows.shape[0]):
        n = rows[k]
        members = damping.members[damping.member_starts[n] : damping.member_starts[n + 1]]
        part = gather(bodies, members)
        for c in range(10):
            parts[k, c] = part[c]
        mass += part[0]
        x += part[0] * part[1]
        y += part[0] * part[2]
        z += part[0] * part[3]
    x, y, z = x / mass, y / mass, z / mass
    xx = yy = zz = xy = xz = yz = 0.0
    for k in range(rows.shape[0]):
        m = parts[k, 0]
        ax, ay, az = parts[k, 1] - x, parts[k, 2] - y, parts[k, 3] - z
        xx += parts[k, 4] + m * (ay * ay + az * az)
        yy += parts[k, 5] + m * (ax * ax + az * az)
        zz += parts[k, 6] + m * (ax * ax + ay * ay)
        xy += parts[k, 7] - m * ax * ay
        xz += parts[k, 8] - m * ax * az
        yz += parts[k, 9] - m * ay * az
    return mass, x, y, z, xx, yy, zz, xy, xz, yz


@inner
def rigid_body(damping, bodies, n):
    """Mass of a body with all that is welded to it, and its inertia about each of its axes.

    The latter is torque over angular acceleration: one over the diagonal of the inverse inertia.
    """
    members = damping.members[damping.member_starts[n] : damping.member_starts[n + 1]]
    whole = gather(bodies, members)
    return whole[0], find_inertias(whole, bodies.xmat[damping.bodies[n]])


@inner
def find_motion(damping, bodies, rows, parts, whole, out):
    """Write the motion of the rigid body that has the momentum of a group to `out` (6,).

    It is the velocity of the centre of mass, and the rotation, in the world's axes.
    """
    px = py = pz = lx = ly = lz = 0.0
    for k in range(rows.shape[0]):
        b, m = damping.bodies[rows[k]], parts[k, 0]
        cvel, origin = bodies.cvel[b], bodies.subtree_com[bodies.body_rootid[b]]
        wx, wy, wz = cvel[0], cvel[1], cvel[2]
        ox, oy, oz = parts[k, 1] - origin[0], parts[k, 2] - origin[1], parts[k, 3] - origin[2]
        ux = m * (cvel[3] + wy * oz - wz * oy)
        uy = m * (cvel[4] + wz * ox - wx * oz)
        uz = m * (cvel[5] + wx * oy - wy * ox)
        px, py, pz = px + ux, py + uy, pz + uz
        ax, ay, az = parts[k, 1] - whole[1], parts[k, 2] - whole[2], parts[k, 3] - whole[3]
        lx += ay * uz - az * uy + parts[k, 4] * wx + parts[k, 7] * wy + parts[k, 8] * wz
        ly += az * ux - ax * uz + parts[k, 7] * wx + parts[k, 5] * wy + parts[k, 9] * wz
        lz += ax * uy - ay * ux + parts[k, 8] * wx + parts[k, 9] * wy + parts[k, 6] * wz
    out[0], out[1], out[2] = px / whole[0], py / whole[0], pz / whole[0]
    out[3], out[4], out[5] = _solve(whole, lx, ly, lz)


@njit(cache=True, error_model="numpy")
def share(damping, bodies, rows, parts, whole, f, out):
    """Add to each member of a group what it needs to move along under a wrench (6,).

    The wrench is about the centre of mass of the group, in the world's axes.
    """
    ax, ay, az = f[0] / whole[0], f[1] / whole[0], f[2] / whole[0]
    wx, wy, wz = _solve(whole, f[3], f[4], f[5])
    for k in range(rows.shape[0]):
        b, m = damping.bodies[rows[k]], parts[k, 0]
        x, y, z = parts[k, 1] - whole[1], parts[k, 2] - whole[2], parts[k, 3] - whole[3]
        fx = m * (ax + wy * z - wz * y)
        fy = m * (ay + wz * x - wx * z)
        fz = m * (az + wx * y - wy * x)
        com = bodies.xipos[b]
        x, y, z = parts[k, 1] - com[0], parts[k, 2] - com[1], parts[k, 3] - com[2]
        tx = parts[k, 4] * wx + parts[k, 7] * wy + parts[k, 8] * wz + y * fz - z * fy
        ty = parts[k, 7] * wx + parts[k, 5] * wy + parts[k, 9] * wz + z * fx - x * fz
        tz = parts[k, 8] * wx + parts[k, 9] * wy + parts[k, 6] * wz + x * fy - y * fx
        out[b, 0] += fx
        out[b, 1] += fy
        out[b, 2] += fz
        out[b, 3] += tx
        out[b, 4] += ty
        out[b, 5] += tz


@njit(cache=True, error_model="numpy", inline="always")
def find_inertias(whole, r):
    """Torque over angular acceleration along each of the axes r."""
    determinant, cxx, cyy, czz, cxy, cxz, cyz = _cofactors(whole)
    i0 = _about(determinant, cxx, cyy, czz, cxy, cxz, cyz, r[0], r[3], r[6])
    i1 = _about(determinant, cxx, cyy, czz, cxy, cxz, cyz, r[1], r[4], r[7])
    i2 = _about(determinant, cxx, cyy, czz, cxy, cxz, cyz, r[2], r[5], r[8])
    return i0, i1, i2


@njit(cache=True, error_model="numpy", inline="always")
def _solve(whole, x, y, z):
    """Inverse of the inertia that `gather` gives, times a vector; 0 without inertia."""
    determinant, cxx, cyy, czz, cxy, cxz, cyz = _cofactors(whole)
    scale = 1.0 / determinant if determinant > 0.0 else 0.0
    return (
        scale * (cxx * x + cxy * y + cxz * z),
        scale * (cxy * x + cyy * y + cyz * z),
        scale * (cxz * x + cyz * y + czz * z),
    )


@njit(cache=True, error_model="numpy", inline="always")
def _cofactors(whole):
    """Determinant of the inertia that `gather` gives, and its cofactors xx, yy, zz, xy, xz, yz."""
    xx, yy, zz, xy, xz, yz = whole[4], whole[5], whole[6], whole[7], whole[8], whole[9]
    cxx, cyy, czz = yy * zz - yz * yz, xx * zz - xz * xz, xx * yy - xy * xy
    cxy, cxz, cyz = xz * yz - xy * zz, xy * yz - xz * yy, xy * xz - xx * yz
    return xx * cxx + xy * cxy + xz * cxz, cxx, cyy, czz, cxy, cxz, cyz


@njit(cache=True, error_model="numpy", inline="always")
def _about(determinant, cxx, cyy, czz, cxy, cxz, cyz, x, y, z):
    """The determinant over the cofactors' quadratic form along an axis; 0 without inertia."""
    form = cxx * x * x + cyy * y * y + czz * z * z + 2.0 * (cxy * x * y + cxz * x * z + cyz * y * z)
    return determinant / form if form > 0.0 else 0.0
