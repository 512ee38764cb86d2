"""Thrusters as plugins of the engine: what an instance of a model is."""

import functools
import math
from collections.abc import Mapping

import mujoco
import numpy as np

from buoyancy_mj.engine.device_kinds import DeviceKind, Plan
from buoyancy_mj.engine.device_registration import register_kind
from buoyancy_mj.engine.model_memory import read_texts
from buoyancy_mj.errors import ModelError
from buoyancy_mj.kernels.entries import thrusters as entries
from buoyancy_mj.kernels.vehicle.devices import Device
from buoyancy_mj.kernels.vehicle.propulsors import Propulsor
from buoyancy_mj.kernels.vehicle.thrusters import READINGS
from buoyancy_mj.vehicle.thrusters.curves import DENSITY
from buoyancy_mj.vehicle.thrusters.texts import KEYS, parse_thruster
from buoyancy_mj.vehicle.thrusters.thruster import Thruster

PLUGIN = "buoyancy_mj.thruster"
"""Name of the engine plugin."""
RECOVERY = 10.0
"""Revolutions in which air leaves a propeller that does not say so. Thrust is seen to return later
than it was lost (Smogeli 2006, NTNU thesis 2006:187; Kozlowska et al. 2020, *J. Mar. Sci. Eng.* 8).
The number is an estimate: the lift of a blade alone comes back within one (Wagner 1925)."""


def read_thruster(model: mujoco.MjModel, actuator: int) -> Thruster:
    """The thruster that an actuator of this plugin is.

    Raises:
        ModelError: its configuration makes no sense.
    """
    instance = int(model.actuator_plugin[actuator])
    return parse_thruster(read_texts(model._address, instance, KEYS), _call(model, actuator))


def _plan(model: mujoco.MjModel, instance: int, texts: Mapping[str, str]) -> Plan:
    """What an instance of a model is."""
    owners = np.flatnonzero(model.actuator_plugin == instance)
    if len(owners) != 1:
        names = ", ".join(_call(model, int(i)) for i in owners)
        raise ModelError(
            f"a plugin instance of {PLUGIN} drives {names or 'no actuator'}; each thruster needs "
            "an instance of its own"
        )
    actuator = int(owners[0])
    where = _call(model, actuator)
    thruster = parse_thruster(texts, where)
    site = _find_site(model, actuator, where)
    _check_gear(model, actuator, where)
    _check_states(model, actuator, thruster, where)
    return Plan(
        body=int(model.site_bodyid[site]),
        make=functools.partial(_make, model, actuator, site, thruster),
        compute=entries.push_thruster,
        advance=entries.advance_thruster,
        readings=READINGS,
    )


def _make(
    model: mujoco.MjModel, actuator: int, site: int, thruster: Thruster, device: Device
) -> Propulsor:
    """What compiled code knows of a thruster."""
    first = int(model.actuator_actadr[actuator])
    at = {name: first + i for i, name in enumerate(thruster.states)}
    output = int(model.actuator_outadr[actuator])
    gear = float(model.actuator_gear[output, 5])
    curves = thruster.curves
    return Propulsor(
        device=device,
        site=site,
        actuator=actuator,
        address=int(model.actuator_ctrladr[actuator]),
        output=output,
        state=at.get("rotor", -1),
        air=at.get("air", -1),
        neutral=thruster.neutral,
        deadband=thruster.deadband,
        absent=thruster.least_heard,
        diameter=curves.diameter,
        density=DENSITY,
        lag=thruster.lag,
        inertia=thruster.inertia,
        limit=math.inf if thruster.torque is None else thruster.torque,
        # the hull turns against the rotor
        hand=float(-np.sign(gear)),
        gear=gear,
        wake=thruster.wake,
        recovery=RECOVERY if thruster.recovery is None else thruster.recovery,
        drag=curves.drag,
        demands=curves.demands,
        curve=curves.curve,
        advance=curves.advance,
        water=np.zeros(3),
    )


