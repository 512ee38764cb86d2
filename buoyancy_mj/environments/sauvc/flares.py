"""The flares: three rods with a golf ball on top, and the orange one that nobody may touch."""

import math

import mujoco

from buoyancy_mj.environments.sauvc.added_mass import Rod, state_ball, state_rods
from buoyancy_mj.environments.sauvc.pool import SWAYING, find_depth

HEIGHT = 0.8
"""Height of a flare that carries a ball [m]."""
RADIUS = 0.008
"""Radius of its rod [m]."""
BALL_RADIUS = 0.02134
"""Radius of a golf ball [m]: at least 42.67 mm across (R&A, Equipment Rules, 2019)."""
BALL_MASS = 0.0459
"""Mass of a golf ball [kg]: at most 45.93 g (R&A, Equipment Rules, 2019)."""
ORANGE_RADIUS = 0.075
"""Radius of the orange flare [m]."""

RIMS = "!*_flare_rim_*"
"""Word for `<custom><text name="buoyancy_geoms">` that keeps the rims out of the water."""

_COLOURS = {
    "red": (0.8, 0.0, 0.0, 1.0),
    "yellow": (0.95, 0.77, 0.2, 1.0),
    "blue": (0.23, 0.47, 0.85, 1.0),
    "orange": (0.91, 0.58, 0.22, 1.0),
}
_BALL = (0.95, 0.95, 0.95, 1.0)
_BASE_RADIUS = 0.02
_BASE_HEIGHT = 0.01
_RIM = 4
"""Number of beads on the end of a rod, between which its ball rests."""
_RIM_RADIUS = 0.008
_BEAD = 0.003
_ROD_DENSITY = 500.0
"""Density of a rod with the air in it, assumed [kg/m^3]."""
_STIFFNESS = 10.0
"""Stiffness of the joint at its foot, assumed [N m/rad]: it bends by 11 degrees under 5 N in its
middle, and comes back."""
_DAMPING = 0.3
_ORANGE_DENSITY = 200.0
"""Density of the orange flare, a tube of foam, assumed [kg/m^3]."""
_FREEBOARD = 0.05
"""How far the orange flare reaches out of the water [m], about as its figure has it."""
_ORANGE_DAMPING = 5.0


def add_flare(spec: mujoco.MjSpec, colour: str, place: tuple[float, float]) -> None:
    """Add a flare on a springy joint at its foot, and a golf ball that rests on its top.

    The ball lies between beads on the rod's end, and rolls off when the rod tilts or is jerked. The
    site 'COLOUR_flare' is the middle of the resting ball, and 'COLOUR_flare_ball' the ball's body.

    Args:
        spec: the arena.
        colour: name of its colour.
        place: its foot (2,) [m].
    """
    x, y = place
    floor = -find_depth(x)
    name = f"{colour}_flare"
    spec.worldbody.add_geom(
        name=f"{name}_base",
        type=mujoco.mjtGeom.mjGEOM_CYLINDER,
        size=[_BASE_RADIUS, 0.5 * _BASE_HEIGHT, 0.0],
        pos=[x, y, floor + 0.5 * _BASE_HEIGHT],
        rgba=_COLOURS[colour],
        contype=0,
        conaffinity=0,
    )
    rod = spec.worldbody.add_body(name=name, pos=[x, y, floor])
    rod.add_joint(
        name=name,
        type=mujoco.mjtJoint.mjJNT_BALL,
        stiffness=[_STIFFNESS, 0.0, 0.0],
        damping=[_DAMPING, 0.0, 0.0],
    )
    rod.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_CAPSULE,
        size=[RADIUS, 0.5 * HEIGHT - RADIUS, 0.0],
        pos=[0.0, 0.0, 0.5 * HEIGHT],
        rgba=_COLOURS[colour],
        density=_ROD_DENSITY,
        contype=SWAYING,
    )
    _add_rim(rod, name)
    state_rods(spec, name, [Rod((0.0, 0.0, 0.0), (0.0, 0.0, HEIGHT), RADIUS)])

    # the middle of a ball that touches all beads
    reach = BALL_RADIUS + _BEAD
    rise = HEIGHT + math.sqrt(reach * reach - _RIM_RADIUS * _RIM_RADIUS)
    rod.add_site(name=name, pos=[0.0, 0.0, rise], size=[0.005] * 3, group=4)
    ball = spec.worldbody.add_body(name=f"{name}_ball", pos=[x, y, floor + rise])
    ball.add_freejoint(name=f"{name}_ball")
    ball.add_geom(
        name=f"{name}_ball",
        type=mujoco.mjtGeom.mjGEOM_SPHERE,
        size=[BALL_RADIUS, 0.0, 0.0],
        mass=BALL_MASS,
        rgba=_BALL,
        condim=6,
        friction=[0.6, 0.005, 0.002],
    )
    state_ball(spec, f"{name}_ball", BALL_RADIUS)


def add_orange_flare(spec: mujoco.MjSpec, place: tuple[float, float]) -> None:
    """Add the orange flare, a tube of foam that its buoyancy holds upright over its foot.

    Without water it falls over.

    Args:
        spec: the arena.
        place: its foot (2,) [m].
    """
    x, y = place
    floor = -find_depth(x)
    length = _FREEBOARD - floor
    body = spec.worldbody.add_body(name="orange_flare", pos=[x, y, floor])
    body.add_joint(
        name="orange_flare", type=mujoco.mjtJoint.mjJNT_BALL, damping=[_ORANGE_DAMPING, 0.0, 0.0]
    )
    body.add_geom(
        name="orange_flare",
        type=mujoco.mjtGeom.mjGEOM_CYLINDER,
        size=[ORANGE_RADIUS, 0.5 * length, 0.0],
        pos=[0.0, 0.0, 0.5 * length],
        rgba=_COLOURS["orange"],
        density=_ORANGE_DENSITY,
        contype=SWAYING,
    )
    rod = Rod((0.0, 0.0, 0.0), (0.0, 0.0, length), ORANGE_RADIUS)
    state_rods(spec, "orange_flare", [rod])


def _add_rim(rod: mujoco.MjsBody, name: str) -> None:
    """Add the beads around the end of a rod: without friction, a well from which a ball can roll.

    They weigh nothing, and displace nothing, see `RIMS`.
    """
    for number in range(_RIM):
        angle = 2.0 * math.pi * (number + 0.5) / _RIM
        place = [_RIM_RADIUS * math.cos(angle), _RIM_RADIUS * math.sin(angle), HEIGHT]
        rod.add_geom(
            name=f"{name}_rim_{number}",
            type=mujoco.mjtGeom.mjGEOM_SPHERE,
            size=[_BEAD, 0.0, 0.0],
            pos=place,
            rgba=_COLOURS[name.partition("_")[0]],
            mass=0.0,
            contype=SWAYING,
            condim=1,
            priority=1,
        )
