"""`Mount`: where a sensor is and how it samples; what it holds stands in the engine's state.

A sensor measures into `Mount.truth`, NaN for what it does not find. From that a sample is made, and
it is held until the next.
"""

import math
from typing import Annotated, NamedTuple

import numpy as np

from buoyancy_mj.kernels.arrays import Doubles
from buoyancy_mj.kernels.compiling import inner, njit
from buoyancy_mj.kernels.vehicle.sensors.noise import draw_normal

STREAM, TAKEN, SAMPLE, TIME, HELD = range(5)
"""States of a sensor: the user's number of the noise stream; 1 once there is a sample; its number;
when it was taken [s]; and from here on what it reads."""


class Mount(NamedTuple):
    """Where a sensor is, and how it samples."""

    site: int
    """Index of its site."""
    body: int
    """Index of the site's body."""
    address: int
    """Index of its first number in `sensordata`."""
    state: int
    """Index of its first state in `plugin_state`."""
    sensor: int
    """Its index."""
    seed: int
    """Of its noise."""
    rate: float
    """Samples per second [Hz]; 0 for one in each step."""
    noise: Annotated[Doubles, ("n",)]
    """Standard deviation of each of its numbers."""
    bias: Annotated[Doubles, ("n",)]
    """What is added to each."""
    lost: Annotated[Doubles, ("n",)]
    """What each reads where there is nothing to read."""
    truth: Annotated[Doubles, ("n",)]
    """What it measures, without noise; NaN for nothing."""


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def find_sample(mount, equipment):
    """The number of the sample that is due; each falls on the step nearest to its time."""
    timestep = equipment.option.timestep
    period = 1.0 / mount.rate if mount.rate > 0.0 else timestep
    return np.int64(math.floor((equipment.time + 0.5 * timestep) / period))


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def is_held(mount, equipment, sample):
    """Whether a sample was taken before; one that was taken at this very time is taken anew."""
    held = equipment.sensing.plugin_state[mount.state : mount.state + HELD]
    return held[TAKEN] != 0.0 and held[SAMPLE] == sample and held[TIME] != equipment.time


@inner
def hold_sample(mount, equipment):
    """Read what the last sample read."""
    state, data = equipment.sensing.plugin_state, equipment.sensing.sensordata
    for n in range(mount.truth.shape[0]):
        data[mount.address + n] = state[mount.state + HELD + n]


@inner
def take_sample(mount, equipment, sample):
    """Read what was measured, with bias and noise, and hold it."""
    state, data = equipment.sensing.plugin_state, equipment.sensing.sensordata
    stream = np.int64(state[mount.state + STREAM])
    for n in range(mount.truth.shape[0]):
        reading = mount.truth[n]
        if math.isnan(reading):
            reading = mount.lost[n]
        else:
            reading += mount.bias[n]
            if mount.noise[n] > 0.0:
                normal = draw_normal(mount.seed, stream, mount.sensor, sample, n)
                reading += mount.noise[n] * normal
            # a range less than 0 would be taken for a lost one
            if mount.lost[n] < 0.0:
                reading = max(reading, 0.0)
        data[mount.address + n] = state[mount.state + HELD + n] = reading
    state[mount.state + TAKEN] = 1.0
    state[mount.state + SAMPLE] = sample
    state[mount.state + TIME] = equipment.time
