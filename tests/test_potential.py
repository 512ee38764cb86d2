"""Added mass by potential flow: closed forms, another code, invariances, and what is kept of it."""

import itertools
import json
import math
import os

import mujoco
import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner

from buoyancy_mj import Buoyancy, BuoyancyWarning, ModelError, TriMesh
from buoyancy_mj.cli import app
from buoyancy_mj.files import find_cache_folder
from buoyancy_mj.hulls.geoms import find_hulls
from buoyancy_mj.hulls.selection import Selection
from buoyancy_mj.inspection.inspection import inspect_model
from buoyancy_mj.inspection.report import list_sections
from buoyancy_mj.kernels.galerkin import concentrate, integrate
from buoyancy_mj.loads.added_mass import find_estimates
from buoyancy_mj.loads.added_mass_estimates import estimate_added_mass
from buoyancy_mj.meshes import shapes
from buoyancy_mj.meshes.bisection import Bisection
from buoyancy_mj.meshes.decimation import Decimation
from buoyancy_mj.meshes.surface import directed_edges, signed_volume
from buoyancy_mj.meshes.union import find_symmetries, unite
from buoyancy_mj.potential import added_mass, cache
from buoyancy_mj.potential.added_mass import compute_added_mass
from buoyancy_mj.potential.cache import find_added_mass
from buoyancy_mj.potential.ellipsoid import Ellipsoid, ellipsoid_added_mass
from buoyancy_mj.potential.solution import _build_panels, solve
from tests import vessels

BALL = 4.0 / 3.0 * math.pi


def as_mesh(mesh):
    return TriMesh(mesh.vertices, mesh.faces)


def box(x, y, z, at=(0.0, 0.0, 0.0)):
    return shapes.box((0.5 * x, 0.5 * y, 0.5 * z)).transformed(np.eye(3), at)


def moved(matrix, point):
    """A matrix about a point as one about the origin, by the velocity of the point."""
    shift = np.eye(6)
    for axis in range(3):
        shift[:3, 3 + axis] = np.cross(np.eye(3)[axis], point)
    return shift.T @ matrix @ shift


def turned(matrix, turn):
    both = np.kron(np.eye(2), turn)
    return both @ matrix @ both.T


def differ(one, two, mesh):
    """Largest difference of two matrices, as a part of them and of the displaced mass."""
    inertia = mesh.volume * np.square(mesh.extents).sum() / 12.0
    scale = np.diag(two) + np.repeat([mesh.volume, inertia], 3)
    return np.abs((one - two) / np.sqrt(np.outer(scale, scale))).max()


