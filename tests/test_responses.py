"""Responses to waves: limits, symmetries, published numbers, one way of measuring by the other."""

import csv
import json
import math

import numpy as np
import pytest
import trimesh
import xarray
from typer.testing import CliRunner

from buoyancy_mj import JonswapSea, RegularWave, ResponseError, respond
from buoyancy_mj.cli import app
from buoyancy_mj.responses import regular
from buoyancy_mj.responses.charts import make_responses_figure
from buoyancy_mj.responses.extremes import respond_to_sea
from buoyancy_mj.responses.harmonics import fit_harmonics
from buoyancy_mj.responses.regular import Channels, choose_steps, measure_regular
from buoyancy_mj.responses.responses import list_names
from buoyancy_mj.responses.subject import prepare, read_subject
from buoyancy_mj.responses.tracks import MOTIONS
from tests import vessels

RAFT = """<mujoco><worldbody><body name="raft"><freejoint/>
<geom type="box" size="0.5 0.4 0.1" mass="40"/><site name="corner" pos="0.5 0.4 0.1"/></body>
</worldbody>
<sensor><framepos name="where" objtype="site" objname="corner"/>
<framequat name="turn" objtype="site" objname="corner"/></sensor></mujoco>"""
SEA = "jonswap significant_height=0.2 peak_period=4"
HEAVE = MOTIONS.index("heave")


@pytest.fixture(scope="session")
def raft(tmp_path_factory):
    path = tmp_path_factory.mktemp("raft") / "raft.xml"
    path.write_text(RAFT)
    return path


@pytest.fixture(scope="session")
def around(raft):
    """A raft in waves of two periods from four sides."""
    return respond(raft, [4.0, 6.0], np.radians([0.0, 90.0, 180.0, 225.0]), sensors=["where"])


def at(responses, name, degrees, period):
    """Size over elevation or slope, and lag [deg]."""
    where = (
        int(np.argmin(np.abs(np.degrees(responses.headings) - degrees))),
        list(responses.periods).index(period),
        responses.names.index(name),
    )
    return responses.normal_sizes[where], math.degrees(responses.phases[where])


# limits and symmetries ----------------------------------------------------------------------------


def test_a_light_raft_goes_with_long_waves_and_leans_with_their_slope(around):
    assert around.sure.all()
    # at a crest the water runs with the wave, and is farthest ahead a quarter of a period later;
    # the bow goes down when the crest of a head sea has passed, and before a following one comes
    lags = {
        ("heave", 180): 0.0,
        ("surge", 0): 90.0,
        ("surge", 180): -90.0,
        ("sway", 90): 90.0,
        ("pitch", 0): -90.0,
        ("pitch", 180): 90.0,
        ("roll", 90): 90.0,
    }
    for (name, degrees), lag in lags.items():
        size, found = at(around, name, degrees, 6.0)
        assert size == pytest.approx(1.0, abs=0.02), name
        assert found == pytest.approx(lag, abs=2.0), name


def test_in_an_oblique_sea_slopes_and_orbits_are_those_along_the_axes(around):
    for name, part in (("surge", math.sqrt(0.5)), ("sway", math.sqrt(0.5)), ("heave", 1.0)):
        assert at(around, name, 225, 6.0)[0] == pytest.approx(part, abs=0.01)


def test_waves_from_the_other_side_give_the_mirrored_motions():
    both = respond("catamaran", 2.5, np.radians([60.0, -60.0]), settings=["added_mass=none"])
    port, starboard = both.transfer[:, 0]
    mirror = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
    np.testing.assert_allclose(starboard, mirror * port, atol=0.01 * np.abs(port).max())


def test_a_point_moves_as_the_rigid_body_has_it(raft):
    found = respond(raft, 3.0, math.radians(150.0), points=[(0.5, 0.4, 0.1)], sensors=["where.2"])
    motion = found.transfer[0, 0]
    turned = np.cross(motion[3:6], (0.5, 0.4, 0.1))
    np.testing.assert_allclose(motion[6:9], motion[:3] + turned, rtol=5e-3)
    # a sensor of the same point says the same
    assert motion[9] == pytest.approx(motion[8], rel=5e-3)
    assert found.names[6:] == ("point.x", "point.y", "point.z", "where.2")


def test_the_station_has_no_part_in_the_motions(raft):
    steps, timestep = choose_steps(3.0, 0.01)
    wave = RegularWave(0.005, period=3.0, direction=math.pi, phase=0.5 * math.pi)
    held, free = (
        measure_regular(
            prepare(read_subject(raft), [wave], timestep=timestep), steps, Channels(), hold=hold
        )
        for hold in (True, False)
    )
    np.testing.assert_allclose(held.transfer[[0, 2, 4]], free.transfer[[0, 2, 4]], rtol=0.01)
    assert abs(held.turned) < 1e-3


