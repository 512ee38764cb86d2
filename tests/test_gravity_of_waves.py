"""The gravity of waves is that of the model in whose water they run."""

import copy
import math
import pickle
import re

import mujoco
import numpy as np
import pytest

from buoyancy_mj import (
    Buoyancy,
    JonswapSea,
    LevelOscillation,
    PiersonMoskowitzSea,
    RegularWave,
    Simulation,
    Water,
    WaterError,
    add_water,
    read_scene,
    water_in,
)
from buoyancy_mj.kernels.waves import AMPLITUDE, KX, OMEGA
from buoyancy_mj.settings.config import parse_plugin_config, write_plugin_config
from buoyancy_mj.settings.settings import Settings

MOON = 1.62
BOX = """<mujoco><option gravity="{gravity}"><flag gravity="{flag}"/></option><worldbody>
<body name="hull"><freejoint/><geom type="box" size=".3 .2 .1" mass="12"/></body>
</worldbody></mujoco>"""
REFUSAL = re.escape(
    "a wave states a gravity of 9.81 m/s^2, and that of the model is 1.62 m/s^2; "
    "leave the wave's out, and it takes the model's"
)


def xml(gravity=MOON, flag="enable"):
    return BOX.format(gravity=gravity if isinstance(gravity, str) else f"0 0 -{gravity}", flag=flag)


def model_of(gravity=MOON, flag="enable"):
    return mujoco.MjModel.from_xml_string(xml(gravity, flag))


def rows_in(model, *waves):
    return Buoyancy(model, Water(waves=waves)).water.rows


@pytest.mark.parametrize("length", [{"frequency": 0.2}, {"period": 5.0}, {"wavelength": 40.0}])
@pytest.mark.parametrize("depth", [math.inf, 3.0])
def test_a_wave_that_states_no_gravity_takes_the_models(length, depth):
    wave = RegularWave(0.1, depth=depth, **length)
    (row,) = rows_in(model_of(), wave)
    k, omega = row[KX], row[OMEGA]
    assert omega**2 == pytest.approx(MOON * k * math.tanh(k * depth), rel=1e-12)

    # what was given stays
    values = {
        "frequency": omega / (2 * math.pi),
        "period": 2 * math.pi / omega,
        "wavelength": 2 * math.pi / k,
    }
    ((name, value),) = length.items()
    assert values[name] == pytest.approx(value, rel=1e-12)


def test_a_sea_takes_the_models_gravity_and_keeps_its_spectrum():
    sea = JonswapSea(significant_height=0.2, peak_period=4.0, seed=3)
    rows = rows_in(model_of(), sea)
    assert rows[:, KX] == pytest.approx(rows[:, OMEGA] ** 2 / MOON)
    assert rows[:, [AMPLITUDE, OMEGA]] == pytest.approx(sea.rows[:, [AMPLITUDE, OMEGA]])

    # a fully developed sea has its peak by gravity: omega_p goes with its root
    grown = PiersonMoskowitzSea(significant_height=0.2)
    (taken,) = Buoyancy(model_of(), Water(waves=grown)).water.waves
    assert taken.peak_period == pytest.approx(grown.peak_period * math.sqrt(9.81 / MOON))
    stated = PiersonMoskowitzSea(significant_height=0.2, peak_period=4.0)
    (taken,) = Buoyancy(model_of(), Water(waves=stated)).water.waves
    assert taken.peak_period == 4.0


def test_waves_of_earth_stay_as_they_are():
    waves = RegularWave(0.1, period=2.0), LevelOscillation(0.1, 0.2)
    water = Water(waves=waves)
    assert Buoyancy(model_of(9.81), water).water is water
    assert water.with_gravity(MOON).waves[1] is waves[1]


@pytest.mark.parametrize(
    "wave",
    [
        RegularWave(0.1, period=2.0, gravity=9.81),
        JonswapSea(significant_height=0.1, peak_period=3.0, gravity=9.81),
        PiersonMoskowitzSea(significant_height=0.1, gravity=9.81),
    ],
)
def test_a_wave_that_states_another_gravity_is_refused_everywhere(wave, tmp_path):
    with pytest.raises(WaterError, match=REFUSAL):
        Buoyancy(model_of(), Water(waves=wave))
    spec = mujoco.MjSpec.from_string(xml())
    add_water(spec, Water(waves=wave))
    with pytest.raises(ValueError, match=REFUSAL):
        mujoco.MjData(spec.compile())
    (tmp_path / "box.xml").write_text(xml())
    (tmp_path / "scene.toml").write_text(
        """title = "Moon"\nvehicle = "box.xml"\n
        [[water.waves]]\namplitude = 0.1\nperiod = 2.0\ngravity = 9.81\n"""
    )
    with pytest.raises(WaterError, match=REFUSAL):
        Simulation(read_scene(tmp_path / "scene.toml"))

    # the same to nine digits is the same
    assert Buoyancy(model_of(9.81 * (1.0 + 1e-12)), Water(waves=wave))


