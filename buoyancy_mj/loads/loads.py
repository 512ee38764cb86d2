"""`Loads`: the forces and torques of the water at one instant."""

import dataclasses
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray


@dataclasses.dataclass(frozen=True)
class Portion:
    """The wet part of hulls, and the force of the water on them; the centroid is NaN where all is
    dry.

    n is the number of hulls or of bodies; the total has no such axis.
    """

    volume: NDArray[np.float64]
    """Submerged volume (n,) [m^3]."""
    centroid: NDArray[np.float64]
    """Centroid of that volume (n, 3) [m], world frame."""
    force: NDArray[np.float64]
    """Force (n, 3) [N], world frame."""
    torque: NDArray[np.float64]
    """Torque (n, 3) [N m], world frame, about the point that the field of `Loads` names."""


@dataclasses.dataclass(frozen=True)
class Loads:
    """All that the water does at one instant: by hull, by body, in total, and by cause."""

    names: tuple[str, ...]
    """Names of the hulls (h)."""
    hull: Portion
    """Each hull and its buoyancy (h); torques about the origin of its body's inertial frame,
    MuJoCo's xipos."""
    body: Portion
    """Each body of the model (nbody) and the sum of all causes; torques about its xipos."""
    total: Portion
    """Everything; torque about the centre of mass of the floating bodies."""
    wetted_area: NDArray[np.float64]
    """Area of each hull under water (h,) [m^2]; NaN from a method that does not find it."""
    waterplane_area: NDArray[np.float64]
    """Area of each hull's cut with the surface, seen from above (h,) [m^2]; NaN from a method that
    does not find it."""
    by_cause: Mapping[str, NDArray[np.float64]]
    """Force and torque rows (nbody, 6) [N, N m] of each cause, in the layout of MuJoCo's
    xfrc_applied."""

    @property
    def xfrc(self) -> NDArray[np.float64]:
        """The sum of all causes (nbody, 6), in the layout of MuJoCo's xfrc_applied."""
        return np.hstack([self.body.force, self.body.torque])

    def _repr_html_(self) -> str:
        """How a notebook shows them."""
        from buoyancy_mj.loads.portrait import portray

        return portray(self)
