"""Tables whose rows rise in one column: straight between rows, held beyond the ends."""

from buoyancy_mj.kernels.compiling import njit


@njit(cache=True, error_model="numpy", _nrt=False)
def interpolate(table, into, out, value):
    """Column `out` of a table (n, m) where column `into`, which never falls, has a value."""
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
