"""`Drag`: damping good enough to settle, estimated from what a hull shows to the flow."""

import dataclasses
import math
from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.choice import body_name
from buoyancy_mj.errors import ModelError
from buoyancy_mj.hull import Hull
from buoyancy_mj.kernels.rays import silhouette
from buoyancy_mj.mesh import TriMesh
from buoyancy_mj.stated import stated

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

    It is an estimate: no added mass, no lift, no waves radiated, no skin friction. A body whose own
    damping the model states, as numerics 'linear_damping:BODY' and 'quadratic_damping:BODY' of six
    numbers each in `<custom>`, has that instead: force and torque per velocity and per velocity
    squared along the body's axes, at the centroid of what is wet of it; Fossen's diagonals.

    Raises:
        ModelError: a negative or infinite value.
    """

    coefficient: float = 1.05
    """Drag coefficient of a flat face across the flow."""
    linear_froude: float = 0.05
    """Froude number at which linear and quadratic damping are equal; 0 for no linear damping."""

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 <= value < math.inf:
                raise ModelError(f"drag {field.name} is {value!r}; it must be a finite number of at least 0")


@dataclasses.dataclass(frozen=True)
class Damping:
    """Damping of all bodies that have hulls, along the axes of each body: three forces, three torques."""

    bodies: NDArray[np.int64]
    """Their indices in the model (n,)."""
    volumes: NDArray[np.float64]
    """Volume of each body's hulls (n,) [m^3]."""
    linear: NDArray[np.float64]
    """Force [N s/m] and torque [N m s] per velocity (n, 6), when fully wet."""
    quadratic: NDArray[np.float64]
    """Force [N s^2/m^2] and torque [N m s^2] per velocity squared (n, 6), when fully wet."""
    members: NDArray[np.int64]
    """Indices of those bodies and of what is welded to each, one body after the other (m,)."""
    member_starts: NDArray[np.int64]
    """Where those of each begin (n + 1,)."""


def estimated(drag: Drag, model: mujoco.MjModel, hulls: Sequence[Hull], density: float) -> Damping:
    """The damping that `drag` estimates for the bodies of `hulls` in water of a density [kg/m^3]."""
    gravity = float(np.linalg.norm(model.opt.gravity))
    bodies = sorted({hull.body for hull in hulls})
    volumes = np.zeros(len(bodies))
    linear, quadratic = np.zeros((2, len(bodies), 6))
    own_linear, own_quadratic = (stated(model, f"{kind}_damping", bodies) for kind in ("linear", "quadratic"))
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
        whole = np.array([hull.displacement for hull in own])
        volumes[row] = whole.sum()
        centre = whole @ [mesh.centroid for mesh in meshes] / volumes[row]
        if body in own_linear or body in own_quadratic:
            linear[row] = _diagonal(model, body, "linear", own_linear.get(body))
            quadratic[row] = _diagonal(model, body, "quadratic", own_quadratic.get(body))
            continue
        quadratic[row], length = _quadratic(0.5 * density * drag.coefficient, meshes, centre)
        slow = drag.linear_froude * math.sqrt(gravity * length)
        linear[row] = quadratic[row] * np.repeat([slow, slow / (0.5 * length)], 3)
    starts = np.cumsum([0, *(len(group) for group in members)])
    return Damping(np.array(bodies), volumes, linear, quadratic, np.concatenate(members).astype(np.int64), starts)


def _diagonal(model: mujoco.MjModel, body: int, kind: str, given: NDArray[np.float64] | None) -> NDArray[np.float64]:
    """Damping that a model states (6,); what it does not is zero."""
    if given is None:
        return np.zeros(6)
    if len(given) != 6 or not (given >= 0.0).all() or not np.isfinite(given).all():
        raise ModelError(
            f"the {kind} damping of body '{body_name(model, body)}' is {given.tolist()}; it must be 6 numbers of at least "
            "0: surge, sway, heave, roll, pitch, yaw (Fossen's X_u, X_uu have the other sign)"
        )
    return given


def _quadratic(
    resistance: float, meshes: Sequence[TriMesh], centre: NDArray[np.float64]
) -> tuple[NDArray[np.float64], float]:
    """Quadratic damping (6,) of one body about a centre, and its longest side [m].

    `resistance` [kg/m^3] is force per area and velocity squared of a face across the flow.
    """
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    v = np.vstack([mesh.vertices for mesh in meshes]) - centre
    f = np.vstack([mesh.faces + start for mesh, start in zip(meshes, starts[:-1], strict=True)])
    low, high = v.min(axis=0), v.max(axis=0)
    step = (high - low) / CELLS
    middles = low + (np.arange(CELLS)[:, None] + 0.5) * step
    # how squarely the faces meet the flow along each axis: 1 for a box, 1/2 for a sphere
    shown = np.abs(np.vstack([mesh.area_vectors for mesh in meshes]))
    cosines = shown / np.maximum(np.concatenate([mesh.areas for mesh in meshes]), 1e-300)[:, None]
    bluffness = (shown * cosines**2).sum(axis=0) / shown.sum(axis=0)
    damping = np.zeros(6)
    for axis in range(3):
        j, k = (axis + 1) % 3, (axis + 2) % 3
        grid = np.zeros((CELLS, CELLS), np.bool_)
        silhouette(v[:, j], v[:, k], f, low[[j, k]], step[[j, k]], grid)
        per_cell = resistance * bluffness[axis] * step[j] * step[k]
        damping[axis] = per_cell * grid.sum()
        # turning about j moves the strips at distance |k| along this axis, and the other way round
        damping[3 + j] += per_cell * (grid * np.abs(middles[None, :, k]) ** 3).sum()
        damping[3 + k] += per_cell * (grid * np.abs(middles[:, None, j]) ** 3).sum()
    return damping, float((high - low).max())
