"""A symmetric body in head waves: mirror images, angular momentum, and growth into yaw."""

import mujoco
import numpy as np
import pytest

from buoyancy_mj import Buoyancy, Damping, Exact, RegularWave, Water

LENGTH, BREADTH, HEIGHT = 0.5, 0.3, 0.2
ASIDE = [3, 5, 7, 9, 11]
"""Coordinates that a mirror in the plane of symmetry turns round, but for sway, on which nothing
depends here: roll and yaw; the rates of sway, roll and yaw."""
MIRROR = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])


def model_of(length=LENGTH, breadth=BREADTH, damping="", timestep=0.01, integrator="RK4"):
    """A box of half the water's density; its draft is half its height."""
    numeric = f'<numeric name="linear_damping:hull" data="{damping}"/>' if damping else ""
    return mujoco.MjModel.from_xml_string(
        f"""<mujoco><option timestep="{timestep}" integrator="{integrator}"/>
        <custom>{numeric}</custom><worldbody><body name="hull"><freejoint/>
        <geom type="box" size="{length / 2} {breadth / 2} {HEIGHT / 2}" density="500"/>
        </body></worldbody></mujoco>"""
    )


def head_waves(amplitude=0.1, frequency=0.5):
    return Water(waves=RegularWave(amplitude, frequency=frequency))


def moved(model, start, steps):
    """Where a state, time and qpos and qvel, comes to."""
    data = mujoco.MjData(model)
    data.time, data.qpos[:], data.qvel[:] = start
    mujoco.mj_step(model, data, steps)
    return data.time, data.qpos.copy(), data.qvel.copy()


def shifted(model, state, change):
    """A state and a small change (12,) of its tangent and its velocity."""
    time, qpos, qvel = state[0], state[1].copy(), state[2]
    mujoco.mj_integratePos(model, qpos, change[:6], 1.0)
    return time, qpos, qvel + change[6:]


def difference(model, one, other):
    """The change (12,) that leads from one state to another."""
    tangent = np.zeros(6)
    mujoco.mj_differentiatePos(model, tangent, 1.0, one[1], other[1])
    return np.concatenate([tangent, other[2] - one[2]])


def at_rest(yaw=0.0):
    return 0.0, np.array([0, 0, 0, np.cos(yaw / 2), 0, 0, np.sin(yaw / 2)]), np.zeros(6)


def settled(model, state, periods, steps):
    """A state after some periods in the plane of symmetry, and its last advance [m] along x."""
    for _ in range(periods):
        before = state[1][0]
        time, qpos, qvel = moved(model, state, steps)
        qpos[[1, 4, 6]] = 0.0
        qpos[3:] /= np.linalg.norm(qpos[3:])
        qvel[[1, 3, 5]] = 0.0
        state = time, qpos, qvel
    return state, qpos[0] - before


def apart(model, state, change, steps):
    """What becomes of a small change (12,) out of the plane of symmetry: the change (5,) `ASIDE`.

    Half the distance between starts to both sides, in which all cancels that they have in common.
    """
    ends = [moved(model, shifted(model, state, s * change), steps) for s in (-1.0, 1.0)]
    return 0.5 * difference(model, *ends)[ASIDE]


def grown(model, state, steps, by=1e-5):
    """How small changes out of the plane of symmetry grow in some steps (5, 5)."""
    changes = by * np.eye(12)[ASIDE]
    return np.column_stack([apart(model, state, c, steps) for c in changes]) / by


# mirror images


def mirrored(state):
    """The image of a state in the plane of x and z."""
    time, qpos, qvel = state
    return time, qpos * [1, -1, 1, 1, -1, 1, -1], qvel * MIRROR


START = (
    0.0,
    np.array([0.0, 0.0, 0.03, *np.array([1, 0.15, 0.1, 0.2]) / np.sqrt(1.0725)]),
    np.array([0.3, 0.2, 0.0, 0.4, -0.5, 0.6]),
)


@pytest.mark.parametrize("damping", [Damping(), None], ids=["drag", "no drag"])
def test_mirrored_starts_stay_mirror_images_on_still_water(damping):
    model = model_of()
    with Buoyancy(model, damping=damping).installed():
        one, other = (moved(model, start, 500) for start in (START, mirrored(START)))
    assert difference(model, mirrored(one), other) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("pressure", ["archimedes", "hydrostatic", "froude-krylov"])
