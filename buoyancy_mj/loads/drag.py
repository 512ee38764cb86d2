"""`Drag`: damping good enough to settle, estimated from what a hull shows to the flow."""

import dataclasses
import math
from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import ModelError
from buoyancy_mj.hulls.custom import read_custom
from buoyancy_mj.hulls.hull import Hull
from buoyancy_mj.hulls.selection import body_name
from buoyancy_mj.kernels.damping import DampingArrays
from buoyancy_mj.kernels.rays import silhouette
from buoyancy_mj.meshes.mesh import TriMesh

CELLS = 200
"""Cells along each side of the grid on which a silhouette is measured."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Drag:
    """How linear and quadratic damping are estimated from the hulls of a body.

    Along each axis of the body the force is 1/2 rho C A |u| u: A is the silhouette of all its hulls,
    C is `coefficient` times the mean square cosine between the hulls' normals and the axis, weighed
    by what each face shows. That makes 1.05 for a cube face-on, 0.53 for a sphere and 0.70 for a
    cylinder across the flow; Hoerner, Fluid-Dynamic Drag (1965), ch. 3, measured 1.05, 0.47 and,
    with a length of one to five diameters, 0.64 to 0.74 (table 7.3 of White, Fluid Mechanics, 8th ed.).

    Turning about an axis through the centroid of its volume, each strip of the two other silhouettes
    meets the flow at its own speed (cross-flow principle): the torque is 1/2 rho C int |r|^3 dA |w| w.

    The linear part equals the quadratic one at a low speed, `linear_froude` sqrt(g L), with L the
    longest side of the body. In the measured coefficients of the BlueROV2 Heavy (von Benzon et al.
    2022, J. Mar. Sci. Eng. 10(12):1898) the two are equal at 0.10 m/s in surge and 0.17 m/s in
    heave, with L = 0.46 m a Froude number of 0.05 to 0.08.

    With `panels` each wet triangle has its own pressure drag and skin friction instead, see
    `kernels.panels.add_panels`: faces that lead have the coefficient 2/3 `coefficient`, those that
    trail 1/3, so that a plate across the flow has all of it, and a smooth hull along the flow little.

    It is an estimate. A body whose own damping the model states, as numerics 'linear_damping:BODY' and
    'quadratic_damping:BODY' in `<custom>`, has that instead: force and torque per velocity and per
    velocity squared along the body's axes. Six numbers are diagonals, at the centroid of what is wet
    of it; 36 are matrices row by row, at its origin, D v and (D_n |v|) v (Fossen 2021, sec. 6.4).

    'radiation_damping:BODY' of three numbers is what the waves that it makes take from heave, roll and
    pitch, force and torques per velocity, scaled with its waterplane over its silhouette from above;
    a load of its own, whether or not there is drag.

    Raises:
        ModelError: a negative or infinite value.
    """

    coefficient: float = 1.05
    """Drag coefficient of a flat face across the flow."""
    linear_froude: float = 0.05
    """Froude number at which linear and quadratic damping are equal; 0 for no linear damping."""
    viscous: bool = True
    """Whether there is drag at all."""
    radiation: bool = True
    """Whether bodies lose what the waves take that they make, if the model states it."""
    panels: bool = False
    """Whether the estimate is made triangle by triangle, in each step."""
    viscosity: float = 1.19e-6
    """Kinematic viscosity [m^2/s], for panels: of sea water at 15 degrees Celsius (ITTC 7.5-02-01-03)."""

    def __post_init__(self) -> None:
        for name in ("viscous", "radiation", "panels"):
            if not isinstance(getattr(self, name), bool):
                raise ModelError(
                    f"drag {name} is {getattr(self, name)!r}; it must be true or false"
                )
        if self.panels and not self.viscous:
            raise ModelError(
                "drag has panels, but viscous is false, and panels are viscous drag; leave out one of them"
            )
        if self.panels and isinstance(self.viscosity, float) and self.viscosity == 0.0:
            raise ModelError(
                "drag viscosity is 0; panels need one, 1.19e-6 for sea water at 15 degrees Celsius"
            )
        for field in dataclasses.fields(self):
            if field.type in (bool, "bool"):
                continue
            value = getattr(self, field.name)
            if (
                isinstance(value, bool)
                or not isinstance(value, int | float)
                or not 0.0 <= value < math.inf
            ):
                raise ModelError(
                    f"drag {field.name} is {value!r}; it must be a finite number of at least 0"
                )


def resolve_damping(
    drag: Drag, model: mujoco.MjModel, hulls: Sequence[Hull], density: float
) -> DampingArrays:
    """The damping that `drag` estimates for the bodies of `hulls` in water of a density [kg/m^3]."""
    gravity = float(np.linalg.norm(model.opt.gravity))
    bodies = sorted({hull.body for hull in hulls})
    volumes = np.zeros(len(bodies))
    linear, quadratic = np.zeros((2, len(bodies), 6))
    coupled, matrices = np.zeros(len(bodies), np.int64), np.zeros((len(bodies), 72))
    radiation, panels = np.zeros((len(bodies), 4)), np.zeros((len(bodies), 5))
    own_linear, own_quadratic = (
        read_custom(model, f"{kind}_damping", bodies) for kind in ("linear", "quadratic")
    )
    made = read_custom(model, "radiation_damping", bodies) if drag.radiation else {}
    members = [np.flatnonzero(model.body_weldid == body) for body in bodies]
    for row, body in enumerate(bodies):
        mass = float(model.body_mass[members[row]].sum())
        if not mass > 0.0:
            raise ModelError(
                f"body '{body_name(model, body)}' displaces water and has a mass of {mass:g} kg; give it a mass, "
                "or leave its geoms out (--geoms)"
            )
        own = [hull for hull in hulls if hull.body == body]
        meshes = [hull.mesh_in_body for hull in own]
        whole = np.array([hull.displaced_volume for hull in own])
        volumes[row] = whole.sum()
        centre = whole @ [mesh.centroid for mesh in meshes] / volumes[row]
        if body in made:
            coefficients = _numbers(model, body, "radiation", made[body], (3,))
            radiation[row] = *coefficients, _shown(meshes, centre)[0][2].sum()
        if not drag.viscous:
            continue
        if body in own_linear or body in own_quadratic:
            given = [
                _numbers(model, body, kind, own.get(body, np.zeros(6)), (6, 36))
                for kind, own in (("linear", own_linear), ("quadratic", own_quadratic))
            ]
            if max(len(numbers) for numbers in given) == 6:
                linear[row], quadratic[row] = given
            else:
                coupled[row] = 1
                matrices[row] = np.concatenate(
                    [np.diag(n).ravel() if len(n) == 6 else n for n in given]
                )
            continue
        if drag.panels:
            length = float(np.ptp(np.vstack([mesh.vertices for mesh in meshes]), axis=0).max())
            panels[row] = (
                drag.coefficient * 2.0 / 3.0,
                drag.coefficient / 3.0,
                length,
                drag.viscosity,
                density,
            )
            continue
        quadratic[row], length = _quadratic(0.5 * density * drag.coefficient, meshes, centre)
        slow = drag.linear_froude * math.sqrt(gravity * length)
        linear[row] = quadratic[row] * np.repeat([slow, slow / (0.5 * length)], 3)
    starts = np.cumsum([0, *(len(group) for group in members)])
    return DampingArrays(
        np.array(bodies),
        volumes,
        linear,
        quadratic,
        coupled,
        matrices,
        radiation,
        panels if panels.any() else panels[:0],
        np.concatenate(members).astype(np.int64),
        starts,
    )


def _numbers(
    model: mujoco.MjModel, body: int, kind: str, given: NDArray[np.float64], sizes: tuple[int, ...]
) -> NDArray[np.float64]:
    """Damping that a model states: coefficients, or a matrix row by row."""
    name, entries = (
        body_name(model, body),
        {3: "heave, roll, pitch", 6: "surge, sway, heave, roll, pitch, yaw"},
    )
    if (
        len(given) not in sizes
        or not np.isfinite(given).all()
        or (len(given) < 36 and not (given >= 0.0).all())
    ):
        more = ", or all 36 of a matrix" if 36 in sizes else ""
        raise ModelError(
            f"the {kind} damping of body '{name}' is {given.tolist()}; it must be {sizes[0]} numbers of at least 0: "
            f"{entries[sizes[0]]}{more} (Fossen's X_u, X_uu have the other sign)"
        )
    if len(given) == 36:
        matrix = given.reshape(6, 6)
        least = float(np.linalg.eigvalsh(0.5 * (matrix + matrix.T))[0])
        if least < -1e-9 * float(np.abs(matrix).max()):
            raise ModelError(
                f"the {kind} damping of body '{name}' has a negative eigenvalue, {least:.4g}, and would push it on; check "
                "the signs (Fossen's derivatives are minus the damping)"
            )
    return given


def _quadratic(
    resistance: float, meshes: Sequence[TriMesh], centre: NDArray[np.float64]
) -> tuple[NDArray[np.float64], float]:
    """Quadratic damping (6,) of one body about a centre, and its longest side [m].

    `resistance` [kg/m^3] is force per area and velocity squared of a face across the flow.
    """
    areas, middles, longest = _shown(meshes, centre)
    # how squarely the faces meet the flow along each axis: 1 for a box, 1/2 for a sphere
    shown = np.abs(np.vstack([mesh.area_vectors for mesh in meshes]))
    cosines = shown / np.maximum(np.concatenate([mesh.areas for mesh in meshes]), 1e-300)[:, None]
    bluffness = (shown * cosines**2).sum(axis=0) / shown.sum(axis=0)
    damping = np.zeros(6)
    for axis in range(3):
        j, k = (axis + 1) % 3, (axis + 2) % 3
        strips = resistance * bluffness[axis] * areas[axis]
        damping[axis] = strips.sum()
        # turning about j moves the strips at distance |k| along this axis, and the other way round
        damping[3 + j] += (strips * np.abs(middles[None, :, k]) ** 3).sum()
        damping[3 + k] += (strips * np.abs(middles[:, None, j]) ** 3).sum()
    return damping, longest


def _shown(
    meshes: Sequence[TriMesh], centre: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
    """Silhouettes of meshes along each axis, as areas of cells (3, CELLS, CELLS) [m^2]; cells' middles; longest side."""
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    v = np.vstack([mesh.vertices for mesh in meshes]) - centre
    f = np.vstack([mesh.faces + start for mesh, start in zip(meshes, starts[:-1], strict=True)])
    low, high = v.min(axis=0), v.max(axis=0)
    step = (high - low) / CELLS
    areas = np.empty((3, CELLS, CELLS))
    for axis in range(3):
        j, k = (axis + 1) % 3, (axis + 2) % 3
        grid = np.zeros((CELLS, CELLS), np.bool_)
        silhouette(v[:, j], v[:, k], f, low[[j, k]], step[[j, k]], grid)
        areas[axis] = step[j] * step[k] * grid
    return areas, low + (np.arange(CELLS)[:, None] + 0.5) * step, float((high - low).max())
