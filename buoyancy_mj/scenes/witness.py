"""`Witness`: sees what each step of a run leaves, and sums the run up."""

import math
from collections.abc import Callable, Mapping, Sequence

import mujoco
import numpy as np

from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.scenes.divergence import Limits
from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.scenes.lookout import Lookout
from buoyancy_mj.scenes.meters import Meters
from buoyancy_mj.scenes.monitor import Monitor
from buoyancy_mj.scenes.natural_periods import Periods
from buoyancy_mj.scenes.scene import Scene
from buoyancy_mj.scenes.summary import Summary
from buoyancy_mj.scenes.trajectory import Poses, Trajectory, poses_of


class Witness:
    """Sees what each step of a run leaves: whether it can be believed, and what it tells.

    Args:
        scene: what runs.
        model: its model.
        data: the data that are stepped.
        start: data with the poses at the start, which may change later.
        vehicles: the vehicles, by name.
        monitors: what the summary keeps of each vehicle, by its name.
        buoyancy: the water that acts.
        sensors: names of the sensors to measure.

    Raises:
        SceneError: there is no such sensor.
        EngineError: this MuJoCo is not as expected inside.
    """

    def __init__(
        self,
        scene: Scene,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        start: mujoco.MjData,
        vehicles: Mapping[str, Vehicle],
        monitors: Mapping[str, Monitor],
        buoyancy: Buoyancy,
        sensors: Sequence[str],
    ) -> None:
        self._scene, self._model, self._data = scene, model, data
        self._monitors = monitors
        self.limits = Limits(scene, model, start)
        """Within what the run can be believed."""
        self._lookout = Lookout(data, self.limits, monitors.values())
        watched = {name: (vehicles[name], one.corners) for name, one in monitors.items()}
        water, duration = buoyancy.water, scene.duration
        self.meters = Meters(model, start, data, watched, water, duration, sensors)
        """What is measured."""
        self._present: Poses | None = poses_of(start)

    def begin(self, count: int) -> Callable[[float, float], None]:
        """Make ready for so many steps; what to call after each, with the times around it [s]."""
        tape, look = self.meters.tape, self._lookout.look
        take, keep = tape.take, tape.keep
        self._lookout.reserve(count)
        tape.wind(self._data.time)
        self._present = None

        def see(before: float, now: float) -> None:
            # a step leaves the poses of its beginning
            look(before, now)
            keep(take())

        return see

    def take_present(self, present: mujoco.MjData) -> None:
        """Take the poses of data at the time to which the run has come, which monitors know."""
        self._present = poses_of(present)

    def replay(self, trajectory: Trajectory, scratch: mujoco.MjData) -> None:
        """Take over a whole run that was stepped elsewhere, and put the data at its end.

        Args:
            trajectory: what the run left.
            scratch: data that are overwritten.

        Raises:
            DivergenceError: a body has left all reason.
        """
        model, data, timestep = self._model, self._data, self._model.opt.timestep

        # each step; contacts are found anew, from the coordinates at its beginning
        self.limits.check_trajectory(trajectory, timestep)
        for monitor in self._monitors.values():
            monitor.add_trajectory(trajectory, timestep)
        self.meters.add_trajectory(trajectory)
        starts = np.vstack([data.qpos[None], trajectory.qpos])
        for step in np.flatnonzero(trajectory.ncon):
            scratch.qpos[:] = starts[step]
            mujoco.mj_fwdPosition(model, scratch)
            for monitor in self._monitors.values():
                monitor.add_contacts(scratch, float(step + 1) * timestep)

        # the end
        data.qpos[:] = trajectory.qpos[-1]
        data.time = len(trajectory.qpos) * timestep
        mujoco.mj_fwdPosition(model, data)
        poses = self._present = poses_of(data)
        self.limits.check_poses(poses, float(data.time))
        for monitor in self._monitors.values():
            monitor.add_poses(poses, float(data.time))

    def sum_up(
        self,
        wall_time: float,
        updates_at_limits: Mapping[str, int],
        natural_periods: Mapping[str, Periods],
    ) -> Summary:
        """The run so far.

        Args:
            wall_time: how long it took [s].
            updates_at_limits: of each controller, by the vehicle that it steers.
            natural_periods: of vehicles, by their names, if they are known.
        """
        now, monitors, meters = float(self._data.time), self._monitors, self.meters
        if self._present is None:
            # the draft in the poses that the last step left
            for monitor in monitors.values():
                monitor.add_poses(poses_of(self._data), now - self._model.opt.timestep)
        motions, heights = meters.measure(now, self._present), meters.heights
        return Summary(
            scene=self._scene.title,
            method=self._scene.method.name,
            sea=meters.sea,
            vehicles={
                name: monitor.summary(heights[name], motions[name], updates_at_limits.get(name))
                for name, monitor in monitors.items()
            },
            simulated_time=now,
            wall_time=wall_time,
            real_time_factor=now / wall_time if wall_time else math.nan,
            sensors=meters.measure_sensors(now),
            natural_periods=natural_periods,
        )
