"""`Thruster`: what a thruster is like, and its bollard pull."""

import dataclasses
import functools
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import ModelError, choices, describe
from buoyancy_mj.kernels.vehicle.rotor import THRUST
from buoyancy_mj.values import ANY, read_array, read_truth, set_number
from buoyancy_mj.vehicle.thrusters import t200, t500
from buoyancy_mj.vehicle.thrusters.curves import (
    CONTROLS,
    NEUTRAL_PULSE,
    NO_PULSE,
    Curves,
    bollard_curves,
    open_water_curves,
    tabulate,
)
from buoyancy_mj.vehicle.thrusters.wageningen import wageningen

PRESETS = {
    "t200": ("voltage", "advance"),
    "t500": ("advance",),
    "b_series": ("blades", "area_ratio", "pitch_ratio", "diameter", "speed", "astern"),
}
"""Presets, and the fields beside them that say more."""
_OWN = {"open_water": ("diameter", "speed", "astern"), "bollard": ("diameter", "advance")}
"""Tables that a thruster may state itself, and the fields beside them."""
_NEEDED = ("blades", "area_ratio", "pitch_ratio", "diameter", "speed")
"""Fields that must be stated where they say something."""
_BOUNDS = {
    "deadband": {"least": 0.0},
    "lag": {"least": 0.0, "most": 1e3},
    "inertia": {"least": 0.0, "most": 1e9},
    "torque": {"above": 0.0, "most": 1e9},
    "wake": {"least": -1.0, "most": 0.9},
    "recovery": {"above": 0.0, "most": 1e4},
    "diameter": {"above": 0.0, "most": 20.0},
    "speed": {"above": 0.0, "most": 1e4},
    "astern": {"above": 0.0, "most": 2.0},
}
"""Range of each number; those of the presets are checked there."""

_COLUMNS = {"open_water": 3, "bollard": 4, "advance": 3}
"""Columns of each table."""

Row3 = tuple[float, float, float]
Row4 = tuple[float, float, float, float]


