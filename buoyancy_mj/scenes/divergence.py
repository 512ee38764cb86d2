"""Simulations that leave the finite numbers, or all reason."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import DivergenceError
from buoyancy_mj.hulls.bodies import find_moving_bodies
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.kernels.arrays import conform
from buoyancy_mj.kernels.watching import Bounds, count_calm, is_calm
from buoyancy_mj.scenes.floors import Floors
from buoyancy_mj.scenes.scene import Scene
from buoyancy_mj.scenes.trajectory import Poses, Trajectory

FASTEST = 1e3
"""Speed [m/s] beyond which nothing that floats, sinks or falls can move."""
FARTHEST = 1e5
"""Distance [m] from its start beyond which nothing has come by floating, sinking or falling."""
QUANTITIES = {
    mujoco.mjtWarning.mjWARN_BADQPOS: "position",
    mujoco.mjtWarning.mjWARN_BADQVEL: "velocity",
    mujoco.mjtWarning.mjWARN_BADQACC: "acceleration",
}
"""The quantity that is bad, by the warning that MuJoCo counts."""
BAD_VALUES = [int(warning) for warning in QUANTITIES]
"""The indices of these warnings in `data.warning`."""


class Limits:
    """What the bodies of a run may not go beyond, and still be believed.

    A body that moves faster than 1,000 m/s, is farther than 100 km from its start, or is below the
    bottom under which it started, has left all reason; so has a value that MuJoCo counts as bad.

    Args:
        scene: the scene, for messages.
        model: its model.
        data: the poses at the start, after mj_kinematics.
    """

    def __init__(self, scene: Scene, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self._scene = scene
        self._model = model
        self._bodies = np.flatnonzero(find_moving_bodies(model))
        self._start = data.xipos[self._bodies]
        self._floors = Floors(model, data, self._bodies)
        self._last: tuple[float, NDArray[np.float64]] | None = None
        self.bounds = conform(
            Bounds(
                bodies=self._bodies,
                start=self._start,
                lowest=self._floors.lowest,
                farthest=0.5 * FARTHEST,
                fastest=0.01 * FASTEST,
            )
        )
        """Within what most steps are, far from all limits, so that compiled code passes them."""

    def check_data(self, data: mujoco.MjData, time: float) -> None:
        """Check data after a step or mj_forward, whose poses are those at a time [s].

        Raises:
            DivergenceError: a limit is passed; the error names the body and the quantity.
        """
        check_finite(self._scene, self._model, data)
        if is_calm(self.bounds, data.xipos, data.cvel):
            return
        bodies = self._bodies
        centres = data.xipos[bodies]
        arms = centres - data.subtree_com[self._model.body_rootid[bodies]]
        velocities = data.cvel[bodies, 3:] + np.cross(data.cvel[bodies, :3], arms)
        self._check(centres, velocities, time)

    def check_trajectory(self, trajectory: Trajectory, timestep: float) -> None:
        """Check the poses of a run that was stepped elsewhere, one timestep [s] apart from 0 s.

        Raises:
            DivergenceError: a limit is passed; the error names the body and the quantity.
        """
        calm = count_calm(self.bounds, trajectory.xipos, timestep)
        for step in range(max(0, calm - 1), len(trajectory.qpos)):
            self.check_poses(trajectory.poses(step), step * timestep)

    def check_poses(self, poses: Poses, time: float) -> None:
        """Check the next poses of a run that was stepped elsewhere, at a time [s].

        Raises:
            DivergenceError: a limit is passed; the error names the body and the quantity.
        """
        centres = poses.xipos[self._bodies].copy()
        velocities = np.zeros_like(centres)
        if self._last is not None and time > self._last[0]:
            velocities = (centres - self._last[1]) / (time - self._last[0])
        self._last = time, centres
        self._check(centres, velocities, time)

    def _check(
        self, centres: NDArray[np.float64], velocities: NDArray[np.float64], time: float
    ) -> None:
        """Check places (n, 3) [m] and velocities (n, 3) [m/s] of the moving bodies."""
        speeds = np.linalg.norm(velocities, axis=1)
        distances = np.linalg.norm(centres - self._start, axis=1)
        i = int(np.argmax(speeds))
        if not speeds[i] <= FASTEST:
            self._refuse(i, time, f"moves at {speeds[i]:.3g} m/s (more than {FASTEST:,.0f})")
        i = int(np.argmax(distances))
        if not distances[i] <= FARTHEST:
            self._refuse(
                i, time, f"is {distances[i]:.3g} m from its start (more than {FARTHEST:,.0f})"
            )
        fallen = self._floors.find_fallen(centres)
        if fallen is not None:
            mend = ""
            if not _can_touch(self._model, int(self._bodies[fallen])):
                mend = "none of its geoms can touch it, so give one contype and conaffinity of 1"
            place = f"{centres[fallen, 2]:.4g} m"
            self._refuse(fallen, time, f"has gone through the bottom, to z = {place}", mend)

    def _refuse(self, i: int, time: float, what: str, mend: str = "") -> None:
        """Raise the error that the i-th moving body has left all reason."""
        name = body_name(self._model, int(self._bodies[i]))
        raise DivergenceError(
            f"the simulation diverged at {time:.4g} s: body '{name}' {what}; "
            f"{mend or _mend(self._scene)}"
        )


def check_finite(scene: Scene, model: mujoco.MjModel, data: mujoco.MjData) -> None:
    """Check that MuJoCo has met no bad value so far.

    Raises:
        DivergenceError: it has; the error names the body and the quantity.
    """
    if not data.warning.number[BAD_VALUES].any():
        return
    for warning, quantity in QUANTITIES.items():
        counter = data.warning[warning]
        if counter.number:
            body = _body_of(model, warning, counter.lastinfo)
            subject = f"the {quantity} of body '{body_name(model, body)}'"
            raise DivergenceError(describe_divergence(scene, float(data.time), subject))


def describe_divergence(
    scene: Scene, time: float, subject: str = "a position, velocity or acceleration"
) -> str:
    """The sentence that tells of a run that diverged at a time [s]."""
    return (
        f"the simulation diverged at {time:.4g} s: {subject} is not a finite, sensible number; "
        f"{_mend(scene)}"
    )


def _can_touch(model: mujoco.MjModel, body: int) -> bool:
    """Whether any geom that moves with a body takes part in contacts."""
    own = model.body_treeid[model.geom_bodyid] == model.body_treeid[body]
    return bool((model.geom_contype[own] | model.geom_conaffinity[own]).any())


def _mend(scene: Scene) -> str:
    """What to try."""
    return (
        f"try a smaller timestep (now {scene.timestep:g} s) or another integrator "
        f"(now {scene.integrator})"
    )


def _body_of(model: mujoco.MjModel, warning: mujoco.mjtWarning, index: int) -> int:
    """The body whose coordinate, or degree of freedom, has the index that a warning holds."""
    if warning != mujoco.mjtWarning.mjWARN_BADQPOS:
        return int(model.dof_bodyid[index])
    joint = int(np.searchsorted(model.jnt_qposadr, index, side="right")) - 1
    return int(model.jnt_bodyid[joint])
