"""Datasets of potential-flow codes: Hulme's hemisphere by Capytaine, written and read again."""

import itertools
import math

import mujoco
import numpy as np
import pytest
import xarray

from buoyancy_mj import (
    Buoyancy,
    ModelError,
    SceneError,
    Simulation,
    add_coefficients,
    read_coefficients,
)
from buoyancy_mj.loads.datasets import DOFS
from buoyancy_mj.scenes.scene import scene_from_table

OMEGAS = np.array([1.0, math.sqrt(9.81 / 5.0), 2.0])
MASS = 1000.0 * 2.0 / 3.0 * math.pi * 125.0


@pytest.fixture(scope="module")
def hemisphere(tmp_path_factory):
    cpt = pytest.importorskip("capytaine")
    mesh = cpt.mesh_sphere(radius=5.0, resolution=(20, 20)).immersed_part()
    body = cpt.FloatingBody(
        mesh=mesh, dofs=cpt.rigid_body_dofs(rotation_center=(0, 0, 0)), name="ball"
    )
    grid = xarray.Dataset(coords={"omega": OMEGAS, "radiating_dof": list(body.dofs), "rho": 1000.0})
    path = tmp_path_factory.mktemp("bem") / "ball.nc"
    cpt.export_dataset(
        path, cpt.BEMSolver().fill_dataset(grid, body, hydrostatics=False), format="netcdf"
    )
    return path


def write_dataset(path, names=DOFS, added=None, damping=None, **coords):
    """A dataset as those codes write it."""
    n = len(names)
    matrices = {
        "added_mass": np.diag(np.arange(1.0, n + 1)) if added is None else added,
        "radiation_damping": np.diag(np.arange(1.0, n + 1)) if damping is None else damping,
    }
    data = {
        k: (("omega", "influenced_dof", "radiating_dof"), np.array([m, 10.0 * m]))
        for k, m in matrices.items()
    }
    coords |= {"omega": [1.0, 2.0], "influenced_dof": list(names), "radiating_dof": list(names)}
    xarray.Dataset(data, coords=coords).to_netcdf(path)
    return path


def test_capytaines_hemisphere_has_hulmes_coefficients(hemisphere):
    # Hulme 1982, ka = 1: a33 0.4284, b33 0.2484 of rho 2/3 pi R^3 (and omega); a coarse mesh
    found = read_coefficients(hemisphere, 2 * math.pi / OMEGAS[1], submerged=0.5)["ball"]
    assert found.omega == pytest.approx(OMEGAS[1])
    assert found.added_mass[2, 2] / 2 == pytest.approx(0.4284 * MASS, rel=0.04)
    assert found.radiation[0] == pytest.approx(0.2484 * MASS * OMEGAS[1], rel=0.04)
    # a sphere about its middle carries no water round
    assert np.abs(found.added_mass[3:, 3:]).max() < 0.01 * found.added_mass[2, 2] * 25.0


def test_a_model_takes_them_where_it_states_none_itself(hemisphere):
    found = read_coefficients(hemisphere, 4.4, submerged=0.5)
    spec = mujoco.MjSpec.from_string(
        '<mujoco><worldbody><body name="ball"><freejoint/>'
        '<geom type="sphere" size="5" mass="261800" pos="0 0 1e-3"/></body>'
        "</worldbody></mujoco>"
    )
    add_coefficients(spec, found)
    buoyancy = Buoyancy(spec.compile())
    assert buoyancy.added_mass.matrices[0].reshape(6, 6) == pytest.approx(
        found["ball"].added_mass, rel=1e-12
    )
    assert "radiation" in buoyancy.causes
    own = spec.copy()
    add_coefficients(own, {"ball": read_coefficients(hemisphere, 6.0)["ball"]})
    assert len(own.numerics) == len(spec.numerics)
    with pytest.raises(ModelError, match="the model has no body 'ball2'; did you mean 'ball'"):
        add_coefficients(spec, {"ball2": found["ball"]})


def test_each_of_several_vehicles_names_a_dataset_of_its_own(tmp_path):
    text = """<mujoco><worldbody><body name="hull"><freejoint/>
    <geom type="sphere" size=".3" mass="50" pos="0 0 1e-3"/></body></worldbody></mujoco>"""
    (tmp_path / "ball.xml").write_text(text)
    names = [f"ball__{dof}" for dof in DOFS]
    write_dataset(tmp_path / "ball.nc", names)
    vehicles = [
        {"model": "ball.xml", "name": "without"},
        {"model": "ball.xml", "name": "with", "start": {"position": [2.0, 0.0, 0.0]}},
    ]
    vehicles[1]["coefficients"] = {"file": "ball.nc", "period": 6.0, "body": "hull"}
    simulation = Simulation(scene_from_table({"title": "t", "vehicles": vehicles}, folder=tmp_path))
    added = simulation.buoyancy.added_mass
    assert added.bodies.tolist() == [simulation.model.body("with/hull").id]
    assert added.matrices[0].reshape(6, 6).diagonal() == pytest.approx(np.arange(1.0, 7.0))
    assert "radiation" in simulation.buoyancy.causes


