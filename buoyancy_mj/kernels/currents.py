"""A current as rows of (depth or time, velocity (3), 0 or 1 for which): straight between rows, held beyond them."""

from numba import njit


@njit(cache=True, error_model="numpy")
def set_current(rows, depth, time, out):
    """Velocity [m/s] of the current at a depth [m] under the still level and a time [s], written to `out` (3,)."""
    at, share = _between(rows, time if rows[0, 4] != 0.0 else depth)
    for c in range(3):
        out[c] = rows[at, 1 + c]
        if share > 0.0:
            out[c] += share * (rows[at + 1, 1 + c] - rows[at, 1 + c])


@njit(cache=True, error_model="numpy")
def set_rate(rows, time, out):
    """How fast it grows with time [m/s^2], written to `out` (3,)."""
    out[:] = 0.0
    if rows[0, 4] == 0.0 or not rows[0, 0] <= time < rows[rows.shape[0] - 1, 0]:
        return
    at, _ = _between(rows, time)
    for c in range(3):
        out[c] = (rows[at + 1, 1 + c] - rows[at, 1 + c]) / (rows[at + 1, 0] - rows[at, 0])


@njit(cache=True, error_model="numpy")
def _between(rows, place):
    """The row before a place, and how far the place is to the next; 0 beyond the ends."""
    low, high = 0, rows.shape[0] - 1
    if high == 0 or not place > rows[0, 0]:
        return 0, 0.0
    if place >= rows[high, 0]:
        return high, 0.0
    while high - low > 1:
        middle = (low + high) // 2
        if rows[middle, 0] <= place:
            low = middle
        else:
            high = middle
    return low, (place - rows[low, 0]) / (rows[high, 0] - rows[low, 0])
