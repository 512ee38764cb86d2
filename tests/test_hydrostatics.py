"""Closed forms, published ships and vehicles, another code, finite differences of the forces."""

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
    BuoyancyWarning,
    ModelError,
    RegularWave,
    Selection,
    Water,
    hydrostatics,
    repair,
)
from buoyancy_mj.meshes import shapes
from buoyancy_mj.statics.building import build_vessel
from tests import naive, vessels


def at(height, turn=None, x=0.0, y=0.0):
    """Coordinates of a free joint."""
    quat = (turn or Rotation.identity()).as_quat(scalar_first=True)
    return [x, y, height, *quat]


# closed forms


def test_a_box_has_its_metacentric_heights_and_periods():
    # B = 1, L = 2, T = 0.3: KB = T / 2, BM = B^2 / (12 T), KG = 0.3; T_heave = 2 pi sqrt(T / g)
    found = hydrostatics(vessels.box())
    assert (found.displacement, found.volume) == pytest.approx((600.0, 0.6), rel=1e-12)
    assert (found.draft, found.KB, found.KG) == pytest.approx((0.3, 0.15, 0.3), rel=1e-12)
    assert (found.BMt, found.GMt, found.KMt) == pytest.approx(
        (1 / 3.6, 0.127778, 0.15 + 1 / 3.6), abs=1e-6
    )
    assert found.BMl == pytest.approx(4 / 3.6, rel=1e-12)
    assert pytest.approx(found.GMt, rel=1e-12) == found.GM
    assert (found.waterline_length, found.waterline_beam) == pytest.approx((2.0, 1.0), rel=1e-12)
    assert found.wetted_area == pytest.approx(2.0 + 2 * 0.3 * 3.0, rel=1e-12)
    assert found.reserve == pytest.approx(600.0, rel=1e-12)
    heave, roll, _ = found.natural_periods()
    assert (heave, roll) == pytest.approx((1.0988, 1.8893), abs=5e-5)


@pytest.mark.parametrize(
    ("beam", "stable"), [(0.30, False), (0.7071, True), (0.8165 * 0.999 * 0.5, False)]
)
def test_the_floating_cuboid_of_openfoam_wants_to_tip_and_a_wide_one_not(beam, stable):
    # P21, OpenFOAM's floatingObject: 0.3 x 0.2 x 0.5 tall, 500 kg/m^3, draft 0.25, upright GM =
    # 0.125 + B^2 / 3 - 0.25
    found = hydrostatics(vessels.box((0.1, 0.5 * beam, 0.25), 500.0 * 0.2 * beam * 0.5))
    assert found.draft == pytest.approx(0.25, rel=1e-9)
    assert found.GMt == pytest.approx(0.125 + beam**2 / 3.0 - 0.25, rel=1e-9)
    assert (found.GMt > 0.0) == stable
    assert found.natural_periods()[0] == pytest.approx(1.003, abs=5e-4)


@pytest.mark.parametrize(
    ("ratio", "draft", "gm", "apex_up"),
    # P4: a cone of half angle 45 degrees, height 1, relative density c
    [
        (0.2, 0.584804, 0.127205, False),
        (0.5, 0.793701, 0.440551, False),
        (0.8, 0.928318, 0.642477, False),
        (0.2, 0.071682, 2.569907, True),
        (0.5, 0.206299, 0.440551, True),
        (0.8, 0.415197, 0.031801, True),
    ],
)
def test_cones_have_their_metacentric_height(ratio, draft, gm, apex_up):
    mesh = naive.cone(1.0, 1.0, sections=720, apex_up=apex_up)
    model = vessels.of_mesh(mesh, ratio * 1000.0 * mesh.volume, mesh.centroid)
    found = hydrostatics(model, qpos=at(-draft))
    assert (found.GMt, found.GMl) == pytest.approx((gm, gm), rel=1e-4)
    assert found.draft == pytest.approx(draft, abs=1e-7)


