"""Still water and waves on single meshes: closed forms, an independent slice, invariances."""

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from buoyancy_mj import MeshError, RegularWave, TriMesh, Water, submerge
from buoyancy_mj.meshes import shapes
from buoyancy_mj.meshes.refinement import refine
from buoyancy_mj.submersion import exact
from buoyancy_mj.submersion.hull_set import HullSet
from buoyancy_mj.submersion.wetted_surface import cut_wetted_surface
from tests import naive
from tests.naive import trimesh_hull

SPHERE = trimesh_hull(trimesh.creation.icosphere(subdivisions=6))
TORUS = trimesh_hull(trimesh.creation.torus(1.0, 0.4, major_sections=40, minor_sections=20))
HOURGLASS = naive.two_cones(0.5, 1.0, sections=64)
PIECES = TriMesh(
    np.vstack(
        [shapes.box((0.3, 0.2, 0.1)).vertices + [1.0, 0.0, 0.2], shapes.sphere(0.4).vertices]
    ),
    np.vstack([shapes.box((0.3, 0.2, 0.1)).faces, shapes.sphere(0.4).faces + 8]),
)
ODD = {
    "torus": TORUS,
    "hourglass": HOURGLASS,
    "pieces": PIECES,
    "capsule": shapes.capsule(0.3, 0.6),
}


def turned(seed):
    return Rotation.random(random_state=seed).as_matrix()


# closed forms


@pytest.mark.parametrize(
    ("draft", "volume", "offset"),
    [
        (0.2, 0.117286, 0.867857),
        (0.5, 0.654498, 0.675),
        (1.0, 2.094395, 0.375),
        (1.5, 3.534292, 0.125),
    ],
)
def test_a_sphere_cap_has_its_volume_and_centroid(draft, volume, offset):
    # V = pi h^2 (3 R - h) / 3, centroid 3 (2 R - h)^2 / (4 (3 R - h)) below the centre
    wet = submerge(SPHERE, (0.0, 0.0, 1.0 - draft))
    assert wet.volume == pytest.approx(volume, abs=3e-4 * 4.18879)
    assert wet.centroid == pytest.approx([0.0, 0.0, 1.0 - draft - offset], abs=1e-3)


def test_a_sphere_cap_converges_with_the_square_of_the_edge():
    errors = []
    for subdivisions in (2, 3, 4, 5):
        mesh = trimesh_hull(trimesh.creation.icosphere(subdivisions=subdivisions))
        errors.append(abs(submerge(mesh, (0.0, 0.0, 0.5)).volume - np.pi * 0.25 * 2.5 / 3.0))
    assert np.array(errors[:-1]) / errors[1:] == pytest.approx([4.0] * 3, rel=0.25)


@pytest.mark.parametrize(
    ("draft", "volume", "offset"),
    [
        (0.1, 0.0817506, 0.4403640),
        (0.25, 0.3070925, 0.3525101),
        (0.5, 0.7853982, 0.2122066),
        (0.75, 1.2637039, 0.0856634),
    ],
)
def test_a_lying_cylinder_has_its_segment(draft, volume, offset):
    # A = r^2 acos((r - h) / r) - (r - h) sqrt(2 r h - h^2); centroid c^3 / (12 A) below the axis
    solid = trimesh.creation.cylinder(radius=0.5, height=2.0, sections=1024)
    turn = naive.roll(np.pi / 2.0)
    wet = submerge(trimesh_hull(solid), (0.0, 0.0, 0.5 - draft), turn)
    assert wet.volume == pytest.approx(volume, rel=1e-4)
    assert wet.centroid[2] == pytest.approx(0.5 - draft - offset, abs=1e-4)


@pytest.mark.parametrize(
    ("heel", "arm"),
    [
        (10, 0.0229382),
        (20, 0.0499955),
        (25, 0.0667645),
        (35, 0.1055164),
        (45, 0.1131371),
        (60, 0.09),
    ],
)
def test_a_heeled_box_has_its_righting_arm_past_the_deck_edge_too(heel, arm):
    # GZ = sin phi (GM + BM tan^2 phi / 2) up to 30.96 degrees; beyond, the exact section
    box = shapes.box((1.0, 0.5, 0.3))
    assert naive.righting_arm(box, np.zeros(3), 0.6, np.radians(heel)) == pytest.approx(
        arm, abs=6e-8
    )


