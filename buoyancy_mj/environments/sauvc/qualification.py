"""`Qualification`: a run through a gate, a U-turn, and back."""

from buoyancy_mj.environments.sauvc.attempt import Attempt
from buoyancy_mj.environments.sauvc.passages import Passage
from buoyancy_mj.environments.sauvc.props import Props
from buoyancy_mj.environments.sauvc.watcher import Sight


class Qualification(Attempt):
    """Judge a run of the qualification.

    The way back counts through the gate of the way out, and after a U-turn: the bow points the
    other way. Who touches the gate has failed; who surfaces or touches the bottom or a wall has
    ended the run, and keeps, which is assumed, the point of the way out.
    """

    def __init__(self, props: Props, start: float) -> None:
        super().__init__(props, start)
        self._out: Passage | None = None
        self._is_back = self._has_failed = False

    def see_passage(self, passage: Passage) -> None:
        """The first way out counts, and the way back after a U-turn ends the run."""
        if passage.direction > 0:
            self._out = self._out or passage
        elif self._out is not None and passage.gate == self._out.gate:
            if passage.heading * self._out.heading < 0.0:
                self._is_back = True
                self.now = passage.time
                self.end("qualified")
            else:
                self.note("no U-turn", passage.gate, passage.time)

    def see_touch(self, what: str) -> None:
        """The gate undoes the run; anything else ends it."""
        self._has_failed |= what == "gate" and not self.ended
        self.end(f"the {what} was touched")

    def see_props(self, sight: Sight) -> None:
        """There are none."""

    def score(self) -> tuple[tuple[str, float], ...]:
        """A point for the way out, and another for the way back."""
        if self._has_failed or self._out is None:
            return ()
        out = ("gate passed", 1.0)
        return (out, ("gate passed again after a U-turn", 1.0)) if self._is_back else (out,)
