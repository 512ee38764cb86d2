"""What flags of `respond` and `decay` say: numbers, angles, points, seas and names of files."""

import collections
import dataclasses
import importlib
import math
import shlex
from collections.abc import Sequence
from pathlib import Path
from types import ModuleType
from typing import Annotated

import numpy as np
import typer

from buoyancy_mj.cli.console import err, print_line, quote_path
from buoyancy_mj.errors import ResponseError, SceneError, describe
from buoyancy_mj.responses.datasets import check_datasets, write_responses_netcdf
from buoyancy_mj.responses.extremes import HOURS_3, Sea
from buoyancy_mj.responses.respond import check_sea
from buoyancy_mj.responses.responses import Responses
from buoyancy_mj.responses.tables import write_responses_csv
from buoyancy_mj.sea.spectra import JonswapSea, PiersonMoskowitzSea
from buoyancy_mj.settings.texts import parse_toml
from buoyancy_mj.settings.toml import wave_from_table
from buoyancy_mj.values import read_number

SubjectArgument = Annotated[
    str,
    typer.Argument(
        help="An MJCF or URDF file, a scene (.toml), or the name of a model or scene that ships."
    ),
]
PICTURES = (".png", ".svg", ".pdf")
"""Ends of the names of pictures."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class SeaFlags:
    """A sea: what responses come to in it, and whether they are measured in it."""

    sea: Annotated[str | None, typer.Option(metavar="'KIND KEY=VALUE ...'")] = None
    """Tell what the responses come to in a sea, as 'jonswap significant_height=1 peak_period=6'."""
    hours: float = HOURS_3 / 3600.0
    """How long that sea lasts [h]."""
    irregular: Annotated[bool, typer.Option("--irregular")] = False
    """Measure in that sea, by cross-spectra with coherence."""

    def read(self) -> Sea | None:
        """The sea; None if none is given.

        Raises:
            ResponseError: it is none, or it is missing.
        """
        read_number(ResponseError, "--hours", self.hours, above=0.0)
        if self.sea is not None:
            sea = parse_sea(self.sea)
            check_sea(sea)
            return sea
        if self.irregular:
            raise ResponseError(
                "--irregular measures in a sea, and there is none; add one, as in "
                "--sea 'jonswap significant_height=1 peak_period=6'"
            )
        return None

    @property
    def duration(self) -> float:
        """How long it lasts [s]."""
        return 3600.0 * self.hours


@dataclasses.dataclass(frozen=True, kw_only=True)
class ResponseFiles:
    """Files into which responses go."""

    plot: Path | None = None
    """Draw the responses into this .png, .svg or .pdf."""
    csv: Path | None = None
    """Write a row for each wave into this .csv."""
    netcdf: Path | None = None
    """Write a dataset laid out as Capytaine's into this .nc."""

    def check(self) -> None:
        """Refuse, before anything is run, what could not be written.

        Raises:
            ResponseError: a name that does not say what the file is, or a library is missing.
        """
        if self.plot is not None:
            import_charts("--plot", self.plot)
        check_file("--csv", self.csv, (".csv",))
        check_file("--netcdf", self.netcdf, (".nc",))
        if self.netcdf is not None:
            check_datasets()

    def write(self, responses: Responses, sea: Sea | None) -> None:
        """Write them, and say where they are on the standard error.

        Raises:
            OSError: one cannot be written.
        """
        if self.csv is not None:
            write_responses_csv(responses, self.csv)
        if self.netcdf is not None:
            write_responses_netcdf(responses, self.netcdf)
        if self.plot is not None:
            import_charts("--plot", self.plot).draw_responses(responses, self.plot, sea)
        tell_files(self.plot, self.csv, self.netcdf)


def tell_files(*files: Path | None) -> None:
    """Say on the standard error which files were written."""
    for file in files:
        if file is not None:
            print_line(err, f"written: {quote_path(file)}")


def parse_numbers(flag: str, text: str) -> list[float]:
    """Numbers of 'a:b:n', n from a to b, or of 'a,b,c'.

    Raises:
        ResponseError: the text is neither, or has a number twice.
    """
    try:
        if ":" in text:
            first, last, count = text.split(":")
            if not 1 <= int(count) <= 100_000:
                raise ValueError
            numbers = np.linspace(float(first), float(last), int(count)).tolist()
        else:
            numbers = [float(word) for word in text.split(",")]
        if not all(map(math.isfinite, numbers)):
            raise ValueError
    except ValueError:
        raise ResponseError(
            f"{flag} is {describe(text)}; write a:b:n, n numbers from a to b, as in 2:12:21, or a "
            "list as in 4,6,8"
        ) from None
    counts = collections.Counter(numbers)
    if len(counts) < len(numbers):
        ((twice, _),) = counts.most_common(1)
        raise ResponseError(f"{flag} is {describe(text)}, which has {twice:g} twice; give it once")
    return [float(number) for number in numbers]


def parse_angles(flag: str, text: str) -> list[float]:
    """Angles [rad] of numbers in degrees, see `parse_numbers`."""
    return [math.radians(number) for number in parse_numbers(flag, text)]


def parse_points(texts: Sequence[str]) -> list[tuple[float, ...]]:
    """Points (3,) of texts 'x,y,z'.

    Raises:
        ResponseError: a text is no point.
    """
    points: list[tuple[float, ...]] = []
    for text in texts:
        try:
            x, y, z = map(float, text.split(","))
        except ValueError:
            raise ResponseError(
                f"--point is {describe(text)}; write x,y,z in metres, as in 0.5,0,0.2"
            ) from None
        points.append((x, y, z))
    return points


def parse_sea(text: str) -> Sea:
    """The sea of a kind and its keys: 'jonswap significant_height=1 peak_period=6'.

    Raises:
        ResponseError: the text describes none, or no irregular one.
    """
    hint = "write its kind and its keys, as in 'jonswap significant_height=1 peak_period=6'"
    try:
        kind, *settings = shlex.split(text)
        table = parse_toml("\n".join(settings), "--sea") | {"kind": kind}
        sea = wave_from_table(table, "--sea")
    except (ValueError, SceneError) as error:
        reason = f": {error}" if isinstance(error, SceneError) else ""
        raise ResponseError(f"--sea is {describe(text)}{reason}; {hint}") from error
    if not isinstance(sea, JonswapSea | PiersonMoskowitzSea):
        raise ResponseError(f"--sea is {describe(text)}, which has no spectrum; {hint}")
    return sea


def check_file(flag: str, path: Path | None, ends: Sequence[str]) -> None:
    """Check that the name of a file, if there is one, says what it is.

    Raises:
        ResponseError: it does not.
    """
    if path is not None and path.suffix not in ends:
        raise ResponseError(f"{flag} is '{path}'; its name must end in {' or '.join(ends)}")


def import_charts(flag: str, path: Path, module: str = "charts") -> ModuleType:
    """The module that draws, before anything is run.

    Raises:
        ResponseError: the name of the picture says no kind of picture, or Matplotlib is missing.
    """
    check_file(flag, path, PICTURES)
    try:
        return importlib.import_module(f"buoyancy_mj.responses.{module}")
    except ModuleNotFoundError as error:
        if error.name is None or not error.name.startswith("matplotlib"):
            raise
        raise ResponseError(
            f"{flag} needs matplotlib, which is not installed: pip install 'buoyancy_mj[charts]', "
            "or leave it out"
        ) from error
