"""A vehicle and an environment, joined into one MuJoCo model."""

import contextlib
import dataclasses
import warnings
from pathlib import Path

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from buoyancy_mj.engine.checks import skips_passive
from buoyancy_mj.engine.instances import PLUGIN
from buoyancy_mj.engine.native import pop_error
from buoyancy_mj.engine.plugin import add_water
from buoyancy_mj.errors import (
    BuoyancyError,
    BuoyancyWarning,
    EngineError,
    ModelError,
    SceneError,
    choices,
)
from buoyancy_mj.hulls.geoms import find_hulls
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.loads.coefficients import add_coefficients
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.scene import EQUILIBRIUM, INTEGRATORS, Scene, Start
from buoyancy_mj.statics.equilibrium import find_rest
from buoyancy_mj.statics.vessel import build_vessel

ENVIRONMENT = "environment/"
"""What the names of the environment start with in a joined model; the vehicle's stay as they are."""
_FREE = mujoco.mjtJoint.mjJNT_FREE
_MENDS = {
    "inertia": "a body that floats needs mass and inertia: give it an <inertial>, or bound them by <compiler boundmass "
    "boundinertia>",
    "ASCII": "save the mesh as a binary STL or as OBJ",
}
"""What to do, by a word in the compiler's message."""


def assemble(scene: Scene, *, afloat: bool = False) -> tuple[mujoco.MjModel, mujoco.MjData, int]:
    """The model of a scene, its data at the start, and how many of its bodies, from the first, are world and vehicle.

    The vehicle's file is the base: its options, names, keyframes and custom elements stay. Its body
    gets a free joint if it has none, and the environment is attached to the world under the prefix
    'environment/'. With `afloat` the scene's water is part of the model, unless MuJoCo would skip it
    there (see `callbacks.skips_passive`); water that the vehicle's file brings gives way to the scene's.

    Raises:
        ModelError: a file is missing, MuJoCo refuses it, or it has no body that could float; afloat,
            also what `Buoyancy` raises.
        SceneError: the start names a keyframe that does not exist.
    """
    path = catalog.model_path(scene.vehicle, scene.folder)
    spec = read_vehicle(path)
    _leave_out_dry_land(spec, path, scene.water.level)
    if scene.coefficients is not None:
        add_coefficients(spec, scene.coefficients.read(scene.folder))
    bodies = len(spec.bodies)
    if scene.environment is not None:
        place = catalog.environment_path(scene.environment, scene.folder)
        try:
            spec.attach(
                catalog.read_spec(place), prefix=ENVIRONMENT, frame=spec.worldbody.add_frame()
            )
        except ValueError as error:
            raise ModelError(
                f"MuJoCo cannot join '{place}' to '{path}': {' '.join(str(error).split())}"
            ) from error
    # what the scene decides
    spec.option.timestep = scene.timestep
    spec.option.integrator = INTEGRATORS[scene.integrator.lower()]
    if afloat and not skips_passive(spec.option.disableflags):
        # where the plugin cannot be, that was told on import
        with contextlib.suppress(EngineError):
            add_water(spec, scene)
    model = compile_spec(spec, path)
    _load(model, scene, bodies)
    try:
        data = mujoco.MjData(model)
    except mujoco.FatalError as error:
        raise pop_error() or error from None
    _place(model, data, scene.start, bodies)
    if scene.start.at == EQUILIBRIUM:
        _settle(model, data, scene, bodies)
    return model, data, bodies


def read_vehicle(path: Path) -> mujoco.MjSpec:
    """A vehicle's file, not yet compiled, with a free joint if it has none and without water of its own.

    Raises:
        ModelError: MuJoCo refuses it, or it has no body that could float.
    """
    spec = catalog.read_spec(path)
    _free(spec, path)
    _weigh(spec)
    _leave_out_own_water(spec)
    return spec


def _weigh(spec: mujoco.MjSpec) -> None:
    """Turn gravity on: without it nothing weighs, and nothing is lifted."""
    off = int(mujoco.mjtDisableBit.mjDSBL_GRAVITY)
    if spec.option.disableflags & off or not np.any(spec.option.gravity):
        gravity = "disables gravity" if spec.option.disableflags & off else "sets gravity to 0 0 0"
        warnings.warn(
            f"the vehicle {gravity}; in water it weighs, by 0 0 -9.81",
            BuoyancyWarning,
            stacklevel=4,
        )
        spec.option.disableflags &= ~off
        if not np.any(spec.option.gravity):
            spec.option.gravity = [0.0, 0.0, -9.81]


def compile_spec(spec: mujoco.MjSpec, path: Path) -> mujoco.MjModel:
    """A spec, compiled.

    Raises:
        ModelError: MuJoCo refuses it; its own message is kept, with a mend where there is one.
        BuoyancyError: what the water in it refuses.
    """
    pop_error()
    try:
        return spec.compile()
    except ValueError as error:
        # what the water refuses comes through MuJoCo as a text
        refused = pop_error()
        if isinstance(refused, BuoyancyError):
            raise refused from None
        told = " ".join(str(error).split())
        mend = next((f"; {mend}" for word, mend in _MENDS.items() if word in told), "")
        raise ModelError(f"MuJoCo cannot compile '{path}': {told}{mend}") from error


