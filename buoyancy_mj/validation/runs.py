"""Models of one body, and runs of models in water."""

from collections.abc import Callable, Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.loads.damping import Damping
from buoyancy_mj.sea.water import Water


def build_body(
    geom: str,
    *,
    mass: float,
    inertia: Sequence[float],
    centre: str = "0 0 0",
    joint: str = "<freejoint/>",
    custom: str = "",
) -> mujoco.MjModel:
    """Build a model of one body 'b' at the origin.

    Args:
        geom: MJCF of its geoms.
        mass: of the body [kg].
        inertia: diagonal (3,) [kg m^2].
        centre: MJCF of the centre of gravity [m].
        joint: MJCF of its joint.
        custom: MJCF of elements of `<custom>`, see `numeric`.
    """
    diagonal = " ".join(repr(float(value)) for value in inertia)
    return mujoco.MjModel.from_xml_string(f"""
        <mujoco>
          <option timestep="0.005" integrator="RK4"/>
          <custom>{custom}</custom>
          <worldbody>
            <body name="b">
              {joint}
              <inertial pos="{centre}" mass="{mass!r}" diaginertia="{diagonal}"/>
              {geom}
            </body>
          </worldbody>
        </mujoco>""")


def build_deep_body(geom: str, mass: float, custom: str = "") -> mujoco.MjModel:
    """Build a model of a free body 100 m under water, where it can fall for long."""
    model = build_body(geom, mass=mass, inertia=(0.1, 0.12, 0.14), custom=custom)
    place(model, [0.0, 0.0, -100.0])
    return model


def place(model: mujoco.MjModel, position: Sequence[float]) -> None:
    """Place the free body of a model at a position (3,) [m]."""
    model.body_pos[1] = position
    model.qpos0[:3] = position


def numeric(quantity: str, values: Sequence[float]) -> str:
    """MJCF of a numeric that sets a quantity of body 'b', such as its "added_mass"."""
    data = " ".join(repr(float(value)) for value in values)
    return f'<numeric name="{quantity}:b" data="{data}"/>'


def follow(
    model: mujoco.MjModel,
    water: Water,
    duration: float,
    *,
    read: Callable[[mujoco.MjData], float],
    start: Callable[[mujoco.MjData], None] = lambda _: None,
    pressure: str = "archimedes",
    added_mass: str = "model",
    damping: Damping | None = Damping(),
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Run a model in water, and read a value at the beginning of each step.

    Args:
        model: what moves.
        water: in which it moves.
        duration: of the run [s].
        read: returns the value.
        start: sets the data before the run.
        pressure: see `Buoyancy`.
        added_mass: see `Buoyancy`.
        damping: see `Buoyancy`.

    Returns:
        Times (n,) [s] and values (n,).
    """
    data = mujoco.MjData(model)
    start(data)
    times, values = [], []
    buoyancy = Buoyancy(model, water, pressure=pressure, added_mass=added_mass, damping=damping)
    with buoyancy.installed():
        while data.time < duration:
            times.append(data.time)
            values.append(read(data))
            mujoco.mj_step(model, data)
    return np.array(times), np.array(values)
