"""Currents: the velocity of the water without its waves; everywhere the same, by depth, or by time."""

import dataclasses
import math
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import WaterError

Velocity = tuple[float, float, float]
"""[m/s], world frame."""


@dataclasses.dataclass(frozen=True)
class CurrentProfile:
    """A current that depends on depth: straight between the depths given, and held above the first and below the last.

    Raises:
        WaterError: depths that do not grow, not as many velocities, or one that is no finite number.
    """

    depths: tuple[float, ...]
    """Under the still level [m], growing (n,)."""
    velocities: tuple[Velocity, ...]
    """There (n, 3) [m/s], world frame."""

    def __post_init__(self) -> None:
        depths, velocities = _columns("depths", self.depths, self.velocities)
        object.__setattr__(self, "depths", depths)
        object.__setattr__(self, "velocities", velocities)

    @property
    def rows(self) -> NDArray[np.float64]:
        """As compiled code reads it (n, 5), see `kernels.currents`."""
        return np.column_stack([self.depths, self.velocities, np.zeros(len(self.depths))])


@dataclasses.dataclass(frozen=True)
class CurrentSeries:
    """A current that depends on time: straight between the times given, and held before the first and after the last.

    Bodies with added mass feel it gather speed; the pressure gradient that drives it is left out, so
    that it should gather speed slowly beside g, as tides do.

    Raises:
        WaterError: times that do not grow, not as many velocities, or one that is no finite number.
    """

    times: tuple[float, ...]
    """[s], growing (n,)."""
    velocities: tuple[Velocity, ...]
    """Then (n, 3) [m/s], world frame."""

    def __post_init__(self) -> None:
        times, velocities = _columns("times", self.times, self.velocities)
        object.__setattr__(self, "times", times)
        object.__setattr__(self, "velocities", velocities)

    @classmethod
    def read(cls, path: str | Path) -> "CurrentSeries":
        """A series from a file of comma-separated time [s], u, v and, if it has it, w [m/s]; a line of names may head it.

        Raises:
            WaterError: it cannot be read, has other columns, or holds what is no number.
        """
        try:
            lines = [line.split("#")[0].strip() for line in Path(path).read_text().splitlines()]
        except (OSError, UnicodeDecodeError) as error:
            raise WaterError(f"the current in '{path}' cannot be read: {error}") from error
        rows: list[list[float]] = []
        for number, line in enumerate(lines, 1):
            if not line:
                continue
            try:
                values = [float(word) for word in line.split(",")]
            except ValueError:
                if not rows and not any(character.isdigit() for character in line):
                    continue
                raise WaterError(
                    f"line {number} of '{path}' is '{line}'; needed are numbers: time, u, v, w"
                ) from None
            if len(values) not in (3, 4) or not all(math.isfinite(value) for value in values):
                raise WaterError(
                    f"line {number} of '{path}' is '{line}'; needed are 3 or 4 finite numbers: time, u, v, w"
                )
            rows.append([*values, 0.0][:4])
        if not rows:
            raise WaterError(f"'{path}' holds no current; needed are lines of time, u, v, w")
        return cls(tuple(row[0] for row in rows), tuple((row[1], row[2], row[3]) for row in rows))

    @property
    def rows(self) -> NDArray[np.float64]:
        """As compiled code reads it (n, 5), see `kernels.currents`."""
        return np.column_stack([self.times, self.velocities, np.ones(len(self.times))])


Current = Velocity | CurrentProfile | CurrentSeries
"""What `Water.current` may be."""


def current_rows(current: Current) -> NDArray[np.float64]:
    """Any current as compiled code reads it (n, 5), see `kernels.currents`."""
    if isinstance(current, CurrentProfile | CurrentSeries):
        return current.rows
    return np.array([[0.0, *current, 0.0]])


def uniform(current: object) -> Velocity:
    """The velocity (3,) of a current that is everywhere the same.

    Raises:
        WaterError: it is no such velocity.
    """
    try:
        velocity = np.asarray(current, float)
    except (TypeError, ValueError):
        velocity = np.array(np.nan)
    if velocity.shape != (3,) or not np.isfinite(velocity).all():
        raise WaterError(
            f"current is {current!r}; it must be three finite numbers [m/s], a CurrentProfile or a CurrentSeries"
        )
    x, y, z = velocity.tolist()
    return x, y, z


def _columns(
    name: str, places: ArrayLike, velocities: ArrayLike
) -> tuple[tuple[float, ...], tuple[Velocity, ...]]:
    """Two columns of a table, checked."""
    try:
        at, speeds = np.asarray(places, float), np.asarray(velocities, float)
    except (TypeError, ValueError):
        at = speeds = np.array(np.nan)
    if at.ndim != 1 or not at.size or speeds.shape != (at.size, 3):
        raise WaterError(
            f"a current by {name} needs as many {name} as velocities of three numbers each, at least one; it has {at.size} "
            f"{name}, and velocities of shape {speeds.shape}"
        )
    for what, table in ((name, at), ("velocities", speeds)):
        if not np.isfinite(table).all():
            row = int(np.argwhere(~np.isfinite(table))[0][0])
            raise WaterError(
                f"the {what} of the current hold {table[row]} in row {row}; they must be finite numbers"
            )
    if not (np.diff(at) > 0.0).all():
        row = int(np.argmax(~(np.diff(at) > 0.0)))
        raise WaterError(
            f"the {name} of the current must grow from row to row; {at[row + 1]:g} follows {at[row]:g}"
        )
    return tuple(at.tolist()), tuple((x, y, z) for x, y, z in speeds.tolist())