def test_a_box_has_its_metacentric_height():
    assert naive.metacentric_height(shapes.box((1.0, 0.5, 0.3)), np.zeros(3), 0.6) == pytest.approx(
        0.127778, abs=1e-6
    )


def test_the_floating_cuboid_of_openfoam_wants_to_tip():
    # 0.3 x 0.2 x 0.5 m at half density: GM = 0.125 + B^2 / (12 T) - 0.25 = -0.095
    box = shapes.box((0.1, 0.15, 0.25))
    assert naive.metacentric_height(box, np.zeros(3), 0.015) == pytest.approx(-0.095, abs=1e-6)


@pytest.mark.parametrize(
    ("ratio", "up_draft", "up_gm", "down_draft", "down_gm"),
    [
        (0.2, 0.071682, 2.569907, 0.584804, 0.127205),
        (0.5, 0.206299, 0.440551, 0.793701, 0.440551),
        (0.8, 0.415197, 0.031801, 0.928318, 0.642477),
    ],
)
def test_cones_float_at_their_draft_with_their_metacentric_height(
    ratio, up_draft, up_gm, down_draft, down_gm
):
    # half-angle 45 degrees, height and radius 1, uniform density; apex down T = c^(1/3)
    volume = ratio * np.pi / 3.0
    for apex_up, draft, gm, centre in (
        (True, up_draft, up_gm, 0.25),
        (False, down_draft, down_gm, 0.75),
    ):
        mesh = naive.cone(1.0, 1.0, apex_up=apex_up)
        assert -naive.floating(mesh, volume) == pytest.approx(draft, abs=2e-5)
        assert naive.metacentric_height(
            mesh, np.array([0.0, 0.0, centre]), volume
        ) == pytest.approx(gm, abs=2e-4)


@given(st.integers(0, 1000), st.floats(0.2, 0.8))
def test_turned_over_a_body_keeps_the_product_of_volume_and_metacentric_height(seed, ratio):
    # reflection rule: V GM at density ratio c equals that of the body turned over at 1 - c
    rng = np.random.default_rng(seed)
    mesh = trimesh_hull(trimesh.convex.convex_hull(rng.normal(size=(20, 3))))
    mesh = mesh.transformed(np.eye(3), -mesh.centroid)
    over = mesh.transformed(naive.roll(np.pi))
    one, two = ratio * mesh.volume, (1.0 - ratio) * mesh.volume
    gm = [
        naive.metacentric_height(m, np.zeros(3), v, heel=s * 1e-5)
        for m, v in ((mesh, one), (over, two))
        for s in (1, -1)
    ]
    assert one * (gm[0] + gm[1]) == pytest.approx(two * (gm[2] + gm[3]), rel=1e-3, abs=1e-4)


def test_an_ellipsoid_cut_askew_has_its_segment():
    # q = |(a nx, b ny, c nz)|, h = d / q, V = pi abc (1 + h)^2 (2 - h) / 3; a, b, c = 0.5, 0.3, 0.2
    normal = np.array([0.3, -0.2, 0.93])
    normal /= np.linalg.norm(normal)
    mesh = TriMesh(SPHERE.vertices * [0.5, 0.3, 0.2], SPHERE.faces)
    turn = Rotation.align_vectors([[0.0, 0.0, 1.0]], [normal])[0].as_matrix()
    wet = submerge(mesh, (0.0, 0.0, -0.05), turn)
    assert wet.volume == pytest.approx(0.08165, abs=5e-5)
    assert turn.T @ (wet.centroid + [0, 0, 0.05]) == pytest.approx(
        [-0.0807965, 0.0193912, -0.0400751], abs=5e-5
    )


@pytest.mark.parametrize(
    ("draft", "volume"),
    [(0.25, 0.1513528), (0.5, 0.2290745), (1.0, 0.2617994), (1.5, 0.2945243), (2.0, 0.5235988)],
)
def test_an_hourglass_of_two_cones_has_its_volume_through_the_neck(draft, volume):
    # V = (pi R^2 H / 3) (1 - (1 - z / H)^3) for all 0 <= z <= 2 H
    mesh = naive.two_cones(0.5, 1.0)
    assert submerge(mesh, (0.0, 0.0, 1.0 - draft)).volume == pytest.approx(volume, abs=1e-7)


