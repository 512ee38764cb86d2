"""`Tape`: the poses and sensors that each step of a run leaves, handed on many at a time."""

from collections.abc import Callable

import mujoco
import numpy as np
from numpy.lib.stride_tricks import as_strided
from numpy.typing import NDArray

from buoyancy_mj.errors import EngineError
from buoyancy_mj.scenes.kinematics import Kinematics
from buoyancy_mj.scenes.trajectory import Poses

LENGTH = 1024
"""Number of steps that are handed on at once, at least."""

MOST_APART = 16
"""How far apart the arrays of poses are, over the size of the last, at most."""

Reader = Callable[[NDArray[np.float64], Poses, NDArray[np.float64]], None]
"""Takes times (n,) [s], poses (n, nbody, ...) and sensors (n, nsensordata) of steps."""


class Tape:
    """Keeps the poses at the beginning of each step, and what sensors measured in it.

    A step is kept by `keep(take())` after it, a hundredth of the cost of a cheap step.

    Args:
        model: the model.
        data: the data, which are stepped.
        reader: takes what was kept.
        kinematics: finds poses at coordinates, if steps do not leave those of their beginning.
        with_sensors: whether sensors are kept.

    Raises:
        EngineError: this MuJoCo is not as expected inside.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        reader: Reader,
        *,
        kinematics: Kinematics | None,
        with_sensors: bool,
    ) -> None:
        self._timestep, self._reader = float(model.opt.timestep), reader
        self._kinematics = kinematics
        self._qpos, self._before = data.qpos, b""

        # the engine has poses beside each other: one copy takes them all
        arrays = data.xpos, data.xmat, data.xipos
        self._shapes = [array.shape for array in arrays]
        places = [(array.ctypes.data - data.xpos.ctypes.data) // 8 for array in arrays]
        if places != sorted(places) or places[-1] > MOST_APART * data.xipos.size:
            raise EngineError("this MuJoCo keeps its poses apart; try version 4.0.0")
        self._spans = [
            slice(place, place + array.size) for place, array in zip(places, arrays, strict=True)
        ]
        width = self._spans[-1].stop
        poses = as_strided(data.xpos, (width,), (8,), writeable=False)
        # a view of memory is copied faster than an array
        take = poses.data.tobytes if kinematics is None else self._take_coordinates
        self._width = width if kinematics is None else model.nq

        # the tape
        self._kept: list[bytes] = []
        self._start = 0.0
        self.keep = self._kept.append
        """Keeps what was taken."""
        self.take: Callable[[], bytes] = take
        """Takes what a step has left."""
        if with_sensors:
            sensors = data.sensordata.data
            self.take = lambda: take() + sensors.tobytes()

    def wind(self, time: float) -> None:
        """Make ready for steps from a time [s] on; hand on what was kept if it is much."""
        if len(self._kept) >= LENGTH:
            self.flush()
        if not self._kept:
            self._start = time
        if self._kinematics is not None:
            self._before = self._qpos.tobytes()

    def flush(self) -> None:
        """Hand on what was kept."""
        count = len(self._kept)
        if not count:
            return
        kept = np.frombuffer(b"".join(self._kept)).reshape(count, -1)
        self._kept.clear()
        times = self._start + self._timestep * np.arange(count, dtype=np.float64)
        self._reader(times, self._read_poses(kept[:, : self._width]), kept[:, self._width :])

    def _take_coordinates(self) -> bytes:
        """The coordinates at the beginning of the step; those at its end are the next one's."""
        before, self._before = self._before, self._qpos.tobytes()
        return before

    def _read_poses(self, kept: NDArray[np.float64]) -> Poses:
        """The poses (n, nbody, ...) of what was kept (n, width)."""
        if self._kinematics is not None:
            return self._kinematics.find_poses(kept)
        return Poses(
            *(
                kept[:, span].reshape(len(kept), *shape)
                for span, shape in zip(self._spans, self._shapes, strict=True)
            )
        )
