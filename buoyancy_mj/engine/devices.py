"""Thrusters, tanks and sensors as plugins of the engine: how a kind of them is registered.

A kind says what its numbers mean and which kernels are at work. All kinds share the C functions of
`kernels.entries.device_hooks`. MuJoCo calls only compiled functions, from any thread. Python is
asked once for each device of each mjData, when the data are made, and again when the data are
stepped with another model or in other water.
"""

import collections
import ctypes
import functools
import math
import threading
import weakref
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.engine import compiled, layout, presence
from buoyancy_mj.engine.acting import ActingWater
from buoyancy_mj.engine.c_functions import PythonFunction
from buoyancy_mj.engine.instances import find_instance_bodies, plugin_instances
from buoyancy_mj.engine.model_memory import copy_model, fingerprint_devices, read_texts
from buoyancy_mj.engine.plugin_struct import register_plugin
from buoyancy_mj.engine.waters import LOCK, find_water, is_making_water
from buoyancy_mj.kernels.entries import device_hooks
from buoyancy_mj.kernels.entries.closures import Closure, compile_kernel
from buoyancy_mj.kernels.entries.views import Table
from buoyancy_mj.kernels.paths import PATHS
from buoyancy_mj.kernels.sea import PressureModel, Sea
from buoyancy_mj.kernels.vehicle.devices import ALIVE, CHANGES, IDS, MODEL, Device

MOST_PLANS = 64
"""Models whose devices are remembered."""
_WORD = ctypes.c_int64


class Plan(NamedTuple):
    """What one plugin instance of a model is, found once for all data of such models."""

    body: int
    """Index of the body that it is mounted on."""
    make: Callable[[Device], Any]
    """Makes the NamedTuple of its kind, whose first field is the `Device`."""
    compute: Callable[..., Any]
    """Kernel f(mjModel, mjData, device) of three words that writes what it does, see `Device`."""
    advance: Callable[..., Any] | None = None
    """Kernel that runs before it; None for none."""
    readings: int = 0
    """Numbers that it leaves for others to read."""


class DeviceKind(NamedTuple):
    """One kind of thrusters, tanks or sensors: a plugin of the engine."""

    plugin: str
    """Name of the plugin, as 'buoyancy_mj.depth'."""
    keys: tuple[str, ...]
    """Keys of its configuration."""
    plan: Callable[[mujoco.MjModel, int, Mapping[str, str]], Plan]
    """Finds what an instance of a model is, from the texts of its configuration."""
    capability: mujoco.mjtPluginCapabilityBit
    """What it does for the engine."""
    stage: mujoco.mjtStage = mujoco.mjtStage.mjSTAGE_POS
    """When a sensor is read."""
    numbers: int = 0
    """Numbers of a sensor."""
    states: int = 0
    """Numbers that an instance keeps from step to step."""


_kinds: dict[int, DeviceKind] = {}
"""Kinds by the numbers of their plugins."""
_plans: collections.OrderedDict[bytes, dict[int, Plan]] = collections.OrderedDict()
"""Plans by the fingerprint of their models and by instance, the last used last."""
_models: collections.OrderedDict[bytes, mujoco.MjModel] = collections.OrderedDict()
"""Copies of those models."""
_thread = threading.local()


def register_kind(kind: DeviceKind) -> None:
    """Register a kind with MuJoCo.

    Raises:
        EngineError: this MuJoCo is not as expected inside.
    """
    hooks = _hooks()
    functions = dict(hooks.functions)
    functions["nstate"] = hooks.count(device_hooks.count, kind.states)
    functions["reset"] = hooks.count(device_hooks.reset, kind.states)
    if kind.numbers:
        functions["nsensordata"] = hooks.count(device_hooks.count_readings, kind.numbers)
    slot = register_plugin(kind.plugin, kind.keys, int(kind.capability), int(kind.stage), functions)
    _kinds[slot] = kind


def device_instances(model: mujoco.MjModel) -> list[int]:
    """Indices of the plugin instances of a model that are thrusters, tanks or sensors of ours."""
    return [i for i in range(model.nplugin) if int(model.plugin[i]) in _kinds]


def kind_of(model: mujoco.MjModel, instance: int) -> DeviceKind | None:
    """The kind of a plugin instance of a model; None if it is not one of ours."""
    return _kinds.get(int(model.plugin[instance])) if instance >= 0 else None


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


