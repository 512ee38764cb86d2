"""Waters as callbacks: blocks that end in any order, other people's callbacks, data and sizes."""

import copy
import gc
import itertools
import pickle
import threading
import weakref

import mujoco
import numpy as np
import pytest
from mujoco import batch

from buoyancy_mj import (
    Buoyancy,
    BuoyancyWarning,
    EngineError,
    MeshError,
    ModelError,
    RegularWave,
    Selection,
    Water,
    add_water,
)
from buoyancy_mj.engine import callbacks, leases, passes
from buoyancy_mj.engine.compiled import THREADS
from buoyancy_mj.kernels import multibody

BOX = """<mujoco><option timestep="0.002"/><worldbody>
  <body name="box" pos="0 0 -3"><freejoint/>
    <geom name="box" type="box" size=".2 .15 .1" mass="6"/></body>
</worldbody></mujoco>"""
TWO = BOX.replace("</worldbody>", "<body><freejoint/><geom size='.1'/></body></worldbody>")
SLIDE = """<mujoco><worldbody><body><joint type="slide" axis="0 0 1"/><geom size=".1"/>
  <body><geom size=".2"/><joint/></body></body></worldbody></mujoco>"""
HINGES = """<mujoco><worldbody><body><joint/><geom size=".1"/></body>
  <body><joint/><geom size=".2"/></body></worldbody></mujoco>"""


def box():
    model = mujoco.MjModel.from_xml_string(BOX)
    return model, mujoco.MjData(model)


def floats(model, data):
    """Whether the water acts on a model."""
    mujoco.mj_forward(model, data)
    return data.qacc[2] > 0.0


def end(water, model, count=50):
    """Where data of a model end in a water that is alone."""
    data = mujoco.MjData(model)
    with water.installed():
        for _ in range(count):
            mujoco.mj_step(model, data)
    return data.qpos.copy()


# the order in which blocks end --------------------------------------------------------------------


@pytest.mark.parametrize("order", list(itertools.permutations(range(3))))
@pytest.mark.parametrize("kinds", [(True, True, True), (False, False, False), (True, True, False)])
def test_blocks_end_in_any_order_and_those_that_stay_act(kinds, order):
    scenes = [box() for _ in kinds]
    waters = [Buoyancy(model, damping=None) for model, _ in scenes]
    blocks = [water.installed(native=native) for water, native in zip(waters, kinds, strict=True)]
    for block in blocks:
        block.__enter__()
    left = set()
    for number in order:
        assert [floats(*scene) for scene in scenes] == [n not in left for n in range(3)]
        blocks[number].__exit__(None, None, None)
        left.add(number)
    assert not any(floats(*scene) for scene in scenes)
    assert mujoco.get_mjcb_passive() is None


@pytest.mark.parametrize("native", [True, False])
def test_a_callback_under_them_comes_back_whichever_ends_last(native):
    seen = []

    def theirs(_model, data):
        seen.append(data)

    (one, data), (two, _) = box(), box()
    mujoco.set_mjcb_passive(None if native else theirs)
    try:
        first, second = Buoyancy(one).installed(), Buoyancy(two).installed()
        first.__enter__()
        second.__enter__()
        first.__exit__(None, None, None)
        mujoco.mj_forward(one, data)
        second.__exit__(None, None, None)
        assert mujoco.get_mjcb_passive() is (None if native else theirs)
        assert len(seen) == (0 if native else 1)
    finally:
        mujoco.set_mjcb_passive(None)


def test_a_water_that_is_lent_twice_stays_until_both_blocks_end():
    model, data = box()
    water = Buoyancy(model)
    outer, inner = water.installed(), water.installed()
    outer.__enter__()
    inner.__enter__()
    outer.__exit__(None, None, None)
    assert floats(model, data)
    inner.__exit__(None, None, None)
    assert not floats(model, data)


