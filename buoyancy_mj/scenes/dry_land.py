"""Dry land in a vehicle's file: ground that would keep the scene's water out is left out.

People draw a vehicle on a floor at z = 0, where a scene has its water. A plane is such ground if it
is level and lies at the water's level or above it, wherever the vehicle is. Any other fixed geom is
if its surface lies so high everywhere under the vehicle and a length of the vehicle around it. What
reaches above the water beside the vehicle, as a quay does, or above the vehicle, as a bridge does,
stays; so does what touches nothing. A mesh counts as its convex hull, since MuJoCo has contacts
with that: a basin in one mesh is full.
"""

import itertools
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import BuoyancyWarning
from buoyancy_mj.hulls.bodies import find_moving_bodies
from buoyancy_mj.hulls.names import geom_kind, geom_name
from buoyancy_mj.scenes.heights import SQUARE, TOUCH, bound_geoms, find_heights
from buoyancy_mj.scenes.specs import compile_spec

_GEOM = mujoco.mjtObj.mjOBJ_GEOM
_AROUND = 3.0
"""How far from the vehicle's middle ground must reach to be left out, over the vehicle's radius."""


class _Ground(NamedTuple):
    """A fixed geom, and how high it lies."""

    geom: mujoco.MjsGeom
    """The geom in the spec of the vehicle."""
    title: str
    """What messages call it."""
    around: NDArray[np.float64]
    """Heights of its surface around the vehicle (n,) [m]; minus infinity where it is not."""


def remove_dry_land(
    spec: mujoco.MjSpec, path: Path, level: float, start: ArrayLike | None = None
) -> None:
    """Remove ground of a vehicle's file that would keep out the water, with a notice for each.

    Args:
        spec: the vehicle, not yet compiled.
        path: its file, for messages.
        level: height of the still water [m].
        start: where the vehicle's first free body will be (3,) [m]; where the file has it if None.

    Raises:
        ModelError: MuJoCo cannot compile the vehicle.
    """
    grounds = _measure_grounds(spec, path, level, start)
    dry = _find_dry(grounds, level)
    for ground, height in dry:
        _warn(
            f"the vehicle's ground {ground.title} at z = {height:g} m would keep out "
            f"the water at {level:g} m and was left out"
        )
        _remove_geom(spec, ground.geom)


def _find_dry(grounds: Sequence[_Ground], level: float) -> list[tuple[_Ground, float]]:
    """Grounds that lie above the water on all lines, each alone or all together.

    Returns:
        Each, with its lowest height where it does lie above the water [m].
    """
    heights = [(ground, ground.around) for ground in grounds]
    dry = [(ground, around) for ground, around in heights if around.min() >= level - TOUCH]
    if not dry and heights:
        together = np.max([around for _, around in heights], axis=0)
        if together.min() >= level - TOUCH:
            dry = [(ground, around) for ground, around in heights if around.max() >= level - TOUCH]
    return [
        (ground, round(float(around[around >= level - TOUCH].min()), 9) + 0.0)
        for ground, around in dry
    ]


def _measure_grounds(
    spec: mujoco.MjSpec, path: Path, level: float, start: ArrayLike | None
) -> list[_Ground]:
    """All that is fixed and can be touched, with its heights about the vehicle."""
    fixed = [geom for geom in _list_fixed_geoms(spec.worldbody) if _touches(geom, spec)]
    if not fixed:
        return []

    # a copy in which the compiler keeps every geom says where all are, however that is written
    copy = spec.copy()
    copy.compiler.fusestatic = copy.compiler.discardvisual = False
    model = compile_spec(copy, path)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    twins = [geom for geom in _list_fixed_geoms(copy.worldbody) if _touches(geom, copy)]

    around = _place_lines(model, data, level, start)
    return [
        _Ground(
            geom,
            f"{geom_kind(model, twin.id)} '{geom_name(model, twin.id)}'",
            find_heights(model, data, twin.id, around),
        )
        for geom, twin in zip(fixed, twins, strict=True)
    ]


def _warn(message: str) -> None:
    """Warn from where the scene is assembled."""
    warnings.warn(message, BuoyancyWarning, stacklevel=5)


def _list_fixed_geoms(body: mujoco.MjsBody) -> list[mujoco.MjsGeom]:
    """Geoms of a body and of those below it that move with it."""
    below = (child for child in body.bodies if not child.joints)
    return [*body.geoms, *itertools.chain.from_iterable(map(_list_fixed_geoms, below))]


def _touches(geom: mujoco.MjsGeom, spec: mujoco.MjSpec) -> bool:
    """Whether a geom can touch anything, so that it keeps a vehicle out of the water."""
    paired = any(geom.name in (pair.geomname1, pair.geomname2) for pair in spec.pairs if geom.name)
    return bool(geom.contype or geom.conaffinity or paired)


def _place_lines(
    model: mujoco.MjModel, data: mujoco.MjData, level: float, start: ArrayLike | None
) -> NDArray[np.float64]:
    """Points (n, 3) [m] around the vehicle from which to look down.

    They lie at the vehicle's top or the water's level, whichever is higher: what is above them, as
    a bridge is, is no ground.
    """
    bounds = _bound_vehicle(model, data, start)
    middle = bounds.mean(axis=0)
    middle[2] = max(bounds[1, 2], level) + TOUCH
    radius = 0.5 * float(np.linalg.norm(np.ptp(bounds[:, :2], axis=0)))
    return np.asarray(middle + _AROUND * radius * SQUARE, float)


def _bound_vehicle(
    model: mujoco.MjModel, data: mujoco.MjData, start: ArrayLike | None
) -> NDArray[np.float64]:
    """Lowest and highest corner (2, 3) [m] of the first tree that is free, or of the first tree."""
    free = model.jnt_bodyid[model.jnt_type == mujoco.mjtJoint.mjJNT_FREE]
    first = int(free[0]) if len(free) else int(np.argmax(find_moving_bodies(model)))
    tree = model.body_treeid == model.body_treeid[first]
    geoms = np.flatnonzero(tree[model.geom_bodyid])

    bounds = bound_geoms(model, data, geoms, data.xpos[first])
    if start is not None and len(free):
        bounds += np.asarray(start, float) - data.xpos[first]
    return bounds


def _remove_geom(spec: mujoco.MjSpec, geom: mujoco.MjsGeom) -> None:
    """Remove a geom, and what refers to it: contact pairs and sensors."""
    if geom.name:
        referring = [
            *(pair for pair in spec.pairs if geom.name in (pair.geomname1, pair.geomname2)),
            *(
                sensor
                for sensor in spec.sensors
                if (sensor.objtype, sensor.objname) == (_GEOM, geom.name)
                or (sensor.reftype, sensor.refname) == (_GEOM, geom.name)
            ),
        ]
        for element in referring:
            spec.delete(element)
    spec.delete(geom)
