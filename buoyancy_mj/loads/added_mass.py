"""Added mass of bodies: given by the model or the user, or estimated from the hulls."""

import math
from collections.abc import Mapping, Sequence

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import elliprd

from buoyancy_mj.errors import ModelError, choices, describe
from buoyancy_mj.hulls.custom import find_body, read_numerics
from buoyancy_mj.hulls.hull import Hull, combine_volumes, group_by_body
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.kernels.inertia import AddedMass
from buoyancy_mj.loads.foil_arrays import PlacedFoil
from buoyancy_mj.loads.full_inertia import QUANTITY
from buoyancy_mj.loads.matrices import move_to_origin, parse_matrix
from buoyancy_mj.loads.plates import estimate_plate
from buoyancy_mj.meshes.mesh import TriMesh

SOURCES = ("model", "estimate", "none")
"""Where added mass comes from: the model's numerics; an estimate for bodies without; nowhere."""


def check_source(source: object) -> None:
    """Refuse what is no source of added mass; which bodies there are is known with the model.

    Raises:
        ModelError: it is none of `SOURCES`, None or a mapping by the names of bodies, or it holds
            a matrix that is none.
    """
    if source is None or (isinstance(source, str) and source in SOURCES):
        return
    if not isinstance(source, Mapping):
        raise ModelError(
            f"added mass is {describe(source)}; {choices(source, SOURCES)}, or matrices by body"
        )
    for name, matrix in source.items():
        if not isinstance(name, str):
            raise ModelError(
                f"added mass is given for body {describe(name)}; a body's name is a text"
            )
        parse_matrix(matrix, f"the added mass of body '{name}'")


def resolve_added_mass(
    model: mujoco.MjModel,
    hulls: Sequence[Hull],
    density: float,
    source: str | Mapping[str, ArrayLike] | None = "model",
    foils: Sequence[PlacedFoil] = (),
    *,
    slamming: bool = False,
) -> AddedMass:
    """Find the added mass of the bodies that have hulls.

    Args:
        model: any model.
        hulls: its hulls.
        density: of the water [kg/m^3], for estimates.
        source: one of `SOURCES`, or matrices (6, 6) or diagonals (6,) by the name of the body.
        foils: its foils; the estimate adds the plate of each that is no part of a hull.
        slamming: whether the water keeps the momentum that an entry takes.

    Raises:
        ModelError: an unknown source or body; a matrix of another size, not finite, not symmetric
            or not positive; one that does not fit into what MuJoCo keeps of a body's inertia; or
            slamming where no body has added mass.
    """
    check_source(source)

    # by the user, by the model, or by an estimate
    by_body = group_by_body(hulls)
    matrices = _read_matrices(model, list(by_body), source)
    if source == "estimate":
        for body in by_body.keys() - matrices.keys():
            matrices[body] = estimate_added_mass(by_body[body], density)
            displacing = {geom for hull in by_body[body] for geom in hull.geoms}
            for foil in foils:
                if foil.body == body and foil.geom not in displacing:
                    matrices[body] = matrices[body] + estimate_plate(foil, density)

    # in the order of the model
    bodies = sorted(matrices)
    for body in bodies:
        _check_fit(model, body, matrices[body])
    if slamming and not bodies:
        raise ModelError(
            "slamming is true, and no body has added mass; give the model numerics "
            "'added_mass:BODY', or choose added_mass='estimate'"
        )
    volumes = [sum(hull.displaced_volume for hull in by_body[body]) for body in bodies]
    owners = np.array([hull.body for hull in hulls])
    own_hulls, hull_starts = _join([np.flatnonzero(owners == body) for body in bodies])
    members, member_starts = _join([np.flatnonzero(model.body_weldid == body) for body in bodies])
    return AddedMass(
        bodies=np.array(bodies, np.int64),
        volumes=np.array(volumes, float),
        matrices=np.array([matrices[body].ravel() for body in bodies]).reshape(-1, 36),
        hulls=own_hulls,
        hull_starts=hull_starts,
        members=members,
        member_starts=member_starts,
        slamming=int(slamming),
    )


