"""Fins, rudders, keels and wings: their lift and drag, and how they act on bodies."""

import dataclasses
import math

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from buoyancy_mj import (
    Buoyancy,
    Damping,
    ModelError,
    Panels,
    RegularWave,
    Water,
    add_water,
)
from buoyancy_mj.hulls.geoms import find_hulls
from buoyancy_mj.inspection.inspection import inspect_model
from buoyancy_mj.inspection.json_report import to_json
from buoyancy_mj.inspection.report import to_markdown
from buoyancy_mj.loads.added_mass import resolve_added_mass
from buoyancy_mj.loads.foil_arrays import find_foils
from buoyancy_mj.loads.foils import Foil, finite_slope, parse_foil
from buoyancy_mj.loads.plates import estimate_plate
from buoyancy_mj.potential.ellipsoid import ellipsoid_added_mass
from buoyancy_mj.validation import foils as validation

from . import naive

PLANE = Foil(walls=2, drag=0.0)
"""A section in plane flow."""
FOILS = st.builds(
    Foil,
    aspect=st.floats(0.2, 30.0),
    thickness=st.floats(0.0, 0.3),
    lift_slope=st.floats(1.0, 7.0),
    zero_lift=st.floats(-15.0, 15.0),
    stall=st.floats(2.0, 60.0),
    drag=st.floats(0.0, 0.2),
    efficiency=st.floats(0.6, 2.0),
    crossflow=st.floats(0.0, 4.0),
    suction=st.floats(0.0, 1.0),
)
ANGLES = st.floats(-math.pi, math.pi)


def polar(foil, *degrees):
    return foil.coefficients(np.radians(degrees))


# the polar


def test_a_section_in_plane_flow_has_the_slope_of_thin_aerofoil_theory():
    lift, drag, moment = polar(PLANE, 1.0)[0]
    assert lift == pytest.approx(2.0 * math.pi * math.radians(1.0), rel=1e-3)
    assert drag == pytest.approx(0.0, abs=1e-12)
    assert moment == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(("aspect", "slope"), [(1.0, 1.401), (2.0, 2.444), (3.0, 3.138)])
def test_rudders_have_the_slopes_of_whicker_and_fehlner(aspect, slope):
    # DTMB 933: 0.9 (2 pi) AR / (1.8 + sqrt(AR^2 + 4))
    assert finite_slope(1.8 * math.pi, 1.0 / aspect) == pytest.approx(slope, abs=5e-4)


def test_a_short_wing_has_half_pi_times_its_aspect_ratio_as_slope():
    # Jones (1946), NACA report 835
    assert finite_slope(2.0 * math.pi, 1.0 / 0.01) == pytest.approx(0.005 * math.pi, rel=1e-2)


def test_a_long_wing_has_the_lift_and_the_induced_drag_of_prandtls_lifting_line():
    aspect, angle = 30.0, math.radians(3.0)
    lift, drag, _ = Foil(aspect=aspect, drag=0.0, crossflow=0.0, efficiency=1.0).coefficients(
        angle
    )[0]
    assert lift == pytest.approx(2.0 * math.pi * angle / (1.0 + 2.0 / aspect), rel=0.02)
    assert drag == pytest.approx(lift**2 / (math.pi * aspect), rel=1e-3)


def test_a_plate_across_the_flow_has_hoerners_drag():
    # Fluid-Dynamic Drag (1965), ch. 3: 1.98 in plane flow, and 1.17 for a square
    assert polar(Foil(walls=2, drag=0.0), 90.0)[0, 1] == pytest.approx(1.98, rel=0.01)
    assert polar(Foil(aspect=1.0, drag=0.0), 90.0)[0, 1] == pytest.approx(1.17, rel=0.01)


def test_the_force_goes_from_the_quarter_to_the_middle_of_the_chord():
    moments = polar(PLANE, 5.0, 90.0)
    assert moments[0, 2] == pytest.approx(0.0, abs=1e-12)
    assert moments[1, 2] == pytest.approx(-0.25 * moments[1, 1], rel=1e-12)


def test_a_cambered_section_has_the_moment_of_a_parabolic_arc():
    # thin aerofoil theory: zero lift at -2 h, and -pi h about the quarter of the chord
    height = 0.02
    section = dataclasses.replace(PLANE, zero_lift=-math.degrees(2.0 * height))
    lift, _, moment = polar(section, 0.0)[0]
    assert lift == pytest.approx(4.0 * math.pi * height, rel=1e-3)
    assert moment == pytest.approx(-math.pi * height, rel=1e-3)
    assert polar(section, section.zero_lift)[0, 0] == pytest.approx(0.0, abs=1e-3)


