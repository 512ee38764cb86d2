"""A current as rows of numbers at depths or at times: straight between rows, held beyond them."""

from buoyancy_mj.kernels.compiling import inner

PLACE, VELOCITY, TIMED = 0, 1, 4
"""Columns of a row: a depth [m] or a time [s]; the velocity (3) there [m/s]; and 0 for depths, 1
for times."""


@inner
def set_current(rows, depth, time, out):
    """Write the velocity [m/s] of the current at a depth [m] and a time [s] to `out` (3,).

    The depth is that under the still level.
    """
    at, share = _between(rows, time if rows[0, TIMED] != 0.0 else depth)
    for c in range(3):
        out[c] = rows[at, VELOCITY + c]
        if share > 0.0:
            out[c] += share * (rows[at + 1, VELOCITY + c] - rows[at, VELOCITY + c])


@inner
def set_rate(rows, time, out):
    """Write how fast the current grows with time [m/s^2] to `out` (3,)."""
    out[:] = 0.0
    if rows[0, TIMED] == 0.0 or not rows[0, PLACE] <= time < rows[rows.shape[0] - 1, PLACE]:
        return
    at, _ = _between(rows, time)
    for c in range(3):
        out[c] = (rows[at + 1, VELOCITY + c] - rows[at, VELOCITY + c]) / (
            rows[at + 1, PLACE] - rows[at, PLACE]
        )


@inner
def _between(rows, place):
    """The row before a place, and how far the place is to the next; 0 beyond the ends."""
    low, high = 0, rows.shape[0] - 1
    if high == 0 or not place > rows[0, PLACE]:
        return 0, 0.0
    if place >= rows[high, PLACE]:
        return high, 0.0
    while high - low > 1:
        middle = (low + high) // 2
        if rows[middle, PLACE] <= place:
            low = middle
        else:
            high = middle
    return low, (place - rows[low, PLACE]) / (rows[high, PLACE] - rows[low, PLACE])
