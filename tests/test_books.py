"""The books of added mass: energy, momentum and entries of bodies that enter and leave water."""

import math
import re
import warnings

import mujoco
import numpy as np
import pytest
from mujoco import batch
from scipy.integrate import solve_ivp

from buoyancy_mj import (
    Buoyancy,
    Damping,
    LevelOscillation,
    MethodError,
    ModelError,
    RegularWave,
    SceneError,
    Selection,
    Settings,
    Water,
    add_water,
    water_in,
)
from buoyancy_mj.errors import BuoyancyWarning
from buoyancy_mj.kernels import clip, waterplane
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.scene import scene_from_table
from buoyancy_mj.scenes.simulation import Simulation
from buoyancy_mj.settings.config import parse_plugin_config, write_plugin_config
from buoyancy_mj.submersion.hull_set import HullSet
from buoyancy_mj.submersion.methods import parse_method
from tests import naive, vessels

G = 9.81
RADIUS = 0.15
SPHERE = 1000.0 * 4.0 / 3.0 * math.pi * RADIUS**3
"""Mass of water that the sphere displaces fully wet [kg]."""

# a hair off its origin, lest MuJoCo keep the inertia as a diagonal
BOX = """<body name="hull" pos="0 0 .1" euler="25 15 0"><freejoint/>
<inertial pos="0 0 1e-6" mass="15" diaginertia=".1625 .3625 .425"/>
<geom type="box" size=".25 .15 .1"/></body>"""
BALL = f"""<body name="hull" pos="0 0 .12"><freejoint/>
<inertial pos="0 0 1e-6" mass="{0.5 * SPHERE}" diaginertia=".06 .06 .06"/>
<geom type="sphere" size="{RADIUS}"/></body>"""
PAIR = """<body name="hull" pos="0 0 .05" euler="20 10 0"><freejoint/>
<inertial pos="0 0 1e-6" mass="8" diaginertia=".1 .2 .22"/><geom type="box" size=".25 .15 .08"/>
<body name="arm" pos=".3 0 0"><joint axis="0 1 .3"/>
<inertial pos=".2 0 0" mass="2" diaginertia=".005 .03 .03"/>
<geom type="capsule" size=".06" fromto=".05 0 0 .4 0 0"/></body></body>"""


def model_of(bodies, timestep=0.002, integrator="RK4", gravity=G):
    """A model of bodies in MJCF; or the hourglass that ships, let go leaning."""
    if bodies != "hourglass":
        return mujoco.MjModel.from_xml_string(
            f"""<mujoco><option timestep="{timestep}" integrator="{integrator}"
            gravity="0 0 {-gravity}"/><worldbody>{bodies}</worldbody></mujoco>"""
        )
    spec = mujoco.MjSpec.from_file(str(catalog.models()["hourglass"]))
    spec.option.timestep = timestep
    spec.option.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator.upper()}")
    hull = spec.body("hourglass")
    hull.pos, hull.quat = [0.0, 0.0, 0.1], [0.9, 0.3, 0.2, 0.1]
    return spec.compile()


def energy(model, buoyancy, data):
    """Energy [J] of bodies, of the water that they displace, and of that which they move along."""
    moments = np.zeros(model.nv)
    mujoco.mj_mulM(model, data, moments, data.qvel)
    loads = buoyancy.evaluate(data)
    lifted = buoyancy.water.depth(loads.hull.centroid, data.time)
    raised = np.nansum(loads.hull.force[:, 2] * lifted)
    weights = -model.opt.gravity[2] * model.body_mass
    return 0.5 * data.qvel @ moments + weights @ data.xipos[:, 2] + raised


