"""`draw_water`: water in renderers that are somebody else's."""

import os
import subprocess
import sys
import types

import mujoco
import numpy as np
import pytest

from buoyancy_mj import Buoyancy, DrawingError, ModelError, RegularWave, Water, draw_water
from buoyancy_mj.drawing.classic.graphics import open_gl
from buoyancy_mj.drawing.classic.sea import Eye, add_sea
from buoyancy_mj.drawing.classic.triangles import SEGMENT
from buoyancy_mj.drawing.filament.graphics import open_context
from buoyancy_mj.drawing.shots import look_at

MODEL = mujoco.MjModel.from_xml_string("""
<mujoco>
  <visual><global offwidth="160" offheight="90"/></visual>
  <worldbody>
    <light pos="0 0 5"/>
    <geom name="buoy" type="sphere" pos="0 3 0" size="0.3" rgba="1 1 0 1"/>
    <body name="float"><freejoint/>
      <geom type="box" size="0.4 0.3 0.2" density="500" rgba="1 0 0 1"/>
    </body>
  </worldbody>
</mujoco>""")
WAVES = Water(level=0.1, waves=RegularWave(0.1, period=2.0, direction=0.7))
EYE = np.array([3.0, -3.0, 1.5])


@pytest.fixture
def data():
    data = mujoco.MjData(MODEL)
    data.time = 0.3
    mujoco.mj_forward(MODEL, data)
    return data


def free_camera():
    camera = mujoco.MjvCamera()
    camera.lookat[:], camera.distance, camera.azimuth, camera.elevation = 0.0, 4.5, 135.0, -19.0
    return camera


def classic_scene(data, maxgeom=20_000):
    """A scene as `update_scene` of a renderer leaves it, which needs no graphics."""
    scene = mujoco.MjvScene(MODEL, maxgeom=maxgeom)
    every = mujoco.mjtCatBit.mjCAT_ALL.value
    mujoco.mjv_updateScene(MODEL, data, mujoco.MjvOption(), None, free_camera(), every, scene)
    return scene


def describe_geoms(geoms):
    return [(int(g.type), int(g.objid), g.pos.tolist(), g.rgba.tolist()) for g in geoms]


def test_the_scene_keeps_what_stood_in_it(data):
    scene = classic_scene(data)
    count, before = scene.ngeom, describe_geoms(scene.geoms[: scene.ngeom])
    draw_water(scene, data, buoyancy=Buoyancy(MODEL, WAVES))
    assert scene.ngeom > count + 500
    assert describe_geoms(scene.geoms[:count]) == before
    # and again what was drawn last
    draw_water(scene, data, buoyancy=Buoyancy(MODEL, Water()))
    assert describe_geoms(scene.geoms[:count]) == before


def test_each_triangle_lies_on_the_water(data):
    scene = classic_scene(data)
    count = scene.ngeom
    draw_water(scene, data, buoyancy=Buoyancy(MODEL, WAVES))
    near = 0
    for geom in scene.geoms[count : scene.ngeom]:
        assert int(geom.objid) == SEGMENT
        corners = geom.pos + np.vstack([np.zeros(3), geom.mat.T[:2]])
        if np.abs(corners[:, :2]).max() < 0.4:
            near += 1
            height = WAVES.elevation(corners[:, 0], corners[:, 1], 0.3)
            assert corners[:, 2] == pytest.approx(height, abs=1e-5)
    assert near > 50


def test_what_the_camera_does_not_see_is_left_out(data):
    scene = classic_scene(data)
    count = scene.ngeom
    draw_water(scene, data, buoyancy=Buoyancy(MODEL, Water()))
    forward = np.array(scene.camera[0].forward)
    middles = np.array([geom.pos for geom in scene.geoms[count : scene.ngeom]])
    far = middles[np.linalg.norm(middles, axis=1) > 50.0]
    assert len(far) > 100
    assert ((far - scene.camera[0].pos) @ forward).min() > 0.0


def test_the_surface_fits_the_room_of_the_scene(data):
    scene = classic_scene(data, maxgeom=3000)
    draw_water(scene, data, buoyancy=Buoyancy(MODEL, WAVES))
    assert scene.ngeom <= 3000
    scene = classic_scene(data, maxgeom=100)
    with pytest.raises(DrawingError) as caught:
        draw_water(scene, data, buoyancy=Buoyancy(MODEL, WAVES))
    assert str(caught.value) == (
        f"the scene has room for {100 - scene.ngeom} more geoms, and the sea takes 1044 at least; "
        "make the renderer with a larger max_geom"
    )


def test_a_scene_without_a_camera_asks_for_the_eye(data):
    scene = mujoco.MjvScene(MODEL, maxgeom=10_000)
    with pytest.raises(DrawingError) as caught:
        draw_water(scene, data, buoyancy=Buoyancy(MODEL, WAVES))
    assert str(caught.value) == (
        "the scene has no camera yet; call renderer.update_scene(data, camera) first, or give "
        "eye=, the place of the camera"
    )
    draw_water(scene, data, eye=EYE, buoyancy=Buoyancy(MODEL, WAVES))
    assert scene.ngeom > 500


