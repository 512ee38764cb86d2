"""`DampingArrays`: the damping of all bodies of a model, as the kernels read it.

The model gives it, or it is estimated from the hulls as `Damping` chooses.
"""

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import ModelError
from buoyancy_mj.hulls.custom import read_numerics
from buoyancy_mj.hulls.hull import Hull, combine_volumes, group_by_body
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.hulls.welds import WeldedGroup, group_welded_bodies
from buoyancy_mj.kernels.damping import DampingArrays, WeldedGroups
from buoyancy_mj.kernels.facets import FACE_ROWS
from buoyancy_mj.kernels.hulls import Hulls
from buoyancy_mj.kernels.panels import LENGTH
from buoyancy_mj.loads.damping import Damping, Panels, Silhouette
from buoyancy_mj.loads.exposure import gather_faces, measure_exposure
from buoyancy_mj.loads.groups import join, join_hulls
from buoyancy_mj.loads.matrices import check_eigenvalues
from buoyancy_mj.loads.silhouettes import Silhouettes, estimate_drag, measure_silhouettes
from buoyancy_mj.meshes.mesh import TriMesh

_ENTRIES = {3: "heave, roll, pitch", 6: "surge, sway, heave, roll, pitch, yaw"}
"""Names of the entries of damping, by their number."""


class _Viscous(NamedTuple):
    """Viscous drag of one body: its rows of `DampingArrays`, zero but for one kind of drag."""

    linear: NDArray[np.float64] = np.zeros(6)
    quadratic: NDArray[np.float64] = np.zeros(6)
    matrices: NDArray[np.float64] | None = None
    panels: NDArray[np.float64] = np.zeros(5)


class _Shape(NamedTuple):
    """The hulls of one body, in its frame."""

    meshes: list[TriMesh]
    dragging: list[TriMesh]
    """Those whose shape makes drag: a foil has its own."""
    volume: float
    """Volume that they displace [m^3]."""
    centre: NDArray[np.float64]
    """Its centroid (3,) [m]."""

    def silhouettes(self, meshes: list[TriMesh]) -> Silhouettes:
        return measure_silhouettes(meshes, self.centre)


def resolve_damping(
    damping: Damping,
    model: mujoco.MjModel,
    hulls: Sequence[Hull],
    density: float,
    packed: Hulls | None = None,
    dragging: Sequence[Hull] | None = None,
) -> DampingArrays:
    """Find the damping of the bodies that have hulls.

    Args:
        damping: the user's choice.
        model: any model.
        hulls: its hulls.
        density: of the water [kg/m^3], for estimates.
        packed: the same hulls as kernels read them, for drag by panels.
        dragging: the hulls without those geoms that are foils, whose drag is no estimate's; None
            for all.

    Raises:
        ModelError: a body without mass, or numerics of the model that make no sense.
    """
    # the bodies with what is welded to them, and their shapes
    by_body = group_by_body(hulls)
    bodies = list(by_body)
    members = [np.flatnonzero(model.body_weldid == body) for body in bodies]
    for body, group in zip(bodies, members, strict=True):
        _check_mass(model, body, group)
    without_foils = group_by_body(hulls if dragging is None else dragging)
    shapes = {
        body: _Shape(
            [hull.mesh_in_body for hull in group],
            [hull.mesh_in_body for hull in without_foils.get(body, [])],
            *combine_volumes(group),
        )
        for body, group in by_body.items()
    }

    # what slows each of them down, and what welds hold together
    radiation = _resolve_radiation(damping, model, shapes)
    viscous, groups, of_groups = _resolve_viscous(damping, model, shapes, density)
    panels = np.stack([drag.panels for drag in viscous])
    faces, shifts = np.zeros((FACE_ROWS, 0)), np.zeros(0, np.int64)
    if panels.any() and packed is not None:
        exposure = measure_exposure(packed, hulls, groups)
        faces, shifts = gather_faces(packed, exposure), exposure.shifts
    group_of = {body: i for i, group in enumerate(groups) for body in group.places}
    own_hulls, hull_starts = join_hulls(hulls, bodies)
    all_members, member_starts = join(members)
    return DampingArrays(
        bodies=np.array(bodies),
        volumes=np.array([shape.volume for shape in shapes.values()]),
        linear=np.stack([drag.linear for drag in viscous]),
        quadratic=np.stack([drag.quadratic for drag in viscous]),
        coupled=np.array([drag.matrices is not None for drag in viscous], np.int64),
        matrices=np.stack(
            [np.zeros(72) if drag.matrices is None else drag.matrices for drag in viscous]
        ),
        radiation=radiation,
        panels=panels if panels.any() else panels[:0],
        owners=_list_owners(hulls, hulls if dragging is None else dragging),
        members=all_members,
        member_starts=member_starts,
        hulls=own_hulls,
        hull_starts=hull_starts,
        group=np.array([group_of.get(body, -1) for body in bodies]),
        welded=_arrange_groups(groups, bodies, of_groups),
        faces=faces,
        shifts=shifts,
    )


