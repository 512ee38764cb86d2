"""`Variations`: a scene some of whose fields vary from run to run, and the row that a run gives."""

import dataclasses
import hashlib
import json
import warnings
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from buoyancy_mj.errors import BuoyancyError, BuoyancyWarning, SceneError, SceneTypeError
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.assembly import assemble
from buoyancy_mj.scenes.batches import run_simulations
from buoyancy_mj.scenes.linear_algebra import on_one_thread
from buoyancy_mj.scenes.ranges import Value
from buoyancy_mj.scenes.scene import Scene, read_scene
from buoyancy_mj.scenes.sensor_measures import find_channels
from buoyancy_mj.scenes.simulation import Simulation
from buoyancy_mj.scenes.steering import check_trust
from buoyancy_mj.scenes.summary import list_sensor_values, list_values

Values = tuple[Value, ...]
"""The values of a run, one for each field that varies."""

_NO_COLUMNS = ("scene", "wall_time", "real_time_factor")
"""Values of the summary that become no columns: a digest stands for the scene, and time varies."""
_OF_MISSION = ("points", "mission_time")
"""Columns of a scene with a mission: its points, and the length of the attempt [s]."""
_OF_FILES = ("MuJoCo cannot read", "Error opening file", "ould not allocate")
"""Words of errors that have to do with files or memory, and not with the values of a run."""


class UntriedError(Exception):
    """A run that could not be tried, whatever its values."""


@dataclasses.dataclass(frozen=True)
class Variations:
    """What a run needs beside its values to become a row of results."""

    path: Path
    """The scene's file."""
    settings: tuple[str, ...]
    """Settings that all runs share, as for `--set`."""
    keys: tuple[str, ...]
    """Keys of the fields that vary."""
    trust: bool
    """Whether to run the Python files that the scene names as controllers."""
    digest: str
    """A short text of all that the runs have in common."""
    results: tuple[str, ...]
    """Columns of the summary; with several vehicles each has NAME.column."""
    sensors: tuple[str, ...] = ()
    """Names of the sensors that are measured."""
    folder: str = ""
    """Where the scene's files lie that came from another machine; reasons leave it out."""

    @property
    def header(self) -> list[str]:
        """Columns of a row."""
        return ["run", "scene", *self.keys, "status", "reason", *self.results]

    def read_scene(self, values: Values) -> Scene:
        """The scene with the values of one run.

        Raises:
            SceneError: the values make no sense.
        """
        return _read_scene(self.path, self.settings, self.keys, values)

    def run(self, values: Mapping[int, Values], threads: int = 0) -> Iterator[dict[str, Any]]:
        """Run some runs side by side; the rows are the same on any number of threads and cores.

        Args:
            values: the values of each, by its number.
            threads: number of threads that step at once; 0 for one per core.

        Yields:
            A row for each run, as they end.

        Raises:
            UntriedError: a file that a run needs cannot be read.
            MemoryError: the memory runs out.
        """
        return on_one_thread(self._run(values, threads))

    def _run(self, values: Mapping[int, Values], threads: int) -> Iterator[dict[str, Any]]:
        """A row for each run, as they end."""
        simulations: dict[int, Simulation] = {}
        for run, own in values.items():
            try:
                scene = self.read_scene(own)
                simulations[run] = Simulation(scene, trust=self.trust, measure=self.sensors)
            except BuoyancyError as error:
                if not _is_of_values(error):
                    raise UntriedError(self._leave_folder_out(str(error))) from error
                yield self._row(run, own, reason=str(error))
        for run, reason in run_simulations(simulations, threads):
            yield self._row(run, values[run], simulations[run], reason)

    def _row(
        self, run: int, values: Values, simulation: Simulation | None = None, reason: str = ""
    ) -> dict[str, Any]:
        """One row of the results."""
        row = {
            "run": run,
            "scene": self.digest,
            "status": "failed" if reason else "done",
            "reason": " ".join(self._leave_folder_out(reason).split()),
        }
        row |= dict(zip(self.keys, values, strict=True))
        results: dict[str, Any] = {}
        if simulation and not reason:
            results = simulation.summary().values()
            if simulation.mission is not None:
                report = simulation.mission.report
                results |= dict(zip(_OF_MISSION, (report.points, report.run_time), strict=True))
        return row | {name: results.get(name) for name in self.results}

    def _leave_folder_out(self, text: str) -> str:
        """A text in which files have the paths that they have where the sweep was started."""
        return text.replace(self.folder, "") if self.folder else text


