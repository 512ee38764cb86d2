"""The source paper's methods beside the exact one: where they agree, and where they do not."""

import dataclasses
import itertools

import mujoco
import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy.spatial.transform import Rotation

from buoyancy_mj import (
    Buoyancy,
    ConvexHull,
    DivergenceError,
    Exact,
    LevelOscillation,
    MethodError,
    RegularWave,
    SceneError,
    Sections,
    Simulation,
    TriMesh,
    Water,
    read_scene,
    submerge,
)
from buoyancy_mj.meshes import shapes
from buoyancy_mj.scenes import catalog
from buoyancy_mj.submersion import convex_hull
from buoyancy_mj.submersion.cross_sections import cut_sections, integrate
from buoyancy_mj.submersion.hull_set import HullSet
from buoyancy_mj.submersion.methods import METHODS
from buoyancy_mj.submersion.quickhull import hull_moments
from tests import naive
from tests.naive import trimesh_hull

CONVEX = {
    "sphere": shapes.sphere(0.5),
    "ellipsoid": shapes.ellipsoid((0.5, 0.3, 0.2)),
    "cylinder": shapes.cylinder(0.3, 0.5),
    "capsule": shapes.capsule(0.2, 0.4),
    "box": shapes.box((0.4, 0.3, 0.2)),
}
HOLLOW = {
    "torus": trimesh_hull(trimesh.creation.torus(1.0, 0.4, major_sections=64, minor_sections=32)),
    "hourglass": naive.two_cones(0.5, 1.0, sections=64),
    "two spheres": TriMesh(
        np.vstack([shapes.sphere(0.4).vertices + [1.0, 0.0, 0.2], shapes.sphere(0.4).vertices]),
        np.vstack(
            [shapes.sphere(0.4).faces, shapes.sphere(0.4).faces + len(shapes.sphere(0.4).vertices)]
        ),
    ),
}
SHAPES = CONVEX | HOLLOW
# sections at the default step. Where a torus ends its section grows as c sqrt(z) with
# c = 4 pi R sqrt(2 r), and the trapezoid misses 0.208 c h^1.5 there (zeta(-1/2)): 0.7 % of its
# volume from both ends, for its 28 sections
STEP_ERROR = dict.fromkeys(SHAPES, 2e-3) | {"torus": 7e-3}
TRUE_HULL = ConvexHull(cut=True, centroid="hull")
ALL = [
    Exact(),
    ConvexHull(),
    ConvexHull(cut=True),
    TRUE_HULL,
    Sections(),
    Sections(rule="simpson"),
    Sections(axis=(0.0, 0.0, 1.0)),
    Sections(axis=(0.3, -0.5, 1.0), rule="simpson"),
]
POSES = [
    ((0.3, -2.0, z), Rotation.random(random_state=seed).as_matrix())
    for seed, z in enumerate((-0.2, 0.0, 0.1))
]

# one interface, one suite of shapes


@pytest.mark.parametrize("method", ALL, ids=repr)
@pytest.mark.parametrize("shape", SHAPES)
def test_far_above_all_is_dry_and_far_below_all_is_wet(method, shape):
    mesh = SHAPES[shape]
    dry = submerge(mesh, (1.0, 2.0, 5.0), method=method)
    assert dry.volume == 0.0
    assert np.isnan(dry.centroid).all()
    wet = submerge(mesh, (1.0, 2.0, -5.0), method=method)
    if isinstance(method, ConvexHull):
        whole, tolerance = trimesh.Trimesh(mesh.vertices, mesh.faces).convex_hull.volume, 1e-9
    else:
        whole, tolerance = mesh.volume, 1e-12 if isinstance(method, Exact) else STEP_ERROR[shape]
    assert wet.volume == pytest.approx(whole, rel=tolerance)
    assert wet.centroid[2] == pytest.approx(mesh.centroid[2] - 5.0, abs=0.05)


@pytest.mark.parametrize("method", ALL, ids=repr)
@pytest.mark.parametrize("shape", SHAPES)
def test_moving_along_the_water_and_turning_about_the_vertical_move_the_submersion_along(
    method, shape
):
    place, turn = POSES[0]
    yaw = Rotation.from_euler("z", 0.7).as_matrix()
    here = submerge(SHAPES[shape], place, turn, method=method)
    there = submerge(SHAPES[shape], yaw @ place + [3.0, -4.0, 0.0], yaw @ turn, method=method)
    assert there.volume == pytest.approx(here.volume, rel=1e-9)
    assert there.centroid == pytest.approx(yaw @ here.centroid + [3.0, -4.0, 0.0], abs=1e-9)


