"""Threads that share the hulls and bodies of one pass, and hulls that share one mesh."""

import ctypes
import itertools
import os
import threading

import mujoco
import numba
import numpy as np
import pytest
from mujoco import batch, rollout

from buoyancy_mj import (
    Buoyancy,
    Damping,
    EngineError,
    MethodError,
    ModelError,
    Panels,
    RegularWave,
    Settings,
    TriMesh,
    Water,
    add_water,
    read_scene,
)
from buoyancy_mj.engine import crews
from buoyancy_mj.engine.c_functions import address_of
from buoyancy_mj.kernels import inertia
from buoyancy_mj.kernels.arrays import gather
from buoyancy_mj.kernels.entries.crews import MOST, share
from buoyancy_mj.kernels.entries.tables import Links
from buoyancy_mj.kernels.multibody import Bodies, Joints, MassMatrix
from buoyancy_mj.meshes import shapes
from buoyancy_mj.scenes.catalog import scenes
from buoyancy_mj.settings.config import parse_plugin_config, write_plugin_config
from buoyancy_mj.settings.settings import MOST_THREADS
from buoyancy_mj.submersion.exact import PackedHulls
from buoyancy_mj.submersion.hull_set import HullSet

from .test_processes import run

SEA = Water(
    density=1025.0,
    waves=[RegularWave(0.1, wavelength=6.0), RegularWave(0.03, wavelength=2.0, direction=1.0)],
)
VESSEL = """
<body name="boat {n}" pos="{x} {y} .05" euler="5 0 {heading}">
  <freejoint/>
  <geom name="hull {n}" type="box" size=".5 {half} .1" mass="30"/>
  <geom type="box" size=".1 .1 .1" pos=".2 0 .2" mass="1"/>
  <site name="keel {n}" type="box" size=".2 .02 .003" pos="0 0 -.15" euler="90 0 0"/>
  <body pos="-.8 0 0"><joint axis="0 1 0"/><geom type="ellipsoid" size=".2 .1 .05" mass="3"/></body>
</body>
"""
CUSTOM = """
<text name="foil:keel {n}" data="walls=1"/>
<numeric name="radiation_damping:boat {n}" data="40 2 5"/>
"""
FLEET = """
<mujoco>
  <option timestep=".01" integrator="implicitfast"/>
  <custom>{custom}</custom>
  <worldbody>{vessels}</worldbody>
  <equality><weld body1="boat 1" body2="boat 2"/></equality>
</mujoco>
"""
ALL_LOADS = {
    "water": SEA,
    "pressure": "froude-krylov",
    "added_mass": "ellipsoid",
    "slamming": True,
}
INSTANCES = """
<mujoco>
  <asset>
    <mesh name="a" builtin="sphere" params="2"/><mesh name="b" builtin="sphere" params="1"/>
  </asset>
  <worldbody>{bodies}</worldbody>
</mujoco>
"""

SLAB = """
<mujoco><worldbody><body><freejoint/><geom type="box" size=".5 .3 .1" mass="60"/></body></worldbody>
</mujoco>
"""
FORK = """
import warnings
from buoyancy_mj import Buoyancy
from buoyancy_mj.engine import crews
import mujoco, numpy as np, os

warnings.simplefilter("ignore")
head, body = BODY.split("<worldbody>")
two = body.replace("one", "two").replace("</worldbody></mujoco>", "")
model = mujoco.MjModel.from_xml_string(f"{head}<worldbody>{two}{body}")
crew = crews.crew()

def lifts():
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 5)
    return data.qvel.tobytes()

with Buoyancy(model, threads=2).installed():
    expected, before = lifts(), crew.count
    pid = os.fork()
    if pid == 0:
        inherited = crew.count
        print(before, inherited, lifts() == expected, crew.count, flush=True)
        os._exit(0)
    os.waitpid(pid, 0)
"""


def fleet(vessels=9):
    spec = mujoco.MjSpec.from_string(
        FLEET.format(
            custom="".join(CUSTOM.format(n=n) for n in range(vessels)),
            vessels="".join(
                VESSEL.format(n=n, x=3 * n, y=n % 2, heading=40 * n, half=0.2 + 0.01 * n)
                for n in range(vessels)
            ),
        )
    )
    for body in spec.bodies:
        body.simple = False
    return spec


