"""Ground in a vehicle's file that would keep out the water."""

import warnings
from pathlib import Path

import mujoco
import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from buoyancy_mj import BuoyancyWarning, Scene, Start
from buoyancy_mj.scenes.dry_land import remove_dry_land
from buoyancy_mj.scenes.heights import _find_hull_heights
from buoyancy_mj.scenes.scene import read_scene
from buoyancy_mj.scenes.simulation import Simulation

CASES = Path(__file__).parent / "data/cases/static_ground"
BOAT = """<mujoco>{extra}<worldbody>{ground}
<body name="boat"><freejoint/><geom name="hull" type="box" size=".2 .1 .1" mass="8"/></body>
</worldbody></mujoco>"""


def judge(ground, *, level=0.0, start=(0.0, 0.0, 0.0), extra=""):
    """The names of the geoms that stay, and what is told."""
    spec = mujoco.MjSpec.from_string(BOAT.format(ground=ground, extra=extra))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", BuoyancyWarning)
        remove_dry_land(spec, Path("boat.xml"), level, start)
    spec.compile()
    return [geom.name for geom in spec.geoms], [str(entry.message) for entry in caught]


SLAB = '<geom name="g" type="box" size="5 5 .5" pos="0 0 {z}"/>'
TERRAIN = (
    '<asset><hfield name="h" nrow="3" ncol="3" size="5 5 1 .1" elevation="{heights}"/></asset>'
)
ISLAND = '<geom name="g" type="hfield" hfield="h" pos="0 0 {z}"/>'
PRISM = """<asset><mesh name="m" vertex="-4 -4 0 4 -4 0 -4 4 0 4 4 0 -4 -4 1 4 -4 1 -4 4 1 4 4 1"/>
</asset>"""


@pytest.mark.parametrize(
    ("ground", "extra", "kind"),
    [
        ('<geom name="g" type="plane" size="1 1 1"/>', "", "plane"),
        ('<geom name="g" type="plane" size="0 0 1" pos="9 9 0" euler="10 0 0"/>', "", "plane"),
        (SLAB.format(z=-0.5), "", "box"),
        ('<geom name="g" type="box" size=".5 5 5" pos="0 0 -.5" euler="0 90 0"/>', "", "box"),
        ('<geom name="g" type="cylinder" size="9 1" pos="0 0 -1"/>', "", "cylinder"),
        ('<geom name="g" type="ellipsoid" size="50 50 9" pos="0 0 -8.9"/>', "", "ellipsoid"),
        (ISLAND.format(z=0), TERRAIN.format(heights="0 1 0 1 0 1 0 1 0"), "hfield"),
        ('<geom name="g" type="mesh" mesh="m" pos="0 0 -.5"/>', PRISM, "mesh"),
        (f'<body pos="0 0 -.5"><body>{SLAB.format(z=0)}</body></body>', "", "box"),
        (f'<body mocap="true">{SLAB.format(z=-0.5)}</body>', "", "box"),
        (
            SLAB.format(z=-0.5).replace("/>", ' contype="0" conaffinity="0"/>'),
            '<contact><pair geom1="g" geom2="hull"/></contact>',
            "box",
        ),
        (SLAB.format(z=-0.5), '<compiler fusestatic="true" discardvisual="true"/>', "box"),
    ],
)
def test_ground_at_the_level_of_the_water_is_left_out_and_told_whatever_its_shape(
    ground, extra, kind
):
    names, told = judge(ground, extra=extra)
    assert names == ["hull"]
    (message,) = told
    assert message.startswith(f"the vehicle's ground {kind} 'g' at z = ")
    assert message.endswith(" m would keep out the water at 0 m and was left out")


