"""`Simulation`: run a scene frame by frame."""

import functools
import math
import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, nullcontext

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.engine.callbacks import PASSIVE
from buoyancy_mj.engine.instances import plugin_instances
from buoyancy_mj.engine.plugin import water_in
from buoyancy_mj.errors import BuoyancyWarning, ModelError
from buoyancy_mj.hulls.gravity import find_weighing_masses
from buoyancy_mj.records import ReadOnly
from buoyancy_mj.scenes.assembly import assemble
from buoyancy_mj.scenes.divergence import check_finite
from buoyancy_mj.scenes.frames import LAST, Energy, Frame, Summary
from buoyancy_mj.scenes.monitor import Monitor
from buoyancy_mj.scenes.scene import Scene
from buoyancy_mj.scenes.trajectory import Trajectory, poses_of
from buoyancy_mj.statics.vessel import PLAUSIBLE

_STATE = mujoco.mjtState.mjSTATE_INTEGRATION


class Simulation(ReadOnly):
    """A scene, assembled and ready to run once.

    Args:
        scene: what to run.
        through: where the water's forces enter; by 'qfrc_passive' the water is a part of the model,
            by 'xfrc_applied' a callback, see `Buoyancy.installed`.

    Raises:
        ModelError, MeshError, SceneError: what `assemble` and `Buoyancy` raise; also a vehicle
            whose displacement is absurd for its mass.
        EngineError: there is no such `through`.

    Example:
        `drafts = [frame.draft for frame in Simulation(read_scene(path)).frames()]`
    """

    def __init__(self, scene: Scene, *, through: str = PASSIVE) -> None:
        self.scene = scene
        """The scene."""
        self.model, self.data, bodies = assemble(scene, with_water=through == PASSIVE)
        # a diverging simulation ends with an error, and is not set back to its start
        self.model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)
        self.model.opt.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)

        # the water, in the model or lent to MuJoCo for each step
        self.buoyancy: Buoyancy
        """The water that acts."""
        self._lend_water: Callable[[], AbstractContextManager[object]]
        if plugin_instances(self.model):
            self.buoyancy = water_in(self.model)
            self._lend_water = nullcontext
        else:
            self.buoyancy = Buoyancy(self.model, scene)
            self._lend_water = functools.partial(self.buoyancy.installed, through=through)

        # the vehicle
        floating = self.buoyancy.floating
        self.vehicle = floating[floating < bodies]
        """Indices of the vehicle's bodies, without what floats in the environment."""
        self.hulls = tuple(hull for hull in self.buoyancy.hulls if hull.body < bodies)
        """The vehicle's hulls."""
        if not self.hulls:
            raise ModelError("the vehicle displaces no water; choose geoms of its own (--geoms)")
        self._masses = self.model.body_mass[self.vehicle]
        self.mass = float(self._masses.sum())
        """Mass of the vehicle [kg]."""
        weighing = find_weighing_masses(self.model)
        self.weight = float(weighing[self.vehicle].sum()) * self.buoyancy.gravity
        """Weight of the vehicle [N], less what gravity compensation carries."""
        self._carried_masses = self.model.body_mass - weighing
        self.displacement = float(
            scene.water.density * sum(hull.displaced_volume for hull in self.hulls)
        )
        """Mass of water that the vehicle's hulls displace when fully under water [kg]."""
        self.root = int(self.model.body_rootid[self.hulls[0].body])
        """Index of the vehicle's root body."""
        _check_scale(self.mass, self.displacement)
        _warn_of_second_drag(self.model, scene)
        _warn_of_compensation(self.mass, float(self._carried_masses[self.vehicle].sum()))

        # what a run leaves
        self._monitor = Monitor(self.model, self.vehicle, self.hulls, scene.water)
        self._wall_time = 0.0
        self._frame_data = mujoco.MjData(self.model)
        self._state = np.empty(mujoco.mj_stateSize(self.model, _STATE))

        # compile what a fresh installation has not compiled, before the clock runs
        with self._lend_water():
            mujoco.mj_forward(self.model, self._frame_data)
        scene.water.elevation(0.0, 0.0, 0.0)
        self._seal("make another Simulation of a changed scene (dataclasses.replace)", Simulation)

    @property
    def steps(self) -> int:
        """Number of timesteps of the whole run."""
        return max(1, round(self.scene.duration / self.scene.timestep))

    def frames(self) -> Iterator[Frame]:
        """Run the scene; a frame at time 0, then at the record rate, and one at the end.

        Raises:
            DivergenceError: a position, velocity or acceleration left the finite numbers.
        """
        started = time.perf_counter()
        yield self._frame()
        recorded = 0
        for step in range(1, self.steps + 1):
            self.step()
            # the small part forgives the rounding of time * rate
            due = math.floor(step * self.scene.timestep * self.scene.record_rate + 1e-9)
            if due > recorded or step == self.steps:
                recorded = due
                frame = self._frame()
                self._wall_time = time.perf_counter() - started
                yield frame
        self._wall_time = time.perf_counter() - started

    def step(self) -> None:
        """Take one timestep with the water acting.

        Raises:
            DivergenceError: a position, velocity or acceleration left the finite numbers.
        """
        with self._lend_water():
            mujoco.mj_step(self.model, self.data)
        check_finite(self.scene, self.model, self.data)

        # a step leaves the poses of its beginning
        now = float(self.data.time)
        self._monitor.add_poses(poses_of(self.data), now - self.model.opt.timestep)
        self._monitor.add_contacts(self.data, now)

    def replay(self, trajectory: Trajectory, wall_time: float) -> None:
        """Take over a whole run that was stepped elsewhere, for the summary.

        Args:
            trajectory: what the run left.
            wall_time: time that it took [s].
        """
        timestep = self.model.opt.timestep

        # each step; contacts are found anew, from the coordinates at its beginning
        starts = np.vstack([self.data.qpos[None], trajectory.qpos])
        for step, poses in enumerate(trajectory.poses):
            self._monitor.add_poses(poses, step * timestep)
            if trajectory.ncon[step]:
                self._frame_data.qpos[:] = starts[step]
                mujoco.mj_fwdPosition(self.model, self._frame_data)
                self._monitor.add_contacts(self._frame_data, (step + 1) * timestep)

        # the end
        self.data.qpos[:] = trajectory.qpos[-1]
        self.data.time = len(trajectory.qpos) * timestep
        mujoco.mj_fwdPosition(self.model, self.data)
        self._monitor.add_poses(poses_of(self.data), float(self.data.time))
        self._wall_time = wall_time

    def summary(self) -> Summary:
        """Sum up the run so far."""
        end = float(self.data.time)
        return Summary(
            scene=self.scene.title,
            method=self.scene.method.name,
            mass=self.mass,
            displacement=self.displacement,
            net_weight=self.weight - self.displacement * self.buoyancy.gravity,
            peak_draft=self._monitor.peak_draft,
            final_draft=self._monitor.draft,
            cog_z_range=self._monitor.height_range(end - LAST),
            simulated_time=end,
            wall_time=self._wall_time,
            real_time_factor=end / self._wall_time if self._wall_time else math.nan,
            contact_steps=self._monitor.contact_steps,
            first_contact=self._monitor.first_contact,
        )

    def centre_of_mass(self, data: mujoco.MjData) -> NDArray[np.float64]:
        """Centre of mass (3,) [m] of the vehicle, world frame."""
        centre: NDArray[np.float64] = self._masses @ data.xipos[self.vehicle] / self.mass
        return centre

    def _frame(self) -> Frame:
        """The present, on other data: mj_forward on the running data would disturb the run."""
        # poses and loads at exactly this time
        data = self._frame_data
        mujoco.mj_getState(self.model, self.data, self._state, _STATE)
        mujoco.mj_setState(self.model, data, self._state, _STATE)
        with self._lend_water():
            mujoco.mj_forward(self.model, data)
        now = float(data.time)
        loads = self.buoyancy.loads(data)
        self._monitor.add_poses(poses_of(data), now)

        # what gravity compensation adds to MuJoCo's potential energy
        lifted_by_engine = self._carried_masses @ data.xipos[:, 2] * self.buoyancy.gravity

        # what they mean
        water = self.scene.water
        centre = self.centre_of_mass(data)
        lifted = water.depth(loads.hull.centroid, now)
        return Frame(
            time=now,
            data=data,
            loads=loads,
            centre_of_mass=centre,
            attitude=_roll_pitch_yaw(data.xmat[self.root]),
            draft=self._monitor.draft,
            elevation=float(water.elevation(centre[0], centre[1], now)),
            energy=Energy(
                kinetic=float(data.energy[1]),
                potential=float(data.energy[0] - lifted_by_engine),
                buoyancy=float(np.nansum(loads.hull.force[:, 2] * lifted)),
            ),
        )


