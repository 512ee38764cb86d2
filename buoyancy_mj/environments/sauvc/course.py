"""`Course`: an attempt at the final."""

from buoyancy_mj.environments.sauvc.attempt import SURFACED, Attempt
from buoyancy_mj.environments.sauvc.passages import Passage
from buoyancy_mj.environments.sauvc.props import Props
from buoyancy_mj.environments.sauvc.rules import MOST_CONTACT, MOST_TOUCHES, Deeds, score
from buoyancy_mj.environments.sauvc.watcher import Sight


class Course(Attempt):
    """Judge an attempt at the final.

    The gate counts when it is passed away from the start, which is assumed, and balls count from
    then on. Bumped is a flare whose ball has fallen.
    """

    def __init__(self, props: Props, start: float) -> None:
        super().__init__(props, start)
        self._is_through = self._was_dropped_before_gate = self._has_ball = False
        self._fallen: list[str] = []
        self._counted: list[str] = []
        self._drum: str | None = None

    def see_passage(self, passage: Passage) -> None:
        """The gate counts once; after the ball was dropped, it opens the last task."""
        self._is_through |= passage.direction > 0
        self._was_dropped_before_gate |= self._drum is not None

    def see_touch(self, what: str) -> None:
        """The orange flare ends the attempt."""
        if what == "orange":
            self.end("aborted: the orange flare was touched")

    def see_props(self, sight: Sight) -> None:
        """Balls of flares fall, the ball to drop lies in a drum; too much of the bottom ends it."""
        for colour in sight.fallen:
            if colour not in self._fallen:
                self._fallen.append(colour)
                self._counted += [colour] if self._is_through else []
                self.note("ball fell", colour + ("" if self._is_through else ", before the gate"))
        if self._is_through and self._drum is None and sight.drum is not None:
            self._drum = sight.drum
            self.note("ball in drum", self._describe_drum(sight.drum))
        self._has_ball = sight.has_ball

        # too much of the bottom
        if self.ground.count >= MOST_TOUCHES:
            self.end(f"aborted: bottom or walls touched {self.ground.count} times")
        elif self.ground.time > MOST_CONTACT:
            self.end(f"aborted: bottom or walls touched for {self.ground.time:.1f} s")

    def score(self) -> tuple[tuple[str, float], ...]:
        """Points so far, as if it had been aborted now where it has not ended."""
        has_surfaced = self.ended == SURFACED
        is_aborted_by_touch = self.ended.startswith("aborted: bottom")
        return score(
            Deeds(
                is_through_gate=self._is_through,
                flares=tuple(self._counted),
                order=self.props.order,
                drum=self._sort_drum(),
                has_ball_again=(has_surfaced and self._was_dropped_before_gate and self._has_ball),
                has_surfaced=has_surfaced,
                run_time=self.now - self.start,
                gate_touches=self.touches["gate"].count,
                bottom_touches=self.ground.count - is_aborted_by_touch,
            )
        )

    def _sort_drum(self) -> str | None:
        """The kind of the drum in which the ball was dropped."""
        if self._drum is None:
            return None
        if self._drum == self.props.pinger:
            return "pinger"
        return self._drum.split("_")[0]

    def _describe_drum(self, name: str) -> str:
        """A drum for the list of events."""
        return f"{name}, with the pinger" if name == self.props.pinger else name
