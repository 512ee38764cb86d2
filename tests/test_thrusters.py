"""Thrusters: tables, propellers, rotors, the surface, the books of momentum and work, models."""

import dataclasses
import itertools
import math

import mujoco
import numpy as np
import pytest
from mujoco import batch, rollout

from buoyancy_mj import (
    Buoyancy,
    ModelError,
    RegularWave,
    Thruster,
    Water,
    add_thruster,
    add_water,
    find_thruster,
    read_thrusters,
)
from buoyancy_mj.kernels.vehicle.immersion import ventilated_share, wet_share
from buoyancy_mj.kernels.vehicle.open_water import meet_flow
from buoyancy_mj.vehicle.thrusters.texts import parse_thruster, write_thruster
from buoyancy_mj.vehicle.thrusters.wageningen import wageningen
from tests import naive

STATE = mujoco.mjtState.mjSTATE_FULLPHYSICS
KGF = 9.80665
BODY = """
<mujoco>
  <option timestep="{timestep}" integrator="{integrator}"/>
  <worldbody>
    <body name="hull" pos="0 0 {height}">
      {joint}
      <geom type="box" size="0.3 0.2 0.1" density="1000"/>
      <site name="stern" zaxis="{axis}"/>
      <site name="bow" zaxis="{axis}"/>
    </body>
  </worldbody>
</mujoco>
"""
SCREW = Thruster(
    preset="b_series", blades=4, area_ratio=0.7, pitch_ratio=1.0, diameter=0.2, speed=100.0,
    control="speed", ventilation=False,
)  # fmt: skip


def build(
    thruster,
    *,
    height=-3.0,
    axis="1 0 0",
    joint="<freejoint/>",
    timestep=0.005,
    integrator="implicitfast",
    hand="none",
    water=None,
    file="",
):
    """A box with a thruster in its middle, in its own water."""
    text = BODY.format(
        height=height, axis=axis, joint=joint, timestep=timestep, integrator=integrator
    )
    spec = mujoco.MjSpec.from_string(file or text)
    add_thruster(spec, "stern", thruster, hand=hand)
    add_water(spec, water or Water(), damping=None)
    return spec.compile()


def look(model, control, *, velocity=0.0, height=None):
    """What the thruster of a still body does at an instant, by its control."""
    data = mujoco.MjData(model)
    data.ctrl[:] = control
    data.qvel[0] = velocity
    if height is not None:
        data.qpos[2] = height
    mujoco.mj_forward(model, data)
    return read_thrusters(model, data)[0]


# tables and propellers ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("voltage", "pulse", "rpm", "kgf"),
    # the maker's workbook of September 2019
    [
        (12, 1900, 2994.6, 3.714),
        (12, 1800, 2456.2, 2.463),
        (12, 1700, 1796.5, 1.279),
        (12, 1600, 1008.8, 0.3946),
        (12, 1400, -1022.6, -0.3175),
        (12, 1300, -1815.1, -1.0206),
        (12, 1200, -2457.1, -1.9459),
        (12, 1100, -2975.7, -2.9037),
        (16, 1900, 3533.4, 5.245),
        (16, 1800, 2888.0, 3.420),
        (16, 1700, 2128.7, 1.823),
        (16, 1600, 1237.1, 0.6033),
        (16, 1100, -3465.0, -4.069),
        (20, 1900, 3931.0, 65.9226 / KGF),
        (20, 1100, -3782.5, -49.3826 / KGF),
        (20, 1448, -751.8, -1.6903 / KGF),
        (16, 1464, -388.5, -0.4893 / KGF),
        (10, 1452, -377.2, -0.4448 / KGF),
        (10, 1900, 2668.0, 28.691 / KGF),
        (10, 1704, 1621.6, 10.2754 / KGF),
        (10, 1416, -739.5, -1.6014 / KGF),
    ],
)
def test_the_t200_pulls_as_its_maker_measured(voltage, pulse, rpm, kgf):
    model = build(Thruster(preset="t200", voltage=voltage, control="pwm", ventilation=False))
    read = look(model, pulse)
    assert read.thrust == pytest.approx(kgf * KGF, rel=0.02)
    assert 60.0 * read.rotor_speed == pytest.approx(rpm, rel=0.02)


@pytest.mark.parametrize(
    ("voltage", "pulse", "ampere"), [(12, 1900, 16.91), (12, 1200, 8.9), (16, 1700, 4.58)]
)
def test_the_t200_draws_what_its_maker_measured(voltage, pulse, ampere):
    read = look(build(Thruster(preset="t200", voltage=voltage, control="pwm")), pulse)
    assert read.current == pytest.approx(ampere, rel=0.02)
    assert read.power == pytest.approx(voltage * ampere, rel=0.02)


