"""What the window and the simulation tell each other, which are two threads."""

import dataclasses

from mujoco.studio import messages

from buoyancy_mj.sea.water import Water
from buoyancy_mj.studio.readouts import Readout
from buoyancy_mj.studio.sea_state import SeaState
from buoyancy_mj.studio.skin_sea import SkinSea

# from the window


@dataclasses.dataclass(frozen=True)
class SeaSnapshot(messages.Snapshot):
    """The window asks for a sea; of several the last counts."""

    sea: SeaState
    """The sea."""


@dataclasses.dataclass(frozen=True)
class DropEvent(messages.Event):
    """The window wants a vehicle held over the sea and let go."""

    vehicle: str
    """Its name."""
    height: float
    """Between its lowest point and the surface [m]."""


@dataclasses.dataclass(frozen=True)
class RestEvent(messages.Event):
    """The window wants a vehicle put where it rests on still water."""

    vehicle: str
    """Its name."""


@dataclasses.dataclass(frozen=True)
class LeanEvent(messages.Event):
    """The window wants a vehicle turned about its centre of mass, and let go."""

    vehicle: str
    """Its name."""
    heel: float
    """Turn about the x axis of its root body [rad]."""
    trim: float
    """Turn about its y axis [rad]."""


@dataclasses.dataclass(frozen=True)
class LaunchEvent(messages.Event):
    """The window wants the dry model that it shows put into water."""


# from the simulation


@dataclasses.dataclass(frozen=True)
class AfloatEvent(messages.Event):
    """A scene is under way."""

    title: str
    """Its title."""
    sea: SeaState
    """Its water, in the numbers of the panel."""
    radius: float
    """Distance around what is looked at within which the sea is drawn exactly [m]."""
    skin: SkinSea | None
    """The sea as a part of the model that is shown; None where the window draws it."""


@dataclasses.dataclass(frozen=True)
class WaterEvent(messages.Event):
    """A water acts from now on."""

    water: Water
    """The water."""
    doubts: tuple[str, ...]
    """What should be known of it."""


@dataclasses.dataclass(frozen=True)
class RefusalEvent(messages.Event):
    """What was asked for cannot be, or the run has ended."""

    sentence: str
    """Why."""


@dataclasses.dataclass(frozen=True)
class VerdictEvent(messages.Event):
    """A model is shown dry."""

    title: str
    """Its name."""
    lines: tuple[str, ...]
    """What the inspection says of it."""
    can_float: bool
    """Whether it can be put into water."""


@dataclasses.dataclass(frozen=True)
class ReadoutSnapshot(messages.Snapshot):
    """What there is to see of the present."""

    readout: Readout
    """The numbers."""
