"""Controllers: stations kept in waves, poles as computed, schedules, programs, and their errors."""

import csv
import dataclasses
import json
import math
import re
import sys

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner

from buoyancy_mj import (
    ControlError,
    ControlSensors,
    Hold,
    Keyframes,
    Lqr,
    Program,
    RegularWave,
    SceneError,
    Simulation,
    Tank,
    Water,
    Waypoint,
    add_ballast,
    add_water,
    read_scene,
    start_controller,
)
from buoyancy_mj.cli import app
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.scene import scene_from_table
from buoyancy_mj.scenes.sweep import Sweep
from buoyancy_mj.vehicle.control.controller import Outset, copy_data
from buoyancy_mj.vehicle.control.course import Course
from buoyancy_mj.vehicle.control.gains import find_apparent_masses
from buoyancy_mj.vehicle.control.keyframes import read_schedule
from buoyancy_mj.vehicle.control.motion import Motion
from buoyancy_mj.vehicle.crafts import find_craft
from tests import naive

WAVES = {"waves": [{"amplitude": 0.1, "period": 3.0, "direction": 0.6}]}
BOX = """<mujoco><compiler autolimits="true"/><option timestep="0.01" integrator="implicitfast"/>
<worldbody><body name="rov"><freejoint/>
<geom name="hull" type="box" size=".3 .2 .1" mass="{mass}"/>{sites}
<site name="nose" pos=".3 0 .05" euler="0 0 40"/></body></worldbody>
<actuator>{motors}</actuator>
<sensor><framequat name="attitude" objtype="site" objname="nose"/><gyro name="gyro" site="nose"/>
<framepos name="place" objtype="site" objname="nose"/><velocimeter name="log" site="nose"/>
<framelinvel name="way" objtype="site" objname="nose"/><accelerometer name="shake" site="nose"/>
<framepos name="hull" objtype="body" objname="rov"/></sensor></mujoco>"""
PLACES = {
    "ahead_port": (".0 .2 0", "1 0 0"),
    "ahead_starboard": ("0 -.2 0", "1 0 0"),
    "side_front": (".2 0 0", "0 1 0"),
    "side_back": ("-.2 0 0", "0 1 0"),
    "up_port": ("0 .2 0", "0 0 1"),
    "up_starboard": ("0 -.2 0", "0 0 1"),
    "up_front": (".3 0 0", "0 0 1"),
}
"""Seven motors that push along every axis: places, and directions of thrust."""


def box(names=tuple(PLACES), limit=20.0, water=None, mass=48.5):
    """A box under its motors in fresh water, 0.5 kg too heavy."""
    sites = [f'<site name="{n}" pos="{PLACES[n][0]}" zaxis="{PLACES[n][1]}"/>' for n in names]
    motors = [
        f'<motor name="{n}" site="{n}" gear="0 0 1 0 0 0" ctrlrange="{-limit} {limit}"/>'
        for n in names
    ]
    xml = BOX.format(mass=mass, sites="".join(sites), motors="".join(motors))
    spec = mujoco.MjSpec.from_string(xml)
    add_water(spec, Water() if water is None else water, added_mass="ellipsoid")
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qpos[2] = -1.0
    return model, data


def steer(update, model, data, duration, every=2):
    """Step with a controller at work; the poses (n, 7)."""
    poses = []
    for step in range(round(duration / model.opt.timestep)):
        if step % every == 0:
            update(model, data)
        mujoco.mj_step(model, data)
        poses.append(data.qpos[:7].copy())
    return np.array(poses)


def controlled(control, *, vehicle="bluerov2_heavy", trust=False, folder=None, **table):
    one = {"vehicle": vehicle, "start": {"position": [0.0, 0.0, -1.0]}}
    given = {} if "vehicles" in table else one
    table = {"title": "steered", "control": control} | given | table
    folder = {} if folder is None else {"folder": folder}
    return Simulation(scene_from_table(table, **folder), trust=trust)


def run_out(simulation):
    """Step to the end; the poses (n, 7)."""
    poses = []
    for _ in range(simulation.steps):
        simulation.step()
        poses.append(simulation.data.qpos[:7].copy())
    return np.array(poses)


def angles(poses):
    """Roll, pitch and yaw (n, 3) [rad]."""
    return Rotation.from_quat(poses[:, 3:7], scalar_first=True).as_euler("ZYX")[:, ::-1]


# hold ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("vehicle", ["bluerov2_heavy", "sauvc_auv"])
def test_a_station_is_kept_within_5_cm_and_3_degrees_in_waves_of_10_cm(vehicle):
    more = {"water": WAVES, "pressure": "froude-krylov", "added_mass": "ellipsoid"}
    simulation = controlled({"kind": "hold"}, vehicle=vehicle, duration=16.0, **more)
    late = run_out(simulation)[600:]
    assert np.linalg.norm(late[:, :3] - [0.0, 0.0, -1.0], axis=1).max() < 0.05
    assert np.degrees(np.abs(angles(late)).max()) < 3.0
    # the waves do pull: without the thrusters it goes round by as much as the water
    adrift = run_out(controlled([], vehicle=vehicle, duration=3.5, **more))
    assert np.ptp(adrift[:, 0]) > 0.1


