"""Thrusters: the T200's table, propellers of the B-series, and an AUV in a basin."""

import csv
import functools
import importlib.resources
import math
from collections.abc import Sequence
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.sea.water import Water
from buoyancy_mj.validation.case import Case, Row
from buoyancy_mj.validation.runs import numeric
from buoyancy_mj.vehicle.thrusters.adding import add_thruster, read_thrusters
from buoyancy_mj.vehicle.thrusters.thruster import Thruster
from buoyancy_mj.vehicle.thrusters.wageningen import wageningen

T200 = {
    (12, 1900): (2994.6, 3.714),
    (12, 1700): (1796.5, 1.279),
    (12, 1600): (1008.8, 0.3946),
    (12, 1400): (1022.6, -0.3175),
    (12, 1200): (2457.1, -1.9459),
    (12, 1100): (2975.7, -2.9037),
    (16, 1900): (3533.4, 5.245),
    (16, 1700): (2128.7, 1.823),
    (16, 1600): (1237.1, 0.6033),
    (16, 1100): (3465.0, -4.069),
    (20, 1900): (3931.0, 6.722),
    (20, 1100): (3782.5, -5.036),
}
"""Speed of the rotor [rev/min] and bollard pull [kgf] by supply [V] and pulse [us]."""
B_SERIES = {
    (4, 0.70): ((0.0, 0.4547, 0.6754), (0.4, 0.3142, 0.4921), (0.8, 0.1297, 0.2397)),
    (3, 0.65): ((0.0, 0.4415, 0.6719), (0.4, 0.2957, 0.4718), (0.8, 0.1172, 0.2185)),
}
"""J, K_T and 10 K_Q at a pitch ratio of 1, by blades and area ratio."""
WINDOWS = {
    "surge": ((136.0, 142.0), (165.0, 173.0), (216.0, 221.0)),
    "sway": ((151.0, 156.0), (225.0, 235.0)),
}
"""Stretches [s] in which the AUV went at a steady speed under a steady force, by run."""
AXES = {
    "surge": (0.70711, 0.70711, 0.70711, 0.70711),
    "sway": (-0.70711, 0.70711, -0.70711, 0.70711),
}
"""Share of the thrust of the horizontal thrusters 0, 3, 4, 7 along each run, forward and right."""
SIGNS = (1.0, 1.0, -1.0, -1.0)
"""Which way their pulses go."""
NEUTRAL = 1580.0
"""Pulse of the log at which they stand [us]; 1500 for the maker."""
FITTED = {"surge": (173.1, 67.7, 0.0), "sway": (143.3, 95.4, 54.0)}
"""Apparent mass [kg], linear [N s/m] and quadratic [N s^2/m^2] drag along each run, fitted to the
first `HALF` of it, with the forces that the table gives."""
HALF = 120.0
"""Time [s] from which on a run is predicted."""


# one thruster


def _compare_t200() -> Sequence[Row]:
    """Bollard pull and speed of the rotor, in the engine."""
    rows = []
    for (voltage, pulse), (speed, pull) in T200.items():
        found = _pull(Thruster(preset="t200", voltage=voltage, control="pwm"), pulse)
        what = f"{pulse} us at {voltage} V"
        rows.append(Row(f"pull, {what} [kgf]", pull, found[0] / 9.80665, 0.02))
        rows.append(Row(f"rotor, {what} [rev/min]", speed, 60.0 * abs(found[1]), 0.02))
    return rows


def _pull(thruster: Thruster, control: float) -> tuple[float, float]:
    """Thrust [N] and speed of the rotor [rev/s] of a thruster on a still body deep under water."""
    model = _build((thruster,), ((1.0, 0.0),), "1 0 0", (100.0, 0.0, 0.0))
    data = mujoco.MjData(model)
    data.ctrl[:] = control
    with Buoyancy(model, damping=None).installed():
        mujoco.mj_forward(model, data)
    read = read_thrusters(model, data)[0]
    return read.thrust, read.rotor_speed


def _compare_b_series() -> Sequence[Row]:
    """The polynomials of the series."""
    rows = []
    for (blades, area), published in B_SERIES.items():
        for j, thrust, torque in published:
            found = wageningen(blades, area, 1.0, j)[0]
            what = f"B{blades}-{100 * area:.0f} at J = {j:g}"
            rows.append(Row(f"K_T, {what}", thrust, float(found[0]), 1e-4, absolute=True))
            rows.append(Row(f"10 K_Q, {what}", torque, 10.0 * float(found[1]), 1e-4, absolute=True))
    return rows


# the AUV


class _Log(NamedTuple):
    """What was logged along a run, once a second."""

    times: NDArray[np.float64]
    """(n,) [s]."""
    voltages: NDArray[np.float64]
    """(n,) [V]."""
    pulses: NDArray[np.float64]
    """Of the horizontal thrusters (n, 4), about 1500 [us]."""
    forces: NDArray[np.float64]
    """Along the run (n,) [N]."""
    speeds: NDArray[np.float64]
    """Along the run (n,) [m/s]."""


@functools.cache
def _read_log(run: str) -> _Log:
    """The log of a run."""
    file = importlib.resources.files(__package__).joinpath("data", "beluga.csv")
    lines = [line for line in file.read_text("utf-8").splitlines() if not line.startswith("#")]
    rows = np.array([row[1:] for row in csv.reader(lines) if row[0] == run], float)
    pulses = 1500.0 + np.array(SIGNS) * (rows[:, 2:6] - NEUTRAL)
    return _Log(rows[:, 0], rows[:, 1], pulses, rows[:, 6], rows[:, 7])


