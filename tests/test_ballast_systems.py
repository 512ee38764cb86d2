"""Bladders, tanks and compartments: ballast that changes under way."""

import math
import re

import mujoco
import numpy as np
import pytest
import trimesh
from mujoco import rollout
from typer.testing import CliRunner

from buoyancy_mj import (
    Bladder,
    Buoyancy,
    Compartment,
    ModelError,
    RegularWave,
    Selection,
    Tank,
    Water,
    add_ballast,
    add_water,
    equilibria,
    equilibrium,
    hydrostatics,
    righting_arm,
    water_in,
)
from buoyancy_mj.cli import app
from buoyancy_mj.hulls.placed_ballasts import find_ballasts
from buoyancy_mj.meshes import shapes
from buoyancy_mj.meshes.fills import TankShape, integrate_below, measure_fill
from buoyancy_mj.statics.attitude import Attitude
from buoyancy_mj.statics.building import build_vessel
from buoyancy_mj.statics.floating_pose import pose_vessel

FAR_BELOW = Water(level=-1000.0)
"""Water that acts on the model and touches nothing."""
STATE = mujoco.mjtState.mjSTATE_FULLPHYSICS


def build(body, *ballast, water=None, option="", numerics=(), **options):
    """A model of one body, with ballast (geom, what) in it."""
    spec = mujoco.MjSpec.from_string(
        f"<mujoco><option {option}/><worldbody>{body}</worldbody></mujoco>"
    )
    for geom, what in ballast:
        add_ballast(spec, geom, what)
    for name, numbers in numerics:
        spec.add_numeric(name=name, data=numbers, size=len(numbers))
    add_water(spec, water or Water(), **options)
    return spec.compile()


def run(model, seconds, **start):
    """Data after so many seconds from a start of act, ctrl, qpos or qvel."""
    data = mujoco.MjData(model)
    for name, values in start.items():
        getattr(data, name)[:] = values
    while data.time < seconds - 1e-9:
        mujoco.mj_step(model, data)
    return data


# flow ---------------------------------------------------------------------------------------------

CUBE = """
<body name="cube">
  <joint type="slide" axis="1 0 0"/>
  <geom name="tank" type="box" size="0.5 0.5 0.5" mass="2000"/>
  <site name="hole" pos="0 0 -0.5"/>
</body>
"""
"""A tank of 1 m^3 that stays at its height."""
HOLE = Compartment(opening="hole", area=1e-3)


@pytest.mark.parametrize("timestep", [0.5, 4.0])
def test_a_tank_drains_as_torricelli_says_at_any_timestep(timestep):
    # A / (Cd a) sqrt(2 h / g), the root of the level falls evenly
    whole = 1.0 / (0.6 * 1e-3) * math.sqrt(2.0 / 9.81)
    assert whole == pytest.approx(752.5, abs=0.1)
    model = build(CUBE, ("tank", HOLE), water=FAR_BELOW, option=f"timestep='{timestep}'")
    half = run(model, 376.0, act=1.0)
    assert half.act[0] == pytest.approx((1.0 - half.time / whole) ** 2, rel=1e-9)
    assert run(model, 752.0, act=1.0).act[0] > 0.0
    assert run(model, 756.0, act=1.0).act[0] == pytest.approx(0.0, abs=1e-15)


def test_runge_kutta_drains_a_tank_the_same():
    model = build(CUBE, ("tank", HOLE), water=FAR_BELOW, option="integrator='RK4' timestep='1'")
    assert run(model, 376.0, act=1.0).act[0] == pytest.approx((1.0 - 376.0 / 752.54) ** 2, rel=5e-3)
    assert run(model, 770.0, act=1.0).act[0] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(("depth", "filled"), [(5.0, 0.3173), (10.0, 0.4856), (20.0, 0.6575)])
def test_the_air_of_a_diving_bell_is_compressed_as_boyle_says(depth, filled):
    bell = Compartment(opening="hole", area=0.02, vent=False)
    water = Water(density=1025.0, level=depth - 0.5)
    model = build(CUBE, ("tank", bell), water=water, option="timestep='0.05'")
    data = run(model, 40.0)
    assert data.act[0] == pytest.approx(filled, abs=5e-5)
    assert data.act_dot[0] == pytest.approx(0.0, abs=1e-12)


