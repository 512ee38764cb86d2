"""`SeaState`: the water as the panel sets it, in a few numbers."""

import dataclasses
import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from buoyancy_mj.sea.currents import CurrentProfile, CurrentSeries
from buoyancy_mj.sea.irregular import IrregularSea
from buoyancy_mj.sea.spectra import JonswapSea, PiersonMoskowitzSea
from buoyancy_mj.sea.water import Water
from buoyancy_mj.sea.waves import RegularWave

SCENE = "as in the scene"
"""The spectrum that leaves the waves of the scene as they are."""
STILL = "still"
REGULAR = "regular"
JONSWAP = "JONSWAP"
PIERSON_MOSKOWITZ = "Pierson-Moskowitz"
SPECTRA = (STILL, REGULAR, JONSWAP, PIERSON_MOSKOWITZ, SCENE)
"""What the waves can be."""


class Range(NamedTuple):
    """What a slider may give."""

    label: str
    """What stands beside it."""
    unit: str
    """Its unit, '' for none."""
    least: float
    """Its least value."""
    most: float
    """Its greatest value."""


RANGES: Mapping[str, Range] = {
    "height": Range("height", "m", 0.0, 3.0),
    "period": Range("period", "s", 0.8, 15.0),
    "heading": Range("heading", "deg", -180.0, 180.0),
    "current": Range("speed", "m/s", 0.0, 3.0),
    "current_heading": Range("towards", "deg", -180.0, 180.0),
    "density": Range("density", "kg/m^3", 900.0, 1300.0),
    "level": Range("level", "m", -2.0, 2.0),
}
"""The sliders of the panel, by the field of `SeaState` that each sets."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class SeaState:
    """The water of a scene in a few numbers."""

    spectrum: str = STILL
    """What the waves are, one of `SPECTRA`."""
    height: float = 0.3
    """Height from trough to crest of a regular wave, or significant height of a sea [m]."""
    period: float = 4.0
    """Period of the wave, or of the sea's peak [s]."""
    heading: float = 0.0
    """Where the waves run to, from x towards y [degrees]."""
    seed: int = 0
    """Seed that draws the phases of an irregular sea."""
    current: float | None = 0.0
    """Speed of the current [m/s]; None for a current by depth or time, which stays the scene's."""
    current_heading: float = 0.0
    """Where the current runs to, from x towards y [degrees]."""
    density: float = 1000.0
    """Density of the water [kg/m^3]."""
    level: float = 0.0
    """Height of the still water [m], world frame."""

    def make_water(self, own: Water) -> Water:
        """The water that these numbers describe.

        Args:
            own: the water of the scene, for what it alone can say.

        Raises:
            WaterError: there is no such water.
        """
        if self.current is None:
            current: Any = own.current
        else:
            angle = math.radians(self.current_heading)
            current = (self.current * math.cos(angle), self.current * math.sin(angle), 0.0)
        return Water(
            density=self.density, level=self.level, waves=self._make_waves(own), current=current
        )

    def change(self, **fields: Any) -> "SeaState":
        """The same with other numbers; waves that are set are no longer the scene's."""
        waves = {"height", "period", "heading", "seed"} & fields.keys()
        if waves and "spectrum" not in fields and self.spectrum in (SCENE, STILL):
            fields["spectrum"] = JONSWAP if "seed" in fields else REGULAR
        return dataclasses.replace(self, **fields)

    def _make_waves(self, own: Water) -> Any:
        """The waves, of which water takes one, several or none."""
        heading = math.radians(self.heading)
        if self.spectrum == SCENE:
            return own.waves
        if self.spectrum == REGULAR:
            return RegularWave(0.5 * self.height, period=self.period, direction=heading)
        if self.spectrum == JONSWAP:
            return JonswapSea(self.height, self.period, direction=heading, seed=self.seed)
        if self.spectrum == PIERSON_MOSKOWITZ:
            return PiersonMoskowitzSea(
                self.height, peak_period=self.period, direction=heading, seed=self.seed
            )
        return ()


def describe_water(water: Water) -> SeaState:
    """The numbers that say most of a water: those of its first wave, with the spectrum `SCENE`."""
    fields: dict[str, Any] = {"density": water.density, "level": water.level}
    waves: Any = water.waves
    if waves:
        fields |= {"spectrum": SCENE} | _describe_wave(waves[0])
    if isinstance(water.current, CurrentProfile | CurrentSeries):
        fields["current"] = None
    else:
        vx, vy, _ = water.current
        fields["current"] = float(np.hypot(vx, vy))
        fields["current_heading"] = math.degrees(math.atan2(vy, vx))
    return SeaState(**fields)


def _describe_wave(wave: Any) -> dict[str, Any]:
    """Height, period, heading and seed of a wave as far as it has them."""
    if isinstance(wave, IrregularSea):
        sea: Any = wave
        return {
            "height": sea.significant_height,
            "period": sea.peak_period,
            "heading": math.degrees(sea.direction),
            "seed": sea.seed,
        }
    if isinstance(wave, RegularWave):
        return {
            "height": 2.0 * wave.amplitude,
            "period": wave.period,
            "heading": math.degrees(wave.direction),
        }
    return {}
