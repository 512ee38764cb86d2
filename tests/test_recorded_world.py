"""The picture of a recording: where the eye is, and what it sees around the vehicles."""

import math

import mujoco
import numpy as np
import pytest
import rerun as rr

from buoyancy_mj import RegularWave, Simulation, Water, read_scene
from buoyancy_mj.drawing.shots import look_at
from buoyancy_mj.drawing.sight import clear_sight
from buoyancy_mj.meshes import shapes
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.run import place_at_start
from buoyancy_mj.submersion.wetted_surface import Placed, cut_waterlines, cut_wetted_surface
from buoyancy_mj.viz import eye as eyes
from buoyancy_mj.viz import motes, sea_surface, sky
from buoyancy_mj.viz.depth_tint import STEPS, DepthTint
from buoyancy_mj.viz.height_fields import mesh_height_field
from buoyancy_mj.viz.legend import WIDTH, Legend
from buoyancy_mj.viz.log import Log
from buoyancy_mj.viz.motes import MoteDrawing
from buoyancy_mj.viz.sea_grid import choose_cell, paint_grid
from buoyancy_mj.viz.sea_shades import Shades
from buoyancy_mj.viz.sea_surface import SurfaceDrawing
from buoyancy_mj.viz.sites import draw_sites
from buoyancy_mj.viz.surroundings import Surroundings


class Kept(Log):
    """A log that keeps what is drawn, in the place of sending it."""

    def __init__(self):
        super().__init__(())
        self.static, self.rows = {}, []

    def keep(self, entity, *data):
        self.static.setdefault(entity, []).extend(data)

    def draw(self, entity, _archetype, **parts):
        copies = {name: np.array(part) for name, part in parts.items()}
        self.rows.append((self.time, entity, copies))

    def of(self, entity, part):
        return [
            (time, parts[part]) for time, one, parts in self.rows if one == entity and part in parts
        ]


def simulate(scene, *settings):
    return Simulation(read_scene(catalog.scenes()[scene], list(settings)))


def eye_of(scene, *settings):
    simulation = simulate(scene, *settings)
    return simulation, eyes.Eye(simulation, place_at_start(simulation))


def see(eye, points):
    """Where points are in the eye's picture, whose edges are at 1 and -1."""
    return look_at(eye.position, eye.middle, eyes.FOVY).project(points, eyes.ASPECT)


def corners(simulation, data):
    """Corners of boxes around all moving geoms (n, 3) [m]."""
    model, signs = simulation.model, np.indices((2, 2, 2)).reshape(3, -1).T * 2.0 - 1.0
    moving = np.flatnonzero(model.body_weldid[model.geom_bodyid] > 0)
    turns = data.geom_xmat[moving].reshape(-1, 3, 3)
    boxes = model.geom_aabb[moving, None, :3] + signs * model.geom_aabb[moving, None, 3:]
    return np.concatenate(np.einsum("gij,gcj->gci", turns, boxes) + data.geom_xpos[moving, None])


# the eye ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("depth", [0.3, 8.0, 50.0])
def test_the_vehicle_is_whole_in_the_picture_and_fills_a_good_part_of_it_at_every_depth(depth):
    simulation = simulate("auv_drop_still", f"start.position.2={-depth}", "duration=1.5")
    surroundings, log = Surroundings(simulation, place_at_start(simulation)), Kept()
    for frame in simulation.frames():
        log.time = frame.time
        surroundings.draw(log, frame)
        places = see(surroundings.eye, corners(simulation, frame.data))
        assert (np.abs(places) < 0.95).all()
        assert np.ptp(places[:, 1]) > 0.35
    assert surroundings.eye.is_below == (depth > 1.0)
    # the view is that of a camera there
    (_, last), *_ = reversed(log.of(eyes.ENTITY, "translation"))
    assert last[0] == pytest.approx(surroundings.eye.position)
    aim = last[0] - surroundings.eye.offset
    assert np.linalg.norm(aim - frame.centre_of_mass) < 0.25 * simulation.vehicle.length


