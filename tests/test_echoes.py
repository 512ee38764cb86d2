"""Sensors of sound: a DVL over bottoms that lie, slope and move, altimeters, hydrophones."""

import mujoco
import numpy as np
import pytest

from buoyancy_mj import (
    Altimeter,
    Dvl,
    Hydrophone,
    ModelError,
    RegularWave,
    Water,
    add_sensor,
    add_water,
)

SPEED = 1500.0
VEHICLE = """
    <body name="rov" pos="0 0 -3">
      <freejoint/>
      <geom type="box" size="0.3 0.2 0.1" density="1000"/>
      <site name="dvl" pos="0.2 0.1 -0.05"/>
      <body name="skid" pos="0 0 -0.3">
        <joint axis="0 1 0" limited="true" range="-1 1"/>
        <geom type="box" size="0.6 0.6 0.01" density="1000"/>
      </body>
    </body>
"""
FLOOR = '<geom type="plane" size="0 0 1" pos="0 0 -8"/>'


def build(*sensors, world=FLOOR, water=None):
    """A vehicle over a floor, with sensors named after their kinds."""
    mjcf = f'<mujoco><option timestep="0.01"/><worldbody>{world}{VEHICLE}</worldbody></mujoco>'
    spec = mujoco.MjSpec.from_string(mjcf)
    add_water(spec, water or Water())
    for sensor in sensors:
        add_sensor(spec, "dvl", sensor)
    return spec.compile()


def place(model, height=-3.0, turned=(0.95, 0.1, -0.2, 0.15), time=0.0, others=()):
    """Data of the vehicle at a height, turned and in motion, read out."""
    data = mujoco.MjData(model)
    rov = model.body("rov").jntadr[0]
    q, v = model.jnt_qposadr[rov], model.jnt_dofadr[rov]
    data.time = time
    data.qpos[q + 2 : q + 7] = height, *turned
    data.qvel[v : v + 6] = 0.8, -0.5, 0.3, 0.4, -0.6, 0.7
    for name, velocity in others:
        data.qvel[model.joint(name).dofadr[0] :][:6] = velocity
    mujoco.mj_forward(model, data)
    return data


def at_site(data, name="dvl"):
    """Where a site is, how it is turned, and how it moves in the world's axes."""
    site, velocity = data.site(name), np.zeros(6)
    mujoco.mj_objectVelocity(data.model, data, mujoco.mjtObj.mjOBJ_SITE, site.id, velocity, 0)
    return site.xpos.copy(), site.xmat.reshape(3, 3).copy(), velocity[3:]


# the doppler velocity log -----------------------------------------------------------------------


def read_dvl(data):
    """Velocity, lock and ranges."""
    read = data.sensor("dvl").data
    return read[:3], read[3], read[4:]


def find_beams(angle=30.0):
    """Directions of the beams in the site's axes."""
    azimuths = np.radians([45, 135, -135, -45])
    down = np.radians(angle)
    beams = [(np.sin(down) * np.cos(a), np.sin(down) * np.sin(a), -np.cos(down)) for a in azimuths]
    return np.array(beams)


def test_a_dvl_reads_the_true_velocity_over_a_level_floor():
    data = place(build(Dvl()))
    velocity, lock, ranges = read_dvl(data)
    at, rotation, true = at_site(data)
    assert lock == 1
    assert np.allclose(velocity, rotation.T @ true, rtol=0, atol=1e-9)
    beams = find_beams() @ rotation.T
    assert np.allclose(ranges, (-8.0 - at[2]) / beams[:, 2], rtol=0, atol=1e-9)


def test_the_beams_pass_the_whole_vehicle():
    # the skid, 0.25 m under the instrument, is another body of the same vehicle
    _, _, ranges = read_dvl(place(build(Dvl()), turned=(1, 0, 0, 0)))
    assert np.allclose(ranges, (8.0 - 3.0 - 0.05) / np.cos(np.radians(30.0)), rtol=0, atol=1e-9)