def test_a_floating_box_floods_evenly_until_it_goes_under():
    # outside and inside heads differ by the draft of the empty box all along
    body = """
    <body pos="0 0 0.05">
      <joint type="slide" axis="0 0 1" damping="200"/>
      <geom name="hold" type="box" size="0.5 0.25 0.2" mass="75"/>
      <site name="hole" pos="0 0 -0.2"/>
    </body>
    """
    model = build(body, ("hold", HOLE), option="timestep='0.02' integrator='implicitfast'")
    data = run(model, 20.0)
    start, early = data.time, data.act[0]
    while data.qpos[0] > -0.25:
        mujoco.mj_step(model, data)
        if data.time < 100.0:
            late, end = data.act[0], data.time
    assert (late - early) / (end - start) / 0.5 == pytest.approx(0.0020586, rel=1e-3)
    assert data.time == pytest.approx(121.4, abs=0.4)


@pytest.mark.parametrize("timestep", [0.01, 1.0])
def test_levels_that_are_equal_stay_so_without_chatter(timestep):
    wide = Compartment(opening="hole", area=0.05)
    model = build(CUBE, ("tank", wide), water=Water(level=0.1), option=f"timestep='{timestep}'")
    data = run(model, 30.0)
    flows = []
    for _ in range(20):
        mujoco.mj_step(model, data)
        flows.append(data.act_dot[0])
    assert data.act[0] == pytest.approx(0.6, abs=1e-9)
    assert np.abs(flows).max() < 1e-9


def test_an_opening_above_the_water_lets_nothing_in_and_holds_what_is_below_it():
    body = CUBE.replace("0 0 -0.5", "0 0 0.2")
    model = build(body, ("tank", HOLE), water=Water(level=0.1), option="timestep='1'")
    assert run(model, 50.0).act[0] == 0.0
    assert run(model, 50.0, act=0.5).act[0] == 0.5
    # what is above it drains
    assert run(model, 2000.0, act=0.9).act[0] == pytest.approx(0.7, abs=1e-6)


def test_pumps_keep_to_their_rate_and_stop_exactly_at_the_limits():
    model = build(CUBE, ("tank", Tank(capacity=0.3, rate=0.07)), option="timestep='0.03'")
    data = run(model, 3.0, ctrl=9.0)
    assert data.act[0] == pytest.approx(0.21, rel=1e-12)
    for _ in range(100):
        mujoco.mj_step(model, data)
    assert data.act[0] == 0.3
    data.ctrl[:] = -1.0
    for _ in range(200):
        mujoco.mj_step(model, data)
    assert data.act[0] == 0.0


# inertia, momentum and energy ---------------------------------------------------------------------

FREE = "<freejoint/>"
HINGE = "<joint type='hinge' axis='0 1 0'/>"
LINK = """
<body pos="0.5 0 0">
  <joint type="hinge" axis="1 1 0"/>
  <geom type="box" size="0.2 0.05 0.05" mass="3" contype="0" conaffinity="0"/>
</body>
"""


def tank_and_twin(joint, more, water, option):
    """A body with a tank that is filled to a third, and one with that water as a geom."""
    body = """
    <body euler="20 30 10">{joint}
      <geom name="h" type="ellipsoid" size="0.6 0.4 0.3" mass="40" contype="0" conaffinity="0"/>
      <body pos="0.1 0.05 -0.05" euler="0 25 40">
        <geom name="t" type="box" size="0.2 0.15 0.1" mass="0" contype="0" conaffinity="0"/>{water}
      </body>{more}
    </body>
    """
    fixed = (
        '<geom type="box" size="0.2 0.15 0.03" pos="0 0 -0.07" mass="7.2" contype="0" '
        'conaffinity="0"/>'
    )
    choice = {"selection": Selection(geoms=("h", "t")), "water": water, "option": option}
    tank = ("t", Tank(rate=1.0, solid=True))
    return (
        build(body.format(joint=joint, water="", more=more), tank, **choice),
        build(body.format(joint=joint, water=fixed, more=more), **choice),
    )


@pytest.mark.parametrize("integrator", ["RK4", "Euler"])
@pytest.mark.parametrize(
    ("joint", "more", "water"),
    [(FREE, "", FAR_BELOW), (FREE, "", Water(level=100.0)), (HINGE, LINK, FAR_BELOW)],
)
def test_a_body_with_water_in_a_tank_moves_like_one_that_has_its_mass(
    joint, more, water, integrator
):
    option = f"timestep='0.002' integrator='{integrator}'"
    model, twin = tank_and_twin(joint, more, water, option)
    speed = np.linspace(1.0, 3.0, model.nv)
    data = run(model, 0.8, act=7.2e-3, ctrl=7.2e-3, qvel=speed)
    other = run(twin, 0.8, qvel=speed)
    assert np.allclose(data.qpos, other.qpos, rtol=0.0, atol=1e-11)
    assert np.allclose(data.qvel, other.qvel, rtol=0.0, atol=1e-10)


