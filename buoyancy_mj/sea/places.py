"""Places and times that somebody gave, as arrays that broadcast together."""

import math
from typing import NamedTuple, TypeGuard

import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import WaterError
from buoyancy_mj.values import ANY, read_array

Shape = tuple[int, ...]


class Spots(NamedTuple):
    """Horizontal points at their times, as the kernels take them."""

    shape: Shape
    """The shape to which points and times broadcast."""
    x: NDArray[np.float64]
    """Coordinates (n,) [m] of all of them."""
    y: NDArray[np.float64]
    """The other coordinates (n,) [m]."""
    times: NDArray[np.float64]
    """The time of each (n,) [s], or one for all (1,)."""


class Places(NamedTuple):
    """Points at their times, as the kernels take them."""

    shape: Shape
    """The shape to which points and times broadcast, without the axis of coordinates."""
    points: NDArray[np.float64]
    """All of them (n, 3) [m]."""
    times: NDArray[np.float64]
    """The time of each (n,) [s], or one for all (1,)."""


def read_spots(x: ArrayLike, y: ArrayLike, time: ArrayLike) -> Spots:
    """Horizontal coordinates and times of any shapes that broadcast together.

    Raises:
        WaterError: one holds no numbers, a time is not finite, or the shapes do not broadcast.
    """
    xs, ys, times = _read_any("x", x), _read_any("y", y), _read_times(time)
    shape = _join_shapes({"x": xs.shape, "y": ys.shape, "time": times.shape})
    return Spots(
        shape, _spread(xs, shape).ravel(), _spread(ys, shape).ravel(), _spread_times(times, shape)
    )


def read_places(points: ArrayLike, time: ArrayLike) -> Places:
    """Points (..., 3) and times (...) of any shapes that broadcast together.

    Raises:
        WaterError: as `read_spots`; or the last axis of the points is not of 3.
    """
    places, times = read_points(points), _read_times(time)
    shape = _join_shapes({"points (..., 3)": places.shape[:-1], "time": times.shape})
    return Places(shape, _spread(places, (*shape, 3)).reshape(-1, 3), _spread_times(times, shape))


def read_points(points: ArrayLike) -> NDArray[np.float64]:
    """Points (..., 3) as floats; nan stays nan, as of a hull that is dry."""
    if _is_double(points) and points.shape[-1:] == (3,):
        return points
    shape = (*[ANY] * (_count_axes(points) - 1), 3)
    return read_array(WaterError, "points", points, shape, finite=False)


def _read_any(name: str, value: ArrayLike) -> NDArray[np.float64]:
    """Numbers of any shape; nan stays nan."""
    if isinstance(value, float) or _is_double(value):
        return np.asarray(value)
    return read_array(WaterError, name, value, (ANY,) * _count_axes(value), finite=False)


def _read_times(time: ArrayLike) -> NDArray[np.float64]:
    """Finite times of any shape."""
    if isinstance(time, float) and math.isfinite(time):
        return np.array(time)
    return read_array(WaterError, "time", time, (ANY,) * _count_axes(time))


def _is_double(value: ArrayLike) -> TypeGuard[NDArray[np.float64]]:
    """Whether a value is an array of doubles already."""
    return isinstance(value, np.ndarray) and value.dtype.char == "d"


def _count_axes(value: ArrayLike) -> int:
    """How many axes a value has; 1 for what is no array, such as rows of several lengths."""
    try:
        return np.ndim(value)
    except ValueError:
        return 1


def _join_shapes(shapes: dict[str, Shape]) -> Shape:
    """The shape to which shapes broadcast; the error calls them by these names."""
    first, *others = shapes.values()
    if all(other in (first, ()) for other in others):
        return first
    try:
        return np.broadcast_shapes(*shapes.values())
    except ValueError:
        names = ", ".join(f"{name} {shape}" for name, shape in shapes.items())
        raise WaterError(
            f"these shapes do not broadcast together: {names}; give arrays of one shape, or of "
            "extent 1 along the axes of another"
        ) from None


def _spread(array: NDArray[np.float64], shape: Shape) -> NDArray[np.float64]:
    """An array, spread to a shape where it has another."""
    if array.shape == shape:
        return array
    spread = np.empty(shape)
    spread[...] = array
    return spread


def _spread_times(times: NDArray[np.float64], shape: Shape) -> NDArray[np.float64]:
    """The time of each place (n,), or one for all (1,)."""
    return times.reshape(1) if times.size == 1 else _spread(times, shape).ravel()
