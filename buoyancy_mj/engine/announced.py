"""What MuJoCo is told of each plugin of this package before anything else of it is imported.

A class that stands behind a plugin says the same once more; `engine.announcing.put_hooks` and a
test compare them.
"""

from typing import NamedTuple

import mujoco

_DOES = mujoco.mjtPluginCapabilityBit
_ACTUATOR, _PASSIVE, _SENSOR = map(
    int, (_DOES.mjPLUGIN_ACTUATOR, _DOES.mjPLUGIN_PASSIVE, _DOES.mjPLUGIN_SENSOR)
)
_POSITION, _VELOCITY = int(mujoco.mjtStage.mjSTAGE_POS), int(mujoco.mjtStage.mjSTAGE_VEL)
_NOISY = ("rate", "noise", "bias", "seed")
"""Keys of all sensors with noise."""
_HELD = 4
"""Numbers that a sensor keeps from step to step beside its readings."""


class Announced(NamedTuple):
    """A plugin of the engine."""

    name: str
    """Its name, as 'buoyancy_mj.depth'."""
    keys: tuple[str, ...]
    """Keys of its configuration."""
    capability: int
    """What it does for the engine: bits of mjtPluginCapabilityBit."""
    stage: int = _POSITION
    """The mjtStage at which a sensor is read."""
    states: int = 0
    """Numbers that an instance keeps from step to step."""
    numbers: int = 0
    """Numbers of a sensor."""


def _sensor(kind: str, numbers: int, *keys: str, stage: int = _POSITION) -> Announced:
    return Announced(f"buoyancy_mj.{kind}", keys, _SENSOR, stage, _HELD + numbers, numbers)


PLUGINS = (
    Announced(
        "buoyancy_mj.water",
        (
            "density", "level", "waves", "current", "method", "pressure", "damping", "added_mass",
            "slamming", "threads", "geoms", "hull", "fill", "instance",
        ),
        _PASSIVE,
        _VELOCITY,
    ),
    Announced(
        "buoyancy_mj.ballast",
        ("kind", "geom", "capacity", "rate", "solid", "area", "discharge", "vent"),
        _ACTUATOR,
    ),
    _sensor("altimeter", 1, *_NOISY, "min_range", "max_range", "surface"),
    _sensor(
        "dvl", 8, *_NOISY, "angle", "min_range", "max_range", "water_lock", "range_noise",
        stage=_VELOCITY,
    ),
    _sensor(
        "hydrophone", 4, *_NOISY, "pinger", "sound_speed", "period", "angle_noise", stage=_VELOCITY
    ),
    _sensor("pressure", 1, *_NOISY, "absolute"),
    _sensor("depth", 1, *_NOISY, "still"),
    _sensor("elevation", 1, *_NOISY),
    _sensor("wet", 1, "rate", "radius"),
    _sensor("water_velocity", 3, *_NOISY, "frame"),
    _sensor("speed_through_water", 3, *_NOISY, stage=_VELOCITY),
    Announced(
        "buoyancy_mj.thruster",
        (
            "preset", "control", "voltage", "blades", "area_ratio", "pitch_ratio", "open_water",
            "bollard", "advance", "diameter", "speed", "astern", "deadband", "lag", "inertia",
            "torque", "wake", "ventilation", "recovery",
        ),
        _ACTUATOR | _PASSIVE,
    ),
)  # fmt: skip
"""All plugins, in the order of their numbers, by which MuJoCo's binary files and pickles name them:
new ones come last."""