def test_over_a_slope_the_velocity_is_as_true():
    slope = '<geom type="plane" size="0 0 1" pos="0 0 -8" euler="-12 20 0"/>'
    data = place(build(Dvl(angle=22.5), world=slope))
    velocity, lock, ranges = read_dvl(data)
    _, rotation, true = at_site(data)
    assert lock == 1
    assert np.ptp(ranges) > 0.5
    assert np.allclose(velocity, rotation.T @ true, rtol=0, atol=1e-9)


ASTERN = '<geom type="box" size="3 6 .1" pos="-2.8 0.1 -6"/>'
AHEAD_TO_STARBOARD = '<geom type="box" size="3 3 .1" pos="3.2 -2.9 -6"/>'


@pytest.mark.parametrize("tables", [ASTERN + AHEAD_TO_STARBOARD, ASTERN])
def test_three_beams_are_enough_and_two_are_not(tables):
    data = place(build(Dvl(), world=tables), turned=(1, 0, 0, 0))
    velocity, lock, ranges = read_dvl(data)
    _, rotation, true = at_site(data)
    enough = tables != ASTERN
    assert (ranges > 0.0).tolist() == [False, True, True, enough]
    assert lock == enough
    expected = rotation.T @ true if enough else [np.nan] * 3
    assert np.allclose(velocity, expected, rtol=0, atol=1e-9, equal_nan=True)


def test_over_a_moving_deck_the_velocity_is_relative_to_it():
    deck = """<body name="deck" pos="0 0 -8"><freejoint name="deck"/>
      <geom type="box" size="30 30 .1" density="1000"/></body>"""
    model = build(Dvl(), world=deck)
    data = place(model, others=[("deck", (1.0, 2.0, -0.5, 0.0, 0.0, 0.0))])
    velocity, lock, _ = read_dvl(data)
    _, rotation, true = at_site(data)
    assert lock == 1
    assert np.allclose(velocity, rotation.T @ (true - [1.0, 2.0, -0.5]), rtol=0, atol=1e-9)


def test_a_bottom_out_of_range_is_lost_and_water_takes_its_place():
    water = Water(current=(0.6, 0.2, 0.0))
    data = place(build(Dvl(max_range=3.0), water=water))
    velocity, lock, ranges = read_dvl(data)
    assert (lock, ranges.tolist()) == (0.0, [-1.0] * 4)
    assert np.isnan(velocity).all()
    data = place(build(Dvl(max_range=3.0, water_lock=2.0), water=water))
    velocity, lock, _ = read_dvl(data)
    _, rotation, true = at_site(data)
    assert lock == 2
    assert np.allclose(velocity, rotation.T @ (true - [0.6, 0.2, 0.0]), rtol=0, atol=1e-9)


def test_a_bottom_too_near_is_lost():
    _, lock, ranges = read_dvl(place(build(Dvl(min_range=20.0, max_range=30.0))))
    assert (lock, ranges.tolist()) == (0.0, [-1.0] * 4)


def test_out_of_the_water_all_beams_are_lost():
    _, lock, ranges = read_dvl(place(build(Dvl(water_lock=1.0)), height=0.5))
    assert (lock, ranges.tolist()) == (0.0, [-1.0] * 4)


def test_beams_that_leave_the_water_are_lost():
    # on its side beside a wall: two beams meet it above the water, two below
    wall = '<geom type="box" size=".1 20 20" pos="-4 0 0"/>'
    turned = np.sqrt([0.5, 0, 0.5, 0])
    data = place(build(Dvl(), world=wall), height=-0.5, turned=turned)
    _, lock, ranges = read_dvl(data)
    assert lock == 0
    assert (ranges > 0.0).sum() == 2
    assert (ranges == -1.0).sum() == 2


def test_noise_of_a_dvl_is_in_velocity_and_ranges_and_not_in_the_lock():
    clean = place(build(Dvl())).sensor("dvl").data.copy()
    model = build(Dvl(noise=0.01, range_noise=0.1, bias=(0.1, 0.0, 0.0)))
    noisy = np.array([place(model, time=0.01 * n).sensor("dvl").data - clean for n in range(200)])
    assert np.allclose(noisy.mean(axis=0)[:3], [0.1, 0, 0], rtol=0, atol=0.004)
    assert np.allclose(noisy.std(axis=0)[:3], 0.01, rtol=0.25)
    assert (noisy[:, 3] == 0.0).all()
    assert np.allclose(noisy.std(axis=0)[4:], 0.1, rtol=0.25)


