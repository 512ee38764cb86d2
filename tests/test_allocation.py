"""Thrusts and the wrenches that they bring: the engine, pairs of motors by hand, and limits."""

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from buoyancy_mj import (
    ModelError,
    Tank,
    Thruster,
    add_ballast,
    add_thruster,
    allocation,
    find_thruster,
)
from buoyancy_mj.scenes import catalog
from buoyancy_mj.vehicle.drives import find_drives

PAIR = """<mujoco><option gravity="0 0 0"/><worldbody>
<body name="rov" pos="1 2 3"><freejoint/><geom size=".2" mass="10" pos=".1 0 0"/>
<site name="port" pos="0 .5 0" zaxis="1 0 0"/><site name="starboard" pos="0 -.5 0" zaxis="1 0 0"/>
</body>{more}</worldbody>
<actuator>{actuators}</actuator></mujoco>"""
MOTORS = """<motor name="port" site="port" gear="0 0 2 0 0 .1" ctrlrange="-5 10"/>
<motor name="starboard" site="starboard" gear="0 0 1 0 0 -.05" ctrlrange="-20 40"
 forcerange="-30 30"/>"""


def model_of(actuators=MOTORS, more=""):
    return mujoco.MjModel.from_xml_string(PAIR.format(actuators=actuators, more=more))


def ship(name):
    return mujoco.MjModel.from_xml_path(str(catalog.models()[name]))


# the matrix ---------------------------------------------------------------------------------------