def _call(model: mujoco.MjModel, actuator: int) -> str:
    """How messages call a thruster."""
    name = str(model.actuator(actuator).name)
    return f"thruster '{name}'" if name else f"the thruster that is actuator {actuator}"


def _find_site(model: mujoco.MjModel, actuator: int, where: str) -> int:
    """The site of a thruster, which has no other."""
    site, reference = model.actuator_trnid[actuator].tolist()
    if model.actuator_trntype[actuator] != mujoco.mjtTrn.mjTRN_SITE or reference >= 0:
        raise ModelError(f"{where} must push at a site; give it site= alone")
    others = [
        int(i)
        for i in np.flatnonzero(model.actuator_trntype == mujoco.mjtTrn.mjTRN_SITE)
        if i != actuator
        and model.actuator_trnid[i, 0] == site
        and _is_thruster(model, int(i), actuator)
    ]
    if others:
        name = model.site(site).name
        raise ModelError(
            f"{where} and {_call(model, others[0])} push at one site, '{name}'; "
            "give each a site of its own"
        )
    return int(site)


def _is_thruster(model: mujoco.MjModel, actuator: int, other: int) -> bool:
    """Whether an actuator is of the same plugin as another."""
    one, two = model.actuator_plugin[[actuator, other]].tolist()
    return one >= 0 and int(model.plugin[one]) == int(model.plugin[two])


def _check_gear(model: mujoco.MjModel, actuator: int, where: str) -> None:
    """Refuse a transmission that does not carry a thrust along z of the site."""
    gear = model.actuator_gear[model.actuator_outadr[actuator]].tolist()
    if gear[:5] != [0.0, 0.0, 1.0, 0.0, 0.0] or not math.isfinite(gear[5]):
        words = " ".join(f"{number:g}" for number in gear)
        raise ModelError(
            f"{where} has the gear '{words}'; it must be '0 0 1 0 0 Q', with the torque of "
            "reaction Q for each newton: below 0 for a right-handed propeller, 0 for none"
        )
    if model.actuator_forcelimited[actuator]:
        raise ModelError(
            f"{where} has a forcerange, which would leave its torque as it was; "
            "remove it, and bound its control (ctrlrange)"
        )
    if model.actuator_delay[actuator] > 0.0:
        raise ModelError(f"{where} has a delay, which it does not keep; remove it, and state lag")


def _check_states(model: mujoco.MjModel, actuator: int, thruster: Thruster, where: str) -> None:
    """Refuse another number of states than the thruster keeps, and inertia without a hand."""
    states, got = thruster.states, int(model.actuator_actnum[actuator])
    if got != len(states):
        kept = " and ".join(_STATES[name] for name in states) or "nothing"
        raise ModelError(
            f'{where} has actdim {got}; it keeps {kept}, so write actdim="{len(states)}"'
        )
    if model.actuator_dyntype[actuator] != mujoco.mjtDyn.mjDYN_NONE:
        raise ModelError(
            f"{where} has a dyntype, which it does not follow; remove it, and state lag"
        )
    if model.actuator_actearly[actuator]:
        raise ModelError(f"{where} has actearly, which it does not follow; remove it")
    if thruster.inertia and model.actuator_gear[model.actuator_outadr[actuator], 5] == 0.0:
        raise ModelError(
            f"{where} states inertia, but its gear has no torque that tells its hand; "
            "write gear='0 0 1 0 0 Q', with Q below 0 for a right-handed propeller"
        )


_STATES = {"rotor": "what follows its control (lag)", "air": "the air at its disc (ventilation)"}
"""States in words."""

register_kind(
    DeviceKind(
        plugin=PLUGIN,
        keys=KEYS,
        plan=_plan,
        # it is told when passive forces are computed, to which it adds torque
        capability=int(mujoco.mjtPluginCapabilityBit.mjPLUGIN_ACTUATOR)
        | int(mujoco.mjtPluginCapabilityBit.mjPLUGIN_PASSIVE),
    )
)