def test_the_depth_of_the_water_makes_the_waves_shorter_and_the_orbits_longer(raft):
    deep, shallow = (respond(raft, 6.0, math.pi, depth=h) for h in (math.inf, 3.0))
    k = shallow.wavenumbers[0]
    assert 9.81 * k * math.tanh(3.0 * k) == pytest.approx((2.0 * math.pi / 6.0) ** 2)
    assert k > 1.5 * deep.wavenumbers[0]
    # x of the orbit over z is 1 / tanh(k h) at the surface
    ratio = at(shallow, "surge", 180, 6.0)[0] / at(shallow, "heave", 180, 6.0)[0]
    assert ratio == pytest.approx(1.0 / math.tanh(3.0 * k), rel=0.03)


# published and known ------------------------------------------------------------------------------


def test_a_catamaran_heaves_a_tenth_of_a_metre_in_waves_of_5_cm_at_6_and_at_8_s():
    # from trough to crest; the range of the last 2 s of a run is 0.074 and 0.051 m
    settings = ["pressure=archimedes", "added_mass=model"]
    found = respond("catamaran", [6.0, 8.0], 0.0, amplitude=0.05, settings=settings)
    assert 2.0 * 0.05 * found.sizes[0, :, HEAVE] == pytest.approx([0.1012, 0.1006], abs=5e-4)


def test_the_sphere_of_oes_task_10_heaves_as_five_codes_have_it_where_waves_are_long():
    # data of IEA OES Task 10, steepness 0.01, no power take-off: InWave twice, Marin, NREL, Proteus
    published = {
        6.0: (1.14966, 1.15316, 1.15463, 1.15699, 1.12136),
        8.0: (1.03297, 1.03247, 1.03061, 1.03577, 1.0308),
    }
    found = respond("oes_sphere", list(published), math.pi)
    for period, codes in published.items():
        low, high = min(codes), max(codes)
        assert 0.975 * low <= at(found, "heave", 180, period)[0] <= 1.025 * high


RM3_MASS, RM3_CENTRE = 725_834.0, -0.72


def write_rm3_float(folder):
    """The float of RM3 as a model, and its mesh."""
    solid = vessels.rm3_float()
    trimesh.Trimesh(solid.vertices, solid.faces).export(folder / "float.stl")
    (folder / "rm3.xml").write_text(
        '<mujoco><asset><mesh name="float" file="float.stl" inertia="shell"/></asset>'
        f'<worldbody><body name="float" pos="0 0 {RM3_CENTRE}"><freejoint/>'
        f'<inertial pos="0 0 0" mass="{RM3_MASS}" diaginertia="20907301 21306091 37085481"/>'
        '<geom type="mesh" mesh="float"/></body></worldbody></mujoco>'
    )
    return folder / "rm3.xml", solid


def test_the_float_of_rm3_heaves_as_wamit_has_it_where_waves_are_long(tmp_path):
    path, _ = write_rm3_float(tmp_path)
    # |X3 / (C33 - w^2 (m + A33) - i w B33)| of A33, B33 and X3 in WEC-Sim's examples/RM3/hydroData/
    # rm3.out (WAMIT 7.2 by NREL), with C33 of the waterplane of 285.52 m^2 that it states
    published = {8.055: 0.9876, 12.083: 1.0146}
    found = np.abs(respond(path, list(published)).find("heave")[0])
    assert found == pytest.approx(list(published.values()), rel=0.02)


@pytest.mark.long
def test_the_float_of_rm3_heaves_as_potential_flow_has_it_where_waves_are_long(tmp_path):
    capytaine = pytest.importorskip("capytaine")
    airy_waves = pytest.importorskip("capytaine.bem.airy_waves")
    path, solid = write_rm3_float(tmp_path)
    mass, centre = RM3_MASS, RM3_CENTRE
    periods = np.array([8.0, 10.0, 12.0])
    found = respond(path, periods)

    # the same mesh by boundary elements
    mesh = capytaine.Mesh(solid.vertices, solid.faces).translated_z(centre)
    middle = (0.0, 0.0, centre)
    dofs = capytaine.rigid_body_dofs(rotation_center=middle)
    body = capytaine.FloatingBody(mesh=mesh, dofs=dofs, center_of_mass=middle).immersed_part()
    solver, stiffness = capytaine.BEMSolver(), 1000.0 * 9.81 * 284.763
    for period, heave in zip(periods, found.find("heave")[0], strict=True):
        omega = 2.0 * math.pi / period
        radiation = capytaine.RadiationProblem(omega=omega, body=body, radiating_dof="Heave")
        diffraction = capytaine.DiffractionProblem(omega=omega, body=body, wave_direction=math.pi)
        radiated, scattered = solver.solve(radiation), solver.solve(diffraction)
        force = scattered.forces["Heave"] + airy_waves.froude_krylov_force(diffraction)["Heave"]
        inertia = mass + radiated.added_masses["Heave"]
        damping = radiated.radiation_dampings["Heave"]
        expected = force / (stiffness - omega**2 * inertia - 1j * omega * damping)
        assert abs(heave - expected) < 0.04 * abs(expected), period


