"""The packets that ArduPilot sends to a physics backend, and the lines that it wants back.

The format is that of ArduPilot's JSON interface (libraries/SITL/examples/JSON/readme.md of
ArduPilot, read in its version of 2025).
"""

import struct
from typing import NamedTuple

from buoyancy_mj.autopilot.readings import Reading

NEUTRAL = 1500
"""Pulse at which a motor stands still [us]; a channel without output sends 0, and means this."""
CHANNELS = 32
"""The most channels that a packet has."""
_LAYOUTS = {
    18458: struct.Struct("<HHI16H"),
    29569: struct.Struct("<HHI32H"),
}
"""Layout of a packet by its first number: that number, frame rate, frame count, pulses."""
_MAGIC = struct.Struct("<H")
LARGEST = max(layout.size for layout in _LAYOUTS.values())
"""Size of the largest packet [bytes]."""


class Servos(NamedTuple):
    """What an autopilot asks for in one frame."""

    rate: int
    """Number of frames in a second [Hz]."""
    frame: int
    """Number of the frame since the autopilot started."""
    pulses: tuple[int, ...]
    """Pulse of each channel (16,) or (32,) [us], 0 for a channel without output."""


def parse_servos(packet: bytes | memoryview) -> Servos | None:
    """Read a packet; None if it is no packet of servos."""
    if len(packet) < _MAGIC.size:
        return None
    layout = _LAYOUTS.get(_MAGIC.unpack_from(packet)[0])
    if layout is None or len(packet) != layout.size:
        return None
    _, rate, frame, *pulses = layout.unpack(packet)
    return Servos(rate, frame, tuple(pulses)) if rate > 0 else None


def write_answer(reading: Reading) -> bytes:
    """A reading as the line of JSON that ArduPilot's parser takes.

    The parser looks for names and reads numbers right behind them, so nothing stands between. The
    line begins and ends with a line break. Numbers have all their digits: the autopilot takes the
    time step from the difference of two timestamps, and cuts its rate down to whole hertz.
    """
    extras = "".join(
        f',"rng_{i}":{distance!r}' for i, distance in enumerate(reading.distances, start=1)
    )
    if reading.battery is not None:
        voltage, current = reading.battery
        extras += f',"battery":{{"voltage":{voltage!r},"current":{current!r}}}'
    line = (
        f'\n{{"timestamp":{reading.time!r},'
        f'"imu":{{"gyro":{_list(reading.gyro)},"accel_body":{_list(reading.specific_force)}}},'
        f'"position":{_list(reading.position)},"quaternion":{_list(reading.attitude)},'
        f'"velocity":{_list(reading.velocity)}{extras}}}\n'
    )
    return line.encode("ascii")


def _list(numbers: tuple[float, ...]) -> str:
    """Numbers as a list of JSON without a space."""
    return f"[{','.join(map(repr, numbers))}]"
