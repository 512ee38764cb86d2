"""`FrameSource`: frames of running data, which a look at them does not disturb."""

from collections.abc import Callable, Mapping

import mujoco
import numpy as np

from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.engine.c_functions import raise_causes
from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.scenes.monitor import Monitor
from buoyancy_mj.scenes.observer import Observer
from buoyancy_mj.scenes.trajectory import poses_of

_STATE = mujoco.mjtState.mjSTATE_INTEGRATION


class FrameSource:
    """Takes frames of a run, on data of its own: a pass over the running data would disturb them.

    Args:
        model: the model.
        buoyancy: the water that acts.
        vehicles: what floats, by name.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        buoyancy: Buoyancy,
        vehicles: Mapping[str, Vehicle],
    ) -> None:
        self.monitors = {
            name: Monitor(model, vehicle, buoyancy.water) for name, vehicle in vehicles.items()
        }
        """What the summary keeps of each vehicle, by its name."""
        self._observers = {
            name: Observer(model, vehicle, self.monitors[name], buoyancy.water)
            for name, vehicle in vehicles.items()
        }
        self._model, self._buoyancy = model, buoyancy
        self._state = np.empty(mujoco.mj_stateSize(model, _STATE))
        self.data = _make_data(model)
        """The data of the frames, which each frame overwrites."""

    def copy_state(self, data: mujoco.MjData) -> None:
        """Copy the state of running data to those of the frames."""
        mujoco.mj_getState(self._model, data, self._state, _STATE)
        mujoco.mj_setState(self._model, self.data, self._state, _STATE)

    def see(self, running: mujoco.MjData, forward: Callable[[mujoco.MjData], None]) -> None:
        """Let the monitors have the present of running data, without a frame.

        Args:
            running: the data.
            forward: as for `take`.
        """
        self.copy_state(running)
        forward(self.data)
        for monitor in self.monitors.values():
            monitor.add_poses(poses_of(self.data), float(self.data.time))

    def take(self, running: mujoco.MjData, forward: Callable[[mujoco.MjData], None]) -> Frame:
        """The present of running data: poses and loads at exactly its time.

        Args:
            running: the data.
            forward: makes a pass over the data of the frames, with the water at work; what it
                raises ends the frame.
        """
        self.see(running, forward)
        data = self.data
        now = float(data.time)
        loads = self._buoyancy.loads(data)
        return Frame(
            time=now,
            data=data,
            loads=loads,
            vehicles={
                name: observer.observe(data, loads) for name, observer in self._observers.items()
            },
        )


def _make_data(model: mujoco.MjModel) -> mujoco.MjData:
    """Data of a model, whose plugins may refuse it."""
    with raise_causes():
        return mujoco.MjData(model)
