"""`Simulation`: run a scene frame by frame."""

import functools
import importlib
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.engine.c_functions import raise_causes
from buoyancy_mj.engine.callbacks import PASSIVE
from buoyancy_mj.engine.instances import plugin_instances
from buoyancy_mj.engine.plugin import water_in
from buoyancy_mj.environments.missions import MISSIONS
from buoyancy_mj.environments.sauvc.mission import Mission
from buoyancy_mj.hulls.hull import Hull
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.records import ReadOnly
from buoyancy_mj.scenes.assembly import assemble
from buoyancy_mj.scenes.fleet import Vehicle, build_vehicles
from buoyancy_mj.scenes.frame_source import FrameSource
from buoyancy_mj.scenes.frames import Frame, take_only
from buoyancy_mj.scenes.natural_periods import Periods, find_natural_periods
from buoyancy_mj.scenes.obstacles import warn_of_obstacles
from buoyancy_mj.scenes.scene import Scene
from buoyancy_mj.scenes.steering import Steering
from buoyancy_mj.scenes.summary import Summary
from buoyancy_mj.scenes.tape import LENGTH
from buoyancy_mj.scenes.trajectory import Trajectory
from buoyancy_mj.scenes.witness import Witness
from buoyancy_mj.vehicle.control.controller import Controller

BLOCK_TIME = 0.1
"""About how long `run` steps before it tells where it is [s]."""


