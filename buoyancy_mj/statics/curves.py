"""The lines of a vessel: how it fills out with its draft, and its waterlines."""

import dataclasses

import numpy as np
import trimesh
from numpy.typing import NDArray

from buoyancy_mj.statics.floating_pose import pose_vessel
from buoyancy_mj.statics.vessel import Vessel


@dataclasses.dataclass(frozen=True, eq=False)
class HydrostaticCurves:
    """How a vessel fills out with its draft, at one attitude."""

    draft: NDArray[np.float64]
    """Depths of the lowest point (n,) [m]."""
    volume: NDArray[np.float64]
    """Submerged volumes (n,) [m^3]."""
    waterplane_area: NDArray[np.float64]
    """Areas cut out of the surface (n,) [m^2]."""


def compute_hydrostatic_curves(
    vessel: Vessel, rotation: NDArray[np.float64], count: int = 101
) -> HydrostaticCurves:
    """Volume and waterplane area from touching the water to being under it.

    Args:
        vessel: any.
        rotation: its attitude, world_from_vessel (3, 3).
        count: number of drafts.
    """
    heights = vessel.points @ rotation[2]
    low, high = float(heights.min()), float(heights.max())
    # just off the ends, where flat faces lie in the surface
    drafts = (high - low) * np.linspace(1e-6, 1.0 - 1e-6, count)
    poses = [
        pose_vessel(vessel, [0.0, 0.0, vessel.water.level - draft - low], rotation)
        for draft in drafts
    ]
    return HydrostaticCurves(
        drafts, np.array([p.volume for p in poses]), np.array([p.waterplane.area for p in poses])
    )


def compute_waterline(
    vessel: Vessel, rotation: NDArray[np.float64], draft: float
) -> NDArray[np.float64]:
    """Segments (n, 2, 2) [m] of the waterline at a draft, seen from above, from the centre of gravity."""
    height = float((vessel.points @ rotation[2]).min()) + draft
    cuts = [
        trimesh.intersections.mesh_plane(
            trimesh.Trimesh(mesh.vertices @ rotation.T, mesh.faces, process=False),
            [0.0, 0.0, 1.0],
            [0.0, 0.0, height],
        )
        for mesh in vessel.meshes
    ]
    return np.concatenate([np.asarray(cut, float).reshape(-1, 2, 3) for cut in cuts])[:, :, :2]
