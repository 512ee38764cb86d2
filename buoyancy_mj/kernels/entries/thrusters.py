"""Thrusters as C functions of the addresses of mjModel, mjData and a `Propulsor`."""

from numba import int64

from buoyancy_mj.kernels.entries.views import view, view_engine
from buoyancy_mj.kernels.sea import Sea
from buoyancy_mj.kernels.vehicle import thrusters
from buoyancy_mj.kernels.vehicle.propulsors import Propulsor, Surroundings


def advance_thruster(model: int64, data: int64, thruster: int64) -> int64:
    """See `thrusters.advance`; returns 0, for it cannot fail."""
    known = view(thruster, Propulsor)
    around = view_engine(model, data, known.device.offsets, Surroundings)
    thrusters.advance(known, around, view(known.device.sea, Sea))
    return 0


def push_thruster(model: int64, data: int64, thruster: int64) -> int64:
    """See `thrusters.push`; returns 0, for it cannot fail."""
    known = view(thruster, Propulsor)
    around = view_engine(model, data, known.device.offsets, Surroundings)
    thrusters.push(known, around, view(known.device.sea, Sea))
    return 0
