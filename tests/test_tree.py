"""The tree of moments: its structure, its moments, and the plain way's answers, in waves too."""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from buoyancy_mj import (
    BuoyancyWarning,
    Exact,
    LevelOscillation,
    MethodError,
    RegularWave,
    TriMesh,
    Water,
    WaterError,
)
from buoyancy_mj.kernels import clip
from buoyancy_mj.meshes import shapes, tree
from buoyancy_mj.submersion import exact, wave_limits
from buoyancy_mj.submersion.hull_set import HullSet
from tests import naive
from tests.naive import trimesh_hull


def list_arrays(rows):
    return [a for row in rows for a in (list_arrays(row) if isinstance(row, tuple) else [row])]


def subdivided(mesh, times):
    v, f = mesh.vertices, mesh.faces
    for _ in range(times):
        v, f = trimesh.remesh.subdivide(v, f)
    return TriMesh(v, f)


BALL = trimesh_hull(trimesh.creation.icosphere(subdivisions=4, radius=0.5))
MESHES = {
    "ball": BALL,
    "torus": trimesh_hull(trimesh.creation.torus(0.6, 0.2, major_sections=64, minor_sections=32)),
    "hourglass": subdivided(naive.two_cones(0.5, 0.6, sections=64), 2),
    "plate": subdivided(shapes.box((0.8, 0.6, 0.01)), 4),
    "far from its frame": BALL.transformed(np.eye(3), (20.0, -30.0, 10.0)),
    "two pieces": TriMesh(
        np.vstack([BALL.vertices, BALL.vertices + 1.5]),
        np.vstack([BALL.faces, BALL.faces + len(BALL.vertices)]),
    ),
}
BEAM = subdivided(shapes.box((4.0, 0.1, 0.1)), 6)
WAVES = Water(
    waves=[
        RegularWave(0.1, wavelength=8.0),
        RegularWave(0.05, wavelength=5.0, direction=1.0, phase=0.4),
    ]
)


def packed(mesh, water, monkeypatch, *, few, tolerance=2e-3):
    """A packed mesh, by a tree (few = 0) or by the plain way."""
    monkeypatch.setattr(tree, "FEW", few)
    # a mesh of its own, since trees stay with theirs
    return exact.PackedHulls(HullSet([TriMesh(mesh.vertices, mesh.faces)]), water, tolerance)


@pytest.fixture
def pair():
    """Maker of the same hulls, plain and by a tree."""
    with pytest.MonkeyPatch.context() as patch:
        yield lambda mesh, water: [packed(mesh, water, patch, few=few) for few in (10**9, 0)]


def place(mesh, seed, height):
    """A random attitude, with the middle of the mesh at a height."""
    turn = Rotation.random(random_state=seed).as_matrix()
    position = np.array([0.3, -0.2, height]) - turn @ mesh.bounds.mean(axis=0)
    return position[None], turn.reshape(1, 9)


# structure ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", MESHES)
def test_a_tree_holds_each_triangle_in_one_leaf_and_each_corner_in_its_boxes(name, monkeypatch):
    mesh = MESHES[name]
    hulls = packed(mesh, Water(), monkeypatch, few=0).hulls
    (first, last, start, end, skip), faces = hulls.spans.T, hulls.faces
    whole = [
        sorted(map(tuple, corners.reshape(-1, 9).tolist()))
        for corners in (hulls.vertices[faces], mesh.vertices[mesh.faces])
    ]
    assert whole[0] == whole[1]
    leaves = np.flatnonzero(skip == np.arange(len(skip)) + 1)
    assert (last[leaves] - first[leaves] <= tree.LEAF).all()
    assert first[leaves[0]] == 0
    assert last[leaves[-1]] == len(faces)
    np.testing.assert_array_equal(first[leaves[1:]], last[leaves[:-1]])
    # leaves share no vertices
    np.testing.assert_array_equal(start[leaves[1:]], end[leaves[:-1]])
    assert (start[leaves[0]], end[leaves[-1]]) == (0, len(hulls.vertices))
    for node in range(len(first)):
        assert (
            np.unique(faces[first[node] : last[node]]) == np.arange(start[node], end[node])
        ).all()
        corners = hulls.vertices[faces[first[node] : last[node]]].reshape(-1, 3)
        off = np.abs(corners - hulls.boxes[node, :3]) - hulls.boxes[node, 3:6]
        assert off.max() <= 1e-12
        # the children of a node are what lies before the one that comes behind it
        inside = np.arange(node + 1, skip[node])
        assert ((first[inside] >= first[node]) & (last[inside] <= last[node])).all()


