"""The flow around a moving body on one surface of triangles, and its added mass.

The potential on the surface is continuous and linear on each triangle. With the single layer V, the
double layer K, its transpose K' and the hypersingular operator D, all by Galerkin's method, the
potential phi outside a body whose surface moves by g along its outward normal obeys (Steinbach
2008, *Numerical Approximation Methods for Elliptic Boundary Value Problems*, ch. 6 and 7)

    D phi = -(1/2 + K') g,
    added mass over density = -<phi, g> = <V g, g> + <D^-1 (1/2 + K') g, (1/2 + K') g>.

Both terms are positive. The second is short of its true value by the squared error of phi in the
norm of energy, so that a coarse surface does well; thin plates need nothing of their own. D is the
single layer of the surface curl (Maue 1949), which is constant on each triangle.
"""

import dataclasses
import math

import numpy as np
import scipy
from numpy.typing import NDArray

from buoyancy_mj.kernels.galerkin import Layers, Panels, Rule, Rules, sum_layers
from buoyancy_mj.meshes.surface import find_pieces


@dataclasses.dataclass(frozen=True, eq=False)
class Solution:
    """The six unit motions of a body: along the axes, then about them through the origin."""

    matrix: NDArray[np.float64]
    """Added mass over the density of the water (6, 6) [m^3, m^4, m^5]."""
    translation: NDArray[np.float64]
    """That of translation (3, 3) [m^3] by another formula: <D^-1 n, n> less the volume."""
    curls: NDArray[np.float64]
    """Surface curl of the six potentials on each triangle, n x grad phi (m, 6, 3)."""


def solve(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> Solution:
    """Solve for the flow around a body.

    Args:
        vertices: corners (n, 3) [m] of a closed surface in which each edge has two faces.
        faces: indices of the corners of each triangle (m, 3), counter-clockwise from outside.

    Raises:
        numpy.linalg.LinAlgError: the energy of some flow is not positive; the surface crosses
            itself.
    """
    panels = _build_panels(vertices, faces)
    n, m = len(vertices), len(faces)
    layers = Layers(np.zeros((m, m)), np.zeros((n, 6)), np.zeros((6, 6)))
    sum_layers(panels, _RULES, layers)

    # the hypersingular operator, and the constant of each piece of the surface, which it forgets
    opposite = np.roll(panels.tangents * panels.lengths[:, :, None], -1, axis=1)
    curls_of_hats = opposite / (2.0 * panels.areas[:, None, None])
    operator = _build_hypersingular(faces, curls_of_hats, layers.single, n)
    scale = float(np.trace(operator)) / n
    for piece in find_pieces(faces):
        operator[np.ix_(piece, piece)] += scale / len(piece)

    # the right-hand sides and the six potentials; LU, since the threads of a Cholesky factorization
    # wait for each other without end where other processes are busy
    weights = _weigh_motions(panels, vertices, n)
    sides, normal = 0.5 * weights + layers.double, weights[:, :3]
    potentials, dipoles = np.split(np.linalg.solve(operator, np.hstack([sides, normal])), [6], 1)
    energies = sides.T @ potentials, normal.T @ dipoles
    for energy in energies:
        eigenvalues = np.linalg.eigvalsh(energy + energy.T)
        if eigenvalues[0] < -1e-9 * eigenvalues[-1]:
            raise np.linalg.LinAlgError("the energy of a flow is negative")
    matrix = layers.power + energies[0]

    # by the other formula
    volume = float(np.einsum("ni,ni->", vertices, normal)) / 3.0
    return Solution(
        matrix=0.5 * (matrix + matrix.T),
        translation=energies[1] - volume * np.eye(3),
        curls=np.einsum("tkx,tkj->tjx", curls_of_hats, potentials[faces]),
    )


def _build_panels(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> Panels:
    """The triangles as the kernel takes them."""
    corners = vertices[faces]
    edges = np.roll(corners, -1, axis=1) - corners
    lengths = np.linalg.norm(edges, axis=2)
    tangents = edges / lengths[:, :, None]
    doubled = np.cross(edges[:, 0], -edges[:, 2])
    areas = 0.5 * np.linalg.norm(doubled, axis=1)
    normals = doubled / (2.0 * areas[:, None])
    centres = corners.mean(axis=1)
    return Panels(
        # those of a mesh are read-only, and kernels would be compiled again for such an array
        faces=faces.copy(),
        corners=corners,
        normals=normals,
        tangents=tangents,
        outwards=np.cross(tangents, normals[:, None]),
        lengths=lengths,
        areas=areas,
        centres=centres,
        radii=np.linalg.norm(corners - centres[:, None], axis=2).max(axis=1),
    )


def _build_hypersingular(
    faces: NDArray[np.int64],
    curls: NDArray[np.float64],
    single: NDArray[np.float64],
    count: int,
) -> NDArray[np.float64]:
    """The hypersingular operator between hat functions (n, n), from their curls (m, 3, 3)."""
    single = 0.5 * (single + single.T)
    rows = np.repeat(np.arange(len(faces)), 3)
    operator = np.zeros((count, count))
    for axis in range(3):
        curl = scipy.sparse.csr_matrix(
            (curls[:, :, axis].ravel(), (rows, faces.ravel())), shape=(len(faces), count)
        )
        operator += curl.T @ (curl.T @ single).T
    return operator


def _weigh_motions(
    panels: Panels, vertices: NDArray[np.float64], count: int
) -> NDArray[np.float64]:
    """Integrals of each hat function times n and x cross n (n, 6)."""
    weights = np.zeros((count, 6))
    total = panels.corners.sum(axis=1)
    for corner in range(3):
        at = panels.faces[:, corner]
        moments = (total + vertices[at]) * panels.areas[:, None] / 12.0
        flows = panels.normals * panels.areas[:, None] / 3.0
        np.add.at(weights, at, np.hstack([flows, np.cross(moments, panels.normals)]))
    return weights


def _rule_of_seven() -> Rule:
    """The rule of degree 5 (Radon 1948)."""
    root = math.sqrt(15.0)
    points, weights = [[1.0 / 3.0] * 3], [9.0 / 40.0]
    for sign in (-1.0, 1.0):
        a = (6.0 + sign * root) / 21.0
        points += [[1.0 - 2.0 * a, a, a], [a, 1.0 - 2.0 * a, a], [a, a, 1.0 - 2.0 * a]]
        weights += [(155.0 + sign * root) / 1200.0] * 3
    return Rule(np.array(points), np.array(weights))


def _quarter(rule: Rule) -> Rule:
    """A rule on each of the four triangles between the corners and the middles of the edges."""
    corners = np.eye(3)
    middles = 0.5 * (corners + np.roll(corners, -1, axis=0))
    pieces = (
        [corners[0], middles[0], middles[2]],
        [middles[0], corners[1], middles[1]],
        [middles[2], middles[1], corners[2]],
        middles,
    )
    points = np.vstack([rule.points @ np.array(piece) for piece in pieces])
    return Rule(points, np.tile(rule.weights, 4) / 4.0)


_RULES = Rules(
    near=_quarter(_rule_of_seven()),
    middle=Rule(np.full((3, 3), 1.0 / 6.0) + 0.5 * np.eye(3), np.full(3, 1.0 / 3.0)),
    far=Rule(np.full((1, 3), 1.0 / 3.0), np.ones(1)),
)
"""Points at which the potential of a triangle is taken on another."""
