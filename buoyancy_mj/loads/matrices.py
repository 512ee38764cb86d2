"""Matrices (6, 6) of surge, sway, heave, roll, pitch, yaw: their checks, and a change of point."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import ModelError
from buoyancy_mj.values import read_array

NEGATIVE = -1e-9
"""Least eigenvalue, as a part of the largest entry, that is still rounding."""
ASYMMETRY = 1e-6
"""Difference of mirrored entries, as a part of their diagonal entries, that is still rounding."""


def parse_matrix(value: ArrayLike, what: str) -> NDArray[np.float64]:
    """A symmetric matrix (6, 6) from its 36 numbers, or from the 6 of its diagonal.

    Args:
        value: 6 or 36 numbers, flat or as a matrix.
        what: how messages call it, as "the added mass of body 'hull'".

    Raises:
        ModelError: another shape, an entry that is no real number or not finite, or a matrix that
            is not symmetric or has a negative eigenvalue.
    """
    numbers = read_array(ModelError, what, value, (6,), (36,), (6, 6))
    matrix = np.diag(numbers) if numbers.size == 6 else numbers.reshape(6, 6)
    scale = np.sqrt(np.abs(np.outer(np.diag(matrix), np.diag(matrix)))) + 1e-12
    if (np.abs(matrix - matrix.T) > ASYMMETRY * scale).any():
        raise ModelError(f"{what} is not symmetric; average it with its transpose")
    check_eigenvalues(matrix, what)
    return symmetric_part(matrix)


def check_eigenvalues(matrix: NDArray[np.float64], what: str) -> None:
    """Refuse a matrix (6, 6) whose symmetric part has a negative eigenvalue: it would give energy.

    Raises:
        ModelError: it has one; `what` names the matrix.
    """
    least = float(np.linalg.eigvalsh(symmetric_part(matrix))[0])
    if least < NEGATIVE * float(np.abs(matrix).max()):
        raise ModelError(
            f"{what} has a negative eigenvalue, {least:.4g}; the water would push it on: check the "
            "signs (Fossen's derivatives, such as X_udot and X_u, are minus these numbers)"
        )


def symmetric_part(matrix: NDArray[np.float64]) -> NDArray[np.float64]:
    """The mean of a matrix and its transpose."""
    return 0.5 * (matrix + matrix.T)


def move_to_origin(matrix: NDArray[np.float64], point: ArrayLike) -> NDArray[np.float64]:
    """A matrix (6, 6) about a point (3,) [m] of the body, as one about the body's origin.

    The velocity of the point is v + w x p, and its power the same about either point.
    """
    point_from_origin = np.eye(6)
    point_from_origin[:3, 3:] = np.cross(np.asarray(point, float), np.eye(3))
    moved: NDArray[np.float64] = point_from_origin.T @ matrix @ point_from_origin
    return moved
