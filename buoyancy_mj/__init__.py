"""Water for MuJoCo: any MJCF vehicle floats, rights itself and rides waves, exact on its own meshes."""

from buoyancy_mj.buoyancy import Buoyancy as Buoyancy
from buoyancy_mj.drag import Drag as Drag
from buoyancy_mj.errors import BuoyancyError as BuoyancyError
from buoyancy_mj.errors import BuoyancyWarning as BuoyancyWarning
from buoyancy_mj.errors import DivergenceError as DivergenceError
from buoyancy_mj.errors import MeshError as MeshError
from buoyancy_mj.errors import ModelError as ModelError
from buoyancy_mj.errors import RecordingError as RecordingError
from buoyancy_mj.errors import SceneError as SceneError
from buoyancy_mj.errors import WaterError as WaterError
from buoyancy_mj.frames import Frame as Frame
from buoyancy_mj.frames import Summary as Summary
from buoyancy_mj.loads import Loads as Loads
from buoyancy_mj.loads import Portion as Portion
from buoyancy_mj.mending import mended as mended
from buoyancy_mj.mesh import TriMesh as TriMesh
from buoyancy_mj.scene import Scene as Scene
from buoyancy_mj.scene import Start as Start
from buoyancy_mj.scene import read_scene as read_scene
from buoyancy_mj.simulation import Simulation as Simulation
from buoyancy_mj.submersion import Submersion as Submersion
from buoyancy_mj.submersion import submerge as submerge
from buoyancy_mj.water import LevelOscillation as LevelOscillation
from buoyancy_mj.water import RegularWave as RegularWave
from buoyancy_mj.water import Water as Water
from buoyancy_mj.water import wavenumber as wavenumber
