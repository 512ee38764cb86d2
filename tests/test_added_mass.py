"""Added mass: Lamb's ellipsoids, Kirchhoff's equations, periods, waves, and a steady engine."""

import math
import re

import mujoco
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from buoyancy_mj import Buoyancy, ModelError, RegularWave, Settings, Water, add_water, water_in
from buoyancy_mj.hulls.geoms import find_hulls
from buoyancy_mj.kernels.waves import add_motion, add_velocity
from buoyancy_mj.loads.added_mass_estimates import estimate_added_mass
from buoyancy_mj.potential.ellipsoid import ellipsoid_added_mass
from tests import vessels

DIAGONAL = np.array([3.0, 9.0, 14.0, 0.2, 0.5, 0.4])


# closed forms


def test_a_sphere_carries_half_its_volume():
    assert ellipsoid_added_mass((0.3, 0.3, 0.3), 1000.0) == pytest.approx(
        [0.5 * 1000 * 4 / 3 * math.pi * 0.027] * 3 + [0.0] * 3, rel=1e-12
    )


@pytest.mark.parametrize(
    ("ratio", "along", "across", "turning"),
    # Lamb 1932, art. 115: prolate spheroids, k1, k2, k'
    [
        (1.5, 0.305, 0.621, 0.094),
        (2.0, 0.209, 0.702, 0.240),
        (3.99, 0.082, 0.860, 0.608),
        (9.97, 0.021, 0.960, 0.883),
    ],
)
def test_a_spheroid_has_lambs_coefficients(ratio, along, across, turning):
    mass = 4 / 3 * math.pi * ratio
    found = ellipsoid_added_mass((ratio, 1.0, 1.0), 1.0)
    # his table is good to a few units of its last digit
    assert found[:3] / mass == pytest.approx([along, across, across], abs=3e-3)
    assert found[3:] / (0.2 * mass * (ratio**2 + 1)) == pytest.approx(
        [0.0, turning, turning], abs=3e-3
    )
    # and his formulas
    e = math.sqrt(1 - 1 / ratio**2)
    log = math.log((1 + e) / (1 - e))
    alpha, beta = (
        2 * (1 - e * e) / e**3 * (0.5 * log - e),
        1 / e**2 - (1 - e * e) / (2 * e**3) * log,
    )
    assert found[:2] / mass == pytest.approx([alpha / (2 - alpha), beta / (2 - beta)], rel=1e-9)
    k = e**4 * (beta - alpha) / ((2 - e * e) * (2 * e * e - (2 - e * e) * (beta - alpha)))
    assert found[4] / (0.2 * mass * (ratio**2 + 1)) == pytest.approx(k, rel=1e-8)


def test_a_thin_disc_has_its_limits():
    # Lamb 1932, art. 102, 108: broadside 8/3 rho a^3, about a diameter 16/45 rho a^5
    found = ellipsoid_added_mass((1.0, 1.0, 1e-5), 1.0)
    assert found[2] == pytest.approx(8 / 3, rel=1e-4)
    assert found[3] == pytest.approx(16 / 45, rel=1e-4)


def test_the_estimate_for_an_ellipsoid_is_exact_wherever_it_sits():
    model = vessels.of_geoms(
        '<geom type="ellipsoid" size=".5 .3 .2" pos=".1 .2 -.1" euler="20 30 40" mass="9"/>'
    )
    matrix = estimate_added_mass(find_hulls(model), 1025.0).matrix
    turn = np.empty(9)
    mujoco.mju_quat2Mat(turn, model.geom_quat[0])
    axes = np.kron(np.eye(2), turn.reshape(3, 3))
    # about its own middle
    back = np.eye(6)
    x, y, z = -model.geom_pos[0]
    back[:3, 3:] = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]).T
    own = axes.T @ back.T @ matrix @ back @ axes
    assert own == pytest.approx(
        np.diag(ellipsoid_added_mass((0.5, 0.3, 0.2), 1025.0)), abs=2e-3 * matrix.max()
    )


