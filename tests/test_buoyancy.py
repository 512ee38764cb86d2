"""`Buoyancy` in the engine: callbacks, other people's forces, integrators, states."""

import ctypes
import warnings

import mujoco
import numpy as np
import pytest
from mujoco import rollout

from buoyancy_mj import (
    Buoyancy,
    Damping,
    LevelOscillation,
    ModelError,
    RegularWave,
    Silhouette,
    Water,
)
from buoyancy_mj.hulls.geoms import find_hulls

BOX = """
<mujoco>
  <option timestep="0.002" integrator="{integrator}" gravity="{gravity}"><flag {flag}/></option>
  <worldbody>
    <body name="box" pos="0 0 {z}"><freejoint/>
      <geom name="box" type="box" size=".2 .15 .1" mass="6"/></body>
  </worldbody>
  <actuator/>
</mujoco>
"""
INTEGRATORS = ["Euler", "RK4", "implicit", "implicitfast", "discrete"]


def box(integrator="implicitfast", gravity="0 0 -9.81", flag="energy='disable'", z=0.1):
    model = mujoco.MjModel.from_xml_string(
        BOX.format(integrator=integrator, gravity=gravity, flag=flag, z=z)
    )
    return model, mujoco.MjData(model)


def steps(model, data, count):
    for _ in range(count):
        mujoco.mj_step(model, data)


def after(count, integrator="RK4", push=None, **kwargs):
    """State after some steps, with `push(data, step)` called before each."""
    model, data = box(integrator)
    with Buoyancy(model, **kwargs).installed():
        for step in range(count):
            if push:
                push(data, step)
            mujoco.mj_step(model, data)
    return np.r_[data.qpos, data.qvel]


# loads --------------------------------------------------------------------------------------------


def test_the_force_is_rho_g_v_at_the_centroid_of_what_is_wet():
    model, data = box(z=0.03)
    data.qpos[3:7] = [np.cos(0.1), np.sin(0.1), 0.0, 0.0]
    mujoco.mj_forward(model, data)
    loads = Buoyancy(model, Water(density=1025.0), damping=None).evaluate(data)
    volume, centroid = float(loads.total.volume), loads.total.centroid
    assert loads.total.force == pytest.approx([0.0, 0.0, 1025.0 * 9.81 * volume])
    assert loads.body.force[1] == pytest.approx(loads.total.force)
    assert loads.body.torque[1] == pytest.approx(
        np.cross(centroid - data.xipos[1], loads.total.force)
    )
    assert loads.hull.torque[0] == pytest.approx(loads.body.torque[1])
    assert loads.xfrc[1] == pytest.approx([*loads.body.force[1], *loads.body.torque[1]])


def test_an_applied_force_and_torque_do_what_the_loads_say():
    # qfrc = J^T w at the inertial frame origin: the engine's own account of xfrc_applied
    model, data = box(z=0.03)
    data.qpos[3:7] = [np.cos(0.1), np.sin(0.1), 0.0, 0.0]
    buoyancy = Buoyancy(model)
    with buoyancy.installed():
        mujoco.mj_forward(model, data)
    with_water = data.qacc.copy()
    rows = buoyancy.evaluate(data).xfrc
    data.xfrc_applied[:] = rows
    mujoco.mj_forward(model, data)
    assert with_water == pytest.approx(data.qacc, abs=1e-12)


