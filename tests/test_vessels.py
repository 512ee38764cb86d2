"""What welds and connects hold together is one vessel, by their constraints, in all statics."""

import math

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from buoyancy_mj import (
    Buoyancy,
    BuoyancyWarning,
    ModelError,
    RegularWave,
    Scene,
    Simulation,
    Start,
    Water,
    ballast,
    equilibria,
    equilibrium,
    hydrostatics,
    righting_arm,
)
from buoyancy_mj.engine.checks import check_waves
from buoyancy_mj.hulls.geoms import find_hulls
from buoyancy_mj.inspection.inspection import inspect_model
from buoyancy_mj.inspection.json_report import to_json
from buoyancy_mj.inspection.report import list_sections
from buoyancy_mj.statics.building import build_vessel
from tests import vessels

WELDED = vessels.DATA / "cases" / "welded_hulls" / "weld.xml"
ONE = vessels.DATA / "cases" / "welded_hulls" / "one.xml"
ROOTS = ("port", "starboard", "deck")


def read(path):
    return mujoco.MjModel.from_xml_path(str(path))


def catamaran(equalities, deck="0 0 0.3", extra=""):
    """Two hulls and a deck as three free bodies, held together by equalities."""
    return mujoco.MjModel.from_xml_string(
        f"""<mujoco><worldbody>{extra}
        <body name="port" pos="0 0.5 0"><freejoint/>
          <geom name="p" type="box" size="1 0.1 0.1" mass="40"/></body>
        <body name="starboard" pos="0 -0.5 0"><freejoint/>
          <geom name="s" type="box" size="1 0.1 0.1" mass="40"/></body>
        <body name="deck" pos="{deck}"><freejoint/>
          <geom name="d" type="box" size="0.5 0.6 0.02" mass="30"/></body>
        </worldbody><equality>{equalities}</equality></mujoco>"""
    )


def weld(one, other, relpose=""):
    stated = f'relpose="{relpose}"' if relpose else ""
    return f'<weld body1="{one}" body2="{other}" {stated}/>'


BOTH = weld("port", "deck") + weld("starboard", "deck")


def gaps(model, qpos):
    """Gaps of all equality constraints, as the engine measures them."""
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    mujoco.mj_forward(model, data)
    return data.efc_pos[data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY]


# one vessel


@pytest.mark.parametrize("body", [None, *ROOTS])
def test_welded_hulls_float_as_the_one_body_that_they_are(body):
    one = equilibrium(read(ONE)).hydrostatics
    found = equilibrium(read(WELDED), body=body).hydrostatics
    assert pytest.approx(1.7293560606, rel=1e-9) == found.GM
    for name in ("mass", "volume", "draft", "GMt", "GMl", "heel", "trim", "KB", "KG"):
        assert getattr(found, name) == pytest.approx(getattr(one, name), rel=1e-9, abs=1e-9)
    assert found.stiffness == pytest.approx(one.stiffness, rel=1e-9, abs=1e-6)
    assert found.mass_matrix == pytest.approx(one.mass_matrix, rel=1e-9, abs=1e-9)


def test_welded_hulls_have_the_righting_arms_and_rest_poses_of_the_one_body():
    heels = np.radians([5.0, 30.0, 90.0, 150.0])
    one, welded = read(ONE), read(WELDED)
    arms = [righting_arm(model, heel=heels).gz for model in (one, welded)]
    assert arms[1] == pytest.approx(arms[0], abs=1e-9)
    energies = [[rest.energy for rest in equilibria(model)] for model in (one, welded)]
    assert energies[1] == pytest.approx(energies[0], rel=1e-9)


def test_at_rest_the_welds_hold_and_forces_balance_by_the_engine():
    model = read(WELDED)
    start = [
        *model.qpos0[:3],
        *Rotation.from_euler("xyz", [0.4, 0.2, 1.0]).as_quat(scalar_first=True),
    ]
    rest = equilibrium(model, start=start)
    assert np.abs(gaps(model, rest.qpos)).max() < 1e-12
    data = mujoco.MjData(model)
    data.qpos[:] = rest.qpos
    mujoco.mj_forward(model, data)
    total = Buoyancy(model, damping=None).evaluate(data).total
    assert total.force[2] == pytest.approx(110.0 * 9.81, rel=1e-9)
    assert total.centroid[:2] == pytest.approx(data.subtree_com[0, :2], abs=1e-9)


