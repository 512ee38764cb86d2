"""Which water acts on a model, for those who were not told."""

import contextlib
from collections.abc import Iterator
from typing import TYPE_CHECKING

import mujoco

from buoyancy_mj.errors import ModelError

if TYPE_CHECKING:
    from buoyancy_mj.engine.buoyancy import Buoyancy

_installed: list["Buoyancy"] = []
"""Waters that are installed as callbacks, once for each block that they are installed for."""


@contextlib.contextmanager
def keep_installed(water: "Buoyancy") -> Iterator[None]:
    """Let others find a water for the length of a `with` block."""
    _installed.append(water)
    try:
        yield
    finally:
        _installed.remove(water)


def find_callback_water(model: mujoco.MjModel) -> "Buoyancy":
    """The water that acts on a model as a callback of MuJoCo: installed, or set by hand.

    Raises:
        ModelError: there is none, or there are several.
    """
    callbacks = mujoco.get_mjcb_control(), mujoco.get_mjcb_passive()
    by_hand = [one for one in callbacks if hasattr(one, "act_late")]
    candidates: list[Buoyancy] = [*_installed, *by_hand]
    found = {id(one): one for one in candidates if one.model._address == model._address}
    if not found:
        raise ModelError(
            "no water acts on this model: give it its own with add_water before it is compiled, "
            "enter `with buoyancy.installed():` first, or say which (buoyancy=...)"
        )
    if len(found) > 1:
        raise ModelError(f"{len(found)} waters act on this model: say which (buoyancy=...)")
    (water,) = found.values()
    return water
