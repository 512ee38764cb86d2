"""`SiteSensor` and `NoisySensor`: what all sensors have, as their rate and their noise."""

import dataclasses
import math
from typing import ClassVar, NamedTuple

from buoyancy_mj.errors import ModelError, describe
from buoyancy_mj.values import (
    ANY,
    is_number,
    read_array,
    read_number,
    read_whole_number,
    set_number,
)

LARGEST_SEED = 2**31 - 1


class Kind(NamedTuple):
    """What all sensors of a kind have."""

    plugin: str
    """Name of its plugin, 'buoyancy_mj.depth'."""
    channels: tuple[tuple[str, str], ...]
    """Name and unit of each of its numbers; the name is '' for the only one."""
    lost: tuple[float, ...] = ()
    """What each reads where there is nothing to read; () for none that can be lost."""
    noisy: int = 0
    """How many of its numbers `noise` and `bias` are for, from the first on; 0 for all."""
    bounds: tuple[tuple[str, float, float], ...] = ()
    """Fields that are numbers, with the least and the greatest value of each."""


VELOCITY = (("x", "m/s"), ("y", "m/s"), ("z", "m/s"))
"""Channels of a velocity."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class SiteSensor:
    """A sensor at a site.

    Raises:
        ModelError: a value out of its range.
    """

    KIND: ClassVar[Kind]
    """What all of its kind have."""

    rate: float = 0.0
    """Samples per second [Hz], each held until the next; 0 reads in each step."""

    def __post_init__(self) -> None:
        set_number(self, ModelError, "rate", least=0.0)
        for field, least, most in self.KIND.bounds:
            set_number(self, ModelError, field, least=least, most=most)

    @property
    def deviations(self) -> tuple[float, ...]:
        """Standard deviation of the noise of each of its numbers."""
        return (0.0,) * len(self.KIND.channels)

    @property
    def biases(self) -> tuple[float, ...]:
        """What is added to each of its numbers."""
        return (0.0,) * len(self.KIND.channels)


@dataclasses.dataclass(frozen=True, kw_only=True)
class NoisySensor(SiteSensor):
    """A sensor with noise.

    Raises:
        ModelError: a value out of its range.
    """

    noise: tuple[float, ...] | float = 0.0
    """Standard deviation of Gaussian noise, in the unit of the reading: one number for all that the
    sensor reads, or one for each."""
    bias: tuple[float, ...] | float = 0.0
    """What is added to the reading: one number for all, or one for each."""
    seed: int = 0
    """Whole number that the noise depends on; noise of the same seed repeats."""

    def __post_init__(self) -> None:
        super().__post_init__()
        self._set_numbers("noise", least=0.0)
        self._set_numbers("bias", least=-math.inf)
        seed = read_whole_number(ModelError, "seed", self.seed, 0, LARGEST_SEED)
        object.__setattr__(self, "seed", seed)

    @property
    def deviations(self) -> tuple[float, ...]:
        """Standard deviation of the noise of each of its numbers."""
        return self._spread(self.noise)

    @property
    def biases(self) -> tuple[float, ...]:
        """What is added to each of its numbers."""
        return self._spread(self.bias)

    @property
    def _count(self) -> int:
        """How many numbers have noise and bias."""
        return self.KIND.noisy or len(self.KIND.channels)

    def _set_numbers(self, field: str, least: float) -> None:
        """Keep a field as a number, or as a tuple of as many as there are."""
        value = getattr(self, field)
        array = read_array(ModelError, field, [value] if is_number(value) else value, (ANY,))
        if len(array) not in (1, self._count):
            wanted = f"one number or {self._count}" if self._count > 1 else "one number"
            raise ModelError(f"{field} is {describe(value)}; it must be {wanted}")
        for number in array.tolist():
            read_number(ModelError, field, number, least=least)
        numbers = tuple(array.tolist())
        object.__setattr__(self, field, numbers if len(numbers) > 1 else numbers[0])

    def _spread(self, value: tuple[float, ...] | float) -> tuple[float, ...]:
        """A number of each of the numbers; 0 for those without noise."""
        numbers = value if isinstance(value, tuple) else (value,) * self._count
        return (*numbers, *[0.0] * (len(self.KIND.channels) - self._count))
