"""Waves on a current: published numbers, the Doppler shift, what is blocked, and bodies in them."""

import dataclasses
import itertools
import math
import pickle

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from buoyancy_mj import (
    Buoyancy,
    BuoyancyWarning,
    CurrentProfile,
    CurrentSeries,
    JonswapSea,
    LevelOscillation,
    PiersonMoskowitzSea,
    RegularWave,
    SceneError,
    Water,
    WaterError,
    wavenumber,
)
from buoyancy_mj.scenes.scene import scene_from_table
from buoyancy_mj.sea.currents import effective_current
from buoyancy_mj.sea.dispersion import Dispersion
from buoyancy_mj.settings.config import parse_plugin_config, write_plugin_config
from buoyancy_mj.settings.settings import Settings

SHEAR = CurrentProfile((0.0, 1.0, 4.0), ((0.6, 0.1, 0.0), (0.2, 0.3, 0.0), (-0.2, 0.0, 0.0)))


# the dispersion relation


@pytest.mark.parametrize(
    ("current", "expected"),
    [(-2.0, 0.098300), (-1.0, 0.075561), (0.0, 0.062880), (1.0, 0.054462)],
)
def test_waves_of_8_s_have_the_wavenumbers_that_the_quadratic_equation_of_deep_water_gives(
    current, expected
):
    # (omega - k U)^2 = g k with omega = 2 pi / 8 s and g = 9.81, solved elsewhere
    assert wavenumber(2 * math.pi / 8.0, current=current) == pytest.approx(expected, abs=5.1e-7)


def test_currents_block_waves_where_theory_says():
    # in deep water from g / (4 omega) on
    assert wavenumber(2 * math.pi / 8.0, current=-3.1225) < 0.2515
    with pytest.raises(
        WaterError,
        match=r"no wave with an omega of 0\.785398 rad/s runs against a current of 3\.1227 m/s, "
        r"which blocks waves with a period of less than 8 s; make omega or the current less",
    ):
        wavenumber(2 * math.pi / 8.0, current=-3.1227)
    # in 0.5 m of water 0.5 m/s blocks 1.2811 s; solved elsewhere
    shallow = Dispersion((-0.5, 0.0, 0.0), 0.5, 9.81, (1.0, 10.0))
    assert 2 * math.pi / shallow.highest_frequency(0.0) == pytest.approx(1.2811, abs=5e-5)
    # a current faster than sqrt(g h) blocks them all
    with pytest.raises(WaterError, match="blocks waves of any period; make"):
        wavenumber(0.01, depth=0.1, current=-1.0)


BAD_WAVENUMBERS = [
    ({"omega": math.nan}, "omega is nan; it must be a finite number"),
    ({"omega": 0.0}, "omega is 0.0; it must be at least 1e-06 and at most 1e+07"),
    ({"omega": "1"}, "omega is '1'; it must be a finite number"),
    ({"depth": -1.0}, "wave depth is -1.0; it must be at least 1e-06 m (inf is deep water)"),
    ({"gravity": 0.0}, "gravity is 0.0; it must be at least 1e-06 and at most 1e+12"),
    ({"current": math.nan}, "current is nan; it must be a finite number"),
    ({"current": -math.inf}, "current is -inf; it must be a finite number"),
]


@pytest.mark.parametrize(("given", "message"), BAD_WAVENUMBERS)
def test_a_wavenumber_of_numbers_that_no_wave_has_is_refused(given, message):
    with pytest.raises(WaterError) as error:
        wavenumber(**({"omega": 1.0} | given))
    assert str(error.value) == message


@given(st.floats(0.1, 8.0), st.floats(0.05, 100.0), st.floats(-2.0, 3.0))
def test_the_wavenumber_is_the_least_that_solves_the_relation(omega, depth, current):
    try:
        k = wavenumber(omega, depth, current=current)
    except WaterError:
        k = None
    # the frequency at rest of all waves that are longer, and of all there are
    longer = np.geomspace(1e-6, k or 400.0, 4000)[: -1 if k else None]
    at_rest = np.sqrt(9.81 * longer * np.tanh(longer * depth)) + longer * current
    assert (at_rest < omega).all()
    if k:
        assert omega - k * current == pytest.approx(
            math.sqrt(9.81 * k * math.tanh(k * depth)), rel=1e-9
        )


def test_without_a_current_the_relation_is_that_of_still_water():
    for omega, depth in ((0.7, math.inf), (2.0, 0.5), (5.0, 3.0)):
        still = wavenumber(omega, depth)
        assert wavenumber(omega, depth, current=1e-300) == pytest.approx(still, rel=1e-12)


