"""Words in `<custom>` hold for what came from their file, under whatever names it was attached."""

import warnings
from pathlib import Path

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from buoyancy_mj import (
    Buoyancy,
    BuoyancyWarning,
    Damping,
    ModelError,
    RegularWave,
    Selection,
    Water,
    add_water,
    water_in,
)
from buoyancy_mj.engine.instances import PLUGIN
from buoyancy_mj.hulls.convex_choice import describe_convex_choice
from buoyancy_mj.hulls.geoms import find_hulls
from buoyancy_mj.hulls.replicas import find_originals
from buoyancy_mj.hulls.selection import add_geom, join_words, rename_patterns, split_words
from buoyancy_mj.inspection.inspection import inspect_model
from buoyancy_mj.loads.coefficients import Coefficients, add_coefficients
from buoyancy_mj.loads.damping_arrays import resolve_damping
from buoyancy_mj.scenes.catalog import model_path
from buoyancy_mj.scenes.scene import read_scene
from buoyancy_mj.scenes.simulation import Simulation
from buoyancy_mj.settings.config import parse_plugin_config, write_plugin_config
from buoyancy_mj.settings.settings import Settings

# MuJoCo's own, of a suffix alone
pytestmark = pytest.mark.filterwarnings("ignore:Attaching a spec with an empty prefix")

DATA = Path(__file__).parent / "data" / "cases"
ROV = DATA / "attached_fleet" / "rov.xml"
ENVIRONMENT = DATA / "environment_choice"
VOLUME = 0.4 * 0.2 * 0.2 * 0.5
"""Of the ROV's float, half of which floods [m^3]."""
BALL = 4.0 / 3.0 * np.pi * 0.2**3
HULL = 0.4 * 0.2 * 0.2
AFFIXES = [
    ("rov1_", ""),
    ("rov1-", ""),
    ("rov1/", ""),
    ("rov1", ""),
    ("a_b_", ""),
    ("fleet/one/", ""),
    ("", "_1"),
    ("r_", "_s"),
    ("a", "b"),
    ("rov:", ""),
]


def rov(free=True):
    """The ROV of the case, with a free joint."""
    spec = mujoco.MjSpec.from_file(str(ROV))
    if free:
        spec.body("rov").add_freejoint()
    return spec


def attached(*affixes, base="<mujoco/>", read=rov):
    """A spec with a file attached under each pair of a prefix and a suffix, 3 m apart."""
    spec = mujoco.MjSpec.from_string(base)
    for i, (prefix, suffix) in enumerate(affixes):
        frame = spec.worldbody.add_frame(pos=[0.0, 3.0 * i, 0.0])
        spec.attach(read(), prefix=prefix, suffix=suffix, frame=frame)
    return spec


def joined(vehicle, environment, prefix):
    """The vehicle of the case with its environment attached under a prefix."""
    spec = mujoco.MjSpec.from_file(str(ENVIRONMENT / vehicle))
    other = mujoco.MjSpec.from_file(str(ENVIRONMENT / environment))
    spec.attach(other, prefix=prefix, frame=spec.worldbody.add_frame())
    return spec.compile()


def with_custom(custom, body="", more=""):
    """A free box 'hull' with a pod, and whatever `<custom>` says."""
    return mujoco.MjModel.from_xml_string(
        f"""<mujoco><custom>{custom}</custom><worldbody>
        <geom name="rock" type="box" size="1 1 1" pos="0 0 -9"/>
        <body name="hull"><freejoint/><geom name="box" type="box" size=".2 .1 .1" mass="9"/>
          <geom name="pod" size=".05" mass=".1" pos="0 0 .2"/>
          <body name="mast"><geom name="mast" type="box" size=".01 .01 .2" mass=".1"
            contype="0" conaffinity="0" pos="0 .3 0"/></body>{body}</body>{more}
        </worldbody></mujoco>"""
    )


def text(name, data):
    return f'<text name="{name}" data="{data}"/>'


def numeric(name, data="1 1 1 1 1 1"):
    return f'<numeric name="{name}" data="{data}"/>'


def volumes(model, **options):
    """The volume that each hull displaces, by its name."""
    return {hull.name: hull.displaced_volume for hull in find_hulls(model, **options)}


def assert_is_the_rov(model, body):
    """The body displaces by its float, half flooded, with the added mass and damping it states."""
    buoyancy = Buoyancy(model)
    mine = [hull for hull in buoyancy.hulls if hull.body == body]
    assert sum(hull.displaced_volume for hull in mine) == pytest.approx(VOLUME, rel=1e-12)
    (row,) = np.flatnonzero(buoyancy.added_mass.bodies == body)
    assert np.diag(buoyancy.added_mass.matrices[row].reshape(6, 6)) == pytest.approx(
        [20, 30, 40, 1, 1, 1]
    )
    damping = resolve_damping(Damping(), model, buoyancy.hulls, 1000.0)
    (row,) = np.flatnonzero(damping.bodies == body)
    assert damping.quadratic[row] == pytest.approx([50, 80, 90, 3, 3, 3])
    assert damping.linear[row] == pytest.approx(np.zeros(6))