def many_slabs(threads):
    """A model of twelve slabs in a sea, whose water works on some threads."""
    spec = mujoco.MjSpec()
    for n in range(12):
        body = spec.worldbody.add_body(pos=[3.0 * n, 0.0, 0.0])
        body.add_freejoint()
        body.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.5, 0.2 + 0.01 * n, 0.1], mass=40.0)
    add_water(spec, SEA, threads=threads)
    return spec.compile()


def state(data):
    return np.r_[data.qpos, data.qvel]


def stepped(model, steps=12, threads=1, **options):
    """State, and loads, after some steps in water on some threads."""
    data = mujoco.MjData(model)
    with Buoyancy(model, threads=threads, **options).installed(native=True) as water:
        for _ in range(steps):
            mujoco.mj_step(model, data)
        return state(data), water.loads(data)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:the added mass of bodies:buoyancy_mj.BuoyancyWarning")
@pytest.mark.parametrize("damping", [Damping(), Damping(viscous=Panels())])
def test_all_loads_have_the_same_bits_on_any_number_of_threads(damping):
    model = fleet().compile()
    alone, loads = stepped(model, damping=damping, **ALL_LOADS)
    acting = {"buoyancy", "wave_pressure", "drag", "radiation", "foil", "added_mass", "slamming"}
    assert {cause for cause, rows in loads.by_cause.items() if rows.any()} == acting
    for threads in (2, 3, 16):
        together, others = stepped(model, threads=threads, damping=damping, **ALL_LOADS)
        assert np.array_equal(together, alone)
        for cause in acting:
            assert np.array_equal(others.by_cause[cause], loads.by_cause[cause])


def test_the_added_mass_of_trees_is_added_once_wherever_pieces_end():
    model = fleet().compile()
    data = mujoco.MjData(model)
    with pytest.warns(match="welds hold them together"):
        water = Buoyancy(model, Water(level=1.0), added_mass="ellipsoid")
    mujoco.mj_forward(model, data)
    structs = {"mjModel": model, "mjData": data}
    bodies, joints = gather(Bodies, structs), gather(Joints, structs)
    matrix = gather(MassMatrix, structs)
    dry = data.M.copy()
    centres = np.zeros((model.nbody, 4))
    centres[water.added_mass.bodies, 0] = water.added_mass.volumes

    def augmented(*ends):
        data.M[:] = dry
        for first, last in itertools.pairwise(ends):
            inertia.add_inertia(water.added_mass, bodies, joints, matrix, centres, first, last)
        return data.M.copy()

    count = len(water.added_mass.bodies)
    whole = augmented(0, count)
    assert (whole - dry).any()
    for end in range(count + 1):
        assert np.array_equal(augmented(0, end, min(end + 1, count), count), whole)


@numba.njit(nogil=True)
def share_items(function, words, items, links):
    return share(function, words, items, links)


def test_helpers_do_what_the_caller_is_too_busy_for():
    model = mujoco.MjModel.from_xml_string(SLAB)
    water = Buoyancy(model, threads=3).compiled
    meeting, done = threading.Barrier(3, timeout=60.0), []

    @ctypes.CFUNCTYPE(ctypes.c_int64, *[ctypes.c_int64] * 7)
    def meet(*words):
        meeting.wait()
        done.append((words[5:], threading.get_ident()))
        return 0

    links = Links(*np.zeros(len(Links._fields), np.int64))._replace(
        crew=crews.crew().table.address, threads=3
    )
    words = 1, 2, 3, water.address, 5
    # each of three pieces ends when all have begun
    share_items(address_of(meet), words, 3, links)
    assert sorted(piece for piece, _ in done) == [(0, 1), (1, 2), (2, 3)]
    assert len({thread for _, thread in done}) == 3


