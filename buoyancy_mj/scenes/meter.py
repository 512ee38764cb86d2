"""`Meter`: measures how a vehicle moves, from its poses step by step."""

import math

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.kernels.drafts import Corners
from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.scenes.seakeeping import Seakeeping, Spread
from buoyancy_mj.scenes.stations import find_stations
from buoyancy_mj.scenes.tally import Tally
from buoyancy_mj.scenes.trajectory import Poses
from buoyancy_mj.scenes.windows import Beat
from buoyancy_mj.sea.water import Water

SLAM = 0.093
"""Least speed of a slam over sqrt(g L): Ochi, "Prediction of occurrence and severity of ship
slamming at sea", 5th Symposium on Naval Hydrodynamics (1964)."""
_SURGE, _X, _Y, _Z, _ROLL, _PITCH, _AX, _AY, _AZ, _WET, _COUNT = range(11)
"""Rows of what is tallied."""


class Meter:
    """Measures how a vehicle moves.

    Args:
        model: the model.
        data: its poses at the start.
        vehicle: the vehicle.
        corners: the corners of its hulls.
        water: the sea.
        beat: parts of the run, of which the window is made.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        vehicle: Vehicle,
        corners: Corners,
        water: Water,
        beat: Beat,
    ) -> None:
        self._vehicle, self._water = vehicle, water
        self._timestep = float(model.opt.timestep)
        self._stations = find_stations(model, data, vehicle, corners)
        self._tally = Tally(beat, _COUNT, [_SURGE])

        # what the last samples leave for the next
        self._centres = np.zeros((3, 0))
        self._angles = np.zeros((2, 0))
        self._surge = 0.0
        self._keel: NDArray[np.float64] | None = None

        # peaks of the whole run
        self._peak_acceleration = self._peak_load = 0.0
        self._slams, self._slammed = 0, -math.inf

    def add(self, times: NDArray[np.float64], poses: Poses) -> None:
        """Add the poses (n, nbody, ...) at the beginning of steps, at times (n,) [s]."""
        values, heights = self._take(times, poses)
        self._tally.add(times, values)

        # slams
        keel = heights[self._stations.decks :]
        keel = np.hstack([keel[:, :1] if self._keel is None else self._keel, keel])
        falls = (keel[:, :-1] - keel[:, 1:]) / self._timestep
        least = SLAM * math.sqrt(self._vehicle.gravity * self._stations.length)
        hits = (keel[:, :-1] > 0.0) & (keel[:, 1:] <= 0.0) & (falls >= least)
        for step in np.flatnonzero(hits.any(axis=0)):
            self._count_slam(float(times[step]))

        # what is left for the next
        self._keel = keel[:, -1:]
        self._peak_acceleration, self._peak_load = self._find_peaks(values)
        self._surge = float(values[_SURGE, -1])

    @property
    def height(self) -> float:
        """Height of the vehicle's hulls [m]."""
        return self._stations.height

    def measure(self, now: float, poses: Poses | None = None) -> Seakeeping:
        """How the vehicle has moved so far; NaN if no step was taken.

        Args:
            now: the present [s].
            poses: poses (nbody, ...) at the present, if they are known.
        """
        last = None
        peaks = self._peak_acceleration, self._peak_load
        if poses is not None and self._centres.size:
            kept = self._centres, self._angles
            values, _ = self._take(np.array([now]), Poses(*(array[None] for array in poses)))
            self._centres, self._angles = kept
            last, peaks = values[:, 0], self._find_peaks(values)
        told = self._tally.measure(now, last)
        weight = self._vehicle.mass * self._vehicle.gravity
        ranges, rms = told.most - told.least, told.rms

        def spread(row: int) -> Spread:
            return Spread(float(ranges[row]), float(rms[row]))

        return Seakeeping(
            window=told.window,
            heave=spread(_Z),
            roll=spread(_ROLL),
            pitch=spread(_PITCH),
            surge=spread(_SURGE),
            drift=(float(told.rate[_X]), float(told.rate[_Y])),
            vertical_acceleration=spread(_AZ),
            horizontal_acceleration_rms=math.hypot(rms[_AX], rms[_AY]),
            deck_wetness=float(told.mean[_WET]),
            peak_acceleration=peaks[0],
            peak_load=peaks[1],
            load_factor=peaks[1] / weight,
            slams=self._slams,
        )

    def _take(
        self, times: NDArray[np.float64], poses: Poses
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """What is tallied (q, n), and heights of the stations over the water (k, n) [m]."""
        vehicle, count = self._vehicle, len(times)
        values = np.empty((_COUNT, count))

        # the centre of gravity; a second difference is the acceleration of the step before
        shares = vehicle.masses / vehicle.mass
        centres = values[_X : _Z + 1]
        centres[:] = np.einsum("b,nbk->kn", shares, poses.xipos[:, vehicle.bodies])
        known = np.hstack([self._centres, centres])
        moved = np.diff(known)
        accelerations = np.diff(moved) / self._timestep**2
        late = count - accelerations.shape[1]
        values[_AX : _AZ + 1, late:] = accelerations
        values[_AX : _AZ + 1, :late] = accelerations[:, :1] if accelerations.size else 0.0

        # angles, which go on beyond a turn
        r = poses.xmat[:, vehicle.root].T
        angles = np.stack([np.arctan2(r[7], r[8]), -np.arcsin(r[6].clip(-1.0, 1.0))])
        angles = np.hstack([self._angles, angles])
        if np.abs(np.diff(angles)).max(initial=0.0) > math.pi:
            angles = np.unwrap(angles)
        values[_ROLL : _PITCH + 1] = angles[:, -count:]

        # surge: the way along the heading
        moved = moved[:2, -count:]
        late = count - moved.shape[1]
        ahead, aside = r[0, late:], r[3, late:]
        ways = (moved[0] * ahead + moved[1] * aside) / np.maximum(np.hypot(ahead, aside), 1e-9)
        values[_SURGE, :late] = self._surge
        values[_SURGE, late:] = self._surge + np.cumsum(ways)

        # the water at the stations
        x, y, z = np.moveaxis(self._stations.locate(poses), 1, 0)
        heights: NDArray[np.float64] = z - self._water.elevation(x, y, times)
        values[_WET] = heights[: self._stations.decks].min(axis=0) < 0.0
        self._centres, self._angles = known[:, -2:], angles[:, -1:]
        return values, heights

    def _find_peaks(self, values: NDArray[np.float64]) -> tuple[float, float]:
        """Greatest acceleration [m/s^2] and load [N] so far, with these."""
        ax, ay, az = values[_AX : _AZ + 1]
        level = ax * ax + ay * ay
        fastest = math.sqrt((level + az * az).max())
        load = self._vehicle.mass * math.sqrt((level + (az + self._vehicle.gravity) ** 2).max())
        return max(self._peak_acceleration, fastest), max(self._peak_load, load)

    def _count_slam(self, time: float) -> None:
        """Count a slam at a time [s], but not that of the other side of the same bow."""
        if time - self._slammed > math.sqrt(self._stations.length / self._vehicle.gravity):
            self._slams += 1
        self._slammed = time
