"""All plugins of the engine: whoever imports this has put their compiled hooks into MuJoCo.

It also tells of the place where compiled kernels are kept, if that is an unusual one.
"""

import warnings

from buoyancy_mj.engine import plugin as plugin
from buoyancy_mj.errors import BuoyancyWarning
from buoyancy_mj.kernels.caches import NOTICES
from buoyancy_mj.vehicle import ballast as ballast
from buoyancy_mj.vehicle.sensors import altimeter as altimeter
from buoyancy_mj.vehicle.sensors import dvl as dvl
from buoyancy_mj.vehicle.sensors import hydrophone as hydrophone
from buoyancy_mj.vehicle.sensors import pressure as pressure
from buoyancy_mj.vehicle.sensors import surface as surface
from buoyancy_mj.vehicle.sensors import velocities as velocities
from buoyancy_mj.vehicle.thrusters import adding as adding

for _notice in NOTICES:
    warnings.warn(_notice, BuoyancyWarning, stacklevel=2)
