"""`sauvc_arena`: the pool of the challenge with its props, as an `MjSpec`."""

from collections.abc import Callable, Mapping

import mujoco

from buoyancy_mj.environments.sauvc.drums import add_ball, add_drums
from buoyancy_mj.environments.sauvc.flares import RIMS, add_flare, add_orange_flare
from buoyancy_mj.environments.sauvc.gates import add_gate, add_qualification_gate
from buoyancy_mj.environments.sauvc.layout import (
    GATE_X,
    LANES,
    QUALIFICATION_GATE_X,
    Layout,
    draw_layout,
)
from buoyancy_mj.environments.sauvc.pool import LENGTH, add_pool, add_start_zone
from buoyancy_mj.errors import SceneError, choices, describe
from buoyancy_mj.hulls.selection import CUSTOM_TEXTS

ORDER_TEXT = "sauvc_flare_order"
"""`<custom><text>` that holds the colours of the flares in the order in which to bump them."""
_START_ZONE = (1.4, 1.4)
_STARTING_LINE = (1.4, 1.0)
"""Length and width of the water before the starting line, a metre of the wall [m]; its length is
assumed, that of the start zone."""
_BALL_HEIGHT = -0.6
"""Height of the ball under the start zone [m]."""


def sauvc_arena(task: str = "course", seed: int | None = None) -> mujoco.MjSpec:
    """Build the arena of the Singapore AUV Challenge, after the rulebook of 2026, v6.1.0.

    The water is not in it: its still surface is z = 0, x runs along the pool from the start and y
    to port, and the origin is in the middle. Props on joints float and sway once the model is in
    water, see `add_water`. To put a vehicle in, attach its spec to the arena, or the arena to the
    vehicle; prefixes do not matter to the referee, `mission`.

    Args:
        task: 'course' for the final, with start zone, orange flare, three flares with balls, gate,
            drums with pinger, and a ball to drop; 'qualification' for two lanes with a gate each.
        seed: draws the places of the final's props within the bounds of the rulebook; in the
            qualification props have their places, and the start is in the lane to port for an even
            seed, to starboard for an odd one. None for the places of its figures.

    Raises:
        SceneError: there is no such task, or the seed is no whole number of 0 or more.

    Example:
        >>> arena = sauvc_arena("course", seed=3)
        >>> model = arena.compile()
        >>> model.site("pinger").name
        'pinger'
    """
    if task not in _BUILDERS:
        raise SceneError(f"there is no task {describe(task)}; {choices(task, _BUILDERS)}")
    spec = mujoco.MjSpec()
    spec.modelname = f"sauvc_{task}"
    add_pool(spec)
    _BUILDERS[task](spec, draw_layout(seed), seed)
    return spec


def _add_course(spec: mujoco.MjSpec, layout: Layout, _: int | None) -> None:
    """Add the props of the final."""
    add_start_zone(spec, layout.start, _START_ZONE)
    add_orange_flare(spec, layout.orange_flare)
    for colour, place in layout.flares.items():
        add_flare(spec, colour, place)
    add_gate(spec, (GATE_X, layout.gate))
    add_drums(spec, layout)
    add_ball(spec, (*layout.start, _BALL_HEIGHT))
    spec.add_text(name=CUSTOM_TEXTS["geoms"], data=RIMS)
    spec.add_text(name=ORDER_TEXT, data=" ".join(layout.order))


def _add_qualification(spec: mujoco.MjSpec, _: Layout, seed: int | None) -> None:
    """Add both lanes of the qualification, with the start before one of them."""
    lanes = list(LANES)
    lane = LANES[lanes[(seed or 0) % len(lanes)]]
    length, _width = _STARTING_LINE
    add_start_zone(spec, (0.5 * (length - LENGTH), lane), _STARTING_LINE)
    for name, y in LANES.items():
        add_qualification_gate(spec, name, (QUALIFICATION_GATE_X, y))


_BUILDERS: Mapping[str, Callable[[mujoco.MjSpec, Layout, int | None], None]] = {
    "course": _add_course,
    "qualification": _add_qualification,
}
"""What puts the props of each task into a pool."""
TASKS = tuple(_BUILDERS)
"""Names of the tasks."""