def test_a_tank_with_a_level_surface_keeps_the_energy_of_a_pendulum():
    body = """
    <body>
      <joint type="hinge" axis="0 1 0"/>
      <geom type="box" size="0.5 0.05 0.05" mass="5"/>
      <geom name="t" type="box" size="0.3 0.15 0.1" pos="0 0 -0.4" mass="0"/>
    </body>
    """
    option = "timestep='0.002' integrator='RK4'"
    model = build(body, ("t", Tank(rate=1.0)), water=FAR_BELOW, option=option)
    (tank,) = find_ballasts(model)
    data = mujoco.MjData(model)
    volume = data.act[0] = data.ctrl[0] = 0.012
    data.qpos[0] = 0.6
    energies, mass, heights = [], np.zeros((1, 1)), []
    for step in range(1000):
        mujoco.mj_step(model, data)
        if step % 50 == 0:
            mujoco.mj_forward(model, data)
            mujoco.mj_fullM(model, data, mass)
            turn = data.geom_xmat[tank.geom].reshape(3, 3)
            heights.append(tank.find_centroid(volume, turn, data.geom_xpos[tank.geom])[2])
            kinetic = 0.5 * mass[0, 0] * data.qvel[0] ** 2
            lifted = 5.0 * data.xipos[1, 2] + 1000.0 * volume * heights[-1]
            energies.append(kinetic + 9.81 * lifted)
    assert np.ptp(heights) > 0.01
    assert np.ptp(energies) < 1e-7


def test_water_comes_aboard_with_its_own_velocity_and_leaves_with_the_bodys():
    body = """
    <body>
      <joint type="slide" axis="1 0 0"/>
      <geom name="t" type="box" size="0.2 0.2 0.2" mass="50"/>
    </body>
    """
    model = build(
        body,
        ("t", Tank(capacity=0.04, rate=0.02)),
        water=Water(level=100.0, current=(0.5, 0.0, 0.0)),
        option="gravity='0 0 0' timestep='0.002'",
        damping=None,
    )
    data = run(model, 3.0, ctrl=0.04, qvel=2.0)
    assert data.qvel[0] == pytest.approx((50.0 * 2.0 + 40.0 * 0.5) / 90.0, rel=1e-3)
    faster = data.qvel[0]
    data.ctrl[0] = 0.0
    for _ in range(1500):
        mujoco.mj_step(model, data)
    assert data.act[0] == 0.0
    assert data.qvel[0] == pytest.approx(faster, rel=1e-12)


SPINNER = """
<body euler="20 30 10">
  {joint}
  <geom type="box" size="0.1 0.1 0.1" mass="2"/>
  <geom name="t" type="box" size="0.2 0.2 0.2" pos="0.5 0 0" mass="0"/>
</body>
"""
WEIGHTLESS = "gravity='0 0 0' timestep='0.004' integrator='RK4'"


def test_water_at_rest_that_fills_a_tank_leaves_the_momentum_of_a_body_that_tumbles():
    tank = ("t", Tank(capacity=0.04, rate=0.02))
    body = SPINNER.format(joint=FREE)
    model = build(body, tank, water=FAR_BELOW, option=WEIGHTLESS)
    data, mass = mujoco.MjData(model), np.zeros((6, 6))
    data.qvel[:] = 0.3, 0.2, 0.1, 1.0, 0.5, -0.7
    data.ctrl[0] = 0.04

    def momentum():
        mujoco.mj_forward(model, data)
        mujoco.mj_fullM(model, data, mass)
        linear, angular = np.split(mass @ data.qvel, 2)
        return [*linear, *np.cross(data.qpos[:3], linear), *data.xmat[1].reshape(3, 3) @ angular]

    def total():
        both = np.array(momentum())
        return np.concatenate([both[:3], both[3:6] + both[6:]])

    start, speed = total(), data.qvel.copy()
    mujoco.mj_step(model, data, 550)
    assert data.act[0] == pytest.approx(0.04)
    assert np.allclose(total(), start, rtol=0.0, atol=1e-4 * np.abs(start).max())
    assert np.linalg.norm(data.qvel) < 0.2 * np.linalg.norm(speed)


def test_water_that_leaves_a_spinning_tank_takes_along_what_it_has_at_the_opening():
    # d(I w) = rho c^2 w dV at the opening, and I = I_0 + a V
    body = SPINNER.format(joint="<joint type='hinge' axis='0 0 1'/>").replace("20 30 10", "0 0 0")
    model = build(body, ("t", Tank(rate=0.01)), water=FAR_BELOW, option=WEIGHTLESS)
    data = run(model, 3.0, act=0.02, ctrl=0.0, qvel=2.0)
    hull, slope, opening = 2.0 * 0.02 / 3.0, 1000.0 * (0.25 + 0.08 / 3.0), 1000.0 * 0.25
    ratio = hull / (hull + slope * 0.02)
    assert data.act[0] == pytest.approx(0.0, abs=1e-15)
    assert data.qvel[0] == pytest.approx(2.0 * ratio ** (opening / slope - 1.0), rel=1e-3)


