"""Added mass of a body estimated from its hulls: by potential flow, or as that of an ellipsoid."""

import dataclasses
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.hulls.hull import Hull, combine_volumes
from buoyancy_mj.loads.matrices import move_to_origin
from buoyancy_mj.loads.notices import tell_of_potential_flow
from buoyancy_mj.potential.cache import find_added_mass
from buoyancy_mj.potential.ellipsoid import fit_ellipsoid, measure_second_moments


@dataclasses.dataclass(frozen=True, eq=False)
class Estimate:
    """Added mass of a body, and how it was found."""

    matrix: NDArray[np.float64]
    """About the body's origin, in its axes (6, 6) [kg, kg m, kg m^2]."""
    method: str
    """'mesh' for potential flow around its meshes, 'ellipsoid', or 'stated' for no estimate."""
    change: float = 0.0
    """What the extrapolation added, as a part of the displaced and the added mass together."""
    triangles: int = 0
    """Triangles of the finest solution; 0 for an ellipsoid."""
    doubt: str = ""
    """Why potential flow is not trusted; empty if it is, or was not asked."""


def estimate_added_mass(
    hulls: Sequence[Hull], density: float, method: str = "estimate"
) -> Estimate:
    """Estimate the added mass of a body from its hulls.

    'mesh' solves the potential flow around them in unbounded water. 'ellipsoid' takes the ellipsoid
    of their volume with the proportions of their second moments. 'estimate' takes 'mesh', or
    'ellipsoid' where that is not to be trusted.

    A hull of a fill below 1 lets water through: what it adds is that part of what it would add if
    it were full.

    Args:
        hulls: all hulls of the body.
        density: of the water [kg/m^3].
        method: one of these.
    """
    if method == "ellipsoid":
        return Estimate(density * _take_ellipsoid(hulls), "ellipsoid")
    solved = _solve(hulls, density)
    if solved.doubt and method == "estimate":
        matrix = density * _take_ellipsoid(hulls)
        return dataclasses.replace(solved, matrix=matrix, method="ellipsoid")
    return solved


def _solve(hulls: Sequence[Hull], density: float) -> Estimate:
    """By potential flow around all that is at least as full, for each fill, from the fullest on."""
    fills = sorted({hull.fill for hull in hulls}, reverse=True)
    matrix, change, triangles, doubt = np.zeros((6, 6)), 0.0, 0, ""
    for fill, less in zip(fills, [*fills[1:], 0.0], strict=True):
        meshes = [hull.mesh_in_body for hull in hulls if hull.fill >= fill]
        found = find_added_mass(meshes, tell_of_potential_flow)
        matrix += density * (fill - less) * found.matrix
        change, triangles = max(change, found.change), max(triangles, found.triangles)
        doubt = doubt or found.doubt
    return Estimate(matrix, "mesh", change, triangles, doubt)


def _take_ellipsoid(hulls: Sequence[Hull]) -> NDArray[np.float64]:
    """That of an ellipsoid like the hulls, over the density of the water (6, 6)."""
    volume, centre = combine_volumes(hulls)
    spread = np.zeros((3, 3))
    for hull in hulls:
        mesh = hull.mesh_in_body
        spread += hull.fill * measure_second_moments(mesh.vertices, mesh.faces, centre) / volume
    ellipsoid = fit_ellipsoid(volume, centre, spread)
    return move_to_origin(ellipsoid.added_mass, centre)
