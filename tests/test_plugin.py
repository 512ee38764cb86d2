"""The water as an engine plugin: its settings, files, copies, batches, rollouts and its life."""

import copy
import dataclasses
import gc
import subprocess
import sys
import threading

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mujoco import batch, rollout

from buoyancy_mj import (
    Buoyancy,
    BuoyancyWarning,
    ConvexHull,
    Damping,
    EngineError,
    Exact,
    JonswapSea,
    LevelOscillation,
    MeshError,
    MethodError,
    ModelError,
    PiersonMoskowitzSea,
    RegularWave,
    Scene,
    Sections,
    Selection,
    Silhouette,
    Simulation,
    Water,
    WaterError,
    add_water,
    water_in,
)
from buoyancy_mj.engine import waters
from buoyancy_mj.engine.instances import PLUGIN
from buoyancy_mj.settings.config import parse_plugin_config, write_plugin_config
from buoyancy_mj.settings.settings import Settings

SEA = Water(
    density=1025.0,
    level=0.1,
    waves=[RegularWave(0.1, wavelength=6.0, direction=0.3), LevelOscillation(0.05, 0.5)],
)
PLAIN = """<mujoco><option timestep="0.004"/><worldbody>
  <body name="one"><freejoint/><geom type="box" size=".3 .2 .1" mass="12"/></body>
  <body name="two" pos="0 3 0"><freejoint/><geom size=".2" mass="10"/>
    <body name="lid" pos="0 0 .3"><geom type="box" size=".1 .1 .02" mass=".1"/></body></body>
</worldbody></mujoco>"""


def mjcf(instances, one="", two="", lid="", option=""):
    """A model of two bodies whose file declares the plugin."""
    return f"""<mujoco><option timestep="0.004">{option}</option>
    <extension><plugin plugin="{PLUGIN}">{instances}</plugin></extension>
    <worldbody>
      <body name="one"><freejoint/>
        <geom name="hull" type="box" size=".3 .2 .1" mass="12"/>{one}</body>
      <body name="two" pos="0 3 0"><freejoint/><geom size=".2" mass="10"/>{two}
        <body name="lid" pos="0 0 .3"><geom type="box" size=".1 .1 .02" mass=".1"/>{lid}</body>
      </body>
    </worldbody></mujoco>"""


def sea(name="sea", **config):
    entries = "".join(f'<config key="{key}" value="{value}"/>' for key, value in config.items())
    return f'<instance name="{name}">{entries}</instance>'


def compiled(*args, **kwargs):
    return mujoco.MjModel.from_xml_string(mjcf(*args, **kwargs))


def with_water(water=SEA, **options):
    spec = mujoco.MjSpec.from_string(PLAIN)
    add_water(spec, water, **options)
    return spec.compile()


def stepped(model, count=100, data=None):
    data = data or mujoco.MjData(model)
    for _ in range(count):
        mujoco.mj_step(model, data)
    return data


def wet_bodies(model):
    return {model.body(b).name for name in names(model) for b in water_in(model, name).bodies}


def names(model):
    return [mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_PLUGIN, i) for i in range(model.nplugin)]


# what it does -------------------------------------------------------------------------------------


@pytest.mark.parametrize("integrator", ["Euler", "RK4", "implicitfast"])
@pytest.mark.parametrize("method", ["exact", "sections"])
def test_a_model_with_water_in_it_moves_as_under_the_callback(integrator, method):
    wet, dry = with_water(method=method), mujoco.MjModel.from_xml_string(PLAIN)
    ends = []
    for model in (wet, dry):
        model.opt.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator.upper()}")
    ends.append(stepped(wet).qpos)
    with Buoyancy(dry, SEA, method=method).installed(native=False):
        ends.append(stepped(dry).qpos)
    assert ends[0] == pytest.approx(ends[1], rel=0, abs=1e-12)


def test_all_moving_bodies_are_in_the_water_when_none_joins_it():
    assert wet_bodies(compiled(sea())) == {"one", "two"}
    assert len(water_in(compiled(sea())).hulls) == 3


def test_bodies_join_the_instance_they_name_and_take_along_what_is_welded_to_them():
    model = compiled(sea(), two='<plugin instance="sea"/>')
    assert {hull.body for hull in water_in(model).hulls} == {model.body("two").id}
    assert len(water_in(model).hulls) == 2
    assert stepped(model).body("one").xpos[2] < -0.5


