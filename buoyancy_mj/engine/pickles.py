"""Pickles of models with water or devices, and of their data, which bring this package along.

MuJoCo's own pickle of a model names its plugins by number, and a process that does not know them
ends when it makes data of it. Its pickle of data holds addresses of what plugins keep for
them, which were those of the process that wrote it.
"""

import copyreg
import ctypes
from typing import Any

import mujoco

from buoyancy_mj.engine import layout
from buoyancy_mj.engine.device_kinds import device_instances
from buoyancy_mj.engine.instances import plugin_instances


def _reduce_model(model: mujoco.MjModel) -> tuple[Any, ...]:
    return _reduce(model, model)


def _reduce_data(data: mujoco.MjData) -> tuple[Any, ...]:
    return _reduce(data, data.model)


def _reduce(value: Any, model: mujoco.MjModel) -> tuple[Any, ...]:
    """How to pickle a model or its data: by a function of this package where it has plugins."""
    if not _find_instances(model):
        reduced: tuple[Any, ...] = value.__reduce_ex__(2)
        return reduced
    return _restore, (type(value), value.__getstate__())


def _restore(kind: Any, state: Any) -> Any:
    """A model or data from a pickle; importing this module has announced the plugins."""
    value = kind.__new__(kind)
    value.__setstate__(state)
    if isinstance(value, mujoco.MjData):
        records = layout.word(value._address + layout.offset("mjData.plugin_data"))
        for instance in _find_instances(value.model):
            # the next pass finds a record of this process
            ctypes.c_int64.from_address(records + 8 * instance).value = 0
    return value


def _find_instances(model: mujoco.MjModel) -> list[int]:
    """Indices of the plugin instances of this package."""
    return plugin_instances(model) + device_instances(model)


def pickle_with_water() -> None:
    """Let `pickle` write models with water, and their data, so that they bring this package."""
    copyreg.pickle(mujoco.MjModel, _reduce_model)
    copyreg.pickle(mujoco.MjData, _reduce_data)
