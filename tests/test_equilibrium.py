"""Rest poses: classic bodies, where the simulated vehicle comes to rest, what cannot float."""

import math

import mujoco
import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from buoyancy_mj import (
    Buoyancy,
    EquilibriumError,
    ModelError,
    Scene,
    SceneError,
    Simulation,
    Start,
    TriMesh,
    Water,
    equilibria,
    equilibrium,
    hydrostatics,
)
from buoyancy_mj.inspection.inspection import inspect_model
from buoyancy_mj.meshes import shapes
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.specs import read_spec
from tests import dense_search, naive, vessels


def tilted(roll, pitch=0.0, yaw=0.0, place=(0.0, 0.0, 0.0)):
    """Coordinates of a free joint."""
    return [*place, *Rotation.from_euler("ZYX", [yaw, pitch, roll]).as_quat(scalar_first=True)]


# classic bodies


def test_a_box_rights_itself_from_any_heel_short_of_its_vanishing_stability():
    for heel in (0.0, 30.0, 60.0, 80.0):
        found = equilibrium(vessels.box(), start=tilted(math.radians(heel), 0.2))
        assert found.stable
        assert found.hydrostatics.draft == pytest.approx(0.3, abs=1e-9)
        assert (found.hydrostatics.heel, found.hydrostatics.trim) == pytest.approx(
            (0.0, 0.0), abs=1e-9
        )
    # heave, roll and pitch of the box, squared: 2 pi / 1.0988 s, 2 pi / 1.8893 s
    assert 2 * math.pi / np.sqrt(found.eigenvalues) == pytest.approx(
        [1.8893, 1.2334, 1.0988], abs=1e-4
    )


def test_a_box_floats_on_either_face_and_nowhere_else():
    found = equilibria(vessels.box())
    assert sorted(abs(math.degrees(one.hydrostatics.heel)) for one in found) == pytest.approx(
        [0.0, 180.0], abs=1e-6
    )
    assert [one.energy for one in found] == pytest.approx([600 * 9.81 * 0.15] * 2, rel=1e-9)


@pytest.mark.parametrize(
    ("ratio", "angle"),
    # a long square log: flat for c < (3 - sqrt 3) / 6 = 0.2113, on edge from 9/32 to 23/32, between
    # them at an angle; at a quarter tan = 1/2 (Erdos, Schibler, Herndon 1992, Am. J. Phys. 60, 335)
    [
        (0.2, 0.0),
        (0.25, math.degrees(math.atan(0.5))),
        (0.29, 45.0),
        (0.5, 45.0),
        (0.75, 26.565),
        (0.8, 0.0),
    ],
)
def test_a_square_log_floats_flat_slanted_or_on_edge(ratio, angle):
    model = vessels.box((3.0, 0.5, 0.5), ratio * 6000.0)
    heel = abs(math.degrees(equilibrium(model).hydrostatics.heel)) % 90.0
    assert min(heel, 90.0 - heel) == pytest.approx(angle, abs=1e-3)


def test_a_cube_of_half_density_floats_on_any_of_its_corners():
    found = equilibria(vessels.box((0.5, 0.5, 0.5), 500.0))
    assert len(found) == 8
    downs = np.array(
        [
            np.abs(Rotation.from_quat(one.qpos[3:], scalar_first=True).as_matrix()[2])
            for one in found
        ]
    )
    assert downs == pytest.approx(np.full((8, 3), 1 / math.sqrt(3)), abs=1e-6)


def uprights(found):
    """The direction of the vessel that points up, for each rest pose (n, 3)."""
    return np.array(
        [Rotation.from_quat(one.qpos[3:7], scalar_first=True).as_matrix()[2] for one in found]
    )


def floats_on_a_face(ratio):
    """GM = BM - BG of a cube with side 1 is 1 / (12 s) - (1 - s) / 2 at the density s."""
    return 1.0 / (12.0 * ratio) > 0.5 * (1.0 - ratio)