@pytest.mark.parametrize("shape", CONVEX)
@pytest.mark.parametrize("pose", POSES)
def test_on_convex_meshes_the_hull_with_its_cuts_is_exact_and_sections_nearly(shape, pose):
    mesh = CONVEX[shape]
    truth = submerge(mesh, *pose)
    hull = submerge(mesh, *pose, method=TRUE_HULL)
    assert hull.volume == pytest.approx(truth.volume, rel=1e-11)
    assert hull.centroid == pytest.approx(truth.centroid, abs=1e-11)
    for rule, error in (("trapezoid", 2e-3), ("simpson", 4e-4)):
        cut = submerge(mesh, *pose, method=Sections(rule=rule))
        assert cut.volume == pytest.approx(truth.volume, abs=error * mesh.volume)
        assert cut.centroid == pytest.approx(truth.centroid, abs=4e-3)


@pytest.mark.parametrize("shape", HOLLOW)
@pytest.mark.parametrize("seed", range(3))
def test_on_hollow_meshes_sections_stay_right_and_hulls_are_too_large(shape, seed):
    mesh = HOLLOW[shape]
    pose = (0.0, 0.0, -0.35), Rotation.random(random_state=seed).as_matrix()
    truth = submerge(mesh, *pose).volume
    assert submerge(mesh, *pose, method=Sections()).volume == pytest.approx(
        truth, abs=2e-3 * mesh.volume
    )
    # what a hull fills; even so, without the cuts it may fall short of the surface
    assert submerge(mesh, *pose, method=ConvexHull(cut=True)).volume > truth + 0.02 * mesh.volume


def test_the_paper_s_hull_ends_at_the_last_vertex_below_the_surface():
    # so a box, with vertices at its corners only, has nothing at all under water until its lid is
    box = shapes.box((0.4, 0.3, 0.2))
    assert submerge(box, (0, 0, 0.0), method=ConvexHull()).volume == 0.0
    assert submerge(box, (0, 0, -0.199), method=ConvexHull()).volume == 0.0
    assert submerge(box, (0, 0, -0.201), method=ConvexHull()).volume == pytest.approx(
        8 * 0.4 * 0.3 * 0.2, rel=1e-12
    )
    assert submerge(box, (0, 0, 0.0), method=ConvexHull(cut=True)).volume == pytest.approx(
        4 * 0.4 * 0.3 * 0.2, rel=1e-12
    )


def test_it_nears_the_truth_from_below_as_vertices_grow_dense():
    errors = []
    for subdivisions in (2, 3, 4, 5):
        ball = trimesh_hull(trimesh.creation.icosphere(subdivisions=subdivisions))
        errors.append(
            1.0
            - submerge(ball, (0, 0, 0.3), method=ConvexHull()).volume
            / submerge(ball, (0, 0, 0.3)).volume
        )
    assert all(0.0 < fine < 0.75 * coarse for coarse, fine in itertools.pairwise(errors))
    assert errors[-1] < 0.03


def test_a_torus_has_the_hull_of_pappus():
    # a slab 2 pi R^2 r and outside it the outer half of the torus, pi^2 R r^2 + 4/3 pi r^3
    ring = trimesh_hull(trimesh.creation.torus(1.0, 0.4, major_sections=256, minor_sections=128))
    exact = 2.0 * np.pi * 0.4 + np.pi**2 * 0.16 + 4.0 / 3.0 * np.pi * 0.064
    assert submerge(ring, (0, 0, -2), method=ConvexHull()).volume == pytest.approx(exact, rel=1e-3)
    assert exact / (2.0 * np.pi**2 * 0.16) == pytest.approx(1.38, abs=0.01)


# hulls of points