def test_a_scene_that_starts_at_rest_does_not_tear_the_welds():
    start = Start(position=(1.0, 2.0, 3.0), yaw=0.7, at="equilibrium")
    simulation = Simulation(Scene(title="weld", vehicle=WELDED, start=start, duration=2.0))
    assert np.abs(gaps(simulation.model, simulation.data.qpos)).max() < 1e-12
    frames = list(simulation.frames())
    # welds are soft: they give way by a millimetre, where the hulls swung by 0.29 m
    assert np.ptp([frame.centre_of_mass[2] for frame in frames]) < 3e-3
    assert np.abs(gaps(simulation.model, simulation.data.qpos)).max() < 1e-2
    assert frames[-1].attitude == pytest.approx([0.0, 0.0, 0.7], abs=2e-2)


def test_the_root_that_is_named_gives_the_axes_and_its_pose_takes_the_others_along():
    model = read(WELDED)
    turn = Rotation.from_euler("z", 0.5)
    pose = [3.0, 1.0, 0.25, *turn.as_quat(scalar_first=True)]
    vessel = build_vessel(model, qpos=pose, body="deck")
    assert vessel.name == "deck"
    assert vessel.qpos[14:17] == pytest.approx(pose[:3])
    assert vessel.qpos[:3] == pytest.approx(pose[:3] + turn.apply([0.0, 0.5, -0.3]), abs=1e-12)
    assert np.abs(gaps(model, vessel.qpos)).max() < 1e-12
    assert hydrostatics(model, qpos=pose, body="deck").draft == pytest.approx(0.15)


def test_an_unknown_vessel_is_told_with_all_names():
    with pytest.raises(
        ModelError,
        match=r"^no body 'prot' floats in this model; did you mean 'port'\? "
        r"possible: deck, port, starboard$",
    ):
        hydrostatics(read(WELDED), body="prot")