def _free(spec: mujoco.MjSpec, path: Path) -> None:
    """Give the vehicle a free joint, unless a body of it already floats or moves on joints of its own."""
    roots = [body for body in spec.worldbody.bodies if not body.mocap]
    if not roots:
        raise ModelError(
            f"'{path}' has no body that could float; put the vehicle's geoms into a <body>"
        )
    jointed = [body for body in roots if body.joints]
    if any(joint.type == _FREE for body in jointed for joint in body.joints):
        return
    fixed = [body for body in roots if not body.joints]
    if len(fixed) == 1 and not jointed:
        fixed[0].add_freejoint()
        # the root's joint comes first, and the keyframes of the fixed vehicle lack it
        for key in spec.keys:
            if len(key.qpos):
                key.qpos = [*fixed[0].pos, *fixed[0].quat, *key.qpos]
            if len(key.qvel):
                key.qvel = [0.0] * 6 + list(key.qvel)
    elif not jointed:
        names = ", ".join(f"'{body.name}'" for body in fixed)
        raise ModelError(
            f"'{path}' has {len(fixed)} bodies without a joint ({names}); give the one that floats a <freejoint/>"
        )


def _leave_out_dry_land(spec: mujoco.MjSpec, path: Path, level: float) -> None:
    """Remove level ground of the vehicle's file at the height of the water or above: no water could be there."""
    planes = [geom for geom in spec.worldbody.geoms if geom.type == mujoco.mjtGeom.mjGEOM_PLANE]
    if not planes:
        return
    # the compiler knows which way they face, however that was written
    model = compile_spec(spec.copy(), path)
    own = [
        g
        for g in range(model.ngeom)
        if model.geom_bodyid[g] == 0 and model.geom_type[g] == mujoco.mjtGeom.mjGEOM_PLANE
    ]
    up, normal = np.array([0.0, 0.0, 1.0]), np.empty(3)
    for plane, g in zip(planes, own, strict=True):
        mujoco.mju_rotVecQuat(normal, up, model.geom_quat[g])
        height = model.geom_pos[g, 2]
        if normal[2] > 0.95 and height >= level - 1e-9:
            warnings.warn(
                f"the vehicle's ground plane '{plane.name}' at z = {height:g} m would keep out the water at {level:g} m "
                "and was left out",
                BuoyancyWarning,
                stacklevel=4,
            )
            spec.delete(plane)


def _leave_out_own_water(spec: mujoco.MjSpec) -> None:
    """Remove the water that the model brings: the scene's takes its place."""
    own = [plugin for plugin in spec.plugins if plugin.plugin_name == PLUGIN]
    for body in spec.bodies:
        if body.plugin.plugin_name == PLUGIN or body.plugin.name in [plugin.name for plugin in own]:
            body.plugin.active = False
    for plugin in own:
        warnings.warn(
            f"the water '{plugin.name}' of the model gives way to the scene's",
            BuoyancyWarning,
            stacklevel=4,
        )
        spec.delete(plugin)


def _load(model: mujoco.MjModel, scene: Scene, bodies: int) -> None:
    """Give the vehicle, the first `bodies` of the model, the mass and the centre of gravity that the scene says."""
    if scene.mass is not None:
        factor = scene.mass / model.body_mass[1:bodies].sum()
        model.body_mass[1:bodies] *= factor
        model.body_inertia[1:bodies] *= factor
    if any(scene.cog_shift):
        model.body_ipos[1] += scene.cog_shift
        # the sameframe shortcuts hold no longer
        model.body_sameframe[1] = int(mujoco.mjtSameFrame.mjSAMEFRAME_NONE)
        model.body_simple[1] = 0
    if scene.mass is not None or any(scene.cog_shift):
        mujoco.mj_setConst(model, mujoco.MjData(model))


def _place(model: mujoco.MjModel, data: mujoco.MjData, start: Start, bodies: int) -> None:
    """Set the state at time 0; the vehicle's are the first `bodies`."""
    if start.keyframe is not None:
        names = [model.key(i).name for i in range(model.nkey)]
        if start.keyframe not in names:
            raise SceneError(
                f"start: the vehicle has no keyframe '{start.keyframe}'; {choices(start.keyframe, names)}"
            )
        mujoco.mj_resetDataKeyframe(model, data, names.index(start.keyframe))
        data.time = 0.0
    free = [
        j for j in range(model.njnt) if model.jnt_type[j] == _FREE and model.jnt_bodyid[j] < bodies
    ]
    if not free:
        if dataclasses.replace(start, keyframe=None) != Start():
            warnings.warn(
                "the vehicle hangs on joints of its own and has no free one; the position, attitude and velocity of the "
                "start were not applied",
                BuoyancyWarning,
                stacklevel=4,
            )
        return
    # the first body goes where the start has it, and takes the others along as one rigid body
    poses = [data.qpos[model.jnt_qposadr[j] :][:7].copy() for j in free]
    turn = Rotation.from_euler("ZYX", [start.yaw, start.pitch, start.roll])
    moved = turn * Rotation.from_quat(poses[0][3:], scalar_first=True).inv()
    spin = turn.apply(start.angular_velocity)
    for joint, pose in zip(free, poses, strict=True):
        q, v = model.jnt_qposadr[joint], model.jnt_dofadr[joint]
        arm = moved.apply(pose[:3] - poses[0][:3])
        attitude = moved * Rotation.from_quat(pose[3:], scalar_first=True)
        data.qpos[q : q + 7] = [
            *(np.array(start.position) + arm),
            *attitude.as_quat(scalar_first=True),
        ]
        data.qvel[v : v + 6] = [
            *(np.array(start.velocity) + np.cross(spin, arm)),
            *attitude.inv().apply(spin),
        ]


def _settle(model: mujoco.MjModel, data: mujoco.MjData, scene: Scene, bodies: int) -> None:
    """Bring each of the vehicle's bodies that float to rest, from where it is."""
    hulls = find_hulls(model, scene.selection, range(1, bodies))
    for root in dict.fromkeys(int(model.body_rootid[hull.body]) for hull in hulls):
        name = body_name(model, root)
        vessel = build_vessel(model, scene.water, data.qpos, body=name, selection=scene.selection)
        data.qpos[:] = find_rest(vessel).qpos
