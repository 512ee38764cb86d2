"""`hydrostatics`: what a naval architect asks of a vessel in a pose, exact on its meshes."""

import dataclasses
import math
from collections.abc import Mapping

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import ModelError
from buoyancy_mj.hulls.selection import Selection
from buoyancy_mj.sea.water import Water
from buoyancy_mj.statics.attitude import Attitude
from buoyancy_mj.statics.building import build_vessel
from buoyancy_mj.statics.floating_pose import FloatingPose, pose_vessel
from buoyancy_mj.statics.heading_axes import (
    HEAVE_ROLL_PITCH,
    compute_mass_matrix,
    compute_stiffness,
    measure_waterline,
    rotate_to_heading,
)


@dataclasses.dataclass(frozen=True, eq=False)
class Hydrostatics:
    """The hydrostatics of a vessel in one pose on still water.

    Axes are z up, x horizontal along the vessel's heading, y to port. Motions are in the order
    surge, sway, heave, roll, pitch, yaw, about the centre of gravity (Newman 1977). In Fossen's
    axes, z down and y to starboard, a matrix M becomes D M D with D = diag(1, -1, -1, 1, -1, -1).

    Metacentric heights are those of the pose, at rest or not: displacement means the water that
    the vessel displaces there. Without a waterplane they are those of a submerged body, GM = BG.
    """

    density: float
    """Density of the water [kg/m^3]."""
    gravity: float
    """Downward acceleration [m/s^2]."""
    level: float
    """Height of the still water [m], world frame."""
    mass: float
    """Mass of the vessel that weighs [kg]: that of all bodies, less what is carried."""
    carried_mass: float
    """Mass of the vessel that gravity compensation carries (`gravcomp`) [kg]."""
    whole_volume: float
    """Volume of water that the vessel displaces fully submerged [m^3]."""
    volume: float
    """Volume of water that the vessel displaces [m^3]."""
    centre_of_gravity: NDArray[np.float64]
    """Centre of gravity G (3,) [m], world frame: the point through which the weight acts, with the
    water in tanks where it lies in the pose."""
    centre_of_buoyancy: NDArray[np.float64]
    """Centre of buoyancy B (3,) [m], world frame; NaN when dry."""
    wetted_area: float
    """Area of the hulls under water [m^2]."""
    waterplane_area: float
    """Area cut out of the surface [m^2]; of flooded hulls, the part that displaces."""
    centre_of_flotation: NDArray[np.float64]
    """Centroid of the waterplane (3,) [m], world frame; NaN without one."""
    waterplane_moments: NDArray[np.float64]
    """Second moments x x, x y; x y, y y of the waterplane about its centroid (2, 2) [m^4].

    x points along the heading, y to port."""
    free_surface: NDArray[np.float64]
    """Second moments of the surfaces of water in tanks, each about its own centroid (2, 2) [m^4],
    along the axes of `waterplane_moments`: they take rho i / displacement off GM."""
    keel: float
    """Height of the lowest point of the hulls [m], world frame."""
    waterline_length: float
    """Extent of the waterline along the heading [m]; 0 without one."""
    waterline_beam: float
    """Extent of the waterline across the heading [m]; 0 without one."""
    heading: float
    """Direction of the root body's x axis, about the vertical [rad]."""
    trim: float
    """Pitch [rad], bow down."""
    heel: float
    """Roll [rad], port up."""
    mass_matrix: NDArray[np.float64]
    """Mass and inertia of all bodies about the centre of gravity (6, 6) [kg, kg m^2]."""
    stiffness: NDArray[np.float64]
    """Hydrostatic stiffness about the centre of gravity (6, 6) [N/m, N, N m]."""

    def _repr_html_(self) -> str:
        """How a notebook shows them."""
        from buoyancy_mj.statics.portrait import portray

        return portray(self)

    @property
    def displacement(self) -> float:
        """Mass of the water displaced [kg]."""
        return self.density * self.volume

    @property
    def reserve(self) -> float:
        """Mass [kg] that the vessel could carry before it goes under; negative where it sinks."""
        return self.density * self.whole_volume - self.mass

    @property
    def draft(self) -> float:
        """Depth of the lowest point of the hulls [m]; negative above the water."""
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
        return self._divide_by_volume(self.waterplane_moments[1, 1])

    @property
    def BMl(self) -> float:  # noqa: N802
        """Longitudinal metacentric radius [m]."""
        return self._divide_by_volume(self.waterplane_moments[0, 0])

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
        """Transverse metacentric height [m]: positive rights the vessel in roll."""
        return self.BG + self.BMt - self._divide_by_volume(self.free_surface[1, 1])

    @property
    def GMl(self) -> float:  # noqa: N802
        """Longitudinal metacentric height [m]: positive rights the vessel in pitch."""
        return self.BG + self.BMl - self._divide_by_volume(self.free_surface[0, 0])

    @property
    def GM(self) -> float:  # noqa: N802
        """Least metacentric height [m], over all axes to heel about."""
        if not self.volume > 0.0:
            return math.nan
        moments = self.waterplane_moments - self.free_surface
        return self.BG + float(np.linalg.eigvalsh(moments)[0]) / self.volume

    def natural_periods(self, added_mass: ArrayLike | None = None) -> NDArray[np.float64]:
        """Compute the undamped periods of heave, roll and pitch, each by itself (3,) [s].

        2 pi sqrt((M_ii + A_ii) / C_ii) about the centre of gravity; inf where nothing restores.

        Args:
            added_mass: diagonal (6,) or matrix (6, 6) in the axes of `stiffness`; None for none.

        Raises:
            ModelError: the added mass has another shape, or is not finite.
        """
        inertia = np.diag(self.mass_matrix + _expand_added_mass(added_mass))[HEAVE_ROLL_PITCH]
        stiffness = np.diag(self.stiffness)[HEAVE_ROLL_PITCH]
        with np.errstate(divide="ignore", invalid="ignore"):
            squared = np.where(stiffness > 0.0, inertia / stiffness, math.inf)
        return 2.0 * math.pi * np.sqrt(squared)

    def modes(
        self, added_mass: ArrayLike | None = None
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Compute the undamped motions of the coupled vessel that have a period.

        They are the eigenvectors of (M + A)^-1 C, scaled to a largest component of 1. A motion that
        grows instead of swinging has no period and is left out, as are surge, sway and yaw, which
        nothing restores.

        Args:
            added_mass: diagonal (6,) or matrix (6, 6) in the axes of `stiffness`; None for none.

        Returns:
            Periods (n,) [s], ascending, and the motion of each (n, 6).

        Raises:
            ModelError: the added mass has another shape, or is not finite.
        """
        inertia = self.mass_matrix + _expand_added_mass(added_mass)
        values, vectors = np.linalg.eig(np.linalg.solve(inertia, self.stiffness))

        # what swings
        scale = np.abs(values).max(initial=0.0)
        swings = (values.real > 1e-9 * scale) & (np.abs(values.imag) <= 1e-9 * scale)
        periods = 2.0 * math.pi / np.sqrt(values.real[swings])

        # each scaled by its largest component
        shapes = vectors.real[:, swings].T
        shapes /= np.take_along_axis(shapes, np.abs(shapes).argmax(axis=1)[:, None], axis=1)
        order = np.argsort(periods)
        return periods[order], shapes[order]

    def _divide_by_volume(self, moment: float) -> float:
        return float(moment) / self.volume if self.volume > 0.0 else math.nan


def hydrostatics(
    model: mujoco.MjModel,
    water: Water | None = None,
    qpos: ArrayLike | None = None,
    *,
    body: str | None = None,
    selection: Selection = Selection(),
    ballast: Mapping[str, float] | ArrayLike | None = None,
) -> Hydrostatics:
    """Compute the hydrostatics of a vessel at `qpos`: floating, submerged or in the air.

    Args:
        model: any MuJoCo model with bodies that displace water.
        water: the sea, whose still level alone counts; fresh water with its level at z = 0 if None.
        qpos: coordinates of the model (nq,), or of the vessel's free joint alone (7,);
            `model.qpos0` if None.
        body: name of the root body, where several float; the first that floats freely and has
            hulls if None.
        selection: which geoms displace water, and as what.
        ballast: what tanks, compartments and bladders hold: volumes [m^3] by name, or the states of
            actuators (na,), as `data.act`; None for empty.

    Raises:
        ModelError: see `statics.building.build_vessel`.
        MeshError: a mesh bounds no volume.

    Example:
        `hydrostatics(model, qpos=[0, 0, -0.2, 1, 0, 0, 0]).GMt`
    """
    vessel = build_vessel(model, water, qpos, body=body, selection=selection, ballast=ballast)
    return compute_hydrostatics(pose_vessel(vessel, vessel.position, vessel.rotation))


def compute_hydrostatics(pose: FloatingPose) -> Hydrostatics:
    """Compute the hydrostatics of a vessel in a pose."""
    vessel = pose.vessel
    attitude = Attitude.from_matrix(pose.rotation)
    axes = rotate_to_heading(attitude.heading)
    low, _ = vessel.heights(pose.rotation)

    # a waterplane of rounding errors is none
    area = pose.waterplane.area
    flotation = np.full(3, math.nan)
    moments = np.zeros((2, 2))
    length, beam = 0.0, 0.0
    if area > 1e-12 * vessel.radius**2:
        middle = pose.waterplane.first_moments / area
        flotation = np.append(pose.position[:2] + middle, vessel.water.level)
        about_middle = pose.waterplane.second_moments - area * np.outer(middle, middle)
        moments = axes[:2, :2] @ about_middle @ axes[:2, :2].T
        length, beam = measure_waterline(pose, axes)

    return Hydrostatics(
        density=vessel.water.density,
        gravity=vessel.gravity,
        level=vessel.water.level,
        mass=vessel.mass,
        carried_mass=vessel.carried_mass,
        whole_volume=vessel.volume,
        volume=pose.volume,
        centre_of_gravity=pose.position + pose.shift,
        centre_of_buoyancy=pose.position + (pose.arm if pose.volume > 0.0 else math.nan),
        wetted_area=pose.wetted_area,
        waterplane_area=area,
        centre_of_flotation=flotation,
        waterplane_moments=moments,
        free_surface=axes[:2, :2] @ pose.free_surface @ axes[:2, :2].T,
        keel=float(pose.position[2] + low),
        waterline_length=length,
        waterline_beam=beam,
        heading=attitude.heading,
        trim=attitude.trim,
        heel=attitude.heel,
        mass_matrix=compute_mass_matrix(pose, axes),
        stiffness=compute_stiffness(pose, axes),
    )


def _expand_added_mass(added_mass: ArrayLike | None) -> NDArray[np.float64]:
    """An added mass as a matrix (6, 6); zero if None."""
    if added_mass is None:
        return np.zeros((6, 6))
    values = np.asarray(added_mass, float)
    if values.shape not in ((6,), (6, 6)) or not np.isfinite(values).all():
        raise ModelError(
            f"added mass has shape {values.shape}; "
            "it must be finite, a diagonal (6,) or a matrix (6, 6)"
        )
    return np.diag(values) if values.ndim == 1 else values
