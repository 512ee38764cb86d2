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
    hulls. C has two parts, of what is seen from outside:

    - Pressure: `coefficient` times the mean square cosine between the normals and the axis. It
      falls by 18 % from 0.55 to 2.2 lengths over widths, the width that of a circle as large as the
      silhouette: flow that separates at a blunt face closes on the sides of a longer body, 1.73
      diameters behind the face of a cylinder (JSME Int. J. B 39(2):354, 1996). C of cylinders along
      the flow was measured as 1.1, 0.93, 0.83, 0.85 at 0.5, 1, 2 and 4 diameters (Munson et al.,
      Fundamentals of Fluid Mechanics, 6th ed., fig. 9.20).
    - Friction: `friction` times the area of the sides over A.

    C is 1.04 for a cube face-on, 0.52 for a sphere, 0.20 for an ellipsoid four times as long as
    wide and 0.98 for a cylinder as long. Measured were 1.05 to 1.07, 0.47, 0.25 and 0.87 (White,
    Fluid Mechanics, 8th ed., table 7.3, after Hoerner, Fluid-Dynamic Drag, 1965, ch. 3).

    Bodies that active welds hold together are one body here, along the axes of the first of them,
    as long as the welds act.

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
    friction: float = 0.0075
    """Coefficient of skin friction; that of a smooth plate at a Reynolds number of 1.5e5 by
    default, 0.3 m long at 0.5 m/s (ITTC 1957). Ships have 0.002."""
    linear_froude: float = 0.05
    """Froude number at which linear and quadratic damping are equal; 0 for no linear damping."""

    def __post_init__(self) -> None:
        _set_numbers(self)


@dataclasses.dataclass(frozen=True, kw_only=True)
class Panels:
    """Pressure drag and skin friction of each wet triangle in each step, for slender hulls.

    Leading faces have the coefficient 2/3 `coefficient`, trailing faces 1/3. So a plate across the
    flow has the whole `coefficient`, and a smooth hull along the flow little; the formulas stand in
    `kernels.panels.add_panels`. Faces that lie against or within another hull of the body, or of
    what active welds hold to it, do not count.

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
