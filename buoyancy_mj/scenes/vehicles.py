"""A vehicle's file, ready for a scene: free, with gravity, without water."""

import warnings
from pathlib import Path

import mujoco
import numpy as np

from buoyancy_mj.engine.instances import PLUGIN
from buoyancy_mj.errors import BuoyancyWarning, ModelError
from buoyancy_mj.hulls.bodies import find_moving_bodies
from buoyancy_mj.hulls.custom import read_all_texts
from buoyancy_mj.hulls.names import geom_name
from buoyancy_mj.hulls.selection import CUSTOM_TEXTS
from buoyancy_mj.hulls.verdicts import SOLID_TYPES
from buoyancy_mj.scenes.specs import compile_spec, read_spec
from buoyancy_mj.scenes.urdf import add_missing_inertia, is_urdf

_NO_GRAVITY = int(mujoco.mjtDisableBit.mjDSBL_GRAVITY)


def read_vehicle(path: Path) -> mujoco.MjSpec:
    """Read a vehicle's file, and make it ready for the water of a scene.

    The vehicle gets a free joint if it has none, gravity if it is without, and loses the water that
    its file brings. Links of a URDF without inertia get the smallest sound one. Where the file has
    MuJoCo fuse bodies that cannot move, they are fused.

    Raises:
        ModelError: MuJoCo refuses the file, or it has no body that could float.
    """
    spec = read_spec(path)
    _add_free_joint(spec, path)
    if is_urdf(path):
        add_missing_inertia(spec)
    _turn_gravity_on(spec)
    remove_water(spec)

    # the compiler fuses bodies in the spec itself, which then has those of the model
    if spec.compiler.fusestatic:
        # a URDF does not say so: there links that are fixed to others are a part of them
        drawn = [] if is_urdf(path) else _list_drawn_geoms(spec, path)
        compile_spec(spec, path)
        kept = {body.name for body in spec.bodies}
        lost = [geom for body, geom in drawn if body not in kept]
        if lost:
            warnings.warn(
                f"the vehicle has MuJoCo fuse its fixed bodies (fusestatic), and {', '.join(lost)},"
                " of bodies that are only drawn, displace nothing beside the collision geoms with "
                "which they are fused; name them among the geoms, or set fusestatic='false'",
                BuoyancyWarning,
                stacklevel=4,
            )
    return spec


def _list_drawn_geoms(spec: mujoco.MjSpec, path: Path) -> list[tuple[str, str]]:
    """Geoms of bodies that are only drawn, fixed to others that collide: names of body and geom.

    Where the file chooses its geoms itself there are none.
    """
    whole = spec.copy()
    whole.compiler.fusestatic = False
    model = compile_spec(whole, path)
    if any(CUSTOM_TEXTS["geoms"] in name for name in read_all_texts(model)):
        return []
    solid = (
        np.isin(model.geom_type, list(SOLID_TYPES)) & find_moving_bodies(model)[model.geom_bodyid]
    )
    collides = solid & ((model.geom_contype != 0) | (model.geom_conaffinity != 0))
    carriers = model.body_weldid[model.geom_bodyid]
    alone = ~np.isin(model.geom_bodyid, model.geom_bodyid[collides])
    drawn = solid & alone & np.isin(carriers, carriers[collides]) & (carriers != model.geom_bodyid)
    return [
        (str(model.body(model.geom_bodyid[geom]).name), f"'{geom_name(model, geom)}'")
        for geom in np.flatnonzero(drawn).tolist()
    ]


def _add_free_joint(spec: mujoco.MjSpec, path: Path) -> None:
    """Add a free joint to the vehicle, unless one of its bodies moves on joints already."""
    roots = [body for body in spec.worldbody.bodies if not body.mocap]
    if not roots:
        raise ModelError(
            f"'{path}' has no body that could float; put the vehicle's geoms into a <body>"
        )
    if any(body.joints for body in roots):
        return
    if len(roots) > 1:
        names = ", ".join(f"'{body.name}'" for body in roots)
        raise ModelError(
            f"'{path}' has {len(roots)} bodies without a joint ({names}); give the one that floats "
            "a <freejoint/>"
        )
    (root,) = roots
    root.add_freejoint()

    # the root's joint comes first, and the keyframes of the fixed vehicle lack it
    for key in spec.keys:
        if len(key.qpos):
            key.qpos = [*root.pos, *root.quat, *key.qpos]
        if len(key.qvel):
            key.qvel = [0.0] * 6 + list(key.qvel)


def _turn_gravity_on(spec: mujoco.MjSpec) -> None:
    """Turn gravity on: without it there is neither weight nor buoyancy."""
    disabled = bool(spec.option.disableflags & _NO_GRAVITY)
    if not disabled and np.any(spec.option.gravity):
        return
    cause = "disables gravity" if disabled else "sets gravity to 0 0 0"
    spec.option.disableflags &= ~_NO_GRAVITY
    if not np.any(spec.option.gravity):
        spec.option.gravity = [0.0, 0.0, -9.81]
    x, y, z = spec.option.gravity
    warnings.warn(
        f"the vehicle {cause}; water needs gravity, so it is {x:g} {y:g} {z:g} here",
        BuoyancyWarning,
        stacklevel=4,
    )


def remove_water(spec: mujoco.MjSpec) -> None:
    """Remove the water that a file brings: the scene's takes its place."""
    instances = [plugin for plugin in spec.plugins if plugin.plugin_name == PLUGIN]
    names = [plugin.name for plugin in instances]
    for body in spec.bodies:
        if body.plugin.plugin_name == PLUGIN or body.plugin.name in names:
            body.plugin.active = False
    for plugin in instances:
        warnings.warn(
            f"the water '{plugin.name}' of the model gives way to the scene's",
            BuoyancyWarning,
            stacklevel=4,
        )
        spec.delete(plugin)
