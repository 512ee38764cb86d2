"""`Responses`: response amplitude operators over headings and periods."""

import dataclasses
import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.responses.extremes import (
    HOURS_3,
    Sea,
    SeaResponse,
    find_covered_part,
    respond_to_sea,
)
from buoyancy_mj.responses.tracks import MOTIONS

SURE = 0.8
"""Coherence below which what a cross-spectrum says is not told as sure."""
TURNED = math.radians(2.0)
"""How far a vehicle may turn away from the heading that was asked for [rad]."""
LEAST_ENERGY = 0.01
"""Part of the greatest density of wave energy below which nothing is sure either."""


@dataclasses.dataclass(frozen=True, eq=False)
class Responses:
    """What a vehicle answers to waves: motion over elevation, by heading and period.

    The elevation at the vehicle's mean place is A cos(omega t). A motion is
    |H| A cos(omega t - arg H): a positive phase lags behind the crest. As a complex number, motion
    is the real part of H A e^(-i omega t), the convention of Capytaine and WAMIT's successors.

    The six motions are those of the centre of gravity, in horizontal axes along the vehicle's mean
    heading: x ahead, y to port, z up, and turns about them. Heading 0 is a following sea, pi / 2
    one that comes from starboard and runs to port, pi a head sea.
    """

    title: str
    """What was measured."""
    notes: tuple[str, ...]
    """How it was measured, in sentences."""
    headings: NDArray[np.float64]
    """Directions that the waves run to, from the vehicle's heading (h,) [rad]."""
    periods: NDArray[np.float64]
    """Periods of the waves (p,) [s]."""
    wavenumbers: NDArray[np.float64]
    """Their wavenumbers (p,) [rad/m]."""
    amplitudes: NDArray[np.float64]
    """Amplitudes of the waves (p,) [m]; NaN from an irregular sea."""
    names: tuple[str, ...]
    """Names of the responses (c,): the six motions, then points and sensors."""
    units: tuple[str, ...]
    """Unit of each (c,): "m", "rad", or "" where a sensor does not say."""
    transfer: NDArray[np.complex128]
    """H, motion over elevation (h, p, c) [unit per m]."""
    sure: NDArray[np.bool_]
    """Whether each can be trusted (h, p, c): the transient has died down, or the coherence is
    above `SURE` and there is wave energy."""
    coherence: NDArray[np.float64] | None
    """Squared coherence with the elevation (h, p, c); None from regular waves."""
    cycles: NDArray[np.int64]
    """Wave periods that each took (h, p); 0 from an irregular sea."""
    turned: NDArray[np.float64]
    """How far the mean heading in each run was off the one that was asked for (h, p) [rad]."""
    natural_periods: NDArray[np.float64]
    """Undamped periods of heave, roll and pitch (3,) [s]; inf where nothing restores."""
    density: float
    """Density of the water [kg/m^3]."""
    gravity: float
    """Downward acceleration [m/s^2]."""
    depth: float
    """Depth of the water [m]."""

    @property
    def omegas(self) -> NDArray[np.float64]:
        """Frequencies of the waves (p,) [rad/s]."""
        return np.asarray(2.0 * math.pi / self.periods)

    @property
    def sizes(self) -> NDArray[np.float64]:
        """Amplitude of each response over that of the wave, |H| (h, p, c) [unit per m]."""
        return np.abs(self.transfer)

    @property
    def phases(self) -> NDArray[np.float64]:
        """By how much each lags behind the crest (h, p, c) [rad], above -pi and up to pi."""
        return np.angle(self.transfer)

    @property
    def normal_sizes(self) -> NDArray[np.float64]:
        """|H|, and for turns |H| over the wavenumber: turn over wave slope (h, p, c)."""
        turns = np.array([unit == "rad" for unit in self.units])
        return np.where(turns, self.sizes / self.wavenumbers[:, None], self.sizes)

    def find(self, name: str) -> NDArray[np.complex128]:
        """H of the response of a name (h, p)."""
        return self.transfer[:, :, self.names.index(name)]

    def in_sea(self, sea: Sea, duration: float = HOURS_3) -> list[list[SeaResponse]]:
        """What each response comes to in a long-crested sea from each heading.

        Only waves between the shortest and the longest period count: `covers` tells how much of
        the sea that is.

        Args:
            sea: its spectrum.
            duration: how long it lasts [s].

        Returns:
            For each heading, for each response.
        """
        order = np.argsort(self.omegas)
        return [
            [respond_to_sea(self.omegas[order], sizes, sea, duration) for sizes in by_name.T]
            for by_name in self.sizes[:, order]
        ]

    def covers(self, sea: Sea) -> float:
        """Part of a sea's energy between the longest and the shortest period."""
        return find_covered_part(np.sort(self.omegas), sea)

    def doubts(self) -> Iterator[str]:
        """Sentences on what is not sure."""
        most = float(np.abs(self.turned).max())
        if most > TURNED:
            count = int((np.abs(self.turned) > TURNED).any(axis=1).sum())
            yield (
                f"from {count} of {len(self.headings)} headings the waves turned the vehicle, by "
                f"up to {math.degrees(most):.2g} degrees; lower waves turn it less"
            )
        if self.sure.all():
            return
        count, whole = int((~self.sure).any(axis=2).sum()), self.sure[:, :, 0].size
        if self.coherence is None:
            yield (
                f"in {count} of {whole} runs a response had not settled after "
                f"{self.cycles.max()} periods of the wave or less; such values are marked *"
            )
        else:
            yield (
                f"{count} of {whole} rows have a response with a squared coherence below {SURE:g}, "
                f"or less than {100.0 * LEAST_ENERGY:g} % of the energy at the peak of the sea; "
                "such values are marked *"
            )

    def units_of(self) -> list[str]:
        """What each of `sizes` is measured in, as 'm/m'."""
        return [f"{unit}/m" for unit in self.units]


def list_names(points: int, sensors: tuple[str, ...]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Names and units of the six motions, of points and of sensors."""
    numbers = range(1, points + 1)
    place = [f"point{number if points > 1 else ''}" for number in numbers]
    names = (*MOTIONS, *(f"{name}.{axis}" for name in place for axis in "xyz"), *sensors)
    units = (*("m",) * 3, *("rad",) * 3, *("m",) * 3 * points, *("",) * len(sensors))
    return names, units
