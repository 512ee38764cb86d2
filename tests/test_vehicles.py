"""Vehicles as other people write them: each runs, or is refused with the right sentence.

What they do was met in quadrupeds, quadrotors, arms, humanoids and fish of dm_control, gymnasium,
robosuite, example-robot-data and pybullet, none of which are kept here.
"""

import json
import shlex
import warnings
from pathlib import Path

import numpy as np
import pytest
import trimesh
from typer.testing import CliRunner

from buoyancy_mj import BuoyancyWarning, repair
from buoyancy_mj.cli import app
from buoyancy_mj.meshes import shapes
from buoyancy_mj.scenes.vehicles import read_vehicle
from tests import vessels

URDF = """<robot name="robot"><link name="base"><inertial><mass value="{mass}"/>
<inertia ixx="{inertia}" ixy="0" ixz="0" iyy="{inertia}" iyz="0" izz="{inertia}"/></inertial>
<collision><geometry><mesh filename="{file}"/></geometry></collision></link>
<link name="leg"><inertial><mass value="1"/>
<inertia ixx=".1" ixy="0" ixz="0" iyy=".1" iyz="0" izz=".1"/></inertial>
<collision><geometry><cylinder radius=".03" length=".3"/></geometry></collision></link>
<joint name="hip" type="revolute"><parent link="base"/><child link="leg"/>
<origin xyz="0 .2 -.1"/><axis xyz="0 1 0"/>
<limit lower="-1" upper="1" effort="9" velocity="9"/></joint></robot>"""


def write(folder, name, text):
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return str(path)


def stl(folder, name, mesh, kind="stl"):
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    trimesh.Trimesh(mesh.vertices, mesh.faces, process=False).export(path, file_type=kind)


def inspect_model(path, *flags):
    result = CliRunner().invoke(app, ["inspect", path, "--json", *flags])
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout), result.stderr


def ran(path, *flags):
    result = CliRunner().invoke(
        app,
        [*shlex.split(f"run auv_waves --vehicle {path} --no-record --json --duration 0.5"), *flags],
    )
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout), result.stderr


def refused(path, message):
    """By both commands, in one sentence."""
    for command in (["inspect", path], ["run", "auv_waves", "--vehicle", path, "--no-record"]):
        result = CliRunner().invoke(app, command)
        assert result.exit_code == 1
        assert message in result.stderr
        assert "Traceback" not in result.output


# URDF of ROS packages


def test_files_of_a_package_are_found_above_the_urdf(tmp_path):
    stl(tmp_path, "my_robot/meshes/base.stl", shapes.box((0.2, 0.2, 0.1)))
    text = URDF.format(file="package://my_robot/meshes/base.stl", mass=10, inertia=0.2)
    path = write(tmp_path, "my_robot/urdf/robot.urdf", text)
    found, _ = inspect_model(path)
    assert found["floating"][0]["displaced"] == pytest.approx(
        1000 * (0.032 + np.pi * 0.03**2 * 0.3), rel=1e-6
    )
    summary, _ = ran(path)
    assert summary["mass"] == pytest.approx(11.0)


def test_files_of_a_package_are_found_on_the_ros_path(tmp_path, monkeypatch):
    stl(tmp_path, "elsewhere/my_robot/base.stl", shapes.box((0.2, 0.2, 0.1)))
    path = write(
        tmp_path,
        "robot.urdf",
        URDF.format(file="package://my_robot/base.stl", mass=10, inertia=0.2),
    )
    refused(
        path,
        "no folder 'my_robot' above it or on ROS_PACKAGE_PATH holds that file; "
        "put the package there",
    )
    monkeypatch.setenv("ROS_PACKAGE_PATH", f"/nowhere:{tmp_path / 'elsewhere'}")
    assert inspect_model(path)[0]["problems"] == []


def test_a_base_without_inertia_is_reported(tmp_path):
    stl(tmp_path, "base.stl", shapes.box((0.2, 0.2, 0.1)))
    path = write(tmp_path, "robot.urdf", URDF.format(file="base.stl", mass=0.0, inertia=0.1))
    refused(
        path,
        "a body that floats needs mass and inertia: give it an <inertial>, "
        "or bound them by <mujoco><compiler boundmass",
    )