def floats_on_a_corner(ratio):
    """Whether a cube is stable with a diagonal upright.

    The planes of the three wet faces meet the surface at a > 1 along each edge: a tetrahedron, less
    three that are a - 1 large. Its moments give GM V = sqrt(3) / 12 b (1 - b) (1 - 2 b + 2 b^2),
    with b = a - 1. Up to a density of 1/6 a is 1 or less, and GM = sqrt(3) / 2 (a - 1).
    """
    return 1.0 / 6.0 < ratio < 5.0 / 6.0


@pytest.mark.parametrize("ratio", [0.1, 0.18, 0.2, 0.21, 0.25, 0.5, 0.79, 0.8, 0.82, 0.9])
def test_a_cube_floats_on_faces_on_corners_or_on_both(ratio):
    # how the cube lies in its frame does not matter
    turn = Rotation.random(random_state=3).as_matrix()
    cube = shapes.box((0.5, 0.5, 0.5)).transformed(turn, np.zeros(3))
    found = equilibria(vessels.of_mesh(cube, 1000.0 * ratio, inertia=[1000.0 * ratio / 6.0] * 3))
    assert {one.stability for one in found} == {"stable"}
    ups = np.sort(np.abs(uprights(found) @ turn), axis=1)
    on_face = np.abs(ups - [0.0, 0.0, 1.0]).max(axis=1) < 1e-3
    on_corner = np.abs(ups - 1.0 / math.sqrt(3.0)).max(axis=1) < 1e-3
    assert on_face.sum() == 6 * floats_on_a_face(ratio)
    assert on_corner.sum() == 8 * floats_on_a_corner(ratio)
    assert len(found) == on_face.sum() + on_corner.sum()


def polytope(seed):
    """A closed mesh with flat faces: the convex hull of points on an ellipsoid."""
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(rng.integers(6, 16), 3))
    points *= rng.uniform(0.3, 1.0, 3) / np.linalg.norm(points, axis=1)[:, None]
    return naive.trimesh_hull(trimesh.convex.convex_hull(points))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(20))
def test_all_rest_poses_are_those_that_a_dense_search_finds(seed):
    rng = np.random.default_rng(seed)
    mesh = vessels.dented(seed) if seed % 8 == 0 else polytope(seed)
    volume = rng.uniform(0.05, 0.95) * mesh.volume
    centre = mesh.centroid + rng.integers(0, 2) * rng.uniform(-0.15, 0.15, 3) * mesh.extents
    compare_with_dense_search(mesh, volume, centre, 4000)


@pytest.mark.slow
@pytest.mark.parametrize("ratio", [0.05, 0.19, 0.21, 0.3, 0.7, 0.79, 0.81, 0.95])
def test_all_rest_poses_of_a_cube_are_those_that_a_dense_search_finds(ratio):
    turn = Rotation.random(random_state=5).as_matrix()
    cube = shapes.box((0.5, 0.5, 0.5)).transformed(turn, np.zeros(3))
    compare_with_dense_search(cube, ratio, np.zeros(3), 12000)


def compare_with_dense_search(mesh, volume, centre, count):
    found = uprights(equilibria(vessels.of_mesh(mesh, 1000.0 * volume, centre)))
    dense = dense_search.Floating(mesh, centre, volume).lows(count)
    apart = np.linalg.norm(found[:, None] - dense, axis=2)
    assert apart.shape == (len(dense), len(dense))
    assert max(apart.min(axis=0).max(), apart.min(axis=1).max()) < 2e-3


def test_the_tall_cuboid_of_openfoam_stands_only_on_paper():
    # P21: upright GM = -0.095 with B = 0.3 in its narrow direction
    model = vessels.box((0.15, 0.1, 0.25), 15.0)
    upright = equilibrium(model, stable=False)
    assert upright.stability == "unstable"
    assert upright.eigenvalues[0] < 0.0
    assert (upright.hydrostatics.heel, upright.hydrostatics.draft) == pytest.approx(
        (0.0, 0.25), abs=1e-9
    )
    fallen = equilibrium(model)
    assert fallen.stable
    assert abs(math.degrees(fallen.hydrostatics.heel)) == pytest.approx(90.0, abs=1e-6)
    assert fallen.energy < upright.energy


