"""`inspect`: each fault of a mesh is named, each body weighed, the sentence is the right one."""

import json

import mujoco
import numpy as np
import pytest
import shapely
import trimesh
from scipy.integrate import cumulative_trapezoid
from typer.testing import CliRunner

from buoyancy_mj import (
    BuoyancyWarning,
    Selection,
    Water,
    equilibria,
    equilibrium,
    hydrostatics,
    righting_arm,
)
from buoyancy_mj.cli import app
from buoyancy_mj.inspection.brief import describe_in_brief
from buoyancy_mj.inspection.inspection import inspect_model
from buoyancy_mj.inspection.json_report import to_json
from buoyancy_mj.inspection.report import list_sections, to_markdown
from buoyancy_mj.meshes import shapes
from buoyancy_mj.statics.building import build_vessel
from buoyancy_mj.statics.curves import compute_hydrostatic_curves, compute_waterline
from tests import vessels

HEAVY_BELOW = '<inertial pos=".1 0 -.1" mass="400" diaginertia="9 9 9"/>'
BALL = trimesh.creation.icosphere(subdivisions=3, radius=0.3)


def mesh_model(vertices, faces, mass=20.0, **arguments):
    """A free body with a mesh that MuJoCo takes as it is."""
    spec = mujoco.MjSpec()
    spec.add_mesh(
        name="hull",
        uservert=np.asarray(vertices, float).ravel(),
        userface=np.asarray(faces, int).ravel(),
        inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
    )
    body = spec.worldbody.add_body(
        name="boat", mass=mass, inertia=[1.0, 1.0, 1.0], ipos=[0, 0, -0.05], explicitinertial=True
    )
    body.add_freejoint()
    body.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname="hull", name="hull", **arguments)
    return spec.compile()


def only(model, **choice):
    """What floats of a model with one vehicle."""
    (floating,) = inspect_model(model, **choice).vessels
    return floating


# the sentence


@pytest.mark.parametrize(
    ("mass", "sentence"),
    [
        (600.0, "floats: 600 kg reserve, draft 0.3 m, stable, GM 0.128 m"),
        (1201.3, "sinks: 1.3 kg too heavy"),
        (1200.0, "hovers: neutral, BG 0 m"),
    ],
)
def test_the_sentence_a_person_wants(mass, sentence):
    assert only(vessels.box(mass=mass)).sentence == sentence


def test_what_does_not_stay_as_drawn_is_told():
    sentence = only(vessels.box((0.1, 0.15, 0.25), 15.0)).sentence
    assert sentence.startswith("floats: 15 kg reserve, draft 0.1 m, stable, GM ")
    assert sentence.endswith("degrees, not as drawn")


def test_a_lean_is_told():
    model = vessels.of_geoms(
        '<geom type="box" size="1 .5 .3"/>',
        '<inertial pos="0 .02 -.1" mass="600" diaginertia="9 9 9"/>',
    )
    found = only(model)
    assert (
        f", heel {np.degrees(found.rest.hydrostatics.heel):.1f}, trim 0.0 degrees" in found.sentence
    )
    assert found.rest.hydrostatics.heel < -0.05


def test_what_hangs_on_joints_is_weighed():
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><worldbody><body name="buoy"><joint type="slide" axis="0 0 1"/>'
        '<geom type="box" size=".5 .5 .5" mass="100"/></body></worldbody></mujoco>'
    )
    found = only(model)
    assert found.sentence == (
        "body 'buoy' hangs on joints: free, it would float with 900 kg reserve"
    )
    assert found.rest is None


def test_what_is_heavy_and_hangs_on_joints_does_not_sink():
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><worldbody><body name="crane"><joint/>'
        '<geom type="box" size=".5 .5 .5" mass="1200"/></body></worldbody></mujoco>'
    )
    assert only(model).sentence == (
        "body 'crane' hangs on joints: free, it would sink, 200 kg too heavy"
    )


def test_density_of_the_water_counts():
    assert only(vessels.box(mass=1201.3)).sentence.startswith("sinks")
    (floating,) = inspect_model(vessels.box(mass=1201.3), Water(density=1025.0)).vessels
    assert floating.sentence.startswith("floats: 28.7 kg reserve")


