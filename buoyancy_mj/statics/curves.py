"""Hydrostatic curves of a vessel over its draft, and its waterlines."""

import dataclasses

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.statics.floating_pose import pose_vessel
from buoyancy_mj.statics.vessel import Vessel


@dataclasses.dataclass(frozen=True, eq=False)
class HydrostaticCurves:
    """Volume and waterplane of a vessel over its draft, at one attitude."""

    draft: NDArray[np.float64]
    """Depths of the lowest point of the hulls (n,) [m], ascending."""
    volume: NDArray[np.float64]
    """Submerged volumes (n,) [m^3]."""
    waterplane_area: NDArray[np.float64]
    """Areas cut out of the surface (n,) [m^2]."""


def compute_hydrostatic_curves(
    vessel: Vessel, rotation: NDArray[np.float64], count: int = 101
) -> HydrostaticCurves:
    """Compute volume and waterplane area from touching the water to being under it.

    Args:
        vessel: the vessel.
        rotation: its attitude, world_from_vessel (3, 3).
        count: number of drafts.
    """
    low, high = vessel.heights(rotation)

    # just off the ends, where flat faces lie in the surface
    drafts = (high - low) * np.linspace(1e-6, 1.0 - 1e-6, count)
    heights = vessel.water.level - drafts - low
    poses = [pose_vessel(vessel, [0.0, 0.0, height], rotation) for height in heights]
    return HydrostaticCurves(
        draft=drafts,
        volume=np.array([pose.volume for pose in poses]),
        waterplane_area=np.array([pose.waterplane.area for pose in poses]),
    )


def compute_waterline(
    vessel: Vessel, rotation: NDArray[np.float64], draft: float
) -> NDArray[np.float64]:
    """Cut the hulls of a vessel at a draft.

    Args:
        vessel: the vessel.
        rotation: its attitude, world_from_vessel (3, 3).
        draft: depth of the lowest point of its hulls [m].

    Returns:
        Segments of the waterline (n, 2, 2) [m], seen from above, from the centre of gravity.
    """
    import trimesh

    low, _ = vessel.heights(rotation)
    cuts = [
        trimesh.intersections.mesh_plane(
            trimesh.Trimesh(mesh.vertices @ rotation.T, mesh.faces, process=False),
            plane_normal=[0.0, 0.0, 1.0],
            plane_origin=[0.0, 0.0, low + draft],
        )
        for mesh in vessel.meshes
    ]
    segments = np.concatenate([np.asarray(cut, float).reshape(-1, 2, 3) for cut in cuts])
    return segments[:, :, :2]