@pytest.fixture
def coarse(monkeypatch):
    """Solutions are not to be fine, only quick."""
    monkeypatch.setattr(added_mass, "FINE", 600)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("BUOYANCY_MJ_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(cache, "_known", {})
    return tmp_path / "cache" / "added_mass"


# the integrals


def test_the_layers_of_a_triangle_are_what_a_fine_rule_sums():
    rng = np.random.default_rng(2)
    corners = rng.normal(size=(3, 3))
    # a tetrahedron, of which the first face counts
    vertices = np.vstack([corners, corners.mean(axis=0) - np.cross(*np.diff(corners, axis=0))])
    faces = np.array([[0, 1, 2], [0, 2, 3], [2, 1, 3], [1, 0, 3]])
    panels = _build_panels(vertices, faces)
    normal, area = panels.normals[0], panels.areas[0]

    # the middles of many small triangles, and their barycentric coordinates
    n = 600
    i, j = (k.ravel() for k in np.mgrid[:n, :n])
    up, down = i + j < n, i + j < n - 1
    first = np.concatenate([i[up] + 1 / 3, i[down] + 2 / 3]) / n
    second = np.concatenate([j[up] + 1 / 3, j[down] + 2 / 3]) / n
    hats = np.column_stack([1 - first - second, first, second])
    places = hats @ corners
    weight = area / len(places)
    flows = np.hstack([np.tile(normal, (len(places), 1)), np.cross(places, normal)])
    layer, found = np.empty(6), np.empty(3)
    for point in corners.mean(axis=0) + rng.normal(size=(4, 3)):
        away = places - point
        r = np.linalg.norm(away, axis=1)
        single = integrate(panels, 0, False, *point, np.empty((3, 2)), layer, found)
        assert single == pytest.approx(weight * (1 / r).sum(), rel=1e-4)
        assert layer == pytest.approx(weight * (flows / r[:, None]).sum(axis=0), abs=1e-4 * single)
        double = -weight * (hats * (away @ normal / r**3)[:, None]).sum(axis=0)
        assert found == pytest.approx(double, abs=1e-3 * np.abs(double).max())
    # far away it is its centre
    near, far = np.empty((2, 6)), np.empty((2, 3))
    one = integrate(panels, 0, False, 90.0, 40.0, 20.0, np.empty((3, 2)), near[0], near[1][:3])
    one = integrate(panels, 0, False, 90.0, 40.0, 20.0, np.empty((3, 2)), near[0], far[0])
    two = concentrate(panels, 0, 90.0, 40.0, 20.0, near[1], far[1])
    assert two == pytest.approx(one, rel=1e-4)
    assert near[1] == pytest.approx(near[0], rel=1e-2, abs=1e-4 * one)
    assert far[1] == pytest.approx(far[0], rel=5e-2)


# one surface


def test_a_ball_of_80_triangles_carries_half_its_volume():
    ball = trimesh.creation.icosphere(subdivisions=1)
    solution = solve(np.array(ball.vertices), np.array(ball.faces, np.int64))
    assert np.diag(solution.matrix) / ball.volume == pytest.approx(
        [0.5, 0.5, 0.5, 0.0, 0.0, 0.0], abs=1e-3
    )
    assert solution.translation == pytest.approx(solution.matrix[:3, :3], abs=1e-3 * ball.volume)


def test_a_surface_cut_further_never_has_less_added_mass():
    bisection = Bisection(*unite([box(1, 1, 1)]))
    found = []
    for count in (48, 96, 192):
        bisection.refine(np.ones(len(bisection.surface[1])), count)
        found.append(solve(*bisection.surface).matrix)
    for coarse, fine in itertools.pairwise(found):
        assert np.linalg.eigvalsh(fine - coarse).min() > -1e-3


def test_water_in_a_closed_cavity_moves_along_whole():
    outer, inner = box(1.0, 0.8, 0.6), box(0.5, 0.4, 0.3, at=(0.1, 0.0, 0.0))
    count = len(outer.vertices)
    vertices = np.vstack([outer.vertices, inner.vertices])
    faces = np.vstack([outer.faces, inner.faces[:, ::-1] + count])
    hollow = solve(vertices, faces).matrix[:3, :3]
    assert hollow == pytest.approx(
        solve(outer.vertices, outer.faces).matrix[:3, :3] + inner.volume * np.eye(3), abs=2e-3
    )


# closed forms


@pytest.mark.parametrize("radii", [(1.0, 1.0, 1.0), (3.0, 1.0, 1.0), (1.0, 0.8, 0.5)])
def test_ellipsoids_have_lambs_added_mass(radii, monkeypatch):
    mesh = shapes.ellipsoid(radii)
    expected = np.diag(ellipsoid_added_mass(radii, 1.0))
    exact = compute_added_mass([mesh])
    assert (exact.change, exact.triangles) == (0.0, 0)
    assert differ(exact.matrix, expected, mesh) < 1e-3
    # and without being told that they are ellipsoids
    monkeypatch.setattr(Ellipsoid, "fits", lambda *_: False)
    found = compute_added_mass([mesh])
    assert found.doubt == ""
    assert found.triangles > 0
    assert differ(found.matrix, expected, mesh) < 0.01


def test_a_cube_has_the_added_mass_of_a_cube():
    # Sihvola et al. 2004: 0.6383; about its centre 0.0392 (Capytaine on graded panels)
    found = compute_added_mass([box(1, 1, 1)])
    assert np.diag(found.matrix) == pytest.approx([0.6383] * 3 + [0.0392] * 3, rel=0.015)
    # and its symmetries to rounding
    assert np.ptp(np.diag(found.matrix)[:3]) < 1e-12
    assert found.matrix == pytest.approx(np.diag(np.diag(found.matrix)), abs=1e-12)


@pytest.mark.parametrize(
    ("ratio", "along", "across"),
    [(2, 0.335, 0.833), (10, 0.0711, None)],
)
def test_square_prisms_have_that_of_converged_potential_flow(ratio, along, across, monkeypatch):
    monkeypatch.setattr(added_mass, "FINE", 1200)
    found = np.diag(compute_added_mass([box(1, 1, ratio)]).matrix) / ratio
    assert found[2] == pytest.approx(along, rel=0.03)
    assert across is None or found[0] == pytest.approx(across, rel=0.02)


def test_thin_plates_and_discs_have_their_limits(monkeypatch):
    monkeypatch.setattr(added_mass, "FINE", 1200)
    # DNV-RP-C205, table D-2: 0.757 pi / 4 a^2 b for b = 2 a
    plate = compute_added_mass([box(1, 2, 5e-4)]).matrix
    assert plate[2, 2] == pytest.approx(0.757 * math.pi / 4 * 2, rel=0.015)
    # Lamb 1932, art. 102, 108: 8/3 broadside, 16/45 about a diameter
    disc = compute_added_mass([shapes.cylinder(1.0, 2.5e-4)]).matrix
    assert disc[2, 2] == pytest.approx(8 / 3, rel=0.02)
    assert disc[3, 3] == pytest.approx(16 / 45, rel=0.04)
    # along themselves they carry next to nothing
    assert np.abs(plate[:2, :2]).max() < 1e-3


# another code


def radiate(mesh):
    """Added mass (6, 6) about the origin by Capytaine, without a free surface."""
    cpt = pytest.importorskip("capytaine")
    panels = cpt.Mesh(vertices=mesh.vertices, faces=np.hstack([mesh.faces, mesh.faces[:, :1]]))
    dofs = cpt.rigid_body_dofs(rotation_center=(0, 0, 0))
    body = cpt.FloatingBody(mesh=panels, dofs=dofs, name="body")
    names = list(dofs.keys()) if hasattr(dofs, "keys") else list(body.dofs)
    solver = cpt.BEMSolver()
    matrix = np.empty((6, 6))
    for row, name in enumerate(names):
        problem = cpt.RadiationProblem(
            body=body, radiating_dof=name, free_surface=np.inf, water_depth=np.inf, rho=1.0, omega=1
        )
        found = solver.solve(problem).added_masses
        matrix[row] = [found[other] for other in names]
    return 0.5 * (matrix + matrix.T)


@pytest.mark.slow
@pytest.mark.parametrize("sides", [(24, 12), (48, 8)])
@pytest.mark.long
def test_ducts_have_the_added_mass_that_capytaine_computes(sides):
    ring = trimesh.creation.torus(1.0, 0.3, major_sections=sides[0], minor_sections=sides[1])
    mesh = as_mesh(ring)
    # its flat panels are too much by the inverse of their number
    coarse = radiate(ring)
    fine = radiate(trimesh.Trimesh(*trimesh.remesh.subdivide(ring.vertices, ring.faces)))
    expected = fine + (fine - coarse) / 3.0
    assert differ(compute_added_mass([mesh]).matrix, expected, mesh) < 0.02


def frame(thick):
    """The twelve beams along the edges of a box."""
    beams = []
    sides = np.array([1.0, 0.7, 0.5])
    for axis in range(3):
        j, k = (axis + 1) % 3, (axis + 2) % 3
        for one in (-0.5, 0.5):
            for two in (-0.5, 0.5):
                size, at = np.full(3, thick), np.zeros(3)
                size[axis] = sides[axis] + thick
                at[j], at[k] = one * sides[j], two * sides[k]
                beams.append(box(*size, at=at))
    return beams


@pytest.mark.slow
def test_an_open_frame_has_the_added_mass_that_capytaine_computes():
    beams = frame(0.1)
    union = as_mesh(trimesh.Trimesh(*unite(beams), process=False))
    bisection = Bisection(union.vertices, union.faces)
    corners = union.vertices[union.faces]
    lengths = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    bisection.refine(lengths.max(axis=1) ** 3, 900)
    surface = bisection.surface
    # beams have sharp edges: on one surface it is too much there, and too little here, and the mean
    # stays the same to 0.4 % on 900, 1,800 and 3,600 triangles
    theirs, ours = radiate(trimesh.Trimesh(*surface, process=False)), solve(*surface).matrix
    found = compute_added_mass(beams)
    assert found.doubt == ""
    assert (np.diag(ours) < np.diag(found.matrix)).all()
    assert (np.diag(found.matrix) < np.diag(theirs)).all()
    assert differ(found.matrix, 0.5 * (theirs + ours), union) < 0.02


# invariances


@pytest.mark.usefixtures("coarse")
def test_added_mass_scales_with_the_cube_of_size_and_moves_with_the_body():
    mesh = vessels.dented(1)
    found = compute_added_mass([mesh]).matrix
    lengths = np.repeat([1.0, 0.01], 3)
    small = compute_added_mass([TriMesh(0.01 * mesh.vertices, mesh.faces)]).matrix
    assert small == pytest.approx(1e-6 * np.outer(lengths, lengths) * found, rel=1e-5)
    away = compute_added_mass([mesh.transformed(np.eye(3), (3.0, -1.0, 2.0))]).matrix
    assert differ(away, moved(found, (3.0, -1.0, 2.0)), mesh) < 1e-6


@pytest.mark.usefixtures("coarse")
def test_added_mass_turns_and_is_mirrored_with_the_body():
    mesh = vessels.dented(1)
    found = compute_added_mass([mesh]).matrix
    turn = Rotation.from_euler("xyz", [0.4, -0.9, 1.3]).as_matrix()
    assert (
        differ(compute_added_mass([mesh.transformed(turn)]).matrix, turned(found, turn), mesh)
        < 0.01
    )
    mirror = np.diag([1.0, -1.0, 1.0])
    image = compute_added_mass([TriMesh(mesh.vertices @ mirror, mesh.faces[:, ::-1])]).matrix
    both = np.zeros((6, 6))
    both[:3, :3], both[3:, 3:] = mirror, -mirror
    assert differ(image, both @ found @ both.T, mesh) < 0.01


@pytest.mark.usefixtures("coarse")
def test_overlapping_meshes_have_the_added_mass_of_their_union():
    whole = box(1.0, 0.6, 0.4)
    parts = [box(0.7, 0.6, 0.4, at=(-0.15, 0, 0)), box(0.5, 0.6, 0.4, at=(0.25, 0, 0))]
    assert (
        differ(compute_added_mass(parts).matrix, compute_added_mass([whole]).matrix, whole) < 0.015
    )


@pytest.mark.usefixtures("coarse")
@pytest.mark.parametrize("gap", [0.0, 1e-9, 1e-6])
def test_turned_boxes_that_touch_are_one_whatever_rounding_makes_of_it(gap):
    turn = Rotation.from_rotvec(np.array([1.0, 2.0, 3.0]) / 14.0**0.5 * 0.7).as_matrix()
    halves = [box(1.0, 1.0, 1.0), box(1.0, 1.0, 1.0, at=(1.0 + gap, 0.0, 0.0))]
    found = compute_added_mass([half.transformed(turn, (0.0, 0.0, 0.0)) for half in halves])
    whole = compute_added_mass([box(2.0, 1.0, 1.0, at=(0.5, 0.0, 0.0))]).matrix
    assert not found.doubt
    assert differ(found.matrix, turned(whole, turn), box(2.0, 1.0, 1.0)) < 0.02


def test_a_union_keeps_plates_that_are_thinner_than_its_detail():
    ball, vane = shapes.sphere(0.1), box(1.0, 1.0, 2e-5, at=(2.0, 0.0, 0.0))
    vertices, faces = unite([ball, vane])
    assert vertices[:, 0].max() == pytest.approx(2.5)
    assert TriMesh(vertices, faces).volume == pytest.approx(ball.volume + vane.volume, rel=1e-3)


def test_a_plate_that_is_too_thin_to_solve_is_told():
    found = compute_added_mass([box(1.0, 1.0, 1e-6)])
    assert found.doubt == "its surface crosses itself, or almost does, where it has few triangles"


@pytest.mark.usefixtures("coarse")
def test_two_balls_far_apart_carry_what_each_carries():
    balls = [shapes.sphere(0.5).transformed(np.eye(3), (0.0, y, 0.0)) for y in (-4.0, 4.0)]
    one = np.diag([0.5 * BALL * 0.125] * 3 + [0.0] * 3)
    expected = sum(moved(one, (0.0, y, 0.0)) for y in (-4.0, 4.0))
    assert differ(compute_added_mass(balls).matrix, expected, balls[0]) < 0.01


# surfaces


def check_closed(vertices, faces, volume):
    edges = directed_edges(faces)
    forward = {tuple(edge) for edge in edges.tolist()}
    assert len(forward) == len(edges)
    assert {edge[::-1] for edge in forward} == forward
    assert signed_volume(vertices, faces) == pytest.approx(volume, rel=1e-9)


def test_cut_surfaces_stay_closed_and_no_triangle_grows_slender():
    mesh = box(1.0, 0.7, 0.4)
    bisection = Bisection(mesh.vertices, mesh.faces)
    bisection.refine(np.arange(12.0) + 1.0, 700)
    vertices, faces = bisection.surface
    assert 700 <= len(faces) <= 701
    check_closed(vertices, faces, mesh.volume)
    sides = np.linalg.norm(vertices[faces] - np.roll(vertices[faces], 1, axis=1), axis=2)
    areas = 0.5 * np.linalg.norm(
        np.cross(*np.diff(vertices[faces], axis=1).transpose(1, 0, 2)), axis=1
    )
    assert (areas / sides.max(axis=1) ** 2).min() > 0.09


def test_slender_triangles_in_a_plane_are_turned_into_rounder_ones():
    prism = shapes.cylinder(1.0, 0.2)
    # a fan around a corner of the rim instead of one around the middle
    corners = Decimation(*unite([prism]))
    corners.reduce(0)
    vertices, faces = unite([prism])
    bisection = Bisection(vertices, faces)
    bisection.turn_flat_edges()
    check_closed(*bisection.surface, prism.volume)

    def smallest(faces):
        a, b, c = vertices[faces.T]
        return min(
            np.arccos(
                np.clip(
                    ((q - p) * (r - p)).sum(axis=1)
                    / np.linalg.norm(q - p, axis=1)
                    / np.linalg.norm(r - p, axis=1),
                    -1,
                    1,
                )
            ).min()
            for p, q, r in ((a, b, c), (b, c, a), (c, a, b))
        )

    assert smallest(bisection.surface[1]) >= smallest(faces) - 1e-9


def test_a_union_keeps_what_is_thin_and_drops_what_is_fine():
    wire, sheet = shapes.cylinder(0.001, 1.0), box(1.0, 1.0, 1e-5)
    assert signed_volume(*unite([wire])) == pytest.approx(wire.volume, rel=1e-2)
    assert signed_volume(*unite([sheet])) == pytest.approx(sheet.volume, rel=1e-6)
    ring = trimesh.creation.torus(1.0, 0.3, major_sections=200, minor_sections=100)
    vertices, faces = unite([as_mesh(ring)])
    assert len(faces) <= 8000
    check_closed(vertices, faces, signed_volume(vertices, faces))
    assert signed_volume(vertices, faces) == pytest.approx(ring.volume, rel=5e-3)


def test_a_decimated_surface_is_closed_and_near():
    ball = shapes.sphere(1.0)
    decimation = Decimation(ball.vertices, ball.faces)
    decimation.reduce(300)
    vertices, faces = decimation.surface
    assert len(faces) == 300
    check_closed(vertices, faces, signed_volume(vertices, faces))
    assert np.abs(np.linalg.norm(vertices, axis=1) - 1.0).max() < 0.03
    assert signed_volume(vertices, faces) == pytest.approx(BALL, rel=0.025)


def test_flat_faces_lose_nothing_and_a_tetrahedron_stays():
    brick = box(1.0, 0.7, 0.4)
    bisection = Bisection(brick.vertices, brick.faces)
    bisection.refine(np.ones(12), 500)
    decimation = Decimation(*bisection.surface)
    decimation.reduce(12)
    assert len(decimation.surface[1]) == 12
    assert signed_volume(*decimation.surface) == pytest.approx(brick.volume, rel=1e-9)
    decimation.reduce(0)
    assert len(decimation.surface[1]) >= 4


@pytest.mark.parametrize(
    ("mesh", "count"),
    [
        (box(1, 1, 1), 48),
        (box(1, 2, 3, at=(1, 2, 3)), 8),
        (box(1, 2, 3).transformed(Rotation.from_euler("x", 0.4).as_matrix()), 8),
        (shapes.cylinder(0.5, 2.0), 16),
        (vessels.dented(1), 1),
    ],
)
def test_symmetries_are_found(mesh, count):
    turns = find_symmetries(TriMesh(*unite([mesh])))
    assert len(turns) == count
    assert np.linalg.inv(turns) == pytest.approx(np.swapaxes(turns, 1, 2))


# estimates


@pytest.mark.usefixtures("coarse", "folder")
def test_a_hull_that_lets_water_through_adds_its_part():
    model = vessels.of_geoms(
        '<geom name="tank" type="box" size=".2 .1 .1" mass="9"/>'
        '<geom name="frame" type="box" size=".3 .3 .02" pos="0 0 .3"/>'
    )
    full = estimate_added_mass(find_hulls(model), 1000.0).matrix
    tank = estimate_added_mass([find_hulls(model)[0]], 1000.0).matrix
    open_hulls = find_hulls(model, Selection(fill="frame=0.25"))
    found = estimate_added_mass(open_hulls, 1000.0)
    assert found.method == "mesh"
    assert found.matrix == pytest.approx(0.25 * full + 0.75 * tank, abs=1e-9 * full.max())


def test_a_body_that_potential_flow_does_not_know_is_told_or_refused(monkeypatch):
    monkeypatch.setattr(added_mass, "GIVEN", 10)
    model = vessels.box((0.31, 0.2, 0.1))
    hulls = find_hulls(model)
    reason = (
        "the added mass of body 'hull' is not known from its meshes: "
        "its surface needs 12 triangles, and 10 are possible"
    )
    monkeypatch.setattr(cache, "_known", {})
    monkeypatch.setenv("BUOYANCY_MJ_CACHE", "")
    with pytest.warns(BuoyancyWarning) as caught:
        (found,) = find_estimates(model, hulls, 1000.0, "estimate").values()
    assert [str(one.message) for one in caught] == [
        f"{reason}; that of an ellipsoid is taken instead"
    ]
    (ellipsoid,) = find_estimates(model, hulls, 1000.0, "ellipsoid").values()
    assert np.array_equal(found.matrix, ellipsoid.matrix)
    assert (found.method, ellipsoid.method, ellipsoid.doubt) == ("ellipsoid", "ellipsoid", "")
    with pytest.raises(ModelError) as error:
        Buoyancy(model, added_mass="mesh")
    assert str(error.value) == (
        f"{reason}; added_mass='estimate' takes that of an ellipsoid instead"
    )


def test_surfaces_that_touch_along_an_edge_are_solved_as_two():
    wedge = np.array([[0, 0, 0], [0, 0, 1], [1, 0.3, 0.5], [1, -0.3, 0.5]])
    faces = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])
    if signed_volume(wedge, faces) < 0.0:
        faces = faces[:, ::-1]
    other = np.array([0, 1, 4, 5])
    both = TriMesh(np.vstack([wedge, wedge[2:] * [-1, -1, 1]]), np.vstack([faces, other[faces]]))
    vertices, split = unite([both])
    check_closed(vertices, split, both.volume)
    assert len(vertices) == 8


