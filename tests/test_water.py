import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from buoyancy_mj import LevelOscillation, RegularWave, Water, WaterError, wavenumber
from tests import naive


@pytest.mark.parametrize(
    ("period", "depth", "wavelength"),
    [
        # omega^2 = g k tanh(k h) solved elsewhere, g = 9.81, to the digits given
        (8.0, 10.0, "70.898"),
        (10.0, 20.0, "121.237"),
        (4.0, math.inf, "24.981"),
        (3.0, 1.2, "9.3685"),
        (2.0, 1.6, "5.8549"),
        (1.2, 0.4, "1.9362"),
    ],
)
def test_wavelengths_follow_the_dispersion_relation(period, depth, wavelength):
    digits = len(wavelength.partition(".")[2])
    wave = RegularWave(0.1, period=period, depth=depth)
    assert f"{wave.wavelength:.{digits}f}" == wavelength


@given(st.floats(0.01, 50.0), st.floats(0.001, 1e4))
def test_the_wavenumber_solves_the_dispersion_relation(omega, depth):
    k = wavenumber(omega, depth)
    assert 9.81 * k * math.tanh(k * depth) == pytest.approx(omega**2, rel=1e-10)


@given(st.floats(0.05, 5.0), st.floats(0.1, 1e3))
def test_frequency_period_and_wavelength_describe_one_wave(frequency, depth):
    first = RegularWave(0.01, frequency=frequency, depth=depth)
    for again in (
        RegularWave(0.01, period=first.period, depth=depth),
        RegularWave(0.01, wavelength=first.wavelength, depth=depth),
    ):
        assert again.rows == pytest.approx(first.rows, rel=1e-9)


@pytest.mark.parametrize(
    "given_", [{}, {"period": 2.0, "frequency": 0.5}, {"period": 2.0, "wavelength": 6.0}]
)
def test_exactly_one_of_the_three_is_given(given_):
    with pytest.raises(WaterError, match="give exactly one of frequency"):
        RegularWave(0.1, **given_)


@given(st.integers(0, 10**6))
def test_elevation_is_the_sum_of_cosines(seed):
    rng = np.random.default_rng(seed)
    waves = [
        RegularWave(
            rng.uniform(0, 0.7),
            period=rng.uniform(1, 9),
            direction=rng.uniform(-3, 3),
            phase=rng.uniform(-3, 3),
        )
    ]
    waves += [LevelOscillation(rng.uniform(0, 1), rng.uniform(0.1, 1), rng.uniform(-3, 3))]
    water = Water(level=rng.uniform(-2, 2), waves=waves)
    x, y, t = rng.uniform(-50, 50, (3, 7))
    assert water.elevation(x, y, t[0]) == pytest.approx(
        water.level + naive.elevation(water.rows, x, y, t[0]), abs=1e-12
    )


def test_a_wave_runs_where_its_direction_points():
    wave = Water(waves=RegularWave(1.0, period=2.0, direction=0.5))
    speed = wave.waves[0].wavelength / 2.0
    for time in (0.0, 0.3, 1.1):
        crest = speed * time * np.array([math.cos(0.5), math.sin(0.5)])
        assert wave.elevation(*crest, time) == pytest.approx(1.0, abs=1e-12)


def test_a_level_oscillation_is_an_infinitely_long_wave():
    level = Water(waves=LevelOscillation(0.3, 0.5, phase=0.7))
    # shallow water is slow; so deep that the frequency alone makes it long
    wave = Water(waves=RegularWave(0.3, frequency=0.5, phase=0.7, gravity=1e9))
    assert level.elevation(3.0, 4.0, 1.3) == pytest.approx(wave.elevation(3.0, 4.0, 1.3), abs=1e-6)
    assert level.velocity([3.0, 4.0, -1.0], 1.3)[2] == pytest.approx(
        wave.velocity([3.0, 4.0, -1.0], 1.3)[2], abs=1e-6
    )


def test_the_level_of_the_source_paper_stays_within_its_bounds():
    water = Water(waves=LevelOscillation(0.3, 0.5))
    heights = np.array([float(water.elevation(0.0, 0.0, t)) for t in np.arange(0.0, 4.0, 0.01)])
    assert heights.max() == pytest.approx(0.3, abs=1e-12)
    assert heights.min() == pytest.approx(-0.3, abs=1e-12)
    assert heights[:200] == pytest.approx(heights[200:], abs=1e-12)


