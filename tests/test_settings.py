"""Options stand in one place, and are the same wherever they are given."""

import dataclasses
import inspect
import math
import typing

import mujoco
import numpy as np
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
from buoyancy_mj.settings.texts import parse_value
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
        match="unknown key 'panels'; possible: coefficient, friction, kind, linear_froude, "
        "radiation, where kind is one of silhouette, panels, none",
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


class Swell:
    """A wave of somebody's own: a level that is 0.1 m higher at time 0."""

    def __init__(self, depth=math.inf, width=6):
        self.rows = np.array([[0.1, 0.0, 0.0, 2.0, 0.0, depth]])[:, :width]


@pytest.mark.parametrize(
    "options",
    [
        {"water": Water(waves=Swell())},
        {"added_mass": {"hourglass": [1.0, 1.0, 1.0, 0.1, 0.1, 0.1]}},
    ],
)
def test_a_simulation_runs_with_what_no_model_can_hold(options):
    scene = read_scene(catalog.scenes()["hourglass_drop_still"], ["duration=0.05"])
    simulation = Simulation(dataclasses.replace(scene, **options))
    for frame in simulation.frames():
        assert np.isfinite(frame.draft)
    for name, value in options.items():
        assert getattr(simulation.buoyancy.settings, name) is value


@pytest.mark.parametrize(
    ("wave", "message"),
    [
        (Swell(width=5), r"of shape \(1, 5\); it must be numbers of shape \(n, 6\)"),
        (Swell(depth=0.0), "hold a depth of 0; it must be above 0"),
        (RegularWave, "RegularWave'> is no wave; possible are RegularWave"),
    ],
)
def test_a_wave_of_somebodys_own_is_checked_at_once(wave, message):
    with pytest.raises(buoyancy_mj.WaterError, match=message):
        Water(waves=[wave])


def test_no_damping_is_one_thing_however_it_is_said():
    scene = catalog.scenes()["auv_waves"]
    for text in ("none", "false", '{kind="none"}'):
        assert read_scene(scene, [f"damping={text}"]).damping is None
    for text in ("none", "false"):
        assert config.parse_plugin_config({"damping": text}, "here").damping is None
    radiation = Damping(viscous=None)
    assert read_scene(scene, ['damping={kind="none", radiation=true}']).damping == radiation
    for damping in (None, radiation, Damping(viscous=None, radiation=False), Damping()):
        texts = config.write_plugin_config(Settings(damping=damping))
        assert config.parse_plugin_config(texts, "here").damping == damping


def test_numbers_of_numpy_are_numbers_and_truths_are_truths():
    damping = Damping(viscous=Silhouette(coefficient=np.float32(0.5)), radiation=np.bool_(False))
    assert damping == Damping(viscous=Silhouette(coefficient=0.5), radiation=False)
    assert damping.radiation is False
    water = Water(density=np.int64(1025), waves=JonswapSea(0.5, np.float32(4.0), seed=np.int32(7)))
    assert water == Water(density=1025.0, waves=JonswapSea(0.5, 4.0, seed=7))
    for value in (True, np.bool_(True), 1j, "1", None, np.array([1.0]), 10**400, np.nan):
        with pytest.raises(buoyancy_mj.WaterError, match=r"density is .*; it must be a finite"):
            Water(density=value)
        with pytest.raises(buoyancy_mj.ModelError, match=r"coefficient is .*; it must be a finite"):
            Silhouette(coefficient=value)
    with pytest.raises(buoyancy_mj.ModelError, match="damping radiation is 1; it must be true or"):
        Damping(radiation=1)


def test_a_whole_number_may_be_written_with_a_point_so_that_seeds_can_be_swept_over():
    sea = 'water.waves=[{kind="jonswap", significant_height=0.1, peak_period=3.0}]'
    scene = catalog.scenes()["auv_waves"]
    assert read_scene(scene, [sea, "water.waves.0.seed=7.0"]).water.waves[0].seed == 7
    with pytest.raises(buoyancy_mj.SceneError, match=r"seed is 7.5; needed is a whole number"):
        read_scene(scene, [sea, "water.waves.0.seed=7.5"])


def test_the_rows_of_a_water_cannot_be_changed_for_all_who_share_it():
    sea = JonswapSea(0.5, 4.0)
    water = Water(waves=sea, current=(0.1, 0.0, 0.0))
    for rows in (water.rows, water.current_rows, sea.rows):
        with pytest.raises(ValueError, match="read-only"):
            rows[0, 0] = 9.0


def test_the_old_name_of_a_key_says_the_new_one():
    with pytest.raises(
        buoyancy_mj.SceneError,
        match="scene 'auv_waves': unknown key 'drag'; it is 'damping' now; possible: added_mass",
    ):
        read_scene(catalog.scenes()["auv_waves"], ["drag=false"])


@pytest.mark.parametrize(
    ("text", "value"),
    [
        (".5", 0.5),
        ("-.5", -0.5),
        ("1.", 1.0),
        ("1.e3", 1000.0),
        ("[[0,.5],[1.,2]]", [[0, 0.5], [1.0, 2]]),
        (".5.1", ".5.1"),
        (".", "."),
        ("a.5", "a.5"),
    ],
)
def test_numbers_are_read_as_mjcf_may_have_them(text, value):
    assert parse_value(text, "noise") == value
