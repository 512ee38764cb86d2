"""A clear line of sight: walls, floors and other things that stay are not between."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.hulls.bodies import find_moving_bodies

MOST_HITS = 64
"""Most surfaces of moving bodies that a line of sight passes."""
AWAY = 0.9
"""How near a camera goes to what is in its way, over the distance of that."""


def clear_sight(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    target: NDArray[np.float64],
    eye: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Where a camera sees a target, on the line from it to the eye (3,) [m].

    Args:
        model: the model.
        data: its data, with poses.
        target: what it looks at (3,) [m].
        eye: where it would stand (3,) [m].
    """
    ray = eye - target
    reach = float(np.linalg.norm(ray))
    ray = ray / reach
    moves, geom = find_moving_bodies(model), np.zeros(1, np.int32)
    passed = 0.0
    for _ in range(MOST_HITS):
        distance = mujoco.mj_ray(model, data, target + passed * ray, ray, None, 1, -1, geom, None)
        if distance < 0.0 or passed + distance >= reach:
            return eye
        passed += distance
        if not moves[model.geom_bodyid[geom[0]]]:
            return np.asarray(target + AWAY * passed * ray)
        passed += 1e-6 * reach
    return eye