# shapes -------------------------------------------------------------------------------------------


def test_a_tank_that_is_a_mesh_is_like_the_box_of_its_shape():
    corners = " ".join(
        f"{x} {y} {z}" for x in (-0.3, 0.3) for y in (-0.2, 0.2) for z in (-0.1, 0.1)
    )
    body = """
    <body euler="5 0 0">
      <freejoint/>
      <geom name="hull" type="box" size="1 0.5 0.25" mass="300"/>
      <geom name="t" {shape} pos="0.3 0.1 0.05" euler="0 0 30" mass="0" contype="0"
        conaffinity="0"/>
    </body>
    """
    ends = []
    for shape in ('type="box" size="0.3 0.2 0.1"', 'type="mesh" mesh="box"'):
        spec = mujoco.MjSpec.from_string(
            f"""<mujoco><option timestep="0.01"/>
            <asset><mesh name="box" vertex="{corners}"/></asset>
            <worldbody>{body.format(shape=shape)}</worldbody></mujoco>"""
        )
        add_ballast(spec, spec.geom("t"), Tank(rate=0.01))
        add_water(spec)
        ends.append(run(spec.compile(), 1.0, ctrl=0.01).qpos)
    assert np.allclose(*ends, rtol=0.0, atol=1e-6)


@pytest.mark.parametrize("up", [(0.0, 0.0, 1.0), (0.48, -0.6, 0.64)])
def test_water_in_a_tank_has_the_moments_of_the_solid_below_its_level(up):
    mesh, normal = shapes.capsule(0.3, 0.5), np.array(up)
    solid = trimesh.Trimesh(mesh.vertices, mesh.faces)
    below = solid.slice_plane(0.1 * normal, -normal, cap=True)
    volume, x, y, z, *second = integrate_below(mesh, normal, 0.1)
    assert volume == pytest.approx(below.volume, rel=1e-9)
    assert np.allclose([x, y, z], volume * below.center_mass, atol=1e-9)
    about = below.moment_inertia + volume * (
        below.center_mass @ below.center_mass * np.eye(3)
        - np.outer(below.center_mass, below.center_mass)
    )
    xx, yy, zz, xy, xz, yz = second
    assert np.allclose(about, [[yy + zz, -xy, -xz], [-xy, xx + zz, -yz], [-xz, -yz, xx + yy]])

    # and the level is where that volume is
    level, centroid = TankShape(mesh).find_level(normal, volume)
    assert level == pytest.approx(0.1, abs=1e-9)
    assert np.allclose(centroid, below.center_mass, atol=1e-9)


def test_the_moments_of_a_box_are_exact_at_any_fill():
    first, second = measure_fill(shapes.box((1.0, 0.5, 0.2)), np.array([0.0, 0.0, 1.0])).moments(
        0.3
    )
    top = -0.2 + 0.3 / 2.0
    assert np.allclose(first, [0.0, 0.0, top**2 - 0.04], atol=1e-14)
    expected = [0.3 / 3.0, 0.3 / 12.0, 2.0 * (top**3 + 0.008) / 3.0]
    assert np.allclose(second, np.diag(expected), atol=1e-14)


# bladders -----------------------------------------------------------------------------------------

SPAR = """
<body pos="0 0 -0.2">
  <joint type="slide" axis="0 0 1"/>
  <geom name="spar" type="cylinder" size="0.1 0.5" mass="20"/>
</body>
"""


def test_a_bladder_lifts_by_the_water_that_it_displaces():
    model = build(SPAR, ("spar", Bladder(capacity=0.002, rate=1.0)), water=Water(level=5.0))
    data = run(model, 0.0, act=0.0015)
    mujoco.mj_forward(model, data)
    loads = water_in(model).loads(data)
    assert loads.by_cause["ballast"][1] == pytest.approx([0, 0, 1000 * 9.81 * 0.0015, 0, 0, 0])
    # the hull itself is what it was
    assert loads.total.volume == pytest.approx(math.pi * 0.01, rel=1e-9)


