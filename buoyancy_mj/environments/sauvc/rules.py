"""The points of the rulebook, section Tasks, for what a vehicle has done in the final."""

import dataclasses

TIME = 900.0
"""Length of a game [s]."""
NAVIGATION = 15
"""Points for passing the gate."""
DRUMS = {"blue": 30, "pinger": 50, "red": 10}
"""Points for the first ball in a drum: the blue one, the red one with the pinger, another."""
REACQUISITION = 60
"""Points for holding the dropped ball again at the end."""
FLARE = 20
"""Points for each flare whose ball has fallen."""
ORDER = 60
"""Points for all three in the order that was asked for, besides."""
SURFACING = 5
"""Points for ending the attempt by surfacing."""
PER_SECOND = 0.03
"""Points for each second that is left, after the gate and another task [1/s]."""
GATE_TOUCH = 2
"""Points lost for each touch of the gate."""
BOTTOM_TOUCH = 5
"""Points lost for each touch of the bottom, a wall, or the outside of a drum."""
MOST_TOUCHES = 5
"""Touches of bottom and walls that end an attempt."""
MOST_CONTACT = 10.0
"""Time in contact with bottom and walls beyond which an attempt ends [s]."""
BUILD = 10
"""Points for a vehicle that is small, and as many for one that is light."""
SMALL = (0.7, 0.5, 0.5)
"""Length, width and height below which a vehicle is small [m]."""
LIGHT = 42.0
"""Mass below which it is light [kg]."""
LARGEST = (1.4, 1.0, 1.0)
"""Length, width and height of the largest vehicle that may take part [m]."""
HEAVIEST = 52.0
"""Mass of the heaviest [kg]."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Deeds:
    """What a vehicle has done in an attempt at the final."""

    is_through_gate: bool = False
    """Whether it has passed the gate."""
    flares: tuple[str, ...] = ()
    """Colours of the flares whose balls fell after that, in their order."""
    order: tuple[str, ...] = ()
    """Colours in the order that was asked for."""
    drum: str | None = None
    """The drum of the first ball, by the keys of `DRUMS`."""
    has_ball_again: bool = False
    """Whether it held the dropped ball at the end, after another passage of the gate."""
    has_surfaced: bool = False
    """Whether it ended the attempt by surfacing."""
    run_time: float = TIME
    """Length of the attempt [s]."""
    gate_touches: int = 0
    """Touches of the gate."""
    bottom_touches: int = 0
    """Touches of bottom, walls and drums, without the one that ended the attempt."""


def score(deeds: Deeds) -> tuple[tuple[str, float], ...]:
    """The points of an attempt, line by line, as the examples of the rulebook have them.

    Where the text is open, its examples decide: each touch costs, but the one by which an attempt
    is aborted; and who does not surface gets neither the points for that nor those for time.
    """
    rows: list[tuple[str, float]] = []
    is_through = deeds.is_through_gate
    others = 0
    if is_through:
        rows.append(("navigation: gate passed", NAVIGATION))
    if is_through and deeds.drum is not None:
        others += 1
        rows.append((f"target acquisition: ball in the {_DRUM[deeds.drum]}", DRUMS[deeds.drum]))
        if deeds.has_ball_again:
            others += 1
            rows.append(("target reacquisition: ball held at the end", REACQUISITION))
    if is_through and deeds.flares:
        others += 1
        rows.append((f"localization: {', '.join(deeds.flares)}", FLARE * len(deeds.flares)))
        if deeds.flares == deeds.order:
            rows.append(("communication: flares in their order", ORDER))

    # how it ended, and what it cost
    if deeds.has_surfaced:
        rows.append(("surfaced", SURFACING))
        if others:
            rows.append(("time left", PER_SECOND * max(0.0, TIME - deeds.run_time)))
    if deeds.gate_touches:
        rows.append(("gate touched", -GATE_TOUCH * deeds.gate_touches))
    if deeds.bottom_touches:
        rows.append(("bottom, wall or drum touched", -BOTTOM_TOUCH * deeds.bottom_touches))
    return tuple(rows)


_DRUM = {"blue": "blue drum", "pinger": "red drum with the pinger", "red": "red drum"}


def score_build(size: tuple[float, float, float], mass: float) -> int:
    """Points that a vehicle gets for its build, once it has qualified.

    Args:
        size: its length, width and height (3,) [m], in any order.
        mass: its mass in air [kg].
    """
    is_small = all(a < b for a, b in zip(sorted(size), sorted(SMALL), strict=True))
    return BUILD * (is_small + (mass < LIGHT))


def may_take_part(size: tuple[float, float, float], mass: float) -> bool:
    """Whether a vehicle keeps to the greatest size (3,) [m] and mass [kg]."""
    fits = all(a <= b for a, b in zip(sorted(size), sorted(LARGEST), strict=True))
    return fits and mass <= HEAVIEST
