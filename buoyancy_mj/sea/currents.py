"""Currents: the velocity of the water without its waves; uniform, by depth, or by time."""

import dataclasses
import math
from pathlib import Path

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import WaterError, describe
from buoyancy_mj.values import ANY, read_array

Velocity = tuple[float, float, float]
"""A velocity (3,) [m/s], world frame."""
BY_DEPTH = 0.0
"""Mark of rows whose first column is a depth, see `kernels.currents`."""
BY_TIME = 1.0
"""Mark of rows whose first column is a time, see `kernels.currents`."""


@dataclasses.dataclass(frozen=True)
class CurrentProfile:
    """A current that depends on depth.

    It is linear between the depths, and constant above the first and below the last.

    Raises:
        WaterError: depths that do not grow, another number of velocities than of depths, or a value
            that is not finite.

    Example:
        >>> water = Water(current=CurrentProfile((0.0, 10.0), ((0.8, 0.0, 0.0), (0.2, 0.0, 0.0))))
        >>> float(water.velocity([0.0, 0.0, -5.0], time=0.0)[0])
        0.5
    """

    depths: tuple[float, ...]
    """Depths under the still level (n,) [m], growing."""
    velocities: tuple[Velocity, ...]
    """Velocities at these depths (n, 3) [m/s], world frame."""

    def __post_init__(self) -> None:
        depths, velocities = _check_table("depths", self.depths, self.velocities)
        object.__setattr__(self, "depths", depths)
        object.__setattr__(self, "velocities", velocities)

    @property
    def rows(self) -> NDArray[np.float64]:
        """The current as compiled code reads it (n, 5), see `kernels.currents`."""
        return np.column_stack([self.depths, self.velocities, np.full(len(self.depths), BY_DEPTH)])


@dataclasses.dataclass(frozen=True)
class CurrentSeries:
    """A current that depends on time.

    It is linear between the times, and constant before the first and after the last. Bodies with
    added mass feel it gather speed. The pressure gradient that drives it is left out, so that it
    should gather speed slowly beside g, as tides do.

    Raises:
        WaterError: times that do not grow, another number of velocities than of times, or a value
            that is not finite.

    Example:
        >>> water = Water(current=CurrentSeries((0.0, 60.0), ((0.0, 0.0, 0.0), (0.5, 0.0, 0.0))))
        >>> float(water.velocity([0.0, 0.0, -5.0], time=30.0)[0])
        0.25
    """

    times: tuple[float, ...]
    """Times (n,) [s], growing."""
    velocities: tuple[Velocity, ...]
    """Velocities at these times (n, 3) [m/s], world frame."""

    def __post_init__(self) -> None:
        times, velocities = _check_table("times", self.times, self.velocities)
        object.__setattr__(self, "times", times)
        object.__setattr__(self, "velocities", velocities)

    @classmethod
    def read(cls, path: str | Path) -> "CurrentSeries":
        """Read a series from a file of comma-separated values, as in "0.0, 0.5, 0.0".

        The columns are time [s], u, v and, if there is a fourth, w [m/s]. Text behind a '#' and
        lines of words before the first numbers are skipped.

        Raises:
            WaterError: the file cannot be read, has other columns, or holds what is no number.
        """
        try:
            lines = Path(path).read_text(encoding="utf-8").splitlines()
        except (OSError, ValueError) as error:
            raise WaterError(f"the current in '{path}' cannot be read: {error}") from error

        rows: list[tuple[float, Velocity]] = []
        for number, text in enumerate(lines, 1):
            line = text.split("#")[0].strip()
            is_heading = not rows and not any(character.isdigit() for character in line)
            row = _parse_row(line, f"line {number} of '{path}'", is_heading=is_heading)
            if row is not None:
                rows.append(row)
        if not rows:
            raise WaterError(f"'{path}' holds no current; needed are lines of time, u, v, w")
        times, velocities = zip(*rows, strict=True)
        return cls(times, velocities)

    @property
    def mean(self) -> NDArray[np.float64]:
        """Mean velocity (3,) [m/s] from the first to the last of the times."""
        if len(self.times) == 1:
            return np.array(self.velocities[0])
        path: NDArray[np.float64] = scipy.integrate.trapezoid(self.velocities, self.times, axis=0)
        return path / (self.times[-1] - self.times[0])

    @property
    def rows(self) -> NDArray[np.float64]:
        """The current as compiled code reads it (n, 5), see `kernels.currents`."""
        return np.column_stack([self.times, self.velocities, np.full(len(self.times), BY_TIME)])


Current = Velocity | CurrentProfile | CurrentSeries
"""Anything that `Water.current` may be."""


def current_rows(current: Current) -> NDArray[np.float64]:
    """Any current as compiled code reads it (n, 5), see `kernels.currents`."""
    if isinstance(current, CurrentProfile | CurrentSeries):
        return current.rows
    return np.array([[0.0, *current, BY_DEPTH]])