def test_a_bladder_scales_what_waves_do_to_its_geom():
    water = Water(level=0.4, waves=RegularWave(0.1, period=2.0))
    model = build(
        SPAR.replace("slide' axis='0 0 1", "free"),
        ("spar", Bladder(capacity=0.002, rate=1.0)),
        water=water,
        pressure="froude-krylov",
    )
    data = run(model, 0.0, act=0.001)
    mujoco.mj_forward(model, data)
    causes = water_in(model).loads(data).by_cause
    share = 0.001 / (math.pi * 0.01)
    expected = share * (causes["buoyancy"] + causes["wave_pressure"])
    assert np.abs(causes["wave_pressure"][1]).max() > 1.0
    assert np.allclose(causes["ballast"], expected, rtol=1e-12, atol=1e-12)


def test_a_bladder_in_the_bow_of_a_hull_lifts_the_bow():
    body = """
    <body>
      <freejoint/>
      <geom name="hull" type="ellipsoid" size="0.8 0.1 0.1" mass="30"/>
      <geom name="bow" type="sphere" size="0.03" pos="0.6 0 0" mass="0"/>
    </body>
    """
    model = build(body, ("bow", Bladder(capacity=5e-4, rate=1.0)), water=Water(level=5.0))
    data = run(model, 0.0, act=5e-4)
    mujoco.mj_forward(model, data)
    lift = 1000.0 * 9.81 * 5e-4
    expected = [0.0, 0.0, lift, 0.0, -0.6 * lift, 0.0]
    assert water_in(model).loads(data).by_cause["ballast"][1] == pytest.approx(expected, abs=1e-9)


def test_a_bladder_brings_a_float_to_the_draft_that_statics_say():
    body = SPAR.replace('axis="0 0 1"', 'axis="0 0 1" damping="60"')
    model = build(body, ("spar", Bladder(capacity=0.004, rate=0.002)), option="timestep='0.01'")
    data = run(model, 30.0, ctrl=0.003)
    # the wet part of the spar, and of the bladder over all of it, carry 20 kg
    share = 1.0 + 0.003 / (math.pi * 0.01)
    draft = 20.0 / 1000.0 / (math.pi * 0.01) / share
    assert 0.5 - (data.qpos[0] - 0.2) == pytest.approx(draft, abs=1e-4)
    free = body.replace('<joint type="slide" axis="0 0 1" damping="60"/>', "<freejoint/>")
    afloat = build(free, ("spar", Bladder(capacity=0.004, rate=0.002)))
    assert equilibrium(afloat, stable=False, ballast=[0.003]).hydrostatics.draft == pytest.approx(
        draft, rel=1e-6
    )


# statics ------------------------------------------------------------------------------------------

BARGE = """
<body name="barge">
  <freejoint/>
  <geom name="hull" type="box" size="1 0.5 0.25" mass="300"/>
  <geom name="t" type="{kind}" size="{size}" pos="{pos}" euler="{euler}" mass="0" contype="0"
    conaffinity="0"/>
</body>
"""
MIDSHIPS = BARGE.format(kind="box", size="0.4 0.3 0.2", pos="0 0 0", euler="0 0 0")


def test_a_free_surface_takes_its_moment_over_the_displacement_off_the_metacentric_height():
    model = build(MIDSHIPS, ("t", Tank(rate=0.01)))
    at = equilibrium(model, ballast={"t": 0.06}).hydrostatics
    assert at.draft == pytest.approx(0.18, rel=1e-9)
    correction = 0.8 * 0.6**3 / 12.0 / 0.36
    assert at.KB + at.BMt - at.KG - at.GMt == pytest.approx(correction, rel=1e-9)
    # and off the righting arm
    heel = math.radians(0.1)
    arm = righting_arm(model, heel=[0.0, heel], ballast={"t": 0.06})
    assert arm.gz[1] / math.sin(heel) == pytest.approx(at.GMt, rel=1e-4)
    # water that a piston holds does not
    solid = build(MIDSHIPS, ("t", Tank(rate=0.01, solid=True)))
    assert equilibrium(solid, ballast={"t": 0.06}).hydrostatics.GMt == pytest.approx(
        at.GMt + correction, rel=1e-9
    )