def test_two_hulls_of_one_body_count_together():
    one = vessels.of_geoms('<geom type="box" size="1 .3 .2" mass="9"/>')
    two = vessels.of_geoms(
        '<geom type="box" size=".5 .3 .2" pos=".5 0 0" mass="9"/>'
        '<geom type="box" size=".5 .3 .2" pos="-.5 0 0"/>'
    )
    assert estimate_added_mass(find_hulls(two), 1000.0, "ellipsoid").matrix == pytest.approx(
        estimate_added_mass(find_hulls(one), 1000.0, "ellipsoid").matrix, abs=1e-6
    )


# the engine's mass matrix


ARM = """<mujoco><custom><numeric name="added_mass:hull" data="{hull}"/>
<numeric name="added_mass:arm" data="{arm}"/></custom>
<option timestep="0.005" gravity="0 0 -9.81"/><worldbody><body name="hull" pos="0 0 -3"><freejoint/>
<geom type="ellipsoid" size=".4 .2 .15" mass="45" pos=".05 0 .02"/>
<body name="arm" pos=".4 .1 0"><joint axis="0 1 .2"/>
<geom type="capsule" size=".05" fromto="0 0 0 .5 0 0" mass="3"/>
</body></body></worldbody></mujoco>"""


def words(matrix):
    return " ".join(str(value) for value in np.ravel(matrix))


def random_matrix(seed, scale):
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(6, 6))
    return scale * root @ root.T


def moved(model, seed=3):
    """Data with everything in motion."""
    data = mujoco.MjData(model)
    rng = np.random.default_rng(seed)
    data.qpos[3:7] = Rotation.random(random_state=seed).as_quat(scalar_first=True)
    data.qpos[7:] = rng.uniform(-1, 1, model.nq - 7)
    data.qvel[:] = rng.normal(size=model.nv)
    return data


@pytest.mark.parametrize("native", [True, False])
def test_each_bodys_matrix_enters_as_its_jacobians_say(native):
    matrices = {"hull": random_matrix(1, 5.0), "arm": random_matrix(2, 0.5)}
    model = mujoco.MjModel.from_xml_string(
        ARM.format(hull=words(matrices["hull"]), arm=words(matrices["arm"]))
    )
    data = moved(model)
    mujoco.mj_forward(model, data)
    plain, full = np.zeros((model.nv, model.nv)), np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, plain)
    with Buoyancy(model, damping=None).installed(native=native):
        mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, full)
    expected = plain.copy()
    for name, matrix in matrices.items():
        jacobians = np.zeros((2, 3, model.nv))
        mujoco.mj_jac(model, data, *jacobians, data.body(name).xpos, model.body(name).id)
        turn = data.body(name).xmat.reshape(3, 3)
        own = np.vstack([turn.T @ jacobians[0], turn.T @ jacobians[1]])
        expected += own.T @ matrix @ own
    assert full == pytest.approx(expected, abs=1e-9 * np.abs(expected).max())


@pytest.mark.parametrize("native", [True, False])
def test_a_pass_over_the_same_pose_adds_it_once(native):
    # finite differences of velocities go over a pass without computing the mass matrix anew
    model = mujoco.MjModel.from_xml_string(
        ARM.format(hull=words(DIAGONAL), arm=words(0.1 * DIAGONAL))
    )
    data = moved(model)
    a, again = np.zeros((2, 2 * model.nv, 2 * model.nv))
    with Buoyancy(model).installed(native=native):
        mujoco.mj_forward(model, data)
        before = data.M.copy()
        mujoco.mj_forwardSkip(model, data, mujoco.mjtStage.mjSTAGE_POS, False)
        assert np.array_equal(data.M, before)
        mujoco.mjd_transitionFD(model, data, 1e-6, False, a, None, None, None)
        # by hand, each from its own start
        base = step(model, data, np.zeros(2 * model.nv))
        for i in range(2 * model.nv):
            push = np.zeros(2 * model.nv)
            push[i] = 1e-6
            again[:, i] = difference(model, step(model, data, push), base) / 1e-6
    assert a == pytest.approx(again, abs=2e-5)


def step(model, data, push):
    """State a step after a start that was pushed."""
    copy = mujoco.MjData(model)
    copy.qpos[:], copy.qvel[:] = data.qpos, data.qvel
    mujoco.mj_integratePos(model, copy.qpos, push[: model.nv], 1.0)
    copy.qvel += push[model.nv :]
    mujoco.mj_step(model, copy)
    return copy.qpos.copy(), copy.qvel.copy()


