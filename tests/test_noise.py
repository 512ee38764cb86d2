"""The noise of sensors: Gaussian, and a function of whole numbers alone."""

import numpy as np
import pytest
from scipy import stats

from buoyancy_mj.kernels.vehicle.sensors.noise import draw_normal, draw_normals, mix

COUNT = 200_000


def draw(seed=0, stream=0, sensor=0, first=0, number=0):
    """Noise of samples in a row."""
    out = np.empty(COUNT)
    draw_normals(seed, stream, sensor, first, number, out)
    return out


def test_noise_is_gaussian_to_its_tails():
    noise = draw(seed=5)
    assert noise.mean() == pytest.approx(0.0, abs=4.0 / np.sqrt(COUNT))
    assert noise.var() == pytest.approx(1.0, abs=4.0 * np.sqrt(2.0 / COUNT))
    assert stats.kstest(noise, "norm").pvalue > 1e-3
    beyond = (np.abs(noise) > 3.5).sum()
    expected = COUNT * 2.0 * stats.norm.sf(3.5)
    assert beyond == pytest.approx(expected, abs=4.0 * np.sqrt(expected))
    assert 4.0 < np.abs(noise).max() < 6.5


@pytest.mark.parametrize(
    "other",
    [{"seed": 1}, {"stream": 1}, {"sensor": 1}, {"number": 1}, {"first": 1}, {"first": 2**40}],
)
def test_noise_of_neighbours_has_nothing_in_common(other):
    one, two = draw(), draw(**other)
    for first, second in ((one, two), (one**2, two**2), (np.abs(one), two)):
        assert abs(np.corrcoef(first, second)[0, 1]) < 4.5 / np.sqrt(COUNT)


def test_noise_of_a_sample_is_the_same_whenever_it_is_drawn():
    assert draw(first=1000)[7] == draw_normal(0, 0, 0, 1007, 0)


def test_numbers_before_the_beginning_and_large_ones_have_noise_too():
    for words in ((0, -1, 0, -5, 0), (2**31 - 1, 2**52, 10**6, 2**60, 500)):
        assert np.isfinite(draw_normal(*words))


def test_the_bits_are_those_of_splitmix64():
    # the first three words from the seed 1234567, as Vigna's splitmix64.c gives them
    golden = 0x9E3779B97F4A7C15
    words = [int(mix(np.uint64((1234567 + n * golden) % 2**64))) for n in (1, 2, 3)]
    assert words == [6457827717110365317, 3203168211198807973, 9817491932198370423]