def test_the_wigley_hull_has_its_closed_forms():
    # P10 with L 2.5, B 0.25, T 0.15625: V 4/9 LBT, Awp 2/3 LB, VCB -3/8 T, BM_T 3/35 B^2/T, BM_L
    # 3/40 L^2/T
    found = hydrostatics(vessels.of_mesh(vessels.wigley(), 43.4))
    assert found.volume == pytest.approx(0.0434028, rel=1e-4)
    assert found.waterplane_area == pytest.approx(2 / 3 * 2.5 * 0.25, rel=1e-4)
    assert found.centre_of_buoyancy[2] == pytest.approx(-0.375 * 0.15625, rel=1e-4)
    # the diagonals of its 200 stations lean one way: L / 200^2
    assert found.centre_of_buoyancy[:2] == pytest.approx([0, 0], abs=2.5 / 200**2)
    assert (found.BMt, found.BMl) == pytest.approx((0.0342857, 3.0), rel=1e-4)
    assert (found.waterline_length, found.waterline_beam) == pytest.approx((2.5, 0.25), rel=1e-6)
    assert found.draft == pytest.approx(0.15625, rel=1e-6)


@given(st.integers(0, 10**6), st.floats(0.1, 0.9))
@settings(max_examples=25)
def test_turned_over_a_body_keeps_the_product_of_volume_and_metacentric_height(seed, ratio):
    # P7: a homogeneous body of relative density c, and turned over at 1 - c
    mesh = vessels.dented(seed)
    model = vessels.of_mesh(mesh, 1.0, mesh.centroid)
    height = naive.floating(mesh, ratio * mesh.volume)
    upright = hydrostatics(model, qpos=at(height))
    over = hydrostatics(model, qpos=at(-height, Rotation.from_rotvec([math.pi, 0, 0])))
    assert over.volume == pytest.approx((1.0 - ratio) * mesh.volume, rel=1e-5)
    size = mesh.volume ** (4 / 3)
    assert over.volume * over.GMt == pytest.approx(upright.volume * upright.GMt, abs=1e-6 * size)
    assert over.volume * over.GMl == pytest.approx(upright.volume * upright.GMl, abs=1e-6 * size)


# published


def test_the_tanker_of_mss_has_the_hydrostatics_that_wamit_gives():
    # P12: WAMIT volumes 92309.5, 92313.2, 92314.5, CB (3.9259, 0, -4.8155), C33 10221.5, C35 31916,
    # C44 9.2149e5 from the centroids of its panels (an exact cut gives 9.25441e5), C55 4.3472e7;
    # about CG (3.93, 0, 2.5), over rho g
    mesh, notices = repair(*vessels.tanker())
    assert "36 holes with 392 edges" in notices[-1]
    model = vessels.of_mesh(mesh, 1025.0 * 92313.2, (3.93, 0.0, 2.5))
    with pytest.warns(BuoyancyWarning, match="257 m long"):
        found = hydrostatics(model, Water(density=1025.0))
    # WAMIT turns about the origin of its file
    about_origin = np.eye(6)
    about_origin[2, 4] = -3.93
    stiffness = about_origin.T @ found.stiffness @ about_origin / (1025.0 * 9.81)
    assert found.volume == pytest.approx(92313.2, rel=1e-4)
    assert found.centre_of_buoyancy == pytest.approx([3.9259, 0.0, -4.8155], abs=5e-3)
    assert stiffness[2, 2] == pytest.approx(10221.5, rel=1e-5)
    assert stiffness[2, 4] == pytest.approx(31916, rel=1e-3)
    assert stiffness[3, 3] == pytest.approx(9.25441e5, rel=1e-4)
    assert stiffness[3, 3] == pytest.approx(9.2149e5, rel=5e-3)
    assert stiffness[4, 4] == pytest.approx(4.3472e7, rel=1e-3)


def test_the_float_of_rm3_has_its_volume_and_waterplane():
    # P13: at z = 0.72 of its frame the mesh has V 728.382, Awp 284.763; WAMIT's panels gave
    # 725.834, 285.52
    found = hydrostatics(vessels.of_mesh(vessels.rm3_float(), 725834.0), qpos=at(-0.72))
    assert found.volume == pytest.approx(728.382, abs=1e-3)
    assert found.waterplane_area == pytest.approx(284.763, abs=1e-3)
    assert found.volume == pytest.approx(725.834, rel=4e-3)


def submerged(mass, volume, over, inertia, density):
    """A deeply submerged ellipsoid of a volume, its centre of gravity below its middle."""
    a = (volume / (4 / 3 * math.pi)) ** (1 / 3)
    moments = " ".join(map(str, inertia))
    inertial = f'<inertial pos="0 0 {-over}" mass="{mass}" diaginertia="{moments}"/>'
    model = vessels.of_geoms(f'<geom type="ellipsoid" size="{1.5 * a} {a} {a / 1.5}"/>', inertial)
    return hydrostatics(model, Water(density=density), qpos=at(-5.0))


