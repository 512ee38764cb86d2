"""The gravity under which waves run: the one that they state, or that of the model they are in."""

import math
from typing import Protocol, TypeGuard, TypeVar, cast

from buoyancy_mj.errors import WaterError
from buoyancy_mj.sea.dispersion import GRAVITY
from buoyancy_mj.sea.ranges import SMALLEST, STRONGEST
from buoyancy_mj.values import read_number

W = TypeVar("W")

_SAME = 1e-9
"""Most by which two numbers for one gravity differ, over their size."""


class GravityWave(Protocol):
    """A wave whose length depends on gravity."""

    @property
    def gravity(self) -> float | None:
        """The acceleration of gravity that the wave states [m/s^2]; None if it states none."""
        ...

    def with_gravity(self, gravity: float) -> "GravityWave":
        """The same wave under this acceleration of gravity [m/s^2], which it then states."""
        ...


def read_stated(gravity: float | None) -> float | None:
    """The acceleration of gravity that a wave states [m/s^2], or None.

    Raises:
        WaterError: it is no number in its range.
    """
    if gravity is None:
        return None
    return read_number(WaterError, "gravity", gravity, least=SMALLEST, most=STRONGEST)


def or_default(stated: float | None) -> float:
    """The acceleration of gravity [m/s^2] of a wave that is in no model."""
    return GRAVITY if stated is None else stated


def take_gravity(wave: W, gravity: float) -> W:
    """A wave as it runs in a model: one that states no gravity takes the model's.

    Args:
        wave: any wave; one that is no `GravityWave` stays as it is.
        gravity: of the model [m/s^2]. A model without, 0, contradicts no wave.

    Raises:
        WaterError: the wave states another gravity, or there is no such wave under this one.
    """
    if gravity == 0.0 or not _depends_on_gravity(wave):
        return wave
    stated = wave.gravity
    if math.isclose(or_default(stated), gravity, rel_tol=_SAME):
        return cast(W, wave)
    if stated is not None:
        raise WaterError(
            f"a wave states a gravity of {stated:g} m/s^2, and that of the model is "
            f"{gravity:g} m/s^2; leave the wave's out, and it takes the model's"
        )
    return cast(W, wave.with_gravity(gravity))


def _depends_on_gravity(wave: object) -> TypeGuard[GravityWave]:
    """Whether a wave is a `GravityWave`."""
    return callable(getattr(wave, "with_gravity", None))
