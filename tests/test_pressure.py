"""Wave pressure: mean-value theorem, a published table, limits, a slow twin, the compiled path."""

import math

import mujoco
import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import j1

from buoyancy_mj import (
    Buoyancy,
    Damping,
    JonswapSea,
    LevelOscillation,
    MethodError,
    RegularWave,
    TriMesh,
    Water,
    add_water,
    hydrostatics,
    water_in,
)
from buoyancy_mj.kernels.waves import head, tabulate
from buoyancy_mj.meshes import shapes
from buoyancy_mj.scenes.scene import scene_from_table
from buoyancy_mj.submersion.exact import PackedHulls
from buoyancy_mj.submersion.hull_set import HullSet
from tests import naive, vessels

BALL = trimesh.creation.icosphere(subdivisions=4)
# scaled to the volume of a ball of radius 1
BALL = TriMesh(BALL.vertices * (4 / 3 * math.pi / BALL.volume) ** (1 / 3), BALL.faces)


def press(mesh, water, place, turn=None, time=0.0, dynamic=True):
    """Force over rho g [m^3] and torque over rho g about the frame's origin [m^4]."""
    packed = PackedHulls(HullSet([mesh]), water)
    rotation = np.eye(3) if turn is None else turn
    return packed.press(np.array([place], float), rotation.reshape(1, 9), time, dynamic=dynamic)[0]


def heads(water, points, time, dynamic):
    """Pressure heads at points."""
    return np.array([head(water.table, *point, time, dynamic) for point in points])


# the pressure


@pytest.mark.parametrize("depth", [math.inf, 3.0])
def test_pressure_is_zero_on_the_surface_and_the_still_waters_far_below_deep_waves(depth):
    water = Water(
        waves=[
            RegularWave(0.3, wavelength=7.0, depth=depth),
            RegularWave(0.1, wavelength=3.0, direction=1.0),
        ]
    )
    for x, y, t in ((0.0, 0.0, 0.0), (1.0, -2.0, 0.7), (3.0, 1.0, 2.0)):
        eta = float(water.elevation(x, y, t))
        assert head(water.table, x, y, eta, t, True) == pytest.approx(0.0, abs=1e-15)
        assert head(water.table, x, y, eta - 0.4, t, False) == pytest.approx(0.4, rel=1e-12)
    if math.isinf(depth):
        assert head(water.table, 0.0, 0.0, -50.0, 0.0, True) == pytest.approx(50.0, rel=1e-12)


def test_at_small_steepness_it_is_that_of_linear_theory():
    # Newman 1977, 6.2: A cosh k (z + h) / cosh k h cos, less z
    wave = RegularWave(1e-4, period=4.0, depth=10.0)
    k, h = float(np.hypot(*wave.rows[0, 1:3])), 10.0
    for z in (-0.5, -3.0, -10.0):
        expected = 1e-4 * math.cosh(k * (z + h)) / math.cosh(k * h) - z
        assert head(Water(waves=wave).table, 0.0, 0.0, z, 0.0, True) - expected == pytest.approx(
            0.0, abs=1e-7
        )


@given(
    st.floats(0.01, 0.44),
    st.floats(0.3, 60.0),
    st.floats(0.0, 2.0 * math.pi),
    st.floats(0.0, 1.0),
    st.integers(0, 10**6),
)
@settings(max_examples=40, deadline=None)
def test_it_is_that_of_the_height_in_still_water_found_by_bisection(steep, kh, phase, part, seed):
    # one wave up to the steepness at which it breaks, tanh(k h) of 0.44, and a sea: a step of
    # Newton's leaves a twentieth of the fourth power of the steepness, over k, and where its guess
    # of e^(k z) is off by a few hundredths, as little of the third
    amplitude = steep * math.tanh(kh)
    wave = RegularWave(amplitude, wavelength=2.0 * math.pi, depth=kh if kh < 20.0 else math.inf)
    eta = amplitude * math.cos(phase)
    z = eta - part * min(4.0, kh + eta)
    rows = Water(waves=wave).rows
    bound = 0.06 * amplitude**4 + 0.008 * amplitude**3 + 1e-12
    assert head(tabulate(rows), phase, 0.0, z, 0.0, True) == pytest.approx(
        naive.head(rows, phase, 0.0, z, 0.0), abs=bound
    )
    sea = JonswapSea(0.3, 4.0, components=16, spreading=8.0, depth=1.0 + kh, seed=seed)
    rows = Water(waves=sea).rows
    eta = naive.elevation(rows, 1.0, 2.0, 3.0)
    z = eta - part * min(2.0, 1.0 + kh + eta)
    assert head(tabulate(rows), 1.0, 2.0, z, 3.0, True) == pytest.approx(
        naive.head(rows, 1.0, 2.0, z, 3.0), abs=2e-3
    )


