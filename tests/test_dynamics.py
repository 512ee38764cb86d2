"""Motion against theory: exact periods, energy, rest, and nothing that moves by itself."""

import mujoco
import numpy as np
import pytest
from scipy.optimize import brentq

from buoyancy_mj import (
    Buoyancy,
    Damping,
    LevelOscillation,
    Silhouette,
    Simulation,
    Water,
    read_scene,
    submerge,
)
from buoyancy_mj.hulls.geoms import find_hulls
from buoyancy_mj.scenes import catalog
from tests import naive

G = 9.81


def model_of(geom, integrator="RK4", timestep=0.002, extra=""):
    return mujoco.MjModel.from_xml_string(
        f"""<mujoco>
        <option timestep="{timestep}" integrator="{integrator}"><flag energy="enable"/></option>
        <worldbody><body name="b"><freejoint/>{geom}{extra}</body></worldbody></mujoco>"""
    )


def run(model, duration, look, water=None, drag=None, start=(0, 0, 0, 1, 0, 0, 0), spin=(0, 0, 0)):
    """`look(data)` after every step."""
    data = mujoco.MjData(model)
    data.qpos[:7] = start
    data.qvel[3:6] = spin
    seen = []
    with Buoyancy(model, water, damping=drag).installed():
        for _ in range(round(duration / model.opt.timestep)):
            mujoco.mj_step(model, data)
            seen.append(look(data))
    return np.array(seen)


def measured_period(values, timestep):
    """Mean time between upward crossings of the mean of the extremes."""
    middle = 0.5 * (values.max() + values.min())
    x = values - middle
    i = np.flatnonzero((x[:-1] < 0.0) & (x[1:] >= 0.0))
    times = (i - x[i] / (x[i + 1] - x[i])) * timestep
    return np.diff(times).mean()


# periods ------------------------------------------------------------------------------------------


def test_a_box_heaves_with_its_wall_sided_period():
    # T = 2 pi sqrt(draft / g), no added mass: 1.0988 s
    model = model_of('<geom type="box" size="1 .5 .3" density="500"/>')
    z = run(model, 12.0, lambda d: d.qpos[2], start=(0, 0, 0.02, 1, 0, 0, 0))
    assert measured_period(z, 0.002) == pytest.approx(1.0988, rel=1e-3)


def test_a_box_rolls_with_its_small_angle_period():
    # T = 2 pi r / sqrt(g GM): 1.8893 s
    model = model_of('<geom type="box" size="1 .5 .3" density="500"/>')
    angle = 0.005
    start = (0, 0, 0, np.cos(angle / 2), np.sin(angle / 2), 0, 0)
    rolls = run(model, 20.0, lambda d: 2.0 * np.arctan2(d.qpos[4], d.qpos[3]), start=start)
    assert measured_period(rolls, 0.002) == pytest.approx(1.8893, rel=1e-3)


@pytest.mark.parametrize("drop", [0.05, 0.2, 0.35])
def test_a_sphere_bobs_with_its_exact_nonlinear_period(drop):
    # potential of weight and cap volume, V = pi h^2 (3 R - h) / 3, between the turning points
    radius, mass = 0.4, 0.5 * 1000.0 * 4.0 / 3.0 * np.pi * 0.4**3

    def potential(z):
        h = np.clip(radius - z, 0.0, 2.0 * radius)
        # int V dz from the top down
        water = np.pi * (radius * h**3 / 3.0 - h**4 / 12.0)
        return mass * G * z + 1000.0 * G * water

    low = brentq(lambda z: potential(z) - potential(drop), -0.399, -1e-6)
    model = model_of(f'<geom type="sphere" size="{radius}" mass="{mass}"/>')
    z = run(model, 12.0, lambda d: d.qpos[2], start=(0, 0, drop, 1, 0, 0, 0))
    assert measured_period(z, 0.002) == pytest.approx(
        naive.period(potential, mass, low, drop), rel=1e-3
    )
    assert z.min() == pytest.approx(low, abs=1e-3)


@pytest.mark.parametrize(
    ("angle", "factor"),
    [(10, 1.001907), (30, 1.017409), (60, 1.073182), (90, 1.180341), (120, 1.372881)],
)
def test_a_neutral_body_under_water_swings_as_a_pendulum(angle, factor):
    # T = 2 pi sqrt(I / (B h)), times the elliptic factor for the angle
    model = model_of(
        '<geom type="ellipsoid" size=".4 .2 .2" mass="0"/>',
        extra='<inertial pos="0 0 -.05" mass="67.02064" diaginertia="1.2 4 4"/>',
    )
    volume = find_hulls(model)[0].mesh.volume
    model.body_mass[1] = 1000.0 * volume
    half = np.radians(angle) / 2.0
    start = (0, 0, -3, np.cos(half), np.sin(half), 0, 0)
    rolls = run(model, 12.0, lambda d: 2.0 * np.arctan2(d.qpos[4], d.qpos[3]), start=start)
    assert measured_period(rolls, 0.002) == pytest.approx(
        2.0 * np.pi * np.sqrt(1.2 / (1000.0 * G * volume * 0.05)) * factor, rel=1e-3
    )