def test_the_integral_takes_up_a_net_weight_and_a_current():
    model, data = box(water=Water(current=(0.3, -0.1, 0.0)))
    update = start_controller(Hold(), model, data)
    poses = steer(update, model, data, 25.0)
    np.testing.assert_allclose(poses[-1, :3], [0.0, 0.0, -1.0], atol=2e-3)
    np.testing.assert_allclose(angles(poses[-1:]), 0.0, atol=2e-3)
    # the thrusters carry the half kilogram, less what the current lifts, which is nothing
    wrench = update.allocation.matrix @ data.ctrl
    assert wrench[2] == pytest.approx(0.5 * 9.81, rel=0.02)
    assert wrench[0] < -1.0
    assert wrench[1] > 0.1


def test_a_small_push_dies_out_as_a_critically_damped_spring_of_the_bandwidth():
    model, data = box()
    hold = Hold(bandwidth=2.0, position_gains=None, heading=0.0, speed=1e3, turn_rate=1e3)
    update = start_controller(hold, model, data)
    update._gains.integral[:] = 0.0
    update._force[:] = [0.0, 0.0, 0.5 * 9.81]
    data.qpos[0] = 0.01
    poses = steer(update, model, data, 2.0, every=1)
    time = 0.01 * np.arange(1, 201)
    wanted = 0.01 * (1.0 + 2.0 * time) * np.exp(-2.0 * time)
    np.testing.assert_allclose(poses[:, 0], wanted, atol=2e-4)


def test_the_apparent_masses_are_those_by_which_thrust_accelerates():
    model, data = box()
    data.qpos[3:7] = Rotation.from_euler("ZYX", [0.7, 0.2, -0.4]).as_quat(scalar_first=True)
    update = start_controller(Hold(), model, data)
    outset = _outset(model, data)
    masses = find_apparent_masses(outset)
    assert masses[0] > 49.0
    turn = outset.data.xmat[1].reshape(3, 3)
    rest = outset.data.qacc.copy()
    for i in range(3):
        outset.data.qfrc_applied[:3] = turn[:, i]
        mujoco.mj_forward(model, outset.data)
        pushed = turn.T @ (outset.data.qacc - rest)[:3]
        # the box is symmetric, so that no axis drags another along
        assert pushed[i] == pytest.approx(1.0 / masses[i], rel=1e-9)
    assert update._gains.proportional[0] == pytest.approx(2.5**2 * masses[0])


def _outset(model, data):
    return Outset(model, copy_data(model, data), find_craft(model))


def test_a_hold_at_its_limits_does_not_wind_up():
    overshoots = []
    for unwinds in (True, False):
        model, data = box(limit=8.0)
        update = start_controller(Hold(position=(0.0, 0.0), speed=1e3), model, data)
        if not unwinds:
            update._unwinding = 0.0
        data.xfrc_applied[1, 0] = -30.0
        steer(update, model, data, 4.0)
        assert data.qpos[0] < -1.0
        data.xfrc_applied[1, 0] = 0.0
        overshoots.append(steer(update, model, data, 12.0)[:, 0].max())
    assert overshoots[0] < 0.3
    assert overshoots[1] > 3.0 * overshoots[0]


def test_what_is_free_is_left_alone():
    model, data = box()
    update = start_controller(Hold(depth=1.2, free=("position", "heading")), model, data)
    data.qvel[[0, 5]] = 0.05, 0.3
    poses = steer(update, model, data, 15.0)
    assert poses[-1, 2] == pytest.approx(-1.2, abs=5e-3)
    # it drifts on and turns on, slowed by drag alone
    assert poses[-1, 0] > 0.2
    assert abs(angles(poses[-1:])[0, 2]) > 0.5
    np.testing.assert_allclose(update.allocation.matrix[[0, 1, 5]] @ data.ctrl, 0.0, atol=0.05)


def test_waypoints_are_passed_one_after_the_other_and_the_last_is_held():
    model, data = box()
    points = (
        Waypoint(position=(1.5, 0.0), depth=1.2, heading=0.0, radius=0.2, stay=2.0),
        Waypoint(position=(1.5, 1.0), heading=math.pi, radius=0.3),
        Waypoint(position=(0.0, 1.0), radius=0.1),
    )
    update = start_controller(Hold(waypoints=points, speed=0.4), model, data)
    poses, passed = [], []
    for step in range(2500):
        if step % 2 == 0:
            update(model, data)
        mujoco.mj_step(model, data)
        poses.append(data.qpos[:7].copy())
        passed.append(update.course.passed)
    poses, passed = np.array(poses), np.array(passed)
    # within the radius of each when it is passed, and in it for two seconds at the first
    starts = [int(np.argmax(passed == number)) for number in (1, 2, 3)]
    for start, point in zip(starts, points, strict=True):
        away = poses[start, :2] - point.position
        assert np.linalg.norm(away) < point.radius
    away = np.linalg.norm(poses[starts[0] - 195 : starts[0], :2] - points[0].position, axis=1)
    assert away.max() < 0.2
    assert passed[-1] == 3
    np.testing.assert_allclose(poses[-1, :3], [0.0, 1.0, -1.2], atol=0.02)
    assert abs(angles(poses[-1:])[0, 2]) == pytest.approx(math.pi, abs=0.02)
    # no faster than it was told to
    speeds = np.linalg.norm(np.diff(poses[:, :3], axis=0), axis=1) / 0.01
    assert speeds.max() < 0.6