def _arrange_groups(
    groups: Sequence[WeldedGroup], bodies: Sequence[int], drags: Sequence[_Viscous]
) -> WeldedGroups:
    """Groups as kernels read them, with the drag of each; `bodies` are those of the rows."""
    return WeldedGroups(
        rows=np.array([bodies.index(body) for group in groups for body in group.places], np.int64),
        starts=np.cumsum([0, *(len(group.places) for group in groups)]),
        welds=np.array([weld for group in groups for weld in group.welds], np.int64),
        weld_starts=np.cumsum([0, *(len(group.welds) for group in groups)]),
        linear=np.array([drag.linear for drag in drags]).reshape(-1, 6),
        quadratic=np.array([drag.quadratic for drag in drags]).reshape(-1, 6),
        lengths=np.array([drag.panels[LENGTH] for drag in drags]),
    )


def _list_owners(hulls: Sequence[Hull], dragging: Sequence[Hull]) -> NDArray[np.int64]:
    """The body of each hull; -1 for one of which no geom makes drag."""
    geoms = {geom for hull in dragging for geom in hull.geoms}
    owners = [hull.body if geoms.intersection(hull.geoms) else -1 for hull in hulls]
    return np.array(owners, np.int64)


def _check_mass(model: mujoco.MjModel, body: int, members: NDArray[np.int64]) -> None:
    """Refuse a body that has no mass, together with what is welded to it."""
    mass = float(model.body_mass[members].sum())
    if not mass > 0.0:
        raise ModelError(
            f"body '{body_name(model, body)}' displaces water and has a mass of {mass:g} kg; "
            "give it a mass, or leave its geoms out (--geoms)"
        )


def _resolve_radiation(
    damping: Damping, model: mujoco.MjModel, shapes: Mapping[int, _Shape]
) -> NDArray[np.float64]:
    """Radiation damping that the model gives, and the silhouette from above, by body (n, 4)."""
    rows = np.zeros((len(shapes), 4))
    numerics = read_numerics(model, "radiation_damping", list(shapes)) if damping.radiation else {}
    for row, (body, shape) in zip(rows, shapes.items(), strict=True):
        if body in numerics:
            row[:3] = _check_numbers(model, body, "radiation", numerics[body], (3,))
            row[3] = shape.silhouettes(shape.meshes).areas[2]
    return rows


def _resolve_viscous(
    damping: Damping, model: mujoco.MjModel, shapes: Mapping[int, _Shape], density: float
) -> tuple[list[_Viscous], tuple[WeldedGroup, ...], list[_Viscous]]:
    """Viscous drag of each body: what the model gives, or else an estimate.

    Returns:
        The drag of the bodies; the groups of those that are estimated and that welds hold together;
        and the drag of the groups.
    """
    linear = read_numerics(model, "linear_damping", list(shapes))
    quadratic = read_numerics(model, "quadratic_damping", list(shapes))
    gravity = float(np.linalg.norm(model.opt.gravity))
    given = linear.keys() | quadratic.keys()
    estimated = [body for body in shapes if body not in given and damping.viscous is not None]
    groups = group_welded_bodies(model, estimated)
    together = [_join_shapes(shapes, group) for group in groups]
    drags = []
    for body, shape in shapes.items():
        if body in given and damping.viscous is not None:
            drag = _read_viscous(model, body, linear.get(body), quadratic.get(body))
        else:
            drag = _estimate(damping.viscous, shape, density, gravity)
        drags.append(drag)
    of_groups = [_estimate(damping.viscous, whole, density, gravity) for whole in together]
    return drags, groups, of_groups