def test_each_body_is_weighed_and_the_whole():
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><worldbody><body name="rov"><freejoint/>
        <geom type="box" size=".2 .2 .2" mass="60"/>
        <body name="arm" pos=".3 0 0"><joint axis="0 1 0"/>
        <geom type="box" size=".05 .05 .05" mass="3"/>
        <body name="cover"><geom type="box" size=".01 .01 .01" pos=".1 0 0" mass=".5"/></body>
        </body></body></worldbody></mujoco>"""
    )
    found = only(model)
    shares = {share.body: share for share in found.bodies}
    assert set(shares) == {"rov", "arm"}  # the cover moves with the arm
    assert shares["rov"].reserve == pytest.approx(4.0)
    assert shares["arm"].reserve == pytest.approx(1.008 - 3.5)
    assert shares["arm"].lift == pytest.approx((1.008 - 3.5) * 9.81)
    assert found.total.reserve == pytest.approx(65.008 - 63.5)
    assert found.centre_of_gravity == pytest.approx([(3 * 0.3 + 0.5 * 0.4) / 63.5, 0, 0])
    assert found.centre_of_buoyancy == pytest.approx([(0.3 + 0.008 * 0.4) / 65.008, 0, 0])


def test_the_numbers_are_those_of_the_library():
    model = vessels.of_geoms('<geom type="capsule" size=".3 1" euler="0 90 0"/>', HEAVY_BELOW)
    found = only(model)
    assert found.rest.qpos == pytest.approx(equilibrium(model).qpos)
    assert len(found.rests) == len(equilibria(model))
    arm = righting_arm(model, start=found.rest.qpos)
    assert found.righting.gz == pytest.approx(arm.gz, abs=1e-9)


# slips


def test_mass_that_nobody_stated_is_told():
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><worldbody><body><freejoint/><geom type="box" size=".5 .5 .5"/></body>'
        "</worldbody></mujoco>"
    )
    (note,) = only(model).notes
    assert (
        "just what 1000 kg/m^3 makes of its volume: "
        "MuJoCo's choice where a model states no mass; give its bodies" in note
    )


@pytest.mark.long
def test_a_slip_of_units_is_told():
    found = only(mesh_model(1000.0 * BALL.vertices, BALL.faces))
    assert any(
        "check the scale of its meshes (a mesh drawn in millimetres wants scale='0.001" in note
        for note in found.notes
    )


# the mesh doctor


def doctor(vertices, faces):
    """The part, and all that the report says of meshes."""
    found = inspect_model(mesh_model(vertices, faces))
    (part,) = found.geoms
    text = "\n".join(note for section in list_sections(found) for note in section.notes)
    return part, text


def test_a_sound_mesh_has_no_fault():
    part, text = doctor(BALL.vertices, BALL.faces)
    assert part.diagnosis.notices == []
    assert not part.diagnosis.repaired
    assert part.notes == ()
    assert "hull" not in text.replace("'hull'", "")


def test_thin_walls_open_to_the_sea_are_told():
    inner = trimesh.creation.icosphere(subdivisions=3, radius=0.295)
    keep = BALL.triangles_center[:, 2] < 0.2
    top = BALL.faces[keep]
    # a cup: outer wall, inner wall, and a rim that joins them
    edges = trimesh.Trimesh(BALL.vertices, top, process=False)
    rim = edges.edges[trimesh.grouping.group_rows(edges.edges_sorted, require_count=1)]
    n = len(BALL.vertices)
    band = np.vstack(
        [
            np.column_stack([rim[:, 1], rim[:, 0], rim[:, 0] + n]),
            np.column_stack([rim[:, 1], rim[:, 0] + n, rim[:, 1] + n]),
        ]
    )
    part, text = doctor(
        np.vstack([BALL.vertices, inner.vertices]), np.vstack([top, top[:, ::-1] + n, band])
    )
    assert part.mesh is not None
    assert "its walls are about 4.95 mm thick and it displaces" in text
    assert "or take its convex hull (--hull '" in text


def test_a_refused_mesh_is_named_and_the_rest_goes_on():
    spec = mujoco.MjSpec()
    open_box = shapes.box((0.2, 0.2, 0.2))
    sides = open_box.faces[open_box.area_vectors[:, 2] <= 0.0]
    spec.add_mesh(
        name="tub",
        uservert=open_box.vertices.ravel(),
        userface=sides.ravel(),
        inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
    )
    body = spec.worldbody.add_body(
        name="boat", mass=5.0, inertia=[1, 1, 1], ipos=[0, 0, 0], explicitinertial=True
    )
    body.add_freejoint()
    body.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname="tub", name="tub")
    body.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.1, 0.1, 0.1], pos=[0, 0, -1], name="keel")
    found = inspect_model(spec.compile())
    tub, keel = found.geoms
    assert tub.displaces
    assert tub.mesh is None
    assert keel.mesh is not None
    (problem,) = found.problems
    assert "mesh 'tub' of geom 'tub': it is open: 1 hole with 4 edges" in problem
    assert "close the mesh, take its convex hull (--hull 'tub=convex', in Python" in problem
    (floating,) = found.vessels
    assert floating.total.displacement == pytest.approx(8.0)
    # and nothing is said of how the vessel floats without it
    assert floating.sentence == ("not known before 'tub' can displace water, see the problems")
    assert floating.refused == ("tub",)
    assert (floating.rest, floating.rests, floating.righting) == (None, (), None)
    text = to_markdown(found)
    assert "| tub | mesh | refused, see the problems |" in text
    assert "| boat | 5 | - | - | - |" in text
    assert "1 hole, to 1.6 m round" in text
    assert "sinks" not in text
    values = to_json(found)["floating"][0]
    assert (values["refused"], values["displaced"], values["lift"]) == (["tub"], None, None)
    # as its convex hull it displaces
    convex = inspect_model(spec.compile(), selection=Selection(hull="tub=convex"))
    assert convex.problems == ()
    assert convex.geoms[0].convex
    assert convex.vessels[0].total.displacement == pytest.approx(72.0, rel=1e-6)


def test_what_does_not_displace_says_why():
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><worldbody><geom name="floor" type="plane" size="1 1 1"/>
        <geom name="rock" type="box" size="1 1 1"/>
        <body name="boat"><freejoint/><geom name="hull" type="box" size=".5 .5 .5" mass="9"/>
        <geom name="paint" type="box" size=".6 .5 .5" contype="0" conaffinity="0" mass="0"/></body>
        </worldbody></mujoco>"""
    )
    reasons = {part.name: part.reason for part in inspect_model(model).geoms}
    assert reasons == {
        "floor": "a plane bounds no volume",
        "rock": "its body cannot move",
        "hull": "collision geom",
        "paint": "visual; its body has collision geoms",
    }
    assert {
        p.name: p.displaces for p in inspect_model(model, selection=Selection(geoms="paint")).geoms
    }["hull"] is False


