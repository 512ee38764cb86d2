"""`righting_arm`: the GZ curve of a vessel, from upright to upside down."""

import dataclasses
import math
import warnings
from collections.abc import Mapping, Sequence
from typing import Literal

import mujoco
import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import BuoyancyWarning, EquilibriumError, ModelError, choices, describe
from buoyancy_mj.hulls.selection import Selection
from buoyancy_mj.sea.water import Water
from buoyancy_mj.statics.building import build_vessel
from buoyancy_mj.statics.floating_pose import FloatingPose
from buoyancy_mj.statics.heeling import Heeling
from buoyancy_mj.statics.vessel import Vessel

POINTS = ("deck_edge*", "downflooding*")
"""Globs of the sites to watch by default, which need not exist."""
TRIMS = ("free", "fixed")
"""What trim may do while the vessel heels."""


@dataclasses.dataclass(frozen=True, eq=False)
class RightingArm:
    """The righting arm GZ over heel: weight times GZ is the torque that brings the vessel back."""

    heel: NDArray[np.float64]
    """Turns about the axis from the attitude at the start (n,) [rad], ascending.

    They end where the vessel balances no more."""
    gz: NDArray[np.float64]
    """Righting arms (n,) [m], positive where they work against a positive heel."""
    trim: NDArray[np.float64]
    """Turns about the horizontal axis across (n,) [rad], bow down, from the trim at the start."""
    draft: NDArray[np.float64]
    """Depths of the lowest point of the hulls (n,) [m]."""
    vanishing: float
    """Angle of vanishing stability [rad]: the first zero past the largest arm; NaN without one."""
    immersed: dict[str, float]
    """Least heel from 0 on at which each site goes under [rad]; NaN if it never does."""

    @property
    def maximum(self) -> tuple[float, float]:
        """Heel [rad] and arm [m] where the arm is largest among positive heels."""
        ahead = np.flatnonzero(self.heel >= 0.0)
        best = int(ahead[self.gz[ahead].argmax()])
        return float(self.heel[best]), float(self.gz[best])

    def area(self, low: float = 0.0, high: float | None = None) -> float:
        """Compute the area under the curve [m rad]: the work per weight that heels the vessel.

        Args:
            low: heel at the start [rad].
            high: heel at the end [rad]; None for the angle of vanishing stability, or without one
                for the end of the curve.

        Raises:
            ModelError: a heel lies outside of the curve.
        """
        if high is not None:
            end = high
        elif math.isfinite(self.vanishing):
            end = self.vanishing
        else:
            end = float(self.heel[-1])
        if not self.heel[0] <= low <= end <= self.heel[-1]:
            raise ModelError(
                f"area from {low:g} to {end:g} rad; "
                f"the curve goes from {self.heel[0]:g} to {self.heel[-1]:g} rad"
            )
        inside = self.heel[(self.heel > low) & (self.heel < end)]
        heels = np.array([low, *inside, end])
        return float(scipy.integrate.trapezoid(np.interp(heels, self.heel, self.gz), heels))


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
    ballast: Mapping[str, float] | ArrayLike | None = None,
) -> RightingArm:
    """Compute the GZ curve of a vessel at the draft that carries its weight, its joints held.

    Heel and trim are roll and pitch as in `Start`: the vessel heels first, then trims about the
    horizontal axis across. With trim free no torque is left about that axis; of several balances
    the curve follows the one nearest to that at the heel before. Where that ends, it goes on with
    the next one downhill. If that one is end over end, the curve ends, with a `BuoyancyWarning`.

    Args:
        model: any MuJoCo model with a body that floats.
        water: the sea, whose still level alone counts; fresh water with its level at z = 0 if None.
        heel: angles (n,) [rad]; None for 0 to 180 degrees, one by one.
        axis: direction of the axis of heel, from the heading at the start to port [rad]; 0 for the
            longitudinal axis, pi / 2 for a curve in trim.
        trim: 'free', or 'fixed' to that at the start.
        start: coordinates of the upright model (nq,), or of its free joint alone (7,);
            `model.qpos0` if None.
        points: globs of the sites to watch, as deck edges and downflooding points.
        body: name of the root body, where several float; the first that floats freely and has
            hulls if None.
        selection: which geoms displace water, and as what.
        ballast: what tanks, compartments and bladders hold: volumes [m^3] by name, or the states of
            actuators (na,), as `data.act`; None for empty.

    Raises:
        EquilibriumError: the vessel sinks, weighs nothing, or does not balance at all.
        ModelError: a heel is not finite, `trim` is another word, a glob matches no site, joints or
            a weld hold the vessel; or see `statics.building.build_vessel`.
        MeshError: a mesh bounds no volume.

    Example:
        `math.degrees(righting_arm(model).vanishing)`
    """
    try:
        heels = np.unique(np.asarray(np.radians(np.arange(181.0)) if heel is None else heel, float))
        is_finite = bool(heels.size) and bool(np.isfinite(heels).all()) and math.isfinite(axis)
    except (TypeError, ValueError):
        is_finite = False
    if not is_finite:
        raise ModelError("heel and axis must be finite angles [rad], at least one of heel")
    if trim not in TRIMS:
        raise ModelError(f"trim is '{trim}'; {choices(trim, TRIMS)}")
    if isinstance(points, str):
        points = [points]
    if not isinstance(points, Sequence) or not all(isinstance(glob, str) for glob in points):
        raise ModelError(f"points is {describe(points)}; it must be globs of sites, as ['deck*']")
    vessel = build_vessel(model, water, start, body=body, selection=selection, ballast=ballast)
    vessel.check_free()
    return compute_righting_arm(vessel, heels, axis=axis, trim_free=trim == "free", points=points)


