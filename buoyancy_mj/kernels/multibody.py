"""Bodies, joints and geoms: what kernels read of mjModel and mjData, under MuJoCo's names."""

import math
from typing import Annotated, NamedTuple

import numpy as np

from buoyancy_mj.kernels.arrays import Doubles, Int32s, Truths, Words
from buoyancy_mj.kernels.compiling import njit


class Option(NamedTuple):
    """Options of the simulation."""

    timestep: Annotated[float, "mjModel.opt"]
    """[s]."""
    gravity: Annotated[Doubles, "mjModel.opt", (3,)]
    """[m/s^2]."""
    disableflags: Annotated[np.int32, "mjModel.opt"]
    """Bits of mjtDisableBit."""
    solver: Annotated[np.int32, "mjModel.opt"]
    """One of mjtSolver."""
    noslip_iterations: Annotated[np.int32, "mjModel.opt"]
    """0 for no such solver."""


class Bodies(NamedTuple):
    """Where bodies are, how they move and what they weigh."""

    body_rootid: Annotated[Int32s, "mjModel", ("nbody",)]
    """Root of the kinematic tree of each."""
    body_mass: Annotated[Doubles, "mjModel", ("nbody",)]
    """[kg]."""
    body_inertia: Annotated[Doubles, "mjModel", ("nbody", 3)]
    """Principal moments of inertia [kg m^2]."""
    xpos: Annotated[Doubles, "mjData", ("nbody", 3)]
    """Origins [m]."""
    xmat: Annotated[Doubles, "mjData", ("nbody", 9)]
    """world_from_body, row-major."""
    xipos: Annotated[Doubles, "mjData", ("nbody", 3)]
    """Centres of mass [m]."""
    ximat: Annotated[Doubles, "mjData", ("nbody", 9)]
    """world_from_inertia, row-major."""
    subtree_com: Annotated[Doubles, "mjData", ("nbody", 3)]
    """Centre of mass of each and all below it [m]."""
    cvel: Annotated[Doubles, "mjData", ("nbody", 6)]
    """Rotation [rad/s], then translation [m/s] at the root's centre of mass."""


class Joints(NamedTuple):
    """The kinematic trees, and the axes of their degrees of freedom."""

    body_parentid: Annotated[Int32s, "mjModel", ("nbody",)]
    """Parent of each body."""
    body_dofnum: Annotated[Int32s, "mjModel", ("nbody",)]
    """Degrees of freedom of each body's joints."""
    body_dofadr: Annotated[Int32s, "mjModel", ("nbody",)]
    """The first of them."""
    dof_parentid: Annotated[Int32s, "mjModel", ("nv",)]
    """The next degree of freedom towards the world; -1 for none."""
    cdof: Annotated[Doubles, "mjData", ("nv", 6)]
    """Axes: rotation, then translation at the root's centre of mass."""
    cdof_dot: Annotated[Doubles, "mjData", ("nv", 6)]
    """Their rates."""
    qvel: Annotated[Doubles, "mjData", ("nv",)]
    """Velocities."""


class Geoms(NamedTuple):
    """Where the frames of hulls are."""

    geom_xpos: Annotated[Doubles, "mjData", ("ngeom", 3)]
    """Origins [m]."""
    geom_xmat: Annotated[Doubles, "mjData", ("ngeom", 9)]
    """world_from_geom, row-major."""


class MassMatrix(NamedTuple):
    """The mass matrix, its lower triangle by rows."""

    M_rownnz: Annotated[Int32s, "mjModel", ("nv",)]
    """Elements of each row."""
    M_rowadr: Annotated[Int32s, "mjModel", ("nv",)]
    """Where each row begins."""
    M_colind: Annotated[Int32s, "mjModel", ("nC",)]
    """Column of each element."""
    M: Annotated[Doubles, "mjData", ("nC",)]
    """The elements, which the water's added mass is written to."""
    qLD: Annotated[Doubles, "mjData", ("nC",)]  # noqa: N815 - MuJoCo's name
    """L of the factorization L^T D L of the mass matrix, without the added mass of this pass."""
    qLDiagInv: Annotated[Doubles, "mjData", ("nv",)]  # noqa: N815 - MuJoCo's name
    """One over D."""


class Equalities(NamedTuple):
    """The equality constraints, by which welds hold bodies together."""

    eq_active: Annotated[Truths, "mjData", ("neq",)]
    """Whether each acts now."""


class Commands(NamedTuple):
    """What ballast is told, what it holds, and where it opens."""

    act: Annotated[Doubles, "mjData", ("na",)]
    """States of the actuators."""
    ctrl: Annotated[Doubles, "mjData", ("nu",)]
    """Commands."""
    actuator_ctrllimited: Annotated[Truths, "mjModel", ("nu",)]
    """Whether the range of commands holds."""
    actuator_ctrlrange: Annotated[Doubles, "mjModel", ("nu", 2)]
    """Least and most command."""
    site_xpos: Annotated[Doubles, "mjData", ("nsite", 3)]
    """Origins of the sites [m]."""


class Engine(NamedTuple):
    """All that a pass of the water reads of the engine, and the two arrays that it writes to."""

    option: Option
    time: Annotated[float, "mjData"]
    """[s]."""
    bodies: Bodies
    joints: Joints
    geoms: Geoms
    mass_matrix: MassMatrix
    equalities: Equalities
    commands: Commands
    qfrc_passive: Annotated[Doubles, "mjData", ("nv",)]
    """Generalized passive forces, which the water's are added to."""


class Identity(NamedTuple):
    """By what compiled code knows a model again."""

    signature: Annotated[int, "mjModel"]
    """MuJoCo's compilation signature."""
    geom_size: Annotated[Words, "mjModel", ("ngeom", 3)]
    """Bits of the sizes of its geoms."""


GOLDEN = np.int64(-7046029254386353131)
"""2^64 over the golden ratio, as a signed word."""
NO_GRAVITY, PGS = 1 << 7, 0
"""MuJoCo's mjDSBL_GRAVITY and mjSOL_PGS."""


@njit(cache=True, error_model="numpy")
def sum_sizes(geom_size):
    """A sum over the bits of the sizes of all geoms (ngeom, 3), which other sizes change.

    The weights are multiples of the golden ratio. A power of two changes the highest bits alone, so
    that they are folded onto lower ones.
    """
    total = weight = np.int64(0)
    for geom in range(geom_size.shape[0]):
        for k in range(3):
            bits = geom_size[geom, k]
            weight += GOLDEN
            total += (bits ^ (bits >> 29)) * weight
    return total


@njit(cache=True, error_model="numpy")
def downward_gravity(gravity, disableflags):
    """Downward acceleration [m/s^2] of a model; NaN for gravity that is not along -z.

    It is 0 where the model's flags disable gravity.
    """
    if disableflags & NO_GRAVITY:
        return 0.0
    if gravity[0] != 0.0 or gravity[1] != 0.0 or gravity[2] > 0.0:
        return math.nan
    return -gravity[2]


@njit(cache=True, error_model="numpy", inline="always")
def last_dof(joints, body):
    """The last degree of freedom that moves a body; -1 for none.

    From it `dof_parentid` leads to all others.
    """
    b = body
    while b > 0 and joints.body_dofnum[b] == 0:
        b = joints.body_parentid[b]
    return joints.body_dofadr[b] + joints.body_dofnum[b] - 1 if b > 0 else -1