def test_a_model_as_cad_writes_it_comes_to_rest_upside_down():
    # top-heavy as drawn, the centre of gravity 7e-8 m off the middle
    model = mujoco.MjModel.from_xml_path(
        str(vessels.DATA / "cases" / "top_heavy_cad" / "exported.xml")
    )
    found = equilibrium(model)
    assert found.stable
    assert math.degrees(found.hydrostatics.heel) == pytest.approx(180.0, abs=1e-3)
    assert pytest.approx(0.0729167, abs=1e-6) == found.hydrostatics.GM
    assert [one.energy for one in equilibria(model)] == pytest.approx([found.energy])
    # what `inspect` says
    (vessel,) = inspect_model(model).vessels
    assert vessel.sentence == (
        "floats: 140 kg reserve, draft 0.133 m, stable, GM 0.0729 m, "
        "heel 180.0, trim 0.0 degrees, not as drawn"
    )


TOP_HEAVY = {
    "box": '<geom type="box" size="0.5 0.15 0.3"/>',
    "cylinder": '<geom type="cylinder" size="0.15 0.3"/>',
    "ellipsoid": '<geom type="ellipsoid" size="0.3 0.15 0.3"/>',
    "torus": None,
    "prism": None,
}


def top_heavy(name, offset):
    """A body that stands on its head, its centre of gravity off the middle by an offset [m]."""
    centre = [0.4 * offset, offset, 0.25]
    if TOP_HEAVY[name] is not None:
        place = " ".join(repr(value) for value in centre)
        inertial = f'<inertial pos="{place}" mass="15" diaginertia="2 2 2"/>'
        return vessels.of_geoms(TOP_HEAVY[name], inertial)
    # meshes, which MuJoCo keeps in single precision
    if name == "torus":
        # on its rim
        solid = trimesh.creation.torus(0.3, 0.1, major_sections=32, minor_sections=16)
        solid.apply_transform(trimesh.transformations.rotation_matrix(0.5 * math.pi, [1, 0, 0]))
    else:
        solid = trimesh.creation.cylinder(0.15, 0.6, sections=7)
    mesh = TriMesh(np.asarray(solid.vertices), np.asarray(solid.faces))
    return vessels.of_mesh(mesh, 300.0 * mesh.volume, centre)


@pytest.mark.parametrize("name", TOP_HEAVY)
@pytest.mark.parametrize("offset", [0.0, *(10.0**n for n in range(-13, -2))])
def test_no_asymmetry_is_too_small_to_fall_over(name, offset):
    model = top_heavy(name, offset)
    upright = equilibrium(model, stable=False)
    found = equilibrium(model)
    assert found.stability != "unstable"
    assert found.energy < upright.energy - 0.01 * model.body_mass.sum() * 9.81
    assert any(one.energy == pytest.approx(found.energy, abs=1e-6) for one in equilibria(model))


@pytest.mark.parametrize(
    ("size", "starboard", "bow"), [("0.5 0.15 0.25", -1.0, 0.0), ("0.15 0.5 0.25", 0.0, -1.0)]
)
def test_off_an_exact_summit_it_heels_to_starboard_or_trims_by_the_bow(size, starboard, bow):
    inertial = '<inertial pos="0 0 0" mass="30" diaginertia="1 1 1"/>'
    model = vessels.of_geoms(f'<geom type="box" size="{size}"/>', inertial)
    for yaw in (0.0, 1.0):
        # the height of the bow and of the starboard side
        x, y, _ = uprights([equilibrium(model, start=tilted(0.0, yaw=yaw))])[0]
        assert (-y, x) == pytest.approx((starboard, bow), abs=1e-6)


@pytest.mark.parametrize("clearance", [-1e-3, -1e-6, 0.0, 1e-8, 1e-6])
def test_outriggers_that_just_touch_the_water_hold_a_narrow_hull(clearance):
    # 250 mm draft; without outriggers GM = 0.3^2 / (12 * 0.25) - 0.225 < 0
    height = 0.05 + clearance
    model = vessels.of_geoms(
        '<geom type="box" size="1 .15 .3" pos="0 0 .05"/>'
        f'<geom type="box" size=".5 .1 .05" pos="0 .6 {height!r}"/>'
        f'<geom type="box" size=".5 .1 .05" pos="0 -.6 {height!r}"/>',
        '<inertial pos="0 0 .1" mass="150" diaginertia="10 50 50"/>',
    )
    found = equilibrium(model)
    assert found.stable
    assert math.degrees(found.hydrostatics.heel) == pytest.approx(0.0, abs=1e-3)
    assert {one.stability for one in equilibria(model)} == {"stable"}