def test_in_waves_sides_differ_by_the_cuts_of_triangles_alone(pressure):
    # the triangles of a box are no mirror images of each other; finer ones are more nearly so
    model = model_of()
    data = mujoco.MjData(model)
    worst = []
    for tolerance in (2e-3, 1e-4):
        water = Buoyancy(model, head_waves(), pressure=pressure, method=Exact(tolerance=tolerance))
        aside = []
        for time in np.linspace(0.0, 2.0, 9):
            data.time = time
            data.qpos[:] = [0, 0, 0.1 * np.cos(np.pi * time), np.cos(0.03), 0, np.sin(0.03), 0]
            data.qvel[:] = [0.1, 0, 0.1, 0, 0.1, 0]
            mujoco.mj_forward(model, data)
            total = water.evaluate(data).total
            aside.append([total.force[1], total.torque[0] / LENGTH, total.torque[2] / LENGTH])
        weight = model.body_mass[1] * 9.81
        worst.append(np.abs(aside).max() / weight)
        assert worst[-1] < 0.1 * tolerance
    # or there is nothing left to differ
    assert worst[1] < max(0.5 * worst[0], 1e-12)


# yaw


def test_a_vertical_force_leaves_the_angular_momentum_about_the_vertical():
    model = model_of(timestep=0.005)
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = START[1:]
    momenta = []
    with Buoyancy(model, head_waves(), damping=None).installed():
        for _ in range(10):
            mujoco.mj_step(model, data, 100)
            mujoco.mj_subtreeVel(model, data)
            momenta.append(data.subtree_angmom[1].copy())
    x, y, z = np.transpose(momenta)
    assert np.ptp(z) < 1e-6
    assert min(np.ptp(x), np.ptp(y)) > 0.1


@pytest.mark.parametrize(
    ("length", "breadth"), [(LENGTH, BREADTH), (BREADTH, LENGTH)], ids=["head-on", "beam-on"]
)
def test_damped_yaw_grows_as_theory_says(length, breadth):
    # damping about the axes, and of heave so that the motion settles
    stated = np.array([0.2, 0.4, 0.05])
    frequency, slope = 0.4, 0.005
    omega = 2.0 * np.pi * frequency
    steps = round(1.0 / frequency / 0.01)
    model = model_of(length, breadth, f"0 0 60 {' '.join(map(str, stated))}")
    wave = RegularWave(slope * 9.81 / omega**2, frequency=frequency)
    with Buoyancy(model, Water(waves=wave)).installed():
        state, _ = settled(model, at_rest(), 40, steps)
        found = np.linalg.eigvals(grown(model, state, steps))
    rates = np.sort(np.log(found.astype(complex)).real * frequency)

    # half of the box is wet, and damping scales with that
    bx, by, bz = 0.5 * stated
    mass, inertia = model.body_mass[1], model.body_inertia[1]
    draft = 0.5 * HEIGHT

    def turn(side, inertia, damping):
        """Amplitude of roll or pitch over that of the slope, without a restoring by the slope."""
        by_waterplane = mass * 9.81 * side**2 / (12.0 * draft)
        restoring = by_waterplane - mass * 9.81 * 0.5 * draft
        return by_waterplane / (restoring - inertia * omega**2 - 1j * omega * damping)

    roll, pitch = turn(breadth, inertia[0], bx), turn(length, inertia[1], by)
    moment = -0.5 * slope**2 * omega * (bx + by - bz) * (pitch * np.conj(roll)).imag
    rate = (np.sqrt(bz**2 + 4.0 * inertia[2] * moment) - bz) / (2.0 * inertia[2])

    # sway is free, and has a multiplier of 1
    slowest = rates[np.argsort(np.abs(rates))][:2]
    assert slowest[0] == pytest.approx(0.0, abs=1e-9)
    assert slowest[1] == pytest.approx(rate, rel=0.02)
    assert (rate > 0.0) == (length > breadth)


def period_map(amplitude, pressure):
    """A box with drag in head waves: its motion from one meeting of a crest to the next.

    Returns:
        The model, its water, a state of the periodic motion, the steps of a period, and how what
        leads out of the plane of symmetry grows in one.
    """
    wave = RegularWave(amplitude, frequency=0.5)
    period, steps, state = wave.period, 100, at_rest()
    for _ in range(3):
        model = model_of(timestep=period / steps, integrator="implicitfast")
        water = Buoyancy(model, Water(waves=wave), pressure=pressure)
        with water.installed():
            state, advance = settled(model, state, 40, steps)
        # the body drifts along, and meets crests less often
        period = 1.0 / (wave.frequency - advance / period / wave.wavelength)
    with water.installed():
        return model, water, state, steps, grown(model, state, steps)


def test_growth_into_yaw_is_that_of_the_linearised_motion_whatever_the_seed():
    model, water, state, steps, once = period_map(0.2, "archimedes")
    assert np.abs(np.linalg.eigvals(once)).max() > 1.05
    expected = np.linalg.matrix_power(once, 8)[:, 1]
    for seed in (1e-8, 1e-6, 1e-4):
        with water.installed():
            got = apart(model, state, seed * np.eye(12)[5], 8 * steps) / seed
        assert got == pytest.approx(expected, abs=0.02 * np.abs(expected).max())


def test_under_the_pressure_of_waves_the_same_box_keeps_its_heading():
    *_, once = period_map(0.1, "froude-krylov")
    assert np.abs(np.linalg.eigvals(once)).max() < 0.95