def vary(
    path: Path,
    settings: tuple[str, ...],
    keys: tuple[str, ...],
    some: Sequence[Values],
    *,
    trust: bool,
    measure: Sequence[str] = (),
) -> Variations:
    """Look at a scene whose fields `keys` vary.

    Args:
        path: the scene's file.
        settings: settings that all runs share.
        keys: keys of the fields that vary.
        some: values of some runs; the first that can be assembled says which vehicles float.
        trust: whether to run the Python files that the scene names as controllers.
        measure: names of sensors that become columns, as for `Simulation`.

    Raises:
        SceneError: the scene cannot be read, a key that it does not have or whose values are of
            another type, a controller that is not trusted, or a sensor that is not there.
    """
    scene = read_scene(path, settings)
    check_trust(scene, trust=trust)
    _check_keys(path, settings, keys, some)

    # columns
    vehicles, channels = _name_columns(path, settings, keys, some, measure)
    steered = [control.vehicle or vehicles[0] for control in scene.control]
    names = list_values(vehicles, steered)
    if scene.mission is not None:
        names += _OF_MISSION
    names += list_sensor_values(channels)
    results = tuple(name for name in names if name not in (*_NO_COLUMNS, *keys))
    digest = _digest(path, settings, keys, scene)
    return Variations(path, settings, keys, trust, digest, results, tuple(measure))


def _read_scene(path: Path, settings: Sequence[str], keys: Sequence[str], values: Values) -> Scene:
    """The scene with the values of one run."""
    # a text in quotes is TOML as well as JSON
    varied = (f"{key}={json.dumps(value)}" for key, value in zip(keys, values, strict=True))
    return read_scene(path, [*settings, *varied])


def _check_keys(
    path: Path, settings: Sequence[str], keys: Sequence[str], some: Sequence[Values]
) -> None:
    """Refuse a key that the scene lacks, or that takes no numbers: every run would fail."""
    try:
        _read_scene(path, settings, keys, some[0])
    except SceneTypeError:
        raise
    except SceneError:
        # other values may make sense
        return


def _name_columns(
    path: Path,
    settings: Sequence[str],
    keys: Sequence[str],
    some: Sequence[Values],
    measure: Sequence[str],
) -> tuple[list[str], list[str]]:
    """Names of the vehicles and of the sensors' numbers, as in the first run that is assembled."""
    names = [""]
    for values in some:
        try:
            scene = _read_scene(path, settings, keys, values)
            names = [str(entry.name) for entry in scene.entries]
            with warnings.catch_warnings():
                # the run itself will give them
                warnings.simplefilter("ignore", BuoyancyWarning)
                assembled = assemble(scene)
        except BuoyancyError:
            # the row of that run will say why
            continue
        channels = find_channels(assembled.model, measure)
        return [group.name for group in assembled.afloat], list(channels)
    return names, []


def _digest(path: Path, settings: tuple[str, ...], keys: tuple[str, ...], scene: Scene) -> str:
    """A short text of the files, the settings and the keys."""
    models = [catalog.model_path(entry.model, scene.folder) for entry in scene.entries]
    controls = [file for control in scene.control for file in control.list_files(scene.folder)]
    files = [file.read_bytes() for file in (path, *models, *controls) if file.is_file()]
    common = repr((*files, settings, keys))
    return f"{path.stem} {hashlib.blake2b(common.encode(), digest_size=4).hexdigest()}"


def _is_of_values(error: BaseException) -> bool:
    """Whether an error may be due to the values of a run, and not to files or memory."""
    if isinstance(error, (OSError, MemoryError)) or any(words in str(error) for words in _OF_FILES):
        return False
    cause = error.__cause__
    return cause is None or _is_of_values(cause)
