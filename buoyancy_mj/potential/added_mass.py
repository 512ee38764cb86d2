"""Added mass of a body in unbounded water, from its surface, and how far it can be trusted."""

import dataclasses
import functools
import time
from collections.abc import Callable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.meshes.bisection import Bisection
from buoyancy_mj.meshes.decimation import Decimation
from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.meshes.surface import Surface, find_pieces, signed_volume
from buoyancy_mj.meshes.union import find_symmetries, unite
from buoyancy_mj.potential.ellipsoid import fit_ellipsoid, measure_second_moments
from buoyancy_mj.potential.solution import Solution, solve

COARSE, FINE = 300, 2400
"""Triangles of the first solution at least, and of the last at most."""
GIVEN = 1600
"""Triangles that the surface may have before any is cut."""
LOSS = 0.025
"""Part of its volume that the surface may lose to fewer triangles; the rest is scaled up to it."""
ORDER = 0.8
"""Power of the number of triangles with which the error falls.

It is 2/3 at right-angled edges and 1/2 at edges of thin plates where all triangles are alike, and
more where they are smaller towards the edges, as here.
"""
CLOSE = 0.04
"""What the extrapolation may add, as a part of the added mass, for triangles to be enough."""
SLIGHT = 0.05
"""Part of the displaced mass, or of its moment of inertia, beside which added mass is small."""
REST = 0.06
"""What the extrapolation may add at most, as a part of the displaced and the added mass together.

It is right to a third of itself on prisms, plates, cylinders and ducts. On frames, whose beams have
few triangles across, as much again may be missing.
"""
DISAGREEMENT = 0.01
"""Difference of two formulas for the same at most, as a part of both masses together."""
LONG = 2.0
"""Seconds after which whoever waits is told."""
MANY = 10000
"""Triangles of the surface beyond which whoever waits is told at once."""


@dataclasses.dataclass(frozen=True, eq=False)
class UnboundedAddedMass:
    """Added mass of a body in water without a surface or a bottom."""

    matrix: NDArray[np.float64]
    """Over the density of the water, about the origin (6, 6) [m^3, m^4, m^5]."""
    change: float
    """What the extrapolation added at most, as a part of the displaced and the added mass."""
    triangles: int
    """Triangles of the last solution; 0 for an ellipsoid, which needs none."""
    doubt: str = ""
    """Why it is not to be trusted; empty if it is."""


def compute_added_mass(
    meshes: Sequence[TriMesh], tell: Callable[[], None] = lambda: None
) -> UnboundedAddedMass:
    """Compute the added mass of the union of meshes.

    What is enclosed by them but in none is water too, and moves along. The flow is solved on more
    and more triangles until the added mass changes by less than `CLOSE`; then it is extrapolated,
    and made as symmetric as the union is. An ellipsoid has Lamb's closed form instead.

    Args:
        meshes: closed meshes in one frame.
        tell: called once, if this takes long.
    """
    surface = unite(meshes)
    if surface is None:
        return _doubt("more than two faces meet at an edge of its mesh")
    union = TriMesh(*surface)
    spread = measure_second_moments(*surface, union.centroid) / union.volume
    ellipsoid = fit_ellipsoid(union.volume, union.centroid, spread)
    if ellipsoid.fits(union.compact[0]):
        return UnboundedAddedMass(_move(ellipsoid.added_mass, union.centroid), 0.0, 0)

    # fewer triangles than it has, then more and more of them
    tell = functools.cache(tell)
    if len(surface[1]) > MANY:
        tell()
    vertices, faces = _simplify(union)
    if len(faces) > GIVEN:
        return _doubt(f"its surface needs {len(faces)} triangles, and {GIVEN} are possible")
    try:
        size = float(np.cbrt(union.volume))
        found = _converge((vertices - union.centroid) / size, faces, tell)
    except np.linalg.LinAlgError:
        return _doubt("its surface crosses itself, or almost does, where it has few triangles")

    # with its own size, symmetries and place
    lengths = np.repeat([1.0, size], 3)
    matrix = size**3 * np.outer(lengths, lengths) * found.matrix
    matrix = _move(_average(matrix, find_symmetries(union)), union.centroid)
    return dataclasses.replace(found, matrix=matrix)