def test_hulls_add_up_to_bodies_and_bodies_to_the_total():
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><worldbody><body name="raft"><freejoint/>
        <geom type="box" size=".5 .1 .1" pos="0 .3 0"/>
        <geom type="box" size=".5 .1 .1" pos="0 -.3 .05"/>
        <body name="flap" pos=".7 0 0"><joint axis="0 1 0"/><geom type="sphere" size=".1"/></body>
        </body></worldbody></mujoco>"""
    )
    data = mujoco.MjData(model)
    data.qpos[2] = -0.03
    data.qvel[:] = 0.1
    mujoco.mj_forward(model, data)
    loads = Buoyancy(model).evaluate(data)
    assert loads.body.volume == pytest.approx(
        [0.0, loads.hull.volume[:2].sum(), loads.hull.volume[2]]
    )
    assert loads.total.volume == pytest.approx(loads.hull.volume.sum())
    # the volume-weighted global centroid of the source paper
    weighed = loads.hull.volume @ loads.hull.centroid / loads.hull.volume.sum()
    assert loads.total.centroid == pytest.approx(weighed)
    assert loads.total.force == pytest.approx(loads.body.force.sum(axis=0))
    assert sum(loads.by_cause.values()) == pytest.approx(loads.xfrc)
    assert set(loads.by_cause) == {"buoyancy", "drag"}
    # one resultant at the global centroid acts like the forces on each hull
    com = Buoyancy(model).centre_of_mass(data)
    one = np.cross(loads.total.centroid - com, [0, 0, loads.by_cause["buoyancy"][:, 2].sum()])
    each = sum(
        np.cross(c - com, f) for c, f in zip(loads.hull.centroid, loads.hull.force, strict=True)
    )
    assert one == pytest.approx(each)


def test_evaluating_writes_nothing():
    model, data = box()
    mujoco.mj_forward(model, data)
    before = {
        name: getattr(data, name).copy()
        for name in ("qfrc_passive", "xfrc_applied", "qfrc_applied", "qacc", "qpos")
    }
    Buoyancy(model).evaluate(data)
    for name, value in before.items():
        assert np.array_equal(getattr(data, name), value), name


def test_loads_are_copies():
    model, data = box(z=0.0)
    mujoco.mj_forward(model, data)
    buoyancy = Buoyancy(model)
    loads = buoyancy.evaluate(data)
    volume = float(loads.hull.volume[0])
    data.qpos[2] = 9.0
    mujoco.mj_forward(model, data)
    buoyancy.evaluate(data)
    assert float(loads.hull.volume[0]) == volume > 0.0


def test_gravity_is_the_models():
    for gravity in (9.81, 1.62):
        model, data = box(gravity=f"0 0 -{gravity}", z=-1.0)
        mujoco.mj_forward(model, data)
        assert Buoyancy(model, damping=None).evaluate(data).total.force[2] == pytest.approx(
            1000.0 * gravity * 0.024
        )


@pytest.mark.parametrize("flag", ["gravity='disable'", None])
def test_without_gravity_there_is_no_buoyancy(flag):
    model, data = box(flag=flag, z=-1.0) if flag else box(gravity="0 0 0", z=-1.0)
    mujoco.mj_forward(model, data)
    assert Buoyancy(model, damping=None).evaluate(data).total.force == pytest.approx(
        [0.0, 0.0, 0.0]
    )


# models where it could not work -------------------------------------------------------------------


@pytest.mark.parametrize("gravity", ["0 0 9.81", "0 -9.81 0", "0.1 0 -9.81"])
def test_gravity_in_another_direction_is_refused(gravity):
    with pytest.raises(
        ModelError,
        match=r"gravity is .*; water needs it along -z: set <option gravity='0 0 -9.81'/>",
    ):
        Buoyancy(box(gravity=gravity)[0])


def test_a_model_whose_callback_would_be_skipped_is_refused():
    with pytest.raises(
        ModelError,
        match="this model disables actuation, and MuJoCo then skips the control callback",
    ):
        Buoyancy(box(flag="actuation='disable'")[0])
    model, _ = box()
    buoyancy = Buoyancy(model)
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_ACTUATION)
    with pytest.raises(ModelError, match="disables actuation"), buoyancy.installed():
        pass


def test_springs_and_dampers_may_be_disabled():
    model, data = box(flag="spring='disable' damper='disable'", z=-1.0)
    with Buoyancy(model, damping=None).installed():
        mujoco.mj_forward(model, data)
    assert data.qacc[2] == pytest.approx(9.81 * (24.0 / 6.0 - 1.0))


def test_a_model_whose_bodies_would_sleep_through_waves_is_refused():
    with pytest.raises(
        ModelError,
        match="lets bodies at rest sleep, and MuJoCo does not wake them for water that moves",
    ):
        Buoyancy(box(flag="sleep='enable'")[0])


def test_threads_that_share_one_buoyancy_do_not_disturb_each_other():
    model, data = box("Euler")
    starts = np.zeros((16, mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS)))
    for i, start in enumerate(starts):
        data.qpos[2] = 0.01 * i
        mujoco.mj_getState(model, data, start, mujoco.mjtState.mjSTATE_FULLPHYSICS)
    ends = []
    with Buoyancy(model).installed():
        for threads in (1, 4):
            states, _ = rollout.rollout(
                model, [mujoco.MjData(model) for _ in range(threads)], starts, nstep=100
            )
            ends.append(states[:, -1])
    assert np.array_equal(*ends)


# integrators --------------------------------------------------------------------------------------


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_buoyant_body_comes_to_rest_under_each_integrator(integrator):
    model, data = box(integrator)
    model.opt.timestep = 0.01
    with Buoyancy(model, damping=Damping(viscous=Silhouette(linear_froude=0.5))).installed():
        steps(model, data, 3000)
    # draft = mass / (rho A)
    assert 0.1 - data.qpos[2] == pytest.approx(6.0 / (1000.0 * 0.4 * 0.3), abs=1e-6)
    assert np.abs(data.qvel).max() < 1e-5


def test_all_integrators_agree_on_a_short_drop():
    ends = []
    for integrator in INTEGRATORS:
        model, data = box(integrator)
        model.opt.timestep = 2e-4
        with Buoyancy(model, damping=None).installed():
            steps(model, data, 2000)
        ends.append(data.qpos[2])
    assert ends == pytest.approx([ends[1]] * 5, abs=2e-4)


def test_rk4_is_of_fourth_order_with_the_water_in_every_stage():
    def end(timestep):
        model, data = box("RK4", z=0.02)
        model.opt.timestep = timestep
        # smooth all along: the box bobs without leaving the water or going under
        with Buoyancy(model, Water(waves=LevelOscillation(0.01, 0.5)), damping=None).installed():
            steps(model, data, round(0.64 / timestep))
        return data.qpos[2]

    reference = end(0.001)
    errors = [abs(end(timestep) - reference) for timestep in (0.08, 0.04)]
    assert errors[0] / errors[1] > 12.0


def test_between_mj_step1_and_mj_step2_it_acts_as_the_callback_does():
    model, data = box("Euler")
    buoyancy = Buoyancy(model)
    for _ in range(300):
        mujoco.mj_step1(model, data)
        buoyancy(model, data)
        mujoco.mj_step2(model, data)
    model, again = box("Euler")
    with Buoyancy(model).installed():
        steps(model, again, 300)
    assert np.array_equal(data.qpos, again.qpos)


# other people's forces ----------------------------------------------------------------------------


PUSH = np.array([3.0, -2.0, 25.0, 0.3, 0.2, -0.1])


def reference_push(count, first=0):
    """The same push by another way in: qfrc_applied through the Jacobian."""

    def push(data, step):
        data.qfrc_applied[:] = 0.0
        if step >= first:
            rotation = data.xmat[1].reshape(3, 3)
            data.qfrc_applied[:3] = PUSH[:3]
            data.qfrc_applied[3:6] = rotation.T @ PUSH[3:]

    return after(count, integrator="Euler", push=push)


@pytest.mark.parametrize("how", ["once", "each step", "added", "viewer"])
def test_a_users_force_is_neither_lost_nor_doubled(how):
    def push(data, step):
        if (how == "once" and step == 50) or (how == "each step" and step >= 50):
            data.xfrc_applied[1] = PUSH
        elif how == "added" and step == 50:
            data.xfrc_applied[1] += PUSH
        elif how == "viewer" and step >= 50:
            # the viewer clears all and sets the body that is dragged
            data.xfrc_applied[:] = 0.0
            data.xfrc_applied[1] = PUSH

    # xfrc is turned with the pose of the stage, the reference with that of the last step
    state, reference = after(200, integrator="Euler", push=push), reference_push(200, first=50)
    assert state == pytest.approx(reference, abs=2e-3)
    without = after(200, integrator="Euler")
    assert np.abs(state - without).max() > 0.05


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_what_the_user_wrote_stays_as_it_was_written(integrator):
    model, data = box(integrator)
    data.xfrc_applied[1] = PUSH
    data.qfrc_applied[:] = 0.25
    with Buoyancy(model).installed():
        steps(model, data, 20)
    assert np.array_equal(data.xfrc_applied[1], PUSH)
    assert np.array_equal(data.qfrc_applied, np.full(6, 0.25))


def test_the_viewers_mouse_writes_the_row_it_wants():
    model, data = box(z=0.0)
    perturb = mujoco.MjvPerturb()
    perturb.select, perturb.active = 1, int(mujoco.mjtPertBit.mjPERT_TRANSLATE)
    perturb.localmass, perturb.scale = 1.0, 1.0
    with Buoyancy(model).installed():
        for _ in range(200):
            perturb.refselpos[:] = data.xpos[1] + [0.0, 0.2, 0.0]
            mujoco.mjv_applyPerturbForce(model, data, perturb)
            mujoco.mj_step(model, data)
    assert data.qpos[1] > 0.1
    assert abs(data.qpos[2] - 0.05) < 0.1


def test_a_call_twice_in_one_pass_acts_once():
    model, data = box(z=-1.0)
    buoyancy = Buoyancy(model, damping=None)
    mujoco.mj_step1(model, data)
    buoyancy(model, data)
    once = data.qfrc_passive.copy()
    buoyancy(model, data)
    assert np.array_equal(data.qfrc_passive, once)
    with buoyancy.installed(), buoyancy.installed():
        mujoco.mj_forward(model, data)
    assert np.array_equal(data.qfrc_passive, once)


def test_finite_differences_of_the_transition_see_the_water_once():
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><option timestep="0.002" integrator="Euler"/>
        <worldbody><body><joint name="z" type="slide" axis="0 0 1"/>
        <geom type="box" size=".2 .15 .1" mass="12"/></body></worldbody>
        <actuator><motor joint="z" gear="1"/></actuator></mujoco>"""
    )
    data = mujoco.MjData(model)
    a, b = np.zeros((2, 2)), np.zeros((2, 1))
    with Buoyancy(model, damping=None).installed():
        mujoco.mj_forward(model, data)
        mujoco.mjd_transitionFD(model, data, 1e-6, True, a, b, None, None)
    # dv'/dz = -h rho g A / m, dv'/du = h / m
    assert a[1, 0] == pytest.approx(-0.002 * 1000.0 * 9.81 * 0.12 / 12.0, rel=1e-4)
    assert b[1, 0] == pytest.approx(0.002 / 12.0, rel=1e-4)


