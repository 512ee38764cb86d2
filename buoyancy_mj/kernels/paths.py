"""Where the arrays that kernels read are in MuJoCo's structs."""

from buoyancy_mj.kernels.arrays import leaves
from buoyancy_mj.kernels.multibody import Engine, Identity
from buoyancy_mj.kernels.vehicle.equipment import Equipment
from buoyancy_mj.kernels.vehicle.propulsors import Surroundings

PATHS = tuple(
    dict.fromkeys(
        path
        for kind in (Engine, Identity, Equipment, Surroundings)
        for field in leaves(kind)
        for path in (field.path, *(f"mjModel.{n}" for n in field.shape if isinstance(n, str)))
    )
)
"""All of them, as "mjData.xpos", and the extents of the arrays, as "mjModel.nbody"."""
