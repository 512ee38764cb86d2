"""`Watcher`: what there is to see of a vehicle in an arena, from poses and contacts alone."""

import itertools
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.environments.sauvc.outline import Outline
from buoyancy_mj.environments.sauvc.passages import GateWatch, Passage
from buoyancy_mj.environments.sauvc.props import Props
from buoyancy_mj.sea.water import Water

FALLEN = 0.03
"""How far the ball of a flare has moved from its rest when it has fallen [m]."""


class Sight(NamedTuple):
    """One look at a vehicle in an arena."""

    before: float
    """Time of the look before [s]."""
    time: float
    """Time [s]."""
    passages: tuple[Passage, ...]
    """Gates that it has passed as a whole since then."""
    touched: frozenset[str]
    """What it touches: 'gate', 'bottom', 'wall', 'orange', 'red', 'yellow', 'blue'."""
    fallen: tuple[str, ...]
    """Colours of the flares whose balls have fallen."""
    drum: str | None
    """Name of the drum in which the ball to drop is, let go by the vehicle; None for none."""
    has_ball: bool
    """Whether the vehicle touches the ball to drop."""
    is_breached: bool
    """Whether any of it is out of the water."""
    is_at_start: bool
    """Whether its middle is in the start zone."""
    is_in_pool: bool
    """Whether its middle is between the walls."""


class Watcher:
    """Look at a vehicle in an arena, update by update.

    Args:
        model: the model.
        data: its data.
        props: the props of the arena.
        bodies: indices of the vehicle's bodies, the root body first.
        water: the sea, for its surface.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        props: Props,
        bodies: list[int],
        water: Water,
    ) -> None:
        self.outline = Outline(model, bodies)
        """The corners of the vehicle."""
        self._model, self._data, self._props, self._water = model, data, props, water
        self._root = bodies[0]
        self._is_own = np.isin(model.geom_bodyid, bodies)
        self._is_ball = model.geom_bodyid == (-1 if props.ball is None else props.ball)
        self._crest = float(np.abs(water.rows[:, 0]).sum())
        self._gates = {
            site: GateWatch(name, model.site_size[site, 1:]) for name, site in props.gates.items()
        }
        self._flare_sites = [flare.site for flare in props.flares.values()]
        self._flare_balls = [flare.ball for flare in props.flares.values()]
        self._drums = list(props.drums.values())
        sizes = model.site_size[self._drums, :2]
        self._drum_reach = float((sizes * sizes).sum(axis=1).max(initial=0.0))
        self._areas = [props.start_zone, props.pool]
        self._area_sizes = model.site_size[self._areas, :2]
        self._time = float(data.time)
        self._poses = self.outline.read_poses(data)
        self._frames = self._read_gate_frames()

    def look(self) -> Sight:
        """Look at the vehicle now."""
        data = self._data
        before, self._time = self._time, float(data.time)
        middle, radius = self.outline.bound(data)
        passages = self._follow_gates(before, middle, radius)
        touched, has_ball = self._read_contacts()
        is_at_start, is_in_pool = self._find_areas(middle)
        return Sight(
            before=before,
            time=self._time,
            passages=passages,
            touched=touched,
            fallen=self._list_fallen(),
            drum=None if has_ball else self._find_drum(),
            has_ball=has_ball,
            is_breached=self._is_breached(middle, radius),
            is_at_start=is_at_start,
            is_in_pool=is_in_pool,
        )

    def _read_gate_frames(self) -> dict[int, tuple[NDArray[np.float64], NDArray[np.float64]]]:
        """Middle (3,) [m] and axes (3, 3) of each gate's opening, in the world frame."""
        data = self._data
        return {
            site: (data.site_xpos[site].copy(), data.site_xmat[site].reshape(3, 3).copy())
            for site in self._props.gates.values()
        }

    def _follow_gates(
        self, before: float, middle: NDArray[np.float64], radius: float
    ) -> tuple[Passage, ...]:
        """Follow the vehicle through all gates."""
        frames, self._frames = self._frames, self._read_gate_frames()
        poses, self._poses = self._poses, self.outline.read_poses(self._data)
        bow = self._data.xmat[self._root].reshape(3, 3)[:, 0]
        near = {
            site: gate
            for site, gate in self._gates.items()
            if not gate.is_far(self._measure_distance(site, middle), radius)
        }
        if not near:
            return ()

        # its corners in the frame of each gate
        last, now = self.outline.find_corners(poses), self.outline.find_corners(self._poses)
        passages = []
        for site, gate in near.items():
            (old_place, old_axes), (place, axes) = frames[site], self._frames[site]
            passages.append(
                gate.follow(
                    (last - old_place) @ old_axes,
                    (now - place) @ axes,
                    (before, self._time),
                    float(bow @ axes[:, 0]),
                )
            )
        return tuple(passage for passage in passages if passage is not None)

    def _measure_distance(self, site: int, middle: NDArray[np.float64]) -> float:
        """How far a place (3,) [m] is beyond the plane of a gate [m]."""
        place, axes = self._frames[site]
        return float(axes[:, 0] @ (middle - place))

    def _read_contacts(self) -> tuple[frozenset[str], bool]:
        """What the vehicle touches, and whether it touches the ball to drop."""
        contact = self._data.contact
        pairs = contact.geom
        if not len(pairs):
            return frozenset(), False
        own = self._is_own[pairs]
        is_between = own.any(axis=1) & ~own.all(axis=1)
        if not is_between.any():
            return frozenset(), False

        # the ball clings to the vehicle over a gap
        others = np.where(own[:, 0], pairs[:, 1], pairs[:, 0])
        has_ball = bool(self._is_ball[others[is_between]].any())
        touching = others[is_between & (contact.dist <= 0.0)]
        names = [name for name, of_kind in self._props.kinds.items() if of_kind[touching].any()]
        return frozenset(names), has_ball

    def _list_fallen(self) -> tuple[str, ...]:
        """Colours of the flares whose balls have fallen."""
        arms = self._data.xpos[self._flare_balls] - self._data.site_xpos[self._flare_sites]
        is_fallen = (arms * arms).sum(axis=1) > FALLEN * FALLEN
        return tuple(itertools.compress(self._props.flares, is_fallen.tolist()))

    def _find_drum(self) -> str | None:
        """The drum in which the ball to drop is."""
        if self._props.ball is None:
            return None
        arms = self._data.xpos[self._props.ball] - self._data.site_xpos[self._drums]
        near = np.flatnonzero((arms * arms).sum(axis=1) < self._drum_reach)
        for i in near.tolist():
            site = self._drums[i]
            radius, half = self._model.site_size[site, :2]
            x, y, z = arms[i] @ self._data.site_xmat[site].reshape(3, 3)
            if x * x + y * y <= radius * radius and abs(z) <= half:
                return list(self._props.drums)[i]
        return None

    def _is_breached(self, middle: NDArray[np.float64], radius: float) -> bool:
        """Whether any of the vehicle is out of the water."""
        if middle[2] + radius < self._water.level - self._crest:
            return False
        corners = self.outline.find_corners(self._poses)
        return float(self._water.depth(corners, self._time).min()) < 0.0

    def _find_areas(self, middle: NDArray[np.float64]) -> list[bool]:
        """Whether a place (3,) [m] is in the start zone and in the pool, seen from above."""
        arms = middle - self._data.site_xpos[self._areas]
        own = (arms[:, None] @ self._data.site_xmat[self._areas].reshape(-1, 3, 3))[:, 0, :2]
        within: list[bool] = (np.abs(own) <= self._area_sizes).all(axis=1).tolist()
        return within
