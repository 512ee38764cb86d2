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
from scipy.spatial import ConvexHull

from buoyancy_mj.errors import BuoyancyWarning
from buoyancy_mj.hulls.bodies import find_moving_bodies
from buoyancy_mj.hulls.names import geom_kind, geom_name
from buoyancy_mj.scenes.specs import compile_spec

_PLANE, _HEIGHT_FIELD, _MESH, _SDF = (
    int(getattr(mujoco.mjtGeom, f"mjGEOM_{name}")) for name in ("PLANE", "HFIELD", "MESH", "SDF")
)
_GEOM = mujoco.mjtObj.mjOBJ_GEOM
_LEVEL_COSINE = 0.95
"""Cosine of the slope up to which a plane counts as level ground."""
_AROUND = 3.0
"""How far from the vehicle's middle ground must reach to be left out, over the vehicle's radius."""
_UNDER = 0.5
"""The same for ground that the vehicle stands on, over half of its beam."""
_LINES = 7
"""Vertical lines along each side of the square on which the height of ground is measured."""
_TOUCH = 1e-9
"""Depth [m] up to which ground counts as level with the water."""


class _Ground(NamedTuple):
    """A fixed geom, and how high it lies."""

    geom: mujoco.MjsGeom
    """The geom in the spec of the vehicle."""
    title: str
    """What messages call it."""
    around: NDArray[np.float64]
    """Heights of its surface around the vehicle (n,) [m]; minus infinity where it is not."""
    under: NDArray[np.float64]
    """The same under the middle of the vehicle, within half of its beam."""


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
    dry = _find_dry([(ground, ground.around) for ground in grounds], level)
    for ground, height in dry:
        _warn(
            f"the vehicle's ground {ground.title} at z = {height:g} m would keep out "
            f"the water at {level:g} m and was left out"
        )
        _remove_geom(spec, ground.geom)
    if dry:
        return

    # what is too small or too round to be left out is told
    for ground in grounds:
        height = round(float(ground.under.max()), 9) + 0.0
        if height >= level - _TOUCH:
            _warn(
                f"the vehicle starts above the {ground.title} of its file, which reaches out of "
                f"the water to z = {height:g} m, and will rest on it"
            )


