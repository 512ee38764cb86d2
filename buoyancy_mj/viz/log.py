"""`Log`: how parts of a recording log what they draw, to all of its streams."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import rerun as rr
from numpy.typing import ArrayLike, NDArray

TIMELINE = "sim_time"
"""Name of the timeline of simulated time [s]."""


class _Rows(NamedTuple):
    """What an entity shows, each from one time on."""

    times: list[float]
    """Simulated times [s]."""
    parts: Mapping[str, list[NDArray[Any]]]
    """Arrays (n, ...) of each component of its archetype, one for each time."""


class _Lines(NamedTuple):
    """Lines that have values at the same times."""

    times: list[float]
    """Simulated times [s]."""
    values: list[NDArray[np.float64]]
    """The value of each line, at each time."""


class Log:
    """Logs to the streams of a recording.

    What stays the same goes there at once. What changes with time is kept and goes there as columns
    of many frames, which costs a small part of a call for each.

    Args:
        streams: where to.
    """

    def __init__(self, streams: Sequence[rr.RecordingStream]) -> None:
        self.time = 0.0
        """Simulated time [s] of what is drawn now."""
        self._streams = streams
        self._rows: dict[tuple[Any, ...], _Rows] = {}
        self._lines: dict[tuple[str, ...], _Lines] = {}
        self.extents: dict[str, tuple[float, float]] = {}
        """Least and greatest finite value of each line that has been sent, by its entity."""

    def keep(self, entity: str, *data: Any) -> None:
        """Log what stays the same."""
        for stream in self._streams:
            stream.log(entity, *data, static=True)

    def draw(self, entity: str, archetype: Any, **parts: ArrayLike) -> None:
        """Log what an entity shows from the present time on.

        Args:
            entity: the entity.
            archetype: what it is, as `rr.Points3D`.
            parts: arrays (n, ...) of its components, as `positions`, copied. Each set of components
                has rows of its own, and may so have times of its own.
        """
        rows = self._rows.get((entity, archetype, *parts))
        if rows is None:
            rows = self._rows[entity, archetype, *parts] = _Rows([], {name: [] for name in parts})
        rows.times.append(self.time)
        for name, part in parts.items():
            rows.parts[name].append(np.array(part))

    def plot(self, entities: tuple[str, ...], values: ArrayLike) -> None:
        """Log the values (n,) of lines at the present time."""
        lines = self._lines.get(entities)
        if lines is None:
            lines = self._lines[entities] = _Lines([], [])
        lines.times.append(self.time)
        lines.values.append(np.array(values, float))

    def send(self) -> None:
        """Send what has been kept."""
        columns: dict[tuple[float, ...], rr.TimeColumn] = {}

        def index(times: Iterable[float]) -> rr.TimeColumn:
            """The column of these times, which most entities share."""
            key = tuple(times)
            if key not in columns:
                columns[key] = rr.TimeColumn(TIMELINE, duration=key)
            return columns[key]

        for (entity, archetype, *_), rows in self._rows.items():
            self._send(entity, index(rows.times), _join(archetype, rows))
        for entities, lines in self._lines.items():
            times = index(lines.times)
            for entity, values in zip(entities, np.transpose(lines.values), strict=True):
                self._measure(entity, values)
                self._send(entity, times, rr.Scalars.columns(scalars=values))
        self._rows, self._lines = {}, {}

    def _measure(self, entity: str, values: NDArray[np.float64]) -> None:
        """Widen the extent of a line by new values (n,)."""
        finite = values[np.isfinite(values)]
        if len(finite):
            low, high = self.extents.get(entity, (np.inf, -np.inf))
            self.extents[entity] = min(low, float(finite.min())), max(high, float(finite.max()))

    def _send(self, entity: str, times: rr.TimeColumn, columns: Iterable[Any]) -> None:
        """Send one entity to all streams."""
        for stream in self._streams:
            stream.send_columns(entity, [times], columns)


def _join(archetype: Any, rows: _Rows) -> Any:
    """Rows of one entity as the columns of its archetype."""
    lengths = [len(part) for part in next(iter(rows.parts.values()))]
    arrays = {name: np.concatenate(parts) for name, parts in rows.parts.items()}
    return archetype.columns(**arrays).partition(lengths)
