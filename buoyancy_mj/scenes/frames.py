"""What a run gives: `Frame` at each instant, `Summary` at the end."""

import dataclasses

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.loads.loads import Loads

LAST = 2.0
"""Time at the end of a run [s] over which the summary looks at the motion."""


@dataclasses.dataclass(frozen=True)
class Energy:
    """Mechanical energy of the vehicle and the water that it displaces [J]; constant without drag on still water."""

    kinetic: float
    """Of the bodies."""
    potential: float
    """Of the bodies in gravity (and in springs), zero at z = 0."""
    buoyancy: float
    """Of the displaced water, lifted from the submerged centroid to the surface: rho g V (elevation - z)."""

    @property
    def total(self) -> float:
        """The sum."""
        return self.kinetic + self.potential + self.buoyancy


@dataclasses.dataclass(frozen=True)
class Frame:
    """One instant of a run."""

    time: float
    """[s]."""
    data: mujoco.MjData
    """Poses and velocities at exactly this time; overwritten by the next frame."""
    loads: Loads
    """What the water does."""
    centre_of_mass: NDArray[np.float64]
    """Of the vehicle (3,) [m], world frame."""
    attitude: NDArray[np.float64]
    """Roll, pitch and yaw (3,) [rad] of the vehicle's root body."""
    draft: float
    """Depth of the lowest point of its hulls under the surface [m]; negative above it."""
    elevation: float
    """Height of the surface above the centre of mass [m], world frame."""
    energy: Energy
    """Mechanical energy."""


@dataclasses.dataclass(frozen=True)
class Summary:
    """What a run amounts to."""

    scene: str
    """Title of the scene."""
    method: str
    """How the submersion was found."""
    mass: float
    """Of the vehicle [kg]."""
    displacement: float
    """Mass of water that its hulls displace when fully under water [kg]."""
    net_weight: float
    """Weight less greatest buoyancy [N]: positive sinks, negative floats."""
    peak_draft: float
    """Greatest depth of the lowest point [m]."""
    final_draft: float
    """Depth of the lowest point at the end [m]."""
    cog_z_range: float
    """Highest less lowest z of the centre of gravity over the last 2 s [m]."""
    simulated_time: float
    """[s]."""
    wall_time: float
    """Time that took, with whatever was done with the frames [s]."""
    real_time_factor: float
    """Simulated over wall time."""
    contact_steps: int
    """Steps in which the vehicle touched the bottom or another fixed thing."""
    first_contact: float | None
    """Time of the first touch [s]."""

    def rows(self) -> list[tuple[str, str]]:
        """Names and values for a table, with units."""
        kind = "sinks" if self.net_weight > 0.0 else "floats"
        touched = (
            f"{self.contact_steps} steps, first at {self.first_contact:.2f} s"
            if self.contact_steps
            else "none"
        )
        return [
            ("method", self.method),
            ("mass", f"{self.mass:.3f} kg"),
            ("displacement, fully under water", f"{self.displacement:.3f} kg"),
            ("net weight, fully under water", f"{self.net_weight:+.2f} N ({kind})"),
            ("peak draft", f"{self.peak_draft:.3f} m"),
            ("final draft", f"{self.final_draft:.3f} m"),
            (f"CoG z range, last {LAST:g} s", f"{self.cog_z_range:.4f} m"),
            ("simulated time", f"{self.simulated_time:.2f} s"),
            ("real-time factor", f"{self.real_time_factor:.1f} x"),
            ("contact with the bottom or walls", touched),
        ]