class Simulation(ReadOnly):
    """A scene, assembled and ready to run once.

    Args:
        scene: what to run.
        through: where the water's forces enter; by 'qfrc_passive' the water is a part of the model,
            by 'xfrc_applied' a callback, see `Buoyancy.installed`.
        trust: whether to run the Python files that the scene names as controllers.
        measure: names of sensors of which the summary tells, as 'gyro', or 'gyro.x'.

    Raises:
        ModelError, MeshError, SceneError: what `assemble` and `Buoyancy` raise; also a vehicle
            whose displacement is absurd for its mass, and a sensor that is not there.
        SceneError, ControlError: a controller that is not trusted, or cannot steer its vehicle.
        EngineError: there is no such `through`.

    Example:
        `drafts = [frame.draft for frame in Simulation(read_scene(path)).frames()]`
    """

    def __init__(
        self,
        scene: Scene,
        *,
        through: str = PASSIVE,
        trust: bool = False,
        measure: Sequence[str] = (),
    ) -> None:
        self.scene = scene
        """The scene."""
        self.model, self.data, afloat = assemble(scene, with_water=through == PASSIVE)
        # a diverging simulation ends with an error, and is not set back to its start
        self.model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)

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

        # the vehicles
        self.vehicles = build_vehicles(self.model, self.buoyancy, afloat)
        """What floats of the scene's vehicles, by name; surroundings are none of them."""

        # frames, from the poses at the start on
        self._source = FrameSource(self.model, self.buoyancy, self.vehicles)
        self._source.copy_state(self.data)
        start = self._source.data
        with raise_causes():
            mujoco.mj_fwdPosition(self.model, start)
        warn_of_obstacles(self.model, start, self.vehicles, scene.water.level)
        self._witness = Witness(
            scene,
            self.model,
            self.data,
            start,
            self.vehicles,
            self._source.monitors,
            self.buoyancy,
            measure,
        )
        self._wall_time = 0.0

        # who watches
        self.mission = self._start_mission()
        """The referee of the scene's mission; None without one."""

        # compile what a fresh installation has not compiled, before the clock runs
        with self._lend_water(), raise_causes():
            mujoco.mj_forward(self.model, start)
        self.buoyancy.water.elevation(0.0, 0.0, 0.0)

        # what steers, from the poses and sensors at the start
        self._steering: Steering | None = None
        if scene.control:
            with self._lend_water(), raise_causes():
                mujoco.mj_forward(self.model, self.data)
            # without the water that is lent: it would act while another model is compiled
            self._steering = Steering(scene, self.model, self.data, afloat, trust=trust)
        self._seal("make another Simulation of a changed scene (dataclasses.replace)", Simulation)

    @property
    def title(self) -> str:
        """Title of the scene."""
        return self.scene.title

    @property
    def text(self) -> str:
        """The scene as TOML."""
        return self.scene.text

    @property
    def vehicle(self) -> Vehicle:
        """The only vehicle; an error that names them where there are several."""
        return take_only(self.vehicles)

    @property
    def controllers(self) -> dict[str, Controller]:
        """The controllers at work, by the vehicle that each steers; a hold has its `course`."""
        return {} if self._steering is None else self._steering.controllers

    @property
    def hulls(self) -> tuple[Hull, ...]:
        """The hulls of the only vehicle."""
        return self.vehicle.hulls

    @property
    def mass(self) -> float:
        """Mass of the only vehicle [kg]."""
        return self.vehicle.mass

    @property
    def weight(self) -> float:
        """Weight of the only vehicle [N]."""
        return self.vehicle.weight

    @property
    def displacement(self) -> float:
        """Mass of water that the only vehicle's hulls displace when fully under water [kg]."""
        return self.vehicle.displacement

    @property
    def steps(self) -> int:
        """Number of timesteps of the whole run."""
        return max(1, round(self.scene.duration / self.scene.timestep))

    @property
    def measures_sensors(self) -> bool:
        """Whether the summary tells of sensors."""
        return self._witness.meters.with_sensors

    def frames(self) -> Iterator[Frame]:
        """Run the scene; a frame at time 0, then at the record rate, and one at the end.

        Raises:
            DivergenceError: a position, velocity or acceleration left the finite numbers, or all
                reason: see `Limits`.
        """
        started = time.perf_counter()
        yield self.frame()
        taken = 0
        for due in self._list_frames():
            self.advance(due - taken)
            taken = due
            frame = self.frame()
            self._wall_time = time.perf_counter() - started
            yield frame
        self._wall_time = time.perf_counter() - started

    def run(self, each: Callable[[float], object] = float) -> Summary:
        """Run the scene to its end without frames, and sum it up; nothing costs less.

        Args:
            each: called with the simulated time [s] some ten times in a second.

        Raises:
            DivergenceError: as `frames`.

        Example:
            `peak = Simulation(read_scene(path)).run().peak_draft`
        """
        started = time.perf_counter()
        taken = count = 0
        while taken < self.steps:
            count = min(max(1, count), self.steps - taken)
            begun = time.perf_counter()
            self.advance(count)
            taken += count
            each(float(self.data.time))
            # twice as many until they take long enough
            count = int(count * min(2.0, BLOCK_TIME / (time.perf_counter() - begun)))
        self._source.see(self.data, self._forward)
        self._witness.take_present(self._source.data)
        self._wall_time = time.perf_counter() - started
        return self.summary()

    def show(self) -> Any:
        """Run the scene to its end, and show it in a notebook.

        Returns:
            Rerun's viewer with the recording, where `pip install 'buoyancy_mj[notebook]'` has put
            it; else the summary, with charts of the motion. As the last word of a cell it is shown.

        Raises:
            SceneError: the scene has run already.
            DivergenceError: as `frames`.

        Example:
            `Simulation(read_scene(path)).show()`
        """
        # a room downstream draws, and is imported when somebody looks
        return importlib.import_module("buoyancy_mj.viz.notebook").show_run(self)

    def step(self) -> None:
        """Take one timestep with the water acting, steered by the controllers that are due.

        Raises:
            ControlError: a controller raises, or gives what is no finite number.
            DivergenceError: a position, velocity or acceleration left the finite numbers, or all
                reason: see `Limits`.
            KeyboardInterrupt: Ctrl-C, also while Python code submerges.
        """
        self.advance(1)

    def advance(self, count: int) -> None:
        """Take timesteps, as `step` does, with next to nothing between them.

        Args:
            count: how many.

        Raises:
            ControlError, DivergenceError, KeyboardInterrupt: as `step`.
        """
        steering, mission = self._steering, self.mission
        left = count
        while left:
            # natively as far as nobody has to be asked
            some = min(left, LENGTH) if mission is None else 1
            if steering is not None:
                some = min(some, steering.update(self.data))
            self._step_natively(some)
            left -= some
            if steering is not None:
                steering.note_steps(some)
            if mission is not None:
                mission.update()

    def _step_natively(self, count: int) -> None:
        """Take timesteps with the water acting, and see what each leaves."""
        model, data, step = self.model, self.data, mujoco.mj_step
        see = self._witness.begin(count)
        with self._lend_water(), raise_causes():
            for _ in range(count):
                before = data.time
                step(model, data)
                see(before, data.time)

    def replay(self, trajectory: Trajectory, wall_time: float) -> None:
        """Take over a whole run that was stepped elsewhere, for the summary.

        Args:
            trajectory: what the run left.
            wall_time: time that it took [s].

        Raises:
            DivergenceError: a body has left all reason.
        """
        self._witness.replay(trajectory, self._source.data)
        self._wall_time = wall_time

    def frame(self) -> Frame:
        """The present, computed beside the run, which goes on as it would without.

        Raises:
            DivergenceError: a position, velocity or acceleration left the finite numbers, or all
                reason: see `Limits`.
        """
        frame = self._source.take(self.data, self._forward)
        self._witness.take_present(self._source.data)
        return frame

    def summary(self, *, with_periods: bool = False) -> Summary:
        """Sum up the run so far.

        Args:
            with_periods: whether to find the natural periods of the vehicles too, from their
                statics, which takes some milliseconds for each.
        """
        at_limits = {} if self._steering is None else self._steering.at_limits
        periods = self._natural_periods if with_periods else {}
        return self._witness.sum_up(self._wall_time, at_limits, periods)

    @functools.cached_property
    def _natural_periods(self) -> dict[str, Periods]:
        """Natural periods of the vehicles, by their names."""
        hulls, water = self.buoyancy.hulls, self.buoyancy.water
        return find_natural_periods(self.model, hulls, self.vehicles, water)

    def _list_frames(self) -> Iterator[int]:
        """The steps after which frames are due: at the record rate, and the last."""
        taken = np.arange(1, self.steps + 1)
        # the small part forgives the rounding of time * rate
        due = np.floor(taken * self.scene.timestep * self.scene.record_rate + 1e-9)
        is_due = np.diff(due, prepend=0.0) > 0.0
        is_due[-1] = True
        yield from taken[is_due].tolist()

    def centre_of_mass(self, data: mujoco.MjData) -> NDArray[np.float64]:
        """Centre of mass (3,) [m] of the only vehicle, world frame."""
        return self.vehicle.centre_of_mass(data)

    def _start_mission(self) -> Mission | None:
        """The referee that the scene asks for."""
        if self.scene.mission is None:
            return None
        return Mission(
            self.model,
            self.data,
            task=MISSIONS[self.scene.mission],
            vehicle=body_name(self.model, self.vehicle.root),
            water=self.buoyancy.water,
        )

    def _forward(self, data: mujoco.MjData) -> None:
        """A pass over the data of a frame, which may have left all reason; their energy too."""
        with self._lend_water(), raise_causes():
            mujoco.mj_forward(self.model, data)
        mujoco.mj_energyPos(self.model, data)
        mujoco.mj_energyVel(self.model, data)
        self._witness.limits.check_data(data, float(data.time))
