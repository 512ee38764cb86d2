import mujoco
import numpy as np
import pytest

from buoyancy_mj import Buoyancy, Damping, ModelError, Silhouette, Water
from buoyancy_mj.hulls.geoms import find_hulls
from buoyancy_mj.loads.damping_arrays import resolve_damping


def damping(geom, drag=None, extra="", density=1000.0):
    model = mujoco.MjModel.from_xml_string(
        f"<mujoco><worldbody><body><freejoint/>{geom}{extra}</body></worldbody></mujoco>"
    )
    return resolve_damping(drag or Damping(), model, find_hulls(model), density)


def coefficients(geom, areas):
    """C along each axis, from 1/2 rho C A."""
    return damping(geom).quadratic[0, :3] / (0.5 * 1000.0 * np.array(areas))


def test_a_cube_has_the_coefficient_that_hoerner_measured():
    assert coefficients('<geom type="box" size=".2 .2 .2"/>', [0.16] * 3) == pytest.approx(
        [1.05] * 3, rel=1e-2
    )


def test_a_sphere_is_near_the_coefficient_that_hoerner_measured():
    assert coefficients('<geom type="sphere" size=".2"/>', [np.pi * 0.04] * 3) == pytest.approx(
        [0.47] * 3, rel=0.15
    )


def test_a_short_cylinder_across_the_flow_is_near_whites_table():
    # L / D = 2: 0.68
    across = coefficients('<geom type="cylinder" size=".2 .4"/>', [0.32, 0.32, np.pi * 0.04])[0]
    assert across == pytest.approx(0.68, rel=0.05)


def test_drag_grows_with_the_density_of_the_water():
    geom = '<geom type="box" size=".2 .2 .2"/>'
    assert damping(geom, density=1025.0).quadratic == pytest.approx(1.025 * damping(geom).quadratic)


def test_a_hidden_part_adds_nothing_to_the_silhouette():
    geom = '<geom type="box" size=".5 .2 .2"/>'
    behind = '<geom type="box" size=".1 .1 .1" pos=".7 0 0"/>'
    assert damping(geom, extra=behind).quadratic[0, 0] == pytest.approx(
        damping(geom).quadratic[0, 0], rel=0.02
    )


def test_along_the_flow_a_plate_has_the_friction_of_its_sides():
    option = Damping(viscous=Silhouette(friction=0.003))
    along = damping('<geom type="box" size=".5 .2 .0005"/>', option).quadratic[0, 0]
    sides = 0.5 * 1000.0 * 0.003 * 2.0 * 0.4
    front = 0.5 * 1000.0 * 1.05 * 0.82 * 0.4 * 0.001
    assert along == pytest.approx(sides + front, rel=1e-2)


def test_drag_along_a_cylinder_changes_smoothly_with_its_length():
    # flow closes on the sides from 0.55 to 2.2 diameters on
    lengths = np.linspace(0.3, 3.0, 10)
    found = [
        coefficients(f'<geom type="cylinder" size=".1 {0.1 * x}"/>', [1, 1, np.pi * 0.01])[2]
        for x in lengths
    ]
    friction = 0.0075 * 4.0 * lengths
    closed = np.interp(lengths, (0.55, 2.2), (0.0, 1.0))
    assert found == pytest.approx(1.05 * (1.0 - 0.18 * closed) + friction, rel=1e-2)


def test_turning_a_plate_meets_the_flow_at_each_strips_own_speed():
    # 1/2 rho C int |x|^3 dA over a plate 2 a long and 2 b wide: 1/2 rho C b a^4, on its flat sides
    a, b = 0.5, 0.2
    about_y = damping(f'<geom type="box" size="{a} {b} .001"/>').quadratic[0, 4]
    assert about_y == pytest.approx(0.5 * 1000.0 * 1.05 * b * a**4, rel=0.02)


def test_linear_and_quadratic_parts_are_equal_at_the_froude_number_of_the_options():
    d = damping(
        '<geom type="box" size=".5 .2 .2"/>', Damping(viscous=Silhouette(linear_froude=0.07))
    )
    speed = 0.07 * np.sqrt(9.81 * 1.0)
    assert d.linear[0, :3] == pytest.approx(d.quadratic[0, :3] * speed)
    assert damping(
        '<geom type="box" size=".5 .2 .2"/>', Damping(viscous=Silhouette(linear_froude=0.0))
    ).linear == pytest.approx(0.0)


BOX = """<mujoco><worldbody><body pos="0 0 -2"><freejoint/>
<geom type="box" size=".3 .2 .1" mass="24"/></body></worldbody></mujoco>"""


def test_the_force_on_a_moving_box_is_half_rho_c_a_v_squared():
    model = mujoco.MjModel.from_xml_string(BOX)
    data = mujoco.MjData(model)
    data.qvel[0] = 1.5
    mujoco.mj_forward(model, data)
    rows = (
        Buoyancy(model, damping=Damping(viscous=Silhouette(linear_froude=0.0)))
        .evaluate(data)
        .by_cause["drag"]
    )
    # 0.6 m long, as wide as a disk of 0.08 m^2: 1.88 lengths over widths; 0.72 m^2 of sides
    slenderness = 0.6 / np.sqrt(4 * 0.08 / np.pi)
    c = 1.05 * (1.0 - 0.18 * (slenderness - 0.55) / 1.65) + 0.0075 * 0.72 / 0.08
    assert c == pytest.approx(0.965, abs=1e-3)
    assert rows[1, :3] == pytest.approx([-0.5 * 1000.0 * c * 0.08 * 1.5**2, 0.0, 0.0], rel=1e-2)


