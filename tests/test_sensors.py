"""Sensors of the water: what they read where they are, in waves, current and air."""

import mujoco
import numpy as np
import pytest
from mujoco import batch, rollout

from buoyancy_mj import (
    Altimeter,
    Depth,
    Dvl,
    Elevation,
    Hydrophone,
    ModelError,
    Pressure,
    RegularWave,
    SpeedThroughWater,
    Water,
    WaterVelocity,
    Wet,
    add_sensor,
    add_water,
    find_streams,
)
from buoyancy_mj.vehicle.sensors.kinds import CHANNELS
from buoyancy_mj.vehicle.sensors.texts import format_sensor, list_keys, parse_sensor

SEA = Water(density=1025.0, level=0.5, waves=RegularWave(0.3, period=4.0), current=(0.4, -0.2, 0.0))
STATE = mujoco.mjtState.mjSTATE_FULLPHYSICS
BUOY = """
<mujoco>
  <option timestep="0.01"/>
  <worldbody>
    <body name="buoy" pos="0.7 -0.3 -1.5">
      <freejoint/>
      <geom type="box" size="0.2 0.15 0.1" density="1000"/>
      <site name="probe" pos="0.1 0.05 -0.1" euler="20 -30 40"/>
    </body>
  </worldbody>
</mujoco>
"""


def build(*sensors, water=SEA, mjcf=BUOY, site="probe"):
    """A model with water and sensors that are named after their kinds."""
    spec = mujoco.MjSpec.from_string(mjcf)
    if water is not None:
        add_water(spec, water)
    for sensor in sensors:
        add_sensor(spec, site, sensor)
    return spec.compile()


def moving(model, time=1.3, position=(0.7, -0.3, -1.5)):
    """Data at a time, turned and in motion, read out."""
    data = mujoco.MjData(model)
    data.time = time
    data.qpos[:3] = position
    data.qpos[3:7] = 0.9, 0.1, -0.3, 0.2
    data.qvel[:] = 0.8, -0.5, 0.3, 0.4, -0.6, 0.7
    mujoco.mj_forward(model, data)
    return data


def at_site(data):
    """Where the probe is, how it is turned, and how it moves in the world's axes."""
    site = data.site("probe")
    velocity = np.zeros(6)
    mujoco.mj_objectVelocity(data.model, data, mujoco.mjtObj.mjOBJ_SITE, 0, velocity, 0)
    return site.xpos.copy(), site.xmat.reshape(3, 3).copy(), velocity[3:]


@pytest.fixture(scope="module")
def all_of_them():
    """Data of a buoy with one of each, read out, under its waves."""
    kinds = (Pressure(), Depth(), Elevation(), WaterVelocity(), SpeedThroughWater(), Wet())
    return moving(build(*kinds))


def test_pressure_is_that_of_the_sea_at_the_place_and_the_instant(all_of_them):
    at, _, _ = at_site(all_of_them)
    assert all_of_them.sensor("pressure").data[0] == pytest.approx(
        float(SEA.pressure(at, 1.3)), rel=1e-12
    )


def test_pressure_on_the_bed_is_that_of_linear_theory():
    # A rho g / cosh k h for A = 1 m, T = 8 s, h = 20 m, sea water: 4612 Pa
    period, depth, amplitude = 8.0, 20.0, 0.01
    mjcf = '<mujoco><worldbody><site name="probe" pos="0 0 -19.999999"/></worldbody></mujoco>'
    wave = RegularWave(amplitude, period=period, depth=depth)
    spec = mujoco.MjSpec.from_string(mjcf)
    body = spec.worldbody.add_body(pos=[0, 0, -1])
    body.add_freejoint()
    body.add_geom(size=[0.1, 0.1, 0.1], density=1000)
    add_water(spec, Water(density=1025.0, waves=wave))
    add_sensor(spec, "probe", Pressure())
    model = spec.compile()
    data, read = mujoco.MjData(model), {}
    for time in (0.0, 0.5 * period):
        data.time = time
        mujoco.mj_forward(model, data)
        read[time] = data.sensor("pressure").data[0]
    swing = 0.5 * (read[0.0] - read[0.5 * period]) / amplitude
    assert swing == pytest.approx(4612.0, rel=1e-4)
    assert sum(read.values()) / 2.0 == pytest.approx(1025.0 * 9.81 * 20.0, rel=1e-5)