def _move(matrix: NDArray[np.float64], point: NDArray[np.float64]) -> NDArray[np.float64]:
    """A matrix (6, 6) about a point (3,) [m] as one about the origin, symmetric to the last bit."""
    point_from_origin = np.eye(6)
    point_from_origin[:3, 3:] = np.cross(point, np.eye(3))
    moved = point_from_origin.T @ matrix @ point_from_origin
    return np.asarray(0.5 * (moved + moved.T))


def _doubt(reason: str) -> UnboundedAddedMass:
    """No added mass, for a reason."""
    return UnboundedAddedMass(np.zeros((6, 6)), np.inf, 0, reason)


def _simplify(mesh: TriMesh) -> Surface:
    """The surface of a mesh in few triangles that enclose the same volume."""
    # by a third each time, as long as that loses little
    fewer, count = mesh, GIVEN
    while count >= 30:
        if len(fewer.faces) > count:
            decimation = Decimation(*fewer.compact)
            decimation.reduce(count)
            even_fewer = TriMesh(*decimation.surface)
            if count < GIVEN and abs(even_fewer.volume / mesh.volume - 1.0) > LOSS:
                break
            fewer = even_fewer
        count = count * 2 // 3

    # the volume that was lost, and rounder triangles in planes
    bisection = Bisection(_restore_volumes(fewer, mesh), fewer.compact[1])
    bisection.turn_flat_edges()
    return bisection.surface


def _restore_volumes(fewer: TriMesh, mesh: TriMesh) -> NDArray[np.float64]:
    """Vertices of a decimated mesh, each of its pieces scaled to the volume that it had before.

    Decimation keeps the order of the pieces, since it keeps the first vertex of each.
    """
    (vertices, faces), (before, faces_before) = fewer.compact, mesh.compact
    restored = vertices.copy()
    for piece, original in zip(find_pieces(faces), find_pieces(faces_before), strict=True):
        now = signed_volume(vertices, faces[np.isin(faces[:, 0], piece)])
        then = signed_volume(before, faces_before[np.isin(faces_before[:, 0], original)])
        middle = vertices[piece].mean(axis=0)
        restored[piece] = middle + np.cbrt(then / now) * (vertices[piece] - middle)
    return restored


def _converge(
    vertices: NDArray[np.float64], faces: NDArray[np.int64], tell: Callable[[], None]
) -> UnboundedAddedMass:
    """Solve on more and more triangles, and extrapolate the last two solutions."""
    displaced = _weigh_displaced(vertices, faces)
    solutions = _solve_finer(vertices, faces, SLIGHT * displaced, tell)
    count, solution = next(solutions)
    small = np.inf
    while small > CLOSE and 4 * count < 3 * FINE:
        coarse, before = solution, count
        count, solution = next(solutions)
        added = np.diag(solution.matrix)
        rest = (solution.matrix - coarse.matrix) / ((count / before) ** ORDER - 1.0)
        small = _measure(rest, SLIGHT * displaced + added)

    # rounding may have left less than nothing of what is nearly none
    scale = np.sqrt(displaced + added)
    matrix = solution.matrix + rest
    eigenvalues, axes = np.linalg.eigh(matrix / np.outer(scale, scale))
    matrix = np.outer(scale, scale) * ((axes * np.maximum(eigenvalues, 0.0)) @ axes.T)

    # whether all is as it must be
    change = _measure(rest, displaced + added)
    other = _measure(solution.translation - solution.matrix[:3, :3], (displaced + added)[:3])
    worst = max(other, -float(eigenvalues[0]))
    doubt = ""
    if change > REST:
        doubt = f"on {count} triangles {100 * change:.2g} % of it are still to come"
    elif worst > DISAGREEMENT:
        doubt = f"on {count} triangles two formulas for it differ by {100 * worst:.2g} %"
    return UnboundedAddedMass(matrix, change, count, doubt)


