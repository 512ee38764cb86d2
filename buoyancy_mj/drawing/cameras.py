"""Cameras that keep the vehicles in their picture, and those that a model brings."""

import math
from typing import Protocol

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.drawing.shots import Shot, look_at, shot_of_camera
from buoyancy_mj.drawing.sight import clear_sight
from buoyancy_mj.drawing.subject import Subject
from buoyancy_mj.errors import DrawingError, choices
from buoyancy_mj.sea.water import Water

FOLLOW, ORBIT, UNDER = "follow", "orbit", "under"
"""Names of the cameras that every film has."""
FOVY = math.radians(36.0)
"""Angle from top to bottom of their pictures [rad]."""
BEARING = math.radians(-50.0)
"""Where they stand, from where the vehicle points [rad]: off its starboard bow."""
TURN = 24.0
"""Time in which `orbit` goes round [s]."""
ROOM = 0.65
"""Part of the distance from a third to the edge of the picture that vehicles fill."""
RISE, FALL = 0.21, -0.35
"""Height of the camera over the vehicles, over its distance: as usual, and for `under`."""
FLAT = 4.0
"""Distance of the camera over the height from a trough to where it stands, at least."""
LAG = 0.4
"""Time by which the camera follows the vehicles late [s]."""
SLACK = 0.25
"""Most that it lags behind, over the reach of the vehicles."""


class Camera(Protocol):
    """Anything that tells where the camera is in each frame."""

    def aim(self, data: mujoco.MjData) -> Shot:
        """What the camera sees; frames are given in their order.

        Args:
            data: poses, as mj_forward left them.
        """
        ...


def find_camera(
    name: str, model: mujoco.MjModel, subject: Subject, water: Water, aspect: float
) -> Camera:
    """The camera of a name: `FOLLOW`, `ORBIT`, `UNDER`, or one of the model.

    Raises:
        DrawingError: there is none, and the message names those that are; or it is orthographic.
    """
    if name in (FOLLOW, ORBIT, UNDER):
        return Follower(name, model, subject, water, aspect)
    names = [str(model.camera(index).name) for index in range(model.ncam)]
    if name not in names:
        possible = [FOLLOW, ORBIT, UNDER, *filter(None, names)]
        raise DrawingError(f"there is no camera '{name}'; {choices(name, possible)}")
    index = names.index(name)
    if model.cam_projection[index] != mujoco.mjtProjection.mjPROJ_PERSPECTIVE:
        raise DrawingError(
            f"camera '{name}' is orthographic, and films are in perspective; leave out its "
            f"projection, or take {FOLLOW}, {ORBIT} or {UNDER}"
        )
    return FixedCamera(model, index)


class FixedCamera:
    """A camera that the model has.

    Args:
        model: the model.
        index: which of its cameras.
    """

    def __init__(self, model: mujoco.MjModel, index: int) -> None:
        self._model, self._index = model, index

    def aim(self, data: mujoco.MjData) -> Shot:
        """What the camera sees; see `Camera.aim`."""
        return shot_of_camera(self._model, data, self._index)


class Follower:
    """A level camera that goes along with the vehicles, over the water or in it.

    It is over the water while they are near the surface, and dives after them.

    Args:
        name: `FOLLOW`, `ORBIT` which goes round them, or `UNDER` which is always under water.
        model: the model, whose walls and floors are not to hide them.
        subject: the vehicles.
        water: the sea.
        aspect: width of the picture over its height.
    """

    def __init__(
        self, name: str, model: mujoco.MjModel, subject: Subject, water: Water, aspect: float
    ) -> None:
        self._name, self._model, self._subject = name, model, subject
        self._water, self._aspect = water, aspect
        self._middle: NDArray[np.float64] | None = None
        self._time = 0.0
        self._is_below = name == UNDER
        amplitudes = water.rows[:, 0]
        # a crest higher than two standard deviations is rare
        self._crest = float(
            min(np.abs(amplitudes).sum(), 2.0 * math.sqrt(0.5 * (amplitudes**2).sum()))
        )

    def aim(self, data: mujoco.MjData) -> Shot:
        """What the camera sees; see `Camera.aim`."""
        along, up = self._subject.measure(data)
        middle = self._follow(self._subject.locate(data), float(data.time), SLACK * min(along, up))
        half = math.tan(0.5 * FOVY)
        # seen from a little above, what is far stands higher in the picture
        distance = max(
            along / (ROOM * self._aspect * half) + along, (up + RISE * along) / (ROOM * half)
        )
        if self._name != UNDER:
            self._choose_side(middle, up)
        if not self._is_below:
            # over crests and into troughs, with the horizon still in the picture
            distance = max(distance, FLAT * 3.0 * self._crest)

        turn = 2.0 * math.pi * self._time / TURN if self._name == ORBIT else 0.0
        bearing = self._subject.heading + BEARING + turn
        eye = middle + distance * np.array([math.cos(bearing), math.sin(bearing), 0.0])
        eye[2] = self._height(middle, distance, up)
        eye = clear_sight(self._model, data, middle, eye)
        return look_at(eye, middle, FOVY, self._place(), self._aspect)

    def _follow(
        self, middle: NDArray[np.float64], time: float, slack: float
    ) -> NDArray[np.float64]:
        """The middle of the vehicles (3,) [m], without haste."""
        if self._middle is None:
            self._middle = middle
        else:
            part = -math.expm1(-(time - self._time) / LAG)
            self._middle = self._middle + part * (middle - self._middle)
            behind = self._middle - middle
            self._middle = middle + behind * min(
                1.0, slack / max(float(np.linalg.norm(behind)), 1e-9)
            )
        self._time = time
        return self._middle

    def _choose_side(self, middle: NDArray[np.float64], up: float) -> None:
        """Dive when the vehicles are well under water, and come up when they come up."""
        depth = self._water.level - middle[2]
        dives, rises = 1.4 * up + self._crest, 1.1 * up + 0.6 * self._crest
        self._is_below = depth > (rises if self._is_below else dives)

    def _height(self, middle: NDArray[np.float64], distance: float, up: float) -> float:
        """Height of the camera [m], clear of the waves."""
        level, clear = self._water.level, 1.8 * self._crest + 0.2 * up
        if not self._is_below:
            return max(float(middle[2]) + RISE * distance, level + clear)
        rise = FALL if self._name == UNDER else 0.5 * RISE
        return min(float(middle[2]) + rise * distance, level - clear)

    def _place(self) -> tuple[float, float]:
        """Where in the picture the vehicles are: one in the third from which it comes."""
        across = -1.0 / 3.0 if self._subject.count == 1 else 0.0
        if self._name == UNDER:
            return across, 0.1
        return across, -0.15 if self._is_below else -1.0 / 3.0
