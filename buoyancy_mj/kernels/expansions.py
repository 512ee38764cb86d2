"""Pressure over a node of the tree, by a quadratic about its middle and the moments of its area."""

from buoyancy_mj.kernels import tree
from buoyancy_mj.kernels.blocks import join_values
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.vectors import rotate_back
from buoyancy_mj.kernels.waves import head


@njit(cache=True, error_model="numpy", _nrt=False)
def find_quadratic(waves, x, y, z, s, time, dynamic):
    """The head of waves about a place as a quadratic, by its values at 13 places up to s away.

    Returns its value, its gradient (3), and its coefficients of x^2, y^2, z^2, x y, x z and y z.
    """
    p = head(waves, x, y, z, time, dynamic)
    px, nx = head(waves, x + s, y, z, time, dynamic), head(waves, x - s, y, z, time, dynamic)
    py, ny = head(waves, x, y + s, z, time, dynamic), head(waves, x, y - s, z, time, dynamic)
    pz, nz = head(waves, x, y, z + s, time, dynamic), head(waves, x, y, z - s, time, dynamic)
    xy = head(waves, x + s, y + s, z, time, dynamic) + head(waves, x - s, y - s, z, time, dynamic)
    xz = head(waves, x + s, y, z + s, time, dynamic) + head(waves, x - s, y, z - s, time, dynamic)
    yz = head(waves, x, y + s, z + s, time, dynamic) + head(waves, x, y - s, z - s, time, dynamic)
    return join_values(s, p, (px, nx, py, ny, pz, nz), (xy, xz, yz))


@njit(cache=True, error_model="numpy", _nrt=False)
def add_node(moments, node, middle, r, quadratic, sums):
    """Add force and torque of the head over a node.

    Args:
        moments: of all nodes.
        node: the node.
        middle: of its box, in the frame of the hull.
        r: world_from_frame.
        quadratic: the head about its middle in the world's axes, see `blocks.quadratic_in`.
        sums: force over rho g [m^3], and torque about the origin over rho g [m^4] (6,), in the
            hull's frame; written.
    """
    p, slope, second = quadratic
    g = rotate_back(r, slope[0], slope[1], slope[2])
    h = _turn_back(r, second)
    f0 = _force(moments, node, 0, p, g, h)
    f1 = _force(moments, node, 1, p, g, h)
    f2 = _force(moments, node, 2, p, g, h)

    # the torque about the middle, to first order
    m, n = moments, node
    t0 = _lever(m, n, 1, 2, p, g) - _lever(m, n, 2, 1, p, g)
    t1 = _lever(m, n, 2, 0, p, g) - _lever(m, n, 0, 2, p, g)
    t2 = _lever(m, n, 0, 1, p, g) - _lever(m, n, 1, 0, p, g)
    b0, b1, b2 = middle
    sums[0] += f0
    sums[1] += f1
    sums[2] += f2
    sums[3] += t0 + b1 * f2 - b2 * f1
    sums[4] += t1 + b2 * f0 - b0 * f2
    sums[5] += t2 + b0 * f1 - b1 * f0


@njit(cache=True, error_model="numpy", inline="always")
def _turn_back(r, second):
    """Coefficients of x^2, y^2, z^2, x y, x z and y z of the world, in the axes of a frame."""
    xx, yy, zz, xy, xz, yz = second
    xy, xz, yz = 0.5 * xy, 0.5 * xz, 0.5 * yz
    # the symmetric matrix times each column of the rotation
    a0, a1, a2 = _times(xx, yy, zz, xy, xz, yz, r[0], r[3], r[6])
    b0, b1, b2 = _times(xx, yy, zz, xy, xz, yz, r[1], r[4], r[7])
    c0, c1, c2 = _times(xx, yy, zz, xy, xz, yz, r[2], r[5], r[8])
    return (
        r[0] * a0 + r[3] * a1 + r[6] * a2,
        r[1] * b0 + r[4] * b1 + r[7] * b2,
        r[2] * c0 + r[5] * c1 + r[8] * c2,
        2.0 * (r[0] * b0 + r[3] * b1 + r[6] * b2),
        2.0 * (r[0] * c0 + r[3] * c1 + r[6] * c2),
        2.0 * (r[1] * c0 + r[4] * c1 + r[7] * c2),
    )


@njit(cache=True, error_model="numpy", inline="always")
def _times(xx, yy, zz, xy, xz, yz, x, y, z):
    """A symmetric matrix times a vector."""
    return xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z


@njit(cache=True, error_model="numpy", inline="always")
def _force(m, n, c, p, g, h):
    """Component c of the integral of a quadratic head over the area of a node.

    The head has a value p, a gradient g and coefficients h of the squares and products.
    """
    return (
        p * m[n, tree.VECTOR + c]
        + g[0] * m[n, tree.X + c] + g[1] * m[n, tree.Y + c] + g[2] * m[n, tree.Z + c]
        + h[0] * m[n, tree.XX + c] + h[1] * m[n, tree.YY + c] + h[2] * m[n, tree.ZZ + c]
        + h[3] * m[n, tree.XY + c] + h[4] * m[n, tree.XZ + c] + h[5] * m[n, tree.YZ + c]
    )  # fmt: skip


@njit(cache=True, error_model="numpy", inline="always")
def _lever(m, n, i, c, p, g):
    """Integral of a linear head times coordinate i over component c of the area."""
    x = tree.XX if i == 0 else tree.XY if i == 1 else tree.XZ
    y = tree.XY if i == 0 else tree.YY if i == 1 else tree.YZ
    z = tree.XZ if i == 0 else tree.YZ if i == 1 else tree.ZZ
    return (
        p * m[n, tree.X + 3 * i + c]
        + g[0] * m[n, x + c] + g[1] * m[n, y + c] + g[2] * m[n, z + c]
    )  # fmt: skip
