"""Ellipsoids: their added mass in closed form, and those that a volume is like."""

import math
from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

ROUND = 0.01
"""How far vertices may lie off an ellipsoid that a mesh still is, as a part of its radii."""


class Ellipsoid(NamedTuple):
    """An ellipsoid somewhere in a frame."""

    radii: NDArray[np.float64]
    """Semi-axes (3,) [m]."""
    axes: NDArray[np.float64]
    """Their directions, as columns (3, 3)."""
    centre: NDArray[np.float64]
    """Its centre (3,) [m]."""

    @property
    def added_mass(self) -> NDArray[np.float64]:
        """Added mass over the density of the water, about its centre (6, 6) [m^3, m^5]."""
        frame = np.zeros((6, 6))
        frame[:3, :3] = frame[3:, 3:] = self.axes
        return frame @ np.diag(ellipsoid_added_mass(self.radii, 1.0)) @ frame.T

    def fits(self, vertices: NDArray[np.float64]) -> bool:
        """Whether vertices (n, 3) [m] lie on it."""
        places = (vertices - self.centre) @ self.axes / self.radii
        return bool(np.abs(np.linalg.norm(places, axis=1) - 1.0).max() < ROUND)


def fit_ellipsoid(
    volume: float, centre: NDArray[np.float64], spread: NDArray[np.float64]
) -> Ellipsoid:
    """The ellipsoid of a volume with the proportions of its second moments.

    Args:
        volume: the volume [m^3].
        centre: its centroid (3,) [m].
        spread: its second moments about the centroid, over the volume (3, 3) [m^2].
    """
    # the second moments of a solid ellipsoid are a fifth of its squared radii
    squares, axes = np.linalg.eigh(spread)
    if np.linalg.det(axes) < 0.0:
        axes[:, 0] = -axes[:, 0]
    radii = np.sqrt(5.0 * squares)
    radii *= (volume / (4.0 / 3.0 * math.pi * radii.prod())) ** (1.0 / 3.0)
    return Ellipsoid(radii, axes, centre)


def measure_second_moments(
    vertices: NDArray[np.float64], faces: NDArray[np.int64], centre: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Integrals of x x, x y, ... over the volume of a mesh, about a point (3, 3) [m^5].

    A sum over tetrahedra with one corner at the point.
    """
    corners = vertices[faces] - centre
    volumes = np.linalg.det(corners) / 6.0
    sums = corners.sum(axis=1)
    moments: NDArray[np.float64] = (
        np.einsum("n,nij,nik->jk", volumes, corners, corners)
        + np.einsum("n,nj,nk->jk", volumes, sums, sums)
    ) / 20.0
    return moments


def ellipsoid_added_mass(radii: ArrayLike, density: float) -> NDArray[np.float64]:
    """Added mass (6,) [kg, kg m^2] of an ellipsoid of radii (3,) [m] along and about its axes.

    Lamb, Hydrodynamics (1932), art. 114, 115; the integrals by Carlson's R_D.
    """
    a = np.asarray(radii, float)
    mass = density * 4.0 / 3.0 * math.pi * a.prod()
    squares = a * a
    alpha = np.empty(3)
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        alpha[i] = 2.0 / 3.0 * a.prod() * scipy.special.elliprd(squares[j], squares[k], squares[i])

    # along the axes, then about them
    added = np.zeros(6)
    added[:3] = mass * alpha / (2.0 - alpha)
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        difference = squares[j] - squares[k]
        total = squares[j] + squares[k]
        # a circle that turns carries nothing round
        if abs(difference) <= 1e-9 * total:
            continue
        twist = alpha[k] - alpha[j]
        added[3 + i] = 0.2 * mass * difference**2 * twist / (2.0 * difference - total * twist)
    return added
