"""Added mass of the bodies of a model: what the vehicle says, what the user gives, or an estimate from its hulls."""

import math
from collections.abc import Mapping, Sequence

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import elliprd

from buoyancy_mj.errors import ModelError, choices
from buoyancy_mj.hulls.custom import find_body, read_numerics
from buoyancy_mj.hulls.hull import Hull
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.kernels.inertia import AddedMass
from buoyancy_mj.meshes.mesh import TriMesh

QUANTITY = "added_mass"
"""What MJCF `<custom><numeric>` that state it start with; then a colon, and the name of the body."""
SOURCES = ("model", "estimate", "none")
"""Where it may come from: what the model states; an estimate for what it does not state; nowhere."""


def resolve_added_mass(
    model: mujoco.MjModel,
    hulls: Sequence[Hull],
    density: float,
    source: str | Mapping[str, ArrayLike] | None = "model",
) -> AddedMass:
    """The added mass of the bodies that have hulls.

    Args:
        model: any model.
        hulls: its hulls.
        density: of the water [kg/m^3], for estimates.
        source: one of `SOURCES`, or matrices (6, 6) or diagonals (6,) by the name of the body.

    Raises:
        ModelError: an unknown source or body, a matrix of another size, not finite, not symmetric or not
            positive, or one that does not fit into what MuJoCo keeps of a body's inertia.
    """
    bodies = sorted({hull.body for hull in hulls})
    given: dict[int, NDArray[np.float64]] = {}
    if isinstance(source, Mapping):
        given = {
            find_body(model, name, bodies, QUANTITY): _matrix(name, value)
            for name, value in source.items()
        }
    elif source not in (None, *SOURCES):
        raise ModelError(
            f"added mass is '{source}'; {choices(source, SOURCES)}, or matrices by body"
        )
    elif source in ("model", "estimate"):
        numbers = read_numerics(model, QUANTITY, bodies)
        given = {body: _matrix(body_name(model, body), value) for body, value in numbers.items()}
    if source == "estimate":
        estimates = {
            body: estimate_added_mass([h for h in hulls if h.body == body], density)
            for body in bodies
            if body not in given
        }
        given |= estimates
    for body, matrix in given.items():
        _check_fit(model, body, matrix)
    chosen = sorted(given)
    volumes = [sum(hull.displaced_volume for hull in hulls if hull.body == body) for body in chosen]
    return AddedMass(
        np.array(chosen, np.int64),
        np.array(volumes, float),
        np.array([given[body].ravel() for body in chosen]).reshape(-1, 36),
    )


def estimate_added_mass(hulls: Sequence[Hull], density: float) -> NDArray[np.float64]:
    """Added mass (6, 6) of a body about its origin: that of the ellipsoid with the second moments of its hulls' volume.

    An estimate for compact bodies; frames, ducts and thin plates carry more water along than it knows.
    """
    shares = np.array([hull.displaced_volume for hull in hulls])
    volume = shares.sum()
    centre = shares @ [hull.mesh_in_body.centroid for hull in hulls] / volume
    spread = sum(hull.fill * _second_moments(hull.mesh_in_body, centre) for hull in hulls) / volume
    squares, axes = np.linalg.eigh(spread)
    if np.linalg.det(axes) < 0.0:
        axes[:, 0] = -axes[:, 0]
    radii = np.sqrt(5.0 * squares)
    radii *= (volume / (4.0 / 3.0 * math.pi * radii.prod())) ** (1.0 / 3.0)
    whole = np.zeros((6, 6))
    turn = np.zeros((6, 6))
    turn[:3, :3] = turn[3:, 3:] = axes
    whole[:, :] = turn @ np.diag(ellipsoid_added_mass(radii, density)) @ turn.T
    # from the middle to the origin: the velocity there is v + w x centre
    shift = np.eye(6)
    shift[:3, 3:] = _cross(centre).T
    return shift.T @ whole @ shift