@given(st.integers(0, 10**6), st.floats(0.5, 50.0), st.floats(0.0, 100.0))
@settings(max_examples=60, deadline=None)
def test_it_is_zero_on_the_surface_of_any_sea(seed, depth, time):
    waves = [JonswapSea(0.25, 3.0, spreading=8.0, depth=depth, seed=seed), LevelOscillation(0.1, 1)]
    rows = Water(waves=waves).rows
    eta = naive.elevation(rows, 0.3, -2.0, time)
    assert head(tabulate(rows), 0.3, -2.0, eta, time, True) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("depth", [math.inf, 3.0, 1.0])
@pytest.mark.parametrize("steepness", [0.1, 0.3, 0.44])
def test_it_grows_with_depth_in_waves_up_to_those_that_break(steepness, depth):
    rows = RegularWave(steepness * math.tanh(depth), wavelength=2.0 * math.pi, depth=depth).rows
    for x in np.linspace(0.0, math.pi, 9):
        eta = naive.elevation(rows, x, 0.0, 0.0)
        z = np.linspace(eta, -min(depth, 4.0), 200)
        values = [head(tabulate(rows), x, 0.0, height, 0.0, True) for height in z]
        assert (np.diff(values) / -np.diff(z)).min() > 0.7


@pytest.mark.parametrize("steepness", [1.0, 3.0])
def test_it_is_finite_and_without_a_jump_in_waves_steeper_than_any_that_breaks(steepness):
    rows = np.array([[steepness, 1.0, 0.0, math.sqrt(9.81), 0.0, math.inf]])
    for x in np.linspace(0.0, math.pi, 9):
        z = np.linspace(5.0, -10.0, 15001)
        values = np.array([head(tabulate(rows), x, 0.0, height, 0.0, True) for height in z])
        assert np.isfinite(values).all()
        assert np.abs(np.diff(values)).max() < 0.06


@pytest.mark.parametrize("depth", [math.inf, 2.0, 0.8])
def test_its_mean_is_less_than_still_waters_by_the_square_of_the_vertical_velocity(depth):
    # Longuet-Higgins and Stewart 1964: -rho <w^2>, which is Bernoulli's in deep water
    amplitude, k = 0.05, 1.0
    wave = RegularWave(amplitude, wavelength=2.0 * math.pi, depth=depth)
    water = Water(waves=wave)
    times = np.linspace(0.0, wave.period, 64, endpoint=False)
    omega, h = float(wave.rows[0, 3]), min(depth, 20.0)
    for z in (-0.1, -0.3, -0.6):
        mean = np.mean([head(water.table, 0.0, 0.0, z, t, True) for t in times]) + z
        square = 0.5 * (amplitude * omega * math.sinh(k * (z + h)) / math.sinh(k * h)) ** 2
        assert mean == pytest.approx(-square / 9.81, rel=0.03)


def test_under_a_standing_wave_it_is_bernoullis_mean_at_node_and_crest_alike():
    # two waves that meet: <u^2> is k g (A e^kz)^2 at any place
    waves = [RegularWave(0.05, wavelength=2.0 * math.pi, direction=b) for b in (0.0, math.pi)]
    water, times = Water(waves=waves), np.linspace(0.0, waves[0].period, 64, endpoint=False)
    for x in (0.0, 0.25 * math.pi, 0.5 * math.pi):
        mean = np.mean([head(water.table, x, 0.0, -2.0, t, True) for t in times]) - 2.0
        assert mean == pytest.approx(-(0.05**2) * math.exp(-4.0), rel=0.05)