EDGES = {
    "none": np.zeros((0, 3)),
    "three": np.eye(3),
    "coincident": np.ones((12, 3)),
    "on a line": np.outer(np.arange(9.0), [1.0, 2.0, -1.0]),
    "flat": np.column_stack([np.random.default_rng(1).random((50, 2)), np.zeros(50)]),
    "flat and tilted": np.random.default_rng(2).random((50, 2))
    @ [[1.0, 0.3, 0.2], [-0.4, 1.0, 0.7]],
    "flat and far away": np.column_stack(
        [np.random.default_rng(3).random((50, 2)), np.full(50, 1e3)]
    ),
}


@pytest.mark.parametrize("points", EDGES.values(), ids=EDGES)
def test_sets_without_volume_have_none(points):
    volume, centroid = hull_moments(points)
    assert volume == 0.0
    assert np.isnan(centroid).all()


@given(
    hnp.arrays(
        float, st.tuples(st.integers(0, 12), st.just(3)), elements=st.integers(-3, 3).map(float)
    )
)
def test_any_set_has_the_volume_of_its_delaunay_cells(points):
    volume, centroid = hull_moments(points)
    assert volume == pytest.approx(
        naive.hull_volume(points) if len(points) > 3 else 0.0, rel=1e-9, abs=1e-12
    )
    if volume:
        assert (centroid >= points.min(axis=0) - 1e-9).all()
        assert (centroid <= points.max(axis=0) + 1e-9).all()


@given(st.integers(0, 2**31), st.sampled_from([1e-3, 1e-9, 1e-13, 1e-15]))
def test_nearly_flat_sets_raise_nothing(seed, thickness):
    points = np.random.default_rng(seed).normal(size=(30, 3)) * [1.0, 1.0, thickness]
    volume, _ = hull_moments(points @ Rotation.random(random_state=seed).as_matrix().T)
    assert 0.0 <= volume < 300.0 * thickness + 1e-9


def test_the_mean_of_the_vertices_is_no_centroid():
    # a pyramid, its base finely divided: the mean sinks to the base, the centroid stays put
    side = np.linspace(-1.0, 1.0, 41)
    rim = np.array([(x, y, 0.0) for x in side for y in side if max(abs(x), abs(y)) == 1.0])
    points = np.vstack([rim, [[0.0, 0.0, 1.0]]])
    assert hull_moments(points, "hull")[1] == pytest.approx([0.0, 0.0, 0.25], abs=1e-12)
    assert hull_moments(points, "vertices")[1][2] <= 0.2 + 1e-12


# sorting


def poses_of(places, turns):
    """Arguments of `submerge` for one mesh, one step after the other at 0.01 s."""
    for step, (place, turn) in enumerate(zip(places, turns, strict=True)):
        yield np.array([place]), turn.reshape(1, 9), 0.01 * step


def run(method, mesh, places, turns, water=None):
    packed = method.pack(HullSet([mesh]), water or Water())
    volumes = [packed.submerge(*pose)[0, 0] for pose in poses_of(places, turns)]
    return np.array(volumes), packed.counts


def test_until_the_lowest_vertex_is_wet_one_vertex_a_step_is_looked_at():
    ball = CONVEX["sphere"]
    n = len(ball.vertices)
    volumes, counts = run(ConvexHull(), ball, [(0, 0, 2.0)] * 20, [np.eye(3)] * 20)
    assert not volumes.any()
    assert counts == {
        "calls": 20,
        "vertices": 20 * n,
        "vertex_checks": 2 * n + 18,
        "sorts": 2,
        "hulls": 0,
        "hull_points": 0,
    }


def test_a_body_that_falls_without_turning_loses_nothing_by_it_and_saves_checks():
    mesh, turn = HOLLOW["torus"], POSES[0][1]
    falling = [(0.0, 0.0, 1.5 - 0.03 * step) for step in range(100)]
    plain, all_checks = run(ConvexHull(resort_every=0), mesh, falling, [turn] * 100)
    walked, checks = run(ConvexHull(resort_every=10), mesh, falling, [turn] * 100)
    np.testing.assert_allclose(walked, plain, rtol=1e-12)
    assert all_checks["vertex_checks"] == all_checks["vertices"] == 100 * len(mesh.vertices)
    assert checks["sorts"] == 10
    assert checks["vertex_checks"] < 0.7 * all_checks["vertex_checks"]
    assert checks["hull_points"] == all_checks["hull_points"]