def test_between_two_supplies_the_t200_pulls_between():
    low, middle, high = (
        Thruster(preset="t200", voltage=v, control="throttle").thrust(0.7) for v in (12, 14, 16)
    )
    assert low < middle < high
    assert middle == pytest.approx(0.5 * (low + high), rel=0.02)


@pytest.mark.parametrize(("voltage", "ends"), [(12, (1464, 1536)), (16, (1472, 1528))])
def test_in_its_dead_band_the_t200_stands(voltage, ends):
    thruster = Thruster(preset="t200", voltage=voltage, control="pwm")
    assert thruster.thrust([*ends, 1500.0]).tolist() == [0.0, 0.0, 0.0]
    beyond = thruster.thrust([ends[0] - 4, ends[1] + 4])
    assert beyond[0] < 0.0 < beyond[1]


@pytest.mark.parametrize(
    ("blades", "area", "thrusts", "torques"),
    [
        # Oosterveld and van Oossanen 1975, pitch ratio 1, at J = 0, 0.2, ... 1; torques times ten
        (
            4,
            0.70,
            [0.4547, 0.3919, 0.3142, 0.2256, 0.1297, 0.0307],
            [0.6754, 0.5942, 0.4921, 0.3727, 0.2397, 0.0969],
        ),
        (
            3,
            0.65,
            [0.4415, 0.3746, 0.2957, 0.2086, 0.1172, 0.0254],
            [0.6719, 0.5812, 0.4718, 0.3491, 0.2185, 0.0854],
        ),
    ],
)
def test_propellers_of_the_b_series_have_the_coefficients_of_its_polynomials(
    blades, area, thrusts, torques
):
    j = np.linspace(0.0, 1.0, 6)
    found = wageningen(blades, area, 1.0, j)
    assert found[:, 0] == pytest.approx(thrusts, abs=6e-5)
    assert 10.0 * found[:, 1] == pytest.approx(torques, abs=6e-5)

    # and so do thrust and torque in the engine
    thruster = dataclasses.replace(SCREW, blades=blades, area_ratio=area)
    model, n, d = build(thruster), 8.0, 0.2
    for ratio, thrust, torque in zip(j, thrusts, torques, strict=True):
        read = look(model, 2.0 * math.pi * n, velocity=ratio * n * d)
        assert read.inflow_speed == pytest.approx(ratio * n * d)
        assert read.thrust == pytest.approx(1000.0 * n**2 * d**4 * thrust, abs=0.01)
        assert read.torque == pytest.approx(100.0 * n**2 * d**5 * torque, rel=2e-3)


def test_thrust_falls_with_advance_to_nothing_and_goes_with_the_density():
    model = build(SCREW)
    dense = build(SCREW, water=Water(density=1025.0))
    speeds = np.linspace(0.0, 2.3, 12)
    thrusts = [look(model, 60.0, velocity=v).thrust for v in speeds]
    assert (np.diff(thrusts) < 0.0).all()
    assert thrusts[-1] < 0.0 < thrusts[0]
    assert look(dense, 60.0).thrust == pytest.approx(1.025 * thrusts[0])


def test_a_current_is_an_inflow_and_the_wake_takes_a_share_of_it():
    still, wake = build(SCREW), build(dataclasses.replace(SCREW, wake=0.25))
    stream = build(SCREW, water=Water(current=(-1.2, 0.0, 0.0)))
    ahead = look(still, 60.0, velocity=1.2)
    assert look(stream, 60.0).thrust == pytest.approx(ahead.thrust)
    assert look(wake, 60.0, velocity=1.6).thrust == pytest.approx(ahead.thrust)


@pytest.mark.parametrize("velocity", [-1.5, -0.2, 0.3, 1.5])
def test_thrust_does_not_jump_where_the_rotor_stands(velocity):
    model = build(SCREW)
    back, stopped, ahead = (look(model, w, velocity=velocity).thrust for w in (-1e-4, 0, 1e-4))
    assert back == pytest.approx(stopped, rel=1e-3)
    assert ahead == pytest.approx(stopped, rel=1e-3)
    # a plate's drag on blades of 0.7 of the disc (Hoerner 1965)
    area = 0.7 * 0.25 * math.pi * 0.2**2
    assert stopped == pytest.approx(-0.5 * 1000 * 1.17 * area * velocity * abs(velocity))


def test_a_screw_that_brakes_pulls_more_and_one_that_is_towed_less_than_nothing():
    model = build(SCREW)
    bollard = look(model, 60.0).thrust
    assert look(model, 60.0, velocity=-1.0).thrust > bollard
    assert look(model, 60.0, velocity=4.0).thrust < 0.0
    assert look(model, 60.0, velocity=4.0).torque < 0.0