# attached -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(("prefix", "suffix"), AFFIXES)
def test_an_attached_vehicle_keeps_what_its_file_states(prefix, suffix):
    model = attached((prefix, suffix)).compile()
    assert_is_the_rov(model, model.body(f"{prefix}rov{suffix}").id)


AFFIX = st.text(st.sampled_from("abrov01_-/:.[]*? é'"), max_size=6)


@given(prefix=AFFIX, suffix=AFFIX)
def test_so_it_does_under_any_prefix_and_suffix(prefix, suffix):
    model = attached((prefix, suffix)).compile()
    assert_is_the_rov(model, 1)


@pytest.mark.parametrize(
    "pair",
    [
        [("r0_", ""), ("r1_", "")],
        [("r1_", ""), ("r10_", "")],
        [("", "_0"), ("", "_1")],
        [("a", ""), ("ab", "")],
        [("", "a"), ("", "")],
        [("a", ""), ("a", "a")],
        [("r0/", ""), ("r0_", "")],
    ],
)
def test_of_two_attached_vehicles_each_keeps_it(pair):
    model = attached(*pair).compile()
    for prefix, suffix in pair:
        assert_is_the_rov(model, model.body(f"{prefix}rov{suffix}").id)


def test_attaching_twice_nests_prefixes():
    fleet = attached(("one_", ""), ("two_", ""))
    model = attached(("fleet_", "_x"), read=lambda: fleet).compile()
    for name in ("fleet_one_rov_x", "fleet_two_rov_x"):
        assert_is_the_rov(model, model.body(name).id)


def test_so_does_a_body_attached_by_itself():
    spec = mujoco.MjSpec.from_string("<mujoco/>")
    spec.worldbody.add_frame().attach_body(rov().body("rov"), "p_", "_s")
    model = spec.compile()
    assert_is_the_rov(model, model.body("p_rov_s").id)

    spec = mujoco.MjSpec.from_string("<mujoco/>")
    spec.worldbody.add_site(name="dock").attach_body(rov().body("rov"), "p-", "")
    model = spec.compile()
    assert_is_the_rov(model, model.body("p-rov").id)


def test_so_does_a_body_attached_in_mjcf(tmp_path):
    (tmp_path / "rov.xml").write_text(rov().to_xml())
    (tmp_path / "fleet.xml").write_text(
        """<mujoco><asset><model name="rov" file="rov.xml"/></asset><worldbody>
        <frame><attach model="rov" body="rov" prefix="q1_"/></frame>
        <frame pos="0 3 0"><attach model="rov" body="rov" prefix="q2_"/></frame>
        </worldbody></mujoco>"""
    )
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "fleet.xml"))
    for body in (1, 2):
        assert_is_the_rov(model, body)


@pytest.mark.parametrize("count", [1, 3, 12])
@pytest.mark.parametrize("separator", ["", 'sep="-"', 'sep="_"'])
def test_so_do_copies_by_replicate(count, separator):
    xml = (
        rov()
        .to_xml()
        .replace(
            '<body name="rov">',
            f'<replicate count="{count}" offset="3 0 0" {separator}><body name="rov">',
        )
    )
    xml = xml.replace("</body>", "</body></replicate>")
    model = mujoco.MjModel.from_xml_string(xml)
    assert model.nbody == count + 1
    for body in range(1, model.nbody):
        assert_is_the_rov(model, body)
    # and where the file of the copies is attached
    spec = mujoco.MjSpec.from_string("<mujoco/>")
    spec.attach(mujoco.MjSpec.from_string(xml), prefix="p_", frame=spec.worldbody.add_frame())
    model = spec.compile()
    for body in range(1, model.nbody):
        assert_is_the_rov(model, body)


def test_copies_of_an_attached_body_are_its_own_too(tmp_path):
    (tmp_path / "rov.xml").write_text(rov().to_xml())
    (tmp_path / "fleet.xml").write_text(
        """<mujoco><asset><model name="rov" file="rov.xml"/></asset><worldbody>
        <replicate count="2" offset="3 0 0"><frame><attach model="rov" body="rov" prefix="q_"/>
        </frame></replicate></worldbody></mujoco>"""
    )
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "fleet.xml"))
    for body in (1, 2):
        assert_is_the_rov(model, body)


