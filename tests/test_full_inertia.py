"""Added mass of bodies of whose inertia MuJoCo would keep the diagonal alone."""

import re

import mujoco
import numpy as np
import pytest
from typer.testing import CliRunner

from buoyancy_mj import Buoyancy, ModelError, Simulation, Water, add_water, read_scene, water_in
from buoyancy_mj.cli import app
from buoyancy_mj.loads.full_inertia import make_room
from tests import vessels

BOX = """<mujoco><worldbody>
<body name="hull"><freejoint/>{inertial}<geom type="box" size=".25 .15 .1" density="500"/></body>
</worldbody><custom>{custom}</custom></mujoco>"""
GIVEN = '<numeric name="added_mass:hull" data="3 9 14 .2 .5 .4"/>'
DIAGONAL = np.array([3.0, 9.0, 14.0, 0.2, 0.5, 0.4])
INERTIAL = '<inertial pos="0 0 0" mass="15" diaginertia=".2 .4 .5"/>'
JOINTS = {
    "slides": [("slide", "1 0 0"), ("slide", "0 1 0"), ("slide", "0 0 1")],
    "ball": [("ball", "0 0 1")],
    "planar": [("slide", "1 0 0"), ("slide", "0 1 0"), ("hinge", "0 0 1")],
}


def spec_of(inertial="", custom=""):
    return mujoco.MjSpec.from_string(BOX.format(inertial=inertial, custom=custom))


def on_joints(name, simple="auto"):
    joints = "".join(f'<joint type="{kind}" axis="{axis}"/>' for kind, axis in JOINTS[name])
    return mujoco.MjModel.from_xml_string(
        f"""<mujoco><worldbody><body name="hull" simple="{simple}">{joints}
        <geom type="box" size=".25 .15 .1" density="500"/></body></worldbody></mujoco>"""
    )


def full_mass_matrix(model, data):
    full = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, full)
    return full


def rolled(model, seconds=1.0, buoyancy=None):
    """Where a model is after some time from a rolled start that turns."""
    data = mujoco.MjData(model)
    data.qpos[:7] = [0, 0, 0.02, *np.array([1, 0.2, 0.1, 0.05]) / np.sqrt(1.0525)]
    data.qvel[:] = [0.1, 0.2, 0.0, 0.5, 0.4, 0.3]
    steps = round(seconds / model.opt.timestep)
    if buoyancy is None:
        mujoco.mj_step(model, data, steps)
    else:
        with buoyancy.installed():
            mujoco.mj_step(model, data, steps)
    return data.qpos


@pytest.mark.parametrize("inertial", ["", INERTIAL], ids=["inferred", "stated"])
@pytest.mark.parametrize(
    ("custom", "source"), [("", "estimate"), (GIVEN, "model"), (GIVEN, "estimate")]
)
def test_add_water_makes_room_and_leaves_masses_and_inertias_bit_for_bit(inertial, custom, source):
    before = spec_of(inertial, custom).compile()
    assert (before.M_rownnz == 1).all()
    spec = spec_of(inertial, custom)
    add_water(spec, added_mass=source)
    model = spec.compile()
    for name in ("body_mass", "body_inertia", "body_ipos", "body_iquat", "geom_pos"):
        assert np.array_equal(getattr(model, name), getattr(before, name))

    # all of it stands in the mass matrix
    data = mujoco.MjData(model)
    data.qpos[2] = -1.0
    data.qpos[3:7] = np.array([1, 0.2, 0.1, 0.5]) / np.sqrt(1.3)
    mujoco.mj_forward(model, data)
    matrix = water_in(model).added_mass.matrices.reshape(6, 6)
    turn = data.xmat[1].reshape(3, 3)
    body_from_free = np.block([[turn.T, np.zeros((3, 3))], [np.zeros((3, 3)), np.eye(3)]])
    rigid = np.diag([*[model.body_mass[1]] * 3, *model.body_inertia[1]])
    expected = rigid + body_from_free.T @ matrix @ body_from_free
    assert full_mass_matrix(model, data) == pytest.approx(expected, abs=1e-9)


def test_the_room_is_kept_in_saved_files_and_made_once():
    spec = spec_of()
    add_water(spec, added_mass="estimate")
    text = spec.to_xml()
    assert text.count('simple="false"') == 1
    again = mujoco.MjSpec.from_string(text)
    make_room(again, "estimate")
    assert again.to_xml() == text
    assert rolled(mujoco.MjModel.from_xml_string(text)) == pytest.approx(
        rolled(spec.compile()), abs=1e-12
    )


def test_water_without_added_mass_leaves_bodies_as_they_are():
    for source in ("model", "none", None):
        spec = spec_of()
        add_water(spec, added_mass=source)
        assert (spec.compile().M_rownnz == 1).all()
    spec = spec_of(custom=GIVEN)
    add_water(spec, added_mass="none")
    assert (spec.compile().M_rownnz == 1).all()