def at(x, y=0.0, z=-1.0, heading=0.0):
    turn = Rotation.from_euler("z", heading).as_matrix()
    return Motion(np.array([x, y, z]), turn, np.zeros(3), np.zeros(3))


def test_the_reference_goes_straight_at_its_speed_turns_the_short_way_and_waits():
    course = Course(
        [Waypoint(position=(3.0, 4.0), heading=-3.0)],
        np.array([0.0, 0.0, -1.0]),
        3.0,
        level=0.0,
        speed=0.5,
        turn_rate=0.1,
    )
    first = course.advance(at(0.0, heading=3.0), 0.1, 0.1)
    np.testing.assert_allclose(first.position, [0.03, 0.04, -1.0])
    np.testing.assert_allclose(first.velocity, [0.3, 0.4, 0.0])
    # over pi, not back through 0
    assert (first.heading, first.turning) == pytest.approx((3.01, 0.1))
    for step in range(2, 200):
        last = course.advance(at(0.0, heading=3.0), 0.1 * step, 0.1)
    # a metre ahead of a vehicle that does not follow
    assert np.linalg.norm(last.position - first.position) < 1.05
    assert not last.velocity.any()


def test_a_hold_begins_anew_where_data_are_reset():
    model, data = box()
    update = start_controller(Hold(depth=1.1), model, data)
    ends = []
    for _ in range(2):
        mujoco.mj_resetData(model, data)
        data.qpos[2] = -1.0
        ends.append(steer(update, model, data, 2.0))
    np.testing.assert_array_equal(ends[0], ends[1])


def test_a_hold_by_sensors_is_one_by_the_state():
    ends = []
    names = ControlSensors(attitude="attitude", gyro="gyro", position="place", velocity="log")
    world = ControlSensors(attitude="attitude", gyro="gyro", depth="place", velocity="way")
    for sensors in (None, names, world):
        model, data = box()
        data.qpos[3:7] = Rotation.from_euler("ZYX", [0.3, 0.1, 0.1]).as_quat(scalar_first=True)
        mujoco.mj_forward(model, data)
        hold = Hold(position=(0.2, 0.1), depth=1.1, heading=0.0, sensors=sensors)
        poses = steer(start_controller(hold, model, data), model, data, 8.0)
        ends.append(poses[::50])
    # sensors are a step old
    np.testing.assert_allclose(ends[1], ends[0], atol=0.02)
    np.testing.assert_allclose(ends[2], ends[0], atol=0.02)
    assert not np.array_equal(ends[1], ends[0])


def test_an_echo_that_is_lost_leaves_the_last_one():
    model, data = box()
    mujoco.mj_forward(model, data)
    update = start_controller(Hold(sensors=ControlSensors(depth="place")), model, data)
    update(model, data)
    known = update._reader.read(data).position[2]
    data.sensordata[:] = np.nan
    assert update._reader.read(data).position[2] == known


@pytest.mark.parametrize(
    ("sensors", "message"),
    [
        ({"gyro": "gyros"}, "there is no sensor 'gyros'; did you mean 'gyro'?"),
        ({"gyro": "attitude"}, "sensor 'attitude' is framequat; needed for the gyro is gyro"),
        (
            {"velocity": "shake"},
            "sensor 'shake' is accelerometer; needed for the velocity is velocimeter or "
            "buoyancy_mj.dvl or framelinvel",
        ),
        (
            {"depth": "hull"},
            "sensor 'hull' is at no site of body 'rov'; put it at one, so that the controller "
            "knows where it is",
        ),
    ],
)
def test_a_sensor_that_does_not_fit_is_refused(sensors, message):
    with pytest.raises(ControlError, match=re.escape(message)):
        start_controller(Hold(sensors=ControlSensors(**sensors)), *box())