def drift(bodies, duration, samples=100, **options):
    """Most that the energy of undamped bodies strays from the start, over m g 0.2 m."""
    timestep, integrator = options.pop("timestep", 0.002), options.pop("integrator", "RK4")
    model = model_of(bodies, timestep, integrator)
    data, copy = mujoco.MjData(model), mujoco.MjData(model)
    buoyancy = Buoyancy(model, damping=None, added_mass="estimate", **options)
    energies = []
    with buoyancy.installed():
        for _ in range(samples + 1):
            copy.qpos[:], copy.qvel[:] = data.qpos, data.qvel
            mujoco.mj_forward(model, copy)
            energies.append(energy(model, buoyancy, copy))
            mujoco.mj_step(model, data, round(duration / timestep / samples))
    return (np.array(energies) - energies[0]) / (0.2 * G * model.body_mass.sum())


# energy


@pytest.mark.parametrize(
    ("bodies", "duration"), [(BOX, 60.0), (BALL, 20.0), (PAIR, 20.0), ("hourglass", 20.0)]
)
def test_an_undamped_body_keeps_its_energy(bodies, duration):
    assert np.abs(drift(bodies, duration)).max() < 2e-5


@pytest.mark.long
@pytest.mark.slow
def test_an_undamped_box_keeps_its_energy_for_ten_minutes():
    # without the change of the wet share it has gained 40 m g 0.2 m by then
    assert np.abs(drift(BOX, 600.0)).max() < 1e-4


@pytest.mark.parametrize(("bodies", "timestep"), [(BOX, 0.004), (PAIR, 0.016)])
def test_a_quarter_of_the_step_keeps_it_better_by_nearly_the_third_power(bodies, timestep):
    # RK4 is of the fourth order, and of the third where the waterplane has kinks
    coarse, fine = (np.abs(drift(bodies, 8.0, timestep=t)).max() for t in (timestep, timestep / 4))
    assert coarse > 32.0 * fine


@pytest.mark.parametrize("integrator", ["Euler", "implicitfast", "implicit"])
def test_integrators_of_first_order_keep_it_to_first_order(integrator):
    ends = [np.abs(drift(BALL, 5.0, timestep=t, integrator=integrator)).max() for t in (4e-3, 2e-3)]
    assert ends[0] < 1e-2
    assert ends[1] == pytest.approx(0.5 * ends[0], rel=0.2)


def test_a_light_ball_that_leaves_in_a_few_steps_loses_energy_and_less_with_shorter_steps():
    foam = f"""<body name="hull" pos="0 0 -.3"><freejoint/>
    <inertial pos="0 0 1e-6" mass=".5" diaginertia=".005 .005 .005"/>
    <geom type="sphere" size="{RADIUS}"/></body>"""
    tops = []
    for timestep in (0.002, 0.001, 0.00025):
        model = model_of(foam, timestep)
        data = mujoco.MjData(model)
        buoyancy = Buoyancy(model, damping=None, added_mass="estimate")
        mujoco.mj_forward(model, data)
        limit = energy(model, buoyancy, data) / (0.5 * G)
        with buoyancy.installed():
            while data.qvel[2] >= 0.0:
                mujoco.mj_step(model, data)
        tops.append(data.qpos[2])
    assert limit == pytest.approx(8.18, abs=0.01)
    assert tops == pytest.approx([6.73, 7.60, 8.14], abs=0.05)


def test_an_undamped_disc_that_tumbles_needs_rk4_or_drag():
    disc = """<body name="hull" pos="0 0 -50"><freejoint/>
    <inertial pos="0 0 1e-6" mass="5.65" diaginertia=".127 .127 .254"/>
    <geom type="cylinder" size=".3 .01"/></body>"""

    def growth(integrator, timestep, damping):
        model = model_of(disc, timestep, integrator, gravity=0.0)
        data, moments = mujoco.MjData(model), np.zeros(6)
        data.qvel[:] = [0.5, 0.5, 0.5, 1.0, 1.5, 0.5]
        ends = []
        with Buoyancy(model, damping=damping, added_mass="ellipsoid").installed():
            for steps in (0, round(5.0 / timestep)):
                mujoco.mj_step(model, data, steps)
                mujoco.mj_forward(model, data)
                mujoco.mj_mulM(model, data, moments, data.qvel)
                ends.append(data.qvel @ moments)
        return ends[1] / ends[0]

    assert growth("RK4", 0.002, None) == pytest.approx(1.0, abs=1e-6)
    assert growth("implicitfast", 0.002, None) == pytest.approx(3.6, rel=0.1)
    assert growth("implicitfast", 0.0005, None) == pytest.approx(1.2, rel=0.1)
    assert growth("implicitfast", 0.002, Damping()) < 0.5


