"""Irregular seas: their spectra, the statistics of long realisations, seeds, and theory."""

import math

import numpy as np
import pytest
import trimesh
from scipy.integrate import quad
from scipy.signal import welch

from buoyancy_mj import (
    Buoyancy,
    BuoyancyWarning,
    JonswapSea,
    LevelOscillation,
    ModelError,
    PiersonMoskowitzSea,
    RegularWave,
    Water,
    WaterError,
)
from buoyancy_mj.kernels import heads, surface, tiles
from buoyancy_mj.kernels import waves as kernels
from buoyancy_mj.kernels.arrays import conform
from buoyancy_mj.kernels.scratch import new_scratches
from buoyancy_mj.meshes import shapes
from buoyancy_mj.scenes.scene import scene_from_table
from buoyancy_mj.settings.config import parse_plugin_config, write_plugin_config
from buoyancy_mj.settings.settings import Settings
from buoyancy_mj.submersion import sea_tiles
from buoyancy_mj.submersion.exact import PackedHulls
from buoyancy_mj.submersion.hull_set import HullSet
from tests import naive, vessels

HOUR = np.arange(0.0, 3600.0, 0.1)
SEAS = [
    JonswapSea(0.6, 4.0),
    JonswapSea(0.6, 4.0, gamma=7.0, spreading=4.0, seed=3),
    JonswapSea(2.0, 8.0, gamma=1.0, depth=12.0, seed=7),
    PiersonMoskowitzSea(0.6, seed=11),
]


def elevations(sea, times=HOUR, x=0.0):
    """The surface at one place."""
    a, kx, _, omega, phase, _ = sea.rows.T
    return (a[:, None] * np.cos(kx[:, None] * x - omega[:, None] * times + phase[:, None])).sum(
        axis=0
    )


# spectra


def test_the_spectrum_is_the_published_one():
    # Pierson and Moskowitz 1964 as in DNV-RP-C205, 3.5.5:
    # 5/16 Hs^2 omega_p^4 omega^-5 exp(-5/4 (omega / omega_p)^-4)
    sea, peak = JonswapSea(2.0, 8.0, gamma=1.0), 2 * math.pi / 8.0
    for omega in (0.7 * peak, peak, 1.5 * peak, 3.0 * peak):
        expected = 5 / 16 * 4.0 * peak**4 * omega**-5 * math.exp(-1.25 * (omega / peak) ** -4)
        # what the cutoff takes is spread over the rest
        assert float(sea.spectrum(omega)) == pytest.approx(expected, rel=2e-4)
    # there too: JONSWAP is that times 1 - 0.287 ln gamma and times gamma^exp(...), at the peak
    # gamma; good to 1 %
    factor = float(JonswapSea(2.0, 8.0).spectrum(peak) / sea.spectrum(peak))
    assert factor == pytest.approx(3.3 * (1.0 - 0.287 * math.log(3.3)), rel=0.01)


@pytest.mark.parametrize("gamma", [1.0, 2.0, 3.3, 5.0, 7.0])
def test_the_zero_crossing_period_is_the_published_one(gamma):
    # DNV-RP-C205, 3.5.5: a fit, for gamma from 1 to 7
    fit = 0.6673 + 0.05037 * gamma - 0.006230 * gamma**2 + 0.0003341 * gamma**3
    assert JonswapSea(1.0, 6.0, gamma=gamma).zero_crossing_period / 6.0 == pytest.approx(
        fit, rel=0.01
    )


@pytest.mark.parametrize("sea", SEAS[:3])
def test_height_is_four_standard_deviations_and_the_waves_have_the_spectrums_moments(sea):
    area, _ = quad(
        sea.spectrum,
        0.3 * 2 * math.pi / sea.peak_period,
        10 * 2 * math.pi / sea.peak_period,
        limit=200,
    )
    assert 4.0 * math.sqrt(area) == pytest.approx(sea.significant_height, rel=1e-4)
    a, omega = sea.rows[:, 0], sea.rows[:, 3]
    assert 4.0 * math.sqrt(0.5 * (a**2).sum()) == pytest.approx(sea.significant_height, rel=1e-12)
    crossing = 2 * math.pi * math.sqrt((a**2).sum() / (a**2 * omega**2).sum())
    assert crossing == pytest.approx(sea.zero_crossing_period, rel=1e-4)


