"""Thrusters in models: put into a spec, found in a model, read after a step."""

import dataclasses

import mujoco
import numpy as np

from buoyancy_mj.engine.device_kinds import kind_of
from buoyancy_mj.engine.devices import read_device
from buoyancy_mj.errors import ModelError, choices, describe
from buoyancy_mj.kernels.vehicle import thrusters as kernel
from buoyancy_mj.kernels.vehicle.rotor import THRUST, TORQUE
from buoyancy_mj.values import read_text
from buoyancy_mj.vehicle.thrusters.plugin import PLUGIN, read_thruster
from buoyancy_mj.vehicle.thrusters.texts import write_thruster
from buoyancy_mj.vehicle.thrusters.thruster import Thruster

HANDS = {"right": 1.0, "left": -1.0, "none": 0.0}
"""Ways a propeller may turn, and the sign of its rotation about z of its site to push along z."""


@dataclasses.dataclass(frozen=True)
class ThrusterReading:
    """What a thruster did in the last pass over the data."""

    name: str
    """Name of the actuator."""
    thrust: float
    """Along z of its site [N]."""
    torque: float
    """Of the water against the rotor [N m]; it has the sign of the speed where it brakes."""
    rotor_speed: float
    """[rev/s]; above 0 to push along z."""
    inflow_speed: float
    """Of the disc through the water along z, less the wake [m/s]; 0 where no inflow matters."""
    wet_share: float
    """Share of its disc under water."""
    ventilation_loss: float
    """Share of the thrust of the wet part that air takes."""
    current: float
    """From the supply [A]; 0 where no table says it."""
    power: float
    """From the supply [W]; 0 where no table says it."""


def add_thruster(
    spec: mujoco.MjSpec,
    site: str,
    thruster: Thruster,
    name: str | None = None,
    *,
    hand: str = "right",
) -> mujoco.MjsActuator:
    """Put a thruster at a site of a model; it pushes along z of the site.

    Its control is bounded by what it has. MuJoCo keeps what it keeps in `data.act`.

    Args:
        spec: the model.
        site: name of the site at the middle of the propeller's disc.
        thruster: what it is like.
        name: of the actuator and its plugin instance; that of the site if None.
        hand: 'right' for a propeller that turns about +z to push along z, 'left' for the other way,
            'none' for two that turn against each other.

    Returns:
        The actuator, for `group` and the like.

    Raises:
        ModelError: no such site, one that has a thruster, a name that is taken, an unknown hand.

    Example:
        >>> spec = mujoco.MjSpec.from_file("vehicle.xml")
        >>> site = spec.worldbody.first_body().add_site(name="stern", quat=[0.7, 0.0, 0.7, 0.0])
        >>> actuator = add_thruster(spec, "stern", Thruster(preset="t200", voltage=16.0))
        >>> model = spec.compile()
    """
    if not isinstance(spec, mujoco.MjSpec):
        raise ModelError(f"spec is {describe(spec)}; it must be an MjSpec")
    if not isinstance(thruster, Thruster):
        raise ModelError(
            f"thruster is {describe(thruster)}; it must be a Thruster, as Thruster(preset='t200')"
        )
    if hand not in tuple(HANDS):
        raise ModelError(f"thruster hand is {describe(hand)}; {choices(hand, HANDS)}")
    sites = [str(one.name) for one in spec.sites if one.name]
    if site not in sites:
        raise ModelError(f"the model has no site {describe(site)}; {choices(site, sites)}")
    name = read_text(ModelError, "name of the thruster", site if name is None else name)
    if any(str(plugin.name) == name for plugin in spec.plugins) or spec.actuator(name) is not None:
        raise ModelError(
            f"the model already has an actuator or a plugin instance '{name}'; "
            "give the thruster another name (name=)"
        )
    if thruster.inertia and not HANDS[hand]:
        raise ModelError(
            "a thruster with inertia has a hand; give hand='right' or 'left', or leave inertia out"
        )
    for other in spec.actuators:
        if other.plugin.active and other.plugin.plugin_name == PLUGIN and other.target == site:
            raise ModelError(
                f"the site '{site}' has the thruster '{other.name}' already; "
                "give each a site of its own"
            )

    spec.activate_plugin(PLUGIN)
    plugin = spec.add_plugin(name=name, plugin_name=PLUGIN, active=True)
    plugin.config = write_thruster(thruster)
    end = thruster.curves.curve[-1]
    actuator = spec.add_actuator(
        name=name,
        target=site,
        trntype=mujoco.mjtTrn.mjTRN_SITE,
        gear=[0.0, 0.0, 1.0, 0.0, 0.0, -HANDS[hand] * end[TORQUE] / end[THRUST]],
        ctrllimited=True,
        ctrlrange=thruster.control_range(),
        actdim=len(thruster.states) or -1,
    )
    actuator.plugin.active = True
    actuator.plugin.plugin_name = PLUGIN
    actuator.plugin.name = name
    return actuator


def find_thruster(model: mujoco.MjModel, actuator: int | str) -> Thruster | None:
    """The thruster that an actuator is; None for another kind of actuator.

    Args:
        model: any model.
        actuator: its index or its name.

    Raises:
        ModelError: there is no such actuator.
    """
    index = _find_actuator(model, actuator)
    kind = kind_of(model, int(model.actuator_plugin[index]))
    return read_thruster(model, index) if kind is not None and kind.plugin == PLUGIN else None


def read_thrusters(model: mujoco.MjModel, data: mujoco.MjData) -> tuple[ThrusterReading, ...]:
    """What each thruster of a model did in the last pass over its data, in the model's order.

    Raises:
        ModelError: the configuration of one makes no sense.
    """
    found = ((i, find_thruster(model, i)) for i in range(model.nactuator))
    return tuple(_read(model, data, i, thruster) for i, thruster in found if thruster is not None)


def _read(
    model: mujoco.MjModel, data: mujoco.MjData, actuator: int, thruster: Thruster
) -> ThrusterReading:
    """What one thruster did."""
    read = read_device(data, int(model.actuator_plugin[actuator]))
    if not len(read):
        read = np.zeros(kernel.READINGS)
    current = float(read[kernel.READ_CURRENT])
    return ThrusterReading(
        name=str(model.actuator(actuator).name),
        thrust=float(read[kernel.READ_THRUST]),
        torque=float(read[kernel.READ_TORQUE]),
        rotor_speed=float(read[kernel.READ_SPEED]),
        inflow_speed=float(read[kernel.READ_INFLOW]),
        wet_share=float(read[kernel.READ_WET]),
        ventilation_loss=float(read[kernel.READ_LOST]),
        current=current,
        power=current * thruster.supply,
    )


def _find_actuator(model: mujoco.MjModel, actuator: int | str) -> int:
    """The index of an actuator."""
    names = [str(model.actuator(i).name) for i in range(model.nactuator)]
    if isinstance(actuator, str):
        if actuator not in names:
            raise ModelError(
                f"the model has no actuator {describe(actuator)}; {choices(actuator, names)}"
            )
        return names.index(actuator)
    if not 0 <= actuator < model.nactuator:
        raise ModelError(
            f"actuator is {describe(actuator)}; the model has {model.nactuator} of them, from 0 on"
        )
    return int(actuator)
