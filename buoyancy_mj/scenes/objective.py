"""`objective`: a number of a run as a function of fields of its scene, for optimisers."""

import contextlib
import math
import warnings
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from buoyancy_mj.errors import BuoyancyWarning, SweepError, choices, describe
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.bundle import Bundle, pack, unpack
from buoyancy_mj.scenes.journal import Journal, read_row
from buoyancy_mj.scenes.places import LOCAL, find_place
from buoyancy_mj.scenes.ranges import FieldRange, parse_range
from buoyancy_mj.scenes.variations import UntriedError, Values, Variations, vary
from buoyancy_mj.values import ANY, is_number, read_array

Row = Mapping[str, Any]
"""A row of results: numbers, texts, and None where a run has no such number."""


class Objective:
    """A number of a run as a function of fields of its scene; `objective` makes one.

    It may be sent to another process or machine, with the files of its scene, where it runs on one
    thread and keeps no rows.
    """

    def __init__(
        self,
        variations: Variations,
        ranges: Sequence[FieldRange],
        minimise: str | Callable[[Row], float],
        out: Path | None,
        on: str,
    ) -> None:
        self.keys = variations.keys
        """Keys of the fields, in the order of the parameters."""
        self.bounds = [(one.low, one.high) for one in ranges]
        """Least and greatest value of each parameter."""
        self.rows: list[Row] = []
        """The rows of all runs, as they came."""
        self._variations, self._minimise, self._on = variations, minimise, on
        self._numbers: dict[Values, int] = {}
        self._next = 0
        self._open(out)

    def __call__(self, x: ArrayLike) -> Any:
        """Run the scene with other values, or several times side by side.

        Args:
            x: parameters (n,), or of m runs (n, m), as SciPy has them where it is vectorized.

        Returns:
            The number to minimise, or (m,) of them; inf where a run failed.

        Raises:
            SweepError: `x` is of another shape, a run has no such number, a file that a run needs
                cannot be read, or the rows cannot be written.
        """
        count = len(self.keys)
        array = read_array(SweepError, "x", x, (count,), (count, ANY))
        points = [tuple(point) for point in np.atleast_2d(array.T).tolist()]
        self._run([point for point in dict.fromkeys(points) if point not in self._numbers])
        numbers = [self._rate(self.rows[self._numbers[point]]) for point in points]
        return numbers[0] if array.ndim == 1 else np.array(numbers)

    @property
    def best(self) -> Row:
        """The row of the least number so far.

        Raises:
            SweepError: no run has been done.
        """
        done = [row for row in self.rows if row["status"] == "done"]
        if not done:
            raise SweepError("no run of the objective is done; there is no best one")
        return min(done, key=self._rate)

    def close(self) -> None:
        """Close the file of the rows, and the cluster where this process started one."""
        self._stack.close()

    def __enter__(self) -> "Objective":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _open(self, out: Path | None) -> None:
        """Open the file and the place of the runs."""
        self._stack = contextlib.ExitStack()
        self._journal: Journal | None = None
        with contextlib.ExitStack() as stack:
            if out is not None:
                variations = self._variations
                self._journal = Journal(out, variations.header, variations.digest)
                stack.callback(self._journal.close)
                for run, row in self._journal.rows.items():
                    self._keep(row)
                    self._next = max(self._next, run + 1)
            self._work = stack.enter_context(find_place(self._on)())
            self._stack = stack.pop_all()

    def _run(self, points: Sequence[Values]) -> None:
        """Run what has not been run; rows are kept as they come."""
        values = dict(enumerate(points, self._next))
        self._next += len(points)
        try:
            with contextlib.closing(self._work(self._variations, values)) as done:
                for rows in done:
                    if self._journal is not None:
                        self._journal.add(*rows)
                    for row in rows:
                        self._keep(row)
        except (MemoryError, UntriedError) as error:
            raise SweepError(
                f"the objective cannot be found: {str(error) or 'the memory ran out'}"
            ) from error

    def _keep(self, row: Row) -> None:
        """Remember a row by its values, and tell of the first that failed."""
        row = read_row(row)
        if row["status"] != "done" and all(one["status"] == "done" for one in self.rows):
            warnings.warn(
                f"a run of the objective failed, and counts as inf: {row['reason']}",
                BuoyancyWarning,
                stacklevel=4,
            )
        self._numbers[tuple(float(row[key]) for key in self.keys)] = len(self.rows)
        self.rows.append(row)

    def _rate(self, row: Row) -> float:
        """The number to minimise."""
        if row["status"] != "done":
            return math.inf
        number = self._minimise(row) if callable(self._minimise) else row[self._minimise]
        if not is_number(number) or math.isnan(number):
            named = ", ".join(f"{key}={row[key]:g}" for key in self.keys)
            raise SweepError(
                f"the run with {named} has {describe(number)} to minimise; give a function of the "
                "row that makes a number of it"
            )
        return float(number)

    def __reduce__(self) -> tuple[Any, ...]:
        if self._journal is not None:
            raise SweepError(
                f"an objective that keeps its rows in '{self._journal.path}' stays in its process; "
                "leave out= out to send it to others"
            )
        return _receive, (pack(self._variations), self.bounds, self._minimise)


