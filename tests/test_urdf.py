"""URDF as people publish it for underwater vehicles."""

import warnings
from pathlib import Path

import mujoco
import numpy as np
import pytest
import trimesh

from buoyancy_mj import Buoyancy, BuoyancyWarning, ModelError, Water
from buoyancy_mj.hulls.geoms import find_hulls
from buoyancy_mj.scenes.specs import compile_spec
from buoyancy_mj.scenes.vehicles import read_vehicle

CASES = Path(__file__).parent / "data/cases/urdf_thruster"
BOX = '<geometry><box size="0.5 0.3 0.2"/></geometry>'
KEEP = '<mujoco><compiler discardvisual="false"/></mujoco>'


def link(name, mass=None, inertia=0.1, *, visual="", collision=""):
    """A link; `inertia` is one moment, or the text of all."""
    if not isinstance(inertia, str):
        inertia = f'ixx="{inertia}" ixy="0" ixz="0" iyy="{inertia}" iyz="0" izz="{inertia}"'
    inertial = f'<inertial><mass value="{mass}"/><inertia {inertia}/></inertial>'
    return (
        f'<link name="{name}">{"" if mass is None else inertial}'
        f"{visual and f'<visual>{visual}</visual>'}"
        f"{collision and f'<collision>{collision}</collision>'}</link>"
    )


def joint(child, kind="continuous", parent="base", more=""):
    return (
        f'<joint name="to_{child}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="-0.2 0 0"/><axis xyz="1 0 0"/>'
        f'<limit lower="-1" upper="1" effort="9" velocity="9"/>{more}</joint>'
    )


def read(folder, *parts):
    """The model of a robot, and what is told."""
    path = folder / "rov.urdf"
    path.write_text(f'<robot name="rov">{"".join(parts)}</robot>')
    return read_file(path)


def read_file(path):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", BuoyancyWarning)
        model = compile_spec(read_vehicle(path), path)
    return model, [str(entry.message) for entry in caught]


def refuse(folder, *parts):
    with pytest.raises(ModelError) as refusal:
        read(folder, *parts)
    return str(refusal.value)


BASE = link("base", 20, collision=BOX)


def test_a_thruster_of_a_gram_without_inertia_gets_that_of_a_ball_of_water():
    model, told = read_file(CASES / "uuv.urdf")
    assert told == ["links without inertia get that of a ball of water of their mass: 'thruster'"]
    thruster = model.body("thruster")
    assert thruster.mass == pytest.approx(0.001)
    # 2/5 m r^2 of a ball of 1 cm^3
    assert thruster.inertia == pytest.approx(0.4e-3 * (0.75e-6 / np.pi) ** (2 / 3), rel=1e-9)
    assert model.body_mass.sum() == pytest.approx(20.001)


def test_it_moves_for_a_while_and_stays_finite():
    model, _ = read_file(CASES / "uuv.urdf")
    data = mujoco.MjData(model)
    with Buoyancy(model, Water()).installed():
        for _ in range(500):
            mujoco.mj_step(model, data)
    # 20.001 kg on 0.5 m x 0.3 m: the box sinks in by 0.13334 m, and floats
    assert abs(data.qpos[2]) < 0.15
    assert np.isfinite(data.qacc).all()


def test_a_frame_without_mass_gets_a_gram_and_what_it_carries_is_as_it_was(tmp_path):
    parts = [
        link("frame"),
        joint("frame", "revolute"),
        link("arm", 0.5),
        joint("arm", parent="frame"),
    ]
    model, told = read(tmp_path, BASE, *parts)
    assert told == [
        "links without mass get mass and inertia of a ball of water of 1 g: 'frame'",
    ]
    assert model.body("frame").mass == pytest.approx(0.001)
    assert model.body("arm").inertia == pytest.approx(0.1)


@pytest.mark.parametrize(
    "parts",
    [
        # fixed frames, before the vehicle and on it, as ROS asks for
        [link("root"), BASE, joint("base", "fixed", "root"), link("imu"), joint("imu", "fixed")],
        # a frame that moves and carries something heavy
        [BASE, link("turret"), joint("turret"), link("lamp", 1), joint("lamp", "fixed", "turret")],
        # a link whose geometry has the mass
        [BASE, link("fin", collision=BOX), joint("fin")],
        # the file bounds them by itself
        [
            '<mujoco><compiler boundmass="0.01" boundinertia="0.001"/></mujoco>',
            BASE,
            link("frame"),
            joint("frame"),
        ],
    ],
)
def test_what_is_sound_is_left_as_it_is(tmp_path, parts):
    _, told = read(tmp_path, *parts)
    assert told == []


def test_a_rod_gets_only_the_moment_that_it_lacks(tmp_path):
    rod = 'ixx="0" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"'
    model, (told,) = read(tmp_path, BASE, link("rod", 0.1, rod), joint("rod"))
    assert told.endswith("of their mass: 'rod'")
    ball = 0.4 * 0.1 * (0.75 * 1e-4 / np.pi) ** (2 / 3)
    assert sorted(model.body("rod").inertia) == pytest.approx([ball, 0.01, 0.01])


