"""`Props`: the props of an arena in a compiled model, found by their names."""

import re
from collections.abc import Mapping
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.environments.sauvc.arena import ORDER_TEXT, TASKS
from buoyancy_mj.environments.sauvc.layout import COLOURS
from buoyancy_mj.errors import ModelError, SceneError, choices, describe

_SITE = mujoco.mjtObj.mjOBJ_SITE
_BODY = mujoco.mjtObj.mjOBJ_BODY
_NEEDED: Mapping[str, tuple[str, ...]] = {
    "course": ("gate", "blue_drum", *(f"{colour}_flare" for colour in COLOURS)),
    "qualification": ("gate_port", "gate_starboard"),
}
"""Sites without which there is no such task."""
_NAMES = re.compile(
    r"pool|start_zone|pinger|ball|gate(_port|_starboard)?|(blue|red)_drum(_\d)?"
    r"|orange_flare|(red|yellow|blue)_flare(_ball)?"
)
"""Names of the arena's sites and bodies: a vehicle may be beside them without a prefix."""


class Flare(NamedTuple):
    """A flare that carries a ball."""

    site: int
    """Index of the site where its ball rests."""
    ball: int
    """Index of the ball's body."""


class Props(NamedTuple):
    """What an arena holds, by index in the model."""

    task: str
    """The task: 'course' or 'qualification'."""
    prefix: str
    """What stands before all names of the arena."""
    pool: int
    """Site of the box around the water."""
    start_zone: int
    """Site of the start zone."""
    gates: Mapping[str, int]
    """Site of the opening of each gate, by its name without the prefix."""
    flares: Mapping[str, Flare]
    """Flares that carry a ball, by colour."""
    order: tuple[str, ...]
    """Colours of the flares in the order in which they are to be bumped."""
    drums: Mapping[str, int]
    """Site of the inside of each drum, by its name without the prefix."""
    pinger: str | None
    """Name of the drum with the pinger."""
    ball: int | None
    """Body of the ball to drop; None without one."""
    bodies: frozenset[int]
    """Bodies of the arena that can move."""
    kinds: Mapping[str, NDArray[np.bool_]]
    """Whether each geom (ngeom,) belongs to a gate, to the bottom, walls or drums ('bottom',
    'wall'), or to a flare ('orange', 'red', ...)."""


def find_props(model: mujoco.MjModel, task: str | None = None) -> Props:
    """Find the props of an arena in a model.

    Args:
        model: a model with an arena in it, under any prefix.
        task: 'course' or 'qualification'; None for the one whose props are there.

    Raises:
        SceneError: there is no such task.
        ModelError: the model has no arena, or not the props of the task.
    """
    if task is not None and task not in TASKS:
        raise SceneError(f"there is no task {describe(task)}; {choices(task, TASKS)}")
    prefix = _find_prefix(model)
    sites = _list_names(model, _SITE, model.nsite, prefix)
    bodies = _list_names(model, _BODY, model.nbody, prefix)

    # the task
    there = [name for name in TASKS if sites.keys() >= set(_NEEDED[name])]
    if task is None and there:
        task = there[0]
    if task not in there:
        wanted = task or TASKS[0]
        missing = ", ".join(f"'{prefix}{name}'" for name in _NEEDED[wanted] if name not in sites)
        raise ModelError(
            f"the task '{wanted}' needs the sites {missing}, which the model does not have; put "
            f"sauvc_arena('{wanted}') into it, as environment = 'sauvc_{wanted}' does in a scene"
        )

    # what the task is about
    drums = {name: i for name, i in sites.items() if "_drum" in name}
    flares = {
        colour: Flare(sites[f"{colour}_flare"], bodies[f"{colour}_flare_ball"])
        for colour in COLOURS
        if task == "course"
    }
    return Props(
        task=task,
        prefix=prefix,
        pool=sites["pool"],
        start_zone=sites["start_zone"],
        gates={name: i for name, i in sites.items() if name.split("_")[0] == "gate"},
        flares=flares,
        order=_read_order(model, prefix) if flares else (),
        drums=drums,
        pinger=_find_pinger(model, sites, drums),
        ball=bodies.get("ball") if task == "course" else None,
        bodies=frozenset(i for i in bodies.values() if model.body_treeid[i] >= 0),
        kinds=_sort_geoms(model, prefix),
    )


