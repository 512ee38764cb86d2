"""Which sensor values are measured, by the names of sensors."""

from collections.abc import Sequence

import mujoco

from buoyancy_mj.errors import ResponseError, choices

_TURNS = (int(mujoco.mjtSensor.mjSENS_FRAMEQUAT), int(mujoco.mjtSensor.mjSENS_BALLQUAT))
"""Sensors whose values are no signals by themselves: the parts of a quaternion."""


def find_columns(
    model: mujoco.MjModel, names: Sequence[str]
) -> tuple[tuple[int, ...], tuple[str, ...]]:
    """Find the values of sensors.

    Args:
        model: the model.
        names: names of sensors, or NAME.0, NAME.1 and so on for one value of several.

    Returns:
        Indices in `data.sensordata` (s,), and what each is called (s,).

    Raises:
        ResponseError: there is no such sensor, or it gives a quaternion.
    """
    known = {}
    for i in range(model.nsensor):
        sensor = model.sensor(i)
        first, count = int(model.sensor_adr[i]), int(model.sensor_dim[i])
        own = [str(sensor.name)] if count == 1 else [f"{sensor.name}.{n}" for n in range(count)]
        known[str(sensor.name)] = list(zip(own, range(first, first + count), strict=True))
        if int(model.sensor_type[i]) in _TURNS:
            known[str(sensor.name)] = []
    values = {name: column for pairs in known.values() for name, column in pairs}

    found: list[tuple[str, int]] = []
    for name in names:
        if name in values:
            found.append((name, values[name]))
        elif known.get(name):
            found += known[name]
        elif name in known:
            raise ResponseError(
                f"sensor '{name}' gives a quaternion, which has no amplitude; roll, pitch and yaw "
                "are measured anyway, so leave it out"
            )
        else:
            listed = [each for each, pairs in known.items() if pairs]
            raise ResponseError(f"there is no sensor '{name}'; {choices(name, listed)}")
    return tuple(column for _, column in found), tuple(name for name, _ in found)
