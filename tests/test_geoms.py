import re
import warnings

import mujoco
import numpy as np
import pytest
import shapely
import shapely.affinity

from buoyancy_mj import (
    Buoyancy,
    BuoyancyWarning,
    MeshError,
    ModelError,
    RegularWave,
    Selection,
    Water,
    add_water,
)
from buoyancy_mj.hulls.convex_choice import write_patterns
from buoyancy_mj.hulls.geoms import find_hulls
from buoyancy_mj.meshes import shapes
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
      <geom name="hull_visual" type="box" size=".1 .1 .4" contype="0" conaffinity="0" mass="0"
        group="2"/>
      <body name="mast" pos="0 0 .6">
        <geom name="mast_visual" type="cylinder" size=".02 .2" contype="0" conaffinity="0"
          mass=".1"/>
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
    assert names(find_hulls(vehicle())) == ["hull_collision", "mast_visual", "arm/ellipsoid 0"]


def test_what_cannot_move_displaces_nothing():
    assert names(find_hulls(vehicle(), Selection(geoms="*"))) == [
        "hull_collision + hull_visual",
        "mast_visual",
        "arm/ellipsoid 0",
    ]


@pytest.mark.parametrize(
    ("patterns", "chosen"),
    [
        ("hull_visual", ["hull_visual"]),
        ("*_visual", ["hull_visual", "mast_visual"]),
        (["mast*", "hull_c*"], ["hull_collision", "mast_visual"]),
        ("hull_visual, arm/*", ["hull_visual", "arm/ellipsoid 0"]),
        ("group:2", ["hull_visual", "arm/ellipsoid 0"]),
        (["group:3", "mast_visual"], ["hull_collision", "mast_visual"]),
    ],
)
def test_patterns_and_groups_choose(patterns, chosen):
    assert names(find_hulls(vehicle(), Selection(geoms=patterns))) == chosen


def test_the_vehicle_itself_may_choose_and_the_user_overrules_it():
    model = vehicle('<text name="buoyancy_geoms" data="hull_visual mast* !arm/*"/>')
    assert names(find_hulls(model)) == ["hull_visual", "mast_visual"]
    assert names(find_hulls(model, Selection(geoms="hull_collision"))) == ["hull_collision"]


def test_a_pattern_that_matches_nothing_lists_what_there_is():
    with pytest.raises(
        ModelError,
        match=r"no moving geom matches 'hull_vizual'; did you mean 'hull_visual'\? possible: arm/",
    ):
        find_hulls(vehicle(), Selection(geoms="hull_vizual"))
    with pytest.raises(ModelError, match="no moving geom matches 'floor'"):
        find_hulls(vehicle(), Selection(geoms="floor"))
    with pytest.raises(ModelError, match="an empty choice of geoms displaces nothing"):
        find_hulls(vehicle(), Selection(geoms=[]))


def test_a_model_without_a_displacing_geom_is_refused():
    still = mujoco.MjModel.from_xml_string(
        "<mujoco><worldbody><geom size='1'/></worldbody></mujoco>"
    )
    with pytest.raises(ModelError, match="no geom of this model displaces water"):
        Buoyancy(still)


def test_a_body_without_a_joint_is_part_of_its_parent():
    model = vehicle()
    hulls = {hull.name: hull for hull in find_hulls(model)}
    assert hulls["mast_visual"].body == model.body("hull").id
    assert hulls["mast_visual"].position == pytest.approx([0.0, 0.0, 0.6])
    assert hulls["arm/ellipsoid 0"].body == model.body("arm").id


PAIR = """
<mujoco><worldbody><body name="twin"><freejoint/>
  <geom name="left" type="box" size=".2 .1 .1"/>
  <geom name="right" type="box" size=".2 .1 .1" pos="{x} 0 0" euler="0 0 {turn}"/>
</body></worldbody></mujoco>
"""


