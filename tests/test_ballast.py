"""Ballast: the result is put into the model, which must then float or hover as wanted."""

import math

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from buoyancy_mj import (
    BallastError,
    BuoyancyWarning,
    ModelError,
    Water,
    ballast,
    equilibrium,
    hydrostatics,
    righting_arm,
)

# a box that floats at 0.3 m, with places on its bottom, outside and in
RAFT = """<mujoco><worldbody><body name="raft"><freejoint/>
  <geom name="hull" type="box" size="1 .5 .3" mass="300"/>
  <site name="ballast_fore" pos=".8 0 -.25"/><site name="ballast_aft" pos="-.8 0 -.25"/>
  <site name="ballast_port" pos="0 .4 -.25"/><site name="ballast_starboard" pos="0 -.4 -.25"/>
  <site name="keel" pos="0 0 -.8"/><site name="foam_top" pos="0 0 .6"/>
  <site name="inside" pos="0 0 0"/>
</body></worldbody></mujoco>"""


def raft(text=RAFT):
    return mujoco.MjSpec.from_string(text)


def put(spec, result):
    """The vehicle with the ballast in it."""
    result.add_to(spec)
    return spec.compile()


@given(st.floats(0.16, 0.5), st.floats(-0.05, 0.05), st.floats(-0.02, 0.02))
@settings(max_examples=20)
def test_the_ballasted_model_floats_at_the_wanted_draft_heel_and_trim(draft, heel, trim):
    spec = raft()
    try:
        result = ballast(spec.compile(), draft=draft, heel=heel, trim=trim)
    except BallastError as error:
        # near its own draft there is not enough to add that could heel it
        assert draft < 0.3
        assert "cannot level it" in str(error) or "too heavy" in str(error)  # noqa: PT017
        return
    found = equilibrium(put(spec, result)).hydrostatics
    assert (found.draft, found.heel, found.trim) == pytest.approx((draft, heel, trim), abs=1e-6)
    assert found.mass == pytest.approx(300.0 + result.mass, rel=1e-12)
    assert found.GMt == pytest.approx(result.hydrostatics.GMt, rel=1e-6)


def test_level_ballast_is_what_archimedes_says():
    result = ballast(raft().compile(), draft=0.3)
    assert result.mass == pytest.approx(300.0, rel=1e-12)
    assert result.hydrostatics.draft == pytest.approx(0.3, rel=1e-9)


def test_a_vessel_that_is_right_needs_nothing():
    result = ballast(raft().compile(), draft=0.15)
    assert result.items == ()
    assert result.mass == 0.0


def test_neutral_with_a_wanted_bg_is_reached_by_the_lowest_ballast():
    spec = raft()
    result = ballast(spec.compile(), reserve=0.0, masses=["ballast*", "keel"], bg=0.2)
    found = hydrostatics(put(spec, result), qpos=[0, 0, -5, 1, 0, 0, 0])
    assert found.reserve == pytest.approx(0.0, abs=1e-3 * 1200)
    assert pytest.approx(0.2, rel=2e-3) == found.BG
    assert found.GMt == pytest.approx(found.BG, rel=1e-9)
    # the keel hangs outside, so it displaces: lead of 11340 kg/m^3
    keel = next(one for one in result.items if one.name == "keel")
    assert keel.displaces
    assert keel.radius == pytest.approx((keel.mass / 11340 * 3 / (4 * math.pi)) ** (1 / 3))
    total = 1.2 + keel.mass / 11340
    assert 1000 * total == pytest.approx(300 + result.mass, rel=1e-9)


def test_a_reserve_is_left():
    spec = raft()
    result = ballast(spec.compile(), Water(density=1025.0), reserve=2.5)
    assert hydrostatics(put(spec, result), Water(density=1025.0)).reserve == pytest.approx(
        2.5, rel=1e-9
    )


def test_foam_lifts_what_is_too_heavy_and_displaces_its_own_volume():
    spec = raft(RAFT.replace('mass="300"', 'mass="1300"'))
    # foam above and lead below: neutral at last
    result = ballast(spec.compile(), reserve=0.0, foam_density=150.0)
    model = put(spec, result)
    found = hydrostatics(model, qpos=[0, 0, -5, 1, 0, 0, 0])
    assert found.reserve == pytest.approx(0.0, abs=2e-3 * 1300)
    (foam,) = result.items
    assert (foam.kind, foam.name) == ("foam", "foam_top")
    # 100 kg to lift: V (1000 - 150) = 100
    assert foam.mass == pytest.approx(100.0 / 850.0 * 150.0, rel=1e-9)