def test_a_tree_without_hulls_adds_its_mass_and_may_be_named():
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><worldbody>
        <body name="weight" pos="0 0 -1"><freejoint/><inertial pos="0 0 0" mass="60"
          diaginertia="1 1 1"/></body>
        <body name="buoy"><freejoint/><geom type="box" size=".5 .5 .5" mass="90"/></body>
        </worldbody><equality><weld body1="buoy" body2="weight"/></equality></mujoco>"""
    )
    for body in (None, "weight"):
        rest = equilibrium(model, body=body).hydrostatics
        assert (rest.mass, rest.draft) == pytest.approx((150.0, 0.15), rel=1e-9)
        assert pytest.approx(0.5 - 60.0 / 150.0, rel=1e-9) == rest.KG
    assert build_vessel(model).name == "buoy"


# the shape


@given(st.integers(0, 10**6))
@settings(max_examples=25)
def test_the_shape_is_that_which_the_welds_demand_wherever_the_bodies_are_drawn(seed):
    """A chain of boxes by welds, drawn anywhere, against the same boxes as one body."""
    rng = np.random.default_rng(seed)
    # too far apart to overlap
    places = rng.uniform(-0.3, 0.3, (3, 3)) + np.outer(range(3), [2.0, 0.0, 0.0])
    turns = Rotation.random(3, random_state=seed)
    shifts = rng.uniform(-2.0, 2.0, (3, 3))
    # turned by less than half a turn, at which MuJoCo's weld does not know the way
    spins = Rotation.from_rotvec(rng.uniform(-1.0, 1.0, (3, 3)))

    loose, fixed, equalities = "", "", ""
    for i in range(3):
        size = " ".join(map(str, rng.uniform(0.1, 0.4, 3)))
        geom = f'<geom type="box" size="{size}" mass="{rng.uniform(5, 20)}"/>'
        quat = turns[i].as_quat(scalar_first=True)
        fixed += f'<body pos="{row(places[i])}" quat="{row(quat)}">{geom}</body>'
        drawn = (spins[i] * turns[i]).as_quat(scalar_first=True)
        loose += (
            f'<body name="b{i}" pos="{row(places[i] + shifts[i])}" quat="{row(drawn)}">'
            f"<freejoint/>{geom}</body>"
        )
        if i:
            # pose of this body in the frame of the one before
            back = turns[i - 1].inv()
            arm = back.apply(places[i] - places[i - 1])
            relative = (back * turns[i]).as_quat(scalar_first=True)
            equalities += (
                f'<weld body1="b{i - 1}" body2="b{i}" relpose="{row(arm)} {row(relative)}"/>'
            )
    one = mujoco.MjModel.from_xml_string(
        f'<mujoco><worldbody><body name="whole"><freejoint/>{fixed}</body></worldbody></mujoco>'
    )
    many = mujoco.MjModel.from_xml_string(
        f"<mujoco><worldbody>{loose}</worldbody><equality>{equalities}</equality></mujoco>"
    )
    with pytest.warns(BuoyancyWarning, match="^welds and connects hold body 'b"):
        vessel = build_vessel(many)
    assert vessel.freedoms == 0
    assert np.abs(gaps(many, vessel.qpos)).max() < 1e-9
    whole = build_vessel(one)
    assert (vessel.mass, vessel.volume) == pytest.approx((whole.mass, whole.volume), rel=1e-9)
    # what does not depend on the axes
    assert np.linalg.eigvalsh(vessel.inertia) == pytest.approx(
        np.linalg.eigvalsh(whole.inertia), rel=1e-9
    )
    assert np.linalg.norm(vessel.centroid) == pytest.approx(
        np.linalg.norm(whole.centroid), rel=1e-6, abs=1e-9
    )


def row(values):
    return " ".join(repr(float(value)) for value in values)


def test_where_welds_demand_another_shape_than_drawn_it_is_told():
    model = catamaran(
        weld("port", "deck", "0 -0.5 0.2 1 0 0 0") + weld("port", "starboard"), deck="5 5 5"
    )
    with pytest.warns(
        BuoyancyWarning,
        match=r"^welds and connects hold body 'deck' 8\.\d+ m and 0 degrees from where the model "
        r"draws it beside 'port'; statics take it where they hold it$",
    ):
        found = hydrostatics(model)
    assert found.centre_of_gravity == pytest.approx([0.0, 0.0, 0.2 * 30.0 / 110.0], abs=1e-9)
    (vessel,) = inspect_model(model).vessels
    assert vessel.notes[0].startswith("welds and connects hold body 'deck' 8.")


def test_a_turn_that_welds_demand_is_told():
    half = math.sqrt(0.5)
    model = catamaran(weld("deck", "port") + weld("port", "starboard", f"0 -1 0 {half} 0 0 {half}"))
    with pytest.warns(
        BuoyancyWarning,
        match="^welds and connects hold body 'starboard' 0 m and 90 degrees from where",
    ):
        vessel = build_vessel(model)
    assert np.abs(gaps(model, vessel.qpos)).max() < 1e-9


def test_a_loop_within_a_tree_that_is_open_at_its_joint_angles_is_told():
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><worldbody><body name="boat"><freejoint/>
        <geom type="box" size="1 .5 .2" mass="100"/>
        <body name="boom"><joint axis="0 0 1"/><geom type="box" size=".5 .1 .1" mass="1"/></body>
        </body></worldbody>
        <equality><connect name="sheet" body1="boat" body2="boom" anchor=".5 0 0"/></equality>
        </mujoco>"""
    )
    equilibrium(model)
    open_by = math.radians(10.0)
    with pytest.warns(
        BuoyancyWarning,
        match="^connect 'sheet' is open by 0.0868 m or rad at these joint angles, and statics hold "
        "the joints as they are; give angles at which it closes$",
    ):
        hydrostatics(model, qpos=[*model.qpos0[:7], open_by])


def test_a_model_with_sparse_constraints_has_the_same_shape():
    model = read(WELDED)
    model.opt.jacobian = mujoco.mjtJacobian.mjJAC_SPARSE
    model.body_pos[3] += 0.5
    model.qpos0[14:17] += 0.5
    with pytest.warns(BuoyancyWarning, match="hold body 'deck' 0.866 m and 0 degrees"):
        found = hydrostatics(model)
    assert found.GMt == pytest.approx(hydrostatics(read(WELDED)).GMt)


