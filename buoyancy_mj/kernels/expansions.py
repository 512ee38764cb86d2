"""Pressure over a node of the tree, by a quadratic about its middle and the moments of its area.

The quadratic is known by the head at 13 places in the node. Several nodes wait, so that their heads
are found together.
"""

import math

from buoyancy_mj.kernels import tree
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.heads import HEAD, set_heads
from buoyancy_mj.kernels.vectors import rotate_back, triple

_STENCIL = (
    (0.0, 0.0, 0.0),
    (1.0, 0.0, 0.0), (-1.0, 0.0, 0.0),
    (0.0, 1.0, 0.0), (0.0, -1.0, 0.0),
    (0.0, 0.0, 1.0), (0.0, 0.0, -1.0),
    (1.0, 1.0, 0.0), (-1.0, -1.0, 0.0),
    (1.0, 0.0, 1.0), (-1.0, 0.0, -1.0),
    (0.0, 1.0, 1.0), (0.0, -1.0, -1.0),
)  # fmt: skip
"""Places about the middle of a node at which the head is found, in the world's axes."""
SIZE = len(_STENCIL)
"""How many they are."""
NODES = 4
"""Nodes that may wait."""


@njit(cache=True, error_model="numpy", _nrt=False)
def let_wait(asked, nodes, count, node, middle, size):
    """Let a wet node wait as the one behind `count` others.

    Args:
        asked: its places, as rows of `heads.set_heads` (4, NODES * SIZE); written.
        nodes: the nodes that wait (NODES,); written.
        count: how many wait.
        node: the node.
        middle: of its box, from the still level.
        size: half the diagonal of its box.
    """
    s = size / math.sqrt(3.0)
    for n in range(SIZE):
        for c in range(3):
            asked[c, count * SIZE + n] = middle[c] + s * _STENCIL[n][c]
    nodes[count] = node


@njit(cache=True, error_model="numpy", _nrt=False)
def sum_nodes(sea, asked, nodes, count, moments, boxes, r, sums):
    """Add force and torque of all nodes that wait.

    Args:
        sea: a `heads.Sea`.
        asked: see `let_wait`.
        nodes: see `let_wait`.
        count: how many wait.
        moments: of all nodes.
        boxes: of all nodes.
        r: world_from_frame.
        sums: force over rho g [m^3], and torque about the origin over rho g [m^4] (6,), in the
            hull's frame; written.
    """
    set_heads(sea, asked, count * SIZE)
    for n in range(count):
        node = nodes[n]
        e0, e1, e2 = triple(boxes, node, tree.HALF)
        s = math.sqrt((e0 * e0 + e1 * e1 + e2 * e2) / 3.0)
        quadratic = _find_quadratic(asked, n * SIZE, s)
        _add(moments, node, triple(boxes, node, tree.MIDDLE), r, quadratic, sums)


@njit(cache=True, error_model="numpy", _nrt=False)
def _find_quadratic(asked, first, s):
    """The head about the middle of a node: its value, its gradient (3), and coefficients.

    These are of x^2, y^2, z^2, x y, x z and y z. The heads stand from column `first` on.
    """
    p = asked[HEAD, first]
    px, nx, py = asked[HEAD, first + 1], asked[HEAD, first + 2], asked[HEAD, first + 3]
    ny, pz, nz = asked[HEAD, first + 4], asked[HEAD, first + 5], asked[HEAD, first + 6]
    xy = asked[HEAD, first + 7] + asked[HEAD, first + 8]
    xz = asked[HEAD, first + 9] + asked[HEAD, first + 10]
    yz = asked[HEAD, first + 11] + asked[HEAD, first + 12]
    step, square = 0.5 / s, 0.5 / (s * s)
    return (
        p, (step * (px - nx), step * (py - ny), step * (pz - nz)),
        (
            square * (px + nx - 2.0 * p),
            square * (py + ny - 2.0 * p),
            square * (pz + nz - 2.0 * p),
            square * (xy - px - nx - py - ny + 2.0 * p),
            square * (xz - px - nx - pz - nz + 2.0 * p),
            square * (yz - py - ny - pz - nz + 2.0 * p),
        ),
    )  # fmt: skip


@njit(cache=True, error_model="numpy", _nrt=False)
def _add(moments, node, middle, r, quadratic, sums):
    """Add force and torque of a quadratic head over a node."""
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