def difference(model, one, other):
    tangent = np.zeros(model.nv)
    mujoco.mj_differentiatePos(model, tangent, 1.0, other[0], one[0])
    return np.concatenate([tangent, one[1] - other[1]])


# motion


def kirchhoff(mass, inertia, added, v, w, duration):
    """Body velocities and attitude of a neutral body in still, unbounded, frictionless water.

    Lamb 1932, art. 124.
    """
    whole = added + np.diag([mass] * 3 + list(inertia))
    inverse = np.linalg.inv(whole)

    def rate(_, y):
        v, w, turn = y[:3], y[3:6], y[6:].reshape(3, 3)
        p, h = np.split(whole @ y[:6], 2)
        change = inverse @ np.concatenate([np.cross(p, w), np.cross(h, w) + np.cross(p, v)])
        skew = np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
        return np.concatenate([change, (turn @ skew).ravel()])

    found = solve_ivp(rate, (0, duration), [*v, *w, *np.eye(3).ravel()], rtol=1e-10, atol=1e-12)
    return found.y[:6, -1], found.y[6:, -1].reshape(3, 3)


@pytest.mark.parametrize("native", [True, False])
@pytest.mark.parametrize("current", [(0.0, 0.0, 0.0), (0.7, -0.4, 0.2)])
def test_a_neutral_body_moves_by_kirchhoffs_equations_in_any_current(native, current):
    a = 0.045 / (4 / 3 * math.pi * 0.4 * 0.2)
    inertia, added = (2.0, 3.0, 4.0), np.diag([4.0, 20.0, 40.0, 0.5, 1.5, 1.0])
    added[0, 4] = added[4, 0] = 1.0
    # a hair off its origin, lest MuJoCo keep its inertia as a diagonal
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><option timestep="0.002" integrator="RK4"/>
        <worldbody><body name="b" pos="0 0 -9"><freejoint/>
        <inertial pos="0 0 1e-5" mass="45" diaginertia="{words(inertia)}"/>
        <geom type="ellipsoid" size=".4 .2 {a}" pos="0 0 1e-5"/></body></worldbody></mujoco>"""
    )
    v, w = np.array([0.5, -0.3, 0.2]), np.array([0.3, 0.8, -0.4])
    data = mujoco.MjData(model)
    data.qvel[:] = [*(v + current), *w]
    with Buoyancy(model, Water(current=current), damping=None, added_mass={"b": added}).installed(
        native=native
    ):
        while data.time < 2.0 - 1e-9:
            mujoco.mj_step(model, data)
    end, turn = kirchhoff(45.0, inertia, added, v, w, 2.0)
    assert data.qvel[3:] == pytest.approx(end[3:], abs=2e-5)
    assert data.body("b").xmat.reshape(3, 3) == pytest.approx(
        turn, abs=4e-3
    )  # of the beginning of the last step
    assert data.qvel[:3] - current == pytest.approx(turn @ end[:3], abs=2e-4)


def test_a_sphere_bobs_slower_by_what_is_wet_of_it():
    # 2 pi sqrt((m + s A) / C33), half of it wet: R 0.15, C33 = rho g pi R^2
    mass, added = 1000 * 2 / 3 * math.pi * 0.15**3, 3.0
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><option timestep="0.002"/>
        <custom><numeric name="added_mass:b" data="3 3 3 0 0 0"/></custom>
        <worldbody><body name="b"><freejoint/><geom type="sphere" size=".15" mass="{mass}"/></body>
        </worldbody></mujoco>"""
    )
    expected = 2 * math.pi * math.sqrt((mass + 0.5 * added) / (1000 * 9.81 * math.pi * 0.15**2))
    for integrator in ("mjINT_EULER", "mjINT_IMPLICITFAST", "mjINT_IMPLICIT", "mjINT_RK4"):
        model.opt.integrator = getattr(mujoco.mjtIntegrator, integrator)
        data = mujoco.MjData(model)
        data.qpos[2] = 0.002
        crossings, last = [], data.qpos[2]
        with Buoyancy(model, damping=None).installed():
            while data.time < 5.0:
                mujoco.mj_step(model, data)
                if last < 0.0 <= data.qpos[2]:
                    crossings.append(data.time - 0.002 * data.qpos[2] / (data.qpos[2] - last))
                last = data.qpos[2]
        assert np.diff(crossings).mean() == pytest.approx(expected, rel=2e-3)