def test_a_wave_that_the_models_gravity_would_make_higher_than_long_is_refused():
    wave = RegularWave(0.3, frequency=0.8)
    with pytest.raises(WaterError, match=r"0\.6 m high and 0\.403 m long is higher than long"):
        Buoyancy(model_of(), Water(waves=wave))


def test_plugins_and_scenes_have_the_waves_of_their_model(tmp_path):
    wave = RegularWave(0.1, period=5.0)
    expected = Buoyancy(model_of(), Water(waves=wave)).water.rows
    assert expected[0, KX] == pytest.approx((2 * math.pi / 5.0) ** 2 / MOON)

    # one text is in models of two gravities
    spec = mujoco.MjSpec.from_string(xml())
    add_water(spec, Water(waves=wave))
    text = spec.to_xml()
    assert "gravity=" not in write_plugin_config(Settings(water=Water(waves=wave)))["waves"]
    model = mujoco.MjModel.from_xml_string(text)
    assert np.array_equal(water_in(model).water.rows, expected)
    model.opt.gravity[2] = -9.81
    assert np.array_equal(water_in(model).water.rows, Water(waves=wave).rows)

    # and so has a scene
    (tmp_path / "box.xml").write_text(xml())
    (tmp_path / "scene.toml").write_text(
        """title = "Moon"\nvehicle = "box.xml"\nduration = 0.1\n
        [[water.waves]]\namplitude = 0.1\nperiod = 5.0\n"""
    )
    simulation = Simulation(read_scene(tmp_path / "scene.toml"))
    assert np.array_equal(simulation.buoyancy.water.rows, expected)


@pytest.mark.parametrize(
    "wave",
    [
        RegularWave(0.1, frequency=0.3),
        RegularWave(0.1, period=3.7, direction=1.0),
        RegularWave(0.1, wavelength=17.3),
        PiersonMoskowitzSea(significant_height=0.21),
        PiersonMoskowitzSea(significant_height=0.21, peak_period=4.0),
    ],
)
def test_texts_pickles_and_copies_keep_what_was_given(wave):
    texts = write_plugin_config(Settings(water=Water(waves=wave)))
    (read,) = parse_plugin_config(texts, "here").water.waves
    (expected,) = Water(waves=wave).with_gravity(MOON).waves
    for same in (read, pickle.loads(pickle.dumps(wave)), copy.deepcopy(wave)):
        (taken,) = Water(waves=same).with_gravity(MOON).waves
        assert taken == expected
        assert np.array_equal(taken.rows, expected.rows)


def test_a_water_is_made_anew_for_a_model_of_another_gravity():
    buoyancy = Buoyancy(model_of(), Water(waves=RegularWave(0.1, period=5.0)))
    again = pickle.loads(pickle.dumps(buoyancy))
    assert np.array_equal(again.water.rows, buoyancy.water.rows)
    on_earth = Buoyancy(model_of(9.81), buoyancy.settings)
    assert on_earth.water.rows[0, KX] == pytest.approx((2 * math.pi / 5.0) ** 2 / 9.81)


@pytest.mark.parametrize(("gravity", "flag"), [("0 0 0", "enable"), (MOON, "disable")])
def test_without_gravity_waves_keep_their_own(gravity, flag):
    model = model_of(gravity, flag)
    for stated in (None, MOON):
        wave = RegularWave(0.1, period=5.0, gravity=stated)
        assert np.array_equal(rows_in(model, wave), Water(waves=wave).rows)


def test_gravity_that_is_changed_later_leaves_the_waves_and_changes_the_force():
    model = model_of(9.81)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    buoyancy = Buoyancy(model, Water(waves=RegularWave(0.05, period=5.0)))
    before, rows = buoyancy.evaluate(data).total.force[2], buoyancy.water.rows
    model.opt.gravity[2] = -MOON
    assert buoyancy.evaluate(data).total.force[2] == pytest.approx(before * MOON / 9.81)
    assert buoyancy.water.rows is rows
    assert Buoyancy(model, buoyancy.settings).water.rows[0, KX] > 6.0 * rows[0, KX]


def test_a_gravity_that_is_none_is_refused():
    for value, message in (
        ("moon", "gravity is 'moon'; it must be a finite number"),
        (0.0, "gravity is 0.0; it must be at least 1e-06 and at most 1e+12"),
    ):
        for make in (
            lambda g: RegularWave(0.1, period=2.0, gravity=g),
            lambda g: JonswapSea(significant_height=0.1, peak_period=3.0, gravity=g),
            lambda g: PiersonMoskowitzSea(significant_height=0.1, gravity=g),
        ):
            with pytest.raises(WaterError, match=re.escape(message)):
                make(value)
