"""`Track`: where a vehicle was, sample by sample, and its motions in the axes of its heading."""

from collections.abc import Sequence
from typing import NamedTuple

import mujoco
import numpy as np
import scipy
from numpy.typing import NDArray

from buoyancy_mj.statics.heading_axes import rotate_to_heading

MOTIONS = ("surge", "sway", "heave", "roll", "pitch", "yaw")
"""The motions of the centre of gravity, in the order of matrices (6, 6)."""


class Track(NamedTuple):
    """Samples of a run, one after the other."""

    times: NDArray[np.float64]
    """Times (n,) [s]."""
    positions: NDArray[np.float64]
    """Origin of the root body (n, 3) [m], world frame."""
    quaternions: NDArray[np.float64]
    """Its attitude world_from_body (n, 4), scalar first."""
    sensors: NDArray[np.float64]
    """Values of the sensors that are read (n, s)."""

    @property
    def headings(self) -> NDArray[np.float64]:
        """Direction of the root body's x axis about the vertical (n,) [rad], without jumps."""
        w, x, y, z = self.quaternions.T
        return np.unwrap(np.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)))

    def motions(
        self, centre: NDArray[np.float64], points: Sequence[Sequence[float]] = ()
    ) -> NDArray[np.float64]:
        """Motions about the mean pose of these samples, in horizontal axes along its heading.

        Args:
            centre: where the six motions are told, in the frame of the root body (3,) [m].
            points: other points fixed to the root body (p, 3) [m].

        Returns:
            Surge, sway and heave [m] of the centre, roll, pitch and yaw [rad], the motions along x,
            y and z of each point [m], and the sensors as they are (n, 6 + 3 p + s).
        """
        Rotation = scipy.spatial.transform.Rotation
        attitudes = Rotation.from_quat(self.quaternions, scalar_first=True)
        axes = rotate_to_heading(float(self.headings.mean()))
        turns = (attitudes * attitudes.mean().inv()).as_rotvec() @ axes.T
        moved = [
            (self.positions + attitudes.apply(np.asarray(point, float))) @ axes.T
            for point in (centre, *points)
        ]
        columns = [moved[0] - moved[0].mean(axis=0), turns, *moved[1:], self.sensors]
        return np.hstack(columns)


def join_tracks(tracks: Sequence[Track]) -> Track:
    """Tracks one after the other as one."""
    return Track(*(np.concatenate(parts) for parts in zip(*tracks, strict=True)))


class Reader:
    """Reads a track off the data of a run.

    Args:
        model: the model.
        root: index of the root body.
        columns: indices of the sensor values that are read.
    """

    def __init__(self, model: mujoco.MjModel, root: int, columns: Sequence[int] = ()) -> None:
        self._timestep = float(model.opt.timestep)
        self._root = root
        self._columns = list(columns)

    def start(self, count: int) -> Track:
        """Room for samples."""
        sizes = ((count,), (count, 3), (count, 4), (count, len(self._columns)))
        return Track(*(np.empty(size) for size in sizes))

    def read(self, data: mujoco.MjData, track: Track, row: int) -> None:
        """Read a sample: a step leaves the poses and the sensors of its beginning."""
        track.times[row] = data.time - self._timestep
        track.positions[row] = data.xpos[self._root]
        track.quaternions[row] = data.xquat[self._root]
        if self._columns:
            track.sensors[row] = data.sensordata[self._columns]