def test_unnamed_geoms_match_under_a_prefix():
    xml = """<mujoco><custom><text name="buoyancy_geoms" data="rov/box*"/></custom><worldbody>
      <geom type="plane" size="1 1 1" pos="0 0 -9"/>
      <body name="rov"><freejoint/><geom size=".1"/><geom type="box" size=".1 .1 .1"/></body>
      </worldbody></mujoco>"""
    model = attached(("p_", ""), ("q/", ""), read=lambda: mujoco.MjSpec.from_string(xml)).compile()
    assert list(volumes(model)) == ["p_rov/box 1", "q/rov/box 1"]


def test_an_unnamed_geom_keeps_its_name_whatever_stands_beside_its_body():
    xml = """<mujoco><custom><text name="buoyancy_geoms" data="'rov/box 1'"/></custom><worldbody>
      <body name="rov"><freejoint/><geom size=".1"/><geom type="box" size=".1 .1 .1"/></body>
      </worldbody></mujoco>"""
    spec = mujoco.MjSpec.from_string(xml)
    assert list(volumes(spec.compile())) == ["rov/box 1"]
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[1, 1, 1], pos=[0, 0, -9])
    assert list(volumes(spec.compile())) == ["rov/box 1"]


def test_a_selection_of_the_user_holds_for_the_whole_model():
    model = attached(("r0_", ""), ("r1_", "")).compile()
    chosen = volumes(model, selection=Selection(geoms="*frame"))
    assert list(chosen) == ["r0_frame", "r1_frame"]
    # it takes the place of the files' own, and what they say of other geoms is moot
    assert volumes(model, selection=Selection(geoms="r0_*", fill="*_a=0.25")) == pytest.approx(
        {"r0_float_a": HULL / 4, "r0_frame": 0.4 * 0.4 * 0.1}
    )


def test_coefficients_do_not_replace_what_an_attached_file_states():
    spec = attached(("r0_", ""))
    of_body = Coefficients(1.0, np.eye(6), np.ones(3))
    add_coefficients(spec, {"r0_rov": of_body})
    model = spec.compile()
    assert_is_the_rov(model, 1)
    assert Buoyancy(model).causes == ("buoyancy", "drag", "radiation", "added_mass")


# vehicles that move alike -------------------------------------------------------------------------

SEA = Water(waves=RegularWave(amplitude=0.1, period=3.0), level=1.0)
PLACES = np.array([[0, 0, -0.5, 1, 0, 0, 0], [40, 3, 0.2, 0.9, 0.3, 0.3, 0.1]])
PLACES[1, 3:] /= np.linalg.norm(PLACES[1, 3:])


def bluerov():
    return mujoco.MjSpec.from_file(str(model_path("bluerov2_heavy")))


def moved(spec, places, how):
    """Poses (n, 7) of free bodies after 300 steps of 4 ms from places (n, 7)."""
    spec.option.timestep = 0.004
    if how == "in the model":
        add_water(spec, SEA)
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qpos[:] = np.ravel(places)
    data.qvel[:] = np.tile([0.3, 0.1, 0.0, 0.2, 0.5, 0.1], len(places))
    if how == "callback":
        with Buoyancy(model, SEA).installed():
            mujoco.mj_step(model, data, 300)
    else:
        mujoco.mj_step(model, data, 300)
    return data.qpos.reshape(-1, 7).copy()


@pytest.mark.parametrize("how", ["callback", "in the model", "attached with it"])
def test_two_attached_bluerovs_move_as_one_alone_does(how):
    def read():
        spec = bluerov()
        if how == "attached with it":
            add_water(spec, SEA)
        return spec

    both = moved(attached(("r0_", ""), ("r1_", ""), read=read), PLACES, how)
    for place, pose in zip(PLACES, both, strict=True):
        (alone,) = moved(bluerov(), [place], "callback" if how == "callback" else "in the model")
        assert pose == pytest.approx(alone, abs=1e-12)
        assert np.abs(pose - place).max() > 0.1


# environments -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("vehicle", "environment", "prefix", "hulls"),
    [
        ("vehicle.xml", "buoys.xml", "environment/", {"hull", "environment/ball"}),
        ("vehicle.xml", "buoys_say.xml", "environment/", {"hull", "environment/ball"}),
        ("vehicle.xml", "buoys_say.xml", "env_", {"hull", "env_ball"}),
        ("vehicle_plain.xml", "buoys_say.xml", "env_", {"hull", "mast", "env_ball"}),
        ("vehicle_plain.xml", "buoys.xml", "env_", {"hull", "mast", "env_ball"}),
    ],
)
def test_the_words_of_a_vehicle_and_of_its_environment_hold_for_their_own(
    vehicle, environment, prefix, hulls
):
    model = joined(vehicle, environment, prefix)
    found = volumes(model)
    assert {name for hull in found for name in hull.split(" + ")} == hulls
    assert found[f"{prefix}ball"] == pytest.approx(BALL, rel=1e-3)
    added_mass = Buoyancy(model).added_mass
    assert added_mass.bodies.tolist() == ([2] if environment == "buoys_say.xml" else [])


