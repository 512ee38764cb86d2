"""`Water`: everything the sea is."""

import dataclasses
import functools
from collections.abc import Sequence
from typing import cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import WaterError, describe
from buoyancy_mj.kernels import many_places as kernels
from buoyancy_mj.kernels.waves import tabulate
from buoyancy_mj.sea.currents import (
    Current,
    CurrentProfile,
    CurrentSeries,
    current_rows,
    parse_velocity,
)
from buoyancy_mj.sea.dispersion import GRAVITY
from buoyancy_mj.sea.doppler import add_doppler, describe_change
from buoyancy_mj.sea.gravity import take_gravity
from buoyancy_mj.sea.irregular import IrregularSea
from buoyancy_mj.sea.places import read_places, read_points, read_spots
from buoyancy_mj.sea.ranges import LARGEST
from buoyancy_mj.sea.rows import join_equal, rows_of
from buoyancy_mj.sea.waves import Wave, depends_on_current
from buoyancy_mj.values import set_number

MOST_WAVES = 10_000
"""Most waves at once; each costs its time in every step."""
DENSEST = 1e5
"""Greatest density [kg/m^3]; no liquid comes near it."""


@dataclasses.dataclass(frozen=True)
class Water:
    """The sea: its density, its still level, the waves on it and the current in it.

    Raises:
        WaterError: a value out of its range, or a wave that is none.

    Example:
        >>> water = Water(density=1025.0, waves=RegularWave(0.3, period=4.0), current=(0.5, 0, 0))
        >>> float(water.elevation(x=0.0, y=0.0, time=0.0))
        0.3
    """

    density: float = 1000.0
    """Mass density rho [kg/m^3]; sea water has about 1025."""
    level: float = 0.0
    """Height of the still surface [m], world frame."""
    waves: Wave | Sequence[Wave] = ()
    """One wave or several; their elevations and velocities add up."""
    current: Current = (0.0, 0.0, 0.0)
    """Velocity of the water without its waves (3,) [m/s], world frame; or one by depth or time."""

    def __post_init__(self) -> None:
        # numbers
        set_number(self, WaterError, "density", above=0.0, most=DENSEST)
        set_number(self, WaterError, "level", least=-LARGEST, most=LARGEST)

        # waves, as a tuple
        is_one = hasattr(self.waves, "rows") or not isinstance(self.waves, Sequence)
        waves = (self.waves,) if is_one else tuple(cast(Sequence[Wave], self.waves))
        for wave in waves:
            if isinstance(wave, type) or not hasattr(wave, "rows"):
                raise WaterError(
                    f"{describe(wave)} is no wave; possible are RegularWave, JonswapSea, "
                    "PiersonMoskowitzSea and LevelOscillation"
                )
        object.__setattr__(self, "waves", waves)

        # the current, which the waves meet
        if not isinstance(self.current, CurrentProfile | CurrentSeries):
            object.__setattr__(self, "current", parse_velocity(self.current))
        if len(self._all_rows) > MOST_WAVES:
            raise WaterError(
                f"the sea has {len(self._all_rows)} waves; it may have {MOST_WAVES} at most, "
                "so leave out the smallest"
            )

    def _repr_html_(self) -> str:
        """How a notebook shows it."""
        from buoyancy_mj.sea.portrait import portray

        return portray(self)

    @property
    def _waves(self) -> tuple[Wave, ...]:
        """The waves, which are a tuple once the water exists."""
        return cast(tuple[Wave, ...], self.waves)

    @functools.cached_property
    def rows(self) -> NDArray[np.float64]:
        """The components of all waves on the current as rows (n, 7), read-only.

        The columns are those of `Wave.rows`, and the angular frequency sigma [rad/s] that the water
        sees, which drifts with the current; see `kernels.waves`. Components that differ in
        amplitude and phase alone are one wave.
        """
        return _read_only(self._rows)

    @functools.cached_property
    def table(self) -> NDArray[np.float64]:
        """The waves as kernels read them (9, n), read-only; see `kernels.waves`."""
        return _read_only(self._table)

    @functools.cached_property
    def current_rows(self) -> NDArray[np.float64]:
        """The current as rows (n, 5), see `kernels.currents`; read-only."""
        return _read_only(self._current_rows)

    # kernels are compiled for arrays that can be written to

    @functools.cached_property
    def _rows(self) -> NDArray[np.float64]:
        return join_equal(self._all_rows)

    @functools.cached_property
    def _table(self) -> NDArray[np.float64]:
        return tabulate(self._rows)

    @functools.cached_property
    def _all_rows(self) -> NDArray[np.float64]:
        return np.concatenate([np.zeros((0, 7)), *self._rows_by_wave])

    @functools.cached_property
    def _seen(self) -> tuple[Wave, ...]:
        """The waves on the current, as the water sees them; here alone they meet it."""
        return tuple(
            wave.on(self.current) if depends_on_current(wave) else wave for wave in self._waves
        )

    @functools.cached_property
    def _rows_by_wave(self) -> tuple[NDArray[np.float64], ...]:
        """The rows (n, 7) of each wave."""
        return tuple(
            add_doppler(rows_of(seen), self.current, at_rest=not depends_on_current(wave))
            for wave, seen in zip(self._waves, self._seen, strict=True)
        )

    @functools.cached_property
    def _current_rows(self) -> NDArray[np.float64]:
        return current_rows(self.current)

    @functools.cached_property
    def curvature(self) -> float:
        """Bound of the curvature of the surface [1/m].

        It is the sum of A k^2 of all waves, but of an irregular sea no more than four standard
        deviations.
        """
        total = 0.0
        for wave, rows in zip(self._waves, self._rows_by_wave, strict=True):
            amplitude, kx, ky, *_ = rows.T
            each = np.abs(amplitude) * (kx**2 + ky**2)
            bound = each.sum()
            if isinstance(wave, IrregularSea):
                bound = min(bound, 4.0 * np.sqrt(0.5 * (each**2).sum()))
            total += bound
        return float(total)

    @functools.cached_property
    def warnings(self) -> tuple[str, ...]:
        """A clause for each doubt about the waves.

        One is for each wave that would break in nature, see `RegularWave.warning`, one for each sea
        of which the current blocks a part, and one for waves on a current that changes with time.
        """
        clauses = [getattr(wave, "warning", "") for wave in self._seen]
        if isinstance(self.current, CurrentSeries):
            clauses.append(describe_change(self.current, self._rows))
        return tuple(clause for clause in clauses if clause)

    def with_gravity(self, gravity: float) -> "Water":
        """The water of a model: waves that state no gravity take the model's.

        Args:
            gravity: of the model [m/s^2]. Where it is 0, waves keep theirs, 9.81 by default.

        Raises:
            WaterError: a wave states another gravity, or there is no such wave under this one.
        """
        waves = tuple(take_gravity(wave, gravity) for wave in self._waves)
        if all(new is old for new, old in zip(waves, self._waves, strict=True)):
            return self
        return dataclasses.replace(self, waves=waves)

    def elevation(self, x: ArrayLike, y: ArrayLike, time: ArrayLike) -> NDArray[np.float64]:
        """Height of the surface (...) [m], world frame; a float for three numbers.

        Args:
            x: horizontal coordinates of points [m], world frame, of any shape that broadcasts with
                the others.
            y: the other horizontal coordinates [m], likewise.
            time: [s], likewise.

        Raises:
            WaterError: shapes that do not broadcast, or a time that is not finite; so in the
                methods below.
        """
        spots = read_spots(x, y, time)
        out = np.empty(spots.x.size)
        if len(spots.times) == 1:
            kernels.elevations(self._table, spots.x, spots.y, spots.times[0], out)
        else:
            kernels.elevations_at(self._table, *spots[1:], out)
        return _unwrap(self.level + out.reshape(spots.shape))

    def slope(self, x: ArrayLike, y: ArrayLike, time: ArrayLike) -> NDArray[np.float64]:
        """Gradient (..., 2) of the elevation along x and y.

        Args:
            x: horizontal coordinates of points [m], world frame, of any shape that broadcasts with
                the others.
            y: the other horizontal coordinates [m], likewise.
            time: [s], likewise.
        """
        spots = read_spots(x, y, time)
        out = np.empty((spots.x.size, 2))
        kernels.slopes(self._table, *spots[1:], out)
        return out.reshape(*spots.shape, 2)

    def depth(self, points: ArrayLike, time: ArrayLike) -> NDArray[np.float64]:
        """Depth (...) [m] of points (..., 3) [m] under the surface at times (...) [s].

        It is positive in the water, and a float for one point at one time.

        Raises:
            WaterError: points of another shape; so in the methods below.
        """
        p = read_points(points)
        return _unwrap(self.elevation(p[..., 0], p[..., 1], time) - p[..., 2])

    def velocity(self, points: ArrayLike, time: ArrayLike) -> NDArray[np.float64]:
        """Velocity (..., 3) [m/s] of the water at points (..., 3) [m] and times (...) [s].

        It is the sum of the current and of the velocities of the waves, world frame, see
        `kernels.waves.add_motion`.
        """
        shape, places, times = read_places(points, time)
        out = np.empty((len(places), 3))
        kernels.velocities(self._table, self._current_rows, places, self.level, times, out)
        return out.reshape(*shape, 3)

    def acceleration(self, points: ArrayLike, time: ArrayLike) -> NDArray[np.float64]:
        """Acceleration (..., 3) [m/s^2] of the water at points (..., 3) [m] and times (...) [s].

        It is that of the water itself as it moves in waves and drifts with the current, which the
        gradient of `pressure` gives: what moves a body with added mass. The part that the shear of
        a profile convects is left out.
        """
        shape, places, times = read_places(points, time)
        out = np.empty((len(places), 3))
        kernels.accelerations(self._table, self._current_rows, places, self.level, times, out)
        return out.reshape(*shape, 3)

    def pressure(
        self, points: ArrayLike, time: ArrayLike, gravity: float = GRAVITY
    ) -> NDArray[np.float64]:
        """Pressure (...) [Pa] in excess of the air's at points (..., 3) [m] in the water.

        It is zero on the surface, and far below it that of linear waves less the mean of their
        square; see `kernels.waves.head`. Above the surface there is no water, and the numbers mean
        nothing.

        Args:
            points: places (..., 3) [m], world frame.
            time: [s], of any shape (...) that broadcasts with the places; a float and one place
                give a float.
            gravity: acceleration of gravity [m/s^2].
        """
        shape, places, times = read_places(points, time)
        out = np.empty(len(places))
        kernels.heads(self._table, places, self.level, times, out)
        return _unwrap(self.density * gravity * out.reshape(shape))


def _unwrap(array: NDArray[np.float64]) -> NDArray[np.float64]:
    """The same array; an array without axes as the float that it holds."""
    unwrapped: NDArray[np.float64] = array[()]
    return unwrapped


def _read_only(array: NDArray[np.float64]) -> NDArray[np.float64]:
    """The same numbers, which cannot be changed for all who share them."""
    view = array.view()
    view.setflags(write=False)
    return view
