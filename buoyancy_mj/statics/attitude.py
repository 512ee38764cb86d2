"""`Attitude`: a rotation as heading, trim and heel."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Attitude(NamedTuple):
    """Heading, trim and heel [rad]: turns about z, then y, then x of the body."""

    heading: float
    """Direction of the bow about the vertical [rad]; 0 where the bow points up or down."""
    trim: float
    """Pitch [rad], bow down."""
    heel: float
    """Roll [rad], port up."""

    @classmethod
    def from_matrix(cls, rotation: NDArray[np.float64]) -> "Attitude":
        """Read the attitude off a rotation world_from_vessel (3, 3)."""
        trim = -math.asin(max(-1.0, min(1.0, float(rotation[2, 0]))))

        # with the bow straight up or down, heading and heel are one angle: call all of it heel
        if math.hypot(rotation[1, 0], rotation[0, 0]) < 1e-9:
            return cls(0.0, trim, _find_heel(-rotation[1, 2], rotation[1, 1]))
        return cls(
            heading=math.atan2(rotation[1, 0], rotation[0, 0]),
            trim=trim,
            heel=_find_heel(rotation[2, 1], rotation[2, 2]),
        )

    def as_matrix(self) -> NDArray[np.float64]:
        """The rotation world_from_vessel (3, 3) with this attitude."""
        from scipy.spatial.transform import Rotation

        return np.asarray(Rotation.from_euler("ZYX", self).as_matrix(), float)


def _find_heel(sine: float, cosine: float) -> float:
    """The angle [rad] of a sine and a cosine; keel up is pi, and never minus pi by rounding."""
    heel = math.atan2(sine, cosine)
    return heel + 2.0 * math.pi if heel < 1e-6 - math.pi else heel
