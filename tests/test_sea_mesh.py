"""The sea as it is drawn: its mesh lies on the surface that acts."""

import numpy as np
import pytest

from buoyancy_mj import JonswapSea, LevelOscillation, RegularWave, Water
from buoyancy_mj.drawing.sea_mesh import HORIZON, SeaMesh

CENTRE = np.array([3.0, -2.0])
SEAS = {
    "still": Water(level=0.3),
    "regular": Water(waves=RegularWave(0.3, wavelength=4.0, direction=0.4)),
    "jonswap": Water(waves=JonswapSea(1.0, peak_period=5.0, spreading=5.0), current=(0.5, 0, 0)),
    "two": Water(waves=(RegularWave(0.2, period=2.0), RegularWave(0.1, period=9.0, direction=2.0))),
}


def world_vertices(mesh, water, time=1.3):
    surface = mesh.shape(water, CENTRE, time)
    vertices = surface.vertices.astype(float)
    vertices[:, :2] += CENTRE
    return vertices, surface.normals


@pytest.mark.parametrize("sea", SEAS)
def test_within_its_radius_the_mesh_is_within_a_millimetre_of_the_surface(sea):
    water = SEAS[sea]
    mesh = SeaMesh(1.5, water.curvature)
    vertices, _ = world_vertices(mesh, water)
    corners = vertices[mesh.faces]
    is_near = np.hypot(*(corners.mean(axis=1)[:, :2] - CENTRE).T) < 1.5
    # anywhere on its triangles
    parts = np.random.default_rng(0).dirichlet([1.0, 1.0, 1.0], is_near.sum())
    points = np.einsum("ij,ijk->ik", parts, corners[is_near])
    assert np.abs(water.depth(points, 1.3)).max() < 1e-3


def test_the_mesh_is_where_the_water_reaches_a_float_that_rides_it():
    water = SEAS["jonswap"]
    mesh = SeaMesh(0.4, water.curvature)
    vertices, _ = world_vertices(mesh, water, 7.0)
    angles = np.linspace(0.0, 2.0 * np.pi, 50)
    waterline = CENTRE + 0.2 * np.column_stack([np.cos(angles), np.sin(angles)])
    nearest = np.linalg.norm(vertices[:, None, :2] - waterline, axis=2).argmin(axis=0)
    height = water.elevation(*vertices[nearest, :2].T, 7.0)
    assert vertices[nearest, 2] == pytest.approx(height, abs=1e-6)


def test_normals_are_those_of_the_surface():
    water = SEAS["regular"]
    mesh = SeaMesh(1.0, water.curvature)
    vertices, normals = world_vertices(mesh, water)
    is_near = np.hypot(*(vertices[:, :2] - CENTRE).T) < 1.0
    slope = water.slope(*vertices[is_near, :2].T, 1.3)
    expected = np.column_stack([-slope, np.ones(len(slope))])
    expected /= np.linalg.norm(expected, axis=1)[:, None]
    assert normals[is_near] == pytest.approx(expected, abs=1e-5)
    assert np.linalg.norm(normals, axis=1) == pytest.approx(1.0, abs=1e-6)


def test_the_mesh_has_no_hole_and_faces_up():
    mesh = SeaMesh(1.0)
    vertices, _ = world_vertices(mesh, Water())
    a, b, c = np.moveaxis(vertices[mesh.faces], 1, 0)
    areas = 0.5 * np.cross(b - a, c - a)[:, 2]
    assert areas.min() > 0.0
    rim = np.hypot(*(vertices[-1, :2] - CENTRE))
    count = round(2.0 * np.pi / np.arctan2(*np.abs(vertices[2, :2] - CENTRE)[::-1]))
    assert rim >= HORIZON
    assert areas.sum() == pytest.approx(
        0.5 * count * rim**2 * np.sin(2.0 * np.pi / count), rel=1e-6
    )
    # each inner edge is between two triangles, run through both ways
    edges = np.concatenate([mesh.faces[:, [i, (i + 1) % 3]] for i in range(3)]).astype(np.int64)
    codes = edges @ [len(vertices), 1]
    back = edges @ [1, len(vertices)]
    assert len(np.unique(codes)) == len(codes)
    assert np.count_nonzero(~np.isin(codes, back)) == count


def test_far_off_no_wave_is_left_that_the_mesh_could_not_show():
    water = Water(level=0.5, waves=RegularWave(0.3, wavelength=4.0))
    mesh = SeaMesh(1.0, water.curvature)
    vertices, normals = world_vertices(mesh, water)
    is_far = np.hypot(*(vertices[:, :2] - CENTRE).T) > 200.0
    assert vertices[is_far, 2] == pytest.approx(0.5)
    assert normals[is_far, 2] == pytest.approx(1.0)


def test_a_level_that_goes_up_and_down_does_so_to_the_horizon():
    water = Water(waves=LevelOscillation(0.3, 0.5, phase=0.2))
    vertices, _ = world_vertices(SeaMesh(1.0), water)
    assert vertices[:, 2] == pytest.approx(float(water.elevation(0.0, 0.0, 1.3)), abs=1e-6)


def test_another_sea_on_the_same_mesh_is_drawn_as_itself():
    mesh = SeaMesh(1.5, 1.0)
    world_vertices(mesh, SEAS["regular"])
    vertices, _ = world_vertices(mesh, SEAS["two"])
    assert vertices[:50, 2] == pytest.approx(SEAS["two"].elevation(*vertices[:50, :2].T, 1.3))