def test_the_bluerov2_heavy_swings_with_its_periods():
    # P18: von Benzon et al. 2022, J. Mar. Sci. Eng. 10(12):1898, table of parameters; B z_b phi
    # over I, and over I + A
    found = submerged(13.5, 0.0134, 0.01, (0.26, 0.23, 0.37), 1000.0)
    assert found.reserve == pytest.approx(-0.1, rel=1e-9)
    assert found.natural_periods()[1:] == pytest.approx([2.794, 2.628], rel=1e-3)
    added = (6.36, 7.12, 18.68, 0.189, 0.135, 0.222)
    assert found.natural_periods(added)[1:] == pytest.approx([3.672, 3.311], rel=1e-3)
    assert math.isinf(found.natural_periods()[0])
    assert (found.waterplane_area, found.GMt, found.GMl) == pytest.approx(
        (0.0, 0.01, 0.01), rel=1e-9
    )
    # the restoring matrix of Fossen for W and B at r_g = 0, r_b = (0, 0, -z_b): diag(z_b B, z_b B)
    # for small angles
    assert found.stiffness[3:5, 3:5] == pytest.approx(np.diag([1.31454] * 2), rel=1e-6)


def test_the_remus_100_swings_with_its_periods():
    # P19: Fossen's Python vehicle simulator: a spheroid L 1.6, D 0.19 in rho 1026, W = B, CG 0.02 m
    # below CB, added moment in roll 0.3 I_x; periods 0.8523 and 5.1107 s dry, 1.0123 s and 6.958 s
    # about CB, 0.9917 and 6.953 coupled
    a, b, density, drop = 0.8, 0.095, 1026.0, 0.02
    mass = density * 4 / 3 * math.pi * a * b * b
    ix, iy = 0.4 * mass * b * b, 0.2 * mass * (a * a + b * b)
    inertial = f'<inertial pos="0 0 {-drop}" mass="{mass}" diaginertia="{ix} {iy} {iy}"/>'
    model = vessels.of_geoms(f'<geom type="ellipsoid" size="{a} {b} {b}"/>', inertial)
    found = hydrostatics(model, Water(density=density), qpos=at(-5.0))
    assert mass == pytest.approx(31.029, abs=2e-3)
    assert found.natural_periods()[1:] == pytest.approx([0.8523, 5.1107], rel=1e-3)
    # Lamb's spheroid (Fossen 2021, sec. 8.4), about its centre
    e = math.sqrt(1.0 - (b / a) ** 2)
    log = math.log((1 + e) / (1 - e))
    alpha, beta = (
        2 * (1 - e * e) / e**3 * (0.5 * log - e),
        1 / e**2 - (1 - e * e) / (2 * e**3) * log,
    )
    k1, k2 = alpha / (2 - alpha), beta / (2 - beta)
    k5 = e**4 * (beta - alpha) / ((2 - e * e) * (2 * e * e - (2 - e * e) * (beta - alpha)))
    # roll about the centre of buoyancy: 0.3 of the moment there
    about_middle = np.diag([k1 * mass, k2 * mass, k2 * mass, 0.3 * ix, k5 * iy, k5 * iy])
    rise = np.eye(6)
    rise[0, 4], rise[1, 3] = drop, -drop
    periods, _ = found.modes(rise.T @ about_middle @ rise)
    assert periods == pytest.approx([0.9917, 6.953], rel=2e-3)