def _compare_beluga() -> Sequence[Row]:
    """Forces by the table and the allocation, then speeds by the forces."""
    rows = []
    for run in WINDOWS:
        log = _read_log(run)
        forces = _find_forces(log, run)
        match = float(np.corrcoef(forces, log.forces)[0, 1])
        slope = float(forces @ log.forces / (log.forces @ log.forces))
        rows.append(Row(f"force in {run}, correlation", 1.0, match, 0.005))
        rows.append(Row(f"force in {run}, slope", 1.0, slope, 0.01))

        # in the engine, from the pulses alone
        log = _Log(*(column[log.times >= HALF] for column in log))
        speeds = _run(log, run)
        for begin, end in WINDOWS[run]:
            inside = (log.times >= begin) & (log.times <= end)
            force = log.forces[inside].mean()
            rows.append(
                Row(
                    f"{run} under {force:.1f} N [m/s]",
                    float(log.speeds[inside].mean()),
                    float(speeds[inside].mean()),
                    0.15,
                )
            )
    return rows


def _find_forces(log: _Log, run: str) -> NDArray[np.float64]:
    """Forces along a run (n,) [N], from pulses and supply."""
    supplies = log.voltages.round(1)
    forces = np.zeros(len(log.times))
    for supply in np.unique(supplies):
        here = supplies == supply
        thruster = Thruster(preset="t200", voltage=float(supply), control="pwm")
        forces[here] = thruster.thrust(log.pulses[here]) @ AXES[run]
    return forces


def _run(log: _Log, run: str) -> NDArray[np.float64]:
    """Speeds (n,) [m/s] of a body with the fitted mass and drag, under four thrusters."""
    voltage = float(log.voltages.mean())
    thruster = Thruster(preset="t200", voltage=voltage, control="pwm")
    axis = {"surge": "1 0 0", "sway": "0 1 0"}[run]
    axes = tuple(zip(AXES["surge"], AXES["sway"], strict=True))
    model = _build((thruster,) * 4, axes, axis, FITTED[run])
    data = mujoco.MjData(model)
    data.qvel[0] = log.speeds[0]
    speeds = []
    with Buoyancy(model, Water()).installed():
        for pulses in log.pulses:
            speeds.append(float(data.qvel[0]))
            data.ctrl[:] = pulses
            mujoco.mj_step(model, data, round(1.0 / model.opt.timestep))
    return np.array(speeds)


def _build(
    thrusters: Sequence[Thruster],
    axes: Sequence[tuple[float, float]],
    axis: str,
    fitted: tuple[float, float, float],
) -> mujoco.MjModel:
    """Build a body that weighs nothing in water and slides along an axis, with thrusters.

    Args:
        thrusters: what they are (n).
        axes: the directions (n) of their thrusts, x and y.
        axis: MJCF of the axis on which the body slides.
        fitted: its mass [kg], its linear and its quadratic drag along x and y.
    """
    mass, linear, quadratic = fitted
    radius = (mass / 1000.0 * 0.75 / math.pi) ** (1.0 / 3.0)
    sites = "".join(f'<site name="t{i}" zaxis="{x!r} {y!r} 0"/>' for i, (x, y) in enumerate(axes))
    spec = mujoco.MjSpec.from_string(f"""
        <mujoco>
          <option timestep="0.02" integrator="implicitfast"/>
          <custom>
            {numeric("linear_damping", (linear, linear, linear, 0.0, 0.0, 0.0))}
            {numeric("quadratic_damping", (quadratic, quadratic, quadratic, 0.0, 0.0, 0.0))}
          </custom>
          <worldbody>
            <body name="b" pos="0 0 -50">
              <joint type="slide" axis="{axis}"/>
              <geom type="sphere" size="{radius!r}" mass="{mass!r}"/>
              {sites}
            </body>
          </worldbody>
        </mujoco>""")
    for i, thruster in enumerate(thrusters):
        add_thruster(spec, f"t{i}", thruster, hand="none")
    return spec.compile()


CASES = (
    Case(
        "t200",
        "The T200 at bollard pull",
        "Blue Robotics, *T200 Public Performance Data 10-20V*, workbook of September 2019, with "
        "the Basic ESC R3",
        "A body deep under water, held by nothing yet, at the first instant of each pulse. The "
        "table that ships is an excerpt of the workbook's.",
        _compare_t200,
        loads=("buoyancy",),
    ),
    Case(
        "b_series",
        "Propellers of the Wageningen B-series in open water",
        "Oosterveld and van Oossanen 1975, *Further computer-analyzed data of the Wageningen "
        "B-screw series*, Int. Shipbuilding Progress 22, 251, at a Reynolds number of 2 million",
        "The polynomials of the preset 'b_series' at a pitch ratio of 1.",
        _compare_b_series,
    ),
    Case(
        "beluga_auv",
        "The thrusters of an AUV in a basin",
        "logs of the Beluga AUV of Vortex NTNU, 29 April 2021, in the basin of NTNU, with the "
        "pulses of its T200s, the voltage of its battery, the forces that it took them for, and "
        "its speeds",
        "Pulses and voltage give forces by the table and the vehicle's own allocation. Then four "
        "thrusters at the mean voltage, under the pulses of the second half of each run, move a "
        "body whose mass and drag are fitted to the first half: 173 kg, 67.7 N s/m in surge; "
        "143 kg, 95.4 N s/m, 54.0 N s^2/m^2 in sway.",
        _compare_beluga,
        loads=("buoyancy", "drag: as the model states it"),
    ),
)
"""In the order of the page."""