def test_a_fully_developed_sea_has_its_period_from_its_height():
    # Pierson and Moskowitz 1964: Hs = 0.21 U^2 / g, omega_p = 0.877 g / U, U the wind at 19.5 m
    wind = 10.0
    sea = PiersonMoskowitzSea(0.21 * wind**2 / 9.81)
    assert 2 * math.pi / sea.peak_period == pytest.approx(0.877 * 9.81 / wind, rel=0.01)


@pytest.mark.parametrize("s", [2.0, 10.0, 50.0])
def test_directions_have_the_spread_of_their_exponent(s):
    # mean cosine of cos^2s(b / 2): s / (s + 1)
    rows = JonswapSea(1.0, 6.0, direction=0.7, spreading=s, components=500).rows
    angles = np.arctan2(rows[:, 2], rows[:, 1]) - 0.7
    assert np.cos(angles).mean() == pytest.approx(s / (s + 1.0), abs=2e-3)
    assert np.sin(angles).mean() == pytest.approx(0.0, abs=2e-3)
    # of all frequencies alike
    assert abs(np.corrcoef(angles, rows[:, 3])[0, 1]) < 0.15


# realisations


@pytest.mark.parametrize("sea", SEAS)
def test_an_hour_has_the_height_the_peak_and_the_crossings_of_its_spectrum(sea):
    eta = elevations(sea)
    assert 4.0 * eta.std() == pytest.approx(sea.significant_height, rel=0.03)
    ups = np.count_nonzero((eta[:-1] < 0.0) & (eta[1:] >= 0.0))
    spectrum = sea if isinstance(sea, JonswapSea) else sea.as_jonswap
    assert 3600.0 / ups == pytest.approx(spectrum.zero_crossing_period, rel=0.03)


@pytest.mark.parametrize("sea", SEAS)
def test_the_spectrum_of_long_realisations_peaks_at_the_peak_period(sea):
    # an estimate blurs the peak, of the true spectrum too: compare centres of the highest parts
    spectrum = sea if isinstance(sea, JonswapSea) else sea.as_jonswap
    times = np.arange(0.0, 8 * 3600.0, 0.25)
    frequencies, density = welch(elevations(sea, times), 4.0, nperseg=int(4 * 16 * sea.peak_period))
    exact = spectrum.spectrum(np.maximum(2 * math.pi * frequencies, 1e-6))
    near = np.abs(frequencies * sea.peak_period - 1.0) < 0.3
    found, expected = (
        np.average(frequencies[near], weights=d[near] ** 4) for d in (density, exact)
    )
    assert found == pytest.approx(expected, rel=0.03)
    assert expected == pytest.approx(1.0 / sea.peak_period, rel=0.05)


@pytest.mark.parametrize("sea", SEAS)
def test_an_hour_does_not_repeat_itself(sea):
    # the correlation of the sea with itself any time later than thirty of its periods
    omega = sea.rows[:, 3]
    lags = np.arange(30 * sea.peak_period, 3600.0, 0.1)
    correlation = np.cos(np.outer(lags, omega)).mean(axis=1)
    assert np.abs(correlation).max() < 0.5