@pytest.mark.parametrize(
    ("ground", "extra"),
    [
        # under the water
        (SLAB.format(z=-1.5), ""),
        (ISLAND.format(z=-2), TERRAIN.format(heights="0 1 0 1 0 1 0 1 0")),
        # a quay beside the boat, and quays on both sides
        ('<geom name="g" type="box" size="5 5 1" pos="5.5 0 0"/>', ""),
        (
            '<geom type="box" size="5 5 1" pos="5.5 0 0"/>'
            '<geom type="box" size="5 5 1" pos="-5.5 0 0"/>',
            "",
        ),
        # walls, upright and steep
        ('<geom name="g" type="plane" size="5 5 1" pos="1 0 0" euler="0 -90 0"/>', ""),
        ('<geom name="g" type="plane" size="5 5 1" euler="0 -30 0"/>', ""),
        # a bridge
        (SLAB.format(z=2.0), ""),
        # a beach far off
        (ISLAND.format(z=-0.5), TERRAIN.format(heights="0 0 9 0 0 9 0 0 9")),
        # a signed distance field
        ('<geom name="g" type="sdf" mesh="m" pos="0 0 -.5"/>', PRISM),
        # what touches nothing
        (SLAB.format(z=-0.5).replace("/>", ' contype="0" conaffinity="0"/>'), ""),
        ('<geom name="g" type="plane" size="1 1 1" contype="0" conaffinity="0"/>', ""),
    ],
)
def test_what_lets_the_water_in_stays_without_a_word(ground, extra):
    names, told = judge(ground, extra=extra)
    assert told == []
    assert len(names) == 1 + ground.count("<geom")


@pytest.mark.parametrize(("level", "stays"), [(0.0, False), (0.4, False), (0.6, True)])
def test_it_is_the_level_of_the_water_that_counts(level, stays):
    names, _ = judge(SLAB.format(z=0.0), level=level)
    assert ("g" in names) == stays


@pytest.mark.parametrize(("x", "stays"), [(0.0, False), (3.0, False), (20.0, True)])
def test_it_is_the_place_where_the_vehicle_starts_that_counts(x, stays):
    names, _ = judge(SLAB.format(z=-0.5), start=(x, 0.0, 0.0))
    assert ("g" in names) == stays


def test_a_vehicle_that_starts_inside_the_ground_gets_it_out_of_its_way():
    names, (told,) = judge(SLAB.format(z=0.0), start=(0.0, 0.0, -0.3))
    assert names == ["hull"]
    assert "box 'g' at z = 0.5 m would keep out" in told


BASIN = (
    np.array([[x, y, z] for z in (-1, 0.5) for x in (-3, 3) for y in (-3, 3)])
    * np.array([[[1, 1, 1]], [[0.9, 0.9, 0.95]]])
).reshape(-1, 3)


def test_a_basin_in_one_mesh_is_full_as_it_is_for_contacts():
    text = " ".join(map(str, BASIN.ravel()))
    extra = f'<asset><mesh name="m" vertex="{text}"/></asset>'
    names, (told,) = judge('<geom name="g" type="mesh" mesh="m"/>', extra=extra)
    assert names == ["hull"]
    assert "ground mesh 'g' at z = 0.5 m would keep out" in told
    # deep under water, or high above as a bridge, it stays
    for z in (-2, 2):
        assert judge(f'<geom name="g" type="mesh" mesh="m" pos="0 0 {z}"/>', extra=extra)[1] == []


@given(st.integers(0, 10**6))
def test_heights_of_a_hull_are_those_that_a_ray_finds(seed):
    rng = np.random.default_rng(seed)
    vertices = rng.normal(size=(12, 3))
    solid = trimesh.convex.convex_hull(vertices)
    points = np.column_stack([rng.uniform(-2, 2, (20, 2)), np.full(20, 9.0)])
    heights = np.full(20, -np.inf)
    places, lines, _ = solid.ray.intersects_location(points, np.tile([0.0, 0, -1], (20, 1)))
    np.maximum.at(heights, lines, places[:, 2])
    assert _find_hull_heights(vertices, points) == pytest.approx(heights, abs=1e-9)


def test_tiles_are_one_ground():
    tile = '<geom name="{name}" type="box" size="3 3 .5" pos="{x} 0 -.5"/>'
    names, told = judge(tile.format(name="a", x=-3) + tile.format(name="b", x=3))
    assert names == ["hull"]
    assert len(told) == 2


def start_above(tmp_path, ground, **scene):
    """What is told where the boat starts at the origin, over ground of its environment."""
    boat, land = tmp_path / "boat.xml", tmp_path / "land.xml"
    boat.write_text(BOAT.format(ground="", extra=""))
    land.write_text(f"<mujoco><worldbody>{ground}</worldbody></mujoco>")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", BuoyancyWarning)
        Simulation(Scene(title="land", vehicle=boat, environment=land, **scene))
    return [str(entry.message) for entry in caught]