def test_several_instances_have_different_waters():
    model = compiled(
        sea("salt", density=2000, damping="false") + sea("oil", density=900, damping="false"),
        two='<plugin instance="oil"/>',
    )
    data = mujoco.MjData(model)
    data.qpos[[2, 9]] = -2.0
    mujoco.mj_forward(model, data)
    salt, oil = (water_in(model, name).loads(data) for name in ("salt", "oil"))
    assert salt.total.force[2] == pytest.approx(2000 * 9.81 * 0.048)
    assert oil.body.force[2, 2] == pytest.approx(900 * 9.81 * (4 / 3 * np.pi * 0.008 + 0.0016))
    assert oil.body.force[1, 2] == salt.body.force[2, 2] == 0.0


def test_inverse_dynamics_and_finite_differences_see_it():
    model = with_water()
    data = stepped(model, 10)
    mujoco.mj_forward(model, data)
    mujoco.mj_inverse(model, data)
    assert data.qfrc_inverse == pytest.approx(0.0, abs=1e-8)


def test_actuation_may_be_disabled():
    data = stepped(compiled(sea(), option='<flag actuation="disable"/>'), 1000)
    assert abs(data.qpos[2]) < 0.2


def test_a_second_water_by_callback_is_refused():
    with pytest.raises(  # noqa: SIM117
        ModelError, match=r"brings its own water, as the plugin 'buoyancy_mj.water', and a callback"
    ):
        with Buoyancy(with_water()).installed():
            pass


def test_the_water_of_an_unknown_instance_is_refused():
    with pytest.raises(ModelError, match="the model has no water named 'see'; did you mean 'sea'"):
        water_in(with_water(), "see")
    with pytest.raises(ModelError, match=r"the model has no water of its own: add_water"):
        water_in(mujoco.MjModel.from_xml_string(PLAIN))


# its configuration --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("config", "message"),
    [
        ({"density": "thick"}, "density is 'thick'; needed is a number"),
        ({"density": "-1"}, "density is -1.0; it must be above 0"),
        ({"level": "nan"}, "level is nan"),
        ({"current": "1 2"}, r"current is \[1, 2\]; needed is a list of 3 numbers"),
        (
            {"waves": "huge amplitude=1"},
            "unknown kind 'huge'; possible: jonswap, level, pierson-moskowitz, regular",
        ),
        (
            {"waves": "regular amplitude=1"},
            "a regular wave got none; give exactly one of frequency",
        ),
        (
            {"waves": "regular amplitude=1 frequency"},
            "key=value pairs between blanks, not 'frequency'",
        ),
        ({"waves": "regular height=1 frequency=1"}, "unknown key 'height'"),
        ({"method": "exat"}, "unknown kind 'exat'; did you mean 'exact'"),
        ({"method": "sections rule=guess"}, "rule is 'guess'"),
        (
            {"damping": "coefficient=-2"},
            r"coefficient is -2.0; it must be at least 0 and at most 1e\+06",
        ),
        ({"damping": "much"}, "damping: unknown kind 'much'; possible: none, panels, silhouette"),
        ({"geoms": "keel*"}, r"no moving geom matches 'keel\*'; possible: .*hull"),
        ({"salt": "1"}, "unrecognized attribute 'plugin:salt'"),
    ],
)
def test_bad_configuration_is_a_compile_error_that_names_the_key(config, message):
    with pytest.raises(ValueError, match=message):
        compiled(sea(**config))


def test_a_model_whose_passive_forces_are_skipped_is_a_compile_error():
    with pytest.raises(
        ValueError, match="disables springs and dampers, and MuJoCo then skips the passive forces"
    ):
        compiled(sea(), option='<flag spring="disable" damper="disable"/>')


def test_a_model_that_sleeps_gets_no_data(tmp_path):
    # MuJoCo's compiler sees the model without that flag
    model = compiled(sea(), option='<flag sleep="enable"/>')
    with pytest.raises(mujoco.FatalError, match="lets bodies at rest sleep"):
        mujoco.MjData(model)
    text = PLAIN.replace('<option timestep="0.004"/>', '<option><flag sleep="enable"/></option>')
    with pytest.raises(ModelError, match="lets bodies at rest sleep"):
        Simulation(scene_of(tmp_path, text))