def _join(groups: Sequence[NDArray[np.int64]]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Groups of indices one after the other, and where each begins, and the end of all."""
    starts = np.cumsum([0, *(len(group) for group in groups)])
    return np.concatenate([np.zeros(0, np.int64), *groups]).astype(np.int64), starts


def estimate_added_mass(hulls: Sequence[Hull], density: float) -> NDArray[np.float64]:
    """Added mass (6, 6) [kg, kg m, kg m^2] of a body about its origin, estimated from its hulls.

    It is that of an ellipsoid with the volume of the hulls and the principal axes and proportions
    of their second moments: an estimate for compact bodies. Frames, ducts and thin plates carry
    more water along than it knows.

    Args:
        hulls: all hulls of the body.
        density: of the water [kg/m^3].
    """
    # the second moments of a solid ellipsoid are a fifth of its squared radii
    volume, centre = combine_volumes(hulls)
    spread = sum(hull.fill * _second_moments(hull.mesh_in_body, centre) for hull in hulls) / volume
    squares, axes = np.linalg.eigh(spread)
    if np.linalg.det(axes) < 0.0:
        axes[:, 0] = -axes[:, 0]
    radii = np.sqrt(5.0 * squares)
    radii *= (volume / (4.0 / 3.0 * math.pi * radii.prod())) ** (1.0 / 3.0)

    # from the ellipsoid's axes to the body's, from its centre to the body's origin
    body_from_ellipsoid = np.zeros((6, 6))
    body_from_ellipsoid[:3, :3] = body_from_ellipsoid[3:, 3:] = axes
    diagonal = np.diag(ellipsoid_added_mass(radii, density))
    return move_to_origin(body_from_ellipsoid @ diagonal @ body_from_ellipsoid.T, centre)


def ellipsoid_added_mass(radii: ArrayLike, density: float) -> NDArray[np.float64]:
    """Added mass (6,) [kg, kg m^2] of an ellipsoid of radii (3,) [m] along and about its axes.

    Lamb, Hydrodynamics (1932), art. 114, 115; the integrals by Carlson's R_D.
    """
    a = np.asarray(radii, float)
    mass = density * 4.0 / 3.0 * math.pi * a.prod()
    squares = a * a
    alpha = np.empty(3)
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        alpha[i] = 2.0 / 3.0 * a.prod() * elliprd(squares[j], squares[k], squares[i])

    # along the axes, then about them
    added = np.zeros(6)
    added[:3] = mass * alpha / (2.0 - alpha)
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        difference = squares[j] - squares[k]
        total = squares[j] + squares[k]
        # a circle that turns carries nothing round
        if abs(difference) <= 1e-9 * total:
            continue
        twist = alpha[k] - alpha[j]
        added[3 + i] = 0.2 * mass * difference**2 * twist / (2.0 * difference - total * twist)
    return added


def _read_matrices(
    model: mujoco.MjModel, bodies: Sequence[int], source: str | Mapping[str, ArrayLike] | None
) -> dict[int, NDArray[np.float64]]:
    """The matrices (6, 6) that the user or the model gives, by the index of the body."""
    numbers: Mapping[int, ArrayLike]
    if isinstance(source, Mapping):
        numbers = {
            find_body(model, name, bodies, QUANTITY): value for name, value in source.items()
        }
    elif source in ("model", "estimate"):
        numbers = read_numerics(model, QUANTITY, bodies)
    else:
        numbers = {}
    return {
        body: parse_matrix(value, f"the added mass of body '{body_name(model, body)}'")
        for body, value in numbers.items()
    }


def _check_fit(model: mujoco.MjModel, body: int, matrix: NDArray[np.float64]) -> None:
    """Refuse added mass that does not fit into the diagonal that MuJoCo keeps of some bodies."""
    first = int(model.body_dofadr[body])
    count = int(model.body_dofnum[body])
    if count < 2 or (model.M_rownnz[first : first + count] > 1).any():
        return

    # what meets the joints: a body that slides keeps its axes, and one on a ball its origin
    types = model.jnt_type[model.dof_jntid[first : first + count]]
    slides = types == mujoco.mjtJoint.mjJNT_SLIDE
    if slides.all():
        block, alike = matrix[:3, :3], True
    elif (types == mujoco.mjtJoint.mjJNT_BALL).all():
        block, alike = matrix[3:, 3:], True
    else:
        block, alike = matrix, np.ptp(np.diag(matrix)[:3]) <= 1e-9 * matrix[0, 0]
    beside = np.abs(block - np.diag(np.diag(block))).max()
    if not alike or beside > 1e-9 * np.abs(matrix).max():
        raise ModelError(
            f"MuJoCo keeps the inertia of body '{body_name(model, body)}' as a diagonal, since its "
            "centre of mass is its origin, and its added mass does not fit there; "
            "write <body simple='false'>, or put the water into its MjSpec (add_water)"
        )


def _second_moments(mesh: TriMesh, centre: NDArray[np.float64]) -> NDArray[np.float64]:
    """Integrals of x x, x y, ... over the volume of a mesh, about a point (3, 3) [m^5].

    A sum over tetrahedra with one corner at the point.
    """
    corners = np.stack(mesh.corners, axis=1) - centre
    volumes = np.linalg.det(corners) / 6.0
    sums = corners.sum(axis=1)
    moments: NDArray[np.float64] = (
        np.einsum("n,nij,nik->jk", volumes, corners, corners)
        + np.einsum("n,nj,nk->jk", volumes, sums, sums)
    ) / 20.0
    return moments
