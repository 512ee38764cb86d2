"""Gravity compensation counts in every balance, as the engine has it."""

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner

from buoyancy_mj import (
    Buoyancy,
    BuoyancyWarning,
    EquilibriumError,
    ModelError,
    Scene,
    Simulation,
    Start,
    ballast,
    equilibrium,
    hydrostatics,
    righting_arm,
)
from buoyancy_mj.cli import app
from buoyancy_mj.hulls.gravity import find_weighing_masses
from buoyancy_mj.inspection.inspection import inspect_model
from buoyancy_mj.inspection.json_report import to_json
from buoyancy_mj.inspection.report import list_sections
from buoyancy_mj.statics.building import build_vessel
from tests import vessels

AUV = vessels.DATA / "cases" / "gravcomp" / "auv.xml"


def auv(gravcomp=1.0, mass=8.0):
    """The case, with another part compensated."""
    text = AUV.read_text().replace('gravcomp="1"', f'gravcomp="{gravcomp}"')
    return mujoco.MjModel.from_xml_string(text.replace('mass="8"', f'mass="{mass}"'))


def trimmed(gravcomp, options=""):
    """A box with a mast and a keel on it, all rigid, each body with its own compensation."""
    hull, mast, keel = gravcomp
    return mujoco.MjModel.from_xml_string(
        f"""<mujoco>{options}<worldbody><body name="hull" gravcomp="{hull}"><freejoint/>
        <geom type="box" size=".5 .3 .2" mass="60"/>
        <body name="mast" pos=".1 .02 .3" gravcomp="{mast}">
          <geom type="capsule" size=".02 .3" mass="4"/></body>
        <body name="keel" pos="-.05 0 -.35" gravcomp="{keel}">
          <geom type="box" size=".1 .02 .1" mass="20"/></body>
        </body></worldbody></mujoco>"""
    )


def accelerations(model, qpos):
    """What the engine makes of a pose at rest in still water."""
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    with Buoyancy(model, damping=None).installed():
        mujoco.mj_forward(model, data)
    return data.qacc.copy()


# the engine's own word


