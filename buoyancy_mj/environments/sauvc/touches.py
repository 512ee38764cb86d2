"""`Touches`: how often and how long a vehicle has touched something."""

APART = 1.0
"""Time without contact after which the next contact is another touch, assumed [s]."""


class Touches:
    """Count touches: contacts with less than `APART` between them are one."""

    def __init__(self) -> None:
        self.count = 0
        """Number of touches so far."""
        self.time = 0.0
        """Time in contact so far [s]."""
        self._last: float | None = None

    def add(self, before: float, now: float, *, is_touching: bool) -> bool:
        """Take note of an update; whether a touch begins with it.

        Args:
            before: time of the update before [s].
            now: its own time [s].
            is_touching: whether there is a contact.
        """
        if not is_touching:
            return False
        begins = self._last is None or now - self._last > APART
        self.count += begins
        self.time += 0.0 if begins else now - max(before, self._last or before)
        self._last = now
        return begins