def test_depth_and_elevation_know_the_surface_above(all_of_them):
    at, _, _ = at_site(all_of_them)
    surface = float(SEA.elevation(at[0], at[1], 1.3))
    assert all_of_them.sensor("elevation").data[0] == pytest.approx(surface, abs=1e-12)
    assert all_of_them.sensor("depth").data[0] == pytest.approx(surface - at[2], abs=1e-12)


def test_depth_under_the_still_level_knows_no_waves():
    data = moving(build(Depth(still=True)))
    at, _, _ = at_site(data)
    assert data.sensor("depth").data[0] == pytest.approx(SEA.level - at[2], abs=1e-12)


def test_velocity_of_the_water_is_that_of_waves_and_current(all_of_them):
    at, rotation, velocity = at_site(all_of_them)
    water = SEA.velocity(at, 1.3)
    assert np.allclose(all_of_them.sensor("water_velocity").data, water, rtol=0, atol=1e-12)
    through = rotation.T @ (velocity - water)
    assert np.allclose(all_of_them.sensor("speed_through_water").data, through, rtol=0, atol=1e-12)


def test_velocity_of_the_water_may_be_read_along_the_axes_of_the_site():
    data = moving(build(WaterVelocity(frame="site")))
    at, rotation, _ = at_site(data)
    water = rotation.T @ SEA.velocity(at, 1.3)
    assert np.allclose(data.sensor("water_velocity").data, water, rtol=0, atol=1e-12)


def test_in_the_air_there_is_neither_pressure_nor_water():
    kinds = (Pressure(absolute=True), WaterVelocity(), SpeedThroughWater(), Wet(), Depth())
    data = moving(build(*kinds), position=(0.0, 0.0, 5.0))
    assert data.sensor("pressure").data[0] == 101_325.0
    assert (data.sensor("water_velocity").data == 0.0).all()
    assert (data.sensor("speed_through_water").data == 0.0).all()
    assert data.sensor("wet").data[0] == 0.0
    assert data.sensor("depth").data[0] < -4.0


@pytest.mark.parametrize(("depth", "share"), [(-0.2, 0), (-0.05, 5 / 32), (0, 1 / 2), (0.2, 1)])
def test_a_small_ball_is_wet_by_its_share(depth, share):
    mjcf = BUOY.replace('pos="0.1 0.05 -0.1"', 'pos="0 0 0"')
    model = build(Wet(radius=0.1), water=Water(), mjcf=mjcf)
    data = moving(model, position=(0.0, 0.0, -depth))
    assert data.sensor("wet").data[0] == pytest.approx(share, abs=1e-12)


def test_without_water_all_is_dry():
    data = moving(build(Pressure(), Depth(), Wet(), water=None))
    assert data.sensordata.tolist() == [0.0, -np.inf, 0.0]


# noise, bias, rate -----------------------------------------------------------------------------


def run(model, steps, stream=0):
    """What is read in each of some steps."""
    data, read = mujoco.MjData(model), []
    data.plugin_state[find_streams(model)] = stream
    for _ in range(steps):
        mujoco.mj_step(model, data)
        read.append(data.sensordata.copy())
    return np.array(read)


def test_noise_and_bias_are_added_to_what_is_true():
    true = run(build(Depth()), 50)[:, 0]
    model = build(Depth(noise=0.02, bias=0.5, seed=3))
    errors = run(model, 50)[:, 0] - true
    assert errors.mean() == pytest.approx(0.5, abs=0.02)
    assert errors.std() == pytest.approx(0.02, rel=0.5)


def test_each_number_may_have_its_own_noise_and_bias():
    true = run(build(WaterVelocity()), 50)
    errors = run(build(WaterVelocity(noise=(0.1, 0, 0), bias=(0, 2, 0))), 50) - true
    assert errors[:, 0].std() > 0.05
    assert np.allclose(errors[:, 1], 2.0, rtol=0, atol=1e-12)
    assert (errors[:, 2] == 0.0).all()


def test_runs_of_a_seed_repeat_and_those_of_other_seeds_and_streams_differ():
    model = build(Depth(noise=0.02, seed=3))
    one = run(model, 20)
    assert (run(model, 20) == one).all()
    assert (run(model, 20, stream=1) != one).all()
    assert (run(build(Depth(noise=0.02, seed=4)), 20) != one).all()