def _find_prefix(model: mujoco.MjModel) -> str:
    """What stands before the names of the arena.

    Raises:
        ModelError: there is no arena, or more than one.
    """
    names = {str(model.site(i).name) for i in range(model.nsite)}
    prefixes = [
        name.removesuffix("pool")
        for name in sorted(names)
        if name.endswith("pool") and f"{name.removesuffix('pool')}start_zone" in names
    ]
    if len(prefixes) != 1:
        number = "no arena" if not prefixes else f"{len(prefixes)} arenas"
        raise ModelError(
            f"the model has {number} of the challenge, known by the sites 'pool' and 'start_zone'; "
            "put one sauvc_arena() into it, or environment = 'sauvc_course' into a scene"
        )
    return prefixes[0]


def _list_names(
    model: mujoco.MjModel, kind: mujoco.mjtObj, count: int, prefix: str
) -> dict[str, int]:
    """Elements of the arena by name without the prefix."""
    names = {mujoco.mj_id2name(model, kind, i) or "": i for i in range(count)}
    return {
        name.removeprefix(prefix): i
        for name, i in names.items()
        if name.startswith(prefix) and _NAMES.fullmatch(name.removeprefix(prefix))
    }


def _read_order(model: mujoco.MjModel, prefix: str) -> tuple[str, ...]:
    """Colours of the flares in the order in which they are to be bumped."""
    name = f"{prefix}{ORDER_TEXT}"
    text = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_TEXT, name)
    if text < 0:
        return COLOURS
    start = int(model.text_adr[text])
    data = bytes(model.text_data[start : start + int(model.text_size[text]) - 1])
    return read_order(data.decode().split())


def read_order(colours: object) -> tuple[str, ...]:
    """The colours of the flares in an order, from a sequence of them or from letters as 'R-B-Y'.

    Raises:
        SceneError: it is none.
    """
    words = colours.replace("-", "").lower() if isinstance(colours, str) else colours
    letters = {colour[0]: colour for colour in COLOURS}
    try:
        order = tuple(letters.get(word, word) for word in words)  # type: ignore[attr-defined]
    except TypeError:
        order = ()
    if sorted(map(str, order)) != sorted(COLOURS):
        raise SceneError(
            f"order is {describe(colours)}; it must name each of {', '.join(COLOURS)} once, "
            "as 'R-B-Y'"
        )
    return order


def _find_pinger(
    model: mujoco.MjModel, sites: Mapping[str, int], drums: Mapping[str, int]
) -> str | None:
    """The drum in whose body the pinger is."""
    if "pinger" not in sites:
        return None
    owner = model.site_bodyid[sites["pinger"]]
    return next((name for name, i in drums.items() if model.site_bodyid[i] == owner), None)


def _sort_geoms(model: mujoco.MjModel, prefix: str) -> dict[str, NDArray[np.bool_]]:
    """Whether each geom (ngeom,) is of a kind, by kind."""
    names = [str(model.geom(i).name) for i in range(model.ngeom)]
    own = [name.removeprefix(prefix) if name.startswith(prefix) else "" for name in names]

    def find(matches: list[bool]) -> NDArray[np.bool_]:
        return np.array(matches, bool)

    kinds = {
        "gate": find([name.startswith("gate") for name in own]),
        "bottom": find([name.startswith("floor") or "_drum" in name for name in own]),
        "wall": find([name.startswith("wall") for name in own]),
    }
    for colour in ("orange", *COLOURS):
        flare = f"{colour}_flare"
        is_rod = [name.startswith(flare) and not name.endswith("_ball") for name in own]
        kinds[colour] = find(is_rod)
    return kinds