def test_drag_scales_with_what_is_wet_and_acts_at_its_centroid():
    model = mujoco.MjModel.from_xml_string(BOX)
    forces = []
    for z in (-2.0, 0.0):
        data = mujoco.MjData(model)
        data.qpos[2], data.qvel[0] = z, 1.0
        mujoco.mj_forward(model, data)
        forces.append(Buoyancy(model).evaluate(data).by_cause["drag"][1])
    assert forces[1][0] == pytest.approx(0.5 * forces[0][0])
    # 5 cm below the centre of mass
    assert forces[1][4] == pytest.approx(-0.05 * forces[1][0])


def test_a_body_at_rest_in_a_current_is_pushed_along():
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><worldbody><body pos="0 0 -2"><freejoint/><geom size=".1" mass="4"/></body>'
        "</worldbody></mujoco>"
    )
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    still, moving = (
        Buoyancy(model, Water(current=c)).evaluate(data).by_cause["drag"][1]
        for c in ((0, 0, 0), (0, 0.5, 0))
    )
    assert still == pytest.approx(0.0)
    assert moving[1] > 0.0
    assert moving[[0, 2]] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("coefficient", -1.0),
        ("linear_froude", float("nan")),
        ("coefficient", "big"),
        ("friction", -0.01),
    ],
)
def test_impossible_drag_is_refused(field, value):
    with pytest.raises(
        ModelError,
        match=f"damping {field} is .*; it must be (a finite number|at least 0 and at most 1e\\+06)",
    ):
        Damping(viscous=Silhouette(**{field: value}))


ROV = """<mujoco><option timestep="0.01" gravity="0 0 -9.81"/><custom>
<numeric name="added_mass:rov" data="6.36 7.12 18.68 0.189 0.135 0.222"/>
<numeric name="linear_damping:rov" data="13.7 0 33 0 0.8 0"/>
<numeric name="quadratic_damping:rov" data="141 217 190 1.19 0.47 1.5"/></custom>
<worldbody><body name="rov" pos="0 0 -9"><freejoint/>
<inertial pos="0 0 -.01" mass="13.5" diaginertia="0.26 0.23 0.37"/>
<geom type="ellipsoid" size="{} {} {}"/></body></worldbody></mujoco>"""


def rov():
    """The BlueROV2 Heavy by its parameters, as an ellipsoid of its volume 0.0134 m^3."""
    a = (0.0134 / (4 / 3 * np.pi)) ** (1 / 3)
    return mujoco.MjModel.from_xml_string(ROV.format(1.5 * a, a, a / 1.5))


@pytest.mark.parametrize(
    ("density", "push", "axis", "speed"),
    # P18: von Benzon et al. 2022, J. Mar. Sci. Eng. 10(12):1898: sinks with 0.981 N in fresh water,
    # rises with 2.305 N in sea water; surge with 10, 40, 100 N
    [
        (1000, 0, 2, -0.0259),
        (1025, 0, 2, 0.0534),
        (1000, 10, 0, 0.222),
        (1000, 40, 0, 0.486),
        (1000, 100, 0, 0.795),
    ],
)
def test_the_bluerov2_heavy_reaches_its_terminal_speeds(density, push, axis, speed):
    model = rov()
    data = mujoco.MjData(model)
    with Buoyancy(model, Water(density=density)).installed():
        while data.time < 20.0:
            # held level, as its autopilot does
            data.qvel[3:] = 0.0
            data.qpos[3:7] = [1, 0, 0, 0]
            data.xfrc_applied[1, 0] = push
            mujoco.mj_step(model, data)
    assert data.qvel[axis] == pytest.approx(speed, rel=1e-2)


def test_damping_that_the_model_gives_replaces_the_estimate_of_that_body():
    damping = resolve_damping(Damping(), rov(), find_hulls(rov()), 1000.0)
    assert damping.linear[0].tolist() == [13.7, 0, 33, 0, 0.8, 0]
    assert damping.quadratic[0].tolist() == [141, 217, 190, 1.19, 0.47, 1.5]


@pytest.mark.parametrize(
    ("before", "after", "message"),
    [
        (
            'data="13.7 0 33 0 0.8 0"',
            'data="13.7 0 33"',
            "the linear damping of body 'rov' is .* it must be 6 numbers",
        ),
        (
            'data="141 ',
            'data="-141 ',
            "the quadratic damping of body 'rov' is .*X_uu have the other sign",
        ),
        (
            "linear_damping:rov",
            "linear_damping:auv",
            "linear damping is given for body 'auv', which the model does not have; possible: rov",
        ),
    ],
)
def test_damping_that_makes_no_sense_is_refused(before, after, message):
    a = 0.15
    model = mujoco.MjModel.from_xml_string(ROV.format(a, a, a).replace(before, after))
    with pytest.raises(ModelError, match=message):
        Buoyancy(model)