def test_buoys_beside_a_vehicle_that_chooses_stay_afloat():
    model = joined("vehicle.xml", "buoys.xml", "environment/")
    data = mujoco.MjData(model)
    with Buoyancy(model).installed():
        mujoco.mj_step(model, data, 3000)
    # less than half of the ball displaces its 10 kg
    assert 0.0 < data.body("environment/gate").xpos[2] < 0.2


def test_a_body_that_the_words_of_a_file_leave_out_is_told():
    model = joined("vehicle.xml", "buoys.xml", "env_")
    with pytest.warns(BuoyancyWarning) as told:
        assert list(volumes(model)) == ["hull"]
    assert [str(warning.message) for warning in told] == [
        "'buoyancy_geoms' names no geom of 'env_gate', which would displace water without it: "
        "name their geoms there, with '!' before them if they shall displace nothing, or attach "
        "them under a prefix that ends in '/' if they come from another file"
    ]


def test_a_word_with_an_exclamation_mark_leaves_geoms_out_without_a_notice():
    arm = (
        '<body name="arm"><joint/><geom name="arm" type="box" size=".1 .01 .01" mass=".1"/></body>'
    )
    model = with_custom(text("buoyancy_geoms", "!arm box !pod p*"), arm)
    # the last word would choose the pod again; what is left out stays out
    assert list(volumes(model)) == ["box"]
    assert list(volumes(model, selection=Selection(geoms="* !m* !p*"))) == ["box", "arm"]
    # without other words, it is taken out of the default
    assert list(volumes(with_custom(text("buoyancy_geoms", "!pod"), arm))) == ["box", "mast", "arm"]
    assert list(volumes(model, selection=Selection(geoms="!mast"))) == ["box", "pod", "arm"]
    with pytest.raises(ModelError, match="the words that choose geoms leave out all; name one of"):
        volumes(model, selection=Selection(geoms="* !*"))
    with pytest.raises(ModelError, match="no moving geom matches 'keel' of 'buoyancy_geoms'"):
        volumes(with_custom(text("buoyancy_geoms", "box pod !keel")))


def test_a_slash_that_a_file_names_itself_is_its_own():
    xml = """<mujoco><custom>{}</custom><worldbody>
      <body name="cat/port"><freejoint/><geom name="cat/hull" type="box" size=".2 .1 .1"/>
        <geom name="cat/rail" size=".05" pos="0 0 .2"/></body></worldbody></mujoco>"""
    for words in ("cat/hull", "*hull", "c*/h*", "* !cat/rail"):
        model = mujoco.MjModel.from_xml_string(xml.format(text("buoyancy_geoms", words)))
        assert list(volumes(model)) == ["cat/hull"]
    # as a file that was attached and says so itself
    model = mujoco.MjModel.from_xml_string(xml.format(text("cat/buoyancy_geoms", "hull")))
    assert list(volumes(model)) == ["cat/hull"]


def test_inspection_says_which_text_chose():
    model = attached(("r0_", "")).compile()
    verdicts = {geom.name: geom.reason for geom in inspect_model(model).geoms}
    assert verdicts == {
        "r0_float_a": "chosen by the model's 'r0_buoyancy_geoms': float*",
        "r0_frame": "not among those chosen",
    }


def scene_in(folder, environment, **texts):
    """A scene of the vehicle of the case; `texts` are files for its folder."""
    for name, content in texts.items():
        (folder / f"{name}.xml").write_text(content)
    (folder / "scene.toml").write_text(
        f"""title = "sea"
        vehicle = "{ENVIRONMENT / "vehicle.xml"}"
        environment = "{environment}"
        duration = 0.1
        """
    )
    return Simulation(read_scene(folder / "scene.toml"))


@pytest.mark.parametrize("environment", ["buoys.xml", "buoys_say.xml"])
def test_in_a_scene_each_file_chooses_for_its_own(tmp_path, environment):
    simulation = scene_in(tmp_path, ENVIRONMENT / environment)
    assert [hull.name for hull in simulation.buoyancy.hulls] == ["hull", "environment/ball"]
    list(simulation.frames())


def test_the_water_of_an_environment_gives_way_to_the_scenes(tmp_path):
    spec = mujoco.MjSpec.from_file(str(ENVIRONMENT / "buoys.xml"))
    add_water(spec, Water(density=500.0))
    with pytest.warns(BuoyancyWarning, match="the water 'sea' of the model gives way to the scene"):
        simulation = scene_in(tmp_path, "own.xml", own=spec.to_xml())
    assert [hull.name for hull in simulation.buoyancy.hulls] == ["hull", "environment/ball"]
    list(simulation.frames())


# words that find nothing --------------------------------------------------------------------------

