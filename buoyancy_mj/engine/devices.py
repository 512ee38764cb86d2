"""The thrusters, tanks and sensors of mjData, and the sea that each is in.

Python is asked once for each device of each mjData, when the data are made, and again when the data
are stepped with another model or in other water.
"""

import ctypes
import functools
import math
import threading
import weakref
from typing import Any, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.engine import layout, presence
from buoyancy_mj.engine.acting import ActingWater
from buoyancy_mj.engine.device_kinds import find_plan
from buoyancy_mj.engine.instances import find_instance_bodies, plugin_instances
from buoyancy_mj.engine.model_memory import fingerprint_devices
from buoyancy_mj.engine.waters import LOCK, find_water, is_making_water
from buoyancy_mj.kernels.entries.closures import compile_kernel
from buoyancy_mj.kernels.entries.views import Table
from buoyancy_mj.kernels.paths import PATHS
from buoyancy_mj.kernels.sea import PressureModel, Sea
from buoyancy_mj.kernels.vehicle.devices import ALIVE, CHANGES, IDS, MODEL, Device
from buoyancy_mj.kernels.waves import ROWS

_WORD = ctypes.c_int64
_thread = threading.local()
_tables: dict[int, Table[Any]] = {}
"""The tables of all devices in use, by their addresses."""
# data may be deleted after the interpreter has gone, and then write to their devices
ctypes.pythonapi.Py_IncRef(ctypes.py_object(_tables))
_seas: weakref.WeakKeyDictionary[ActingWater, Table[Sea]] = weakref.WeakKeyDictionary()
"""The tables of the seas of waters."""
_mounts: dict[int, "_Mount"] = {}
"""How each of them is mounted, by the same addresses."""
_room = 64


class _Mount(NamedTuple):
    """What Python remembers of a device in use."""

    model: mujoco.MjModel
    """A copy of its model."""
    body: int
    """Index of the body that it is mounted on."""
    sea: Table[Sea]
    """The sea that it is in."""
    is_own: bool
    """Whether the model itself brings that sea, which no other replaces."""


class _Burst:
    """What is known of a model while its data ask for one device after the other."""

    def __init__(self, asks: tuple[int, int], key: bytes) -> None:
        self.asks = asks
        """Addresses of the model and the data."""
        self.key = key
        """The fingerprint of the model."""
        self.last = -1
        """The plugin instance that was asked for last."""
        self.waters: dict[int, ActingWater | None] = {}
        """The water that the model itself brings, by the index of the body that is in it."""


def read_device(data: mujoco.MjData, instance: int) -> NDArray[np.float64]:
    """A copy of the readings (m,) that a device left in its last pass over the data.

    Args:
        data: of a model with that device.
        instance: index of its plugin instance.
    """
    address = layout.word(
        layout.word(data._address + layout.offset("mjData.plugin_data")) + 8 * instance
    )
    table = _tables.get(address)
    if table is None:
        return np.zeros(0)
    readings: NDArray[np.float64] = table.arrays[0].readings.copy()
    return readings


def resolve_device(model: int, data: int, instance: int) -> None:
    """Put the address of a device into the engine's data."""
    # data made while a water is made, to look at the poses of its hulls
    if is_making_water():
        return
    with LOCK:
        slot = layout.word(data + layout.offset("mjData.plugin_data")) + 8 * instance
        old = layout.word(slot)
        if old and _keeps_its_sea(model, old):
            return
        changes = presence.count_changes()
        burst = _take_burst(model, data, instance)
        copied, plan = find_plan(burst.key, model, instance)
        sea, is_own = _find_sea(burst, copied, plan.body)
        device = Device(
            ids=np.zeros(IDS, np.int64),
            compute=compile_kernel(plan.compute).address,
            advance=compile_kernel(plan.advance).address if plan.advance else 0,
            offsets=_offsets().ctypes.data,
            sea=sea.address,
            readings=_tables[old].arrays[0].readings if old else np.zeros(plan.readings),
            added=_tables[old].arrays[0].added if old else np.zeros(3),
        )
        device.ids[[ALIVE, MODEL, CHANGES]] = 1, model, changes
        table = Table(plan.make(device))
        _tables[table.address] = table
        _mounts[table.address] = _Mount(copied, plan.body, sea, is_own)
        # in this order, for Ctrl-C may come between
        _WORD.from_address(slot).value = table.address
        if old:
            _tables[old].arrays[0].ids[ALIVE] = 0
        _drop_dead()


def _keeps_its_sea(model: int, address: int) -> bool:
    """Whether a device is of the model at an address and in the sea of now; if so, it is noted."""
    ids, mount = _tables[address].arrays[0].ids, _mounts[address]
    changes = presence.count_changes()
    if ids[MODEL] != model:
        return False
    if not mount.is_own:
        water = presence.find_acting_water(model, mount.model)
        if mount.sea is not (_dry_sea() if water is None else _sea_of(water)):
            return False
    ids[CHANGES] = changes
    return True


def _drop_dead() -> None:
    """Forget the devices of data that are gone, now and then."""
    global _room
    if len(_tables) < _room:
        return
    for address in [a for a, table in _tables.items() if not table.arrays[0].ids[ALIVE]]:
        del _tables[address], _mounts[address]
    _room = 2 * len(_tables) + 64


def _take_burst(model: int, data: int, instance: int) -> "_Burst":
    """What is known of a model while its data ask for one device after the other."""
    burst: _Burst | None = getattr(_thread, "burst", None)
    if burst is None or burst.asks != (model, data) or burst.last >= instance:
        burst = _Burst((model, data), fingerprint_devices(model))
    burst.last = instance
    _thread.burst = burst
    return burst


@functools.cache
def _dry_sea() -> Table[Sea]:
    """A sea whose surface is below everything."""
    nothing = Sea(
        waves=np.zeros((ROWS, 0)),
        current=np.zeros((1, 5)),
        density=0.0,
        level=-math.inf,
        pressure=int(PressureModel.archimedes),
    )
    return Table(nothing)


@functools.cache
def _offsets() -> NDArray[np.int64]:
    """The byte offsets of `PATHS`."""
    return np.array([layout.offset(path) for path in PATHS], np.int64)


def _find_sea(burst: _Burst, model: mujoco.MjModel, body: int) -> tuple[Table[Sea], bool]:
    """The sea of the water that acts on a body of a model, or one without water.

    Also whether the model itself brings it.
    """
    address = burst.asks[0]
    if body not in burst.waters:
        burst.waters[body] = _find_own_water(address, model, body)
    own = burst.waters[body]
    water = own or presence.find_acting_water(address, model)
    return _dry_sea() if water is None else _sea_of(water), own is not None


def _sea_of(water: ActingWater) -> Table[Sea]:
    """The table of the sea of a water."""
    if water not in _seas:
        _seas[water] = Table(water.load_model.arrays.sea)
    return _seas[water]


def _find_own_water(address: int, model: mujoco.MjModel, body: int) -> ActingWater | None:
    """The water that the model brings and that a body is in; the first for bodies in none."""
    instances = plugin_instances(model)
    for instance in instances:
        bodies = find_instance_bodies(model, instance)
        if bodies is None or body in bodies:
            return find_water(address, instance).acting
    return find_water(address, instances[0]).acting if instances else None
