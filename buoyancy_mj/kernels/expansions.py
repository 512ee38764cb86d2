"""Pressure over a node of the tree, by a quadratic about its middle and the moments of its area.

The quadratic is known by its values at 13 places in the node, which several nodes gather, so that
the processor works on several at once.
"""

import math

from buoyancy_mj.kernels import local, tree
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.local import HEAD, heads
from buoyancy_mj.kernels.quadrature import PLACES
from buoyancy_mj.kernels.vectors import place, triple

_STENCIL = (
    (0.0, 0.0, 0.0),
    (1.0, 0.0, 0.0), (-1.0, 0.0, 0.0),
    (0.0, 1.0, 0.0), (0.0, -1.0, 0.0),
    (0.0, 0.0, 1.0), (0.0, 0.0, -1.0),
    (1.0, 1.0, 0.0), (-1.0, -1.0, 0.0),
    (1.0, 0.0, 1.0), (-1.0, 0.0, -1.0),
    (0.0, 1.0, 1.0), (0.0, -1.0, -1.0),
)  # fmt: skip
"""Places in a node at which a quadratic is known by its values."""
NODES = PLACES // len(_STENCIL)
"""Nodes that may wait."""


@njit(cache=True, error_model="numpy")
def add_node(asked, nodes, count, near, setting, sums, moments, boxes, node, origin, r, level):
    """Let a wet node wait.

    Where there are more than the room holds, those that wait are summed.

    Args:
        asked: a room of `local` for `PLACES`.
        nodes: the nodes that wait (NODES,).
        count: how many wait.
        near: the waves around the hull, see `local.gather`.
        setting: a `quadrature.Setting`.
        sums: force over rho g [m^3], and torque about the origin over rho g [m^4] (6,), in the
            hull's frame; written.
        moments: of all nodes.
        boxes: of all nodes.
        node: the node.
        origin: of the hull's frame in the world.
        r: world_from_frame.
        level: the still level [m].

    Returns:
        How many wait then.
    """
    if count == NODES:
        count = sum_nodes(asked, nodes, count, near, setting, sums, moments, boxes)
    first = count * len(_STENCIL)
    b0, b1, b2 = triple(boxes, node, tree.MIDDLE)
    e0, e1, e2 = triple(boxes, node, tree.HALF)
    s = math.sqrt(e0 * e0 + e1 * e1 + e2 * e2) / math.sqrt(3.0)
    for n in range(len(_STENCIL)):
        i, j, k = _STENCIL[n]
        x, y, z = place(origin, r, b0 + s * i, b1 + s * j, b2 + s * k)
        asked[0, first + n], asked[1, first + n] = x - near[local.X], y - near[local.Y]
        asked[2, first + n] = z - level
    nodes[count] = node
    return count + 1


@njit(cache=True, error_model="numpy")
def sum_nodes(asked, nodes, count, near, setting, sums, moments, boxes):
    """Add force and torque of all nodes that wait; returns that none do any more."""
    size = len(_STENCIL)
    heads(near, asked, count * size, setting.time, setting.dynamic)
    for n in range(count):
        _add(moments[nodes[n]], boxes[nodes[n]], asked[HEAD], n * size, sums)
    return 0


@njit(cache=True, error_model="numpy")
def _add(m, box, head, first, sums):
    """Add force and torque of the head over a node, about the origin.

    Its moments m are about the middle of its box.

    The heads at its places stand in a row from `first`.
    """
    b0, b1, b2 = box[tree.MIDDLE], box[tree.MIDDLE + 1], box[tree.MIDDLE + 2]
    e0, e1, e2 = box[tree.HALF], box[tree.HALF + 1], box[tree.HALF + 2]
    s = math.sqrt((e0 * e0 + e1 * e1 + e2 * e2) / 3.0)
    p = head[first]
    px, nx, py, ny = head[first + 1], head[first + 2], head[first + 3], head[first + 4]
    pz, nz = head[first + 5], head[first + 6]
    xy, xz = head[first + 7] + head[first + 8], head[first + 9] + head[first + 10]
    yz = head[first + 11] + head[first + 12]

    # its gradient, and half its second derivatives, those across once for both
    step, square = 0.5 / s, 0.5 / (s * s)
    g = step * (px - nx), step * (py - ny), step * (pz - nz)
    second = (
        square * (px + nx - 2.0 * p),
        square * (py + ny - 2.0 * p),
        square * (pz + nz - 2.0 * p),
        square * (xy - px - nx - py - ny + 2.0 * p),
        square * (xz - px - nx - pz - nz + 2.0 * p),
        square * (yz - py - ny - pz - nz + 2.0 * p),
    )
    f0 = _force(m, 0, p, g, second)
    f1 = _force(m, 1, p, g, second)
    f2 = _force(m, 2, p, g, second)

    # the torque about the middle, to first order
    t0 = _lever(m, 1, 2, p, g) - _lever(m, 2, 1, p, g)
    t1 = _lever(m, 2, 0, p, g) - _lever(m, 0, 2, p, g)
    t2 = _lever(m, 0, 1, p, g) - _lever(m, 1, 0, p, g)
    sums[0] += f0
    sums[1] += f1
    sums[2] += f2
    sums[3] += t0 + b1 * f2 - b2 * f1
    sums[4] += t1 + b2 * f0 - b0 * f2
    sums[5] += t2 + b0 * f1 - b1 * f0


@njit(cache=True, error_model="numpy", inline="always")
def _force(m, c, p, g, h):
    """Component c of the integral of a quadratic head over the area.

    The head has a value p, a gradient g and second derivatives h.
    """
    return (
        p * m[tree.VECTOR + c] + g[0] * m[tree.X + c] + g[1] * m[tree.Y + c] + g[2] * m[tree.Z + c]
        + h[0] * m[tree.XX + c] + h[1] * m[tree.YY + c] + h[2] * m[tree.ZZ + c]
        + h[3] * m[tree.XY + c] + h[4] * m[tree.XZ + c] + h[5] * m[tree.YZ + c]
    )  # fmt: skip


@njit(cache=True, error_model="numpy", inline="always")
def _lever(m, i, c, p, g):
    """Integral of a linear head times coordinate i over component c of the area."""
    x = tree.XX if i == 0 else tree.XY if i == 1 else tree.XZ
    y = tree.XY if i == 0 else tree.YY if i == 1 else tree.YZ
    z = tree.XZ if i == 0 else tree.YZ if i == 1 else tree.ZZ
    return p * m[tree.X + 3 * i + c] + g[0] * m[x + c] + g[1] * m[y + c] + g[2] * m[z + c]
