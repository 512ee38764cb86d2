"""`Loads`: all that the water does at one instant, by hull, by body and in total, and by cause."""

import dataclasses
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray


@dataclasses.dataclass(frozen=True)
class Portion:
    """What is under water of some hulls, and what the water does to them; NaN centroids where all is dry.

    n is the number of hulls or of bodies; the total has no such axis.
    """

    volume: NDArray[np.float64]
    """Submerged volume (n,) [m^3]."""
    centroid: NDArray[np.float64]
    """Its centroid (n, 3) [m], world frame, weighed by volume where there are several hulls."""
    force: NDArray[np.float64]
    """Force (n, 3) [N], world frame."""
    torque: NDArray[np.float64]
    """Torque (n, 3) [N m], world frame, about the reference point named where this is used."""


@dataclasses.dataclass(frozen=True)
class Loads:
    """All wrenches of one evaluation."""

    names: tuple[str, ...]
    """Names of the hulls (h)."""
    hull: Portion
    """Each hull and its buoyancy (h); torques about the inertial frame origin of its body, MuJoCo's xipos."""
    body: Portion
    """Each body of the model (nbody) and the sum of all causes; torques about its xipos."""
    total: Portion
    """Everything; torque about the centre of mass of the floating bodies."""
    wetted_area: NDArray[np.float64]
    """Area of each hull under water (h,) [m^2]; NaN from a method that does not know it."""
    waterplane_area: NDArray[np.float64]
    """Area of each hull's cut with the surface, seen from above (h,) [m^2]; NaN likewise."""
    by_cause: Mapping[str, NDArray[np.float64]]
    """Force and torque rows (nbody, 6) [N, N m] of each cause, in the layout of MuJoCo's xfrc_applied."""

    @property
    def xfrc(self) -> NDArray[np.float64]:
        """The sum of all causes (nbody, 6), in the layout of MuJoCo's xfrc_applied."""
        return np.hstack([self.body.force, self.body.torque])