def test_a_propeller_that_is_drawn_alone_and_has_no_mass_gets_a_gram(tmp_path):
    model, told = read(
        tmp_path, link("base", 20, visual=BOX), link("prop", visual=BOX), joint("prop")
    )
    assert told == ["links without mass get mass and inertia of a ball of water of 1 g: 'prop'"]
    assert model.body("prop").mass == pytest.approx(0.001)


@pytest.mark.parametrize("base", [link("base", 0, 0, collision=BOX), link("base", visual=BOX)])
def test_a_base_without_mass_is_refused_with_a_mend_that_works(tmp_path, base):
    message = refuse(tmp_path, base)
    assert message.endswith(
        "a body that floats needs mass and inertia: give it an <inertial>, or bound them by "
        '<mujoco><compiler boundmass="0.001" boundinertia="1e-08"/></mujoco> in the <robot>'
    )
    mend = message[message.index("<mujoco>") : message.index(" in the <robot>")]
    model, _ = read(tmp_path, mend, base)
    assert model.body("base").mass == pytest.approx(0.001)


@pytest.mark.parametrize(("mass", "inertia"), [(-1, 0.1), (1, -0.1)])
def test_negative_numbers_are_refused(tmp_path, mass, inertia):
    assert "Error" in refuse(tmp_path, BASE, link("fin", mass, inertia), joint("fin"))


def test_an_inertia_that_no_body_has_is_refused_with_a_mend_that_works(tmp_path):
    base = link("base", 20, 'ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="1"', collision=BOX)
    message = refuse(tmp_path, base)
    assert message.endswith(
        "no body has two moments of inertia that are together less than the third: correct them, "
        "or let MuJoCo level them by "
        '<mujoco><compiler balanceinertia="true"/></mujoco> in the <robot>'
    )
    mend = message[message.index("<mujoco>") : message.index(" in the <robot>")]
    model, _ = read(tmp_path, mend, base)
    assert model.body("base").mass == pytest.approx(20.0)


def test_the_mends_of_mjcf_are_those_of_mjcf(tmp_path):
    path = tmp_path / "boat.xml"
    path.write_text(
        '<mujoco><worldbody><body name="b"><freejoint/><inertial pos="0 0 0" mass="1" '
        'diaginertia=".1 .1 1"/><geom size="1"/></body></worldbody></mujoco>'
    )
    with pytest.raises(ModelError, match=r'level them by <compiler balanceinertia="true"/>$'):
        compile_spec(read_vehicle(path), path)


# links that are drawn alone


def test_a_vehicle_that_is_drawn_alone_displaces_by_what_is_drawn(tmp_path):
    (tmp_path / "meshes").mkdir()
    trimesh.creation.box((0.5, 0.3, 0.2)).export(
        tmp_path / "meshes/hull.stl", file_type="stl_ascii"
    )
    mesh = '<geometry><mesh filename="meshes/hull.stl" scale="1 1 2"/></geometry>'
    model, told = read(
        tmp_path, link("base", 20, visual=mesh), link("fin", 1, visual=BOX), joint("fin")
    )
    assert told == []
    assert [hull.mesh.volume for hull in find_hulls(model)] == pytest.approx([0.06, 0.03])
    assert model.body_mass.sum() == pytest.approx(21.0)


def test_links_that_are_drawn_alone_beside_others_displace_nothing_and_are_told(tmp_path):
    parts = [
        BASE,
        *(link("camera", 0.1, visual=BOX), joint("camera", "fixed")),
        *(link("prop", 0.1, visual=BOX), joint("prop")),
    ]
    model, told = read(tmp_path, *parts)
    assert told == [
        "links that are drawn and have no collision geometry displace nothing, since MuJoCo leaves "
        f"visual geometry out of a URDF unless it has {KEEP}: 'prop'"
    ]
    assert model.ngeom == 1
    # as the notice says
    model, told = read(tmp_path, KEEP, *parts)
    assert told == []
    assert len(find_hulls(model)) == 2


# what else public files hold


def test_gazebo_transmissions_and_mimics_are_no_matter(tmp_path):
    model, told = read(
        tmp_path,
        BASE,
        *(link("left", 0.2), joint("left", "revolute")),
        *(link("right", 0.2), joint("right", "revolute", more='<mimic joint="to_left"/>')),
        '<gazebo reference="base"><plugin filename="x.so"><link name="base"/></plugin></gazebo>',
        '<transmission name="t"><joint name="to_left"/></transmission>',
    )
    assert told == []
    assert model.neq == 1


def test_files_are_found_by_their_whole_address(tmp_path):
    (tmp_path / "my meshes").mkdir()
    trimesh.creation.box((0.5, 0.3, 0.2)).export(tmp_path / "my meshes/hull.stl")
    file = f"file://{tmp_path}/my%20meshes/hull.stl"
    model, _ = read(
        tmp_path, link("base", 20, collision=f'<geometry><mesh filename="{file}"/></geometry>')
    )
    assert find_hulls(model)[0].mesh.volume == pytest.approx(0.03)


def test_a_xacro_is_refused_with_what_expands_it(tmp_path):
    path = tmp_path / "rov.urdf.xacro"
    path.write_text('<robot name="rov"/>')
    with pytest.raises(ModelError, match=r"a xacro is expanded by: xacro FILE > NAME.urdf$"):
        read_vehicle(path)