# the current that a wave feels


@pytest.mark.parametrize(("kh", "expected"), [(2.0, 0.75899), (5.0, 0.90001)])
def test_a_linear_profile_has_the_mean_of_kirby_and_chen(kh, expected):
    # U = 1 + z / h: 1 - tanh(kh) / (2 kh), Kirby and Chen 1989
    (felt,) = effective_current(CurrentProfile((0, 1), ((1, 0, 0), (0, 0, 0))), np.array([kh]), 1.0)
    assert felt == pytest.approx([expected, 0.0], abs=5e-6)
    assert felt[0] == pytest.approx(1.0 - math.tanh(kh) / (2.0 * kh), rel=1e-12)


@pytest.mark.parametrize("depth", [0.3, 3.0, math.inf])
@pytest.mark.parametrize("k", [1e-3, 0.4, 30.0])
def test_the_mean_of_a_profile_is_its_integral(k, depth):
    # rows above the surface and below the bottom count only for where they lead
    depths = np.array([-1.0, 0.5, 2.0, 7.0])
    speeds = np.array([[1.0, 0.0], [0.3, 0.2], [-0.5, 0.0], [0.1, 1.0]])
    profile = CurrentProfile(tuple(depths), tuple((u, v, 0.3) for u, v in speeds))

    def weight(z):
        echo = 0.0 if math.isinf(depth) else math.exp(-4.0 * k * (z + depth))
        bottom = 1.0 if math.isinf(depth) else -math.expm1(-4.0 * k * depth)
        return 2.0 * k * math.exp(2.0 * k * z) * (1.0 + echo) / bottom

    ends = [0.0, *(-d for d in depths[1:] if d < depth), -min(depth, 7.0 + 20.0 / k)]
    for c in (0, 1):
        parts = [
            quad(lambda z, c=c: weight(z) * np.interp(-z, depths, speeds[:, c]), low, high)[0]
            for high, low in itertools.pairwise(ends)
        ]
        found = effective_current(profile, np.array([k]), depth)[0, c]
        assert found == pytest.approx(sum(parts), abs=1e-7)


def test_a_wave_on_a_profile_solves_the_relation_with_the_mean_that_it_feels():
    wave = RegularWave(0.1, period=3.0, depth=5.0, direction=0.7)
    ((_, kx, ky, omega, _, _, sigma),) = Water(waves=wave, current=SHEAR).rows
    k = math.hypot(kx, ky)
    (felt,) = effective_current(SHEAR, np.array([k]), 5.0)
    assert omega == pytest.approx(2 * math.pi / 3.0, rel=1e-12)
    assert sigma == pytest.approx(omega - felt @ [kx, ky], rel=1e-12)
    assert sigma**2 == pytest.approx(9.81 * k * math.tanh(5.0 * k), rel=1e-12)
    # a constant profile is the same as the velocity itself
    flat = CurrentProfile((0.0, 2.0), ((0.3, 0.1, 0.0), (0.3, 0.1, 0.0)))
    assert Water(waves=wave, current=flat).rows == pytest.approx(
        Water(waves=wave, current=(0.3, 0.1, 0.0)).rows, rel=1e-12
    )


# what each observer sees


@pytest.mark.parametrize("current", [(0.8, 0.3, 0.0), (-0.5, 0.2, 0.1)])
@pytest.mark.parametrize("depth", [math.inf, 1.5])
def test_a_fixed_place_sees_the_frequency_and_one_that_drifts_sees_that_of_the_water(
    current, depth
):
    wave = RegularWave(0.1, period=3.0, direction=0.3, depth=depth)
    water, u = Water(waves=wave, current=current), np.array(current[:2])
    ((_, kx, ky, _, _, _, sigma),) = water.rows
    assert sigma == pytest.approx(2 * math.pi / 3.0 - u @ [kx, ky], rel=1e-12)
    for time in (0.0, 0.4, 1.1, 7.7):
        fixed = water.elevation(0.0, 0.0, time)
        assert fixed == pytest.approx(0.1 * math.cos(2 * math.pi * time / 3.0), abs=1e-12)
        adrift = water.elevation(*(u * time), time)
        assert adrift == pytest.approx(0.1 * math.cos(sigma * time), abs=1e-12)
    # and says the same of its own period
    same = dataclasses.replace(
        wave, period=2 * math.pi / sigma, frequency=math.nan, wavelength=math.nan, frame="water"
    )
    assert Water(waves=same, current=current).rows == pytest.approx(water.rows, rel=1e-9)