def test_the_picture_follows_a_vehicle_that_moves_and_the_world_does_not():
    simulation = simulate("auv_pool", "duration=2.0", "record_rate=10")
    surroundings, log = Surroundings(simulation, place_at_start(simulation)), Kept()
    surroundings.draw_static(log)
    for frame in simulation.frames():
        log.time = frame.time
        surroundings.draw(log, frame)
    track = np.concatenate([place for _, place in log.of(eyes.ENTITY, "translation")])
    assert np.linalg.norm(track[-1] - track[0]) > 0.5
    moved = {entity for _, entity, parts in log.rows if "translation" in parts}
    assert moved == {eyes.ENTITY, sea_surface.ENTITY, sky.ENTITY}
    # the sea moves by whole squares, so that its grid stays
    steps = np.concatenate([place for _, place in log.of(sea_surface.ENTITY, "translation")])
    squares = steps[:, :2] / surroundings.cell
    assert squares == pytest.approx(np.round(squares))


def test_heave_shows_since_the_eye_is_slow_to_go_up_and_down():
    _, eye = eye_of("auv_drop_still")
    log, start = Kept(), eye.middle.copy()
    for time in np.linspace(0.0, 2.0, 61):
        eye.draw(log, start[None] + [0.0, 0.0, 0.05 * math.sin(math.pi * time)], time)
    heights = np.concatenate([place for _, place in log.of(eyes.ENTITY, "translation")])[:, 2]
    assert np.ptp(heights) < 0.5 * 0.1


FLEET = """
title = "Two"
[[vehicles]]
model = "hourglass"
name = "first"
[[vehicles]]
model = "hourglass"
name = "other"
start.position = [2.0, 1.0, -0.5]
"""


@pytest.fixture
def fleet(tmp_path):
    (tmp_path / "two.toml").write_text(FLEET)
    simulation = Simulation(read_scene(tmp_path / "two.toml"))
    return simulation, eyes.Eye(simulation, place_at_start(simulation))


@pytest.mark.parametrize("apart", [0.0, 3.0, 20.0])
def test_all_of_several_vehicles_stay_in_the_picture_as_they_part(fleet, apart):
    simulation, eye = fleet
    data, log = place_at_start(simulation), Kept()
    centres = np.array([one.centre_of_mass(data) for one in simulation.vehicles.values()])
    middle = centres.mean(axis=0)
    for time in np.linspace(0.0, 10.0, 101):
        spread = centres + apart * time / 10.0 * np.sign(centres - middle) * [1.0, 1.0, 0.0]
        eye.draw(log, spread, time)
        assert (np.abs(see(eye, spread)) < 1.0).all()
    (_, place), *_ = reversed(log.of(eyes.ENTITY, "translation"))
    assert place[0] == pytest.approx(eye.position)


def test_the_camera_of_several_vehicles_looks_at_their_middle_and_is_level(fleet):
    (_, eye), log = fleet, Kept()
    eye.draw_static(log)
    eye.draw(log, eye.middle[None], 0.0)
    assert any(isinstance(one, rr.Pinhole) for one in log.static[eyes.ENTITY])
    ((_, turn),) = log.of(eyes.ENTITY, "quaternion")
    axes = np.empty(9)
    mujoco.mju_quat2Mat(axes, np.roll(turn[0], 1))
    right, down, forward = axes.reshape(3, 3).T
    assert forward == pytest.approx(-eye.offset / eye.distance)
    assert right[2] == pytest.approx(0.0)
    assert down[2] < 0.0


@pytest.mark.parametrize("scene", ["auv_pool", "sauvc_qualification", "sauvc_course"])
def test_no_wall_is_between_the_eye_and_the_vehicle(scene):
    simulation, eye = eye_of(scene)
    start = place_at_start(simulation)
    seen = clear_sight(simulation.model, start, eye.middle, eye.position)
    assert seen == pytest.approx(eye.position)
    assert eye.distance > simulation.vehicle.length


