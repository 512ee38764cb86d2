"""A case of the validation: rows of what is published and what comes out here, and perhaps a picture."""

import dataclasses
import math
from collections.abc import Callable, Sequence

import mujoco
import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.sea.water import Water


@dataclasses.dataclass(frozen=True)
class Row:
    """One quantity."""

    quantity: str
    """What it is, with its unit in brackets."""
    published: float
    """What is published for it."""
    ours: float
    """What comes out here."""
    allowed: float
    """How far they may be apart: a part of the published, or with `absolute` in its unit."""
    absolute: bool = False
    """Which of the two."""

    @property
    def difference(self) -> float:
        """Ours less the published, as `allowed` counts it."""
        gap = self.ours - self.published
        return gap if self.absolute else gap / abs(self.published)

    @property
    def passes(self) -> bool:
        """Whether it is within what is allowed."""
        return abs(self.difference) <= self.allowed


@dataclasses.dataclass(frozen=True)
class Case:
    """A published experiment, benchmark or closed form."""

    name: str
    """By which the command line runs it alone."""
    title: str
    """One line."""
    source: str
    """Where the published numbers stand."""
    what: str
    """How it is run here."""
    run: Callable[[], Sequence[Row]]
    """Runs it."""
    reason: str = ""
    """Why rows fail, where some do."""
    draw: Callable[[], Figure] | None = None
    """Its picture."""


def follow(
    model: mujoco.MjModel,
    water: Water,
    duration: float,
    *,
    read: Callable[[mujoco.MjData], float],
    start: Callable[[mujoco.MjData], None] = lambda data: None,
    pressure: str = "archimedes",
    added_mass: str = "model",
    drag: bool = True,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times [s], and what is read from a run at each (n,).

    Args:
        model: what moves.
        water: in what.
        duration: how long [s].
        read: what is looked at.
        start: sets the data up.
        pressure: see `Buoyancy`.
        added_mass: likewise.
        drag: whether there is any.
    """
    data = mujoco.MjData(model)
    start(data)
    options = {} if drag else {"damping": None}
    times, values = [], []
    with Buoyancy(model, water, pressure=pressure, added_mass=added_mass, **options).installed():  # type: ignore[arg-type]
        while data.time < duration:
            times.append(data.time)
            values.append(read(data))
            mujoco.mj_step(model, data)
    return np.array(times), np.array(values)


def crossings(times: NDArray[np.float64], values: NDArray[np.float64]) -> NDArray[np.float64]:
    """When values pass zero, by straight lines."""
    i = np.flatnonzero(np.sign(values[1:]) * np.sign(values[:-1]) < 0)
    crossed: NDArray[np.float64] = times[i] + (times[i + 1] - times[i]) * values[i] / (
        values[i] - values[i + 1]
    )
    return crossed


def period(times: NDArray[np.float64], values: NDArray[np.float64], count: int = 6) -> float:
    """Mean period of an oscillation about zero over so many half periods."""
    crossed = crossings(times, values)[: count + 1]
    return float(2.0 * np.diff(crossed).mean())


def amplitude(times: NDArray[np.float64], values: NDArray[np.float64], omega: float) -> float:
    """Amplitude of what goes as cos(omega t), by least squares beside a mean and a trend."""
    columns = np.column_stack(
        [np.cos(omega * times), np.sin(omega * times), np.ones_like(times), times]
    )
    a, b, *_ = np.linalg.lstsq(columns, values, rcond=None)[0]
    return math.hypot(a, b)


def body(
    geom: str,
    *,
    mass: float,
    inertia: Sequence[float],
    centre: str = "0 0 0",
    joint: str = "<freejoint/>",
    custom: str = "",
) -> mujoco.MjModel:
    """A model of one body 'b' with geoms, at the origin."""
    return mujoco.MjModel.from_xml_string(f"""<mujoco>
        <option timestep="0.005" integrator="RK4"/><custom>{custom}</custom><worldbody><body name="b">{joint}
        <inertial pos="{centre}" mass="{mass!r}" diaginertia="{" ".join(map(repr, map(float, inertia)))}"/>
        {geom}</body></worldbody></mujoco>""")


def numeric(quantity: str, values: Sequence[float]) -> str:
    """A numeric of MJCF that states it of body 'b'."""
    return (
        f'<numeric name="{quantity}:b" data="{" ".join(repr(float(value)) for value in values)}"/>'
    )