def test_sharp_edges_have_no_force_along_the_chord():
    foil = Foil(aspect=1.0, suction=0.0, drag=0.0)
    for angle in (3.0, 20.0, 60.0, 130.0, 175.0):
        lift, drag, _ = polar(foil, angle)[0]
        a = math.radians(angle)
        assert lift * math.sin(a) - drag * math.cos(a) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("aspect", [1e-3, 0.1, 0.2, 0.4])
def test_a_foil_of_hardly_any_span_has_no_more_normal_force_than_a_plate_across_the_flow(aspect):
    # Bollay (1939): 2 sin^2 a without any span
    angles = np.radians(np.arange(0.0, 91.0))
    fin = Foil(span=aspect, chord=1.0, drag=0.0)
    lift, drag, _ = fin.coefficients(angles).T
    normal = lift * np.cos(angles) + drag * np.sin(angles)
    assert normal.max() == pytest.approx(1.18, abs=0.01)


@given(foil=FOILS, angle=ANGLES)
def test_drag_is_never_negative(foil, angle):
    assert foil.coefficients(angle)[0, 1] >= -1e-12


@given(foil=FOILS, angle=ANGLES)
def test_a_symmetric_foil_is_alike_on_both_sides_and_from_behind(foil, angle):
    foil = dataclasses.replace(foil, zero_lift=0.0)
    lift, drag, moment = foil.coefficients(angle)[0]
    other = foil.coefficients([-angle, math.pi - angle])
    assert other[0] == pytest.approx([-lift, drag, -moment], abs=1e-9)
    assert other[1, :2] == pytest.approx([-lift, drag], abs=1e-9)


@given(foil=FOILS, angle=ANGLES)
def test_the_polar_is_smooth(foil, angle):
    step = 1e-7
    low, high = foil.coefficients([angle - step, angle + step])
    # the steepest is the lift that goes within the width of the stall
    steepest = 20.0 + 30.0 / foil.section()[6]
    assert np.abs(high - low).max() < 2.0 * step * steepest


@given(foil=FOILS, angle=ANGLES)
def test_the_polar_is_its_slow_twins(foil, angle):
    names = [
        *("slope", "camber", "induced", "crossflow", "lost"),
        *("stall", "blend", "drag", "cd90", "tips"),
    ]
    lift, drag, camber, centre = naive.foil_polar(
        angle, **dict(zip(names, foil.section(), strict=True))
    )
    normal = lift * math.cos(angle) + drag * math.sin(angle)
    moment = (centre - 0.25) * normal - centre * camber
    assert foil.coefficients(angle)[0] == pytest.approx([lift, drag, moment], abs=1e-9)


# on bodies


def vehicle(words="stall=15", site="", body="", extra="", timestep=1e-5, mass=1.0):
    """A ball with a wing of 0.8 x 0.1 m, deep under water."""
    return mujoco.MjModel.from_xml_string(f"""
      <mujoco>
        <option timestep="{timestep}" integrator="RK4"/>
        <custom><text name="foil:wing" data="{words}"/></custom>
        <worldbody>
          <body name="b" pos="0 0 -20" {body}>
            <freejoint/>
            <geom type="sphere" size=".1" density="{1000.0 * mass}"/>
            <geom type="box" size=".5 .5 .02" mass=".01" contype="0" conaffinity="0"/>
            <site name="wing" type="box" size=".05 .4 .004" {site}/>
            {extra}
          </body>
        </worldbody>
      </mujoco>""")


def moving(model, qvel, qpos=None):
    data = mujoco.MjData(model)
    data.qvel[:6] = qvel
    if qpos is not None:
        data.qpos[:7] = qpos
    mujoco.mj_forward(model, data)
    return data


def foil_load(model, data, water=None):
    """Force and torque about the centre of mass of body 'b'."""
    return Buoyancy(model, water, damping=None).evaluate(data).by_cause["foil"][1]


def test_a_wing_lifts_a_body_that_moves_down_as_it_goes():
    model = vehicle("aspect=8 drag=0.02 crossflow=0")
    force = foil_load(model, moving(model, [1.0, 0.0, -0.05, 0.0, 0.0, 0.0]))
    lift, drag, _ = Foil(aspect=8.0, drag=0.02, crossflow=0.0).coefficients(math.atan(0.05))[0]
    push = 0.5 * 1000.0 * 0.08 * (1.0 + 0.05**2)
    angle = math.atan(0.05)
    assert force[2] == pytest.approx(
        push * (lift * math.cos(angle) + drag * math.sin(angle)), rel=1e-9
    )
    assert force[0] == pytest.approx(
        push * (lift * math.sin(angle) - drag * math.cos(angle)), rel=1e-9
    )
    # the quarter of the chord is 2.5 cm before the centre of mass, and raises the bow
    assert force[4] == pytest.approx(-0.025 * force[2], rel=1e-9)


