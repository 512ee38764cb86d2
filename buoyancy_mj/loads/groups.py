"""Indices of several groups in one array, as kernels read them."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.hulls.hull import Hull


def join(groups: Sequence[NDArray[np.int64]]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Groups of indices one after the other, and where each begins, and the end of all."""
    starts = np.cumsum([0, *(len(group) for group in groups)])
    return np.concatenate([np.zeros(0, np.int64), *groups]).astype(np.int64), starts


def join_hulls(
    hulls: Sequence[Hull], bodies: Sequence[int]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The indices of the hulls of each body, as `join` gives them."""
    of_body: dict[int, list[int]] = {body: [] for body in bodies}
    for index, hull in enumerate(hulls):
        if hull.body in of_body:
            of_body[hull.body].append(index)
    return join([np.array(indices, np.int64) for indices in of_body.values()])