def test_the_bluerov2_heavy_rolls_and_pitches_with_its_periods():
    # P18: von Benzon et al. 2022: roll 3.672 s and pitch 3.311 s with added moments 0.189 and 0.135
    a = (0.0134 / (4 / 3 * math.pi)) ** (1 / 3)
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><option timestep="0.005" integrator="RK4"/><custom>
        <numeric name="added_mass:rov" data="6.36 7.12 18.68 0.189 0.135 0.222"/></custom>
        <worldbody><body name="rov" pos="0 0 -5"><freejoint/>
        <inertial pos="0 0 -.01" mass="13.4" diaginertia="0.26 0.23 0.37"/>
        <geom type="ellipsoid" size="{1.5 * a} {a} {a / 1.5}"/></body></worldbody></mujoco>"""
    )
    for axis, moment, published in ((0, 0.26 + 0.189, 3.672), (1, 0.23 + 0.135, 3.311)):
        data = mujoco.MjData(model)
        data.qpos[3:7] = [math.cos(0.01), 0, 0, 0]
        data.qpos[4 + axis] = math.sin(0.01)
        angles, times = [], []
        with Buoyancy(model, damping=None).installed():
            while data.time < 12.0:
                angles.append(2.0 * data.qpos[4 + axis])
                times.append(data.time)
                mujoco.mj_step(model, data)
        x = np.array(angles)
        k = np.flatnonzero((x[:-1] < 0.0) & (x[1:] >= 0.0))
        when = np.array(times)[k] - 0.005 * x[k] / (x[k + 1] - x[k])
        # free to sway, it turns about a point between G and B: the moment about the centre of
        # buoyancy differs by m z^2
        assert np.diff(when).mean() == pytest.approx(published, rel=1e-2)
        assert 2 * math.pi * math.sqrt(moment / (13.4 * 9.81 * 0.01)) == pytest.approx(
            published, rel=1e-3
        )


def test_a_small_neutral_sphere_follows_the_orbit_of_the_water():
    # with Froude-Krylov (rho V) and added mass (Ca rho V) the water's acceleration is the sphere's:
    # Kelvin
    radius = 0.05
    mass = 1000 * 4 / 3 * math.pi * radius**3
    # of small amplitude, since it drifts by its square (Stokes)
    wave = RegularWave(0.002, wavelength=6.0)
    k, omega, water = 2 * math.pi / 6.0, float(wave.rows[0, 3]), Water(waves=wave)
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><option timestep="0.01" integrator="RK4"/>
        <worldbody><body name="b" pos="0 0 -1"><freejoint/>
        <geom type="sphere" size="{radius}" mass="{mass}"/></body></worldbody></mujoco>"""
    )
    data = mujoco.MjData(model)
    data.qvel[:3] = water.velocity([0.0, 0.0, -1.0], 0.0)
    orbit = 0.002 * math.exp(-k * 1.0)
    places = []
    with Buoyancy(
        model, water, damping=None, pressure="froude-krylov", added_mass="estimate"
    ).installed():
        while data.time < wave.period:
            places.append(data.qpos[:3].copy())
            mujoco.mj_step(model, data)
    x, _, z = np.array(places).T
    t = 0.01 * np.arange(len(x))
    # about the middle of the orbit: x = -a sin(-wt), z = a cos(-wt), from the start at the top
    assert z + 1.0 == pytest.approx(orbit * (np.cos(omega * t) - 1.0), abs=0.02 * orbit)
    assert x == pytest.approx(orbit * np.sin(omega * t), abs=0.02 * orbit)