def test_welds_that_contradict_each_other_are_refused_by_name():
    model = catamaran(
        '<weld name="fore" body1="port" body2="deck" relpose="0 -0.5 0.3 1 0 0 0"/>'
        + weld("deck", "port", "0 0.5 -0.5 1 0 0 0")
    )
    with pytest.raises(
        ModelError,
        match=r"^no place of the bodies fits weld 'fore' and the weld of 'deck' to 'port': "
        r"0\.0816 m or rad are left between them; correct relpose or anchor, or draw the bodies "
        r"nearer to where they belong$",
    ):
        hydrostatics(model)


def test_welds_that_differ_by_the_digits_of_mjcf_fit():
    model = catamaran(BOTH + weld("port", "starboard", "0.000001 -1.000002 0 1 0 0.000001 0"))
    assert pytest.approx(1.72936, abs=1e-3) == equilibrium(model).hydrostatics.GM


@pytest.mark.parametrize(
    ("connects", "freedoms"),
    [
        ('<connect body1="starboard" body2="deck" anchor="0 0 0.3"/>', 3),
        (
            '<connect body1="starboard" body2="deck" anchor="0.4 0 0.3"/>'
            '<connect body1="starboard" body2="deck" anchor="-0.4 0 0.3"/>',
            1,
        ),
        (
            '<connect body1="starboard" body2="deck" anchor="0.4 0 0.3"/>'
            '<connect body1="starboard" body2="deck" anchor="-0.4 0 0.3"/>'
            '<connect body1="starboard" body2="deck" anchor="0 0.1 0.3"/>',
            0,
        ),
    ],
)
def test_connects_hold_too_and_what_they_leave_free_is_held_as_drawn_and_told(connects, freedoms):
    model = catamaran(weld("port", "deck") + connects)
    (vessel,) = inspect_model(model).vessels
    assert vessel.vessel.freedoms == freedoms
    assert pytest.approx(1.7293560606, rel=1e-9) == vessel.rest.hydrostatics.GM
    note = (
        f"its connects leave it {freedoms} ways to move within itself; "
        "statics hold it in the shape in which the model draws it"
    )
    assert (note in vessel.notes) == (freedoms > 0)


def test_sites_and_links_on_joints_may_be_welded():
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><worldbody>
        <body name="boat"><freejoint/><geom type="box" size="1 .5 .2" mass="100"/>
          <body name="crane" pos=".5 0 .2"><joint axis="0 0 1" name="slew"/>
            <geom type="capsule" fromto="0 0 0 1 0 0" size=".02" mass="5"/>
            <site name="hook" pos="1 0 0"/></body></body>
        <body name="load" pos="5 5 5"><freejoint/><geom type="sphere" size=".1" mass="9"/>
          <site name="ring" pos="0 0 .1"/></body>
        </worldbody><equality><weld site1="hook" site2="ring"/></equality></mujoco>"""
    )
    slewed = model.qpos0.copy()
    slewed[7] = math.pi / 2
    for qpos, place in ((model.qpos0, [1.5, 0.0, 0.1]), (slewed, [0.5, 1.0, 0.1])):
        with pytest.warns(BuoyancyWarning, match="hold body 'load'"):
            vessel = build_vessel(model, qpos=qpos)
        assert vessel.qpos[8:11] == pytest.approx(place, abs=1e-9)
        assert vessel.qpos[7] == qpos[7]
        assert vessel.mass == pytest.approx(114.0)


# what does not float freely

HELD = [
    (
        '<weld name="dock" body1="deck"/>',
        "body 'deck' is held to the world by weld 'dock' and is not free to float; "
        "leave that out, or set its active='false'",
    ),
    (
        '<connect body1="pier" body2="port" anchor="0 0 0"/>',
        "body 'port' is held to 'pier' by a connect and is not free to float; "
        "leave that out, or set its active='false'",
    ),
    (
        '<weld name="tow" body1="starboard" body2="target"/>',
        "body 'starboard' is held to 'target' by weld 'tow' and is not free to float; "
        "leave that out, or set its active='false'",
    ),
    (
        weld("crane", "deck"),
        "body 'crane' hangs on joints and is not free to float; give it a <freejoint/>",
    ),
]
PIER = (
    '<body name="pier" pos="9 0 0"><geom size=".1"/>'
    '<body name="crane"><joint/><geom size=".1"/></body></body>'
    '<body name="target" mocap="true"><geom size=".1"/></body>'
)


@pytest.mark.parametrize(("equality", "message"), HELD)
def test_a_vessel_that_is_held_to_a_place_is_refused_by_name(equality, message):
    model = catamaran(BOTH + equality, extra=PIER)
    for ask in (
        lambda: equilibrium(model, body="port"),
        lambda: equilibria(model, body="port"),
        lambda: righting_arm(model, body="port"),
        lambda: ballast(model, draft=0.1, body="port"),
    ):
        with pytest.raises(ModelError) as caught:
            ask()
        assert str(caught.value) == message
    # in a pose that is given its hydrostatics are known, and inspect says what holds it
    assert hydrostatics(model, body="port").mass >= 110.0
    found = next(one for one in inspect_model(model).vessels if "port" in one.root_names)
    how = message.split(" and is not free")[0]
    assert found.sentence.startswith(f"{how}: free, it would float with ")


def test_statics_are_those_of_the_first_body_that_floats_freely_not_of_a_crane_before_it():
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><worldbody>
        <body name="pier" pos="6 0 0"><geom type="box" size=".5 2 1" mass="5000"/>
          <body name="crane" pos="0 0 1.2"><joint axis="0 0 1"/>
            <geom type="box" size="2 .1 .1" pos="-2 0 0" mass="500"/></body></body>
        <body name="boat"><freejoint/><geom type="box" size=".5 .3 .1" mass="30"/></body>
        </worldbody></mujoco>"""
    )
    assert equilibrium(model).hydrostatics.draft == pytest.approx(0.05)
    assert hydrostatics(model).mass == pytest.approx(30.0)
    assert len(equilibria(model)) == 2
    assert righting_arm(model, heel=[0.1]).gz[0] > 0.0
    for search in (equilibrium, equilibria):
        with pytest.raises(ModelError, match=r"^body 'crane' hangs on joints and is not free"):
            search(model, body="crane")


