"""`FloatingPose`: a vessel in one pose on still water, with its weight and its buoyancy."""

import dataclasses
import functools
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.kernels import clip
from buoyancy_mj.kernels.waterplane import HIGHEST, INTEGRALS, LOWEST
from buoyancy_mj.statics.vessel import Vessel

if TYPE_CHECKING:
    from buoyancy_mj.statics.tanks import FreeSurface


@dataclasses.dataclass(frozen=True, eq=False)
class Waterplane:
    """What the still surface cuts out of a vessel's hulls, seen from above.

    Moments and extents count from the vessel's centre of gravity, along the world's axes.
    """

    area: float
    """Area [m^2]; of flooded hulls, the part that displaces."""
    first_moments: NDArray[np.float64]
    """Integrals of x and y over the area (2,) [m^3]."""
    second_moments: NDArray[np.float64]
    """Integrals of x x, x y; x y, y y over the area (2, 2) [m^4]."""
    low: NDArray[np.float64]
    """Lowest x and y of the waterline (2,) [m]; inf without one."""
    high: NDArray[np.float64]
    """Highest x and y of the waterline (2,) [m]; -inf without one."""


@dataclasses.dataclass(frozen=True, eq=False)
class FloatingPose:
    """A vessel in one pose on still water, in balance or not, submerged or in the air."""

    vessel: Vessel
    """The vessel."""
    position: NDArray[np.float64]
    """Centre of gravity (3,) [m], world frame."""
    rotation: NDArray[np.float64]
    """world_from_vessel (3, 3)."""
    volume: float
    """Submerged volume [m^3]."""
    arm: NDArray[np.float64]
    """From the centre of gravity to the centre of buoyancy (3,) [m], world axes; zero when dry."""
    wetted_area: float
    """Area under the surface [m^2]."""
    waterplane_area: float
    """Area cut out of the surface [m^2]; of flooded hulls, the part that displaces."""

    @functools.cached_property
    def waterplane(self) -> Waterplane:
        """What the surface cuts out of the hulls."""
        vessel = self.vessel
        frames = _place_hulls(vessel, self.position, self.rotation)
        rows = vessel.packed.waterplanes(*frames, self.position)

        # those of all hulls as one
        area, x, y, xx, xy, yy = rows[:, INTEGRALS].sum(axis=0)
        return Waterplane(
            area=float(area),
            first_moments=np.array([x, y]),
            second_moments=np.array([[xx, xy], [xy, yy]]),
            low=rows[:, LOWEST].min(axis=0),
            high=rows[:, HIGHEST].max(axis=0),
        )

    @functools.cached_property
    def surfaces(self) -> "tuple[FreeSurface, ...]":
        """How the water in its tanks lies, of each."""
        return tuple(tank.settle(self.rotation) for tank in self.vessel.tanks)

    @functools.cached_property
    def shift(self) -> NDArray[np.float64]:
        """From `position` to where the weight acts (3,) [m], world axes: the tanks' water moves."""
        vessel = self.vessel
        pairs = zip(vessel.tanks, self.surfaces, strict=True)
        moment = sum((tank.volume * surface.shift for tank, surface in pairs), np.zeros(3))
        return moment * vessel.water.density / vessel.mass if vessel.tanks else np.zeros(3)

    @property
    def lever(self) -> NDArray[np.float64]:
        """From where the weight acts to the centre of buoyancy (3,) [m], world axes."""
        return self.arm - self.shift

    @functools.cached_property
    def free_surface(self) -> NDArray[np.float64]:
        """Second moments of all free surfaces, each about its own centroid (2, 2) [m^4]."""
        return sum((surface.moments for surface in self.surfaces), np.zeros((2, 2)))

    @property
    def draft(self) -> float:
        """Depth of the lowest point of the hulls [m]; negative above the water."""
        low, _ = self.vessel.heights(self.rotation)
        return float(self.vessel.water.level - self.position[2] - low)

    @property
    def buoyancy(self) -> float:
        """Upward force of the water [N]."""
        return self.vessel.specific_weight * self.volume

    @property
    def energy(self) -> float:
        """Potential energy of weight and buoyancy [J]; `force` is minus its slope."""
        height = self.position[2] - self.vessel.water.level
        weight = self.vessel.weight * (height + self.shift[2])
        return float(weight - self.buoyancy * (height + self.arm[2]))

    @property
    def force(self) -> NDArray[np.float64]:
        """Upward force [N] and torques about x and y [N m] (3,), which drive heave, roll and pitch.

        Torques are about `position`, in the world's axes.
        """
        lift, weight = self.buoyancy, self.vessel.weight
        x, y, _ = lift * self.arm - weight * self.shift
        return np.array([lift - weight, y, -x])

    @property
    def torque(self) -> NDArray[np.float64]:
        """Torques about x and y through the centre of gravity (2,) [N m]."""
        return self.force[1:]

    @property
    def stiffness(self) -> NDArray[np.float64]:
        """Restoring force and torques (3, 3) per heave [m] and turn about x and y [rad].

        It is minus the derivative of `force`. With u the motion of the body, the derivative of an
        integral of f over the wet volume is that of grad f . u, less f u_z over the waterplane
        (Reynolds' transport theorem); f = 1, y, x give the matrix of Newman, Marine Hydrodynamics
        (1977), sec. 6.16, with moments about `position`. The water in tanks counts likewise with
        the opposite sign, and the volume of each stays.
        """
        area = self.waterplane.area
        x, y = self.waterplane.first_moments
        (xx, xy), (_, yy) = self.waterplane.second_moments - self.free_surface
        held = self.vessel.mass / self.vessel.water.density
        lever = self.volume * self.arm[2] - held * self.shift[2]
        return self.vessel.specific_weight * np.array(
            [[area, y, -x], [y, yy + lever, -xy], [-x, -xy, xx + lever]]
        )


def pose_vessel(vessel: Vessel, position: ArrayLike, rotation: ArrayLike) -> FloatingPose:
    """Put a vessel into a pose, and submerge it there.

    Args:
        vessel: the vessel.
        position: of its centre of gravity (3,) [m], world frame.
        rotation: world_from_vessel (3, 3).
    """
    origin = np.asarray(position, float)
    world_from_vessel = np.ascontiguousarray(rotation, float)
    wet = vessel.packed.submerge(*_place_hulls(vessel, origin, world_from_vessel), 0.0)

    # volume, and the way to its centroid
    volumes = wet[:, clip.VOLUME]
    volume = float(volumes.sum())
    arm = np.zeros(3)
    if volume > 0.0:
        submerged = volumes > 0.0
        arm = volumes[submerged] @ (wet[submerged, clip.CENTROID] - origin) / volume
    return FloatingPose(
        vessel=vessel,
        position=origin,
        rotation=world_from_vessel,
        volume=volume,
        arm=arm,
        wetted_area=float(wet[:, clip.WETTED_AREA].sum()),
        waterplane_area=float(wet[:, clip.WATERPLANE_AREA].sum()),
    )


def _place_hulls(
    vessel: Vessel, position: NDArray[np.float64], rotation: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Origins (h, 3) [m] and rotations world_from_hull (h, 9) of a vessel's hulls in a pose."""
    origins = position + vessel.hull_positions @ rotation.T
    return origins, (rotation @ vessel.hull_rotations).reshape(-1, 9)