@pytest.mark.parametrize(
    ("joint", "option", "acts"),
    [
        ("<freejoint/>", "", True),
        ("<freejoint/>", '<flag spring="disable" damper="disable"/>', False),
        ("<freejoint/>", '<flag spring="disable"/>', True),
        ("<freejoint/>", '<flag actuation="disable"/>', True),
        ('<joint type="free" actuatorgravcomp="true"/>', "", True),
        ('<joint type="free" actuatorgravcomp="true"/>', '<flag actuation="disable"/>', False),
    ],
)
@pytest.mark.parametrize("motor", [True, False])
def test_the_masses_that_weigh_are_those_that_the_engine_lets_fall(joint, option, acts, motor):
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><option>{option}</option><worldbody>
        <body gravcomp="0.75">{joint}<geom size=".1" mass="8"/>
          <body gravcomp="2"><geom size=".1" mass="1"/></body>
          <body><joint name="j"/><geom size=".05" mass="1"/></body></body></worldbody>
        <actuator>{'<motor joint="j"/>' if motor else ""}</actuator></mujoco>"""
    )
    # without an actuator MuJoCo leaves the forces of actuators out
    acts = acts and (motor or "actuatorgravcomp" not in joint)
    expected = [0.0, 2.0, -1.0, 1.0] if acts else [0.0, 8.0, 1.0, 1.0]
    assert find_weighing_masses(model) == pytest.approx(expected)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    lifted = data.qfrc_passive[2] + data.qfrc_actuator[2]
    assert 10.0 * 9.81 - lifted == pytest.approx(sum(expected) * 9.81)


def test_compensation_set_at_run_time_acts_no_more_than_in_the_engine():
    model = auv(0.0)
    model.body_gravcomp[1] = 1.0
    assert find_weighing_masses(model) == pytest.approx([0.0, 8.0])
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert data.qfrc_passive[2] == 0.0


@given(st.lists(st.floats(-0.3, 0.9), min_size=3, max_size=3), st.floats(-3.0, 3.0))
@settings(max_examples=10)
def test_at_rest_the_engine_sees_no_acceleration(gravcomp, heel):
    model = trimmed(gravcomp)
    start = [0, 0, 0, *Rotation.from_euler("x", heel).as_quat(scalar_first=True)]
    rest = equilibrium(model, start=start)
    assert np.abs(accelerations(model, rest.qpos)).max() < 1e-6


def test_the_stiffness_is_minus_the_slope_of_the_forces_of_the_engine():
    model = trimmed((0.5, 0.0, 1.0))
    turn = Rotation.from_euler("xy", [0.3, -0.2])
    found = hydrostatics(model, qpos=[0, 0, 0.1, *turn.as_quat(scalar_first=True)])
    to_heading = Rotation.from_rotvec([0.0, 0.0, -found.heading]).as_matrix()
    axes = np.kron(np.eye(2), to_heading)
    step = 1e-5
    for column in range(6):
        ends = []
        for sign in (1.0, -1.0):
            motion = axes.T @ (sign * step * np.eye(6)[column])
            moved = Rotation.from_rotvec(motion[3:]) * turn
            place = found.centre_of_gravity + motion[:3]
            place = place - moved.apply(build_vessel(model).centre_of_gravity)
            ends.append(axes @ wrench_at(model, place, moved, found.centre_of_gravity + motion[:3]))
        slope = -(ends[0] - ends[1]) / (2.0 * step)
        assert found.stiffness[:, column] == pytest.approx(slope, abs=1e-1)


def wrench_at(model, place, turn, point):
    """Force of water, weight and compensation, and their torque about a point, by the engine."""
    data = mujoco.MjData(model)
    data.qpos[:] = [*place, *turn.as_quat(scalar_first=True)]
    with Buoyancy(model, damping=None).installed():
        mujoco.mj_forward(model, data)
    generalized = data.qfrc_passive - data.qfrc_bias
    force, torque = generalized[:3], turn.apply(generalized[3:])
    return np.concatenate([force, torque + np.cross(place - point, force)])


def test_the_mass_matrix_counts_all_mass_about_the_point_where_the_weight_acts():
    model = trimmed((0.5, 0.0, 1.0))
    turn = Rotation.from_euler("xyz", [0.3, -0.2, 0.9])
    qpos = [0, 0, 0.1, *turn.as_quat(scalar_first=True)]
    found = hydrostatics(model, qpos=qpos)
    rng = np.random.default_rng(1)
    data = mujoco.MjData(model)
    mujoco.mj_resetData(model, data)
    data.qpos[:] = qpos
    model.opt.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
    for velocity, spin in rng.normal(size=(5, 2, 3)):
        # the velocity of the centre of gravity, in the axes along the heading
        arm = data.qpos[:3] - found.centre_of_gravity
        data.qvel[:3], data.qvel[3:] = velocity + np.cross(spin, arm), turn.inv().apply(spin)
        mujoco.mj_forward(model, data)
        heading = Rotation.from_rotvec([0.0, 0.0, -found.heading])
        motion = np.concatenate([heading.apply(velocity), heading.apply(spin)])
        assert 0.5 * motion @ found.mass_matrix @ motion == pytest.approx(data.energy[1], rel=1e-9)


# one truth


def test_half_compensated_it_floats_at_half_the_draft():
    found = equilibrium(auv(0.75), start=[0, 0, -0.02, 1, 0, 0, 0]).hydrostatics
    assert (found.mass, found.carried_mass) == pytest.approx((2.0, 6.0))
    assert (found.draft, found.displacement) == pytest.approx((0.025, 2.0))
    assert found.reserve == pytest.approx(14.0)
    # the heave of 8 kg on a waterplane of 0.08 m2
    assert found.natural_periods()[0] == pytest.approx(2 * np.pi * np.sqrt(8 / (9810 * 0.08)))


def test_what_weighs_nothing_comes_to_rest_nowhere():
    message = (
        "'hover' comes to rest nowhere: gravity compensation carries 8 kg of its 8 kg, and the "
        "water lifts it out; take gravcomp='...' out of its bodies, or weigh it down (see ballast)"
    )
    scene = Scene(title="hover", vehicle=AUV, start=Start(at="equilibrium"))
    for ask in (
        lambda: equilibrium(auv()),
        lambda: righting_arm(auv()),
        lambda: Simulation(scene),
    ):
        with pytest.raises(EquilibriumError) as caught:
            ask()
        assert str(caught.value) == message
    with pytest.raises(EquilibriumError, match="carries 12 kg of its 8 kg"):
        equilibrium(auv(1.5))


def test_in_a_pose_that_is_given_it_has_hydrostatics():
    found = hydrostatics(auv())
    assert (found.mass, found.carried_mass, found.reserve) == pytest.approx((0.0, 8.0, 16.0))
    assert found.centre_of_gravity == pytest.approx([0.0, 0.0, -2.0])
    assert found.mass_matrix[0, 0] == pytest.approx(8.0)


def test_a_run_counts_it_and_tells():
    with pytest.warns(
        BuoyancyWarning,
        match=r"^gravity compensation \(gravcomp\) carries 8 kg of the vehicle's 8 kg, and the "
        r"water lifts it as well; the net weight counts both$",
    ):
        simulation = Simulation(Scene(title="hover", vehicle=AUV, damping=None))
    summary = simulation.summary()
    assert (summary.mass, summary.net_weight) == pytest.approx((8.0, -156.96))


def test_inspect_tells_what_is_carried():
    found = inspect_model(auv())
    (vessel,) = found.vessels
    assert vessel.sentence == (
        "rises out of the water: 157 N lift it under water, "
        "since gravity compensation carries 8 kg of its 8 kg"
    )
    assert vessel.total.lift == pytest.approx(156.96)
    section = next(one for one in list_sections(found) if one.title.startswith("Will"))
    assert section.header[:3] == ("body", "mass [kg]", "carried [kg]")
    assert section.rows == (("hover", "8", "8", "16", "+16", "+157"),)
    assert to_json(found)["floating"][0]["carried"] == pytest.approx(8.0)

    (part,) = inspect_model(auv(0.5)).vessels
    assert part.sentence.startswith("floats: 12 kg reserve, draft ")
    assert (
        "gravity compensation (gravcomp) carries 4 kg of its 8 kg: reserve, draft and metacentric "
        "heights are those of the rest, and CG is where that weighs"
    ) in part.notes


def test_ballast_makes_it_neutral_by_the_engine():
    spec = mujoco.MjSpec.from_file(str(AUV))
    result = ballast(spec.compile(), reserve=0.0, masses=[[-0.1, -0.05, -0.08], [0.1, 0.05, 0.0]])
    assert result.mass == pytest.approx(16.0)
    result.add_to(spec)
    model = spec.compile()
    acceleration = accelerations(model, model.qpos0)
    assert np.abs(acceleration).max() < 1e-6
    after = hydrostatics(model)
    assert result.hydrostatics.mass == pytest.approx(after.mass) == pytest.approx(16.0)
    assert result.hydrostatics.mass_matrix == pytest.approx(after.mass_matrix, abs=1e-9)
    assert pytest.approx(after.BG) == result.hydrostatics.BG


def test_the_command_tells_what_is_carried_beside_the_ballast():
    box = ["--box", "-.1", "-.05", "-.08", ".1", ".05", "0"]
    result = CliRunner().invoke(app, ["ballast", str(AUV), "--reserve", "0", *box])
    assert result.stdout.splitlines() == [
        "ballast_box: 16 kg of ballast at (0, 0, -0.08) m",
        "16 kg added, 24 kg in all, of which gravity compensation carries 8 kg; under water: "
        "BG 0.08 m, GM 0.08 m, reserve 0 kg",
    ]


@given(st.lists(st.floats(-0.3, 0.9), min_size=3, max_size=3))
@settings(max_examples=10)
def test_a_ballasted_vessel_rests_as_wanted_whatever_is_compensated(gravcomp):
    spec = mujoco.MjSpec.from_string(
        f"""<mujoco><worldbody><body name="hull" gravcomp="{gravcomp[0]}"><freejoint/>
        <geom type="box" size=".5 .3 .2" mass="60"/>
        <body name="keel" pos="-.05 0 -.35" gravcomp="{gravcomp[2]}">
          <geom type="box" size=".1 .02 .1" mass="20"/></body></body></worldbody></mujoco>"""
    )
    box = [[-0.45, -0.25, -0.19], [0.45, 0.25, -0.15]]
    result = ballast(spec.compile(), draft=0.5, heel=0.01, trim=0.02, masses=box)
    result.add_to(spec)
    model = spec.compile()
    found = equilibrium(model)
    at = found.hydrostatics
    assert (at.draft, at.heel, at.trim) == pytest.approx((0.5, 0.01, 0.02), abs=1e-6)
    assert np.abs(accelerations(model, found.qpos)).max() < 1e-6
    assert result.hydrostatics.mass_matrix == pytest.approx(at.mass_matrix, abs=1e-6)


def test_the_energy_of_a_run_is_kept(tmp_path):
    # without MuJoCo's own drag
    text = AUV.read_text().replace(' density="1000" viscosity="0.001"', "")
    path = tmp_path / "auv.xml"
    path.write_text(text.replace('gravcomp="1"', 'gravcomp="0.75"'))
    with pytest.warns(BuoyancyWarning, match="carries 6 kg"):
        simulation = Simulation(
            Scene(
                title="bob",
                vehicle=path,
                damping=None,
                duration=1.0,
                timestep=0.0005,
                start=Start(position=(0.0, 0.0, -0.05)),
            )
        )
    energies = [frame.energy for frame in simulation.frames()]
    totals = [energy.total for energy in energies]
    assert np.ptp([energy.kinetic for energy in energies]) > 1.0
    assert np.ptp(totals) < 0.02 * np.ptp([energy.kinetic for energy in energies])


def test_compensation_that_only_turns_a_vessel_is_refused():
    model = trimmed((0.0, 0.0, 4.2))
    with pytest.raises(
        ModelError,
        match=r"^gravity compensation leaves 'hull' no weight but a turning moment of 23\.9 "
        r"kg m, so that it has no centre of gravity; correct gravcomp of its bodies$",
    ):
        hydrostatics(model)
