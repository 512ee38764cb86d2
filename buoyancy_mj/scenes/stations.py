"""Points of a vehicle at which relative motion is watched: its deck, and its keel at the bow."""

import dataclasses
import fnmatch
import functools

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.kernels.drafts import BODY, FIRST, LAST, NEXT, Corners
from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.scenes.trajectory import Poses

DECK = "deck_edge*"
"""Glob of the sites that are points of the deck."""
BOW = 0.1
"""Share of the length that is the bow."""


@dataclasses.dataclass(frozen=True, eq=False)
class Stations:
    """Points that are fixed to bodies of a vehicle: those of its deck, then those of its keel."""

    bodies: NDArray[np.int64]
    """Index of the body of each (k,)."""
    places: NDArray[np.float64]
    """Each in the frame of its body (k, 3) [m]."""
    decks: int
    """Number of those of the deck."""
    length: float
    """Length of the vehicle along x of its root body [m]."""
    height: float
    """Height along z of it [m]."""

    def locate(self, poses: Poses) -> NDArray[np.float64]:
        """Where they are (k, 3, n) [m], in poses of n instants."""
        located = np.empty((len(self.bodies), 3, len(poses.xpos)))
        for body, own, arms in self._arms:
            turned = arms @ poses.xmat[:, body].T
            located[own] = turned.reshape(len(own), 3, -1) + poses.xpos[:, body].T
        return located

    @functools.cached_property
    def _arms(self) -> list[tuple[int, NDArray[np.int64], NDArray[np.float64]]]:
        """Each body, its points, and what times a rotation (9,) turns them (3 k, 9)."""
        arms = []
        for body in dict.fromkeys(self.bodies.tolist()):
            own = np.flatnonzero(self.bodies == body)
            arm = np.vstack([np.kron(np.eye(3), place) for place in self.places[own]])
            arms.append((body, own, arm))
        return arms


def find_stations(
    model: mujoco.MjModel, data: mujoco.MjData, vehicle: Vehicle, corners: Corners
) -> Stations:
    """Find the points of a vehicle's deck and keel in the poses of data.

    The keel at the bow is the lowest corner in the foremost tenth of its hulls, on each side. The
    deck are the sites called deck_edge*, or else the highest corners there.

    Args:
        model: the model.
        data: its poses at the start.
        vehicle: the vehicle, whose root body has x forward.
        corners: the corners of its hulls.
    """
    # all corners in the frame of the root body
    owners = _list_owners(corners)
    turns = data.xmat.reshape(-1, 3, 3)
    places = np.einsum("nij,nj->ni", turns[owners], corners.corners) + data.xpos[owners]
    places = (places - data.xpos[vehicle.root]) @ turns[vehicle.root]
    x, y, z = places.T
    length = float(np.ptp(x))

    # the foremost, on each side
    foremost = x >= x.max() - BOW * length
    hair = 1e-6 * length
    sides = [np.flatnonzero(foremost & (side * y >= -hair)) for side in (1.0, -1.0)]
    sides = [side for side in sides if len(side)]
    keel = sorted({int(side[np.argmin(z[side])]) for side in sides})
    sites = [
        site
        for site in range(model.nsite)
        if model.site_bodyid[site] in vehicle.bodies
        and fnmatch.fnmatchcase(model.site(site).name, DECK)
    ]
    deck = [] if sites else sorted({int(side[np.argmax(z[side])]) for side in sides})
    return Stations(
        bodies=np.array([*model.site_bodyid[sites], *owners[deck], *owners[keel]], np.int64),
        places=np.vstack([model.site_pos[sites], corners.corners[deck], corners.corners[keel]]),
        decks=len(sites) + len(deck),
        length=length,
        height=float(np.ptp(z)),
    )


def _list_owners(corners: Corners) -> NDArray[np.int64]:
    """The body of each corner (n,)."""
    owners = np.zeros(len(corners.corners), np.int64)
    for box, span in enumerate(corners.spans):
        if span[NEXT] == box + 1:
            owners[span[FIRST] : span[LAST]] = span[BODY]
    return owners