def test_the_eye_clears_the_crests_of_waves_and_what_is_dropped_from_above():
    _, eye = eye_of("hourglass_drop_waves")
    assert eye.offset[2] > eye.crest
    _, eye = eye_of("auv_waves")
    assert eye.position[2] > eye.crest


# the sea ------------------------------------------------------------------------------------------


def draw_sea(water, frames=1, rate=60.0, scene="auv_drop_still"):
    _, eye = eye_of(scene)
    surface, log = SurfaceDrawing(water, eye, choose_cell(eye.distance)), Kept()
    surface.draw_static(log)
    for frame in range(frames):
        log.time = frame / rate
        surface.draw(log, log.time)
    return eye, log


WAVES = Water(waves=RegularWave(0.2, period=2.5, direction=0.4))


def test_triangles_of_the_sea_and_its_grid_are_sent_once():
    _, log = draw_sea(WAVES, frames=30)
    names = [name for mesh in log.static[sea_surface.ENTITY] for name in sent(mesh)]
    assert sorted(names) == [
        "albedo_texture_buffer", "albedo_texture_format", "triangle_indices", "vertex_texcoords",
    ]  # fmt: skip
    rows = {name for _, entity, parts in log.rows if entity == sea_surface.ENTITY for name in parts}
    assert rows == {"translation", "vertex_positions", "vertex_colors", "albedo_factor"}


def sent(archetype):
    return [
        batch.component_descriptor().component.split(":")[1]
        for batch in archetype.as_component_batches()
    ]


def test_the_sea_is_as_high_as_the_waves_are_around_the_vehicle():
    eye, log = draw_sea(WAVES, frames=31)
    time, points = log.of(sea_surface.ENTITY, "vertex_positions")[-1]
    (_, place), *_ = log.of(sea_surface.ENTITY, "translation")
    near = np.hypot(points[:, 0], points[:, 1]) < eye.distance
    world = points[near] + place[0]
    assert time == pytest.approx(0.5)
    assert near.sum() > 100
    assert world[:, 2] == pytest.approx(WAVES.elevation(world[:, 0], world[:, 1], time), abs=0.005)
    # and still where it meets what is drawn out to the horizon
    rim = np.hypot(points[:, 0], points[:, 1]) > 0.99 * np.hypot(points[:, 0], points[:, 1]).max()
    assert (points[rim, 2] == 0.0).all()


def test_the_sea_is_sent_thirty_times_a_second_and_still_water_once():
    _, log = draw_sea(WAVES, frames=61)
    assert len(log.of(sea_surface.ENTITY, "vertex_positions")) == 31
    assert len(log.of(sea_surface.ENTITY, "vertex_colors")) == 16
    _, log = draw_sea(Water(), frames=61)
    assert len(log.of(sea_surface.ENTITY, "vertex_positions")) == 1


def test_what_slopes_away_from_the_eye_reflects_the_sky_and_what_faces_it_shows_the_deep():
    eye = np.array([0.0, -3.0, 1.0])
    away, flat, facing = np.array([[0.0, -0.2], [0.0, 0.0], [0.0, 0.2]])
    point = np.zeros((1, 3))
    bright = [
        int(Shades(point, eye).paint(slope[None])[0] >> 16 & 255) for slope in (facing, flat, away)
    ]
    assert bright[0] < bright[1] < bright[2]


def test_from_below_the_sea_is_bright_overhead_and_fades_into_the_haze_far_off():
    points = np.array([[0.0, 0.0, 0.0], [5.0, 0.0, 0.0], [300.0, 0.0, 0.0]])
    colours = Shades(points, np.array([0.0, 0.0, -2.0])).paint(np.zeros((3, 2)))
    red = colours >> 24
    assert red[0] > red[1]
    assert abs(int(red[2]) - round(255 * 0.06)) < 8


def test_the_grid_has_round_squares():
    assert [choose_cell(distance) for distance in (0.5, 2.0, 4.0, 40.0)] == [0.2, 1.0, 2.0, 20.0]
    picture = paint_grid(10.0, 1.0)
    assert picture.shape[2] == 3
    # a line through the middle, and none half a square beside it
    middle = len(picture) // 2
    half = round(middle * (1.0 + 0.5 / 10.0))
    assert picture[middle, half, 0] > picture[half, half, 0]


