"""The pool: 25 m by 16 m, 1.2 m deep at its ends and 1.6 m in the middle, water at z = 0."""

import math

import mujoco

LENGTH = 25.0
"""Length of the pool along x [m]."""
WIDTH = 16.0
"""Width of the pool along y [m]."""
DEEPEST = 1.6
"""Depth in the middle [m]."""
SHALLOWEST = 1.2
"""Depth at both ends [m]."""
STILL = 0
"""`contype` of what does not move: it touches what wants to touch it, and no prop on a joint."""
SWAYING = 2
"""`contype` of props on joints: they touch vehicles and balls, and neither floor nor each other."""

_SLOPE = (DEEPEST - SHALLOWEST) / (0.5 * LENGTH)
_THICK = 0.2
_TILES = (0.55, 0.75, 0.82, 1.0)
_MARKING = (0.95, 0.95, 0.95, 1.0)
_HIDDEN = 4
"""Group of sites that say where something is, and are not drawn by default."""


def find_depth(x: float) -> float:
    """Depth of the still water [m] at a place along the pool [m]."""
    return DEEPEST - _SLOPE * abs(x)


def add_pool(spec: mujoco.MjSpec) -> None:
    """Add floor, walls, and the site 'pool', a box around the water and a metre of air over it."""
    world = spec.worldbody
    half = (0.5 * LENGTH, 0.5 * WIDTH)
    tilt = math.atan(_SLOPE)

    # two slabs, whose upper faces meet in the middle; each reaches under the walls
    for name, side in (("floor_start", -1.0), ("floor_far", 1.0)):
        middle = 0.5 * half[0]
        world.add_geom(
            name=name,
            type=mujoco.mjtGeom.mjGEOM_BOX,
            size=[middle / math.cos(tilt), half[1] + _THICK, 0.5 * _THICK],
            pos=[
                side * (middle + 0.5 * _THICK * math.sin(tilt)),
                0.0,
                -find_depth(middle) - 0.5 * _THICK * math.cos(tilt),
            ],
            quat=[math.cos(0.5 * tilt), 0.0, -side * math.sin(0.5 * tilt), 0.0],
            rgba=_TILES,
            contype=STILL,
            friction=[0.6, 0.005, 0.0001],
        )
    for name, axis, side in (
        ("wall_start", 0, -1.0),
        ("wall_far", 0, 1.0),
        ("wall_starboard", 1, -1.0),
        ("wall_port", 1, 1.0),
    ):
        size = [0.5 * _THICK, half[1] + _THICK, 1.0]
        place = [0.0, 0.0, -0.6]
        if axis == 1:
            size = [half[0], 0.5 * _THICK, 1.0]
        place[axis] = side * (half[axis] + 0.5 * _THICK)
        world.add_geom(
            name=name,
            type=mujoco.mjtGeom.mjGEOM_BOX,
            size=size,
            pos=place,
            rgba=_TILES,
            contype=STILL,
            friction=[0.6, 0.005, 0.0001],
        )
    add_volume(world, "pool", [0.0, 0.0, 0.5 * (1.0 - DEEPEST)], [*half, 0.5 * (1.0 + DEEPEST)])


def add_start_zone(
    spec: mujoco.MjSpec, middle: tuple[float, float], size: tuple[float, float]
) -> None:
    """Add the start zone: a frame that is marked on the surface, and the site 'start_zone'.

    Args:
        spec: the arena.
        middle: its middle (2,) [m].
        size: its length and width (2,) [m].
    """
    world = spec.worldbody
    (x, y), (length, width) = middle, size
    for number, (dx, dy, along, across) in enumerate(
        (
            (-0.5 * length, 0.0, 0.02, 0.5 * width),
            (0.5 * length, 0.0, 0.02, 0.5 * width),
            (0.0, -0.5 * width, 0.5 * length, 0.02),
            (0.0, 0.5 * width, 0.5 * length, 0.02),
        )
    ):
        world.add_geom(
            name=f"start_zone_{number}",
            type=mujoco.mjtGeom.mjGEOM_BOX,
            size=[along, across, 0.005],
            pos=[x + dx, y + dy, 0.0],
            rgba=_MARKING,
            contype=0,
            conaffinity=0,
        )
    add_volume(world, "start_zone", [x, y, 0.0], [0.5 * length, 0.5 * width, DEEPEST])


def add_volume(
    body: mujoco.MjsBody,
    name: str,
    place: list[float],
    half: list[float],
    *,
    is_round: bool = False,
) -> None:
    """Add a site that says where something is: a box of half sizes (3,) [m], or a cylinder.

    Args:
        body: what it moves with.
        name: its name.
        place: its middle (3,) [m].
        half: half sizes (3,) [m] of a box; radius and half height (2,) [m] of a cylinder.
        is_round: whether it is a cylinder.
    """
    kind = mujoco.mjtGeom.mjGEOM_CYLINDER if is_round else mujoco.mjtGeom.mjGEOM_BOX
    size = [*half, 0.0] if is_round else half
    body.add_site(
        name=name, type=kind, pos=place, size=size, group=_HIDDEN, rgba=[1.0, 1.0, 1.0, 0.2]
    )