# states -------------------------------------------------------------------------------------------


def test_a_saved_state_carries_no_water():
    model, data = box("RK4")
    state = np.empty(mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_INTEGRATION))
    with Buoyancy(model).installed():
        steps(model, data, 100)
        mujoco.mj_getState(model, data, state, mujoco.mjtState.mjSTATE_INTEGRATION)
        steps(model, data, 100)
        end = data.qpos.copy()
        steps(model, data, 37)
        mujoco.mj_setState(model, data, state, mujoco.mjtState.mjSTATE_INTEGRATION)
        steps(model, data, 100)
        assert np.array_equal(data.qpos, end)


def test_a_copy_of_the_data_goes_on_as_the_original():
    model, data = box("RK4")
    with Buoyancy(model).installed():
        steps(model, data, 100)
        copy = mujoco.MjData(model)
        mujoco.mj_copyData(copy, model, data)
        steps(model, data, 100)
        steps(model, copy, 100)
    assert np.array_equal(copy.qpos, data.qpos)


def test_forces_survive_a_reset():
    model, data = box()
    with Buoyancy(model).installed():
        steps(model, data, 500)
        end = data.qpos.copy()
        mujoco.mj_resetData(model, data)
        steps(model, data, 500)
    assert np.array_equal(data.qpos, end)


