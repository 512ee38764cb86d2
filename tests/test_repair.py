import re

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from buoyancy_mj import MeshError, repair
from buoyancy_mj.kernels.rays import misenclosed
from buoyancy_mj.meshes import shapes
from buoyancy_mj.meshes.repair import diagnose

BOX = shapes.box((1.0, 0.5, 0.3))
SPHERE = trimesh.creation.icosphere(subdivisions=4)
COARSE = trimesh.creation.icosphere(subdivisions=2)


def test_a_good_mesh_is_left_as_it_is():
    mesh, notices = repair(BOX.vertices, BOX.faces)
    assert notices == []
    assert mesh.volume == pytest.approx(1.2, rel=1e-14)


def test_a_triangle_soup_is_welded():
    soup = BOX.vertices[BOX.faces].reshape(-1, 3)
    mesh, notices = repair(soup, np.arange(len(soup)).reshape(-1, 3))
    assert len(mesh.vertices) == 8
    assert notices == []


@settings(max_examples=30)
@given(st.integers(0, 10**6), st.sampled_from((1e-8, 1e-7, 1e-6)))
def test_seams_that_rounding_opened_are_closed_with_a_notice(seed, noise):
    rng = np.random.default_rng(seed)
    soup = COARSE.vertices[COARSE.faces].reshape(-1, 3)
    soup = soup + noise * rng.uniform(-1.0, 1.0, soup.shape)
    mesh, notices = repair(soup, np.arange(len(soup)).reshape(-1, 3), name="hull")
    assert mesh.volume == pytest.approx(COARSE.volume, rel=10 * noise)
    assert len(mesh.vertices) == len(COARSE.vertices)
    assert [re.sub(r"\d+ vertices", "N vertices", notice) for notice in notices] == [
        "hull: N vertices of its seams, which lay up to 1e-05 of its length apart, were joined"
    ]


def test_the_sides_of_a_thin_plate_do_not_become_one():
    plate = shapes.box((0.5, 0.5, 1e-6))
    mesh, notices = repair(plate.vertices, plate.faces)
    assert mesh.volume == pytest.approx(2e-6)
    assert notices == []


def test_an_inside_out_mesh_is_turned_with_a_notice():
    mesh, notices = repair(BOX.vertices, BOX.faces[:, ::-1], name="hull")
    assert mesh.volume == pytest.approx(1.2)
    assert notices == ["hull: it was inside out; its faces were turned outward"]


def test_faces_wound_backwards_are_turned_with_a_notice():
    faces = BOX.faces.copy()
    faces[3] = faces[3][::-1]
    mesh, notices = repair(BOX.vertices, faces, name="hull")
    assert mesh.volume == pytest.approx(1.2)
    assert notices == ["hull: 1 triangles were wound backwards and were turned"]


def pair(other, inward):
    faces = other.faces[:, ::-1] if inward else other.faces
    return np.vstack([BOX.vertices, other.vertices]), np.vstack([BOX.faces, faces + 8])


def test_a_piece_that_is_inside_out_is_turned():
    beside = shapes.box((0.1, 0.1, 0.1)).transformed(np.eye(3), (3.0, 0.0, 0.0))
    mesh, notices = repair(*pair(beside, inward=True), name="pair")
    assert mesh.volume == pytest.approx(1.2 + 0.008, rel=1e-12)
    assert notices == ["pair: 1 of its 2 pieces was inside out; its faces were turned outward"]


def test_water_does_not_reach_a_sealed_cavity():
    # a pressure hull drawn with its inner wall
    inside = shapes.box((0.9, 0.4, 0.2))
    mesh, notices = repair(*pair(inside, inward=True), name="hull")
    assert mesh.volume == pytest.approx(1.2, rel=1e-12)
    assert notices == [
        "hull: water cannot reach the 0.576 m^3 sealed inside it, which displace like solid"
    ]


def test_a_ball_in_the_hole_of_a_torus_is_no_cavity():
    torus, ball = trimesh.creation.torus(1.0, 0.2), trimesh.creation.icosphere(radius=0.3)
    vertices = np.vstack([torus.vertices, ball.vertices])
    mesh, notices = repair(
        vertices, np.vstack([torus.faces, ball.faces[:, ::-1] + len(torus.vertices)])
    )
    assert mesh.volume == pytest.approx(torus.volume + ball.volume, rel=1e-12)
    assert "1 of its 2 pieces was inside out" in notices[0]


def test_a_mesh_that_may_be_in_millimetres_is_reported():
    _, notices = repair(BOX.vertices * 200.0, BOX.faces, name="hull")
    assert notices == [
        "hull: it is 400 m long; if it was drawn in millimetres, set scale='0.001 0.001 0.001'"
    ]


def test_degenerate_and_repeated_triangles_go():
    faces = np.vstack([BOX.faces, [[0, 0, 1]], BOX.faces[:1]])
    mesh, _ = repair(BOX.vertices, faces)
    assert len(mesh.faces) == 12