def test_an_irregular_sea_gives_what_regular_waves_give_within_what_coherence_allows(raft):
    sea = JonswapSea(significant_height=0.05, peak_period=4.0, seed=3)
    settings = ["timestep=0.04", "pressure=hydrostatic", "added_mass=none"]
    periods, heading = [3.0, 4.0, 5.0], math.radians(150.0)
    one = respond(raft, periods, heading, settings=settings)
    other = respond(raft, [*periods, 1.2], heading, sea=sea, settings=settings)
    assert np.abs(other.turned).max() < math.radians(1.0)
    assert other.sure[0, :3, : HEAVE + 1].all()
    for name in ("surge", "sway", "heave", "roll", "pitch"):
        c = other.names.index(name)
        sure, coherence = other.sure[0, :3, c], other.coherence[0, :3, c]
        # Bendat and Piersol 2010, 9.2.4: the random error with some 25 averages, and 3 % of bias
        error = 3.0 * np.sqrt((1.0 - coherence) / (50.0 * coherence)) + 0.03
        expected = one.transfer[0, :, c]
        off = np.abs(other.transfer[0, :3, c] - expected)
        assert (off[sure] <= error[sure] * np.abs(expected)[sure]).all(), name
    # waves that the sea does not have are not told as sure
    assert not other.sure[0, 3].any()
    assert "less than 1 %" in next(other.doubts())


# what is computed ---------------------------------------------------------------------------------


def test_a_harmonic_is_found_among_drift_its_double_and_other_swings():
    theta = np.linspace(0.0, 8.0 * math.pi, 320, endpoint=False)
    wanted = np.array([0.7 - 0.2j, -0.1 + 0.3j])
    pure = np.real(wanted * np.exp(1j * theta)[:, None])
    drift = 3.0 + 0.5 * theta[:, None] - 0.02 * theta[:, None] ** 2
    double = 0.2 * np.cos(2.0 * theta + 0.3)[:, None]
    found, slow = fit_harmonics(pure + drift + double, theta)
    np.testing.assert_allclose(found, wanted, atol=1e-12)
    np.testing.assert_allclose(slow, np.broadcast_to(drift, slow.shape), atol=1e-9)
    # a free swing of another period, which a Hann window keeps out
    free = 0.5 * np.cos(5.3 * theta)[:, None]
    assert np.abs(fit_harmonics(pure + free, theta)[0] - wanted).max() < 2e-3


def test_what_follows_the_waves_has_their_height_in_a_sea():
    sea = JonswapSea(significant_height=2.0, peak_period=8.0)
    omegas = np.linspace(0.3, 8.0, 400)
    found = respond_to_sea(omegas, np.ones(400), sea, duration=3600.0)
    assert found.significant == pytest.approx(1.0, rel=2e-3)
    assert found.period == pytest.approx(sea.zero_crossing_period, rel=5e-3)
    # Rayleigh: of N cycles the most probable largest is sqrt(ln(N) / 2) significant ones
    cycles = 3600.0 / found.period
    assert found.largest == pytest.approx(found.significant * math.sqrt(0.5 * math.log(cycles)))


def test_a_run_that_has_not_settled_is_marked(raft, monkeypatch):
    monkeypatch.setattr(regular, "MOST_WINDOWS", 1)
    found = respond(raft, 4.0)
    assert not found.sure.any()
    assert "had not settled after 2 periods" in next(found.doubts())


# what is written ----------------------------------------------------------------------------------