FRAME = st.sampled_from(["earth", "water"])
WAVE = st.one_of(
    st.builds(
        RegularWave,
        st.floats(0.0, 0.02),
        frequency=st.floats(0.05, 5.0),
        direction=st.floats(-4, 4),
        phase=st.floats(-9, 9),
        depth=st.sampled_from([np.inf, 3.0, 10.1]),
        frame=FRAME,
    ),
    st.builds(RegularWave, st.floats(0.0, 0.05), wavelength=st.floats(0.1, 500.0)),
    st.builds(RegularWave, st.floats(0.0, 0.01), period=st.floats(0.2, 30.0), depth=st.just(7.0)),
    st.builds(LevelOscillation, st.floats(0.0, 2.0), st.floats(0.05, 5.0), st.floats(-4, 4)),
    st.builds(
        JonswapSea,
        st.floats(0.0, 0.3),
        st.floats(0.5, 30.0),
        gamma=st.floats(1.0, 7.0),
        seed=st.integers(0, 2**63 - 1),
        spreading=st.sampled_from([np.inf, 4.5]),
        frame=FRAME,
    ),
    st.builds(PiersonMoskowitzSea, st.floats(0.1, 5.0), components=st.integers(1, 9), frame=FRAME),
)
METHOD = st.sampled_from(
    [
        Exact(),
        ConvexHull(),
        ConvexHull(cut=True, centroid="hull", resort_every=0),
        Sections(),
        Sections(step=0.01, axis=(0, 0.6, 0.8), rule="simpson"),
    ]
)


@given(
    waves=st.lists(WAVE, max_size=3),
    density=st.floats(1.0, 2000.0),
    level=st.floats(-10, 10),
    # so weak that it blocks none of these waves, and makes none steeper than waves can be
    current=st.tuples(*[st.floats(-0.03, 0.03)] * 3),
    method=METHOD,
    damping=st.sampled_from([None, Damping(), Damping(viscous=Silhouette(coefficient=0.7))]),
    geoms=st.sampled_from([None, ("hull*", "group:2")]),
)
def test_what_is_written_into_a_model_is_read_back_to_the_last_bit(
    waves, density, level, current, method, damping, geoms
):
    water = Water(density=density, level=level, waves=waves, current=current)
    written = Settings(
        water=water, method=method, damping=damping, selection=Selection(geoms=geoms)
    )
    read = parse_plugin_config(write_plugin_config(written), "here")
    assert np.array_equal(read.water.rows, water.rows)
    assert dataclasses.replace(read, water=water) == written
    assert (read.water.density, read.water.level, read.water.current) == (density, level, current)


def test_waves_and_methods_that_a_model_cannot_hold_are_refused():
    class Swell:
        rows = np.array([[0.0, 0.0, 0.0, 0.0, 0.0, np.inf]])

    class Guess(Exact):
        pass

    with pytest.raises(
        WaterError,
        match="cannot be written into a model; "
        "possible are regular, jonswap, pierson-moskowitz, level",
    ):
        with_water(Water(waves=Swell()))
    with pytest.raises(
        MethodError,
        match="cannot be written into a model; possible are exact, convex_hull, sections",
    ):
        with_water(method=Guess())
    spec = mujoco.MjSpec.from_string(mjcf(sea()))
    with pytest.raises(
        ModelError,
        match=r"already has a plugin instance 'sea'; give the water another name \(instance=\)",
    ):
        add_water(spec)


# files --------------------------------------------------------------------------------------------


def test_a_saved_model_keeps_its_water(tmp_path):
    spec = mujoco.MjSpec.from_string(PLAIN)
    add_water(
        spec, SEA, method=Sections(step=0.02), damping=Damping(viscous=Silhouette(coefficient=0.8))
    )
    model = spec.compile()
    end = stepped(model).qpos
    path = tmp_path / "floating.xml"
    path.write_text(spec.to_xml())
    assert np.array_equal(stepped(mujoco.MjModel.from_xml_path(str(path))).qpos, end)
    mujoco.mj_saveModel(model, str(tmp_path / "floating.mjb"))
    assert np.array_equal(
        stepped(mujoco.MjModel.from_binary_path(str(tmp_path / "floating.mjb"))).qpos, end
    )
    mujoco.mj_saveLastXML(str(tmp_path / "last.xml"), mujoco.MjModel.from_xml_path(str(path)))
    assert np.array_equal(
        stepped(mujoco.MjModel.from_xml_path(str(tmp_path / "last.xml"))).qpos, end
    )