def test_rollouts_read_what_single_runs_read_bit_for_bit():
    model = build(Pressure(noise=10.0), Depth(noise=0.02, rate=30.0), WaterVelocity(noise=0.1))
    start, data = np.empty(mujoco.mj_stateSize(model, STATE)), mujoco.MjData(model)
    mujoco.mj_getState(model, data, start, STATE)
    read = run(model, 30)
    datas = [mujoco.MjData(model) for _ in range(2)]
    _, rolled = rollout.rollout(model, datas, np.tile(start, (4, 1)), nstep=30)
    assert (rolled == read).all()


def test_a_sample_is_held_until_the_next_is_due():
    read = run(build(Depth(rate=20.0)), 31)[:, 0]
    true = run(build(Depth()), 31)[:, 0]
    assert (read == np.repeat(true[::5], 5)[:31]).all()


def test_samples_fall_on_the_nearest_step():
    # at 0, 30, 70 and 100 ms of steps of 10 ms
    read = run(build(Depth(rate=30.0)), 12)[:, 0]
    true = run(build(Depth()), 12)[:, 0]
    assert (read == true[[0, 0, 0, 3, 3, 3, 3, 7, 7, 7, 10, 10]]).all()


def test_a_pose_that_is_set_is_read_at_once():
    model = build(Depth(rate=1.0, noise=0.01))
    data = moving(model)
    before = data.sensor("depth").data[0]
    data.qpos[2] -= 1.0
    mujoco.mj_forward(model, data)
    assert data.sensor("depth").data[0] == pytest.approx(before + 1.0, abs=1e-12)


def test_reset_data_take_their_first_sample_anew():
    model = build(Depth(rate=1.0))
    data = moving(model, time=0.0, position=(0.0, 0.0, -4.0))
    mujoco.mj_resetData(model, data)
    mujoco.mj_step(model, data)
    assert data.sensor("depth").data[0] == run(model, 1)[0, 0]


# wherever MuJoCo steps --------------------------------------------------------------------------

EVERYTHING = (
    Pressure(absolute=True, noise=20.0, bias=-3.5, seed=7),
    Depth(still=True, rate=40.0),
    Elevation(noise=0.01),
    WaterVelocity(frame="site", noise=(0.1, 0.2, 0.0)),
    SpeedThroughWater(bias=(0.1, 0.0, 0.0)),
    Wet(radius=0.05, rate=10.0),
    Dvl(angle=22.5, water_lock=3.0, noise=0.01, range_noise=0.1, rate=8.0),
    Altimeter(surface=True, min_range=0.1, max_range=30.0),
    Hydrophone(pinger="mark", sound_speed=1480.0, period=0.1, angle_noise=0.01),
)


@pytest.fixture(scope="module")
def everything():
    """The spec of a buoy with one of each, over a floor, and beside a pinger."""
    spec = mujoco.MjSpec.from_string(BUOY)
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[9, 9, 1], pos=[0, 0, -5])
    spec.worldbody.add_site(name="mark", pos=[4, 1, -3])
    add_water(spec, SEA)
    for sensor in EVERYTHING:
        add_sensor(spec, "probe", sensor)
    return spec


def test_saved_mjcf_has_the_sensors_and_their_settings(everything):
    read = run(everything.compile(), 20)
    again = run(mujoco.MjModel.from_xml_string(everything.to_xml()), 20)
    assert np.isfinite(read[-1]).all()
    # but for the digits with which MuJoCo writes poses
    assert np.allclose(again, read, rtol=1e-4, atol=1e-5, equal_nan=True)


def test_batches_read_what_single_runs_read_and_streams_part_them(everything):
    model = everything.compile()
    read = run(model, 15)[-1]
    copies = batch.Batch(model, 4, nthread=2)
    copies.bind("plugin_state")[3, find_streams(model)] = 5.0
    batched = copies.bind("sensordata")
    copies.step(nstep=15)
    assert (batched[:3] == read).all()
    assert (batched[3] != read).sum() > 8
    assert (batched[3] == run(model, 15, stream=5)[-1]).all()


def test_each_sensor_has_as_many_numbers_as_channels(everything):
    model = everything.compile()
    for sensor in EVERYTHING:
        name = sensor.KIND.plugin.partition(".")[2]
        assert model.sensor(name).dim == len(CHANNELS[sensor.KIND.plugin])