@pytest.mark.parametrize("kind", [False, True])
def test_a_level_that_goes_up_and_down_adds_its_height(kind):
    water = Water(waves=LevelOscillation(0.3, 0.5))
    assert head(water.table, 1.0, 2.0, -1.0, 0.0, kind) == pytest.approx(
        1.0 + float(water.elevation(1.0, 2.0, 0.0))
    )


# forces on fixed bodies


@pytest.mark.parametrize("kr", [0.1, 0.3, 0.6, 1.0])
@pytest.mark.parametrize("shape", ["ball", "cylinder"])
def test_under_water_the_force_is_minus_volume_times_the_gradient_at_the_centre(kr, shape):
    # mean value of a harmonic field over a ball, or over the circle of a cylinder along the crests
    amplitude, depth = 1e-4, 1.5
    wave = RegularWave(amplitude, wavelength=2 * math.pi / kr)
    mesh = BALL
    if shape == "cylinder":
        along = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
        mesh = shapes.cylinder(1.0, 2.0).transformed(along)
    size = mesh.volume * amplitude * kr * math.exp(-kr * depth)
    for time in np.linspace(0.0, wave.period, 7):
        force = press(mesh, Water(waves=wave), (0.0, 0.0, -depth), time=time)[:3] - [
            0.0,
            0.0,
            mesh.volume,
        ]
        phase = -2 * math.pi * time / wave.period
        # of constant magnitude, and downward under the crest
        assert force == pytest.approx(
            size * np.array([math.sin(phase), 0.0, -math.cos(phase)]), abs=0.01 * size
        )


@pytest.mark.parametrize(
    ("steepness", "kd"), [(0.1, 1.5), (0.2, 1.5), (0.2, 2.0), (0.14, 1.4), (0.16, 2.8)]
)
def test_on_a_sphere_two_radii_deep_the_force_keeps_its_size_and_the_lift_is_bernoullis(
    steepness, kd
):
    # of radius 1: the size is V k A e^-kd, the lift that of -1/2 u^2 / g integrated over the ball
    k = kd / 2.0
    amplitude, q = steepness / k, 2.0 * k
    wave = RegularWave(amplitude, wavelength=2.0 * math.pi / k)
    times = np.linspace(0.0, wave.period, 16, endpoint=False)
    forces = np.array([press(BALL, Water(waves=wave), (0.0, 0.0, -2.0), time=t)[:3] for t in times])
    mean = forces.mean(axis=0)
    sizes = np.linalg.norm(forces - mean, axis=1) / BALL.volume
    assert sizes == pytest.approx([steepness * math.exp(-kd)] * 16, rel=0.02)
    ball = 3.0 * (q * math.cosh(q) - math.sinh(q)) / q**3
    lift = (steepness * math.exp(-kd)) ** 2 * ball
    assert mean[2] / BALL.volume - 1.0 == pytest.approx(lift, rel=0.03)


@pytest.mark.parametrize(("kr", "kd"), [(0.5, 3.0), (1.0, 3.0), (0.5, 5.0), (1.0, 5.0), (2.0, 5.0)])
def test_far_below_short_waves_size_and_lift_are_as_right_as_near_the_surface(kr, kd):
    # the pressure over a node is coarse where waves have faded, but not beside what is left
    wave = RegularWave(0.2 / kr, wavelength=2.0 * math.pi / kr)
    times = np.linspace(0.0, wave.period, 16, endpoint=False)
    water = Water(waves=wave)
    forces = np.array([press(BALL, water, (0.0, 0.0, -kd / kr), time=t)[:3] for t in times])
    mean = forces.mean(axis=0)
    sizes = np.linalg.norm(forces - mean, axis=1)
    assert sizes == pytest.approx([sizes.mean()] * 16, rel=0.01)
    ball = 3.0 * (2.0 * kr * math.cosh(2.0 * kr) - math.sinh(2.0 * kr)) / (2.0 * kr) ** 3
    lift = (0.2 * math.exp(-kd)) ** 2 * ball
    assert mean[2] / BALL.volume - 1.0 == pytest.approx(lift, rel=0.03)
    assert np.abs(mean[:2]).max() / BALL.volume < 0.01 * lift


