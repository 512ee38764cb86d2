"""The drums and the pinger in one of them, and the ball that is dropped into one."""

import math

import mujoco

from buoyancy_mj.environments.sauvc.added_mass import state_ball
from buoyancy_mj.environments.sauvc.layout import DRUM_X, DRUM_YS, Layout
from buoyancy_mj.environments.sauvc.pool import STILL, add_volume, find_depth

RADIUS = 0.3
"""Outer radius of a drum [m]."""
HEIGHT = 0.3
"""Height of a drum [m]."""
BALL_RADIUS = 0.02
"""Radius of the ball to drop [m]; the rulebook has it 3.5 to 4.5 cm across."""
BALL_MASS = 0.1
"""Mass of the ball to drop, assumed [kg]; the rulebook has it 0.2 kg at most."""
GRIP = 5.0
"""Greatest force by which the ball clings to what it touches [N]."""

_BLUE = (0.06, 0.33, 0.6, 1.0)
_RED = (0.6, 0.0, 0.0, 1.0)
_PINGER = (0.2, 0.2, 0.2, 1.0)
_BALL = (1.0, 0.45, 0.05, 1.0)
_FIRM = [0.999, 0.9999, 0.001, 0.5, 2.0]
"""MuJoCo's solimp of the ball: so firm that it does not creep along what it clings to."""
_STAVES = 12
"""Flat boards of which a drum is made: a cylinder of MuJoCo is full."""
_WALL = 0.01
_PINGER_SIZE = (0.0165, 0.05)
"""Radius and half length of a pinger ULB-362B [m], about."""


def add_drums(spec: mujoco.MjSpec, layout: Layout) -> None:
    """Add four drums that stand on the floor, and the pinger.

    The inside of a drum is a site of its name: 'blue_drum', and 'red_drum_1' to 'red_drum_3' from
    port to starboard. The site 'pinger' is in the middle of the pinger, 45 kHz, of which nothing
    but its place is modelled here.
    """
    reds = 0
    for number, y in enumerate(DRUM_YS):
        is_blue = number == layout.blue_drum
        reds += not is_blue
        name = "blue_drum" if is_blue else f"red_drum_{reds}"
        # level, on what is highest of the floor under it
        floor = -find_depth(DRUM_X + RADIUS)
        body = spec.worldbody.add_body(name=name, pos=[DRUM_X, y, floor])
        _add_drum(body, name, _BLUE if is_blue else _RED)
        if number == layout.pinger:
            _add_pinger(body)


def add_ball(spec: mujoco.MjSpec, place: tuple[float, float, float]) -> None:
    """Add the ball to drop, the body 'ball', and the actuator 'ball' that lets go of it.

    The ball clings to whatever it touches while the control is 0, and lets go as the control rises
    to 1: a grip for any vehicle that starts on the ball, and that touches it to pick it up again.

    Args:
        spec: the arena.
        place: its middle (3,) [m].
    """
    ball = spec.worldbody.add_body(name="ball", pos=list(place))
    ball.add_freejoint(name="ball")
    ball.add_geom(
        name="ball",
        type=mujoco.mjtGeom.mjGEOM_SPHERE,
        size=[BALL_RADIUS, 0.0, 0.0],
        mass=BALL_MASS,
        rgba=_BALL,
        condim=6,
        friction=[1.0, 0.01, 0.01],
        priority=1,
        solimp=_FIRM,
        margin=0.004,
        gap=0.004,
    )
    state_ball(spec, "ball", BALL_RADIUS)

    # adhesion of a body, with the force of the control turned round
    actuator = spec.add_actuator(name="ball", target="ball", trntype=mujoco.mjtTrn.mjTRN_BODY)
    actuator.gaintype = mujoco.mjtGain.mjGAIN_FIXED
    actuator.gainprm[0] = -GRIP
    actuator.biastype = mujoco.mjtBias.mjBIAS_AFFINE
    actuator.biasprm[0] = GRIP
    actuator.ctrllimited = True
    actuator.ctrlrange = [0.0, 1.0]


def _add_drum(body: mujoco.MjsBody, name: str, rgba: tuple[float, float, float, float]) -> None:
    """Add the staves, the bottom and the inside of a drum that stands on its body's origin."""
    middle = RADIUS - 0.5 * _WALL
    for number in range(_STAVES):
        angle = 2.0 * math.pi * number / _STAVES
        body.add_geom(
            name=f"{name}_stave_{number}",
            type=mujoco.mjtGeom.mjGEOM_BOX,
            size=[0.5 * _WALL, middle * math.tan(math.pi / _STAVES), 0.5 * HEIGHT],
            pos=[middle * math.cos(angle), middle * math.sin(angle), 0.5 * HEIGHT],
            quat=[math.cos(0.5 * angle), 0.0, 0.0, math.sin(0.5 * angle)],
            rgba=rgba,
            contype=STILL,
        )
    body.add_geom(
        name=f"{name}_bottom",
        type=mujoco.mjtGeom.mjGEOM_CYLINDER,
        size=[middle, 0.5 * _WALL, 0.0],
        pos=[0.0, 0.0, 0.5 * _WALL],
        rgba=rgba,
        contype=STILL,
    )
    add_volume(body, name, [0.0, 0.0, 0.5 * HEIGHT], [RADIUS - _WALL, 0.5 * HEIGHT], is_round=True)


def _add_pinger(drum: mujoco.MjsBody) -> None:
    """Add the pinger that stands in a drum."""
    radius, half = _PINGER_SIZE
    place = [0.0, 0.0, _WALL + half]
    drum.add_geom(
        name="pinger",
        type=mujoco.mjtGeom.mjGEOM_CYLINDER,
        size=[radius, half, 0.0],
        pos=place,
        rgba=_PINGER,
        contype=STILL,
    )
    drum.add_site(name="pinger", pos=place, size=[0.01] * 3, group=4)