POSSIBLE = (
    "possible: added_mass:BODY, buoyancy_fill, buoyancy_geoms, buoyancy_hull, foil:NAME, "
    "linear_damping:BODY, quadratic_damping:BODY, radiation_damping:BODY"
)
PART = "if only a part of its file was attached, delete the word from the spec before that"
WRONG = [
    (
        numeric("added_masss:hull"),
        "the numeric 'added_masss:hull' is none that water reads; "
        f"did you mean 'added_mass:BODY'? {POSSIBLE}",
    ),
    (
        numeric("added_mass"),
        "the numeric 'added_mass' is none that water reads; "
        f"did you mean 'added_mass:BODY'? {POSSIBLE}",
    ),
    (
        numeric("added_mass_hull"),
        "the numeric 'added_mass_hull' is none that water reads; "
        f"did you mean 'added_mass:BODY'? {POSSIBLE}",
    ),
    (
        numeric("linear_damping.hull"),
        "the numeric 'linear_damping.hull' is none that water reads; "
        f"did you mean 'linear_damping:BODY'? {POSSIBLE}",
    ),
    (
        text("bouyancy_geoms", "box"),
        "the text 'bouyancy_geoms' is none that water reads; "
        f"did you mean 'buoyancy_geoms'? {POSSIBLE}",
    ),
    (
        text("buoyancy_geom", "box"),
        "the text 'buoyancy_geom' is none that water reads; "
        f"did you mean 'buoyancy_geoms'? {POSSIBLE}",
    ),
    (
        text("added_mass:hull", "1 1 1 1 1 1"),
        "'added_mass:hull' is a <text> and is read only as a <numeric>; make it one",
    ),
    (
        numeric("buoyancy_geoms", "1"),
        "'buoyancy_geoms' is a <numeric> and is read only as a <text>; make it one",
    ),
    (
        '<tuple name="buoyancy_fill"><element objtype="body" objname="hull" prm=".5"/></tuple>',
        "'buoyancy_fill' is a <tuple> and is read only as a <text>; make it one",
    ),
    (
        numeric("added_mass:hul"),
        "added mass is given for body 'hul', which the model does not have; "
        "did you mean 'hull'? possible: hull",
    ),
    (
        numeric("radiation_damping:mast", "1 1 1"),
        "radiation damping is given for body 'mast', which moves with body 'hull'; "
        "give it for that one",
    ),
    (
        numeric("quadratic_damping:world"),
        "quadratic damping is given for body 'world', which cannot move; possible: hull",
    ),
    (
        numeric("linear_damping:bare"),
        "linear damping is given for body 'bare', which has no hull of its own; possible: hull",
    ),
    (
        text("buoyancy_geoms", " "),
        "the text 'buoyancy_geoms' is empty; give it name globs or group:N, or remove it",
    ),
    (
        text("buoyancy_geoms", "bow"),
        "no moving geom matches 'bow' of 'buoyancy_geoms'; did you mean 'box'? "
        "possible: box, group:0, mast, pod",
    ),
    (
        text("buoyancy_geoms", "rock"),
        "no moving geom matches 'rock' of 'buoyancy_geoms' "
        "('rock' does, but its body cannot move); "
        "possible: box, group:0, mast, pod",
    ),
    (
        text("buoyancy_fill", "mast=0.1") + text("buoyancy_geoms", "box"),
        "no moving geom matches 'mast' of 'buoyancy_fill' "
        "('mast' does, but it displaces nothing); possible: box, group:0",
    ),
    (
        text("buoyancy_hulls", "convex"),
        "the text 'buoyancy_hulls' is none that water reads; "
        f"did you mean 'buoyancy_hull'? {POSSIBLE}",
    ),
    (
        numeric("rov:aded_mass:hull"),
        "the numeric 'rov:aded_mass:hull' is none that water reads; "
        f"did you mean 'added_mass:BODY'? {POSSIBLE}",
    ),
    (
        text("my_buoyancy_geoms", "box"),
        f"no moving geom matches 'box' of 'my_buoyancy_geoms'; possible: nothing; {PART}",
    ),
    (
        text("buoyancy_hull_1", "convex"),
        f"no moving geom matches '*' of 'buoyancy_hull_1'; possible: nothing; {PART}",
    ),
    (
        text("buoyancy_geoms", "&quot;box"),
        "the text 'buoyancy_geoms' is '\"box', whose quote is not closed; close it, "
        "or put a name with a quote in it between quotes of the other kind",
    ),
]


@pytest.mark.parametrize(("custom", "message"), WRONG)
def test_what_a_file_states_and_finds_nothing_is_refused(custom, message):
    bare = '<body name="bare"><joint/><inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/></body>'
    model = with_custom(custom, bare)
    for refuse in (Buoyancy, inspect_model):
        with pytest.raises(ModelError) as error:
            refuse(model)
        assert str(error.value) == message