def test_a_mesh_in_ascii_is_read(tmp_path):
    stl(tmp_path, "base.stl", shapes.box((0.2, 0.2, 0.1)), kind="stl_ascii")
    path = write(tmp_path, "robot.urdf", URDF.format(file="base.stl", mass=10, inertia=0.2))
    found, _ = inspect_model(path)
    assert found["geoms"][0]["volume"] == pytest.approx(0.032, rel=1e-6)
    assert ran(path)[0]["mass"] == pytest.approx(11.0)


# MJCF of simulated animals


FISH = """<mujoco><option gravity="{gravity}"><flag gravity="{flag}"/></option><worldbody>
<geom name="pond" type="plane" size="5 5 .1"/><body name="fish"><freejoint/>
<geom type="ellipsoid" size=".1 .05 .08" density="900"/>
<body name="tail" pos="-.12 0 0"><joint axis="0 0 1"/>
<geom type="ellipsoid" size=".04 .01 .05" density="900"/></body></body></worldbody></mujoco>"""


@pytest.mark.parametrize(
    ("gravity", "flag", "told"),
    [("0 0 0", "enable", "sets gravity to 0 0 0"), ("0 0 -9.81", "disable", "disables gravity")],
)
def test_what_swims_without_gravity_weighs_in_water(tmp_path, gravity, flag, told):
    path = write(tmp_path, "fish.xml", FISH.format(gravity=gravity, flag=flag))
    found, notes = inspect_model(path)
    assert f"the vehicle {told}; water needs gravity, so it is 0 0 -9.81 here" in notes
    assert found["floating"][0]["sentence"].startswith("floats: 0.1")
    summary, notes = ran(path)
    assert told in notes
    assert "ground plane 'pond'" in notes
    assert summary["net_weight"] < 0.0


@pytest.mark.parametrize("flag", ["false", "true"])
def test_a_fin_that_is_drawn_alone_displaces_whether_or_not_visual_geoms_are_discarded(
    tmp_path, flag
):
    path = write(
        tmp_path,
        "fin.xml",
        f'<mujoco><compiler discardvisual="{flag}"/><worldbody><body name="b"><freejoint/>'
        '<geom type="box" size=".1 .1 .1" mass="4"/><body name="fin" pos="0 0 -.2"><joint/>'
        '<geom name="fin" type="box" size=".1 .1 .1" mass="1" contype="0" conaffinity="0"/>'
        "</body></body></worldbody></mujoco>",
    )
    assert inspect_model(path)[0]["floating"][0]["displaced"] == pytest.approx(16.0)
    assert ran(path)[0]["mass"] == pytest.approx(5.0)


FUSED = """<mujoco><compiler fusestatic="{flag}"/><worldbody>
<body name="mark" pos="9 0 0"><geom size=".1" contype="0" conaffinity="0"/></body>
<body name="b"><freejoint/><geom type="box" size=".1 .1 .1" mass="4"/>
<body name="mast" pos="0 0 .2"><geom type="box" size=".01 .01 .1" mass="1"/></body>
</body></worldbody></mujoco>"""
BUOYS = """<mujoco><worldbody>{}</worldbody></mujoco>""".format(
    "".join(
        f'<body pos="{x} 5 0"><freejoint/><geom type="box" size=".1 .1 .1" mass="4"/></body>'
        for x in range(3)
    )
)


@pytest.mark.parametrize("flag", ["false", "true"])
def test_what_floats_in_the_environment_is_no_part_of_a_vehicle_whose_bodies_are_fused(
    tmp_path, flag
):
    path = write(tmp_path, "rov.xml", FUSED.format(flag=flag))
    buoys = write(tmp_path, "buoys.xml", BUOYS)
    summary, _ = ran(path, "--set", f"environment='{buoys}'")
    assert summary["displacement"] == pytest.approx(8.08)


DRAWN = """<mujoco><compiler fusestatic="{flag}"/>{words}<worldbody><body name="b"><freejoint/>
<geom name="hull" type="box" size=".3 .1 .1" mass="9"/><body name="pod" pos="0 0 -.5">
<geom name="pod" type="box" size=".2 .1 .1" contype="0" conaffinity="0" mass="1"/>
</body></body></worldbody></mujoco>"""


