"""What all irregular seas share: their options, and what becomes of them on a current."""

import dataclasses
import math
from typing import Self

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import WaterError

MOST_COMPONENTS = 10_000
"""Most waves of one sea."""
MOST_BLOCKED = 0.05
"""Most of a sea's energy that is left out where a current blocks it."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class IrregularSea:
    """Options that all irregular seas share."""

    components: int = 64
    """Number of waves."""
    seed: int = 0
    """Seed of phases and directions."""
    direction: float = 0.0
    """Mean direction that the sea runs to, from x towards y [rad]."""
    spreading: float = math.inf
    """Exponent s of the spreading cos^2s(b / 2) over directions b.

    It is infinite for long crests, 10 to 25 for swell, and 2 to 5 for a wind sea."""
    depth: float = math.inf
    """Depth of the water [m]; it shortens the waves and leaves the spectrum as it is."""
    gravity: float | None = None
    """Acceleration of gravity in the dispersion relation, g [m/s^2].

    By default it is the model's, and 9.81 where there is no model."""
    frame: str = "earth"
    """Who sees the spectrum: "earth", an observer at rest, or "water", one that drifts along."""

    def with_gravity(self, gravity: float) -> Self:
        """The same sea under this acceleration of gravity [m/s^2], see `sea.gravity`."""
        return dataclasses.replace(self, gravity=gravity)


@dataclasses.dataclass(frozen=True, eq=False)
class SeaOnCurrent:
    """An irregular sea on a current, as its water sees it."""

    rows: NDArray[np.float64]
    """The waves that run there as rows (n, 6), see `waves.CurrentWave.on`."""
    warning: str
    """A clause that says how much too steep the sea is, and what is blocked; empty if nothing is.
    """


def describe_blocked(omegas: NDArray[np.float64], components: int, peak_period: float) -> str:
    """A clause that says how much of a sea a current blocks; empty if it is nothing.

    Args:
        omegas: frequencies of the blocked waves (n,) [rad/s].
        components: number of all waves, which have the same energy.
        peak_period: of the sea [s].

    Raises:
        WaterError: it is more than `MOST_BLOCKED`.
    """
    if not len(omegas):
        return ""
    part = len(omegas) / components
    if part > MOST_BLOCKED:
        raise WaterError(
            f"{100.0 * part:.3g} % of the energy of a sea with a peak_period of {peak_period:g} s "
            "cannot run against the current, waves with periods up to "
            f"{2.0 * math.pi / omegas.min():.3g} s; give it a longer peak_period or a weaker "
            "current, or say frame = 'water' if the spectrum is what the water sees"
        )
    return (
        f"a sea of which {len(omegas)} of {components} waves, {100.0 * part:.2g} % of its energy, "
        "cannot run against the current and are left out"
    )
