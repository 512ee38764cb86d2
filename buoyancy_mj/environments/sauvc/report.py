"""`MissionReport` and `Event`: what a referee has seen, and what it is worth."""

import dataclasses
from typing import Any, NamedTuple


class Event(NamedTuple):
    """Something that the referee has seen."""

    time: float
    """When [s]."""
    kind: str
    """What: 'submerged', 'left start', 'gate passed', 'gate touched', 'bottom touched', 'wall
    touched', 'flare touched', 'ball fell', 'ball in drum', 'ball held', 'ended'."""
    detail: str
    """Which gate and which way, which flare, which drum, or why it ended."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class MissionReport:
    """An attempt so far, as the referee has it."""

    task: str
    """The task: 'course' or 'qualification'."""
    run_time: float
    """Length of the attempt so far, or to its end [s]."""
    ended: str
    """Why the attempt has ended; '' while it goes on."""
    points: float
    """Points of the attempt, the sum of `score`."""
    score: tuple[tuple[str, float], ...]
    """Points line by line: what for, and how many."""
    build_points: int
    """Points for a small and a light vehicle, which come on top once it has qualified."""
    events: tuple[Event, ...]
    """All that was seen, in the order of time."""

    def rows(self) -> list[tuple[str, str]]:
        """The report as a table: names and values."""
        lines = [(f"{event.time:.2f} s", f"{event.kind}: {event.detail}") for event in self.events]
        lines += [(what, f"{points:+.4g}") for what, points in self.score]
        return [
            *lines,
            ("points", f"{self.points:.4g}"),
            ("points for its build, besides", f"{self.build_points}"),
            ("run time", f"{self.run_time:.2f} s"),
            ("ended", self.ended or "not yet"),
        ]

    def values(self) -> dict[str, Any]:
        """The report as plain values, for JSON."""
        return {
            **{field.name: getattr(self, field.name) for field in dataclasses.fields(self)},
            "score": [{"for": what, "points": points} for what, points in self.score],
            "events": [event._asdict() for event in self.events],
        }