def test_the_same_mesh_grows_the_same_tree(monkeypatch):
    # a ball is as wide along each axis
    for name in ("ball", "plate"):
        one, other = (packed(MESHES[name], Water(), monkeypatch, few=0) for _ in range(2))
        for array, another in zip(list_arrays(one.hulls), list_arrays(other.hulls), strict=True):
            np.testing.assert_array_equal(array, another)


def test_the_moments_are_the_integrals(monkeypatch):
    hulls = packed(MESHES["torus"], Water(), monkeypatch, few=0).hulls
    # a rule of degree two: the middles of the edges
    for node in (0, 1, len(hulls.spans) // 2, len(hulls.spans) - 1):
        corners = hulls.vertices[hulls.faces[slice(*hulls.spans[node, :2])]] - hulls.boxes[node, :3]
        middles = 0.5 * (corners + np.roll(corners, 1, axis=1))
        vectors = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        weighed = np.repeat(vectors / 3.0, 3, axis=0)
        y = middles.reshape(-1, 3)
        found = hulls.moments[node]
        assert found[:3] == pytest.approx(vectors.sum(axis=0), abs=1e-12)
        assert found[3:12].reshape(3, 3) == pytest.approx(y.T @ weighed, abs=1e-12)
        for row, (a, b) in zip(
            found[12:30].reshape(6, 3),
            ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)),
            strict=True,
        ):
            assert row == pytest.approx((y[:, a] * y[:, b]) @ weighed, abs=1e-12)
        assert found[30] == pytest.approx(np.linalg.norm(vectors, axis=1).sum(), rel=1e-12)


# results ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "water",
    [Water(), Water(level=0.1, waves=LevelOscillation(0.2, 0.5)), WAVES],
    ids=["still", "level", "waves"],
)
@pytest.mark.parametrize("name", MESHES)
def test_the_tree_finds_what_the_plain_way_finds(name, water, pair):
    mesh = MESHES[name]
    plain, quick = pair(mesh, water)
    assert len(quick.hulls.spans) > 1 == len(plain.hulls.spans)
    for seed in range(20):
        pose = place(mesh, seed, 0.1 * np.sin(seed))
        a, b = plain.submerge(*pose, 0.3)[0], quick.submerge(*pose, 0.3)[0]
        assert b[clip.VOLUME] == pytest.approx(a[clip.VOLUME], abs=1e-12 * mesh.volume)
        if a[clip.VOLUME] > 1e-3 * mesh.volume:
            assert b[clip.CENTROID] == pytest.approx(a[clip.CENTROID], abs=1e-10)
        assert b[clip.WETTED_AREA] == pytest.approx(a[clip.WETTED_AREA], abs=1e-11 * mesh.area)
        assert b[clip.WATERPLANE_AREA] == pytest.approx(
            a[clip.WATERPLANE_AREA], abs=1e-11 * mesh.area
        )