def test_no_propeller_gives_back_more_than_its_motor_puts_in():
    model = build(dataclasses.replace(SCREW, astern=0.8))
    for turn, velocity in itertools.product((-90, -30, -5, 5, 30, 90), np.linspace(-3.0, 3.0, 13)):
        read = look(model, turn, velocity=velocity)
        assert turn * read.torque >= read.thrust * velocity


def test_a_table_over_j_scales_a_bollard_pull():
    rows = ((0.0, 1.0, 1.0), (0.5, 0.6, 0.75), (1.0, 0.1, 0.5))
    model = build(Thruster(preset="t200", control="speed", advance=rows, ventilation=False))
    still = look(model, 200.0)
    read = look(model, 200.0, velocity=0.5 * still.rotor_speed * 0.0762)
    assert read.thrust == pytest.approx(0.6 * still.thrust)
    assert read.torque == pytest.approx(0.75 * still.torque)
    assert meet_flow(np.array(rows), 20.0, 0.0, 0.1)[:2] == (1.0, 1.0)


@pytest.mark.parametrize("control", ["thrust", "throttle", "pwm", "speed"])
def test_a_command_brings_its_thrust(control):
    thruster = Thruster(preset="t200", voltage=14.0, control=control, ventilation=False)
    model, wanted = build(thruster), np.array([-200.0, -20.0, -0.1, 0.0, 0.7, 30.0, 200.0])
    got = [look(model, command).thrust for command in thruster.command(wanted)]
    assert got == pytest.approx(np.clip(wanted, *thruster.limits()), abs=1e-9)
    assert thruster.thrust(thruster.command(wanted)) == pytest.approx(got)
    assert model.actuator_ctrlrange[0] == pytest.approx(thruster.control_range())


def test_controls_are_bounded_and_none_is_none():
    pulse = build(Thruster(preset="t200", control="pwm"))
    most = look(pulse, 1900.0)
    assert look(pulse, 2500.0) == most
    assert look(pulse, 0.0).thrust == 0.0
    assert look(build(Thruster(preset="t200", deadband=2.0)), 1.9).thrust == 0.0

    # an actuator that is switched off, and a control that is no number
    model = build(Thruster(preset="t200"))
    model.opt.disableactuator = 1
    assert look(model, 10.0).thrust == 0.0
    model.opt.disableactuator = 0
    assert look(model, 10.0).thrust == pytest.approx(10.0)
    with np.errstate(all="ignore"):
        assert look(model, math.nan).thrust == 0.0


def test_a_lag_does_not_follow_a_control_beyond_what_there_is():
    for control, most in (("thrust", 51.43587925), ("pwm", 400.0)):
        model = build(Thruster(preset="t200", control=control, lag=0.1, ventilation=False))
        model.actuator_ctrllimited[:] = 0
        data = mujoco.MjData(model)
        data.ctrl[0] = 1e8
        for _ in range(200):
            mujoco.mj_step(model, data)
        assert data.act[0] == pytest.approx(most, rel=1e-3)


# rotors -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("integrator", ["Euler", "implicitfast", "RK4"])
@pytest.mark.parametrize(("timestep", "steps"), [(0.001, 100), (0.02, 5), (0.1, 1)])
def test_a_lag_is_exponential_at_any_timestep(integrator, timestep, steps):
    thruster = Thruster(preset="t200", lag=0.1, ventilation=False)
    model = build(thruster, timestep=timestep, integrator=integrator)
    data = mujoco.MjData(model)
    data.ctrl = 20.0
    mujoco.mj_step(model, data, steps)
    # four passes of Runge and Kutta have 1 - e^-1 to 1.2 %
    assert data.act[0] == pytest.approx(20.0 * (1.0 - math.exp(-1.0)), rel=2e-2)
    if integrator != "RK4":
        assert data.act[0] == pytest.approx(20.0 * (1.0 - math.exp(-1.0)), rel=1e-12)


@pytest.mark.parametrize("integrator", ["Euler", "RK4"])
def test_a_short_lag_overshoots_at_no_timestep(integrator):
    thruster = dataclasses.replace(SCREW, lag=1e-4, inertia=1e-5, torque=3.0)
    model = build(thruster, timestep=0.02, integrator=integrator, hand="right")
    data, speeds = mujoco.MjData(model), []
    data.ctrl = 80.0
    for _ in range(100):
        mujoco.mj_step(model, data)
        speeds.append(data.act[0])
    assert max(speeds) <= 80.0 + 1e-9
    assert speeds[-1] == pytest.approx(80.0, rel=1e-3) or np.ptp(speeds[-20:]) < 0.1