def test_a_wavelength_is_the_same_to_all_and_no_current_blocks_it():
    wave = RegularWave(0.01, wavelength=2.0)
    assert wave.frame == "water"
    for speed in (-9.0, -1.0, 3.0):
        ((_, k, _, omega, _, _, sigma),) = Water(waves=wave, current=(speed, 0.0, 0.0)).rows
        assert k == pytest.approx(math.pi, rel=1e-12)
        assert sigma == pytest.approx(math.sqrt(9.81 * math.pi), rel=1e-12)
        # swept away by a strong current, it runs backwards
        assert omega == pytest.approx(sigma + k * speed, rel=1e-12)


def test_a_current_across_or_upward_leaves_waves_as_they_are():
    wave = RegularWave(0.1, period=3.0, direction=0.5)
    still = Water(waves=wave).rows
    across = (-math.sin(0.5), math.cos(0.5), 0.0)
    assert Water(waves=wave, current=across).rows == pytest.approx(still, rel=1e-12)
    assert np.array_equal(Water(waves=wave, current=(0.0, 0.0, 0.4)).rows, still)


def test_a_level_that_goes_up_and_down_knows_no_current():
    water = Water(waves=LevelOscillation(0.3, 0.5), current=SHEAR)
    assert water.rows[0, 3] == water.rows[0, 6] == math.pi


def test_a_wave_of_somebodys_own_has_its_frequency_at_rest():
    class Ripple:
        rows = np.array([[0.1, 0.5, 0.2, 2.0, 0.0, 3.0]])

    ((*own, sigma),) = Water(waves=Ripple(), current=(0.3, -0.1, 0.0)).rows
    assert own == Ripple.rows[0].tolist()
    assert sigma == pytest.approx(2.0 - 0.15 + 0.02, rel=1e-12)


def test_a_blocked_wave_is_refused_with_the_shortest_period_that_runs():
    with pytest.raises(
        WaterError,
        match=r"a wave with a period of 2 s cannot run against the current, which blocks waves "
        r"with a period of less than 2\.562 s; give it a longer period or a weaker current, or say "
        r"frame = 'water' if the period is what the water sees$",
    ):
        # 8 pi U / g
        Water(waves=RegularWave(0.05, period=2.0, direction=math.pi), current=(1.0, 0.0, 0.0))
    with pytest.raises(
        WaterError,
        match=r"a wave with a period of 2\.6 s cannot run on the current: a wave 4 m high "
        r"and 3\.32 m long is higher than long",
    ):
        Water(waves=RegularWave(2.0, period=2.6), current=(-1.0, 0.0, 0.0))
    # in a scene too
    water = {"current": [-1.0, 0.0, 0.0], "waves": [{"amplitude": 0.05, "period": 2.0}]}
    with pytest.raises(SceneError, match=r"water: a wave with a period of 2 s cannot run against"):
        scene_from_table({"title": "t", "vehicle": "hourglass", "water": water})
    # where it runs with the current, or is the water's, there it is
    Water(waves=RegularWave(0.05, period=2.0), current=(1.0, 0.0, 0.0))
    Water(waves=RegularWave(0.05, period=2.0, frame="water"), current=(-1.0, 0.0, 0.0))


def test_a_wave_that_a_current_makes_too_steep_is_reported():
    wave = RegularWave(0.7, period=4.0)
    assert Water(waves=wave).warnings == ()
    (warning,) = Water(waves=wave, current=(-1.5, 0.0, 0.0)).warnings
    assert warning.startswith("a wave 1.4 m high and 8.97 m long, 1.10 times as steep")


@pytest.mark.parametrize("make", [JonswapSea, PiersonMoskowitzSea])
def test_a_frame_is_that_of_the_earth_or_of_the_water(make):
    for build in (
        lambda frame: make(0.3, 4.0, frame=frame),
        lambda frame: RegularWave(0.3, period=4.0, frame=frame),
    ):
        with pytest.raises(WaterError, match=r"^frame is 'ship'; possible: earth, water$"):
            build("ship")
        with pytest.raises(WaterError, match=r"^frame is \['water'\]; possible: earth, water$"):
            build(["water"])


