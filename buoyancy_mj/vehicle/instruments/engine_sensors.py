"""What the sensors of MuJoCo itself read: a name and a unit for each number."""

import itertools
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import mujoco

from buoyancy_mj.vehicle.instruments.transmissions import (
    Units,
    joint_units,
    tendon_units,
    transmission_units,
)

_SENSOR = mujoco.mjtSensor


class Component(NamedTuple):
    """One number of a sensor."""

    name: str
    """Its name within the sensor, as 'x'; '' for the only number."""
    unit: str
    """Its unit; '' for none."""


def one(unit: str, name: str = "") -> tuple[Component, ...]:
    """A single number."""
    return (Component(name, unit),)


def vector(unit: str, name: str = "") -> tuple[Component, ...]:
    """Three numbers along x, y and z."""
    return tuple(Component(f"{name}_{axis}" if name else axis, unit) for axis in "xyz")


_NONE = ""
_ANGLES = tuple(Component(axis, _NONE) for axis in "wxyz")
_READINGS: Mapping[mujoco.mjtSensor, tuple[Component, ...]] = {
    _SENSOR.mjSENS_TOUCH: one("N"),
    _SENSOR.mjSENS_ACCELEROMETER: vector("m/s^2"),
    _SENSOR.mjSENS_VELOCIMETER: vector("m/s"),
    _SENSOR.mjSENS_GYRO: vector("rad/s"),
    _SENSOR.mjSENS_FORCE: vector("N"),
    _SENSOR.mjSENS_TORQUE: vector("N m"),
    _SENSOR.mjSENS_MAGNETOMETER: vector("T"),
    _SENSOR.mjSENS_CAMPROJECTION: (Component("x", "pixel"), Component("y", "pixel")),
    _SENSOR.mjSENS_BALLQUAT: _ANGLES,
    _SENSOR.mjSENS_BALLANGVEL: vector("rad/s"),
    _SENSOR.mjSENS_FRAMEPOS: vector("m"),
    _SENSOR.mjSENS_FRAMEQUAT: _ANGLES,
    _SENSOR.mjSENS_FRAMEXAXIS: vector(_NONE),
    _SENSOR.mjSENS_FRAMEYAXIS: vector(_NONE),
    _SENSOR.mjSENS_FRAMEZAXIS: vector(_NONE),
    _SENSOR.mjSENS_FRAMELINVEL: vector("m/s"),
    _SENSOR.mjSENS_FRAMEANGVEL: vector("rad/s"),
    _SENSOR.mjSENS_FRAMELINACC: vector("m/s^2"),
    _SENSOR.mjSENS_FRAMEANGACC: vector("rad/s^2"),
    _SENSOR.mjSENS_SUBTREECOM: vector("m"),
    _SENSOR.mjSENS_SUBTREELINVEL: vector("m/s"),
    _SENSOR.mjSENS_SUBTREEANGMOM: vector("kg m^2/s"),
    _SENSOR.mjSENS_INSIDESITE: one(_NONE),
    _SENSOR.mjSENS_GEOMDIST: one("m"),
    _SENSOR.mjSENS_GEOMNORMAL: vector(_NONE),
    _SENSOR.mjSENS_GEOMFROMTO: vector("m", "from") + vector("m", "to"),
    _SENSOR.mjSENS_E_POTENTIAL: one("J"),
    _SENSOR.mjSENS_E_KINETIC: one("J"),
    _SENSOR.mjSENS_CLOCK: one("s"),
}
"""Sensors whose units are always the same."""
_BY_JOINT: Mapping[mujoco.mjtSensor, str] = {
    _SENSOR.mjSENS_JOINTPOS: "position",
    _SENSOR.mjSENS_JOINTVEL: "velocity",
    _SENSOR.mjSENS_JOINTACTFRC: "force",
    _SENSOR.mjSENS_JOINTLIMITPOS: "position",
    _SENSOR.mjSENS_JOINTLIMITVEL: "velocity",
    _SENSOR.mjSENS_JOINTLIMITFRC: "force",
}
"""Sensors whose unit is that of a joint, by what they read of it."""
_BY_TENDON: Mapping[mujoco.mjtSensor, str] = {
    _SENSOR.mjSENS_TENDONPOS: "position",
    _SENSOR.mjSENS_TENDONVEL: "velocity",
    _SENSOR.mjSENS_TENDONACTFRC: "force",
    _SENSOR.mjSENS_TENDONLIMITPOS: "position",
    _SENSOR.mjSENS_TENDONLIMITVEL: "velocity",
    _SENSOR.mjSENS_TENDONLIMITFRC: "force",
}
"""Sensors whose unit is that of a tendon."""
_BY_ACTUATOR: Mapping[mujoco.mjtSensor, str] = {
    _SENSOR.mjSENS_ACTUATORPOS: "position",
    _SENSOR.mjSENS_ACTUATORVEL: "velocity",
    _SENSOR.mjSENS_ACTUATORFRC: "force",
}
"""Sensors whose unit is that of what an actuator moves."""
_RAY_FIELDS = (
    one("m", "distance"),
    vector(_NONE, "direction"),
    vector("m", "origin"),
    vector("m", "point"),
    vector(_NONE, "normal"),
    one("m", "depth"),
)
"""What a range finder may give of each ray, in the order of mjtRayDataField."""
_CONTACT_FIELDS = (
    one(_NONE, "found"),
    vector("N", "force"),
    vector("N m", "torque"),
    one("m", "distance"),
    vector("m", "position"),
    vector(_NONE, "normal"),
    vector(_NONE, "tangent"),
    vector("m/s", "velocity"),
    vector("rad/s", "spin"),
)
"""What a contact sensor may give of each contact, in the order of mjtConDataField."""


