"""`register_sensor`: a class of sensors becomes a plugin of the engine."""

import contextlib
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple, TypeVar

import mujoco
import numpy as np

from buoyancy_mj.engine.device_kinds import DeviceKind, Plan
from buoyancy_mj.engine.device_registration import register_kind
from buoyancy_mj.errors import EngineError, ModelError
from buoyancy_mj.kernels.vehicle.devices import Device
from buoyancy_mj.kernels.vehicle.sensors.sampling import HELD, Mount
from buoyancy_mj.vehicle.sensors.sampling import NoisySensor, SiteSensor
from buoyancy_mj.vehicle.sensors.texts import list_keys, parse_sensor

S = TypeVar("S", bound=SiteSensor)
Bind = Callable[[Device, Mount], Any]
"""Makes the NamedTuple of one sensor of one mjData, whose first fields these are."""


CHANNELS: dict[str, tuple[tuple[str, str], ...]] = {}
"""Name and unit of each number of the sensors of a plugin, by its name, see `Kind.channels`."""


class Place(NamedTuple):
    """Where a sensor of a model is."""

    model: mujoco.MjModel
    """The model."""
    sensor: int
    """Index of the sensor."""
    name: str
    """Its name, or that of its site."""
    where: str
    """What messages call it."""
    site: int
    """Index of its site."""
    body: int
    """Index of the site's body."""


def register_sensor(
    cls: type[S],
    compute: Callable[..., int],
    make: Callable[[S, Place], Bind],
    stage: mujoco.mjtStage = mujoco.mjtStage.mjSTAGE_POS,
) -> None:
    """Register a class of sensors with MuJoCo.

    Args:
        cls: the class.
        compute: the C function that reads such a sensor, see `kernels.entries.sensors`.
        make: finds what compiled code knows of one of them.
        stage: when it is read.
    """

    def plan(model: mujoco.MjModel, instance: int, texts: Mapping[str, str]) -> Plan:
        place = _find_place(model, instance, cls.KIND.plugin)
        settings = parse_sensor(cls, texts, place.where)
        bind = make(settings, place)
        state = int(model.plugin_stateadr[instance])
        return Plan(
            body=place.body,
            make=lambda device: bind(device, _mount(settings, place, state)),
            compute=compute,
        )

    CHANNELS[cls.KIND.plugin] = cls.KIND.channels
    numbers = len(cls.KIND.channels)
    kind = DeviceKind(
        plugin=cls.KIND.plugin,
        keys=list_keys(cls),
        plan=plan,
        capability=mujoco.mjtPluginCapabilityBit.mjPLUGIN_SENSOR,
        stage=stage,
        numbers=numbers,
        states=HELD + numbers,
    )
    # where plugins cannot be, the water's warning on import has said so
    with contextlib.suppress(EngineError):
        register_kind(kind)


def _find_place(model: mujoco.MjModel, instance: int, plugin: str) -> Place:
    """Where the sensor of a plugin instance is.

    Raises:
        ModelError: it is at no site, or there is not one sensor.
    """
    sensors = (model.sensor_plugin == instance).nonzero()[0].tolist()
    names = [str(model.sensor(i).name) or f"sensor {i}" for i in sensors]
    if len(sensors) != 1:
        stated = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_PLUGIN, instance) or instance
        raise ModelError(
            f"the instance '{stated}' of {plugin} has {len(sensors)} sensors"
            f"{': ' if names else ''}{', '.join(names)}; give each sensor one of its own"
        )
    sensor, where = sensors[0], f"sensor '{names[0]}'"
    kind = mujoco.mjtObj(int(model.sensor_objtype[sensor]))
    if kind != mujoco.mjtObj.mjOBJ_SITE:
        is_at = kind.name.removeprefix("mjOBJ_").lower()
        raise ModelError(
            f"{where} is at {'nothing' if is_at == 'unknown' else f'a {is_at}'}; {plugin} reads at "
            'a site, so write objtype="site" and the name of one as objname'
        )
    if model.sensor_refid[sensor] >= 0:
        raise ModelError(
            f"{where} has a reftype and a refname, which {plugin} does not read; remove them"
        )
    site = int(model.sensor_objid[sensor])
    name = str(model.sensor(sensor).name or model.site(site).name)
    return Place(model, sensor, name, where, site, int(model.site_bodyid[site]))


def _mount(settings: SiteSensor, place: Place, state: int) -> Mount:
    """What compiled code knows of where a sensor is, and how it samples."""
    count = len(settings.KIND.channels)
    return Mount(
        site=place.site,
        body=place.body,
        address=int(place.model.sensor_adr[place.sensor]),
        state=state,
        sensor=place.sensor,
        seed=settings.seed if isinstance(settings, NoisySensor) else 0,
        rate=settings.rate,
        noise=np.array(settings.deviations),
        bias=np.array(settings.biases),
        lost=np.array(settings.KIND.lost or (0.0,) * count),
        truth=np.zeros(count),
    )
