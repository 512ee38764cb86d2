"""`hydrostatics`: what a naval architect asks of a vessel in a pose, exact on its mesh."""

import dataclasses
import math

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import ModelError
from buoyancy_mj.hulls.selection import Selection
from buoyancy_mj.sea.water import Water
from buoyancy_mj.statics.attitude import Attitude
from buoyancy_mj.statics.building import build_vessel
from buoyancy_mj.statics.floating_pose import FloatingPose, pose_vessel


@dataclasses.dataclass(frozen=True, eq=False)
class Hydrostatics:
    """A vessel in one pose on still water.

    Axes are z up, x horizontal along the vessel's heading, y to port; motions in the order surge,
    sway, heave, roll, pitch, yaw, about the centre of gravity (Newman 1977). In Fossen's axes, z down
    and y to starboard, a matrix M here is D M D with D = diag(1, -1, -1, 1, -1, -1).

    Metacentric heights are those of the pose as it is, at rest or not: displacement means the water
    displaced there. Heights without a waterplane are those of a submerged body, GM = BG.
    """

    density: float
    """Of the water [kg/m^3]."""
    gravity: float
    """[m/s^2]."""
    level: float
    """Height of the still water [m], world frame."""
    mass: float
    """Of the vessel [kg]."""
    whole_volume: float
    """Volume it displaces fully submerged [m^3]."""
    volume: float
    """Volume it displaces [m^3]."""
    centre_of_gravity: NDArray[np.float64]
    """G (3,) [m], world frame."""
    centre_of_buoyancy: NDArray[np.float64]
    """B (3,) [m], world frame; NaN when dry."""
    wetted_area: float
    """Area of the hulls under water [m^2]."""
    waterplane_area: float
    """Area cut out of the surface [m^2]; of flooded hulls, the part that displaces."""
    centre_of_flotation: NDArray[np.float64]
    """Centroid of the waterplane (3,) [m], world frame; NaN without one."""
    waterplane_moments: NDArray[np.float64]
    """Second moments of the waterplane about its centroid (2, 2) [m^4]: x x along the heading, y y across, x y."""
    keel: float
    """Height of the lowest point of the hulls [m], world frame."""
    waterline_length: float
    """Extent of the waterline along the heading [m]; 0 without one."""
    waterline_beam: float
    """Extent of the waterline across the heading [m]; 0 without one."""
    heading: float
    """Of the x axis of the root body, about the vertical [rad]."""
    trim: float
    """Pitch, bow down [rad]."""
    heel: float
    """Roll, port up [rad]."""
    mass_matrix: NDArray[np.float64]
    """Mass and inertia about the centre of gravity (6, 6) [kg, kg m^2]."""
    stiffness: NDArray[np.float64]
    """Hydrostatic stiffness about the centre of gravity (6, 6) [N/m, N, N m]."""

    @property
    def displacement(self) -> float:
        """Mass of the water displaced [kg]."""
        return self.density * self.volume

    @property
    def reserve(self) -> float:
        """Mass [kg] that it could still carry before it goes under; negative where it sinks."""
        return self.density * self.whole_volume - self.mass

    @property
    def draft(self) -> float:
        """Depth of its lowest point [m]; negative above the water."""
        return self.level - self.keel

    @property
    def KB(self) -> float:  # noqa: N802
        """Height of the centre of buoyancy over the keel [m]."""
        return float(self.centre_of_buoyancy[2] - self.keel)

    @property
    def KG(self) -> float:  # noqa: N802
        """Height of the centre of gravity over the keel [m]."""
        return float(self.centre_of_gravity[2] - self.keel)

    @property
    def BG(self) -> float:  # noqa: N802
        """Height of the centre of buoyancy over that of gravity [m]."""
        return float(self.centre_of_buoyancy[2] - self.centre_of_gravity[2])

    @property
    def BMt(self) -> float:  # noqa: N802
        """Transverse metacentric radius [m]: second moment of the waterplane over volume."""
        return self._over_volume(self.waterplane_moments[1, 1])

    @property
    def BMl(self) -> float:  # noqa: N802
        """Longitudinal metacentric radius [m]."""
        return self._over_volume(self.waterplane_moments[0, 0])

    @property
    def KMt(self) -> float:  # noqa: N802
        """Height of the transverse metacentre over the keel [m]."""
        return self.KB + self.BMt

    @property
    def KMl(self) -> float:  # noqa: N802
        """Height of the longitudinal metacentre over the keel [m]."""
        return self.KB + self.BMl

    @property
    def GMt(self) -> float:  # noqa: N802
        """Transverse metacentric height [m]: positive rights it in roll."""
        return self.BG + self.BMt

    @property
    def GMl(self) -> float:  # noqa: N802
        """Longitudinal metacentric height [m]: positive rights it in pitch."""
        return self.BG + self.BMl

    @property
    def GM(self) -> float:  # noqa: N802
        """The least metacentric height [m], over all axes to heel about."""
        if not self.volume > 0.0:
            return math.nan
        return self.BG + float(np.linalg.eigvalsh(self.waterplane_moments)[0]) / self.volume

    def natural_periods(self, added_mass: ArrayLike | None = None) -> NDArray[np.float64]:
        """Undamped periods of heave, roll and pitch, each by itself (3,) [s]; inf where nothing restores.

        2 pi sqrt((M_ii + A_ii) / C_ii) about the centre of gravity.

        Args:
            added_mass: diagonal (6,) or matrix (6, 6) in the axes of `stiffness`; None for none.

        Raises:
            ModelError: an added mass of another shape, or not finite.
        """
        inertia = np.diag(self.mass_matrix + _matrix(added_mass))[2:5]
        restoring = np.diag(self.stiffness)[2:5]
        with np.errstate(divide="ignore", invalid="ignore"):
            squared = np.where(restoring > 0.0, inertia / restoring, math.inf)
        return 2.0 * math.pi * np.sqrt(squared)

    def modes(
        self, added_mass: ArrayLike | None = None
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Undamped motions of the coupled vessel that have a period: the periods (n,) [s], and how it moves (n, 6).

        The eigenvectors of (M + A)^-1 C, scaled to a largest component of 1. What grows instead of
        swinging has no period and is left out, as are surge, sway and yaw, which nothing restores.

        Raises:
            ModelError: an added mass of another shape, or not finite.
        """
        values, vectors = np.linalg.eig(
            np.linalg.solve(self.mass_matrix + _matrix(added_mass), self.stiffness)
        )
        scale = np.abs(values).max(initial=0.0)
        swings = (values.real > 1e-9 * scale) & (np.abs(values.imag) <= 1e-9 * scale)
        periods = 2.0 * math.pi / np.sqrt(values.real[swings])
        shapes = vectors.real[:, swings].T
        shapes /= np.take_along_axis(shapes, np.abs(shapes).argmax(axis=1)[:, None], axis=1)
        order = np.argsort(periods)
        return periods[order], shapes[order]

    def _over_volume(self, moment: float) -> float:
        return float(moment) / self.volume if self.volume > 0.0 else math.nan


def hydrostatics(
    model: mujoco.MjModel,
    water: Water | None = None,
    qpos: ArrayLike | None = None,
    *,
    body: str | None = None,
    selection: Selection = Selection(),
) -> Hydrostatics:
    """Hydrostatics of a vessel where `qpos` has it, floating, submerged or in the air, its joints as they are.

    Args:
        model: any MuJoCo model with bodies that displace water.
        water: fresh and still at z = 0 if None; waves are left aside.
        qpos: coordinates of the model (nq,), or of the vessel's free joint alone (7,); the model's own if None.
        body: name of the root body, where several float; None for the first that has hulls.
        selection: which geoms displace water, and as what.

    Raises:
        ModelError: see `statics.build_vessel`.
        MeshError: a mesh that bounds no volume.
    """
    vessel = build_vessel(model, water, qpos, body=body, selection=selection)
    return compute_hydrostatics(pose_vessel(vessel, vessel.position, vessel.rotation))


def compute_hydrostatics(afloat: FloatingPose) -> Hydrostatics:
    """Hydrostatics of a vessel in a pose."""
    vessel, turn = afloat.vessel, afloat.rotation
    heading, trim, heel = Attitude.from_matrix(turn)
    along = np.array([math.cos(heading), math.sin(heading)])
    axes = np.array([along, [-along[1], along[0]]])
    area = afloat.waterplane.area
    has_one = area > 1e-12 * vessel.radius**2
    middle = afloat.waterplane.first_moments / area if has_one else np.full(2, math.nan)
    second = afloat.waterplane.second_moments - (
        area * np.outer(middle, middle) if has_one else 0.0
    )
    points = vessel.points @ turn.T
    length, beam = _extents(afloat, axes) if has_one else (0.0, 0.0)
    about = np.eye(3)
    about[:2, :2] = axes
    masses = np.zeros((6, 6))
    masses[:3, :3] = vessel.mass * np.eye(3)
    masses[3:, 3:] = about @ turn @ vessel.inertia @ turn.T @ about.T
    flotation = np.append(afloat.position[:2] + middle, vessel.water.level)
    return Hydrostatics(
        density=vessel.water.density,
        gravity=vessel.gravity,
        level=vessel.water.level,
        mass=vessel.mass,
        whole_volume=vessel.volume,
        volume=afloat.volume,
        centre_of_gravity=afloat.position.copy(),
        centre_of_buoyancy=afloat.position + (afloat.arm if afloat.volume > 0.0 else math.nan),
        wetted_area=afloat.wetted_area,
        waterplane_area=area,
        centre_of_flotation=flotation if has_one else np.full(3, math.nan),
        waterplane_moments=axes @ second @ axes.T if has_one else np.zeros((2, 2)),
        keel=float(afloat.position[2] + points[:, 2].min()),
        waterline_length=length,
        waterline_beam=beam,
        heading=heading,
        trim=trim,
        heel=heel,
        mass_matrix=masses,
        stiffness=_stiffness(afloat, axes),
    )


def _stiffness(afloat: FloatingPose, axes: NDArray[np.float64]) -> NDArray[np.float64]:
    """All of it (6, 6), in horizontal axes (2, 2): `FloatingPose.stiffness`, and how the moments turn with the heading."""
    about = np.eye(3)
    about[1:, 1:] = axes
    whole = np.zeros((6, 6))
    whole[2:5, 2:5] = about @ afloat.stiffness @ about.T
    lift = afloat.vessel.water.density * afloat.vessel.gravity * afloat.volume
    whole[3:5, 5] = -lift * (axes @ afloat.arm[:2])
    return whole


def _extents(afloat: FloatingPose, axes: NDArray[np.float64]) -> tuple[float, float]:
    """Length and beam of the waterline [m]."""
    about = np.eye(3)
    about[:2, :2] = axes
    turned = pose_vessel(afloat.vessel, afloat.position, about @ afloat.rotation)
    length, beam = turned.waterplane.high - turned.waterplane.low
    return float(length), float(beam)


def _matrix(added_mass: ArrayLike | None) -> NDArray[np.float64]:
    """An added mass as a matrix."""
    if added_mass is None:
        return np.zeros((6, 6))
    given = np.asarray(added_mass, float)
    if given.shape not in ((6,), (6, 6)) or not np.isfinite(given).all():
        raise ModelError(
            f"added mass has shape {given.shape}; it must be finite, a diagonal (6,) or a matrix (6, 6)"
        )
    return np.diag(given) if given.ndim == 1 else given