@pytest.mark.usefixtures("coarse")
def test_a_solution_that_is_not_converged_is_doubted(monkeypatch):
    monkeypatch.setattr(added_mass, "REST", 1e-6)
    found = compute_added_mass([box(1, 1, 1)])
    assert found.doubt.startswith(f"on {found.triangles} triangles ")
    assert found.doubt.endswith(" % of it are still to come")


@pytest.mark.usefixtures("coarse")
def test_what_takes_long_is_told_once(monkeypatch):
    monkeypatch.setattr(added_mass, "LONG", 0.0)
    told = []
    compute_added_mass([box(1, 1, 1)], lambda: told.append(1))
    assert told == [1]


@pytest.mark.usefixtures("coarse")
def test_a_surface_of_many_triangles_is_told_before_it_is_decimated(monkeypatch):
    monkeypatch.setattr(added_mass, "MANY", 11)
    told = []

    def simplify(mesh):
        assert told == [1]
        return mesh.compact

    monkeypatch.setattr(added_mass, "_simplify", simplify)
    monkeypatch.setattr(added_mass, "LONG", 0.0)
    compute_added_mass([box(1, 1, 1)], lambda: told.append(1))
    assert told == [1]


# what is kept


def forget(monkeypatch, compute=None):
    """As in another process; where it computes, that is refused or counted."""
    monkeypatch.setattr(cache, "_known", {})
    if compute is not None:
        monkeypatch.setattr(cache, "compute_added_mass", compute)