class _Hooks:
    """The C functions that all kinds share.

    They are never freed, since data may be deleted after the interpreter has gone.
    """

    def __init__(self) -> None:
        compiled.require_known_layout()
        self._resolve = PythonFunction(_resolve)
        self._context = Table(
            device_hooks.DeviceContext(
                layout.offset("mjData.plugin_data"),
                self._resolve.address,
                presence.CHANGES,
                layout.symbol("mju_error"),
            )
        )
        self._closures = [Closure(hook, self._context.address) for hook in device_hooks.BOUND]
        self._counts: dict[tuple[Any, int], Closure] = {}
        self.functions = {
            hook.__name__: closure.address
            for hook, closure in zip(device_hooks.BOUND, self._closures, strict=True)
        }
        """Addresses by the names that MuJoCo has for them."""
        ctypes.pythonapi.Py_IncRef(ctypes.py_object(self))

    def count(self, hook: Callable[..., Any], number: int) -> int:
        """Address of a hook that a number is bound to."""
        key = hook, number
        if key not in self._counts:
            self._counts[key] = Closure(hook, number)
        address: int = self._counts[key].address
        return address


@functools.cache
def _hooks() -> _Hooks:
    return _Hooks()


@functools.cache
def _dry_sea() -> Table[Sea]:
    """A sea whose surface is below everything."""
    nothing = Sea(
        waves=np.zeros((0, 7)),
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


# devices of data ----------------------------------------------------------------------------------

_tables: dict[int, Table[Any]] = {}
"""The tables of all devices in use, by their addresses."""
# data may be deleted after the interpreter has gone, and then write to their devices
ctypes.pythonapi.Py_IncRef(ctypes.py_object(_tables))
_seas: weakref.WeakKeyDictionary[ActingWater, Table[Sea]] = weakref.WeakKeyDictionary()
"""The tables of the seas of waters."""
_held: dict[int, Table[Sea]] = {}
"""The table of the sea that each device in use is in, by the address of the device."""
_room = 64


def _resolve(model: int, data: int, instance: int) -> None:
    """Put the address of a device into the engine's data."""
    # data made while a water is made, to look at the poses of its hulls
    if is_making_water():
        return
    with LOCK:
        changes = presence.count_changes()
        key = _fingerprint(model, data, instance)
        plan = _find_plan(key, model, instance)
        sea = _find_sea(model, _models[key], plan.body)
        slot = layout.word(data + layout.offset("mjData.plugin_data")) + 8 * instance
        old = _tables.get(layout.word(slot))
        device = Device(
            ids=np.zeros(IDS, np.int64),
            compute=compile_kernel(plan.compute).address,
            advance=compile_kernel(plan.advance).address if plan.advance else 0,
            offsets=_offsets().ctypes.data,
            sea=sea.address,
            readings=old.arrays[0].readings if old else np.zeros(plan.readings),
        )
        device.ids[[ALIVE, MODEL, CHANGES]] = 1, model, changes
        table = Table(plan.make(device))
        _tables[table.address], _held[table.address] = table, sea
        # in this order, for Ctrl-C may come between
        _WORD.from_address(slot).value = table.address
        if old:
            old.arrays[0].ids[ALIVE] = 0
        _drop_dead()


def _drop_dead() -> None:
    """Forget the devices of data that are gone, now and then."""
    global _room
    if len(_tables) < _room:
        return
    for address in [a for a, table in _tables.items() if not table.arrays[0].ids[ALIVE]]:
        del _tables[address], _held[address]
    _room = 2 * len(_tables) + 64


def _fingerprint(model: int, data: int, instance: int) -> bytes:
    """The fingerprint of a model, found once for all devices that a data asks for in a row."""
    last = getattr(_thread, "last", (0, 0, -1, b""))
    key = last[3] if last[:2] == (model, data) and last[2] < instance else None
    key = key or fingerprint_devices(model)
    _thread.last = model, data, instance, key
    return key


def _find_plan(key: bytes, model: int, instance: int) -> Plan:
    """The plan of an instance of the model at an address.

    Raises:
        ModelError: what the model says of the device makes no sense.
    """
    if key not in _models:
        _models[key], _plans[key] = copy_model(model), {}
        for oldest in list(_models)[:-MOST_PLANS]:
            del _models[oldest], _plans[oldest]
    _models.move_to_end(key)
    plans = _plans[key]
    if instance not in plans:
        copied = _models[key]
        kind = _kinds[int(copied.plugin[instance])]
        plans[instance] = kind.plan(copied, instance, read_texts(model, instance, kind.keys))
    return plans[instance]


def _find_sea(address: int, model: mujoco.MjModel, body: int) -> Table[Sea]:
    """The sea of the water that acts on a body of the model at an address, or one without water."""
    water = _find_own_water(address, model, body) or presence.find_acting_water(address, model)
    if water is None:
        return _dry_sea()
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
