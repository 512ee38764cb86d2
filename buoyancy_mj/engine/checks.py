"""Checks of a model before water acts on it: MuJoCo's flags, what has no volume, shallow waves."""

import math
import warnings
from collections.abc import Sequence

import mujoco
import numpy as np

from buoyancy_mj.errors import BuoyancyWarning, ModelError, describe
from buoyancy_mj.hulls.bodies import find_moving_bodies, group_floating_bodies
from buoyancy_mj.hulls.gravity import find_weighing_masses
from buoyancy_mj.hulls.hull import Hull
from buoyancy_mj.hulls.names import body_name, geom_kind, geom_name
from buoyancy_mj.hulls.tethers import find_tether
from buoyancy_mj.hulls.verdicts import SOLID_TYPES
from buoyancy_mj.kernels.inertia import AddedMass
from buoyancy_mj.kernels.waves import DEPTH
from buoyancy_mj.sea.water import Water
from buoyancy_mj.submersion.exact import Exact
from buoyancy_mj.submersion.methods import Method


def skips_passive(disableflags: int) -> bool:
    """Whether MuJoCo skips the passive forces, and the water with them, under these flags."""
    both = int(mujoco.mjtDisableBit.mjDSBL_SPRING) | int(mujoco.mjtDisableBit.mjDSBL_DAMPER)
    return disableflags & both == both


def check_actuation(model: mujoco.MjModel) -> None:
    """Refuse a model for which MuJoCo would skip a control callback without a word.

    Raises:
        ModelError: it disables actuation.
    """
    if model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_ACTUATION:
        raise ModelError(
            "this model disables actuation, and MuJoCo then skips the control callback through "
            "which water acts: remove <flag actuation='disable'/>, and disable single actuators by "
            "<option actuatorgroupdisable> instead, or put the water into the model (add_water)"
        )


def check_sleep(model: mujoco.MjModel) -> None:
    """Refuse a model whose bodies would stay at rest while the water moves.

    Raises:
        ModelError: it enables sleep.
    """
    if model.opt.enableflags & mujoco.mjtEnableBit.mjENBL_SLEEP:
        raise ModelError(
            "this model lets bodies at rest sleep, and MuJoCo does not wake them for water that "
            "moves: remove <flag sleep='enable'/>"
        )


def check_applied(model: mujoco.MjModel, causes: Sequence[str], *, augments: bool) -> None:
    """Refuse water in `xfrc_applied` that a sensor of the model would misread.

    The part of added mass that goes with accelerations stands in the mass matrix. MuJoCo's
    recursion for forces between bodies knows only their own inertia, and its sensor of kinetic
    energy reads the matrix before a control callback is called.

    Args:
        model: the model.
        causes: names of the loads that act.
        augments: whether anything of them stands in the mass matrix.

    Raises:
        ModelError: added mass or the water of tanks acts, and a sensor measures the force or torque
            between bodies, or kinetic energy.
    """
    sensor = mujoco.mjtSensor
    kinds = sensor.mjSENS_FORCE, sensor.mjSENS_TORQUE, sensor.mjSENS_E_KINETIC
    sensors = np.flatnonzero(np.isin(model.sensor_type, [int(kind) for kind in kinds]))
    if augments and len(sensors):
        name = model.sensor(sensors[0]).name or f"number {sensors[0]}"
        if "added_mass" not in causes:
            raise ModelError(
                f"the sensor '{name}' would not read the water in tanks, whose inertia stands in "
                "the mass matrix and not in xfrc_applied: leave out the sensor, or let the water "
                "act through qfrc_passive"
            )
        raise ModelError(
            f"the sensor '{name}' would not read the added mass, which stands in the mass matrix "
            "and not in xfrc_applied: leave out the sensor, or the added mass (added_mass='none')"
        )


def check_data(model: mujoco.MjModel, data: mujoco.MjData) -> None:
    """Refuse data of another model, whose arrays have other sizes or another meaning.

    Copies of a model have its signature, and pickled ones have none.

    Raises:
        ModelError: the data are of another model, or no data.
    """
    if not isinstance(data, mujoco.MjData):
        raise ModelError(f"data are {describe(data)}; give the mujoco.MjData of this water's model")
    if data.model._address == model._address:
        return
    signatures = {model.signature, data.signature} - {0}
    pairs = {
        "nq": (model.nq, data.qpos.shape[0]),
        "nv": (model.nv, data.qvel.shape[0]),
        "nbody": (model.nbody, data.xpos.shape[0]),
        "ngeom": (model.ngeom, data.geom_xpos.shape[0]),
        "nC": (model.nC, data.M.shape[0]),
    }
    other = [
        f"{name} {theirs}, not {ours}" for name, (ours, theirs) in pairs.items() if ours != theirs
    ]
    if other or len(signatures) > 1:
        raise ModelError(
            f"these data are of another model than this water's "
            f"({', '.join(other) or 'of the same sizes'}): make them of it, "
            "mujoco.MjData(buoyancy.model), or make a Buoyancy of their model"
        )