def test_without_this_package_mujoco_says_what_is_missing(tmp_path):
    path = tmp_path / "floating.xml"
    path.write_text(mjcf(sea()))
    # MuJoCo finds no plugins that are installed
    code = (
        "import importlib.metadata as installed; installed.entry_points = lambda **_: ()\n"
        f"import mujoco; mujoco.MjModel.from_xml_path({str(path)!r})"
    )
    said = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
    )
    assert "buoyancy_mj.water" in said.stderr
    assert said.returncode == 1


# copies, resets, other models ---------------------------------------------------------------------


def test_copied_data_go_on_as_the_original_and_keep_their_loads():
    model = with_water()
    data = stepped(model, 20)
    twin = copy.copy(data)
    water = water_in(model)
    assert np.array_equal(water.loads(twin).xfrc, water.loads(data).xfrc)
    assert np.array_equal(stepped(model, 20, twin).qpos, stepped(model, 20, data).qpos)
    again = mujoco.MjData(model)
    mujoco.mj_copyData(again, model, data)
    assert np.array_equal(stepped(model, 20, again).qpos, stepped(model, 20, data).qpos)


def test_reset_data_start_afresh():
    model = with_water()
    data = stepped(model, 20)
    end = data.qpos.copy()
    mujoco.mj_resetData(model, data)
    with pytest.raises(EngineError, match="this water has not acted on these data"):
        water_in(model).loads(data)
    assert np.array_equal(stepped(model, 20, data).qpos, end)


def test_saved_states_carry_no_water():
    model = with_water()
    data = stepped(model, 20)
    kept = np.zeros(mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_INTEGRATION))
    mujoco.mj_getState(model, data, kept, mujoco.mjtState.mjSTATE_INTEGRATION)
    end = stepped(model, 20, data).qpos.copy()
    other = stepped(model, 3)
    mujoco.mj_setState(model, other, kept, mujoco.mjtState.mjSTATE_INTEGRATION)
    assert np.array_equal(stepped(model, 20, other).qpos, end)


def test_what_fails_in_a_thread_of_the_engine_is_its_error():
    model = with_water()
    many = batch.Batch(model, 4, nthread=2)
    many.expand("geom_size")[1] *= 0.0
    with pytest.raises(batch.SimulationError, match="encloses 0 m"):
        many.forward()
    assert many.error(0) == ""


def test_data_stepped_with_another_model_are_in_its_water():
    models = [with_water(Water(density=density)) for density in (900.0, 1200.0)]
    shared, ends = mujoco.MjData(models[0]), []
    for model in (*models, models[0]):
        mujoco.mj_resetData(model, shared)
        ends.append(stepped(model, 50, shared).qpos.copy())
    alone = [stepped(model, 50).qpos for model in models]
    assert np.array_equal(ends, [*alone, alone[0]])


def test_models_of_one_hull_with_other_joints_have_waters_of_their_own():
    def made(joint, timestep):
        spec = mujoco.MjSpec.from_string(
            f"""<mujoco><option timestep="{timestep}"/><worldbody><body pos="0 0 -1">{joint}
            <geom type="box" size=".2 .15 .1" pos="0 0 .01" mass="6"/></body></worldbody>
            </mujoco>"""
        )
        dry = spec.compile()
        add_water(spec, SEA, added_mass="estimate")
        return spec.compile(), Buoyancy(dry, SEA, added_mass="estimate")

    for joint, timestep in (
        ('<joint type="slide" axis="0 0 1"/>', 0.002),
        ("<freejoint/>", 0.002),
        ("<freejoint/>", 0.01),
    ):
        model, water = made(joint, timestep)
        data, dry = stepped(model, 1), mujoco.MjData(water.model)
        with water.installed():
            mujoco.mj_step(water.model, dry)
        assert data.qacc == pytest.approx(dry.qacc, rel=1e-12, abs=1e-12)
        assert water_in(model).loads(data).xfrc == pytest.approx(water.loads(dry).xfrc)


def test_geoms_that_are_resized_in_place_displace_what_they_are_then():
    model = with_water(Water(), damping=None)
    data = mujoco.MjData(model)
    data.qpos[2] = -3.0
    mujoco.mj_forward(model, data)
    small = data.qfrc_passive[2]
    model.geom_size[0] *= 2.0
    mujoco.mj_forward(model, data)
    assert data.qfrc_passive[2] == pytest.approx(8.0 * small)


