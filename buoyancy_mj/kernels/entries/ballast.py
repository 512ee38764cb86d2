"""Ballast as C functions of the addresses of mjModel, mjData and a `BallastDevice`."""

from typing import NamedTuple

from numba import int64

from buoyancy_mj.kernels.ballast import Ballast, held_volume
from buoyancy_mj.kernels.entries.views import view, view_engine
from buoyancy_mj.kernels.flooding import BLADDER, find_flow
from buoyancy_mj.kernels.multibody import Engine, downward_gravity
from buoyancy_mj.kernels.sea import Sea
from buoyancy_mj.kernels.vehicle.devices import Device
from buoyancy_mj.kernels.vehicle.equipment import Equipment


class BallastDevice(NamedTuple):
    """A bladder, a tank or a compartment of one mjData."""

    device: Device
    ballast: Ballast
    """It alone."""
    dry_text: int
    """What the engine is told where it holds water and no water acts."""


def advance(model: int64, data: int64, device: int64) -> int64:
    """Write how fast the volume grows; returns 0, or the address of a text that tells why not."""
    known = view(device, BallastDevice)
    engine = view_engine(model, data, known.device.offsets, Engine)
    equipment = view_engine(model, data, known.device.offsets, Equipment)
    sea, ballast = view(known.device.sea, Sea), known.ballast
    held = held_volume(ballast, 0, engine.commands.act)
    if held > 0.0 and not sea.density > 0.0 and ballast.kinds[0] != BLADDER:
        return known.dry_text
    gravity = downward_gravity(engine.option.gravity, engine.option.disableflags)
    equipment.actuators.act_dot[ballast.acts[0]] = find_flow(
        ballast,
        0,
        engine.commands,
        engine.geoms,
        sea,
        engine.time,
        engine.option.timestep,
        gravity,
    )
    return 0


def compute(model: int64, data: int64, device: int64) -> int64:
    """Ballast pushes nothing as an actuator: its loads come with the water's; returns 0."""
    known = view(device, BallastDevice)
    equipment = view_engine(model, data, known.device.offsets, Equipment)
    equipment.actuators.actuator_force[known.ballast.outputs[0]] = 0.0
    return 0