def test_the_dataset_is_read_back_as_capytaine_has_it(around, tmp_path):
    merging = pytest.importorskip("capytaine.io.xarray")
    from buoyancy_mj.responses.datasets import write_responses_netcdf

    write_responses_netcdf(around, tmp_path / "raft.nc")
    with xarray.open_dataset(tmp_path / "raft.nc") as file:
        dataset = merging.merge_complex_values(file.load())
    assert dataset["RAO"].dims == ("omega", "wave_direction", "radiating_dof")
    heave = dataset["RAO"].sel(radiating_dof="Heave", wave_direction=math.pi, method=None)
    np.testing.assert_array_equal(heave.values[::-1], around.find("heave")[2])
    assert list(dataset["channel"].values) == ["where.0", "where.1", "where.2"]
    assert dataset["period"].values.tolist() == [6.0, 4.0]


def test_nothing_on_the_picture_is_cut_off(around):
    figure = make_responses_figure(around, JonswapSea(0.2, 4.0))
    assert tuple(figure.get_size_inches() * 150) == (1600.0, 1350.0)
    figure.draw_without_rendering()
    whole = figure.bbox
    for artist in (*figure.texts, *figure.legends, *figure.axes):
        box = artist.get_tightbbox()
        assert whole.x0 - 1 <= box.x0, artist
        assert box.x1 <= whole.x1 + 1, artist
        assert whole.y0 - 1 <= box.y0, artist
        assert box.y1 <= whole.y1 + 1, artist


def test_the_command_tells_in_80_columns_and_writes_files(raft, tmp_path, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.chdir(tmp_path)
    words = ["--periods", "4:6:2", "--heading", "0:180:4", "--sea", SEA, "--csv", "raos.csv"]
    done = CliRunner().invoke(app, ["respond", str(raft), *words, "--plot", "raos.svg"])
    assert done.exit_code == 0, done.output
    assert max(map(len, done.stdout.splitlines())) <= 80
    for said in ("A station holds", "significant amplitude", "most probable largest", "natural"):
        assert said.lower() in done.stdout.lower()
    with (tmp_path / "raos.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 8
    assert float(rows[0]["heave [m/m]"]) == pytest.approx(1.0, abs=0.02)
    assert "<svg" in (tmp_path / "raos.svg").read_text()[:1000]


def test_json_holds_all_and_nothing_else(raft):
    words = ["--periods", "5", "--sea", SEA, "--of", "where.2", "--json"]
    done = CliRunner().invoke(app, ["respond", str(raft), *words])
    told = json.loads(done.stdout)
    assert [*told["responses"]] == [*MOTIONS, "where.2"]
    assert told["sea"]["responses"]["heave"][0].keys() == {"significant", "largest", "period"}
    assert told["depth"] is None


# what is refused ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--periods", "fast"], "--periods is 'fast'; write a:b:n"),
        (["--periods", "0,4"], "periods is [0.0, 4.0]; it must be one or several finite numbers"),
        (["--periods", "4", "--heading", "1:2"], "--heading is '1:2'; write a:b:n"),
        (["--periods", "2,4,2"], "--periods is '2,4,2', which has 2 twice; give it once"),
        (["--periods", "4", "--amplitude", "-1"], "amplitude is -1.0; it must be above 0"),
        (["--periods", "4", "--of", "whre"], "there is no sensor 'whre'; did you mean 'where'?"),
        (["--periods", "4", "--of", "turn"], "sensor 'turn' gives a quaternion, which has no"),
        (["--periods", "4", "--point", "1,2"], "--point is '1,2'; write x,y,z in metres"),
        (["--periods", "4", "--irregular"], "--irregular measures in a sea, and there is none"),
        (["--periods", "4", "--sea", "regular amplitude=1 period=4"], "which has no spectrum"),
        (["--periods", "4", "--sea", f"{SEA} spreading=5"], "leave spreading out"),
        (["--periods", "4", "--plot", "a.gif"], "its name must end in .png or .svg or .pdf"),
        (["--periods", "4", "--set", "water.current=[1,0,0]"], "the scene has a current"),
    ],
)
def test_a_wrong_flag_is_one_sentence(raft, words, said):
    done = CliRunner().invoke(app, ["respond", str(raft), *words])
    assert done.exit_code == 1
    assert said in done.stderr.replace("\n", " ")


def test_a_scene_of_several_vehicles_is_refused():
    with pytest.raises(ResponseError, match="one is measured at a time; take a scene of one"):
        respond("fleet", 4.0)


def test_points_are_numbered_where_there_are_several():
    names, units = list_names(2, ("depth",))
    assert names[6:] == ("point1.x", "point1.y", "point1.z", "point2.x", "point2.y", "point2.z",
                         "depth")  # fmt: skip
    assert units[5:7] == ("rad", "m")
    assert units[-1] == ""