def test_a_body_that_turns_loses_vertices_until_the_next_sort():
    mesh = shapes.ellipsoid((0.5, 0.3, 0.2))
    rolls = [Rotation.from_euler("x", 0.05 * step).as_matrix() for step in range(40)]
    places = [(0.0, 0.0, 0.05)] * 40
    every_step, _ = run(ConvexHull(resort_every=1), mesh, places, rolls)
    plain, _ = run(ConvexHull(resort_every=0), mesh, places, rolls)
    tenth, _ = run(ConvexHull(resort_every=10), mesh, places, rolls)
    np.testing.assert_array_equal(every_step, plain)
    np.testing.assert_array_equal(tenth[::10], plain[::10])
    assert (tenth <= plain + 1e-12).all()
    assert tenth.min() < 0.5 * plain.min()


def test_poses_set_by_hand_and_time_set_back_sort_anew():
    mesh = CONVEX["ellipsoid"]
    packed = ConvexHull().pack(HullSet([mesh]), Water())
    sorts = 0
    for seed, time, fresh in (
        (0, 0.0, True),
        (1, 0.0, True),
        (2, 0.01, True),
        (2, 0.02, False),
        (2, 0.01, True),
    ):
        turn = Rotation.random(random_state=seed).as_matrix()
        volume = packed.submerge(np.zeros((1, 3)), turn.reshape(1, 9), time)[0, 0]
        # sorted anew, vertices of one height may be summed in another order
        anew = submerge(mesh, (0, 0, 0), turn, method=ConvexHull(resort_every=0)).volume
        assert volume == pytest.approx(anew, rel=1e-12)
        sorts += fresh
        assert packed.counts["sorts"] == sorts


def test_runs_that_take_turns_keep_orders_of_their_own():
    mesh = CONVEX["ellipsoid"]
    turns = [
        [Rotation.from_euler("x", side * 0.02 * step).as_matrix() for step in range(30)]
        for side in (1, -1)
    ]
    places = [(0.0, 0.0, 0.05)] * 30
    alone = [run(ConvexHull(), mesh, places, turn)[0] for turn in turns]
    packed = ConvexHull().pack(HullSet([mesh]), Water())
    together = [
        [packed.submerge(*pose, number)[0, 0] for number, pose in enumerate(poses)]
        for poses in zip(*(poses_of(places, turn) for turn in turns), strict=True)
    ]
    np.testing.assert_array_equal(np.array(together).T, alone)


def test_runs_that_ended_are_forgotten():
    packed = ConvexHull().pack(HullSet([CONVEX["box"]]), Water())
    for number in range(200):
        packed.submerge(np.zeros((1, 3)), np.eye(3).reshape(1, 9), 0.0, number)
    assert len(packed._runs) == convex_hull.MOST_RUNS


def test_the_cuts_are_found_from_a_walk_too():
    mesh, turn = CONVEX["capsule"], POSES[1][1]
    falling = [(0.0, 0.0, 0.6 - 0.02 * step) for step in range(60)]
    walked, checks = run(ConvexHull(cut=True), mesh, falling, [turn] * 60)
    exact, _ = run(Exact(), mesh, falling, [turn] * 60)
    np.testing.assert_allclose(walked, exact, rtol=1e-10, atol=1e-13)
    assert checks["vertex_checks"] < checks["vertices"]


# sections


@pytest.mark.parametrize("shape", SHAPES)
def test_sections_are_those_of_an_independent_slice(shape):
    mesh = SHAPES[shape].transformed(POSES[2][1], (0.4, -0.3, 0.0))
    s, rows, _ = cut_sections(
        mesh.vertices, mesh.faces, float(np.ptp(mesh.vertices[:, 2])) / 17.3, np.inf
    )
    for height, (area, u, v, along) in zip(s[1:-1], rows[1:-1], strict=True):
        there, centroid = naive.section(mesh, height)
        # trimesh joins points of a section that are 1e-8 apart
        assert area == pytest.approx(there, rel=1e-6)
        assert [u / area, v / area] == pytest.approx(centroid, abs=1e-6)
        assert along == pytest.approx(area * height, rel=1e-12)