def test_one_buoyancy_serves_several_data():
    model, _ = box()
    several = [mujoco.MjData(model) for _ in range(3)]
    several[1].qpos[2], several[2].qpos[2] = 0.2, -0.2
    alone = []
    for data in several:
        copy = mujoco.MjData(model)
        copy.qpos[:] = data.qpos
        with Buoyancy(model).installed():
            steps(model, copy, 50)
        alone.append(copy.qpos.copy())
    with Buoyancy(model).installed():
        for _ in range(50):
            for data in several:
                mujoco.mj_step(model, data)
    for data, end in zip(several, alone, strict=True):
        assert np.array_equal(data.qpos, end)


# callbacks ----------------------------------------------------------------------------------------


def test_two_models_live_in_one_process():
    (one, one_data), (two, two_data) = box(z=0.1), box(z=0.1)
    with (
        Buoyancy(one, Water(density=1000.0)).installed(),
        Buoyancy(two, Water(density=500.0)).installed(),
    ):
        for _ in range(20000):
            mujoco.mj_step(one, one_data)
            mujoco.mj_step(two, two_data)
    assert one_data.qpos[2] == pytest.approx(0.05, abs=2e-3)
    assert two_data.qpos[2] == pytest.approx(0.0, abs=2e-3)


def test_another_model_is_left_alone():
    (floating, _), (falling, data) = box(), box(z=-1.0)
    with Buoyancy(floating).installed():
        mujoco.mj_step(falling, data)
    assert data.qacc[2] == pytest.approx(-9.81)


