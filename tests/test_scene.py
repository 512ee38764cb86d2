import math
import re
import textwrap
from pathlib import Path

import mujoco
import numpy as np
import pytest

from buoyancy_mj import (
    BuoyancyWarning,
    Damping,
    DivergenceError,
    LevelOscillation,
    ModelError,
    RegularWave,
    Scene,
    SceneError,
    Silhouette,
    Simulation,
    read_scene,
)
from buoyancy_mj.scenes import catalog

SCENE = """
title = "A box"
vehicle = "box.xml"
duration = 0.5

[water]
density = 1025.0
[[water.waves]]
amplitude = 0.1
period = 2.0
[[water.waves]]
kind = "level"
amplitude = 0.2
frequency = 0.1
"""
BOX = """<mujoco model="box"><worldbody>
<body name="box">{joint}<geom name="box" type="box" size=".2 .15 .05" mass="4"/>
{more}</body></worldbody>{rest}</mujoco>"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "box.xml").write_text(BOX.format(joint="<freejoint/>", more="", rest=""))
    (tmp_path / "scene.toml").write_text(SCENE)
    return tmp_path


def simulation_of(folder, xml, *settings):
    (folder / "box.xml").write_text(textwrap.dedent(xml))
    return Simulation(read_scene(folder / "scene.toml", settings))


# reading ------------------------------------------------------------------------------------------


def test_a_scene_is_read_into_what_it_says(folder):
    scene = read_scene(folder / "scene.toml")
    assert scene.water.density == 1025.0
    assert scene.water.waves == (RegularWave(0.1, period=2.0), LevelOscillation(0.2, 0.1))
    assert scene.damping == Damping()
    assert (scene.duration, scene.timestep, scene.record_rate) == (0.5, 0.01, 60.0)


@pytest.mark.parametrize(
    ("setting", "look"),
    [
        ("duration=2", lambda s: s.duration == 2.0),
        ("water.level=0.5", lambda s: s.water.level == 0.5),
        ("water.current=[0.1, 0, 0]", lambda s: s.water.current == (0.1, 0.0, 0.0)),
        ("water.waves.0.amplitude=0.3", lambda s: s.water.waves[0].amplitude == 0.3),
        ("water.waves=[]", lambda s: s.water.waves == ()),
        ("start.position=[1, 2, 3]", lambda s: s.start.position == (1.0, 2.0, 3.0)),
        ("start.roll=0.5", lambda s: s.start.roll == 0.5),
        ("damping=false", lambda s: s.damping is None),
        (
            "damping.coefficient=0.8",
            lambda s: s.damping == Damping(viscous=Silhouette(coefficient=0.8)),
        ),
        ("integrator=RK4", lambda s: s.integrator == "RK4"),
        ('geoms=["hull*", "group:2"]', lambda s: s.selection.geoms == ("hull*", "group:2")),
        ("vehicle=sauvc_auv", lambda s: s.vehicle == "sauvc_auv"),
        ("vehicle=sauvc_auv", lambda s: s.title == "sauvc_auv in the scene scene"),
        ("vehicle=sauvc_auv", lambda s: s.stem == "sauvc_auv"),
        ("vehicle=box.xml", lambda s: (s.title, s.stem) == ("A box", "scene")),
    ],
)
def test_any_field_can_be_set(folder, setting, look):
    assert look(read_scene(folder / "scene.toml", [setting]))


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        (
            "durations=2",
            "unknown key 'durations'; did you mean 'duration'? "
            "possible: added_mass, coefficients, cog_shift, control, damping",
        ),
        (
            "water.densty=2",
            "water: unknown key 'densty'; did you mean 'density'? "
            "possible: current, density, level",
        ),
        (
            "water.waves.0.kind=choppy",
            "water.waves.0: unknown kind 'choppy'; "
            "possible: jonswap, level, pierson-moskowitz, regular",
        ),
        (
            "water.waves.5.amplitude=1",
            "cannot set 'water.waves.5': the list has 2 entries, counted from 0",
        ),
        ("water.waves.0.amplitude=nan", "water.waves.0: amplitude is nan; needed is a number"),
        (
            "water.waves.0.frequency=1",
            "give exactly one of frequency [Hz], period [s], wavelength [m]",
        ),
        ("water.waves=3", "water: waves is 3; needed is a list of tables"),
        ("water=3", "water is 3; needed is a table"),
        ("water.density=-1", "density is -1.0; it must be above 0"),
        ("duration=0", "duration is 0.0; it must be at least 1e-06 and at most 1e+06"),
        ("timestep=1e-310", "timestep is 1e-310; it must be at least 1e-07 and at most 1"),
        (
            "water.waves.0.kind=[1]",
            "water.waves.0: unknown kind [1]; possible: jonswap, level, pierson-moskowitz, regular",
        ),
        (
            "water.waves.².amplitude=1",
            "cannot set 'water.waves.²': the list has 2 entries, counted from 0",
        ),
        ("duration=long", "duration is 'long'; needed is a number"),
        ("timestep=true", "timestep is True; needed is a number"),
        ("title=3", "title is 3; needed is a text in quotes"),
        (
            "integrator=RK5",
            "unknown integrator 'RK5'; did you mean 'rk4'? possible: discrete, euler, implicit",
        ),
        ("start.position=[1, 2]", "start: position is [1, 2]; needed is a list of 3 numbers"),
        ("start.position=[1, 2, nan]", "start: position is nan; needed is a number"),
        ("start.roll=inf", "start: roll is inf; it must be a finite number"),
        (
            "damping.coefficient=-1",
            "damping coefficient is -1.0; it must be at least 0 and at most 1e+06",
        ),
        ("geoms=hull", "geoms is 'hull'; needed is a list of words"),
        ("duration", "'duration' is no setting; write KEY=VALUE"),
        ("title.x=3", "cannot set 'title.x': 'title' is 'A box', no table"),
    ],
)
def test_a_setting_that_makes_no_sense_is_reported(folder, setting, message):
    with pytest.raises(SceneError, match=re.escape(message)):
        read_scene(folder / "scene.toml", [setting])


def test_a_missing_key_is_reported(folder):
    (folder / "scene.toml").write_text('title = "x"')
    with pytest.raises(
        SceneError, match="scene 'scene': 'vehicle' is missing; needed is a text in quotes"
    ):
        read_scene(folder / "scene.toml")


def test_a_file_that_is_no_toml_is_reported(folder):
    (folder / "scene.toml").write_text("title = ")
    with pytest.raises(SceneError, match="is no valid TOML"):
        read_scene(folder / "scene.toml")
    with pytest.raises(SceneError, match="cannot read scene"):
        read_scene(folder / "nothing.toml")


def test_an_unknown_scene_is_reported_with_the_nearest():
    with pytest.raises(
        SceneError,
        match=r"there is no scene 'auv_wave', .*; did you mean 'auv_waves'\? "
        "possible: auv_current, auv_drop_still",
    ):
        catalog.scene_path("auv_wave")
    with pytest.raises(SceneError, match="scene '/' is a folder"):
        catalog.scene_path("/")


# vehicles -----------------------------------------------------------------------------------------


def test_a_vehicle_is_found_beside_its_scene(folder, monkeypatch, tmp_path_factory):
    monkeypatch.chdir(tmp_path_factory.mktemp("elsewhere"))
    assert Simulation(read_scene(folder / "scene.toml")).mass == pytest.approx(4.0)


def test_a_missing_vehicle_is_reported(folder):
    with pytest.raises(
        ModelError,
        match=r"there is no vehicle 'bax.xml', neither a file nor one that ships; "
        "possible: bluerov2_heavy",
    ):
        Simulation(read_scene(folder / "scene.toml", ["vehicle=bax.xml"]))


def test_mujocos_own_message_is_kept(folder):
    (folder / "box.xml").write_text("<mujoco><worldbody><bdy/></worldbody></mujoco>")
    with pytest.raises(ModelError, match=r"MuJoCo cannot read '.*box.xml': .*unrecognized element"):
        Simulation(read_scene(folder / "scene.toml"))


def test_a_vehicle_without_a_free_joint_gets_one(folder):
    simulation = simulation_of(
        folder, BOX.format(joint="", more="", rest=""), "start.position=[0, 0, 1]"
    )
    assert simulation.model.jnt_type.tolist() == [mujoco.mjtJoint.mjJNT_FREE]
    assert simulation.data.qpos[:3] == pytest.approx([0.0, 0.0, 1.0])


def test_keyframes_survive_the_free_joint(folder):
    arm = '<body pos=".3 0 0"><joint name="j"/><geom size=".05"/></body>'
    rest = '<keyframe><key name="bent" qpos=".7"/></keyframe>'
    simulation = simulation_of(
        folder,
        BOX.format(joint="", more=arm, rest=rest),
        "start.keyframe=bent",
        "start.position=[1, 2, 3]",
    )
    assert simulation.data.qpos == pytest.approx([1, 2, 3, 1, 0, 0, 0, 0.7])


def test_an_unknown_keyframe_is_reported(folder):
    with pytest.raises(SceneError, match="the vehicle has no keyframe 'bend'; possible: nothing"):
        simulation_of(folder, BOX.format(joint="", more="", rest=""), "start.keyframe=bend")


def test_a_vehicle_on_joints_of_its_own_keeps_them(folder):
    simulation = simulation_of(
        folder, BOX.format(joint='<joint type="slide" axis="0 0 1"/>', more="", rest="")
    )
    assert simulation.model.nv == 1
    for _ in simulation.frames():
        pass


def test_a_start_that_cannot_be_applied_is_reported(folder):
    xml = BOX.format(joint='<joint type="slide" axis="0 0 1"/>', more="", rest="")
    with pytest.warns(
        BuoyancyWarning,
        match="hangs on joints of its own and has no free one; the position, attitude",
    ):
        simulation_of(folder, xml, "start.position=[0, 0, 1]")


def test_several_free_bodies_start_as_one_rigid_body(folder):
    pair = """<mujoco><worldbody><body name="a" pos="1 0 0"><freejoint/><geom size=".1"/></body>
    <body name="b" pos="1 .5 0"><freejoint/><geom size=".1"/></body></worldbody></mujoco>"""
    data = simulation_of(
        folder,
        pair,
        "start.position=[0, 0, 5]",
        f"start.yaw={math.pi / 2}",
        "start.angular_velocity=[0, 0, 2]",
    ).data
    assert data.qpos[:3] == pytest.approx([0.0, 0.0, 5.0])
    assert data.qpos[7:10] == pytest.approx([-0.5, 0.0, 5.0])
    assert data.qvel[6:12] == pytest.approx([0.0, -1.0, 0.0, 0.0, 0.0, 2.0])


def test_a_mocap_body_is_no_vehicle(folder):
    xml = BOX.format(joint="", more="", rest="").replace(
        "<worldbody>", '<worldbody><body name="target" mocap="true"/>'
    )
    simulation = simulation_of(folder, xml, "start.position=[0, 0, 1]")
    assert simulation.data.qpos[:3] == pytest.approx([0.0, 0.0, 1.0])


def test_an_environment_that_does_not_fit_is_reported(folder):
    (folder / "pool.xml").write_text(
        """<mujoco><worldbody><geom type="plane" size="1 1 1"/></worldbody>
        <keyframe><key name="e" qpos="1 2"/></keyframe></mujoco>"""
    )
    with pytest.raises(ModelError, match=r"MuJoCo cannot (join|compile) .*[Kk]eyframe"):
        Simulation(read_scene(folder / "scene.toml", ["environment=pool.xml"]))


def test_the_summary_does_not_depend_on_the_record_rate(folder):
    summaries = []
    for rate in (100, 0.3):
        settings = [
            "start.position=[0, 0, 0.5]",
            "start.roll=0.3",
            "duration=3",
            f"record_rate={rate}",
        ]
        simulation = Simulation(read_scene(folder / "scene.toml", settings))
        list(simulation.frames())
        summaries.append(simulation.summary())
    one, two = (summary.values() for summary in summaries)
    for name in ("peak_draft", "final_draft", "heave_range", "pitch_rms", "peak_load"):
        assert one[name] == pytest.approx(two[name], rel=1e-9, abs=1e-12)


def test_two_bodies_without_joints_are_refused(folder):
    bodies = "<body name='a'><geom size='.1'/></body><body name='b'><geom size='.1'/></body>"
    two = f"<mujoco><worldbody>{bodies}</worldbody></mujoco>"
    with pytest.raises(
        ModelError,
        match=r"has 2 bodies without a joint \('a', 'b'\); give the one that floats a <freejoint/>",
    ):
        simulation_of(folder, two)


def test_geoms_without_a_body_are_refused(folder):
    with pytest.raises(
        ModelError, match="has no body that could float; put the vehicle's geoms into a <body>"
    ):
        simulation_of(folder, "<mujoco><worldbody><geom size='.1'/></worldbody></mujoco>")


def test_a_ground_plane_at_the_water_level_is_left_out_with_a_notice(folder):
    xml = BOX.format(joint="", more="", rest="").replace(
        "<worldbody>", '<worldbody><geom name="ground" type="plane" size="1 1 1"/>'
    )
    with pytest.warns(
        BuoyancyWarning,
        match="ground plane 'ground' at z = 0 m would keep out the water at 0 m and was left out",
    ):
        simulation = simulation_of(folder, xml)
    assert simulation.model.ngeom == 1


@pytest.mark.parametrize(
    "pose", ['pos="0 0 -2"', 'pos="0 5 0.7" euler="90 0 0"', 'pos="0 0 0.7" zaxis="1 0 0"']
)
def test_a_sea_bed_and_walls_stay(folder, pose):
    xml = BOX.format(joint="", more="", rest="").replace(
        "<worldbody>", f'<worldbody><geom name="bed" type="plane" size="1 1 1" {pose}/>'
    )
    assert simulation_of(folder, xml).model.ngeom == 2


def test_a_urdf_floats_too(folder):
    (folder / "box.urdf").write_text(
        """<robot name="r"><link name="base"><inertial><mass value="4"/>
        <inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/></inertial>
        <collision><geometry><box size=".4 .3 .1"/></geometry></collision></link></robot>"""
    )
    simulation = Simulation(
        read_scene(
            folder / "scene.toml",
            ["vehicle=box.urdf", "water.waves=[]", "duration=30", "water.density=1000"],
        )
    )
    *_, last = simulation.frames()
    assert last.draft == pytest.approx(0.1 / 3.0, abs=1e-3)


def test_the_environment_is_attached_under_its_own_prefix(folder):
    (folder / "pool.xml").write_text(
        """<mujoco><worldbody><geom name="box" type="plane" size="1 1 1" pos="0 0 -1"/>
        <body name="buoy" pos="3 0 0"><freejoint/><geom name="buoy" size=".1" mass="1"/></body>
        </worldbody></mujoco>"""
    )
    simulation = Simulation(
        read_scene(folder / "scene.toml", ["environment=pool.xml", "start.position=[0, 0, 0.3]"])
    )
    names = [simulation.model.geom(i).name for i in range(simulation.model.ngeom)]
    assert set(names) == {"box", "environment/box", "environment/buoy"}
    # the start is the vehicle's; the buoy stays and floats
    assert simulation.data.qpos[:3] == pytest.approx([0.0, 0.0, 0.3])
    assert simulation.data.qpos[7:10] == pytest.approx([3.0, 0.0, 0.0])
    assert [hull.name for hull in simulation.buoyancy.hulls] == ["box", "environment/buoy"]
    # and is none of the vehicle's
    list(simulation.frames())
    assert simulation.summary().mass == pytest.approx(4.0)
    assert simulation.summary().displacement == pytest.approx(1025.0 * 0.012)


def test_a_vehicle_a_thousand_times_too_large_is_reported(folder):
    xml = BOX.format(joint="", more="", rest="").replace('size=".2 .15 .05"', 'size="200 100 100"')
    with pytest.raises(
        ModelError,
        match=r"weighs 4 kg and would displace 1.64e\+10 kg of water; "
        "check the scale of its meshes",
    ):
        simulation_of(folder, xml)


@pytest.mark.parametrize("option", ["density='1000'", "viscosity='0.001'"])
def test_mujocos_own_fluid_is_reported_as_double_drag(folder, option):
    xml = BOX.format(joint="", more="", rest=f"<option {option}/>")
    with pytest.warns(
        BuoyancyWarning, match=rf"<option {option}>: MuJoCo's own fluid drag acts as well as ours"
    ):
        simulation_of(folder, xml)


# surroundings -------------------------------------------------------------------------------------

FREE = "<freejoint/>"
STILL = ("water.waves=[]", "water.density=1000")
SURROUNDINGS = {
    "a pier": '<body name="pier" pos="6 0 0"><geom type="box" size=".5 2 1" mass="5000"/></body>',
    "a mocap body": '<body name="goal" mocap="true" pos="5 0 0"><geom size=".3" mass="70"/></body>',
    "a mocap body with a flag": """<body name="goal" mocap="true" pos="5 0 0"><geom size=".3"/>
        <body name="flag" pos="0 0 1"><geom size=".1" mass="9"/></body></body>""",
    "a pier with a crane": """<body name="pier" pos="6 0 0"><geom type="box" size=".5 2 1"/>
        <body name="crane" pos="0 0 2"><joint axis="0 0 1" damping="100"/>
        <inertial pos="0 0 0" mass="30" diaginertia="1 1 1"/></body></body>""",
}


def behind(first, joint=FREE):
    """The box, with something before it in the file."""
    return BOX.format(joint=joint, more="", rest="").replace("<worldbody>", f"<worldbody>{first}")


@pytest.mark.parametrize("first", SURROUNDINGS.values(), ids=SURROUNDINGS)
def test_mass_and_centre_of_gravity_reach_the_vehicle_wherever_surroundings_stand(folder, first):
    settings = ["mass=6", "cog_shift=[0.01, 0.02, -0.03]", "start.position=[0, 0, 0.3]", *STILL]
    simulation = simulation_of(folder, behind(first), *settings)
    model = simulation.model
    assert simulation.vehicle.name == "box"
    assert simulation.mass == pytest.approx(6.0)
    assert model.body("box").mass == pytest.approx(6.0)
    assert model.body("box").ipos == pytest.approx([0.01, 0.02, -0.03])
    assert simulation.vehicle.root == model.body("box").id
    frame = next(simulation.frames())
    assert frame.centre_of_mass == pytest.approx([0.01, 0.02, 0.27])
    assert frame.draft == pytest.approx(-0.25)
    for name in ("pier", "goal", "flag", "crane"):
        if f'"{name}"' in first:
            alone = mujoco.MjModel.from_xml_string(behind(first))
            assert model.body(name).mass == alone.body(name).mass


def test_the_boat_behind_a_pier_floats_at_the_draft_of_its_own_mass():
    file = Path(__file__).parent / "data" / "pier" / "harbour.xml"
    scene = Scene(title="pier", vehicle=str(file), mass=10.0, duration=20.0)
    simulation = Simulation(scene)
    list(simulation.frames())
    summary = simulation.summary()
    assert summary.mass == pytest.approx(10.0)
    assert summary.net_weight == pytest.approx(-6.0 * 9.81)
    assert summary.final_draft == pytest.approx(0.125, abs=2e-3)


def test_a_static_body_among_others_gets_no_free_joint_where_one_has_it(folder):
    simulation = simulation_of(folder, behind(SURROUNDINGS["a pier"]))
    assert simulation.model.njnt == 1
    with pytest.raises(
        ModelError,
        match=r"has 2 bodies without a joint \('pier', 'box'\); give the one that floats",
    ):
        simulation_of(folder, behind(SURROUNDINGS["a pier"], joint=""))


def test_each_of_several_free_bodies_is_a_vehicle_of_its_own(folder):
    buoy = '<body name="buoy" pos="2 0 0"><freejoint/><geom size=".2" mass="10"/></body>'
    simulation = simulation_of(folder, behind(buoy), "start.position=[2, 0, 0]", *STILL)
    list(simulation.frames())
    summary = simulation.summary()
    assert {name: one.mass for name, one in summary.vehicles.items()} == pytest.approx(
        {"buoy": 10.0, "box": 4.0}
    )
    assert summary.vehicles["box"].displacement == pytest.approx(12.0)
    with pytest.raises(
        SceneError,
        match=re.escape(
            "cog_shift does not say which of 2 floating bodies of 'box.xml' it shifts "
            "('buoy', 'box'); put each into a file of its own, and these under [[vehicles]]"
        ),
    ):
        simulation_of(folder, behind(buoy), "cog_shift.2=0.1")


def test_bodies_that_a_weld_holds_together_are_one_vehicle(folder):
    deck = '<body name="deck" pos="0 0 .1"><freejoint/><geom size=".05" mass="1"/></body>'
    xml = behind(deck).replace(
        "</mujoco>", '<equality><weld body1="deck" body2="box"/></equality></mujoco>'
    )
    simulation = simulation_of(folder, xml, "mass=10")
    assert simulation.mass == pytest.approx(10.0)
    assert len(simulation.hulls) == 2


def test_what_hangs_on_a_pier_keeps_its_mass_beside_what_floats_freely(folder):
    crane = SURROUNDINGS["a pier with a crane"].replace(
        '<inertial pos="0 0 0" mass="30" diaginertia="1 1 1"/>', '<geom size=".1" mass="30"/>'
    )
    simulation = simulation_of(folder, behind(crane), "mass=6", "start.at=equilibrium", *STILL)
    assert simulation.vehicles["crane"].mass == pytest.approx(30.0)
    assert simulation.vehicles["box"].mass == pytest.approx(6.0)
    assert simulation.data.qpos[3] == pytest.approx(0.0, abs=1e-3)


def test_a_vehicle_that_displaces_nothing_is_refused(folder):
    buoy = '<body name="buoy" pos="2 0 0"><freejoint/><geom name="ball" size=".2"/></body>'
    (folder / "pool.xml").write_text(f"<mujoco><worldbody>{buoy}</worldbody></mujoco>")
    settings = ["environment=pool.xml", 'geoms=["environment/*"]']
    with pytest.raises(
        ModelError,
        match=re.escape("the vehicle displaces no water; choose geoms of its own (--geoms)"),
    ):
        Simulation(read_scene(folder / "scene.toml", settings))


# running ------------------------------------------------------------------------------------------


def test_frames_come_at_the_record_rate(folder):
    simulation = Simulation(read_scene(folder / "scene.toml", ["duration=1", "record_rate=20"]))
    times = [frame.time for frame in simulation.frames()]
    assert times == pytest.approx(np.linspace(0.0, 1.0, 21), abs=1e-9)


def test_a_frame_holds_the_state_at_its_own_time(folder):
    simulation = Simulation(
        read_scene(
            folder / "scene.toml", ["start.position=[0, 0, 1]", "duration=0.2", "water.waves=[]"]
        )
    )
    for frame in simulation.frames():
        # symplectic free fall: z = z0 - g h^2 n (n + 1) / 2
        n = round(frame.time / 0.01)
        assert frame.data.xpos[1, 2] == pytest.approx(1.0 - 9.81e-4 * n * (n + 1) / 2.0, abs=1e-9)
        assert frame.draft == pytest.approx(0.05 - frame.data.xpos[1, 2], abs=1e-9)


def test_the_frames_attitude_is_roll_pitch_yaw(folder):
    scene = read_scene(
        folder / "scene.toml", ["start.roll=0.3", "start.pitch=-0.2", "start.yaw=1.1"]
    )
    first = next(iter(Simulation(scene).frames()))
    assert first.attitude == pytest.approx([0.3, -0.2, 1.1])


def test_energy_of_a_frame_is_kept_without_drag(folder):
    settings = [
        "damping=false",
        "water.waves=[]",
        "start.position=[0,0,0.2]",
        "start.roll=0.4",
        "duration=4",
        "integrator=RK4",
        "timestep=0.002",
    ]
    totals = [
        frame.energy.total
        for frame in Simulation(read_scene(folder / "scene.toml", settings)).frames()
    ]
    assert np.ptp(totals) < 1e-3 * 4.0 * 9.81 * 0.2


def test_the_summary_says_what_happened(folder):
    settings = ["water.waves=[]", "duration=20", "water.density=1000"]
    simulation = Simulation(read_scene(folder / "scene.toml", settings))
    list(simulation.frames())
    summary = simulation.summary()
    assert summary.mass == pytest.approx(4.0)
    assert summary.displacement == pytest.approx(12.0)
    assert summary.net_weight == pytest.approx(-8.0 * 9.81)
    assert summary.final_draft == pytest.approx(0.1 / 3.0, abs=1e-3)
    assert summary.seakeeping.heave.range < 0.01
    assert summary.simulated_time == pytest.approx(20.0)
    assert summary.real_time_factor > 1.0
    assert (summary.contact_steps, summary.first_contact) == (0, None)


def test_touching_the_bottom_is_counted(folder):
    (folder / "pool.xml").write_text(
        '<mujoco><worldbody><geom type="plane" size="1 1 1" pos="0 0 -.3"/></worldbody></mujoco>'
    )
    settings = ["environment=pool.xml", "start.position=[0,0,-0.24]", "start.velocity=[0,0,-2]"]
    simulation = Simulation(read_scene(folder / "scene.toml", settings))
    list(simulation.frames())
    assert simulation.summary().contact_steps > 0
    assert simulation.summary().first_contact == pytest.approx(0.01, abs=0.011)


def test_a_diverging_simulation_is_reported_with_time_body_and_quantity(folder):
    (folder / "box.xml").write_text(BOX.format(joint="<freejoint/>", more="", rest=""))
    simulation = Simulation(read_scene(folder / "scene.toml"))
    frames = simulation.frames()
    next(frames)
    simulation.data.qvel[2] = 1e12
    with pytest.raises(
        DivergenceError,
        match=r"the simulation diverged at .* s: the velocity of body 'box' is not a finite",
    ):
        list(frames)


def test_a_steep_simulation_that_runs_away_is_reported(folder):
    # an undamped explicit step far beyond its stability limit
    simulation = simulation_of(
        folder,
        BOX.format(joint='<joint type="slide" axis="0 0 1" stiffness="1e9"/>', more="", rest=""),
        "integrator=Euler",
        "duration=5",
        "start.position=[0,0,0]",
    )
    simulation.data.qpos[0] = 0.1
    with pytest.raises(
        DivergenceError,
        match=r"of body 'box' is not a finite, sensible number; try a smaller timestep",
    ):
        list(simulation.frames())


@pytest.mark.parametrize("scene", ["auv_sea_state_2", "hourglass_drop_waves", "auv_drop_still"])
def test_the_draft_is_the_depth_of_the_deepest_of_all_vertices(scene):
    simulation = Simulation(read_scene(catalog.scenes()[scene]))
    data, water = simulation.data, simulation.scene.water
    rng = np.random.default_rng(0)
    for time in rng.uniform(0.0, 60.0, 8):
        data.time = time
        data.qpos[:7] = [*rng.uniform(-9.0, 9.0, 2), rng.uniform(-1.0, 0.5), *rng.normal(size=4)]
        frame = simulation.frame()
        depths = [
            water.depth(
                hull.mesh.vertices @ frame.data.geom_xmat[hull.geom].reshape(3, 3).T
                + frame.data.geom_xpos[hull.geom],
                time,
            ).max()
            for hull in simulation.hulls
        ]
        assert frame.draft == pytest.approx(max(depths), abs=1e-9)


def run_of(folder, *settings):
    (folder / "floor.xml").write_text(
        """<mujoco><worldbody>
        <geom name="bed" type="box" size="2 2 .1" pos="0 0 -3.1"/></worldbody></mujoco>"""
    )
    simulation = Simulation(read_scene(folder / "scene.toml", [*settings, *STILL]))
    list(simulation.frames())
    return simulation.summary()


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        (
            ["start.velocity=[2e6, 0, 0]"],
            "the simulation diverged at 0 s: body 'box' moves at 2e+06 m/s (more than 1,000); "
            "try a smaller timestep (now 0.01 s) or another integrator (now implicitfast)",
        ),
        (
            ["start.velocity=[900, 0, 0]", "duration=200", "timestep=0.1", "damping=false"],
            "s: body 'box' is 1e+05 m from its start (more than 100,000); try a smaller timestep",
        ),
        (
            [
                "environment=floor.xml",
                "start.velocity=[0, 0, -900]",
                "start.position.2=-1",
                "damping=false",
            ],
            "the simulation diverged at 0.01 s: body 'box' has gone through the bottom, "
            "to z = -9.998 m; try a smaller timestep (now 0.01 s)",
        ),
    ],
)
def test_speeds_and_places_beyond_reason_end_a_run(folder, settings, message):
    with pytest.raises(DivergenceError, match=re.escape(message)):
        run_of(folder, *settings)


@pytest.mark.parametrize(
    "settings",
    [
        # beside the floor, and over its edge
        ["start.position=[5, 0, -1]", "mass=30"],
        ["start.position=[1.9, 0, -1]", "start.velocity=[5, 0, 0]", "mass=30"],
        # from below, though as deep
        ["start.position=[0, 0, -5]", "start.velocity=[0, 0, -5]", "mass=30"],
        # fast, but not absurdly
        ["start.position=[0, 0, 9]", "start.velocity=[900, 0, 0]", "duration=0.1"],
    ],
)
def test_who_never_was_over_the_floor_or_left_it_by_its_edge_may_sink(folder, settings):
    summary = run_of(folder, "environment=floor.xml", "duration=3", "damping=false", *settings)
    assert summary.peak_draft > 3.5 or summary.simulated_time == pytest.approx(0.1)


def test_a_body_that_can_touch_nothing_is_told_why_it_went_through_the_bottom(folder):
    text = BOX.format(joint=FREE, more="", rest="").replace(
        'type="box"', 'type="box" contype="0" conaffinity="0"'
    )
    (folder / "box.xml").write_text(text)
    settings = ["environment=floor.xml", "mass=40", "start.position.2=-2", "duration=9"]
    with pytest.raises(
        DivergenceError,
        match=r"^the simulation diverged at .* s: body 'box' has gone through the bottom, to z = "
        r"-3\.4.* m; none of its geoms can touch it, so give one contype and conaffinity of 1$",
    ):
        run_of(folder, *settings)


def test_a_part_that_hangs_through_the_bottom_does_not_end_a_run(folder):
    # the propeller touches nothing, and turns below the floor on which the hull lies
    propeller = """<body name="propeller" pos="0 0 -.6"><joint axis="0 0 1"/>
        <geom size=".05" mass=".1" contype="0" conaffinity="0"/></body>"""
    (folder / "box.xml").write_text(BOX.format(joint=FREE, more=propeller, rest=""))
    summary = run_of(
        folder, "environment=floor.xml", "mass=40", "start.position.2=-2.8", "duration=2"
    )
    assert summary.contact_steps > 10
    assert summary.final_draft > 3.4


def test_the_limits_hold_for_what_floats_in_the_environment_too(folder):
    (folder / "pool.xml").write_text(
        """<mujoco><worldbody><body name="buoy" pos="3 0 0"><freejoint/><geom size=".1"/></body>
        </worldbody></mujoco>"""
    )
    simulation = Simulation(read_scene(folder / "scene.toml", ["environment=pool.xml"]))
    simulation.data.qpos[7] = 1e7
    with pytest.raises(
        DivergenceError, match="body 'environment/buoy' is 1e\\+07 m from its start"
    ):
        simulation.step()


def test_a_body_may_be_set_elsewhere_between_steps(folder):
    simulation = Simulation(read_scene(folder / "scene.toml"))
    for x in (0.0, 500.0):
        simulation.data.qpos[0] = x
        simulation.step()
    assert simulation.data.qpos[0] == pytest.approx(500.0, abs=1.0)


@pytest.mark.parametrize(
    "name", sorted(name for name in catalog.scenes() if not name.startswith("sauvc"))
)
def test_every_scene_that_ships_runs(name):
    # to its end; frames take as long as steps, and test_sauvc_scenes runs those with a mission
    simulation = Simulation(read_scene(catalog.scenes()[name], ["record_rate=5"]))
    frames = [
        (frame.time, *vehicle.centre_of_mass, vehicle.energy.total)
        for frame in simulation.frames()
        for vehicle in frame.vehicles.values()
    ]
    assert np.isfinite(frames).all()
    summary = simulation.summary()
    assert summary.simulated_time == pytest.approx(simulation.scene.duration)
    for vehicle in summary.vehicles.values():
        # all float, but the ROV in fresh water
        assert (vehicle.net_weight < 0.0) == (not name.startswith("bluerov2_heavy"))
        assert math.isfinite(vehicle.seakeeping.heave.range)


def test_the_source_papers_scenes_keep_its_numbers():
    for name in ("hourglass_drop_still", "hourglass_drop_waves"):
        scene = read_scene(catalog.scenes()[name])
        assert (scene.duration, scene.timestep) == (5.0, 0.01)
    (wave,) = scene.water.waves
    assert (wave.amplitude, wave.frequency) == (0.3, 0.5)


def test_the_pool_has_the_depths_of_the_rulebook():
    scene = read_scene(catalog.scenes()["auv_pool"])
    model, data = Simulation(scene).model, Simulation(scene).data
    mujoco.mj_forward(model, data)
    hit = np.zeros(1, np.int32)
    for x, depth in ((-12.45, 1.2), (0.05, 1.6), (12.45, 1.2), (6.25, 1.4)):
        start = np.array([x, 5.0, 0.0])
        found = mujoco.mj_ray(
            model, data, start, np.array([0.0, 0.0, -1.0]), None, 1, -1, hit, None
        )
        assert found == pytest.approx(depth, abs=3e-3)
    for direction, distance in (
        ([1, 0, 0], 12.5),
        ([-1, 0, 0], 12.5),
        ([0, 1, 0], 8.0),
        ([0, -1, 0], 8.0),
    ):
        found = mujoco.mj_ray(
            model,
            data,
            np.array([0.0, 0.0, -0.6]),
            np.array(direction, float),
            None,
            1,
            -1,
            hit,
            None,
        )
        assert found == pytest.approx(distance, abs=1e-6)


def test_the_auv_touches_the_bottom_of_the_pool_and_comes_up():
    simulation = Simulation(read_scene(catalog.scenes()["auv_pool"]))
    *_, last = simulation.frames()
    assert simulation.summary().contact_steps > 0
    assert last.draft < 0.6
