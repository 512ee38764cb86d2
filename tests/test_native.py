"""Compiled water: the same as Python's, beside others, in threads, whatever numbers it gets."""

import ctypes
import threading
import types

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mujoco import batch

from buoyancy_mj import Buoyancy, Damping, EngineError, ModelError, RegularWave, Silhouette, Water
from buoyancy_mj.engine import compiled as compiled_water
from buoyancy_mj.engine import layout, library
from buoyancy_mj.kernels import wrenches
from buoyancy_mj.kernels.arrays import gather
from buoyancy_mj.kernels.entries import passive
from buoyancy_mj.kernels.entries.closures import compile_kernel
from buoyancy_mj.kernels.multibody import Bodies, Joints
from buoyancy_mj.kernels.passes import ALIVE
from buoyancy_mj.kernels.paths import PATHS

SEA = Water(
    density=1025.0,
    waves=[RegularWave(0.1, wavelength=6.0), RegularWave(0.03, wavelength=2.0, direction=1.0)],
)
RAFT = """
<mujoco>
  <option timestep="0.004" integrator="{integrator}"/>
  <worldbody>
    <body name="raft" pos="0 0 .05">
      <freejoint/>
      <geom type="box" size=".5 .1 .1" pos="0 .3 0" mass="9"/>
      <geom type="capsule" size=".1 .4" pos="0 -.3 0" euler="0 90 0" mass="9"/>
      <body name="mast" pos="0 0 .2"><geom type="cylinder" size=".03 .3" mass="1"/></body>
      <body name="arm" pos=".5 0 0"><joint axis="0 1 0"/>
        <geom type="ellipsoid" size=".1 .2 .05" mass="2"/>
        <body name="hand" pos=".3 0 0"><joint type="ball"/><geom size=".1" mass="3"/></body>
      </body>
    </body>
    <body name="buoy" pos="2 0 0">
      <joint type="slide" axis="0 0 1"/><geom size=".2" mass="10"/></body>
  </worldbody>
</mujoco>
"""
ENGINE_FUNCTION = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)


def raft(integrator="implicitfast"):
    model = mujoco.MjModel.from_xml_string(RAFT.format(integrator=integrator))
    data = mujoco.MjData(model)
    data.qvel[:] = np.linspace(-0.5, 0.5, model.nv)
    return model, data


def state(data):
    return np.r_[data.qpos, data.qvel]


def after(count, compiled, integrator="implicitfast", push=None, **options):
    model, data = raft(integrator)
    with Buoyancy(model, SEA, **options).installed(native=compiled):
        for step in range(count):
            if push:
                push(data, step)
            mujoco.mj_step(model, data)
    return state(data)


# the same as in Python ----------------------------------------------------------------------------


@pytest.mark.parametrize("integrator", ["Euler", "RK4", "implicit", "implicitfast", "discrete"])
def test_it_moves_bodies_as_the_python_callback_does(integrator):
    assert after(200, True, integrator) == pytest.approx(
        after(200, False, integrator), rel=0, abs=1e-12
    )


@pytest.mark.parametrize("method", ["sections", "convex_hull"])
def test_other_methods_act_the_same(method):
    assert np.array_equal(after(20, True, method=method), after(20, False, method=method))


def test_forces_of_the_user_are_neither_lost_nor_doubled():
    def push(data, _step):
        data.xfrc_applied[1] = [5.0, 3.0, 10.0, 1.0, 0.5, 0.2]
        data.xfrc_applied[3] += [0.0, 0.0, 0.01, 0.0, 0.0, 0.0]

    ends = [after(100, compiled, "RK4", push) for compiled in (True, False)]
    assert ends[0] == pytest.approx(ends[1], rel=0, abs=1e-12)
    assert np.abs(ends[0] - after(100, True, "RK4")).max() > 0.01


def test_it_is_the_default():
    model, _ = raft()
    with Buoyancy(model).installed():
        assert hasattr(mujoco.get_mjcb_passive(), "argtypes")
    assert mujoco.get_mjcb_passive() is None


