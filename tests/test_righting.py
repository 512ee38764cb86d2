"""GZ curves: closed forms past the deck edge, the slow twin, energy, and where sites go under."""

import math

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from buoyancy_mj import BuoyancyWarning, EquilibriumError, ModelError, Water, righting_arm
from buoyancy_mj.meshes import shapes
from buoyancy_mj.statics.balance import find_heave_balance
from buoyancy_mj.statics.building import build_vessel
from buoyancy_mj.statics.hydrostatics import compute_hydrostatics
from tests import naive, vessels

DEGREES = np.radians([10.0, 20.0, 25.0, 35.0, 45.0, 60.0, 90.0, 120.0])


@pytest.mark.parametrize("trim", ["free", "fixed"])
def test_a_box_has_its_righting_arms_past_the_deck_edge_too(trim):
    # P3: sin(heel) (GM + BM tan^2(heel) / 2) up to 30.96 degrees, exact beyond
    found = righting_arm(vessels.box(), heel=DEGREES, trim=trim)
    arms = [0.0229382, 0.0499955, 0.0667645, 0.1055164, 0.1131371, 0.0900000, 0.0, -0.09]
    assert found.gz == pytest.approx(arms, abs=5e-8)
    assert found.vanishing == pytest.approx(math.pi / 2, abs=1e-8)
    assert found.trim == pytest.approx(np.zeros(8), abs=1e-9)


def test_half_a_turn_in_steps_of_a_degree_is_the_default():
    found = righting_arm(vessels.box())
    assert np.degrees(found.heel) == pytest.approx(np.arange(181))
    # the largest arm of this box: d/dheel of the exact curve of the triangular section, by the slow
    # twin
    heel, arm = found.maximum
    twin = [
        naive.righting_arm(shapes.box((1.0, 0.5, 0.3)), np.zeros(3), 0.6, angle)
        for angle in (heel - 0.02, heel, heel + 0.02)
    ]
    assert arm == pytest.approx(twin[1], rel=1e-9)
    assert twin[1] > max(twin[0], twin[2])


@pytest.mark.parametrize(("axis", "name"), [(0.0, "GMt"), (math.pi / 2, "GMl")])
def test_the_initial_slope_is_the_metacentric_height(axis, name):
    mesh = vessels.dented(7)
    model = vessels.of_mesh(mesh, 500.0 * mesh.volume, mesh.centroid + [0, 0, -0.1])
    small = 1e-4
    found = righting_arm(model, heel=[-small, 0.0, small], axis=axis, trim="fixed")
    upright = compute_hydrostatics(find_heave_balance(build_vessel(model), np.eye(3)))
    assert (found.gz[2] - found.gz[0]) / (2 * small) == pytest.approx(
        getattr(upright, name), rel=1e-5
    )


@pytest.mark.parametrize("seed", [2, 5, 7])
def test_with_fixed_trim_it_is_the_slow_twins(seed):
    mesh = vessels.dented(seed)
    centre = mesh.centroid + [0.0, 0.02, -0.1]
    model = vessels.of_mesh(mesh, 600.0 * mesh.volume, centre)
    angles = np.radians([-50.0, -10.0, 15.0, 40.0, 100.0, 150.0])
    found = righting_arm(model, heel=angles, trim="fixed")
    twin = [naive.righting_arm(mesh, centre, 0.6 * mesh.volume, angle) for angle in angles]
    assert found.gz * np.sign(angles) == pytest.approx(twin, abs=1e-6)


@pytest.mark.parametrize("seed", [0, 2, 4])
def test_with_free_trim_no_torque_is_left_across(seed):
    mesh = vessels.dented(seed)
    model = vessels.of_mesh(mesh, 500.0 * mesh.volume, mesh.centroid + [0.05, 0, -0.1])
    found = righting_arm(model, heel=np.radians([0, 20, 40, 60]))
    assert np.abs(found.trim).max() > 1e-3
    vessel = build_vessel(model)
    for heel, trim, gz in zip(found.heel, found.trim, found.gz, strict=True):
        pose = find_heave_balance(vessel, Rotation.from_euler("YX", [trim, heel]).as_matrix())
        assert pose.arm[:2] == pytest.approx([0.0, -gz], abs=1e-9)


@pytest.mark.parametrize("trim", ["fixed", "free"])
def test_the_area_is_the_work_that_heels_it(trim):
    # dE = W GZ cos(trim) dheel, since heel turns about the trimmed axis
    mesh = vessels.dented(0)
    model = vessels.of_mesh(mesh, 500.0 * mesh.volume, mesh.centroid + [0, 0, -0.1])
    found = righting_arm(model, heel=np.radians(np.arange(0, 60.25, 0.25)), trim=trim)
    vessel = build_vessel(model)
    ends = [
        find_heave_balance(
            vessel, Rotation.from_euler("YX", [found.trim[i], found.heel[i]]).as_matrix()
        ).energy
        / vessel.weight
        for i in (0, -1)
    ]
    work = np.trapezoid(found.gz * np.cos(found.trim), found.heel)
    assert work == pytest.approx(ends[1] - ends[0], rel=1e-5)
    if trim == "fixed":
        assert found.area(0.0, found.heel[-1]) == pytest.approx(ends[1] - ends[0], rel=1e-5)


