"""`Battery`: what the thrusters of a vehicle draw from their supply."""

import mujoco

from buoyancy_mj.autopilot.thrusters import find_actuators
from buoyancy_mj.engine.devices import read_device
from buoyancy_mj.kernels.vehicle.thrusters import READ_CURRENT
from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.vehicle.thrusters.adding import find_thruster


class Battery:
    """The supply of a vehicle's thrusters, whose voltage does not fall under load.

    Thrusters of several voltages are thought of as fed by one battery of the highest, through
    converters that lose nothing.

    Args:
        model: the model.
        vehicle: the vehicle.
    """

    def __init__(self, model: mujoco.MjModel, vehicle: Vehicle) -> None:
        found = {i: find_thruster(model, i) for i in find_actuators(model, vehicle).values()}
        supplies = {
            int(model.actuator_plugin[i]): thruster.supply
            for i, thruster in found.items()
            if thruster is not None and thruster.supply > 0.0
        }
        self.voltage = max(supplies.values(), default=0.0)
        """Voltage [V]; 0 where no thruster says what it draws."""
        self._shares = [(instance, supply / self.voltage) for instance, supply in supplies.items()]

    def read(self, data: mujoco.MjData) -> tuple[float, float] | None:
        """Voltage [V] and current [A] in the last pass over data; None if nothing is known."""
        if not self._shares:
            return None
        current = 0.0
        for instance, share in self._shares:
            read = read_device(data, instance)
            current += share * float(read[READ_CURRENT]) if len(read) else 0.0
        return self.voltage, current
