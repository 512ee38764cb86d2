"""`Propulsor`: what compiled code knows of one thruster, and what of the engine it reads."""

from typing import Annotated, NamedTuple

import numpy as np

from buoyancy_mj.kernels.arrays import Doubles, Int32s, Truths
from buoyancy_mj.kernels.vehicle.devices import Device


class Propulsor(NamedTuple):
    """One thruster of one mjData."""

    device: Device
    site: int
    """Index of the site at the middle of its disc, whose z it pushes along."""
    actuator: int
    """Index of its actuator."""
    address: int
    """Index of its command in `ctrl`."""
    output: int
    """Index of its thrust in `actuator_force`."""
    state: int
    """Index in `act` of what follows the command with a lag: the speed [rad/s] of a rotor that has
    inertia, or else the command, from the one at which the rotor stands; -1 for no lag."""
    air: int
    """Index in `act` of the share of thrust that air takes; -1 for none."""
    neutral: float
    """The command at which the rotor stands."""
    deadband: float
    """From there to the first command that is heard."""
    absent: float
    """Commands below this are none."""
    diameter: float
    """[m]."""
    density: float
    """Of the water that the curve is for [kg/m^3]."""
    lag: float
    """[s]."""
    inertia: float
    """Of the rotor and the water that turns with it [kg m^2]."""
    limit: float
    """Torque of the motor at most [N m]."""
    hand: float
    """1 for a rotor that turns about +z to push ahead, -1 for the other way, 0 for no torque."""
    gear: float
    """Torque about z that the transmission of the actuator has for each newton [m]."""
    wake: float
    """Wake fraction."""
    recovery: float
    """Revolutions in which air leaves the disc."""
    drag: float
    """See `open_water.drag_blades`."""
    demands: Annotated[Doubles, ("k", 2)]
    """See `rotor.demand_speed`."""
    curve: Annotated[Doubles, ("m", 4)]
    """See `rotor`."""
    advance: Annotated[Doubles, ("j", 3)]
    """See `open_water`; no rows for a thrust that no flow changes."""
    water: Annotated[Doubles, (3,)]
    """Room for the water's velocity [m/s]."""


class Surroundings(NamedTuple):
    """All that a thruster reads of the engine, and the arrays that it writes to.

    A call hands each array on by seven words, so that these are as few as can be.
    """

    timestep: Annotated[float, "mjModel.opt"]
    """[s]."""
    disableflags: Annotated[np.int32, "mjModel.opt"]
    """Bits of mjtDisableBit."""
    integrator: Annotated[np.int32, "mjModel.opt"]
    """One of mjtIntegrator."""
    disableactuator: Annotated[np.int32, "mjModel.opt"]
    """Bits of the groups of actuators that are switched off."""
    time: Annotated[float, "mjData"]
    """[s]."""
    body_rootid: Annotated[Int32s, "mjModel", ("nbody",)]
    """Root of the kinematic tree of each body."""
    body_parentid: Annotated[Int32s, "mjModel", ("nbody",)]
    """Parent of each body."""
    body_dofnum: Annotated[Int32s, "mjModel", ("nbody",)]
    """Degrees of freedom of each body's joints."""
    body_dofadr: Annotated[Int32s, "mjModel", ("nbody",)]
    """The first of them."""
    dof_parentid: Annotated[Int32s, "mjModel", ("nv",)]
    """The next degree of freedom towards the world; -1 for none."""
    subtree_com: Annotated[Doubles, "mjData", ("nbody", 3)]
    """Centre of mass of each body and all below it [m]."""
    cvel: Annotated[Doubles, "mjData", ("nbody", 6)]
    """Rotation [rad/s], then translation [m/s] at the root's centre of mass."""
    cdof: Annotated[Doubles, "mjData", ("nv", 6)]
    """Axes of the degrees of freedom: rotation, then translation there."""
    site_bodyid: Annotated[Int32s, "mjModel", ("nsite",)]
    """Body of each site."""
    site_xpos: Annotated[Doubles, "mjData", ("nsite", 3)]
    """Origins of the sites [m]."""
    site_xmat: Annotated[Doubles, "mjData", ("nsite", 9)]
    """world_from_site, row-major."""
    actuator_group: Annotated[Int32s, "mjModel", ("nactuator",)]
    """Groups of the actuators, which an option may switch off."""
    actuator_ctrllimited: Annotated[Truths, "mjModel", ("nu",)]
    """Whether the range of commands holds."""
    actuator_ctrlrange: Annotated[Doubles, "mjModel", ("nu", 2)]
    """Least and most command."""
    ctrl: Annotated[Doubles, "mjData", ("nu",)]
    """Commands."""
    act: Annotated[Doubles, "mjData", ("na",)]
    """States of the actuators."""
    act_dot: Annotated[Doubles, "mjData", ("na",)]
    """Their rates [1/s]."""
    actuator_force: Annotated[Doubles, "mjData", ("nout",)]
    """Forces along the actuators [N]."""
    qfrc_passive: Annotated[Doubles, "mjData", ("nv",)]
    """Generalized passive forces."""
