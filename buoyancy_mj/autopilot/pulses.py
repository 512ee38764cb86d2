"""`PulseMap`: from the pulses of an autopilot to the controls of a model."""

from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.autopilot.channels import Channel
from buoyancy_mj.autopilot.packets import NEUTRAL
from buoyancy_mj.errors import AutopilotError

SPAN = 400.0
"""Pulse from neutral to either end [us]: ArduSub sends 1100 to 1900."""


class PulseMap:
    """Sets the controls of the actuators that an autopilot drives.

    A pulse of 1500 us is neutral. 1100 and 1900 us are the ends of the actuator's `ctrlrange`, and
    neutral lies at 0, or in the middle of a range without 0. So a motor from -40 to 51 N gets -40 N
    at 1100 us, and an actuator whose range is 1100 to 1900 gets the pulse itself.

    Args:
        model: the model.
        channels: what drives what.

    Raises:
        AutopilotError: an actuator has no range.
    """

    def __init__(self, model: mujoco.MjModel, channels: Sequence[Channel]) -> None:
        addresses = model.actuator_ctrladr[[channel.actuator for channel in channels]]
        for channel, address in zip(channels, addresses, strict=True):
            if not model.actuator_ctrllimited[address]:
                raise AutopilotError(
                    f"actuator '{channel.name}' has no ctrlrange, so nobody knows what a full "
                    "pulse means; give it one"
                )
        self.highest = max(channel.number for channel in channels)
        """Number of the last output that drives something."""
        self._indices = np.array([channel.number - 1 for channel in channels])
        self._addresses = addresses
        self._signs = np.array([channel.sign for channel in channels])
        low, high = model.actuator_ctrlrange[addresses].T
        self._neutral = np.where((low < 0.0) & (high > 0.0), 0.0, 0.5 * (low + high))
        self._ahead = high - self._neutral
        self._astern = self._neutral - low

    def apply(self, pulses: Sequence[int], ctrl: NDArray[np.float64]) -> None:
        """Set the controls for the pulses of all channels [us]; 0 means neutral.

        Args:
            pulses: at least as many as `highest`.
            ctrl: controls (nu,) of the model, changed in place.
        """
        widths = np.array(pulses, dtype=float)[self._indices]
        widths[widths == 0.0] = NEUTRAL
        throttle = self._signs * np.minimum(np.maximum((widths - NEUTRAL) / SPAN, -1.0), 1.0)
        scale = np.where(throttle > 0.0, self._ahead, self._astern)
        ctrl[self._addresses] = self._neutral + throttle * scale