@given(st.integers(0, 10**6), st.floats(0.05, 0.95))
@settings(max_examples=15, deadline=None)
def test_where_it_comes_to_rest_is_one_of_all_rest_poses(seed, ratio):
    rng = np.random.default_rng(seed)
    mesh = polytope(seed)
    centre = mesh.centroid + rng.uniform(-0.1, 0.1, 3)
    model = vessels.of_mesh(mesh, ratio * 1000.0 * mesh.volume, centre)
    every = uprights(equilibria(model))
    for _ in range(5):
        found = equilibrium(model, start=tilted(*rng.uniform(-3, 3, 3)))
        assert found.stability != "unstable"
        assert np.linalg.norm(uprights([found]) - every, axis=1).min() < 2e-2


@pytest.mark.parametrize("shape", ["cylinder", "capsule"])
def test_a_log_rolls_without_resistance_and_counts_once(shape):
    found = equilibria(vessels.of_geoms(f'<geom type="{shape}" size=".2 1" mass="100"/>'))
    assert len(found) == 1
    assert abs(Rotation.from_quat(found[0].qpos[3:], scalar_first=True).apply([0, 0, 1])[2]) < 1e-6


def test_a_homogeneous_ball_is_indifferent():
    found = equilibria(vessels.of_geoms('<geom type="sphere" size=".5" mass="100"/>'))
    assert [one.stability for one in found] == ["indifferent"]


def test_an_hourglass_that_weighs_half_hangs_by_its_neck():
    # P6: V = 0.2617994 to the neck, where nothing stiffens the heave
    mesh = naive.two_cones(0.5, 1.0)
    model = vessels.of_mesh(mesh, 500.0 * mesh.volume, (0.0, 0.0, -1.2))
    found = equilibrium(model, start=tilted(0.3))
    # MuJoCo keeps vertices to 1e-8, whose cube root is 2e-3
    assert found.hydrostatics.draft == pytest.approx(1.0, abs=3e-3)
    assert found.hydrostatics.waterplane_area == pytest.approx(0.0, abs=math.pi * (0.5 * 3e-3) ** 2)
    assert found.hydrostatics.trim == pytest.approx(0.0, abs=1e-6)


@given(st.integers(0, 10**6), st.floats(0.05, 0.95))
@settings(max_examples=30)
def test_at_rest_forces_vanish_and_every_small_tilt_comes_back(seed, ratio):
    rng = np.random.default_rng(seed)
    mesh = vessels.dented(seed)
    model = vessels.of_mesh(
        mesh, ratio * 1000.0 * mesh.volume, mesh.centroid + rng.uniform(-0.2, 0.2, 3)
    )
    found = equilibrium(model, start=tilted(*rng.uniform(-3, 3, 3)))
    assert found.stability != "unstable"
    # by the engine's own callback
    data = mujoco.MjData(model)
    data.qpos[:] = found.qpos
    mujoco.mj_forward(model, data)
    total = Buoyancy(model, damping=None).evaluate(data).total
    weight = model.body_mass.sum() * 9.81
    assert total.force[2] == pytest.approx(weight, rel=1e-9)
    assert total.centroid[:2] == pytest.approx(data.subtree_com[1, :2], abs=1e-8)
    # and from a little beside it the way leads back
    push = Rotation.from_rotvec([*rng.uniform(-0.01, 0.01, 2), 0.0]) * Rotation.from_quat(
        found.qpos[3:], scalar_first=True
    )
    again = equilibrium(model, start=[0, 0, 0, *push.as_quat(scalar_first=True)])
    assert again.energy == pytest.approx(found.energy, abs=1e-9 * weight)


# what is kept, and what else is there


def test_heading_and_place_are_kept():
    start = tilted(0.4, -0.3, 2.0, (5.0, -3.0, 1.0))
    found = equilibrium(vessels.box(), Water(level=2.0), start)
    assert found.qpos[:2] == pytest.approx([5.0, -3.0], abs=1e-12)
    assert found.qpos[2] == pytest.approx(2.0, abs=1e-9)
    assert found.hydrostatics.heading == pytest.approx(2.0, abs=1e-9)


