"""The integrals of `clip` over a node that is wholly wet, by its moments."""

from buoyancy_mj.kernels import tree
from buoyancy_mj.kernels.compiling import inlined


@inlined
def integrate_node(m, middle, r, under, gradient):
    """The seven integrals over a node that is wholly wet, by its moments m, in the hull's frame.

    Of d, x d, y d, z d, d^2 and 1 over its area seen from above, and of 1 over its area. The middle
    of its box lies `under` the plane.
    """
    # contracted with the vertical
    s = _vertical(m, tree.VECTOR, r)
    t0, t1, t2 = _vertical(m, tree.X, r), _vertical(m, tree.Y, r), _vertical(m, tree.Z, r)
    u00, u11, u22 = _vertical(m, tree.XX, r), _vertical(m, tree.YY, r), _vertical(m, tree.ZZ, r)
    u01, u02, u12 = _vertical(m, tree.XY, r), _vertical(m, tree.XZ, r), _vertical(m, tree.YZ, r)

    # with the depth
    g0, g1, g2 = gradient
    tilted = g0 * t0 + g1 * t1 + g2 * t2
    n0 = g0 * u00 + g1 * u01 + g2 * u02
    n1 = g0 * u01 + g1 * u11 + g2 * u12
    n2 = g0 * u02 + g1 * u12 + g2 * u22
    part = under * s + tilted
    b0, b1, b2 = middle
    return (
        part,
        b0 * part + under * t0 + n0,
        b1 * part + under * t1 + n1,
        b2 * part + under * t2 + n2,
        under * (part + tilted) + g0 * n0 + g1 * n1 + g2 * n2,
        s,
        m[tree.AREA],
    )


@inlined
def _vertical(m, k, r):
    """Three numbers of a row of moments, along the world's vertical."""
    return m[k] * r[6] + m[k + 1] * r[7] + m[k + 2] * r[8]


@inlined
def sum_nodes(a, b):
    """Seven numbers and seven more."""
    return (
        a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3], a[4] + b[4], a[5] + b[5], a[6] + b[6],
    )  # fmt: skip