def _check_scale(mass: float, displacement: float) -> None:
    """Refuse a slip of units, which gives a hull a thousand million times its volume."""
    lowest, highest = PLAUSIBLE
    if not lowest <= displacement / mass <= highest:
        raise ModelError(
            f"the vehicle weighs {mass:.4g} kg and would displace {displacement:.4g} kg of water; "
            "check the scale of its meshes (a mesh drawn in millimetres wants "
            "scale='0.001 0.001 0.001')"
        )


def _warn_of_second_drag(model: mujoco.MjModel, scene: Scene) -> None:
    """Warn of a model that sets MuJoCo's own fluid, whose drag adds to the scene's."""
    density = model.opt.density
    viscosity = model.opt.viscosity
    if scene.damping is None or not (density > 0.0 or viscosity > 0.0):
        return
    option = f"density='{density:g}'" if density > 0.0 else f"viscosity='{viscosity:g}'"
    warnings.warn(
        f"the vehicle sets <option {option}>: MuJoCo's own fluid drag acts as well as ours; "
        "leave one out (damping = false in the scene)",
        BuoyancyWarning,
        stacklevel=3,
    )


def _warn_of_compensation(mass: float, carried: float) -> None:
    """Tell of gravity compensation, which lifts a vehicle as well as the water does."""
    if carried:
        warnings.warn(
            f"gravity compensation (gravcomp) carries {carried:.4g} kg of the vehicle's "
            f"{mass:.4g} kg, and the water lifts it as well; the net weight counts both",
            BuoyancyWarning,
            stacklevel=3,
        )


def _roll_pitch_yaw(rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """Angles (3,) [rad] of a rotation (9,): first yaw about z, then pitch about y, then roll."""
    r = rotation.reshape(3, 3)
    return np.array(
        [
            math.atan2(r[2, 1], r[2, 2]),
            -math.asin(max(-1.0, min(1.0, r[2, 0]))),
            math.atan2(r[1, 0], r[0, 0]),
        ]
    )