def test_frames_stand_in_scenes_and_in_models():
    table = {"amplitude": 0.1, "period": 2.0, "frame": "water"}
    scene = {"title": "t", "vehicle": "hourglass", "water": {"waves": [table]}}
    wave = RegularWave(0.1, period=2.0, frame="water")
    assert scene_from_table(scene).water.waves == (wave,)
    with pytest.raises(SceneError, match=r"water.waves.0: frame is 'sea'; possible: earth, water"):
        scene_from_table(scene | {"water": {"waves": [table | {"frame": "sea"}]}})
    # a wave that its length alone gives to the last bit keeps its frame
    sea = JonswapSea(0.3, 4.0, frame="water")
    for waves in (wave, RegularWave(0.1, wavelength=7.3), sea):
        water = Water(waves=waves, current=(0.4, 0.0, 0.0))
        read = parse_plugin_config(write_plugin_config(Settings(water=water)), "here").water
        assert read.waves == water.waves
        assert np.array_equal(read.rows, water.rows)
        assert np.array_equal(pickle.loads(pickle.dumps(water)).rows, water.rows)


# seas


@pytest.mark.parametrize("spreading", [math.inf, 4.0])
def test_a_sea_keeps_its_spectrum_at_rest_and_its_height(spreading):
    sea = JonswapSea(0.4, 4.0, spreading=spreading, depth=20.0, seed=3)
    still, moving = Water(waves=sea).rows, Water(waves=sea, current=(0.5, 0.2, 0.0)).rows
    for column in (0, 3, 4, 5):
        assert moving[:, column] == pytest.approx(still[:, column], rel=1e-12)
    # each along its own direction
    assert np.arctan2(*moving[:, [2, 1]].T) == pytest.approx(np.arctan2(*still[:, [2, 1]].T))
    k = np.hypot(*moving[:, 1:3].T)
    assert moving[:, 6] == pytest.approx(np.sqrt(9.81 * k * np.tanh(20.0 * k)), rel=1e-9)
    assert moving[:, 6] == pytest.approx(moving[:, 3] - moving[:, 1:3] @ [0.5, 0.2], rel=1e-12)


def test_a_sea_of_the_water_is_that_of_still_water_which_drifts():
    sea = JonswapSea(0.4, 4.0, spreading=4.0, frame="water")
    water, still = Water(waves=sea, current=(-1.5, 0.2, 0.0)), Water(waves=sea)
    x, y = np.random.default_rng(0).normal(scale=20.0, size=(2, 9))
    assert water.elevation(x - 1.5 * 3.3, y + 0.2 * 3.3, 3.3) == pytest.approx(
        still.elevation(x, y, 3.3), abs=1e-12
    )


def test_waves_of_a_sea_that_a_current_blocks_are_left_out_and_reported():
    water = Water(waves=JonswapSea(0.3, 4.0), current=(-0.7, 0.0, 0.0))
    # all above g / (4 U), of equal energy
    omegas = JonswapSea(0.3, 4.0).rows[:, 3]
    runs = omegas < 9.81 / 2.8
    assert water.rows[:, 3] == pytest.approx(omegas[runs], rel=1e-12)
    assert (~runs).sum() == 2
    assert water.warnings == (
        "a sea of which 2 of 64 waves, 3.1 % of its energy, cannot run against the current and are "
        "left out",
    )
    model = mujoco.MjModel.from_xml_string(BALL.format(place="0 0 -1", more=""))
    with pytest.warns(BuoyancyWarning, match="the water has a sea of which 2 of 64 waves"):
        Buoyancy(model, water)
    with pytest.raises(
        WaterError,
        match=r"^29\.7 % of the energy of a sea with a peak_period of 4 s cannot run against the "
        r"current, waves with periods up to 3\.\d+ s; give it a longer peak_period or a weaker "
        r"current, or say frame = 'water' if the spectrum is what the water sees$",
    ):
        Water(waves=JonswapSea(0.3, 4.0), current=(-1.3, 0.0, 0.0))


def test_the_steepness_of_a_sea_is_what_its_water_sees():
    sea = PiersonMoskowitzSea(1.5, 4.0)
    assert Water(waves=sea).warnings == ()
    (warning,) = Water(waves=sea, current=(-0.65, 0.0, 0.0)).warnings
    assert warning.startswith("a sea of which 2 of 64 waves, 3.1 % of its energy, cannot run")
    assert ", and a sea 1.5 m high at 3.53 s, " in warning


# currents by time


