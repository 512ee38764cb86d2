"""Options stand in one place, and are the same wherever they are given."""

import dataclasses
import inspect
import typing

import mujoco
import pytest

import buoyancy_mj
from buoyancy_mj import (
    Buoyancy,
    Damping,
    JonswapSea,
    MethodError,
    Panels,
    RegularWave,
    Scene,
    Sections,
    Selection,
    Settings,
    Silhouette,
    Simulation,
    Water,
    add_water,
    read_scene,
    water_in,
)
from buoyancy_mj.records import field_docs
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.scene import KEYS
from buoyancy_mj.settings import config
from buoyancy_mj.settings.settings import PRESSURES, Options
from tests import vessels

PUBLIC_DATACLASSES = [
    value
    for value in vars(buoyancy_mj).values()
    if isinstance(value, type) and dataclasses.is_dataclass(value)
]


def fields(cls):
    return [field.name for field in dataclasses.fields(cls)]


def test_keyword_arguments_are_the_fields_of_settings():
    assert ["water", *typing.get_type_hints(Options)] == fields(Settings)


def test_a_scene_and_the_plugin_have_every_field_of_settings_as_a_key():
    own = [name for name in fields(Settings) if name not in ("water", "selection")]
    chosen = fields(Selection)
    assert set(KEYS) >= {*own, *chosen, "water"}
    assert set(config.KEYS) == {*own, *chosen, *fields(Water)}


def test_settings_and_keyword_arguments_make_the_same_water():
    model, water = vessels.box(), Water(density=1025.0)
    options = {"method": "sections", "damping": Damping(radiation=False)}
    settings = Settings(water=water, method=Sections(), damping=Damping(radiation=False))
    assert Buoyancy(model, water, **options).settings == settings
    assert Buoyancy(model, settings).settings == settings
    assert Buoyancy(model, Settings(water=water), **options).settings == settings


def test_an_option_that_there_is_not_is_refused_with_those_that_there_are():
    for name in ("drag", "geoms"):
        with pytest.raises(
            TypeError, match=f"there is no option '{name}'; possible: added_mass, damping, method"
        ):
            Buoyancy(vessels.box(), **{name: "hull*"})


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"damping": Panels()}, r"damping is Panels\(.*; it must be Damping\(viscous="),
        ({"damping": True}, r"damping is True; it must be Damping\(viscous="),
        ({"selection": "hull*"}, r"selection is 'hull\*'; it must be Selection\(geoms="),
        ({"selection": None}, r"selection is None; it must be Selection\(geoms="),
    ],
)
def test_a_value_of_another_kind_is_refused(options, message):
    with pytest.raises(buoyancy_mj.ModelError, match=message):
        Settings(**options)
    with pytest.raises(buoyancy_mj.ModelError, match=message):
        Buoyancy(vessels.box(), **options)
    with pytest.raises(buoyancy_mj.ModelError, match=message):
        dataclasses.replace(read_scene(catalog.scenes()["auv_waves"]), **options)


@pytest.mark.parametrize("water", [1025.0, [], "sea", RegularWave(0.1, period=3.0)])
def test_what_is_no_water_is_refused(water):
    with pytest.raises(buoyancy_mj.WaterError, match="it must be a Water, as Water"):
        Buoyancy(vessels.box(), water)


def test_a_water_that_is_more_than_its_text_does_not_fit_into_a_model():
    class Murky(Water):
        """A water of somebody's own."""

    spec = mujoco.MjSpec.from_file(str(catalog.models()["hourglass"]))
    with pytest.raises(buoyancy_mj.WaterError, match="cannot be written into a model"):
        add_water(spec, Murky())


def test_the_keys_of_damping_are_listed_with_the_kinds():
    with pytest.raises(
        buoyancy_mj.SceneError,
        match="unknown key 'panels'; possible: coefficient, kind, linear_froude, radiation, "
        "where kind is one of silhouette, panels, none",
    ):
        read_scene(catalog.scenes()["auv_waves"], ["damping.panels=true"])


def test_a_model_without_water_says_how_to_get_one():
    with pytest.raises(
        buoyancy_mj.ModelError, match=r"no water of its own: add_water\(spec, water"
    ):
        water_in(vessels.box())


def test_a_class_of_somebodys_own_may_have_attributes_of_its_own():
    class Counting(Buoyancy):
        def __init__(self, model):
            super().__init__(model)
            self.count = 0

    buoyancy = Counting(vessels.box())
    buoyancy.count += 1
    with pytest.raises(AttributeError, match="'water' of a Counting cannot be changed"):
        buoyancy.water = Water()


def test_one_pattern_is_a_list_of_one():
    assert Selection(geoms="hull*") == Selection(geoms=["hull*"]) == Selection(geoms=("hull*",))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"pressure": "linear"}, "pressure is 'linear'; possible: archimedes, froude-krylov"),
        ({"method": "monte_carlo"}, "unknown method 'monte_carlo'; possible: convex_hull"),
        (
            {"pressure": PRESSURES[1], "method": "sections"},
            "pressure 'hydrostatic' needs the method 'exact', not 'sections'",
        ),
        (
            {"damping": Damping(viscous=Panels()), "method": "sections"},
            "drag by panels needs the method 'exact', not 'sections'",
        ),
    ],
)
def test_settings_that_contradict_each_other_are_refused(options, message):
    with pytest.raises(MethodError, match=message):
        Settings(**options)
    with pytest.raises(MethodError, match=message):
        Buoyancy(vessels.box(), **options)


def test_water_of_a_spec_is_not_read_back_from_its_text():
    water = Water(waves=JonswapSea(significant_height=0.3, peak_period=3.5))
    spec = mujoco.MjSpec.from_file(str(catalog.models()["hourglass"]))
    add_water(spec, water, damping=Damping(viscous=Silhouette(coefficient=0.9)))
    model = spec.compile()
    assert water_in(model).water is water


def test_matrices_of_added_mass_do_not_fit_into_a_model_s_text():
    spec = mujoco.MjSpec.from_file(str(catalog.models()["hourglass"]))
    with pytest.raises(buoyancy_mj.ModelError, match="give it there as numerics 'added_mass:BODY'"):
        add_water(spec, added_mass={"hourglass": [1.0, 1.0, 1.0, 0.1, 0.1, 0.1]})


def test_what_would_change_nothing_cannot_be_assigned():
    buoyancy = Buoyancy(vessels.box())
    for name in ("water", "settings", "hulls", "gravity", "no_such_thing"):
        with pytest.raises(
            AttributeError, match=r"make another Buoyancy\(model, water, ...\)|setter"
        ):
            setattr(buoyancy, name, None)
    with pytest.raises(AttributeError, match="'water' of a Buoyancy cannot be changed"):
        del buoyancy.water
    simulation = Simulation(read_scene(catalog.scenes()["hourglass_drop_still"]))
    with pytest.raises(AttributeError, match="make another Simulation of a changed scene"):
        simulation.scene = None


@pytest.mark.parametrize("cls", PUBLIC_DATACLASSES, ids=lambda cls: cls.__name__)
def test_help_shows_every_field_of_a_public_dataclass_with_its_docstring(cls):
    docs, text = field_docs(cls), inspect.getdoc(cls)
    for field in dataclasses.fields(cls):
        if field.init and not field.name.startswith("_"):
            assert docs.get(field.name), f"{cls.__name__}.{field.name} has no docstring"
            assert f"    {field.name}: " in text


def test_a_scene_has_the_fields_of_its_settings():
    assert issubclass(Scene, Settings)
    assert field_docs(Scene)["pressure"] == field_docs(Settings)["pressure"]
