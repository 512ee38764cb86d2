"""The curves of a thruster, as the kernels read them."""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from buoyancy_mj.errors import ModelError, describe
from buoyancy_mj.kernels.vehicle.rotor import SQUARE, THRUST, TORQUE

CONTROLS = ("pwm", "speed", "throttle", "thrust")
"""What a control may say."""
DENSITY = 1000.0
"""Of the water in which bollard pull is stated [kg/m^3]."""
NEUTRAL_PULSE, PULSE_SPAN, NO_PULSE = 1500.0, 400.0, 800.0
"""Pulse at which a rotor stands, from there to full speed, and below which there is none [us]."""
BLADE_AREA = 0.5
"""Area of the blades over that of the disc, where a propeller does not state it."""
_PLATE = 1.17
"""Drag coefficient of a plate across the flow, for the blades of a screw that stands (Hoerner 1965,
*Fluid-Dynamic Drag*, 3-16)."""
_ROWS = 25
"""Rows of the curve of a propeller of a series, up to the J at which it has no thrust."""

Doubles = NDArray[np.float64]


class Curves(NamedTuple):
    """See `kernels.vehicle.rotor` and `kernels.vehicle.open_water` for the columns."""

    demands: Doubles
    """(k, 2); no rows where commands are thrusts."""
    curve: Doubles
    """(m, 4)."""
    advance: Doubles
    """(j, 3); no rows for a thrust that no flow changes."""
    diameter: float
    """Of the propeller [m]."""
    drag: float
    """Half the drag coefficient of the blades, times their area over the square of the diameter."""

    def speed_of(self, thrust: Doubles) -> Doubles:
        """The speeds of the rotor [rev/s] with bollard pulls [N] in fresh water."""
        squares = np.interp(thrust, self.curve[:, THRUST], self.curve[:, SQUARE])
        speeds: Doubles = np.copysign(np.sqrt(np.abs(squares)), squares)
        return speeds

    def thrust_of(self, speed: Doubles) -> Doubles:
        """The bollard pulls [N] in fresh water at speeds of the rotor [rev/s]."""
        squares = speed * np.abs(speed)
        return np.interp(squares, self.curve[:, SQUARE], self.curve[:, THRUST])


def bollard_curves(rows: Doubles, diameter: float, advance: Doubles, control: str) -> Curves:
    """The curves of a thruster that is known by its bollard pull.

    Args:
        rows: (m, 5), throttle, speed of the rotor [rev/s], thrust [N], torque [N m], current [A].
        diameter: of the propeller [m].
        advance: (j, 3), see `Thruster.advance`.
        control: one of `CONTROLS`.

    Raises:
        ModelError: rows that do not rise, or a propeller that does more work than its motor.
    """
    _check_bollard(rows)
    squares = rows[:, 1] * np.abs(rows[:, 1])
    turning = squares != 0.0
    curve = np.vstack(
        [
            np.column_stack([squares, rows[:, 2:]])[turning & (squares < 0.0)],
            np.zeros((1, 4)),
            np.column_stack([squares, rows[:, 2:]])[turning & (squares > 0.0)],
        ]
    )
    if len(advance):
        _check_advance(advance, "advance")
        for end in (curve[0], curve[-1]):
            work = advance[:, 0] * diameter * end[THRUST] * advance[:, 1]
            _check_work(advance, work, 2.0 * math.pi * end[TORQUE] * advance[:, 2], "advance")
    drag = 0.125 * math.pi * BLADE_AREA * _PLATE
    return Curves(_demands(control, rows[:, :2]), curve, advance, diameter, drag)


def open_water_curves(
    rows: Doubles,
    diameter: float,
    speed: float,
    astern: float,
    control: str,
    area_ratio: float = BLADE_AREA,
) -> Curves:
    """The curves of a thruster that is known by its propeller in open water.

    Args:
        rows: (k, 3), J, K_T and K_Q, from J = 0 on.
        diameter: of the propeller [m].
        speed: of the rotor at most [rad/s].
        astern: bollard pull astern over that ahead.
        control: one of `CONTROLS`.
        area_ratio: area of the blades over that of the disc.

    Raises:
        ModelError: rows that do not rise, or a propeller that does more work than its motor.
    """
    _check_advance(rows, "open_water")
    thrust, torque = rows[0, 1:]
    if not (thrust > 0.0 and torque > 0.0):
        raise ModelError(
            f"open_water has K_T {thrust:g} and K_Q {torque:g} at J = 0; both must be above 0"
        )
    _check_work(rows, rows[:, 0] * rows[:, 1], 2.0 * math.pi * rows[:, 2], "open_water")
    most = speed / (2.0 * math.pi)
    ahead = np.array(
        [most**2, *(DENSITY * diameter**4 * most**2 * np.array([thrust, torque * diameter])), 0.0]
    )
    curve = np.vstack([-ahead * [1.0, astern, astern, 1.0], np.zeros(4), ahead])
    advance = rows / [1.0, thrust, torque]
    drag = 0.125 * math.pi * area_ratio * _PLATE
    ends = np.array([(-1.0, -most), (0.0, 0.0), (1.0, most)])
    return Curves(_demands(control, ends), curve, advance, diameter, drag)