def _receive(bundle: Bundle, bounds: list[tuple[float, float]], minimise: Any) -> Objective:
    """An objective that another process sent."""
    keys = bundle.variations.keys
    ranges = [FieldRange(key, *ends, 0) for key, ends in zip(keys, bounds, strict=True)]
    return Objective(unpack(bundle), ranges, minimise, None, LOCAL)


def objective(
    scene: str | Path,
    over: Sequence[str],
    minimise: str | Callable[[Row], float],
    *,
    settings: Sequence[str] = (),
    out: str | Path | None = None,
    on: str = LOCAL,
    trust: bool = False,
    measure: Sequence[str] = (),
) -> Objective:
    """Make a number of a run a function of fields of its scene, for an optimiser to minimise.

    Values that were run before are not run again, also not in another process that goes on with the
    same file.

    Args:
        scene: a scene file, or the name of a scene that ships.
        over: texts 'KEY=a:b', one for each parameter, with its bounds.
        minimise: a column of the rows of a sweep, or a function of a row.
        settings: texts KEY=VALUE that all runs share.
        out: a .csv file of a row for each run; None for none.
        on: where the runs are run, as for `Sweep.run`.
        trust: whether to run the Python files that the scene names as controllers.
        measure: names of sensors whose numbers become columns.

    Raises:
        SceneError: the scene cannot be read, has no such field or sensor, or names a controller
            that is not trusted.
        SweepError: a range, a column, a file or a place that makes no sense.

    Example:
        >>> from scipy.optimize import differential_evolution
        >>> settings = ["duration=1"]
        >>> over = ["mass=10:20"]
        >>> drop = objective("hourglass_drop_still", over, "peak_draft", settings=settings)
        >>> best = differential_evolution(
        ...     drop, drop.bounds, vectorized=True, updating="deferred", seed=1
        ... )
    """
    ranges = _read_ranges(over)
    keys = tuple(one.key for one in ranges)
    middle = tuple(0.5 * (one.low + one.high) for one in ranges)
    path = catalog.scene_path(str(scene))
    variations = vary(path, tuple(settings), keys, [middle], trust=trust, measure=measure)
    if not callable(minimise) and minimise not in variations.results:
        raise SweepError(
            f"minimise is {describe(minimise)}; {choices(minimise, variations.results)}"
        )
    if out is not None and Path(out).suffix != ".csv":
        raise SweepError(f"out is '{out}'; rows go to a file that ends in .csv")
    return Objective(variations, ranges, minimise, None if out is None else Path(out), on)


def _read_ranges(over: Sequence[str]) -> list[FieldRange]:
    """The parameters and their bounds."""
    if isinstance(over, str) or not over:
        raise SweepError(
            f"over is {describe(over)}; give a list of 'KEY=a:b', one for each parameter"
        )
    ranges = [parse_range(text) for text in over]
    for one in ranges:
        if one.listed:
            raise SweepError(
                f"over {one.text} is a list, and an optimiser chooses between bounds; give "
                f"{one.key}=a:b"
            )
        if one.count:
            raise SweepError(
                f"over {one.text} has a number of values, which an optimiser does not use; "
                f"leave out ':{one.count}'"
            )
        if not one.low < one.high:
            raise SweepError(f"over {one.text} has no room; give KEY=a:b with a below b")
    keys = [one.key for one in ranges]
    if len(set(keys)) < len(keys):
        raise SweepError(f"a field is given twice: {', '.join(keys)}; give each once")
    return ranges