# the altimeter ----------------------------------------------------------------------------------


def test_an_altimeter_reads_the_range_below_its_site():
    data = place(build(Altimeter()))
    at, rotation, _ = at_site(data)
    down = -rotation[2, 2]
    assert data.sensor("altimeter").data[0] == pytest.approx((-8.0 - at[2]) / down, abs=1e-9)


def test_an_altimeter_out_of_range_or_of_the_water_is_lost():
    for sensor, height in ((Altimeter(max_range=3.0), -3.0), (Altimeter(), 1.0)):
        assert place(build(sensor), height=height).sensor("altimeter").data[0] == -1.0


def test_an_altimeter_that_is_fixed_to_the_world_sees_the_world():
    spec = mujoco.MjSpec.from_string(
        f'<mujoco><worldbody>{FLOOR}<site name="pier" pos="9 0 -1"/>{VEHICLE}</worldbody></mujoco>'
    )
    add_water(spec, Water())
    add_sensor(spec, "pier", Altimeter())
    assert place(spec.compile()).sensor("altimeter").data[0] == pytest.approx(7.0, abs=1e-12)


@pytest.mark.parametrize("height", [-3.0, 3.0])
def test_an_altimeter_may_see_the_surface_of_waves_from_both_sides(height):
    water = Water(waves=RegularWave(0.4, period=2.5))
    turned = (0.2, 0.95, 0.1, 0.15) if height < 0.0 else (0.95, 0.1, -0.2, 0.15)
    data = place(build(Altimeter(surface=True), water=water), height=height, turned=turned)
    at, rotation, _ = at_site(data)
    far = data.sensor("altimeter").data[0]
    end = at - far * rotation[:, 2]
    assert far > 2.0
    assert float(water.depth(end, 0.0)) == pytest.approx(0.0, abs=1e-9)
    between = at - np.linspace(0.0, 0.999 * far, 500)[:, None] * rotation[:, 2]
    assert (np.sign(water.depth(between, 0.0)) == -np.sign(height)).all()


# the hydrophone ---------------------------------------------------------------------------------


BEACON = """<body name="beacon" pos="6 3 -5"><freejoint name="beacon"/>
  <geom size=".1" density="1000"/><site name="beacon"/></body>"""


def test_a_hydrophone_hears_a_pinger_at_rest_where_it_is():
    world = '<site name="pinger" pos="6 3 -5"/>'
    data = place(build(Hydrophone(), world=world))
    at, rotation, _ = at_site(data)
    far, bearing, elevation, travel = data.sensor("hydrophone").data
    x, y, z = rotation.T @ (np.array([6.0, 3.0, -5.0]) - at)
    assert far == pytest.approx(np.linalg.norm([x, y, z]), abs=1e-9)
    assert bearing == pytest.approx(np.arctan2(y, x), abs=1e-9)
    assert elevation == pytest.approx(np.arcsin(z / far), abs=1e-9)
    assert travel == pytest.approx(far / SPEED, abs=1e-12)


def test_a_pinger_that_moves_is_heard_where_it_was():
    velocity = np.array([20.0, -40.0, 5.0])
    model = build(Hydrophone(pinger="beacon", sound_speed=150.0), world=BEACON)
    data = place(model, others=[("beacon", (*velocity, 0, 0, 0))])
    at, rotation, _ = at_site(data)
    far, bearing, elevation, travel = data.sensor("hydrophone").data
    source = np.array([6.0, 3.0, -5.0]) - travel * velocity
    assert np.linalg.norm(source - at) == pytest.approx(150.0 * travel, rel=1e-12)
    way = far * np.array(
        [
            np.cos(elevation) * np.cos(bearing),
            np.cos(elevation) * np.sin(bearing),
            np.sin(elevation),
        ]
    )
    assert np.allclose(at + rotation @ way, source, rtol=0, atol=1e-9)