def test_joints_are_held():
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><worldbody><body name="raft"><freejoint/>
        <geom type="box" size="1 .5 .2" mass="200"/>
        <body pos="0 0 .2"><joint name="boom" type="hinge" axis="1 0 0"/>
        <geom type="capsule" fromto="0 0 0 0 0 1" size=".02" mass="10"/></body></body>
        </worldbody></mujoco>"""
    )
    upright, aside = (equilibrium(model, start=[*tilted(0.0), angle]) for angle in (0.0, -0.8))
    assert upright.hydrostatics.heel == pytest.approx(0.0, abs=1e-9)
    # the boom leans to port, y > 0, and takes the raft down there: tan(heel) is about m y / (M GM)
    assert aside.qpos[7] == -0.8
    arm = 10 * 0.5 * math.sin(0.8) / 210
    assert math.tan(aside.hydrostatics.heel) == pytest.approx(
        -arm / upright.hydrostatics.GMt, rel=0.05
    )


def test_what_is_too_heavy_sinks_with_the_missing_kilograms():
    with pytest.raises(
        EquilibriumError,
        match=r"'hull' sinks: it weighs 1300 kg and displaces 1200 kg .* 100 kg too little",
    ):
        equilibrium(vessels.box(mass=1300.0))


def test_what_weighs_just_what_it_displaces_hovers_with_its_buoyancy_on_top():
    inertial = '<inertial pos=".1 0 -.02" mass="1000" diaginertia="1 1 1"/>'
    model = vessels.of_geoms('<geom type="box" size=".5 .5 .5"/>', inertial)
    found = equilibrium(model, start=tilted(0.0, place=(0, 0, -7)))
    assert found.stability == "indifferent"
    assert pytest.approx(math.hypot(0.1, 0.02), rel=1e-12) == found.hydrostatics.BG
    assert found.qpos[2] == pytest.approx(-7.0, abs=0.2)
    assert math.degrees(found.hydrostatics.trim) == pytest.approx(
        math.degrees(math.atan2(0.1, 0.02)), rel=1e-9
    )
    assert len(equilibria(model)) == 1


def test_a_hair_of_reserve_is_enough_to_float():
    mesh = vessels.dented(1)
    model = vessels.of_mesh(
        mesh, 1000.0 * mesh.volume * (1.0 - 1e-5), mesh.centroid + [0, 0, -0.05]
    )
    found = equilibrium(model, start=tilted(1.0))
    assert found.stable
    assert 0.0 < found.hydrostatics.waterplane_area < 1e-2
    assert found.hydrostatics.displacement == pytest.approx(found.hydrostatics.mass, rel=1e-9)


def test_what_hangs_on_joints_is_not_free_to_float():
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><worldbody><body name="buoy"><joint type="slide" axis="0 0 1"/>'
        '<geom type="sphere" size=".5" mass="100"/></body></worldbody></mujoco>'
    )
    with pytest.raises(
        ModelError,
        match="body 'buoy' hangs on joints and is not free to float; give it a <freejoint/>",
    ):
        equilibrium(model)


# against the simulation


def settled(model, start, seconds=60.0):
    """Where a strongly damped simulation from `start` ends."""
    model.opt.timestep, model.opt.integrator = 0.01, mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    data = mujoco.MjData(model)
    data.qpos[:] = start
    # joints stay as they are, as by a stiff servo
    mujoco.mj_forward(model, data)
    scale = np.array([model.body_mass.sum()] * 3 + [model.body_inertia[1:].max() + 1e-3] * 3)
    model.dof_damping[:6] = 4.0 * scale
    with Buoyancy(model).installed():
        while data.time < seconds:
            mujoco.mj_step(model, data)
    assert np.abs(data.qvel[:6]).max() < 1e-5
    return data.qpos.copy()


def odd(name):
    if name in ("hourglass", "sauvc_auv"):
        return read_spec(catalog.model_path(name)).compile()
    if name == "dented":
        mesh = vessels.dented(12)
        return vessels.of_mesh(mesh, 450.0 * mesh.volume, mesh.centroid + [0.05, -0.03, -0.1])
    if name == "catamaran with a load to one side":
        return vessels.of_geoms(
            '<geom type="capsule" size=".15 .8" pos="0 .5 0" euler="0 90 0" mass="20"/>'
            '<geom type="capsule" size=".15 .8" pos="0 -.5 0" euler="0 90 0" mass="20"/>'
            '<geom type="box" size=".3 .6 .02" pos="0 0 .15" mass="10"/>'
            '<geom type="sphere" size=".1" pos=".2 .3 .25" mass="15"/>'
        )
    mesh = naive.cone(0.6, 0.8, sections=24).transformed(np.eye(3), (0.3, 0.0, 0.0))
    return vessels.of_mesh(mesh, 300.0 * mesh.volume, (0.32, 0.01, 0.1))


@pytest.mark.parametrize(
    "name",
    ["hourglass", "sauvc_auv", "dented", "catamaran with a load to one side", "cone off its frame"],
)
def test_it_is_where_the_simulated_vehicle_comes_to_rest(name):
    model = odd(name)
    start = np.concatenate([tilted(0.3, 0.2, 0.5, (0.1, 0.2, 0.1)), model.qpos0[7:]])
    found = equilibrium(model, start=start)
    end = settled(model, start)
    assert found.qpos[2] == pytest.approx(end[2], abs=1e-4)
    ours, theirs = (
        Rotation.from_quat(q[3:7], scalar_first=True).as_matrix()[2] for q in (found.qpos, end)
    )
    assert math.degrees(math.atan2(np.linalg.norm(np.cross(ours, theirs)), ours @ theirs)) < 0.05


def test_a_scene_may_start_there():
    start = Start(position=(1.0, 2.0, 3.0), roll=0.5, yaw=0.7, at="equilibrium")
    simulation = Simulation(Scene(title="rest", vehicle="sauvc_auv", start=start, duration=2.0))
    frames = list(simulation.frames())
    heights = [frame.centre_of_mass[2] for frame in frames]
    assert np.ptp(heights) < 1e-6
    assert frames[0].data.qpos[:2] == pytest.approx([1.0, 2.0])
    assert frames[-1].attitude == pytest.approx([0.0, 0.0, 0.7], abs=1e-4)


def test_a_scene_that_starts_at_something_else_is_told():
    with pytest.raises(
        SceneError, match=r"start.at is 'anchor'; possible: equilibrium, or leave it out"
    ):
        Start(at="anchor")


def test_a_scene_that_cannot_float_is_told():
    with pytest.raises(EquilibriumError, match="sinks"):
        Simulation(
            Scene(title="heavy", vehicle="sauvc_auv", mass=40.0, start=Start(at="equilibrium"))
        )


def test_the_wetted_part_is_that_of_its_own_mesh():
    found = equilibrium(vessels.of_mesh(shapes.box((1, 0.5, 0.3)), 600.0), start=tilted(0.2))
    assert found.hydrostatics.wetted_area == pytest.approx(2.0 + 2 * 0.3 * 3.0, rel=1e-6)


@pytest.mark.parametrize("model", ["my_auv.xml", None, mujoco.MjSpec()])
def test_what_is_no_model_is_refused(model):
    for ask in (equilibrium, hydrostatics, Buoyancy):
        with pytest.raises(ModelError, match=r"^model is .*; it must be an MjModel, as mujoco\.M"):
            ask(model)


@pytest.mark.parametrize("start", ["x", {}, 3.0, [[1], [1, 2]]])
def test_coordinates_that_are_no_numbers_are_refused(start):
    with pytest.raises(ModelError, match=r"^qpos is .*; it must be 7 finite coordinates"):
        equilibrium(vessels.box(), start=start)


def test_what_is_no_selection_is_refused():
    for ask in (equilibrium, hydrostatics, Buoyancy):
        with pytest.raises(ModelError, match=r"^selection is 3; it must be Selection\(geoms="):
            ask(vessels.box(), selection=3)


def test_statics_in_what_is_no_water_are_refused():
    with pytest.raises(ModelError, match=r"^water is 3; it must be a Water, as Water\(density"):
        equilibrium(vessels.box(), 3)
