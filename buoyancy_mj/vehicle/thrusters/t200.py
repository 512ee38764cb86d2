"""The T200 of Blue Robotics: its maker's table of bollard pull, at any supply from 10 to 20 V."""

import csv
import functools
import importlib.resources

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import ModelError
from buoyancy_mj.values import read_number

DIAMETER = 0.0762
"""Of its propeller [m]: 3 inches."""
VOLTAGE = 16.0
"""Supply that is taken without being stated [V]."""
LEVERS = (0.014, 0.012)
"""Torque of the propeller over its thrust, astern and ahead [m]. The maker gives no torque: this is
0.7 of the electric power at 100 to 200 W over the thrust and the rotor's speed, where 0.7 is an
estimate of the efficiency of motor and controller."""
KGF = 9.80665
"""[N]."""


def t200_rows(voltage: float) -> NDArray[np.float64]:
    """Bollard pull at a supply [V] as rows (m, 5): throttle, rev/s, thrust [N], torque [N m], A.

    Between the supplies of the table all of them go straight, at one throttle.

    Raises:
        ModelError: a supply that the table does not have.
    """
    supply = read_number(ModelError, "voltage", voltage, least=10.0, most=20.0)
    tables = _read_tables()
    supplies = sorted(tables)
    at = min(int(np.searchsorted(supplies, supply, side="right")), len(supplies) - 1)
    low, high = supplies[at - 1], supplies[at]
    throttles = np.union1d(tables[low][:, 0], tables[high][:, 0])
    share = (supply - low) / (high - low)
    columns = [
        (1.0 - share) * _column(tables[low], c, throttles)
        + share * _column(tables[high], c, throttles)
        for c in (1, 2, 3)
    ]
    speeds, thrusts, currents = columns
    torques = np.where(thrusts < 0.0, LEVERS[0], LEVERS[1]) * thrusts
    return np.column_stack([throttles, speeds, thrusts, torques, currents])


def _column(
    table: NDArray[np.float64], column: int, throttles: NDArray[np.float64]
) -> NDArray[np.float64]:
    """A column of the table of a supply at throttles."""
    return np.interp(throttles, table[:, 0], table[:, column])


@functools.cache
def _read_tables() -> dict[float, NDArray[np.float64]]:
    """Rows (m, 4) by supply [V]: throttle, rev/s, thrust [N], current [A]."""
    text = importlib.resources.files(__package__).joinpath("data", "t200.csv").read_text("utf-8")
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    rows = np.array([[float(word) for word in line] for line in csv.reader(lines)])
    table = np.column_stack(
        [(rows[:, 1] - 1500.0) / 400.0, rows[:, 2] / 60.0, rows[:, 3] * KGF, rows[:, 4]]
    )
    return {float(supply): table[rows[:, 0] == supply] for supply in np.unique(rows[:, 0])}
