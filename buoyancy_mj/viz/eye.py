"""`Eye`: where one looks from in a recording: over the water or in it, along with the vehicles."""

import math

import mujoco
import numpy as np
import rerun as rr
from numpy.typing import NDArray

from buoyancy_mj.drawing.sea_mesh import HORIZON
from buoyancy_mj.drawing.sight import clear_sight
from buoyancy_mj.drawing.subject import Subject
from buoyancy_mj.scenes.run import Run
from buoyancy_mj.sea.water import Water
from buoyancy_mj.viz.log import Log

ENTITY = "world/eye"
"""The entity that the view follows: a camera."""
FOVY = math.radians(55.0)
"""Angle that the viewer's eye takes from top to bottom [rad]."""
ASPECT = 1.4
"""Width of the view over its height, about."""
ROOM = 0.68, 0.85
"""Part of the picture that vehicles fill, from top to bottom and across."""
PITCH = math.radians(14.0), math.radians(10.0)
"""Angle by which the eye stands higher than what it looks at [rad]: over water, and in it."""
BEARINGS = np.radians([-70.0, 70.0, -110.0, 110.0, -20.0, 160.0])
"""Where it may stand, from where the vehicle points [rad]; the first with a clear sight is taken.
From the side, since vehicles go ahead: a wall that they come to stays out of the way."""
LAG = np.array([0.4, 0.4, 3.0])
"""Times by which the eye follows late [s], along x, y and z: heave shows against the horizon."""
STEEPEST = math.radians(21.0)
"""Most of that angle; where waves are high the eye goes farther away."""
WIDE = 60.0
"""Least distance of the horizon over that of the eye."""
SINK = 0.7
"""How far vehicles sink under the middle of the picture, over their reach, before the eye does."""
SLACK = 0.4
"""Most that it lags behind, over the reach of the vehicles."""