def test_a_scene_that_should_start_at_rest_and_is_held_is_refused_by_name(tmp_path):
    path = tmp_path / "moored.xml"
    moored = '<weld name="dock" body1="deck"/></equality>'
    path.write_text(WELDED.read_text().replace("</equality>", moored))
    with pytest.raises(ModelError, match=r"^body 'deck' is held to the world by weld"):
        Simulation(Scene(title="moored", vehicle=path, start=Start(at="equilibrium")))


def test_constraints_that_do_not_act_hold_nothing():
    off = '<weld name="dock" body1="deck" active="false"/>'
    assert equilibrium(catamaran(BOTH + off)).hydrostatics.mass == pytest.approx(110.0)
    model = catamaran(BOTH + '<weld body1="deck"/>')
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_EQUALITY)
    assert equilibrium(model).hydrostatics.mass == pytest.approx(40.0)
    assert equilibrium(model, body="deck").hydrostatics.mass == pytest.approx(30.0)


@pytest.mark.parametrize(
    ("tendon", "told"),
    [('stiffness="10"', True), ('range="0 4" limited="true"', True), ("", False)],
)
def test_what_pulls_at_a_vessel_from_outside_is_told(tendon, told):
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><worldbody><site name="anchor" pos="0 0 -3"/>
        <body name="buoy"><freejoint/><geom size=".5" mass="100"/><site name="eye"/></body>
        </worldbody><tendon><spatial name="mooring" {tendon}><site site="anchor"/>
        <site site="eye"/></spatial></tendon></mujoco>"""
    )
    (vessel,) = inspect_model(model).vessels
    note = "tendon 'mooring' may pull at it in a run; its statics leave that out"
    assert (note in vessel.notes) == told


def test_the_spring_of_a_free_joint_is_told():
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><worldbody><body name="buoy"><joint name="f" type="free" stiffness="3"/>
        <geom size=".5" mass="100"/></body></worldbody></mujoco>"""
    )
    (vessel,) = inspect_model(model).vessels
    assert "the spring of joint 'f' may pull at it in a run; its statics leave that out" in (
        vessel.notes
    )


# inspect, ballast, waves


def test_inspect_reports_one_vessel_with_the_budget_of_each_body():
    found = inspect_model(read(WELDED))
    (vessel,) = found.vessels
    # the draft of 0.1375 m may be rounded either way
    assert vessel.sentence.startswith("floats: 98 kg reserve, draft 0.13")
    assert vessel.sentence.endswith(" m, stable, GM 1.73 m")
    assert [budget.body for budget in vessel.bodies] == list(ROOTS)
    section = next(one for one in list_sections(found) if one.title.startswith("Will"))
    assert section.title == "Will 'port', 'starboard' and 'deck', held together, float?"
    assert section.rows[-1] == ("all", "110", "208", "+98", "+961.4")
    assert "in the frame of 'port', " in section.notes[1]
    assert to_json(found)["floating"][0]["roots"] == list(ROOTS)


