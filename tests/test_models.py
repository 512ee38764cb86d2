"""The contract of a model folder, and what the vehicles promise."""

import importlib.util
from pathlib import Path

import mujoco
import numpy as np
import pytest
import trimesh

from buoyancy_mj import (
    Buoyancy,
    Simulation,
    Water,
    equilibrium,
    hydrostatics,
    read_scene,
    submerge,
)
from buoyancy_mj.hulls.geoms import find_hulls
from buoyancy_mj.scenes import catalog

MODELS = catalog.models()


def loaded(name):
    return mujoco.MjModel.from_xml_path(str(MODELS[name]))


@pytest.mark.parametrize("name", sorted(MODELS))
def test_a_model_folder_keeps_the_contract(name):
    folder = MODELS[name].parent
    # a vehicle of primitives has no assets
    assets = {"assets"} if loaded(name).nmesh else set()
    assert {path.name for path in folder.iterdir()} == {
        f"{name}.xml",
        "scene.xml",
        "README.md",
        "LICENSE",
    } | assets
    assert "where each mass and dimension comes from" in (folder / "README.md").read_text().lower()
    assert len(catalog.summary(MODELS[name])) > 20


@pytest.mark.parametrize("name", sorted(MODELS))
@pytest.mark.parametrize("file", ["{}.xml", "scene.xml"])
def test_a_model_runs_for_a_second_without_a_warning(name, file):
    model = mujoco.MjModel.from_xml_path(str(MODELS[name].parent / file.format(name)))
    data = mujoco.MjData(model)
    with Buoyancy(model).installed():
        while data.time < 1.0:
            mujoco.mj_step(model, data)
    assert not any(data.warning[i].number for i in range(mujoco.mjtWarning.mjNWARNING))


@pytest.mark.parametrize("name", sorted(MODELS))
def test_the_vehicle_file_is_the_vehicle_alone(name):
    model = loaded(name)
    assert model.nlight == 0
    assert (model.body_weldid[model.geom_bodyid] > 0).all()
    assert model.jnt_type[0] == mujoco.mjtJoint.mjJNT_FREE
    assert model.nkey > 0


@pytest.mark.parametrize("name", sorted(MODELS))
def test_every_keyframe_can_be_run(name):
    model = loaded(name)
    for key in range(model.nkey):
        data = mujoco.MjData(model)
        mujoco.mj_resetDataKeyframe(model, data, key)
        with Buoyancy(model).installed():
            for _ in range(100):
                mujoco.mj_step(model, data)
        assert np.isfinite(data.qpos).all()


def test_the_meshes_are_what_the_script_makes():
    spec = importlib.util.spec_from_file_location(
        "make_models", Path(__file__).parent.parent / "scripts" / "make_models.py"
    )
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    made = {
        "hourglass/assets/hourglass": script.hourglass(),
        "sauvc_auv/assets/pressure_hull": script.capped_tube(
            script.HULL_RADIUS, script.HULL_CYLINDER, script.HULL_DOME
        ),
        "sauvc_auv/assets/battery_pod": script.capped_tube(
            script.POD_RADIUS, script.POD_CYLINDER, script.POD_DOME
        ),
        "sauvc_auv/assets/frame": script.frame(),
        "sauvc_auv/assets/thruster": script.thruster(),
        "catamaran/assets/demihull": script.demihull(),
    }
    for name, mesh in made.items():
        committed = trimesh.load_mesh(script.MODELS / f"{name}.obj")
        assert committed.is_watertight
        assert committed.volume == pytest.approx(mesh.volume, rel=1e-5)
        assert committed.extents == pytest.approx(mesh.extents, abs=1e-6)


# hourglass ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("draft", [0.05, 0.1, 0.2, 0.25, 0.35, 0.4])
def test_the_hourglass_has_the_volume_of_its_two_frusta(draft):
    base, neck, half = 0.15, 0.04, 0.2
    # radius falls from base to neck over the first half, and the upper half mirrors it
    slope = (base - neck) / half

    def frustum(z):
        r = base - slope * z
        return np.pi * z / 3.0 * (base**2 + base * r + r**2)

    whole = frustum(half)
    volume = frustum(draft) if draft <= half else 2.0 * whole - frustum(2.0 * half - draft)
    mesh = find_hulls(loaded("hourglass"))[0].mesh
    # a circle of 96 facets has 0.9993 of its area
    facets = 96.0 / (2.0 * np.pi) * np.sin(2.0 * np.pi / 96.0)
    assert submerge(mesh, (0, 0, half - draft)).volume == pytest.approx(facets * volume, rel=1e-5)


