"""Added mass of props: that of slender rods and of balls, stated in the arena's MJCF."""

from collections.abc import Sequence
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

DENSITY = 1000.0
"""Density of the water in the pool [kg/m^3]."""


class Rod(NamedTuple):
    """A round rod, in the frame of its body."""

    start: tuple[float, float, float]
    """One end (3,) [m]."""
    end: tuple[float, float, float]
    """The other end (3,) [m]."""
    radius: float
    """Its radius [m]."""


def state_rods(spec: mujoco.MjSpec, body: str, rods: Sequence[Rod]) -> None:
    """State the added mass of a body of slender rods: across each, that of the water it displaces.

    It is that of a circle in potential flow, rho pi r^2 for each length, summed along the rods
    about the body's origin; J. N. Newman, Marine Hydrodynamics (1977), sections 4.13 and 7.2.

    Args:
        spec: the arena.
        body: name of the body.
        rods: its rods.
    """
    matrix = np.zeros((6, 6))
    for rod in rods:
        start, end = np.array(rod.start), np.array(rod.end)
        length = float(np.linalg.norm(end - start))
        way = (end - start) / length
        across = np.eye(3) - np.outer(way, way)

        # Simpson's rule is exact, since the integrand is quadratic
        for weight, share in ((1.0 / 6.0, 0.0), (4.0 / 6.0, 0.5), (1.0 / 6.0, 1.0)):
            x, y, z = start + share * (end - start)
            arm = np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])
            motion = np.hstack([np.eye(3), arm])
            mass = DENSITY * np.pi * rod.radius**2 * length
            matrix += weight * mass * motion.T @ across @ motion
    _state(spec, body, matrix.ravel())


def state_ball(spec: mujoco.MjSpec, body: str, radius: float) -> None:
    """State the added mass of a ball [m] in its middle: half the water that it displaces.

    Sir H. Lamb, Hydrodynamics, 6th edition (1932), article 92.
    """
    half = 0.5 * DENSITY * 4.0 / 3.0 * np.pi * radius**3
    _state(spec, body, np.array([half, half, half, 0.0, 0.0, 0.0]))


def _state(spec: mujoco.MjSpec, body: str, values: NDArray[np.float64]) -> None:
    """Write the added mass of a body, as the water of this package reads it."""
    spec.add_numeric(name=f"added_mass:{body}", data=values.tolist(), size=len(values))