def test_waves_on_a_current_by_time_have_the_length_that_they_have_on_its_mean():
    wave = RegularWave(0.1, period=8.0)
    series = CurrentSeries((0.0, 10.0, 30.0), ((0.1, 0.0, 0.0), (0.3, 0.0, 0.0), (0.1, 0.0, 0.0)))
    water = Water(waves=wave, current=series)
    assert water.rows == pytest.approx(Water(waves=wave, current=(0.2, 0.0, 0.0)).rows, rel=1e-12)
    assert water.warnings == ()
    # one row is a constant
    one = CurrentSeries((0.0,), ((0.2, 0.0, 0.0),))
    assert Water(waves=wave, current=one).rows == pytest.approx(water.rows, rel=1e-12)


def test_waves_on_a_current_that_changes_much_beside_their_speed_are_reported():
    # (sigma / k) of 3 s on a mean of 0.5 m/s is 5.15 m/s
    series = CurrentSeries((0.0, 10.0), ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0)))
    assert Water(waves=RegularWave(0.1, period=3.0), current=series).warnings == (
        "waves on a current that leaves its mean by up to 9.7 % of their speed through the water; "
        "they keep the length that they have on its mean: give the current of a shorter time",
    )
    assert Water(waves=LevelOscillation(0.1, 1.0), current=series).warnings == ()
    assert Water(current=series).warnings == ()


# bodies

BALL = """<mujoco><option timestep="0.01" integrator="RK4"/>
    <worldbody><body name="b" pos="{place}"><freejoint/>
    <geom type="sphere" size="0.05" density="1000"/></body></worldbody>{more}</mujoco>"""


@pytest.mark.parametrize(("speed", "period"), [(1.0, 2.0), (-0.6, 2.5)])
def test_a_neutral_sphere_that_drifts_along_orbits_as_the_water_does(speed, period):
    model = mujoco.MjModel.from_xml_string(BALL.format(place="0 0 -1", more=""))
    wave = RegularWave(0.002, period=period)
    water = Water(waves=wave, current=(speed, 0.0, 0.0))
    ((_, k, _, _, _, _, sigma),) = water.rows
    data, heights = mujoco.MjData(model), []
    data.qvel[:3] = water.velocity([0.0, 0.0, -1.0], 0.0)
    with Buoyancy(
        model, water, damping=None, pressure="froude-krylov", added_mass="estimate"
    ).installed():
        while data.time < 2 * math.pi / sigma:
            heights.append(data.qpos[2] + 1.0)
            mujoco.mj_step(model, data)
    # from the top of an orbit of A e^kz, with the frequency that the water sees
    orbit, times = 0.002 * math.exp(-k), 0.01 * np.arange(len(heights))
    assert heights == pytest.approx(orbit * (np.cos(sigma * times) - 1.0), abs=0.02 * orbit)


FLOAT = """<mujoco><option timestep="0.005" integrator="{integrator}"/>
    <custom><numeric name="radiation_damping:b" data="30 1 1"/></custom>
    <worldbody><body name="b" pos="0.1 0.2 0.03" euler="10 5 20"><freejoint/>
    <geom type="box" size="0.25 0.15 0.1" density="500"/>
    <geom type="sphere" size="0.08" pos="0.1 0 -0.2" density="700"/></body></worldbody></mujoco>"""


@pytest.mark.parametrize(
    ("integrator", "pressure"), [("RK4", "froude-krylov"), ("implicitfast", "archimedes")]
)
def test_a_vehicle_on_a_current_moves_as_one_on_still_water_seen_from_afar(integrator, pressure):
    # Galilei: still water, in which the vehicle starts with -U, seen by who moves with -U
    model = mujoco.MjModel.from_xml_string(FLOAT.format(integrator=integrator))
    u, start = np.array([0.7, -0.4, 0.0]), np.array([0.2, 0.1, 0.0])
    waves = [
        RegularWave(0.05, period=1.8, direction=2.5, frame="water", depth=3.0),
        RegularWave(0.02, wavelength=1.5, direction=-0.4, depth=3.0),
    ]
    paths = []
    for current, velocity in ((u, start), (np.zeros(3), start - u)):
        data = mujoco.MjData(model)
        data.qvel[:3] = velocity
        water = Water(waves=waves, current=current)
        path = []
        with Buoyancy(model, water, pressure=pressure, added_mass="estimate").installed():
            for _ in range(8):
                mujoco.mj_step(model, data, 50)
                place = data.qpos[:3] - current * data.time
                path.append(np.concatenate([place, data.qpos[3:], data.qvel[:3] - current]))
        paths.append(path)
    assert np.array(paths[0]) == pytest.approx(np.array(paths[1]), abs=1e-8)
    # it was carried off
    assert np.ptp(np.array(paths[0])[:, 0]) > 0.2
