"""How parts of a recording log what they draw."""

from typing import Any, Protocol


class Log(Protocol):
    """A function that logs data to an entity of all streams of a recording."""

    def __call__(self, entity: str, *data: Any, static: bool = False) -> None:
        """Log data at the present time, or for all times if `static`."""