@pytest.mark.parametrize("prefix", ["p_", "p/"])
def test_so_it_is_under_a_prefix(prefix):
    def refused(before, after):
        xml = rov().to_xml().replace(before, after)
        model = attached((prefix, ""), read=lambda: mujoco.MjSpec.from_string(xml)).compile()
        with pytest.raises(ModelError) as error:
            Buoyancy(model)
        return str(error.value)

    assert refused("added_mass:rov", "added_mass:row") == (
        f"added mass is given for body '{prefix}row', which the model does not have; "
        f"did you mean '{prefix}rov'? possible: {prefix}rov; {PART}"
    )
    assert refused('data="float*"', 'data="flaot*"') == (
        f"no moving geom matches 'flaot*' of '{prefix}buoyancy_geoms'; "
        f"did you mean 'float_a'? possible: float_a, frame, group:0; {PART}"
    )
    assert refused("buoyancy_fill", "buoyancy_fills").startswith(
        f"the text '{prefix}buoyancy_fills' is none that water reads; did you mean 'buoyancy_fill'"
    )
    assert refused("added_mass:", "added_mass_").startswith(
        f"the numeric '{prefix}added_mass_rov' is none that water reads; did you mean 'added_mass:B"
    )
    assert refused("added_mass:", "aded_mass:").startswith(
        f"the numeric '{prefix}aded_mass:rov' is none that water reads; did you mean 'added_mass:B"
    )


def test_a_number_is_given_once_for_a_body():
    spec = attached(("p_", ""))
    spec.add_numeric(name="added_mass:p_rov", data=[1.0] * 6, size=6)
    with pytest.raises(
        ModelError,
        match="'p_added_mass:rov' and 'added_mass:p_rov' both give the added mass of body 'p_rov'; "
        "remove one of them",
    ):
        Buoyancy(spec.compile())


@pytest.mark.parametrize(
    "name",
    [
        "max_depth", "thruster_gain:hull", "buoyancy_centre", "mass:hull", "damping", "_", "a:b",
        ":", "inertia:hull", "cfd_added_mass", "nav/goal:1",
    ],
)  # fmt: skip
def test_custom_names_of_other_people_are_left_alone(name):
    for custom in (text(name, "anything"), numeric(name)):
        assert volumes(with_custom(custom)) == volumes(with_custom(""))


# a pattern and its words --------------------------------------------------------------------------


def test_a_word_of_a_sequence_is_whole_and_a_text_splits():
    xml = """<mujoco><custom>{}</custom><worldbody><body><freejoint/>
      <geom name="my hull" type="box" size=".2 .1 .1"/><geom name="a,b" size=".05" pos="0 0 .2"/>
      <geom name="pod" size=".05" pos="0 0 .4"/></body></worldbody></mujoco>"""
    plain = mujoco.MjModel.from_xml_string(xml.format(""))
    chosen = {
        ("my hull",): ["my hull"],
        "'my hull', pod": ["my hull", "pod"],
        "pod,'a,b'": ["a,b", "pod"],
        '"my hull"': ["my hull"],
        ("a,b", "p*"): ["a,b", "pod"],
        "my' 'hull": ["my hull"],
    }
    for patterns, names in chosen.items():
        selection = Selection(geoms=patterns)
        assert list(volumes(plain, selection=selection)) == names
        # the plugin keeps them
        settings = Settings(selection=selection)
        assert parse_plugin_config(write_plugin_config(settings), "here") == settings

    said = mujoco.MjModel.from_xml_string(
        xml.format(
            text("buoyancy_geoms", "'my hull' 'a,b'") + text("buoyancy_fill", "'my hull=0.5'")
        )
    )
    assert volumes(said)["my hull"] == pytest.approx(HULL / 2)
    with pytest.raises(ModelError, match="no moving geom matches 'my'"):
        volumes(plain, selection=Selection(geoms="my hull"))


def test_the_advised_choice_of_convex_hulls_is_one_flag_for_each_pattern():
    model = with_custom("", '<geom name="bob\'s tail" size=".05" pos="0 0 -.2" mass=".1"/>')
    geoms = [model.geom("box").id, model.geom("bob's tail").id]
    assert describe_convex_choice(model, geoms, geoms) == (
        "--hull 'box=convex' --hull 'bob?s?tail=convex', "
        "in Python Selection(hull='box=convex bob?s?tail=convex'), "
        'in MJCF <text name="buoyancy_hull" data="box=convex bob?s?tail=convex"/>'
    )


@given(st.lists(st.text(min_size=1).filter(str.strip), min_size=1))
def test_words_joined_to_a_text_split_again(words):
    assert split_words(join_words(words), "words") == tuple(words)


