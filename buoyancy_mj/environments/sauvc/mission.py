"""`mission`: a referee for a vehicle in an arena of the challenge, in anyone's loop."""

import mujoco

from buoyancy_mj.engine.instances import plugin_instances
from buoyancy_mj.engine.plugin import water_in
from buoyancy_mj.environments.sauvc.attempt import Attempt
from buoyancy_mj.environments.sauvc.course import Course
from buoyancy_mj.environments.sauvc.props import Props, find_props, read_order
from buoyancy_mj.environments.sauvc.qualification import Qualification
from buoyancy_mj.environments.sauvc.report import Event, MissionReport
from buoyancy_mj.environments.sauvc.rules import may_take_part, score_build
from buoyancy_mj.environments.sauvc.watcher import Watcher
from buoyancy_mj.errors import ModelError, choices, describe
from buoyancy_mj.hulls.bodies import group_floating_bodies
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.records import ReadOnly
from buoyancy_mj.sea.water import Water


def mission(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    *,
    task: str | None = None,
    vehicle: str | None = None,
    order: str | tuple[str, ...] | None = None,
    water: Water | None = None,
) -> "Mission":
    """Watch a vehicle in an arena of the Singapore AUV Challenge, and count its points.

    Args:
        model: a model with a vehicle and the props of `sauvc_arena` in it, under any prefix.
        data: its data, at the start of the attempt.
        task: 'course' or 'qualification'; None for that of the arena.
        vehicle: name of the vehicle's root body; None for the only one that is no prop.
        order: colours of the flares as they are to be bumped, as 'R-B-Y'; None for the arena's own.
        water: the sea, for its surface; None for the one in the model, or else still water at
            z = 0.

    Raises:
        ModelError: the model has no arena or not the props of the task, or it is open which vehicle
            is meant.
        SceneError: there is no such task, or the order is none.

    Example:
        >>> arena = sauvc_arena("qualification")
        >>> frame = arena.worldbody.add_frame(pos=[-11.8, 4.0, -0.6])
        >>> _ = arena.attach(spec, prefix="my/", frame=frame)
        >>> model = arena.compile()
        >>> data = mujoco.MjData(model)
        >>> referee = mission(model, data)
        >>> mujoco.mj_step(model, data)
        >>> referee.update()
        >>> referee.report.points
        0
    """
    return Mission(model, data, task=task, vehicle=vehicle, order=order, water=water)


class Mission(ReadOnly):
    """A referee; `mission` says what its arguments are.

    It reads poses and contacts alone, and changes nothing. Call `update` after each step: a gate is
    seen to be passed also between updates that are far apart, but a contact between them is not.
    After `mj_step` poses and contacts are those of the step's beginning, one timestep old. Where
    the time of the data falls back, a new attempt begins.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        *,
        task: str | None = None,
        vehicle: str | None = None,
        order: str | tuple[str, ...] | None = None,
        water: Water | None = None,
    ) -> None:
        props = find_props(model, task)
        if order is not None:
            props = props._replace(order=read_order(order))
        if water is None:
            water = water_in(model).water if plugin_instances(model) else Water()
        self._model, self._data, self._props, self._water = model, data, props, water
        self._bodies = _find_vehicle(model, props, vehicle)
        self._begin()
        self._seal("make another mission", Mission)

    def update(self) -> None:
        """Look at the vehicle and judge what it does; after each step, or at a rate."""
        if float(self._data.time) < self._attempt.now:
            self._begin()
        if not self._attempt.ended:
            self._attempt.see(self._watcher.look())

    @property
    def events(self) -> tuple[Event, ...]:
        """What was seen so far, in the order of time."""
        return tuple(sorted(self._attempt.events, key=lambda event: event.time))

    @property
    def ended(self) -> str:
        """Why the attempt has ended; '' while it goes on."""
        return self._attempt.ended

    @property
    def report(self) -> MissionReport:
        """The attempt so far, with its points."""
        attempt = self._attempt
        rows = attempt.score()
        return MissionReport(
            task=self._props.task,
            run_time=attempt.now - attempt.start,
            ended=attempt.ended,
            points=sum(points for _, points in rows),
            score=rows,
            build_points=self._build_points,
            events=self.events,
        )

    def _begin(self) -> None:
        """Begin an attempt."""
        # poses of data that nobody has stepped yet, without touching them
        placed = mujoco.MjData(self._model)
        placed.qpos[:] = self._data.qpos
        mujoco.mj_kinematics(self._model, placed)
        self._watcher = Watcher(self._model, self._data, self._props, self._bodies, self._water)
        make = Course if self._props.task == "course" else Qualification
        self._attempt: Attempt = make(self._props, float(self._data.time))

        # its build
        length, width, height = self._watcher.outline.measure(placed).tolist()
        mass = float(self._model.body_mass[self._bodies].sum())
        self._build_points = score_build((length, width, height), mass)
        if not may_take_part((length, width, height), mass):
            self._attempt.note(
                "too large", f"{length:.2f} x {width:.2f} x {height:.2f} m, {mass:.1f} kg"
            )


def _find_vehicle(model: mujoco.MjModel, props: Props, name: str | None) -> list[int]:
    """Bodies of the vehicle, its root first.

    Raises:
        ModelError: there is no such vehicle, or it is open which.
    """
    groups = {}
    for group in group_floating_bodies(model):
        bodies = [body for body in group.tolist() if body not in props.bodies]
        if bodies:
            groups[body_name(model, bodies[0])] = bodies
    if name is None and len(groups) == 1:
        (name,) = groups
    if name not in groups:
        what = f"no vehicle {describe(name)}" if name else f"{len(groups)} vehicles"
        raise ModelError(
            f"the model has {what} beside the arena; name the root body of one (vehicle=); "
            f"{choices(name, groups)}"
        )
    return groups[name]