def test_the_otter_has_its_metacentres_and_restoring_matrix():
    # P19: Otter of Fossen's simulator: 80 kg, draft 0.195122, nabla 0.0780488, Awp 0.75, KB
    # 0.136585, BM_T 1.537912, BM_L 3.416667, KG 0.441997, GM_T 1.2325, GM_L 3.111255, G33 7541.44,
    # G44 967.27, G55 2441.71; its draft is a formula and no mesh: this one has two wall-sided
    # pontoons on narrower feet that have just these numbers
    draft, volume, area = 0.195122, 0.0780488, 0.75
    length = math.sqrt(12 * 3.416667 * volume / area)
    width = area / 2 / length
    apart = math.sqrt((1.537912 * volume - area / 12 * width**2) / area)
    full, high = volume / (area * draft), 0.136585 / draft * volume / (area * draft)
    # of unit draft and width: w h + (1 - h) = full; w h^2 / 2 + (1 - h^2) / 2 = high
    rise = (1.0 - 2.0 * high) / (1.0 - full)
    narrow = (full - 1.0 + rise) / rise
    half = 0.5 * length
    geoms = "".join(
        f'<geom type="box" size="{half} {0.5 * narrow * width} {0.5 * rise * draft}" '
        f'pos="0 {side} {(0.5 * rise - 1) * draft}"/>'
        f'<geom type="box" size="{half} {0.5 * width} {0.5 * (1 - rise) * draft + 0.05}" '
        f'pos="0 {side} {0.5 * (rise - 1) * draft + 0.05}"/>'
        for side in (apart, -apart)
    )
    inertial = f'<inertial pos="0 0 {0.441997 - draft}" mass="80" diaginertia="10 10 10"/>'
    found = hydrostatics(vessels.of_geoms(geoms, inertial), Water(density=1025.0))
    assert found.displacement == pytest.approx(80.0, rel=1e-6)
    assert (found.KB, found.BMt, found.BMl) == pytest.approx(
        (0.136585, 1.537912, 3.416667), rel=1e-5
    )
    assert (found.GMt, found.GMl) == pytest.approx((1.232500, 3.111255), rel=1e-5)
    assert np.diag(found.stiffness)[2:5] == pytest.approx([7541.44, 967.27, 2441.71], rel=1e-4)


# another code


@pytest.mark.parametrize(
    ("name", "height", "roll", "pitch"),
    [
        ("dented", 0.1, 0.4, -0.3),
        ("dented", -5.0, 1.0, 0.2),
        ("torus", 0.0, 0.3, 0.1),
        ("box", 0.05, 0.0, 0.0),
        ("several", 0.0, 0.1, 0.1),
    ],
)
def test_everything_equals_capytaine_on_the_same_mesh(name, height, roll, pitch):
    capytaine = pytest.importorskip("capytaine")
    if name == "several":
        model = vessels.of_geoms(
            # boxes: Capytaine's cut has a tolerance of 1e-8 m, which small triangles feel
            '<geom type="box" size="1 .3 .3" pos="0 .8 0" mass="200"/>'
            '<geom type="box" size=".7 .2 .2" pos="0 -.8 -.1" euler="0 30 10" mass="100"/>'
        )
    else:
        mesh = {
            "dented": vessels.dented(7),
            "torus": naive.trimesh_hull(trimesh.creation.torus(1.0, 0.4)),
            "box": shapes.box((1.0, 0.5, 0.3)),
        }[name]
        model = vessels.of_mesh(mesh, 300.0, (0.1, -0.05, -0.1))
    turn = Rotation.from_euler("YX", [pitch, roll])
    vessel = build_vessel(model, qpos=at(height, turn))
    found = hydrostatics(model, qpos=at(height, turn))
    # Capytaine's axes are the world's; the vessel heads along x
    assert found.heading == pytest.approx(0.0, abs=1e-12)
    parts = [mesh.transformed(vessel.rotation, vessel.position) for mesh in vessel.meshes]
    whole = capytaine.Mesh(
        vertices=np.vstack([part.vertices for part in parts]),
        faces=np.vstack(
            [
                p.faces + n
                for p, n in zip(
                    parts, np.cumsum([0] + [len(p.vertices) for p in parts]), strict=False
                )
            ]
        ),
    ).with_quadrature("Gauss-Legendre 2")
    body = capytaine.FloatingBody(
        mesh=whole,
        dofs=capytaine.rigid_body_dofs(rotation_center=vessel.position),
        center_of_mass=vessel.position,
        mass=vessel.mass,
    )
    size = vessel.radius
    assert found.volume == pytest.approx(body.disp_volume, rel=1e-8)
    assert found.centre_of_buoyancy == pytest.approx(body.center_of_buoyancy, abs=1e-8 * size)
    assert found.wetted_area == pytest.approx(body.wet_surface_area, rel=1e-8)
    assert found.waterplane_area == pytest.approx(
        body.waterplane_area, rel=1e-8, abs=1e-8 * size**2
    )
    if found.waterplane_area:
        assert found.centre_of_flotation[:2] == pytest.approx(
            body.waterplane_center, abs=1e-8 * size
        )
    stiffness = body.compute_hydrostatic_stiffness(rho=1000.0, g=9.81).to_numpy()
    assert found.stiffness == pytest.approx(stiffness, abs=1e-8 * 1000.0 * 9.81 * size**3)


