"""Cameras of films: vehicles are in the picture, whole, at every depth."""

import itertools

import mujoco
import numpy as np
import pytest

from buoyancy_mj import Buoyancy, DrawingError, JonswapSea, Water
from buoyancy_mj.drawing.cameras import find_camera
from buoyancy_mj.drawing.subject import Subject
from buoyancy_mj.scenes.fleet import find_vehicles

ASPECT = 16.0 / 9.0
FREE = """
<body name="{name}" pos="{x} {y} 0"><freejoint/>
  <geom type="box" size="0.5 0.2 0.15" density="900"/>
  <geom type="capsule" fromto="0.4 0 0 0.7 0 0.1" size="0.05" density="900"/>
</body>"""
SEA = Water(waves=JonswapSea(0.3, peak_period=3.0))


def build(*places, more=""):
    bodies = "".join(FREE.format(name=f"v{i}", x=x, y=y) for i, (x, y) in enumerate(places))
    model = mujoco.MjModel.from_xml_string(
        f"<mujoco><worldbody>{bodies}{more}</worldbody></mujoco>"
    )
    return model, mujoco.MjData(model)


def film(model, data, name, depths, water=SEA):
    """The shots of a camera while all vehicles go from depth to depth, and their corners."""
    mujoco.mj_forward(model, data)
    vehicles = find_vehicles(model, Buoyancy(model, water))
    subject = Subject(model, vehicles.values(), data)
    camera = find_camera(name, model, subject, water, ASPECT)
    rng = np.random.default_rng(1)
    for depth in depths:
        for row in range(len(vehicles)):
            data.qpos[7 * row + 2] = -depth
            turn = rng.normal(size=4) * [1.0, 0.1, 0.1, 1.0]
            data.qpos[7 * row + 3 : 7 * row + 7] = turn / np.linalg.norm(turn)
        data.time += 0.5
        mujoco.mj_forward(model, data)
        yield depth, camera.aim(data), corners(model, data, vehicles)


def corners(model, data, vehicles):
    """The corners of the boxes around all geoms of vehicles (n, 3)."""
    signs = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
    bodies = np.concatenate([vehicle.bodies for vehicle in vehicles.values()])
    return np.concatenate(
        [
            data.geom_xpos[geom]
            + (model.geom_aabb[geom, :3] + signs * model.geom_aabb[geom, 3:])
            @ data.geom_xmat[geom].reshape(3, 3).T
            for geom in np.flatnonzero(np.isin(model.geom_bodyid, bodies))
        ]
    )


@pytest.mark.parametrize("name", ["follow", "orbit", "under"])
@pytest.mark.parametrize("depth", [0.3, 8.0, 50.0])
def test_the_vehicle_is_in_the_frame_at_every_depth(name, depth):
    for _, shot, points in film(*build((0.0, 0.0)), name, [depth] * 4):
        places = shot.project(points, ASPECT)
        assert np.abs(places).max() < 1.0
        # and not lost in it
        assert np.ptp(places, axis=0).max() > 0.15


def test_the_vehicle_stays_in_the_frame_while_it_dives_and_comes_up():
    depths = np.concatenate([np.linspace(0.0, 12.0, 40), np.linspace(12.0, 0.0, 40)])
    sides = []
    for depth, shot, points in film(*build((0.0, 0.0)), "follow", depths):
        assert np.abs(shot.project(points, ASPECT)).max() < 1.0
        sides.append(bool(shot.eye[2] < 0.0))
        if depth in (0.0, 12.0):
            assert sides[-1] == (depth > 0.0)
    # it goes through the surface once each way
    assert np.count_nonzero(np.diff(sides)) == 2


def test_several_vehicles_are_all_in_the_frame():
    for depth in (0.2, 20.0):
        for name in ("follow", "under"):
            model, data = build((0.0, 0.0), (6.0, 1.0), (-2.0, -5.0))
            for _, shot, points in film(model, data, name, [depth] * 3):
                assert np.abs(shot.project(points, ASPECT)).max() < 1.0


def test_the_horizon_is_level_and_a_lone_vehicle_in_a_third():
    for name in ("follow", "orbit", "under"):
        for _, shot, points in film(*build((0.0, 0.0)), name, [0.1, 0.1, 9.0, 9.0]):
            assert shot.right[2] == pytest.approx(0.0, abs=1e-12)
            assert shot.up[2] > 0.5
            assert np.dot(shot.up, shot.forward) == pytest.approx(0.0, abs=1e-12)
            middle = shot.project(points, ASPECT).mean(axis=0)
            assert middle[0] == pytest.approx(-1.0 / 3.0, abs=0.12)


def test_no_wave_of_the_sea_covers_the_camera():
    for name, side in (("follow", 1.0), ("under", -1.0)):
        for _, shot, _ in film(*build((0.0, 0.0)), name, [0.1] * 20):
            x, y, z = shot.eye
            times = np.linspace(0.0, 60.0, 200)
            assert (side * (z - SEA.elevation(x, y, times))).min() > 0.0


def test_a_wall_does_not_hide_the_vehicle():
    walls = "".join(
        f'<geom type="plane" size="9 9 1" pos="{x} {y} -4" xyaxes="{axes}"/>'
        for x, y, axes in (
            (1.5, 0, "0 1 0 0 0 -1"),
            (-1.5, 0, "0 1 0 0 0 1"),
            (0, 1.5, "1 0 0 0 0 1"),
            (0, -1.5, "1 0 0 0 0 -1"),
        )
    )
    for _, shot, points in film(*build((0.0, 0.0), more=walls), "orbit", [2.0] * 30):
        assert np.abs(shot.eye[:2]).max() < 1.5
        assert np.isfinite(shot.project(points, ASPECT)).all()


def test_a_camera_of_the_model_is_used_as_it_is():
    camera = '<camera name="mast" pos="1 2 3" xyaxes="0 1 0 -1 0 1" fovy="50"/>'
    ((_, shot, _),) = film(*build((0.0, 0.0), more=camera), "mast", [0.0])
    assert shot.eye == pytest.approx([1.0, 2.0, 3.0])
    assert shot.fovy == pytest.approx(np.radians(50.0))
    assert shot.forward == pytest.approx(np.array([-1.0, 0.0, -1.0]) / np.sqrt(2.0))


def test_an_orthographic_camera_is_refused_for_films_are_in_perspective():
    camera = '<camera name="mast" projection="orthographic" fovy="2"/>'
    with pytest.raises(DrawingError, match="'mast' is orthographic, and films are in perspective"):
        next(film(*build((0.0, 0.0), more=camera), "mast", [0.0]))


def test_an_unknown_camera_is_refused_with_the_names_of_all():
    camera = '<camera name="mast"/>'
    with pytest.raises(DrawingError) as caught:
        next(film(*build((0.0, 0.0), more=camera), "folow", [0.0]))
    assert str(caught.value) == (
        "there is no camera 'folow'; did you mean 'follow'? possible: follow, mast, orbit, under"
    )