def _estimate(
    viscous: Silhouette | Panels | None, shape: _Shape, density: float, gravity: float
) -> _Viscous:
    """Drag as the user chose to estimate it; none of what has no hulls but foils."""
    if viscous is None or not shape.dragging:
        return _Viscous()
    if isinstance(viscous, Panels):
        return _prepare_panels(viscous, shape, density)
    return _estimate_viscous(viscous, shape, density, gravity)


def _join_shapes(shapes: Mapping[int, _Shape], group: WeldedGroup) -> _Shape:
    """The hulls of all bodies of a group, in the frame of the first."""
    members = [(shapes[body], *place) for body, place in group.places.items()]
    volumes = np.array([shape.volume for shape, _, _ in members])
    centres = [position + rotation @ shape.centre for shape, rotation, position in members]
    return _Shape(
        [mesh.transformed(turn, at) for shape, turn, at in members for mesh in shape.meshes],
        [mesh.transformed(turn, at) for shape, turn, at in members for mesh in shape.dragging],
        float(volumes.sum()),
        volumes @ centres / volumes.sum(),
    )


def _read_viscous(
    model: mujoco.MjModel,
    body: int,
    linear: NDArray[np.float64] | None,
    quadratic: NDArray[np.float64] | None,
) -> _Viscous:
    """Drag that the model gives, as diagonals if both parts are, otherwise as matrices."""
    parts = [
        np.zeros(6) if numbers is None else _check_numbers(model, body, kind, numbers, (6, 36))
        for kind, numbers in (("linear", linear), ("quadratic", quadratic))
    ]
    if all(len(numbers) == 6 for numbers in parts):
        return _Viscous(linear=parts[0], quadratic=parts[1])
    rows = [np.diag(numbers).ravel() if len(numbers) == 6 else numbers for numbers in parts]
    return _Viscous(matrices=np.concatenate(rows))


def _prepare_panels(panels: Panels, shape: _Shape, density: float) -> _Viscous:
    """Drag by panels, which the kernel finds in each step from these numbers."""
    vertices = np.vstack([mesh.vertices for mesh in shape.dragging])
    length = float(np.ptp(vertices, axis=0).max())
    leading = panels.coefficient * 2.0 / 3.0
    trailing = panels.coefficient / 3.0
    return _Viscous(panels=np.array([leading, trailing, length, panels.viscosity, density]))


def _estimate_viscous(
    silhouette: Silhouette, shape: _Shape, density: float, gravity: float
) -> _Viscous:
    """Drag estimated from silhouettes; its linear part equals the quadratic one at a low speed."""
    silhouettes = shape.silhouettes(shape.dragging)
    quadratic = estimate_drag(silhouette.coefficient, silhouette.friction, density, silhouettes)
    slow = silhouette.linear_froude * math.sqrt(gravity * silhouettes.length)
    slow_turn = slow / (0.5 * silhouettes.length)
    return _Viscous(linear=quadratic * np.repeat([slow, slow_turn], 3), quadratic=quadratic)


def _check_numbers(
    model: mujoco.MjModel,
    body: int,
    kind: str,
    numbers: NDArray[np.float64],
    sizes: tuple[int, ...],
) -> NDArray[np.float64]:
    """Damping that the model gives, if it is one of some numbers of coefficients, or a matrix."""
    what = f"the {kind} damping of body '{body_name(model, body)}'"
    is_matrix = len(numbers) == 36
    possible = len(numbers) in sizes and np.isfinite(numbers).all()
    if not possible or (not is_matrix and not (numbers >= 0.0).all()):
        or_matrix = ", or all 36 of a matrix" if 36 in sizes else ""
        raise ModelError(
            f"{what} is {numbers.tolist()}; it must be {sizes[0]} numbers of at least 0: "
            f"{_ENTRIES[sizes[0]]}{or_matrix} (Fossen's X_u, X_uu have the other sign)"
        )
    if is_matrix:
        check_eigenvalues(numbers.reshape(6, 6), what)
    return numbers