def test_acceleration_is_the_rate_of_the_velocity_of_the_water_as_it_moves():
    # to first order at the surface, and in one deep wave far below it to second order
    left = {}
    for scale in (0.01, 0.02):
        waves = Water(
            waves=[
                RegularWave(scale, wavelength=5.0, direction=0.7),
                RegularWave(2.0 * scale, period=3.0, depth=4.0),
            ]
        ).table
        deep = Water(waves=RegularWave(10.0 * scale, wavelength=2.0 * math.pi)).table
        for sea, point in (
            (waves, (0.3, 0.2, -0.1)),
            (waves, (0.3, 0.2, -0.5)),
            (waves, (2.0, -1.0, -3.0)),
            (deep, (0.3, 0.0, -3.0)),
        ):
            at, rate, ends = np.zeros(3), np.zeros(3), np.zeros((2, 3))
            add_motion(sea, *point, 1.0, at, rate)
            for end, step in zip(ends, (1e-5, -1e-5), strict=True):
                add_velocity(sea, *(point + step * at), 1.0 + step, end)
            error = rate - (ends[0] - ends[1]) / 2e-5
            left.setdefault(point, []).append(np.abs(error).max())
    for point, (one, two) in left.items():
        assert two < 0.02, point
        assert two / one > (3.0 if point[2] > -3.0 else 3.5), point
    assert left[0.3, 0.0, -3.0][1] < 0.05 * 9.81 * 0.2**2 * math.exp(-6.0)


