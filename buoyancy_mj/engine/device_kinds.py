"""Kinds of thrusters, tanks and sensors, and what their instances in a model are."""

import collections
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import mujoco

from buoyancy_mj.engine.announcing import load_plugins
from buoyancy_mj.engine.model_memory import copy_model, read_texts
from buoyancy_mj.kernels.vehicle.devices import Device

MOST_PLANS = 64
"""Models whose devices are remembered."""


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
    capability: int
    """What it does for the engine: bits of mjtPluginCapabilityBit."""
    stage: mujoco.mjtStage = mujoco.mjtStage.mjSTAGE_POS
    """When a sensor is read."""
    numbers: int = 0
    """Numbers of a sensor."""
    states: int = 0
    """Numbers that an instance keeps from step to step."""


KINDS: dict[int, DeviceKind] = {}
"""Kinds by the numbers of their plugins."""
_plans: collections.OrderedDict[bytes, tuple[mujoco.MjModel, dict[int, Plan]]]
_plans = collections.OrderedDict()
"""Copies of models, and the plans of their instances, by fingerprint, the last used last."""


def device_instances(model: mujoco.MjModel) -> list[int]:
    """Indices of the plugin instances of a model that are thrusters, tanks or sensors of ours."""
    return [i for i in range(model.nplugin) if kind_of(model, i) is not None]


def kind_of(model: mujoco.MjModel, instance: int) -> DeviceKind | None:
    """The kind of a plugin instance of a model; None if it is not one of ours."""
    if instance < 0:
        return None
    # a model of a binary file may have a device before MuJoCo has asked for any
    load_plugins()
    return KINDS.get(int(model.plugin[instance]))


def find_plan(key: bytes, model: int, instance: int) -> tuple[mujoco.MjModel, Plan]:
    """A copy of the model at an address, and the plan of one of its instances.

    Args:
        key: the fingerprint of the model.
        model: address of the mjModel.
        instance: index of the plugin instance.

    Raises:
        ModelError: what the model says of the device makes no sense.
    """
    if key not in _plans:
        _plans[key] = copy_model(model), {}
        for oldest in list(_plans)[:-MOST_PLANS]:
            del _plans[oldest]
    _plans.move_to_end(key)
    copied, plans = _plans[key]
    if instance not in plans:
        kind = KINDS[int(copied.plugin[instance])]
        plans[instance] = kind.plan(copied, instance, read_texts(model, instance, kind.keys))
    return copied, plans[instance]