def test_a_shape_is_solved_once_for_all_processes(folder, monkeypatch):
    mesh = shapes.sphere(0.3)
    found = find_added_mass([mesh])
    assert len(list(folder.iterdir())) == 1

    def refuse(*_):
        raise AssertionError

    forget(monkeypatch, refuse)
    again = find_added_mass([mesh])
    assert np.array_equal(again.matrix, found.matrix)
    assert (again.change, again.triangles, again.doubt) == (0.0, 0, "")
    # a pose with another rounding is the same shape
    shifted = TriMesh(mesh.vertices * (1.0 + 1e-15), mesh.faces)
    assert np.array_equal(find_added_mass([shifted]).matrix, found.matrix)
    with pytest.raises(AssertionError):
        find_added_mass([shapes.sphere(0.31)])


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[]",
        "{",
        '{"matrix": [1, 2]}',
        '{"matrix": "x"}',
        "[" * 100_000,
        "\xff",
        '{"matrix": [[1e999',
    ],
)
def test_a_file_that_makes_no_sense_is_computed_anew(folder, monkeypatch, text):
    mesh = shapes.sphere(0.3)
    found = find_added_mass([mesh])
    (path,) = folder.iterdir()
    path.write_bytes(text.encode("latin-1"))
    forget(monkeypatch)
    assert np.array_equal(find_added_mass([mesh]).matrix, found.matrix)
    assert json.loads(path.read_text())["triangles"] == 0