# derivatives


def forces_at(model, qpos):
    """Force and torque of water and weight about the centre of gravity, by the engine itself."""
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    loads = Buoyancy(model, damping=None).evaluate(data)
    centre = data.subtree_com[1]
    mass = model.body_mass.sum()
    hull = loads.hull
    held = hull.volume > 0.0
    torque = np.cross(hull.centroid[held] - centre, hull.force[held]).sum(axis=0)
    return np.concatenate([hull.force.sum(axis=0) + mass * model.opt.gravity, torque])


@pytest.mark.parametrize("seed", range(6))
def test_stiffness_is_minus_the_derivative_of_the_exact_forces(seed):
    rng = np.random.default_rng(seed)
    mesh = vessels.dented(seed)
    model = vessels.of_mesh(
        mesh, 0.5 * 1000.0 * mesh.volume, mesh.centroid + rng.uniform(-0.1, 0.1, 3)
    )
    turn, height = Rotation.random(random_state=seed), rng.uniform(-0.2, 0.2)
    found = hydrostatics(model, qpos=at(height, turn, *rng.uniform(-9, 9, 2)))
    centre = found.centre_of_gravity
    yaw = np.eye(6)
    axes = Rotation.from_rotvec([0, 0, found.heading]).as_matrix().T
    yaw[:3, :3] = yaw[3:, 3:] = axes
    step = 1e-5
    for column in range(6):
        ends = []
        for sign in (1.0, -1.0):
            motion = yaw.T @ (sign * step * np.eye(6)[column])
            moved = Rotation.from_rotvec(motion[3:]) * turn
            place = centre + motion[:3] - moved.apply(model.body_ipos[1])
            ends.append(yaw @ forces_at(model, [*place, *moved.as_quat(scalar_first=True)]))
        slope = -(ends[0] - ends[1]) / (2.0 * step)
        assert found.stiffness[:, column] == pytest.approx(
            slope, abs=1e-4 * np.abs(found.stiffness).max()
        )


# vehicles


