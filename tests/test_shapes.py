import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from buoyancy_mj import TriMesh, submerge
from buoyancy_mj.meshes import shapes


@pytest.mark.parametrize(
    ("mesh", "volume"),
    [
        (shapes.box((0.3, 0.2, 0.1)), 0.048),
        (shapes.sphere(0.7), 4.0 / 3.0 * np.pi * 0.343),
        (shapes.ellipsoid((0.5, 0.3, 0.2)), 4.0 / 3.0 * np.pi * 0.03),
        (shapes.cylinder(0.2, 0.5), np.pi * 0.04),
        (shapes.capsule(0.2, 0.5), np.pi * 0.04 * (1.0 + 4.0 / 3.0 * 0.2)),
    ],
)
def test_a_primitive_has_its_true_volume_about_its_middle(mesh, volume):
    assert mesh.volume == pytest.approx(volume, rel=1e-12)
    assert mesh.centroid == pytest.approx(np.zeros(3), abs=1e-12)


@pytest.mark.parametrize("draft", [0.2, 0.5, 1.0, 1.5])
def test_a_cap_of_the_sphere_is_right_to_a_thousandth(draft):
    # pi h^2 (3 R - h) / 3
    wet = submerge(shapes.sphere(1.0), (0.0, 0.0, 1.0 - draft))
    assert wet.volume == pytest.approx(np.pi * draft**2 * (3.0 - draft) / 3.0, abs=1e-3 * 4.18879)


def test_a_cylinder_and_a_capsule_stand_along_z():
    assert np.ptp(shapes.cylinder(0.2, 0.5).vertices[:, 2]) == pytest.approx(1.0)
    assert np.ptp(shapes.capsule(0.2, 0.5).vertices[:, 2]) == pytest.approx(1.4)


size = st.floats(-4.0, 3.0).map(lambda exponent: 10.0**exponent)


@given(size, size, size)
def test_any_size_and_slenderness_is_a_closed_solid_of_the_true_volume(a, b, c):
    for mesh, volume in (
        (shapes.box((a, b, c)), 8.0 * a * b * c),
        (shapes.ellipsoid((a, b, c)), 4.0 / 3.0 * np.pi * a * b * c),
        (shapes.cylinder(a, b), 2.0 * np.pi * a**2 * b),
        (shapes.capsule(a, b), np.pi * a**2 * (2.0 * b + 4.0 / 3.0 * a)),
    ):
        assert mesh.volume == pytest.approx(volume, rel=1e-9)


@pytest.mark.parametrize("draft", [0.1, 0.3, 0.55])
def test_a_standing_capsule_and_cylinder_have_their_volume_to_a_thousandth(draft):
    # cap and tube of a capsule of radius 0.2 and half length 0.3
    tube = max(draft - 0.2, 0.0)
    h = min(draft, 0.2)
    capsule = np.pi * h**2 * (0.6 - h) / 3.0 + np.pi * 0.04 * tube
    whole = np.pi * 0.04 * (0.6 + 0.8 / 3.0)
    assert submerge(shapes.capsule(0.2, 0.3), (0, 0, 0.5 - draft)).volume == pytest.approx(
        capsule, abs=1e-3 * whole
    )
    assert submerge(shapes.cylinder(0.2, 0.3), (0, 0, 0.3 - draft)).volume == pytest.approx(
        np.pi * 0.04 * draft, rel=1e-12
    )


@pytest.mark.parametrize("half_length", [0.02, 0.1, 0.4, 2.0])
def test_a_capsule_of_600_triangles_is_as_right_as_one_of_100_times_as_many(half_length):
    # trimesh's lies within the true shape, and is widened to its volume
    capsule, longest = shapes.capsule(0.2, half_length), 2.0 * half_length + 0.4
    assert len(capsule.faces) <= 600
    volume = 2.0 * np.pi * 0.04 * half_length + 4.0 / 3.0 * np.pi * 0.008
    assert capsule.volume == pytest.approx(volume, rel=1e-12)
    fine = trimesh.creation.capsule(2.0 * half_length, 0.2, count=[192, 192])
    vertices = (fine.vertices - fine.bounds.mean(axis=0)) * np.cbrt(volume / fine.volume)
    fine = TriMesh(vertices, fine.faces)

    draw = np.random.default_rng(3)
    for turn in Rotation.random(20, random_state=3).as_matrix():
        height = draw.uniform(-0.9, 0.9) * (capsule.vertices @ turn.T)[:, 2].max()
        got, true = (submerge(mesh, (0.0, 0.0, height), turn) for mesh in (capsule, fine))
        assert got.volume == pytest.approx(true.volume, abs=5e-4 * volume)
        assert got.volume == pytest.approx(true.volume, abs=5e-4 * longest * true.waterplane_area)
        assert got.centroid == pytest.approx(true.centroid, abs=1e-3 * longest)
        assert got.waterplane_area == pytest.approx(true.waterplane_area, rel=9e-3)


def test_a_capsule_is_as_symmetric_as_a_square_prism():
    capsule = shapes.capsule(0.2, 0.3)
    corners = {tuple(c) for c in capsule.vertices.round(12) + 0.0}
    for mirror in ([-1, 1, 1], [1, -1, 1], [1, 1, -1]):
        assert {tuple(c) for c in (capsule.vertices * mirror).round(12) + 0.0} == corners
    assert {tuple(c) for c in capsule.vertices[:, [1, 0, 2]].round(12) + 0.0} == corners