def tabulate(coefficients: Callable[[Doubles], Doubles]) -> Doubles:
    """Rows J, K_T, K_Q (k, 3) of a propeller, up to a little beyond the J without thrust.

    Args:
        coefficients: K_T and K_Q (n, 2) at J (n,).
    """
    end = scipy.optimize.brentq(lambda j: float(coefficients(np.array([j]))[0, 0]), 0.0, 3.0)
    j = np.linspace(0.0, end, _ROWS)
    j = np.append(j, end + (j[1] - j[0]))
    return np.column_stack([j, coefficients(j)])


def _demands(control: str, rows: Doubles) -> Doubles:
    """The table from a command to a speed [rev/s], of throttles and speeds (m, 2)."""
    match control:
        case "thrust":
            return np.zeros((0, 2))
        case "speed":
            speeds = np.array([rows[0, 1], 0.0, rows[-1, 1]])
            return np.column_stack([2.0 * math.pi * speeds, speeds])
    return rows * [PULSE_SPAN if control == "pwm" else 1.0, 1.0]


def _check_bollard(rows: Doubles) -> None:
    """Refuse bollard pull that does not rise with the throttle, or not through a standing rotor."""
    for column, name in enumerate(("throttle", "rotor speed", "thrust")):
        steps = np.diff(rows[:, column])
        # within the dead band nothing changes
        stands = (rows[1:, 1] == 0.0) & (rows[:-1, 1] == 0.0) & (column > 0)
        wrong = np.flatnonzero(~((steps > 0.0) | (stands & (steps == 0.0))))
        if len(wrong):
            low, high = rows[wrong[0] : wrong[0] + 2, column]
            raise ModelError(
                f"bollard has a {name} of {high:g} after {low:g}; it must rise from row to row"
            )
    if not (rows[:, 1] == 0.0).any() or rows[rows[:, 1] == 0.0, 2].any():
        raise ModelError("bollard has no row with a rotor that stands without thrust; add one")
    wrong = np.flatnonzero(rows[:, 3] * rows[:, 1] < 0.0)
    if len(wrong):
        raise ModelError(
            f"bollard has a torque of {rows[wrong[0], 3]:g} at a rotor speed of "
            f"{rows[wrong[0], 1]:g} rev/s; the two must have one sign"
        )


def _check_advance(rows: Doubles, name: str) -> None:
    """Refuse a table over J that does not begin at 0, or does not rise."""
    if len(rows) < 2 or rows[0, 0] != 0.0:
        raise ModelError(
            f"{name} is {describe(rows.tolist())}; it must have two rows at least, from J = 0 on"
        )
    wrong = np.flatnonzero(np.diff(rows[:, 0]) <= 0.0)
    if len(wrong):
        low, high = rows[wrong[0] : wrong[0] + 2, 0]
        raise ModelError(f"{name} has J {high:g} after {low:g}; J must rise from row to row")
    if name == "advance" and (rows[0, 1:] != 1.0).any():
        raise ModelError(
            f"advance begins with {describe(rows[0].tolist())}; it must begin with 0, 1, 1, "
            "for its columns are over the values at J = 0"
        )


def _check_work(rows: Doubles, work: Doubles, power: Doubles, name: str) -> None:
    """Refuse a propeller whose thrust does more work than its motor, where torque is known."""
    wrong = np.flatnonzero((np.abs(work) > np.abs(power)) & (work * power > 0.0))
    if len(wrong):
        raise ModelError(
            f"{name} has an efficiency of {work[wrong[0]] / power[wrong[0]]:.2f} at "
            f"J = {rows[wrong[0], 0]:g}; J K_T / (2 pi K_Q) is 1 at most"
        )
