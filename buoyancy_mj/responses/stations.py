"""`Station`: keeps a vehicle where it is and on its heading, without a part in its wave motions."""

import math

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.responses.subject import Subject

SOFTNESS = 10.0
"""Natural period of the station, in periods of the waves."""
DAMPING = 0.5
"""Its part of critical damping."""
TRIM = 0.15
"""How soon it takes up a steady pull, over its natural frequency."""
AFLOAT = 1e-9
"""Part of weight over length from which on a heave stiffness is one."""


class Station:
    """A soft mooring that feels the mean of the last wave period, and nothing that is faster.

    A mean over a whole period has no part of the wave's frequency, nor of its harmonics. So the
    spring and the damper act on drift and on turning away alone, and the motions in waves are those
    of a free vehicle. Its mark is the mean place over the first period, and the heading at the
    start; what pulls steadily it takes up in time. What no waterplane holds at its
    height is held there too, with its reserve of buoyancy taken up.

    Args:
        subject: what is held.
        period: over which the mean is taken [s].
        samples: number of samples in that period.
        softness: natural period over that period.
    """

    def __init__(
        self, subject: Subject, period: float, samples: int, softness: float = SOFTNESS
    ) -> None:
        at = subject.at_start
        self._root, self._centre = subject.root, subject.centre
        self._period, self._samples = period, samples
        inertia = np.diag(at.mass_matrix + subject.added_mass)
        omega = 2.0 * math.pi / (softness * period)
        self._stiffness = omega**2 * inertia[[0, 1, 2, 5]]
        self._damping = 2.0 * DAMPING * omega * inertia[[0, 1, 2, 5]]
        self._trim = TRIM * omega * self._stiffness * period / samples
        self._steady = np.zeros(4)

        # heave, only where water does not
        self.holds_depth = bool(
            at.stiffness[2, 2] <= AFLOAT * at.mass * at.gravity / subject.simulation.vehicle.length
        )
        self._lift = (at.mass - at.displacement) * at.gravity if self.holds_depth else 0.0
        if not self.holds_depth:
            self._stiffness[2] = self._damping[2] = self._trim[2] = 0.0
        self._heading = at.heading
        self._past = np.zeros((samples, 4))
        self._count = 0
        self._mark = np.zeros(4)

    def hold(self, data: mujoco.MjData) -> None:
        """Look where the vehicle is, and pull at it until the next sample."""
        rotation = data.xmat[self._root].reshape(3, 3)
        centre = data.xpos[self._root] + rotation @ self._centre
        heading = math.atan2(rotation[1, 0], rotation[0, 0])
        row = self._count % self._samples
        # without jumps
        last = self._past[row - 1, 3] if self._count else self._heading
        heading += 2.0 * math.pi * round((last - heading) / (2.0 * math.pi))
        now = np.array([*centre, heading])
        before = self._past[row].copy()
        self._past[row] = now
        self._count += 1

        force = np.zeros(4)
        if self._count >= self._samples:
            mean = self._past.mean(axis=0)
            if self._count == self._samples:
                self._mark = np.array([*mean[:3], self._heading])
            else:
                drift = (now - before) / self._period
                self._steady -= self._trim * (mean - self._mark)
                force = self._steady - self._stiffness * (mean - self._mark) - self._damping * drift
        force[2] += self._lift
        self._apply(data, force, centre)

    def _apply(
        self, data: mujoco.MjData, force: NDArray[np.float64], centre: NDArray[np.float64]
    ) -> None:
        """Act at the centre of gravity with a force and a moment about the vertical (4,)."""
        wrench = data.xfrc_applied[self._root]
        wrench[:3] = force[:3]
        wrench[3:] = np.cross(centre - data.xipos[self._root], force[:3])
        wrench[5] += force[3]