# batches and rollouts -----------------------------------------------------------------------------


HEIGHTS = np.linspace(-0.5, 0.5, 7)


def alone(model, height, count=60):
    data = mujoco.MjData(model)
    data.qpos[2] += height
    return stepped(model, count, data).qpos


@pytest.mark.parametrize("persistent", [False, True])
def test_a_batch_moves_as_single_simulations_at_any_number_of_threads(persistent):
    model = with_water()
    single = [alone(model, height) for height in HEIGHTS]
    for threads in (1, 2, 3):
        many = batch.Batch(model, len(HEIGHTS), nthread=threads, persistent=persistent)
        many.bind("qpos")[:, 2] += HEIGHTS
        many.step(nstep=60)
        assert np.array_equal(many.bind("qpos"), single)


def test_a_batch_of_models_has_the_water_of_each():
    models = [with_water(Water(density=1000.0 + 100.0 * i)) for i in range(3)]
    many = batch.Batch(models[0], 6, nthread=2)
    many.set_models(models * 2)
    for _ in range(20):
        many.step(nstep=3)
    assert np.array_equal(many.bind("qpos"), [alone(model, 0.0) for model in models * 2])


def test_a_batch_with_masses_of_their_own_moves_as_models_with_those_masses():
    model = with_water()
    factors = np.array([0.8, 1.0, 1.5, 2.0])
    for threads in (1, 2):
        many = batch.Batch(model, 4, nthread=threads)
        many.expand("body_mass")[:] *= factors[:, None]
        many.expand("body_inertia")[:] *= factors[:, None, None]
        many.set_const()
        many.step(nstep=60)
        for factor, end in zip(factors, many.bind("qpos"), strict=True):
            own = with_water()
            own.body_mass[:] *= factor
            own.body_inertia[:] *= factor
            mujoco.mj_setConst(own, mujoco.MjData(own))
            assert np.array_equal(alone(own, 0.0), end)


def test_a_batch_with_geoms_of_their_own_displaces_what_each_has():
    spec = mujoco.MjSpec.from_string(PLAIN)
    spec.delete(spec.body("lid"))
    add_water(spec, damping=None)
    model = spec.compile()
    many = batch.Batch(model, 3, nthread=2)
    many.expand("geom_size")[:] *= np.array([1.0, 1.5, 2.0])[:, None, None]
    many.bind("qpos")[:, 2] = -5.0
    force = many.bind("qfrc_passive")
    many.forward()
    assert force[:, 2] == pytest.approx(force[0, 2] * np.array([1.0, 1.5, 2.0]) ** 3)


def test_a_rollout_moves_as_single_simulations():
    model = with_water()
    spec = mujoco.mjtState.mjSTATE_FULLPHYSICS
    starts = np.zeros((len(HEIGHTS), mujoco.mj_stateSize(model, spec)))
    for height, start in zip(HEIGHTS, starts, strict=True):
        data = mujoco.MjData(model)
        data.qpos[2] += height
        mujoco.mj_getState(model, data, start, spec)
    single = [alone(model, height) for height in HEIGHTS]
    for threads in (1, 2):
        states, _ = rollout.rollout(
            model, [mujoco.MjData(model) for _ in range(threads)], starts, nstep=60
        )
        assert np.array_equal(states[:, -1, 1 : 1 + model.nq], single)


# its life -----------------------------------------------------------------------------------------


@pytest.mark.long
@pytest.mark.slow
def test_five_thousand_data_leave_nothing_behind():
    model = with_water()
    water = water_in(model).compiled
    data = [mujoco.MjData(model) for _ in range(50)]
    del data
    gc.collect()
    room = resident()
    for _ in range(5_000):
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        del data
    gc.collect()
    assert len(water._records) < 64
    assert resident() - room < 2e6


def resident():
    """Memory of this process [bytes]."""
    resource = pytest.importorskip("resource")
    try:
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * resource.getpagesize()
    except FileNotFoundError:
        pytest.skip("needs /proc")


def test_records_of_freed_data_serve_again_and_those_in_use_stay():
    model = with_water()
    kept = [stepped(model, 1) for _ in range(40)]
    forces = [water_in(model).loads(data).xfrc for data in kept]
    for _ in range(200):
        mujoco.MjData(model)
    assert all(
        np.array_equal(water_in(model).loads(d).xfrc, f) for d, f in zip(kept, forces, strict=True)
    )


