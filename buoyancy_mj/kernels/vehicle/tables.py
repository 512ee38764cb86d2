"""Tables whose rows rise in one column: straight between rows, held beyond the ends."""

from numba import int64

from buoyancy_mj.kernels.compiling import njit


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def interpolate(table, into, out, value):
    """Column `out` of a table (n, m) where column `into`, which never falls, has a value."""
    # as plain numbers: Numba would compile once for each pair of constants
    return _interpolate(table, int64(into), int64(out), value)


@njit(cache=True, error_model="numpy", _nrt=False)
def _interpolate(table, into, out, value):
    """The same for columns that are no constants."""
    low, high = 0, table.shape[0] - 1
    if value <= table[low, into]:
        return table[low, out]
    if value >= table[high, into]:
        return table[high, out]
    while high - low > 1:
        middle = (low + high) // 2
        if table[middle, into] <= value:
            low = middle
        else:
            high = middle
    width = table[high, into] - table[low, into]
    return table[low, out] + (value - table[low, into]) / width * (
        table[high, out] - table[low, out]
    )