def test_inside_a_box_one_mass_does_it():
    spec = raft(RAFT.replace('pos="0 0 .6"', 'pos=".1 .05 .6"'))
    box = [[-0.9, -0.45, -0.28], [0.9, 0.45, -0.2]]
    result = ballast(spec.compile(), draft=0.25, heel=0.05, trim=0.02, masses=box)
    (mass,) = result.items
    assert mass.name == "box"
    assert (mass.position >= box[0]).all()
    assert (mass.position <= box[1]).all()
    found = equilibrium(put(spec, result)).hydrostatics
    assert (found.draft, found.heel, found.trim) == pytest.approx((0.25, 0.05, 0.02), abs=1e-6)


def test_joints_are_held_and_another_pose_needs_another_ballast():
    text = RAFT.replace(
        "</body></worldbody>",
        '<body name="arm" pos="0 0 .3"><joint name="arm" axis="1 0 0"/>'
        '<geom name="arm" type="capsule" size=".03" '
        'fromto="0 0 0 0 0 .5" mass="20"/></body></body></worldbody>',
    )
    spec = raft(text)
    start = [0, 0, 0, 1, 0, 0, 0, -1.2]
    result = ballast(spec.compile(), draft=0.25, start=start)
    model = put(spec, result)
    assert equilibrium(model, start=start).hydrostatics.heel == pytest.approx(0.0, abs=1e-6)
    assert abs(equilibrium(model).hydrostatics.heel) > 0.02


def test_the_vehicles_own_choice_of_geoms_takes_the_foam_in():
    text = RAFT.replace(
        "<worldbody>", '<custom><text name="buoyancy_geoms" data="hull"/></custom><worldbody>'
    )
    spec = raft(text.replace('mass="300"', 'mass="1300"'))
    result = ballast(spec.compile(), reserve=0.0)
    model = put(spec, result)
    assert hydrostatics(model, qpos=[0, 0, -5, 1, 0, 0, 0]).reserve == pytest.approx(
        0.0, abs=2e-3 * 1300
    )
    # and keeps it through XML
    again = mujoco.MjModel.from_xml_string(spec.to_xml())
    assert hydrostatics(again, qpos=[0, 0, -5, 1, 0, 0, 0]).reserve == pytest.approx(
        0.0, abs=2e-3 * 1300
    )


@pytest.mark.parametrize(("prefix", "suffix"), [("p_", ""), ("p/", ""), ("p_", "_1")])
def test_so_does_the_choice_of_an_attached_vehicle(prefix, suffix):
    custom = '<custom><text name="buoyancy_geoms" data="hull"/></custom><worldbody>'
    text = RAFT.replace("<worldbody>", custom).replace('mass="300"', 'mass="1300"')
    spec = mujoco.MjSpec.from_string("<mujoco/>")
    frame = spec.worldbody.add_frame()
    spec.attach(mujoco.MjSpec.from_string(text), prefix=prefix, suffix=suffix, frame=frame)
    places = {"foam": f"{prefix}foam*{suffix}", "masses": f"{prefix}ballast*{suffix}"}
    model = put(spec, ballast(spec.compile(), reserve=0.0, **places))
    reserve = hydrostatics(model, qpos=[0, 0, -5, 1, 0, 0, 0]).reserve
    assert reserve == pytest.approx(0.0, abs=2e-3 * 1300)


def test_the_wanted_heel_is_where_the_righting_arm_vanishes():
    spec = raft()
    model = put(spec, ballast(spec.compile(), draft=0.3, heel=0.1))
    assert righting_arm(model, heel=[0.1]).gz == pytest.approx(0.0, abs=1e-6)
    assert Rotation.from_quat(equilibrium(model).qpos[3:], scalar_first=True).as_euler("ZYX")[
        2
    ] == pytest.approx(0.1, abs=1e-6)