def test_force_and_stiffness_are_slopes_of_the_energy_with_water_in_tanks():
    vessel = build_vessel(build(MIDSHIPS, ("t", Tank(rate=0.01))), ballast=[0.06])
    quat, turn = np.array([0.98, 0.1, 0.06, 0.15]), np.zeros(9)
    mujoco.mju_quat2Mat(turn, quat / np.linalg.norm(quat))
    position, step = np.array([0.1, 0.2, 0.02]), 1e-5

    def at(move):
        half = np.array([1.0, 0.5 * move[1], 0.5 * move[2], 0.0])
        by = np.zeros(9)
        mujoco.mju_quat2Mat(by, half / np.linalg.norm(half))
        rotation = by.reshape(3, 3) @ turn.reshape(3, 3)
        return pose_vessel(vessel, position + [0.0, 0.0, move[0]], rotation)

    pairs = [(at(step * axis), at(-step * axis)) for axis in np.eye(3)]
    slopes = [(low.energy - high.energy) / (2.0 * step) for high, low in pairs]
    bends = np.column_stack([(low.force - high.force) / (2.0 * step) for high, low in pairs])
    assert np.allclose(at(np.zeros(3)).force, slopes, rtol=0.0, atol=1e-4)
    assert np.allclose(at(np.zeros(3)).stiffness, bends, rtol=0.0, atol=1e-3)


@pytest.mark.parametrize("what", ["ballast", "act"])
def test_a_tank_trims_a_barge_as_the_equilibrium_of_the_loaded_model_says(what):
    body = BARGE.format(kind="cylinder", size="0.2 0.15", pos="0.6 0.1 0", euler="90 0 0")
    model = build(
        body,
        ("t", Tank(rate=0.01)),
        option="timestep='0.01' integrator='implicitfast'",
        numerics=[("linear_damping:barge", [50, 50, 1500, 150, 400, 50])],
    )
    rest = equilibrium(model, ballast={"t": 0.012} if what == "ballast" else np.array([0.012]))
    data = run(model, 30.0, ctrl=0.012)
    attitude = Attitude.from_matrix(data.xmat[1].reshape(3, 3))
    assert abs(rest.hydrostatics.trim) > 0.01
    assert attitude.trim == pytest.approx(rest.hydrostatics.trim, abs=2e-5)
    assert attitude.heel == pytest.approx(rest.hydrostatics.heel, abs=2e-5)
    assert data.qpos[2] == pytest.approx(rest.qpos[2], abs=2e-5)


def test_a_tank_in_a_tender_vessel_makes_it_loll():
    # KM 0.266 m of the empty barge: a deep pool on deck lays it over
    body = BARGE.format(kind="box", size="0.9 0.45 0.1", pos="0 0 0.3", euler="0 0 0")
    model = build(body, ("t", Tank(rate=0.01)))
    assert equilibrium(model).hydrostatics.heel == pytest.approx(0.0, abs=1e-9)
    loaded = equilibria(model, ballast={"t": 0.08})
    assert abs(loaded[0].hydrostatics.heel) > 0.05
    assert hydrostatics(model, qpos=[0, 0, 0.06, 1, 0, 0, 0], ballast={"t": 0.08}).GMt < 0.0


def test_inspect_reports_what_ballast_holds(tmp_path):
    spec = mujoco.MjSpec.from_string(f"<mujoco><worldbody>{MIDSHIPS}</worldbody></mujoco>")
    add_ballast(spec, "t", Tank(rate=0.01, capacity=0.1))
    path = tmp_path / "barge.xml"
    path.write_text(spec.to_xml())
    result = CliRunner().invoke(app, ["inspect", str(path), "--ballast", "t=0.06"])
    assert result.exit_code == 0
    assert "Ballast systems" in result.output
    assert "0.04, " in next(x for x in result.output.splitlines() if "lost to free surfaces" in x)
    wrong = CliRunner().invoke(app, ["inspect", str(path), "--ballast", "fore=0.06"])
    assert "the model has no ballast 'fore'; possible: t" in " ".join(wrong.output.split())


# the engine ---------------------------------------------------------------------------------------


def loaded_barge():
    spec = mujoco.MjSpec.from_string(
        f"<mujoco><option timestep='0.01'/><worldbody>{MIDSHIPS}</worldbody></mujoco>"
    )
    spec.worldbody.bodies[0].add_site(name="hole", pos=[0.5, 0.2, -0.25])
    spec.worldbody.bodies[0].add_geom(
        name="hold", type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.2, 0.2, 0.2], pos=[0.7, 0, 0], mass=0,
        contype=0, conaffinity=0,
    )  # fmt: skip
    add_ballast(spec, "t", Tank(rate=0.005))
    add_ballast(spec, "hold", Compartment(opening="hole", area=1e-3))
    add_ballast(spec, "hull", Bladder(capacity=0.02, rate=0.005))
    return spec


