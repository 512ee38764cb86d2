"""`PlacedBallast`: the bladders, tanks and compartments of a model, as its actuators state them."""

import dataclasses
import functools
import math
from collections.abc import Mapping, Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import ModelError
from buoyancy_mj.hulls.ballasts import (
    PLUGIN,
    Ballasting,
    Bladder,
    Tank,
    parse_ballast,
)
from buoyancy_mj.hulls.geoms import build_mesh
from buoyancy_mj.hulls.names import body_name, geom_kind, geom_name
from buoyancy_mj.hulls.places import locate_geom
from buoyancy_mj.hulls.plugins import read_instances
from buoyancy_mj.hulls.references import find_named
from buoyancy_mj.hulls.verdicts import SOLID_TYPES
from buoyancy_mj.meshes.fills import FillCurve, TankShape, find_fill
from buoyancy_mj.meshes.mesh import TriMesh

ROUNDING = 1e-6
"""Part of a volume by which a capacity may be beyond it: facets and texts are rounded."""


@dataclasses.dataclass(frozen=True, eq=False)
class PlacedBallast:
    """A bladder, a tank or a compartment on a body of a model."""

    name: str
    """Name of its actuator."""
    ballast: Ballasting
    """What it is."""
    instance: int
    """Index of its plugin instance."""
    actuator: int
    """Index of its actuator."""
    address: int
    """Index of its command in `ctrl`."""
    output: int
    """Index of its actuator in `actuator_force`."""
    state: int
    """Index of its volume among the states of actuators, `data.act`."""
    geom: int
    """Index of its geom."""
    site: int
    """Index of its site: the opening of a compartment, where a tank takes water in."""
    body: int
    """Index of the body it moves with: a body without a joint is part of its parent."""
    mesh: TriMesh
    """Mesh of its geom, in the geom's frame."""
    body_from_geom: NDArray[np.float64]
    """Rotation (3, 3)."""
    position: NDArray[np.float64]
    """Origin of the geom's frame in that of the body (3,) [m]."""

    @property
    def holds_water(self) -> bool:
        """Whether it is a tank or a compartment."""
        return not isinstance(self.ballast, Bladder)

    @property
    def has_level(self) -> bool:
        """Whether its water has a surface that stays level."""
        solid = isinstance(self.ballast, Tank) and self.ballast.solid
        return self.holds_water and not solid

    @property
    def capacity(self) -> float:
        """Most that it holds [m^3]."""
        stated = self.ballast.capacity
        return self.mesh.volume if stated is None else min(stated, self._largest)

    @property
    def _largest(self) -> float:
        return self.mesh.volume if self.holds_water else math.inf

    @functools.cached_property
    def up(self) -> NDArray[np.float64]:
        """The axis along which it fills, in the axes of its geom (3,).

        With a piston that is z of the geom, otherwise z of the body.
        """
        return self.body_from_geom[2].copy() if self.has_level else np.array([0.0, 0.0, 1.0])

    @functools.cached_property
    def curve(self) -> FillCurve:
        """How it fills along that axis, in the frame of its geom."""
        x, y, z = self.up.tolist()
        return find_fill(self.mesh, (x, y, z))

    def find_centroid(
        self, volume: float, rotation: NDArray[np.float64], origin: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Where its water is, or the middle of a bladder's geom (3,) [m], world frame.

        Args:
            volume: of the water [m^3], above 0.
            rotation: world_from_geom (3, 3).
            origin: of the geom's frame (3,) [m], world frame.
        """
        if not self.holds_water:
            centroid = self.mesh.centroid
        elif self.has_level:
            _, centroid = self._shape.find_level(rotation[2], volume)
        else:
            centroid = self.curve.moments(volume)[0] / volume
        return np.asarray(rotation @ centroid + origin, float)

    @functools.cached_property
    def _shape(self) -> TankShape:
        return TankShape(self.mesh)

    def water(self, volume: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """First (3,) [m^4] and second moments (3, 3) [m^5] of its water, in the frame of the body.

        The water lies as it does in an upright body.

        Args:
            volume: of the water [m^3].
        """
        first, second = self.curve.moments(volume)
        turned, shift = self.body_from_geom @ first, self.position
        cross = np.outer(turned, shift)
        return (
            turned + volume * shift,
            self.body_from_geom @ second @ self.body_from_geom.T
            + cross
            + cross.T
            + volume * np.outer(shift, shift),
        )


def find_ballasts(
    model: mujoco.MjModel, bodies: Sequence[int] | None = None
) -> tuple[PlacedBallast, ...]:
    """Find all ballast of a model that changes under way.

    Args:
        model: any model.
        bodies: indices of the bodies on which the water acts; None for all.

    Raises:
        ModelError: ballast that makes no sense, see `place_ballast`; or two waters in one geom.
        MeshError: a geom whose mesh bounds no volume.
    """
    placed = [
        place_ballast(model, instance, texts)
        for instance, texts in read_instances(model, PLUGIN).items()
        if (model.actuator_plugin == instance).any()
    ]
    holders: dict[int, str] = {}
    for one in placed:
        other = holders.setdefault(one.geom, one.name) if one.holds_water else one.name
        if other != one.name:
            raise ModelError(
                f"'{other}' and '{one.name}' both hold water in the geom "
                f"'{geom_name(model, one.geom)}'; give each a geom of its own"
            )
    return tuple(one for one in placed if bodies is None or one.body in bodies)


def place_ballast(model: mujoco.MjModel, instance: int, texts: Mapping[str, str]) -> PlacedBallast:
    """The ballast of one plugin instance of a model.

    Raises:
        ModelError: texts that make no sense, an actuator that is not at a site or keeps another
            number of states, a geom that is none or bounds no volume, that cannot move or moves
            with another body than the site, or a capacity beyond its volume.
        MeshError: a geom whose mesh bounds no volume.
    """
    actuator = _find_actuator(model, instance)
    name = str(model.actuator(actuator).name) or f"ballast {instance}"
    what = f"ballast '{name}'"
    if model.actuator_trntype[actuator] != mujoco.mjtTrn.mjTRN_SITE:
        raise ModelError(f"{what} is not at a site; write site='...', on the body that carries it")
    site = int(model.actuator_trnid[actuator, 0])
    ballast = parse_ballast(texts, str(model.site(site).name) or f"site {site}", what)
    try:
        geom = find_named(model, mujoco.mjtObj.mjOBJ_GEOM, texts["geom"], name)
    except ModelError as error:
        raise ModelError(f"{what}: geom: {error}") from None
    body = int(model.body_weldid[model.geom_bodyid[geom]])
    _check_geom(model, geom, body, what)
    if model.body_weldid[model.site_bodyid[site]] != body:
        raise ModelError(
            f"{what} is at a site of the body "
            f"'{body_name(model, int(model.site_bodyid[site]))}', and its geom moves with "
            f"'{body_name(model, body)}'; put the site there"
        )
    rotation, position = locate_geom(model, geom, body)
    placed = PlacedBallast(
        name=name,
        ballast=ballast,
        instance=instance,
        actuator=actuator,
        address=int(model.actuator_ctrladr[actuator]),
        output=int(model.actuator_outadr[actuator]),
        state=int(model.actuator_actadr[actuator]),
        geom=geom,
        site=site,
        body=body,
        mesh=build_mesh(model, geom),
        body_from_geom=rotation,
        position=position,
    )
    _check_capacity(model, placed, what)
    return placed


def _find_actuator(model: mujoco.MjModel, instance: int) -> int:
    """The actuator of a plugin instance.

    Raises:
        ModelError: several share it.
    """
    actuators = np.flatnonzero(model.actuator_plugin == instance)
    if len(actuators) != 1:
        names = ", ".join(f"'{model.actuator(i).name}'" for i in actuators) or "no actuator"
        raise ModelError(
            f"one instance of '{PLUGIN}' is that of {names}; give each actuator its own instance"
        )
    return int(actuators[0])


def _check_geom(model: mujoco.MjModel, geom: int, body: int, what: str) -> None:
    """Refuse a geom that bounds no volume or cannot move."""
    name = geom_name(model, geom)
    if model.geom_type[geom] not in SOLID_TYPES:
        raise ModelError(
            f"{what} names the geom '{name}', and a {geom_kind(model, geom)} bounds no volume; "
            "name a mesh, box, sphere, ellipsoid, capsule or cylinder"
        )
    if model.body_treeid[body] < 0:
        raise ModelError(
            f"{what} names the geom '{name}', whose body cannot move; give the body a joint"
        )


def _check_capacity(model: mujoco.MjModel, placed: PlacedBallast, what: str) -> None:
    """Refuse a capacity beyond the geom, and another number of states than one."""
    name, volume = geom_name(model, placed.geom), placed.mesh.volume
    stated = placed.ballast.capacity
    if placed.holds_water and stated is not None and stated > (1.0 + ROUNDING) * volume:
        raise ModelError(
            f"{what} has a capacity of {stated:g} m^3, and its geom '{name}' a volume of "
            f"{volume:g} m^3; give it at most that, or make the geom larger"
        )
    if model.actuator_dyntype[placed.actuator] != mujoco.mjtDyn.mjDYN_NONE:
        raise ModelError(f"{what} has a dyntype, which it does not follow; remove it")
    states = model.actuator_actnum[placed.actuator]
    if states != 1:
        raise ModelError(f"{what} keeps {states} states; write actdim='1', for its volume alone")