def compute_righting_arm(
    vessel: Vessel,
    heels: NDArray[np.float64],
    *,
    upright: NDArray[np.float64] | None = None,
    axis: float = 0.0,
    trim_free: bool = True,
    points: Sequence[str] | str = POINTS,
) -> RightingArm:
    """Compute the GZ curve of a vessel, see `righting_arm`.

    Args:
        vessel: the vessel.
        heels: angles (n,) [rad], ascending.
        upright: attitude before it heels, world_from_vessel (3, 3); that of the vessel if None.
        axis: direction of the axis of heel, from the heading of `upright` to port [rad].
        trim_free: whether the vessel trims as it likes.
        points: globs of the sites to watch.
    """
    globs = [points] if isinstance(points, str) else points
    names = vessel.match_sites(globs, optional=POINTS)
    start = vessel.rotation if upright is None else upright
    heeling = Heeling(vessel, start, axis, trim_free=trim_free)

    # the poses in ascending order of heel
    by_heel = _heel_outwards(heeling, heels)
    heels = np.array(sorted(by_heel))
    poses = [by_heel[angle] for angle in heels.tolist()]

    gz = np.array([heeling.measure_arm(pose) for pose in poses])
    return RightingArm(
        heel=heels,
        gz=gz,
        trim=np.array([heeling.measure_trim(pose) for pose in poses]),
        draft=np.array([pose.draft for pose in poses]),
        vanishing=_find_vanishing(heeling, heels, gz, poses),
        immersed={
            name: _find_immersion(heeling, vessel.sites[name], heels, poses) for name in names
        },
    )


def _heel_outwards(heeling: Heeling, heels: NDArray[np.float64]) -> dict[float, FloatingPose]:
    """Poses at heels [rad], found outwards from the least, so that each trim begins at the last."""
    poses: dict[float, FloatingPose] = {}
    for side in (heels[heels >= 0.0], heels[heels < 0.0][::-1]):
        last = None
        for angle in side.tolist():
            try:
                last = heeling.heel(angle, last)
            except EquilibriumError as error:
                if last is None:
                    raise
                warnings.warn(
                    f"the righting arm ends there: {error}", BuoyancyWarning, stacklevel=4
                )
                break
            poses[angle] = last
    return poses


def _find_vanishing(
    heeling: Heeling,
    heels: NDArray[np.float64],
    gz: NDArray[np.float64],
    poses: Sequence[FloatingPose],
) -> float:
    """Find the first zero of the arm past its largest [rad]; NaN without one."""
    first = int(np.searchsorted(heels, 0.0))
    if gz[first:].max(initial=0.0) <= 0.0:
        return math.nan
    best = first + int(gz[first:].argmax())

    # upside down the arm of a symmetric vessel is zero but for rounding
    least = 1e-9 * heeling.vessel.radius
    for i in range(best, len(heels) - 1):
        if gz[i] > least >= gz[i + 1]:
            return heeling.find_root(heeling.measure_arm, poses[i], heels[i], heels[i + 1])
    return math.nan


def _find_immersion(
    heeling: Heeling,
    site: NDArray[np.float64],
    heels: NDArray[np.float64],
    poses: Sequence[FloatingPose],
) -> float:
    """Find the least positive heel at which a site (3,) [m] goes under [rad]; NaN without one."""

    def height(pose: FloatingPose) -> float:
        return float(pose.position[2] + pose.rotation[2] @ site) - heeling.vessel.water.level

    first = int(np.searchsorted(heels, 0.0))
    for i in range(first, len(heels)):
        if height(poses[i]) <= 0.0:
            if i == first:
                return float(heels[i])
            return heeling.find_root(height, poses[i - 1], heels[i - 1], heels[i])
    return math.nan
