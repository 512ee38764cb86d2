"""`Dvl`: a Doppler velocity log with four beams."""

import dataclasses
import math
from typing import ClassVar

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import ModelError
from buoyancy_mj.kernels.entries.sensors import make_echo_entry
from buoyancy_mj.kernels.vehicle.sensors.dvl import FEWEST, DvlSensor, measure_dvl
from buoyancy_mj.vehicle.sensors.beams import make_echoes
from buoyancy_mj.vehicle.sensors.kinds import Bind, Place, register_sensor
from buoyancy_mj.vehicle.sensors.ranging import check_ranges
from buoyancy_mj.vehicle.sensors.sampling import VELOCITY, Kind, NoisySensor

AZIMUTHS = np.radians([45.0, 135.0, -135.0, -45.0])
"""Of the four beams, from x of the site towards y: ahead to port, astern to port, astern to
starboard, ahead to starboard [rad]."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Dvl(NoisySensor):
    """A Doppler velocity log: velocity over the bottom [m/s], and the ranges of four beams [m].

    The beams stand in the Janus configuration around -z of the site. Each gives the speed along it,
    relative to what it meets, and the velocity is the one that fits at least three of them best,
    along the axes of the site. It is locked to the bottom (1), or with `water_lock` to a layer of
    water (2), or to nothing (0): then the velocity is NaN. A beam that meets nothing within its
    range, or something in the air, reads -1; in the air all do.

    Raises:
        ModelError: a value out of its range.
    """

    KIND: ClassVar[Kind] = Kind(
        "buoyancy_mj.dvl",
        channels=(*VELOCITY, ("lock", ""), *((f"range_{n}", "m") for n in (1, 2, 3, 4))),
        lost=(*[math.nan] * 3, 0.0, *[-1.0] * 4),
        noisy=3,
        bounds=(
            ("angle", 1.0, 80.0),
            ("range_noise", 0.0, math.inf),
            ("water_lock", 0.0, math.inf),
        ),
    )
    """What all of its kind have."""

    angle: float = 30.0
    """Between each beam and -z of the site [degrees]; 30 and 22.5 are common."""
    min_range: float = 0.05
    """Least range along a beam [m]."""
    max_range: float = 50.0
    """Greatest range along a beam [m]."""
    water_lock: float = 0.0
    """How far along the beams the layer of water is that it locks to without the bottom [m]; 0 for
    none."""
    range_noise: float = 0.0
    """Standard deviation of the noise of the ranges [m]; `noise` and `bias` are the velocity's."""

    def __post_init__(self) -> None:
        super().__post_init__()
        check_ranges(self)
        if self.water_lock > self.max_range:
            raise ModelError(
                f"water_lock is {self.water_lock:g}; it must be at most {self.max_range:g}, which "
                "is max_range"
            )

    @property
    def deviations(self) -> tuple[float, ...]:
        """Standard deviation of the noise of each of its numbers."""
        return (*super().deviations[:4], *[self.range_noise] * 4)


def find_beams(angle: float) -> NDArray[np.float64]:
    """Directions (4, 3) of the beams, site's axes, at an angle [degrees] from -z."""
    down = np.radians(angle)
    out = np.sin(down)
    return np.column_stack(
        [out * np.cos(AZIMUTHS), out * np.sin(AZIMUTHS), np.full(4, -np.cos(down))]
    )


def solve_beams(beams: NDArray[np.float64]) -> NDArray[np.float64]:
    """For each set of beams, by its bits, the matrix (3, 4) that makes a velocity of their speeds.

    It is the pseudo-inverse of their directions, and 0 for too few. All are stacked: (48, 4).
    """
    rows = np.zeros((16, 3, 4))
    for bits in range(16):
        chosen = [b for b in range(4) if bits >> b & 1]
        if len(chosen) >= FEWEST:
            rows[bits][:, chosen] = np.linalg.pinv(beams[chosen])
    return rows.reshape(48, 4)


def _make(settings: Dvl, place: Place) -> Bind:
    beams = find_beams(settings.angle)
    solvers = solve_beams(beams)
    return lambda device, mount: DvlSensor(
        device,
        mount,
        make_echoes(place, beams, settings.min_range, settings.max_range),
        settings.water_lock,
        solvers,
        np.zeros(4),
    )


register_sensor(Dvl, make_echo_entry(DvlSensor, measure_dvl), _make, mujoco.mjtStage.mjSTAGE_VEL)