def _measure(matrix: NDArray[np.float64], scale: NDArray[np.float64]) -> float:
    """Largest entry of a matrix (n, n), over the scale of its diagonal (n,)."""
    return float((np.abs(matrix) / np.sqrt(np.outer(scale, scale))).max())


def _solve_finer(
    vertices: NDArray[np.float64],
    faces: NDArray[np.int64],
    slight: NDArray[np.float64],
    tell: Callable[[], None],
) -> Iterator[tuple[int, Solution]]:
    """Solve on more and more triangles, up to twice as many each time, where the flow turns most.

    Yields:
        The number of triangles, and the solution.
    """
    start, told = time.monotonic(), False
    bisection = Bisection(vertices, faces)
    corners = vertices[faces]
    lengths = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    bisection.refine(lengths.max(axis=1) ** 3, COARSE)
    while True:
        vertices, faces = bisection.surface
        solution = solve(vertices, faces)
        yield len(faces), solution

        # the next one takes about four times as long
        if not told and 4.0 * (time.monotonic() - start) > LONG:
            tell()
            told = True
        scale = slight + np.diag(solution.matrix)
        errors = _estimate_errors(vertices, faces, solution.curls, scale)
        bisection.refine(errors, min(2 * len(faces), FINE))


def _estimate_errors(
    vertices: NDArray[np.float64],
    faces: NDArray[np.int64],
    curls: NDArray[np.float64],
    scale: NDArray[np.float64],
) -> NDArray[np.float64]:
    """What is missing in the energy of the flow on each triangle (m,), but for a factor.

    The cube of its longest edge times the squared jumps of the slope of the potential across its
    edges, over the scale of the energy of each of the six motions.
    """
    corners = vertices[faces]
    edges = np.roll(corners, -1, axis=1) - corners
    lengths = np.linalg.norm(edges, axis=2)
    slopes = np.einsum("tex,tjx->tej", edges / lengths[:, :, None], curls).reshape(-1, 6)

    # the other side of each edge runs the other way
    starts, ends = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    forward, backward = starts * len(vertices) + ends, ends * len(vertices) + starts
    order = np.argsort(forward)
    others = order[np.searchsorted(forward[order], backward)]
    jumps = ((slopes + slopes[others]) ** 2 / scale).sum(axis=1).reshape(-1, 3)
    errors: NDArray[np.float64] = lengths.max(axis=1) ** 3 * jumps.sum(axis=1)
    return errors


def _weigh_displaced(
    vertices: NDArray[np.float64], faces: NDArray[np.int64]
) -> NDArray[np.float64]:
    """Volume, thrice, and its moments of inertia about the axes at the origin (6,) [m^3, m^5]."""
    corners = vertices[faces]
    volumes = np.linalg.det(corners) / 6.0
    sums = corners.sum(axis=1)
    squares = volumes @ ((corners**2).sum(axis=1) + sums**2) / 20.0
    return np.concatenate([np.full(3, volumes.sum()), squares.sum() - squares])


def _average(matrix: NDArray[np.float64], turns: NDArray[np.float64]) -> NDArray[np.float64]:
    """The mean of a matrix (6, 6) and its images under rotations and reflections (n, 3, 3).

    Angular velocities are reflected the other way.
    """
    images = []
    for turn in turns:
        both = np.zeros((6, 6))
        both[:3, :3], both[3:, 3:] = turn, np.linalg.det(turn) * turn
        images.append(both @ matrix @ both.T)
    mean: NDArray[np.float64] = np.mean(images, axis=0)
    return mean
