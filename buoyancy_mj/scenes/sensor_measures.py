"""`SensorMeter`: what sensors measured over the window of a run."""

from collections.abc import Sequence
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import SceneError, choices, describe
from buoyancy_mj.scenes.tally import Tally
from buoyancy_mj.scenes.windows import Beat
from buoyancy_mj.vehicle.instruments.instruments import SENSOR, Instruments


class SensorMeasure(NamedTuple):
    """One number of a sensor over the window of a run, in its unit."""

    mean: float
    """Mean."""
    least: float
    """Least."""
    greatest: float
    """Greatest."""
    range: float
    """Greatest less least."""
    rms: float
    """Root of the mean square about the mean."""


class SensorMeter:
    """Measures what sensors show, step by step.

    Args:
        model: the model.
        names: names of sensors, or of one number of a sensor, as 'gyro' or 'gyro.x'.
        beat: parts of the run, of which the window is made.

    Raises:
        SceneError: there is no such sensor.
    """

    def __init__(self, model: mujoco.MjModel, names: Sequence[str], beat: Beat) -> None:
        self.channels = find_channels(model, names)
        """Index in `data.sensordata` of each number that is measured, by its name."""
        self._columns = np.array(list(self.channels.values()), np.int64)
        self._tally = Tally(beat, len(self._columns))

    def add(self, times: NDArray[np.float64], sensors: NDArray[np.float64]) -> None:
        """Add the readings (n, nsensordata) of steps that begin at times (n,) [s]."""
        self._tally.add(times, sensors.T[self._columns])

    def measure(self, now: float) -> dict[str, SensorMeasure]:
        """What was measured so far, by the name of the number; the present is `now` [s]."""
        told = self._tally.measure(now)
        columns = np.stack([told.mean, told.least, told.most, told.most - told.least, told.rms])
        return {
            name: SensorMeasure(*column)
            for name, column in zip(self.channels, columns.T.tolist(), strict=True)
        }


def find_channels(model: mujoco.MjModel, names: Sequence[str]) -> dict[str, int]:
    """Find the numbers of sensors in `data.sensordata`, by their names.

    Raises:
        SceneError: a name is of no sensor.
    """
    channels = [one for one in Instruments(model).channels if one.kind == SENSOR]
    found: dict[str, int] = {}
    for name in names:
        own = {one.name: i for i, one in enumerate(channels) if name in (one.owner, one.name)}
        if not own:
            sensors = list(dict.fromkeys(one.owner for one in channels))
            possible = choices(name, sensors) if sensors else "the model has no sensor"
            raise SceneError(f"there is no sensor {describe(name)} to measure; {possible}")
        found |= own
    return found