def test_a_wrench_becomes_the_generalized_force_that_the_engine_makes_of_it():
    model, data = raft()
    data.qpos[:] += np.linspace(-0.2, 0.3, model.nq)
    mujoco.mj_forward(model, data)
    wrench = np.random.default_rng(0).normal(size=(model.nbody, 6))
    ours, theirs = np.zeros((2, model.nv))
    bodies = np.arange(model.nbody)
    structs = {"mjModel": model, "mjData": data}
    wrenches.project(wrench, bodies, gather(Bodies, structs), gather(Joints, structs), ours)
    for body in bodies:
        mujoco.mj_applyFT(
            model, data, wrench[body, :3], wrench[body, 3:], data.xipos[body], body, theirs
        )
    assert ours == pytest.approx(theirs, rel=1e-12, abs=1e-12)


# loads after a step -------------------------------------------------------------------------------


@pytest.mark.parametrize("compiled", [True, False])
def test_the_loads_of_the_last_pass_stay_readable(compiled):
    model, data = raft("Euler")
    buoyancy = Buoyancy(model, SEA)
    with buoyancy.installed(native=compiled):
        for _ in range(10):
            mujoco.mj_step(model, data)
    loads = buoyancy.loads(data)
    # Euler's only pass saw these poses, at the time before the step
    seen = mujoco.MjData(model)
    seen.time, seen.qpos[:], seen.qvel[:] = data.time - 0.004, data.qpos, data.qvel
    mujoco.mj_forward(model, seen)
    for name in ("xpos", "xmat", "xipos", "ximat", "geom_xpos", "geom_xmat", "cvel", "subtree_com"):
        getattr(seen, name)[:] = getattr(data, name)
    again = buoyancy.evaluate(seen)
    for cause in ("buoyancy", "drag"):
        assert loads.by_cause[cause] == pytest.approx(again.by_cause[cause], rel=1e-12, abs=1e-12)
    assert loads.hull.volume == pytest.approx(again.hull.volume)
    assert loads.total.torque == pytest.approx(again.total.torque)


def test_loads_of_data_that_nothing_acted_on_are_refused():
    model, data = raft()
    buoyancy = Buoyancy(model)
    with pytest.raises(
        EngineError,
        match="this water has not acted on these data at their time, 0 s; step them while it acts",
    ):
        buoyancy.loads(data)
    with buoyancy.installed():
        mujoco.mj_forward(model, data)
    buoyancy.loads(data)
    with pytest.raises(EngineError):
        buoyancy.loads(mujoco.MjData(model))


# beside others ------------------------------------------------------------------------------------


def test_several_waters_act_each_on_its_own_model():
    scenes = [(*raft(), Water(density=density)) for density in (600.0, 1000.0, 1400.0)]
    waters = [Buoyancy(model, water) for model, _, water in scenes]
    with waters[0].installed(), waters[1].installed(), waters[2].installed():
        for _ in range(50):
            for model, data, _ in scenes:
                mujoco.mj_step(model, data)
    for (model, data, _), water in zip(scenes, waters, strict=True):
        alone = mujoco.MjData(model)
        alone.qvel[:] = np.linspace(-0.5, 0.5, model.nv)
        with water.installed():
            for _ in range(50):
                mujoco.mj_step(model, alone)
        assert np.array_equal(state(data), state(alone))


def test_installed_around_another_and_again_inside_it_acts_once():
    (model, data), (other, _) = raft(), raft()
    one, two = Buoyancy(model, damping=None), Buoyancy(other)
    with one.installed():
        mujoco.mj_forward(model, data)
        once = data.qfrc_passive.copy()
        with two.installed(), one.installed():
            mujoco.mj_forward(model, data)
            assert np.array_equal(data.qfrc_passive, once)
            one(model, data)
            assert np.array_equal(data.qfrc_passive, once)


def test_a_callback_in_c_still_runs_first_and_comes_back():
    model, data = raft()
    seen = []
    theirs = ENGINE_FUNCTION(lambda m, d: seen.append((m, d)))
    mujoco.set_mjcb_passive(theirs)
    try:
        with Buoyancy(model).installed(native=True):
            mujoco.mj_forward(model, data)
        assert seen == [(model._address, data._address)]
        assert mujoco.get_mjcb_passive() is theirs
    finally:
        mujoco.set_mjcb_passive(None)


