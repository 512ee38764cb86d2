"""Water for MuJoCo: any MJCF vehicle floats, rights itself and rides waves, on its own meshes."""

# first of all: it decides where the others come from
from buoyancy_mj import _launch as _launch  # isort: split

import dataclasses as _dataclasses
import importlib as _importlib
from typing import TYPE_CHECKING, Any

from buoyancy_mj._names import read_homes as _read_homes
from buoyancy_mj.records import show_fields as _show_fields

if TYPE_CHECKING:
    from buoyancy_mj.drawing.draw_water import draw_water as draw_water
    from buoyancy_mj.engine.buoyancy import Buoyancy as Buoyancy
    from buoyancy_mj.engine.plugin import add_water as add_water
    from buoyancy_mj.engine.plugin import water_in as water_in
    from buoyancy_mj.environments.sauvc.arena import sauvc_arena as sauvc_arena
    from buoyancy_mj.environments.sauvc.mission import Mission as Mission
    from buoyancy_mj.environments.sauvc.mission import mission as mission
    from buoyancy_mj.environments.sauvc.report import Event as Event
    from buoyancy_mj.environments.sauvc.report import MissionReport as MissionReport
    from buoyancy_mj.errors import AutopilotError as AutopilotError
    from buoyancy_mj.errors import BallastError as BallastError
    from buoyancy_mj.errors import BuoyancyError as BuoyancyError
    from buoyancy_mj.errors import BuoyancyWarning as BuoyancyWarning
    from buoyancy_mj.errors import ControlError as ControlError
    from buoyancy_mj.errors import DivergenceError as DivergenceError
    from buoyancy_mj.errors import DrawingError as DrawingError
    from buoyancy_mj.errors import EngineError as EngineError
    from buoyancy_mj.errors import EquilibriumError as EquilibriumError
    from buoyancy_mj.errors import MeshError as MeshError
    from buoyancy_mj.errors import MethodError as MethodError
    from buoyancy_mj.errors import ModelError as ModelError
    from buoyancy_mj.errors import RecordingError as RecordingError
    from buoyancy_mj.errors import ResponseError as ResponseError
    from buoyancy_mj.errors import SceneError as SceneError
    from buoyancy_mj.errors import SweepError as SweepError
    from buoyancy_mj.errors import WaterError as WaterError
    from buoyancy_mj.hulls.ballasts import Bladder as Bladder
    from buoyancy_mj.hulls.ballasts import Compartment as Compartment
    from buoyancy_mj.hulls.ballasts import Tank as Tank
    from buoyancy_mj.hulls.selection import Selection as Selection
    from buoyancy_mj.loads.coefficients import Coefficients as Coefficients
    from buoyancy_mj.loads.coefficients import add_coefficients as add_coefficients
    from buoyancy_mj.loads.coefficients import read_coefficients as read_coefficients
    from buoyancy_mj.loads.damping import Damping as Damping
    from buoyancy_mj.loads.damping import Panels as Panels
    from buoyancy_mj.loads.damping import Silhouette as Silhouette
    from buoyancy_mj.loads.foils import Foil as Foil
    from buoyancy_mj.loads.loads import Loads as Loads
    from buoyancy_mj.loads.loads import Portion as Portion
    from buoyancy_mj.meshes.mesh import TriMesh as TriMesh
    from buoyancy_mj.meshes.repair import repair as repair
    from buoyancy_mj.responses.decay import Decay as Decay
    from buoyancy_mj.responses.decay import decay as decay
    from buoyancy_mj.responses.respond import respond as respond
    from buoyancy_mj.responses.responses import Responses as Responses
    from buoyancy_mj.scenes.fleet import Vehicle as Vehicle
    from buoyancy_mj.scenes.frames import Frame as Frame
    from buoyancy_mj.scenes.frames import VehicleFrame as VehicleFrame
    from buoyancy_mj.scenes.objective import Objective as Objective
    from buoyancy_mj.scenes.objective import objective as objective
    from buoyancy_mj.scenes.scene import Scene as Scene
    from buoyancy_mj.scenes.scene import read_scene as read_scene
    from buoyancy_mj.scenes.scene_vehicle import SceneVehicle as SceneVehicle
    from buoyancy_mj.scenes.scene_vehicle import Start as Start
    from buoyancy_mj.scenes.seakeeping import Seakeeping as Seakeeping
    from buoyancy_mj.scenes.seakeeping import Spread as Spread
    from buoyancy_mj.scenes.simulation import Simulation as Simulation
    from buoyancy_mj.scenes.summary import Summary as Summary
    from buoyancy_mj.scenes.summary import VehicleSummary as VehicleSummary
    from buoyancy_mj.scenes.sweep import Sweep as Sweep
    from buoyancy_mj.sea.currents import CurrentProfile as CurrentProfile
    from buoyancy_mj.sea.currents import CurrentSeries as CurrentSeries
    from buoyancy_mj.sea.dispersion import wavenumber as wavenumber
    from buoyancy_mj.sea.spectra import JonswapSea as JonswapSea
    from buoyancy_mj.sea.spectra import PiersonMoskowitzSea as PiersonMoskowitzSea
    from buoyancy_mj.sea.water import Water as Water
    from buoyancy_mj.sea.waves import LevelOscillation as LevelOscillation
    from buoyancy_mj.sea.waves import RegularWave as RegularWave
    from buoyancy_mj.settings.settings import Settings as Settings
    from buoyancy_mj.statics.ballast import Ballast as Ballast
    from buoyancy_mj.statics.ballast import ballast as ballast
    from buoyancy_mj.statics.ballast_items import BallastItem as BallastItem
    from buoyancy_mj.statics.equilibrium import Equilibrium as Equilibrium
    from buoyancy_mj.statics.equilibrium import equilibria as equilibria
    from buoyancy_mj.statics.equilibrium import equilibrium as equilibrium
    from buoyancy_mj.statics.hydrostatics import Hydrostatics as Hydrostatics
    from buoyancy_mj.statics.hydrostatics import hydrostatics as hydrostatics
    from buoyancy_mj.statics.righting import RightingArm as RightingArm
    from buoyancy_mj.statics.righting import righting_arm as righting_arm
    from buoyancy_mj.submersion.convex_hull import ConvexHull as ConvexHull
    from buoyancy_mj.submersion.exact import Exact as Exact
    from buoyancy_mj.submersion.sections import Sections as Sections
    from buoyancy_mj.submersion.submerge import Submersion as Submersion
    from buoyancy_mj.submersion.submerge import submerge as submerge
    from buoyancy_mj.vehicle.allocation import Allocation as Allocation
    from buoyancy_mj.vehicle.allocation import allocation as allocation
    from buoyancy_mj.vehicle.ballast import add_ballast as add_ballast
    from buoyancy_mj.vehicle.control.controller import Control as Control
    from buoyancy_mj.vehicle.control.controller import Controller as Controller
    from buoyancy_mj.vehicle.control.controller import start_controller as start_controller
    from buoyancy_mj.vehicle.control.course import Waypoint as Waypoint
    from buoyancy_mj.vehicle.control.hold import Hold as Hold
    from buoyancy_mj.vehicle.control.keyframes import Keyframes as Keyframes
    from buoyancy_mj.vehicle.control.lqr import Lqr as Lqr
    from buoyancy_mj.vehicle.control.motion import ControlSensors as ControlSensors
    from buoyancy_mj.vehicle.control.program import Program as Program
    from buoyancy_mj.vehicle.sensors.adding import add_sensor as add_sensor
    from buoyancy_mj.vehicle.sensors.adding import find_streams as find_streams
    from buoyancy_mj.vehicle.sensors.altimeter import Altimeter as Altimeter
    from buoyancy_mj.vehicle.sensors.dvl import Dvl as Dvl
    from buoyancy_mj.vehicle.sensors.hydrophone import Hydrophone as Hydrophone
    from buoyancy_mj.vehicle.sensors.pressure import Pressure as Pressure
    from buoyancy_mj.vehicle.sensors.surface import Depth as Depth
    from buoyancy_mj.vehicle.sensors.surface import Elevation as Elevation
    from buoyancy_mj.vehicle.sensors.surface import Wet as Wet
    from buoyancy_mj.vehicle.sensors.velocities import SpeedThroughWater as SpeedThroughWater
    from buoyancy_mj.vehicle.sensors.velocities import WaterVelocity as WaterVelocity
    from buoyancy_mj.vehicle.thrusters.adding import ThrusterReading as ThrusterReading
    from buoyancy_mj.vehicle.thrusters.adding import add_thruster as add_thruster
    from buoyancy_mj.vehicle.thrusters.adding import find_thruster as find_thruster
    from buoyancy_mj.vehicle.thrusters.adding import read_thrusters as read_thrusters
    from buoyancy_mj.vehicle.thrusters.thruster import Thruster as Thruster
    from buoyancy_mj.viz.recorder import Recorder as Recorder

    __version__: str

# each name comes from its module when it is first asked for
_HOMES = _read_homes(__file__)
if not TYPE_CHECKING:
    __all__ = [*_HOMES]


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version

        return version(__name__)
    if name not in _HOMES:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    # whoever uses the package has the plugins whole, and is told where kernels are kept
    _importlib.import_module("buoyancy_mj.vehicle.plugins")
    value = getattr(_importlib.import_module(_HOMES[name]), name)
    if isinstance(value, type) and _dataclasses.is_dataclass(value):
        _show_fields(value)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_HOMES})


# MuJoCo knows the plugins of models from now on; a command of ours imports them when it begins
if not _launch.IS_COMMAND_LINE:
    # MuJoCo first: it asks for the plugins itself, of a module that has to be whole by then
    _importlib.import_module("mujoco")
    _importlib.import_module("buoyancy_mj.engine.announcing").announce()
