"""Sites, actuators and sensors: what devices read and write of mjModel and mjData."""

from typing import Annotated, NamedTuple

import numpy as np

from buoyancy_mj.kernels.arrays import Doubles, Int32s, Truths
from buoyancy_mj.kernels.multibody import Bodies, Geoms, Joints, Option


class Sites(NamedTuple):
    """Where devices are mounted."""

    site_bodyid: Annotated[Int32s, "mjModel", ("nsite",)]
    """Body of each."""
    site_xpos: Annotated[Doubles, "mjData", ("nsite", 3)]
    """Origins [m]."""
    site_xmat: Annotated[Doubles, "mjData", ("nsite", 9)]
    """world_from_site, row-major."""


class Actuators(NamedTuple):
    """Commands, states and forces."""

    actuator_group: Annotated[Int32s, "mjModel", ("nactuator",)]
    """Groups, which an option may switch off."""
    actuator_ctrllimited: Annotated[Truths, "mjModel", ("nu",)]
    """Whether the range of commands holds."""
    actuator_ctrlrange: Annotated[Doubles, "mjModel", ("nu", 2)]
    """Least and most command."""
    actuator_actadr: Annotated[Int32s, "mjModel", ("nactuator",)]
    """The first state of each; -1 for none."""
    ctrl: Annotated[Doubles, "mjData", ("nu",)]
    """Commands."""
    act: Annotated[Doubles, "mjData", ("na",)]
    """States."""
    act_dot: Annotated[Doubles, "mjData", ("na",)]
    """Rates of the states [1/s]."""
    actuator_force: Annotated[Doubles, "mjData", ("nout",)]
    """Forces along the actuators."""


class Sensing(NamedTuple):
    """What sensors read out."""

    sensordata: Annotated[Doubles, "mjData", ("nsensordata",)]
    """Readings of all sensors."""
    plugin_state: Annotated[Doubles, "mjData", ("npluginstate",)]
    """What sensors keep from one reading to the next."""


class Equipment(NamedTuple):
    """All that a device reads of the engine, and the arrays that it writes to."""

    option: Option
    integrator: Annotated[np.int32, "mjModel.opt"]
    """One of mjtIntegrator."""
    disableactuator: Annotated[np.int32, "mjModel.opt"]
    """Bits of the groups of actuators that are switched off."""
    time: Annotated[float, "mjData"]
    """[s]."""
    bodies: Bodies
    joints: Joints
    geoms: Geoms
    sites: Sites
    actuators: Actuators
    sensing: Sensing
    qfrc_passive: Annotated[Doubles, "mjData", ("nv",)]
    """Generalized passive forces."""


class Motions(NamedTuple):
    """How bodies move: what `motion.find_velocity` reads of `multibody.Bodies`."""

    body_rootid: Annotated[Int32s, "mjModel", ("nbody",)]
    """Root of the kinematic tree of each."""
    subtree_com: Annotated[Doubles, "mjData", ("nbody", 3)]
    """Centre of mass of each and all below it [m]."""
    cvel: Annotated[Doubles, "mjData", ("nbody", 6)]
    """Rotation [rad/s], then translation [m/s] at the root's centre of mass."""


class SensorEquipment(NamedTuple):
    """The part of `Equipment` that a sensor reads and writes to; the less, the faster compiled."""

    option: Option
    time: Annotated[float, "mjData"]
    """[s]."""
    bodies: Motions
    sites: Sites
    sensing: Sensing
