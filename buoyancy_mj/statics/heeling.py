"""`Heeling`: a vessel brought to one heel after another, its trim free or fixed."""

import math
from collections.abc import Callable

import numpy as np
import scipy
from numpy.typing import NDArray

from buoyancy_mj.errors import EquilibriumError
from buoyancy_mj.statics.attitude import Attitude
from buoyancy_mj.statics.balance import find_heave_balance
from buoyancy_mj.statics.descent import find_balance
from buoyancy_mj.statics.floating_pose import FloatingPose
from buoyancy_mj.statics.vessel import Vessel


class Heeling:
    """A vessel that heels about a horizontal axis, at the draft that carries its weight."""

    def __init__(
        self, vessel: Vessel, upright: NDArray[np.float64], axis: float, *, trim_free: bool
    ) -> None:
        """Choose the axis.

        Args:
            vessel: the vessel.
            upright: its attitude before it heels, world_from_vessel (3, 3).
            axis: direction of the axis of heel, from the heading of `upright` to port [rad].
            trim_free: whether it trims until no torque is left about the axis across.
        """
        from scipy.spatial.transform import Rotation

        self.vessel = vessel
        self.trim_free = trim_free
        direction = Attitude.from_matrix(upright).heading + axis
        # axes along the axis of heel, across it, and up
        self._world_from_axes = Rotation.from_rotvec([0.0, 0.0, direction]).as_matrix()
        self._upright = self._world_from_axes.T @ upright
        self._across = self._world_from_axes[:2, 1:2].copy()

    def heel(self, angle: float, last: FloatingPose | None) -> FloatingPose:
        """Bring the vessel to a heel.

        Args:
            angle: heel [rad].
            last: the pose at a heel nearby, whose trim begins the search; upright if None.

        Raises:
            EquilibriumError: the vessel sinks, finds no balance, or balances end over end only.
        """
        from scipy.spatial.transform import Rotation

        lean = 0.0 if last is None else self.measure_trim(last)
        height = None if last is None else float(last.position[2])
        turn = Rotation.from_euler("YX", [lean, angle]).as_matrix()
        rotation = self._world_from_axes @ turn @ self._upright
        if not self.trim_free:
            return find_heave_balance(self.vessel, rotation, height)

        # the nearest balance; where there is none, the vessel goes downhill to another
        try:
            pose, _ = find_balance(self.vessel, rotation, height, axes=self._across, stable=False)
        except EquilibriumError:
            pose, _ = find_balance(self.vessel, rotation, height, axes=self._across)

        # end over end the cosine of the trim is negative
        if self._turn_from_upright(pose)[2, 1:] @ [math.sin(angle), math.cos(angle)] < 0.0:
            raise EquilibriumError(
                f"at a heel of {math.degrees(angle):.4g} degrees it balances only end over end; "
                "use trim='fixed' or less heel"
            )
        return pose

    def find_root(
        self, value: Callable[[FloatingPose], float], last: FloatingPose, low: float, high: float
    ) -> float:
        """Find the heel [rad] at which a value changes sign.

        Args:
            value: function of the pose.
            last: the pose at `low`.
            low: a heel with one sign [rad].
            high: a heel with the other [rad], which is the answer if rounding hides the change.
        """

        def at(angle: float) -> float:
            return value(self.heel(angle, last))

        if at(low) * at(high) >= 0.0:
            return float(high)
        return float(scipy.optimize.brentq(at, low, high, xtol=1e-10))

    def measure_arm(self, pose: FloatingPose) -> float:
        """Righting arm [m] of a pose."""
        return -float(self._world_from_axes[:2, 1] @ pose.lever[:2])

    def measure_trim(self, pose: FloatingPose) -> float:
        """Trim [rad] of a pose, bow down, from that of the upright vessel."""
        return Attitude.from_matrix(self._turn_from_upright(pose)).trim

    def _turn_from_upright(self, pose: FloatingPose) -> NDArray[np.float64]:
        """Rotation (3, 3) from upright to a pose, in axes along and across the axis of heel."""
        turn = self._world_from_axes.T @ pose.rotation @ self._upright.T
        return np.asarray(turn, float)