def test_a_wing_on_a_shoal_of_water_that_flows_is_a_wing_that_moves():
    model = vehicle("zero_lift=-3", site='euler="10 -4 7"')
    still = foil_load(model, moving(model, [1.2, 0.1, -0.2, 0.0, 0.0, 0.0]))
    data = moving(model, np.zeros(6))
    flowing = foil_load(model, data, Water(current=(-1.2, -0.1, 0.2)))
    assert flowing == pytest.approx(still, rel=1e-12)


def test_a_wing_brakes_roll_as_strip_theory_says():
    # -1/2 rho V a c int y^2 dy p
    model = vehicle("aspect=8 drag=0 crossflow=0 suction=1")
    spin, speed = 0.01, 2.0
    torque = foil_load(model, moving(model, [speed, 0, 0, spin, 0, 0]))[3]
    slope = finite_slope(2.0 * math.pi, 1.0 / 8.0)
    assert torque == pytest.approx(
        -0.5 * 1000.0 * speed * slope * 0.1 * 2.0 / 3.0 * 0.4**3 * spin, rel=0.02
    )


@settings(max_examples=50)
@given(
    velocity=st.tuples(*[st.floats(-3.0, 3.0)] * 6),
    turn=st.tuples(*[st.floats(-1.0, 1.0)] * 4).filter(lambda q: np.linalg.norm(q) > 0.1),
)
def test_a_foil_without_camber_takes_energy_from_whatever_moves(velocity, turn):
    model = vehicle("suction=0.5", site='pos=".3 .1 .2" euler="20 30 40"', timestep=1e-5)
    data = moving(model, velocity, [0, 0, -20, *(np.array(turn) / np.linalg.norm(turn))])
    wrench = foil_load(model, data)
    # of a free joint MuJoCo's rotation is in the body's axes
    spin = data.xmat[1].reshape(3, 3) @ data.qvel[3:]
    velocity_of_com = data.qvel[:3] + np.cross(spin, data.xipos[1] - data.xpos[1])
    assert wrench[:3] @ velocity_of_com + wrench[3:] @ spin <= 1e-9 * np.abs(wrench).max()


def test_half_of_a_keel_that_is_half_out_of_the_water_has_half_the_force():
    model = vehicle("aspect=4", site='euler="90 0 0"')
    deep, half, dry = (
        foil_load(model, moving(model, [1, 0.1, 0, 0, 0, 0], [0, 0, z, 1, 0, 0, 0]))
        for z in (-20.0, 0.0, 0.41)
    )
    assert half[:3] == pytest.approx(0.5 * deep[:3], rel=1e-9)
    # its middle is halfway down
    assert half[3] - 0.5 * deep[3] == pytest.approx(0.2 * half[1], rel=1e-9)
    assert not dry.any()


def test_what_is_wet_of_a_foil_grows_evenly_as_it_goes_down():
    model = vehicle("aspect=4", site='euler="70 20 0"')
    depths = np.linspace(-0.6, 0.6, 41)
    forces = [
        foil_load(model, moving(model, [1, 0.1, 0, 0, 0, 0], [0, 0, z, 1, 0, 0, 0]))[1]
        for z in depths
    ]
    steps = -np.diff(np.abs(forces))
    assert (steps >= -1e-12).all()
    assert steps.max() < 0.1 * abs(forces[0])


def test_a_foil_feels_the_water_of_waves():
    model = vehicle("aspect=8")
    water = Water(waves=RegularWave(amplitude=0.2, period=3.0))
    data = moving(model, np.zeros(6), [0, 0, -1.0, 1, 0, 0, 0])
    data.time = 0.3
    mujoco.mj_forward(model, data)
    across = math.sqrt(1.0 / 12.0) * 0.8
    places = np.array([[0.0, y, -1.0] for y in (-across, 0.0, across)])
    flow = water.velocity(places, 0.3)
    assert np.ptp(flow, axis=0) == pytest.approx([0.0] * 3, abs=1e-12)
    moved = moving(model, [*(-flow[0]), 0, 0, 0])
    assert foil_load(model, data, water) == pytest.approx(foil_load(model, moved), rel=1e-6)


