"""The water in `xfrc_applied`: the same motion, sensors that see it, and whose a row is."""

import contextlib
import functools

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

from buoyancy_mj import (
    Buoyancy,
    BuoyancyWarning,
    EngineError,
    ModelError,
    RegularWave,
    Simulation,
    Water,
    read_scene,
)
from buoyancy_mj.cli import app
from buoyancy_mj.engine import applied
from buoyancy_mj.scenes import catalog

SEA = Water(density=1025.0, waves=RegularWave(0.1, wavelength=6.0))
RAFT = """
<mujoco>
  <option timestep="0.004" integrator="{integrator}"/>
  <worldbody>
    <body name="raft" pos="0 0 .05"><freejoint/>
      <geom type="box" size=".5 .4 .1" mass="40"/>
      <body name="arm" pos=".6 0 0"><joint axis="0 1 0"/>
        <geom type="ellipsoid" size=".1 .2 .05" mass="2"/></body></body>
    <body name="dry" pos="0 0 5"><freejoint/><geom size=".1" contype="0" conaffinity="0"/></body>
  </worldbody>
  {more}
</mujoco>
"""
RIG = """
<mujoco><option timestep="0.002"/><worldbody>
  <body name="tether" pos="0 0 -2"><joint type="ball"/>
    <site name="foot"/>
    <geom name="buoy" size=".2" pos="0 0 1" mass="10"/></body>
  <body name="strut" pos="3 0 -1"><joint type="slide" axis="1 0 0" stiffness="1e4"/>
    <site name="root"/>
    <geom name="float" type="box" size=".2 .1 .1" pos="0 .5 0" mass="5"/></body>
</worldbody>
<sensor><force site="foot"/><force site="root"/><torque site="root"/></sensor></mujoco>
"""
PUSH = np.array([30.0, -20.0, 25.0, 3.0, 2.0, -1.0])
ADDED_MASS = {"raft": [5.0, 10.0, 30.0, 1.0, 2.0, 3.0]}
INTEGRATORS = ["Euler", "RK4", "implicit", "implicitfast", "discrete"]
INTEGRATION = mujoco.mjtState.mjSTATE_INTEGRATION


def raft(integrator="Euler", more=""):
    model = mujoco.MjModel.from_xml_string(RAFT.format(integrator=integrator, more=more))
    return model, mujoco.MjData(model)


def state(data):
    return np.r_[data.qpos, data.qvel]


def after(through, count=150, integrator="Euler", push=None, **options):
    """State after some steps, with `push(data, step)` called before each."""
    model, data = raft(integrator)
    with Buoyancy(model, SEA, **options).installed(through=through):
        for step in range(count):
            if push:
                push(data, step)
            mujoco.mj_step(model, data)
    return state(data)


def alike(count=150, **kwargs):
    """The state after some steps, if it is the same through either array."""
    ends = [after(through, count, **kwargs) for through in ("qfrc_passive", "xfrc_applied")]
    assert ends[1] == pytest.approx(ends[0], rel=0, abs=1e-10)
    return ends[1]


# motion -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_bodies_move_as_they_do_through_passive_forces(integrator):
    alike(integrator=integrator)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_bodies_with_added_mass_do_too(integrator):
    end = alike(integrator=integrator, added_mass=ADDED_MASS)
    assert np.abs(end - alike(integrator=integrator)).max() > 1e-3


def test_kinetic_energy_counts_the_added_mass_either_way():
    energies = []
    for through in ("qfrc_passive", "xfrc_applied"):
        model, data = raft(more="<option><flag energy='enable'/></option>")
        data.qvel[:] = 1.0
        with Buoyancy(model, SEA, added_mass=ADDED_MASS).installed(through=through):
            mujoco.mj_forward(model, data)
        energies.append(data.energy[1])
    mujoco.mj_forward(model, data)
    assert energies[1] == pytest.approx(energies[0], rel=1e-12)
    assert energies[1] > data.energy[1] + 10.0