def test_rollouts_and_batches_fill_tanks_bit_for_bit():
    spec = loaded_barge()
    add_water(spec, Water(waves=RegularWave(0.05, period=2.0)))
    model = spec.compile()
    data = mujoco.MjData(model)
    data.ctrl[:] = 0.05, 0.0, 0.01
    start = np.empty(mujoco.mj_stateSize(model, STATE))
    mujoco.mj_getState(model, data, start, STATE)
    for _ in range(40):
        mujoco.mj_step(model, data)
    end = np.empty_like(start)
    mujoco.mj_getState(model, data, end, STATE)
    datas = [mujoco.MjData(model) for _ in range(2)]
    controls = np.tile(data.ctrl, (4, 40, 1))
    states, _ = rollout.rollout(model, datas, np.tile(start, (4, 1)), controls)
    assert data.act.min() > 0.0
    assert (states[:, -1] == end).all()


def test_water_that_is_installed_or_called_acts_on_tanks_as_a_models_own():
    water = Water(waves=RegularWave(0.05, period=2.0))
    spec = loaded_barge()
    add_water(spec, water)
    own = run(spec.compile(), 0.2, ctrl=[0.05, 0.0, 0.01])
    bare = loaded_barge().compile()
    for native in (True, False):
        with Buoyancy(bare, water).installed(native=native):
            data = run(bare, 0.2, ctrl=[0.05, 0.0, 0.01])
        assert np.allclose(data.qpos, own.qpos, rtol=0.0, atol=1e-12)
        assert np.allclose(data.act, own.act, rtol=0.0, atol=1e-14)


def test_saved_and_attached_models_keep_their_ballast():
    spec = loaded_barge()
    add_water(spec)
    direct = run(spec.compile(), 0.2, ctrl=[0.05, 0.0, 0.01])
    read = run(mujoco.MjModel.from_xml_string(spec.to_xml()), 0.2, ctrl=[0.05, 0.0, 0.01])
    assert (read.act == direct.act).all()
    parent, child = mujoco.MjSpec(), loaded_barge()
    add_water(child)
    parent.option.timestep = 0.01
    parent.attach(child, prefix="one/", frame=parent.worldbody.add_frame())
    attached = run(parent.compile(), 0.2, ctrl=[0.05, 0.0, 0.01])
    assert np.allclose(attached.act, direct.act, rtol=0.0, atol=1e-12)
    assert np.allclose(attached.qpos, direct.qpos, rtol=0.0, atol=1e-9)


# what makes no sense ------------------------------------------------------------------------------


def test_a_tank_that_holds_water_where_none_acts_is_told():
    bare = loaded_barge().compile()
    data = mujoco.MjData(bare)
    mujoco.mj_step(bare, data)
    data.act[0] = 0.01
    with pytest.raises(mujoco.FatalError, match="'t' holds water and no water acts on its body"):
        mujoco.mj_step(bare, data)


TANK = Tank(rate=0.01)


@pytest.mark.parametrize(
    ("geom", "ballast", "message"),
    [
        ("tenk", TANK, "the model has no geom 'tenk'; possible: hull, t"),
        (
            "t",
            Tank(rate=0.01, capacity=0.5),
            "has a capacity of 0.5 m^3, and its geom 't' a volume",
        ),
        ("t", Compartment(opening="hull", area=1e-3), "is the site 'hull', and there is none"),
        ("t", Bladder(capacity=1e-3, rate=1e-4), "'t', which displaces no water"),
        ("t", "Tank", "ballast is 'Tank'; it must be a Bladder, a Tank or a Compartment"),
    ],
)
def test_ballast_that_does_not_fit_the_model_is_refused(geom, ballast, message):
    with pytest.raises((ModelError, mujoco.FatalError, ValueError), match=re.escape(message)):
        build(MIDSHIPS, (geom, ballast))


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Tank(rate=-1.0), "tank rate is -1.0; it must be above 0"),
        (lambda: Tank(rate=1.0, capacity=-0.1), "tank capacity is -0.1; it must be above 0"),
        (lambda: Bladder(capacity=0.0, rate=1.0), "bladder capacity is 0.0; it must be above 0"),
        (lambda: Tank(rate=1.0, solid=1), "tank solid is 1; it must be true or false"),
        (lambda: Compartment(opening="a", area=0.0), "compartment area is 0.0; it must be above 0"),
        (
            lambda: Compartment(opening="a", area=1.0, discharge=1.5),
            "compartment discharge is 1.5; it must be at most 1",
        ),
    ],
)
def test_numbers_out_of_range_are_refused(make, message):
    with pytest.raises(ModelError, match=message):
        make()


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("tank", "tonk", "is of the kind 'tonk'; did you mean 'tank'?"),
        ("rate", "area", "a tank, has the key 'area'; possible: capacity, rate, solid"),
        ('actdim="1"', 'actdim="2"', "keeps 2 states; write actdim='1'"),
        ('value="t"', 'value="tt"', "geom: the model has no geom named 'tt'"),
        ('actdim="1"', 'actdim="1" dyntype="integrator"', "has a dyntype, which it does not foll"),
        ('value="0.01"', 'value="fast"', "tank rate is 'fast'; it must be a finite number"),
        ('value="t"', 'value="hull"', ""),
        ('value="t"', 'value="pier"', "names the geom 'pier', whose body cannot move"),
        ('value="t"', 'value="sea"', "and a plane bounds no volume"),
        ('site="s"', 'site="quay"', "is at a site of the body 'world', and its geom moves with"),
        ('site="s"', 'joint="j"', "is not at a site; write site='...'"),
    ],
)
def test_mjcf_that_makes_no_sense_is_refused(old, new, message):
    text = f"""
    <mujoco>
      <extension><plugin plugin="buoyancy_mj.ballast"/></extension>
      <worldbody>
        {MIDSHIPS.replace("<freejoint/>", '<freejoint name="j"/><site name="s"/>')}
        <geom name="pier" type="box" size="1 1 1" pos="9 0 0"/><site name="quay"/>
        <geom name="sea" type="plane" size="9 9 1" pos="0 0 -9"/>
      </worldbody>
      <actuator>
        <plugin name="t" plugin="buoyancy_mj.ballast" site="s" actdim="1">
          <config key="kind" value="tank"/>
          <config key="geom" value="t"/>
          <config key="rate" value="0.01"/>
        </plugin>
      </actuator>
    </mujoco>
    """
    assert old in text
    changed = text.replace(
        f'"{old}"' if old.isalpha() else old, f'"{new}"' if new.isalpha() else new
    )
    if not message:
        mujoco.MjData(mujoco.MjModel.from_xml_string(changed))
        return
    with pytest.raises((ModelError, mujoco.FatalError, ValueError), match=re.escape(message)):
        mujoco.MjData(mujoco.MjModel.from_xml_string(changed))