def test_what_the_thrusters_cannot_hold_must_be_free():
    names = [name for name in PLACES if name != "up_front"]
    model, data = box(names)
    message = (
        "the thrusters of 'rov' do not push along pitch alone in both directions, which a hold "
        "needs; give it free = ['pitch']"
    )
    with pytest.raises(ControlError) as caught:
        start_controller(Hold(), model, data)
    assert str(caught.value) == message
    update = start_controller(Hold(depth=1.1, free=("pitch",)), model, data)
    poses = steer(update, model, data, 15.0)
    np.testing.assert_allclose(poses[-1, :3], [0.0, 0.0, -1.1], atol=5e-3)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"rate": 0.0}, "rate is 0.0; it must be above 0"),
        ({"depth": math.nan}, "depth is nan; it must be a finite number"),
        (
            {"free": ("deep",)},
            "free holds 'deep'; did you mean 'depth'? possible: depth, heading, pitch, "
            "position, roll",
        ),
        ({"roll_gains": (1.0, -1.0, 0.0)}, "roll_gains holds -1; gains must not be negative"),
        (
            {"depth": 1.0, "waypoints": (Waypoint(position=(0.0, 0.0)),)},
            "depth is given beside waypoints; give it to the way-points, or leave one of the two "
            "out",
        ),
        (
            {"free": ("position",), "waypoints": (Waypoint(position=(0.0, 0.0)),)},
            "free holds 'position', and waypoints ask for it; leave one out",
        ),
        (
            {"waypoints": ((0.0, 0.0),)},
            "waypoints hold (0.0, 0.0); each must be a Waypoint, as Waypoint(position=(1.0, 0.0))",
        ),
    ],
)
def test_a_hold_that_makes_no_sense_is_refused(values, message):
    with pytest.raises(ControlError) as caught:
        Hold(**values)
    assert str(caught.value) == message


# lqr ----------------------------------------------------------------------------------------------


def test_ballast_is_no_thruster_and_a_rest_carries_what_it_holds():
    sites = [f'<site name="{n}" pos="{p}" zaxis="{z}"/>' for n, (p, z) in PLACES.items()]
    tank = '<geom name="tank" type="box" size=".1 .1 .05" mass="0" contype="0" conaffinity="0"/>'
    motors = [f'<motor name="{n}" site="{n}" gear="0 0 1 0 0 0"/>' for n in PLACES]
    xml = BOX.format(mass=46.0, sites="".join([*sites, tank]), motors="".join(motors))
    spec = mujoco.MjSpec.from_string(xml)
    add_ballast(spec, "tank", Tank(rate=1e-4))
    add_water(spec, added_mass="ellipsoid")
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qpos[2] = -1.0
    data.act[0] = data.ctrl[-1] = 1.5e-3
    update = start_controller(Lqr(), model, data)
    assert update.allocation.names == tuple(PLACES)
    # 48 kg of water are displaced, and 47.5 kg carried
    assert (update.allocation.matrix @ update.motion.thrusts)[2] == pytest.approx(-0.5 * 9.81)


def test_the_derivatives_of_the_engine_have_the_water_and_its_added_mass_in_them():
    model, data = box()
    update = start_controller(Lqr(), model, data)
    data.qpos[:] = update.motion.qpos
    update.allocation.write(data, update.motion.thrusts)
    a, b = naive.differentiate_step(model, data)
    np.testing.assert_allclose(update.motion.a, a, atol=1e-7)
    # the controls of motors are thrusts
    np.testing.assert_allclose(update.motion.b, b, atol=1e-9)
    # surge: h over the mass with what the water adds
    mass = find_apparent_masses(_outset(model, data))[0]
    assert mass > 49.0
    assert update.motion.b[6, 0] == pytest.approx(0.01 / mass, rel=1e-3)
    assert update.allocation.matrix[2] @ update.motion.thrusts == pytest.approx(0.5 * 9.81)


@pytest.mark.parametrize(
    ("vehicle", "free"), [("bluerov2_heavy", []), ("sauvc_auv", ["position", "heading"])]
)
def test_small_motions_of_a_run_have_the_poles_that_were_computed(vehicle, free):
    control = {"kind": "lqr", "rate": 25.0, "free": free}
    simulation = controlled(control, vehicle=vehicle, added_mass="ellipsoid")
    update = simulation.controllers[vehicle]
    model, data = simulation.model, simulation.data

    assert len(update.poles) == (9 if free else 12) + (model.nu if model.na else 0)

    # what the state is from one update to the next, over runs from small errors of all kinds
    before, after = [], []
    rng = np.random.default_rng(3)
    for _ in range(4):
        mujoco.mj_resetData(model, data)
        data.qpos[:] = update.motion.qpos
        mujoco.mj_integratePos(model, data.qpos, 1e-4 * rng.normal(size=6), 1)
        data.qvel[:] = 1e-4 * rng.normal(size=6)
        if model.na:
            # the first state of each thruster follows its control
            thrusts = update.motion.thrusts + 1e-3 * rng.normal(size=model.nu)
            data.act[model.actuator_actadr] = thrusts
        for _ in range(30):
            before.append(update.measure(model, data))
            for _ in range(4):
                simulation.step()
            after.append(update.measure(model, data))
    found = np.linalg.lstsq(np.array(before), np.array(after), rcond=None)[0]
    poles = np.linalg.eigvals(found)
    assert len(poles) == len(update.poles)
    assert np.abs(update.poles).max() < 0.99
    for pole in update.poles:
        # the torque of small propellers is not quite in proportion to their thrust
        assert np.abs(poles - pole).min() < (3e-3 if model.na else 1e-3)


