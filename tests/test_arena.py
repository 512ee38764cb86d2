"""The arena of the Singapore AUV Challenge: what stands where, and how its props behave."""

import importlib.util
import itertools
import math
from pathlib import Path

import mujoco
import numpy as np
import pytest

from buoyancy_mj import SceneError, Water, add_water, sauvc_arena
from buoyancy_mj.environments.sauvc.layout import COLOURS, DRUM_YS, draw_layout
from buoyancy_mj.scenes import catalog

SEEDS = range(40)
RAY = np.zeros(1, np.int32)


def floor_under(model, data, x, y):
    """Depth of what is met straight down from the surface [m]."""
    return mujoco.mj_ray(model, data, [x, y, 0.0], [0.0, 0.0, -1.0], None, 1, -1, RAY)


def posed(model):
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return data


def afloat(spec, seconds):
    """The arena after some time in still water."""
    add_water(spec, Water(), added_mass="model")
    spec.option.timestep = 0.01
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    model = spec.compile()
    data = mujoco.MjData(model)
    while data.time < seconds:
        mujoco.mj_step(model, data)
    return model, data


def distance(data, ball, site):
    return np.linalg.norm(data.body(ball).xpos - data.site(site).xpos)


# the pool ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("x", "depth"), [(-12.49, 1.2), (-6.25, 1.4), (0.0, 1.6), (6.25, 1.4), (12.49, 1.2)]
)
def test_the_pool_is_as_deep_as_the_rulebook_says(x, depth):
    model = sauvc_arena("qualification").compile()
    data = posed(model)
    for y in (-7.9, 0.0, 7.9):
        assert floor_under(model, data, x, y) == pytest.approx(depth, abs=1e-3)


@pytest.mark.parametrize(
    ("direction", "distance"), [((1, 0, 0), 12.5), ((-1, 0, 0), 12.5), ((0, 1, 0), 8.0)]
)
def test_the_pool_is_25_m_by_16_m(direction, distance):
    model = sauvc_arena("qualification").compile()
    way = np.array(direction, float)
    met = mujoco.mj_ray(model, posed(model), [0.0, 0.0, -0.3], way, None, 1, -1, RAY)
    assert met == pytest.approx(distance)


# what stands in it ------------------------------------------------------------------------------


def test_the_gate_of_the_final_is_150_cm_wide_outside_and_100_cm_high_inside():
    model = sauvc_arena("course").compile()
    data = posed(model)
    middle = data.site("gate").xpos
    assert middle[0] + 12.5 == pytest.approx(16.0)

    def reach(*way):
        return mujoco.mj_ray(model, data, middle, np.array(way, float), None, 1, -1, RAY)

    assert reach(0, 1, 0) + reach(0, -1, 0) == pytest.approx(1.5 - 2 * 0.04)
    assert reach(0, 0, 1) + reach(0, 0, -1) == pytest.approx(1.0, abs=2e-3)
    assert model.site("gate").size[1:] == pytest.approx([0.71, 0.5])
    # red to port, green to starboard
    red, green = model.geom("gate_port_1"), model.geom("gate_starboard_1")
    assert red.rgba[0] > 0.8 > 0.2 > red.rgba[1]
    assert green.rgba[1] > 0.8 > 0.2 > green.rgba[0]
    assert red.pos[1] > 0.0 > green.pos[1]


def test_the_qualification_gates_hang_from_the_surface_to_the_floor_10_m_from_the_start():
    model = sauvc_arena("qualification").compile()
    data = posed(model)
    for lane in ("port", "starboard"):
        x, _, z = data.site(f"gate_{lane}").xpos
        half = model.site(f"gate_{lane}").size[2]
        assert x + 12.5 == pytest.approx(10.0)
        assert z + half == pytest.approx(0.0)
        assert z - half == pytest.approx(-1.52, abs=0.03)


def test_a_drum_is_60_cm_wide_30_cm_deep_and_open_above():
    model = sauvc_arena("course").compile()
    data = posed(model)
    for name in ("blue_drum", "red_drum_1", "red_drum_2", "red_drum_3"):
        x, y, z = data.site(name).xpos
        # beside the pinger, down to its bottom on the floor, 0.6 m wide
        assert floor_under(model, data, x, y + 0.1) == pytest.approx(1.2, abs=0.06)
        around = [
            mujoco.mj_ray(
                model, data, [x, y, z + 0.1], [math.cos(a), math.sin(a), 0.0], None, 1, -1, RAY
            )
            for a in np.arange(12) * math.pi / 6.0
        ]
        assert around == pytest.approx([0.29] * 12, abs=1e-6)
        assert model.body(name).pos[2] + 0.3 == pytest.approx(z + 0.15)


def test_one_drum_is_blue_and_a_red_one_has_the_pinger():
    assert all(layout.blue_drum != layout.pinger for layout in map(draw_layout, SEEDS))
    for seed in range(3):
        model = sauvc_arena("course", seed).compile()
        owner = model.body(model.site_bodyid[model.site("pinger").id]).name
        assert owner.startswith("red_drum")


# layouts ----------------------------------------------------------------------------------------