@pytest.mark.parametrize("affixes", [{"prefix": "rov/"}, {"suffix": "_2"}, {"prefix": "a_"}])
def test_ballast_that_was_attached_is_in_the_geom_that_came_with_it(affixes):
    parent = mujoco.MjSpec.from_string("<mujoco><option timestep='0.01'/></mujoco>")
    parent.attach(loaded_barge(), frame=parent.worldbody.add_frame(), **affixes)
    add_water(parent, Water())
    model = parent.compile()
    names = [model.geom(placed.geom).name for placed in find_ballasts(model)]
    prefix, suffix = affixes.get("prefix", ""), affixes.get("suffix", "")
    assert [name.lstrip("/") for name in names] == [
        f"{prefix}{geom}{suffix}" for geom in ("t", "hold", "hull")
    ]


def test_a_command_that_is_no_number_leaves_a_tank_as_it_is():
    spec = loaded_barge()
    add_water(spec, Water())
    model = spec.compile()
    data = mujoco.MjData(model)
    data.act[0] = 0.01
    for value in (math.nan, math.inf):
        data.ctrl[0] = value
        mujoco.mj_step(model, data)
    assert data.act[0] == 0.01
    assert data.warning[mujoco.mjtWarning.mjWARN_BADCTRL].number == 2


def test_a_body_whose_inertia_is_kept_as_a_diagonal_has_no_room_for_water():
    spec = loaded_barge()
    spec.body("barge").simple = True
    spec.delete(spec.geom("hold"))
    for name in ("hold",):
        spec.delete(next(one for one in spec.actuators if one.name == name))
    with pytest.raises(ModelError, match="does not fit there; write <body simple='false'>"):
        Buoyancy(spec.compile())


def test_a_name_is_taken_once_and_volumes_keep_to_their_limits():
    spec = loaded_barge()
    spec.worldbody.add_geom(name="pier", size=[1, 1, 1])
    with pytest.raises(ModelError, match="the geom 'pier' is fixed to the world"):
        add_ballast(spec, "pier", TANK)
    with pytest.raises(ModelError, match="already has an actuator or a plugin instance 't'"):
        add_ballast(spec, "t", TANK)
    model = spec.compile()
    with pytest.raises(
        ModelError, match=r"the volume of ballast 't' is 1.0; it must be at least 0"
    ):
        hydrostatics(model, ballast={"t": 1.0})
    with pytest.raises(ModelError, match="ballast is"):
        hydrostatics(model, ballast=[0.1])
    spec = loaded_barge()
    add_ballast(spec, "t", TANK, name="other")
    add_water(spec)
    with pytest.raises((ModelError, mujoco.FatalError, ValueError), match="both hold water"):
        spec.compile()
