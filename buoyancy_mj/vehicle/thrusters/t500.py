"""The T500 of Blue Robotics, from what its maker says of full throttle at 24 V."""

import math

import numpy as np
from numpy.typing import NDArray

ASTERN, AHEAD = 10.5 * 9.80665, 16.1 * 9.80665
"""Greatest bollard pull [N] at 24 V, as the maker's product page is quoted by others."""
VOLTAGE = 24.0
"""Supply [V]."""
DIAMETER = 0.114
"""Of its propeller [m]: an estimate."""
COEFFICIENT = 0.44
"""K_T ahead: that of the T200, whose kind it is."""
LEVERS = (0.021, 0.018)
"""Torque of the propeller over its thrust, astern and ahead [m]: that of the T200, by size."""
CURRENT = 43.5
"""At full throttle [A], as quoted in the same way."""


def t500_rows() -> NDArray[np.float64]:
    """Bollard pull as rows (m, 5): throttle, rev/s, thrust [N], torque [N m], current [A].

    The maker's table may not be passed on. So this is a quadratic curve: the rotor's speed goes
    with the throttle, the thrust with its square up to the maker's greatest, the current with its
    cube. The rotor's speed itself is an estimate.
    """
    most = math.sqrt(AHEAD / (COEFFICIENT * 1000.0 * DIAMETER**4))
    throttles = np.linspace(-1.0, 1.0, 41)
    squares = throttles * np.abs(throttles)
    back = throttles < 0.0
    thrusts = np.where(back, ASTERN, AHEAD) * squares
    torques = np.where(back, *LEVERS) * thrusts
    currents = CURRENT * np.abs(throttles) ** 3
    return np.column_stack([throttles, most * throttles, thrusts, torques, currents])