def test_flat_ends_are_counted_at_both():
    box = shapes.box((0.4, 0.3, 0.2))
    s, rows, _ = cut_sections(box.vertices, box.faces, 0.025, np.inf)
    np.testing.assert_allclose(rows[:, 0], 4 * 0.4 * 0.3, rtol=1e-8)
    assert len(s) == 17
    assert integrate(rows, s, "trapezoid")[-1, 0] == pytest.approx(box.volume, rel=1e-8)


@pytest.mark.parametrize(("rule", "order"), [("trapezoid", 2), ("simpson", 3)])
def test_the_rules_converge_with_their_order(rule, order):
    # a cone's section is a parabola in z; Simpson's last, shorter interval is a trapezoid of
    # third order
    cone = naive.cone(1.0, 1.0, sections=64)
    errors = []
    for step in (0.08, 0.04, 0.02, 0.01):
        found = submerge(cone, (0, 0, -0.63), method=Sections(step=step, rule=rule)).volume
        errors.append(abs(found - submerge(cone, (0, 0, -0.63)).volume))
    assert np.log2(errors[0] / errors[-1]) / 3 == pytest.approx(
        order, abs=0.8 if rule == "simpson" else 0.1
    )
    assert errors[-1] < 1e-4


def test_the_iterations_are_the_sections_up_to_the_water():
    packed = Sections(step=0.01).pack(HullSet([CONVEX["box"]]), Water())
    packed.submerge(np.array([[0.0, 0.0, 0.05]]), np.eye(3).reshape(1, 9), 0.0)
    # the box's bottom lies 0.15 m deep
    # each section of a box meets its 8 side triangles, but for those just at their corners
    assert packed.counts == {
        "calls": 1,
        "sections": 16,
        "crossings": 128,
        "tabulated": 0,
        "look_ups": 0,
    }
    table = Sections(step=0.01, axis=(0, 0, 1)).pack(HullSet([CONVEX["box"]]), Water())
    for _ in range(3):
        table.submerge(np.array([[0.0, 0.0, 0.05]]), np.eye(3).reshape(1, 9), 0.0)
    assert table.counts == {
        "calls": 3,
        "sections": 0,
        "crossings": 0,
        "tabulated": 41,
        "look_ups": 3,
    }


@pytest.mark.parametrize("shape", SHAPES)
def test_a_table_along_an_upright_axis_is_the_vertical_method_either_way_up(shape):
    mesh = SHAPES[shape]
    for turn in (np.eye(3), naive.roll(np.pi)):
        truth = submerge(mesh, (0.2, 0.1, -0.07), turn)
        for axis in ((0, 0, 1), (0, 0, -2.0)):
            wet = submerge(mesh, (0.2, 0.1, -0.07), turn, method=Sections(axis=axis))
            assert wet.volume == pytest.approx(truth.volume, abs=STEP_ERROR[shape] * mesh.volume)
            assert wet.centroid == pytest.approx(truth.centroid, abs=5e-3)


def test_an_axis_of_the_body_cuts_a_heeled_body_wrongly():
    # half a ball under water is half a ball whatever the axis, but its centroid lies along the axis
    ball, heel = CONVEX["sphere"], np.radians(40.0)
    wet = submerge(ball, (0, 0, 0), naive.roll(heel), method=Sections(axis=(0, 0, 1)))
    assert wet.volume == pytest.approx(0.5 * ball.volume, rel=2e-3)
    assert wet.centroid == pytest.approx(naive.roll(heel) @ [0, 0, -3 / 8 * 0.5], abs=2e-3)
    # less than half, and the surface is taken at depth / cos(heel)
    shallow = submerge(
        ball, (0, 0, 0.2), naive.roll(heel), method=Sections(axis=(0, 0, 1), step=1e-3)
    )
    assert shallow.volume == pytest.approx(
        submerge(ball, (0, 0, 0.2 / np.cos(heel))).volume, rel=1e-3
    )


def test_small_hulls_are_not_lost_between_sections():
    ball = shapes.sphere(0.01)
    for step in (0.05, 0.5, 100.0):
        for axis in (None, (0.0, 0.0, 1.0)):
            found = submerge(ball, (0, 0, -1), method=Sections(step=step, axis=axis)).volume
            assert found == pytest.approx(ball.volume, rel=0.02)


