"""Whole runs: what compiled code keeps of each step, and slow twins in Python."""

import dataclasses
import math
import re

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from buoyancy_mj import DivergenceError, JonswapSea, Simulation, read_scene
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.trajectory import Poses


def simulate(scene="hourglass_drop_waves", *settings):
    return Simulation(read_scene(catalog.scenes()[scene], settings))


def numbers_of(simulation):
    return {name: one.values() for name, one in simulation.summary().vehicles.items()}


@pytest.mark.parametrize("integrator", ["implicitfast", "RK4"])
def test_a_run_without_frames_leaves_the_summary_of_single_steps_and_of_frames(integrator):
    settings = ["duration=0.5", f"integrator={integrator}"]
    run, stepped, framed = (simulate("hourglass_drop_waves", *settings) for _ in range(3))
    times = []
    run.run(times.append)
    for _ in range(stepped.steps):
        stepped.step()
    stepped.frame()
    for _ in framed.frames():
        pass
    assert numbers_of(run) == numbers_of(stepped)
    for name, numbers in numbers_of(framed).items():
        # frames see stages of a run that its steps do not, under RK4
        wanted = {key: pytest.approx(value) for key, value in numbers_of(run)[name].items()}
        if integrator != "RK4":
            assert numbers == wanted
    assert run.data.qpos == pytest.approx(framed.data.qpos, abs=0.0)
    assert times == sorted(times)
    assert times[-1] == pytest.approx(0.5)
    assert run.summary().wall_time > 0.0


def test_the_summary_between_frames_is_of_the_last_step():
    simulation = simulate("hourglass_drop_still")
    simulation.advance(5)
    lowest = min(
        (hull.mesh_in_body.vertices @ simulation.data.xmat[hull.body].reshape(3, 3).T)[:, 2].min()
        + simulation.data.xpos[hull.body, 2]
        for hull in simulation.hulls
    )
    assert simulation.summary().final_draft == pytest.approx(-lowest, abs=1e-12)


@pytest.mark.parametrize("scene", ["hourglass_drop_still", "sphere_decay"])
@pytest.mark.parametrize("waves", [(), (JonswapSea(0.3, 2.0, components=12, spreading=10.0),)])
def test_the_draft_is_that_of_the_deepest_corner_of_all(scene, waves):
    scene = read_scene(catalog.scenes()[scene])
    scene = dataclasses.replace(scene, water=dataclasses.replace(scene.water, waves=waves))
    simulation = Simulation(scene)
    water, model = simulation.buoyancy.water, simulation.model
    (monitor,) = simulation._source.monitors.values()
    known = monitor._table.arrays.corners
    body = simulation.vehicle.root
    random = np.random.default_rng(3)
    peak = -math.inf
    for time in np.linspace(0.0, 20.0, 20).tolist():
        turns = Rotation.random(model.nbody, random_state=random).as_matrix().reshape(-1, 9)
        places = random.uniform(-2.0, 2.0, (model.nbody, 3))
        corners = known.corners @ turns[body].reshape(3, 3).T + places[body]
        draft = water.depth(corners, time).max()
        peak = max(peak, draft)
        monitor.add_poses(Poses(places, turns, places), time)
        assert monitor.draft == pytest.approx(draft, abs=1e-9)
        assert monitor.peak_draft == pytest.approx(peak, abs=1e-9)


def test_contacts_with_what_is_fixed_are_counted_as_the_engine_lists_them():
    run, twin = (simulate("auv_pool", "duration=0.4") for _ in range(2))
    fixed = run.model.body_weldid[run.model.geom_bodyid] == 0
    for one in (run, twin):
        one.data.qpos[2] = -1.35
    steps, first = 0, None
    for _ in range(twin.steps):
        mujoco.mj_step(twin.model, twin.data)
        pairs = twin.data.contact.geom
        if (fixed[pairs[:, 0]] ^ fixed[pairs[:, 1]]).any():
            steps += 1
            first = twin.data.time if first is None else first
    summary = run.run()
    assert steps > 0
    assert (summary.contact_steps, summary.first_contact) == (steps, first)


@pytest.mark.parametrize(
    ("kick", "cause"),
    [
        (math.nan, "the velocity of body 'hourglass' is not a finite, sensible number"),
        (2e3, "body 'hourglass' moves at 2e+03 m/s (more than 1,000)"),
    ],
)
def test_a_run_that_diverges_is_told_at_the_time_of_its_step(kick, cause):
    told = []
    for block in (1, 50):
        simulation = simulate("hourglass_drop_still")
        simulation.advance(7)
        simulation.data.qvel[0] = kick
        with pytest.raises(DivergenceError, match=re.escape(cause)) as caught:
            simulation.advance(block)
        told.append(str(caught.value))
        assert simulation.data.time == pytest.approx(0.08)
    assert told[0] == told[1]
    # a bad value is told after the step that meets it, a wild one at the poses that show it
    assert f"diverged at {0.08 if math.isnan(kick) else 0.07:.4g} s" in told[0]


@pytest.mark.parametrize("rate", [7.0, 60.0, 100.0, 1000.0])
def test_frames_are_due_at_the_record_rate_and_at_the_end(rate):
    simulation = simulate("hourglass_drop_still", f"record_rate={rate}", "duration=1.23")
    recorded, wanted = 0, []
    for step in range(1, simulation.steps + 1):
        due = math.floor(step * simulation.scene.timestep * rate + 1e-9)
        if due > recorded or step == simulation.steps:
            recorded = due
            wanted.append(step)
    assert list(simulation._list_frames()) == wanted


def test_long_runs_keep_a_sum_for_each_part_and_no_poses():
    simulation = simulate("hourglass_drop_still", "duration=60")
    simulation.advance(5000)
    tally = simulation._witness.meters._meters["hourglass"]._tally
    assert len(simulation._witness.meters.tape._kept) + sum(map(len, tally._open)) < 3000
    assert sum(len(parts.number) for parts in tally._parts) <= 25