RESTS = "which reaches out of the water to z = {:g} m, and will rest on it"


def test_a_table_under_the_vehicle_stays_and_is_told(tmp_path):
    table = '<geom name="table" type="box" size=".3 .3 .5" pos="0 0 -.4"/>'
    assert judge(table) == (["table", "hull"], [])
    path = tmp_path / "boat.xml"
    path.write_text(BOAT.format(ground=table, extra=""))
    with pytest.warns(BuoyancyWarning) as caught:
        Simulation(Scene(title="table", vehicle=path, start=Start(position=(0.0, 0.0, 0.3))))
    assert (
        str(caught.pop(BuoyancyWarning).message)
        == f"the vehicle starts above the box 'table', {RESTS.format(0.1)}"
    )


@pytest.mark.parametrize(
    ("kind", "size"),
    [
        ("sphere", 'size="1000" pos="0 0 -1000"'),
        ("ellipsoid", 'size="9 9 .05" pos="0 0 -.05"'),
        ("capsule", 'size="5 5" pos="0 0 -5" euler="0 90 0"'),
        ("box", 'size=".02 .02 .5" pos="0 0 -.5"'),
        ("plane", 'size="9 9 1"'),
    ],
)
def test_ground_of_any_shape_that_reaches_the_water_under_the_vehicle_is_told(tmp_path, kind, size):
    assert start_above(tmp_path, f'<geom name="g" type="{kind}" {size}/>') == [
        f"the vehicle starts above the {kind} 'environment/g', {RESTS.format(0.0)}"
    ]


@pytest.mark.parametrize(
    ("ground", "z"),
    [
        ('<geom name="quay" type="box" size="3 3 1" pos="0 -3.2 -.5"/>', 0.0),
        ('<geom name="bottom" type="plane" size="9 9 1" pos="0 0 -3"/>', 0.0),
        ('<geom name="ice" type="box" size="9 9 .5"/>', -2.0),
        ('<geom name="bridge" type="box" size="9 9 .1" pos="0 0 3"/>', 0.0),
    ],
)
def test_what_a_vehicle_does_not_rest_on_is_not_told(tmp_path, ground, z):
    assert start_above(tmp_path, ground, start=Start(position=(0.0, 0.0, z))) == []


def test_a_body_of_the_environment_in_which_the_vehicle_starts_is_told(tmp_path):
    buoy = '<body name="buoy"><freejoint/><geom size=".1" mass="2"/></body>'
    assert start_above(tmp_path, buoy) == [
        "vehicle 'boat' and 'environment/buoy' lie in each other at the start, and contact will "
        "throw them apart; start the vehicle elsewhere (start.position)"
    ]


def test_what_refers_to_the_ground_goes_with_it():
    extra = (
        '<contact><pair geom1="g" geom2="hull"/></contact>'
        '<sensor><distance geom1="g" geom2="hull" cutoff="1"/><clock/></sensor>'
    )
    spec = mujoco.MjSpec.from_string(BOAT.format(ground=SLAB.format(z=-0.5), extra=extra))
    with pytest.warns(BuoyancyWarning, match="ground box 'g' at z = 0 m"):
        remove_dry_land(spec, Path("boat.xml"), 0.0)
    model = spec.compile()
    assert (model.ngeom, model.npair, model.nsensor) == (1, 0, 1)


@pytest.mark.parametrize(
    ("file", "told"),
    [
        ("fuse", []),
        ("discard", []),
        (
            "boxfloor",
            [
                "the vehicle's ground box 'floor' at z = 0 m would keep out the water at 0 m and "
                "was left out"
            ],
        ),
    ],
)
def test_a_boat_floats_whatever_its_file_says_of_ground(tmp_path, file, told):
    scene = tmp_path / "scene.toml"
    scene.write_text(
        f'title = "boat"\nvehicle = "{CASES / file}.xml"\nduration = 1.0\n'
        "[start]\nposition = [0, 0, 0]\n"
    )
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", BuoyancyWarning)
        run = Simulation(read_scene(scene))
    assert [str(entry.message) for entry in caught] == told
    for _ in run.frames():
        pass
    summary = run.summary()
    # 8 kg on 0.4 m x 0.2 m
    assert summary.final_draft == pytest.approx(0.1, abs=1e-6)
    assert summary.contact_steps == 0