def test_an_articulated_vehicle_is_measured_at_its_joint_angles():
    # a raft with a weight on an arm, turned up and down
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><worldbody><body name="raft" pos="3 2 0"><freejoint/>
        <geom type="box" size="1 .5 .2" mass="200"/>
        <body name="mast" pos="0 0 .2"><joint name="fold" type="hinge" axis="0 1 0"/>
        <geom type="capsule" fromto="0 0 0 0 0 1" size=".02" mass="10"/></body></body>
        </worldbody></mujoco>"""
    )
    up = hydrostatics(model)
    # folded into the water over the bow
    down = hydrostatics(model, qpos=[*model.qpos0[:7], math.radians(135)])
    assert up.centre_of_gravity == pytest.approx([3, 2, 10 * 0.7 / 210], rel=1e-12)
    s = math.sin(math.radians(135))
    assert down.centre_of_gravity == pytest.approx(
        [3 + 10 * 0.5 * s / 210, 2, 10 * (0.2 - 0.5 * s) / 210], rel=1e-12
    )
    assert up.volume == pytest.approx(0.4, rel=1e-12)
    assert down.volume > 0.4
    assert up.mass_matrix[4, 4] > down.mass_matrix[4, 4] > 200 * (2**2 + 0.4**2) / 12
    assert up.whole_volume == pytest.approx(down.whole_volume, rel=1e-12)


def test_flooded_parts_count_in_part():
    geoms = '<geom name="pod" type="box" size="1 .5 .3" mass="300"/>'
    whole, part = (
        hydrostatics(vessels.of_geoms(geoms), selection=Selection(fill=fill))
        for fill in (None, "pod=0.5")
    )
    assert part.volume == pytest.approx(0.5 * whole.volume, rel=1e-12)
    assert part.waterplane_area == pytest.approx(0.5 * whole.waterplane_area, rel=1e-12)
    assert part.BMt == pytest.approx(whole.BMt, rel=1e-12)
    assert part.wetted_area == pytest.approx(whole.wetted_area, rel=1e-12)


@given(st.floats(-100, 100), st.floats(-100, 100), st.floats(-3.1, 3.1), st.floats(-50, 50))
@settings(max_examples=25)
def test_nothing_changes_where_the_vessel_stands_or_which_way_it_heads(x, y, yaw, level):
    model = vessels.of_mesh(vessels.dented(3), 400.0, (0.1, 0.05, -0.1))
    attitude = Rotation.from_euler("ZYX", [0.0, 0.2, -0.4])
    base = hydrostatics(model, qpos=at(0.1, attitude))
    turned = Rotation.from_euler("z", yaw)
    moved = hydrostatics(model, Water(level=level), at(0.1 + level, turned * attitude, x, y))
    for name in (
        "volume",
        "wetted_area",
        "waterplane_length",
        "GMt",
        "GMl",
        "GM",
        "draft",
        "trim",
        "heel",
    ):
        name = name.replace("waterplane_length", "waterline_length")
        assert getattr(moved, name) == pytest.approx(getattr(base, name), rel=1e-8, abs=1e-9)
    assert moved.stiffness == pytest.approx(base.stiffness, rel=1e-7, abs=1e-5)
    assert moved.mass_matrix == pytest.approx(base.mass_matrix, abs=1e-9 * 400)
    assert moved.centre_of_buoyancy == pytest.approx(
        turned.apply(base.centre_of_buoyancy) + [x, y, level], abs=1e-8
    )


def test_in_the_air_nothing_is_wet_and_nothing_breaks():
    found = hydrostatics(vessels.box(), qpos=at(9.0))
    assert (found.volume, found.wetted_area, found.waterplane_area, found.waterline_length) == (
        0.0,
        0.0,
        0.0,
        0.0,
    )
    assert found.draft == pytest.approx(-8.7)
    assert math.isnan(found.GMt)
    assert np.isinf(found.natural_periods()).all()
    assert len(found.modes()[0]) == 0


def test_waves_and_current_are_left_aside():
    sea = Water(waves=RegularWave(amplitude=0.3, frequency=0.5), current=(1.0, 0.0, 0.0), level=1.0)
    assert hydrostatics(vessels.box(), sea, at(1.0)).volume == pytest.approx(0.6, rel=1e-12)


def test_of_several_vehicles_one_is_named():
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><worldbody>
        <body name="tug"><freejoint/><geom type="box" size="1 .5 .3"/></body>
        <body name="barge" pos="0 9 0"><freejoint/><geom type="box" size="2 .5 .3"/></body>
        </worldbody></mujoco>"""
    )
    assert hydrostatics(model).volume == pytest.approx(0.6)
    assert hydrostatics(model, body="barge").volume == pytest.approx(1.2)
    assert hydrostatics(model, body="barge", qpos=at(0.1)).volume == pytest.approx(0.8)
    with pytest.raises(
        ModelError,
        match=r"no body 'barg' floats in this model; did you mean 'barge'\? possible: barge, tug",
    ):
        hydrostatics(model, body="barg")


@pytest.mark.parametrize(
    ("options", "arguments", "message"),
    [
        ('gravity="0 0 0"', {}, "gravity is 0 0 0; water needs it along -z"),
        ('gravity="1 0 -9"', {}, "gravity is 1 0 -9; water needs it along -z"),
        (
            "",
            {"qpos": [0, 0, 0]},
            r"qpos has shape \(3,\); it must be 7 finite coordinates of the model, or position and",
        ),
        ("", {"qpos": [0, 0, math.nan, 1, 0, 0, 0]}, "must be 7 finite coordinates"),
        ("", {"selection": Selection(geoms="keel")}, "no moving geom matches 'keel'"),
    ],
)
def test_what_makes_no_sense_is_told(options, arguments, message):
    model = vessels.of_geoms('<geom type="box" size="1 .5 .3"/>', options=options)
    with pytest.raises(ModelError, match=message):
        hydrostatics(model, **arguments)


@pytest.mark.parametrize("added", [3.0, [1, 2, 3], [[1]], [math.nan] * 6])
def test_an_added_mass_of_another_shape_is_told(added):
    with pytest.raises(ModelError, match="it must be finite, a diagonal"):
        hydrostatics(vessels.box()).natural_periods(added)
