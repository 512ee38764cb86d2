"""The linear regulator of least cost, for a motion in steps x' = A x + B u."""

from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from buoyancy_mj.errors import ControlError

SLOWEST = 1.0 - 1e-6
"""Greatest size of a pole of the closed loop; one nearer to 1 was not meant to be."""
_UNSTABLE = 1.0 - 1e-9
"""Size of an eigenvalue from which on a motion does not come to rest by itself."""
_LOST = 1e-10
"""Singular value below which a matrix has lost its rank."""
_WITHOUT_END = (
    "no feedback was found: a weight of 0 lets a motion be that does not come to rest by itself; "
    "give it a weight, or put it into free"
)

Matrix = NDArray[np.float64]


class Regulator(NamedTuple):
    """Linear feedback u = -K x."""

    gain: Matrix
    """K (m, n)."""
    poles: NDArray[np.complex128]
    """Eigenvalues of A - B K (n,)."""


def add_lags(a: Matrix, b: Matrix, kept: Matrix) -> tuple[Matrix, Matrix]:
    """The motion with the states of inputs that lag behind what they are told.

    Args:
        a: A (n, n).
        b: B (n, m).
        kept: part of the gap that is left of each input after a step (m,); 0 for one without lag.

    Returns:
        A and B of the state with the j inputs that lag behind it (n + j).
    """
    lagging = np.flatnonzero(kept)
    own = np.eye(b.shape[1])[lagging]
    return (
        np.block([[a, b[:, lagging]], [np.zeros((len(lagging), len(a))), np.diag(kept[lagging])]]),
        np.vstack([np.where(kept > 0.0, 0.0, b), (1.0 - kept[lagging])[:, None] * own]),
    )


def hold_inputs(a: Matrix, b: Matrix, steps: int) -> tuple[Matrix, Matrix]:
    """A and B of so many steps in which the input stays."""
    several, pushed = np.eye(len(a)), np.zeros_like(b)
    for _ in range(steps):
        several, pushed = a @ several, a @ pushed + b
    return several, pushed


def find_unreached(a: Matrix, b: Matrix) -> int | None:
    """The state that has most part in a motion that does not come to rest and no input reaches.

    M. L. J. Hautus, Controllability and observability conditions of linear autonomous systems
    (1969): A - z 1 and B beside each other have full rank for each eigenvalue z.

    Returns:
        Its index; None if inputs reach all such motions.
    """
    for value in np.linalg.eigvals(a):
        if abs(value) < _UNSTABLE:
            continue
        lefts, sizes, _ = np.linalg.svd(np.hstack([a - value * np.eye(len(a)), b]))
        if sizes[-1] < _LOST:
            return int(np.argmax(np.abs(lefts[:, -1])))
    return None


def solve_regulator(a: Matrix, b: Matrix, weights: Matrix, input_weights: Matrix) -> Regulator:
    """The feedback that makes the sum of x' Q x + u' R u least.

    Args:
        a: A (n, n).
        b: B (n, m).
        weights: diagonal of Q (n,).
        input_weights: diagonal of R (m,).

    Raises:
        ControlError: there is none, since the cost does not see a motion without end.
    """
    r = np.diag(input_weights)
    try:
        cost = scipy.linalg.solve_discrete_are(a, b, np.diag(weights), r)
    except (np.linalg.LinAlgError, ValueError) as error:
        raise ControlError(_WITHOUT_END) from error
    gain = np.linalg.solve(r + b.T @ cost @ b, b.T @ cost @ a)
    poles = np.linalg.eigvals(a - b @ gain)
    if np.abs(poles).max() > SLOWEST:
        raise ControlError(_WITHOUT_END)
    return Regulator(gain, poles.astype(complex))