# an independent slice, and invariances


@pytest.mark.parametrize("name", ODD)
@pytest.mark.parametrize("seed", range(8))
def test_volume_and_centroid_equal_those_of_a_capped_slice(name, seed):
    mesh, turn = ODD[name], turned(seed)
    position = np.array([3.0, -2.0, np.random.default_rng(seed).uniform(-0.5, 0.5) * mesh.radius])
    volume, centroid = naive.sliced(mesh, position, turn)
    wet = submerge(mesh, position, turn)
    assert wet.volume == pytest.approx(volume, abs=1e-12 * mesh.volume)
    assert wet.centroid == pytest.approx(centroid, abs=1e-10)


@given(st.integers(0, 10**6))
def test_any_convex_solid_agrees_with_a_capped_slice(seed):
    rng = np.random.default_rng(seed)
    mesh = trimesh_hull(trimesh.convex.convex_hull(rng.normal(size=(12, 3))))
    position, turn = rng.uniform(-0.5, 0.5, 3), turned(seed)
    volume, _ = naive.sliced(mesh, position, turn)
    assert submerge(mesh, position, turn).volume == pytest.approx(volume, abs=1e-12 * mesh.volume)


@pytest.mark.parametrize("name", ODD)
def test_a_dry_hull_displaces_nothing_and_a_wet_one_all_of_itself(name):
    mesh, turn = ODD[name], turned(3)
    dry, wet = submerge(mesh, (0, 0, 5), turn), submerge(mesh, (0, 0, -5), turn)
    assert (dry.volume, dry.wetted_area, dry.waterplane_area) == (0.0, 0.0, 0.0)
    assert np.isnan(dry.centroid).all()
    assert wet.volume == pytest.approx(mesh.volume, rel=1e-14)
    assert wet.centroid == pytest.approx(turn @ mesh.centroid + [0, 0, -5], abs=1e-13)
    assert wet.wetted_area == pytest.approx(mesh.area, rel=1e-14)
    assert wet.waterplane_area == 0.0


@pytest.mark.parametrize("height", [0.3, -0.3, 0.0, 0.1, -0.1])
def test_the_surface_may_pass_through_vertices_edges_and_faces(height):
    box = shapes.box((1.0, 0.5, 0.3))
    wet = submerge(box, (0.0, 0.0, height))
    assert wet.volume == pytest.approx(2.0 * (0.3 - height), abs=1e-12)
    corner_up = Rotation.align_vectors([[0.0, 0.0, 1.0]], [[1.0, 1.0, 1.0]])[0].as_matrix()
    cube = shapes.box((0.5, 0.5, 0.5))
    # through three corners of the cube: a sixth of it
    assert submerge(cube, (0, 0, np.sqrt(3.0) / 6.0), corner_up).volume == pytest.approx(
        1.0 / 6.0, abs=1e-12
    )


@given(st.floats(-1e4, 1e4), st.floats(-1e4, 1e4), st.floats(-np.pi, np.pi), st.integers(0, 1000))
def test_nothing_changes_where_the_hull_stands_or_which_way_it_points(x, y, yaw, seed):
    turn, spin = turned(seed), Rotation.from_euler("z", yaw).as_matrix()
    here, there = submerge(TORUS, (0, 0, 0.1), turn), submerge(TORUS, (x, y, 0.1), spin @ turn)
    assert there.volume == pytest.approx(here.volume, rel=1e-12)
    assert there.centroid == pytest.approx(spin @ here.centroid + [x, y, 0.0], abs=1e-8)
    assert there.wetted_area == pytest.approx(here.wetted_area, rel=1e-12)
    assert there.waterplane_area == pytest.approx(here.waterplane_area, abs=1e-11)