def test_a_small_hole_is_closed_and_its_doubt_reported():
    mesh, notices = repair(SPHERE.vertices, SPHERE.faces[3:], name="float")
    assert mesh.volume == pytest.approx(SPHERE.volume, rel=1e-3)
    assert notices == [
        "float: 1 hole with 9 edges puts 0.000212 m^3 (0.01% of its volume) in doubt; "
        "they were closed"
    ]


def test_an_open_box_is_refused_with_the_volume_in_doubt():
    with pytest.raises(
        MeshError,
        match=r"tub: it is open: 1 hole with 4 edges puts .* in doubt; "
        "close the mesh, or take its convex hull instead",
    ):
        repair(BOX.vertices, BOX.faces[BOX.area_vectors[:, 2] <= 0.0], name="tub")


def test_pieces_that_overlap_are_joined_and_the_volume_reported():
    other = BOX.transformed(np.eye(3), (0.5, 0.0, 0.0))
    mesh, notices = repair(
        np.vstack([BOX.vertices, other.vertices]),
        np.vstack([BOX.faces, other.faces + 8]),
        name="pair",
    )
    assert mesh.volume == pytest.approx(1.2 + 0.3, rel=1e-12)
    assert notices == [
        "pair: its 2 pieces overlap; they were joined, and 0.9 m^3 no longer count twice"
    ]


def test_a_mesh_that_crosses_itself_is_refused():
    # a ball whose top was pulled through its bottom
    ball = SPHERE.vertices.copy()
    ball[ball[:, 2] > 0.7, 2] -= 2.5
    with pytest.raises(
        MeshError,
        match=r"ring: it crosses itself: about .* is enclosed twice and .* inside out, "
        r".*; join its parts by a boolean union, or take its convex hull instead",
    ):
        repair(ball, SPHERE.faces, name="ring")


@pytest.mark.parametrize("scale", [1e6, 1e-6])
def test_an_absurd_scale_is_refused(scale):
    with pytest.raises(
        MeshError,
        match=r"hull: its longest side is 2e.* m, possible are 0.0001 to 1000 m; scale the mesh",
    ):
        repair(BOX.vertices * scale, BOX.faces, name="hull")


def test_a_flat_mesh_is_refused():
    with pytest.raises(MeshError, match="flat and encloses no volume"):
        repair([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 1]])


def test_only_degenerate_triangles_are_refused():
    with pytest.raises(MeshError, match="all 1 triangles are degenerate"):
        repair([[0, 0, 0], [1, 0, 0], [1, 0, 0]], [[0, 1, 2]])


def test_rays_measure_what_two_boxes_enclose_twice():
    other = BOX.transformed(np.eye(3), (0.5, 0.1, 0.05))
    doubled, inverted = misenclosed(
        np.vstack([BOX.vertices, other.vertices]), np.vstack([BOX.faces, other.faces + 8]), 300
    )
    assert doubled == pytest.approx(1.5 * 0.9 * 0.55, rel=0.01)
    assert inverted == 0.0


@pytest.mark.parametrize(
    "solid", [BOX, shapes.cylinder(0.3, 1.0), shapes.capsule(0.3, 0.5), shapes.sphere(1.0)]
)
def test_rays_find_no_fault_with_a_sound_solid(solid):
    assert misenclosed(solid.vertices, solid.faces, 200) == (0.0, 0.0)


def test_a_diagnosis_counts_what_it_found():
    faces = np.vstack([SPHERE.faces[3:], [[0, 0, 1]], SPHERE.faces[5:6]])
    faces[10] = faces[10][::-1]
    found = diagnose(SPHERE.vertices, faces, name="float")
    assert (found.triangles, found.degenerate, found.duplicates, found.backwards) == (
        len(faces),
        1,
        1,
        1,
    )
    assert [hole.edges for hole in found.holes] == [9]
    assert 0.0 < found.uncertain_volume < 1e-3 * SPHERE.volume
    assert found.holes[0].perimeter == pytest.approx(9 * 0.0692, rel=0.1)
    assert found.pieces == 1
    assert found.refusal == ""
    assert found.extents == pytest.approx((2.0, 2.0, 2.0), rel=1e-3)


def test_a_diagnosis_of_what_is_refused_keeps_what_it_found():
    tub = diagnose(BOX.vertices, BOX.faces[BOX.area_vectors[:, 2] <= 0.0], name="tub")
    assert tub.mesh is None
    assert tub.refusal.startswith("tub: it is open: 1 hole with 4 edges")
    assert tub.refusal.endswith("; close the mesh, or take its convex hull instead")
    assert [hole.perimeter for hole in tub.holes] == pytest.approx([6.0])


def test_a_diagnosis_counts_pieces_and_inner_shells():
    inside = shapes.box((0.9, 0.4, 0.2))
    found = diagnose(*pair(inside, inward=True))
    assert (found.pieces, found.shells) == (2, 1)
    assert found.sealed_volume == pytest.approx(0.576)