@pytest.mark.parametrize("dof", [2, 3])
def test_a_light_wing_is_slowed_down_and_not_turned_round_by_a_long_step(dof):
    # the roll of a ball with a wing dies within 0.2 ms, its heave within 4 ms; and the water passes
    # the wing in one step, so that no more than a fifth of a motion is stopped in each
    model = vehicle("aspect=8", timestep=0.02, mass=0.5)
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_EULER
    model.opt.gravity[:] = 0.0
    data = moving(model, np.eye(6)[0] * 5.0 + np.eye(6)[dof] * 0.5)
    with Buoyancy(model, damping=None).installed():
        mujoco.mj_step(model, data)
        assert 0.0 <= data.qvel[dof] < 0.45
        for _ in range(100):
            mujoco.mj_step(model, data)
    assert np.linalg.norm(data.qvel) < 5.0


@pytest.mark.parametrize("integrator", ["Euler", "implicitfast", "RK4"])
@pytest.mark.parametrize("place", [-0.3, 0.0, 0.3])
def test_a_wing_on_a_ball_never_gains_energy_however_long_the_step_is(integrator, place):
    # of a ball MuJoCo's own terms of rotation add none
    model = mujoco.MjModel.from_xml_string(f"""
      <mujoco><option timestep="0.05" gravity="0 0 0" integrator="{integrator}"/>
        <custom><text name="foil:wing" data="walls=0"/></custom>
        <worldbody><body pos="0 0 -20"><freejoint/><geom type="sphere" size=".1" density="1000"/>
          <site name="wing" type="box" size=".05 .5 .003" pos="{place} 0 0"/></body></worldbody>
      </mujoco>""")
    inertia = np.append([model.body_mass[1]] * 3, model.body_inertia[1])
    random = np.random.default_rng(0)
    for _ in range(4):
        data = moving(model, random.normal(size=6) * np.repeat([1.0, 2.0], 3))
        energies = []
        with Buoyancy(model, damping=None).installed():
            for _ in range(200):
                mujoco.mj_step(model, data)
                energies.append(0.5 * inertia @ data.qvel**2)
        assert (np.diff(energies) <= 1e-9 * energies[0]).all()
        assert energies[-1] < 0.5 * energies[0]


def test_a_light_wing_that_spins_about_its_span_is_not_turned_round_by_a_long_step():
    model = vehicle("aspect=8", timestep=0.1, mass=0.1)
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_EULER
    model.opt.gravity[:] = 0.0
    data = moving(model, np.eye(6)[4] * 300.0)
    with Buoyancy(model, damping=None).installed():
        for _ in range(20):
            before = data.qvel[4]
            mujoco.mj_step(model, data)
            assert 0.0 <= data.qvel[4] < before
    assert data.qvel[4] < 30.0


def test_holding_a_fast_motion_leaves_slow_ones_alone():
    # roll is stiff at this step, the drag ahead is not
    loads = []
    for timestep in (1e-5, 0.01):
        model = vehicle("aspect=8 drag=0.02", timestep=timestep, mass=2.0)
        loads.append(foil_load(model, moving(model, [2.0, 0.0, 0.0, 0.1, 0.0, 0.0])))
    assert loads[1][0] == pytest.approx(loads[0][0], rel=1e-3)
    assert abs(loads[1][3]) < 0.5 * abs(loads[0][3])


def test_a_light_rudder_on_a_hinge_keeps_the_force_that_its_boat_can_bear():
    hull = '<geom type="box" size=".5 .15 .1" density="500"/>'
    rudder = """<body name="r" pos="-.55 0 -.1"><joint axis="0 0 1" armature=".001"/>
      <geom size=".01" mass=".01" contype="0" conaffinity="0"/>
      <site name="rudder" type="box" size=".04 .1 .005" pos="-.02 0 0" euler="90 0 0"/></body>"""
    model = mujoco.MjModel.from_xml_string(f"""
      <mujoco><option timestep="0.005"/>
        <custom><text name="foil:rudder" data="walls=1"/></custom>
        <worldbody><body name="b" pos="0 0 -5"><freejoint/>{hull}{rudder}</body></worldbody>
      </mujoco>""")
    data = moving(model, [1.0, 0.1, 0, 0, 0, 0])
    held = Buoyancy(model, damping=None).evaluate(data).by_cause["foil"][2]
    model.opt.timestep = 1e-6
    free = Buoyancy(model, damping=None).evaluate(data).by_cause["foil"][2]
    assert held[1] == pytest.approx(free[1], rel=0.2)


