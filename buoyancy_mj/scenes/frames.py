"""`Frame`: one instant of a run; `Summary`: the run as a whole."""

import dataclasses

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.loads.loads import Loads

LAST = 2.0
"""Length of the end of a run [s] over which the summary takes the range of heights."""


@dataclasses.dataclass(frozen=True)
class Energy:
    """Mechanical energy [J] of the vehicle and of the water that it displaces.

    The total is constant without drag on still water.
    """

    kinetic: float
    """Kinetic energy of the bodies [J]."""
    potential: float
    """Potential energy of the bodies in gravity (and in springs) [J], zero at z = 0.

    What gravity compensation carries has none."""
    buoyancy: float
    """Energy [J] that lifted the displaced water from its centroid to the surface:
    rho g V (elevation - z)."""

    @property
    def total(self) -> float:
        """The sum [J]."""
        return self.kinetic + self.potential + self.buoyancy


@dataclasses.dataclass(frozen=True)
class Frame:
    """One instant of a run."""

    time: float
    """Simulated time [s]."""
    data: mujoco.MjData
    """Poses and velocities at exactly this time; the next frame overwrites them."""
    loads: Loads
    """Forces and torques of the water."""
    centre_of_mass: NDArray[np.float64]
    """Centre of mass of the vehicle (3,) [m], world frame."""
    attitude: NDArray[np.float64]
    """Roll, pitch and yaw (3,) [rad] of the vehicle's root body."""
    draft: float
    """Depth of the lowest point of the vehicle's hulls under the surface [m]; negative above it."""
    elevation: float
    """Height of the surface at the centre of mass [m], world frame."""
    energy: Energy
    """Mechanical energy."""


@dataclasses.dataclass(frozen=True)
class Summary:
    """A run in a few numbers."""

    scene: str
    """Title of the scene."""
    method: str
    """Name of the method that finds the submersion."""
    mass: float
    """Mass of the vehicle [kg]."""
    displacement: float
    """Mass of water that the vehicle's hulls displace when fully under water [kg]."""
    net_weight: float
    """Weight less greatest buoyancy [N]: positive sinks, negative floats."""
    peak_draft: float
    """Greatest depth of the lowest point [m]."""
    final_draft: float
    """Depth of the lowest point at the end [m]."""
    cog_z_range: float
    """Highest less lowest z of the centre of gravity over the last 2 s [m]."""
    simulated_time: float
    """Simulated time [s]."""
    wall_time: float
    """Time that the run took [s], with whatever was done with its frames."""
    real_time_factor: float
    """Simulated over wall time."""
    contact_steps: int
    """Number of steps in which the vehicle touched the bottom or another fixed thing."""
    first_contact: float | None
    """Time of the first touch [s]; None without one."""

    def rows(self) -> list[tuple[str, str]]:
        """The summary as a table: names, and values with units."""
        verdict = "sinks" if self.net_weight > 0.0 else "floats"
        contact = (
            f"{self.contact_steps} steps, first at {self.first_contact:.2f} s"
            if self.contact_steps
            else "none"
        )
        return [
            ("method", self.method),
            ("mass", f"{self.mass:.3f} kg"),
            ("displacement, fully under water", f"{self.displacement:.3f} kg"),
            ("net weight, fully under water", f"{self.net_weight:+.2f} N ({verdict})"),
            ("peak draft", f"{self.peak_draft:.3f} m"),
            ("final draft", f"{self.final_draft:.3f} m"),
            (f"CoG z range, last {LAST:g} s", f"{self.cog_z_range:.4f} m"),
            ("simulated time", f"{self.simulated_time:.2f} s"),
            ("real-time factor", f"{self.real_time_factor:.1f} x"),
            ("contact with the bottom or walls", contact),
        ]