def test_a_scene_names_a_dataset(hemisphere, tmp_path):
    (tmp_path / "ball.xml").write_text(
        '<mujoco><worldbody><body name="float">'
        '<geom type="sphere" size="5" mass="261800" pos="0 0 1e-3"/></body>'
        "</worldbody></mujoco>"
    )
    (tmp_path / "ball.nc").write_bytes(hemisphere.read_bytes())
    table = {
        "title": "a ball",
        "vehicle": "ball.xml",
        "start": {"position": [0.0, 0.0, 1.0]},
        "duration": 12.0,
    }
    table["coefficients"] = {"file": "ball.nc", "period": 4.4, "submerged": 0.5, "body": "float"}
    simulation = Simulation(scene_from_table(table, folder=tmp_path))
    added = read_coefficients(hemisphere, 4.4, submerged=0.5)["ball"].added_mass[2, 2] / 2
    frames = list(simulation.frames())
    heights = np.array([(frame.time, frame.centre_of_mass[2]) for frame in frames])
    assert "radiation" in frames[-1].loads.by_cause
    # it bobs with the added mass and the waterplane's stiffness
    period = 2 * math.pi * math.sqrt((261800 + added) / (1000.0 * 9.81 * math.pi * 25.0))
    down = [t for (t, z), (_, after) in itertools.pairwise(heights) if z > 0.0 >= after]
    assert np.diff(down).mean() == pytest.approx(period, rel=0.02)

    def refuse(message, **changed):
        with pytest.raises((ModelError, SceneError), match=message):
            Simulation(
                scene_from_table(
                    table | {"coefficients": table["coefficients"] | changed}, folder=tmp_path
                )
            )

    refuse("the model has no body 'boat'", body="boat")
    refuse("none.nc' cannot be read: there is no such file", file="none.nc")
    refuse("period is -1.0 s", period=-1.0)
    refuse(
        "coefficients: unknown key 'depth'; possible: body, centre, file, period, submerged",
        depth=3,
    )
    write_dataset(tmp_path / "two.nc", ["left__Heave", "right__Heave"])
    refuse("'two.nc' has the bodies left, right; name them as the model does", file="two.nc")


def test_the_nearest_frequency_counts_and_the_wet_part_divided_out(tmp_path):
    path = write_dataset(tmp_path / "a.nc")
    assert read_coefficients(path, 2 * math.pi / 1.4)["body"].added_mass[2, 2] == 3.0
    found = read_coefficients(path, 2 * math.pi / 1.6, submerged=0.25)["body"]
    assert (found.omega, found.added_mass[2, 2]) == (2.0, 120.0)
    assert found.radiation.tolist() == [30.0, 40.0, 50.0]


def test_bodies_stand_apart_and_what_is_missing_is_zero(tmp_path):
    path = write_dataset(tmp_path / "a.nc", ["left__Heave", "left__Pitch", "right__Heave"])
    found = read_coefficients(path, 6.0)
    assert sorted(found) == ["left", "right"]
    assert np.diag(found["left"].added_mass).tolist() == [0.0, 0.0, 1.0, 0.0, 2.0, 0.0]
    assert np.diag(found["right"].added_mass).tolist() == [0.0, 0.0, 3.0, 0.0, 0.0, 0.0]


def test_added_mass_is_carried_from_its_centre_to_the_origin(tmp_path):
    centre = np.array([0.3, -0.2, 0.5])
    path = write_dataset(tmp_path / "a.nc", rotation_center=("space_coordinate", centre))
    found = read_coefficients(path, 6.0)["body"].added_mass
    # kinetic energy is the same, from the velocity of the origin
    rng = np.random.default_rng(0)
    v, w = rng.normal(size=(2, 3))
    there = np.concatenate([v + np.cross(w, centre), w])
    assert np.concatenate([v, w]) @ found @ np.concatenate([v, w]) == pytest.approx(
        there @ np.diag(np.arange(1.0, 7.0)) @ there
    )


@pytest.mark.parametrize(
    ("how", "message"),
    [
        (lambda path: read_coefficients(path / "none.nc", 4.0), "none.nc' cannot be read"),
        (
            lambda path: read_coefficients(write_dataset(path / "a.nc"), 0.0),
            "period is 0.0 s and submerged 1.0",
        ),
        (
            lambda path: read_coefficients(write_dataset(path / "a.nc"), 4.0, submerged=2.0),
            "at most 1",
        ),
        (
            lambda path: read_coefficients(write_dataset(path / "a.nc"), 4.0, centre=(1, 2)),
            "give one of three numbers",
        ),
        (
            lambda path: read_coefficients(write_dataset(path / "a.nc", ["Bend"]), 4.0),
            "by none of Surge, Sway, .*it has Bend",
        ),
        (
            lambda path: read_coefficients(
                write_dataset(path / "a.nc", added=np.full((6, 6), np.nan)), 4.0
            ),
            "holds added_mass that is no finite number at 2 rad/s",
        ),
    ],
)
def test_datasets_that_make_no_sense_are_refused(tmp_path, how, message):
    with pytest.raises(ModelError, match=message):
        how(tmp_path)


def test_another_dataset_is_refused(tmp_path):
    xarray.Dataset({"temperature": ("x", [1.0])}).to_netcdf(tmp_path / "a.nc")
    with pytest.raises(ModelError, match="has no 'added_mass'; it has temperature"):
        read_coefficients(tmp_path / "a.nc", 4.0)
