"""Added mass and radiation damping from the datasets of potential-flow codes, at one frequency."""

import dataclasses
import math
from collections.abc import Mapping
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import ModelError, choices
from buoyancy_mj.hulls.custom import split_quantity
from buoyancy_mj.loads import datasets
from buoyancy_mj.loads.matrices import move_to_origin, symmetric_part


@dataclasses.dataclass(frozen=True)
class Coefficients:
    """Added mass and radiation damping of one body at one frequency, for `Buoyancy` and MJCF."""

    omega: float
    """The frequency of the dataset nearest to the one asked for [rad/s]."""
    added_mass: NDArray[np.float64]
    """(6, 6) [kg, kg m, kg m^2] in the body's axes, about its origin, as if the body were fully
    wet."""
    radiation: NDArray[np.float64]
    """Heave [N s/m], roll and pitch [N m s] (3,), about the dataset's centre of rotation."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class CoefficientsFile:
    """A dataset as a scene names it; the fields are arguments of `read_coefficients`."""

    file: str
    """Its path; a relative one starts from the scene's folder."""
    period: float
    """Period of the motion or the waves [s]."""
    submerged: float = 1.0
    """Part of the hulls' volume that is under water in the dataset."""
    centre: tuple[float, float, float] | None = None
    """Point about which the dataset rotates, in the body's frame (3,) [m]; None for the one it
    names."""
    body: str | None = None
    """The model's name for the only body of the dataset; None if both call it alike."""

    def read(self, folder: Path) -> dict[str, Coefficients]:
        """Read the coefficients of each body, by its name in the model.

        Raises:
            ModelError: `body` is set for a dataset of several; and all that `read_coefficients`
                raises.
        """
        coefficients = read_coefficients(
            folder / self.file, self.period, submerged=self.submerged, centre=self.centre
        )
        if self.body is None:
            return coefficients
        if len(coefficients) > 1:
            raise ModelError(
                f"'{self.file}' has the bodies {', '.join(coefficients)}; "
                "name them as the model does, and give no body"
            )
        return {self.body: next(iter(coefficients.values()))}


def read_coefficients(
    path: str | Path, period: float, *, submerged: float = 1.0, centre: ArrayLike | None = None
) -> dict[str, Coefficients]:
    """Read the coefficients of each body of a dataset, by its name there.

    Datasets are NetCDF as Capytaine exports them, and as it converts Nemoh's results: variables
    'added_mass' and 'radiation_damping' over 'omega', 'radiating_dof' and 'influenced_dof'. What
    couples bodies is left out. Needs xarray.

    Args:
        path: the file.
        period: of the motion or the waves [s]; the nearest frequency is taken.
        submerged: part of the hulls' volume under water in the dataset; `Buoyancy` scales added
            mass with it.
        centre: point about which the dataset rotates, in the body's frame (3,) [m]. None for the
            one that the dataset names, or the origin if it names none.

    Raises:
        ModelError: a file that cannot be read or is no such dataset, or an argument out of its
            range.

    Example:
        >>> coefficients = read_coefficients("boat.nc", period=9.0, submerged=0.4)
        >>> add_coefficients(spec, coefficients)
    """
    if not (0.0 < period < math.inf and 0.0 < submerged <= 1.0):
        raise ModelError(
            f"period is {period} s and submerged {submerged}; "
            "the one must be positive, the other above 0 and at most 1"
        )

    # one frequency of the dataset
    dataset = datasets.open_dataset(Path(path))
    index, omega = datasets.nearest_frequency(dataset, 2.0 * math.pi / period, path)
    point = datasets.rotation_centre(dataset, centre, path)
    at_omega = dataset.isel(omega=index) if "omega" in dataset["added_mass"].dims else dataset

    # of each body, both matrices
    coefficients = {}
    for body, dofs in datasets.bodies_and_dofs(at_omega, path).items():
        matrices = {}
        for name in ("added_mass", "radiation_damping"):
            matrices[name] = datasets.read_block(at_omega, name, body, dofs)
            if not np.isfinite(matrices[name]).all():
                raise ModelError(
                    f"'{path}' holds {name} that is no finite number at {omega:.4g} rad/s"
                )
        added_mass = move_to_origin(symmetric_part(matrices["added_mass"]), point) / submerged
        radiation = np.diag(matrices["radiation_damping"])[2:5].copy()
        coefficients[datasets.body_label(dataset, body)] = Coefficients(
            omega, added_mass, radiation
        )
    return coefficients


def add_coefficients(spec: mujoco.MjSpec, coefficients: Mapping[str, Coefficients]) -> None:
    """Add coefficients to a model as numerics, where it gives none itself.

    `Buoyancy` and the plugin read them as 'added_mass:BODY' and 'radiation_damping:BODY'.

    Args:
        spec: the model, which is changed.
        coefficients: by the names of its bodies.

    Raises:
        ModelError: the model has no such body.
    """
    bodies = {body.name for body in spec.bodies}
    given = {split_quantity(numeric.name) for numeric in spec.numerics}
    for name, of_body in coefficients.items():
        if name not in bodies:
            raise ModelError(f"the model has no body '{name}'; {choices(name, bodies)}")
        for quantity, values in (
            ("added_mass", of_body.added_mass.ravel()),
            ("radiation_damping", of_body.radiation),
        ):
            if (quantity, name) not in given:
                spec.add_numeric(name=f"{quantity}:{name}", data=values.tolist(), size=len(values))