def test_the_hourglass_has_a_neck_that_its_convex_hull_fills():
    mesh = find_hulls(loaded("hourglass"))[0].mesh
    hull = trimesh.convex.convex_hull(mesh.vertices)
    assert hull.volume / mesh.volume > 1.8


# the AUV ------------------------------------------------------------------------------------------


def auv_under_water():
    model = loaded("sauvc_auv")
    data = mujoco.MjData(model)
    data.qpos[2] = -2.0
    mujoco.mj_forward(model, data)
    buoyancy = Buoyancy(model)
    return model, data, buoyancy, buoyancy.evaluate(data)


def test_the_auv_keeps_the_rules_of_sauvc():
    # bonus of the SAUVC rulebook 2026 v6.1.0: below 70 x 50 x 50 cm and 42 kg
    model, data, buoyancy, _ = auv_under_water()
    points = np.concatenate(
        [
            h.mesh.vertices @ data.geom_xmat[h.geom].reshape(3, 3).T + data.geom_xpos[h.geom]
            for h in buoyancy.hulls
        ]
    )
    assert (np.ptp(points, axis=0) < [0.7, 0.5, 0.5]).all()
    assert model.body_mass.sum() == pytest.approx(24.0, abs=0.5)


def test_the_auv_is_slightly_buoyant_and_stable():
    model, data, _, loads = auv_under_water()
    surplus = float(loads.total.volume) * 1000.0 - model.body_mass.sum()
    assert 0.5 < surplus < 1.2
    cg = data.subtree_com[1]
    assert loads.total.centroid[2] - cg[2] == pytest.approx(0.03, abs=0.003)
    assert loads.total.centroid[:2] == pytest.approx(cg[:2], abs=1e-4)


def test_no_two_parts_of_the_auv_overlap():
    # BuoyancyWarning is an error here
    assert len(find_hulls(loaded("sauvc_auv"))) == 15


def test_the_thrusters_span_all_six_directions():
    model, data, buoyancy, _ = auv_under_water()
    rows = []
    with buoyancy.installed():
        for i in range(model.nu):
            data.ctrl[:], data.act[:] = 0.0, 0.0
            data.ctrl[i] = data.act[model.actuator_actadr[i]] = 10.0
            mujoco.mj_forward(model, data)
            rows.append(data.qfrc_actuator[:6].copy())
    rows = np.array(rows)
    assert model.nu == 8
    assert np.linalg.matrix_rank(rows, tol=0.1) == 6
    # four vertical, four at 45 degrees in the horizontal plane
    assert np.abs(rows[:4, 2]) == pytest.approx([10.0] * 4)
    assert np.abs(rows[4:, :2]) == pytest.approx(np.full((4, 2), 10.0 / np.sqrt(2.0)))


def test_the_ahead_keyframe_drives_ahead():
    model = loaded("sauvc_auv")
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("ahead").id)
    with Buoyancy(model).installed():
        while data.time < 3.0:
            mujoco.mj_step(model, data)
    assert data.qpos[0] > 0.5
    assert abs(data.qpos[1]) < 1e-3


def test_the_auv_senses_its_depth_and_attitude():
    model, data, buoyancy, _ = auv_under_water()
    with buoyancy.installed():
        mujoco.mj_forward(model, data)
    # of noise no more than five standard deviations
    assert data.sensor("depth").data[0] == pytest.approx(2.0 - 0.04, abs=5 * 0.005)
    gauge = 1000.0 * 9.81 * (2.0 - 0.04)
    assert data.sensor("pressure").data[0] == pytest.approx(gauge, abs=5 * 50.0)
    assert data.sensor("attitude").data == pytest.approx([1, 0, 0, 0], abs=1e-9)
    assert data.sensor("gyro").data == pytest.approx(np.zeros(3), abs=1e-9)
    assert data.sensor("accelerometer").data[2] == pytest.approx(data.qacc[2] + 9.81, abs=1e-6)


# BlueROV2 Heavy -----------------------------------------------------------------------------------