@dataclasses.dataclass(frozen=True, kw_only=True)
class Thruster:
    """A propeller with its drive: a preset, or a table of its own, and how it is commanded.

    Thrust and torque are those of bollard pull at the rotor's speed, times what the inflow leaves
    of them where that is known, times what the surface leaves.

    Raises:
        ModelError: an unknown preset or control, a number out of its range, a table that does not
            rise, a field that says nothing here or lacks.

    Example:
        >>> Thruster(preset="t200", voltage=16.0).limits()
        (-39.9..., 51.4...)
    """

    preset: str = ""
    """'t200' or 't500' of Blue Robotics, 'b_series' for a propeller of the Wageningen series; ''
    for a table in `open_water` or `bollard`."""
    control: str = "thrust"
    """What a control says: 'thrust' [N], in still fresh water; 'throttle' from -1 to 1; 'pwm', a
    pulse [us] from 1100 to 1900 about 1500, where less than 800 is no pulse; 'speed' [rad/s]."""
    voltage: float | None = None
    """Supply [V] of a 't200', from 10 to 20; None for 16."""
    blades: int | None = None
    """Number of blades of a 'b_series', from 2 to 7."""
    area_ratio: float | None = None
    """Expanded area of its blades over the disc's, from 0.3 to 1.05."""
    pitch_ratio: float | None = None
    """Its pitch over its diameter, from 0.5 to 1.4."""
    open_water: tuple[Row3, ...] = ()
    """Rows J, K_T, K_Q of a propeller in open water, from J = 0 on."""
    bollard: tuple[Row4, ...] = ()
    """Rows of bollard pull in fresh water from full astern to full ahead: throttle, speed of the
    rotor [rad/s], thrust [N], torque against the rotor [N m]."""
    advance: tuple[Row3, ...] = ()
    """Rows J, K_T over that at J = 0, K_Q over that at J = 0, from (0, 1, 1) on, for a thruster
    known by its bollard pull. () for a thrust that no inflow changes."""
    diameter: float | None = None
    """Of the propeller [m]."""
    speed: float | None = None
    """Greatest speed of the rotor [rad/s]."""
    astern: float | None = None
    """Bollard pull astern over that ahead at the same speed of the rotor; None for 1."""
    deadband: float = 0.0
    """Commands nearer than this to the one at which the rotor stands are not heard."""
    lag: float = 0.0
    """Time constant [s] with which the drive follows its command."""
    inertia: float = 0.0
    """Moment of inertia of the rotor and the water that turns with it [kg m^2]; with it the rotor's
    speed is a state, and its angular momentum is taken from the hull."""
    torque: float | None = None
    """Greatest torque of the motor [N m]; None for no limit."""
    wake: float = 0.0
    """Wake fraction: the share of the speed through the water that the hull takes off."""
    ventilation: bool = True
    """Whether air comes down to it near the surface."""
    recovery: float | None = None
    """Revolutions of the rotor in which that air leaves it; None for 10. It comes within one."""

    def __post_init__(self) -> None:
        if self.control not in CONTROLS:
            raise ModelError(
                f"thruster control is {describe(self.control)}; {choices(self.control, CONTROLS)}"
            )
        if self.preset and self.preset not in PRESETS:
            raise ModelError(
                f"thruster preset is {describe(self.preset)}; {choices(self.preset, PRESETS)}"
            )
        for name, bounds in _BOUNDS.items():
            if getattr(self, name) is not None or getattr(Thruster, name) is not None:
                set_number(self, ModelError, name, prefix="thruster ", **bounds)
        truth = read_truth(ModelError, "thruster ventilation", self.ventilation)
        object.__setattr__(self, "ventilation", truth)
        for name, columns in _COLUMNS.items():
            value = getattr(self, name)
            if not (isinstance(value, list | tuple) and len(value) == 0):
                rows = read_array(ModelError, f"thruster {name}", value, (ANY, columns))
                object.__setattr__(self, name, tuple(map(tuple, rows.tolist())))
        self._check_source()
        # a table that makes no sense is refused here
        curves = self.curves
        self._check_drive(len(curves.advance) > 0)

    def _check_source(self) -> None:
        """Refuse several sources of the bollard pull, none, and fields that say nothing."""
        sources = {name: getattr(self, name) for name in ("preset", *_OWN)}
        stated = [name for name, value in sources.items() if value]
        if len(stated) != 1:
            raise ModelError(
                f"a thruster states {' and '.join(stated) or 'neither preset nor table'}; "
                f"state one of preset ({', '.join(PRESETS)}), open_water, bollard"
            )
        source = stated[0]
        used = PRESETS[self.preset] if source == "preset" else _OWN[source]
        name = f"'{self.preset}'" if source == "preset" else source
        for field in sorted({f for fields in (*PRESETS.values(), *_OWN.values()) for f in fields}):
            value = getattr(self, field)
            if field not in used and value not in (None, ()):
                raise ModelError(
                    f"thruster {field} is {describe(value)}, which says nothing beside {name}; "
                    f"leave it out; possible: {', '.join(used)}"
                )
            if field in used and field in _NEEDED and value is None:
                raise ModelError(f"a thruster with {name} needs {field}; state it")

    def _check_drive(self, meets_flow: bool) -> None:
        """Refuse what says nothing about the drive."""
        if self.inertia and not self.lag:
            raise ModelError(
                "a thruster states inertia without lag; the rotor would need a torque without "
                "bound, so state the lag of its governor too"
            )
        if self.torque is not None and not self.inertia:
            raise ModelError(
                f"thruster torque is {self.torque:g} without inertia, which it would turn; "
                "state inertia too, or leave it out"
            )
        if self.recovery is not None and not self.ventilation:
            raise ModelError(
                f"thruster recovery is {self.recovery:g} without ventilation; leave it out"
            )
        if self.wake and not meets_flow:
            raise ModelError(
                f"thruster wake is {self.wake:g}, but no inflow changes its thrust; "
                "state advance too, or leave it out"
            )

    @functools.cached_property
    def curves(self) -> Curves:
        """Its curves, as the kernels read them."""
        if self.open_water or self.preset == "b_series":
            return self._open_water_curves()
        advance = np.array(self.advance, float).reshape(-1, 3)
        if self.preset == "t200":
            rows, diameter = t200.t200_rows(self.supply), t200.DIAMETER
        elif self.preset == "t500":
            rows, diameter = t500.t500_rows(), t500.DIAMETER
        else:
            stated = np.array(self.bollard)
            stated[:, 1] /= 2.0 * math.pi
            rows, diameter = np.column_stack([stated, np.zeros(len(stated))]), self.diameter or 0.0
        return bollard_curves(rows, diameter, advance, self.control)

    def _open_water_curves(self) -> Curves:
        """The curves of a propeller that is known in open water."""
        size = self.diameter or 0.0, self.speed or 0.0, self.astern or 1.0
        if self.open_water:
            return open_water_curves(np.array(self.open_water), *size, self.control)
        blades, area, pitch = self.blades or 0, self.area_ratio or 0.0, self.pitch_ratio or 0.0
        rows = tabulate(lambda j: wageningen(blades, area, pitch, j))
        return open_water_curves(rows, *size, self.control, area)

    @property
    def states(self) -> tuple[str, ...]:
        """What it keeps in `data.act`, in order: 'rotor' and 'air', either or none."""
        return ("rotor",) * (self.lag > 0.0) + ("air",) * self.ventilation

    @property
    def supply(self) -> float:
        """Voltage of the supply [V]; 0 where no table says the current."""
        if self.preset == "t200":
            return self.voltage or t200.VOLTAGE
        return t500.VOLTAGE if self.preset == "t500" else 0.0

    @property
    def neutral(self) -> float:
        """The command at which the rotor stands."""
        return NEUTRAL_PULSE if self.control == "pwm" else 0.0

    @property
    def least_heard(self) -> float:
        """Commands below this are none."""
        return NO_PULSE if self.control == "pwm" else -math.inf

    def limits(self) -> tuple[float, float]:
        """Least and most bollard pull [N], in fresh water."""
        thrusts = self.curves.curve[:, THRUST]
        return float(thrusts[0]), float(thrusts[-1])

    def control_range(self) -> tuple[float, float]:
        """Least and most command."""
        if not len(self.curves.demands):
            return self.limits()
        commands = self.curves.demands[[0, -1], 0] + self.neutral
        return float(commands[0]), float(commands[1])

    def thrust(self, command: ArrayLike) -> NDArray[np.float64]:
        """Bollard pulls [N] in still fresh water, of commands of any shape."""
        heard = np.asarray(command, float)
        asked = np.where(heard < self.least_heard, 0.0, heard - self.neutral)
        asked = np.where(np.abs(asked) < self.deadband, 0.0, asked)
        demands = self.curves.demands
        if not len(demands):
            bounded: NDArray[np.float64] = np.clip(asked, *self.limits())
            return bounded
        return self.curves.thrust_of(np.interp(asked, demands[:, 0], demands[:, 1]))

    def command(self, thrust: ArrayLike) -> NDArray[np.float64]:
        """Commands for bollard pulls [N] of any shape in still fresh water; the nearest it has.

        Where no command has a pull that is too small, it is that at which the rotor stands.
        """
        wanted: NDArray[np.float64] = np.clip(np.asarray(thrust, float), *self.limits())
        demands = self.curves.demands
        if not len(demands):
            return wanted
        speeds = self.curves.speed_of(wanted)

        # on either side of the dead band
        commands = np.zeros_like(speeds)
        for side in (-1.0, 1.0):
            rows = demands[demands[:, 1] * side >= 0.0]
            rests = np.flatnonzero(rows[:, 1] == 0.0)
            if len(rests):
                rows = rows[rests[-1] :] if side > 0.0 else rows[: rests[0] + 1]
            here = speeds * side > 0.0
            commands = np.where(here, np.interp(speeds, rows[:, 1], rows[:, 0]), commands)
        answer: NDArray[np.float64] = commands + self.neutral
        return answer