def test_the_callback_that_was_there_still_runs_and_comes_back():
    model, data = box(z=-1.0)
    seen = []

    def theirs(_model, data):
        seen.append(data.time)

    mujoco.set_mjcb_control(theirs)
    try:
        with Buoyancy(model).installed():
            mujoco.mj_step(model, data)
        assert seen == [0.0]
        assert data.qacc[2] > 0.0
        assert mujoco.get_mjcb_control() is theirs
    finally:
        mujoco.set_mjcb_control(None)


def test_a_compiled_callback_that_was_there_still_runs():
    model, data = box(z=-1.0)
    seen = []
    kind = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)
    theirs = kind(lambda m, d: seen.append((m, d)))
    mujoco.set_mjcb_control(theirs)
    try:
        with Buoyancy(model).installed():
            mujoco.mj_step(model, data)
        assert seen == [(model._address, data._address)]
        assert data.qacc[2] > 0.0
    finally:
        mujoco.set_mjcb_control(None)


def test_the_old_callback_comes_back_after_an_exception():
    model, _ = box()
    with pytest.raises(RuntimeError, match="mine"), Buoyancy(model).installed():
        raise RuntimeError("mine")
    assert mujoco.get_mjcb_control() is None


def test_without_the_callback_it_sinks():
    model, data = box(z=-1.0)
    with Buoyancy(model).installed():
        mujoco.mj_step(model, data)
    assert data.qacc[2] > 0.0
    mujoco.mj_step(model, data)
    assert data.qacc[2] == pytest.approx(-9.81)


def test_it_is_itself_a_control_callback():
    model, data = box(z=-1.0)
    mujoco.set_mjcb_control(Buoyancy(model, damping=None))
    try:
        mujoco.mj_step(model, data)
    finally:
        mujoco.set_mjcb_control(None)
    assert data.qacc[2] == pytest.approx(9.81 * 3.0)


def test_an_error_of_another_callback_reaches_the_user():
    model, data = box()

    def broken(_model, _data):
        raise ValueError("theirs")

    mujoco.set_mjcb_control(broken)
    try:
        with pytest.raises(ValueError, match="theirs"), Buoyancy(model).installed():
            mujoco.mj_step(model, data)
        assert mujoco.get_mjcb_control() is broken
    finally:
        mujoco.set_mjcb_control(None)


# articulated vehicles -----------------------------------------------------------------------------