@pytest.mark.parametrize(
    ("period", "fraction"),
    # P14, IEA OES Task 10: sphere of 5 m, half in the water, Froude-Krylov heave force over
    # rho g pi R^2 A
    [
        (3, 0.094),
        (4, 0.355),
        (4.4, 0.440),
        (5, 0.543),
        (6, 0.665),
        (7, 0.746),
        (8, 0.801),
        (9, 0.840),
        (10, 0.869),
        (11, 0.890),
    ],
)
def test_a_floating_hemisphere_is_lifted_by_its_published_fraction(period, fraction):
    amplitude = 1e-3
    water = Water(waves=RegularWave(amplitude, period=period))
    ball = TriMesh(5.0 * BALL.vertices, BALL.faces)
    still = press(ball, Water(), (0, 0, 0))[2]
    area = math.pi * 25.0 * amplitude
    quarter = period / 4
    # the crest passes at 0, and the force over a quarter of a period tells amplitude and phase
    lifts = [press(ball, water, (0, 0, 0), time=t)[2] - still for t in (0.0, quarter)]
    assert math.hypot(*lifts) / area == pytest.approx(fraction, abs=0.004)
    # of the surface alone: 2 J1(kR) / kR
    kr = float(np.hypot(*water.rows[0, 1:3])) * 5.0
    lifts = [
        press(ball, water, (0, 0, 0), time=t, dynamic=False)[2] - still for t in (0.0, quarter)
    ]
    assert math.hypot(*lifts) / area == pytest.approx(abs(2 * j1(kr) / kr), abs=0.004)


@pytest.mark.parametrize("dynamic", [False, True])
@pytest.mark.parametrize("place", [(0.3, -0.2, 0.1), (0.0, 0.4, -0.9), (0.2, 0.1, -3.0)])
@pytest.mark.parametrize("name", ["dented", "box"])
def test_it_is_what_a_fine_sum_over_small_triangles_gives(name, place, dynamic):
    mesh = vessels.dented(4) if name == "dented" else shapes.box((1.0, 0.5, 0.4))
    waves = [
        RegularWave(0.06, wavelength=4.0, direction=0.4),
        RegularWave(0.03, wavelength=2.5, direction=2.0, phase=1.0),
    ]
    water = Water(waves=waves)
    turn = trimesh.transformations.rotation_matrix(0.7, [1, 2, 3])[:3, :3]
    row = press(mesh, water, place, turn, 0.3, dynamic)
    fine = trimesh.Trimesh(mesh.vertices @ turn.T + place, mesh.faces, process=False)
    for _ in range(4 if name == "dented" else 7):
        fine = fine.subdivide()
    points, vectors = fine.triangles_center, fine.face_normals * fine.area_faces[:, None]
    values = np.maximum(heads(water, points, 0.3, dynamic), 0.0)
    # above the surface of the water there is none
    values[points[:, 2] > water.elevation(points[:, 0], points[:, 1], 0.3)] = 0.0
    force = -(values[:, None] * vectors).sum(axis=0)
    torque = -np.cross(points - place, values[:, None] * vectors).sum(axis=0)
    assert row[:3] == pytest.approx(force, abs=1e-3 * mesh.volume)
    assert row[3:] == pytest.approx(torque, abs=1e-3 * mesh.volume)


@pytest.mark.parametrize("seed", range(4))
def test_on_still_water_it_is_archimedes(seed):
    rng = np.random.default_rng(seed)
    mesh, place = vessels.dented(seed), rng.uniform(-0.5, 0.5, 3) + [30.0, -20.0, 0.0]
    turn = trimesh.transformations.random_rotation_matrix(rng.uniform(size=3))[:3, :3]
    wet = PackedHulls(HullSet([mesh]), Water()).submerge(place[None], turn.reshape(1, 9), 0.0)[0]
    row = press(mesh, Water(), place, turn)
    assert row[:3] == pytest.approx([0.0, 0.0, wet[0]], abs=1e-10 * mesh.volume)
    assert row[3:] == pytest.approx(
        np.cross(wet[1:4] - place, [0.0, 0.0, wet[0]]), abs=1e-10 * mesh.volume
    )