def test_a_file_with_other_numbers_than_a_matrix_has_is_computed_anew(folder, monkeypatch):
    mesh = shapes.sphere(0.3)
    found = find_added_mass([mesh])
    (path,) = folder.iterdir()
    for entry in (math.nan, 5.0):
        table = json.loads(path.read_text())
        table["matrix"][1] = entry
        path.write_text(json.dumps(table))
        forget(monkeypatch)
        assert np.array_equal(find_added_mass([mesh]).matrix, found.matrix)


def test_nothing_is_kept_where_nothing_is_wanted_or_nothing_can_be_written(tmp_path, monkeypatch):
    for place in ("", str(tmp_path / "file" / "below")):
        (tmp_path / "file").write_text("here")
        monkeypatch.setenv("BUOYANCY_MJ_CACHE", place)
        monkeypatch.chdir(tmp_path)
        forget(monkeypatch)
        find_added_mass([shapes.sphere(0.3)])
        assert os.listdir(tmp_path) == ["file"]


def test_the_folder_is_the_users(monkeypatch, tmp_path):
    monkeypatch.delenv("BUOYANCY_MJ_CACHE", raising=False)
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert find_cache_folder() == tmp_path / "buoyancy_mj"
    monkeypatch.delenv("XDG_CACHE_HOME")
    monkeypatch.setenv("HOME", str(tmp_path))
    assert find_cache_folder() == tmp_path / ".cache" / "buoyancy_mj"
    monkeypatch.setattr("sys.platform", "darwin")
    assert find_cache_folder() == tmp_path / "Library" / "Caches" / "buoyancy_mj"
    # a relative one would be in the working folder
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.setenv("BUOYANCY_MJ_CACHE", "~/kept")
    assert find_cache_folder() == tmp_path / "kept"
    monkeypatch.delenv("BUOYANCY_MJ_CACHE")
    monkeypatch.setenv("XDG_CACHE_HOME", "caches")
    assert find_cache_folder() is None