def test_welded_hulls_that_overlap_are_told_once():
    model = catamaran(BOTH, deck="0 0 0.1")
    found = inspect_model(model)
    assert [overlap[:2] for overlap in found.overlaps] == [("p", "d"), ("s", "d")]
    assert len(found.vessels) == 1


def test_ballast_of_welded_hulls_brings_them_to_the_wanted_draft():
    spec = mujoco.MjSpec.from_file(str(WELDED))
    box = [[-0.9, -1.2, 0.4], [0.9, 0.2, 0.5]]
    result = ballast(spec.compile(), draft=0.16, heel=0.02, masses=box)
    result.add_to(spec)
    found = equilibrium(spec.compile()).hydrostatics
    assert (found.draft, found.heel, found.trim) == pytest.approx((0.16, 0.02, 0.0), abs=1e-6)


def test_waves_in_which_the_whole_vessel_is_aground_are_refused():
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><worldbody>
        <body name="raft"><freejoint/><geom type="box" size="1 1 1" mass="100"/></body>
        <body name="cargo" pos="0 0 1"><freejoint/><inertial pos="0 0 0" mass="7000"
          diaginertia="1 1 1"/></body></worldbody>
        <equality><weld body1="raft" body2="cargo"/></equality></mujoco>"""
    )
    sea = Water(waves=RegularWave(amplitude=0.01, frequency=1.0, depth=0.5))
    with pytest.raises(
        ModelError,
        match=r"^the waves run in water 0.5 m deep, and body 'raft' has a draft of at least "
        r"0\.592 m in any attitude; make the waves' depth greater$",
    ):
        check_waves(model, sea, find_hulls(model))
    model.eq_active0[0] = 0
    check_waves(model, sea, find_hulls(model))


# against the simulation


@pytest.mark.parametrize("kind", ["weld", "connect"])
def test_it_is_where_the_simulated_vessel_comes_to_rest(kind):
    """Two hulls, a deck and a load to one side, part of whose weight is compensated."""
    stiff = 'solref="0.004 1" solimp="0.999 0.9999 0.001 0.5 2"'
    places = ("0.4 0 0.3", "-0.4 0 0.3", "0 0.1 0.2")
    anchors = [f'anchor="{place}"' for place in places] if kind == "connect" else [""]
    equalities = "".join(
        f'<{kind} body1="{hull}" body2="deck" {anchor} {stiff}/>'
        for hull in ("port", "starboard")
        for anchor in anchors
    )
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><option timestep="0.002" integrator="implicitfast"/><worldbody>
        <body name="port" pos="0 0.5 0"><joint type="free" damping="60"/>
          <geom name="p" type="box" size="1 0.1 0.1" mass="40"/></body>
        <body name="starboard" pos="0 -0.5 0"><joint type="free" damping="60"/>
          <geom name="s" type="box" size="1 0.1 0.1" mass="40"/></body>
        <body name="deck" pos="0 0 0.3"><joint type="free" damping="60"/>
          <geom name="d" type="box" size="0.5 0.6 0.02" mass="30"/>
          <body name="load" pos=".2 .25 .3" gravcomp="0.4"><inertial pos="0 0 0" mass="20"
            diaginertia="0.1 0.1 0.1"/></body></body>
        </worldbody><equality>{equalities}</equality></mujoco>"""
    )
    rest = equilibrium(model)
    assert math.degrees(rest.hydrostatics.heel) == pytest.approx(-0.936, abs=1e-3)
    data = mujoco.MjData(model)
    with Buoyancy(model).installed():
        while data.time < 15.0:
            mujoco.mj_step(model, data)
    for tree in range(3):
        height, quat = 7 * tree + 2, slice(7 * tree + 3, 7 * tree + 6)
        assert data.qpos[height] == pytest.approx(rest.qpos[height], abs=1e-4)
        assert data.qpos[quat] == pytest.approx(rest.qpos[quat], abs=1e-3)