def test_a_motor_with_too_little_torque_turns_as_fast_as_that_brings():
    thruster = dataclasses.replace(SCREW, lag=0.05, inertia=0.002, torque=1.0)
    model = build(thruster, joint="<joint type='slide' axis='0 1 0'/>", hand="right")
    data = mujoco.MjData(model)
    data.ctrl = 100.0
    mujoco.mj_step(model, data, 400)
    n = math.sqrt(1.0 / (0.0675384 * 1000.0 * 0.2**5))
    assert data.act[0] == pytest.approx(2.0 * math.pi * n, rel=1e-4)
    assert read_thrusters(model, data)[0].torque == pytest.approx(1.0, rel=1e-4)


@pytest.mark.parametrize("integrator", ["Euler", "RK4"])
@pytest.mark.parametrize("hand", ["right", "left"])
def test_what_a_rotor_gains_in_spin_its_hull_loses(integrator, hand):
    # in the air nothing else turns the two
    thruster = dataclasses.replace(SCREW, lag=0.2, inertia=0.01)
    model = build(
        thruster, height=5.0, timestep=0.001, integrator=integrator, hand=hand, axis="0 0 1"
    )
    model.opt.gravity[:] = 0.0
    data = mujoco.MjData(model)
    data.ctrl = 90.0
    mujoco.mj_step(model, data, 1000)
    sign = 1.0 if hand == "right" else -1.0
    assert data.act[0] == pytest.approx(90.0 * (1.0 - math.exp(-5.0)), rel=1e-6)
    assert model.body_inertia[1][2] * data.qvel[5] == pytest.approx(
        -sign * 0.01 * data.act[0], rel=1e-9
    )


def test_a_spinning_rotor_is_a_gyroscope():
    # the momentum of hull and rotor together stays in space while they tumble
    thruster = dataclasses.replace(SCREW, lag=0.1, inertia=0.05)
    model = build(thruster, height=5.0, timestep=0.0005, integrator="RK4", hand="right")
    model.opt.gravity[:] = 0.0
    data = mujoco.MjData(model)
    data.ctrl = 100.0
    data.qvel[3:] = 0.3, 0.4, -0.2

    def momentum():
        mujoco.mj_forward(model, data)
        turn = data.ximat[1].reshape(3, 3)
        spin = data.cvel[1, :3]
        rotor = 0.05 * data.act[0] * data.site_xmat[0].reshape(3, 3)[:, 2]
        return turn @ (model.body_inertia[1] * (turn.T @ spin)) + rotor

    before = momentum()
    mujoco.mj_step(model, data, 1000)
    assert data.act[0] > 99.0
    assert momentum() == pytest.approx(before, abs=1e-5)


@pytest.mark.parametrize("hand", ["right", "left", "none"])
def test_water_that_holds_the_rotor_turns_the_hull_against_it(hand):
    model = build(SCREW, hand=hand)
    data = mujoco.MjData(model)
    data.ctrl, data.qvel[0] = 60.0, 0.8
    passive = mujoco.MjData(model)
    passive.qvel[0] = 0.8
    for one in (data, passive):
        mujoco.mj_forward(model, one)
    read = read_thrusters(model, data)[0]
    turned = (data.qfrc_actuator + data.qfrc_passive - passive.qfrc_passive)[3]
    turned -= passive.qfrc_actuator[3]
    sign = {"right": -1.0, "left": 1.0, "none": 0.0}[hand]
    assert turned == pytest.approx(sign * read.torque, abs=1e-12)
    assert data.qfrc_actuator[0] == pytest.approx(read.thrust)


@pytest.mark.parametrize("lag", [0.0, 0.1])
def test_derivatives_of_the_engine_have_the_torque_of_reaction_once(lag):
    thruster = dataclasses.replace(SCREW, lag=lag, inertia=0.01 * lag)
    model = build(thruster, hand="right")
    data = mujoco.MjData(model)
    data.ctrl[:], data.qvel[0] = 40.0, 0.8
    if lag:
        data.act[:] = 30.0
    mujoco.mj_forward(model, data)
    size = 2 * model.nv + model.na
    a, b = np.zeros((size, size)), np.zeros((size, 1))
    mujoco.mjd_transitionFD(model, data, 1e-6, True, a, b, None, None)

    def step(ctrl, act):
        other = mujoco.MjData(model)
        other.ctrl[:], other.act[:], other.qvel[0] = 40.0 + ctrl, data.act + act, 0.8
        mujoco.mj_step(model, other)
        return np.concatenate([other.qvel, other.act])

    by_control = (step(1e-4, 0.0) - step(-1e-4, 0.0)) / 2e-4
    assert b[model.nv :, 0] == pytest.approx(by_control, abs=1e-6)
    if lag:
        by_state = (step(0.0, 1e-4) - step(0.0, -1e-4)) / 2e-4
        assert a[model.nv :, -1] == pytest.approx(by_state, abs=1e-6)

    # passes over the actuators alone, of these data and of a copy
    copied = mujoco.MjData(model)
    mujoco.mj_copyData(copied, model, data)
    for one in (data, copied):
        forces = one.qfrc_passive.copy()
        assert abs(forces[3]) > 1e-3
        mujoco.mj_forwardSkip(model, one, mujoco.mjtStage.mjSTAGE_VEL, 0)
        assert one.qfrc_passive == pytest.approx(forces, abs=1e-12)


