"""The gates: that of the final stands on the floor, those of the qualification hang from a line."""

import mujoco

from buoyancy_mj.environments.sauvc.added_mass import Rod, state_rods
from buoyancy_mj.environments.sauvc.pool import STILL, SWAYING, add_volume, find_depth

WIDTH = 1.5
"""Width over the outsides of the posts [m]."""
HEIGHT = 1.0
"""Height of the final's opening, from the floor to the underside of the bar [m]."""
PIPE = 0.04
"""Thickness of posts and bars [m]."""

_RED = (0.9, 0.05, 0.05, 1.0)
_GREEN = (0.05, 0.85, 0.1, 1.0)
_BLACK = (0.05, 0.05, 0.05, 1.0)
_WHITE = (0.95, 0.95, 0.95, 1.0)
_ORANGE = (1.0, 0.6, 0.0, 1.0)
_STRIPES = (0.06, 0.16, 0.10, 0.20, 0.10, 0.20, 0.10, 0.08)
"""Heights of a post's stripes from the floor up [m], after the figure; white, then in turn the
colour of the side and black."""
_PIPE_DENSITY = 1400.0
"""Density of the posts that hang, PVC [kg/m^3]; they are taken as solid, which is assumed."""


def add_gate(spec: mujoco.MjSpec, place: tuple[float, float]) -> None:
    """Add the gate of the final, with its opening as the site 'gate'.

    It is fixed to the floor, which is assumed: the real one stands by its weight. Its red post is
    to port and its green one to starboard for who comes from the start.

    Args:
        spec: the arena.
        place: its middle (2,) [m].
    """
    x, y = place
    floor = -find_depth(x)
    body = spec.worldbody.add_body(name="gate", pos=[x, y, floor])
    for name, side, colour in (("port", 1.0, _RED), ("starboard", -1.0, _GREEN)):
        foot = 0.0
        for number, height in enumerate(_STRIPES):
            rgba = _WHITE if number == 0 else colour if number % 2 else _BLACK
            body.add_geom(
                name=f"gate_{name}_{number}",
                type=mujoco.mjtGeom.mjGEOM_CYLINDER,
                size=[0.5 * PIPE, 0.5 * height, 0.0],
                pos=[0.0, side * 0.5 * (WIDTH - PIPE), foot + 0.5 * height],
                rgba=rgba,
                contype=STILL,
            )
            foot += height
        body.add_geom(
            name=f"gate_{name}_corner",
            type=mujoco.mjtGeom.mjGEOM_BOX,
            size=[0.5 * PIPE] * 3,
            pos=[0.0, side * 0.5 * (WIDTH - PIPE), HEIGHT + 0.5 * PIPE],
            rgba=colour,
            contype=STILL,
        )
    body.add_geom(
        name="gate_bar",
        type=mujoco.mjtGeom.mjGEOM_BOX,
        size=[0.5 * PIPE, 0.5 * WIDTH - PIPE, 0.5 * PIPE],
        pos=[0.0, 0.0, HEIGHT + 0.5 * PIPE],
        rgba=_BLACK,
        contype=STILL,
    )
    half = [0.5 * PIPE, 0.5 * WIDTH - PIPE, 0.5 * HEIGHT]
    add_volume(body, "gate", [0.0, 0.0, 0.5 * HEIGHT], half)


def add_qualification_gate(spec: mujoco.MjSpec, lane: str, place: tuple[float, float]) -> None:
    """Add a gate that hangs from the surface to the floor, its opening the site 'gate_LANE'.

    Its bar lies on the water, on a line across the pool, and its posts swing about the bar, which
    is assumed; they end 2 cm above the floor.

    Args:
        spec: the arena.
        lane: name of the lane.
        place: the middle of the gate (2,) [m].
    """
    x, y = place
    length = find_depth(x) - 0.02
    body = spec.worldbody.add_body(name=f"gate_{lane}", pos=[x, y, 0.5 * PIPE])
    body.add_joint(
        name=f"gate_{lane}",
        type=mujoco.mjtJoint.mjJNT_HINGE,
        axis=[0.0, 1.0, 0.0],
        damping=[0.5, 0.0, 0.0],
    )
    for name, side in (("port", 1.0), ("starboard", -1.0)):
        body.add_geom(
            name=f"gate_{lane}_{name}",
            type=mujoco.mjtGeom.mjGEOM_CYLINDER,
            size=[0.5 * PIPE, 0.5 * length, 0.0],
            pos=[0.0, side * 0.5 * (WIDTH - PIPE), -0.5 * (length + PIPE)],
            rgba=_ORANGE,
            density=_PIPE_DENSITY,
            contype=SWAYING,
        )
    body.add_geom(
        name=f"gate_{lane}_bar",
        type=mujoco.mjtGeom.mjGEOM_BOX,
        size=[0.5 * PIPE, 0.5 * WIDTH, 0.5 * PIPE],
        rgba=_WHITE,
        density=_PIPE_DENSITY,
        contype=SWAYING,
    )
    posts = [(0.0, side * 0.5 * (WIDTH - PIPE)) for side in (-1.0, 1.0)]
    low, high = -length - 0.5 * PIPE, -0.5 * PIPE
    rods = [Rod((*post, low), (*post, high), 0.5 * PIPE) for post in posts]
    state_rods(spec, f"gate_{lane}", rods)
    half = [0.5 * PIPE, 0.5 * WIDTH - PIPE, 0.5 * length]
    add_volume(body, f"gate_{lane}", [0.0, 0.0, -0.5 * (length + PIPE)], half)
