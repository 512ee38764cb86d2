"""Convex hulls of meshes as CAD writes them."""

from pathlib import Path

import mujoco
import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from buoyancy_mj import MeshError, Selection
from buoyancy_mj.hulls.geoms import find_hulls
from buoyancy_mj.inspection.inspection import inspect_model
from buoyancy_mj.meshes import shapes
from buoyancy_mj.meshes.convex import convex_hull
from tests.naive import trimesh_hull

POD = Path(__file__).parent / "data/cases/round_pod/pod.xml"


def turned(seed):
    """A solid of revolution as CAD writes it: slender triangles, in single precision, askew."""
    rng = np.random.default_rng(seed)
    radius, length, sections = rng.uniform(0.02, 0.3), rng.uniform(0.1, 2.0), rng.integers(6, 300)
    solid = trimesh.creation.cylinder(radius, length, sections=sections).subdivide()
    turn = Rotation.random(random_state=seed)
    vertices = np.float64(np.float32(turn.apply(solid.vertices) + rng.normal(size=3)))
    # a regular polygon of as many corners, times the length
    volume = 0.5 * sections * np.sin(2.0 * np.pi / sections) * radius**2 * length
    return trimesh.Trimesh(vertices, solid.faces, process=False), volume


@pytest.mark.long
@pytest.mark.slow
def test_convex_hulls_of_a_thousand_turned_solids_are_closed_and_have_their_volume():
    for seed in range(1000):
        solid, volume = turned(seed)
        hull = convex_hull(solid.vertices)
        assert hull.volume == pytest.approx(volume, rel=1e-5), seed
        if seed % 10 == 0:
            assert hull.volume == pytest.approx(trimesh_hull(solid).volume, rel=1e-5), seed


def test_a_convex_hull_keeps_the_facets_without_area_that_close_it():
    # as trimesh has it, without them, it is open
    solid, volume = turned(50)
    without = trimesh.convex.convex_hull(solid.vertices)
    with pytest.raises(MeshError, match="is open along"):
        trimesh_hull(without)
    assert convex_hull(solid.vertices).volume == pytest.approx(volume, rel=1e-5)


def test_a_convex_hull_of_points_in_a_plane_is_refused():
    with pytest.raises(MeshError, match=r"^lid: it is flat and has no convex"):
        convex_hull(np.array([[0.0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1]]), "lid")


def test_a_convex_hull_has_no_vertices_inside():
    cloud = np.vstack([shapes.box((1.0, 1.0, 1.0)).vertices, np.zeros((3, 3))])
    assert len(convex_hull(cloud).vertices) == 8


def test_a_turned_pod_is_inspected_and_displaces_as_its_convex_hull():
    # a cylinder of 300 sides; as trimesh has it, its hull is open
    model = mujoco.MjModel.from_xml_path(str(POD))
    volume = trimesh.load_mesh(POD.with_suffix(".stl")).volume
    found = inspect_model(model)
    assert found.problems == ()
    assert found.geoms[0].notes == ()
    assert found.geoms[0].mesh.volume == pytest.approx(volume, rel=1e-6)
    (hull,) = find_hulls(model, Selection(hull="pod=convex"))
    assert hull.mesh.volume == pytest.approx(volume, rel=1e-6)