# the report


ARM = """<mujoco><custom><numeric name="added_mass:arm" data="1 2 3 .1 .2 .3"/></custom>
<worldbody><body name="hull"><freejoint/><geom type="box" size=".3 .2 .1" mass="9" pos="0 0 .01"/>
<body name="arm" pos=".5 0 0"><joint axis="0 1 0"/><geom type="capsule" size=".05 .2"/></body>
</body></worldbody></mujoco>"""


@pytest.mark.usefixtures("coarse", "folder")
def test_inspect_reports_the_added_mass_of_each_body_and_where_it_comes_from(tmp_path):
    model = mujoco.MjModel.from_xml_string(ARM)
    assert inspect_model(model).added_mass == {}
    inspection = inspect_model(model, added_mass="estimate")
    found = inspection.added_mass
    assert list(found) == ["hull", "arm"]
    assert found["arm"].matrix == pytest.approx(np.diag([1, 2, 3, 0.1, 0.2, 0.3]))
    assert (found["hull"].method, found["arm"].method) == ("mesh", "stated")
    (section,) = [one for one in list_sections(inspection) if one.title.startswith("Added mass")]
    assert section.rows[1] == ("arm", "1", "2", "3", "0.1", "0.2", "0.3", "stated", "-")
    assert section.rows[0][7] == "mesh"
    assert float(section.rows[0][8]) == pytest.approx(100 * found["hull"].change, abs=0.06)
    assert float(section.rows[0][3]) == pytest.approx(found["hull"].matrix[2, 2], rel=1e-3)
    # on the command line
    (tmp_path / "arm.xml").write_text(ARM)
    flags = ["inspect", str(tmp_path / "arm.xml"), "--json", "--added-mass"]
    table = json.loads(CliRunner().invoke(app, [*flags, "estimate"]).stdout)["added_mass"]
    assert table["hull"]["matrix"][2][2] == pytest.approx(found["hull"].matrix[2, 2])
    assert table["arm"]["method"] == "stated"
    refused = CliRunner().invoke(app, [*flags, "guess"])
    assert refused.exit_code == 1
    assert "added mass is 'guess'; possible: ellipsoid, estimate" in refused.stderr