ARM = """
<mujoco><option timestep="0.002"/><worldbody><body name="float" pos="0 0 .05"><freejoint/>
  <geom name="float" type="box" size=".3 .3 .1" mass="10"/>
  <body name="link" pos=".35 0 0"><joint name="hinge" axis="0 1 0" damping=".5"/>
    <geom name="link" type="box" size=".2 .03 .03" pos=".2 0 0" mass="{mass}"/></body>
</body></worldbody></mujoco>
"""


def test_each_body_gets_its_own_wrench():
    model = mujoco.MjModel.from_xml_string(ARM.format(mass=1.0))
    data = mujoco.MjData(model)
    data.qpos[2], data.qpos[7] = -0.3, 0.4
    mujoco.mj_forward(model, data)
    loads = Buoyancy(model, damping=None).evaluate(data)
    for hull in find_hulls(model):
        assert loads.body.force[hull.body, 2] == pytest.approx(9810.0 * hull.mesh.volume)
        assert loads.body.centroid[hull.body] == pytest.approx(data.geom_xpos[hull.geom])


@pytest.mark.parametrize(("mass", "up"), [(0.3, True), (8.0, False)])
def test_a_light_link_floats_up_and_a_heavy_one_hangs(mass, up):
    model = mujoco.MjModel.from_xml_string(ARM.format(mass=mass))
    data = mujoco.MjData(model)
    with Buoyancy(model).installed():
        steps(model, data, 20000)
    # a positive turn about y takes the link down
    assert data.geom("link").xpos[2] > -0.05 if up else data.geom("link").xpos[2] < -0.15


def test_a_geom_on_a_body_without_a_joint_floats_its_parent():
    text = """<mujoco><worldbody><body name="a" pos="0 0 -1"><freejoint/>
    <inertial pos="0 0 0" mass="5" diaginertia="1 1 1"/>
    {}</body></worldbody></mujoco>"""
    direct, welded = (
        mujoco.MjModel.from_xml_string(text.format(part))
        for part in (
            '<geom type="box" size=".1 .2 .1" pos=".3 0 .1" mass="0"/>',
            """<body pos=".3 0 .1"><inertial pos="0 0 0" mass="0" diaginertia="0 0 0"/>
            <geom type="box" size=".1 .2 .1" mass="0"/></body>""",
        )
    )
    accelerations = []
    for model in (direct, welded):
        data = mujoco.MjData(model)
        data.qvel[:] = [0.3, 0.1, -0.2, 0.5, 0.4, 0.1]
        with Buoyancy(model).installed():
            mujoco.mj_forward(model, data)
        accelerations.append(data.qacc.copy())
    assert accelerations[0] == pytest.approx(accelerations[1], rel=1e-9)


def test_waves_are_felt_at_the_time_of_the_data():
    model, data = box(z=0.05)
    water = Water(waves=RegularWave(0.05, period=2.0))
    buoyancy = Buoyancy(model, water, damping=None)
    volumes = []
    for time in (0.0, 1.0):
        data.time = time
        mujoco.mj_forward(model, data)
        volumes.append(float(buoyancy.evaluate(data).total.volume))
    assert volumes[0] > 0.0119 > volumes[1]


@pytest.mark.parametrize(
    ("joint", "told"), [("", True), ("<freejoint/>", False), ('<joint type="slide"/>', False)]
)
def test_a_vehicle_without_a_joint_whose_propeller_has_one_is_told(joint, told):
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><worldbody><body name="auv">{joint}
              <geom type="box" size="0.2 0.1 0.1" mass="8"/>
              <body name="propeller" pos="-0.2 0 0"><joint axis="1 0 0"/>
                <geom type="cylinder" size="0.05 0.01" mass="0.1"/></body>
            </body></worldbody></mujoco>"""
    )
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        Buoyancy(model)
    told_of = [str(one.message) for one in caught if "freejoint" in str(one.message)]
    assert told_of == (
        [
            "body 'auv' has no joint and stays where it is, and only what hangs on it is in the "
            "water; give it a <freejoint/> if it shall float"
        ]
        if told
        else []
    )
