"""Several vehicles in one scene: names, starts, masses, and what each of them has of its own."""

import json
import math
import re
import shlex

import mujoco
import numpy as np
import pytest
from typer.testing import CliRunner

from buoyancy_mj import (
    BuoyancyWarning,
    ModelError,
    Scene,
    SceneError,
    SceneVehicle,
    Simulation,
    Start,
    read_scene,
)
from buoyancy_mj.cli import app
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.ranges import grid, parse_range
from buoyancy_mj.scenes.scene import scene_from_table
from buoyancy_mj.scenes.sweep import Sweep

BOX = """<mujoco model="box">{options}<worldbody><body name="box">
<freejoint/><geom name="hull" type="box" size=".2 .15 .05" mass="4"/>{more}</body></worldbody>{rest}
</mujoco>"""
ARM = """<body name="arm" pos="0 0 .2"><joint name="hinge" axis="1 0 0"{}/>
<geom size=".03" mass=".2"/></body>"""
SCENE = """
title = "Two boxes"
duration = 1.0
damping = false

[[vehicles]]
model = "box.xml"
name = "one"

[[vehicles]]
model = "box.xml"
name = "two"
start = { position = [3.0, 0.0, 0.2], roll = 0.4 }
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "box.xml").write_text(BOX.format(options="", more="", rest=""))
    (tmp_path / "scene.toml").write_text(SCENE)
    return tmp_path


def simulation_of(folder, *settings):
    return Simulation(read_scene(folder / "scene.toml", settings))


def write(folder, name, options="", more="", rest=""):
    (folder / name).write_text(BOX.format(options=options, more=more, rest=rest))


# the scene ----------------------------------------------------------------------------------------


def test_each_vehicle_is_read_with_all_that_it_may_say():
    table = {
        "title": "t",
        "vehicles": [
            {"model": "a.xml", "name": "first", "mass": 3, "cog_shift": [0, 0, 1]},
            {"model": "b.xml", "start": {"at": "equilibrium", "roll": 1}},
        ],
    }
    first, second = scene_from_table(table).vehicles
    assert (first.model, first.name, first.mass) == ("a.xml", "first", 3.0)
    assert first.cog_shift == (0.0, 0.0, 1.0)
    assert (second.name, second.start) == ("b", Start(at="equilibrium", roll=1.0))


def test_vehicles_without_a_name_take_that_of_their_file_numbered_where_it_comes_again():
    models = ("sauvc_auv", "hourglass", "sauvc_auv", "my boat.v2.xml")
    scene = Scene(title="t", vehicles=[SceneVehicle(model=model) for model in models])
    names = [vehicle.name for vehicle in scene.vehicles]
    assert names == ["sauvc_auv_1", "hourglass", "sauvc_auv_2", "my_boat_v2"]


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        (
            ["vehicles.0.name=a/b"],
            "scene 'scene': vehicles.0: name is 'a/b'; it must be of letters, digits, '_' and '-', "
            "and not empty",
        ),
        (
            ["vehicles.0.name=two"],
            "scene 'scene': two vehicles are called 'two'; give one of them another name",
        ),
        (
            ["vehicles.1.name=environment"],
            "scene 'scene': a vehicle is called 'environment', as the surroundings are; "
            "give it another name",
        ),
        (
            ["vehicles.0.nme=x"],
            "scene 'scene': vehicles.0: unknown key 'nme'; did you mean 'name'? possible: "
            "coefficients, cog_shift, mass, model, name, start",
        ),
        (
            ["vehicles.1.mass=-1"],
            "scene 'scene': vehicles.1: mass is -1.0; it must be above 0",
        ),
        (
            ["vehicles.1.start.rol=1"],
            "scene 'scene': vehicles.1: start: unknown key 'rol'; did you mean 'roll'?",
        ),
        (
            ["vehicle=hourglass"],
            "scene 'scene': vehicle is 'hourglass' beside [[vehicles]] (box.xml, box.xml); leave "
            "one of the two out, or put another model in the place of one, as vehicles.0.model",
        ),
        (
            ["mass=3"],
            "scene 'scene': mass is given beside [[vehicles]]; give it to one of them, "
            "as vehicles.0.mass",
        ),
        (
            ["start.roll=3"],
            "scene 'scene': start is given beside [[vehicles]]; give it to one of them, "
            "as vehicles.0.start",
        ),
        (
            ["vehicles=[]"],
            "scene 'scene': 'vehicle' is missing; needed is a text in quotes, or several tables "
            "[[vehicles]]",
        ),
        (
            ["vehicles=3"],
            "scene 'scene': vehicles is 3; needed is a list of tables [[vehicles]]",
        ),
        (["vehicles=[3]"], "scene 'scene': vehicles.0 is 3; needed is a table"),
        (
            ["vehicles.2.mass=9"],
            "cannot set 'vehicles.2': the list has 2 entries, counted from 0",
        ),
    ],
)
def test_vehicles_that_make_no_sense_are_reported(folder, settings, message):
    with pytest.raises(SceneError, match="^" + re.escape(message)):
        read_scene(folder / "scene.toml", settings)


def test_vehicles_of_another_kind_are_reported():
    with pytest.raises(
        SceneError,
        match=re.escape(
            "vehicles holds 'hourglass'; each must be a SceneVehicle, as "
            "SceneVehicle(model='sauvc_auv')"
        ),
    ):
        Scene(title="t", vehicles=["hourglass"])


# the model ----------------------------------------------------------------------------------------


def test_each_vehicle_is_attached_under_its_name_and_starts_where_it_should(folder):
    simulation = simulation_of(
        folder, "vehicles.0.start.velocity.1=0.5", "vehicles.1.start.position.2=0.7"
    )
    model, data = simulation.model, simulation.data
    assert [model.body(i).name for i in range(1, model.nbody)] == ["one/box", "two/box"]
    assert data.qpos[:3] == pytest.approx([0.0, 0.0, 0.0])
    assert data.qpos[7:10] == pytest.approx([3.0, 0.0, 0.7])
    assert data.qvel[:3] == pytest.approx([0.0, 0.5, 0.0])
    assert list(simulation.vehicles) == ["one", "two"]
    frame = next(simulation.frames())
    assert frame.vehicles["two"].attitude == pytest.approx([0.4, 0.0, 0.0])
    assert frame.vehicles["two"].centre_of_mass == pytest.approx([3.0, 0.0, 0.7])


def test_mass_and_centre_of_gravity_of_one_leave_the_other_alone(folder):
    simulation = simulation_of(folder, "vehicles.1.mass=6", "vehicles.1.cog_shift.0=0.02")
    one, two = simulation.vehicles.values()
    assert (one.mass, two.mass) == pytest.approx((4.0, 6.0))
    assert two.weight == pytest.approx(6.0 * 9.81)
    assert simulation.model.body("one/box").ipos == pytest.approx([0.0, 0.0, 0.0])
    assert simulation.model.body("two/box").ipos == pytest.approx([0.02, 0.0, 0.0])


def test_each_vehicle_moves_as_it_does_alone(folder):
    waves = "water.waves=[{amplitude=0.1, period=2.0}]"
    settings = [waves, "damping=true", "pressure=froude-krylov"]
    together = simulation_of(folder, *settings)
    *_, last = together.frames()
    for entry in together.scene.vehicles:
        (folder / "alone.toml").write_text('title = "t"\nduration = 1.0\nvehicle = "box.xml"\n')
        x, y, z = entry.start.position
        start = [f"start.position=[{x}, {y}, {z}]", f"start.roll={entry.start.roll}"]
        *_, alone = Simulation(read_scene(folder / "alone.toml", [*settings, *start])).frames()
        one = last.vehicles[entry.name]
        assert one.centre_of_mass == pytest.approx(alone.centre_of_mass, abs=1e-9)
        assert one.attitude == pytest.approx(alone.attitude, abs=1e-9)
        assert one.draft == pytest.approx(alone.draft, abs=1e-9)
        assert one.energy.total == pytest.approx(alone.energy.total, abs=1e-7)


def test_each_vehicle_keeps_what_its_file_says_of_its_added_mass_and_drag():
    first = SceneVehicle(model="bluerov2_heavy", name="first", start=Start(position=(0, 0, -1)))
    start = Start(position=(5.0, 0.0, -2.0), pitch=0.3, keyframe="ahead")
    second = SceneVehicle(model="bluerov2_heavy", name="second", start=start)
    other = SceneVehicle(model="sauvc_auv", start=Start(position=(9.0, 0.0, -1.0)))
    together = Simulation(Scene(title="t", vehicles=(first, second, other), duration=0.5))
    alone = Simulation(Scene(title="t", vehicle="bluerov2_heavy", start=start, duration=0.5))
    assert together.vehicles["second"].displacement == pytest.approx(alone.displacement, rel=1e-12)
    *_, last = together.frames()
    *_, wanted = alone.frames()
    one = last.vehicles["second"]
    assert one.centre_of_mass == pytest.approx(wanted.centre_of_mass, abs=1e-12)
    assert one.attitude == pytest.approx(wanted.attitude, abs=1e-12)
    assert one.energy.total == pytest.approx(wanted.energy.total, rel=1e-9)
    assert one.forces["drag"] == pytest.approx(wanted.loads.by_cause["drag"][1, :3], rel=1e-9)


URDF = """<robot name="r"><link name="base"><inertial><mass value="4"/>
<inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><box size=".4 .3 .1"/></geometry></collision></link></robot>"""
FUSED = """<mujoco><compiler fusestatic="true"/><worldbody>
<body name="pier" pos="9 9 0"><geom size=".3"/></body>
<body name="boat"><freejoint/><geom type="box" size=".2 .1 .1" mass="7"/>
<body name="mast" pos="0 0 .3"><geom type="box" size=".01 .01 .1" mass="1"/></body>
<body name="fin" pos="-.3 0 0"><joint name="fin"/><geom size=".02" mass=".1"/></body></body>
</worldbody><actuator><motor joint="fin"/></actuator></mujoco>"""
BUOYS = """<mujoco><worldbody><replicate count="2" offset="1 0 0">
<body name="buoy" pos="0 5 0"><freejoint/><geom size=".2" mass="10"/></body></replicate>
</worldbody></mujoco>"""


def test_files_of_all_kinds_stand_side_by_side(folder):
    for name, text in (("robot.urdf", URDF), ("fused.xml", FUSED), ("buoys.xml", BUOYS)):
        (folder / name).write_text(text)
    vehicles = [
        SceneVehicle(model=model, start=Start(position=(4.0 * i, 0.0, 0.0)), mass=5.0 + i)
        for i, model in enumerate(("fused.xml", "robot.urdf", "buoys.xml", "box.xml"))
    ]
    simulation = Simulation(Scene(title="t", vehicles=vehicles, folder=folder, duration=0.1))
    found = {name: vehicle.mass for name, vehicle in simulation.vehicles.items()}
    assert found == pytest.approx(
        {"fused": 5.0, "robot": 6.0, "buoys/buoy0": 3.5, "buoys/buoy1": 3.5, "box": 8.0}
    )
    frame = next(simulation.frames())
    places = [frame.data.xpos[vehicle.root, 0] for vehicle in simulation.vehicles.values()]
    assert places == pytest.approx([0.0, 4.0, 8.0, 9.0, 12.0])


def test_keyframes_and_controls_are_each_vehicles_own(folder):
    more = ARM.format("")
    rest = """<actuator><motor joint="hinge"/></actuator>
    <keyframe><key name="bent" qpos="0 0 9 1 0 0 0 .7" ctrl="0.01"/></keyframe>"""
    write(folder, "arm.xml", more=more, rest=rest)
    settings = ["vehicles.0.model=arm.xml", "vehicles.1.model=arm.xml"]
    simulation = simulation_of(folder, *settings, "vehicles.1.start.keyframe=bent")
    assert simulation.data.qpos[7] == 0.0
    assert simulation.data.qpos[8:] == pytest.approx(
        [3.0, 0.0, 0.2, math.cos(0.2), math.sin(0.2), 0.0, 0.0, 0.7]
    )
    assert simulation.data.ctrl == pytest.approx([0.0, 0.01])
    with pytest.raises(
        SceneError,
        match=r"start: vehicle 'one' has no keyframe 'bend'; did you mean 'bent'\? possible: bent",
    ):
        simulation_of(folder, *settings, "vehicles.0.start.keyframe=bend")


def test_each_may_start_at_rest(folder):
    settings = ["water.density=1000", "vehicles.1.start.at=equilibrium"]
    data = simulation_of(folder, *settings).data
    # 4 kg on 0.12 m^2: a draft of a third of its height
    assert data.qpos[9] == pytest.approx(0.05 - 0.1 / 3.0, abs=1e-6)
    assert data.qpos[2] == 0.0


def test_vehicles_keep_their_places_beside_an_environment(folder):
    (folder / "pool.xml").write_text(
        """<mujoco><worldbody><geom type="plane" size="1 1 1" pos="0 0 -3"/>
        <body name="buoy" pos="9 0 0"><freejoint/><geom size=".1" mass="1"/></body>
        </worldbody></mujoco>"""
    )
    simulation = simulation_of(folder, "environment=pool.xml")
    assert list(simulation.vehicles) == ["one", "two"]
    assert simulation.data.qpos[14:17] == pytest.approx([9.0, 0.0, 0.0])
    assert len(simulation.buoyancy.hulls) == 3


def test_options_of_the_first_hold_for_all_and_that_is_told(folder):
    write(folder, "moon.xml", options='<option gravity="0 0 -1.62" cone="elliptic" timestep=".1"/>')
    with pytest.warns(
        BuoyancyWarning,
        match=re.escape(
            "vehicle 'two' sets other options than the first vehicle (cone, gravity); "
            "those of the first hold for all"
        ),
    ):
        simulation = simulation_of(folder, "vehicles.1.model=moon.xml")
    assert simulation.model.opt.gravity[2] == -9.81
    with pytest.warns(BuoyancyWarning, match="vehicle 'two' sets other options"):
        simulation = simulation_of(folder, "vehicles.0.model=moon.xml")
    assert simulation.model.opt.gravity[2] == -1.62
    assert simulation.vehicles["two"].weight == pytest.approx(4.0 * 1.62)


def test_a_total_mass_that_would_be_lost_is_refused(folder):
    write(folder, "heavy.xml", options='<compiler settotalmass="9"/>')
    with pytest.raises(
        ModelError,
        match=r"heavy.xml' sets <compiler settotalmass>, which MuJoCo drops where it joins models; "
        "give vehicle 'two' its mass in the scene instead",
    ):
        simulation_of(folder, "vehicles.1.model=heavy.xml")


def test_a_vehicle_of_the_wrong_scale_is_named(folder):
    text = (folder / "box.xml").read_text().replace('size=".2 .15 .05"', 'size="200 100 100"')
    (folder / "big.xml").write_text(text)
    with pytest.raises(
        ModelError,
        match=r"^vehicle 'two' weighs 4 kg and would displace 1.6e\+10 kg of water; check the",
    ):
        simulation_of(folder, "vehicles.1.model=big.xml")


def test_a_vehicle_that_brings_mujocos_own_drag_is_named(folder):
    write(folder, "drag.xml", options='<option density="1000"/>')
    settings = ["vehicles.0.model=drag.xml", "vehicles.1.model=drag.xml", "damping=true"]
    with pytest.warns(BuoyancyWarning, match="^vehicle 'one' sets <option density='1000'>: MuJoCo"):
        simulation_of(folder, *settings)


def test_a_vehicle_that_cannot_take_its_start_is_named(folder):
    text = (folder / "box.xml").read_text().replace("<freejoint/>", '<joint type="slide"/>')
    (folder / "rail.xml").write_text(text.replace('name="box">', 'name="box" pos="9 0 0">'))
    with pytest.warns(BuoyancyWarning, match="^vehicle 'two' hangs on joints of its own"):
        simulation_of(folder, "vehicles.1.model=rail.xml")


def test_a_vehicle_without_hulls_is_named(folder):
    with pytest.raises(ModelError, match=r"^vehicle 'two' displaces no water; choose geoms"):
        simulation_of(folder, 'geoms=["one/*"]')


def test_vehicles_that_lie_in_each_other_at_the_start_are_told(folder):
    with pytest.warns(
        BuoyancyWarning,
        match=re.escape(
            "vehicles 'one' and 'two' lie in each other at the start, and contact will throw them "
            "apart; start one of them elsewhere (start.position)"
        ),
    ):
        simulation_of(folder, "vehicles.1.start.position=[0.1, 0, 0]")


# what each has of its own -------------------------------------------------------------------------


def test_what_a_frame_or_a_summary_says_of_one_vehicle_asks_which_where_there_are_several(folder):
    simulation = simulation_of(folder)
    frame = next(simulation.frames())
    message = re.escape("this scene has 2 vehicles (one, two); say which, as in vehicles['one']")
    for ask in (
        lambda: frame.draft,
        lambda: frame.energy,
        lambda: simulation.summary().peak_draft,
        lambda: simulation.mass,
        lambda: simulation.vehicle,
    ):
        with pytest.raises(SceneError, match=message):
            ask()


def test_each_vehicle_has_its_own_row_in_the_summary(folder):
    simulation = simulation_of(folder, "vehicles.1.mass=6")
    list(simulation.frames())
    summary = simulation.summary()
    assert summary.vehicles["one"].mass == pytest.approx(4.0)
    assert summary.vehicles["two"].mass == pytest.approx(6.0)
    assert summary.vehicles["two"].net_weight == pytest.approx(-6.0 * 9.81)
    assert summary.rows()[0] == ("mass", "4.000 kg", "6.000 kg")
    assert summary.caption.startswith("method exact, 1.00 s simulated at ")
    assert summary.values()["two.mass"] == pytest.approx(6.0)


STEPS = "timestep=0.002", "integrator=rk4", "record_rate=20", "duration=2"


def test_energy_of_each_vehicle_is_constant_without_drag(folder):
    simulation = simulation_of(folder, *STEPS, "vehicles.0.start.position.2=0.1")
    totals = np.array(
        [[one.energy.total for one in frame.vehicles.values()] for frame in simulation.frames()]
    )
    # they move by joules, each at its own level
    assert np.ptp(totals, axis=0) == pytest.approx([0.0, 0.0], abs=2e-3)
    assert totals[0, 0] == pytest.approx(4.0 * 9.81 * 0.1)
    assert totals[0, 1] == pytest.approx(4.0 * 9.81 * 0.2)


def test_energies_of_all_vehicles_add_up_to_that_of_mujoco_with_their_springs(folder):
    more = ARM.format(' stiffness="3"') + '<site name="eye" pos="0 0 .05"/>'
    rest = """<tendon><spatial stiffness="20" springlength="0.01"><site site="eye"/>
    <site site="tip"/></spatial></tendon>"""
    tip = '<geom size=".03" mass=".2"/><site name="tip"/>'
    write(folder, "arm.xml", more=more.replace('<geom size=".03" mass=".2"/>', tip), rest=rest)
    text = (folder / "box.xml").read_text().replace("<geom", '<geom pos="0 0 -.01"')
    (folder / "box.xml").write_text(text)
    text = (
        (folder / "arm.xml")
        .read_text()
        .replace('<geom name="hull"', '<geom name="hull" pos="0 0 -.01"')
    )
    (folder / "arm.xml").write_text(text)
    settings = ["vehicles.0.model=arm.xml", "added_mass=estimate", "vehicles.0.start.roll=0.5"]
    simulation = simulation_of(folder, *STEPS, *settings, "duration=0.3")
    assert simulation.model.nv == 13
    moved = False
    for frame in simulation.frames():
        one, two = (each.energy for each in frame.vehicles.values())
        potential, kinetic = frame.data.energy
        assert one.kinetic + two.kinetic == pytest.approx(kinetic, rel=1e-12)
        assert one.potential + two.potential == pytest.approx(potential, rel=1e-12)
        moved = moved or one.kinetic > 0.1
        # the springs are of the first
        weight = 4.0 * 9.81 * frame.vehicles["two"].centre_of_mass[2]
        assert two.potential == pytest.approx(weight, rel=1e-12)
    assert moved


# a sweep, the command line ------------------------------------------------------------------------


def plan(folder, *over):
    fields = [parse_range(text) for text in over]
    return Sweep(
        folder / "scene.toml",
        ("duration=0.3",),
        tuple(field.key for field in fields),
        tuple(grid(fields)),
        folder / "out.csv",
    )


def test_a_sweep_has_columns_for_each_vehicle_and_reaches_the_fields_of_one(folder):
    sweep = plan(folder, "vehicles.1.start.position.2=0.2:0.5:2", "vehicles.0.mass=3:5:2")
    rows = list(sweep.run())
    assert [row["status"] for row in rows] == ["done"] * 4
    header = sweep.out.read_text().splitlines()[0].split(",")
    assert header[2:10] == [
        "vehicles.1.start.position.2",
        "vehicles.0.mass",
        "status",
        "reason",
        "method",
        "simulated_time",
        "one.mass",
        "one.displacement",
    ]
    for row in rows:
        settings = [f"{key}={row[key]}" for key in sweep.keys]
        alone = Simulation(read_scene(sweep.path, [*sweep.settings, *settings]))
        list(alone.frames())
        values = alone.summary().values()
        for name in ("one.mass", "one.peak_draft", "two.final_draft", "two.heave_range"):
            assert float(row[name]) == pytest.approx(values[name], rel=1e-9, abs=1e-12), name
    assert len({row["one.mass"] for row in rows}) == 2
    assert len({row["two.peak_draft"] for row in rows}) == 2
    # a sweep that goes on finds the same columns
    assert list(sweep.run()) == rows


def test_a_run_of_a_sweep_that_leaves_all_reason_has_failed(folder):
    rows = list(plan(folder, "vehicles.1.start.velocity.0=0:5000:2").run())
    assert [row["status"] for row in rows] == ["done", "failed"]
    assert rows[1]["reason"].startswith(
        "the simulation diverged at 0.01 s: body 'two/box' moves at 5e+03 m/s (more than 1,000); "
    )
    assert rows[1]["two.peak_draft"] == ""


def run(*words):
    return CliRunner().invoke(app, ["run", *map(str, words)])


def test_the_command_prints_a_column_for_each_vehicle(folder):
    result = run(folder / "scene.toml", "--no-record", "--duration", 0.1)
    assert result.exit_code == 0, result.output
    for text in ("Two boxes", "one", "two", "4.000 kg", "method exact, 0.10 s simulated at"):
        assert text in result.output
    told = json.loads(run(folder / "scene.toml", "--no-record", "--duration", 0.1, "--json").stdout)
    assert told["vehicles"]["two"]["mass"] == pytest.approx(4.0)
    assert told["method"] == "exact"


def test_another_vehicle_calls_itself_and_its_recording_by_its_own_name(folder, monkeypatch):
    monkeypatch.chdir(folder)
    words = shlex.split("hourglass_drop_still --vehicle box.xml --duration 0.02 --json")
    told = json.loads(run(*words).stdout)
    assert told["scene"] == "box in the scene hourglass_drop_still"
    assert told["recording"] == "recordings/box.rrd"
    assert [path.name for path in (folder / "recordings").iterdir()] == ["box.rrd"]


def test_the_fleet_that_ships_has_three_vehicles_and_a_catamaran():
    scene = read_scene(catalog.scenes()["fleet"])
    assert sorted(entry.model for entry in scene.vehicles) == ["catamaran"] + 3 * ["sauvc_auv"]
    assert type(scene.water.waves[0]).__name__ == "JonswapSea"
    model = Simulation(scene).model
    assert mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, "middle/sauvc_auv") > 0