def test_overlaps_between_bodies_are_told():
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><worldbody><body name="a"><freejoint/>
        <geom name="one" type="box" size=".5 .5 .5" mass="9"/>
        <body name="b" pos=".9 0 0"><joint/>
        <geom name="two" type="box" size=".5 .5 .5" mass="9"/></body></body>
        </worldbody></mujoco>"""
    )
    found = inspect_model(model)
    ((one, two, volume),) = found.overlaps
    assert (one, two) == ("one", "two")
    assert volume == pytest.approx(0.1)
    # and count twice
    assert found.vessels[0].total.displacement == pytest.approx(2000.0)


# lines


def test_draft_curves_end_with_the_whole_volume_and_waterlines_close():
    vessel = build_vessel(vessels.of_mesh(vessels.dented(2), 400.0))
    curves = compute_hydrostatic_curves(vessel, np.eye(3), 41)
    assert curves.volume[-1] == pytest.approx(vessel.volume, rel=1e-4)
    assert (np.diff(curves.volume) > 0.0).all()
    # the waterplane is the slope of the volume
    summed = cumulative_trapezoid(curves.waterplane_area, curves.draft, initial=0.0)
    assert curves.volume == pytest.approx(summed, abs=2e-3 * vessel.volume)
    segments = compute_waterline(vessel, np.eye(3), curves.draft[20])
    ends = np.round(segments.reshape(-1, 2), 9)
    assert (np.unique(ends, axis=0, return_counts=True)[1] == 2).all()
    area = shapely.polygonize(list(shapely.linestrings(np.round(segments, 9)))).area
    assert area == pytest.approx(curves.waterplane_area[20], rel=1e-6)


# report


def test_the_report_is_markdown_and_json():
    found = inspect_model(vessels.box(), title="raft")
    text = to_markdown(found, [("Righting arm", "gz.png")])
    assert text.startswith("# raft\n")
    assert "floats: 600 kg reserve, draft 0.3 m, stable, GM 0.128 m" in text
    assert "| GM across, along | 0.1278, 0.9611 | m |" in text
    assert "![Righting arm](gz.png)" in text
    values = json.loads(json.dumps(to_json(found), allow_nan=False))
    (floating,) = values["floating"]
    assert floating["rest"]["hydrostatics"]["GMt"] == pytest.approx(hydrostatics(vessels.box()).GMt)
    assert floating["rest"]["hydrostatics"]["natural_periods"][0] == pytest.approx(1.0988, abs=1e-4)
    assert len(floating["righting"]["gz"]) == 181
    assert values["geoms"][0]["volume"] == pytest.approx(1.2)
    assert values["geoms"][0]["centroid"] == pytest.approx([0.0, 0.0, 0.0])


def test_each_of_several_vessels_has_sections_with_its_name():
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><worldbody>
        <body name="tug"><freejoint/><geom type="box" size="1 .5 .3" mass="600"/></body>
        <body name="barge" pos="0 9 0"><freejoint/><geom type="box" size="2 .5 .3" mass="500"/>
        </body></worldbody></mujoco>"""
    )
    titles = [section.title for section in list_sections(inspect_model(model))]
    assert titles[1:] == [
        "Will 'tug' float?",
        "'tug' at rest",
        "Every pose in which 'tug' rests",
        "Righting arm of 'tug' from there, trim free",
        "Will 'barge' float?",
        "'barge' at rest",
        "Every pose in which 'barge' rests",
        "Righting arm of 'barge' from there, trim free",
    ]