# at the surface -----------------------------------------------------------------------------------


@pytest.mark.parametrize("height", [-0.12, -0.08, -0.03, 0.0, 0.05, 0.09, 0.11])
def test_an_upright_disc_that_comes_out_keeps_the_thrust_of_what_is_wet(height):
    x = max(-1.0, min(1.0, -height / 0.1))
    segment = 1.0 - (math.acos(x) - x * math.sqrt(1.0 - x * x)) / math.pi
    model = build(SCREW)
    read, whole = look(model, 60.0, height=height), look(model, 60.0)
    assert read.wet_share == pytest.approx(segment, abs=1e-12)
    assert read.thrust == pytest.approx(segment * whole.thrust, abs=1e-12)
    assert read.torque == pytest.approx(segment**0.85 * whole.torque, abs=1e-12)


@pytest.mark.parametrize("axis", [(1, 0, 0), (1, 0.4, 1.5), (0.2, 1, -0.6), (0.3, 0.1, 1)])
@pytest.mark.parametrize("height", [-0.06, 0.02])
def test_the_wet_share_is_that_of_the_surface_of_the_instant(axis, height):
    wave = RegularWave(0.1, wavelength=2.0, direction=30.0, phase=1.0)
    water = Water(waves=wave)
    place = water.elevation(0.0, 0.0, 0.0) + height
    model = build(SCREW, axis=" ".join(map(str, axis)), water=water)
    step = 1e-6
    slopes = [
        (water.elevation(*(step * d), 0.0) - water.elevation(*(-step * d), 0.0)) / (2.0 * step)
        for d in np.eye(2)
    ]
    expected = naive.wet_disc(-height, axis, 0.1, slopes)
    read = look(model, 60.0, height=place)
    assert read.wet_share == pytest.approx(expected, abs=2e-3)


def test_a_disc_that_lies_flat_comes_out_over_a_tenth_of_its_diameter():
    model = build(SCREW, axis="0 0 1")
    shares = [look(model, 60.0, height=h).wet_share for h in (-0.0101, -0.005, 0.0, 0.005, 0.0101)]
    assert shares[0] == 1.0
    assert shares[2] == pytest.approx(0.5)
    assert shares[-1] == 0.0
    assert np.diff(shares).max() < 0.0


@pytest.mark.parametrize("ratio", [-0.9, -0.3, 0.0, 0.5, 1.0, 1.29, 1.31, 3.0])
def test_air_takes_what_minsaas_measured(ratio):
    expected = 1.0
    if ratio < 1.3:
        expected = max(0.0, 1.0 - 0.675 * (1.0 - 0.769 * ratio) ** 1.258)
    wet = wet_share(0.1 * ratio, 1.0, 0.1)
    assert wet * ventilated_share(0.1 * ratio, 0.1, wet) == pytest.approx(expected, abs=1e-12)

    # in the engine, after the revolutions that it takes
    model = build(
        dataclasses.replace(SCREW, ventilation=True),
        height=-0.1 * ratio,
        joint="<joint type='slide' axis='0 1 0'/>",
    )
    data = mujoco.MjData(model)
    data.ctrl = 60.0
    mujoco.mj_step(model, data, 400)
    mujoco.mj_forward(model, data)
    bollard = SCREW.thrust(60.0)
    assert data.actuator_force[0] == pytest.approx(expected * bollard, abs=1e-6 * bollard)


