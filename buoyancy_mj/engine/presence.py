"""Which water acts on a model now: what its thrusters, tanks and sensors are in."""

import ctypes
import weakref

import mujoco
import numpy as np

from buoyancy_mj.engine.acting import ActingWater

_changes = np.zeros(1, np.int64)
"""How often the waters that act have changed."""
# data may be stepped by other threads after the interpreter has gone
ctypes.pythonapi.Py_IncRef(ctypes.py_object(_changes))
_lent: tuple[tuple[ActingWater, bool], ...] = ()
"""Waters that act as callbacks, in the order in which they came, and whether on copies too."""
_called: weakref.WeakValueDictionary[int, ActingWater] = weakref.WeakValueDictionary()
"""Waters that somebody calls, by the addresses of their models."""

CHANGES: int = _changes.ctypes.data
"""Address of the word that counts the changes."""


def count_changes() -> int:
    """How often the waters that act have changed so far."""
    return int(_changes[0])


def note_lent(water: ActingWater, *, copies: bool) -> None:
    """A water acts as a callback from now on, on copies of its model too where it says so."""
    global _lent
    _lent = (*_lent, (water, copies))
    _changes[0] += 1


def note_left(water: ActingWater) -> None:
    """A water acts as a callback no more."""
    global _lent
    _lent = tuple(entry for entry in _lent if entry[0] is not water)
    _changes[0] += 1


def note_called(water: ActingWater) -> None:
    """Somebody calls a water."""
    if _called.get(water.model._address) is not water:
        _called[water.model._address] = water
        _changes[0] += 1
        weakref.finalize(water, _note_gone).atexit = False


def _note_gone() -> None:
    """A water that somebody called is gone."""
    _changes[0] += 1


def find_acting_water(address: int, model: mujoco.MjModel) -> ActingWater | None:
    """The water that acts from outside on the model at an address; the newest of several.

    Args:
        address: of the mjModel.
        model: a copy of it.
    """
    for water, copies in reversed(_lent):
        theirs = water.model
        if theirs._address == address or (copies and theirs.signature == model.signature):
            return water
    return _called.get(address)