def test_a_run_of_a_scene_books_the_energy_of_the_water_that_goes_along():
    model = catalog.models()["hourglass"]
    scene = scene_from_table(
        {
            "title": "drop",
            "vehicle": str(model),
            "duration": 4.0,
            "timestep": 0.002,
            "integrator": "RK4",
            "record_rate": 20.0,
            "damping": False,
            "added_mass": "ellipsoid",
            "start": {"position": [0.0, 0.0, 0.1], "roll": 40.0},
        }
    )
    totals = [frame.energy.total for frame in Simulation(scene).frames()]
    assert totals == pytest.approx([totals[0]] * len(totals), abs=2e-5 * 0.2 * G * 9.2)


# motion


def half_period(drop, added):
    """Half a period of a half-dense sphere let go a height over its rest, by its ODE."""
    mass = 0.5 * SPHERE

    def rates(_, y):
        # the cap that is wet: its volume, and how that changes with the height of the centre
        h = min(max(RADIUS - y[0], 0.0), 2.0 * RADIUS)
        volume, area = math.pi * h * h * (RADIUS - h / 3.0), math.pi * h * (2.0 * RADIUS - h)
        whole = SPHERE / 1000.0
        push = 1000.0 * G * volume - mass * G + 0.5 * added * area / whole * y[1] ** 2
        return [y[1], push / (mass + added * volume / whole)]

    def stops(t, y):
        return y[1] if t > 1e-3 else -1.0

    stops.terminal, stops.direction = True, 1.0
    found = solve_ivp(rates, (0, 5), [drop, 0.0], events=stops, rtol=1e-11, atol=1e-12)
    return found.t_events[0][0], found.y_events[0][0][0]


@pytest.mark.parametrize("radii", [0.2, 0.6, 1.0])
def test_a_sphere_that_bobs_far_has_the_period_of_its_equation_of_motion(radii):
    added, drop = 0.5 * SPHERE, radii * RADIUS
    model = model_of(BALL)
    data = mujoco.MjData(model)
    data.qpos[2] = drop
    lows, last = [], (0.0, 0.0)
    with Buoyancy(model, damping=None, added_mass={"hull": [added] * 3 + [0.0] * 3}).installed():
        while len(lows) < 5:
            mujoco.mj_step(model, data)
            if last[1] < 0.0 <= data.qvel[2]:
                share = last[1] / (last[1] - data.qvel[2])
                lows.append(last[0] + share * (data.time - last[0]))
            last = data.time, data.qvel[2]
    half, low = half_period(drop, added)
    assert lows[0] == pytest.approx(half, rel=1e-4)
    assert np.diff(lows).mean() == pytest.approx(2.0 * half, rel=1e-4)
    assert low == pytest.approx(-drop, abs=1e-9)


@pytest.mark.parametrize("depth", [0.0, 5.0])
def test_a_closed_pair_keeps_what_momentum_nothing_takes(depth):
    # the horizontal momentum of bodies and water, and their spin about the vertical
    model = model_of(PAIR)
    data = mujoco.MjData(model)
    data.qpos[2] -= depth
    data.qvel[:] = [0.5, -0.3, 0.2, 0.8, -0.5, 0.6, 1.5]

    def momentum():
        moments, turn = np.zeros(model.nv), np.zeros(9)
        mujoco.mj_forward(model, data)
        mujoco.mj_mulM(model, data, moments, data.qvel)
        mujoco.mju_quat2Mat(turn, data.qpos[3:7])
        spin = (turn.reshape(3, 3) @ moments[3:6])[2]
        x, y = data.qpos[:2]
        return np.array([*moments[:2], spin + x * moments[1] - y * moments[0]])

    with Buoyancy(model, damping=None, added_mass="estimate").installed():
        before = momentum()
        mujoco.mj_step(model, data, 600)
        assert momentum() == pytest.approx(before, abs=2e-5 * np.abs(before).max())