def test_air_comes_within_a_revolution_and_leaves_within_ten():
    model = build(
        dataclasses.replace(SCREW, ventilation=True),
        height=-0.05,
        joint="<joint type='slide' axis='0 0 1'/>",
        timestep=0.001,
    )
    model.opt.gravity[:] = 0.0
    data, n = mujoco.MjData(model), 20.0
    data.ctrl = 2.0 * math.pi * 20.0 * 0.75
    n = 0.75 * 20.0

    def lose(height, revolutions):
        data.qpos[0] = height
        for _ in range(round(1000 * revolutions / n)):
            data.qpos[0], data.qvel[0] = height, 0.0
            mujoco.mj_step(model, data)
        return data.act[0]

    wet = wet_share(0.05, 1.0, 0.1)
    full = 1.0 - ventilated_share(0.05, 0.1, wet)
    assert lose(0.0, 1.0) == pytest.approx(full * (1.0 - math.exp(-1.0)), rel=0.01)
    assert lose(0.0, 12.0) == pytest.approx(full, rel=1e-4)
    assert lose(-2.0, 10.0) == pytest.approx(full * math.exp(-1.0), rel=0.01)


def test_at_full_throttle_in_waves_the_mean_thrust_falls_and_is_least_in_troughs():
    thruster = Thruster(preset="t200", lag=0.02)
    joint = "<joint type='slide' axis='0 1 0'/>"
    wave = RegularWave(0.12, period=2.0)
    still = build(thruster, height=-0.12, joint=joint)
    rough = build(thruster, height=-0.12, joint=joint, water=Water(waves=wave))
    thrusts, heights = [], []
    for model in (still, rough):
        data = mujoco.MjData(model)
        data.ctrl = 50.0
        mujoco.mj_step(model, data, 100)
        for _ in range(400):
            mujoco.mj_step(model, data)
            thrusts.append(data.actuator_force[0])
            heights.append(Water(waves=wave).elevation(0.0, 0.0, data.time))
    calm, rough = np.array(thrusts[:400]), np.array(thrusts[400:])
    assert calm == pytest.approx(50.0)
    assert rough.mean() < 0.9 * calm.mean()
    assert rough.max() == pytest.approx(50.0, rel=0.01)
    assert np.array(heights[400:])[rough < 0.5 * rough.max()].max() < 0.0


def test_without_water_a_rotor_turns_without_load():
    model = mujoco.MjSpec.from_string(
        BODY.format(
            height=-3, axis="1 0 0", joint="<freejoint/>", timestep=0.01, integrator="Euler"
        )
    )
    add_thruster(model, "stern", SCREW)
    model = model.compile()
    read = look(model, 60.0)
    assert (read.thrust, read.torque, read.wet_share) == (0.0, 0.0, 0.0)
    assert 2.0 * math.pi * read.rotor_speed == pytest.approx(60.0)
    with Buoyancy(model).installed():
        assert look(model, 60.0).thrust > 60.0


# models -------------------------------------------------------------------------------------------

FULL = dataclasses.replace(
    SCREW, ventilation=True, lag=0.05, inertia=0.001, torque=4.0, wake=0.1, recovery=8.0
)


@pytest.mark.parametrize("integrator", ["implicitfast", "RK4"])
def test_steps_rollouts_and_batches_are_alike(integrator):
    water = Water(waves=RegularWave(0.1, period=1.5))
    model = build(FULL, height=-0.08, water=water, hand="left", integrator=integrator)
    start, data = np.empty(mujoco.mj_stateSize(model, STATE)), mujoco.MjData(model)
    mujoco.mj_getState(model, data, start, STATE)
    data.ctrl = 70.0
    mujoco.mj_step(model, data, 60)
    assert data.act[0] > 30.0
    assert data.act[1] != 0.0

    states, _ = rollout.rollout(
        model,
        [mujoco.MjData(model) for _ in range(2)],
        np.tile(start, (4, 1)),
        np.full((4, 60, 1), 70.0),
        nstep=60,
    )
    end = np.empty_like(start)
    mujoco.mj_getState(model, data, end, STATE)
    assert (states[:, -1] == end).all()

    many = batch.Batch(model, 64, nthread=2)
    many.bind("ctrl")[:] = 70.0
    many.step(nstep=60)
    assert (many.bind("qpos") == data.qpos).all()
    assert (many.bind("act") == data.act).all()


@pytest.mark.parametrize(
    "thruster",
    [
        FULL,
        Thruster(preset="t200", voltage=14.8, control="pwm", lag=0.1),
        Thruster(preset="t500", control="throttle"),
        Thruster(
            bollard=((-1.0, -90.0, -3.0, -0.1), (0.0, 0.0, 0.0, 0.0), (1.0, 100.0, 4.0, 0.12)),
            diameter=0.1,
            advance=((0, 1, 1), (0.6, 0.3, 0.6)),
        ),
        Thruster(open_water=((0, 0.4, 0.05), (0.7, 0.1, 0.03)), diameter=0.1, speed=200.0),
    ],
)
def test_a_model_knows_its_thruster_again(thruster):
    assert parse_thruster(write_thruster(thruster), "it") == thruster
    spec = mujoco.MjSpec.from_string(BODY.format(
        height=-3, axis="1 0 0", joint="<freejoint/>", timestep=0.01, integrator="Euler"
    ))  # fmt: skip
    add_thruster(spec, "stern", thruster)
    spec.compile()
    saved = mujoco.MjModel.from_xml_string(spec.to_xml())
    assert find_thruster(saved, "stern") == thruster

    parent = mujoco.MjSpec()
    parent.option.timestep = spec.option.timestep
    parent.attach(spec, prefix="rov/", frame=parent.worldbody.add_frame())
    model = parent.compile()
    assert find_thruster(model, "rov/stern") == thruster
    assert read_thrusters(model, mujoco.MjData(model))[0].name == "rov/stern"