def test_a_submerged_vehicle_rights_itself_with_the_sine_of_its_heel():
    inertial = '<inertial pos="0 0 -.03" mass="4188.790205" diaginertia="9 9 9"/>'
    model = vessels.of_geoms('<geom type="sphere" size="1"/>', inertial)
    found = righting_arm(model, heel=DEGREES)
    assert found.gz == pytest.approx(0.03 * np.sin(DEGREES), abs=1e-6)


def test_heeled_about_the_axis_across_it_is_the_curve_in_trim():
    # the box as if it were 2 m wide: B^2 / (12 T) with B = 2
    found = righting_arm(vessels.box(), heel=np.radians([5.0]), axis=math.pi / 2)
    bm = 4.0 / 3.6
    assert found.gz == pytest.approx(
        math.sin(math.radians(5)) * (0.15 - 0.3 + bm + 0.5 * bm * math.tan(math.radians(5)) ** 2)
    )


def test_heading_place_and_level_do_not_matter():
    turned = [4.0, -2.0, 1.0, math.cos(0.7), 0.0, 0.0, math.sin(0.7)]
    found = righting_arm(vessels.box(), Water(level=3.0), DEGREES, start=turned)
    assert found.gz == pytest.approx(righting_arm(vessels.box(), heel=DEGREES).gz, abs=1e-9)


def test_sites_tell_when_they_go_under():
    # the deck edge of the box at atan(T / (B / 2)) = 30.96 degrees, a hatch in the middle of the
    # deck with it at 90
    sites = (
        '<site name="deck_edge_starboard" pos="0 -.5 .3"/>'
        '<site name="deck_edge_port" pos="0 .5 .3"/><site name="downflooding" pos="0 0 .3"/>'
        '<site name="keel" pos="0 0 -.3"/><site name="other" pos="0 0 9"/>'
    )
    model = vessels.of_geoms('<geom type="box" size="1 .5 .3" mass="600"/>' + sites)
    found = righting_arm(model)
    assert set(found.immersed) == {"deck_edge_starboard", "deck_edge_port", "downflooding"}
    assert math.degrees(found.immersed["deck_edge_starboard"]) == pytest.approx(30.9638, abs=1e-3)
    assert math.degrees(found.immersed["downflooding"]) == pytest.approx(90.0, abs=1e-6)
    assert math.degrees(found.immersed["deck_edge_port"]) == pytest.approx(
        180.0 - 30.9638, abs=1e-3
    )
    keel = righting_arm(model, points="keel", heel=np.radians([0, 10]))
    assert keel.immersed == {"keel": 0.0}
    assert math.isnan(
        righting_arm(model, points="other", heel=np.radians([0, 10])).immersed["other"]
    )


def test_where_no_trim_balances_the_curve_ends_and_says_so():
    mesh = vessels.dented(1)
    model = vessels.of_mesh(mesh, 500.0 * mesh.volume, mesh.centroid + [0, 0, -0.1])
    with pytest.warns(
        BuoyancyWarning, match="ends there: at a heel of 105 degrees it balances only"
    ):
        found = righting_arm(model)
    assert math.degrees(found.heel[-1]) == pytest.approx(104.0)
    assert len(found.gz) == len(found.trim) == len(found.draft) == 105


def test_what_sinks_has_no_curve():
    with pytest.raises(EquilibriumError, match="sinks"):
        righting_arm(vessels.box(mass=1300.0))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"heel": []}, "heel and axis must be finite angles"),
        ({"heel": [math.nan]}, "heel and axis must be finite angles"),
        ({"heel": "x"}, "heel and axis must be finite angles"),
        ({"axis": None}, "heel and axis must be finite angles"),
        ({"trim": "loose"}, "trim is 'loose'; possible: fixed, free"),
        ({"points": "rail*"}, r"no site of the vessel matches 'rail\*'; possible: nothing"),
    ],
)
def test_what_makes_no_sense_is_told(arguments, message):
    with pytest.raises(ModelError, match=message):
        righting_arm(vessels.box(), **arguments)


def test_an_area_outside_of_the_curve_is_told():
    found = righting_arm(vessels.box(), heel=DEGREES)
    with pytest.raises(
        ModelError, match=r"area from 0 to 1 rad; the curve goes from 0.1745\d* to 2.094\d* rad"
    ):
        found.area(0.0, 1.0)


def test_all_trees_of_a_model_have_sites_of_their_own():
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><worldbody><site name="downflooding_quay" pos="0 0 1"/>'
        '<body name="tug"><freejoint/><geom type="box" size="1 .5 .3" mass="600"/>'
        '<site name="downflooding_tug" pos="0 0 .5"/></body></worldbody></mujoco>'
    )
    assert list(righting_arm(model, heel=[0.0, 0.1]).immersed) == ["downflooding_tug"]


@pytest.mark.parametrize("points", [3, [1, 2], b"deck"])
def test_points_that_are_no_globs_are_refused(points):
    with pytest.raises(ModelError) as caught:
        righting_arm(vessels.box(), points=points)
    assert str(caught.value) == f"points is {points!r}; it must be globs of sites, as ['deck*']"
