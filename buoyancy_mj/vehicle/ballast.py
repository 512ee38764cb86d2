"""`add_ballast`: bladders, tanks and compartments, as actuators of the engine.

    <actuator>
      <plugin name="aft" plugin="buoyancy_mj.ballast" site="aft" actdim="1">
        <config key="kind" value="tank"/>
        <config key="geom" value="aft"/>
        <config key="capacity" value="0.002"/>
        <config key="rate" value="0.0001"/>
      </plugin>
    </actuator>

The actuator keeps one state, the volume in `data.act`, and pushes nothing. The loads are the
water's, see `kernels.ballast`.
"""

import ctypes
from collections.abc import Mapping

import mujoco
import numpy as np

from buoyancy_mj.engine.c_functions import encode_text
from buoyancy_mj.engine.device_kinds import DeviceKind, Plan
from buoyancy_mj.engine.device_registration import register_kind
from buoyancy_mj.engine.named_instances import name_instances
from buoyancy_mj.errors import ModelError, choices, describe
from buoyancy_mj.hulls.ballasts import (
    KEYS,
    KINDS,
    PLUGIN,
    Ballasting,
    Bladder,
    Compartment,
    write_ballast,
)
from buoyancy_mj.hulls.placed_ballasts import place_ballast
from buoyancy_mj.kernels.entries import ballast as entries
from buoyancy_mj.kernels.entries.ballast import BallastDevice
from buoyancy_mj.loads.ballast_arrays import gather_ballast
from buoyancy_mj.loads.full_inertia import keep_full_inertia
from buoyancy_mj.values import read_text


def add_ballast(
    spec: mujoco.MjSpec,
    geom: str | mujoco.MjsGeom,
    ballast: Ballasting,
    name: str | None = None,
) -> mujoco.MjsActuator:
    """Add ballast that changes under way to a model, in the shape of a geom.

    It becomes an actuator. Its command, in `data.ctrl`, is the volume that is wanted [m^3], and its
    state, in `data.act`, the volume that it has. A compartment needs no command.

    Args:
        spec: the model, with its bodies.
        geom: a geom, or its name. What a tank holds has its shape, and what a bladder displaces is
            wet as it is. The mass of the geom is that of an empty tank: write mass='0' where that
            of the body counts it.
        ballast: a `Bladder`, a `Tank` or a `Compartment`.
        name: of the actuator; that of the geom if None.

    Returns:
        The actuator.

    Raises:
        ModelError: no such geom or opening, a geom of the world, or a name that is taken. What only
            a compiled model shows is refused when it is compiled.

    Example:
        >>> actuator = add_ballast(spec, "glass", Bladder(capacity=5e-4, rate=2e-5))
    """
    if not isinstance(spec, mujoco.MjSpec):
        raise ModelError(
            f"spec is {describe(spec)}; it must be an MjSpec, as "
            "mujoco.MjSpec.from_file('my_auv.xml') gives it"
        )
    if not isinstance(ballast, tuple(KINDS.values())):
        raise ModelError(
            f"ballast is {describe(ballast)}; it must be a Bladder, a Tank or a Compartment"
        )
    shape = _find_geom(spec, geom)
    if shape.parent == spec.worldbody:
        raise ModelError(
            f"the geom '{shape.name}' is fixed to the world, where ballast moves nothing; "
            "name one of a body that can move"
        )
    name = read_text(ModelError, "name of the ballast", name or shape.name)
    taken = {actuator.name for actuator in spec.actuators}
    instances = {plugin.name for plugin in spec.plugins}
    if name in taken | instances:
        raise ModelError(
            f"the model already has an actuator or a plugin instance '{name}'; "
            "give the ballast another name (name=)"
        )

    # where water comes in
    if isinstance(ballast, Compartment):
        sites = [site.name for site in spec.sites if site.name]
        if ballast.opening not in sites:
            raise ModelError(
                f"the opening of compartment '{name}' is the site {describe(ballast.opening)}, and "
                f"there is none; {choices(ballast.opening, sites)}"
            )
        site = ballast.opening
    else:
        site = _add_site(spec, shape, name)

    # the actuator, and room for the inertia of the water
    name_instances(spec)
    spec.activate_plugin(PLUGIN)
    plugin = spec.add_plugin(name=name, plugin_name=PLUGIN, active=True)
    plugin.config = write_ballast(ballast, shape.name)
    actuator = spec.add_actuator(name=name, trntype=mujoco.mjtTrn.mjTRN_SITE, target=site, actdim=1)
    actuator.plugin.name, actuator.plugin.plugin_name = name, PLUGIN
    actuator.plugin.active = True
    if ballast.capacity is not None and not isinstance(ballast, Compartment):
        actuator.ctrllimited, actuator.ctrlrange = 1, [0.0, ballast.capacity]
    if not isinstance(ballast, Bladder):
        keep_full_inertia([_find_moving(spec, shape.parent)])
    return actuator


def _find_geom(spec: mujoco.MjSpec, geom: str | mujoco.MjsGeom) -> mujoco.MjsGeom:
    """A geom of a spec by its name, which it must have."""
    if isinstance(geom, mujoco.MjsGeom):
        if not geom.name:
            raise ModelError("the geom of the ballast has no name; give it one, geom.name = 'tank'")
        return geom
    found = spec.geom(geom) if isinstance(geom, str) and geom else None
    if found is None:
        names = [one.name for one in spec.geoms if one.name]
        raise ModelError(f"the model has no geom {describe(geom)}; {choices(geom, names)}")
    return found


def _add_site(spec: mujoco.MjSpec, geom: mujoco.MjsGeom, name: str) -> str:
    """Add a site at a geom, and give its name."""
    taken = {site.name for site in spec.sites}
    names = (name, *(f"{name}_{n}" for n in range(2, len(taken) + 3)))
    free = next(one for one in names if one not in taken)
    ends = np.asarray(geom.fromto)
    middle = 0.5 * (ends[:3] + ends[3:]) if np.isfinite(ends).all() else geom.pos
    geom.parent.add_site(name=free, pos=middle, group=5)
    return free


def _find_moving(spec: mujoco.MjSpec, body: mujoco.MjsBody) -> mujoco.MjsBody:
    """The body that has the joints with which a body moves; the topmost if none has any."""
    while not body.joints and body.parent != spec.worldbody:
        body = body.parent
    return body


def _plan(model: mujoco.MjModel, instance: int, texts: Mapping[str, str]) -> Plan:
    """What the ballast of one instance is."""
    placed = place_ballast(model, instance, texts)
    arrays = gather_ballast([placed])
    dry = encode_text(
        f"buoyancy_mj: '{placed.name}' holds water and no water acts on its body, so that it would "
        "weigh nothing: put the model into water (add_water or Buoyancy), or empty it"
    )

    # the text lives as long as the plan
    return Plan(
        body=placed.body,
        make=lambda device: BallastDevice(device, arrays, ctypes.addressof(dry)),
        compute=entries.compute,
        advance=entries.advance,
    )


register_kind(
    DeviceKind(
        plugin=PLUGIN,
        keys=KEYS,
        plan=_plan,
        capability=mujoco.mjtPluginCapabilityBit.mjPLUGIN_ACTUATOR,
    )
)
