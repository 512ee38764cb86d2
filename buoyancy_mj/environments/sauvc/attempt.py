"""`Attempt`: one attempt at a task, from the start zone to its end, as the rulebook judges it."""

from abc import ABC, abstractmethod

from buoyancy_mj.environments.sauvc.passages import Passage
from buoyancy_mj.environments.sauvc.props import Props
from buoyancy_mj.environments.sauvc.report import Event
from buoyancy_mj.environments.sauvc.rules import TIME
from buoyancy_mj.environments.sauvc.touches import Touches
from buoyancy_mj.environments.sauvc.watcher import Sight

SURFACED = "surfaced"
"""Why an attempt ended whose vehicle came to the surface."""
_GROUND = "ground"
_OF_GROUND = ("bottom", "wall")


class Attempt(ABC):
    """Judge an attempt, sight by sight.

    A vehicle may be at the surface in the start zone alone; it goes under water as a whole before
    it leaves the zone. Walls count from then on: it may start at one.

    Args:
        props: the props of the arena.
        start: time at which the attempt begins [s].
    """

    def __init__(self, props: Props, start: float) -> None:
        self.props = props
        """The props of the arena."""
        self.start = self.now = start
        """When it began, and the time of the last sight or of its end [s]."""
        self.events: list[Event] = []
        """What was seen."""
        self.ended = ""
        """Why it has ended; '' while it goes on."""
        self.touches = {name: Touches() for name in (*props.kinds, _GROUND)}
        """Touches of each kind of thing, and of all that is bottom or wall."""
        self._is_under = self._has_left = False

    def see(self, sight: Sight) -> None:
        """Judge what there is to see."""
        if self.ended:
            return
        self.now = sight.time
        for passage in sight.passages:
            way = "away from the start" if passage.direction > 0 else "back to the start"
            end = "bow" if passage.heading * passage.direction > 0.0 else "stern"
            self.note("gate passed", f"{passage.gate}, {way}, {end} first", passage.time)
            self.see_passage(passage)
        if self.ended:
            return
        self._see_start(sight)
        self._see_touches(sight)
        self.see_props(sight)

        # what ends it
        if not sight.is_in_pool:
            self.end("out of the pool")
        elif self._has_left and sight.is_breached:
            self.end(SURFACED if self._is_under else "left the start zone at the surface")
        elif sight.time - self.start >= TIME:
            self.end("the time was up")

    @property
    def ground(self) -> Touches:
        """Touches of bottom, walls and drums, together."""
        return self.touches[_GROUND]

    def note(self, kind: str, detail: str, time: float | None = None) -> None:
        """Keep an event of now, or of another time [s]."""
        self.events.append(Event(self.now if time is None else time, kind, detail))

    def end(self, reason: str) -> None:
        """End the attempt, unless it has ended."""
        if not self.ended:
            self.ended = reason
            self.note("ended", reason)

    @abstractmethod
    def see_passage(self, passage: Passage) -> None:
        """Judge that the vehicle has passed a gate."""

    @abstractmethod
    def see_touch(self, what: str) -> None:
        """Judge that a touch has begun: of 'gate', 'bottom', 'wall', 'orange' or a flare."""

    @abstractmethod
    def see_props(self, sight: Sight) -> None:
        """Judge balls and drums, and how often and how long something was touched."""

    @abstractmethod
    def score(self) -> tuple[tuple[str, float], ...]:
        """Points so far, line by line."""

    def _see_start(self, sight: Sight) -> None:
        """Judge how the vehicle leaves the start zone."""
        if not self._is_under and not sight.is_breached:
            self._is_under = True
            self.note("submerged", "the whole vehicle")
        if not self._has_left and not sight.is_at_start:
            self._has_left = True
            self.note("left start", "under water" if self._is_under else "at the surface")

    def _see_touches(self, sight: Sight) -> None:
        """Judge what the vehicle touches."""
        counted = sight.touched if self._has_left else sight.touched - {"wall"}
        for what in self.props.kinds:
            if self._touch(what, sight, is_touching=what in counted):
                is_flare = what not in ("gate", *_OF_GROUND)
                self.note("flare touched" if is_flare else f"{what} touched", what)
                self.see_touch(what)
        is_touching = not counted.isdisjoint(_OF_GROUND)
        self._touch(_GROUND, sight, is_touching=is_touching)

    def _touch(self, what: str, sight: Sight, *, is_touching: bool) -> bool:
        """Count a touch of something; whether one begins."""
        return self.touches[what].add(sight.before, sight.time, is_touching=is_touching)