def test_vertices_without_a_face_are_no_part_of_a_mesh():
    ball = CONVEX["sphere"]
    littered = TriMesh(
        np.vstack([[[0.0, 0.0, 9.0]], ball.vertices, [[20.0, 0.0, -5.0]]]), ball.faces + 1
    )
    for method in ALL:
        clean, same = (submerge(mesh, *POSES[0], method=method) for mesh in (ball, littered))
        assert same.volume == pytest.approx(clean.volume, rel=1e-12)
        assert same.centroid == pytest.approx(clean.centroid, abs=1e-12)


@pytest.mark.parametrize("axis", [(0, 0, 1e-200), (0, 0, 1e200), (0, 0, 1e-5)])
def test_an_axis_counts_by_its_direction_alone(axis):
    pose = POSES[2]
    expected = submerge(CONVEX["sphere"], *pose, method=Sections(axis=(0, 0, 1))).volume
    assert submerge(CONVEX["sphere"], *pose, method=Sections(axis=axis)).volume == pytest.approx(
        expected, rel=1e-12
    )


def test_on_a_wave_sections_see_a_level_surface_over_the_middle_of_each_hull():
    # so they are wrong for what is long for the wave, by 30 % here
    barge, water = shapes.box((2.0, 0.3, 0.2)), Water(waves=RegularWave(0.3, wavelength=6.2))
    here = submerge(barge, (0.4, 0, -0.05), water=water, method=Sections()).volume
    level = float(water.elevation(0.4, 0.0, 0.0))
    assert here == pytest.approx(
        submerge(barge, (0.4, 0, -0.05), water=Water(level=level)).volume, rel=1e-5
    )
    assert here > 1.2 * submerge(barge, (0.4, 0, -0.05), water=water).volume


def test_an_axis_that_lies_level_is_wet_or_dry():
    ball, upright = CONVEX["sphere"], np.eye(3)
    for axis in ((1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0)):
        assert submerge(ball, (0, 0, 0.01), upright, method=Sections(axis=axis)).volume == 0.0
        deep = submerge(ball, (0, 0, -0.01), upright, method=Sections(axis=axis))
        assert deep.volume == pytest.approx(ball.volume, rel=2e-3)


# what no method should be


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: ConvexHull(centroid="mean"), "centroid is 'mean'; possible: hull, vertices"),
        (
            lambda: ConvexHull(resort_every=-1),
            "resort_every is -1; it must be a number of steps, or 0",
        ),
        (lambda: ConvexHull(resort_every=2.5), "resort_every is 2.5"),
        (lambda: Sections(step=0.0), "step is 0.0; it must be a positive length"),
        (lambda: Sections(step=float("nan")), "step is nan"),
        (
            lambda: Sections(axis=(0, 0, 0)),
            r"axis is \(0, 0, 0\); it must be three finite numbers, not all zero",
        ),
        (lambda: Sections(axis=(0, 1)), "axis is"),
        (lambda: Sections(axis="up"), "axis is 'up'"),
        (lambda: Sections(axis=((1, 2), 3, 4)), "axis is"),
        (lambda: Sections(step="0.1"), "step is '0.1'"),
        (lambda: ConvexHull(cut="no"), "cut is 'no'; it must be true or false"),
        (lambda: submerge(CONVEX["box"], method=ConvexHull), "is no method; possible are exact"),
        (lambda: Sections(rule="simpsons"), "did you mean 'simpson'"),
        (
            lambda: submerge(CONVEX["box"], method="hull"),
            "unknown method 'hull'.*possible: convex_hull, exact, sections",
        ),
        (
            lambda: submerge(CONVEX["box"], method=3),
            "3 is no method; possible are exact, convex_hull, sections",
        ),
        (
            lambda: submerge(CONVEX["box"], method=Sections(step=1e-9)),
            "step is 1e-09 m on a mesh 1.08 m long",
        ),
    ],
)
def test_what_makes_no_sense_is_refused(make, message):
    with pytest.raises(MethodError, match=message):
        make()