def test_geoms_of_one_body_that_overlap_displace_as_one():
    (hull,) = find_hulls(mujoco.MjModel.from_xml_string(PAIR.format(x=0.3, turn=0)))
    assert hull.name == "left + right"
    assert hull.geoms == (0, 1)
    assert hull.mesh.volume == pytest.approx(0.032 - 0.004, rel=1e-12)
    assert hull.mesh_in_body.centroid == pytest.approx([0.15, 0.0, 0.0], abs=1e-12)
    # two boxes less the two ends that are inside
    assert hull.mesh.area == pytest.approx(
        2 * (2 * 0.04 + 4 * 0.08 * 1.0) - 2 * 0.04 - 4 * 0.1 * 0.2, rel=1e-12
    )


@pytest.mark.parametrize(("x", "turn"), [(0.3, 30), (0.0, 90), (0.25, 45), (0.39, 10)])
def test_the_union_is_by_inclusion_and_exclusion(x, turn):
    model = mujoco.MjModel.from_xml_string(PAIR.format(x=x, turn=turn))
    (hull,) = find_hulls(model)
    outlines = [
        shapely.affinity.translate(
            shapely.affinity.rotate(shapely.box(-0.2, -0.1, 0.2, 0.1), angle), shift
        )
        for angle, shift in ((0, 0), (turn, x))
    ]
    common = 0.2 * outlines[0].intersection(outlines[1]).area
    assert hull.mesh.volume == pytest.approx(0.032 - common, rel=1e-9)


def test_a_ball_in_a_box_that_pokes_out_counts_by_its_cap():
    # a polyhedral ball of the true volume: the cap of height 0.05 is off by its coarseness alone
    model = mujoco.MjModel.from_xml_string("""<mujoco><worldbody><body><freejoint/>
      <geom type="box" size=".3 .3 .1"/><geom type="sphere" size=".1" pos="0 0 .05"/>
      </body></worldbody></mujoco>""")
    (hull,) = find_hulls(model)
    cap = np.pi * 0.05**2 * (3 * 0.1 - 0.05) / 3
    assert hull.mesh.volume == pytest.approx(0.072 + cap, rel=2e-5)


def test_flooded_geoms_displace_in_part_and_what_is_solid_in_them_wholly():
    model = mujoco.MjModel.from_xml_string("""<mujoco>
      <custom><text name="buoyancy_fill" data="duct=0.25"/></custom>
      <worldbody><body><freejoint/>
      <geom name="duct" type="box" size=".5 .1 .1"/><geom name="pod" type="box" size=".1 .1 .1"/>
      <geom name="mast" type="box" size=".1 .1 .1" pos="0 0 1"/></body></worldbody></mujoco>""")
    water = Water(level=100.0)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    loads = Buoyancy(model, water).evaluate(data)
    assert dict(zip(loads.names, loads.hull.volume.tolist(), strict=True)) == pytest.approx(
        {"duct": 0.25 * 0.032, "pod": 0.008, "mast": 0.008}
    )
    assert Buoyancy(model, water, selection=Selection(fill="duct=1")).evaluate(
        data
    ).total.volume == pytest.approx(0.04 + 0.008)
    # cut by a wave, each force is the same part
    wave = Water(waves=RegularWave(amplitude=0.05, wavelength=1.0), level=0.02)
    hollow, solid = (
        Buoyancy(model, wave, selection=Selection(geoms="duct", fill=f"duct={part}"))
        .evaluate(data)
        .hull
        for part in (0.25, 1)
    )
    assert hollow.volume == pytest.approx(0.25 * solid.volume, rel=1e-12)
    assert hollow.centroid == pytest.approx(solid.centroid, abs=1e-12)


@pytest.mark.parametrize("method", ["exact", "convex_hull", "sections"])
def test_each_method_knows_parts(method):
    model = mujoco.MjModel.from_xml_string(PAIR.format(x=0.5, turn=0))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    whole, part = (
        Buoyancy(model, Water(level=1.0), selection=Selection(fill=f"{fill}"), method=method)
        .evaluate(data)
        .hull
        for fill in (1, 0.3)
    )
    assert part.volume == pytest.approx(0.3 * whole.volume)
    assert part.centroid == pytest.approx(whole.centroid)