# energy -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "geom",
    [
        '<geom type="box" size=".3 .2 .15" density="450"/>',
        '<geom type="capsule" size=".15 .3" density="450"/>',
    ],
)
def test_an_undamped_body_keeps_its_energy_for_twenty_cycles(geom):
    model = model_of(geom)
    data = mujoco.MjData(model)
    data.qpos[:7] = (0, 0, 0.15, np.cos(0.15), np.sin(0.12), np.sin(0.09), 0)
    buoyancy = Buoyancy(model, damping=None)
    energies, heights = [], []
    with buoyancy.installed():
        for _ in range(round(24.0 / 0.002)):
            mujoco.mj_step(model, data)
            # the state after the step, as a whole
            if len(heights) % 10 == 0:
                now = mujoco.MjData(model)
                now.qpos[:], now.qvel[:] = data.qpos, data.qvel
                mujoco.mj_forward(model, now)
                wet = buoyancy.evaluate(now)
                lifted = (
                    0.0 if wet.total.volume == 0.0 else -wet.total.centroid[2] * wet.total.volume
                )
                energies.append(now.energy.sum() + 1000.0 * G * lifted)
            heights.append(data.qpos[2])
    cycles = 24.0 / measured_period(np.array(heights), 0.002)
    assert cycles > 20
    # against the energy above the rest position
    rest = min(_rest_energy(model, h) for h in np.linspace(-0.3, 0.3, 121))
    scale = energies[0] - rest
    assert np.ptp(energies) < 0.005 * scale


def _rest_energy(model, height):
    mesh = find_hulls(model)[0].mesh
    wet = submerge(mesh, (0, 0, height))
    lifted = -wet.centroid[2] * wet.volume if wet.volume else 0.0
    return model.body_mass[1] * G * height + 1000.0 * G * lifted


# rest ---------------------------------------------------------------------------------------------


def test_a_box_settles_at_the_draft_of_its_mass():
    model = model_of(
        '<geom type="box" size=".3 .2 .1" mass="9"/>', integrator="implicitfast", timestep=0.005
    )
    z = run(
        model,
        60.0,
        lambda d: d.qpos[2],
        drag=Damping(viscous=Silhouette(linear_froude=0.2)),
        start=(0, 0, 0.3, 1, 0, 0, 0),
    )
    assert 0.1 - z[-1] == pytest.approx(9.0 / (1000.0 * 0.24), abs=1e-5)
    assert np.ptp(z[-1000:]) < 1e-5


def test_the_default_drag_settles_a_drop_within_a_minute():
    model = model_of(
        '<geom type="box" size=".3 .2 .1" mass="9"/>', integrator="implicitfast", timestep=0.01
    )
    z = run(model, 60.0, lambda d: d.qpos[2], drag=Damping(), start=(0, 0, 0.3, 1, 0, 0, 0))
    assert np.ptp(z[-500:]) < 0.002


def at_rest(name):
    """A vehicle upright in its equilibrium, and its model."""
    model = mujoco.MjModel.from_xml_path(str(catalog.models()[name]))
    model.opt.timestep = 0.01
    data = mujoco.MjData(model)
    buoyancy = Buoyancy(model)

    def surplus(height):
        data.qpos[:7] = (0, 0, height, 1, 0, 0, 0)
        mujoco.mj_forward(model, data)
        return float(buoyancy.evaluate(data).total.volume) * 1000.0 - model.body_mass.sum()

    brentq(surplus, -0.5, 0.5, xtol=1e-15)
    return model, data, buoyancy


def test_the_auv_at_rest_neither_turns_nor_drifts_in_a_minute():
    model, data, buoyancy = at_rest("sauvc_auv")
    height = data.qpos[2]
    with buoyancy.installed():
        for _ in range(6000):
            mujoco.mj_step(model, data)
            assert np.abs(data.qvel[3:]).max() < 1e-6
    assert np.abs(data.qpos[:2]).max() < 1e-7
    assert data.qpos[2] == pytest.approx(height, abs=1e-6)


def test_a_body_of_revolution_gets_no_spin_from_still_water():
    model, data, _ = at_rest("hourglass")
    data.qpos[3:7] = (np.cos(0.2), np.sin(0.2), 0, 0)
    with Buoyancy(model, damping=None).installed():
        for _ in range(1000):
            mujoco.mj_step(model, data)
            # the facets of the mesh leave a little
            assert abs(data.qvel[5]) < 2e-4