@pytest.mark.parametrize("method", ALL, ids=repr)
@pytest.mark.parametrize(
    "position", [(np.nan, np.nan, np.nan), (0.0, 0.0, np.inf), (0.0, 0.0, -np.inf)]
)
def test_a_pose_that_left_the_finite_numbers_gives_no_number(method, position):
    packed = method.pack(HullSet([CONVEX["box"]]), Water())
    assert np.isnan(packed.submerge(np.array([position]), np.eye(3).reshape(1, 9), 0.0)[0, 0])
    assert (
        packed.submerge(np.zeros((1, 3)) - [0, 0, 1.0], np.eye(3).reshape(1, 9), 0.01)[0, 0] > 0.0
    )


# in the engine


@pytest.fixture(scope="module")
def auv():
    model = mujoco.MjModel.from_xml_path(str(catalog.models()["sauvc_auv"]))
    data = mujoco.MjData(model)
    data.qpos[:7] = [
        0.4,
        -0.2,
        -0.05,
        *Rotation.from_euler("xyz", [0.3, -0.2, 0.5]).as_quat(scalar_first=True),
    ]
    data.qvel[:] = [0.1, -0.2, 0.05, 0.3, -0.1, 0.2]
    mujoco.mj_forward(model, data)
    return model, data


@pytest.mark.parametrize("method", METHODS)
def test_forces_of_each_mesh_and_their_resultant_move_a_body_alike(auv, method):
    model, data = auv
    water = Water(waves=RegularWave(0.05, frequency=0.5))
    loads = Buoyancy(model, water, damping=None, method=method).evaluate(data)
    each, one = np.zeros((2, model.nv))
    for body, centroid, force in zip(
        [1] * len(loads.names), loads.hull.centroid, loads.hull.force, strict=True
    ):
        if force.any():
            mujoco.mj_applyFT(model, data, force, np.zeros(3), centroid, body, each)
    wet = loads.hull.volume > 0.0
    centroid = loads.hull.volume[wet] @ loads.hull.centroid[wet] / loads.hull.volume.sum()
    mujoco.mj_applyFT(model, data, loads.hull.force.sum(axis=0), np.zeros(3), centroid, 1, one)
    np.testing.assert_allclose(one, each, rtol=1e-12, atol=1e-12)
    # and that is what Loads says in total, and by body
    assert loads.total.centroid == pytest.approx(centroid, rel=1e-12)
    assert loads.total.force == pytest.approx(loads.hull.force.sum(axis=0), rel=1e-12)
    assert loads.hull.force[:, 2] == pytest.approx(1000.0 * 9.81 * loads.hull.volume, rel=1e-12)
    assert loads.body.force[1] == pytest.approx(loads.hull.force.sum(axis=0), rel=1e-12)


def test_an_axis_of_the_body_stands_in_the_body_whatever_frames_its_geoms_have():
    # MuJoCo turns the frames of mesh geoms to their principal axes: the pressure hull's z lies
    # along its length
    model = mujoco.MjModel.from_xml_path(str(catalog.models()["sauvc_auv"]))
    data = mujoco.MjData(model)
    data.qpos[2] = -0.05
    mujoco.mj_forward(model, data)
    exact, fixed = (
        Buoyancy(model, method=m).evaluate(data).hull.volume
        for m in ("exact", Sections(axis=(0, 0, 1)))
    )
    np.testing.assert_allclose(fixed, exact, rtol=0.03, atol=1e-6)


def test_looking_does_not_change_a_run_and_two_data_do_not_change_each_other():
    model = mujoco.MjModel.from_xml_path(str(catalog.models()["hourglass"]))

    def ends(tilts, *, look):
        buoyancy = Buoyancy(model, method="convex_hull")
        datas = [mujoco.MjData(model) for _ in tilts]
        for data, tilt in zip(datas, tilts, strict=True):
            data.qpos[:7] = [
                0.0,
                0.0,
                0.1,
                *Rotation.from_euler("x", tilt).as_quat(scalar_first=True),
            ]
        with buoyancy.installed():
            for step in range(60):
                for data in datas:
                    mujoco.mj_step(model, data)
                    if look and step % 7 == 0:
                        buoyancy.evaluate(data)
        return [data.qpos.copy() for data in datas]

    (a,), (b,) = ends([0.3], look=False), ends([-0.8], look=False)
    np.testing.assert_array_equal(ends([0.3, -0.8], look=False), [a, b])
    np.testing.assert_array_equal(ends([0.3, -0.8], look=True), [a, b])