def test_a_vehicle_whose_place_and_heading_are_free_comes_to_rest_wherever_it_looks():
    ends = []
    for heading in (0.0, 2.5):
        model, data = box()
        update = start_controller(Lqr(free=("position", "heading")), model, data)
        turn = Rotation.from_euler("z", heading)
        data.qpos[:3] = 5.0, -3.0, -1.3
        leaning = turn * Rotation.from_euler("y", 0.2)
        data.qpos[3:7] = leaning.as_quat(scalar_first=True)
        data.qvel[:3] = turn.apply([0.2, 0.1, 0.0])
        poses = steer(update, model, data, 12.0)
        assert poses[-1, 2] == pytest.approx(-1.0, abs=1e-3)
        ends.append(turn.inv().apply(poses[::100, :3] - [5.0, -3.0, 0.0]))
    # seen from the vehicle both are one motion
    np.testing.assert_allclose(ends[1], ends[0], atol=1e-6)


def test_an_lqr_brings_a_vehicle_to_its_place():
    model, data = box()
    lqr = Lqr(position=(0.3, -0.2), depth=1.2, heading=0.5)
    poses = steer(start_controller(lqr, model, data), model, data, 12.0)
    np.testing.assert_allclose(poses[-1, :3], [0.3, -0.2, -1.2], atol=2e-3)
    np.testing.assert_allclose(angles(poses[-1:]), [[0.0, 0.0, 0.5]], atol=2e-3)


def test_a_motion_that_no_thruster_reaches_is_named():
    names = [name for name in PLACES if not name.startswith("side")]
    # one that is heavier or lighter than water goes aside by leaning
    model, data = box(names, mass=48.0)
    with pytest.raises(ControlError) as caught:
        start_controller(Lqr(), model, data)
    assert str(caught.value) == (
        "the thrusters of 'rov' do not reach its y, which does not come to rest by itself; leave "
        "it free where that is possible, or add a thruster"
    )
    # a place that may be anywhere needs no thruster
    update = start_controller(Lqr(free=("position",)), model, data)
    assert np.abs(update.poles).max() < 1.0


def test_an_lqr_without_a_rest_is_refused():
    model, data = box(limit=1.0)
    with pytest.raises(ControlError, match="cannot hold it where it starts: 'up_port' would have"):
        start_controller(Lqr(), model, data)
    model, data = box(["ahead_port", "ahead_starboard", "side_front"])
    with pytest.raises(ControlError, match=r"cannot hold it where it starts: a force or torque of"):
        start_controller(Lqr(), model, data)
    # where it floats, depth and attitude are held by the water
    model, data = box()
    model.body_mass[1] = 20.0
    data.qpos[2] = 0.1 - 20.0 / (1000.0 * 0.6 * 0.4)
    with pytest.raises(ControlError, match="free holds 'depth', and the motion depends on it"):
        start_controller(Lqr(free=("depth",)), model, data)


def test_an_lqr_is_refused_what_it_cannot_do():
    model, data = box()
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    with pytest.raises(ControlError, match="the integrator is rk4, which MuJoCo does not differen"):
        start_controller(Lqr(), model, data)
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_EULER
    with pytest.raises(ControlError, match=r"rate is 200 Hz, and a timestep of 0.01 s has 100 Hz"):
        start_controller(Lqr(rate=200.0), model, data)
    with pytest.raises(ControlError, match="no feedback was found: a weight of 0 lets a motion"):
        start_controller(Lqr(position_weights=(0.0, 1.0, 1.0)), model, data)
    with pytest.raises(ControlError, match="free holds 'depth', which is given"):
        Lqr(depth=1.0, free=("depth",))
    with pytest.raises(ControlError, match="spin_weights holds -1; weights must not be negative"):
        Lqr(spin_weights=(-1.0, 0.0, 0.0))
    with pytest.raises(ControlError, match="control is 'lqr'; it must be a Hold, Lqr, Keyframes"):
        start_controller("lqr", model, data)


# keyframes ----------------------------------------------------------------------------------------

TABLE = "time, up_port, ahead_port\n0.05, 1, -2\n0.1, 3, -4\n\n0.2, 5, 8\n"