def test_centroids_are_in_the_frame_of_the_body():
    model = vessels.of_mesh(vessels.dented(4).transformed(np.eye(3), (1.0, 2.0, 3.0)), 400.0)
    (part,) = inspect_model(model).geoms
    assert part.centroid == pytest.approx(vessels.dented(4).centroid + [1.0, 2.0, 3.0], abs=1e-6)


# the command line

RAFT = """<mujoco><asset><mesh name="hull" file="hull.obj" inertia="shell"/></asset><worldbody>
<body name="raft" pos="1 2 0"><inertial pos="0 0 0" mass="20" diaginertia="1 1 1"/>
<geom name="hull" type="mesh" mesh="hull" pos=".1 0 0" euler="10 0 0"/>
<site name="ballast_keel" pos="0 0 -.2"/></body>
</worldbody></mujoco>"""


@pytest.fixture
def raft(tmp_path, monkeypatch):
    """A vehicle whose ball lacks a triangle and has one turned, and the command that reads it."""
    faces = np.vstack([BALL.faces[1:], BALL.faces[5:6]])
    faces[3] = faces[3][::-1]
    trimesh.Trimesh(BALL.vertices + [0.05, 0.02, 0.0], faces, process=False).export(
        tmp_path / "hull.obj"
    )
    (tmp_path / "raft.xml").write_text(RAFT)
    monkeypatch.chdir(tmp_path)
    # by its whole name: MuJoCo remembers meshes by the name of their file, and each test has its
    # own
    return lambda *arguments: CliRunner().invoke(
        app, [arguments[0], str(tmp_path / "raft.xml"), *arguments[1:]]
    )


def test_inspect_prints_tables(raft):
    result = raft("inspect", "--water", "density=1025", "--details")
    assert result.exit_code == 0, result.output
    for word in (
        "what displaces water",
        "1 hole, to ",
        "wound backwards",
        "floats:",
        "At rest",
        "Every pose",
        "Righting arm",
    ):
        assert word in result.stdout


def test_inspect_prints_json_alone(raft):
    result = raft("inspect", "--json")
    assert json.loads(result.stdout)["geoms"][0]["mesh"]["backwards"] == 1