def test_what_is_no_renderer_is_refused(data):
    with pytest.raises(DrawingError) as caught:
        draw_water("renderer", data, buoyancy=Buoyancy(MODEL, WAVES))
    assert str(caught.value) == (
        "'renderer' is no renderer; possible are mujoco.Renderer, mujoco.MjvScene and "
        "mujoco.rendering.filament.renderer.Renderer"
    )


def test_a_model_without_water_is_told_so(data):
    with pytest.raises(ModelError, match="no water"):
        draw_water(classic_scene(data), data)


def test_the_water_that_is_a_callback_is_found(data):
    scene = classic_scene(data)
    with Buoyancy(MODEL, WAVES).installed():
        draw_water(scene, data)
    assert scene.ngeom > 500


def test_from_below_the_surface_is_there_too(data):
    scene = classic_scene(data)
    count = scene.ngeom
    eye = Eye(np.array([0.0, 0.0, -3.0]))
    add_sea(scene, Water(), np.zeros(3), 0.0, radius=1.0, eye=eye)
    above = [geom for geom in scene.geoms[count : scene.ngeom] if np.hypot(*geom.pos[:2]) < 1.0]
    far = [geom for geom in scene.geoms[count : scene.ngeom] if np.hypot(*geom.pos[:2]) > 50.0]
    # it is bright overhead, and mirrors the depths far off
    assert np.mean([geom.rgba[:3] for geom in above]) > 2.0 * np.mean(
        [geom.rgba[:3] for geom in far]
    )


def test_a_renderer_of_the_classic_kind_shows_model_and_water():
    code = """
import mujoco, numpy as np
from tests.test_draw_water import MODEL, WAVES, free_camera
from buoyancy_mj import Buoyancy, draw_water
data = mujoco.MjData(MODEL)
mujoco.mj_forward(MODEL, data)
with mujoco.Renderer(MODEL, 90, 160) as renderer:
    renderer.update_scene(data, free_camera())
    draw_water(renderer, data, buoyancy=Buoyancy(MODEL, WAVES))
    pixels = renderer.render()
    renderer.enable_segmentation_rendering()
    ids, kinds = np.moveaxis(renderer.render(), 2, 0)
    geom = int(mujoco.mjtObj.mjOBJ_GEOM)
    print(((ids == 0x5EA) & (kinds == 0)).sum(), ((ids == 0) & (kinds == geom)).sum(),
          ((ids == 1) & (kinds == geom)).sum(), pixels[70:].mean(axis=(0, 1)))
"""
    try:
        open_gl()
    except DrawingError as error:
        pytest.skip(str(error))
    done = subprocess.run(
        [sys.executable, "-c", code], env=os.environ | {"MUJOCO_GL": "egl"},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    sea, buoy, box, *colour = done.stdout.replace("[", "").replace("]", "").split()
    assert int(sea) > 4000
    assert int(buoy) > 10
    assert int(box) > 50
    assert float(colour[2]) > float(colour[0]) + 20.0


def test_filament_shows_model_and_water_and_keeps_both(data):
    from mujoco import mjrf

    try:
        context = open_context()
    except DrawingError as error:
        pytest.skip(str(error))
    scene = context.create_scene(mjrf.SceneParams())
    resources = mjrf.ModelResources(context, MODEL)
    renderables = mjrf.ModelRenderables(scene, resources)
    renderables.update(data)
    # as MuJoCo's own, which Python 3.11 cannot import
    renderer = types.SimpleNamespace(context=context, scene=lambda name: {"scn": scene}[name])

    target = context.create_render_target(
        mjrf.RenderTargetConfig(color_format=mjrf.PixelFormat.PIXEL_FORMAT_RGB8)
    )
    target.resize(160, 90)
    pixels = np.empty((90, 160, 3), np.uint8)
    reading = mjrf.ReadRequest(target=target)
    reading.set_buffer(pixels)

    def segments():
        request = mjrf.RenderRequest(
            scene=scene,
            target=target,
            camera=mjrf.Camera(**look_at(EYE, np.zeros(3), 0.7).frustum(160 / 90, 0.1, 9000.0)),
            viewport=mjrf.Rect(0, 0, 160, 90),
            draw_mode=mjrf.DrawMode.DRAW_MODE_SEGMENTATION_BY_ID,
            post_processing=False,
        )
        context.wait_for_frame(context.render([request], [reading]))
        codes, counts = np.unique(pixels.astype(int) @ [1, 256, 65536], return_counts=True)
        return dict(zip(codes.tolist(), counts.tolist(), strict=True))

    with pytest.raises(DrawingError) as caught:
        draw_water(renderer, data, buoyancy=Buoyancy(MODEL, WAVES))
    assert str(caught.value) == (
        "Filament does not say where its camera is; give eye=, its place [m]"
    )
    before = segments()
    assert before.keys() == {0, 1, 2}
    for _ in range(2):
        draw_water(renderer, data, eye=EYE, buoyancy=Buoyancy(MODEL, WAVES))
        after = segments()
        assert after.keys() == {0, 1, 2, 0xFFFFFF}
        assert after[0xFFFFFF] > 4000
