"""Which bodies active welds hold together, and where they hold them."""

import itertools
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.hulls.bodies import Bond, find_moving_bodies, list_bonds
from buoyancy_mj.meshes.components import label_components

_WELD = int(mujoco.mjtEq.mjEQ_WELD)
_SITE = int(mujoco.mjtObj.mjOBJ_SITE)


class Place(NamedTuple):
    """Where a body stands in the frame of another."""

    rotation: NDArray[np.float64]
    """Rotation (3, 3) from its frame to the other's."""
    position: NDArray[np.float64]
    """Its origin (3,) [m]."""

    def after(self, inner: "Place") -> "Place":
        """The place of what has a place in the frame of this one."""
        return Place(self.rotation @ inner.rotation, self.position + self.rotation @ inner.position)

    def inverse(self) -> "Place":
        """The place of the other body in this one's frame."""
        return Place(self.rotation.T, -self.rotation.T @ self.position)


class WeldedGroup(NamedTuple):
    """Bodies that move as one, since welds hold them together."""

    places: Mapping[int, Place]
    """Where each body is held, in the frame of the first, by its index in the order of the model.

    Only bodies that were asked for are there."""
    welds: tuple[int, ...]
    """Indices of the equality constraints that hold them."""


def group_welded_bodies(model: mujoco.MjModel, bodies: Sequence[int]) -> tuple[WeldedGroup, ...]:
    """Find which of some bodies active welds hold together, directly or through others.

    Welds to the world, to static bodies and to mocap bodies join nothing. The places are those that
    the welds demand, whatever the pose in the file.

    Args:
        model: any model.
        bodies: indices of the bodies that are asked for, none of them without a joint.
    """
    moving = find_moving_bodies(model)
    welds = [
        bond
        for bond in list_bonds(model)
        if model.eq_type[bond.equality] == _WELD and moving[list(bond.bodies)].all()
    ]
    if not welds:
        return ()

    # what moves as one, by the bodies that have joints
    ends = np.array([model.body_weldid[list(weld.bodies)] for weld in welds], np.int64)
    labels = label_components(ends, model.nbody)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    groups = []
    for label in dict.fromkeys(labels[ends[:, 0]].tolist()):
        wanted = [body for body in sorted(bodies) if labels[body] == label]
        if len(wanted) > 1:
            held = [
                weld for weld, (end, _) in zip(welds, ends, strict=True) if labels[end] == label
            ]
            places = _find_places(model, data, held, wanted[0])
            groups.append(
                WeldedGroup(
                    {body: places[body] for body in wanted}, tuple(weld.equality for weld in held)
                )
            )
    return tuple(groups)


def _find_places(
    model: mujoco.MjModel, data: mujoco.MjData, welds: Sequence[Bond], first: int
) -> dict[int, Place]:
    """The place of each body that welds reach from a first one, in its frame."""
    steps: dict[int, list[tuple[int, Place]]] = {}
    for weld in welds:
        # from the carrier of the one body to that of the other
        one, two = (int(model.body_weldid[body]) for body in weld.bodies)
        in_one, in_two = (
            _place_of(data, body, carrier)
            for body, carrier in zip(weld.bodies, (one, two), strict=True)
        )
        place = in_one.after(_read_weld(model, weld)).after(in_two.inverse())
        steps.setdefault(one, []).append((two, place))
        steps.setdefault(two, []).append((one, place.inverse()))
    places = {first: Place(np.eye(3), np.zeros(3))}
    reached = [first]
    for body in itertools.chain(reached):
        for other, place in steps[body]:
            if other not in places:
                places[other] = places[body].after(place)
                reached.append(other)
    return places


def _place_of(data: mujoco.MjData, body: int, carrier: int) -> Place:
    """Where a body stands in the frame of the body that carries it rigidly."""
    turn = data.xmat[carrier].reshape(3, 3).T
    return Place(
        turn @ data.xmat[body].reshape(3, 3), turn @ (data.xpos[body] - data.xpos[carrier])
    )


def _read_weld(model: mujoco.MjModel, weld: Bond) -> Place:
    """Where a weld holds its second body, in the frame of its first.

    A weld of sites lays one on the other; one of bodies holds a point of the second, its anchor, at
    a place in the first.
    """
    i = weld.equality
    if model.eq_objtype[i] == _SITE:
        one, two = (
            Place(_rotation(model.site_quat[site]), model.site_pos[site])
            for site in (int(model.eq_obj1id[i]), int(model.eq_obj2id[i]))
        )
        return one.after(two.inverse())
    anchor, position, quaternion = np.split(model.eq_data[i, :10], [3, 6])
    rotation = _rotation(quaternion)
    return Place(rotation, position - rotation @ anchor)


def _rotation(quaternion: NDArray[np.float64]) -> NDArray[np.float64]:
    """The rotation matrix (3, 3) of a quaternion (4,)."""
    matrix = np.empty(9)
    mujoco.mju_quat2Mat(matrix, quaternion / np.linalg.norm(quaternion))
    return matrix.reshape(3, 3)