class Eye:
    """The eye of a recording's view of the world.

    A camera goes along with the vehicle. It draws back as several of them part, so that all stay in
    the picture. (Rerun's own eye could track the vehicle itself, and one could turn about it as it
    goes on. But in a browser it is often put far outside of the world at first.)

    Args:
        run: the run.
        start: its data with the poses at the start.
    """

    def __init__(self, run: Run, start: mujoco.MjData) -> None:
        water = run.buoyancy.water
        subject = Subject(run.model, run.vehicles.values(), start)
        along, up = subject.measure(start)
        self._several = subject.count > 1
        self.middle = subject.locate(start)
        """What it looks at (3,) [m]."""
        self.reach = max(along, up)
        """How far the vehicles reach from there at the start [m]."""
        self.distance = find_distance(along, up)
        """How far it is from there [m]."""
        self.horizon = max(HORIZON, WIDE * self.distance)
        """How far it sees [m]."""
        self.level = water.level
        """Height of the still surface [m]."""
        self.crest = measure_crest(water)
        """How high crests are, but for rare ones [m]."""

        # the side, whence nothing hides the vehicles
        rise = self._find_rise(up)
        # waves are not looked at from far above, so that the horizon stays in the picture
        self.distance = max(self.distance, rise / math.sin(STEEPEST))
        flat = math.sqrt(max(self.distance**2 - rise**2, 0.0))
        headings = subject.heading + BEARINGS
        offsets = np.column_stack(
            [flat * np.cos(headings), flat * np.sin(headings), np.full(len(headings), rise)]
        )
        seen = np.array(
            [clear_sight(run.model, start, self.middle, self.middle + one) for one in offsets]
        )
        free = np.linalg.norm(seen - self.middle, axis=1)
        best = int(np.argmax(np.round(free / self.distance, 3)))
        self._away = offsets[best] / np.linalg.norm(offsets[best])
        if not self._several:
            self.distance = float(free[best])
        self._turn = _look_along(-self._away)
        self._time: float | None = None
        self._step, self._left = 0.0, np.ones(3)
        self._slack = SLACK * min(along, up)
        self._room = SINK * up
        is_above = self.position[2] > self.level
        self._lowest = (
            self.level + self._clear(up) - float(self.offset[2]) if is_above else -math.inf
        )
        self._alone = 0.5 * max(vehicle.length for vehicle in run.vehicles.values())

    @property
    def offset(self) -> NDArray[np.float64]:
        """From what it looks at to the eye (3,) [m]."""
        offset: NDArray[np.float64] = self.distance * self._away
        return offset

    @property
    def position(self) -> NDArray[np.float64]:
        """Where it is (3,) [m]."""
        return self.middle + self.offset

    @property
    def is_below(self) -> bool:
        """Whether it is under water, as still water stands."""
        return bool(self.position[2] < self.level)

    def draw_static(self, log: Log) -> None:
        """Draw the camera, which nobody sees."""
        camera = rr.Pinhole(
            fov_y=FOVY, aspect_ratio=ASPECT, image_plane_distance=1e-3 * self.distance
        )
        log.keep(ENTITY, camera)

    def draw(self, log: Log, centres: NDArray[np.float64], time: float) -> None:
        """Follow the vehicles.

        Args:
            log: where to.
            centres: their centres of mass (n, 3) [m].
            time: [s].
        """
        low, high = centres.min(axis=0), centres.max(axis=0)
        self._follow(0.5 * (low + high), time)
        if self._several:
            # as far as it takes, and no nearer again
            half = 0.5 * (high - low)
            along = math.hypot(half[0], half[1]) + self._alone
            self.distance = max(self.distance, find_distance(along, half[2] + self._alone))
        log.draw(
            ENTITY, rr.Transform3D, translation=self.position[None], quaternion=self._turn[None]
        )

    def _follow(self, middle: NDArray[np.float64], time: float) -> None:
        """Go after what it looks at, late, but never so late that it leaves the picture."""
        if self._time is not None:
            if time - self._time != self._step:
                self._step = time - self._time
                self._left = np.exp(-self._step / LAG)
            behind = (self.middle - middle) * self._left
            far = math.sqrt(behind @ behind)
            late = middle + behind * min(1.0, self._slack / max(far, 1e-9))
            # over the waves while the vehicle is still in the picture, and then down after it
            late[2] = max(late[2], min(self._lowest, middle[2] + self._room))
            middle = late
        self.middle, self._time = middle, time

    def _clear(self, up: float) -> float:
        """How far from still water the eye is, so that waves pass it [m]."""
        return 1.5 * self.crest + 0.2 * up

    def _find_rise(self, up: float) -> float:
        """How much higher than what it looks at the eye stands [m], clear of the surface."""
        clear = self._clear(up)
        # what is dropped comes down
        depth = max(self.level - float(self.middle[2]), 0.0)
        if depth > 1.2 * up + self.crest:
            return min(self.distance * math.sin(PITCH[1]), depth - clear)
        return max(self.distance * math.sin(PITCH[0]), depth + clear)


def find_distance(along: float, up: float) -> float:
    """Distance [m] at which vehicles fill their room in the picture.

    Args:
        along: how far they reach along the ground from where one looks [m].
        up: how far they reach up and down [m].
    """
    half = math.tan(0.5 * FOVY)
    return max(along / (ROOM[1] * ASPECT * half) + 0.25 * along, up / (ROOM[0] * half))


def _look_along(forward: NDArray[np.float64]) -> NDArray[np.float64]:
    """The quaternion (4,), the scalar last, of a level camera that looks along a unit vector."""
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    turn = np.column_stack([right, np.cross(forward, right), forward])
    scalar_first = np.empty(4)
    mujoco.mju_mat2Quat(scalar_first, turn.ravel())
    return np.roll(scalar_first, -1)


def measure_crest(water: Water) -> float:
    """Height of crests [m]: of all waves at once, or two standard deviations, as more is rare."""
    amplitudes = water.rows[:, 0]
    return float(min(np.abs(amplitudes).sum(), 2.0 * math.sqrt(0.5 * (amplitudes**2).sum())))