def read_components(model: mujoco.MjModel, sensor: int) -> tuple[Component, ...] | None:
    """Each number of a sensor of the engine, in the order of `sensordata`.

    Args:
        model: the model.
        sensor: index of the sensor.

    Returns:
        The numbers; None for a sensor of which MuJoCo does not say what it reads: a plugin's, or
        one that users fill.
    """
    kind = _SENSOR(int(model.sensor_type[sensor]))
    target, dim = int(model.sensor_objid[sensor]), int(model.sensor_dim[sensor])
    units: Units | None = None
    if kind in _BY_JOINT:
        units, field = joint_units(model, target), _BY_JOINT[kind]
    elif kind in _BY_TENDON:
        units, field = tendon_units(model, target), _BY_TENDON[kind]
    elif kind in _BY_ACTUATOR:
        units, field = transmission_units(model, target), _BY_ACTUATOR[kind]
    if units is not None:
        return repeat_components(one(getattr(units, field)), dim)
    if kind == _SENSOR.mjSENS_RANGEFINDER:
        return _read_fields(_RAY_FIELDS, int(model.sensor_intprm[sensor, 0]), dim)
    if kind == _SENSOR.mjSENS_CONTACT:
        return _read_fields(_CONTACT_FIELDS, int(model.sensor_intprm[sensor, 0]), dim)
    return _READINGS.get(kind)


def repeat_components(components: Sequence[Component], count: int) -> tuple[Component, ...]:
    """The numbers of `count` in all, where a sensor gives the same components again and again.

    Where there is more than one of each, their names are numbered from 1.
    """
    if not components or count == len(components):
        return tuple(components)[:count]
    rounds = itertools.chain.from_iterable(
        (Component("_".join(filter(None, (name, str(i)))), unit) for name, unit in components)
        for i in itertools.count(1)
    )
    return tuple(itertools.islice(rounds, count))


def _read_fields(
    fields: Sequence[tuple[Component, ...]], chosen: int, count: int
) -> tuple[Component, ...]:
    """The numbers of a sensor that gives a choice of fields, whose bits are set in `chosen`."""
    parts = [part for i, field in enumerate(fields) if chosen >> i & 1 for part in field]
    # a sensor that gives one field alone needs no name for it
    if len(parts) == 1:
        parts = [Component("", parts[0].unit)]
    return repeat_components(parts, count)