def test_a_pair_of_motors_has_the_matrix_that_one_writes_down_by_hand():
    found = allocation(model_of())
    assert found.names == ("port", "starboard")
    np.testing.assert_allclose(found.centre, [0.1, 0.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(
        found.matrix,
        [[1, 1], [0, 0], [0, 0], [0.05, -0.05], [0, 0], [-0.5, 0.5]],
        atol=1e-12,
    )
    assert found.rank == 2
    # a gear of 2 doubles the thrust of a control
    np.testing.assert_allclose(found.commands([6.0, 6.0]), [3.0, 6.0])
    np.testing.assert_allclose([found.least, found.most], [[-10, -20], [20, 30]])


@pytest.mark.parametrize("name", ["bluerov2_heavy", "sauvc_auv"])
def test_the_engine_accelerates_a_vehicle_as_the_matrix_says(name):
    model = ship(name)
    model.opt.gravity[:] = 0.0
    data = mujoco.MjData(model)
    data.qpos[3:7] = Rotation.from_euler("ZYX", [2.0, 0.4, -0.7]).as_quat(scalar_first=True)
    found = allocation(model, data)
    inertia = Rotation.from_quat(model.body_iquat[1], scalar_first=True).as_matrix()
    inertia = inertia @ np.diag(model.body_inertia[1]) @ inertia.T
    mujoco.mj_forward(model, data)
    moments = np.zeros((model.nu, model.nv))
    mujoco.mju_sparse2dense(
        moments, data.actuator_moment, data.moment_rownnz, data.moment_rowadr, data.moment_colind
    )
    for i in range(model.nu):
        # a newton of thrust, whatever control and time bring it
        data.qfrc_applied[:] = moments[i]
        mujoco.mj_forward(model, data)
        world_from_body = data.xmat[1].reshape(3, 3)
        turning = data.qacc[3:]
        push = data.qacc[:3] + world_from_body @ np.cross(turning, found.centre)
        force = model.body_mass[1] * world_from_body.T @ push
        np.testing.assert_allclose(force, found.matrix[:3, i], atol=1e-10)
        np.testing.assert_allclose(inertia @ turning, found.matrix[3:, i], atol=1e-10)


def test_thrusters_on_an_arm_push_the_whole_vehicle_where_the_arm_stands():
    arm = """<body name="arm" pos="-1 0 0"><joint name="swing" axis="0 0 1"/>
    <geom size=".1" mass="1"/><site name="tip" pos="0 0 0" zaxis="-1 0 0"/></body></body>"""
    xml = PAIR.format(
        actuators='<motor name="tip" site="tip" gear="0 0 1 0 0 0"/>', more=""
    ).replace("</body></worldbody>", f"{arm}</worldbody>")
    model = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(model)
    data.qpos[7] = 0.5 * np.pi
    found = allocation(model, data)
    # the engine: a unit of thrust as generalized force on the free joint
    data.ctrl[0] = 1.0
    mujoco.mj_forward(model, data)
    force, torque = data.qfrc_actuator[:3], data.qfrc_actuator[3:6]
    np.testing.assert_allclose(found.matrix[:3, 0], force, atol=1e-12)
    about_centre = torque - np.cross(found.centre, force)
    np.testing.assert_allclose(found.matrix[3:, 0], about_centre, atol=1e-12)


# what can be reached ------------------------------------------------------------------------------


def test_reach_is_the_most_along_each_axis_alone():
    found = allocation(ship("bluerov2_heavy"))
    push = 4 * np.sqrt(0.5)
    least, most = found.least[0], found.most[0]
    assert -45.0 < least < -35.0
    assert 45.0 < most < 55.0
    np.testing.assert_allclose(found.reach[0], [least * push, most * push], rtol=1e-6)
    # sideways two push and two pull, so that the weaker direction counts
    np.testing.assert_allclose(found.reach[1], [least * push, -least * push], rtol=1e-6)
    np.testing.assert_allclose(found.reach[2], [4.0 * least, 4.0 * most], rtol=1e-6)
    assert found.rank == 6
    assert found.unreachable == ()


def test_thrusters_are_drives_by_their_bollard_curves():
    spec = mujoco.MjSpec.from_string(PAIR.format(actuators="", more=""))
    for site, control in (("port", "throttle"), ("starboard", "thrust")):
        add_thruster(spec, site, Thruster(preset="t200", voltage=16.0, control=control))
    model = spec.compile()
    found = allocation(model)
    thruster = find_thruster(model, "port")
    assert (found.least[0], found.most[0]) == thruster.limits()
    throttle, thrust = found.commands([20.0, -10.0])
    assert thrust == pytest.approx(-10.0)
    assert thruster.thrust(throttle) == pytest.approx(20.0, rel=1e-6)
    # the propeller turns one way, and the vehicle the other
    assert found.matrix[3, 0] < 0.0
    assert found.matrix[5, 0] == pytest.approx(-0.5)


def test_axes_that_cannot_be_had_alone_are_named():
    assert allocation(model_of()).unreachable == ("sway", "heave", "roll", "pitch", "yaw")
    even = MOTORS.replace("0 0 2 0 0 .1", "0 0 1 0 0 0").replace("-.05", "0")
    found = allocation(model_of(even))
    assert found.unreachable == ("sway", "heave", "roll", "pitch")
    np.testing.assert_allclose(found.reach[0], [-10.0, 20.0], rtol=1e-9)
    np.testing.assert_allclose(found.reach[5], [-10.0, 5.0], rtol=1e-9)


def test_motors_without_limits_reach_everything():
    free = allocation(model_of('<motor site="port" gear="0 0 1 0 0 0"/>'))
    assert free.names == ("actuator 0",)
    assert free.most[0] == np.inf
    level = model_of(
        '<motor site="port" gear="0 0 1 0 0 0"/><motor site="starboard" gear="0 0 1 0 0 0"/>'
    )
    np.testing.assert_array_equal(allocation(level).reach[0], [-np.inf, np.inf])


# thrusts ------------------------------------------------------------------------------------------


def test_within_the_limits_the_smallest_thrusts_bring_the_wrench():
    found = allocation(ship("sauvc_auv"))
    wrench = [10.0, -5.0, 8.0, 1.0, -2.0, 3.0]
    thrusts = found.allocate(wrench)
    np.testing.assert_allclose(found.matrix @ thrusts, wrench, atol=1e-10)
    np.testing.assert_allclose(found.inverse @ wrench, thrusts, atol=1e-10)
    # weights change nothing where nothing is missed
    np.testing.assert_allclose(found.allocate(wrench, [1, 2, 3, 4, 5, 6]), thrusts, atol=1e-9)


def test_beyond_the_limits_no_neighbour_misses_less():
    found = allocation(ship("sauvc_auv"))
    wrench = np.array([300.0, 40.0, -20.0, 3.0, 0.0, 25.0])
    weights = np.array([1.0, 1.0, 2.0, 10.0, 10.0, 10.0])
    thrusts = found.allocate(wrench, weights)
    assert (thrusts >= found.least).all()
    assert (thrusts <= found.most).all()

    def missed(forces):
        return np.linalg.norm(weights * (found.matrix @ forces - wrench))

    rng = np.random.default_rng(1)
    for step in rng.normal(size=(200, 8)):
        near = np.clip(thrusts + 0.1 * step, found.least, found.most)
        assert missed(near) >= missed(thrusts) - 1e-6


def test_an_axis_that_weighs_more_is_missed_less():
    found = allocation(ship("bluerov2_heavy"))
    wrench = [200.0, 0.0, 0.0, 0.0, 0.0, 20.0]
    heading = [
        abs((found.matrix @ found.allocate(wrench, [1, 1, 1, w, w, w]))[5] - 20.0)
        for w in (1.0, 10.0, 100.0)
    ]
    assert heading[0] > heading[1] > heading[2]


# what is refused ----------------------------------------------------------------------------------


def test_actuators_that_push_nothing_alone_are_no_drives():
    joint = '<motor name="none" site="port" gear="0 0 0 0 0 0"/>'
    assert [drive.name for drive in find_drives(model_of(MOTORS + joint))] == ["port", "starboard"]
    grouped = model_of(MOTORS.replace('name="port"', 'name="port" group="1"'))
    grouped.opt.disableactuator = 2
    assert allocation(grouped).names == ("starboard",)


def test_ballast_has_a_site_and_pushes_nothing():
    spec = mujoco.MjSpec.from_string(PAIR.format(actuators=MOTORS, more=""))
    spec.body("rov").add_geom(name="tank", size=[0.05, 0, 0], mass=0.0)
    add_ballast(spec, "tank", Tank(rate=1e-5))
    dry, found = allocation(model_of()), allocation(spec.compile())
    assert found.names == dry.names
    np.testing.assert_allclose(found.matrix, dry.matrix, atol=1e-12)


@pytest.mark.parametrize(
    ("actuators", "message"),
    [
        (
            '<general name="port" site="port" gear="0 0 1 0 0 0" dyntype="integrator"/>',
            "the thrust of actuator 'port' does not follow from its control: its dyntype is not "
            "that of a motor or of a thruster; give it one of these, or put it into a group that "
            "is disabled",
        ),
        ("", "no actuator pushes 'rov' at a site; give it motors or thrusters at sites"),
    ],
)
def test_a_model_without_thrust_is_refused(actuators, message):
    with pytest.raises(ModelError) as caught:
        allocation(model_of(actuators))
    assert str(caught.value) == message


def test_a_vehicle_that_is_not_there_is_told():
    more = '<body name="boat"><freejoint/><geom size=".1"/></body><body name="pier"/>'
    model = model_of(more=more)
    # only one of two vehicles has thrusters
    assert allocation(model).root == 1
    with pytest.raises(ModelError, match="no actuator pushes 'boat' at a site"):
        allocation(model, body="boat")
    with pytest.raises(ModelError, match="has no body 'rob'; did you mean 'rov'"):
        allocation(model, body="rob")
    with pytest.raises(ModelError, match="body 'pier' cannot move; name one of a vehicle"):
        allocation(model, body="pier")
    with pytest.raises(ModelError, match="body is 9; the model has bodies 1 to 3"):
        allocation(model, body=9)


def test_a_wrench_that_is_none_is_refused():
    found = allocation(model_of())
    with pytest.raises(ModelError, match="wrench holds nan; its numbers must be finite"):
        found.allocate([0, 0, 0, 0, 0, np.nan])
    with pytest.raises(ModelError, match="weights hold -1; they must not be negative"):
        found.allocate(np.ones(6), [1, 1, 1, 1, 1, -1])