# deep water and floors ----------------------------------------------------------------------------


def test_motes_lie_still_while_their_block_follows_the_eye():
    _, eye = eye_of("auv_drop_still", "start.position.2=-30")
    drawing, log = MoteDrawing(eye), Kept()
    drawing.draw_static(log)
    for step in range(40):
        eye.middle = eye.middle + [0.3, 0.1, -0.2]
        log.time = float(step)
        drawing.draw(log)
    blocks = np.concatenate([place for _, place in log.of(motes.ENTITY, "translation")])
    side = motes.CELL * eye.distance
    assert len(blocks) > 2
    cubes = (blocks - blocks[0]) / side
    assert cubes == pytest.approx(np.round(cubes))
    assert np.abs(blocks[-1] - eye.middle).max() <= 0.51 * side


def test_motes_are_under_water_and_shown_to_an_eye_there():
    _, eye = eye_of("auv_drop_still", "start.position.2=-3")
    drawing, log = MoteDrawing(eye), Kept()
    drawing.draw_static(log)
    drawing.draw(log)
    (cloud,) = log.static[motes.ENTITY]
    heights = cloud.positions.as_arrow_array().flatten().to_numpy().reshape(-1, 3)[:, 2]
    ((_, block),) = log.of(motes.ENTITY, "translation")
    assert heights.max() + block[0, 2] < 0.0
    assert log.of(motes.ENTITY, "radii")[0][1] > 0.0


SEABED = """<mujoco><asset><hfield name="bed" nrow="2" ncol="3" size="6 4 2 1"
elevation="0 1 0  0 .5 0"/></asset><worldbody>
<geom name="floor" type="plane" size="0 0 1" pos="1 2 -7" rgba=".8 .7 .5 1"/>
<geom name="shoal" type="hfield" hfield="bed" pos="0 0 -6"/>
<body name="boat"><freejoint/><geom type="box" size=".4 .2 .1" mass="20"/></body>
</worldbody></mujoco>"""


def test_a_plane_without_end_is_a_floor_as_far_as_one_sees_wherever_the_vehicle_goes(tmp_path):
    (tmp_path / "boat.xml").write_text(SEABED)
    simulation = simulate("auv_drop_still", f"vehicle='{tmp_path / 'boat.xml'}'")
    surroundings, log = Surroundings(simulation, place_at_start(simulation)), Kept()
    surroundings.draw_static(log)
    for frame in simulation.frames():
        surroundings.draw(log, frame)
        break
    surroundings.eye.middle = surroundings.eye.middle + [100.0, 0.0, 0.0]
    surroundings._geoms.draw(log)
    (_, first), (_, second) = log.of("world/environment/floor", "translation")
    assert first[0, 2] == second[0, 2] == -7.0
    # by whole pairs of tiles, so that they stay
    pairs = (second - first)[0] / (2.0 * surroundings.cell)
    assert pairs[0] == pytest.approx(round(pairs[0]))
    assert second[0, 0] - first[0, 0] == pytest.approx(100.0, abs=2.0 * surroundings.cell)
    assert motes.ENTITY not in log.static


def test_height_fields_are_drawn_as_high_as_the_engine_has_them():
    model = mujoco.MjModel.from_xml_string(SEABED)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    points, faces = mesh_height_field(model, model.geom("shoal").id)
    assert len(points) == 6
    assert len(faces) == 4
    hit, down = np.zeros(1, np.int32), np.array([0.0, 0.0, -1.0])
    for point in points * [0.99, 0.99, 1.0] + [0.0, 0.0, -6.0]:
        above = np.array([*point[:2], 10.0])
        distance = mujoco.mj_ray(model, data, above, down, None, 1, -1, hit, None)
        assert 10.0 - distance == pytest.approx(point[2], abs=0.05)
    a, b, c = points[faces.T]
    assert (np.cross(b - a, c - a)[:, 2] > 0.0).all()


