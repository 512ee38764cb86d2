import warnings

import mujoco
import numpy as np
import pytest

from buoyancy_mj import Buoyancy, BuoyancyWarning, MeshError, ModelError, shapes
from buoyancy_mj.geoms import displacing_hulls
from tests.naive import two_cones

VEHICLE = """
<mujoco>
  <custom>{custom}</custom>
  <worldbody>
    <geom name="floor" type="plane" size="5 5 .1" pos="0 0 -3"/>
    <geom name="rock" type="box" size="1 1 1" pos="0 0 -3"/>
    <body name="hull">
      <freejoint/>
      <geom name="hull_collision" type="capsule" size=".1 .3" group="3"/>
      <geom name="hull_visual" type="box" size=".1 .1 .4" contype="0" conaffinity="0" mass="0" group="2"/>
      <body name="mast" pos="0 0 .6">
        <geom name="mast_visual" type="cylinder" size=".02 .2" contype="0" conaffinity="0" mass=".1"/>
      </body>
      <body name="arm" pos="0 .3 0">
        <joint name="arm" axis="1 0 0"/>
        <geom type="ellipsoid" size=".1 .05 .05" contype="0" conaffinity="0" group="2"/>
      </body>
    </body>
  </worldbody>
</mujoco>
"""


def vehicle(custom=""):
    return mujoco.MjModel.from_xml_string(VEHICLE.format(custom=custom))


def names(hulls):
    return [hull.name for hull in hulls]


def test_each_body_displaces_by_its_collision_geoms_or_else_its_visual_ones():
    assert names(displacing_hulls(vehicle())) == ["hull_collision", "mast_visual", "arm/ellipsoid 5"]


def test_what_cannot_move_displaces_nothing():
    with pytest.warns(BuoyancyWarning, match="'hull_collision' and 'hull_visual' overlap"):
        assert not {"floor", "rock"} & set(names(displacing_hulls(vehicle(), "*")))


@pytest.mark.parametrize(
    ("patterns", "chosen"),
    [
        ("hull_visual", ["hull_visual"]),
        ("*_visual", ["hull_visual", "mast_visual"]),
        (["mast*", "hull_c*"], ["hull_collision", "mast_visual"]),
        ("hull_visual, arm/*", ["hull_visual", "arm/ellipsoid 5"]),
        ("group:2", ["hull_visual", "arm/ellipsoid 5"]),
        (["group:3", "mast_visual"], ["hull_collision", "mast_visual"]),
    ],
)
def test_patterns_and_groups_choose(patterns, chosen):
    assert names(displacing_hulls(vehicle(), patterns)) == chosen


def test_the_vehicle_itself_may_choose_and_the_user_overrules_it():
    model = vehicle('<text name="buoyancy_geoms" data="hull_visual mast*"/>')
    assert names(displacing_hulls(model)) == ["hull_visual", "mast_visual"]
    assert names(displacing_hulls(model, "hull_collision")) == ["hull_collision"]


def test_a_pattern_that_matches_nothing_lists_what_there_is():
    with pytest.raises(
        ModelError, match=r"no moving geom matches 'hull_vizual'; did you mean 'hull_visual'\? possible: arm/"
    ):
        displacing_hulls(vehicle(), "hull_vizual")
    with pytest.raises(ModelError, match="no moving geom matches 'floor'"):
        displacing_hulls(vehicle(), "floor")
    with pytest.raises(ModelError, match="an empty choice of geoms displaces nothing"):
        displacing_hulls(vehicle(), [])


def test_a_model_without_a_displacing_geom_is_refused():
    still = mujoco.MjModel.from_xml_string("<mujoco><worldbody><geom size='1'/></worldbody></mujoco>")
    with pytest.raises(ModelError, match="no geom of this model displaces water"):
        Buoyancy(still)


def test_a_body_without_a_joint_is_part_of_its_parent():
    model = vehicle()
    hulls = {hull.name: hull for hull in displacing_hulls(model)}
    assert hulls["mast_visual"].body == model.body("hull").id
    assert hulls["mast_visual"].position == pytest.approx([0.0, 0.0, 0.6])
    assert hulls["arm/ellipsoid 5"].body == model.body("arm").id


PAIR = """
<mujoco><worldbody><body name="twin"><freejoint/>
  <geom name="left" type="box" size=".2 .1 .1"/>
  <geom name="right" type="box" size=".2 .1 .1" pos="{x} 0 0" euler="0 0 {turn}"/>
</body></worldbody></mujoco>
"""


def test_geoms_that_overlap_are_told_with_the_doubled_volume():
    model = mujoco.MjModel.from_xml_string(PAIR.format(x=0.3, turn=0))
    with pytest.warns(
        BuoyancyWarning, match=r"body 'twin': geoms 'left' and 'right' overlap; 0.004 m\^3 \(12.5% of its volume\)"
    ):
        displacing_hulls(model)


@pytest.mark.parametrize("turn", [0, 180])
def test_geoms_that_touch_do_not_overlap(turn):
    model = mujoco.MjModel.from_xml_string(PAIR.format(x=0.4, turn=turn))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(displacing_hulls(model)) == 2


def mesh_model(vertices, faces):
    text = " ".join(str(float(x)) for x in np.ravel(vertices))
    index = " ".join(str(int(i)) for i in np.ravel(faces))
    return mujoco.MjModel.from_xml_string(
        f"""<mujoco><asset><mesh name="tub" vertex="{text}" face="{index}" inertia="shell"/></asset>
        <worldbody><body name="boat"><freejoint/><geom name="tub" type="mesh" mesh="tub"/></body></worldbody></mujoco>"""
    )


def test_an_open_mesh_is_refused_by_the_name_of_its_geom():
    box = shapes.box((1.0, 0.5, 0.3))
    tub = mesh_model(box.vertices, box.faces[box.area_vectors[:, 2] <= 0.0])
    with pytest.raises(MeshError, match=r"mesh 'tub' of geom 'tub': it is open: 1 hole\(s\) with 4 edges"):
        Buoyancy(tub)


def test_a_mesh_is_taken_as_it_is_drawn_and_not_as_its_convex_hull():
    glass = two_cones(0.2, 0.3, sections=24)
    model = mesh_model(glass.vertices, glass.faces)
    assert displacing_hulls(model)[0].mesh.volume == pytest.approx(glass.volume, rel=1e-6)
