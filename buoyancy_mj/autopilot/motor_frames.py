"""The frames of ArduPilot's vehicles: which channel drives a motor that does what.

A motor's factors say what a pulse above 1500 us does, in the axes of the autopilot: forward,
lateral to starboard, throttle up; roll to starboard, pitch bow up, yaw to starboard. Those of
submarines are the numbers that ArduSub mixes with (libraries/AP_Motors/AP_Motors6DOF.cpp, frames
of its parameter FRAME_CONFIG), for MOT_n_DIRECTION = 1, as SITL has them. Those of boats follow
from the outputs of Rover's frame `motorboat-skid`: SERVO1 is the left thruster, SERVO3 the right.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Motor(NamedTuple):
    """What an autopilot thinks that a pulse above neutral on a channel does."""

    channel: int
    """Number of the output channel, from 1."""
    roll: float = 0.0
    """Turn about the axis forward."""
    pitch: float = 0.0
    """Turn about the axis to starboard: bow up."""
    yaw: float = 0.0
    """Turn about the axis down: to starboard."""
    throttle: float = 0.0
    """Push upwards."""
    forward: float = 0.0
    """Push forward."""
    lateral: float = 0.0
    """Push to starboard."""

    @property
    def push(self) -> NDArray[np.float64]:
        """Direction of its push (3,), FRD."""
        return np.array([self.forward, self.lateral, -self.throttle])

    @property
    def turn(self) -> NDArray[np.float64]:
        """Turns that it brings about (3,), FRD."""
        return np.array([self.roll, self.pitch, self.yaw])


_HORIZONTAL = (
    Motor(1, yaw=1.0, forward=-1.0, lateral=1.0),
    Motor(2, yaw=-1.0, forward=-1.0, lateral=-1.0),
    Motor(3, yaw=-1.0, forward=1.0, lateral=1.0),
    Motor(4, yaw=1.0, forward=1.0, lateral=-1.0),
)
_SIMPLE = (
    Motor(1, yaw=-1.0, forward=1.0),
    Motor(2, yaw=1.0, forward=1.0),
    Motor(3, throttle=-1.0),
    Motor(4, throttle=-1.0),
    Motor(5, lateral=1.0),
)
CUSTOM = "custom"
"""The frame of which nothing is known: each channel is stated."""
MOTOR_FRAMES: Mapping[str, tuple[Motor, ...]] = {
    "bluerov1": (
        Motor(1, yaw=-1.0, forward=1.0),
        Motor(2, yaw=1.0, forward=1.0),
        Motor(3, roll=-0.5, pitch=0.5, throttle=0.45),
        Motor(4, roll=0.5, pitch=0.5, throttle=0.45),
        Motor(5, pitch=-1.0, throttle=1.0),
        Motor(6, roll=-0.25, lateral=1.0),
    ),
    "vectored": (
        *_HORIZONTAL,
        Motor(5, roll=1.0, throttle=-1.0),
        Motor(6, roll=-1.0, throttle=-1.0),
    ),
    "vectored_6dof": (
        *_HORIZONTAL,
        Motor(5, roll=1.0, pitch=-1.0, throttle=-1.0),
        Motor(6, roll=-1.0, pitch=-1.0, throttle=-1.0),
        Motor(7, roll=1.0, pitch=1.0, throttle=-1.0),
        Motor(8, roll=-1.0, pitch=1.0, throttle=-1.0),
    ),
    "vectored_6dof_90deg": (
        Motor(1, roll=1.0, pitch=1.0, throttle=1.0),
        Motor(2, yaw=1.0, forward=1.0),
        Motor(3, roll=1.0, pitch=-1.0, throttle=1.0),
        Motor(4, lateral=1.0),
        Motor(5, lateral=1.0),
        Motor(6, roll=-1.0, pitch=1.0, throttle=1.0),
        Motor(7, yaw=-1.0, forward=1.0),
        Motor(8, roll=-1.0, pitch=-1.0, throttle=1.0),
    ),
    "simplerov_3": _SIMPLE[:3],
    "simplerov_4": _SIMPLE[:4],
    "simplerov_5": _SIMPLE,
    "motorboat-skid": (
        Motor(1, yaw=1.0, forward=1.0),
        Motor(3, yaw=-1.0, forward=1.0),
    ),
    CUSTOM: (),
}
"""Motors of each frame by its name, as ArduPilot's documentation calls them."""
