"""`Basin`: a scene under way, in water that may be changed at any time."""

import dataclasses
import warnings
from collections.abc import Callable, Mapping

import mujoco
import numpy as np

from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.engine.c_functions import raise_causes
from buoyancy_mj.errors import BuoyancyWarning
from buoyancy_mj.scenes.assembly import assemble
from buoyancy_mj.scenes.divergence import Limits
from buoyancy_mj.scenes.fleet import Vehicle, build_vehicles
from buoyancy_mj.scenes.frame_source import FrameSource
from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.scenes.scene import Scene
from buoyancy_mj.scenes.steering import Steering
from buoyancy_mj.sea.water import Water

_STATE = mujoco.mjtState.mjSTATE_INTEGRATION


class Basin:
    """The model of a scene, its state, and the water that acts on it now.

    The water is lent to MuJoCo for the length of each step, so that another one takes its place
    between two steps, and nothing is compiled.

    Args:
        scene: the scene; its water is the first.
        trust: whether to run the Python files that the scene names as controllers.

    Raises:
        ModelError, MeshError, SceneError, ControlError: what `Simulation` raises.
    """

    def __init__(self, scene: Scene, *, trust: bool = False) -> None:
        self.scene = scene
        """The scene."""
        self.model, self.data, self._afloat = assemble(scene)
        self.buoyancy: Buoyancy
        """The water that acts, on the hulls of the model."""
        self.vehicles: Mapping[str, Vehicle]
        """What floats of the scene's vehicles, by name."""
        self.doubts: tuple[str, ...]
        """What should be known of the water: waves that would break, and the like."""
        # a run that diverges ends with an error, and is not set back to its start unseen
        self.model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)
        self.put_into(scene.water)

        # the start, to which a reset leads back
        self._pass_over(self.data)
        self._limits = Limits(scene, self.model, self.data)
        self._start = np.empty(mujoco.mj_stateSize(self.model, _STATE))
        mujoco.mj_getState(self.model, self.data, self._start, _STATE)
        self._trust = trust
        self._steering = self._take_helm()

    @property
    def water(self) -> Water:
        """The sea that acts, with waves under the model's gravity."""
        return self.buoyancy.water

    def put_into(self, water: Water) -> None:
        """Let another water act from the next step on; what was there stays if this one is refused.

        Raises:
            WaterError, ModelError: what `Buoyancy` raises.
        """
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", BuoyancyWarning)
            buoyancy = Buoyancy(self.model, dataclasses.replace(self.scene, water=water))
            vehicles = build_vehicles(self.model, buoyancy, self._afloat)
        self.doubts = tuple(str(entry.message) for entry in caught)
        self.buoyancy, self.vehicles = buoyancy, vehicles
        self._source = FrameSource(self.model, buoyancy, vehicles)

    def advance(self, step: Callable[[mujoco.MjModel, mujoco.MjData], object]) -> None:
        """Let something take steps with the water acting, after the controllers that are due.

        Args:
            step: takes no step, one or several, as `mujoco.mj_step`.

        Raises:
            ControlError: a controller fails.
            DivergenceError: a position or velocity left all reason.
        """
        before = float(self.data.time)
        if self._steering is not None:
            self._steering.update(self.data)
        with self.buoyancy.installed(), raise_causes():
            step(self.model, self.data)
        now = float(self.data.time)
        if self._steering is not None:
            self._steering.note_steps(round((now - before) / self.model.opt.timestep))
        if now != before:
            self._limits.check_data(self.data, before)

    def frame(self) -> Frame:
        """The present: poses and loads at exactly this time."""
        return self._source.take(self.data, self._pass_over)

    def reset(self, key: int | None = None) -> None:
        """Go back to the start of the scene, in the water that acts now.

        Args:
            key: index of the keyframe to go to instead; None or a negative one for the start.
        """
        if key is not None and key >= 0:
            mujoco.mj_resetDataKeyframe(self.model, self.data, key)
        else:
            mujoco.mj_resetData(self.model, self.data)
            mujoco.mj_setState(self.model, self.data, self._start, _STATE)
        self._pass_over(self.data)
        self._steering = self._take_helm()

    def _take_helm(self) -> Steering | None:
        """The controllers of the scene, from the state of the data."""
        if not self.scene.control:
            return None
        return Steering(self.scene, self.model, self.data, self._afloat, trust=self._trust)

    def _pass_over(self, data: mujoco.MjData) -> None:
        """A pass over data, with the water at work."""
        with self.buoyancy.installed(), raise_causes():
            mujoco.mj_forward(self.model, data)
        mujoco.mj_energyPos(self.model, data)
        mujoco.mj_energyVel(self.model, data)