@pytest.mark.parametrize("name", [name for name in MESHES if name != "far from its frame"])
def test_in_waves_it_stays_within_its_tolerance_of_the_sum_over_a_fine_mesh(name):
    mesh, fine = MESHES[name], subdivided(MESHES[name], 1)
    hulls = exact.PackedHulls(HullSet([mesh]), WAVES)
    for seed in range(3):
        position, turn = place(mesh, seed, 0.15 * np.sin(seed) - 0.05)
        volume, moments = naive.directly(fine, position[0], turn.reshape(3, 3), WAVES, 0.1 * seed)
        # the fine mesh errs too, by the bow of the surface over its edges
        bow = (
            WAVES.curvature
            * np.max(np.linalg.norm(np.diff(fine.vertices[fine.faces], axis=1), axis=2)) ** 2
            / 12.0
        )
        slack = 1e-4 * mesh.volume + bow * mesh.area / 2.0
        found = hulls.submerge(position, turn, 0.1 * seed)[0]
        assert found[0] == pytest.approx(volume, abs=min(slack, 1e-3 * mesh.volume))
        assert found[0] * (found[1:4] - position[0]) == pytest.approx(
            moments, abs=min(slack, 1e-3 * mesh.volume) * 2 * mesh.radius
        )


@pytest.mark.long
@pytest.mark.filterwarnings("ignore:the waves are so steep")
@given(
    st.integers(0, 10**6),
    st.floats(-0.7, 0.7),
    st.sampled_from([1e-2, 2e-3, 5e-4]),
    st.sampled_from(["box", "plate", "rod"]),
)
@settings(max_examples=25)
def test_any_tolerance_is_kept(seed, height, tolerance, name):
    mesh = shapes.box(
        {"box": (0.5, 0.4, 0.3), "plate": (0.5, 0.5, 0.01), "rod": (0.8, 0.02, 0.02)}[name]
    )
    pose = place(mesh, seed, height)
    rough, fine = (
        exact.PackedHulls(HullSet([mesh]), WAVES, t).submerge(*pose, 0.0)[0]
        for t in (tolerance, tolerance / 20)
    )
    # beside a twentieth of it, which the finer one may be off by itself
    slack = 0.95 * tolerance * mesh.volume
    assert rough[0] == pytest.approx(fine[0], abs=slack)
    middle = pose[0][0] + pose[1].reshape(3, 3) @ mesh.bounds.mean(axis=0)
    if fine[0] > 0.0 and rough[0] > 0.0:
        moments = [row[0] * (row[clip.CENTROID] - middle) for row in (rough, fine)]
        assert moments[0] == pytest.approx(moments[1], abs=slack * mesh.radius)


@pytest.mark.parametrize("tilt", [0.0, 1e-4, 1e-2])
def test_a_plate_that_lies_flat_in_a_wave_keeps_its_tolerance(tilt):
    # its deck awash, where straight cuts miss the most
    plate, water = shapes.box((0.5, 0.5, 0.02)), Water(waves=RegularWave(0.02, wavelength=4.0))
    for height in (-0.022, -0.02, -0.018, 0.0, 0.01):
        position = np.array([[0.0, 0.0, 0.02 + height]])
        rows = [
            exact.PackedHulls(HullSet([plate]), water, t).submerge(
                position, naive.roll(tilt).reshape(1, 9), 0.0
            )[0]
            for t in (2e-3, 1e-4)
        ]
        assert rows[0][0] == pytest.approx(rows[1][0], abs=2e-3 * plate.volume)


def test_a_long_body_in_short_waves_is_right_too():
    # the phase turns six times over its half length
    water = Water(waves=RegularWave(0.03, wavelength=0.7))
    hulls = exact.PackedHulls(HullSet([shapes.box((2.0, 0.05, 0.05))]), water)
    for time in np.linspace(0.0, 0.5, 7):
        wet = hulls.submerge(np.zeros((1, 3)), np.eye(3).reshape(1, 9), time)[0]
        volume, centroid = naive.columns((2.0, 0.05, 0.05), np.zeros(3), water, time)
        assert wet[0] == pytest.approx(volume, abs=5e-4 * 0.04)
        assert wet[0] * wet[1:4] == pytest.approx(volume * centroid, abs=1e-3 * 0.04)