def test_a_schedule_is_held_or_goes_on_linearly(tmp_path):
    path = tmp_path / "table.csv"
    path.write_text(TABLE, encoding="utf-8-sig")
    model, data = box()
    up, ahead = model.actuator("up_port").id, model.actuator("ahead_port").id
    held, linear = (
        start_controller(Keyframes(file=str(path), between=between), model, data)
        for between in ("hold", "linear")
    )
    data.ctrl[:] = 7.0
    for time, steps, line in (
        (0.04, [7, 7], [7, 7]),
        (0.05, [1, -2], [1, -2]),
        (0.075, [1, -2], [2, -3]),
        (0.1 - 1e-12, [3, -4], [3, -4]),
        (0.15, [3, -4], [4, 2]),
        (9.0, [5, 8], [5, 8]),
    ):
        data.time = time
        for update, wanted in ((held, steps), (linear, line)):
            update(model, data)
            np.testing.assert_allclose(data.ctrl[[up, ahead]], wanted, atol=1e-6)
    # others stay as they are
    others = [i for i in range(model.nu) if i not in (up, ahead)]
    assert (data.ctrl[others] == 7.0).all()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "the schedule '{}' holds no controls; needed are a line of names"),
        ("time,up\n", "the schedule '{}' holds no controls"),
        ("t,up\n0,1\n", "the first line of '{}' names no column 'time'; it has t, up"),
        ("time\n0\n", "'{}' has no column but 'time'; add one for each actuator"),
        ("time,,up\n0,1,2\n", "the first line of '{}' has no name in column 2"),
        ("time,up,up\n0,1,2\n", "'{}' has two columns 'up'; leave one out"),
        (
            "time,up\n0,1\n\n1\n",
            "line 4 of '{}' has 1 values, and the first line names 2 columns; give each a value",
        ),
        (
            "time,up\n0,1\n1,\n",
            "line 3 of '{}', column 'up', is empty; needed is a finite number",
        ),
        ("time,up\n0,nan\n", "line 2 of '{}', column 'up', is 'nan'; needed is a finite number"),
        ("time,up\nx,1\n", "line 2 of '{}', column 'time', is 'x'; needed is a finite number"),
        (
            "time,up\n0,1\n2,1\n2,3\n",
            "line 4 of '{}' has the time 2 s after 2 s; times must rise from line to line",
        ),
        ('time,up\n0,"1\n', "the schedule '{}' cannot be read: unexpected end of data"),
    ],
)
def test_a_table_that_is_no_schedule_is_refused(text, message, tmp_path):
    path = tmp_path / "table.csv"
    path.write_text(text)
    with pytest.raises(ControlError, match=re.escape(message.format(path))):
        read_schedule(path)


def test_a_schedule_of_another_vehicle_is_refused(tmp_path):
    path = tmp_path / "table.csv"
    path.write_text("time,ahead_prot\n0,1\n")
    with pytest.raises(ControlError) as caught:
        start_controller(Keyframes(file=str(path)), *box())
    assert str(caught.value).startswith(
        f"'{path}' has a column 'ahead_prot' (the 2nd), and the vehicle has no such actuator; did "
        "you mean 'ahead_port'? possible: ahead_port,"
    )
    with pytest.raises(ControlError, match=r"the schedule '.*' cannot be read: .*No such file"):
        start_controller(Keyframes(file=str(tmp_path / "none.csv")), *box())
    with pytest.raises(ControlError, match=r"between is 'lines'; .*possible: hold, linear"):
        Keyframes(file="x.csv", between="lines")