def test_two_data_and_batches_and_rollouts_move_in_such_water_as_alone():
    model, same = (many_slabs(threads) for threads in (3, 1))
    data = [mujoco.MjData(model) for _ in range(3)]
    twin = mujoco.MjData(same)
    mujoco.mj_step(same, twin, 30)

    # three data at once, of which one has the helpers
    steppers = [threading.Thread(target=mujoco.mj_step, args=(model, d, 30)) for d in data]
    for stepper in steppers:
        stepper.start()
    for stepper in steppers:
        stepper.join()
    for one in data:
        assert np.array_equal(state(one), state(twin))

    # a batch of threads, and a rollout
    many = batch.Batch(model, 4, nthread=2)
    many.step(nstep=30)
    assert np.array_equal(many.bind("qpos"), [twin.qpos] * 4)
    fresh = mujoco.MjData(model)
    spec = mujoco.mjtState.mjSTATE_FULLPHYSICS
    start = np.empty(mujoco.mj_stateSize(model, spec))
    mujoco.mj_getState(model, fresh, start, spec)
    states, _ = rollout.rollout(model, [fresh, data[0]], np.stack([start, start]), nstep=30)
    mujoco.mj_getState(same, twin, start, spec)
    assert np.array_equal(states[:, -1], [start, start])


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
def test_a_forked_child_hires_helpers_of_its_own(tmp_path):
    assert run(FORK, tmp_path=tmp_path) == "1 0 True 1"


def test_instances_of_one_mesh_share_its_tree():
    one = "<body pos='{x} 0 0' euler='{n} 0 0'><freejoint/><geom type='mesh' mesh='{mesh}'/></body>"
    bodies = [one.format(x=3 * n, n=n, mesh="ab"[n % 2]) for n in range(60)]
    pair, many = (
        Buoyancy(
            mujoco.MjModel.from_xml_string(INSTANCES.format(bodies="".join(some))), damping=None
        )
        for some in (bodies[:2], bodies)
    )
    hulls, others = pair.packed.hulls, many.packed.hulls
    for name in ("vertices", "faces", "areas", "spans", "boxes", "moments"):
        assert np.array_equal(getattr(others, name), getattr(hulls, name))
    # what is left is a few numbers for each hull
    sizes = [sum(a.nbytes for a in h if isinstance(a, np.ndarray)) for h in (others, hulls)]
    assert sizes[0] - sizes[1] < 60 * 150


def test_hulls_that_share_a_tree_are_submerged_as_those_that_do_not():
    ball = shapes.sphere(0.5)
    copies = [TriMesh(ball.vertices + (n * 1e-9), ball.faces) for n in range(3)]
    fills = [1.0, 0.5, 1.0]
    shared = PackedHulls(HullSet([ball] * 3, fills=fills), SEA)
    apart = PackedHulls(HullSet(copies, fills=fills), SEA)
    # one that floods in part displaces less, triangle by triangle
    assert shared.hulls.nodes[0] == shared.hulls.nodes[2] != shared.hulls.nodes[1]
    positions = np.array([[0.0, 0.0, 0.1], [1.0, 0.0, -0.1], [0.0, 2.0, 0.2]])
    rotations = np.tile(np.eye(3).ravel(), (3, 1))
    for dynamic in (False, True):
        pressed = shared.press(positions, rotations, 1.0, dynamic=dynamic)
        expected = apart.press(positions, rotations, 1.0, dynamic=dynamic)
        assert pressed == pytest.approx(expected, abs=1e-6)
    assert shared.submerge(positions, rotations, 1.0) == pytest.approx(
        apart.submerge(positions, rotations, 1.0), abs=1e-6
    )


def test_threads_are_whole_numbers_and_need_the_exact_method():
    for threads in (0, 1.5, True, 65):
        with pytest.raises(ModelError, match="it must be a whole number from 1 to 64"):
            Settings(threads=threads)
    with pytest.raises(MethodError, match="threads is 2, and hulls are shared by the method"):
        Settings(threads=2, method="sections")
    assert MOST_THREADS == MOST + 1


def test_water_in_python_refuses_several_threads():
    water = Buoyancy(mujoco.MjModel.from_xml_string(SLAB), threads=2)
    for options in ({"native": False}, {"through": "xfrc_applied"}):
        refused = pytest.raises(EngineError, match="threads is 2, and threads share the hulls in")
        with refused, water.installed(**options):
            pass


def test_scenes_and_models_state_threads():
    settings = Settings(threads=3)
    texts = write_plugin_config(settings)
    assert texts["threads"] == "3"
    assert parse_plugin_config(texts, "here").threads == 3
    assert "threads" not in write_plugin_config(Settings())
    assert read_scene(scenes()["auv_drop_still"], ["threads=2"]).threads == 2
