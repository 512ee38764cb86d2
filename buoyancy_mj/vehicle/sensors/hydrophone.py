"""`Hydrophone`: range and direction of a pinger."""

import dataclasses
import math
from typing import ClassVar

import mujoco

from buoyancy_mj.errors import ModelError
from buoyancy_mj.hulls.references import find_by_last_word, find_named
from buoyancy_mj.kernels.entries.sensors import read_hydrophone
from buoyancy_mj.kernels.vehicle.sensors.hydrophone import HydrophoneSensor
from buoyancy_mj.values import read_text
from buoyancy_mj.vehicle.sensors.kinds import Bind, Place, register_sensor
from buoyancy_mj.vehicle.sensors.sampling import Kind, NoisySensor

PINGER = "pinger"
"""Name of the site that is heard where none is stated."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Hydrophone(NoisySensor):
    """Range [m], bearing and elevation [rad] and travel time [s] of a pinger's sound, one way.

    The sound shows where the pinger was when it left, the pinger taken to move straight. Bearing is
    from x of the site towards y, to the left; elevation from there towards z. Range is travel time
    times the speed of sound: pinger and hydrophone share a clock. A ping is read in the first step
    after it has arrived. Where either is in the air, or
    before the first ping arrives, range and time are -1 and the angles NaN. Sound goes through
    everything: nothing shades the pinger, and nothing reflects it.

    Raises:
        ModelError: a value out of its range.
    """

    KIND: ClassVar[Kind] = Kind(
        "buoyancy_mj.hydrophone",
        channels=(
            ("range", "m"),
            ("bearing", "rad"),
            ("elevation", "rad"),
            ("travel_time", "s"),
        ),
        lost=(-1.0, math.nan, math.nan, -1.0),
        noisy=1,
        bounds=(
            ("sound_speed", 100.0, math.inf),
            ("period", 0.0, math.inf),
            ("angle_noise", 0.0, math.inf),
        ),
    )
    """What all of its kind have."""

    pinger: str = ""
    """Name of the site of the pinger; of several files the one in the sensor's own comes first.
    Without a name it is the site 'pinger', if there is one; else nothing is heard."""
    sound_speed: float = 1500.0
    """[m/s]; 1480 in fresh water of 20 degrees."""
    period: float = 0.0
    """From ping to ping [s], the first at time 0: each reading is held until the next ping arrives;
    0 for a sound that never ends."""
    angle_noise: float = 0.0
    """Standard deviation of the noise of bearing and elevation [rad]; `noise` and `bias` are the
    range's."""

    def __post_init__(self) -> None:
        super().__post_init__()
        read_text(ModelError, "pinger", self.pinger)
        if self.rate and self.period:
            raise ModelError(
                f"rate is {self.rate:g} beside a period of {self.period:g} s; a hydrophone reads "
                "when a ping arrives, so leave out rate"
            )

    @property
    def deviations(self) -> tuple[float, ...]:
        """Standard deviation of the noise of each of its numbers."""
        return (*super().deviations[:1], self.angle_noise, self.angle_noise, 0.0)


def _make(settings: Hydrophone, place: Place) -> Bind:
    pinger = _find_pinger(settings, place)
    body = int(place.model.site_bodyid[pinger]) if pinger >= 0 else 0
    return lambda device, mount: HydrophoneSensor(
        device, mount, pinger, body, settings.sound_speed, settings.period
    )


def _find_pinger(settings: Hydrophone, place: Place) -> int:
    """Index of the site of the pinger; -1 for none.

    Raises:
        ModelError: there is no site of that name.
    """
    site = mujoco.mjtObj.mjOBJ_SITE
    if not settings.pinger:
        return find_by_last_word(place.model, site, PINGER, place.name)
    try:
        return find_named(place.model, site, settings.pinger, place.name)
    except ModelError as error:
        raise ModelError(f"{place.where}: pinger: {error}") from None


register_sensor(Hydrophone, read_hydrophone, _make, mujoco.mjtStage.mjSTAGE_VEL)