# entries


def falling(speed, **options):
    """A sphere on its way down into water, without weight and so without buoyancy."""
    model = model_of(BALL, gravity=0.0)
    data = mujoco.MjData(model)
    data.qpos[2], data.qvel[:3] = 1.1 * RADIUS, (0.3, 0.0, -speed)
    added = {"hull": [0.5 * SPHERE] * 3 + [0.0] * 3}
    return model, data, Buoyancy(model, damping=None, added_mass=added, **options)


def test_an_entry_shares_its_energy_with_the_water_and_an_exit_gets_it_back():
    # without weight (M + s A) v^2 stays as it is
    model, data, buoyancy = falling(1.0)
    with buoyancy.installed():
        while data.qpos[2] > -1.2 * RADIUS:
            mujoco.mj_step(model, data)
        assert data.qvel @ data.qvel == pytest.approx(0.5 * 1.09, rel=3e-5)
        # s A v is conserved along the surface, (M + s A) v in all
        assert data.qvel[0] == pytest.approx(0.15, rel=3e-5)
        data.qvel[2] = -data.qvel[2]
        while data.qpos[2] < 1.2 * RADIUS:
            mujoco.mj_step(model, data)
        assert data.qvel @ data.qvel == pytest.approx(1.09, rel=3e-4)
        assert data.qvel[0] == pytest.approx(0.3, rel=3e-4)


def test_with_slamming_an_entry_keeps_momentum_and_an_exit_keeps_energy():
    # von Karman 1929: (M + s A) v stays as it is
    model, data, buoyancy = falling(1.0, slamming=True)
    with buoyancy.installed():
        while data.qpos[2] > -1.2 * RADIUS:
            mujoco.mj_step(model, data)
        assert data.qvel[[0, 2]] == pytest.approx([0.15, -0.5], rel=3e-5)
        data.qvel[2] = -data.qvel[2]
        while data.qpos[2] < 1.2 * RADIUS:
            mujoco.mj_step(model, data)
        assert data.qvel @ data.qvel == pytest.approx(2.0 * (0.5**2 + 0.15**2), rel=3e-4)


def test_with_slamming_energy_only_falls():
    steps = np.diff(drift(BOX, 10.0, samples=500, slamming=True))
    assert steps.max() < 1e-7
    assert steps.sum() < -0.1


