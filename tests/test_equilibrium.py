"""Rest poses: classic bodies, where the simulated vehicle comes to rest, what cannot float."""

import math

import mujoco
import numpy as np
import pytest
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
    Water,
    equilibria,
    equilibrium,
)
from buoyancy_mj.meshes import shapes
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.specs import read_spec
from tests import naive, vessels


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