def test_large_triangles_are_summed_finely_enough():
    # a box of 12 triangles, three waves long, under water: the integral over its faces is known
    k, a = 2 * math.pi, 1e-4
    water = Water(waves=RegularWave(a, wavelength=1.0))
    half = np.array([1.4, 0.3, 0.2])
    force = press(shapes.box(half), water, (0.1, 0.0, -0.5))[:3] - [0.0, 0.0, 8 * np.prod(half)]
    decay = math.exp(-k * 0.7) - math.exp(-k * 0.3)
    lift = a * 2 * half[1] * decay * (math.sin(k * 1.5) - math.sin(-k * 1.3)) / k
    assert force[2] == pytest.approx(lift, rel=1e-2)


def test_under_a_slope_the_depth_alone_pushes_by_the_slope():
    # F = -rho g V grad(elevation), for a body short beside the wave
    wave = RegularWave(1e-3, wavelength=100.0)
    time = wave.period / 4
    force = press(BALL, Water(waves=wave), (0.0, 0.0, -2.0), time=time, dynamic=False)
    slope = 1e-3 * 2 * math.pi / 100.0
    # the mean of the slope over the ball is less by (k R)^2 / 10
    assert force[:3] == pytest.approx(
        BALL.volume * np.array([-slope, 0.0, 1.0]), abs=1e-3 * slope * BALL.volume
    )


# a body that moves


def floater(draft, period, pressure):
    """Response amplitude and phase of a slender wall-sided body, free to heave, by simulation."""
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><option timestep="0.002" integrator="RK4"/><worldbody><body>
        <joint type="slide" axis="0 0 1"/>
        <geom type="box" size=".02 .02 1" mass="{1000 * 0.04**2 * draft}" pos="0 0 {1 - draft}"/>
        </body></worldbody>
        </mujoco>"""
    )
    amplitude = 0.002
    water = Water(waves=RegularWave(amplitude, period=period))
    data = mujoco.MjData(model)
    data.qpos[0] = amplitude
    omega, natural = 2 * math.pi / period, math.sqrt(9.81 / draft)
    times, heights = [], []
    with Buoyancy(model, water, damping=None, pressure=pressure).installed():
        while data.time < 6 * period:
            times.append(data.time)
            heights.append(data.qpos[0])
            mujoco.mj_step(model, data)
    t = np.array(times)
    swings = [
        np.cos(omega * t),
        np.sin(omega * t),
        np.cos(natural * t),
        np.sin(natural * t),
        np.ones(len(t)),
    ]
    c, s, *_ = np.linalg.lstsq(np.column_stack(swings), heights, rcond=None)[0] / amplitude
    return math.hypot(c, s), math.atan2(s, c), omega**2 / 9.81 * draft


@pytest.mark.parametrize("pressure", ["archimedes", "hydrostatic", "froude-krylov"])
def test_on_long_waves_it_rides_the_surface_without_lag(pressure):
    # P17: T = 10 T_n; of the surface alone 1 / (1 - (T_n / T)^2) = 1.010, with the pressure e^-kd
    # of it, 1.000
    draft = 0.5
    response, phase, kd = floater(draft, 10 * 2 * math.pi * math.sqrt(draft / 9.81), pressure)
    assert phase == pytest.approx(0.0, abs=1e-3)
    assert kd == pytest.approx(0.01, rel=1e-6)
    expected = 1 / (1 - kd) * (math.exp(-kd) if pressure == "froude-krylov" else 1.0)
    assert response == pytest.approx(expected, abs=5e-4)
    assert response == pytest.approx(1.010 if pressure != "froude-krylov" else 1.000, abs=5e-4)


@pytest.mark.parametrize("pressure", ["archimedes", "froude-krylov"])
def test_in_short_waves_the_surface_alone_lifts_a_deep_body_too_far(pressure):
    # 1 / (1 - kd), against e^-kd / (1 - kd) with the pressure: at kd = 0.5 twice, and 1.21
    draft = 0.5
    response, _, kd = floater(
        draft, 2 * math.pi * math.sqrt(draft / 9.81) / math.sqrt(0.5), pressure
    )
    assert kd == pytest.approx(0.5)
    assert response == pytest.approx(
        2.0 if pressure == "archimedes" else 2.0 * math.exp(-0.5), rel=5e-3
    )


def drift(amplitude, period, depth, start="moving", **options):
    """Drift along the waves [m/s], and rise in a minute [m], of a neutral sphere of 5 cm radius."""
    radius = 0.05
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><option timestep="0.01"/><worldbody>
        <body pos="0 0 {-depth}"><freejoint/>
        <inertial pos="0 0 0" mass="{4000 / 3 * math.pi * radius**3}" diaginertia="1e-3 1.1e-3 1e-3"
        /><geom type="sphere" size="{radius}"/></body></worldbody></mujoco>"""
    )
    # the surface passes its level, and the sphere is in the middle of its orbit; or under a crest
    wave = RegularWave(amplitude, period=period, phase=-math.pi / 2 if start == "moving" else 0.0)
    water, data = Water(waves=wave), mujoco.MjData(model)
    if start == "moving":
        data.qvel[:3] = water.velocity([0.0, 0.0, -depth], 0.0)
    places = []
    with Buoyancy(model, water, pressure="froude-krylov", **options).installed():
        while data.time < 60.0:
            places.append(data.qpos[[0, 2]].copy())
            mujoco.mj_step(model, data)
    # between the means over the first and over the last whole period
    steps, whole = round(period / 0.01), math.floor(60.0 / period)
    first = np.mean(places[:steps], axis=0)
    last = np.mean(places[(whole - 1) * steps : whole * steps], axis=0)
    return (last - first)[0] / ((whole - 1) * period), (last - first)[1]