def test_with_slamming_a_sphere_that_bobs_by_a_fifth_of_its_radius_loses_what_the_guide_says():
    model = mujoco.MjModel.from_xml_string(f"""<mujoco>
      <option integrator="RK4" timestep=".002"/><worldbody><body><freejoint/>
      <geom size="{RADIUS}" density="500"/></body></worldbody></mujoco>""")
    data = mujoco.MjData(model)
    data.qpos[2] = 0.2 * RADIUS
    heights = [data.qpos[2]]
    water = Buoyancy(model, damping=None, added_mass="ellipsoid", slamming=True)
    with water.installed():
        while data.time < 1.2:
            mujoco.mj_step(model, data)
            heights.append(data.qpos[2])
    crest = max(heights[len(heights) // 2 :])
    assert crest / heights[0] == pytest.approx(0.94, abs=0.005)


def test_slamming_is_a_load_of_its_own_that_pushes_up_while_the_body_enters():
    model, data, buoyancy = falling(2.0, slamming=True)
    assert buoyancy.causes == ("buoyancy", "added_mass", "slamming")
    plain = falling(2.0)[2]
    assert plain.causes == ("buoyancy", "added_mass")
    data.qpos[2] = 0.5 * RADIUS
    mujoco.mj_forward(model, data)
    loads = buoyancy.evaluate(data).by_cause
    # straight down half of what the entry takes is given back, or kept
    data.qvel[0] = 0.0
    mujoco.mj_forward(model, data)
    loads = buoyancy.evaluate(data).by_cause
    assert loads["slamming"][1, 2] > 0.0
    assert loads["slamming"][1] == pytest.approx(loads["added_mass"][1], rel=1e-12)
    data.qvel[2] = 2.0
    mujoco.mj_forward(model, data)
    assert not buoyancy.evaluate(data).by_cause["slamming"].any()


@pytest.mark.parametrize("integrator", ["Euler", "implicitfast", "implicit", "RK4"])
@pytest.mark.parametrize("slamming", [False, True])
def test_a_plate_that_falls_flat_is_slowed_and_not_thrown_back(integrator, slamming):
    # five times its mass in added mass within a step or two
    model = model_of(
        """<body name="hull" pos="0 0 .3"><freejoint/>
        <inertial pos="0 0 1e-6" mass="12.5" diaginertia=".25 .25 .5"/>
        <geom type="box" size=".25 .25 .05"/></body>""",
        timestep=0.01,
        integrator=integrator,
    )
    data = mujoco.MjData(model)
    data.qvel[2] = -5.0
    added = {"hull": [0.0, 0.0, 62.5, 1.0, 1.0, 0.0]}
    speeds = []
    with Buoyancy(model, damping=None, added_mass=added, slamming=slamming).installed():
        while data.time < 0.15:
            mujoco.mj_step(model, data)
            speeds.append(data.qvel[2])
    assert np.isfinite(data.qpos).all()
    assert speeds[-1] > -3.0
    assert max(speeds) < 0.0
    # at most as much energy as it had, with that of the water: (M + A) v^2 <= M v0^2
    assert 6.0 * speeds[-1] ** 2 < 1.1 * (5.0**2 + 2.0 * G * 0.25)


def test_what_is_welded_to_a_body_helps_it_to_bear_an_entry():
    # a shell of 5 g round 5 kg: the shell alone would be held
    shell = f"""<body name="hull" pos="0 0 .17"><freejoint/>
        <inertial pos="0 0 1e-6" mass=".005" diaginertia="1e-4 1e-4 1e-4"/>
        <geom type="sphere" size="{RADIUS}"/>
        <body><inertial pos="0 0 0" mass="5" diaginertia=".02 .02 .02"/></body></body>"""
    model = model_of(shell, gravity=0.0)
    data = mujoco.MjData(model)
    data.qvel[2] = -3.0
    added = {"hull": [5.005] * 3 + [0.0] * 3}
    with Buoyancy(model, damping=None, added_mass=added).installed():
        while data.qpos[2] > -0.17:
            mujoco.mj_step(model, data)
    assert data.qvel[2] == pytest.approx(-3.0 / math.sqrt(2.0), rel=1e-5)


# the load itself


def tumbling(seed):
    """An ellipsoid with its centre away from its origin, half under water, in any motion."""
    model = vessels.of_geoms(
        '<geom name="g" type="ellipsoid" size=".3 .2 .12" pos=".1 .05 -.02" mass="14"/>'
    )
    rng = np.random.default_rng(seed)
    data = mujoco.MjData(model)
    data.qpos[2] = rng.uniform(-0.05, 0.05)
    data.qpos[3:7] = rng.normal(size=4)
    data.qvel[:] = rng.normal(size=6)
    data.time = 0.7
    return model, data, rng


@pytest.mark.parametrize("slamming", [False, True])
@pytest.mark.parametrize("seed", range(6))
def test_the_reaction_is_that_of_differences_of_the_wet_volume(seed, slamming):
    model, data, rng = tumbling(seed)
    root = rng.normal(size=(6, 6))
    for water, tolerance in (
        (Water(), 1e-6),
        (Water(current=(0.4, -0.2, 0.1)), 1e-6),
        (Water(waves=LevelOscillation(0.1, 0.8)), 1e-6),
        # slope and rate of the surface are taken at one point
        (Water(waves=RegularWave(0.1, wavelength=12.0, direction=0.5)), 2e-2),
    ):
        buoyancy = Buoyancy(
            model, water, damping=None, added_mass={"hull": root @ root.T}, slamming=slamming
        )
        mujoco.mj_forward(model, data)
        loads = buoyancy.evaluate(data).by_cause
        found = loads["added_mass"][1] + (loads["slamming"][1] if slamming else 0.0)
        expected = naive.reaction(model, buoyancy, data, slamming)
        assert found == pytest.approx(expected, abs=tolerance * np.abs(expected).max())


def test_what_floods_in_part_and_several_hulls_of_a_body_count_by_their_waterplanes():
    model = vessels.of_geoms(
        '<geom name="a" type="box" size=".2 .1 .15" pos=".3 .1 0" mass="5"/>'
        '<geom name="b" type="sphere" size=".15" pos="-.2 0 .02" mass="3"/>'
    )
    data = mujoco.MjData(model)
    data.qpos[2:7] = 0.03, 1.0, 0.1, -0.2, 0.3
    data.qvel[:] = [0.3, -0.5, 0.8, 0.2, -0.7, 0.4]
    mujoco.mj_forward(model, data)
    buoyancy = Buoyancy(
        model,
        damping=None,
        added_mass="estimate",
        selection=Selection(fill=["a=0.4"]),
    )
    expected = naive.reaction(model, buoyancy, data)
    found = buoyancy.evaluate(data).by_cause["added_mass"][1]
    assert found == pytest.approx(expected, abs=1e-6 * np.abs(expected).max())


@pytest.mark.parametrize("slamming", [False, True])
def test_a_body_that_moves_with_the_water_feels_nothing_of_its_entry(slamming):
    # the level rises past it, or it rises with the level
    oscillation = LevelOscillation(0.1, 0.5)
    water = Water(waves=oscillation)
    model = model_of(BALL, gravity=0.0)
    data = mujoco.MjData(model)
    data.time = 0.3
    data.qpos[2] = water.elevation(0.0, 0.0, data.time) - 0.03
    data.qvel[:3] = water.velocity(np.zeros(3), time=data.time)
    buoyancy = Buoyancy(
        model, water, damping=None, added_mass={"hull": [3.0] * 3 + [0.0] * 3}, slamming=slamming
    )
    mujoco.mj_forward(model, data)
    loads = buoyancy.evaluate(data)
    # but for s A times the water's acceleration
    share = loads.total.volume / buoyancy.added_mass.volumes[0]
    rush = water.acceleration(np.zeros(3), time=data.time)
    rows = loads.by_cause["added_mass"][1]
    assert rows[:3] == pytest.approx(3.0 * share * rush, abs=1e-12)
    assert abs(rush[2]) > 0.1
    if slamming:
        assert not loads.by_cause["slamming"].any()
    data.qvel[2] = 0.0
    mujoco.mj_forward(model, data)
    assert buoyancy.evaluate(data).by_cause["added_mass"][1, 2] != pytest.approx(
        3.0 * share * rush[2], rel=0.1
    )


def test_the_waterplane_of_a_cut_is_that_of_the_waterline():
    # by the triangles that are cut, as statics sum it, with its centroid
    rng = np.random.default_rng(4)
    for seed in range(3):
        mesh = vessels.dented(seed)
        packed = parse_method("exact").pack(HullSet([mesh], fills=[0.6]), Water(level=0.1))
        for _ in range(5):
            turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
            turn *= np.sign(np.linalg.det(turn))
            place = rng.uniform(-0.3, 0.3, (1, 3)) + [5.0, -3.0, 0.0]
            row = packed.submerge(place, turn.reshape(1, 9), 0.0)[0]
            line = packed.waterplanes(place, turn.reshape(1, 9), np.zeros(3))[0]
            if line[waterplane.AREA] == 0.0:
                assert np.isnan(row[clip.WATERPLANE_X])
                continue
            assert row[clip.WATERPLANE_AREA] == pytest.approx(line[waterplane.AREA])
            centroid = row[[clip.WATERPLANE_X, clip.WATERPLANE_Y]] * row[clip.WATERPLANE_AREA]
            assert centroid == pytest.approx(line[[waterplane.X, waterplane.Y]], abs=1e-9)


# who acts


def test_python_compiled_code_the_plugin_and_a_batch_agree_on_entries():
    text = f"""<mujoco><option timestep="0.005"/><worldbody>{PAIR}</worldbody></mujoco>"""
    sea = Water(waves=RegularWave(0.1, wavelength=4.0), current=(0.3, 0.1, 0.0))
    options = {"added_mass": "estimate", "slamming": True}
    model = mujoco.MjModel.from_xml_string(text)
    ends = []
    for native in (True, False):
        data = mujoco.MjData(model)
        with Buoyancy(model, sea, **options).installed(native=native):
            mujoco.mj_step(model, data, 300)
        ends.append(data.qpos.copy())
    spec = mujoco.MjSpec.from_string(text)
    add_water(spec, sea, **options)
    own = spec.compile()
    data = mujoco.MjData(own)
    mujoco.mj_step(own, data, 300)
    ends.append(data.qpos.copy())
    assert water_in(own).causes == ("buoyancy", "drag", "added_mass", "slamming")
    copies = batch.Batch(own, 2, nthread=2)
    copies.step(nstep=300)
    ends.extend(np.array(copies.bind("qpos")))
    for end in ends[1:]:
        assert end == pytest.approx(ends[0], abs=1e-9)


def test_slamming_goes_through_texts_and_tables():
    settings = Settings(added_mass="estimate", slamming=True)
    texts = write_plugin_config(settings)
    assert texts["slamming"] == "true"
    assert parse_plugin_config(texts, "here") == settings
    assert parse_plugin_config({}, "here").slamming is False
    table = {"title": "t", "vehicle": "hourglass", "added_mass": "estimate", "slamming": True}
    assert scene_from_table(table).slamming is True
    assert scene_from_table({"title": "t", "vehicle": "hourglass"}).slamming is False


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (
            lambda: Settings(slamming="yes"),
            ModelError,
            "slamming is 'yes'; it must be true or false",
        ),
        (
            lambda: Settings(slamming=True, added_mass="none"),
            ModelError,
            "slamming is true and added_mass is 'none'; slamming is what added mass does in an "
            "entry: state or estimate it, or leave slamming out",
        ),
        (
            lambda: Settings(slamming=True, added_mass=None),
            ModelError,
            "slamming is true and added_mass is None; slamming is what",
        ),
        (
            lambda: Settings(slamming=True, method="sections"),
            MethodError,
            "slamming needs the method 'exact', not 'sections', which knows no waterplane",
        ),
        (
            lambda: Buoyancy(vessels.box(), slamming=True),
            ModelError,
            "slamming is true, and no body has added mass; give the model numerics "
            "'added_mass:BODY', or choose added_mass='estimate'",
        ),
        (
            lambda: scene_from_table({"title": "t", "vehicle": "hourglass", "slamming": 1}),
            SceneError,
            "scene: slamming is 1; needed is true or false",
        ),
        (
            lambda: parse_plugin_config({"slamming": "often"}, "plugin"),
            SceneError,
            "plugin: slamming is 'often'; needed is true or false",
        ),
    ],
)
def test_slamming_that_makes_no_sense_is_refused(call, error, message):
    with pytest.raises(error, match=re.escape(message)):
        call()


def test_a_method_without_a_waterplane_says_that_it_keeps_no_books():
    added = {"hull": [3.0] * 6}
    model = model_of(BOX)
    message = (
        "the method 'sections' knows no waterplane, so that the added mass of 'hull' makes and "
        "takes energy on the way into the water and out of it; use the method 'exact', or "
        "added_mass='none'"
    )
    with pytest.warns(BuoyancyWarning, match=re.escape(message)):
        Buoyancy(model, method="sections", added_mass=added)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        Buoyancy(model, method="sections", added_mass="none")
