import mujoco
import numpy as np
import pytest

from buoyancy_mj.viz.visible_foils import find_visible_foils
from buoyancy_mj.viz.visible_geoms import find_visible_geoms

MODEL = """
<mujoco>
  <asset><material name="red" rgba="1 0 0 .5"/></asset>
  <worldbody>
    <geom name="floor" type="plane" size="0 3 1" pos="0 0 -2"/>
    <body name="pier" pos="1 2 0" euler="0 0 90">
      <geom name="pier" type="box" size="1 .1 .1" pos=".5 0 0" material="red"/></body>
    <body name="boat" pos="0 0 3"><freejoint/>
      <geom name="hull" type="box" size="1 .2 .1" rgba="0 1 0 1"/>
      <geom name="hidden" type="box" size="1 .2 .1" group="3"/>
      <geom name="ghost" type="box" size="1 .2 .1" rgba="0 1 0 0"/>
      <body name="mast" pos="0 0 .5"><geom name="mast" type="capsule" size=".02 .3"/></body>
    </body>
  </worldbody>
</mujoco>
"""


def drawn(text=MODEL):
    model = mujoco.MjModel.from_xml_string(text)
    return model, {model.geom(shape.geom).name: shape for shape in find_visible_geoms(model)}


def test_what_the_viewer_shows_is_drawn_and_nothing_else():
    assert set(drawn()[1]) == {"floor", "pier", "hull", "mast"}


def test_a_model_of_hidden_geoms_is_drawn_all_the_same():
    text = """<mujoco><worldbody><body><freejoint/>
    <geom name="only" size=".1" group="3"/></body></worldbody></mujoco>"""
    assert set(drawn(text)[1]) == {"only"}


def test_colours_are_the_models_own():
    shapes = drawn()[1]
    assert shapes["hull"].colour.tolist() == [0, 255, 0, 255]
    assert shapes["pier"].colour.tolist() == [255, 0, 0, 127]


def test_a_geoms_own_colour_wins_over_its_material_as_in_the_viewer():
    text = MODEL.replace('rgba="0 1 0 1"', 'rgba="0 1 0 1" material="red"')
    assert drawn(text)[1]["hull"].colour.tolist() == [0, 255, 0, 255]


def test_every_geom_stands_where_the_engine_has_it():
    model, shapes = drawn()
    data = mujoco.MjData(model)
    data.qpos[:7] = [1.0, -2.0, 0.5, 0.8, 0.6, 0.0, 0.0]
    mujoco.mj_kinematics(model, data)
    for shape in shapes.values():
        turn = data.xmat[shape.body].reshape(3, 3)
        assert turn @ shape.position + data.xpos[shape.body] == pytest.approx(
            data.geom_xpos[shape.geom]
        )
        assert turn @ shape.rotation == pytest.approx(data.geom_xmat[shape.geom].reshape(3, 3))
    assert not shapes["pier"].moves
    assert shapes["mast"].moves


def test_normals_point_outward():
    for name in ("hull", "mast"):
        shape = drawn()[1][name]
        assert (np.einsum("ij,ij->i", shape.normals, shape.vertices) > 0.0).all()


# foils that are sites -----------------------------------------------------------------------------

GLIDER = """
<mujoco>
  <custom>
    <text name="foil:wing" data="span=2"/><text name="foil:fin" data="walls=1"/>
    <text name="foil:hidden" data="walls=0"/><text name="foil:tail" data="walls=0"/>
  </custom>
  <worldbody>
    <body name="glider" pos="0 0 -3" euler="0 0 90"><freejoint/>
      <geom size=".2"/>
      <geom name="tail" type="box" size=".1 .1 .01" pos="-.5 0 0"/>
      <site name="wing" type="box" size=".1 .5 .01" pos=".2 0 0" rgba="1 0 0 1"/>
      <site name="hidden" type="box" size=".1 .5 .01" group="4"/>
      <site name="mark" type="box" size=".1 .5 .01"/>
      <body pos="-.4 0 0"><site name="fin" type="ellipsoid" size=".1 .2 .01" euler="90 0 0"/></body>
    </body>
  </worldbody>
</mujoco>
"""


def test_foils_that_are_sites_are_drawn_where_they_act_and_as_large():
    model = mujoco.MjModel.from_xml_string(GLIDER)
    drawn = {visible.foil.name: visible for visible in find_visible_foils(model)}
    assert set(drawn) == {"wing", "fin"}
    wing, fin = drawn["wing"], drawn["fin"]
    assert wing.colour.tolist() == [255, 0, 0, 255]
    assert np.ptp(wing.mesh.vertices, axis=0) == pytest.approx([0.2, 2.0, 0.02])
    assert np.ptp(fin.mesh.vertices, axis=0) == pytest.approx([0.2, 0.4, 0.02], rel=0.01)
    assert wing.foil.middle == pytest.approx([0.2, 0.0, 0.0])
    assert (fin.foil.body, fin.foil.middle) == (1, pytest.approx([-0.4, 0.0, 0.0]))