def is_still(current: Current) -> bool:
    """Whether a current has no horizontal velocity anywhere at any time."""
    return not current_rows(current)[:, 1:3].any()


def effective_current(
    current: Current, wavenumbers: NDArray[np.float64], depth: ArrayLike = math.inf
) -> NDArray[np.float64]:
    """Horizontal velocity (n, 2) [m/s] of the current that waves feel, world frame.

    Of a `CurrentProfile` it is the mean with the weight 2 k cosh 2k(z + h) / sinh 2kh, which is
    right to first order in the current (Kirby and Chen 1989, J. Geophys. Res. 94(C1), 1013). Of a
    `CurrentSeries` it is the mean over its times.

    Args:
        current: the current.
        wavenumbers: of the waves, k (n,) [rad/m], above 0.
        depth: depth of the water, h [m], of all or of each (n,).
    """
    if isinstance(current, CurrentSeries):
        mean = current.mean
        return np.tile(mean[:2], (len(wavenumbers), 1))
    rows = current_rows(current)
    depths, velocities = rows[:, 0], rows[:, 1:3]
    surface = np.array([np.interp(0.0, depths, column) for column in velocities.T])

    # integrated by parts: over each straight part its slope times the integral of
    # sinh 2k(z + h) / sinh 2kh, which is written so that nothing overflows
    k, h = wavenumbers[:, None], np.broadcast_to(depth, wavenumbers.shape)[:, None]
    top, bottom = -np.clip(depths[:-1], 0.0, h), -np.clip(depths[1:], 0.0, h)
    near_bottom = np.expm1(-2.0 * k * (top + bottom + 2.0 * h)) / np.expm1(-4.0 * k * h)
    thickness = -np.expm1(-2.0 * k * (top - bottom)) / (2.0 * k)
    slopes = np.diff(velocities, axis=0) / np.diff(depths)[:, None]
    felt: NDArray[np.float64] = surface + (np.exp(2.0 * k * top) * near_bottom * thickness) @ slopes
    return felt


def parse_velocity(current: object) -> Velocity:
    """Convert a uniform current to its velocity (3,) [m/s].

    Raises:
        WaterError: it is no such velocity.
    """
    try:
        x, y, z = read_array(WaterError, "current", current, (3,)).tolist()
    except WaterError:
        raise WaterError(
            f"current is {describe(current)}; "
            "it must be three finite numbers [m/s], a CurrentProfile or a CurrentSeries"
        ) from None
    return x, y, z


def _parse_row(line: str, where: str, *, is_heading: bool) -> tuple[float, Velocity] | None:
    """Time [s] and velocity (3,) [m/s] of a line; None if it is empty or a heading of words.

    Raises:
        WaterError: the line holds other than 3 or 4 finite numbers; the message calls it `where`.
    """
    if not line:
        return None
    try:
        values = [float(word) for word in line.split(",")]
    except ValueError:
        if is_heading:
            return None
        raise WaterError(
            f"{where} is {describe(line)}; needed are numbers: time, u, v, w"
        ) from None
    if len(values) not in (3, 4) or not all(map(math.isfinite, values)):
        raise WaterError(
            f"{where} is {describe(line)}; needed are 3 or 4 finite numbers: time, u, v, w"
        )
    time, u, v, w = [*values, 0.0][:4]
    return time, (u, v, w)


def _check_table(
    name: str, places: ArrayLike, velocities: ArrayLike
) -> tuple[tuple[float, ...], tuple[Velocity, ...]]:
    """Check the two columns of a current by depth or by time, and convert them to tuples.

    Args:
        name: what the first column holds, "depths" or "times".
        places: the first column (n,).
        velocities: the second column (n, 3) [m/s].
    """
    # as many numbers in one as in the other
    what = f"the current's {name}"
    at = read_array(WaterError, what, places, (ANY,), finite=False)
    speeds = read_array(
        WaterError, "the current's velocities", velocities, (ANY, 3), (0,), finite=False
    )
    if not at.size or speeds.shape != (at.size, 3):
        raise WaterError(
            f"a current by {name} needs as many {name} as velocities of three numbers each, "
            f"at least one; it has {at.size} {name}, and velocities of shape {speeds.shape}"
        )

    # finite, and growing
    for column, values in ((name, at), ("velocities", speeds)):
        if not np.isfinite(values).all():
            row = int(np.argwhere(~np.isfinite(values))[0][0])
            raise WaterError(
                f"the {column} of the current hold {values[row]} in row {row}; "
                "they must be finite numbers"
            )
    if not (np.diff(at) > 0.0).all():
        row = int(np.argmax(~(np.diff(at) > 0.0)))
        raise WaterError(
            f"the {name} of the current must grow from row to row; "
            f"{at[row + 1]:g} follows {at[row]:g}"
        )
    return tuple(at.tolist()), tuple((x, y, z) for x, y, z in speeds.tolist())
