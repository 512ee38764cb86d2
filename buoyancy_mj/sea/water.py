"""`Water`: everything the sea is."""

import dataclasses
import functools
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import WaterError
from buoyancy_mj.kernels import waves as kernels
from buoyancy_mj.sea.currents import Current, CurrentProfile, CurrentSeries, current_rows, uniform
from buoyancy_mj.sea.spectra import JonswapSea, PiersonMoskowitzSea
from buoyancy_mj.sea.waves import GRAVITY, LARGEST, Wave, finite

MOST_WAVES = 10_000
"""Waves at once: each costs its time in every step."""


@dataclasses.dataclass(frozen=True)
class Water:
    """The sea: its density, its still level, the waves on it and the current in it.

    Raises:
        WaterError: a value out of its range, or a wave that is none.
    """

    density: float = 1000.0
    """Mass density rho [kg/m^3]; sea water has about 1025."""
    level: float = 0.0
    """World height of the still surface [m]."""
    waves: Wave | Sequence[Wave] = ()
    """One wave or several; elevations and velocities add up."""
    current: Current = (0.0, 0.0, 0.0)
    """Velocity of the water without the waves (3,) [m/s], world frame; or by depth, or by time."""

    def __post_init__(self) -> None:
        finite("density", self.density, above=0.0)
        finite("level", self.level, least=-LARGEST, most=LARGEST)
        waves = (
            (self.waves,)
            if hasattr(self.waves, "rows") or not isinstance(self.waves, Sequence)
            else tuple(self.waves)
        )
        for wave in waves:
            if not hasattr(wave, "rows"):
                raise WaterError(
                    f"{wave!r} is no wave; possible are RegularWave, JonswapSea, PiersonMoskowitzSea and LevelOscillation"
                )
        count = sum(len(wave.rows) for wave in waves)
        if count > MOST_WAVES:
            raise WaterError(
                f"the sea has {count} waves; it may have {MOST_WAVES} at most, so leave out the smallest"
            )
        object.__setattr__(self, "waves", waves)
        if not isinstance(self.current, CurrentProfile | CurrentSeries):
            object.__setattr__(self, "current", uniform(self.current))

    @functools.cached_property
    def rows(self) -> NDArray[np.float64]:
        """All waves as rows (n, 6), see `Wave`."""
        return np.concatenate([np.zeros((0, 6)), *(wave.rows for wave in self.waves)])  # type: ignore[union-attr]

    @functools.cached_property
    def current_rows(self) -> NDArray[np.float64]:
        """The current as rows (n, 5), see `kernels.currents`."""
        return current_rows(self.current)

    @functools.cached_property
    def curvature(self) -> float:
        """Bound of the surface's curvature [1/m]: the sum of A k^2, of random seas four standard deviations."""
        total = 0.0
        for wave in self.waves:  # type: ignore[union-attr]
            each = np.abs(wave.rows[:, 0]) * (wave.rows[:, 1] ** 2 + wave.rows[:, 2] ** 2)
            random = isinstance(wave, JonswapSea | PiersonMoskowitzSea)
            total += min(each.sum(), 4.0 * np.sqrt(0.5 * (each**2).sum())) if random else each.sum()
        return float(total)

    @functools.cached_property
    def warnings(self) -> tuple[str, ...]:
        """What speaks against its waves in nature, clauses: they are steeper than those that break."""
        return tuple(warning for wave in self.waves if (warning := getattr(wave, "warning", "")))  # type: ignore[union-attr]

    def elevation(self, x: ArrayLike, y: ArrayLike, time: float) -> NDArray[np.float64]:
        """Height of the surface [m], world frame, at points x, y (any shape) [m] and a time [s]."""
        xs, ys = np.broadcast_arrays(np.asarray(x, float), np.asarray(y, float))
        out = np.empty(xs.size)
        kernels.elevations(self.rows, xs.ravel(), ys.ravel(), float(time), out)
        return self.level + out.reshape(xs.shape)

    def depth(self, points: ArrayLike, time: float) -> NDArray[np.float64]:
        """How deep points (..., 3) [m] are under the surface at a time [s]; positive in the water."""
        p = np.asarray(points, float)
        return self.elevation(p[..., 0], p[..., 1], time) - p[..., 2]

    def velocity(self, points: ArrayLike, time: float) -> NDArray[np.float64]:
        """Velocity of the water (..., 3) [m/s] at points (..., 3) [m] and a time [s]: current and waves."""
        p = np.asarray(points, float)
        out = np.empty((p.size // 3, 3))
        kernels.velocities(
            self.rows, self.current_rows, p.reshape(-1, 3), self.level, float(time), out
        )
        return out.reshape(p.shape)

    def acceleration(self, points: ArrayLike, time: float) -> NDArray[np.float64]:
        """Rate of that velocity at one place (..., 3) [m/s^2], at points (..., 3) [m] and a time [s]."""
        p = np.asarray(points, float)
        out = np.empty((p.size // 3, 3))
        kernels.accelerations(
            self.rows, self.current_rows, p.reshape(-1, 3), self.level, float(time), out
        )
        return out.reshape(p.shape)

    def pressure(
        self, points: ArrayLike, time: float, gravity: float = GRAVITY
    ) -> NDArray[np.float64]:
        """Pressure (...) [Pa] over the air's at points (..., 3) [m] in the water: zero on its surface.

        That of linear waves, stretched to the surface, see `kernels.waves.head`; over the surface there
        is no water, and the numbers mean nothing.
        """
        p = np.asarray(points, float)
        out = np.empty(p.size // 3)
        kernels.heads(self.rows, p.reshape(-1, 3), self.level, float(time), out)
        return self.density * gravity * out.reshape(p.shape[:-1])

    def slope(self, x: ArrayLike, y: ArrayLike, time: float) -> NDArray[np.float64]:
        """Gradient (..., 2) of the elevation at points x, y (any shape) [m] and a time [s]."""
        xs, ys = np.broadcast_arrays(np.asarray(x, float), np.asarray(y, float))
        out = np.empty((xs.size, 2))
        kernels.slopes(self.rows, xs.ravel(), ys.ravel(), float(time), out)
        return out.reshape(*xs.shape, 2)