@pytest.mark.parametrize("field", ["geoms", "hull", "fill"])
@pytest.mark.parametrize("value", [5, b"hull", [["hull"]], [b"hull"], {"hull": 1}, [None], True])
def test_patterns_are_texts(field, value):
    with pytest.raises(ModelError) as error:
        Selection(**{field: value})
    assert str(error.value) == (
        f"{field} is {value!r}; it must be a pattern, as 'hull*', or a list of patterns"
    )


@pytest.mark.parametrize("value", [[], "", " ", ["hull", ""], ()])
def test_an_empty_pattern_is_refused(value):
    with pytest.raises(ModelError) as error:
        Selection(geoms=value)
    assert str(error.value) == (
        "an empty choice of geoms displaces nothing; give name globs or group:N, or leave it out"
    )


@pytest.mark.parametrize("source", [True, 5, ["model"], np.eye(6), b"model", "modl"])
def test_a_source_of_added_mass_of_another_kind_is_refused(source):
    with pytest.raises(
        ModelError,
        match=r"^added mass is .*; .*possible: ellipsoid, estimate, mesh, model, none, or",
    ):
        Buoyancy(with_custom(""), added_mass=source)
    with pytest.raises(
        ModelError, match=r"added mass is given for body 1; a body's name is a text"
    ):
        Buoyancy(with_custom(""), added_mass={1: np.ones(6)})


def test_originals_of_copies_begin_at_zero_and_are_not_there():
    assert dict(find_originals(["rov0", "rov1"])) == {"rov0": ("rov",), "rov1": ("rov",)}
    assert dict(find_originals(["rov1", "rov2"])) == {"rov1": (), "rov2": ()}
    assert dict(find_originals(["rov", "rov0"])) == {"rov": (), "rov0": ()}
    assert "rov" in find_originals(["rov-00", "rov-10", "rov-01", "rov-11"])["rov-10"]
    assert dict(find_originals(["", "rover"])) == {"rover": ()}


def test_a_geom_is_added_to_the_choice_of_a_file_by_its_name():
    assert add_geom("hull* 'my pod'", "foam [1]") == "hull* 'my pod' 'foam [[]1]'"
    assert add_geom("!mast", "foam") == "!mast"


def test_a_selection_follows_its_water_under_a_prefix():
    selection = Selection(geoms="hull* group:2 !h?m", hull="convex", fill=["a", "b=0.5", "0.1"])
    renamed = rename_patterns(selection, "r[1]_", "_s")
    assert renamed == Selection(
        geoms=["r[[]1]_hull*_s", "group:2", "!r[[]1]_h?m_s"],
        hull=["convex"],
        fill=["a", "r[[]1]_b_s=0.5", "0.1"],
    )


# water that is attached ---------------------------------------------------------------------------

BUOY = """<mujoco><worldbody><body name="buoy" pos="9 0 0"><freejoint/><geom name="ball" size=".2"
  mass="10"/></body></worldbody></mujoco>"""


def wet(water=None, **options):
    """The ROV, which brings its own water."""
    spec = rov()
    add_water(spec, water, **options)
    return spec


@pytest.mark.parametrize(("prefix", "suffix"), AFFIXES)
def test_a_water_stays_where_its_model_is_attached(prefix, suffix):
    model = attached((prefix, suffix), base=BUOY, read=lambda: wet(Water(density=1025.0))).compile()
    water = water_in(model, f"{prefix}sea{suffix}")
    assert water.water.density == 1025.0
    # the buoy of the other file is in no water
    assert [hull.name for hull in water.hulls] == [f"{prefix}float_a{suffix}"]
    data = mujoco.MjData(model)
    data.body(f"{prefix}rov{suffix}").xpos[2] = 0.0
    mujoco.mj_forward(model, data)
    assert water.loads(data).total.force[2] == pytest.approx(1025.0 * 9.81 * VOLUME / 2, rel=1e-9)
    assert data.qfrc_passive[2] == pytest.approx(0.0)


def test_a_water_stays_where_a_body_is_attached_by_itself():
    spec = mujoco.MjSpec.from_string(BUOY)
    spec.worldbody.add_frame().attach_body(wet().body("rov"), "p_", "")
    assert [hull.name for hull in water_in(spec.compile()).hulls] == ["p_float_a"]


def test_the_choice_of_geoms_in_a_water_is_attached_with_it():
    def read():
        return wet(selection=Selection(geoms="f*", fill="frame=0.1 float*=1"))

    model = attached(("p_", ""), ("q_", "_s"), read=read).compile()
    for name, prefix, suffix in (("p_sea", "p_", ""), ("q_sea_s", "q_", "_s")):
        hulls = {hull.name: hull.displaced_volume for hull in water_in(model, name).hulls}
        assert hulls == pytest.approx(
            {f"{prefix}float_a{suffix}": HULL, f"{prefix}frame{suffix}": 0.0016}
        )