def test_a_layout_keeps_to_the_bounds_of_the_rulebook():
    for seed in SEEDS:
        layout = draw_layout(seed)
        assert abs(layout.gate) < 8.0 - 0.75
        assert 4.0 <= layout.orange_flare[0] + 12.5 <= 8.0
        assert abs(layout.orange_flare[1]) <= 7.0
        for x, y in layout.flares.values():
            assert 8.0 <= x + 12.5 <= 16.0
            assert abs(y) <= 7.0
        assert sorted(layout.order) == sorted(COLOURS)
        feet = [layout.orange_flare, *layout.flares.values()]
        assert min(math.dist(*pair) for pair in itertools.combinations(feet, 2)) >= 2.0


def test_a_seed_gives_one_layout_and_seeds_differ():
    layouts = [draw_layout(seed) for seed in SEEDS]
    assert layouts == [draw_layout(seed) for seed in SEEDS]
    assert len({layout.gate for layout in layouts}) == len(SEEDS)
    # every drum is blue in some, every order is asked for in some
    assert {layout.blue_drum for layout in layouts} == set(range(len(DRUM_YS)))
    assert len({layout.order for layout in layouts}) == 6


def test_the_layout_of_a_seed_is_the_same_everywhere():
    layout = draw_layout(7)
    assert layout.gate == pytest.approx(-2.466341292335727, abs=1e-12)


@pytest.mark.parametrize("seed", [-1, 1.5, "seven", True])
def test_a_seed_that_is_none_is_refused(seed):
    with pytest.raises(SceneError, match=r"^seed is .*; it must be a whole number from 0 to"):
        sauvc_arena("course", seed)


def test_an_unknown_task_is_refused():
    with pytest.raises(
        SceneError,
        match=r"^there is no task 'finals'; possible: course, qualification$",
    ):
        sauvc_arena("finals")


# how the props behave ---------------------------------------------------------------------------


def test_in_still_water_everything_stays_where_it_is():
    _, data = afloat(sauvc_arena("course"), 3.0)
    for colour in COLOURS:
        assert distance(data, f"{colour}_flare_ball", f"{colour}_flare") < 0.002
        assert data.body(f"{colour}_flare").xmat[8] > math.cos(math.radians(0.5))
    assert data.body("orange_flare").xmat[8] > math.cos(math.radians(0.5))
    assert not any(data.warning[i].number for i in range(mujoco.mjtWarning.mjNWARNING))


def test_the_orange_flare_comes_upright_again_by_its_buoyancy():
    spec = sauvc_arena("course")
    spec.body("orange_flare").quat = [math.cos(0.15), math.sin(0.15), 0.0, 0.0]
    _, data = afloat(spec, 15.0)
    assert data.body("orange_flare").xmat[8] > math.cos(math.radians(3.0))


def test_a_ball_falls_from_a_flare_that_tilts_and_stays_down():
    spec = sauvc_arena("course")
    add_water(spec, Water(), added_mass="model")
    spec.option.timestep = 0.01
    model = spec.compile()
    data = mujoco.MjData(model)
    dofs = model.joint("red_flare").dofadr[0] + np.arange(3)
    heights = []
    while data.time < 8.0:
        # 3 N at the middle of the rod, for a second
        data.qfrc_applied[dofs] = [0.0, 1.2 if data.time < 1.0 else 0.0, 0.0]
        mujoco.mj_step(model, data)
        heights.append(float(data.body("red_flare_ball").xpos[2]))
    x, _, z = data.body("red_flare_ball").xpos
    assert z == pytest.approx(-floor_depth(x) + 0.02134, abs=5e-3)
    assert heights[0] - min(heights) > 0.7
    assert distance(data, "blue_flare_ball", "blue_flare") < 0.002
    assert np.linalg.norm(data.body("red_flare_ball").cvel[3:]) < 0.05


def floor_depth(x):
    return 1.6 - 0.4 * abs(x) / 12.5


def test_the_ball_clings_until_it_is_let_go():
    spec = sauvc_arena("course")
    holder = spec.worldbody.add_body(name="holder", pos=[-11.6, 1.2, -0.6 + 0.02 + 0.051])
    holder.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.1, 0.1, 0.05])
    add_water(spec, Water(), added_mass="model")
    spec.option.timestep = 0.01
    model = spec.compile()
    data = mujoco.MjData(model)
    while data.time < 2.0:
        mujoco.mj_step(model, data)
    assert np.linalg.norm(data.body("ball").xpos - [-11.6, 1.2, -0.6]) < 0.005
    data.actuator("ball").ctrl = 1.0
    while data.time < 6.0:
        mujoco.mj_step(model, data)
    assert data.body("ball").xpos[2] == pytest.approx(-floor_depth(-11.6) + 0.02, abs=5e-3)


# files ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("task", ["course", "qualification"])
def test_the_arena_that_ships_is_the_one_that_is_built(task):
    path = Path(__file__).parent.parent / "scripts" / "make_arenas.py"
    module = importlib.util.spec_from_file_location("make_arenas", path)
    script = importlib.util.module_from_spec(module)
    module.loader.exec_module(script)
    shipped = catalog.environments()[f"sauvc_{task}"]
    built = mujoco.MjSpec.from_string(script.write_arena(task)).compile()
    model = mujoco.MjModel.from_xml_path(str(shipped))
    assert [model.geom(i).name for i in range(model.ngeom)] == [
        built.geom(i).name for i in range(built.ngeom)
    ]
    for field in ("geom_pos", "geom_size", "site_pos", "body_pos", "body_mass", "geom_rgba"):
        np.testing.assert_allclose(getattr(model, field), getattr(built, field), atol=1e-6)