@pytest.mark.parametrize(
    ("outer", "inner", "now", "then"),
    [
        ({}, {"through": "xfrc_applied"}, "through qfrc_passive", "through xfrc_applied"),
        ({"through": "xfrc_applied"}, {}, "through xfrc_applied", "through qfrc_passive"),
        ({}, {"native": False}, "compiled", "in Python"),
        ({"native": False}, {"native": True}, "in Python", "compiled"),
        ({}, {"copies": True}, "on its own model alone", "on copies"),
    ],
)
def test_a_block_inside_that_asks_for_something_else_is_refused(outer, inner, now, then):
    water = Buoyancy(box()[0])
    message = (
        f"^this water is installed already and acts {now}, which a block inside cannot change: "
        f"ask for it to act {then} in the outer `installed`$"
    )
    with (
        water.installed(**outer),
        pytest.raises(EngineError, match=message),
        water.installed(**inner),
    ):
        pass


def test_generators_that_hold_waters_end_in_any_order():
    def simulate(model, data):
        with Buoyancy(model, damping=None).installed():
            while True:
                mujoco.mj_step(model, data)
                yield float(data.qacc[2])

    scenes = [box() for _ in range(3)]
    runs = [simulate(*scene) for scene in scenes]
    assert [next(run) for run in runs] == pytest.approx([29.43] * 3)
    runs[0].close()
    assert next(runs[1]) > 0.0
    del runs[1]
    gc.collect()
    assert next(runs[1]) > 0.0
    runs[1].close()
    assert callbacks._lent == []


