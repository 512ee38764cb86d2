"""`Device`: what compiled code knows of one thruster, tank or sensor of one mjData."""

from typing import Annotated, NamedTuple

from buoyancy_mj.kernels.arrays import Doubles, Words

ALIVE, MODEL, CHANGES, IDS = range(4)
"""Columns of `Device.ids`, and how many: whether the device is in use; the address of its mjModel;
and how often the waters that act had changed when its sea was looked up."""


class Device(NamedTuple):
    """What all devices have; the first field of the NamedTuple of each kind."""

    ids: Annotated[Words, (IDS,)]
    """In columns `ALIVE` to `CHANGES`."""
    compute: int
    """Address of the C function f(mjModel, mjData, device) that writes what the device does; it
    returns 0, or the address of a text that tells why it cannot."""
    advance: int
    """Address of such a function that runs before it, and writes rates of states; 0 for none."""
    offsets: int
    """Address of the byte offsets of `paths.PATHS`."""
    sea: int
    """Address of the table of a `Sea`: that of the water that acts on the device's body, or one
    without water."""
    readings: Annotated[Doubles, ("m",)]
    """What it leaves for others to read."""
    added: Annotated[Doubles, (3,)]
    """Torque [N m], world frame, that it has added to `qfrc_passive` since the engine last computed
    that."""
