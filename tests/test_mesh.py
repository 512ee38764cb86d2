import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from buoyancy_mj import MeshError, TriMesh
from buoyancy_mj.meshes import shapes
from buoyancy_mj.meshes.refinement import refine
from tests.naive import trimesh_hull


def test_a_box_has_its_volume_area_and_centroid():
    mesh = shapes.box((1.0, 0.5, 0.3)).transformed(np.eye(3), (1.0, 2.0, 3.0))
    assert mesh.volume == pytest.approx(1.2, rel=1e-14)
    assert mesh.area == pytest.approx(7.6, rel=1e-14)
    assert mesh.centroid == pytest.approx([1.0, 2.0, 3.0], abs=1e-14)
    assert mesh.radius == pytest.approx(np.sqrt(1.34), rel=1e-14)


def test_area_vectors_of_a_closed_mesh_sum_to_zero():
    mesh = trimesh_hull(trimesh.creation.torus(1.0, 0.4))
    assert mesh.area_vectors.sum(axis=0) == pytest.approx(np.zeros(3), abs=1e-13)


@given(st.integers(0, 10**6))
def test_volume_agrees_with_trimesh_wherever_the_mesh_lies(seed):
    rng = np.random.default_rng(seed)
    solid = trimesh.creation.torus(1.0, 0.3, major_sections=9, minor_sections=7)
    mesh = trimesh_hull(solid).transformed(
        Rotation.random(random_state=seed).as_matrix(), rng.uniform(-100, 100, 3)
    )
    assert mesh.volume == pytest.approx(solid.volume, rel=1e-10)
    assert mesh.centroid == pytest.approx(
        trimesh.Trimesh(mesh.vertices, mesh.faces).center_mass, rel=1e-6
    )


def test_an_open_mesh_does_not_exist():
    box = shapes.box((1.0, 1.0, 1.0))
    with pytest.raises(
        MeshError, match=r"a mesh of 11 triangles is open along 3 edges; a hull must be closed"
    ):
        TriMesh(box.vertices, box.faces[1:])


def test_an_inside_out_mesh_does_not_exist():
    box = shapes.box((1.0, 1.0, 1.0))
    with pytest.raises(MeshError, match=r"encloses -8 m\^3; a hull must enclose a positive volume"):
        TriMesh(box.vertices, box.faces[:, ::-1])


@pytest.mark.parametrize(
    ("vertices", "faces", "message"),
    [
        (np.zeros((3, 2)), [[0, 1, 2]], r"vertices have shape \(3, 2\); they must be \(n, 3\)"),
        (
            np.zeros((3, 3)),
            [[0, 1, 2, 0]],
            r"faces have shape \(1, 4\); they must be triangles \(m, 3\)",
        ),
        (np.zeros((3, 3)), np.zeros((0, 3), int), "without a single triangle"),
        (np.zeros((3, 3)), [[0.0, 1.0, 2.0]], "faces are of type float64; they must be integer"),
        (
            [[0, 0, 0], [1, 0, np.nan], [0, 1, 0]],
            [[0, 1, 2]],
            r"vertex 1 is \[1.0, 0.0, nan\]; every coordinate",
        ),
        (np.zeros((3, 3)), [[0, 1, 3]], "faces name vertices 0 to 3; there are 0 to 2"),
    ],
)
def test_arrays_that_are_no_mesh_are_refused(vertices, faces, message):
    with pytest.raises(MeshError, match=message):
        TriMesh(vertices, faces)


def test_a_mesh_cannot_be_changed():
    mesh = shapes.box((1.0, 1.0, 1.0))
    with pytest.raises(ValueError, match="read-only"):
        mesh.vertices[0] = 7.0


def test_its_arrays_are_copies():
    vertices = np.array(shapes.box((1.0, 1.0, 1.0)).vertices)
    mesh = TriMesh(vertices, shapes.box((1.0, 1.0, 1.0)).faces)
    vertices[:] = 0.0
    assert mesh.volume == pytest.approx(8.0)


@pytest.mark.parametrize(
    ("size", "edge"), [((1.0, 0.4, 0.02), 0.1), ((5.0, 0.01, 0.02), 0.05), ((1.0, 1.0, 1.0), 0.3)]
)
def test_refining_keeps_the_surface_and_shortens_its_edges(size, edge):
    mesh = shapes.box(size)
    vertices, faces = refine(mesh.vertices, mesh.faces, edge)
    fine = trimesh.Trimesh(vertices, faces, process=False)
    assert fine.volume == pytest.approx(mesh.volume, rel=1e-12)
    assert fine.area == pytest.approx(mesh.area, rel=1e-12)
    assert (fine.face_normals[:, :] @ fine.face_normals[0]).max() == pytest.approx(1.0)
    a, b, c = vertices[faces.T]
    assert max(np.linalg.norm(side, axis=1).max() for side in (b - a, c - b, a - c)) <= 1.4 * edge

    # neighbours have the same edges, but for the rounding of their ends
    _, same = np.unique(vertices.round(9), axis=0, return_inverse=True)
    assert trimesh.Trimesh(vertices, same.ravel()[faces], process=False).is_watertight
    assert len(faces) < 40.0 * (mesh.area / edge**2 + sum(size) / edge)


def test_a_mesh_that_is_fine_enough_is_left_alone():
    mesh = shapes.box((1.0, 1.0, 1.0))
    assert refine(mesh.vertices, mesh.faces, 10.0)[1] is mesh.faces


def test_a_moved_mesh_is_a_mesh():
    mesh = trimesh_hull(trimesh.creation.torus(1.0, 0.3)).transformed(
        np.diag([-1.0, -1.0, 1.0]), (1.0, 2.0, 3.0)
    )
    assert TriMesh(mesh.vertices, mesh.faces).volume == pytest.approx(mesh.volume)
    assert mesh.centroid == pytest.approx([1.0, 2.0, 3.0], abs=1e-12)