@pytest.mark.slow
def test_the_steepest_and_shortest_waves_cost_no_eternity():
    wave = RegularWave(0.0085, wavelength=0.017)
    with pytest.warns(BuoyancyWarning, match="200,000 triangles keep the volume of a hull to"):
        hulls = exact.PackedHulls(HullSet([shapes.box((0.5, 0.4, 0.3))]), Water(waves=wave))
    assert len(hulls.hulls.faces) < 3 * wave_limits.MOST_TRIANGLES
    assert np.isfinite(hulls.submerge(np.zeros((1, 3)), np.eye(3).reshape(1, 9), 0.1)[0, 0])


def test_waves_too_short_to_be_resolved_over_a_hull_are_refused():
    # 512 rad of phase from the middle of the box to a corner
    half = np.array([10.0, 4.0, 3.0])
    shortest = 2.0 * np.pi * np.linalg.norm(half) / 512.0
    hulls = HullSet([shapes.box(tuple(half))])
    with pytest.raises(
        WaterError,
        match=r"the water has waves 0\.136 m long, too short for a hull 22\.4 m from corner to "
        r"corner, over which waves must be at least 0\.137 m long; leave out shorter ones",
    ):
        exact.PackedHulls(hulls, Water(waves=RegularWave(1e-4, wavelength=0.99 * shortest)))
    exact.PackedHulls(hulls, Water(waves=RegularWave(1e-4, wavelength=1.01 * shortest)))
    # as many short waves as a pass can sum up, and not one more
    tide = [RegularWave(1e-5, wavelength=0.3, direction=0.001 * n) for n in range(850)]
    with pytest.raises(
        WaterError,
        match=r"the water has 850 waves that are short for a hull 22\.4 m from corner to corner; "
        r"beside waves 0\.3 m long it may have 847 at most: give the sea fewer components",
    ):
        exact.PackedHulls(hulls, Water(waves=tide))
    exact.PackedHulls(hulls, Water(waves=tide[:840]))
    # a wave of no height is none
    exact.PackedHulls(hulls, Water(waves=RegularWave(0.0, wavelength=0.02)))


@pytest.mark.parametrize(
    "tolerance", [0.0, -1e-4, 1e-300, 2.0, float("nan"), True, "fine", 10**400]
)
def test_a_tolerance_that_is_none_is_told(tolerance):
    with pytest.raises(
        MethodError, match="it must be a part of the volume, at least 1e-08 and at most 1"
    ):
        Exact(tolerance=tolerance)


def test_several_hulls_share_one_structure_and_do_not_mix():
    meshes = [MESHES["ball"], shapes.box((0.1, 0.1, 0.1)), MESHES["torus"]]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(tree, "FEW", 100)
        together = exact.PackedHulls(HullSet(meshes, bodies=[0, 0, 0]), Water())
        positions = np.array([[0.0, 0.0, 0.1], [3.0, 0.0, 0.03], [-3.0, 1.0, -0.05]])
        turns = Rotation.random(3, random_state=5).as_matrix().reshape(3, 9)
        found = together.submerge(positions, turns, 0.0).copy()
        for mesh, position, turn, row in zip(meshes, positions, turns, found, strict=True):
            alone = exact.PackedHulls(HullSet([mesh]), Water()).submerge(
                position[None], turn[None], 0.0
            )[0]
            np.testing.assert_array_equal(row, alone)


def test_triangles_are_visited_at_the_waterline_alone(monkeypatch):
    ball = trimesh_hull(trimesh.creation.icosphere(subdivisions=6))
    hulls = packed(ball, Water(), monkeypatch, few=0)
    vertices = hulls.hulls.vertices
    hulls.submerge(*place(ball, 1, 0.2), 0.0)
    # leaves that the surface does not touch may hold nonsense
    pose = place(ball, 1, 0.2)
    cut = np.abs(vertices @ pose[1][0, 6:] + pose[0][0, 2]) < 0.2
    found = hulls.submerge(*pose, 0.0).copy()
    vertices[~cut] = np.nan
    np.testing.assert_array_equal(hulls.submerge(*pose, 0.0), found)
    assert cut.mean() < 0.25
    vertices[:] = np.nan
    for height in (-1.1, 1.1):
        assert np.isfinite(hulls.submerge(*place(ball, 1, height), 0.0)[0, 0])