@pytest.mark.parametrize("added_mass", ["none", "estimate"])
def test_a_small_neutral_sphere_stays_at_its_depth(added_mass):
    # where the water moves by 3 mm; by its size it rises 1 cm without drag: the lift of its ball is
    # larger by (2 k R)^2 / 10 than that at its centre
    _, rise = drift(0.05, 1.2, 1.0, added_mass=added_mass, damping=None)
    assert rise == pytest.approx(0.0, abs=0.016)
    for start in ("moving", "at rest"):
        _, rise = drift(0.05, 1.2, 1.0, start, added_mass=added_mass, damping=Damping())
        assert rise == pytest.approx(0.0, abs=0.004)


@pytest.mark.parametrize("depth", [2.0, 5.0])
@pytest.mark.parametrize("added_mass", ["none", "estimate"])
def test_a_neutral_sphere_drifts_along_the_waves_with_stokes(depth, added_mass):
    # Stokes 1847: A^2 omega k e^(2 k z), .04939 m/s at the surface
    along, _ = drift(1.0, 8.0, depth, added_mass=added_mass, damping=None)
    # a step of Euler's begins with half a step of acceleration too much, a fifteenth of that
    assert along == pytest.approx(0.04939 * math.exp(-2.0 * 0.06288 * depth), rel=0.1)


# as loads of a model


MODEL = """<mujoco><option timestep="0.01"/><worldbody><body name="a" pos="0 0 -.1"><freejoint/>
<geom type="box" size=".5 .3 .2" mass="60" pos=".1 0 0"/>
<geom type="sphere" size=".2" pos="0 0 -.6" mass="20"/>
<body pos=".6 0 0"><joint axis="0 1 0"/><geom type="capsule" size=".1 .2" mass="9"/>
</body></body></worldbody></mujoco>"""
SEA = Water(
    waves=[
        RegularWave(0.1, wavelength=3.0, direction=0.3),
        RegularWave(0.05, wavelength=2.0, phase=1.0),
    ]
)


