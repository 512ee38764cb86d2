"""`find_named`: what a device means by a name, also where its file was attached to another.

MuJoCo puts a prefix and a suffix around all names of a file that it attaches, but not around those
within `<config>`. What stands around the name of the owner tells which are meant.
"""

import mujoco

from buoyancy_mj.errors import ModelError, choices
from buoyancy_mj.hulls.scopes import BASE, Scope, find_scope

_KINDS = {
    mujoco.mjtObj.mjOBJ_BODY: ("body", "nbody"),
    mujoco.mjtObj.mjOBJ_GEOM: ("geom", "ngeom"),
    mujoco.mjtObj.mjOBJ_SITE: ("site", "nsite"),
    mujoco.mjtObj.mjOBJ_SENSOR: ("sensor", "nsensor"),
    mujoco.mjtObj.mjOBJ_ACTUATOR: ("actuator", "nu"),
}
"""What can be named, in words, and how many of them a model has."""


def find_named(model: mujoco.MjModel, kind: mujoco.mjtObj, name: str, owner: str) -> int:
    """The index of what a device means by a name.

    Of several it is the one that has the most in common with the owner: for the owner 'rov/dvl' the
    name 'beacon' means 'rov/beacon' before 'beacon'. A prefix or suffix that no sign such as '/' or
    '_' parts from the name counts only where nothing else is found.

    Args:
        model: the model.
        kind: of what is looked for: a body, geom, site, sensor or actuator.
        name: its name in the file of the owner, or its whole name.
        owner: name of the device that means it; '' where it has none.

    Raises:
        ModelError: there is nothing of that name.
    """
    word, _ = _KINDS[kind]
    names = _list_names(model, kind)
    found: dict[Scope, int] = {}
    for index, full in enumerate(names):
        scope = find_scope(full, name) if name else None
        if scope is not None and (scope == BASE or scope.has(owner)):
            found[scope] = index
    if not found:
        known = [full for full in names if full]
        raise ModelError(f"the model has no {word} named '{name}'; {choices(name, known)}")
    best = max(found, key=lambda scope: (scope == BASE or scope.separates, scope.length))
    return found[best]


def find_by_last_word(model: mujoco.MjModel, kind: mujoco.mjtObj, name: str, owner: str) -> int:
    """The same for a name that nobody stated: under any prefix that ends in '/', or -1 for none."""
    try:
        return find_named(model, kind, name, owner)
    except ModelError:
        names = _list_names(model, kind)
        last = [n for n, full in enumerate(names) if full.rpartition("/")[2] == name]
        return last[0] if last else -1


def _list_names(model: mujoco.MjModel, kind: mujoco.mjtObj) -> list[str]:
    """The names of all of a kind; '' for those without."""
    _, count = _KINDS[kind]
    return [mujoco.mj_id2name(model, kind, i) or "" for i in range(getattr(model, count))]
