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


def test_an_option_that_there_is_not_is_refused_by_name():
    with pytest.raises(TypeError, match="unexpected keyword argument 'geom'"):
        Buoyancy(vessels.box(), geom="hull*")


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