@pytest.mark.parametrize("pressure", ["hydrostatic", "froude-krylov"])
def test_it_is_a_named_cause_and_the_hulls_add_up(pressure):
    model = mujoco.MjModel.from_xml_string(MODEL)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    plain = Buoyancy(model, SEA, damping=None).evaluate(data)
    water = Buoyancy(model, SEA, damping=None, pressure=pressure)
    loads = water.evaluate(data)
    assert list(loads.by_cause) == ["buoyancy", "wave_pressure"]
    assert loads.by_cause["buoyancy"] == pytest.approx(plain.by_cause["buoyancy"], abs=1e-12)
    pushed = loads.by_cause["wave_pressure"][:, :3].sum(axis=0)
    assert np.abs(pushed).max() > 1.0
    assert loads.total.force == pytest.approx(plain.total.force + pushed, abs=1e-9)
    assert loads.hull.force.sum(axis=0) == pytest.approx(loads.total.force, abs=1e-9)
    # each hull's torque about its body's centre of mass, summed by body
    about = np.zeros((model.nbody, 3))
    np.add.at(about, [hull.body for hull in water.hulls], loads.hull.torque)
    assert loads.body.torque == pytest.approx(about, abs=1e-9)


@pytest.mark.parametrize("pressure", ["hydrostatic", "froude-krylov"])
@pytest.mark.parametrize("native", [True, False])
def test_compiled_and_python_paths_and_the_plugin_move_alike(native, pressure):
    model = mujoco.MjModel.from_xml_string(MODEL)
    data = mujoco.MjData(model)
    with Buoyancy(model, SEA, pressure=pressure).installed(native=native):
        mujoco.mj_step(model, data, 100)
    spec = mujoco.MjSpec.from_string(MODEL)
    add_water(spec, SEA, pressure=pressure)
    own = spec.compile()
    theirs = mujoco.MjData(own)
    mujoco.mj_step(own, theirs, 100)
    assert theirs.qpos == pytest.approx(data.qpos, abs=1e-12)
    assert water_in(own).causes == ("buoyancy", "wave_pressure", "drag")
    assert 'key="pressure" value="' + pressure in spec.to_xml()


def test_where_there_are_no_waves_nothing_changes():
    model = mujoco.MjModel.from_xml_string(MODEL)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    plain, other = (
        Buoyancy(model, pressure=p).evaluate(data) for p in ("archimedes", "froude-krylov")
    )
    assert np.array_equal(plain.total.force, other.total.force)
    assert np.array_equal(other.by_cause["wave_pressure"], np.zeros((model.nbody, 6)))
    assert np.array_equal(plain.hull.torque, other.hull.torque)


def test_a_scene_says_which():
    table = {"title": "t", "vehicle": "hourglass", "pressure": "froude-krylov"}
    assert scene_from_table(table).pressure == "froude-krylov"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            {"pressure": "dynamic"},
            "pressure is 'dynamic'; possible: archimedes, froude-krylov, hydrostatic",
        ),
        (
            {"pressure": "hydrostatic", "method": "sections"},
            "pressure 'hydrostatic' needs the method 'exact', not 'sections'",
        ),
    ],
)
def test_what_makes_no_sense_is_told(arguments, message):
    with pytest.raises(MethodError, match=message):
        Buoyancy(mujoco.MjModel.from_xml_string(MODEL), **arguments)


@pytest.mark.parametrize("pressure", ["hydrostatic", "froude-krylov"])
def test_a_long_wave_turns_a_box_of_twelve_triangles_with_its_slope(pressure):
    # a triangle is half a side, and small beside the wave: its slope over it must not be lost
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><worldbody><body name="raft" pos="0 0 0.05"><freejoint/>'
        '<geom type="box" size="0.5 0.4 0.1" mass="40"/></body></worldbody></mujoco>'
    )
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    stiffness = hydrostatics(model).stiffness
    for direction, axis in ((0.0, 4), (math.pi / 2, 3)):
        wave = RegularWave(0.01, period=12.0, direction=direction, phase=math.pi / 2)
        water = Buoyancy(model, Water(waves=wave), pressure=pressure, damping=None)
        slope = 0.01 * 2.0 * math.pi / wave.wavelength
        torque = water.evaluate(data).total.torque
        size = abs(torque[axis - 3])
        assert size == pytest.approx(stiffness[axis, axis] * slope, rel=0.01)
        assert abs(torque[4 - axis]) < 0.01 * size