def test_a_geom_may_displace_as_its_convex_hull():
    box = shapes.box((1.0, 0.5, 0.3))
    tub = mesh_model(box.vertices, box.faces[box.area_vectors[:, 2] <= 0.0])
    (hull,) = find_hulls(tub, selection=Selection(hull="tub=convex"))
    assert hull.mesh.volume == pytest.approx(1.2, rel=1e-6)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (
            {"hull": "left=concave"},
            r"hull 'left=concave' asks for 'concave'; did you mean 'convex'\? possible",
        ),
        ({"hull": "lift=convex"}, "no moving geom matches 'lift'; did you mean 'left'"),
        (
            {"fill": "left=1.5"},
            "fill 'left=1.5' is no part of a volume: it must be above 0 and at most 1",
        ),
        ({"fill": "left"}, "fill 'left' is no part of a volume"),
        ({"fill": []}, "an empty choice of fill displaces nothing"),
    ],
)
def test_choices_that_make_no_sense_are_refused(options, message):
    with pytest.raises(ModelError, match=message):
        find_hulls(mujoco.MjModel.from_xml_string(PAIR.format(x=0.5, turn=0)), Selection(**options))


@pytest.mark.parametrize("turn", [0, 180])
def test_geoms_that_touch_do_not_overlap(turn):
    model = mujoco.MjModel.from_xml_string(PAIR.format(x=0.4, turn=turn))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(find_hulls(model)) == 2


def mesh_model(vertices, faces):
    text = " ".join(str(float(x)) for x in np.ravel(vertices))
    index = " ".join(str(int(i)) for i in np.ravel(faces))
    return mujoco.MjModel.from_xml_string(
        f"""<mujoco><asset><mesh name="tub" vertex="{text}" face="{index}" inertia="shell"/></asset>
        <worldbody><body name="boat"><freejoint/><geom name="tub" type="mesh" mesh="tub"/></body>
        </worldbody></mujoco>"""
    )


def test_an_open_mesh_is_refused_by_the_name_of_its_geom():
    box = shapes.box((1.0, 0.5, 0.3))
    tub = mesh_model(box.vertices, box.faces[box.area_vectors[:, 2] <= 0.0])
    with pytest.raises(
        MeshError, match=r"mesh 'tub' of geom 'tub': it is open: 1 hole with 4 edges"
    ):
        Buoyancy(tub)


TUBS = """<mujoco><custom>{custom}</custom><asset>
<mesh name="tub" vertex="{vertices}" face="{faces}" inertia="shell"/>
<mesh name="bin" vertex="{vertices}" face="{faces}" inertia="shell"/></asset>
<worldbody><body name="rov"><freejoint/>
  <geom name="shroud 1" type="mesh" mesh="tub"/>
  <geom name="shroud 2" type="mesh" mesh="tub" pos="3 0 0"/>
  <geom name="shroud_drawn" type="mesh" mesh="tub" contype="0" conaffinity="0"/>
  <geom name="foam" type="box" size=".1 .1 .1" pos="0 3 0"/>
  <geom name="bin" type="mesh" mesh="bin" pos="6 0 0"/></body></worldbody></mujoco>"""


def tubs(custom=""):
    box = shapes.box((1.0, 0.5, 0.3))
    faces = box.faces[box.area_vectors[:, 2] <= 0.0]
    arrays = {"vertices": box.vertices, "faces": faces}
    texts = {name: " ".join(map(str, values.ravel())) for name, values in arrays.items()}
    return mujoco.MjModel.from_xml_string(TUBS.format(custom=custom, **texts))


def mended_by_its_message(model, selection):
    """The `hull=` that the refusal of a model advises, in Python."""
    with pytest.raises(MeshError, match="it is open") as refusal:
        find_hulls(model, selection)
    return re.search(r"Selection\(hull='(.*?)'\)", str(refusal.value))[1]


def test_the_mend_of_an_open_mesh_names_its_geoms_and_no_others():
    model = tubs()
    with pytest.raises(MeshError) as refusal:
        find_hulls(model)
    assert str(refusal.value) == (
        "mesh 'tub' of geom 'shroud 1' and 1 more: it is open: 1 hole with 4 edges "
        "puts 1.06 m^3 (88.65% of its volume) in doubt; close the mesh, take its convex hull "
        "(--hull 'shroud?*=convex', in Python Selection(hull='shroud?*=convex'), "
        'in MJCF <text name="buoyancy_hull" data="shroud?*=convex"/>), '
        "or leave the geom out (--geoms)"
    )