def check_forwarded(data: mujoco.MjData) -> None:
    """Refuse data without poses: MuJoCo makes and resets data with zeros in place of rotations.

    Raises:
        ModelError: nothing has placed the bodies yet.
    """
    if not data.xquat[-1].any():
        raise ModelError(
            "these data are new or were reset, and their bodies are placed nowhere yet: "
            "call mujoco.mj_forward(model, data) first"
        )


def warn_of_no_volume(model: mujoco.MjModel) -> None:
    """Name what moves with bodies and can displace no water: flexes, skins, distance fields."""
    moving = find_moving_bodies(model)
    things = [
        f"{kind} '{mujoco.mj_id2name(model, object_type, i) or i}'"
        for kind, object_type, count in (
            ("flex", mujoco.mjtObj.mjOBJ_FLEX, model.nflex),
            ("skin", mujoco.mjtObj.mjOBJ_SKIN, model.nskin),
        )
        for i in range(count)
    ]
    things += [
        f"{geom_kind(model, geom)} '{geom_name(model, geom)}'"
        for geom in range(model.ngeom)
        if moving[model.geom_bodyid[geom]] and model.geom_type[geom] not in SOLID_TYPES
    ]
    if things:
        displace = "displaces" if len(things) == 1 else "displace"
        warnings.warn(
            f"{', '.join(things)} {displace} no water: only geoms of the types mesh, box, sphere, "
            "ellipsoid, capsule and cylinder do",
            BuoyancyWarning,
            stacklevel=3,
        )


def warn_of_fixed_carrier(model: mujoco.MjModel, hulls: Sequence[Hull]) -> None:
    """Name the body without a joint that carries all that is in the water.

    A vehicle whose propeller alone has a joint is one: it was meant to float.
    """
    roots = model.tree_bodyadr[np.unique(model.body_treeid[[hull.body for hull in hulls]])]
    carriers = np.unique(model.body_parentid[roots])
    solid = model.geom_bodyid[np.isin(model.geom_type, SOLID_TYPES)]
    fixed = (model.body_treeid[carriers] < 0) & (model.body_mocapid[carriers] < 0) & (carriers > 0)
    if (fixed & np.isin(carriers, solid)).all():
        warnings.warn(
            f"body '{body_name(model, int(carriers[0]))}' has no joint and stays where it is, and "
            "only what hangs on it is in the water; give it a <freejoint/> if it shall float",
            BuoyancyWarning,
            stacklevel=3,
        )


def warn_of_no_waterplane(model: mujoco.MjModel, added_mass: AddedMass, method: Method) -> None:
    """Name what has added mass under a method that cannot tell how it enters the water."""
    if len(added_mass.bodies) and not isinstance(method, Exact):
        names = ", ".join(f"'{body_name(model, int(body))}'" for body in added_mass.bodies)
        warnings.warn(
            f"the method '{method.name}' knows no waterplane, so that the added mass of {names} "
            "makes and takes energy on the way into the water and out of it; use the method "
            "'exact', or added_mass='none'",
            BuoyancyWarning,
            stacklevel=3,
        )


def check_waves(model: mujoco.MjModel, water: Water, hulls: Sequence[Hull]) -> None:
    """Warn of waves that break, and refuse waves in water in which a floating body is aground.

    From any side, hulls show no more than half their area (Cauchy's projection formula). The volume
    that a body displaces, over that, is its least draft in any attitude.

    Raises:
        ModelError: a floating body has more draft than the water is deep.
    """
    for warning in water.warnings:
        warnings.warn(f"the water has {warning}", BuoyancyWarning, stacklevel=3)
    shallowest = float(np.min(water.rows[:, DEPTH], initial=np.inf))
    if math.isinf(shallowest):
        return
    masses = find_weighing_masses(model)
    for bodies in group_floating_bodies(model):
        of_vessel = [hull for hull in hulls if hull.body in bodies]
        if not of_vessel or find_tether(model, bodies) is not None:
            continue
        volume = min(
            float(masses[bodies].sum()) / water.density,
            sum(hull.displaced_volume for hull in of_vessel),
        )
        least_draft = volume / (0.5 * sum(hull.mesh.area for hull in of_vessel))
        if least_draft > shallowest:
            raise ModelError(
                f"the waves run in water {shallowest:g} m deep, and body "
                f"'{body_name(model, of_vessel[0].body)}' has a draft of at least "
                f"{least_draft:.3g} m in any attitude; make the waves' depth greater"
            )