def test_a_reading_is_held_until_the_next_ping_arrives():
    # 7 m at 100 m/s are 0.07 s: pings leave at 0, 0.2, 0.4 s
    world = '<site name="pinger" pos="7.2 0.1 -3.05"/>'
    model = build(Hydrophone(period=0.2, sound_speed=100.0), world=world)
    data, read = mujoco.MjData(model), []
    model.opt.gravity[:] = 0.0
    data.qvel[0] = 0.1
    for _ in range(60):
        mujoco.mj_step(model, data)
        read.append(data.sensor("hydrophone").data[0])
    changes = np.flatnonzero(np.diff(read)) + 1
    assert read[0] == -1.0
    assert changes.tolist() == [7, 27, 47]
    assert read[7] == pytest.approx(7.0, abs=0.02)


@pytest.mark.parametrize(
    ("height", "world"),
    [(1.0, '<site name="pinger" pos="6 3 -5"/>'), (-3.0, '<site name="pinger" pos="6 3 1"/>')]
    + [(-3.0, FLOOR)],
)
def test_in_the_air_or_without_a_pinger_nothing_is_heard(height, world):
    data = place(build(Hydrophone(), world=world), height=height)
    read = data.sensor("hydrophone").data
    assert np.array_equal(read, [-1.0, np.nan, np.nan, -1.0], equal_nan=True)


def test_range_and_travel_time_have_one_noise_and_the_angles_another():
    world = '<site name="pinger" pos="6 3 -5"/>'
    clean = place(build(Hydrophone(), world=world)).sensor("hydrophone").data.copy()
    model = build(Hydrophone(noise=0.1, angle_noise=0.01), world=world)
    read = np.array([place(model, time=0.01 * n).sensor("hydrophone").data for n in range(200)])
    assert np.allclose(read[:, 0], read[:, 3] * SPEED, rtol=1e-12)
    assert np.allclose((read - clean).std(axis=0)[:3], [0.1, 0.01, 0.01], rtol=0.25)


def test_the_pinger_of_a_sensor_is_that_of_its_own_file_first():
    child = mujoco.MjSpec.from_string(
        f"<mujoco><worldbody>{VEHICLE}<site name='mark' pos='4 0 -3'/></worldbody></mujoco>"
    )
    add_sensor(child, "dvl", Hydrophone(pinger="mark"))
    parent = mujoco.MjSpec()
    parent.worldbody.add_site(name="mark", pos=[0, 0, -50])
    for n in (1, 2):
        parent.attach(
            child.copy(), prefix=f"rov{n}/", frame=parent.worldbody.add_frame(pos=[0, 9 * n, 0])
        )
    add_water(parent, Water())
    model = parent.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    far = np.linalg.norm([3.8, -0.1, 0.05])
    for n in (1, 2):
        assert data.sensor(f"rov{n}/hydrophone").data[0] == pytest.approx(far, abs=1e-9)


def test_without_a_name_any_files_pinger_is_heard():
    world = '<site name="environment/pinger" pos="6 3 -5"/>'
    assert place(build(Hydrophone(), world=world)).sensor("hydrophone").data[0] > 6.0


# bad input --------------------------------------------------------------------------------------


def test_a_pinger_that_is_not_there_is_refused():
    message = "sensor 'hydrophone': pinger: the model has no site named 'beacn'; did you mean 'be"
    with pytest.raises(ValueError, match=message):
        build(Hydrophone(pinger="beacn"), world=BEACON)


@pytest.mark.parametrize(
    ("kind", "values", "message"),
    [
        (Dvl, {"angle": 90}, "angle is 90; it must be at least 1 and at most 80"),
        (Dvl, {"range_noise": -1}, "range_noise is -1; it must be at least 0"),
        (Dvl, {"water_lock": 60}, "water_lock is 60; it must be at most 50, which is max_range"),
        (
            Altimeter,
            {"min_range": 5, "max_range": 2},
            "min_range is 5 and max_range 2; the first must be the smaller",
        ),
        (Hydrophone, {"sound_speed": 0}, "sound_speed is 0; it must be at least 100"),
        (
            Hydrophone,
            {"rate": 2, "period": 1},
            "rate is 2 beside a period of 1 s; a hydrophone reads when a ping arrives, so leave "
            "out rate",
        ),
    ],
)
def test_settings_out_of_range_are_refused(kind, values, message):
    with pytest.raises(ModelError) as caught:
        kind(**values)
    assert str(caught.value) == message