@pytest.mark.parametrize("integrator", ["Euler", "RK4"])
def test_light_flaps_on_hinges_gain_nothing_at_a_long_step(integrator):
    # the flow passes a flap within 30 ms, and would stop its turning within 1 ms
    flap = """<body pos="-.2 {0} 0"><joint axis="0 1 0"/>
      <geom size=".02" mass=".02" pos="-.05 0 0" contype="0" conaffinity="0"/>
      <site name="flap_{1}" type="box" size=".05 .1 .003" pos="-.05 0 0"/></body>"""
    flaps = "".join(flap.format(0.25 * (i - 1.5), i) for i in range(4))
    texts = "".join(f'<text name="foil:flap_{i}" data="walls=1"/>' for i in range(4))
    model = mujoco.MjModel.from_xml_string(f"""
      <mujoco><option timestep="0.02" gravity="0 0 0" integrator="{integrator}"/>
        <custom>{texts}</custom>
        <worldbody><body name="b" pos="0 0 -5"><freejoint/>
          <geom type="box" size=".3 .1 .05" density="1000"/>{flaps}</body></worldbody></mujoco>""")
    data = moving(model, [3.0, 0.1, -0.3, 0.2, 0.3, 0.1])
    data.qvel[6:] = 2.0, -2.0, 1.0, -1.0
    model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
    mujoco.mj_forward(model, data)
    start = data.energy[1]
    with Buoyancy(model, damping=None).installed():
        for _ in range(200):
            mujoco.mj_step(model, data)
            assert data.energy[1] < 1.05 * start
    assert data.energy[1] < 0.9 * start


def test_a_flat_plate_that_spins_through_still_water_loses_energy_all_along():
    model = vehicle("suction=0", site='pos="-.03 0 .02"', timestep=0.001, mass=20.0)
    model.opt.gravity[:] = 0.0
    data = moving(model, [1.0, 0.3, -0.5, 2.0, 3.0, 1.0])
    model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
    energies = []
    with Buoyancy(model, damping=None).installed():
        for _ in range(3000):
            mujoco.mj_step(model, data)
            energies.append(data.energy[1])
    assert (np.diff(energies) <= 1e-9 * energies[0]).all()
    assert energies[-1] < 0.5 * energies[0]


def test_a_fin_behind_the_centre_of_mass_turns_a_body_into_the_current():
    model = vehicle("walls=1", site='pos="-.5 0 0" euler="90 0 0"', timestep=0.01)
    data = moving(model, np.zeros(6))
    data.qpos[3:7] = [math.cos(0.3), 0, 0, math.sin(0.3)]
    model.opt.gravity[:] = 0.0
    with Buoyancy(model, Water(current=(-0.5, 0.0, 0.0)), damping=None).installed():
        turns = [abs(data.qpos[6])]
        for _ in range(500):
            mujoco.mj_step(model, data)
            turns.append(abs(data.qpos[6]))
    assert min(turns) < 0.02


def test_the_glider_of_graver_comes_to_its_equilibrium_glide():
    rows = validation._glide()
    assert [row.holds for row in rows] == [True] * 4


def test_compiled_water_and_the_plugin_act_as_python_does():
    words = "walls=1 zero_lift=-2"
    model = vehicle(words, timestep=0.01)
    start = [1.0, 0.1, -0.2, 0.3, 0.2, 0.1]
    results = []
    for native in (True, False):
        data = moving(model, start)
        with Buoyancy(model).installed(native=native):
            for _ in range(20):
                mujoco.mj_step(model, data)
        results.append(data.qpos.copy())

    spec = mujoco.MjSpec.from_string("""
      <mujoco><option timestep="0.01" integrator="RK4"/>
        <custom><text name="foil:wing" data="walls=1 zero_lift=-2"/></custom>
        <worldbody><body name="b" pos="0 0 -20"><freejoint/>
          <geom type="sphere" size=".1" density="1000"/>
          <geom type="box" size=".5 .5 .02" mass=".01" contype="0" conaffinity="0"/>
          <site name="wing" type="box" size=".05 .4 .004"/></body></worldbody></mujoco>""")
    add_water(spec)
    own = spec.compile()
    data = moving(own, start)
    for _ in range(20):
        mujoco.mj_step(own, data)
    results.append(data.qpos.copy())
    assert results[1] == pytest.approx(results[0], rel=1e-9, abs=1e-12)
    assert results[2] == pytest.approx(results[0], rel=1e-9, abs=1e-12)


# beside other loads


def finned(custom, fin=True, pos="-.4 0 .2"):
    geom = f'<geom name="fin" type="box" size=".05 .1 .004" pos="{pos}" euler="90 0 0"/>'
    return mujoco.MjModel.from_xml_string(f"""
      <mujoco><custom>{custom}</custom><worldbody><body name="b" pos="0 0 -5"><freejoint/>
        <geom name="hull" type="box" size=".5 .1 .1" mass="20"/>{geom if fin else ""}
      </body></worldbody></mujoco>""")


