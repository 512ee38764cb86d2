"""`righting_arm`: the GZ curve of a vessel, from upright to upside down."""

import dataclasses
import fnmatch
import math
import warnings
from collections.abc import Callable, Sequence
from typing import Literal

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import trapezoid
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

from buoyancy_mj.errors import BuoyancyWarning, EquilibriumError, ModelError, choices
from buoyancy_mj.hulls.selection import Selection
from buoyancy_mj.sea.water import Water
from buoyancy_mj.statics.attitude import Attitude
from buoyancy_mj.statics.balance import find_balance, find_heave_balance
from buoyancy_mj.statics.building import build_vessel
from buoyancy_mj.statics.floating_pose import FloatingPose
from buoyancy_mj.statics.vessel import Vessel

POINTS = ("deck_edge*", "downflooding*")
"""Sites that are looked for without being asked."""
TRIMS = ("free", "fixed")
"""What trim may do while the vessel heels."""


@dataclasses.dataclass(frozen=True, eq=False)
class RightingArm:
    """The righting arm GZ over heel: weight times GZ is the torque that brings the vessel back."""

    heel: NDArray[np.float64]
    """Angles (n,) [rad], ascending: turns about the axis, from the attitude of the start; as far as it balances."""
    gz: NDArray[np.float64]
    """Righting arms (n,) [m]: positive where they work against a positive heel."""
    trim: NDArray[np.float64]
    """Turns about the horizontal axis across (n,) [rad], bow down, from that of the start."""
    draft: NDArray[np.float64]
    """Depths of the lowest point (n,) [m]."""
    vanishing: float
    """The first heel past the largest arm at which it vanishes [rad], NaN if none does: angle of vanishing stability."""
    immersed: dict[str, float]
    """Least heel from 0 on at which each site goes under [rad], NaN if it never does."""

    @property
    def maximum(self) -> tuple[float, float]:
        """The largest arm among positive heels: heel [rad] and arm [m]."""
        ahead = np.flatnonzero(self.heel >= 0.0)
        best = int(ahead[self.gz[ahead].argmax()])
        return float(self.heel[best]), float(self.gz[best])

    def area(self, low: float = 0.0, high: float | None = None) -> float:
        """Area under the curve [m rad] between two heels: the work per weight that heels it so far.

        Args:
            low: from this heel [rad].
            high: to this one; None for the angle of vanishing stability, or where there is none the end.

        Raises:
            ModelError: heels outside of the curve.
        """
        end = (
            high
            if high is not None
            else self.vanishing
            if math.isfinite(self.vanishing)
            else float(self.heel[-1])
        )
        if not self.heel[0] <= low <= end <= self.heel[-1]:
            raise ModelError(
                f"area from {low:g} to {end:g} rad; the curve goes from {self.heel[0]:g} to {self.heel[-1]:g} rad"
            )
        inside = self.heel[(self.heel > low) & (self.heel < end)]
        heels = np.array([low, *inside, end])
        return float(trapezoid(np.interp(heels, self.heel, self.gz), heels))


def righting_arm(
    model: mujoco.MjModel,
    water: Water | None = None,
    heel: ArrayLike | None = None,
    axis: float = 0.0,
    trim: Literal["free", "fixed"] = "free",
    start: ArrayLike | None = None,
    *,
    points: Sequence[str] | str = POINTS,
    body: str | None = None,
    selection: Selection = Selection(),
) -> RightingArm:
    """The GZ curve of a vessel at the draft that carries its weight, its joints held.

    Heel and trim are roll and pitch as in `Start`: turned about the horizontal axis across by the
    trim, after the heel. With trim free no torque is left about that axis; of several balances it is
    the one nearest to that at the heel before. Where that ends, the next one downhill follows, unless
    it is end over end: then the curve ends, with a `BuoyancyWarning`.

    Args:
        model: any MuJoCo model with a body that floats.
        water: fresh and still at z = 0 if None; waves are left aside.
        heel: angles (n,) [rad]; None for 0 to 180 degrees, one by one.
        axis: direction of the axis it heels about, from the heading of the start to port [rad]; 0 for the
            longitudinal axis, pi / 2 for a curve in trim.
        trim: 'free', or 'fixed' to that of the start.
        start: upright: coordinates of the model (nq,), or of its free joint alone (7,); the model's own if None.
        points: globs of the sites to watch, as deck edges and downflooding points.
        body: name of the root body, where several float; None for the first that has hulls.
        selection: which geoms displace water, and as what.

    Raises:
        EquilibriumError: it sinks, or does not balance at all.
        ModelError: heels that are not finite, another trim, points that match no site, see also `statics.build_vessel`.
        MeshError: a mesh that bounds no volume.
    """
    heels = np.radians(np.arange(181.0)) if heel is None else np.unique(np.asarray(heel, float))
    if not heels.size or not np.isfinite(heels).all() or not math.isfinite(axis):
        raise ModelError("heel and axis must be finite angles [rad], at least one of heel")
    if trim not in TRIMS:
        raise ModelError(f"trim is '{trim}'; {choices(trim, TRIMS)}")
    vessel = build_vessel(model, water, start, body=body, selection=selection)
    return compute_righting_arm(vessel, heels, axis=axis, free=trim == "free", points=points)


