"""Datasets of potential-flow codes: NetCDF as Capytaine exports it, read with xarray."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import ModelError

DOFS = ("Surge", "Sway", "Heave", "Roll", "Pitch", "Yaw")
"""Degrees of freedom by their names in datasets, alone or behind a body's name, 'body__Heave'."""
_VARIABLES = ("added_mass", "radiation_damping", "omega", "radiating_dof", "influenced_dof")
"""Variables and coordinates that a dataset must have."""


def open_dataset(path: Path) -> Any:
    """An xarray Dataset, loaded and closed, with all that `read_coefficients` needs.

    Raises:
        ModelError: the file cannot be read, a variable is missing, or xarray is not installed.
    """
    if not path.is_file():
        raise ModelError(f"the dataset '{path}' cannot be read: there is no such file")
    try:
        import xarray

        with xarray.open_dataset(path) as opened:
            dataset = opened.load()
    except ImportError as error:
        raise ModelError(
            f"reading '{path}' needs xarray and h5py: pip install 'buoyancy_mj[coefficients]'"
        ) from error
    except (OSError, ValueError, TypeError) as error:
        raise ModelError(
            f"the dataset '{path}' cannot be read: {str(error).splitlines()[0]}"
        ) from error
    for name in _VARIABLES:
        if name not in dataset and name not in dataset.coords:
            variables = ", ".join(map(str, dataset.variables))
            raise ModelError(f"the dataset '{path}' has no '{name}'; it has {variables}")
    return dataset


def nearest_frequency(dataset: Any, omega: float, path: str | Path) -> tuple[int, float]:
    """The index, and the value [rad/s], of the finite frequency nearest to `omega` [rad/s].

    Raises:
        ModelError: the dataset has no finite frequency.
    """
    omegas = np.atleast_1d(np.asarray(dataset["omega"].values, float))
    finite = np.flatnonzero(np.isfinite(omegas))
    if not finite.size:
        raise ModelError(f"'{path}' has no finite frequency; export it over omega")
    nearest = int(finite[np.abs(omegas[finite] - omega).argmin()])
    return nearest, float(omegas[nearest])


def rotation_centre(
    dataset: Any, centre: ArrayLike | None, path: str | Path
) -> NDArray[np.float64]:
    """The point (3,) [m] about which a dataset rotates: `centre`, its own, or else the origin.

    Raises:
        ModelError: the point is not three finite numbers.
    """
    if centre is None:
        has_centre = "rotation_center" in dataset
        centre = dataset["rotation_center"].values if has_centre else np.zeros(3)
    point = np.asarray(centre, float).reshape(-1)
    if point.shape != (3,) or not np.isfinite(point).all():
        raise ModelError(
            f"the centre of rotation of '{path}' is {point.tolist()}; "
            "give one of three numbers (centre=)"
        )
    return point


def bodies_and_dofs(dataset: Any, path: str | Path) -> dict[str, list[int]]:
    """Indices into `DOFS` of the motions that a dataset has, by body; '' for a body without a name.

    Raises:
        ModelError: a body has none of them.
    """
    names = [str(name) for name in dataset["radiating_dof"].values]
    dofs: dict[str, list[int]] = {}
    for body in dict.fromkeys(name.rpartition("__")[0] for name in names):
        dofs[body] = [i for i, dof in enumerate(DOFS) if dof_label(body, dof) in names]
        if not dofs[body]:
            raise ModelError(
                f"'{path}' moves '{body}' by none of {', '.join(DOFS)}; it has {', '.join(names)}"
            )
    return dofs


def dof_label(body: str, dof: str) -> str:
    """How a dataset calls a degree of freedom of a body."""
    return f"{body}__{dof}" if body else dof


def read_block(dataset: Any, name: str, body: str, dofs: Sequence[int]) -> NDArray[np.float64]:
    """A variable of a body at one frequency as a matrix (6, 6); zero for missing motions."""
    labels = [dof_label(body, DOFS[i]) for i in dofs]
    block = dataset[name].sel(influenced_dof=labels, radiating_dof=labels)
    matrix = np.zeros((6, 6))
    matrix[np.ix_(dofs, dofs)] = block.transpose("influenced_dof", "radiating_dof").values
    return matrix


def body_label(dataset: Any, body: str) -> str:
    """The name of a body: the dataset's, where the motions do not say it, or else 'body'."""
    if body:
        return body
    has_name = "body" in dataset and dataset["body"].ndim == 0
    return str(dataset["body"].values) if has_name else "body"