@pytest.mark.parametrize("depth", [math.inf, 20.0, 1.5])
def test_the_surface_moves_with_its_water(depth):
    # linear kinematic condition: d eta / dt = w at the surface
    water = Water(
        level=0.4,
        waves=[
            RegularWave(0.1, period=3.0, depth=depth, direction=0.3),
            LevelOscillation(0.2, 0.2),
        ],
    )
    h = 1e-5
    rate = (water.elevation(1.0, 2.0, 0.7 + h) - water.elevation(1.0, 2.0, 0.7 - h)) / (2.0 * h)
    top = float(water.elevation(1.0, 2.0, 0.7))
    assert water.velocity([1.0, 2.0, top], 0.7)[2] == pytest.approx(float(rate), rel=1e-8)


@pytest.mark.parametrize("depth", [math.inf, 5.0])
def test_the_orbital_velocity_is_free_of_divergence_and_of_rotation(depth):
    # to first order: what is left is as the square of the amplitude, at the surface too
    left = []
    for amplitude in (0.001, 0.002):
        water = Water(waves=RegularWave(amplitude, period=3.0, depth=depth, direction=0.8))
        for z in (-0.002, -0.5, -1.5):
            p, h = np.array([1.0, 2.0, z]), 1e-4
            gradient = np.array(
                [
                    (water.velocity(p + h * e, 0.2) - water.velocity(p - h * e, 0.2)) / (2 * h)
                    for e in np.eye(3)
                ]
            )
            left += [np.trace(gradient), *(gradient - gradient.T)[np.triu_indices(3, 1)]]
    # omega k A is 9e-4
    assert np.abs(left[: len(left) // 2]).max() < 2e-6
    assert np.abs(left[len(left) // 2 :]).max() < 8e-6


@pytest.mark.parametrize("depth", [math.inf, 5.0])
def test_the_velocity_has_no_jump_and_stays_bounded_under_a_crest(depth):
    # ripples on a swell: e^(k z) of the ripple would be 1e5 at the swell's crest
    swell = RegularWave(1.0, wavelength=60.0, depth=depth)
    ripple = RegularWave(0.01, wavelength=0.5, depth=depth)
    water = Water(waves=[swell, ripple])
    z = np.linspace(-2.0, 1.5, 3501)
    points = np.column_stack([0.0 * z, 0.0 * z, z])
    speeds = np.linalg.norm(water.velocity(points, 0.0), axis=1)
    most = sum(
        wave.rows[0, 0] * wave.rows[0, 3] / math.tanh(np.hypot(*wave.rows[0, 1:3]) * depth)
        for wave in (swell, ripple)
    )
    assert speeds.max() < 1.1 * most
    assert np.abs(np.diff(speeds)).max() < 2e-3


@pytest.mark.parametrize("depth", [math.inf, 3.0])
def test_the_mean_velocity_at_a_place_is_zero(depth):
    # so that what floats with the water drifts with Stokes: what moves with the surface would have
    # half of that drift against the waves
    wave = RegularWave(0.1, wavelength=4.0, depth=depth)
    water, k = Water(waves=wave), 2.0 * math.pi / 4.0
    omega = float(wave.rows[0, 3])
    times = np.linspace(0.0, wave.period, 64, endpoint=False)
    for z in (-0.12, -0.4, -1.0):
        mean = np.mean([water.velocity([0.0, 0.0, z], t) for t in times], axis=0)
        drift = 0.1**2 * omega * k * math.cosh(2.0 * k * (min(depth, 9.0) + z))
        drift /= 2.0 * math.sinh(k * min(depth, 9.0)) ** 2
        assert np.abs(mean).max() < 0.06 * drift


def test_waves_that_differ_in_amplitude_and_phase_alone_are_one():
    waves = [
        RegularWave(0.1, period=3.0, phase=0.4),
        RegularWave(0.2, period=4.0),
        RegularWave(0.3, period=3.0, phase=-1.0),
        LevelOscillation(0.1, 0.3),
        LevelOscillation(0.1, 0.3, phase=math.pi),
    ]
    rows = Water(waves=waves).rows
    assert rows[:, 3] == pytest.approx([waves[i].rows[0, 3] for i in (0, 1, 3)], rel=1e-15)
    assert rows[2, 0] == pytest.approx(0.0, abs=1e-16)
    for x, t in ((0.3, 0.2), (-2.0, 1.7)):
        parts = sum(float(Water(waves=wave).elevation(x, 0.0, t)) for wave in waves)
        assert naive.elevation(rows, x, 0.0, t) == pytest.approx(parts, abs=1e-15)


def test_no_water_flows_through_the_bottom():
    water = Water(waves=RegularWave(0.3, period=3.0, depth=2.0))
    assert water.velocity([0.3, 0.0, -2.0], 0.4)[2] == pytest.approx(0.0, abs=1e-15)


def test_deep_water_moves_on_circles_that_shrink_by_exp_kz():
    # at any depth in low waves, and from k d = 1.5 on in steep ones
    for steepness, depths, most in ((1e-4, (0.1, 0.5, 2.0), 2e-4), (0.2, (1.5, 2.0, 3.0), 0.02)):
        wave = RegularWave(steepness, wavelength=2.0 * math.pi)
        water, omega = Water(waves=wave), float(wave.rows[0, 3])
        for d in depths:
            times = np.linspace(0.0, wave.period, 9)
            speeds = [np.linalg.norm(water.velocity([0.0, 0.0, -d], t)) for t in times]
            assert speeds == pytest.approx([steepness * omega * math.exp(-d)] * 9, rel=most)


def test_the_current_adds_to_the_waves():
    # the orbits are those of the still water, which drifts along
    wave, current = RegularWave(0.3, period=3.0, frame="water"), np.array([0.5, -0.2, 0.0])
    still, moving = Water(waves=wave), Water(waves=wave, current=current)
    p = np.array([[1.0, 2.0, -0.3], [0.0, 0.0, -5.0]])
    assert moving.velocity(p + 0.7 * current, 0.7) - still.velocity(p, 0.7) == pytest.approx(
        np.tile(current, (2, 1)), abs=1e-14
    )


def test_depth_is_positive_in_the_water():
    assert Water(level=2.0).depth([[0, 0, 1.5], [0, 0, 2.5]], 0.0) == pytest.approx([0.5, -0.5])


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Water(density=0.0), "density is 0.0; it must be above 0"),
        (lambda: Water(density=math.nan), "density is nan; it must be a finite number"),
        (lambda: Water(level=math.inf), "level is inf; it must be a finite number"),
        (lambda: Water(density="salt"), "density is 'salt'; it must be a finite number"),
        (
            lambda: Water(waves=(3,)),
            "3 is no wave; possible are RegularWave, JonswapSea, PiersonMoskowitzSea and "
            "LevelOscillation",
        ),
        (
            lambda: Water(current=(1.0, 2.0)),
            r"current is \(1.0, 2.0\); it must be three finite numbers",
        ),
        (lambda: RegularWave(-0.1, period=1.0), "amplitude is -0.1; it must be at least 0"),
        (lambda: RegularWave(0.1, period=-1.0), "period is -1.0; it must be at least 1e-06"),
        (
            lambda: RegularWave(0.1, frequency=1e200),
            r"frequency is 1e\+200; it must be at least 1e-06 and at most 1e\+06",
        ),
        (lambda: RegularWave(0.1, period=1e-320), "period is 1e-320; it must be at least 1e-06"),
        (
            lambda: RegularWave(2.0, period=3.0, depth=1.0),
            "amplitude is 2.0 m in water 1.0 m deep; the trough would lie below",
        ),
        (
            lambda: Water(waves=5),
            "5 is no wave; possible are RegularWave, JonswapSea, PiersonMoskowitzSea and "
            "LevelOscillation",
        ),
        (lambda: Water(current="abc"), "current is 'abc'; it must be three finite numbers"),
        (
            lambda: Water(level=1e308),
            r"level is 1e\+308; it must be at least -1e\+06 and at most 1e\+06",
        ),
        (
            lambda: RegularWave(0.1, period=1.0, depth=0.0),
            "wave depth is 0.0; it must be at least 1e-06 m",
        ),
        (lambda: LevelOscillation(0.1, 0.0), "frequency is 0.0; it must be at least 1e-06"),
    ],
)
def test_impossible_water_is_refused(make, message):
    with pytest.raises(WaterError, match=message):
        make()


def test_a_sea_of_absurdly_many_waves_is_refused():
    with pytest.raises(WaterError, match="the sea has 10001 waves; it may have 10000 at most"):
        Water(waves=[LevelOscillation(0.0, 1.0)] * 10_001)
