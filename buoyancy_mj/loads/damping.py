"""`Damping`: the user's choice of how the water slows bodies down."""

import dataclasses
from collections.abc import Mapping
from typing import Any

from buoyancy_mj.errors import ModelError, describe
from buoyancy_mj.values import read_truth, set_number

LARGEST = 1e6
"""Greatest coefficient, Froude number or viscosity; none in nature comes near it."""


def _set_numbers(options: Any) -> None:
    """Keep each field as a number from 0 to `LARGEST`."""
    for field in dataclasses.fields(options):
        set_number(options, ModelError, field.name, prefix="damping ", least=0.0, most=LARGEST)


@dataclasses.dataclass(frozen=True, kw_only=True)
class Silhouette:
    """Linear and quadratic damping of a body, estimated once from the silhouettes of its hulls.

    Along each axis of the body the force is 1/2 rho C A |u| u. A is the silhouette of all its
    hulls. C is `coefficient` times the mean square cosine between the hulls' normals and the axis,
    weighted by the projected area of each face. C is 1.05 for a cube face-on, 0.53 for a sphere
    and 0.70 for a cylinder across the flow. Hoerner, Fluid-Dynamic Drag (1965), ch. 3, measured
    1.05, 0.47 and, with a length of one to five diameters, 0.64 to 0.74 (table 7.3 of White, Fluid
    Mechanics, 8th ed.).

    When the body turns about an axis through the centroid of its volume, each strip of the two
    other silhouettes meets the flow at its own speed (cross-flow principle). The torque is
    1/2 rho C int |r|^3 dA |w| w.

    The linear part equals the quadratic one at a low speed, `linear_froude` sqrt(g L), with L the
    longest side of the body. In the measured coefficients of the BlueROV2 Heavy (von Benzon et al.
    2022, J. Mar. Sci. Eng. 10(12):1898) the two are equal at 0.10 m/s in surge and 0.17 m/s in
    heave, with L = 0.46 m a Froude number of 0.05 to 0.08.

    Raises:
        ModelError: a negative or infinite value.
    """

    coefficient: float = 1.05
    """Drag coefficient of a flat face across the flow."""
    linear_froude: float = 0.05
    """Froude number at which linear and quadratic damping are equal; 0 for no linear damping."""

    def __post_init__(self) -> None:
        _set_numbers(self)


@dataclasses.dataclass(frozen=True, kw_only=True)
class Panels:
    """Pressure drag and skin friction of each wet triangle in each step, for slender hulls.

    Leading faces have the coefficient 2/3 `coefficient`, trailing faces 1/3. So a plate across the
    flow has the whole `coefficient`, and a smooth hull along the flow little; the formulas stand in
    `kernels.panels.add_panels`.

    Raises:
        ModelError: a negative or infinite value, or no viscosity.
    """

    coefficient: float = 1.05
    """Drag coefficient of a flat face across the flow."""
    viscosity: float = 1.19e-6
    """Kinematic viscosity [m^2/s]: of sea water at 15 degrees Celsius (ITTC 7.5-02-01-03)."""

    def __post_init__(self) -> None:
        _set_numbers(self)
        if self.viscosity == 0.0:
            raise ModelError(
                "damping viscosity is 0; panels need one, "
                "1.19e-6 for sea water at 15 degrees Celsius"
            )


VISCOUS: Mapping[str, type[Silhouette] | type[Panels] | None] = {
    "silhouette": Silhouette,
    "panels": Panels,
    "none": None,
}
"""Kinds of viscous drag by name."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Damping:
    """How the water slows a body down: by viscous drag, and by the waves that the body makes.

    `viscous` estimates the drag of bodies whose damping the model does not give. A model gives it
    in `<custom>`, as numerics 'linear_damping:BODY' and 'quadratic_damping:BODY': force and torque
    per velocity and per velocity squared along the body's axes. Six numbers are diagonals, at the
    centroid of the body's wet volume. 36 numbers are matrices row by row, at the body's origin:
    D v and (D_n |v|) v (Fossen 2021, sec. 6.4).

    A model gives radiation damping as the numeric 'radiation_damping:BODY', three numbers for
    heave, roll and pitch: the force and torques per velocity of the waves that the body makes. They
    are scaled with its waterplane over its silhouette from above. Radiation is a load of its own.

    Raises:
        ModelError: a value of another kind.
    """

    viscous: Silhouette | Panels | None = Silhouette()
    """How drag is estimated; None for no viscous drag at all, not even the drag that the model
    gives."""
    radiation: bool = True
    """Whether the waves that bodies make slow them down, where the model gives radiation
    damping."""

    def __post_init__(self) -> None:
        if not isinstance(self.viscous, Silhouette | Panels | None):
            raise ModelError(
                f"damping viscous is {describe(self.viscous)}; "
                "it must be Silhouette(), Panels() or None"
            )
        radiation = read_truth(ModelError, "damping radiation", self.radiation)
        object.__setattr__(self, "radiation", radiation)
