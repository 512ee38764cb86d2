"""Steps of several models from states of a run, timed in turns."""

import time
from collections.abc import Mapping, Sequence
from typing import NamedTuple, TypeVar

import mujoco
import numpy as np
from numpy.typing import NDArray

from benchmarks.timing import spent_since

K = TypeVar("K")


class Start(NamedTuple):
    """The state at the beginning of a stretch of steps."""

    time: float
    """[s]."""
    qpos: NDArray[np.float64]
    """Positions (nq,)."""
    qvel: NDArray[np.float64]
    """Velocities (nv,)."""
    ctrl: NDArray[np.float64]
    """Commands (nu,)."""


class Plan(NamedTuple):
    """Where to time, how long, and how often."""

    starts: int
    """How many stretches."""
    apart: int
    """Steps from the start of one to that of the next."""
    steps: int
    """Steps of each that are timed; the rest of the way is gone once."""
    rounds: int
    """How often each is timed."""


class Course(NamedTuple):
    """A model, and where its stretches start."""

    model: mujoco.MjModel
    starts: Sequence[Start]


def find_starts(model: mujoco.MjModel, data: mujoco.MjData, plan: Plan) -> list[Start]:
    """Run the data on, and keep the states where stretches start."""
    starts = []
    for _ in range(plan.starts):
        starts.append(
            Start(data.time, data.qpos.copy(), data.qvel.copy(), data.ctrl[: model.nu].copy())
        )
        mujoco.mj_step(model, data, plan.apart)
    return starts


def time_steps(courses: Mapping[K, Course], plan: Plan) -> dict[K, float]:
    """Mean time [s] of a step on each course.

    Others may be at work on the machine: it is the time of the thread, courses take turns, and of
    each stretch the quickest round counts.
    """
    best = {label: np.full(len(course.starts), np.inf) for label, course in courses.items()}
    datas = {label: mujoco.MjData(course.model) for label, course in courses.items()}
    for _ in range(plan.rounds):
        for label, (model, starts) in courses.items():
            # caches hold what the last course used
            _time_stretch(model, datas[label], starts[-1], plan.steps)
            for stretch, start in enumerate(starts):
                spent = _time_stretch(model, datas[label], start, plan.steps)
                best[label][stretch] = min(best[label][stretch], spent)
    return {label: float(times.mean()) for label, times in best.items()}


def forward(model: mujoco.MjModel, start: Start) -> mujoco.MjData:
    """Data at the beginning of a stretch, all that follows from their state computed."""
    data = mujoco.MjData(model)
    _set_state(model, data, start)
    mujoco.mj_forward(model, data)
    return data


def _time_stretch(model: mujoco.MjModel, data: mujoco.MjData, start: Start, steps: int) -> float:
    """Time of a step [s]."""
    _set_state(model, data, start)
    started = time.thread_time()
    mujoco.mj_step(model, data, steps)
    return spent_since(started) / steps


def _set_state(model: mujoco.MjModel, data: mujoco.MjData, start: Start) -> None:
    data.time, data.qpos[:], data.qvel[:] = start.time, start.qpos, start.qvel
    data.ctrl[:] = start.ctrl[: model.nu]
