"""The water as a plugin of the engine: part of a model, and at work wherever MuJoCo steps it.

    <extension>
      <plugin plugin="buoyancy_mj.water">
        <instance name="sea">
          <config key="waves" value="regular amplitude=0.3 frequency=0.5"/>
        </instance>
      </plugin>
    </extension>

A body joins the instance by `<plugin instance="sea"/>`; where none does, all bodies that move are
in it. Where a model is attached to another, MuJoCo takes along only instances that a body joined;
so `add_water` lets the bodies join. The keys are those of `settings.config.KEYS`.

MuJoCo calls only compiled functions, from any thread; Python is asked once for each mjData, when it
is made, and when data are stepped with another model.
"""

import warnings
from typing import Unpack

import mujoco

from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.engine.instances import PLUGIN, find_instance
from buoyancy_mj.engine.named_instances import name_instances
from buoyancy_mj.engine.pickles import pickle_with_water
from buoyancy_mj.engine.registration import register
from buoyancy_mj.engine.waters import find_water, remember_settings
from buoyancy_mj.errors import BuoyancyWarning, EngineError, ModelError, describe
from buoyancy_mj.loads.full_inertia import make_room
from buoyancy_mj.sea.water import Water
from buoyancy_mj.settings.config import INSTANCE, write_plugin_config
from buoyancy_mj.settings.settings import Options, Settings, combine_settings


def add_water(
    spec: mujoco.MjSpec,
    water: Water | Settings | None = None,
    *,
    instance: str = "sea",
    **options: Unpack[Options],
) -> None:
    """Put water into a model, so that it floats wherever MuJoCo steps it.

    The model compiled from `spec` has the water, and so has the MJCF saved from it. Where `spec` is
    attached to another model, its bodies keep their water, and the others stay without. Where
    bodies may get added mass, MuJoCo keeps their whole inertia (`<body simple="false">`).

    Args:
        spec: the model, with its bodies: those that it gets later are in this water too, but do not
            take it along when they alone are attached elsewhere. All its bodies that move are in
            the water, but those that joined another instance; or those alone that joined this one
            before.
        water: the sea, fresh and still at z = 0 if None; or `Settings`, which hold it and all
            options.
        instance: name of the plugin's instance in the model.
        options: any of the other fields of `Settings`: method, pressure, damping, added_mass,
            slamming, selection, threads.

    Raises:
        ModelError: the model has an instance of that name, or `spec` is no MjSpec.
        WaterError, MethodError: a wave or a method that MJCF cannot hold.
        EngineError: this MuJoCo is not as expected inside.

    Example:
        >>> spec = mujoco.MjSpec.from_file("vehicle.xml")
        >>> add_water(spec, Water(waves=RegularWave(amplitude=0.3, frequency=0.5)))
        >>> model = spec.compile()
    """
    if not isinstance(spec, mujoco.MjSpec):
        raise ModelError(
            f"spec is {describe(spec)}; it must be an MjSpec, as "
            "mujoco.MjSpec.from_file('my_auv.xml') gives it"
        )
    register()
    if any(plugin.name == instance for plugin in spec.plugins):
        raise ModelError(
            f"the model already has a plugin instance '{instance}'; "
            "give the water another name (instance=)"
        )
    settings = combine_settings(water, options)
    config = write_plugin_config(settings)
    remember_settings(config, settings)
    make_room(spec, settings.added_mass)
    name_instances(spec)
    spec.activate_plugin(PLUGIN)
    plugin = spec.add_plugin(name=instance, plugin_name=PLUGIN, active=True)
    if any(body.plugin.active and body.plugin.name == instance for body in spec.bodies):
        plugin.config = config
        return

    # all bodies, also where the model is attached to another
    plugin.config = config | {INSTANCE: instance}
    _join_bodies(spec, instance)


def _join_bodies(spec: mujoco.MjSpec, instance: str) -> None:
    """Let all bodies with joints join an instance, or those of the world if none has any."""
    bodies = [body for body in spec.bodies if body.joints]
    for body in bodies or [body for body in spec.worldbody.bodies if not body.mocap]:
        if not body.plugin.active:
            body.plugin.active = True
            body.plugin.plugin_name = PLUGIN
            body.plugin.name = instance


def water_in(model: mujoco.MjModel, instance: str | None = None) -> Buoyancy:
    """The `Buoyancy` behind a plugin instance of a model: for its hulls, and the loads on its data.

    Args:
        model: a model that brings its own water.
        instance: name of the instance; None for the only one.

    Raises:
        ModelError: there is no such instance; and all that `Buoyancy` raises.
    """
    return find_water(model._address, find_instance(model, instance))


try:
    register()
    pickle_with_water()
except EngineError as _error:
    warnings.warn(
        f"models cannot bring their own water here: {_error}", BuoyancyWarning, stacklevel=2
    )