def ellipsoid_added_mass(radii: ArrayLike, density: float) -> NDArray[np.float64]:
    """Added mass (6,) [kg, kg m^2] of an ellipsoid of radii (3,) [m] along and about its axes.

    Lamb, Hydrodynamics (1932), art. 114, 115; the integrals by Carlson's R_D.
    """
    a = np.asarray(radii, float)
    mass = density * 4.0 / 3.0 * math.pi * a.prod()
    squares = a * a
    alpha = np.array(
        [
            2.0 / 3.0 * a.prod() * elliprd(squares[(i + 1) % 3], squares[(i + 2) % 3], squares[i])
            for i in range(3)
        ]
    )
    result = np.empty(6)
    result[:3] = mass * alpha / (2.0 - alpha)
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        difference, total = squares[j] - squares[k], squares[j] + squares[k]
        # of a circle nothing is carried round
        if abs(difference) <= 1e-9 * total:
            result[3 + i] = 0.0
            continue
        twist = alpha[k] - alpha[j]
        result[3 + i] = 0.2 * mass * difference**2 * twist / (2.0 * difference - total * twist)
    return result


def _matrix(name: str, value: ArrayLike) -> NDArray[np.float64]:
    """A matrix (6, 6), from one or its diagonal."""
    try:
        given = np.asarray(value, float)
    except (TypeError, ValueError) as error:
        raise ModelError(
            f"the added mass of body '{name}' is {value!r}; it must be 6 numbers or a 6 x 6 matrix"
        ) from error
    if not np.isfinite(given).all():
        raise ModelError(
            f"the added mass of body '{name}' holds {given[~np.isfinite(given)][0]}; its numbers must be finite"
        )
    if given.size not in (6, 36):
        raise ModelError(
            f"the added mass of body '{name}' has {given.size} numbers; it must be 6, its diagonal, or all 36"
        )
    matrix = np.diag(given.ravel()) if given.size == 6 else given.reshape(6, 6)
    scale = np.sqrt(np.abs(np.outer(np.diag(matrix), np.diag(matrix)))) + 1e-12
    if (np.abs(matrix - matrix.T) > 1e-6 * scale).any():
        raise ModelError(
            f"the added mass of body '{name}' is not symmetric; average it with its transpose"
        )
    least = float(np.linalg.eigvalsh(0.5 * (matrix + matrix.T))[0])
    if least < -1e-9 * float(np.abs(matrix).max()):
        raise ModelError(
            f"the added mass of body '{name}' has a negative eigenvalue, {least:.4g}; the water would push it on: check the "
            "signs (Fossen's derivatives X_udot are minus the added mass)"
        )
    return 0.5 * (matrix + matrix.T)


def _check_fit(model: mujoco.MjModel, body: int, matrix: NDArray[np.float64]) -> None:
    """Refuse what has no place where MuJoCo keeps a free body's inertia as a diagonal."""
    first, count = int(model.body_dofadr[body]), int(model.body_dofnum[body])
    if count != 6 or (model.M_rownnz[first : first + 6] > 1).any():
        return
    alike = np.ptp(np.diag(matrix)[:3]) <= 1e-9 * matrix[0, 0]
    if not alike or np.abs(matrix - np.diag(np.diag(matrix))).max() > 1e-9 * np.abs(matrix).max():
        name = body_name(model, body)
        raise ModelError(
            f"MuJoCo keeps the inertia of body '{name}' as a diagonal, since its centre of mass is its origin, and its "
            "added mass does not fit there; move one of them by a hair, as in <inertial pos='0 0 -1e-5' .../>"
        )


def _second_moments(mesh: TriMesh, centre: NDArray[np.float64]) -> NDArray[np.float64]:
    """Integrals of x x, x y, ... over the volume of a mesh, about a point (3, 3) [m^5]: a sum over tetrahedra."""
    corners = np.stack(mesh.corners, axis=1) - centre
    volumes = np.linalg.det(corners) / 6.0
    sums = corners.sum(axis=1)
    squares = np.einsum("n,nij,nik->jk", volumes, corners, corners) + np.einsum(
        "n,nj,nk->jk", volumes, sums, sums
    )
    return squares / 20.0


def _cross(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """The matrix of x times (3, 3)."""
    return np.array([[0.0, -x[2], x[1]], [x[2], 0.0, -x[0]], [-x[1], x[0], 0.0]])
