"""`add_sensor`: a sensor into a spec. `find_streams`: where the noise of a run is chosen."""

from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.engine.device_kinds import device_instances, kind_of
from buoyancy_mj.engine.named_instances import add_instance
from buoyancy_mj.errors import ModelError, choices, describe
from buoyancy_mj.kernels.vehicle.sensors.sampling import STREAM
from buoyancy_mj.values import read_text
from buoyancy_mj.vehicle.sensors.sampling import SiteSensor
from buoyancy_mj.vehicle.sensors.texts import format_sensor


def add_sensor(spec: mujoco.MjSpec, site: str, sensor: SiteSensor, name: str | None = None) -> Any:
    """Put a sensor at a site of a model, so that `data.sensor(name).data` has its readings.

    The MJCF saved from the spec has it too, as a `<plugin>` of `<sensor>`.

    Args:
        spec: the model.
        site: name of the site, whose place and axes are the sensor's.
        sensor: what it is, as `Depth(noise=0.01)`.
        name: of the sensor; None for that of its kind, as 'depth'.

    Returns:
        The sensor's element of the spec, an MjsSensor.

    Raises:
        ModelError: there is no such site, the name is taken, or a value is of the wrong kind.

    Example:
        >>> site = spec.worldbody.add_site(name="pole", pos=[0.0, 2.0, -0.5])
        >>> gauge = add_sensor(spec, "pole", Pressure(noise=20.0, rate=8.0))
        >>> spec.compile().sensor("pressure").dim
        array([1], dtype=int32)
    """
    if not isinstance(spec, mujoco.MjSpec):
        raise ModelError(
            f"spec is {describe(spec)}; it must be an MjSpec, as "
            "mujoco.MjSpec.from_file('my_auv.xml') gives it"
        )
    if not isinstance(sensor, SiteSensor) or not hasattr(sensor, "KIND"):
        kinds = ", ".join(sorted(cls.__name__ for cls in _list_kinds(SiteSensor)))
        raise ModelError(f"sensor is {describe(sensor)}; it must be one of {kinds}")
    sites = [each.name for each in spec.sites if each.name]
    if site not in sites:
        raise ModelError(
            f"the model has no site {describe(site)} for a sensor; {choices(site, sites)}"
        )
    chosen = sensor.KIND.plugin.rpartition(".")[2] if name is None else name
    read_text(ModelError, "name of a sensor", chosen)
    if any(other.name == chosen for other in spec.sensors):
        raise ModelError(
            f"the model already has a sensor '{chosen}'; give this one another name (name=)"
        )

    element = spec.add_sensor(
        name=chosen,
        type=mujoco.mjtSensor.mjSENS_PLUGIN,
        objtype=mujoco.mjtObj.mjOBJ_SITE,
        objname=site,
    )
    add_instance(spec, element, sensor.KIND.plugin, format_sensor(sensor))
    return element


def find_streams(model: mujoco.MjModel) -> NDArray[np.int64]:
    """Where in `plugin_state` the noise stream of each sensor stands, for runs that shall differ.

    The noise of a run depends on the seeds of its sensors and on these numbers, which are 0 in
    fresh and in reset data.

    Args:
        model: a model with sensors of this package.

    Returns:
        Indices (n,) into `plugin_state`, one for each sensor.

    Example:
        >>> data.plugin_state[find_streams(model)] = 7
    """
    sensing = mujoco.mjtPluginCapabilityBit.mjPLUGIN_SENSOR
    kinds = [(i, kind_of(model, i)) for i in device_instances(model)]
    sensors = [i for i, kind in kinds if kind is not None and kind.capability == sensing]
    places: NDArray[np.int64] = model.plugin_stateadr[sensors].astype(np.int64) + STREAM
    return places


def _list_kinds(cls: type[SiteSensor]) -> list[type[SiteSensor]]:
    """All kinds of sensors."""
    below = [kind for sub in cls.__subclasses__() for kind in _list_kinds(sub)]
    return ([cls] if hasattr(cls, "KIND") else []) + below
