"""Waves as rows of numbers, as the kernels take them, see `kernels.waves`."""

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import WaterError, describe
from buoyancy_mj.kernels.waves import AMPLITUDE, PHASE
from buoyancy_mj.sea.waves import Wave
from buoyancy_mj.values import ANY, read_array


def rows_of(wave: Wave) -> NDArray[np.float64]:
    """The rows (n, 6) of a wave, which may be of a class of somebody's own."""
    rows = wave.rows
    name = f"rows of {describe(wave)}"
    array = read_array(WaterError, name, rows, (ANY, 6), finite=False)
    # the depth may be infinite
    read_array(WaterError, name, array[:, :5], (ANY, 5))
    if not (array[:, 5] > 0.0).all():
        raise WaterError(f"{name} hold a depth of {array[:, 5].min():g}; it must be above 0")
    return array


def join_equal(rows: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rows (n, 7) of which those that differ in amplitude and phase alone are joined."""
    others = np.delete(rows, [AMPLITUDE, PHASE], axis=1)
    _, first, which = np.unique(others, axis=0, return_index=True, return_inverse=True)
    if len(first) == len(rows):
        return rows

    # A e^(i phase) adds up; in the order in which each first came
    sums = np.zeros(len(first), complex)
    turned = rows[:, AMPLITUDE] * np.exp(1j * rows[:, PHASE])
    np.add.at(sums, which.ravel(), turned)
    joined = rows[first]
    joined[:, AMPLITUDE], joined[:, PHASE] = np.abs(sums), np.angle(sums)
    order = np.argsort(first)
    in_order: NDArray[np.float64] = np.ascontiguousarray(joined[order])
    return in_order
