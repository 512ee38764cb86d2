"""`Simulation`: run a scene frame by frame."""

import math
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.engine.instances import plugin_instances
from buoyancy_mj.engine.plugin import water_in
from buoyancy_mj.errors import BuoyancyWarning, DivergenceError, ModelError
from buoyancy_mj.hulls.hull import Hull
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.records import ReadOnly
from buoyancy_mj.scenes.assembly import assemble
from buoyancy_mj.scenes.frames import LAST, Energy, Frame, Summary
from buoyancy_mj.scenes.scene import Scene
from buoyancy_mj.statics.vessel import PLAUSIBLE


class Simulation(ReadOnly):
    """A scene, assembled and ready to run once.

    Raises:
        ModelError, MeshError, SceneError: see `assembly.assembled` and `Buoyancy`; also a vehicle
            whose displacement is absurd for its mass.
    """

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.model, self.data, bodies = assemble(scene, with_water=True)
        # a diverging simulation is told, not set back to the start
        self.model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)
        self.model.opt.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
        self.buoyancy: Buoyancy
        """The water that acts."""
        self._acting: Callable[[], AbstractContextManager[object]]
        if plugin_instances(self.model):
            self.buoyancy, self._acting = water_in(self.model), nullcontext
        else:
            self.buoyancy = Buoyancy(self.model, scene)
            self._acting = self.buoyancy.installed
        floating = self.buoyancy.floating
        self.vehicle = floating[floating < bodies]
        """Indices of the vehicle's bodies; what floats in the environment is none of them."""
        self.hulls = tuple(hull for hull in self.buoyancy.hulls if hull.body < bodies)
        """The vehicle's hulls."""
        if not self.hulls:
            raise ModelError("the vehicle displaces no water; choose geoms of its own (--geoms)")
        self._masses = self.model.body_mass[self.vehicle]
        self.mass = float(self._masses.sum())
        """Of the vehicle [kg]."""
        self.weight = self.mass * self.buoyancy.gravity
        """Of the vehicle [N]."""
        self.displacement = float(
            scene.water.density * sum(hull.displaced_volume for hull in self.hulls)
        )
        """Mass of water that its hulls displace when fully under water [kg]."""
        self._check_scale()
        self.root = int(self.model.body_rootid[self.hulls[0].body])
        """Index of the vehicle's root body."""
        self._shown = mujoco.MjData(self.model)
        self._state = np.empty(mujoco.mj_stateSize(self.model, mujoco.mjtState.mjSTATE_INTEGRATION))
        # corners of the convex hulls: the deepest point is one of them
        self._corners = [
            (body, _corners(self.hulls, body))
            for body in sorted({hull.body for hull in self.hulls})
        ]
        self._heights: list[tuple[float, float]] = []
        self._peak_draft, self._draft = -math.inf, math.nan
        self._wall = 0.0
        self._contact_steps = 0
        self._first_contact: float | None = None
        # compiles what a fresh installation has not compiled, before the clock runs
        mujoco.mj_forward(self.model, self._shown)
        scene.water.elevation(0.0, 0.0, 0.0)
        fixed = self.model.body_weldid[self.model.geom_bodyid] == 0
        own = np.isin(self.model.geom_bodyid, self.vehicle)
        self._touches = fixed[:, None] & own[None, :]
        self._touches |= self._touches.T
        self._seal("make another Simulation of a changed scene (dataclasses.replace)")

    @property
    def steps(self) -> int:
        """Timesteps of the whole run."""
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
                self._wall = time.perf_counter() - started
                yield frame
        self._wall = time.perf_counter() - started

    def step(self) -> None:
        """One timestep with the water acting.

        Raises:
            DivergenceError: see `frames`.
        """
        with self._acting():
            mujoco.mj_step(self.model, self.data)
        self._check_finite()
        # the step leaves the poses of its beginning
        data, now = self.data, float(self.data.time)
        self._watch(data.xpos, data.xmat, data.xipos, now - self.model.opt.timestep)
        self._look_for_contact(data, now)

    def _look_for_contact(self, data: mujoco.MjData, now: float) -> None:
        """Count the step that ended now if the vehicle touched something fixed in it."""
        pairs = data.contact.geom
        if len(pairs) and self._touches[pairs[:, 0], pairs[:, 1]].any():
            self._contact_steps += 1
            if self._first_contact is None:
                self._first_contact = now

    def follow(
        self, xpos: NDArray[np.float64], xmat: NDArray[np.float64], xipos: NDArray[np.float64], qpos: NDArray[np.float64],
        ncon: NDArray[np.int64], wall_time: float,
    ) -> None:  # fmt: skip
        """Take a whole run that was stepped elsewhere, for the summary.

        Args:
            xpos: of all bodies at the beginning of each step (steps, nbody, 3) [m].
            xmat: likewise (steps, nbody, 9).
            xipos: likewise (steps, nbody, 3) [m].
            qpos: at the end of each step (steps, nq).
            ncon: number of contacts in each step (steps,).
            wall_time: that it took [s].
        """
        timestep, data = self.model.opt.timestep, self._shown
        starts = np.vstack([self.data.qpos[None], qpos])
        for step, poses in enumerate(zip(xpos, xmat, xipos, strict=True)):
            self._watch(*poses, step * timestep)
            if ncon[step]:
                data.qpos[:] = starts[step]
                mujoco.mj_fwdPosition(self.model, data)
                self._look_for_contact(data, (step + 1) * timestep)
        self.data.qpos[:], self.data.time = qpos[-1], len(qpos) * timestep
        mujoco.mj_fwdPosition(self.model, self.data)
        self._watch(self.data.xpos, self.data.xmat, self.data.xipos, float(self.data.time))
        self._wall = wall_time

    def summary(self) -> Summary:
        """What came of the frames so far."""
        end = self.data.time
        late = [height for at, height in self._heights if at >= end - LAST - 1e-9]
        return Summary(
            scene=self.scene.title,
            method=self.scene.method.name,
            mass=self.mass,
            displacement=self.displacement,
            net_weight=self.weight - self.displacement * self.buoyancy.gravity,
            peak_draft=self._peak_draft,
            final_draft=self._draft,
            cog_z_range=max(late) - min(late) if late else math.nan,
            simulated_time=float(end),
            wall_time=self._wall,
            real_time_factor=end / self._wall if self._wall else math.nan,
            contact_steps=self._contact_steps,
            first_contact=self._first_contact,
        )

    def _frame(self) -> Frame:
        """The present, on data of its own: mj_forward on the running data would disturb its warm start."""
        mujoco.mj_getState(self.model, self.data, self._state, mujoco.mjtState.mjSTATE_INTEGRATION)
        mujoco.mj_setState(
            self.model, self._shown, self._state, mujoco.mjtState.mjSTATE_INTEGRATION
        )
        with self._acting():
            mujoco.mj_forward(self.model, self._shown)
        data, water, now = self._shown, self.scene.water, float(self._shown.time)
        loads = self.buoyancy.loads(data)
        centre = self.centre_of_mass(data)
        elevation = float(water.elevation(centre[0], centre[1], now))
        lifted = water.depth(loads.hull.centroid, now)
        energy = Energy(
            kinetic=float(data.energy[1]),
            potential=float(data.energy[0]),
            buoyancy=float(np.nansum(loads.hull.force[:, 2] * lifted)),
        )
        self._watch(data.xpos, data.xmat, data.xipos, now)
        attitude = _roll_pitch_yaw(data.xmat[self.root])
        return Frame(now, data, loads, centre, attitude, self._draft, elevation, energy)

    def centre_of_mass(self, data: mujoco.MjData) -> NDArray[np.float64]:
        """Of the vehicle (3,) [m], world frame."""
        return self._masses @ data.xipos[self.vehicle] / self.mass

    def _watch(
        self,
        xpos: NDArray[np.float64],
        xmat: NDArray[np.float64],
        xipos: NDArray[np.float64],
        now: float,
    ) -> None:
        """Keep what the summary tells of poses."""
        self._draft = max(
            float(
                self.scene.water.depth(corners @ xmat[body].reshape(3, 3).T + xpos[body], now).max()
            )
            for body, corners in self._corners
        )
        self._peak_draft = max(self._peak_draft, self._draft)
        self._heights.append((now, float(self._masses @ xipos[self.vehicle, 2] / self.mass)))

    def _check_scale(self) -> None:
        """A slip of units gives a hull a thousand million times its volume."""
        ratio = self.displacement / self.mass
        if not PLAUSIBLE[0] <= ratio <= PLAUSIBLE[1]:
            raise ModelError(
                f"the vehicle weighs {self.mass:.4g} kg and would displace {self.displacement:.4g} kg of water; check the "
                "scale of its meshes (a mesh drawn in millimetres wants scale='0.001 0.001 0.001')"
            )
        density, viscosity = self.model.opt.density, self.model.opt.viscosity
        if (density > 0.0 or viscosity > 0.0) and self.scene.damping is not None:
            option = f"density='{density:g}'" if density > 0.0 else f"viscosity='{viscosity:g}'"
            warnings.warn(
                f"the vehicle sets <option {option}>: MuJoCo's own fluid drag acts as well as ours; leave one out (damping = "
                "false in the scene)",
                BuoyancyWarning,
                stacklevel=3,
            )

    def _check_finite(self) -> None:
        """Tell a diverged simulation by MuJoCo's own counters of bad values."""
        for warning, quantity in (
            (mujoco.mjtWarning.mjWARN_BADQPOS, "position"),
            (mujoco.mjtWarning.mjWARN_BADQVEL, "velocity"),
            (mujoco.mjtWarning.mjWARN_BADQACC, "acceleration"),
        ):
            told = self.data.warning[warning]
            if told.number:
                if quantity == "position":
                    joint = (
                        int(np.searchsorted(self.model.jnt_qposadr, told.lastinfo, side="right"))
                        - 1
                    )
                    body = int(self.model.jnt_bodyid[joint])
                else:
                    body = int(self.model.dof_bodyid[told.lastinfo])
                name = body_name(self.model, body)
                raise DivergenceError(
                    self.divergence(float(self.data.time), f"the {quantity} of body '{name}'")
                )

    def divergence(self, now: float, what: str = "a position, velocity or acceleration") -> str:
        """The sentence that tells it."""
        return (
            f"the simulation diverged at {now:.4g} s: {what} is not a finite, sensible number; try a smaller timestep "
            f"(now {self.scene.timestep:g} s) or another integrator (now {self.scene.integrator})"
        )


def _corners(hulls: Sequence[Hull], body: int) -> NDArray[np.float64]:
    """Vertices (n, 3) [m] of the convex hulls of a body's hulls, in its frame."""
    meshes = [hull.mesh_in_body for hull in hulls if hull.body == body]
    return np.vstack([mesh.vertices[ConvexHull(mesh.vertices).vertices] for mesh in meshes])


def _roll_pitch_yaw(rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """Angles (3,) [rad] of a rotation (9,): yaw about z first, then pitch about y, then roll about x."""
    r = rotation.reshape(3, 3)
    return np.array(
        [
            math.atan2(r[2, 1], r[2, 2]),
            -math.asin(max(-1.0, min(1.0, r[2, 0]))),
            math.atan2(r[1, 0], r[0, 0]),
        ]
    )