@pytest.mark.parametrize("integrator", ["Euler", "RK4", "implicit", "implicitfast"])
@pytest.mark.parametrize("solver", ["Newton", "CG", "PGS"])
def test_twenty_times_its_mass_comes_to_rest_on_the_bottom(integrator, solver):
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><option timestep="0.01" integrator="{integrator}" solver="{solver}"/><custom>
        <numeric name="added_mass:hull" data="900 900 900 30 30 30"/>
        <numeric name="added_mass:arm" data="60 60 60 1 1 1"/>
        </custom><worldbody><geom type="plane" size="9 9 .1" pos="0 0 -1"/>
        <body name="hull" pos="0 0 -.5"><freejoint/><geom type="box" size=".2 .2 .1" mass="45"/>
        <body name="arm" pos=".2 0 0"><joint axis="0 1 0" damping="1"/>
        <geom type="capsule" size=".05" fromto="0 0 0 .3 0 0" mass="6"/>
        </body></body></worldbody></mujoco>"""
    )
    data = mujoco.MjData(model)
    with Buoyancy(model).installed():
        while data.time < 40.0:
            mujoco.mj_step(model, data)
    assert np.isfinite(data.qpos).all()
    assert np.abs(data.qvel).max() < 1e-2
    assert data.ncon > 0
    # on the bottom and on its hand
    assert data.qpos[2] == pytest.approx(-0.79, abs=2e-3)


# where it comes from


def test_the_plugin_a_scene_and_the_callback_agree():
    text = ARM.format(hull=words(DIAGONAL), arm=words(0.1 * DIAGONAL))
    sea = Water(waves=RegularWave(0.2, wavelength=4.0), current=(0.3, 0.1, 0.0))
    model = mujoco.MjModel.from_xml_string(text)
    data = moved(model)
    start = data.qpos.copy(), data.qvel.copy()
    with Buoyancy(model, sea).installed():
        mujoco.mj_step(model, data, 100)
    spec = mujoco.MjSpec.from_string(text)
    add_water(spec, sea)
    own = spec.compile()
    theirs = mujoco.MjData(own)
    theirs.qpos[:], theirs.qvel[:] = start
    mujoco.mj_step(own, theirs, 100)
    assert theirs.qpos == pytest.approx(data.qpos, abs=1e-10)
    assert water_in(own).causes == ("buoyancy", "drag", "added_mass")
    loads = water_in(own).loads(theirs)
    assert np.abs(loads.by_cause["added_mass"]).max() > 0.0
    none = mujoco.MjSpec.from_string(text)
    add_water(none, sea, added_mass="none")
    assert water_in(none.compile()).causes == ("buoyancy", "drag")


def test_what_the_model_states_comes_before_an_estimate():
    model = mujoco.MjModel.from_xml_string(
        ARM.format(hull=words(DIAGONAL), arm=words(DIAGONAL)).replace("added_mass:arm", "other")
    )
    of_the_model = Buoyancy(model).added_mass
    assert of_the_model.bodies.tolist() == [model.body("hull").id]
    both = Buoyancy(model, added_mass="estimate").added_mass
    assert both.bodies.tolist() == [model.body("hull").id, model.body("arm").id]
    assert both.matrices[0].reshape(6, 6) == pytest.approx(np.diag(DIAGONAL))
    assert both.matrices[1].reshape(6, 6)[1, 1] > 2.0
    assert len(Buoyancy(model, added_mass=None).added_mass.bodies) == 0
    assert len(Buoyancy(model, added_mass="none").added_mass.bodies) == 0


def test_above_the_water_nothing_is_added():
    model = mujoco.MjModel.from_xml_string(
        ARM.format(hull=words(DIAGONAL), arm=words(DIAGONAL)).replace("0 0 -3", "0 0 9")
    )
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    plain = data.M.copy()
    with Buoyancy(model).installed():
        mujoco.mj_forward(model, data)
    assert np.array_equal(data.M, plain)


@pytest.mark.parametrize(
    ("added_mass", "message"),
    [
        (
            "guess",
            "added mass is 'guess'; "
            "possible: ellipsoid, estimate, mesh, model, none, or matrices by body",
        ),
        (
            {"boat": DIAGONAL},
            "added mass is given for body 'boat', which has no hull of its own; "
            "possible: arm, hull",
        ),
        (
            {"hull": [1, 2, 3]},
            "the added mass of body 'hull' is [1, 2, 3], of shape (3,); "
            "it must be numbers of shape (6,) or (36,) or (6, 6)",
        ),
        (
            {"hull": [1, 2, 3, 4, 5, math.nan]},
            "the added mass of body 'hull' holds nan; its numbers must be finite",
        ),
        (
            {"hull": "heavy"},
            "the added mass of body 'hull' is 'heavy'; "
            "it must be numbers of shape (6,) or (36,) or (6, 6)",
        ),
        (
            {"hull": np.eye(6) + np.eye(6, k=1)},
            "the added mass of body 'hull' is not symmetric; average it with its transpose",
        ),
        (
            {"hull": -DIAGONAL},
            "has a negative eigenvalue, -14; the water would push it on: check the signs",
        ),
    ],
)
def test_added_mass_that_makes_no_sense_is_refused(added_mass, message):
    model = mujoco.MjModel.from_xml_string(ARM.format(hull=words(DIAGONAL), arm=words(DIAGONAL)))
    with pytest.raises(ModelError, match=re.escape(message)):
        Buoyancy(model, added_mass=added_mass)


def test_added_mass_of_a_body_that_there_is_not_waits_for_the_model_and_all_else_does_not():
    Settings(added_mass={"no such body": DIAGONAL})
    for added_mass, message in (
        (
            "guess",
            "added mass is 'guess'; "
            "possible: ellipsoid, estimate, mesh, model, none, or matrices by body",
        ),
        (
            5,
            "added mass is 5; "
            "possible: ellipsoid, estimate, mesh, model, none, or matrices by body",
        ),
        ({"hull": np.zeros((3, 12))}, "of shape (3, 12); it must be numbers of shape (6,)"),
        ({"hull": np.eye(6) * 1j}, "it must be numbers of shape (6,) or (36,) or (6, 6)"),
        ({"hull": [10**400] * 6}, "it must be numbers of shape (6,) or (36,) or (6, 6)"),
        ({"hull": -DIAGONAL}, "the added mass of body 'hull' has a negative eigenvalue"),
    ):
        with pytest.raises(ModelError, match=re.escape(message)):
            Settings(added_mass=added_mass)


def test_a_body_whose_inertia_is_kept_as_a_diagonal_takes_what_fits():
    model = vessels.of_geoms('<geom type="box" size=".2 .2 .2" mass="5"/>')
    assert (model.M_rownnz == 1).all()
    with pytest.raises(
        ModelError,
        match=r"MuJoCo keeps the inertia of body 'hull' as a diagonal, "
        r".* write <body simple='false'>",
    ):
        Buoyancy(model, added_mass={"hull": DIAGONAL})
    assert (
        len(Buoyancy(model, added_mass={"hull": [2, 2, 2, 0.1, 0.2, 0.3]}).added_mass.bodies) == 1
    )