def test_what_is_drawn_alone_and_fused_with_what_collides_is_told(tmp_path):
    def notices(flag, words=""):
        path = write(tmp_path, "rov.xml", DRAWN.format(flag=flag, words=words))
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", BuoyancyWarning)
            read_vehicle(Path(path))
        return [str(entry.message) for entry in caught]

    assert notices("true") == [
        "the vehicle has MuJoCo fuse its fixed bodies (fusestatic), and 'pod', of bodies that are "
        "only drawn, displace nothing beside the collision geoms with which they are fused; name "
        "them among the geoms, or set fusestatic='false'"
    ]
    assert notices("false") == []
    assert notices("true", '<custom><text name="buoyancy_geoms" data="*"/></custom>') == []


# plates


@pytest.mark.parametrize("size", [".5 .5 1e-17", "1e-17 1e-17 .5"])
def test_what_is_too_thin_for_a_convex_hull_runs_beside_what_floats(tmp_path, size):
    path = write(
        tmp_path,
        "plate.xml",
        f'<mujoco><worldbody><body name="b"><freejoint/><geom type="box" size="{size}" mass="0"/>'
        '<geom type="box" size=".1 .1 .1" pos="0 0 2" mass="4"/></body></worldbody></mujoco>',
    )
    inspect_model(path)
    assert ran(path)[0]["mass"] == pytest.approx(4.0)


# hulls of ships


def hull(tmp_path, closed):
    vertices, faces = vessels.tanker()
    if closed:
        mesh, _ = repair(vertices, faces)
        vertices, faces = mesh.vertices, mesh.faces
    else:
        # as it was published: the wetted surface alone
        keep = (vertices[faces][:, :, 2] <= 1e-6).all(axis=1)
        faces = faces[keep]
    trimesh.Trimesh(vertices / 100.0, faces, process=False).export(tmp_path / "tanker.obj")
    return write(
        tmp_path,
        "tanker.xml",
        '<mujoco><asset><mesh name="tanker" file="tanker.obj" inertia="shell"/></asset>'
        '<worldbody><body name="tanker">'
        '<inertial pos=".0393 0 .025" mass="92.3" diaginertia="2 30 30"/>'
        '<geom name="shell" type="mesh" mesh="tanker"/>'
        "</body></worldbody></mujoco>",
    )


def test_a_ship_of_panels_floats_at_its_draft(tmp_path):
    path = hull(tmp_path, closed=True)
    found, _ = inspect_model(path)
    at = found["floating"][0]["rest"]["hydrostatics"]
    # the model of 1 : 100 displaces 92.3 l at a draft of 0.1 m
    assert at["draft"] == pytest.approx(0.1, abs=2e-4)
    assert at["heel"] == pytest.approx(0.0, abs=1e-3)
    assert found["floating"][0]["righting"]["vanishing"] > 0.5
    ran(path)


def test_an_open_shell_is_refused_and_its_convex_hull_floats(tmp_path):
    path = hull(tmp_path, closed=False)
    result = CliRunner().invoke(app, ["inspect", path])
    assert result.exit_code == 1
    assert "geom 'shell'" in result.stdout
    assert "it is open" in result.stdout.replace("\n", " ")
    result = CliRunner().invoke(app, ["run", "auv_waves", "--vehicle", path, "--no-record"])
    assert result.exit_code == 1
    assert (
        "close the mesh, take its convex hull (--hull 'shell=convex', in Python "
        "Selection(hull='shell=convex'), "
        'in MJCF <text name="buoyancy_hull" data="shell=convex"/>), '
        "or leave the geom out (--geoms)" in result.stderr
    )
    found, _ = inspect_model(path, "--hull", "convex")
    assert found["geoms"][0]["hull"] == "convex"
    ran(path, "--hull", "convex")


def test_ballast_stays_in_a_urdf(tmp_path):
    # MuJoCo discards what is visual alone in URDF, and fuses what does not move
    stl(tmp_path, "base.stl", shapes.box((0.2, 0.2, 0.1)))
    path = write(tmp_path, "robot.urdf", URDF.format(file="base.stl", mass=10, inertia=0.2))
    heavy = str(tmp_path / "out" / "robot.xml")
    flags = ["--reserve", "0", "--box", "-.1", "-.1", "-.4", ".1", ".1", "-.3"]
    result = CliRunner().invoke(app, ["ballast", path, *flags, "--out", heavy])
    assert result.exit_code == 0, result.output
    found, _ = inspect_model(heavy)
    assert found["floating"][0]["sentence"].startswith("hovers: neutral")
    assert "ballast_box" in [geom["name"] for geom in found["geoms"]]
    # and touches nothing
    assert ran(heavy)[0]["contact_steps"] == 0
