"""`Lockstep`: what a packet means by its place in the count of frames, and the time it asks for."""

import enum

from buoyancy_mj.errors import AutopilotError

TOLERANCE = 1e-3
"""Relative error of a step that is taken for none: rates are whole numbers, timesteps are not."""


class Turn(enum.Enum):
    """What a packet asks for."""

    NEXT = "next"
    """The next step."""
    REPEATED = "repeated"
    """The last answer again."""
    RESTARTED = "restarted"
    """A new start: its count fell back."""


class Lockstep:
    """Counts the frames of an autopilot.

    Args:
        timestep: the model's timestep [s].
        rate: number of steps in a second [Hz], whatever rate the packets name; None for theirs.

    Raises:
        AutopilotError: the timestep does not divide a step of that rate.
    """

    def __init__(self, timestep: float, rate: float | None = None) -> None:
        self.lost = 0
        """Frames that never came."""
        self.repeated = 0
        """Packets that came again."""
        self._timestep = timestep
        self._fixed = None if rate is None else find_substeps(rate, timestep)
        self._substeps: dict[int, int] = {}
        self._last: int | None = None

    def take(self, frame: int) -> Turn:
        """Take the packet of a frame."""
        last = self._last
        if last is not None and frame == last:
            self.repeated += 1
            return Turn.REPEATED
        if last is not None and frame < last:
            return Turn.RESTARTED
        self.lost += 0 if last is None else frame - last - 1
        self._last = frame
        return Turn.NEXT

    def substeps(self, rate: int) -> int:
        """Number of timesteps for a frame of a rate [Hz].

        Raises:
            AutopilotError: the timestep does not divide the time of a frame.
        """
        if self._fixed is not None:
            return self._fixed
        if rate not in self._substeps:
            self._substeps[rate] = find_substeps(rate, self._timestep)
        return self._substeps[rate]


def find_substeps(rate: float, timestep: float) -> int:
    """Number of timesteps [s] in one step of a rate [Hz].

    Raises:
        AutopilotError: it is no whole number.
    """
    exact = 1.0 / (rate * timestep)
    whole = max(1, round(exact))
    if abs(exact - whole) > TOLERANCE * whole:
        raise AutopilotError(
            f"the autopilot asks for {rate:g} frames in a second, and the timestep of "
            f"{timestep:g} s does not divide them; give --rate {rate:g}, or set the scene's "
            "timestep to a whole part of a frame"
        )
    return whole


def fit_timestep(rate: float, timestep: float) -> float:
    """The greatest timestep [s], no longer than another, that divides a step of a rate [Hz]."""
    step = 1.0 / rate
    # what is longer by rounding alone is as long
    parts = max(1, -int(-(step / timestep - TOLERANCE) // 1))
    return step / parts