def test_waters_that_no_data_use_are_forgotten_in_the_end(monkeypatch):
    monkeypatch.setattr(waters, "MOST_UNUSED", 4)
    for i in range(waters.MOST_UNUSED + 10):
        with_water(Water(density=1.0 + i))
    gc.collect()
    # other tests of this process may have data alive
    unused = [one for one in waters._waters.values() if not one.compiled.used]
    assert len(unused) <= waters.MOST_UNUSED + 3


def test_threads_make_step_and_free_data_at_once():
    models = [with_water(Water(density=900.0 + i)) for i in range(3)]
    ends = {}

    def live(number):
        for _ in range(15):
            ends[number] = stepped(models[number % 3], 20).qpos.copy()

    threads = [threading.Thread(target=live, args=(number,)) for number in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for number, end in ends.items():
        assert np.array_equal(end, stepped(models[number % 3], 20).qpos)


def test_an_interpreter_that_ends_with_data_alive_ends_well():
    code = f"""
import mujoco
from mujoco import batch
from buoyancy_mj import add_water
spec = mujoco.MjSpec.from_string('''{PLAIN}''')
add_water(spec)
model = spec.compile()
data = [mujoco.MjData(model) for _ in range(3)]
many = batch.Batch(model, 4, nthread=2)
many.step()
mujoco.mj_step(model, data[0])
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    told = [line for line in done.stderr.splitlines() if "compiling what is used" not in line]
    assert (done.returncode, told) == (0, [])


def test_a_failed_compilation_leaves_the_next_one_unharmed():
    for _ in range(3):
        with pytest.raises(ValueError, match="density"):
            compiled(sea(density="x"))
        assert stepped(compiled(sea()), 10).time > 0.0


# scenes -------------------------------------------------------------------------------------------


def scene_of(tmp_path, text, **fields):
    path = tmp_path / "vehicle.xml"
    path.write_text(text)
    return Scene(title="a vehicle", vehicle=str(path), duration=0.2, **fields)


def test_a_scene_has_its_water_in_the_model(tmp_path):
    simulation = Simulation(scene_of(tmp_path, PLAIN, water=SEA))
    assert names(simulation.model) == ["sea"]
    frames = list(simulation.frames())
    assert frames[-1].loads.total.force[2] > 0.0
    assert mujoco.get_mjcb_passive() is None


def test_the_scenes_water_takes_the_place_of_the_vehicles_own(tmp_path):
    text = mjcf(sea("own", density=5000), one='<plugin instance="own"/>')
    with pytest.warns(
        BuoyancyWarning, match="the water 'own' of the model gives way to the scene's"
    ):
        simulation = Simulation(scene_of(tmp_path, text, water=Water(density=1234.0)))
    assert names(simulation.model) == ["sea"]
    assert water_in(simulation.model).water.density == 1234.0
    assert len(simulation.buoyancy.hulls) == 3


def test_a_scene_runs_where_passive_forces_are_skipped(tmp_path):
    text = PLAIN.replace(
        '<option timestep="0.004"/>', '<option><flag spring="disable" damper="disable"/></option>'
    )
    simulation = Simulation(scene_of(tmp_path, text))
    assert names(simulation.model) == []
    assert list(simulation.frames())[-1].loads.total.force[2] > 0.0


def test_a_scene_raises_the_errors_of_its_water(tmp_path):
    with pytest.raises(ModelError, match="no moving geom matches 'nothing'"):
        Simulation(scene_of(tmp_path, PLAIN, selection=Selection(geoms="nothing")))
    open_box = """<mujoco><asset>
    <mesh name="m" inertia="shell" vertex="0 0 0 1 0 0 0 1 0 0 0 1"
      face="0 2 1 0 1 3 0 3 2"/></asset>
    <worldbody><body><freejoint/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
    <geom type="mesh" mesh="m"/></body>
    </worldbody></mujoco>"""
    with pytest.raises(MeshError, match="mesh 'm' of geom"):
        Simulation(scene_of(tmp_path, open_box))


def test_water_for_what_is_no_spec_is_refused():
    with pytest.raises(ModelError) as caught:
        add_water(3)
    assert str(caught.value) == (
        "spec is 3; it must be an MjSpec, as mujoco.MjSpec.from_file('my_auv.xml') gives it"
    )