@pytest.mark.parametrize("when", ["before", "after"])
@pytest.mark.parametrize("source", ["estimate", "model"])
def test_several_vehicles_get_their_room_before_and_after_they_are_attached(when, source):
    spec = mujoco.MjSpec()
    for i in range(2):
        own = spec_of(custom=GIVEN)
        if when == "before":
            add_water(own, added_mass=source)
        frame = spec.worldbody.add_frame(pos=[3.0 * i, 0.0, 0.0])
        spec.attach(own, prefix=f"rov{i}_", frame=frame)
    if when == "after":
        add_water(spec, added_mass=source)
    model = spec.compile()
    assert list(model.M_rownnz) == [1, 2, 3, 4, 5, 6] * 2
    waters = ["sea"] if when == "after" else ["rov0_sea", "rov1_sea"]
    assert sum(len(water_in(model, name).added_mass.bodies) for name in waters) == 2


def test_a_body_that_is_attached_with_a_joint_of_its_own_has_room():
    own = spec_of()
    own.delete(own.body("hull").joints[0])
    add_water(own, added_mass="estimate")
    spec = mujoco.MjSpec()
    frame = spec.worldbody.add_frame()
    frame.attach_body(own.body("hull"), "rov_", "").add_freejoint()
    assert list(spec.compile().M_rownnz) == [1, 2, 3, 4, 5, 6]


def test_motion_is_the_same_with_and_without_the_room():
    # a sphere's added mass fits into the diagonal
    sphere = '<mujoco><worldbody><body name="hull" {}><freejoint/><geom size=".2" mass="17"/>{}'
    end = "</body></worldbody></mujoco>"
    added = {"hull": [8.0, 8.0, 8.0, 0.1, 0.1, 0.1]}
    ends = []
    for simple in ("", 'simple="false"'):
        model = mujoco.MjModel.from_xml_string(sphere.format(simple, end))
        model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
        ends.append(rolled(model, 4.0, Buoyancy(model, added_mass=added)))
    assert ends[1] == pytest.approx(ends[0], abs=1e-9)

    # and without added mass anything does
    free = vessels.of_geoms('<geom type="box" size=".25 .15 .1" density="500"/>')
    spec = spec_of()
    spec.body("hull").simple = False
    room = spec.compile()
    one, other = (rolled(model, 2.0, Buoyancy(model)) for model in (free, room))
    assert other == pytest.approx(one, abs=1e-9)


# scenes and the command line


def write_scene(folder, text="", name="box.xml", **given):
    (folder / name).write_text(BOX.format(inertial="", custom="", **given))
    (folder / "scene.toml").write_text(
        f'title = "A box"\nvehicle = "{name}"\nduration = 0.1\n{text}'
    )
    return folder / "scene.toml"


def test_scenes_and_the_command_line_make_room_and_leave_the_file_alone(tmp_path):
    path = write_scene(tmp_path, 'added_mass = "estimate"\n')
    before = (tmp_path / "box.xml").read_text()
    simulation = Simulation(read_scene(path))
    list(simulation.frames())
    assert len(simulation.buoyancy.added_mass.bodies) == 1
    result = CliRunner().invoke(app, ["run", str(path), "--no-record"])
    assert result.exit_code == 0, result.output
    assert (tmp_path / "box.xml").read_text() == before


def test_a_shift_of_the_centre_of_gravity_reaches_the_mass_matrix(tmp_path):
    path = write_scene(tmp_path, "cog_shift = [0.05, 0.0, -0.02]\n")
    simulation = Simulation(read_scene(path))
    model, data = simulation.model, simulation.data
    data.qpos[3:7] = [1, 0, 0, 0]
    mujoco.mj_forward(model, data)
    # a turn about the origin moves the centre of mass: m (w x r)
    mass, (x, _, z) = model.body_mass[1], model.body_ipos[1]
    coupling = mass * np.array([[0.0, z, 0.0], [-z, 0.0, x], [0.0, -x, 0.0]])
    assert full_mass_matrix(model, data)[:3, 3:] == pytest.approx(coupling, abs=1e-12)


# models that are compiled already


@pytest.mark.parametrize(
    ("joints", "fits", "does_not"),
    [
        ("slides", np.diag([1.0, 2, 3, 0.1, 0.2, 0.3]), np.eye(6) + 0.1 * np.eye(6, k=1)),
        ("ball", np.diag([1.0, 2, 3, 0.1, 0.2, 0.3]), np.eye(6) + 0.1 * np.eye(6)[:, ::-1]),
        ("planar", np.diag([2.0, 2, 2, 0.1, 0.2, 0.3]), np.diag(DIAGONAL)),
    ],
)
def test_what_does_not_fit_into_a_diagonal_is_refused_on_any_joints(joints, fits, does_not):
    does_not = does_not + does_not.T
    if joints == "ball":
        does_not[3, 4] = does_not[4, 3] = 0.1
    assert len(Buoyancy(on_joints(joints), added_mass={"hull": fits}).added_mass.bodies) == 1
    message = (
        "MuJoCo keeps the inertia of body 'hull' as a diagonal, since its centre of mass is its "
        "origin, and its added mass does not fit there; write <body simple='false'>, "
        "or put the water into its MjSpec (add_water)"
    )
    with pytest.raises(ModelError, match=re.escape(message)):
        Buoyancy(on_joints(joints), added_mass={"hull": does_not})
    assert Buoyancy(on_joints(joints, "false"), Water(), added_mass={"hull": does_not})