def test_threads_come_and_go_with_waters_of_their_own():
    models = [box()[0] for _ in range(4)]
    rights = [
        end(Buoyancy(model, Water(density=900.0 + i)), model) for i, model in enumerate(models)
    ]
    ends = {}

    def live(number):
        for _ in range(6):
            water = Buoyancy(models[number], Water(density=900.0 + number))
            ends.setdefault(number, []).append(end(water, models[number]))

    threads = [threading.Thread(target=live, args=(number,)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for number, right in enumerate(rights):
        assert all(np.array_equal(one, right) for one in ends[number])
    assert callbacks._lent == []


def test_c_functions_are_used_again():
    model, data = box()
    water = Buoyancy(model)
    for _ in range(leases.MOST_FREE + 20):
        with water.installed():
            mujoco.mj_forward(model, data)
    assert len(leases._free) <= leases.MOST_FREE + 8


# other people's callbacks -------------------------------------------------------------------------


@pytest.mark.parametrize("native", [True, False])
def test_a_callback_that_is_set_inside_stays_and_is_told(native):
    model, data = box()

    def mine(_model, _data):
        pass

    def set_inside():
        with Buoyancy(model).installed(native=native):
            mujoco.set_mjcb_passive(mine)

    try:
        message = (
            "^mjcb_passive was set to .*mine while the water was installed there, which keeps the "
            "water from acting; it stays as it was set: set a callback before `installed`, and the "
            "water calls it first$"
        )
        with pytest.warns(BuoyancyWarning, match=message):
            set_inside()
        assert mujoco.get_mjcb_passive() is mine
    finally:
        mujoco.set_mjcb_passive(None)
    assert not floats(model, data)


def test_a_callback_that_is_removed_inside_is_told():
    def remove_inside():
        with Buoyancy(box()[0]).installed():
            mujoco.set_mjcb_passive(None)

    with pytest.warns(BuoyancyWarning, match="^mjcb_passive was set to None while the water was"):
        remove_inside()
    assert mujoco.get_mjcb_passive() is None


@pytest.mark.parametrize("native", [True, False])
def test_a_callback_that_goes_on_calling_a_water_that_left_calls_nothing(native):
    model, data = box()
    kept = []

    def wrap_inside():
        with Buoyancy(model).installed(native=native):
            ours = mujoco.get_mjcb_passive()
            kept.append(
                (lambda model, data: ours(model._address, data._address)) if native else ours
            )
            mujoco.set_mjcb_passive(kept[0])
            assert floats(model, data)

    try:
        with pytest.warns(BuoyancyWarning) if native else _no_warning():
            wrap_inside()
        gc.collect()
        assert not floats(model, data)
    finally:
        mujoco.set_mjcb_passive(None)


class _no_warning:  # noqa: N801
    """A block in which any warning is an error, as everywhere in these tests."""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        return False


# data ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("text", [TWO, SLIDE, HINGES])
@pytest.mark.parametrize("method", ["act", "evaluate", "loads", "external", "centre_of_mass"])
def test_data_of_another_model_are_refused_and_left_as_they_are(text, method):
    other = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(other)
    mujoco.mj_forward(other, data)
    arrays = [name for name in dir(data) if isinstance(getattr(data, name), np.ndarray)]
    before = {name: getattr(data, name).copy() for name in arrays}
    with pytest.raises(ModelError, match=r"^these data are of another model than this water's"):
        getattr(Buoyancy(box()[0]), method)(data)
    for name, value in before.items():
        assert np.array_equal(getattr(data, name), value, equal_nan=value.dtype.kind == "f"), name


def test_what_differs_is_named():
    message = (
        r"^these data are of another model than this water's \(nq 14, not 7, nv 12, not 6, "
        r"nbody 3, not 2, ngeom 2, not 1, nC 12, not 6\): make them of it, "
        r"mujoco\.MjData\(buoyancy\.model\), or make a Buoyancy of their model$"
    )
    other = mujoco.MjModel.from_xml_string(TWO)
    with pytest.raises(ModelError, match=message):
        Buoyancy(box()[0]).evaluate(mujoco.MjData(other))


@pytest.mark.parametrize("method", ["act", "evaluate"])
@pytest.mark.parametrize("reset", [False, True])
def test_data_whose_bodies_are_placed_nowhere_yet_are_refused(method, reset):
    model, data = box()
    if reset:
        mujoco.mj_forward(model, data)
        mujoco.mj_resetData(model, data)
    water = Buoyancy(model)
    message = (
        r"^these data are new or were reset, and their bodies are placed nowhere yet: "
        r"call mujoco\.mj_forward\(model, data\) first$"
    )
    with pytest.raises(ModelError, match=message):
        getattr(water, method)(data)
    mujoco.mj_kinematics(model, data)
    getattr(water, method)(data)


@pytest.mark.parametrize("method", ["act", "evaluate", "loads", "external", "centre_of_mass"])
def test_what_is_no_data_is_refused(method):
    water = Buoyancy(box()[0])
    with pytest.raises(ModelError, match=r"^data are None; give the mujoco\.MjData of this water"):
        getattr(water, method)(None)


def test_a_water_called_by_hand_does_not_double_that_of_its_model():
    spec = mujoco.MjSpec.from_string(BOX)
    add_water(spec, Water())
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    water, before = Buoyancy(model), data.qfrc_passive.copy()
    for call in (lambda: water.act(data), lambda: water(model, data)):
        with pytest.raises(ModelError, match="brings its own water, as the plugin"):
            call()
    assert np.array_equal(data.qfrc_passive, before)
    assert water.evaluate(data).total.volume == pytest.approx(0.024)


@pytest.mark.parametrize("native", ["xfrc_applied", 1])
def test_an_array_in_the_place_of_native_is_refused(native):
    water = Buoyancy(box()[0])
    message = f"^native is {native!r}; possible: True, False, None; the array is through=...$"
    with pytest.raises(EngineError, match=message), water.installed(native):
        pass


def test_data_of_copies_of_the_model_are_its_own():
    model, data = box()
    mujoco.mj_forward(model, data)
    water = Buoyancy(model)
    for other in (copy.deepcopy(model), pickle.loads(pickle.dumps(model))):
        theirs = mujoco.MjData(other)
        mujoco.mj_forward(other, theirs)
        assert water.evaluate(theirs).total.volume == pytest.approx(0.024)
    assert water.evaluate(pickle.loads(pickle.dumps(data))) is not None


@pytest.mark.parametrize("native", [True, False])
def test_the_loads_of_data_stay_while_others_are_stepped(native):
    model, _ = box()
    water = Buoyancy(model, damping=None)
    assert passes.MOST_RECENT == THREADS == 64
    many = [mujoco.MjData(model) for _ in range(65)]
    with water.installed(native=native):
        for number, data in enumerate(many[:64]):
            data.qpos[2] = 0.1 - number / 320.0
            mujoco.mj_forward(model, data)
        for number, data in enumerate(many[:64]):
            assert water.loads(data).total.volume == pytest.approx(0.12 * number / 320.0)
        mujoco.mj_forward(model, many[64])
        assert water.loads(many[64]).total.volume == pytest.approx(0.024)
        assert water.loads(many[63]).total.volume == pytest.approx(0.12 * 63 / 320.0)
        with pytest.raises(EngineError, match=r"^this water has not acted on these data at their"):
            water.loads(many[0])


@pytest.mark.parametrize("native", [True, False])
def test_loads_are_not_those_of_data_that_lay_there_before_nor_of_other_poses(native):
    model, _ = box()
    water = Buoyancy(model)
    with water.installed(native=native):
        for _ in range(10):
            data = mujoco.MjData(model)
            with pytest.raises(EngineError):
                water.loads(data)
            mujoco.mj_forward(model, data)
            water.loads(data)
            del data
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        data.qpos[2] = 5.0
        mujoco.mj_kinematics(model, data)
        message = (
            "^the bodies of these data are elsewhere than in the last pass of this water; call "
            "mj_forward while it acts, or use evaluate$"
        )
        with pytest.raises(EngineError, match=message):
            water.loads(data)


@pytest.mark.parametrize("integrator", ["Euler", "RK4", "implicit", "implicitfast", "discrete"])
@pytest.mark.parametrize(
    "way", [{}, {"native": False}, {"through": "xfrc_applied"}], ids=["compiled", "python", "xfrc"]
)
def test_loads_are_there_after_a_step_of_each_integrator(integrator, way):
    model = mujoco.MjModel.from_xml_string(BOX.replace("002", f'002" integrator="{integrator}'))
    data = mujoco.MjData(model)
    water = Buoyancy(model)
    with water.installed(**way):
        for _ in range(3):
            mujoco.mj_step(model, data)
            assert water.loads(data).total.volume == pytest.approx(0.024)


@pytest.mark.parametrize("native", [True, False])
def test_the_loads_after_a_reset_are_those_of_the_last_pass(native):
    model, data = box()
    other = mujoco.MjData(model)
    water = Buoyancy(model)
    with water.installed(native=native):
        for _ in range(10):
            mujoco.mj_step(model, data)
            mujoco.mj_step(model, other)
        mujoco.mj_resetData(model, data)
        with pytest.raises(EngineError):
            water.loads(data)
        data.qpos[2] = 5.0
        mujoco.mj_forward(model, data)
        assert water.loads(data).total.volume == 0.0


# sizes --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("native", [True, False])
def test_geoms_that_are_resized_displace_what_they_are_then(native):
    model, data = box()
    water = Buoyancy(model, damping=None)
    with water.installed(native=native):
        for factor in (1.0, 2.0, 0.5, 1.0):
            model.geom_size[0] = factor * np.array([0.2, 0.15, 0.1])
            mujoco.mj_forward(model, data)
            assert data.qfrc_passive[2] == pytest.approx(factor**3 * 24.0 * 9.81)
            assert water.loads(data).total.volume == pytest.approx(factor**3 * 0.024)
            assert water.hulls[0].displaced_volume == pytest.approx(factor**3 * 0.024)


@pytest.mark.parametrize("count", [1, 64, 100])
def test_no_factor_on_all_sizes_nor_an_exchange_of_two_goes_unnoticed(count):
    sizes = np.random.default_rng(count).uniform(0.01, 2.0, (count, 3))
    others = [factor * sizes for factor in (0.25, 0.5, 2.0, 4.0, 1.0 + 1e-15)]
    others += [sizes[:, [1, 0, 2]], np.roll(sizes, 1), -sizes]
    sums = [multibody.sum_sizes(some.view(np.int64)) for some in (sizes, *map(np.array, others))]
    assert len(set(sums)) == len(sums)


def test_resized_geoms_have_the_drag_and_the_added_mass_of_new_ones():
    model = mujoco.MjModel.from_xml_string(BOX.replace("mass=", "pos='0 0 .01' mass="))
    data = mujoco.MjData(model)
    options = {"water": Water(waves=RegularWave(0.1, period=3.0)), "added_mass": "estimate"}
    water = Buoyancy(model, **options)
    model.geom_size[0] *= 1.5
    data.qvel[:] = 1.0
    accelerations = []
    for one in (water, Buoyancy(model, **options)):
        with one.installed():
            mujoco.mj_forward(model, data)
        accelerations.append(data.qacc.copy())
    assert np.array_equal(*accelerations)
    assert np.array_equal(water.evaluate(data).xfrc, Buoyancy(model, **options).evaluate(data).xfrc)


@pytest.mark.parametrize("native", [True, False])
def test_a_size_that_encloses_nothing_is_an_error(native):
    model, data = box()
    with Buoyancy(model).installed(native=native):
        mujoco.mj_forward(model, data)
        model.geom_size[0] = 0.0
        with pytest.raises((MeshError, mujoco.FatalError), match="encloses 0 m"):
            mujoco.mj_forward(model, data)
        model.geom_size[0] = 0.1
        mujoco.mj_forward(model, data)
    assert data.qfrc_passive[2] == pytest.approx(9810.0 * 0.008)


def test_a_copy_with_geoms_of_other_sizes_is_an_error_of_the_engine():
    model, _ = box()
    with Buoyancy(model).installed(copies=True):
        many = batch.Batch(model, 1)
        many.expand("geom_size")[:] *= 2.0
        message = (
            "a copy of the model has geoms of other sizes than the model of the water: "
            r"add_water\(spec\) makes water that is measured for each"
        )
        with pytest.raises(batch.SimulationError, match=message):
            many.forward()


# as a value ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "duplicate",
    [copy.copy, copy.deepcopy, lambda water: pickle.loads(pickle.dumps(water))],
    ids=["copy", "deepcopy", "pickle"],
)
def test_a_copy_of_a_water_acts_as_the_water(duplicate):
    model = mujoco.MjModel.from_xml_string(TWO)
    water = Buoyancy(
        model,
        Water(density=1025.0, waves=RegularWave(0.1, period=3.0)),
        bodies=[1],
        added_mass={"box": [5.0, 5.0, 5.0, 0.1, 0.2, 0.3]},
        selection=Selection(geoms="box"),
    )
    with water.installed():
        other = duplicate(water)
    assert other.settings == water.settings
    assert np.array_equal(end(other, other.model), end(water, model))


@pytest.mark.parametrize(
    "way", [{}, {"native": False}, {"through": "xfrc_applied"}], ids=["compiled", "python", "xfrc"]
)
def test_a_water_that_is_lent_no_more_is_freed_at_once(way):
    model, data = box()
    water = Buoyancy(model)
    with water.installed(**way):
        mujoco.mj_step(model, data)
    gone = weakref.ref(water), weakref.ref(water._acting)
    gc.disable()
    try:
        del water
        assert [one() for one in gone] == [None, None]
    finally:
        gc.enable()


def test_a_water_says_what_it_is():
    model, _ = box()
    water = Buoyancy(model, Water(density=1025.0, waves=RegularWave(0.1, period=3.0)))
    assert repr(water) == (
        "Buoyancy(hulls: 1, bodies: 1, displacement: 24.6 kg, waves: 1, method: exact, "
        "loads: buoyancy, drag)"
    )