def test_inspect_leaves_plots_a_report_and_a_recording(raft, tmp_path):
    result = raft("inspect", "--plot", "out/plots", "--record", "out/raft.rrd")
    assert result.exit_code == 0, result.output
    assert {p.name for p in (tmp_path / "out" / "plots").iterdir()} == {
        "report.md", "raft_curves.png", "raft_waterlines.png", "raft_gz.png",
    }  # fmt: skip
    assert "raft_gz.png" in (tmp_path / "out" / "plots" / "report.md").read_text()
    assert (tmp_path / "out" / "raft.rrd").stat().st_size > 1000


def test_inspect_repairs_what_is_safe(raft, tmp_path):
    before = json.loads(raft("inspect", "--json").stdout)
    result = raft("inspect", "--repair", "mended/raft.xml")
    assert result.exit_code == 0, result.output
    assert "mended mesh 'hull' of geom 'hull'" in result.stderr
    assert "m^3, a change of " in result.stderr
    again = CliRunner().invoke(app, ["inspect", "mended/raft.xml", "--json"])
    after = json.loads(again.stdout)
    assert after["geoms"][0]["mesh"]["notices"] == []
    assert after["geoms"][0]["volume"] == pytest.approx(before["geoms"][0]["volume"], rel=1e-6)
    for name in ("centre_of_buoyancy", "centre_of_gravity", "mass"):
        assert after["floating"][0][name] == pytest.approx(
            before["floating"][0][name], rel=1e-5, abs=1e-6
        )
    # what was there is untouched
    assert "mended" not in (tmp_path / "raft.xml").read_text()


def test_a_refused_hull_is_an_error_status(raft, tmp_path):
    trimesh.Trimesh(BALL.vertices, BALL.faces[200:], process=False).export(tmp_path / "hull.obj")
    result = raft("inspect")
    assert result.exit_code == 1
    assert "it is open" in result.stdout
    assert raft("inspect", "--hull", "convex").exit_code == 0


def test_ballast_writes_a_vehicle_that_hovers(raft):
    result = raft("ballast", "--reserve", "0", "--out", "heavy/raft.xml")
    assert result.exit_code == 1
    assert "these places cannot level it" in result.stderr
    box = ["--box", "-.1", "-.1", "-.2", ".3", ".1", "-.1"]
    result = raft("ballast", "--reserve", "0", *box, "--out", "heavy/raft.xml")
    assert result.exit_code == 0, result.output
    assert "kg of ballast at (" in result.stdout
    assert "kg in all; under water: BG " in result.stdout
    assert "draft" not in result.stdout
    found = json.loads(CliRunner().invoke(app, ["inspect", "heavy/raft.xml", "--json"]).stdout)
    assert found["floating"][0]["sentence"].startswith("hovers: neutral, BG ")


def test_names_may_hold_anything_and_a_mesh_of_two_geoms_is_told_once(tmp_path, capfd):
    faces = np.vstack([BALL.faces[1:], BALL.faces[5:6]])
    trimesh.Trimesh(BALL.vertices * 100.0, faces, process=False).export(tmp_path / "ball.obj")
    (tmp_path / "odd.xml").write_text(
        """<mujoco><compiler angle="degree"/><asset><mesh name="a/b" file="ball.obj"
        scale="-.01 .01 .012" refpos=".01 0 0" refquat=".9 .1 0 0" inertia="shell"/></asset>
        <worldbody><body name="boat/one [x]" euler="0 0 30"><freejoint/>
        <inertial pos="0 0 -.05" mass="30" diaginertia="1 1 1"/>
        <geom name="g/1" type="mesh" mesh="a/b" euler="10 20 30"/>
        <geom type="mesh" mesh="a/b" pos=".8 .2 0"/></body></worldbody></mujoco>"""
    )
    flags = [
        "--repair",
        str(tmp_path / "m" / "odd.xml"),
        "--record",
        str(tmp_path / "odd.rrd"),
        "--plot",
        str(tmp_path / "p"),
    ]
    before = CliRunner().invoke(app, ["inspect", str(tmp_path / "odd.xml"), "--json", *flags])
    assert before.exit_code == 0, before.output
    assert before.stderr.count("mended mesh 'a/b' of geom 'g/1' and 1 more") == 1
    # Rerun complains of paths that are not escaped
    assert "Unescaped" not in capfd.readouterr().err
    after = CliRunner().invoke(app, ["inspect", str(tmp_path / "m" / "odd.xml"), "--json"])
    one, two = (json.loads(result.stdout)["floating"][0] for result in (before, after))
    assert two["centre_of_buoyancy"] == pytest.approx(one["centre_of_buoyancy"], abs=1e-6)
    assert two["displaced"] == pytest.approx(one["displaced"], rel=1e-5)