def test_rk4_ages_an_order_by_two_steps_a_timestep():
    model = mujoco.MjModel.from_xml_path(str(catalog.models()["hourglass"]))
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    model.opt.timestep = 0.005
    data = mujoco.MjData(model)
    data.qpos[2] = 0.15
    buoyancy = Buoyancy(model, method="convex_hull")
    with buoyancy.installed():
        mujoco.mj_step(model, data, 100)
    assert buoyancy.packed.counts["calls"] == 400
    assert 20 <= buoyancy.packed.counts["sorts"] <= 22


@pytest.mark.parametrize("method", [ConvexHull(), Sections(), Sections(axis=(0, 0, 1))], ids=repr)
def test_a_run_that_diverges_is_reported_by_every_method(method):
    scene = dataclasses.replace(
        read_scene(catalog.scenes()["hourglass_drop_still"]), method=method, duration=0.1
    )
    simulation = Simulation(scene)
    simulation.data.qvel[:] = 1e9
    with pytest.raises(DivergenceError, match="diverged"):
        for _ in simulation.frames():
            pass


@pytest.mark.parametrize("method", [TRUE_HULL, Sections(step=2e-3, rule="simpson")])
@pytest.mark.parametrize("wave", [LevelOscillation(0.3, 0.5), RegularWave(0.3, frequency=0.5)])
def test_a_ball_rides_the_moving_level_and_the_travelling_wave_alike_by_every_method(method, wave):
    xml = """<mujoco><worldbody><body><freejoint/>
        <geom type='sphere' size='.2' mass='16'/></body></worldbody></mujoco>"""
    model = mujoco.MjModel.from_xml_string(xml)
    heights = []
    for chosen in (method, "exact"):
        data = mujoco.MjData(model)
        data.qpos[2] = 0.1
        with Buoyancy(model, Water(waves=wave), method=chosen).installed():
            mujoco.mj_step(model, data, 200)
        heights.append(data.qpos[2])
    # the wave is 6.2 m long: across the ball the surface is nearly flat
    assert heights[0] == pytest.approx(heights[1], abs=2e-3)


def test_the_exact_method_is_the_default_everywhere():
    scene = read_scene(catalog.scenes()["auv_waves"])
    assert scene.method == Exact()
    simulation = Simulation(scene)
    assert simulation.buoyancy.settings.method == Exact()
    assert Buoyancy(simulation.model).settings.method == Exact()
    assert simulation.summary().method == "exact"


def test_a_scene_names_its_method_and_its_options():
    path = catalog.scenes()["auv_waves"]
    assert read_scene(path, ["method=sections"]).method == Sections()
    chosen = read_scene(
        path, ['method={kind="convex_hull"}', "method.cut=true", "method.resort_every=3"]
    ).method
    assert chosen == ConvexHull(cut=True, resort_every=3)
    axis = read_scene(path, ["method={kind='sections', axis=[0, 0, 1], step=0.02}"]).method
    assert axis == Sections(step=0.02, axis=(0.0, 0.0, 1.0))
    for settings, message in (
        (["method=exakt"], "unknown kind 'exakt'; did you mean 'exact'"),
        (["method.cut=true"], "'kind' is missing; needed is one of exact, convex_hull, sections"),
        (["method=3"], "method is 3; needed is a table"),
        (["method={kind='sections', cut=true}"], "unknown key 'cut'; possible: axis, rule, step"),
        (["method={kind='convex_hull', cut=1}"], "cut is 1; needed is true or false"),
        (
            ["method={kind='convex_hull', resort_every=1.5}"],
            "resort_every is 1.5; needed is a whole number",
        ),
        (
            ["method={kind='sections', rule='midpoint'}"],
            "rule is 'midpoint'; possible: simpson, trapezoid",
        ),
    ):
        with pytest.raises(SceneError, match=message):
            read_scene(path, settings)


@pytest.mark.parametrize("method", ["convex_hull", "sections"])
def test_a_run_by_another_method_says_so_and_differs(method):
    settings = [f"method={method}", "duration=1.0"]
    simulation = Simulation(read_scene(catalog.scenes()["hourglass_drop_still"], settings))
    for _ in simulation.frames():
        pass
    assert simulation.summary().method == method
    assert ("method", method) in simulation.summary().rows()
    assert simulation.buoyancy.packed.counts["calls"] > 100
