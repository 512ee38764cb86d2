"""`Log`: how parts of a recording log what they draw, to all of its streams."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import rerun as rr
from numpy.typing import ArrayLike, NDArray

TIMELINE = "sim_time"
"""Name of the timeline of simulated time [s]."""


class _Row(NamedTuple):
    """What an entity shows from one time on."""

    time: float
    """Simulated time [s]."""
    parts: Mapping[str, NDArray[Any]]
    """Arrays (n, ...) of its archetype's components, by name."""


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
        self._rows: dict[tuple[str, Any], list[_Row]] = {}
        self._lines: dict[str, tuple[list[float], list[float]]] = {}

    def keep(self, entity: str, *data: Any) -> None:
        """Log what stays the same."""
        for stream in self._streams:
            stream.log(entity, *data, static=True)

    def draw_now(self, entity: str, *data: Any) -> None:
        """Log what an entity shows from the present time on, at once."""
        for stream in self._streams:
            stream.set_time(TIMELINE, duration=self.time)
            stream.log(entity, *data)

    def draw(self, entity: str, archetype: Any, **parts: ArrayLike) -> None:
        """Log what an entity shows from the present time on.

        Args:
            entity: the entity.
            archetype: what it is, as `rr.Points3D`.
            parts: arrays (n, ...) of its components, as `positions`, copied; other rows of the same
                entity have the same ones.
        """
        arrays = {name: np.array(part) for name, part in parts.items()}
        self._rows.setdefault((entity, archetype), []).append(_Row(self.time, arrays))

    def plot(self, entities: Iterable[str], values: Iterable[float]) -> None:
        """Log the values of lines at the present time."""
        for entity, value in zip(entities, values, strict=True):
            line = self._lines.get(entity)
            if line is None:
                line = self._lines[entity] = ([], [])
            line[0].append(self.time)
            line[1].append(value)

    def send(self) -> None:
        """Send what has been kept."""
        columns: dict[tuple[float, ...], rr.TimeColumn] = {}

        def index(times: Iterable[float]) -> rr.TimeColumn:
            """The column of these times, which most entities share."""
            key = tuple(times)
            if key not in columns:
                columns[key] = rr.TimeColumn(TIMELINE, duration=key)
            return columns[key]

        for (entity, archetype), rows in self._rows.items():
            self._send(entity, index(row.time for row in rows), _join(archetype, rows))
        for entity, (times, values) in self._lines.items():
            self._send(entity, index(times), rr.Scalars.columns(scalars=values))
        self._rows, self._lines = {}, {}

    def _send(self, entity: str, times: rr.TimeColumn, columns: Iterable[Any]) -> None:
        """Send one entity to all streams."""
        for stream in self._streams:
            stream.send_columns(entity, [times], columns)


def _join(archetype: Any, rows: Sequence[_Row]) -> Any:
    """Rows of one entity as the columns of its archetype."""
    arrays = {name: np.concatenate([row.parts[name] for row in rows]) for name in rows[0].parts}
    lengths = [len(next(iter(row.parts.values()))) for row in rows]
    return archetype.columns(**arrays).partition(lengths)