def test_each_vehicle_of_a_scene_has_a_controller_of_its_own(tmp_path):
    (tmp_path / "table.csv").write_text("time,horizontal_front_port\n0,5\n")
    simulation = controlled(
        [
            {"kind": "keyframes", "file": "table.csv", "vehicle": "second"},
            {"kind": "hold", "vehicle": "first", "position": [0.0, 0.0], "rate": 25.0},
        ],
        folder=tmp_path,
        vehicles=[
            {"model": "bluerov2_heavy", "name": name, "start": {"position": [0.0, y, -1.0]}}
            for name, y in (("first", 0.0), ("second", 2.0))
        ],
    )
    simulation.step()
    model = simulation.model
    address = model.actuator("second/horizontal_front_port").id
    assert simulation.data.ctrl[address] == 5.0
    held = simulation.data.ctrl[: model.nu // 2].copy()
    # four steps to an update of the hold
    for steps, changed in ((3, False), (1, True)):
        for _ in range(steps):
            simulation.step()
        assert np.array_equal(simulation.data.ctrl[: model.nu // 2], held) != changed
    values = simulation.summary().values()
    assert values["first.updates_at_limits"] == 0
    assert simulation.summary().rows()[0][0] == "mass"
    assert ("controls at their limits", "0 updates", "0 updates") in simulation.summary().rows()


# programs -----------------------------------------------------------------------------------------

CODE = """
from __future__ import annotations
import dataclasses
import math


@dataclasses.dataclass
class Tuning:
    gain: float = 8.0


gain = Tuning().gain


def update(model, data):
    data.ctrl[:4] = gain * (-1.0 - data.qpos[2]) - 20.0 * data.qvel[2]


def broken(model, data):
    if data.time > 0.15:
        raise ValueError("no fix\\nfrom the beacon")


def lost(model, data):
    data.ctrl[2] = math.nan if data.time > 0.15 else 0.0
"""


@pytest.fixture
def code(tmp_path):
    (tmp_path / "mine.py").write_text(CODE)
    return tmp_path


def test_a_program_runs_at_its_rate_for_who_trusts_it(code):
    control = {"kind": "file", "file": "mine.py:update", "rate": 10.0}
    with pytest.raises(SceneError) as caught:
        controlled(control, folder=code)
    assert str(caught.value) == (
        "the scene runs the code of 'mine.py:update'; read it, and give --trust (in Python "
        "trust=True) if you trust it"
    )
    simulation = controlled(control, folder=code, trust=True, start={"position": [0, 0, -1.2]})
    seen = []
    for _ in range(30):
        simulation.step()
        seen.append(float(simulation.data.ctrl[0]))
    assert seen[0] == pytest.approx(8.0 * 0.2)
    assert [i for i in range(1, 30) if seen[i] != seen[i - 1]] == [10, 20]


def test_a_program_imports_files_beside_it(code):
    (code / "tuning_beside_it.py").write_text("gain = 3.0\n")
    (code / "main.py").write_text(
        "from tuning_beside_it import gain\n\n\ndef update(_, data):\n    data.ctrl[:] = gain\n"
    )
    before = list(sys.path)
    control = {"kind": "file", "file": "main.py:update"}
    simulation = controlled(control, folder=code, trust=True)
    simulation.step()
    assert simulation.data.ctrl[0] == 3.0
    assert sys.path == before


def test_a_program_that_fails_is_told_with_time_and_name_and_the_recording_is_kept(
    code, monkeypatch
):
    monkeypatch.chdir(code)
    scene = 'title = "mine"\nvehicle = "bluerov2_heavy"\nduration = 0.5\n'
    scene += '[control]\nkind = "file"\nfile = "mine.py:broken"\n'
    (code / "mine.toml").write_text(scene)
    told = CliRunner().invoke(app, ["run", "mine.toml", "--trust"])
    assert told.exit_code == 1
    said = " ".join(told.output.split())
    assert (
        "the controller 'mine.py:broken' of 'bluerov2_heavy' raised ValueError at 0.16 s: no fix "
        "from the beacon"
    ) in said
    assert "the recording up to 0.16 s is in" in said
    assert (code / "recordings" / "mine.rrd").stat().st_size > 1000


def test_a_control_that_is_no_number_is_told_with_time_and_name(code):
    control = {"kind": "file", "file": "mine.py:lost"}
    simulation = controlled(control, folder=code, trust=True)
    with pytest.raises(ControlError) as caught:
        run_out(simulation)
    assert str(caught.value) == (
        "the controller 'mine.py:lost' of 'bluerov2_heavy' gave nan for actuator "
        "'vertical_back_port' at 0.16 s; controls must be finite numbers"
    )


@pytest.mark.parametrize(
    ("file", "message"),
    [
        ("none.py:update", "there is no controller '{}/none.py'; a path starts at the scene"),
        ("mine.py:updat", "'{}/mine.py' has no function 'updat'; did you mean 'update'? "),
        ("bad.py:update", "the controller '{}/bad.py' cannot be run: ZeroDivisionError: division"),
    ],
)
def test_a_program_that_is_not_there_is_told(file, message, code):
    (code / "bad.py").write_text("1 / 0\n")
    with pytest.raises(ControlError, match=re.escape(message.format(code))):
        controlled({"kind": "file", "file": file}, folder=code, trust=True)


def test_a_program_needs_a_file_and_a_function():
    with pytest.raises(ControlError, match=r"file is 'mine.py'; it must be a Python file"):
        Program(file="mine.py")


# scenes -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("control", "message"),
    [
        ({}, "scene: control: 'kind' is missing; needed is one of hold, lqr, keyframes, file"),
        ({"kind": "pid"}, "scene: control: unknown kind 'pid'; possible: file, hold, keyframes"),
        (
            {"kind": "hold", "dept": 1.0},
            "scene: control: unknown key 'dept'; did you mean 'depth'? possible: bandwidth, depth, "
            "depth_gains, free, heading, heading_gains, kind, pitch_gains, position,",
        ),
        ({"kind": "hold", "depth": "deep"}, "scene: control: depth is 'deep'; needed is a number"),
        ({"kind": "hold", "speed": -1}, "scene: control: speed is -1.0; it must be above 0"),
        ({"kind": "lqr", "depths": 1.0}, "scene: control: unknown key 'depths'; did you mean"),
        (
            {"kind": "hold", "waypoints": [{"depth": 1.0}]},
            "scene: control.waypoints.0: 'position' is missing; needed is a list of 2 numbers",
        ),
        (
            {"kind": "hold", "waypoints": 3},
            "scene: control.waypoints is 3; needed is a list of tables [[control.waypoints]]",
        ),
        (
            {"kind": "hold", "sensors": {"sonar": "x"}},
            "scene: control.sensors: unknown key 'sonar'; possible: attitude, depth, gyro",
        ),
        ("hold", "scene: control is 'hold'; needed is a table"),
        (
            [{"kind": "hold"}, {"kind": "lqr", "vehicle": "x"}],
            "2 controls are given, and one does not say which vehicle it steers; give each a "
            "vehicle = NAME",
        ),
        (
            [{"kind": "hold", "vehicle": "x"}, {"kind": "lqr", "vehicle": "x"}],
            "two controls steer vehicle 'x'; leave one of them out",
        ),
        (
            {"kind": "hold", "vehicle": "bluerov"},
            "control steers vehicle 'bluerov', which is not there; did you mean 'bluerov2_heavy'?",
        ),
    ],
)
def test_a_control_that_makes_no_sense_is_refused(control, message):
    with pytest.raises(SceneError, match=re.escape(message)):
        controlled(control)


def test_a_scene_has_a_control_from_python_too():
    scene = scene_from_table({"title": "t", "vehicle": "bluerov2_heavy"})
    changed = dataclasses.replace(scene, control=Hold(depth=1.0))
    assert changed.control == (Hold(depth=1.0),)
    with pytest.raises(SceneError, match="control is 3; it must be a Hold, Lqr, Keyframes"):
        dataclasses.replace(scene, control=(3,))


def test_the_summary_counts_updates_at_limits():
    far = {"kind": "hold", "position": [50.0, 0.0], "speed": 100.0, "bandwidth": 10.0}
    simulation = controlled(far)
    count = 0
    least, most = simulation.model.actuator_ctrlrange.T
    for step in range(20):
        simulation.step()
        ctrl = simulation.data.ctrl
        count += step % 2 == 0 and bool(((ctrl < least + 1e-6) | (ctrl > most - 1e-6)).any())
    summary = simulation.summary()
    assert 0 < summary.updates_at_limits == count
    assert ("controls at their limits", f"{count} updates") in summary.rows()
    assert "updates_at_limits" not in controlled([]).summary().values()


def test_a_controlled_scene_is_swept_as_it_runs_alone(tmp_path):
    path = catalog.scenes()["bluerov2_heavy_station"]
    keys, values = ("control.bandwidth", "water.waves.0.amplitude"), ((1.0, 0.1), (3.0, 0.05))
    sweep = Sweep(path, ("duration=1",), keys, values, tmp_path / "out.csv")
    rows = sorted(sweep.run(), key=lambda row: row["run"])
    for row, (bandwidth, amplitude) in zip(rows, values, strict=True):
        assert row["status"] == "done"
        settings = [
            "duration=1",
            f"control.bandwidth={bandwidth}",
            f"water.waves.0.amplitude={amplitude}",
        ]
        alone = Simulation(read_scene(path, settings))
        for _ in alone.frames():
            pass
        assert float(row["peak_draft"]) == alone.summary().peak_draft
        assert row["updates_at_limits"] == "0"
    assert rows[0]["peak_draft"] != rows[1]["peak_draft"]


def test_a_sweep_of_a_program_needs_trust_and_tells_of_runs_that_fail(code, monkeypatch):
    monkeypatch.chdir(code)
    (code / "mine.toml").write_text(
        'title = "mine"\nvehicle = "bluerov2_heavy"\nduration = 0.3\n'
        '[control]\nkind = "file"\nfile = "mine.py:lost"\n'
    )
    words = ["sweep", "mine.toml", "--over", "duration=0.1:0.3:2", "--out", "out.csv"]
    told = CliRunner().invoke(app, words)
    assert told.exit_code == 1
    assert "the scene runs the code of 'mine.py:lost'" in " ".join(told.output.split())
    assert not (code / "out.csv").exists()
    # some of its runs failed, and the table has all
    assert CliRunner().invoke(app, [*words, "--trust"]).exit_code == 3
    with (code / "out.csv").open() as file:
        rows = {float(row["duration"]): row for row in csv.DictReader(file)}
    assert rows[0.1]["status"] == "done"
    assert rows[0.3]["status"] == "failed"
    assert "gave nan for actuator 'vertical_back_port' at 0.16 s" in rows[0.3]["reason"]


def test_the_station_that_ships_is_told_as_json():
    words = ["run", "bluerov2_heavy_station", "--duration", "0.3", "--no-record", "--json"]
    told = CliRunner().invoke(app, words)
    assert told.exit_code == 0, told.output
    assert json.loads(told.stdout)["updates_at_limits"] == 0


def test_waves_and_a_current_change_nothing_about_the_rest_of_an_lqr():
    gains = [
        controlled({"kind": "lqr"}, water=water).controllers["bluerov2_heavy"].gain
        for water in ({}, WAVES | {"current": [0.5, 0.0, 0.0]})
    ]
    np.testing.assert_allclose(gains[0], gains[1], rtol=1e-6, atol=1e-6)


def test_a_controller_in_a_loop_knows_the_level_of_the_water():
    model, data = box(water=Water(level=2.0, waves=RegularWave(0.01, period=2.0)))
    data.qpos[2] = 1.0
    poses = steer(start_controller(Hold(depth=1.2), model, data), model, data, 10.0)
    assert poses[-1, 2] == pytest.approx(0.8, abs=0.02)


def test_a_controller_works_alike_where_the_water_is_a_callback():
    """There the rest is found on a model of its own, whose water is a part of it."""
    ends = []
    for through in ("qfrc_passive", "xfrc_applied"):
        scene = read_scene(catalog.scenes()["bluerov2_heavy_station"], ["duration=0.5"])
        simulation = Simulation(scene, through=through)
        ends.append(run_out(simulation)[-1])
    np.testing.assert_allclose(ends[1], ends[0], atol=1e-9)