def test_mends_taken_one_after_the_other_end_with_a_model_that_floats():
    model = tubs()
    first = mended_by_its_message(model, Selection())
    second = mended_by_its_message(model, Selection(hull=first))
    assert second == "shroud?*=convex bin=convex"
    hulls = find_hulls(model, Selection(hull=second))
    assert [hull.mesh.volume for hull in hulls] == pytest.approx([1.2, 1.2, 0.008, 1.2], rel=1e-6)


def test_the_mend_keeps_what_the_model_says_of_other_hulls():
    model = tubs('<text name="buoyancy_hull" data="bin=convex"/>')
    assert mended_by_its_message(model, Selection()) == "shroud?*=convex bin=convex"


@pytest.mark.parametrize(
    ("names", "wanted", "patterns"),
    [
        (["fairing", "foam"], ["fairing"], ["fairing"]),
        (["duct_1", "duct_2", "foam"], ["duct_1", "duct_2"], ["duct_*"]),
        (["duct_1", "duct_2", "duct_3"], ["duct_1", "duct_2"], ["duct_1", "duct_2"]),
        (["a,b", "c[d]*"], ["a,b", "c[d]*"], ["a?b", "c?d]?"]),
        (["left=x", "y"], ["left=x"], ["left=x"]),
    ],
)
def test_patterns_match_the_wanted_geoms_and_no_others(names, wanted, patterns):
    spec = mujoco.MjSpec()
    for name in names:
        spec.worldbody.add_geom(name=name, size=[1, 1, 1])
    model = spec.compile()
    indices = [model.geom(name).id for name in wanted]
    assert write_patterns(model, indices, range(model.ngeom)) == patterns


def test_a_mesh_displaces_as_it_is_drawn_and_not_as_its_convex_hull():
    glass = two_cones(0.2, 0.3, sections=24)
    model = mesh_model(glass.vertices, glass.faces)
    assert find_hulls(model)[0].mesh.volume == pytest.approx(glass.volume, rel=1e-6)


# what has no volume -------------------------------------------------------------------------------

SOFT = """<mujoco><worldbody>
<body name="boat"><freejoint/><geom type="box" size=".2 .1 .1" mass="8"/>
<geom name="ring" type="sdf" mesh="torus" pos="0 0 1" mass="1"><plugin instance="t"/></geom></body>
<body name="anchor" pos="0 0 2"><flexcomp name="net" type="grid" count="3 3 1" spacing=".1 .1 .1"
  mass=".1" dim="2" radius=".01"><edge equality="true"/></flexcomp></body></worldbody>
<extension><plugin plugin="mujoco.sdf.torus"><instance name="t"/></plugin></extension>
<asset><mesh name="torus"><plugin instance="t"/></mesh></asset></mujoco>"""


def test_flexes_and_distance_fields_that_displace_nothing_are_named_once():
    model = mujoco.MjModel.from_xml_string(SOFT)
    with pytest.warns(BuoyancyWarning) as told:
        Buoyancy(model)
    assert [str(entry.message) for entry in told] == [
        "flex 'net', sdf 'ring' displace no water: only geoms of the types mesh, box, sphere, "
        "ellipsoid, capsule and cylinder do"
    ]


def test_a_skin_that_displaces_nothing_is_named_once_for_all_data_of_a_model_with_water():
    spec = mujoco.MjSpec.from_string(
        """<mujoco><worldbody><body name="diver"><freejoint/><geom size=".2" mass="8"/></body>
        </worldbody><deformable><skin name="suit" vertex="0 0 0 1 0 0 0 1 0" face="0 1 2">
        <bone body="diver" bindpos="0 0 0" bindquat="1 0 0 0" vertid="0 1 2"
        vertweight="1 1 1"/></skin></deformable></mujoco>"""
    )
    add_water(spec)
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        model = spec.compile()
        for _ in range(3):
            mujoco.MjData(model)
    assert [str(entry.message) for entry in told] == [
        "skin 'suit' displaces no water: only geoms of the types mesh, box, sphere, ellipsoid, "
        "capsule and cylinder do"
    ]
