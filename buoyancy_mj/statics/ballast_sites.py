"""Where ballast or foam may be added to a vessel, and what a kilogram does there."""

import dataclasses
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import BallastError, ModelError, describe
from buoyancy_mj.meshes.surface import winding_number
from buoyancy_mj.statics.floating_pose import FloatingPose
from buoyancy_mj.statics.vessel import Vessel

FARTHEST = 1e6
"""Greatest distance of ballast from the origin of its body [m]."""


@dataclasses.dataclass(frozen=True, eq=False)
class BallastSite:
    """A point of a vessel where ballast or foam may be added."""

    kind: str
    """'ballast' or 'foam'."""
    name: str
    """Name of the site, or 'box' for a corner of one."""
    point: NDArray[np.float64]
    """Position in the vessel's axes (3,) [m]."""
    density: float
    """Density of what is added [kg/m^3]."""
    displaces: bool
    """Whether it displaces water of its own there, outside of the hulls."""
    lift: float
    """Mass of water displaced for each kilogram added, with the vessel in its target pose."""


def find_ballast_sites(
    pose: FloatingPose, kind: str, where: str | Sequence[str] | ArrayLike, density: float
) -> list[BallastSite]:
    """Find the sites of a vessel that match globs, or the corners of a box.

    Args:
        pose: the vessel in its target pose.
        kind: 'ballast' or 'foam'.
        where: globs of sites, or the lowest and highest corner of a box (2, 3) [m] in the frame of
            the root body.
        density: of what is added [kg/m^3].

    Raises:
        BallastError: foam would lie inside a hull, where it displaces nothing more.
        ModelError: a glob matches no site, or a box is none.
    """
    vessel = pose.vessel
    words = [where] if isinstance(where, str) else where
    if isinstance(words, Sequence) and all(isinstance(word, str) for word in words):
        names = vessel.match_sites([str(word) for word in words], optional=[f"{kind}*"])
        return [
            _describe_site(pose, kind, name, vessel.sites[name], vessel.sites[name], density)
            for name in names
        ]

    # the corners of a box displace as its middle does
    try:
        box = np.asarray(where, float)
    except (TypeError, ValueError):
        box = np.zeros(0)
    is_box = box.shape == (2, 3) and (np.abs(box) <= FARTHEST).all()
    if not is_box or (box[0] > box[1]).any():
        given = box.tolist() if box.ndim == 2 else describe(where)
        raise ModelError(
            f"a box for {kind} is {given}; "
            f"it must be its lowest and highest corner (2, 3) [m], within {FARTHEST:g} m"
        )
    middle = box.mean(axis=0) - vessel.centre_of_gravity
    corners = np.array(np.meshgrid(*box.T)).reshape(3, -1).T - vessel.centre_of_gravity
    return [_describe_site(pose, kind, "box", corner, middle, density) for corner in corners]


def _describe_site(
    pose: FloatingPose,
    kind: str,
    name: str,
    point: NDArray[np.float64],
    middle: NDArray[np.float64],
    density: float,
) -> BallastSite:
    """A site at a point (3,) [m], which is inside a hull where `middle` (3,) [m] is."""
    vessel = pose.vessel
    fill, hull = max(_find_hulls_around(vessel, middle), default=(0.0, ""))
    if kind == "foam" and fill == 1.0:
        raise BallastError(
            f"foam at '{name}' lies inside hull '{hull}', where it displaces nothing more; "
            "put it outside"
        )
    wet = pose.position[2] + pose.rotation[2] @ point < vessel.water.level
    lift = (1.0 - fill) * float(wet) * vessel.water.density / density
    return BallastSite(kind, name, point, density, fill < 1.0, lift)


def _find_hulls_around(vessel: Vessel, point: NDArray[np.float64]) -> list[tuple[float, str]]:
    """Fill and name of each hull that encloses a point (3,) [m] in the vessel's axes."""
    return [
        (hull.fill, hull.name)
        for hull, mesh in zip(vessel.hulls, vessel.meshes, strict=True)
        if (np.abs(point - mesh.bounds.mean(axis=0)) <= 0.5 * mesh.extents).all()
        and winding_number(mesh.vertices, mesh.faces, point) > 0.5
    ]