def compute_righting_arm(
    vessel: Vessel,
    heels: NDArray[np.float64],
    *,
    upright: NDArray[np.float64] | None = None,
    axis: float = 0.0,
    free: bool = True,
    points: Sequence[str] | str = POINTS,
) -> RightingArm:
    """The GZ curve of a vessel from where it is, or from `upright`, world_from_vessel (3, 3); see `righting_arm`."""
    heeled = _Heeled(vessel, vessel.rotation if upright is None else upright, axis, free)
    # outwards from the least, so that each trim is found from the one before
    poses: dict[float, FloatingPose] = {}
    for side in (heels[heels >= 0.0], heels[heels < 0.0][::-1]):
        last = None
        for angle in side.tolist():
            try:
                last = heeled(angle, last)
            except EquilibriumError as error:
                if last is None:
                    raise
                warnings.warn(
                    f"the righting arm ends there: {error}", BuoyancyWarning, stacklevel=3
                )
                break
            poses[angle] = last
    heels = np.array(sorted(poses))
    ordered = [poses[angle] for angle in heels.tolist()]
    gz = np.array([heeled.arm(pose) for pose in ordered])
    ahead = [i for i in range(len(heels)) if heels[i] >= 0.0]
    return RightingArm(
        heel=heels,
        gz=gz,
        trim=np.array([heeled.trim(pose) for pose in ordered]),
        draft=np.array(
            [
                vessel.water.level - pose.position[2] - (vessel.points @ pose.rotation[2]).min()
                for pose in ordered
            ]
        ),
        vanishing=_vanishing(heeled, heels, gz, ordered, ahead),
        immersed={
            name: _immersed(heeled, vessel.sites[name], heels, ordered, ahead)
            for name in _names(vessel, points)
        },
    )


class _Heeled:
    """A vessel brought to a heel, in axes whose x is the axis of heel."""

    def __init__(
        self, vessel: Vessel, upright: NDArray[np.float64], axis: float, free: bool
    ) -> None:
        self.vessel, self.free = vessel, free
        heading = Attitude.from_matrix(upright).heading + axis
        self.back = Rotation.from_rotvec([0.0, 0.0, heading]).as_matrix()
        self.upright = self.back.T @ upright
        self.across = self.back[:2, 1:2].copy()

    def __call__(self, heel: float, last: FloatingPose | None) -> FloatingPose:
        """The vessel at a heel, its trim found from the last."""
        lean = 0.0 if last is None else self.trim(last)
        turn = self.back @ Rotation.from_euler("YX", [lean, heel]).as_matrix() @ self.upright
        height = None if last is None else float(last.position[2])
        if not self.free:
            return find_heave_balance(self.vessel, turn, height)
        try:
            afloat, _ = find_balance(self.vessel, turn, height, free=self.across, stable=False)
        except EquilibriumError:
            # where the balance ends, the vessel goes downhill to another
            afloat, _ = find_balance(self.vessel, turn, height, free=self.across)
        # the cosine of the trim
        if self._turn(afloat)[2, 1:] @ [math.sin(heel), math.cos(heel)] < 0.0:
            raise EquilibriumError(
                f"at a heel of {math.degrees(heel):.4g} degrees it balances only end over end; use trim='fixed' or less heel"
            )
        return afloat

    def arm(self, afloat: FloatingPose) -> float:
        """The righting arm."""
        return -float(self.back[:2, 1] @ afloat.arm[:2])

    def trim(self, afloat: FloatingPose) -> float:
        """Bow down, from that of the start [rad]."""
        return -math.asin(max(-1.0, min(1.0, float(self._turn(afloat)[2, 0]))))

    def _turn(self, afloat: FloatingPose) -> NDArray[np.float64]:
        """From upright to here, in axes along and across (3, 3)."""
        return self.back.T @ afloat.rotation @ self.upright.T


def _vanishing(
    heeled: _Heeled,
    heels: NDArray[np.float64],
    gz: NDArray[np.float64],
    poses: Sequence[FloatingPose],
    ahead: Sequence[int],
) -> float:
    """The first zero of the arm past its largest."""
    if not ahead or gz[ahead].max() <= 0.0:
        return math.nan
    best = ahead[int(gz[ahead].argmax())]
    # upside down a symmetric vessel has none but for rounding
    least = 1e-9 * heeled.vessel.radius
    for i in range(best, len(heels) - 1):
        if gz[i] > least >= gz[i + 1]:
            return _root(heeled, heeled.arm, poses[i], heels[i], heels[i + 1])
    return math.nan


def _immersed(
    heeled: _Heeled,
    site: NDArray[np.float64],
    heels: NDArray[np.float64],
    poses: Sequence[FloatingPose],
    ahead: Sequence[int],
) -> float:
    """The least positive heel at which a site goes under."""

    def height(pose: FloatingPose) -> float:
        return float(pose.position[2] + pose.rotation[2] @ site) - heeled.vessel.water.level

    for i in ahead:
        if height(poses[i]) <= 0.0:
            if i == ahead[0]:
                return float(heels[i])
            return _root(heeled, height, poses[i - 1], heels[i - 1], heels[i])
    return math.nan


def _root(
    heeled: _Heeled,
    value: Callable[[FloatingPose], float],
    last: FloatingPose,
    low: float,
    high: float,
) -> float:
    """The heel at which a value changes sign; the far end if rounding hides it."""

    def at(angle: float) -> float:
        return value(heeled(angle, last))

    if at(low) * at(high) >= 0.0:
        return float(high)
    return float(brentq(at, low, high, xtol=1e-10))


def _names(vessel: Vessel, points: Sequence[str] | str) -> list[str]:
    """Sites that match; those looked for without being asked need not exist."""
    patterns = [points] if isinstance(points, str) else list(points)
    names: dict[str, None] = {}
    for pattern in patterns:
        found = [name for name in vessel.sites if fnmatch.fnmatchcase(name, pattern)]
        if not found and pattern not in POINTS:
            raise ModelError(
                f"no site of the vessel matches '{pattern}'; {choices(pattern, vessel.sites)}"
            )
        names |= dict.fromkeys(found)
    return list(names)