def test_the_bluerov2_heavy_has_its_published_totals():
    # von Benzon et al. 2022, J. Mar. Sci. Eng. 10(12):1898
    model = loaded("bluerov2_heavy")
    hulls = find_hulls(model)
    shares = np.array([hull.displaced_volume for hull in hulls])
    assert shares.sum() == pytest.approx(0.0134, rel=1e-6)
    assert shares @ [hull.mesh_in_body.centroid for hull in hulls] / shares.sum() == pytest.approx(
        [0, 0, 0], abs=1e-7
    )
    assert model.body_mass[1] == 13.5
    assert model.body_ipos[1].tolist() == [0, 0, -0.01]
    assert hydrostatics(model, qpos=[0, 0, -3, 1, 0, 0, 0]).natural_periods(
        [6.36, 7.12, 18.68, 0.189, 0.135, 0.222]
    )[1:] == pytest.approx([3.672, 3.311], rel=1e-3)


@pytest.mark.parametrize(("density", "axis", "speed"), [(1000, 2, -0.0259), (1025, 2, 0.0534)])
def test_the_bluerov2_heavy_drifts_at_its_terminal_speed(density, axis, speed):
    model = loaded("bluerov2_heavy")
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    data.qpos[2] = -9.0
    with Buoyancy(model, Water(density=density)).installed():
        while data.time < 20.0:
            mujoco.mj_step(model, data)
    assert data.qvel[axis] == pytest.approx(speed, rel=1e-2)


def test_the_bluerov2_heavy_dives_and_rights_itself():
    simulation = Simulation(read_scene(catalog.scenes()["bluerov2_heavy_dive"]))
    frames = list(simulation.frames())
    # four times 10 N and the surplus weight against 33 w + 190 w^2
    down = (-33 + np.sqrt(33**2 + 4 * 190 * (40 + 0.981))) / (2 * 190)
    fallen = frames[-61].centre_of_mass[2] - frames[-1].centre_of_mass[2]
    assert fallen == pytest.approx(down, rel=0.02)
    late = [abs(frame.attitude[0]) for frame in frames[-120:]]
    assert max(late) < 0.5 * np.radians(20)
    assert list(frames[-1].loads.by_cause) == ["buoyancy", "drag", "added_mass"]


# the sphere of IEA OES Task 10 --------------------------------------------------------------------


def test_the_sphere_decays_as_in_the_benchmark():
    # P14, IEA OES Task 10, six linear codes on a drop of 1 m: zero crossings 1.13-1.15, 3.36-3.42,
    # 5.50-5.61 s, period 4.36-4.46 s, trough -0.868..-0.892 m, crest 0.631..0.651 m; with constant
    # coefficients it is fair to ask the period within -7/+3 % and the first trough within 0.15 of
    # the drop
    simulation = Simulation(read_scene(catalog.scenes()["sphere_decay"], ["record_rate=100"]))
    times, heights = np.array([(frame.time, frame.data.qpos[2]) for frame in simulation.frames()]).T
    k = np.flatnonzero(np.sign(heights[1:]) != np.sign(heights[:-1]))
    crossings = times[k] + 0.01 * heights[k] / (heights[k] - heights[k + 1])
    assert crossings[:3] == pytest.approx([1.14, 3.39, 5.555], abs=0.06)
    assert 4.36 * 0.93 < crossings[2] - crossings[0] < 4.46 * 1.03
    assert heights.min() == pytest.approx(-0.88, abs=0.15)
    trough = int(heights.argmin())
    assert heights[trough:].max() == pytest.approx(0.64, abs=0.15)


def test_its_coefficients_are_hulmes():
    unit = 1000 * 2 / 3 * np.pi * 5.0**3
    model = loaded("oes_sphere")
    added = Buoyancy(model).added_mass.matrices[0].reshape(6, 6)
    assert added[2, 2] == pytest.approx(2 * 0.4284 * unit, rel=1e-3)
    stated = model.numeric("radiation_damping:oes_sphere").data
    assert stated[0] == pytest.approx(0.2484 * unit * 1.427, rel=1e-3)


# the catamaran ------------------------------------------------------------------------------------


def wigley_volume(draft):
    """Volume of one of its hulls up to the waterline, and from there to the deck."""
    length, beam, freeboard = 1.6, 0.2, 0.12
    return 4.0 / 9.0 * length * beam * draft, 2.0 / 3.0 * length * beam * freeboard