@given(st.integers(0, 10**6))
def test_a_mesh_cut_in_two_displaces_as_much(seed):
    rng = np.random.default_rng(seed)
    cut = rng.uniform(-0.8, 0.8)
    whole = shapes.box((1.0, 0.5, 0.3))
    halves = [
        shapes.box(((1.0 + cut) / 2.0, 0.5, 0.3)).transformed(np.eye(3), ((cut - 1.0) / 2.0, 0, 0)),
        shapes.box(((1.0 - cut) / 2.0, 0.5, 0.3)).transformed(np.eye(3), ((cut + 1.0) / 2.0, 0, 0)),
    ]
    position, turn = (0.0, 0.0, rng.uniform(-0.5, 0.5)), turned(seed)
    wet, parts = (
        submerge(whole, position, turn),
        [submerge(half, position, turn) for half in halves],
    )
    assert sum(part.volume for part in parts) == pytest.approx(wet.volume, abs=1e-12)
    if wet.volume > 0.0:
        moment = sum(part.volume * np.nan_to_num(part.centroid) for part in parts)
        assert moment / wet.volume == pytest.approx(wet.centroid, abs=1e-9)


@given(st.floats(-1.5, 1.5), st.integers(0, 1000))
def test_wet_and_dry_make_the_whole(height, seed):
    turn = turned(seed)
    upside_down = naive.roll(np.pi)
    wet = submerge(TORUS, (0, 0, height), turn)
    dry = submerge(TORUS, (0, 0, -height), upside_down @ turn)
    assert wet.volume + dry.volume == pytest.approx(TORUS.volume, rel=1e-12)
    assert wet.wetted_area + dry.wetted_area == pytest.approx(TORUS.area, rel=1e-12)
    assert wet.waterplane_area == pytest.approx(dry.waterplane_area, abs=1e-11)


def test_the_waterplane_area_is_how_volume_grows_with_draft():
    h = 1e-5
    up, down = (submerge(TORUS, (0, 0, s * h), turned(5)).volume for s in (1, -1))
    assert submerge(TORUS, (0, 0, 0), turned(5)).waterplane_area == pytest.approx(
        (down - up) / (2 * h), rel=1e-6
    )


# waves


def test_a_flat_wave_is_still_water():
    for water in (
        Water(waves=RegularWave(0.0, period=2.0)),
        Water(waves=RegularWave(0.01, wavelength=1e6, phase=np.pi / 2)),
    ):
        wet, still = (
            submerge(TORUS, (0, 0, 0.2), turned(1), water),
            submerge(TORUS, (0, 0, 0.2), turned(1)),
        )
        assert wet.volume == pytest.approx(still.volume, rel=1e-7)
        assert wet.centroid == pytest.approx(still.centroid, abs=1e-7)


@pytest.mark.parametrize("time", [0.0, 0.4, 1.1])
@pytest.mark.parametrize("wavelength", [4.6, 10.0])
def test_twelve_triangles_in_a_wave_displace_what_columns_of_water_do(wavelength, time):
    half, position = (0.5, 0.25, 0.3), np.array([0.2, 0.1, -0.05])
    water = Water(waves=RegularWave(0.05 * wavelength, wavelength=wavelength, direction=0.4))
    volume, centroid = naive.columns(half, position, water, time)
    box = shapes.box(half)
    wet = submerge(box, position, None, water, time)
    assert wet.volume == pytest.approx(volume, abs=1e-3 * box.volume)
    assert wet.volume * (wet.centroid - position) == pytest.approx(
        volume * (centroid - position), abs=1e-3 * box.volume * 1.1
    )


@pytest.mark.filterwarnings("ignore:the waves are so steep")
@pytest.mark.parametrize("name", ["box", "plate", "rod", *ODD])
def test_in_steep_waves_four_hulls_long_the_error_is_below_a_ten_thousandth(name):
    flat = {"box": (1.0, 0.5, 0.3), "plate": (1.0, 1.0, 0.01), "rod": (1.0, 0.03, 0.03)}
    mesh = shapes.box(flat[name]) if name in flat else ODD[name]
    wavelength = 8.0 * mesh.radius
    water = Water(waves=RegularWave(0.07 * wavelength, wavelength=wavelength))
    packed, reference = (
        exact.PackedHulls(HullSet([mesh]), water, tolerance) for tolerance in (2e-3, 2e-5)
    )
    for seed in range(20):
        rng = np.random.default_rng(seed)
        position = rng.uniform(-1.0, 1.0, (1, 3)) * [[wavelength, wavelength, 0.5 * mesh.radius]]
        turn = turned(seed).reshape(1, 9)
        rough, fine = (
            packed.submerge(position, turn, 0.0)[0].copy(),
            reference.submerge(position, turn, 0.0)[0].copy(),
        )
        assert rough[0] == pytest.approx(fine[0], abs=1e-4 * mesh.volume)
        if fine[0] > 0.0 and rough[0] > 0.0:
            error = fine[0] * np.abs(rough[1:4] - fine[1:4]).max()
            assert error < 1e-4 * mesh.volume * mesh.radius


