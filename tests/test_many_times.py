"""The water at arrays of places and times that broadcast together."""

import numpy as np
import pytest

from buoyancy_mj import (
    CurrentProfile,
    CurrentSeries,
    LevelOscillation,
    RegularWave,
    Water,
    WaterError,
)

WAVES = [
    RegularWave(0.3, period=4.0, direction=0.4, depth=9.0),
    RegularWave(0.1, period=2.3, direction=-1.0, phase=0.7),
    LevelOscillation(0.2, 0.1),
]
STEADY = Water(level=0.3, waves=WAVES, current=(0.4, -0.2, 0.0))
SERIES = CurrentSeries((0.0, 1.0, 3.0), ((0.0, 0.0, 0.0), (0.5, 0.1, 0.0), (-0.2, 0.4, 0.0)))
PROFILE = CurrentProfile((0.0, 4.0), ((0.5, 0.0, 0.0), (0.1, 0.2, 0.0)))
WATERS = [
    STEADY,
    Water(current=(0.1, 0.0, 0.0)),
    Water(current=SERIES),
    Water(current=PROFILE),
]
RNG = np.random.default_rng(5)
POINTS = RNG.uniform(-3.0, 0.0, (4, 1, 3))
TIMES = RNG.uniform(0.0, 3.0, 5)
OF_POINTS = ("depth", "velocity", "acceleration", "pressure")


@pytest.mark.parametrize("water", WATERS)
@pytest.mark.parametrize("name", OF_POINTS)
def test_many_places_at_many_times_are_each_as_one_by_one(water, name):
    at = getattr(water, name)
    found = at(POINTS, TIMES)
    assert found.shape[:2] == (4, 5)
    for i, j in np.ndindex(4, 5):
        assert found[i, j] == pytest.approx(at(POINTS[i, 0], TIMES[j]), abs=1e-9)


@pytest.mark.parametrize("name", ["elevation", "slope"])
def test_horizontal_coordinates_and_times_broadcast_each_for_itself(name):
    at = getattr(STEADY, name)
    x, y, t = RNG.uniform(-9.0, 9.0, (6, 1, 1)), RNG.uniform(-9.0, 9.0, (4, 1)), TIMES
    found = at(x, y, t)
    assert found.shape[:3] == (6, 4, 5)
    for i, j, k in np.ndindex(6, 4, 5):
        assert found[i, j, k] == pytest.approx(at(x[i, 0, 0], y[j, 0], t[k]), abs=1e-12)


def test_a_whole_record_of_a_wave_gauge_is_one_call():
    times = np.linspace(0.0, 4.0, 1001)
    wave = RegularWave(0.3, period=4.0)
    expected = 0.3 * np.cos(-2.0 * np.pi / 4.0 * times)
    assert Water(waves=wave).elevation(0.0, 0.0, times) == pytest.approx(expected, abs=1e-13)


def test_the_surface_rises_as_its_water_does_at_all_times_at_once():
    h, t = 1e-5, TIMES[:, None]
    x, y = np.array([0.5, -2.0]), np.array([1.5, 0.3])
    water = Water(level=0.3, waves=WAVES[:1])
    rate = (water.elevation(x, y, t + h) - water.elevation(x, y, t - h)) / (2.0 * h)
    top = water.elevation(x, y, t)
    surface = np.stack([np.broadcast_to(x, top.shape), np.broadcast_to(y, top.shape), top], -1)
    assert water.velocity(surface, t)[..., 2] == pytest.approx(rate, abs=1e-8)


def test_a_current_that_changes_accelerates_by_its_finite_difference_in_time():
    h, times = 1e-6, np.array([0.3, 0.9, 1.7, 2.6, 5.0])
    water = Water(current=SERIES)
    place = [1.0, 2.0, -1.0]
    rate = (water.velocity(place, times + h) - water.velocity(place, times - h)) / (2.0 * h)
    assert water.acceleration(place, times) == pytest.approx(rate, abs=1e-8)


def test_numbers_give_numbers():
    for value in (
        STEADY.elevation(1.0, 2, np.float64(0.5)),
        STEADY.depth([1.0, 2.0, -1.0], 0.5),
        STEADY.pressure((1, 2, -1), 0),
    ):
        assert isinstance(value, float)
    assert STEADY.elevation([1.0], 2.0, 0.5).shape == (1,)
    assert STEADY.elevation(1.0, 2.0, [[0.5]]).shape == (1, 1)
    assert STEADY.velocity([1.0, 2.0, -1.0], 0.5).shape == (3,)


def test_nothing_in_gives_nothing_out():
    assert STEADY.elevation([], [], 0.0).shape == (0,)
    assert STEADY.elevation(0.0, 0.0, []).shape == (0,)
    assert STEADY.slope(np.zeros((0, 1)), 0.0, TIMES).shape == (0, 5, 2)
    for name, tail in zip(OF_POINTS, ((), (3,), (3,), ()), strict=True):
        at = getattr(STEADY, name)
        assert at(np.zeros((0, 3)), 0.0).shape == (0, *tail)
        assert at(np.zeros((2, 1, 3)), np.zeros(0)).shape == (2, 0, *tail)


def test_a_place_that_is_nowhere_is_nan_there_alone():
    x = np.array([0.0, np.nan, np.inf, 1.0])
    assert np.isnan(STEADY.elevation(x, 0.0, TIMES[:1])).tolist() == [False, True, True, False]
    points = np.array([[0.0, 0.0, -1.0], [np.nan, 0.0, -1.0]])
    for name in OF_POINTS:
        found = getattr(STEADY, name)(points, np.array([0.2, 0.2]))
        assert np.isfinite(found[0]).all()
        assert np.isnan(found[1]).any()


def test_shapes_that_do_not_fit_are_told_in_one_sentence():
    with pytest.raises(WaterError) as told:
        STEADY.elevation(np.zeros(3), 0.0, np.zeros(2))
    assert str(told.value) == (
        "these shapes do not broadcast together: x (3,), y (), time (2,); give arrays of one "
        "shape, or of extent 1 along the axes of another"
    )
    for name in OF_POINTS:
        with pytest.raises(WaterError) as told:
            getattr(STEADY, name)(np.zeros((4, 3)), np.zeros(3))
        assert "(4,)" in str(told.value)
        assert "time (3,)" in str(told.value)


@pytest.mark.parametrize("time", [np.nan, [0.0, np.inf]])
def test_a_time_that_never_comes_is_refused(time):
    for call in (
        lambda: STEADY.elevation(0.0, 0.0, time),
        lambda: STEADY.velocity([0.0, 0.0, 0.0], time),
    ):
        with pytest.raises(WaterError, match=r"time holds .*; its numbers must be finite"):
            call()


@pytest.mark.parametrize("time", ["soon", None, [[1.0, 2.0], [3.0]], 1j])
def test_a_time_that_is_no_number_is_refused(time):
    with pytest.raises(WaterError, match=r"time is .*; it must be numbers of shape "):
        STEADY.elevation(0.0, 0.0, time)