def test_the_hulls_of_the_catamaran_have_the_volume_of_wigleys_hull():
    below, above = wigley_volume(0.15)
    model = loaded("catamaran")
    hull = next(hull for hull in find_hulls(model) if hull.name == "hull_port")
    # 32 stations and 10 waterlines have 0.997 of it
    assert hull.displaced_volume == pytest.approx(below + above, rel=4e-3)
    assert hull.displaced_volume < below + above
    pose = hull.position.copy(), hull.body_from_geom.copy()
    assert submerge(hull.mesh, *pose).volume == pytest.approx(below, rel=6e-3)


def test_the_catamaran_floats_level_at_its_design_waterline():
    model = loaded("catamaran")
    assert model.body_mass.sum() == pytest.approx(44.2)
    rest = equilibrium(model).hydrostatics
    assert rest.draft == pytest.approx(0.235, abs=2e-3)
    assert np.degrees([rest.heel, rest.trim]) == pytest.approx([0.0, 0.0], abs=0.1)
    assert pytest.approx(1.1, abs=0.1) == rest.GM


@pytest.mark.parametrize("key", ["ahead", "turning"])
def test_the_thrusters_of_the_catamaran_drive_it_ahead_or_turn_it(key):
    model = loaded("catamaran")
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key(key).id)
    with Buoyancy(model).installed():
        while data.time < 4.0:
            mujoco.mj_step(model, data)
    assert data.qpos[0] > 2.0 if key == "ahead" else abs(data.qpos[0]) < 0.5
    turned = 2.0 * abs(np.arcsin(data.qpos[6]))
    assert turned < 0.05 if key == "ahead" else turned > 0.3


# the glider ---------------------------------------------------------------------------------------


def test_the_glider_glides_down_at_the_slope_that_its_readme_says():
    model = loaded("glider")
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("descent").id)
    # a push to the side: the fin holds it on its way
    data.qvel[1] = 0.01
    speeds = []
    with Buoyancy(model).installed():
        while data.time < 60.0:
            mujoco.mj_step(model, data)
            speeds.append(np.linalg.norm(data.qvel[:3]))
    assert np.degrees(np.arctan2(data.qvel[2], data.qvel[0])) == pytest.approx(-25.0, abs=0.5)
    assert np.degrees(2.0 * np.arcsin(data.qpos[5])) == pytest.approx(21.0, abs=0.6)
    assert speeds[-1] == pytest.approx(speeds[-5000], rel=0.02)
    assert np.abs(data.qvel[3:]).max() < 1e-3
    assert abs(data.qvel[1]) < 1e-3


def test_the_glider_states_the_added_mass_that_is_estimated_for_it():
    model = loaded("glider")
    estimate = Buoyancy(model, added_mass="estimate")
    spec = mujoco.MjSpec.from_file(str(MODELS["glider"]))
    for numeric in list(spec.numerics):
        spec.delete(numeric)
    bare = Buoyancy(spec.compile(), added_mass="estimate").added_mass.matrices[0].reshape(6, 6)
    stated = estimate.added_mass.matrices[0].reshape(6, 6)
    assert np.diag(stated) == pytest.approx(np.diag(bare), rel=0.02)


def test_the_glider_dives_and_climbs_ahead_by_one_change_of_ballast():
    model = loaded("glider")
    model.opt.timestep = 0.01
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("descent").id)
    slopes, places = {}, [data.qpos[:3].copy()]
    with Buoyancy(model).installed():
        for volume in (0.0, 0.000464):
            data.ctrl[0] = volume
            end = data.time + 70.0
            while data.time < end:
                mujoco.mj_step(model, data)
            slopes[volume] = np.degrees(np.arctan2(data.qvel[2], data.qvel[0]))
            places.append(data.qpos[:3].copy())
    assert slopes[0.0] == pytest.approx(-25.0, abs=0.5)
    assert slopes[0.000464] == pytest.approx(20.0, abs=0.7)
    start, turn, end = places
    assert turn[2] - start[2] < -9.0
    assert end[2] - turn[2] > 4.0
    assert start[0] + 15.0 < turn[0] < end[0] - 13.0
    # the bow goes up with it, to where statics without wings have it
    assert np.degrees(2.0 * np.arcsin(-data.qpos[5])) == pytest.approx(15.5, abs=1.0)


def test_the_glider_hovers_with_half_of_its_bladder():
    model = loaded("glider")
    full = hydrostatics(model, qpos=[0, 0, -3, 1, 0, 0, 0], ballast={"bladder": 0.000464})
    empty = hydrostatics(model, qpos=[0, 0, -3, 1, 0, 0, 0])
    assert full.reserve == pytest.approx(-empty.reserve, abs=1e-3)