def test_beside_a_callback_in_python_it_acts_in_python():
    model, data = raft()
    seen = []
    mujoco.set_mjcb_passive(lambda _model, data: seen.append(data))
    try:
        buoyancy = Buoyancy(model)
        with pytest.raises(  # noqa: SIM117
            EngineError, match="cannot act as compiled code: a callback in Python is installed"
        ):
            with buoyancy.installed(native=True):
                pass
        with buoyancy.installed():
            mujoco.mj_forward(model, data)
        assert len(seen) == 1
        assert buoyancy.loads(data).total.volume > 0.0
    finally:
        mujoco.set_mjcb_passive(None)


def test_inverse_dynamics_sees_the_water():
    model, data = raft()
    with Buoyancy(model, SEA).installed():
        mujoco.mj_forward(model, data)
        mujoco.mj_inverse(model, data)
    assert data.qfrc_inverse == pytest.approx(0.0, abs=1e-8)


# copies and threads -------------------------------------------------------------------------------


def test_a_batch_of_copies_moves_as_single_simulations_at_any_number_of_threads():
    model, _ = raft()
    heights = np.linspace(-0.2, 0.3, 6)
    ends = []
    with Buoyancy(model, SEA).installed(copies=True):
        for threads in (1, 2):
            many = batch.Batch(model, len(heights), nthread=threads)
            many.bind("qpos")[:, 2] += heights
            many.step(nstep=100)
            ends.append(many.bind("qpos").copy())
        for height, end in zip(heights, ends[0], strict=True):
            data = mujoco.MjData(model)
            data.qpos[2] += height
            for _ in range(100):
                mujoco.mj_step(model, data)
            assert np.array_equal(data.qpos, end)
    assert np.array_equal(*ends)


def test_without_being_asked_it_leaves_copies_alone():
    model, _ = raft()
    with Buoyancy(model).installed():
        many = batch.Batch(model, 1)
        many.step()
        assert many.bind("qfrc_passive")[0] == pytest.approx(0.0)
    message = "copies of a model are known to compiled code alone"
    with pytest.raises(EngineError, match=message):  # noqa: SIM117
        with Buoyancy(model).installed(native=False, copies=True):
            pass


def test_threads_step_side_by_side():
    model, _ = raft()
    many = [mujoco.MjData(model) for _ in range(8)]

    def run(data):
        for _ in range(100):
            mujoco.mj_step(model, data)

    with Buoyancy(model, SEA).installed(native=True):
        threads = [threading.Thread(target=run, args=(data,)) for data in many]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        alone = mujoco.MjData(model)
        run(alone)
    assert all(np.array_equal(state(data), state(alone)) for data in many)


def test_more_threads_than_there_is_room_for_take_turns(monkeypatch):
    monkeypatch.setattr(compiled_water, "THREADS", 1)
    test_threads_step_side_by_side()


# whatever numbers ---------------------------------------------------------------------------------


def test_a_pose_that_is_no_number_gives_loads_that_are_none_and_the_engines_own_warning():
    model, data = raft("Euler")
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)
    buoyancy = Buoyancy(model, SEA)
    with buoyancy.installed(native=True):
        data.qpos[0] = np.nan
        mujoco.mj_step(model, data)
    assert data.warning[mujoco.mjtWarning.mjWARN_BADQPOS].number == 1
    assert np.isnan(buoyancy.loads(data).body.force[1]).all() or np.isnan(
        buoyancy.loads(data).body.volume[1]
    )


@settings(max_examples=60)
@given(
    numbers=st.lists(
        st.floats(allow_nan=True, allow_infinity=True, width=64), min_size=14, max_size=14
    ),
    time=st.floats(allow_nan=True, allow_infinity=True),
)
def test_no_pose_and_no_time_makes_it_hang_or_read_elsewhere(numbers, time):
    model, buoyancy = _fuzzed()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    for name in ("geom_xpos", "geom_xmat", "xipos", "cvel", "subtree_com"):
        flat = getattr(data, name).reshape(-1)
        flat[: len(numbers)] = numbers[: flat.size]
    data.time = time
    record = buoyancy.compiled.record(model._address)
    function = ctypes.CFUNCTYPE(ctypes.c_int64, *[ctypes.c_int64] * 4)(
        compile_kernel(passive.act).address
    )
    assert function(model._address, data._address, buoyancy.compiled.address, record.address) == 0
    record.arrays.ids[ALIVE] = 0
    assert not (record.arrays.wet[:, 0] > buoyancy.packed.volumes * (1.0 + 1e-9)).any()


