"""Damping resolved for the bodies of a model: what the model states, or an estimate from what a hull shows to the flow."""

import math
from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import ModelError
from buoyancy_mj.hulls.custom import read_numerics
from buoyancy_mj.hulls.hull import Hull
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.kernels.damping import DampingArrays
from buoyancy_mj.kernels.rays import silhouette
from buoyancy_mj.loads.damping import Damping, Panels
from buoyancy_mj.meshes.mesh import TriMesh

CELLS = 200
"""Cells along each side of the grid on which a silhouette is measured."""


def resolve_damping(
    damping: Damping, model: mujoco.MjModel, hulls: Sequence[Hull], density: float
) -> DampingArrays:
    """The damping that `damping` chooses for the bodies of `hulls` in water of a density [kg/m^3]."""
    gravity = float(np.linalg.norm(model.opt.gravity))
    bodies = sorted({hull.body for hull in hulls})
    volumes = np.zeros(len(bodies))
    linear, quadratic = np.zeros((2, len(bodies), 6))
    coupled, matrices = np.zeros(len(bodies), np.int64), np.zeros((len(bodies), 72))
    radiation, panels = np.zeros((len(bodies), 4)), np.zeros((len(bodies), 5))
    own_linear, own_quadratic = (
        read_numerics(model, f"{kind}_damping", bodies) for kind in ("linear", "quadratic")
    )
    made = read_numerics(model, "radiation_damping", bodies) if damping.radiation else {}
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
        if damping.viscous is None:
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
        viscous = damping.viscous
        if isinstance(viscous, Panels):
            length = float(np.ptp(np.vstack([mesh.vertices for mesh in meshes]), axis=0).max())
            panels[row] = (
                viscous.coefficient * 2.0 / 3.0,
                viscous.coefficient / 3.0,
                length,
                viscous.viscosity,
                density,
            )
            continue
        quadratic[row], length = _quadratic(0.5 * density * viscous.coefficient, meshes, centre)
        slow = viscous.linear_froude * math.sqrt(gravity * length)
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
