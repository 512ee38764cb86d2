"""The limits of a range."""

from typing import Protocol

from buoyancy_mj.errors import ModelError
from buoyancy_mj.values import set_number


class _Ranging(Protocol):
    @property
    def min_range(self) -> float: ...
    @property
    def max_range(self) -> float: ...


def check_ranges(sensor: _Ranging) -> None:
    """Keep the limits of a sensor's range as floats, from its `__post_init__`.

    Raises:
        ModelError: they are none.
    """
    set_number(sensor, ModelError, "min_range", least=0.0)
    set_number(sensor, ModelError, "max_range", above=0.0)
    if not sensor.min_range < sensor.max_range:
        raise ModelError(
            f"min_range is {sensor.min_range:g} and max_range {sensor.max_range:g}; the first must "
            "be the smaller"
        )