def _find_dry(
    heights: Sequence[tuple[_Ground, NDArray[np.float64]]], level: float
) -> list[tuple[_Ground, float]]:
    """Grounds that lie above the water on all lines, each alone or all together.

    Returns:
        Each, with its lowest height where it does lie above the water [m].
    """
    dry = [(ground, over) for ground, over in heights if over.min() >= level - _TOUCH]
    if not dry and heights:
        together = np.max([over for _, over in heights], axis=0)
        if together.min() >= level - _TOUCH:
            dry = [(ground, over) for ground, over in heights if over.max() >= level - _TOUCH]
    return [
        (ground, round(float(over[over >= level - _TOUCH].min()), 9) + 0.0) for ground, over in dry
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

    around, under = _place_lines(model, data, level, start)
    return [
        _Ground(
            geom,
            f"{geom_kind(model, twin.id)} '{geom_name(model, twin.id)}'",
            _find_heights(model, data, twin.id, around),
            _find_heights(model, data, twin.id, under),
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
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Points (n, 3) [m] from which to look down: around the vehicle, and over its middle.

    They lie at the vehicle's top or the water's level, whichever is higher: what is above them, as
    a bridge is, is no ground.
    """
    bounds = _bound_vehicle(model, data, start)
    halves = 0.5 * np.ptp(bounds[:, :2], axis=0)
    offsets = np.linspace(-1.0, 1.0, _LINES)
    square = np.array([(x, y, 0.0) for x, y in itertools.product(offsets, offsets)])
    middle = bounds.mean(axis=0)
    middle[2] = max(bounds[1, 2], level) + _TOUCH
    around = _AROUND * float(np.linalg.norm(halves)) * square
    return middle + around, middle + _UNDER * float(halves.min()) * square


def _bound_vehicle(
    model: mujoco.MjModel, data: mujoco.MjData, start: ArrayLike | None
) -> NDArray[np.float64]:
    """Lowest and highest corner (2, 3) [m] of the first tree that is free, or of the first tree."""
    free = model.jnt_bodyid[model.jnt_type == mujoco.mjtJoint.mjJNT_FREE]
    first = int(free[0]) if len(free) else int(np.argmax(find_moving_bodies(model)))
    tree = model.body_treeid == model.body_treeid[first]
    geoms = np.flatnonzero(tree[model.geom_bodyid])

    # boxes around the geoms, turned as these are; without geoms the place of the body
    turns = data.geom_xmat[geoms].reshape(-1, 3, 3)
    middles = data.geom_xpos[geoms] + np.einsum("gij,gj->gi", turns, model.geom_aabb[geoms, :3])
    halves = np.einsum("gij,gj->gi", np.abs(turns), model.geom_aabb[geoms, 3:])
    corners = np.vstack([middles - halves, middles + halves, data.xpos[first][None]])
    bounds = np.array([corners.min(axis=0), corners.max(axis=0)])
    if start is not None and len(free):
        bounds += np.asarray(start, float) - data.xpos[first]
    return bounds


def _find_heights(
    model: mujoco.MjModel, data: mujoco.MjData, geom: int, points: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Heights (n,) [m] of a geom's surface under points (n, 3), minus infinity where there is none.

    A point inside the geom has its top above it. A mesh is its convex hull, as for its contacts.
    """
    kind = int(model.geom_type[geom])
    turn, middle = data.geom_xmat[geom].reshape(3, 3), data.geom_xpos[geom]
    if kind == _PLANE:
        return np.full(len(points), middle[2] if turn[2, 2] > _LEVEL_COSINE else -np.inf)
    if kind == _SDF:
        # it is no ground: its contacts are with the surface that it draws
        return np.full(len(points), -np.inf)
    if kind == _MESH:
        return _find_hull_heights(_list_vertices(model, geom) @ turn.T + middle, points)

    # a height field has one surface, which is found from above it
    box = model.geom_aabb[geom]
    top = float(middle[2] + turn[2] @ box[:3] + np.abs(turn[2]) @ box[3:])
    down, normal = np.array([0.0, 0.0, -1.0]), np.zeros(3)
    heights = []
    for point in points:
        if kind == _HEIGHT_FIELD:
            start = np.array([point[0], point[1], max(point[2], top + 1.0)])
            distance = mujoco.mj_rayHfield(model, data, geom, start, down, normal)
        else:
            start, size = point, model.geom_size[geom]
            distance = mujoco.mju_rayGeom(middle, turn.ravel(), size, start, down, kind, normal)
        below = start[2] - distance if normal[2] > 0.0 else top
        heights.append(below if distance >= 0.0 else -np.inf)
    return np.array(heights)


def _list_vertices(model: mujoco.MjModel, geom: int) -> NDArray[np.float64]:
    """Vertices (n, 3) [m] of the mesh of a geom, in its frame."""
    mesh = model.geom_dataid[geom]
    first = model.mesh_vertadr[mesh]
    return np.asarray(model.mesh_vert[first : first + model.mesh_vertnum[mesh]], float)


def _find_hull_heights(
    vertices: NDArray[np.float64], points: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The same for the convex hull of vertices (m, 3) [m].

    It is where all half spaces n . x + d <= 0 of its facets meet, whose vertical lines have ends.
    """
    equations = ConvexHull(vertices).equations
    upward = equations[:, 2]
    beside = points[:, :2] @ equations[:, :2].T + equations[:, 3]
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = -beside / upward
    upper = np.where(upward > 0.0, ends, np.inf).min(axis=1)
    lower = np.where(upward < 0.0, ends, -np.inf).max(axis=1)
    outside = ((upward == 0.0) & (beside > 0.0)).any(axis=1)
    reached = ~outside & (lower <= upper) & (lower <= points[:, 2])
    return np.where(reached, upper, -np.inf)


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
