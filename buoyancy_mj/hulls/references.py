"""Names in the configuration of a plugin: what they refer to, in an attached model too."""

from typing import Any

import mujoco

from buoyancy_mj.errors import ModelError, choices, describe


def find_named(model: mujoco.MjModel, kind: str, name: str, owner: str) -> int:
    """The index of an element that a plugin names.

    MuJoCo puts a prefix before the names of an attached model and leaves its configurations as they
    are. So a name counts as one of the owner's own model: 'tank' of the owner 'rov/aft' is
    'rov/tank', and 'tank' where there is no such element.

    Args:
        model: any model.
        kind: 'geom', 'site', 'body', ...
        name: the name in the configuration.
        owner: the name of the sensor or the actuator that the plugin is of.

    Raises:
        ModelError: there is no such element.
    """
    object_type: Any = getattr(mujoco.mjtObj, f"mjOBJ_{kind.upper()}")
    for length in range(len(owner), -1, -1):
        index = mujoco.mj_name2id(model, object_type, owner[:length] + name) if name else -1
        if index >= 0:
            return int(index)
    get, count = getattr(model, kind), getattr(model, f"n{kind}")
    names = [str(get(i).name) for i in range(count)]
    raise ModelError(
        f"'{owner}' names the {kind} {describe(name)}, and there is none; "
        f"{choices(name, [n for n in names if n])}"
    )
