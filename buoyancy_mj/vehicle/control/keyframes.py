"""`Keyframes`: a schedule of controls from a table of comma-separated values."""

import csv
import dataclasses
import math
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import ControlError, choices, describe
from buoyancy_mj.values import read_text
from buoyancy_mj.vehicle.control.controller import Control, Outset

BETWEEN = ("hold", "linear")
"""What controls do between two times."""
TIME = "time"
"""Name of the column of times."""


class Schedule(NamedTuple):
    """Controls at some times."""

    names: tuple[str, ...]
    """Names of the actuators (m)."""
    times: NDArray[np.float64]
    """Times (n,) [s], rising."""
    controls: NDArray[np.float64]
    """Controls (n, m)."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Keyframes(Control):
    """Controls by a schedule: a table with a column `time` and one for each actuator that it moves.

    Before the first time controls stay as they are, after the last one they stay as they are there.

    Raises:
        ControlError: no file, or another word between two times.
    """

    file: str
    """File of comma-separated values; its first line names the columns."""
    between: str = "hold"
    """What controls do between two times: 'hold' the value of the earlier, or go on 'linear'."""
    rate: float | None = None
    """Number of updates per simulated second [Hz]; None for one in each step."""

    def __post_init__(self) -> None:
        super().__post_init__()
        read_text(ControlError, "file", self.file)
        if self.between not in BETWEEN:
            raise ControlError(
                f"between is {describe(self.between)}; {choices(self.between, BETWEEN)}"
            )

    @property
    def title(self) -> str:
        """What messages call it."""
        return f"keyframes of '{self.file}'"

    def list_files(self, folder: Path) -> tuple[Path, ...]:
        """The table."""
        return (folder / Path(self.file).expanduser(),)

    def start(self, outset: Outset) -> "KeyframesController":
        """Read the schedule."""
        (path,) = self.list_files(outset.folder)
        return KeyframesController(read_schedule(path), self.between, outset, path)


class KeyframesController:
    """Plays a schedule on one vehicle.

    Args:
        schedule: controls at some times.
        between: what they do between two times.
        outset: the vehicle.
        path: what messages call the schedule.

    Raises:
        ControlError: the vehicle has no such actuator.
    """

    def __init__(self, schedule: Schedule, between: str, outset: Outset, path: Path) -> None:
        self._schedule, self._is_linear = schedule, between == "linear"
        own = _find_controls(outset)
        for column, name in enumerate(schedule.names, 2):
            if name not in own:
                raise ControlError(
                    f"'{path}' has a column {describe(name)} (the {_ordinal(column)}), and the "
                    f"vehicle has no such actuator; {choices(name, own)}"
                )
        self._addresses = [own[name] for name in schedule.names]

    def __call__(self, _: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Write the controls of the time of the data."""
        times, controls = self._schedule.times, self._schedule.controls
        # the small part forgives the rounding of times
        now = float(data.time) + 1e-9
        row = int(np.searchsorted(times, now, side="right")) - 1
        if row < 0:
            return
        values = controls[row]
        if self._is_linear and row + 1 < len(times):
            share = (now - times[row]) / (times[row + 1] - times[row])
            values = values + share * (controls[row + 1] - values)
        data.ctrl[self._addresses] = values


def read_schedule(path: Path) -> Schedule:
    """Read a schedule from a table of comma-separated values, in UTF-8.

    Raises:
        ControlError: the file cannot be read, has no column of times or a column twice, has a gap
            or what is no finite number, or its times do not rise; the message names the line.
    """
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            reader = csv.reader(file, strict=True)
            lines = [(reader.line_num, [word.strip() for word in words]) for words in reader]
            lines = [line for line in lines if any(line[1])]
    except (OSError, ValueError, csv.Error) as error:
        raise ControlError(f"the schedule '{path}' cannot be read: {error}") from error
    if len(lines) < 2:
        raise ControlError(
            f"the schedule '{path}' holds no controls; needed are a line of names, as "
            "time,ACTUATOR, and lines of numbers"
        )
    (_, header), *rows = lines
    names = _read_header(path, header)
    values = np.array([_read_row(path, number, header, words) for number, words in rows])
    times = values[:, header.index(TIME)]
    for (number, _), before, after in zip(rows[1:], times[:-1], times[1:], strict=True):
        if not after > before:
            raise ControlError(
                f"line {number} of '{path}' has the time {after:g} s after {before:g} s; "
                "times must rise from line to line"
            )
    columns = [header.index(name) for name in names]
    return Schedule(names, times, values[:, columns])


def _read_header(path: Path, header: list[str]) -> tuple[str, ...]:
    """The names of the actuators in the first line."""
    if TIME not in header:
        raise ControlError(
            f"the first line of '{path}' names no column '{TIME}'; it has {', '.join(header)}"
        )
    for column, name in enumerate(header, 1):
        if not name:
            raise ControlError(f"the first line of '{path}' has no name in column {column}")
        if header.count(name) > 1:
            raise ControlError(f"'{path}' has two columns '{name}'; leave one out")
    names = tuple(name for name in header if name != TIME)
    if not names:
        raise ControlError(f"'{path}' has no column but '{TIME}'; add one for each actuator")
    return names


def _read_row(path: Path, line: int, header: list[str], words: list[str]) -> list[float]:
    """The numbers of a line."""
    if len(words) != len(header):
        raise ControlError(
            f"line {line} of '{path}' has {len(words)} values, and the first line names "
            f"{len(header)} columns; give each a value"
        )
    numbers = []
    for name, word in zip(header, words, strict=True):
        try:
            number = float(word)
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            got = describe(word) if word else "empty"
            raise ControlError(
                f"line {line} of '{path}', column '{name}', is {got}; needed is a finite number"
            )
        numbers.append(number)
    return numbers


def _find_controls(outset: Outset) -> Mapping[str, int]:
    """Addresses in `data.ctrl` of actuators with one control, by their names in the file."""
    model, prefix = outset.model, outset.prefix
    names = {}
    for actuator in range(len(model.actuator_ctrladr)):
        name = str(model.actuator(actuator).name)
        if name.startswith(prefix) and name and model.actuator_ctrlnum[actuator] == 1:
            names[name.removeprefix(prefix)] = int(model.actuator_ctrladr[actuator])
    return names


def _ordinal(number: int) -> str:
    """A place in a row, in words."""
    return {1: "1st", 2: "2nd", 3: "3rd"}.get(number, f"{number}th")
