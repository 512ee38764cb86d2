"""Added mass of bodies: given by the model or the user, or estimated from the hulls."""

import dataclasses
import warnings
from collections.abc import Mapping, Sequence

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import BuoyancyWarning, ModelError, choices, describe
from buoyancy_mj.hulls.custom import find_body, read_numerics
from buoyancy_mj.hulls.hull import Hull, group_by_body
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.hulls.welds import group_welded_bodies
from buoyancy_mj.kernels.inertia import AddedMass
from buoyancy_mj.loads.added_mass_estimates import Estimate, estimate_added_mass
from buoyancy_mj.loads.foil_arrays import PlacedFoil
from buoyancy_mj.loads.full_inertia import ESTIMATES, QUANTITY
from buoyancy_mj.loads.groups import join, join_hulls
from buoyancy_mj.loads.matrices import parse_matrix
from buoyancy_mj.loads.plates import estimate_plate

SOURCES = ("model", *ESTIMATES, "none")
"""Where added mass comes from: the model's numerics; these and estimates; nowhere."""


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
            or not positive; an estimate by 'mesh' that is not to be trusted; added mass that does
            not fit into what MuJoCo keeps of a body's inertia; or slamming where no body has any.
    """
    found = find_estimates(model, hulls, density, source, foils)
    matrices = {body: estimate.matrix for body, estimate in found.items()}

    # in the order of the model
    bodies = sorted(matrices)
    for body in bodies:
        _check_fit(model, body, matrices[body])
    if slamming and not bodies:
        raise ModelError(
            "slamming is true, and no body has added mass; give the model numerics "
            "'added_mass:BODY', or choose added_mass='estimate'"
        )
    by_body = group_by_body(hulls)
    volumes = [sum(hull.displaced_volume for hull in by_body[body]) for body in bodies]
    own_hulls, hull_starts = join_hulls(hulls, bodies)
    members, member_starts = join([np.flatnonzero(model.body_weldid == body) for body in bodies])
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


def find_estimates(
    model: mujoco.MjModel,
    hulls: Sequence[Hull],
    density: float,
    source: str | Mapping[str, ArrayLike] | None,
    foils: Sequence[PlacedFoil] = (),
) -> dict[int, Estimate]:
    """Find the added mass of bodies, by their indices, and how it was found.

    Args:
        model: any model.
        hulls: its hulls.
        density: of the water [kg/m^3], for estimates.
        source: as `resolve_added_mass` takes it.
        foils: as `resolve_added_mass` takes them.

    Raises:
        ModelError: as `resolve_added_mass`, whatever MuJoCo keeps of a body's inertia.
    """
    check_source(source)
    by_body = group_by_body(hulls)
    found = {
        body: Estimate(matrix, "stated")
        for body, matrix in _read_matrices(model, list(by_body), source).items()
    }
    if isinstance(source, str) and source in ESTIMATES:
        for body in sorted(by_body.keys() - found.keys()):
            found[body] = estimate_added_mass(by_body[body], density, source)
            _judge(found[body], body_name(model, body), source)

            # the plates that are no part of a hull
            displacing = {geom for hull in by_body[body] for geom in hull.geoms}
            matrix = found[body].matrix
            for foil in foils:
                if foil.body == body and foil.geom not in displacing:
                    matrix = matrix + estimate_plate(foil, density)
            found[body] = dataclasses.replace(found[body], matrix=matrix)
        estimated = [body for body in sorted(found) if found[body].method != "stated"]
        _tell_of_welds(model, estimated)
    return found


def _tell_of_welds(model: mujoco.MjModel, estimated: Sequence[int]) -> None:
    """Tell of bodies that are estimated one by one and that welds hold together."""
    for group in group_welded_bodies(model, estimated):
        names = ", ".join(f"'{body_name(model, body)}'" for body in group.places)
        warnings.warn(
            f"the added mass of bodies {names} is estimated for each of them alone, and welds hold "
            "them together; make them one body, or state it by numerics 'added_mass:BODY'",
            BuoyancyWarning,
            stacklevel=2,
        )


def _judge(estimate: Estimate, body: str, source: str) -> None:
    """Tell of an estimate by potential flow that is not to be trusted, or refuse it.

    Raises:
        ModelError: nothing else was asked for.
    """
    if not estimate.doubt:
        return
    message = f"the added mass of body '{body}' is not known from its meshes: {estimate.doubt}"
    if source == "mesh":
        raise ModelError(f"{message}; added_mass='estimate' takes that of an ellipsoid instead")
    warnings.warn(
        f"{message}; that of an ellipsoid is taken instead", BuoyancyWarning, stacklevel=2
    )


def _read_matrices(
    model: mujoco.MjModel, bodies: Sequence[int], source: str | Mapping[str, ArrayLike] | None
) -> dict[int, NDArray[np.float64]]:
    """The matrices (6, 6) that the user or the model gives, by the index of the body."""
    numbers: Mapping[int, ArrayLike]
    if isinstance(source, Mapping):
        numbers = {
            find_body(model, name, bodies, QUANTITY): value for name, value in source.items()
        }
    elif source in ("model", *ESTIMATES):
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