def _fuzzed(made=[]):  # noqa: B006
    if not made:
        model, _ = raft()
        made.append((model, Buoyancy(model, SEA)))
    return made[0]


def test_gravity_that_is_turned_sideways_while_it_runs_is_an_error_of_the_engine():
    model, data = raft()
    with Buoyancy(model).installed(native=True):
        model.opt.gravity[0] = 1.0
        with pytest.raises(
            mujoco.FatalError, match=r"gravity is not along -z, and water needs it so: set <option"
        ):
            mujoco.mj_forward(model, data)
        model.opt.gravity[0] = 0.0
        mujoco.mj_forward(model, data)


def test_masses_timestep_and_gravity_are_read_in_each_pass():
    # a regular wave would take its length or its frequency from gravity as the water is made
    water = Water(density=1025.0, waves=types.SimpleNamespace(rows=SEA.rows[:, :6]))

    def end(change_after_construction):
        model, data = raft("Euler")
        buoyancy = (
            None
            if not change_after_construction
            else Buoyancy(model, water, damping=Damping(viscous=Silhouette(coefficient=100.0)))
        )
        model.body_mass[:] *= 0.5
        model.body_inertia[:] *= 0.5
        model.opt.timestep = 0.01
        model.opt.gravity[2] = -5.0
        mujoco.mj_setConst(model, data)
        # linear damping is estimated from gravity
        buoyancy = buoyancy or Buoyancy(
            model, water, damping=Damping(viscous=Silhouette(coefficient=100.0))
        )
        buoyancy._acting.load_model.arrays.damping.linear[:] = 1.0
        with buoyancy.installed(native=True):
            for _ in range(50):
                mujoco.mj_step(model, data)
        return state(data)

    assert np.array_equal(end(True), end(False))


# the engine's inside ------------------------------------------------------------------------------


def test_the_engine_keeps_its_numbers_where_they_are_looked_for():
    layout.verify(PATHS)
    assert compiled_water.require_known_layout() is None


def test_an_engine_that_keeps_them_elsewhere_is_refused_and_served_in_python(monkeypatch):
    right = layout.offset
    compiled_water.require_known_layout.cache_clear()
    monkeypatch.setattr(layout, "offset", lambda path: right(path) + 8 * (path == "mjData.cdof"))
    try:
        model, data = raft()
        buoyancy = Buoyancy(model)
        with pytest.raises(
            EngineError,
            match=r"MuJoCo 4.* does not keep mjData.cdof at byte \d+, as it says itself",
        ):
            compiled_water.require_known_layout()
        with buoyancy.installed():
            assert not hasattr(mujoco.get_mjcb_passive(), "argtypes")
            mujoco.mj_forward(model, data)
        with (
            pytest.raises(EngineError, match="cannot act as compiled code"),
            buoyancy.installed(native=True),
        ):
            pass
    finally:
        compiled_water.require_known_layout.cache_clear()


def test_fields_and_functions_that_the_engine_lacks_are_told():
    with pytest.raises(
        EngineError, match=r"has no mjData.wetness; the water then acts through Python alone"
    ):
        layout.offset("mjData.wetness")
    with pytest.raises(EngineError, match=r"has no function mj_swim"):
        library.symbol("mj_swim")


def test_where_passive_forces_are_skipped_it_is_lent_as_a_control_callback():
    model, data = raft()
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_SPRING) | int(
        mujoco.mjtDisableBit.mjDSBL_DAMPER
    )
    buoyancy = Buoyancy(model)
    with buoyancy.installed():
        assert mujoco.get_mjcb_control() is not None
        mujoco.mj_forward(model, data)
    assert buoyancy.loads(data).total.force[2] > 0.0
    with (
        pytest.raises(EngineError, match="disables springs and dampers"),
        buoyancy.installed(native=True),
    ):
        pass
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_ACTUATION)
    with pytest.raises(ModelError, match="disables actuation"), buoyancy.installed():
        pass