@pytest.mark.parametrize(
    ("viscous", "pos"),
    [
        (Damping(), "-.4 0 .2"),
        # this fin reaches into the hull, and displaces as one with it
        (Damping(), "-.4 0 .15"),
        (Damping(viscous=Panels()), "-.4 0 .2"),
    ],
)
def test_a_geom_that_is_a_foil_has_no_estimated_drag(viscous, pos):
    text = '<text name="foil:fin" data="walls=1"/>'
    drags = []
    for model in (finned(text, pos=pos), finned("", fin=False)):
        data = moving(model, [0, 1, 0, 0, 0, 0])
        drags.append(Buoyancy(model, damping=viscous).evaluate(data).by_cause["drag"][1, 1])
    assert drags[0] == pytest.approx(drags[1], rel=1e-9)


def test_a_body_of_nothing_but_foils_has_no_estimated_drag():
    model = mujoco.MjModel.from_xml_string("""
      <mujoco><custom><text name="foil:fin" data="walls=1"/></custom><worldbody>
        <body pos="0 0 -5"><freejoint/><geom name="fin" type="box" size=".05 .1 .004"/></body>
      </worldbody></mujoco>""")
    for damping in (Damping(), Damping(viscous=Panels())):
        loads = Buoyancy(model, damping=damping).evaluate(moving(model, [1, 0, 1, 0, 0, 0]))
        assert not loads.by_cause["drag"].any()
        assert loads.by_cause["foil"].any()


def test_an_elliptic_plate_has_the_added_mass_of_a_flat_ellipsoid():
    model = mujoco.MjModel.from_xml_string("""
      <mujoco><custom><text name="foil:fin" data="walls=0"/></custom><worldbody><body><freejoint/>
        <geom size=".1"/><site name="fin" type="ellipsoid" size=".1 .3 .001"/>
      </body></worldbody></mujoco>""")
    (foil,) = find_foils(model)
    exact = ellipsoid_added_mass([0.1, 0.3, 1e-5], 1000.0)
    assert estimate_plate(foil, 1000.0)[2, 2] == pytest.approx(exact[2], rel=1e-3)
    # strip theory, along the span and along the chord
    assert np.diag(estimate_plate(foil, 1000.0))[3:5] == pytest.approx(exact[3:5], rel=0.35)


def test_the_estimate_of_added_mass_has_a_plate_for_each_foil_that_displaces_nothing():
    site = '<site name="fin" type="box" size=".1 .1 .002" pos="-.4 0 .3"/>'
    text = '<text name="foil:fin" data="walls=1"/>'
    body = f"""<body name="b"><freejoint/><geom size=".1" pos="0 0 .01"/>{site}</body>"""
    model = mujoco.MjModel.from_xml_string(
        f"<mujoco><custom>{text}</custom><worldbody>{body}</worldbody></mujoco>"
    )
    hulls = find_hulls(model)
    plain = resolve_added_mass(model, hulls, 1000.0, "estimate").matrices[0].reshape(6, 6)
    winged = resolve_added_mass(model, hulls, 1000.0, "estimate", find_foils(model))
    added = winged.matrices[0].reshape(6, 6) - plain
    # DNV-RP-N103, table A-2: 0.579 pi/4 rho a^3 for a square plate
    assert added[2, 2] == pytest.approx(0.579 * 0.25 * math.pi * 1000.0 * 0.2**3, rel=1e-9)
    assert added[2, 4] == pytest.approx(0.4 * added[2, 2], rel=1e-9)
    assert added[0, 0] == pytest.approx(0.0, abs=1e-12)

    finned_model = finned(text)
    of_hulls = [
        resolve_added_mass(finned_model, find_hulls(finned_model), 1000.0, "estimate", foils)
        for foils in ((), find_foils(finned_model))
    ]
    assert np.array_equal(of_hulls[0].matrices, of_hulls[1].matrices)


# words


def test_a_foil_is_read_from_its_geom_and_its_text():
    model = finned('<text name="foil:fin" data="walls=1 thickness=0.12, stall=20"/>')
    (foil,) = find_foils(model)
    assert foil.foil == Foil(span=0.2, chord=0.1, walls=1, thickness=0.12, stall=20.0)
    assert foil.area == pytest.approx(0.02)
    assert foil.aspect_ratio == pytest.approx(4.0)
    assert foil.lift_slope == pytest.approx(finite_slope(2.0 * math.pi, 0.25))