def test_a_hull_wholly_under_a_wave_is_whole():
    water = Water(waves=RegularWave(0.3, wavelength=8.0))
    wet = submerge(TORUS, (0.3, 0.0, -2.0), turned(2), water)
    assert wet.volume == pytest.approx(TORUS.volume, rel=1e-14)


@given(st.integers(0, 10**5))
def test_the_short_cut_for_dry_and_wet_hulls_never_shows(seed):
    # just where the bounding sphere begins to touch, the full sum must agree with it
    rng = np.random.default_rng(seed)
    water = Water(waves=RegularWave(0.2, wavelength=9.0, direction=rng.uniform(-3, 3)))
    mesh, turn = shapes.box(rng.uniform(0.1, 0.5, 3)), turned(seed)
    position = np.array([rng.uniform(-9, 9), 0.0, rng.uniform(-1.2, 1.2)])
    points = mesh.vertices @ turn.T + position
    depths = water.depth(refine(points, mesh.faces, 0.05)[0], 0.0)
    wet = submerge(mesh, position, turn, water)
    if depths.min() > 1e-3:
        assert wet.volume == pytest.approx(mesh.volume, rel=5e-4)
    elif depths.max() < -1e-3:
        assert wet.volume == 0.0
    else:
        assert 0.0 <= wet.volume <= mesh.volume


# borders


def test_a_pose_that_is_not_finite_gives_nan_and_not_nothing():
    packed = exact.PackedHulls(HullSet([TORUS]), Water())
    row = packed.submerge(np.array([[0.0, 0.0, np.nan]]), np.eye(3).reshape(1, 9), 0.0)[0]
    assert np.isnan(row).all()


@pytest.mark.parametrize(
    ("position", "rotation", "message"),
    [
        (
            (0.0, 0.0),
            None,
            r"position is \(0.0, 0.0\), of shape \(2,\); it must be numbers of shape \(3,\)",
        ),
        (np.zeros((3, 1)), None, r"of shape \(3, 1\); it must be numbers of shape \(3,\)"),
        ((0.0, 0.0, np.nan), None, "position holds nan; its numbers must be finite"),
        ((0.0, 0.0, 1j), None, r"position is .*; it must be numbers of shape \(3,\)"),
        (("0", "0", "1"), None, r"position is \('0', '0', '1'\); it must be numbers"),
        ((0.0, 0.0, 0.0), np.eye(3) * (1.0 + 0j), "it must be a rotation matrix"),
        ((0.0, 0.0, 0.0), np.diag([1.0, 1.0, -1.0]), "it must be a rotation matrix"),
        ((0.0, 0.0, 0.0), 2.0 * np.eye(3), "it must be a rotation matrix"),
        ((0.0, 0.0, 0.0), np.eye(2), "it must be a rotation matrix"),
    ],
)
def test_a_pose_that_is_none_is_refused(position, rotation, message):
    with pytest.raises(MeshError, match=message):
        submerge(TORUS, position, rotation)


def test_a_time_that_is_not_finite_is_refused():
    with pytest.raises(MeshError, match="time is nan; it must be a finite number"):
        submerge(TORUS, time=np.nan)


def test_the_wetted_surface_has_the_wetted_area_and_its_waterline_lies_on_the_water():
    water, turn = Water(level=0.3), turned(7)
    triangles, line = cut_wetted_surface(TORUS, np.array([1.0, 2.0, 0.3]), turn, water, 0.0)
    a, b, c = triangles.swapaxes(0, 1)
    areas = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    assert areas.sum() == pytest.approx(
        submerge(TORUS, (1, 2, 0.3), turn, water).wetted_area, rel=1e-12
    )
    assert line[..., 2] == pytest.approx(np.full(line.shape[:2], 0.3), abs=1e-12)