def test_settings_become_texts_and_settings_again():
    for sensor in (*EVERYTHING, *[type(sensor)() for sensor in EVERYTHING]):
        texts = {key: format_sensor(sensor).get(key, "") for key in list_keys(type(sensor))}
        assert parse_sensor(type(sensor), texts, "sensor") == sensor


# bad input -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("kind", "values", "message"),
    [
        (Depth, {"noise": -0.1}, "noise is -0.1; it must be at least 0"),
        (Depth, {"noise": (0.1, 0.2)}, "noise is (0.1, 0.2); it must be one number"),
        (WaterVelocity, {"bias": (1, 2)}, "bias is (1, 2); it must be one number or 3"),
        (Depth, {"rate": -1}, "rate is -1; it must be at least 0"),
        (Depth, {"seed": -1}, "seed is -1; it must be a whole number from 0 to 2147483647"),
        (Depth, {"still": "no"}, "still is 'no'; it must be true or false"),
        (Wet, {"radius": -1}, "radius is -1; it must be at least 0"),
        (
            WaterVelocity,
            {"frame": "sight"},
            "frame is 'sight'; did you mean 'site'? possible: site, world",
        ),
    ],
)
def test_settings_out_of_range_are_refused(kind, values, message):
    with pytest.raises(ModelError) as caught:
        kind(**values)
    assert str(caught.value) == message


def test_a_sensor_needs_a_site_that_is_there_and_a_name_of_its_own():
    spec = mujoco.MjSpec.from_string(BUOY)
    with pytest.raises(ModelError, match="no site 'prob' for a sensor; did you mean 'probe'"):
        add_sensor(spec, "prob", Depth())
    add_sensor(spec, "probe", Depth())
    with pytest.raises(ModelError, match="already has a sensor 'depth'; give this one another"):
        add_sensor(spec, "probe", Depth())
    with pytest.raises(ModelError, match="sensor is 'depth'; it must be one of Altimeter, Depth"):
        add_sensor(spec, "probe", "depth")
    with pytest.raises(ModelError, match=r"spec is .*; it must be an MjSpec"):
        add_sensor("buoy.xml", "probe", Depth())


PLUGIN = """
<mujoco>
  <extension><plugin plugin="buoyancy_mj.depth"/></extension>
  <worldbody><body name="b"><freejoint/><geom size=".1"/><site name="s"/></body></worldbody>
  <sensor><plugin name="d" plugin="buoyancy_mj.depth" {}</plugin></sensor>
</mujoco>
"""


@pytest.mark.parametrize(
    ("rest", "message"),
    [
        ('objtype="body" objname="b">', "sensor 'd' is at a body; buoyancy_mj.depth reads at a si"),
        (
            'objtype="site" objname="s" reftype="site" refname="s">',
            "sensor 'd' has a reftype and a refname, which buoyancy_mj.depth does not read; remove",
        ),
        ('objtype="site" objname="s" noise="1">', "unrecognized attribute: 'noise'"),
        (
            'objtype="site" objname="s"><config key="noise" value="-1"/>',
            "sensor 'd': noise is -1.0; it must be at least 0",
        ),
        (
            'objtype="site" objname="s"><config key="rate" value="often"/>',
            "sensor 'd': rate is 'often'; needed is a number",
        ),
        (
            'objtype="site" objname="s"><config key="noises" value="1"/>',
            "unrecognized attribute 'plugin:noises'",
        ),
    ],
)
def test_mjcf_that_makes_no_sense_is_a_compile_error(rest, message):
    with pytest.raises(ValueError, match=r"sensor|attribute") as caught:
        mujoco.MjModel.from_xml_string(PLUGIN.format(rest))
    assert message in str(caught.value)


def test_two_sensors_that_share_an_instance_are_refused():
    mjcf = PLUGIN.format(
        'instance="i" objtype="site" objname="s"></plugin><plugin name="e" '
        'plugin="buoyancy_mj.depth" instance="i" objtype="site" objname="s">'
    ).replace('"buoyancy_mj.depth"/>', '"buoyancy_mj.depth"><instance name="i"/></plugin>')
    message = "instance 'i' of buoyancy_mj.depth has 2 sensors: d, e; give each sensor one of its"
    with pytest.raises(ValueError, match=message):
        mujoco.MjModel.from_xml_string(mjcf)