def test_a_ball_rests_as_drawn():
    model = vessels.of_geoms('<geom type="sphere" size=".2" mass="5"/>')
    sentence = only(model).sentence
    assert sentence.startswith("floats: 28.5 kg reserve, draft 0.0976 m, indifferent, GM ")
    assert "drawn" not in sentence


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["inspect", "--water", "density"], "write KEY=VALUE, as in density=1025"),
        (["inspect", "--water", "salt=3"], "unknown key 'salt'"),
        (["inspect", "--record", "a.png"], "a recording's name ends in .rrd"),
        (["inspect", "--geoms", "keel"], "no moving geom matches 'keel'"),
        (["ballast"], "ballast needs either a draft"),
    ],
)
def test_bad_flags_are_told_in_a_sentence(raft, arguments, message):
    result = raft(*arguments)
    assert result.exit_code == 1
    assert message in result.stderr
    assert "Traceback" not in result.output


def test_what_was_mended_is_no_warning_of_the_inspection(recwarn):
    inspect_model(mesh_model(BALL.vertices, BALL.faces[1:]))
    assert not [entry for entry in recwarn if issubclass(entry.category, BuoyancyWarning)]


# in brief


def told_of(name, *flags):
    result = CliRunner().invoke(app, ["inspect", name, *flags], env={"COLUMNS": "80"})
    assert result.exit_code == 0, result.output
    return [line.rstrip() for line in result.stdout.splitlines()]


def test_a_report_begins_with_its_verdict_and_ends_with_what_to_do_next():
    for name, verdict in (("bluerov2_heavy", "sinks: 0.1 kg"), ("catamaran", "floats: 87.9 kg")):
        lines = told_of(name)
        assert lines[0].startswith(f"{name} {verdict}")
        assert "Next" in lines
        assert lines[-1] == f"   buoyancy-mj inspect {name} --plot {name}"


def test_equal_geoms_are_one_row():
    rows = [" ".join(line.split()) for line in told_of("bluerov2_heavy")]
    assert "8 thrusters cylinder 0.2262 1.81 13.5" in rows
    assert "2 x foam box 1.836 3.673 27.4" in rows
    details = told_of("bluerov2_heavy", "--details")
    assert any(line.startswith(" horizontal_front_port ") for line in details)


@pytest.mark.parametrize("flags", [(), ("--details", "--added-mass", "ellipsoid")])
def test_a_report_is_whole_on_eighty_columns(flags):
    for name in ("bluerov2_heavy", "catamaran", "glider"):
        lines = told_of(name, *flags)
        assert max(map(len, lines)) <= 80
        # what is cut off ends with dots
        assert not any("\N{HORIZONTAL ELLIPSIS}" in line for line in lines)
        assert " ".join(lines).count("doubt [%]") == len(flags) // 2


def test_a_draft_is_told_beside_the_height_of_the_vessel():
    (draft,) = [line for line in told_of("hourglass") if line.startswith(" draft")]
    assert draft.split() == ["draft", "0.3394", "m", "of", "0.4", "m", "height"]


def test_what_is_inside_of_another_geom_is_told_to_count_once():
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><worldbody><body name="hull"><freejoint/>
        <geom name="shell" type="box" size=".2 .1 .1" mass="4"/>
        <geom name="battery" type="box" size=".05 .05 .05" mass="2"/>
        <geom name="keel" type="box" size=".1 .05 .01" pos="0 0 -.11" mass="1"/>
        </body></worldbody></mujoco>"""
    )
    first, *_ = describe_in_brief(inspect_model(model))
    assert "1 l of it is inside of other geoms and counts once, so 16.4 l displace" in first.notes