def test_the_hourglass_comes_to_rest_upright():
    model = mujoco.MjModel.from_xml_path(str(catalog.models()["hourglass"]))
    model.opt.timestep, model.opt.integrator = 0.005, mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    start = (0, 0, 0.5, np.cos(0.6), np.sin(0.6), 0, 0)
    ends = run(model, 60.0, lambda d: [d.xmat[1][8], *d.qvel], drag=Damping(), start=start)
    assert ends[-1][0] > 0.9999
    assert np.abs(ends[-1][1:]).max() < 0.02


def test_a_hull_released_at_thirty_degrees_rights_itself():
    model = model_of(
        '<geom type="box" size=".5 .3 .1" density="400"/>', integrator="implicitfast", timestep=0.01
    )
    start = (0, 0, 0, np.cos(np.pi / 12), np.sin(np.pi / 12), 0, 0)
    upright = run(model, 60.0, lambda d: d.xmat[1][8], drag=Damping(), start=start)
    assert upright[0] == pytest.approx(np.cos(np.pi / 6), abs=1e-3)
    assert upright[-500:].min() > 0.999


def test_the_cuboid_of_openfoam_tips_over():
    # GM = -0.095 m upright
    model = model_of(
        '<geom type="box" size=".1 .15 .25" density="500"/>',
        integrator="implicitfast",
        timestep=0.005,
    )
    upright = run(
        model, 20.0, lambda d: d.xmat[1][8], drag=Damping(), start=(0, 0, 0, 1, 0.001, 0, 0)
    )
    assert abs(upright[-1]) < 0.1


# drag ---------------------------------------------------------------------------------------------


def test_drag_is_relative_to_the_current():
    model = model_of(
        '<geom type="box" size=".3 .2 .1" mass="12"/>', integrator="implicitfast", timestep=0.01
    )
    speed = run(
        model, 60.0, lambda d: d.qvel[0], water=Water(current=(0.4, 0.0, 0.0)), drag=Damping()
    )
    assert speed[-1] == pytest.approx(0.4, abs=1e-3)


@pytest.mark.parametrize("timestep", [0.01, 0.05])
def test_drag_never_turns_a_light_body_round(timestep):
    model = model_of(
        '<geom type="box" size=".2 .2 .005" mass="0.02"/>', integrator="Euler", timestep=timestep
    )
    data = mujoco.MjData(model)
    model.opt.gravity[:] = 0.0
    data.qpos[2], data.qvel[:] = -1.0, [0.5, 0.3, 8.0, 3.0, -9.0, 1.0]
    before = data.qvel.copy()
    with Buoyancy(model).installed():
        for _ in range(50):
            mujoco.mj_step(model, data)
            assert np.linalg.norm(data.qvel[:3]) <= np.linalg.norm(before[:3]) * (1.0 + 1e-9)
            before = data.qvel.copy()
    assert np.abs(data.qvel[2]) < 0.1


def test_waves_carry_the_vehicle_with_the_moving_level_of_the_source_paper():
    model = model_of(
        '<geom type="box" size=".3 .2 .1" mass="12"/>', integrator="implicitfast", timestep=0.01
    )
    # 20 s against a bobbing period of 0.6 s: it follows the level
    z = run(
        model,
        60.0,
        lambda d: d.qpos[2],
        water=Water(waves=LevelOscillation(0.3, 0.05)),
        drag=Damping(),
    )
    assert np.ptp(z[-2500:]) == pytest.approx(0.6, rel=0.02)


def test_a_simulation_is_the_same_with_and_without_its_frames():
    ends = []
    for rate in (5, 100):
        simulation = Simulation(
            read_scene(
                catalog.scenes()["hourglass_drop_waves"], [f"record_rate={rate}", "duration=1"]
            )
        )
        list(simulation.frames())
        ends.append(simulation.data.qpos.copy())
    assert np.array_equal(*ends)


@pytest.mark.long
def test_in_a_long_sea_the_auv_rides_the_surface():
    frames = list(Simulation(read_scene(catalog.scenes()["auv_sea_state_2"])).frames())
    late = np.array(
        [(frame.centre_of_mass[2], frame.elevation) for frame in frames if frame.time > 5.0]
    )
    # waves of 19 m carry a hull of half a metre; what is shorter, and its own heave, is a little
    # more
    assert np.corrcoef(late.T)[0, 1] > 0.95
    assert np.std(late[:, 0]) == pytest.approx(np.std(late[:, 1]), rel=0.05)


def test_adrift_the_auv_takes_on_the_current():
    simulation = Simulation(read_scene(catalog.scenes()["auv_current"]))
    places = np.array([(frame.time, *frame.centre_of_mass) for frame in simulation.frames()])
    # over the last ten periods of the wave
    late = places[places[:, 0] >= 27.0 - 1e-9]
    assert (late[-1, 1] - late[0, 1]) / 3.0 == pytest.approx(0.25, rel=0.05)
    assert abs(late[-1, 2] - late[0, 2]) < 0.1