def test_a_word_of_a_file_holds_for_its_own_geoms_under_any_prefix():
    child = mujoco.MjSpec.from_string("""
      <mujoco><custom><text name="foil:fin" data="walls=1"/></custom><worldbody><body name="b">
        <freejoint/><geom name="hull" type="box" size=".5 .1 .1"/>
        <geom name="fin" type="box" size=".05 .1 .004" pos="-.4 0 .3"/></body></worldbody></mujoco>
    """)
    base = mujoco.MjSpec()
    for prefix in ("one_", "two/"):
        frame = base.worldbody.add_frame(pos=[0, len(prefix), 0])
        frame.attach_body(child.copy().body("b"), prefix, "")
    for prefix in ("one_", "two/"):
        if all(text.name != f"{prefix}foil:fin" for text in base.texts):
            base.add_text(name=f"{prefix}foil:fin", data="walls=1")
    model = base.compile()
    assert [foil.name for foil in find_foils(model)] == ["one_fin", "two/fin"]
    assert "foil" in Buoyancy(model).causes


def test_all_copies_of_a_replicated_site_are_foils():
    model = mujoco.MjModel.from_xml_string("""
      <mujoco><custom><text name="foil:fin" data="walls=1"/></custom><worldbody>
        <body name="b"><freejoint/><geom size=".1"/>
        <replicate count="4" euler="90 0 0"><site name="fin" type="box" size=".05 .1 .004"
          pos="0 .2 0"/></replicate></body></worldbody></mujoco>""")
    assert len(find_foils(model)) == 4


def test_a_text_for_one_copy_wins_over_the_one_for_all_copies():
    model = mujoco.MjModel.from_xml_string("""
      <mujoco><custom><text name="foil:fin2" data="walls=0"/><text name="foil:fin" data="walls=1"/>
        </custom><worldbody><body name="b"><freejoint/><geom size=".1"/>
        <replicate count="4" euler="90 0 0"><site name="fin" type="box" size=".05 .1 .004"
          pos="0 .2 0"/></replicate></body></worldbody></mujoco>""")
    walls = {foil.name: foil.foil.walls for foil in find_foils(model)}
    assert walls == {"fin0": 1, "fin1": 1, "fin2": 0, "fin3": 1}


def test_only_the_foils_of_the_bodies_in_this_water_act():
    body = """<body name="{0}" pos="0 {1} -5"><freejoint/><geom size=".1"/>
      <site name="{0}_wing" type="box" size=".05 .2 .004"/></body>"""
    texts = "".join(f'<text name="foil:{name}_wing" data="walls=1"/>' for name in "ab")
    model = mujoco.MjModel.from_xml_string(
        f"<mujoco><custom>{texts}</custom><worldbody>{body.format('a', 0)}{body.format('b', 3)}"
        "</worldbody></mujoco>"
    )
    data = mujoco.MjData(model)
    data.qvel[[0, 6]] = 1.0
    mujoco.mj_forward(model, data)
    rows = Buoyancy(model, bodies=[2]).evaluate(data).by_cause["foil"]
    assert not rows[1].any()
    assert rows[2].any()


def test_an_inspection_lists_the_foils():
    report = inspect_model(finned('<text name="foil:fin" data="walls=1"/>'))
    assert "| fin | 0.02 | 4 | 3.883 | 19.4 |" in to_markdown(report)
    assert to_json(report)["foils"] == [
        {
            "name": "fin",
            "span": pytest.approx(0.2),
            "chord": pytest.approx(0.1),
            "area": pytest.approx(0.02),
            "aspect_ratio": pytest.approx(4.0),
            "lift_slope": pytest.approx(3.883, rel=1e-3),
            "stall": pytest.approx(math.radians(19.4), rel=1e-2),
        }
    ]


KEYS = (
    "aspect, chord, crossflow, drag, efficiency, lift_slope, span, stall, suction, thickness, "
    "walls, zero_lift"
)
BAD_WORDS = {
    "naca=0015": f"the text 'foil:fin' has the word 'naca=0015'; possible: {KEYS}",
    "stal=15": "the text 'foil:fin' has the word 'stal=15'; did you mean 'stall'? "
    f"possible: {KEYS}",
    "stall": "the text 'foil:fin' has the word 'stall'; it must be stall= and a number, as "
    "'stall=1'",
    "walls=1.5": "the text 'foil:fin' has the word 'walls=1.5'; it must be walls= and a whole "
    "number, as 'walls=1'",
    "stall=15 stall=16": "the text 'foil:fin' has stall twice; leave one of them out",
    "stall=95": "the text 'foil:fin': foil stall is 95.0; it must be at least 1 and at most 60",
    "zero_lift=-40": "the text 'foil:fin': foil zero_lift is -40.0; it must be at least -20 and at "
    "most 20",
    "span=-0.2": "the text 'foil:fin': foil span is -0.2; it must be above 0",
    "chord=0": "the text 'foil:fin': foil chord is 0.0; it must be above 0",
    "drag=nan": "the text 'foil:fin': foil drag is nan; it must be a finite number",
    "walls=3": "the text 'foil:fin': foil walls is 3; it must be a whole number from 0 to 2",
    "aspect=3 walls=1": "the text 'foil:fin': foil aspect is 3 beside 1 walls; an aspect ratio "
    "holds what walls do to it, so leave one of them out",
}


