"""The first harmonic of signals, by least squares over whole periods."""

import numpy as np
from numpy.typing import NDArray

TREND = 3
"""Terms of the polynomial in time that takes up what drifts."""


def fit_harmonics(
    values: NDArray[np.float64], theta: NDArray[np.float64]
) -> tuple[NDArray[np.complex128], NDArray[np.float64]]:
    """Fit a slow change and the first two harmonics of a wave to signals.

    x = c0 + c1 t + c2 t^2 + Re(X e^(i theta)) + Re(X2 e^(2 i theta)), by least squares under the
    weights of a Hann window, which let next to nothing of other frequencies into X (Harris 1978).
    The second harmonic, and the polynomial, keep what is not linear in the wave out of it.

    Args:
        values: signals (n, c).
        theta: phase of the wave at each sample (n,) [rad]: its elevation is A cos(theta).

    Returns:
        X of each signal (c,), and the slow part of each (n, c).
    """
    time = np.linspace(-1.0, 1.0, len(theta))
    design = np.column_stack(
        [
            *(time**power for power in range(TREND)),
            *(wave(order * theta) for order in (1, 2) for wave in (np.cos, np.sin)),
        ]
    )
    weights = np.cos(0.5 * np.pi * time)[:, None]
    found, *_ = np.linalg.lstsq(weights * design, weights * values, rcond=None)
    slow = design[:, :TREND] @ found[:TREND]
    return found[TREND] - 1j * found[TREND + 1], slow