# what cannot be


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            {"draft": 0.1, "foam": "foam*"},
            "it is 100 kg too heavy for that; give foam a place under water, or take mass out",
        ),
        (
            {"draft": 0.4, "masses": "ballast_fore"},
            r"these places cannot level it: [+-]\d+ kg m along x .* farther out on that",
        ),
        (
            {"reserve": 0.0, "foam": [], "bg": 0.4},
            r"these places give a BG of 0\.1875 to 0\.1875 m, not 0\.4; give",
        ),
        (
            {"draft": 0.7},
            r"a draft of 0\.7 m is wanted of hulls 0\.6 m tall at this attitude; "
            "it must be above 0 and at most",
        ),
        ({"draft": -0.1}, r"a draft of -0\.1 m is wanted"),
        ({"draft": 0.4, "masses": [[0.5, 0, 0], [0.9, 0.1, 0.1]]}, "these places cannot level it"),
        (
            {"draft": 0.3, "foam": "inside"},
            "foam at 'inside' lies inside hull 'hull', where it displaces nothing more",
        ),
    ],
)
def test_what_these_places_cannot_do_is_told_with_what_they_can(arguments, message):
    with pytest.raises(BallastError, match=message):
        ballast(raft().compile(), **arguments)


def test_without_a_place_the_missing_mass_is_told():
    model = raft(RAFT.replace("ballast_", "b_")).compile()
    with pytest.raises(
        BallastError,
        match=r"\+300 kg are wanted.* name sites 'ballast...' and 'foam...', or give masses or",
    ):
        ballast(model, draft=0.3)
    with pytest.raises(BallastError, match="it is 900 kg too light for that; give masses a place"):
        ballast(model, reserve=0.0)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({}, "0 for neutral, and neither is given$"),
        ({"draft": 0.2, "reserve": 0.0}, "0 for neutral, and both are given$"),
        ({"draft": math.nan}, "all must be finite"),
        ({"draft": "x"}, r"bg are \['x', 0.0, 0.0\], .* all must be finite numbers"),
        ({"draft": 0.2, "foam_density": "x"}, "densities 11340.0 and x; all must be finite numb"),
        ({"draft": 0.2, "mass_density": 0.0}, "densities positive"),
        (
            {"draft": 0.2, "masses": "lead*"},
            r"no site of the vessel matches 'lead\*'; possible: ballast_aft, ",
        ),
        ({"draft": 0.2, "masses": None}, "a box for ballast is None; it must be its lowest"),
        ({"draft": 0.2, "foam": 3}, "a box for foam is 3; it must be its lowest"),
        ({"draft": 0.2, "foam": ["a", 1]}, r"a box for foam is \['a', 1\]; it must be its lowest"),
        ({"draft": 0.2, "masses": [[0, 0, 0]]}, r"must be its lowest and highest corner \(2, 3\)"),
        ({"draft": 0.2, "masses": [[1, 0, 0], [0, 1, 1]]}, "must be its lowest and highest corner"),
    ],
)
def test_what_makes_no_sense_is_told(arguments, message):
    with pytest.raises(ModelError, match=message):
        ballast(raft().compile(), **arguments)


def test_an_unstable_wish_is_granted_with_a_warning():
    text = RAFT.replace('pos="0 .4 -.25"', 'pos="0 .4 1.5"').replace(
        'pos="0 -.4 -.25"', 'pos="0 -.4 1.5"'
    )
    with pytest.warns(BuoyancyWarning, match="it is not stable: GM is -"):
        ballast(raft(text).compile(), draft=0.3, masses=["ballast_port", "ballast_starboard"])


def test_foam_that_overlaps_the_hull_is_told():
    text = RAFT.replace('mass="300"', 'mass="1300"').replace('pos="0 0 .6"', 'pos="0 0 .35"')
    with pytest.warns(
        BuoyancyWarning, match=r"'hull' and 'foam_top' overlap by .* place them apart"
    ):
        ballast(raft(text).compile(), reserve=0.0)


def test_ballasting_twice_is_told():
    spec = raft()
    result = ballast(spec.compile(), draft=0.3)
    result.add_to(spec)
    with pytest.raises(
        ModelError, match=r"body 'ballast_\w+' is there already; ballast the vehicle as it was"
    ):
        result.add_to(spec)


def test_another_vehicle_is_told():
    result = ballast(raft().compile(), draft=0.3)
    with pytest.raises(
        ModelError, match="there is no body 'raft' to carry the ballast; possible: boat, world"
    ):
        result.add_to(
            mujoco.MjSpec.from_string(RAFT.replace('body name="raft"', 'body name="boat"'))
        )


def test_masses_and_their_moments_add_up():
    result = ballast(raft().compile(), draft=0.3, heel=0.05)
    spec = raft()
    model = put(spec, result)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    expected = sum(one.mass * one.position for one in result.items) / (300.0 + result.mass)
    assert data.subtree_com[1] == pytest.approx(expected, abs=1e-9)
    assert np.allclose(result.hydrostatics.mass_matrix[0, 0], 300.0 + result.mass)
