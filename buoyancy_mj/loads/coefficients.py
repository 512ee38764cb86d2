"""Added mass and radiation damping from the datasets of potential-flow codes, at one frequency."""

import dataclasses
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import ModelError, choices

DOFS = ("Surge", "Sway", "Heave", "Roll", "Pitch", "Yaw")
"""Degrees of freedom by their names in datasets, alone or behind a body's name, 'body__Heave'."""


@dataclasses.dataclass(frozen=True)
class Coefficients:
    """What a dataset says of one body at one frequency, as `Buoyancy` and MJCF take it."""

    omega: float
    """The frequency of the dataset nearest to the one asked for [rad/s]."""
    added_mass: NDArray[np.float64]
    """(6, 6) [kg, kg m, kg m^2] in the body's axes, about its origin, as if the body were fully wet."""
    radiation: NDArray[np.float64]
    """Heave [N s/m], roll and pitch [N m s] (3,), about the dataset's centre of rotation."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class CoefficientsFile:
    """A dataset as a scene names it, see `read_coefficients`."""

    file: str
    """Where it is; a relative path starts from the scene's folder."""
    period: float
    """Of the motion or the waves [s]."""
    submerged: float = 1.0
    """Part of the hulls' volume under water in it."""
    centre: tuple[float, float, float] | None = None
    """What it rotates about, in the body's frame (3,) [m]; None for what it says itself."""
    body: str | None = None
    """The model's name for its only body; None if they are named alike."""

    def read(self, folder: Path) -> dict[str, Coefficients]:
        """Coefficients of each body, by its name in the model.

        Raises:
            ModelError: see `read_coefficients`; or a `body` for a dataset of several.
        """
        found = read_coefficients(
            folder / self.file, self.period, submerged=self.submerged, centre=self.centre
        )
        if self.body is None:
            return found
        if len(found) > 1:
            raise ModelError(
                f"'{self.file}' has the bodies {', '.join(found)}; name them as the model does, and give no body"
            )
        return {self.body: next(iter(found.values()))}


def read_coefficients(
    path: str | Path, period: float, *, submerged: float = 1.0, centre: ArrayLike | None = None
) -> dict[str, Coefficients]:
    """Coefficients of each body of a dataset, by its name there; what couples bodies is left out.

    Datasets are NetCDF as Capytaine exports them, and as it converts Nemoh's results: variables
    'added_mass' and 'radiation_damping' over 'omega', 'radiating_dof' and 'influenced_dof'. Needs xarray.

    Args:
        path: the file.
        period: of the motion or the waves [s]; the nearest frequency is taken.
        submerged: part of the hulls' volume under water in the dataset; `Buoyancy` scales added mass with it.
        centre: what the dataset rotates about, in the body's frame (3,) [m]; None for what it says itself,
            and for the origin if it does not.

    Raises:
        ModelError: a file that cannot be read or is no such dataset, or an argument out of its range.
    """
    if not (0.0 < period < math.inf and 0.0 < submerged <= 1.0):
        raise ModelError(
            f"period is {period} s and submerged {submerged}; the one must be positive, the other above 0 and at most 1"
        )
    data = _opened(Path(path))
    omegas = np.atleast_1d(np.asarray(data["omega"].values, float))
    usable = np.flatnonzero(np.isfinite(omegas))
    if not usable.size:
        raise ModelError(f"'{path}' has no finite frequency; export it over omega")
    nearest = int(usable[np.abs(omegas[usable] - 2.0 * math.pi / period).argmin()])
    if centre is None:
        centre = data["rotation_center"].values if "rotation_center" in data else np.zeros(3)
    about = np.asarray(centre, float).reshape(-1)
    if about.shape != (3,) or not np.isfinite(about).all():
        raise ModelError(
            f"the centre of rotation of '{path}' is {about.tolist()}; give one of three numbers (centre=)"
        )
    chosen = data.isel(omega=nearest) if "omega" in data["added_mass"].dims else data
    names = [str(name) for name in chosen["radiating_dof"].values]
    found = {}
    for body in dict.fromkeys(name.rpartition("__")[0] for name in names):
        dofs = {dof: f"{body}__{dof}" if body else dof for dof in DOFS}
        there = [i for i, dof in enumerate(DOFS) if dofs[dof] in names]
        if not there:
            raise ModelError(
                f"'{path}' moves '{body}' by none of {', '.join(DOFS)}; it has {', '.join(names)}"
            )
        labels = [dofs[DOFS[i]] for i in there]
        whole = {}
        for name in ("added_mass", "radiation_damping"):
            whole[name] = np.zeros((6, 6))
            block = (
                chosen[name]
                .sel(influenced_dof=labels, radiating_dof=labels)
                .transpose("influenced_dof", "radiating_dof")
            )
            whole[name][np.ix_(there, there)] = np.asarray(block.values, float)
            if not np.isfinite(whole[name]).all():
                raise ModelError(
                    f"'{path}' holds {name} that is no finite number at {omegas[nearest]:.4g} rad/s"
                )
        # from the centre to the origin: the velocity there is v + w x centre
        shift = np.eye(6)
        shift[:3, 3:] = [
            [0.0, about[2], -about[1]],
            [-about[2], 0.0, about[0]],
            [about[1], -about[0], 0.0],
        ]
        added = shift.T @ (0.5 * (whole["added_mass"] + whole["added_mass"].T)) @ shift / submerged
        label = body or (
            str(data["body"].values) if "body" in data and data["body"].ndim == 0 else "body"
        )
        found[label] = Coefficients(
            float(omegas[nearest]), added, np.diag(whole["radiation_damping"])[2:5].copy()
        )
    return found


def add_coefficients(spec: mujoco.MjSpec, coefficients: Mapping[str, Coefficients]) -> None:
    """Write coefficients into a model by the names of its bodies, where it states none itself: see `Buoyancy`.

    Raises:
        ModelError: the model has no such body.
    """
    bodies = {body.name for body in spec.bodies}
    numerics = {numeric.name for numeric in spec.numerics}
    for name, given in coefficients.items():
        if name not in bodies:
            raise ModelError(f"the model has no body '{name}'; {choices(name, bodies)}")
        for quantity, values in (
            ("added_mass", given.added_mass.ravel()),
            ("radiation_damping", given.radiation),
        ):
            if f"{quantity}:{name}" not in numerics:
                spec.add_numeric(name=f"{quantity}:{name}", data=values.tolist(), size=len(values))


def _opened(path: Path) -> Any:
    """A dataset, and that it has what is needed."""
    if not path.is_file():
        raise ModelError(f"the dataset '{path}' cannot be read: there is no such file")
    try:
        import xarray

        with xarray.open_dataset(path) as opened:
            data = opened.load()
    except ImportError as error:
        raise ModelError(
            f"reading '{path}' needs xarray and h5py: pip install 'buoyancy_mj[coefficients]'"
        ) from error
    except (OSError, ValueError, TypeError) as error:
        raise ModelError(
            f"the dataset '{path}' cannot be read: {str(error).splitlines()[0]}"
        ) from error
    for name in ("added_mass", "radiation_damping", "omega", "radiating_dof", "influenced_dof"):
        if name not in data and name not in data.coords:
            raise ModelError(
                f"the dataset '{path}' has no '{name}'; it has {', '.join(map(str, data.variables))}"
            )
    return data
