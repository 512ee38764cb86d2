"""What devices mean by a name, also where their file was attached to another."""

import mujoco
import pytest

from buoyancy_mj import ModelError
from buoyancy_mj.hulls.references import find_by_last_word, find_named

SITE = mujoco.mjtObj.mjOBJ_SITE


def named(*names):
    """A model with sites of some names."""
    sites = "".join(f'<site name="{name}"/>' for name in names)
    return mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{sites}</worldbody></mujoco>")


@pytest.mark.parametrize(
    ("names", "owner", "found"),
    [
        (("beacon",), "dvl", "beacon"),
        (("beacon", "rov/beacon"), "rov/dvl", "rov/beacon"),
        (("beacon", "rov/beacon"), "dvl", "beacon"),
        (("beacon", "other/beacon"), "rov/dvl", "beacon"),
        (("fleet/beacon", "fleet/rov/beacon", "beacon"), "fleet/rov/dvl", "fleet/rov/beacon"),
        (("beacon_1", "beacon_2"), "dvl_2", "beacon_2"),
        (("a_beacon_1", "a_beacon_2", "beacon"), "a_dvl_2", "a_beacon_2"),
        (("dbeacon", "beacon"), "dvl", "beacon"),
        (("xbeacon", "ybeacon"), "ydvl", "ybeacon"),
        (("beacon", "rov/beacon"), "", "beacon"),
    ],
)
def test_the_nearest_of_a_name_is_meant(names, owner, found):
    model = named(*names)
    assert model.site(find_named(model, SITE, "beacon", owner)).name == found


def test_a_whole_name_may_be_stated():
    model = named("a/beacon", "b/beacon")
    assert model.site(find_named(model, SITE, "a/beacon", "b/dvl")).name == "a/beacon"


@pytest.mark.parametrize("affixes", [{"prefix": "rov/"}, {"suffix": "_2"}])
def test_what_was_attached_is_meant_by_what_was_attached(affixes):
    child, parent = mujoco.MjSpec(), mujoco.MjSpec()
    for name in ("dvl", "beacon"):
        child.worldbody.add_site(name=name)
    parent.worldbody.add_site(name="beacon")
    parent.attach(child, frame=parent.worldbody.add_frame(), **affixes)
    model = parent.compile()
    # MuJoCo puts a slash before names that are to have a suffix alone
    (owner,) = (model.site(i).name for i in range(3) if "dvl" in model.site(i).name)
    found = model.site(find_named(model, SITE, "beacon", owner)).name
    assert found == owner.replace("dvl", "beacon")


@pytest.mark.parametrize("names", [("other/beacon",), ()])
def test_what_is_not_there_is_an_error_that_says_what_is(names):
    model = named(*names)
    possible = ", ".join(names) or "nothing"
    with pytest.raises(ModelError) as caught:
        find_named(model, SITE, "beacon", "rov/dvl")
    hint = "did you mean 'other/beacon'? " if names else ""
    assert str(caught.value) == (
        f"the model has no site named 'beacon'; {hint}possible: {possible}"
    )


def test_a_name_that_nobody_stated_is_found_under_any_prefix():
    model = named("arena/pinger", "x")
    assert find_by_last_word(model, SITE, "pinger", "rov/dvl") == 0
    assert find_by_last_word(model, SITE, "beacon", "rov/dvl") == -1