@pytest.mark.long
@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(catalog.scenes()))
def test_shipped_scenes_do_too(name):
    scene = read_scene(catalog.scene_path(name), ["duration=2", "record_rate=1"])
    ends = []
    for through in ("qfrc_passive", "xfrc_applied"):
        simulation = Simulation(scene, through=through)
        for _ in range(simulation.steps):
            simulation.step()
        ends.append(state(simulation.data))
    assert ends[1] == pytest.approx(ends[0], rel=0, abs=1e-9)


def test_a_model_without_springs_and_dampers_moves_as_it_does_by_its_own_way_in():
    ends = []
    for through in ("qfrc_passive", "xfrc_applied"):
        model, data = raft(more="<option><flag spring='disable' damper='disable'/></option>")
        with Buoyancy(model, SEA).installed(through=through):
            for _ in range(100):
                mujoco.mj_step(model, data)
        ends.append(state(data))
    assert ends[1] == pytest.approx(ends[0], rel=0, abs=1e-10)


def test_finite_differences_of_the_transition_see_the_water_once():
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><option timestep="0.002" integrator="Euler"/>
        <worldbody><body><joint name="z" type="slide" axis="0 0 1"/>
        <geom type="box" size=".2 .15 .1" mass="12"/></body></worldbody>
        <actuator><motor joint="z" gear="1"/></actuator></mujoco>"""
    )
    data = mujoco.MjData(model)
    a, b = np.zeros((2, 2)), np.zeros((2, 1))
    with Buoyancy(model, damping=None).installed(through="xfrc_applied"):
        mujoco.mj_forward(model, data)
        mujoco.mjd_transitionFD(model, data, 1e-6, True, a, b, None, None)
    # dv'/dz = -h rho g A / m, dv'/du = h / m
    assert a[1, 0] == pytest.approx(-0.002 * 1000.0 * 9.81 * 0.12 / 12.0, rel=1e-4)
    assert b[1, 0] == pytest.approx(0.002 / 12.0, rel=1e-4)


# what sees it -------------------------------------------------------------------------------------


def test_a_tether_carries_the_net_lift_of_its_buoy():
    model = mujoco.MjModel.from_xml_string(RIG)
    data = mujoco.MjData(model)
    with Buoyancy(model, Water(density=1025.0)).installed(through="xfrc_applied"):
        mujoco.mj_forward(model, data)
    lift = 1025.0 * 9.81 * 4.0 / 3.0 * np.pi * 0.2**3 - 10.0 * 9.81
    # what the parent, the ground, does to the tether
    assert np.abs(data.sensordata[:3]) == pytest.approx([0.0, 0.0, lift], abs=1e-9)
    with Buoyancy(model, Water(density=1025.0)).installed():
        mujoco.mj_forward(model, data)
    assert data.sensordata[2] == pytest.approx(10.0 * 9.81, abs=1e-9)


def test_force_and_torque_sensors_read_buoyancy_less_weight():
    model = mujoco.MjModel.from_xml_string(RIG)
    data = mujoco.MjData(model)
    water = Buoyancy(model, Water(density=1025.0))
    with water.installed(through="xfrc_applied"):
        mujoco.mj_forward(model, data)
    lift = float(water.evaluate(data).hull.force[1, 2]) - 5.0 * 9.81
    assert data.sensordata[3:6] == pytest.approx([0.0, 0.0, -lift], abs=1e-9)
    assert data.sensordata[6:9] == pytest.approx([-0.5 * lift, 0.0, 0.0], abs=1e-9)


def test_the_engine_counts_it_among_external_forces():
    model, data = raft()
    water = Buoyancy(model, SEA)
    with water.installed(through="xfrc_applied"):
        mujoco.mj_forward(model, data)
        mujoco.mj_rnePostConstraint(model, data)
        assert np.array_equal(data.xfrc_applied[1:], water.loads(data).xfrc[1:])
        assert data.cfrc_ext[1:, 3:] == pytest.approx(water.loads(data).xfrc[1:, :3], abs=1e-12)
    assert np.abs(data.cfrc_ext[1]).max() > 100.0


def test_added_mass_that_a_sensor_would_misread_is_refused():
    kinetic = RAFT.format(integrator="Euler", more="<sensor><e_kinetic name='e'/></sensor>")
    for text, name in ((RIG, "number 0"), (kinetic, "e")):
        model = mujoco.MjModel.from_xml_string(text)
        message = (
            f"^the sensor '{name}' would not read the added mass, which stands in the mass matrix "
            "and not in xfrc_applied: leave out the sensor, or the added mass "
            r"\(added_mass='none'\)$"
        )
        added_mass = {mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_BODY, 1): [1.0] * 6}
        with (
            pytest.raises(ModelError, match=message),
            Buoyancy(model, added_mass=added_mass).installed(through="xfrc_applied"),
        ):
            pass
        with Buoyancy(model).installed(through="xfrc_applied"):
            pass


# whose a row is -----------------------------------------------------------------------------------


def test_a_force_that_was_there_before_stays():
    def once(data, step):
        if step == 0:
            data.xfrc_applied[1] = PUSH

    assert np.abs(alike(push=once) - alike()).max() > 0.05


@pytest.mark.parametrize("integrator", ["Euler", "RK4"])
def test_a_force_that_is_assigned_between_steps_stays_until_the_next(integrator):
    def twice(data, step):
        if step in (40, 80):
            data.xfrc_applied[1] = PUSH if step == 40 else -PUSH

    alike(integrator=integrator, push=twice)


def test_a_force_that_is_assigned_in_each_step_counts_once():
    def always(data, step):
        data.xfrc_applied[1] = PUSH * np.sin(step)

    alike(push=always)


def test_single_components_of_a_force_may_be_assigned():
    def one_by_one(data, step):
        if step % 30 == 10:
            data.xfrc_applied[1, step // 30] = 20.0

    alike(push=one_by_one)


def test_a_force_that_is_taken_back_is_gone():
    def for_a_while(data, step):
        if step == 20:
            data.xfrc_applied[1] = PUSH
        if step == 60:
            data.xfrc_applied[1] = 0.0

    alike(push=for_a_while)


def test_a_viewer_that_clears_all_rows_and_sets_one_is_heard():
    def viewer(data, step):
        data.xfrc_applied[:] = 0.0
        if 30 <= step < 90:
            data.xfrc_applied[1 + step % 2] = PUSH

    alike(push=viewer)


def test_the_viewers_mouse_drags_as_it_does_beside_passive_forces():
    ends = []
    for through in ("qfrc_passive", "xfrc_applied"):
        model, data = raft()
        perturb = mujoco.MjvPerturb()
        perturb.select, perturb.active = 1, int(mujoco.mjtPertBit.mjPERT_TRANSLATE)
        perturb.localmass, perturb.scale = 40.0, 1.0
        with Buoyancy(model, SEA).installed(through=through):
            for _ in range(150):
                perturb.refselpos[:] = data.xpos[1] + [0.0, 0.2, 0.0]
                mujoco.mjv_applyPerturbForce(model, data, perturb)
                mujoco.mj_step(model, data)
        ends.append(state(data))
    assert ends[1] == pytest.approx(ends[0], rel=0, abs=1e-10)
    assert ends[1][1] > 0.1


def test_a_force_on_a_dry_body_is_none_of_the_waters_business():
    def once(data, step):
        if step == 3:
            data.xfrc_applied[3] = PUSH

    alike(push=once)


def test_external_rows_may_be_added_to():
    model, data = raft()
    water = Buoyancy(model, SEA)
    with water.installed(through="xfrc_applied"):
        data.xfrc_applied[1] = PUSH
        for _ in range(3):
            mujoco.mj_step(model, data)
            assert np.array_equal(water.external(data)[1], PUSH)
        water.external(data)[1] += PUSH
        mujoco.mj_step(model, data)
        assert data.xfrc_applied[1] == pytest.approx(water.loads(data).xfrc[1] + 2.0 * PUSH)
    assert np.array_equal(data.xfrc_applied[1], 2.0 * PUSH)


def test_another_control_callback_is_counted_whatever_it_assigns():
    def push(_, data):
        data.xfrc_applied[1] = PUSH * np.sin(data.time)

    ends = []
    models = {through: raft("RK4") for through in ("qfrc_passive", "xfrc_applied")}
    mujoco.set_mjcb_control(push)
    try:
        for through, (model, data) in models.items():
            with Buoyancy(model, SEA).installed(through=through):
                for _ in range(100):
                    mujoco.mj_step(model, data)
            ends.append(state(data))
        assert mujoco.get_mjcb_control() is push
    finally:
        mujoco.set_mjcb_control(None)
    assert ends[1] == pytest.approx(ends[0], rel=0, abs=1e-10)


# states, copies and resets ------------------------------------------------------------------------


@pytest.mark.parametrize("push", [np.zeros(6), PUSH], ids=["alone", "pushed"])
def test_a_state_that_is_restored_goes_on_as_it_did(push, monkeypatch):
    monkeypatch.setattr(applied, "MOST_REMEMBERED", 5)
    model, data = raft()
    saved = np.empty(mujoco.mj_stateSize(model, INTEGRATION))
    with Buoyancy(model, SEA).installed(through="xfrc_applied"):
        data.xfrc_applied[1] = push
        for _ in range(20):
            mujoco.mj_step(model, data)
        mujoco.mj_getState(model, data, saved, INTEGRATION)
        ends = []
        for _ in range(2):
            for _ in range(50):
                mujoco.mj_step(model, data)
            ends.append(state(data))
            mujoco.mj_setState(model, data, saved, INTEGRATION)
    assert np.array_equal(*ends)


def test_a_state_of_another_process_goes_on_as_it_did():
    ends = []
    model, data = raft()
    saved = np.empty(mujoco.mj_stateSize(model, INTEGRATION))
    for _ in range(2):
        # a water that remembers nothing of the first
        with Buoyancy(model, SEA).installed(through="xfrc_applied"):
            if not ends:
                for _ in range(20):
                    mujoco.mj_step(model, data)
                mujoco.mj_getState(model, data, saved, INTEGRATION)
            else:
                mujoco.mj_setState(model, data, saved, INTEGRATION)
            for _ in range(30):
                mujoco.mj_step(model, data)
        ends.append(state(data))
    assert np.array_equal(*ends)


def test_a_copy_of_the_data_goes_on_as_the_original():
    model, data = raft()
    with Buoyancy(model, SEA).installed(through="xfrc_applied"):
        data.xfrc_applied[1] = PUSH
        for _ in range(20):
            mujoco.mj_step(model, data)
        copy = mujoco.MjData(model)
        mujoco.mj_copyData(copy, model, data)
        for _ in range(20):
            mujoco.mj_step(model, data)
            mujoco.mj_step(model, copy)
    assert np.array_equal(state(copy), state(data))
    assert np.array_equal(copy.xfrc_applied, data.xfrc_applied)


def test_a_reset_clears_the_forces_of_others():
    model, data = raft()
    with Buoyancy(model, SEA).installed(through="xfrc_applied"):
        data.xfrc_applied[1] = PUSH
        for _ in range(20):
            mujoco.mj_step(model, data)
        mujoco.mj_resetData(model, data)
        for _ in range(150):
            mujoco.mj_step(model, data)
    assert np.array_equal(state(data), after("xfrc_applied"))


def test_what_cannot_be_told_apart_is_an_error(monkeypatch):
    monkeypatch.setattr(applied, "MOST_REMEMBERED", 2)
    model, data = raft()
    saved = np.empty(mujoco.mj_stateSize(model, INTEGRATION))
    water = Buoyancy(model, SEA)
    with water.installed(through="xfrc_applied"):
        mujoco.mj_step(model, data)
        mujoco.mj_getState(model, data, saved, INTEGRATION)
        for _ in range(5):
            mujoco.mj_step(model, data)
        mujoco.mj_setState(model, data, saved, INTEGRATION)
        data.xfrc_applied[1, 0] += 1.0
        message = (
            "^xfrc_applied holds the water of a pass long ago together with forces of others, and "
            "the two cannot be told apart any more: set xfrc_applied to 0, then to those forces$"
        )
        with pytest.raises(EngineError, match=message):
            mujoco.mj_step(model, data)
        with pytest.raises(EngineError, match=message):
            water.external(data)
        data.xfrc_applied[:] = 0.0
        mujoco.mj_step(model, data)


def test_the_seal_is_in_a_row_that_mujoco_does_not_read_and_too_small_to_count():
    model, data = raft()
    with Buoyancy(model, SEA).installed(through="xfrc_applied"):
        mujoco.mj_forward(model, data)
        assert 0.0 < np.abs(data.xfrc_applied[0]).max() < 1e-300
        rest = data.xfrc_applied[1:].sum(axis=0)
        assert data.xfrc_applied.sum(axis=0) == pytest.approx(rest, rel=0, abs=1e-300)
    mujoco.mj_forward(model, data)
    without = data.qacc.copy()
    data.xfrc_applied[0] = 1e9
    mujoco.mj_forward(model, data)
    assert np.array_equal(data.qacc, without)


class Twin:
    """A simulation and the states it saved, through either array."""

    def __init__(self, model, water, through):
        self.model, self.water, self.through = model, water, through
        self.data, self.other = mujoco.MjData(model), mujoco.MjData(model)
        self.saved = np.zeros(mujoco.mj_stateSize(model, INTEGRATION))
        self.save(0, 0, 0.0)

    def step(self, _row, _column, _value):
        with self.water.installed(through=self.through):
            mujoco.mj_step(self.model, self.data)

    def assign(self, row, column, value):
        self.data.xfrc_applied[row, column:] = value

    def add(self, row, column, value):
        through = self.through == "xfrc_applied"
        rows = self.water.external(self.data) if through else self.data.xfrc_applied
        rows[row, column] += value

    def clear(self, _row, _column, _value):
        self.data.xfrc_applied[:] = 0.0

    def reset(self, _row, _column, _value):
        mujoco.mj_resetData(self.model, self.data)

    def save(self, _row, _column, _value):
        mujoco.mj_getState(self.model, self.data, self.saved, INTEGRATION)

    def restore(self, _row, _column, _value):
        mujoco.mj_setState(self.model, self.data, self.saved, INTEGRATION)

    def swap(self, _row, _column, _value):
        mujoco.mj_copyData(self.other, self.model, self.data)
        self.data, self.other = self.other, self.data


@functools.cache
def shared_water():
    return Buoyancy(raft()[0], SEA)


DEEDS = st.tuples(
    st.sampled_from(["step", "step", "assign", "add", "clear", "reset", "save", "restore", "swap"]),
    st.integers(1, 3),
    st.integers(0, 5),
    st.floats(-50.0, 50.0),
)


@pytest.mark.parametrize("stays", [True, False], ids=["one block", "a block for each step"])
@settings(max_examples=60)
@given(deeds=st.lists(DEEDS, max_size=25))
def test_whatever_others_do_the_motion_is_the_same(stays, deeds):
    ends = []
    for through in ("qfrc_passive", "xfrc_applied"):
        twin = Twin(shared_water().model, shared_water(), through)
        block = twin.water.installed(through=through) if stays else contextlib.nullcontext()
        with block:
            for deed, *how in [*deeds, ("step", 0, 0, 0.0)]:
                getattr(twin, deed)(*how)
        ends.append(np.r_[state(twin.data), twin.data.xfrc_applied.ravel()])
    assert ends[1] == pytest.approx(ends[0], rel=1e-12, abs=1e-12)


# its end ------------------------------------------------------------------------------------------


def test_at_the_end_rows_hold_what_others_want():
    model, _ = raft()
    several = [mujoco.MjData(model) for _ in range(3)]
    for data, push in zip(several, (0.0, PUSH, -PUSH), strict=True):
        data.xfrc_applied[1] = push
    before = [data.xfrc_applied.copy() for data in several]
    with Buoyancy(model, SEA).installed(through="xfrc_applied"):
        for data in several:
            mujoco.mj_step(model, data)
            assert data.xfrc_applied[1, 2] > 100.0
    assert np.array_equal([data.xfrc_applied for data in several], before)
    assert mujoco.get_mjcb_control() is None


def test_an_exception_ends_it_alike():
    model, data = raft()

    def step_and_fail():
        with Buoyancy(model, SEA).installed(through="xfrc_applied"):
            mujoco.mj_step(model, data)
            raise RuntimeError("mine")

    with pytest.raises(RuntimeError, match="mine"):
        step_and_fail()
    assert not data.xfrc_applied.any()


def test_water_that_cannot_be_taken_out_at_the_end_is_told(monkeypatch):
    monkeypatch.setattr(applied, "MOST_REMEMBERED", 1)
    model, data = raft()

    def step_back_and_push():
        with Buoyancy(model, SEA).installed(through="xfrc_applied"):
            mujoco.mj_step(model, data)
            saved = data.xfrc_applied.copy()
            mujoco.mj_step(model, data)
            data.xfrc_applied[:] = saved
            data.xfrc_applied[1] += 1.0

    with pytest.warns(BuoyancyWarning, match=r"^the water stays in data: xfrc_applied holds the"):
        step_back_and_push()


# what is refused ----------------------------------------------------------------------------------


def test_ways_in_that_do_not_exist_or_contradict_are_refused():
    model, _ = raft()
    water = Buoyancy(model, SEA)
    cases = (
        (
            {"through": "xfrc_aplied"},
            r"^through is 'xfrc_aplied'; did you mean 'xfrc_applied'\? possible: qfrc_p",
        ),
        (
            {"through": "xfrc_applied", "native": True},
            "^the water cannot act as compiled code: through='xfrc_applied' is a callback in Pyth",
        ),
        (
            {"through": "xfrc_applied", "copies": True},
            "^copies of a model are known to compiled code alone: through='xfrc_applied' is a",
        ),
    )
    for options, message in cases:
        with pytest.raises(EngineError, match=message), water.installed(**options):
            pass


def test_a_second_water_on_the_same_rows_of_the_world_is_refused():
    model, _ = raft()
    message = (
        "^another water acts through xfrc_applied on this model already, and the two could not "
        "tell their rows apart: let one of them act through qfrc_passive$"
    )
    one, two = Buoyancy(model, bodies=[1]), Buoyancy(model, bodies=[2])
    with (
        one.installed(through="xfrc_applied"),
        pytest.raises(ModelError, match=message),
        two.installed(through="xfrc_applied"),
    ):
        pass


# the command line ---------------------------------------------------------------------------------


def test_a_run_takes_its_water_through_either_array(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    runs = [
        CliRunner().invoke(
            app, ["run", "auv_pool", "--duration", ".1", "--no-record", "--json", *more]
        )
        for more in ([], ["--through", "xfrc_applied"])
    ]
    ends = [[line for line in run.stdout.splitlines() if "final_draft" in line] for run in runs]
    assert ends[0] == ends[1] != []
    wrong = CliRunner().invoke(app, ["run", "auv_pool", "--through", "xfrc_aplied", "--no-record"])
    assert wrong.exit_code == 1
    assert "through is 'xfrc_aplied'; did you mean 'xfrc_applied'?" in wrong.stderr