def test_crests_are_distributed_as_of_a_gaussian_sea():
    # Longuet-Higgins 1952: of narrow seas, one wave height in so many exceeds H: exp(-2 (H / Hs)^2)
    sea = JonswapSea(1.0, 4.0, gamma=7.0, components=256)
    eta = elevations(sea, np.arange(0.0, 4 * 3600.0, 0.1))
    ups = np.flatnonzero((eta[:-1] < 0.0) & (eta[1:] >= 0.0))
    heights = np.array([np.ptp(part) for part in np.split(eta, ups)[1:-1]])
    third = np.sort(heights)[-len(heights) // 3 :].mean()
    assert third == pytest.approx(0.95, abs=0.05)  # Goda: 0.95 of 4 sigma for seas of finite width
    assert np.mean(heights > 1.0) == pytest.approx(math.exp(-2.0), abs=0.04)


def test_the_seed_makes_the_sea_the_same_everywhere():
    # the Mersenne Twister's first numbers for seed 0, 0.8444218515250481 and 0.7579544029403025,
    # are part of Python's tests
    rows = JonswapSea(1.0, 5.0, seed=0).rows
    assert rows[:2, 4] == pytest.approx(
        [2 * math.pi * 0.8444218515250481, 2 * math.pi * 0.7579544029403025], rel=1e-15
    )
    again, other = JonswapSea(1.0, 5.0, seed=0).rows, JonswapSea(1.0, 5.0, seed=1).rows
    assert np.array_equal(rows, again)
    assert not np.allclose(rows[:, 4], other[:, 4])
    assert rows[:, 3] == pytest.approx(other[:, 3])


def test_seas_and_swell_add_up():
    sea, swell = JonswapSea(0.5, 4.0, seed=2), RegularWave(0.2, period=9.0, direction=1.0)
    both = Water(waves=[sea, swell])
    assert len(both.rows) == 65
    x, y = np.linspace(-5, 5, 7), np.linspace(3, -8, 7)
    parts = Water(waves=sea).elevation(x, y, 1.3) + Water(waves=swell).elevation(x, y, 1.3)
    assert both.elevation(x, y, 1.3) == pytest.approx(parts, abs=1e-14)


# what theory asks of water


@pytest.mark.parametrize("depth", [math.inf, 4.0])
@pytest.mark.parametrize("current", [(0.0, 0.0, 0.0), (0.6, -0.3, 0.0)])
def test_water_is_kept_does_not_turn_and_moves_with_its_surface(depth, current):
    # to first order: what is left is of second, and these waves are low
    sea = JonswapSea(4e-4, 3.0, spreading=5.0, depth=depth)
    water, h = Water(waves=sea, current=current), 1e-4
    for p in np.array([[1.0, 2.0, -0.3], [-3.0, 0.5, -2.0]]):
        gradient = np.array(
            [
                (water.velocity(p + h * e, 0.2) - water.velocity(p - h * e, 0.2)) / (2 * h)
                for e in np.eye(3)
            ]
        )
        assert np.trace(gradient) == pytest.approx(0.0, abs=1e-7)
        assert gradient == pytest.approx(gradient.T, abs=1e-7)
        # as the water sees it, which drifts with the current
        d = h * np.array(water.current)
        rate = (water.velocity(p + d, 0.2 + h) - water.velocity(p - d, 0.2 - h)) / (2 * h)
        assert water.acceleration(p, 0.2) == pytest.approx(rate, abs=1e-6)
        ahead = water.elevation(p[0] + d[0], p[1] + d[1], 0.2 + h)
        behind = water.elevation(p[0] - d[0], p[1] - d[1], 0.2 - h)
        rise, top = (ahead - behind) / (2 * h), float(water.elevation(*p[:2], 0.2))
        assert water.velocity([*p[:2], top], 0.2)[2] == pytest.approx(float(rise), abs=1e-9)
        around = [
            water.elevation(p[0] + h * a, p[1] + h * b, 0.2)
            for a, b in ((1, 0), (-1, 0), (0, 1), (0, -1))
        ]
        slope = [(around[0] - around[1]) / (2 * h), (around[2] - around[3]) / (2 * h)]
        assert water.slope(*p[:2], 0.2) == pytest.approx(slope, abs=1e-7)


@pytest.mark.parametrize("depth", [math.inf, 4.0])
@pytest.mark.parametrize("current", [(0.0, 0.0, 0.0), (0.6, -0.3, 0.0), (-0.15, 0.0, 0.0)])
@pytest.mark.parametrize("frame", ["earth", "water"])
def test_pressure_and_acceleration_obey_eulers_equation_to_first_order(depth, current, frame):
    # rho a = -grad p - rho g z; what is left is of second order
    worst = []
    for height in (1e-3, 2e-3):
        sea = JonswapSea(height, 3.0, spreading=5.0, depth=depth, frame=frame)
        water, h, density = Water(waves=sea, current=current), 1e-3, 1000.0
        errors = []
        for p in np.array([[1.0, 2.0, -0.2], [-3.0, 0.5, -1.0], [0.3, 4.0, -2.5]]):
            slope = [
                (water.pressure(p + h * e, 0.4) - water.pressure(p - h * e, 0.4)) / (2 * h)
                for e in np.eye(3)
            ]
            errors.append(
                density * water.acceleration(p, 0.4) + np.array(slope) + [0.0, 0.0, density * 9.81]
            )
        worst.append(np.abs(errors).max())
    assert worst[0] < 2e-3 * density * 9.81 * 1e-3 * (2 * math.pi / 3.0) ** 2 / 9.81 * 10
    assert worst[1] / worst[0] == pytest.approx(4.0, rel=0.1)


def test_pressure_is_zero_on_an_irregular_surface():
    water = Water(density=1025.0, level=0.3, waves=JonswapSea(0.6, 4.0, spreading=5.0))
    for x, y in ((0.0, 0.0), (3.0, -2.0)):
        eta = float(water.elevation(x, y, 2.0))
        assert float(water.pressure([x, y, eta], 2.0)) == pytest.approx(0.0, abs=1e-9)


def test_many_points_at_once_are_summed_as_one_by_one():
    water = Water(waves=SEAS[1])
    x, y = np.random.default_rng(0).normal(scale=1e3, size=(2, 100))
    for time in (0.0, 1e5):
        found = water.elevation(x, y, time)
        one_by_one = [naive.elevation(water.rows, *place, time) for place in zip(x, y, strict=True)]
        # a phase of 1e6 is known to 1e-10
        assert found == pytest.approx(one_by_one, abs=1e-9)


# many waves on hulls


MIXED = [
    lambda depth: JonswapSea(0.6, 4.0, spreading=8.0, depth=depth),
    lambda depth: RegularWave(0.1, period=9.0, depth=depth),
    lambda _: LevelOscillation(0.05, 0.2),
]
"""Waves in water of a depth."""


@pytest.mark.parametrize("radius", [0.1, 0.8, 5.0])
def test_tiles_keep_their_bound(radius):
    rows = Water(waves=[wave(math.inf) for wave in MIXED]).rows
    sea = conform(sea_tiles.lay_tiles(rows, [3.0 * radius, radius]))
    # most of the waves are in them
    assert sea.layout[tiles.HELD] > len(rows) / 2
    (scratch,) = new_scratches(1, 3, len(rows))
    around = (sea, scratch.cut.store)
    places = np.random.default_rng(1).uniform(-4.0, 4.0, (200, 2)) * radius
    for x, y in places:
        found, *slope = surface.tangent_at(*around, x, y, 0.7)
        eta, *exact = kernels.tangent(kernels.tabulate(rows), x, y, 0.7)
        assert found == pytest.approx(eta, abs=sea_tiles.ACCURACY * radius)
        # the last degree counts once more for slopes
        off = tiles.DEGREE / sea.layout[tiles.REACH] * sea_tiles.ACCURACY * radius
        assert slope == pytest.approx(exact, abs=off)

    # and many at once find the same, near each other and far apart
    for x, y in (places.T, (places[:9] * 1e-3).T):
        out = np.zeros(len(x))
        tiles.add_elevations(*around, (0.3, -0.2), x, y, len(x), 0.7, out)
        held = sea.waves[:, : int(sea.layout[tiles.HELD])]
        phases = np.outer(x + 0.3, held[1]) + np.outer(y - 0.2, held[2]) + held[4] - 0.7 * held[3]
        one_by_one = np.cos(phases) @ held[0]
        assert out == pytest.approx(one_by_one, abs=sea_tiles.ACCURACY * radius)


def test_a_tile_is_the_same_whoever_asks_for_it_first():
    rows = Water(waves=SEAS[1]).rows
    sea = conform(sea_tiles.lay_tiles(rows, [0.5]))
    places = np.random.default_rng(2).uniform(-30.0, 30.0, (300, 2))
    found = []
    for order in (places, places[::-1]):
        store = new_scratches(1, 3, len(rows))[0].cut.store
        found.append([surface.tangent_at(sea, store, x, y, 3.1) for x, y in order])
    assert found[0] == found[1][::-1]


@pytest.mark.parametrize("depth", [math.inf, 5.0, 1.2])
def test_blocks_give_the_pressure_of_waves(depth):
    rows = Water(waves=[wave(depth) for wave in MIXED]).rows
    sea = conform(sea_tiles.lay_tiles(rows, [0.8]))
    water = conform(sea_tiles.lay_blocks(rows, [0.8]))
    places = np.zeros((4, 600))
    places[:3] = np.random.default_rng(1).uniform([-2.0, -2.0, -1.0], [2.0, 2.0, 0.3], (600, 3)).T
    exact = np.array(
        [kernels.head(kernels.tabulate(rows), *place, 0.7, True) for place in places[:3].T]
    )
    eta = np.array([naive.elevation(rows, x, y, 0.7) for x, y in places[:2].T])
    wet = places[2] < eta

    # beside what waves add to still water
    (scratch,) = new_scratches(1, 3, len(rows))
    around = heads.Sea(sea, scratch.cut.store, water, scratch.pressure.store, 0.7, True)
    heads.set_heads(around, places, 600)
    off, added = (places[3] - exact)[wet], (exact + places[2])[wet]
    assert off.std() < 6e-3 * added.std()
    assert abs(off.mean()) < 2e-3 * added.std()
    assert np.abs(off).max() < 1e-2 * 0.6

    # hydrostatic under their surface, by tiles
    heads.set_heads(around._replace(dynamic=False), places, 600)
    assert places[3] == pytest.approx(eta - places[2], abs=sea_tiles.ACCURACY * 0.8)

    # where the waves are summed one by one
    sea.layout[tiles.HELD] = 0.0
    heads.set_heads(around, places, 600)
    assert places[3] == pytest.approx(exact, abs=1e-12)


@pytest.mark.parametrize("components", [4, 5, 64, 200])
@pytest.mark.long
def test_a_hull_in_a_sea_displaces_what_the_sum_over_small_triangles_says(components):
    water = Water(waves=JonswapSea(0.6, 4.0, spreading=8.0, components=components))
    mesh, turn = vessels.dented(3), naive.roll(0.4)
    packed = PackedHulls(HullSet([mesh]), water)
    fine = trimesh.Trimesh(mesh.vertices, mesh.faces).subdivide().subdivide().subdivide()
    for time in (0.0, 1.1, 2.7):
        place = np.array([0.4, -0.3, float(water.elevation(0.4, -0.3, time)) - 0.05])
        found = packed.submerge(place[None], turn.reshape(1, 9), time)[0]
        volume, moments = naive.directly(fine, place, turn, water, time)
        assert found[0] == pytest.approx(volume, abs=2e-3 * mesh.volume)
        assert found[0] * (found[1:4] - place) == pytest.approx(
            moments, abs=2e-3 * mesh.volume * mesh.radius
        )


@pytest.mark.parametrize("depth", [math.inf, 5.0, 0.8])
def test_waves_gathered_and_waves_one_by_one_push_alike(depth):
    # a hull around which tiles hold no wave, and the same hull
    waves = [
        RegularWave(0.01, period=3.0 + 0.02 * n, direction=0.3, phase=0.1 * n, depth=depth)
        for n in range(16)
    ]
    water = Water(waves=[*waves, LevelOscillation(0.05, 0.2)])
    mesh, turn = shapes.box((0.5, 0.3, 0.2)), naive.roll(0.4).reshape(1, 9)
    for z in (0.0, -0.3, -1.0):
        for time in (0.2, 0.9):
            rows = [PackedHulls(HullSet([mesh]), water) for _ in range(2)]
            rows[0].hulls.tiles.layout[tiles.HELD] = 0.0
            a, b = (packed.submerge(np.array([[0.1, 0.2, z]]), turn, time)[0] for packed in rows)
            assert b[:5] == pytest.approx(a[:5], abs=1e-6)
            a, b = (
                packed.press(np.array([[0.1, 0.2, z]]), turn, time, dynamic=True)[0]
                for packed in rows
            )
            assert b == pytest.approx(a, abs=1e-6)


# as text, and bad input


def test_seas_stand_in_scenes_and_in_models():
    table = {
        "kind": "jonswap",
        "significant_height": 0.5,
        "peak_period": 4.0,
        "seed": 5,
        "spreading": 8.0,
    }
    scene = scene_from_table({"title": "t", "vehicle": "hourglass", "water": {"waves": [table]}})
    assert scene.water.waves == (JonswapSea(0.5, 4.0, seed=5, spreading=8.0),)
    for sea in SEAS:
        texts = write_plugin_config(Settings(water=Water(waves=sea)))
        assert np.array_equal(parse_plugin_config(texts, "here").water.rows[:, :6], sea.rows)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: JonswapSea(-1.0, 5.0), "significant_height is -1.0; it must be at least 0"),
        (
            lambda: JonswapSea(math.nan, 5.0),
            "significant_height is nan; it must be a finite number",
        ),
        (lambda: JonswapSea(1.0, 0.0), "peak_period is 0.0; it must be at least 1e-06"),
        (lambda: JonswapSea(1.0, 5.0, gamma=0.5), "gamma is 0.5; it must be at least 1"),
        (
            lambda: JonswapSea(1.0, 5.0, components=0),
            "components is 0; it must be a whole number from 1 to 10000",
        ),
        (
            lambda: JonswapSea(1.0, 5.0, components=6.5),
            "components is 6.5; it must be a whole number",
        ),
        (lambda: JonswapSea(1.0, 5.0, seed=-1), "seed is -1; it must be a whole number from 0"),
        (
            lambda: JonswapSea(1.0, 5.0, spreading=0.0),
            "spreading is 0.0; it must be an exponent above 0, or inf",
        ),
        (
            lambda: JonswapSea(3.0, 9.0, depth=2.0),
            "significant_height is 3.0 m in water 2.0 m deep; such waves break",
        ),
        (lambda: PiersonMoskowitzSea(0.0), "significant_height is 0.0; it must be above 0"),
    ],
)
def test_impossible_seas_are_refused(make, message):
    with pytest.raises(WaterError, match=message):
        make()