@pytest.mark.parametrize("words", BAD_WORDS)
def test_bad_words_of_a_foil_are_told_in_one_sentence(words):
    with pytest.raises(ModelError) as error:
        parse_foil(words, "the text 'foil:fin'")
    assert str(error.value) == BAD_WORDS[words]


def modelled(custom, more=""):
    return mujoco.MjModel.from_xml_string(f"""
      <mujoco><custom>{custom}</custom><worldbody>
        <geom name="quay" type="box" size="1 1 1" pos="9 9 9"/>
        <body name="b"><freejoint/><geom name="hull" type="box" size=".5 .1 .1"/>
          <geom name="ball" size=".1" pos="0 0 .3"/>
          <site name="fin" type="box" size=".05 .1 .004"/>{more}</body>
      </worldbody></mujoco>""")


BAD_MODELS = {
    '<text name="foil:rudder" data="walls=1"/>': "'foil:rudder' is for the geom or site 'rudder', "
    "which the model does not have; possible: fin, hull",
    '<text name="foil:ball" data="walls=1"/>': "'foil:ball' is for the geom 'ball', a sphere; make "
    "it a box or an ellipsoid, x along the chord, y along the span, z along the normal, or give "
    "the body such a site",
    '<text name="foil:quay" data="walls=1"/>': "'foil:quay' is for the geom 'quay' of body "
    "'world', which cannot move; give it a joint, or remove the text",
    '<numeric name="foil:fin" data="1"/>': "'foil:fin' is a <numeric> and is read only as a "
    "<text>; make it one",
    '<text name="foils:fin" data="walls=1"/>': "the text 'foils:fin' is none that water reads; did "
    "you mean 'foil:NAME'? possible: added_mass:BODY, buoyancy_fill, buoyancy_geoms, "
    "buoyancy_hull, foil:NAME, linear_damping:BODY, quadratic_damping:BODY, "
    "radiation_damping:BODY",
    '<text name="foil" data="walls=1"/>': "the text 'foil' is none that water reads; did you mean "
    "'foil:NAME'? possible: added_mass:BODY, buoyancy_fill, buoyancy_geoms, buoyancy_hull, "
    "foil:NAME, linear_damping:BODY, quadratic_damping:BODY, radiation_damping:BODY",
    '<text name="foil_fin" data="walls=1"/>': "the text 'foil_fin' is none that water reads; did "
    "you mean 'foil:NAME'? possible: added_mass:BODY, buoyancy_fill, buoyancy_geoms, "
    "buoyancy_hull, foil:NAME, linear_damping:BODY, quadratic_damping:BODY, "
    "radiation_damping:BODY",
}


@pytest.mark.parametrize("custom", BAD_MODELS)
def test_a_foil_that_cannot_be_is_told_in_one_sentence(custom):
    with pytest.raises(ModelError) as error:
        Buoyancy(modelled(custom))
    assert str(error.value) == BAD_MODELS[custom]


def test_a_name_that_a_geom_and_a_site_share_is_told():
    text = '<text name="foil:fin" data="walls=1"/>'
    model = modelled(text, '<geom name="fin" type="box" size=".1 .1 .01" pos="0 0 1"/>')
    with pytest.raises(ModelError) as error:
        find_foils(model)
    assert str(error.value) == (
        "'foil:fin' may be for the geom 'fin' and for the site; rename one of them"
    )


def test_two_texts_for_one_foil_are_told():
    model = mujoco.MjModel.from_xml_string("""
      <mujoco><custom><text name="a/foil:fin" data="walls=1"/>
        <text name="foil:a/fin" data="walls=0"/></custom><worldbody><body name="a/b"><freejoint/>
        <geom size=".1"/><site name="a/fin" type="box" size=".05 .1 .004"/></body></worldbody>
      </mujoco>""")
    with pytest.raises(ModelError) as error:
        find_foils(model)
    assert str(error.value) == (
        "'a/foil:fin' and 'foil:a/fin' both make 'a/fin' a foil; remove one of them"
    )


def test_texts_of_other_people_are_left_alone():
    model = modelled('<text name="oil:tank" data="full"/><text name="foiling" data="yes"/>')
    assert find_foils(model) == ()
    assert "foil" not in Buoyancy(model).causes