def test_bodies_that_come_later_are_in_the_water_too():
    spec = wet()
    buoy = mujoco.MjSpec.from_string(BUOY)
    spec.attach(buoy, prefix="b_", frame=spec.worldbody.add_frame())
    late = spec.worldbody.add_body(name="late", pos=[0, 9, 0])
    late.add_freejoint()
    late.add_geom(name="late", size=[0.1, 0, 0], mass=1.0)
    names = ["float_a", "b_ball", "late"]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", BuoyancyWarning)
        text = next(text for text in spec.texts if text.name == "buoyancy_geoms")
        text.data = "float* b_* late"
        assert [hull.name for hull in water_in(spec.compile()).hulls] == names
        # the saved model has the water of all of them
        saved = mujoco.MjModel.from_xml_string(spec.to_xml())
        assert [hull.name for hull in water_in(saved).hulls] == names
        # and under a prefix they take along their own
        other = mujoco.MjSpec.from_string("<mujoco/>")
        other.attach(spec, prefix="p_", frame=other.worldbody.add_frame())
        hulls = water_in(other.compile()).hulls
        assert [hull.name for hull in hulls] == [f"p_{name}" for name in names]


def test_bodies_that_joined_before_are_alone_in_the_water():
    spec = mujoco.MjSpec.from_file(str(ENVIRONMENT / "buoys.xml"))
    spec.attach(rov(), prefix="p_", frame=spec.worldbody.add_frame())
    plugin = spec.body("gate").plugin
    plugin.active, plugin.plugin_name, plugin.name = True, PLUGIN, "sea"
    add_water(spec)
    assert [hull.name for hull in water_in(spec.compile()).hulls] == ["ball"]


def test_an_attached_water_and_that_of_the_base_share_the_bodies():
    spec = mujoco.MjSpec.from_string(BUOY)
    add_water(spec)
    spec.attach(wet(), prefix="p_", frame=spec.worldbody.add_frame())
    model = spec.compile()
    assert [hull.name for hull in water_in(model, "sea").hulls] == ["ball"]
    assert [hull.name for hull in water_in(model, "p_sea").hulls] == ["p_float_a"]
    with pytest.raises(
        ModelError,
        match="the model has 2 waters of its own; name one of them; possible: p_sea, sea",
    ):
        water_in(model)


def test_each_of_two_waters_reads_what_the_file_states_of_its_own_bodies():
    spec = mujoco.MjSpec.from_file(str(ENVIRONMENT / "buoys_say.xml"))
    spec.attach(rov(), prefix="p_", frame=spec.worldbody.add_frame())
    add_water(spec, instance="sea")
    add_water(spec, Water(density=900.0), instance="oil")
    spec.body("gate").plugin.name = "oil"
    model = spec.compile()
    for name, hull, body in (("oil", "ball", "gate"), ("sea", "p_float_a", "p_rov")):
        water = water_in(model, name)
        assert [one.name for one in water.hulls] == [hull]
        assert water.added_mass.bodies.tolist() == [model.body(body).id]


def test_two_waters_over_one_body_are_refused():
    spec = wet()
    add_water(spec, instance="lake")
    with pytest.raises(ValueError, match="no body that moves is in the water 'lake'; let one join"):
        spec.compile()

    instances = '<instance name="a"/><instance name="b"/>'
    xml = BUOY.replace(
        "<worldbody>",
        f'<extension><plugin plugin="{PLUGIN}">{instances}</plugin></extension><worldbody>',
    )
    with pytest.raises(
        ValueError,
        match="body 'buoy' is in the waters 'a' and 'b'; let each body join one of them, "
        "as by <plugin instance='a'/>, or remove one",
    ):
        mujoco.MjModel.from_xml_string(xml)


@pytest.mark.parametrize(
    ("fill", "lost", "by"),
    [
        (["hull=0.5", "hull=0.6"], "hull=0.5", "hull=0.6"),
        (["hull=0.5", "0.6"], "hull=0.5", "0.6"),
    ],
)
def test_a_fill_that_later_ones_leave_no_geom_is_refused(fill, lost, by):
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><worldbody><body><freejoint/>
             <geom name="hull" type="box" size="0.2 0.1 0.1" mass="4"/>
             <geom name="pod" type="box" size="0.1 0.1 0.1" pos="0 0 -0.5" mass="1"/>
           </body></worldbody></mujoco>"""
    )
    with pytest.raises(ModelError) as caught:
        Buoyancy(model, selection=Selection(fill=fill))
    assert str(caught.value) == (
        f"fill '{lost}' holds for no geom, since '{by}' after it names the same; "
        "leave one of them out"
    )
    general_first = Buoyancy(model, selection=Selection(fill=["0.6", "hull=0.5"]))
    assert [hull.fill for hull in general_first.hulls] == [0.5, 0.6]