@pytest.mark.parametrize(
    ("wave", "message"),
    [
        (
            RegularWave(0.5, wavelength=5.0),
            "a wave 1 m high and 5 m long, 1.41 times as steep as one that breaks",
        ),
        (RegularWave(0.5, wavelength=50.0, depth=3.0), "make it at most 2.56 m high"),
        (
            JonswapSea(3.0, 4.0),
            "a sea 3 m high at 4 s, 1.80 times as steep as seas get before their waves break",
        ),
    ],
)
def test_seas_that_break_are_reported_with_the_number(wave, message):
    water = Water(waves=wave)
    model = vessels.box()
    if isinstance(wave, RegularWave) and wave.depth == 3.0:
        # 0.142 tanh(k h) wavelengths
        assert water.warnings == ()
        assert RegularWave(1.4, wavelength=50.0, depth=3.0).warning.endswith(message)
        return
    with pytest.warns(BuoyancyWarning, match=message):
        Buoyancy(model, water)


def test_water_shallower_than_the_hull_is_refused():
    water = Water(waves=RegularWave(0.02, period=2.0, depth=0.1))
    with pytest.raises(
        ModelError, match=r"water 0\.1 m deep, and body 'hull' has a draft of at least 0\.158 m"
    ):
        Buoyancy(vessels.box(), water)