def test_floors_and_walls_have_squares_and_take_the_place_of_motes():
    simulation = simulate("sauvc_qualification")
    surroundings, log = Surroundings(simulation, place_at_start(simulation)), Kept()
    surroundings.draw_static(log)
    tiled = {
        entity.rsplit("/")[-1]
        for entity, parts in log.static.items()
        if "environment" in entity
        and any("albedo_texture_buffer" in sent(one) for one in parts if isinstance(one, rr.Mesh3D))
    }
    assert {name for name in tiled if name.startswith("wall")}
    assert not {name for name in tiled if "gate" in name}
    assert motes.ENTITY not in log.static
    assert set(surroundings.passive) > {entity for entity in log.static if "wall" in entity}


# the vehicle --------------------------------------------------------------------------------------


def test_colours_keep_apart_at_every_depth_and_are_their_own_in_the_air():
    colours = np.array([[250, 200, 20, 255], [230, 80, 20, 255], [235, 235, 235, 128]], np.uint8)
    tint = DepthTint(Water(), np.arange(3), ["a", "b", "c"], colours)
    shades = tint._colours.astype(">u4").view(np.uint8).reshape(3, STEPS + 1, 4)
    assert (shades[:, 0] == colours).all()
    assert (shades[:, :, 3] == colours[:, None, 3]).all()
    for one, other in ((0, 1), (0, 2), (1, 2)):
        apart = np.abs(shades[one].astype(int) - shades[other])[:, :3].max(axis=1)
        assert (apart > 60).all()
    assert DepthTint.find_steps(np.array([-1.0, 0.01, 50.0])).tolist() == [0, 1, STEPS]


def test_waterlines_of_many_hulls_are_those_of_each():
    water = Water(waves=RegularWave(0.1, period=2.0))
    ball, box = shapes.sphere(0.3), shapes.box([0.4, 0.2, 0.1])
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    hulls = [
        Placed(ball, np.array([1.0, 0.0, 0.1]), np.eye(3)),
        Placed(box, np.array([0.0, 2.0, 0.0]), turn.ravel()),
    ]
    alone = [cut_wetted_surface(*hull, water, 0.3)[1] for hull in hulls]
    assert cut_waterlines(hulls, water, 0.3) == pytest.approx(np.concatenate(alone))
    assert cut_waterlines([], water, 0.3).shape == (0, 2, 3)


def test_sites_are_drawn_in_the_frames_of_their_bodies_with_their_names():
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><worldbody><body pos="1 0 0"><site name="buoy" pos="0 0 2" size=".1"/></body>
        <body name="boat" pos="5 0 0"><freejoint/><geom size=".1"/>
        <site name="bow" pos=".5 0 0" rgba="1 0 0 1"/><site name="off" group="4"/></body>
        </worldbody></mujoco>"""
    )
    log = Kept()
    draw_sites(log, model)
    found = {
        entity: (
            points.labels.as_arrow_array().to_pylist(),
            points.positions.as_arrow_array().to_pylist(),
        )
        for entity, (points,) in log.static.items()
    }
    assert found == {
        "world/environment/sites": (["buoy"], [[1.0, 0.0, 2.0]]),
        "world/bodies/boat/sites": (["bow"], [[0.5, 0.0, 0.0]]),
    }


def test_the_legend_names_every_load_and_says_how_long_arrows_are():
    simulation = simulate("auv_sea_state_2")
    legend = Legend(simulation, 0.5)
    vehicle = simulation.vehicle
    assert {"weight", *(cause.replace("_", " ") for cause in simulation.buoyancy.causes)} <= set(
        legend._names
    )
    assert f"{0.5 * vehicle.length:.3g} m of arrow: {vehicle.weight:.3g} N" in legend._names
    ends = [x + 0.5 * len(name) for (x, _), name in zip(legend._places, legend._names, strict=True)]
    assert max(ends) <= WIDTH
