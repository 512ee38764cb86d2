"""Triangles that a surface cuts, and integrals over what is wet of them.

A corner is a tuple (x, y, z, d): its place, and its depth d under the plane that a hull is cut by.
"""

from buoyancy_mj.kernels.compiling import njit


@njit(cache=True, error_model="numpy", inline="always")
def lone_corner(wet0, wet1, wet2):
    """Which corner of a triangle that the surface cuts is alone on its side."""
    return 0 if wet1 == wet2 else 1 if wet0 == wet2 else 2


@njit(cache=True, error_model="numpy", inline="always")
def turn(first, p, q, o):
    """Three corners in their order round the triangle, from one of them on."""
    if first == 1:
        return q, o, p
    if first == 2:
        return o, p, q
    return p, q, o


@njit(cache=True, error_model="numpy", inline="always")
def moments(a, p, q, o):
    """Integrals of d n_z dA over a wet triangle: plain, times x, y and z, and times d.

    `a` is its signed area seen from above. The integral of a product of linear functions f, g over
    a triangle of area a is a (sum f sum g + sum f g) / 12.
    """
    x0, y0, z0, d0 = p
    x1, y1, z1, d1 = q
    x2, y2, z2, d2 = o
    d = d0 + d1 + d2
    twelfth = a / 12.0
    return (
        a * d / 3.0,
        twelfth * (d * (x0 + x1 + x2) + d0 * x0 + d1 * x1 + d2 * x2),
        twelfth * (d * (y0 + y1 + y2) + d0 * y0 + d1 * y1 + d2 * y2),
        twelfth * (d * (z0 + z1 + z2) + d0 * z0 + d1 * z1 + d2 * z2),
        twelfth * (d * d + d0 * d0 + d1 * d1 + d2 * d2),
    )


@njit(cache=True, error_model="numpy", inline="always")
def _between(p, q, share):
    """The corner a share of the way from p to q."""
    return (
        p[0] + share * (q[0] - p[0]),
        p[1] + share * (q[1] - p[1]),
        p[2] + share * (q[2] - p[2]),
        p[3] + share * (q[3] - p[3]),
    )


@njit(cache=True, error_model="numpy")
def cut(a, p, q, o, wp, wq, wo):
    """The wet part of a triangle that the surface cuts.

    w are the depths of its corners under the surface.

    Returns its `moments`, its fraction of the area, and the two ends of the cut, such that the
    waterplane lies to the left of the way from the first to the second, seen from above.
    """
    # turn the triangle so that p is alone on its side
    first = lone_corner(wp > 0.0, wq > 0.0, wo > 0.0)
    p, q, o = turn(first, p, q, o)
    wp, wq, wo = turn(first, wp, wq, wo)

    # where its two edges meet the surface
    s, t = wp / (wp - wq), wp / (wp - wo)
    b, c = _between(p, q, s), _between(p, o, t)

    # a triangle is wet, or a quadrangle: two triangles
    if wp > 0.0:
        return moments(s * t * a, p, b, c), s * t, (c[0], c[1], c[2]), (b[0], b[1], b[2])
    v, mx, my, mz, n = moments((1.0 - s) * a, b, q, o)
    u, nx, ny, nz, m = moments(s * (1.0 - t) * a, b, o, c)
    both = (v + u, mx + nx, my + ny, mz + nz, n + m)
    return both, 1.0 - s * t, (b[0], b[1], b[2]), (c[0], c[1], c[2])
