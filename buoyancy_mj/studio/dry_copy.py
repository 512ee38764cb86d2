"""A dry copy of a scene's model, for windows and browsers that know none of its plugins."""

import mujoco

from buoyancy_mj.scenes.assembly import join_files
from buoyancy_mj.scenes.scene import Scene


def make_dry_spec(scene: Scene) -> mujoco.MjSpec:
    """The vehicles and surroundings of a scene without plugins and sensors, not yet compiled.

    Its bodies, joints, geoms and actuators are those of the scene's model, in the same order. Water
    and thrusters act on the scene's own model alone. Sensors are left out: on this copy they would
    measure what happens without water.

    Raises:
        ModelError: see `join_files`.
    """
    spec, _ = join_files(scene)
    spec.option.timestep = scene.timestep
    remove_plugins(spec)
    return spec


def remove_plugins(spec: mujoco.MjSpec) -> None:
    """Remove all plugins of a spec, and its sensors; actuators with one become plain ones."""
    for element in (*spec.bodies, *spec.geoms, *spec.meshes):
        element.plugin.active = False
    for actuator in spec.actuators:
        if actuator.plugin.active:
            actuator.plugin.active = False
            actuator.dyntype = mujoco.mjtDyn.mjDYN_NONE
            actuator.actdim = -1
    for sensor in list(spec.sensors):
        spec.delete(sensor)
    for plugin in list(spec.plugins):
        spec.delete(plugin)


def copy_masses(model: mujoco.MjModel, dry: mujoco.MjModel) -> None:
    """Copy masses from the scene's model to its dry copy: pushes with the mouse go by them."""
    count = model.nbody
    for name in ("body_mass", "body_inertia", "body_ipos", "body_iquat"):
        getattr(dry, name)[:count] = getattr(model, name)
    mujoco.mj_setConst(dry, mujoco.MjData(dry))