def test_another_actuator_is_no_thruster():
    model = mujoco.MjModel.from_xml_string("""
        <mujoco>
          <worldbody><body><freejoint/><geom size="1"/><site name="a"/></body></worldbody>
          <actuator><motor site="a"/></actuator>
        </mujoco>""")
    assert find_thruster(model, 0) is None
    assert read_thrusters(model, mujoco.MjData(model)) == ()


WRITTEN = """
<mujoco>
  <extension><plugin plugin="buoyancy_mj.thruster"/></extension>
  <worldbody>
    <body><freejoint name="j"/><geom size=".1"/><site name="a"/></body>
  </worldbody>
  <actuator>
    <plugin name="main" plugin="buoyancy_mj.thruster" site="a" actdim="1" gear="0 0 1 0 0 -.012">
      <config key="preset" value="t200"/>
    </plugin>
  </actuator>
</mujoco>
"""


def test_a_thruster_may_stand_in_mjcf_without_an_instance():
    model = mujoco.MjModel.from_xml_string(WRITTEN)
    assert find_thruster(model, "main") == Thruster(preset="t200")


# bad inputs ---------------------------------------------------------------------------------------

OPEN = {"diameter": 0.1, "speed": 100.0}


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({}, "a thruster states neither preset nor table; state one of preset (t200, t500, "
             "b_series), open_water, bollard"),
        ({"preset": "t20"}, "thruster preset is 't20'; did you mean 't200'? possible: b_series, "
                            "t200, t500"),
        ({"preset": "t200", "control": "pmw"}, "thruster control is 'pmw'; did you mean 'pwm'? "
                                               "possible: pwm, speed, throttle, thrust"),
        ({"preset": "t200", "lag": -1.0}, "thruster lag is -1.0; it must be at least 0 and at most "
                                          "1000"),
        ({"preset": "t200", "lag": None}, "thruster lag is None; it must be a finite number"),
        ({"open_water": None, **OPEN}, "thruster open_water is None; it must be numbers of shape "
                                       "(n, 3)"),
        ({"bollard": np.zeros((0, 4))}, "a thruster states neither preset nor table; state one of "
                                        "preset (t200, t500, b_series), open_water, bollard"),
        ({"preset": "t200", "lag": math.nan}, "thruster lag is nan; it must be a finite number"),
        ({"preset": "t200", "voltage": 25}, "voltage is 25; it must be at least 10 and at most 20"),
        ({"preset": "t200", "speed": 9.0}, "thruster speed is 9.0, which says nothing beside "
                                           "'t200'; leave it out; possible: voltage, advance"),
        ({"preset": "b_series"}, "a thruster with 'b_series' needs area_ratio; state it"),
        ({"preset": "t200", "inertia": 1.0}, "a thruster states inertia without lag; the rotor "
         "would need a torque without bound, so state the lag of its governor too"),
        ({"preset": "t200", "torque": 1.0}, "thruster torque is 1 without inertia, which it would "
                                            "turn; state inertia too, or leave it out"),
        ({"preset": "t200", "wake": 0.1}, "thruster wake is 0.1, but no inflow changes its thrust; "
                                          "state advance too, or leave it out"),
        ({"preset": "t200", "recovery": 5.0, "ventilation": False},
         "thruster recovery is 5 without ventilation; leave it out"),
        ({"open_water": ((0, 0.4, 0.05), (0.5, 0.2, 0.03), (0.4, 0.1, 0.02)), **OPEN},
         "open_water has J 0.4 after 0.5; J must rise from row to row"),
        ({"open_water": ((0, 0.4, 0.01), (0.5, 0.2, 0.003)), **OPEN},
         "open_water has an efficiency of 5.31 at J = 0.5; J K_T / (2 pi K_Q) is 1 at most"),
        ({"bollard": ((-1, -9, -3, -1), (0, 0, 0, 0), (0.5, 5, 3, 1), (1, 9, 2, 2)),
          "diameter": 0.1},
         "bollard has a thrust of 2 after 3; it must rise from row to row"),
        ({"bollard": ((-1, -9, -3, -1), (1, 9, 2, 2)), "diameter": 0.1},
         "bollard has no row with a rotor that stands without thrust; add one"),
        ({"preset": "t200", "advance": ((0, 1, 1), (1, math.inf, 1))},
         "thruster advance holds inf; its numbers must be finite"),
    ],
)  # fmt: skip
def test_a_thruster_that_makes_no_sense_is_refused(fields, message):
    with pytest.raises(ModelError) as refused:
        Thruster(**fields)
    assert str(refused.value) == message


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('actdim="1"', 'actdim="2"',
         "thruster 'main' has actdim 2; it keeps the air at its disc (ventilation), so write "
         'actdim="1"'),
        ('actdim="1"', "",
         "thruster 'main' has actdim 0; it keeps the air at its disc (ventilation), so write "
         'actdim="1"'),
        ('gear="0 0 1 0 0 -.012"', "",
         "thruster 'main' has the gear '1 0 0 0 0 0'; it must be '0 0 1 0 0 Q', with the torque of "
         "reaction Q for each newton: below 0 for a right-handed propeller, 0 for none"),
        ('value="t200"', 'value="t2000"',
         "thruster 'main': thruster preset is 't2000'; did you mean 't200'? possible: b_series, "
         "t200, t500"),
        ('value="t200"/>', 'value="t200"/><config key="lag" value="soon"/>',
         "thruster 'main': lag is 'soon'; needed is a number"),
        ("</actuator>", WRITTEN[WRITTEN.index("<plugin name"):WRITTEN.index("</actuator>")].replace(
            "main", "spare") + "</actuator>",
         "thruster 'main' and thruster 'spare' push at one site, 'a'; give each a site of its own"),
        ('site="a" actdim', 'joint="j" actdim',
         "thruster 'main' must push at a site; give it site= alone"),
        ('actdim="1"', 'actdim="1" forcerange="-1 1" forcelimited="true"',
         "thruster 'main' has a forcerange, which would leave its torque as it was; remove it, and "
         "bound its control (ctrlrange)"),
        ("-.012", "nan",
         "thruster 'main' has the gear '0 0 1 0 0 nan'; it must be '0 0 1 0 0 Q', with the torque "
         "of reaction Q for each newton: below 0 for a right-handed propeller, 0 for none"),
        ('actdim="1"', 'actdim="1" dyntype="integrator"',
         "thruster 'main' has a dyntype, which it does not follow; remove it, and state lag"),
        ('actdim="1"', 'actdim="1" actearly="true"',
         "thruster 'main' has actearly, which it does not follow; remove it"),
    ],
)  # fmt: skip
def test_mjcf_that_makes_no_sense_is_refused(old, new, message):
    with pytest.raises(ValueError, match="engine error: buoyancy_mj: ") as refused:
        mujoco.MjModel.from_xml_string(WRITTEN.replace(old, new, 1))
    assert str(refused.value).endswith(f": buoyancy_mj: {message}")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"site": "sten"}, "the model has no site 'sten'; did you mean 'stern'? possible: bow, "
                           "stern"),
        ({"site": "stern", "name": "other"}, "the site 'stern' has the thruster 'stern' already; "
                                             "give each a site of its own"),
        ({"site": "bow", "name": "stern"}, "the model already has an actuator or a plugin instance "
                                           "'stern'; give the thruster another name (name=)"),
        ({"site": "bow", "hand": "up"}, "thruster hand is 'up'; possible: left, none, right"),
        ({"site": "bow", "hand": ["up"]}, "thruster hand is ['up']; possible: left, none, right"),
        ({"site": "bow", "name": 3}, "name of the thruster is 3; it must be a text"),
        ({"site": "bow", "thruster": "t200"}, "thruster is 't200'; it must be a Thruster, as "
                                              "Thruster(preset='t200')"),
    ],
)  # fmt: skip
def test_a_place_that_makes_no_sense_is_refused(arguments, message):
    spec = mujoco.MjSpec.from_string(BODY.format(
        height=-3, axis="1 0 0", joint="<freejoint/>", timestep=0.01, integrator="Euler"
    ))  # fmt: skip
    add_thruster(spec, "stern", Thruster(preset="t200"))
    with pytest.raises(ModelError) as refused:
        add_thruster(spec, **({"thruster": Thruster(preset="t200")} | arguments))
    assert str(refused.value) == message


def test_a_table_may_be_an_array():
    rows = [(0.0, 0.4, 0.05), (1.0, 0.0, 0.01)]
    assert Thruster(open_water=np.array(rows), **OPEN) == Thruster(open_water=rows, **OPEN)
