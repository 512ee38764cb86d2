"""`find_lows`: attitudes from which every rest pose of a vessel lies downhill."""

import warnings
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import BuoyancyWarning
from buoyancy_mj.meshes.components import label_components
from buoyancy_mj.statics.balance import find_heave_balance
from buoyancy_mj.statics.distinct_poses import FREE
from buoyancy_mj.statics.floating_pose import FloatingPose
from buoyancy_mj.statics.vessel import Vessel

_EVERYWHERE = 3
"""How often the icosahedron of attitudes is subdivided: 642 attitudes, 9 degrees apart."""
_NEAR_BALANCE = 6
"""How often it is where the torque may vanish: 1 degree apart."""
_DRAFT_TOLERANCE = 1e-4
"""Part of the displaced volume by which a draft may be off; the energy is off by its square."""
MOST_LOWS = 200
"""Most lows that are followed. A cylinder has some 130 round its side, a ball that barely dips in
one for each facet."""


def find_lows(vessel: Vessel) -> list[FloatingPose]:
    """Find the attitudes where a vessel's energy is lower than all round, lowest first.

    At the draft that carries its weight the energy depends on the direction of the vertical, seen
    from the vessel, alone. So a grid over the sphere of directions sees all attitudes. Of lows on
    one plain, as all over a ball, the lowest counts.

    Of more than `MOST_LOWS` the lowest count, with a `BuoyancyWarning`.

    Raises:
        EquilibriumError: the vessel sinks.
    """
    poses, edges = _survey_attitudes(vessel)
    energies = np.array([pose.energy for pose in poses]) / (vessel.weight * vessel.radius)

    # none of the neighbours is lower
    around = np.full(len(poses), np.inf)
    for one, other in (edges.T, edges.T[::-1]):
        np.minimum.at(around, one, energies[other])
    lows = np.flatnonzero(energies <= around)

    # the lowest of each plain
    ups = np.array([pose.rotation[2] for pose in poses])
    lengths = np.linalg.norm(ups[edges[:, 0]] - ups[edges[:, 1]], axis=1)
    rises = np.abs(energies[edges[:, 0]] - energies[edges[:, 1]])
    one, other = edges[rises <= 0.5 * FREE * lengths**2].T
    plains = label_components(np.column_stack([one, other]), len(poses))
    lows = lows[np.argsort(energies[lows], kind="stable")]
    _, first = np.unique(plains[lows], return_index=True)
    lows = lows[np.sort(first)]
    if len(lows) > MOST_LOWS:
        warnings.warn(
            f"'{vessel.name}' may rest in {len(lows)} poses, as a body of facets that barely dips "
            f"in; only the lowest {MOST_LOWS} were looked at",
            BuoyancyWarning,
            stacklevel=3,
        )
    return [poses[low] for low in lows[:MOST_LOWS]]


def _survey_attitudes(vessel: Vessel) -> tuple[list[FloatingPose], NDArray[np.int64]]:
    """A vessel at its draft in attitudes all round (n), and which of them are neighbours (m, 2)."""
    import trimesh

    ball = trimesh.creation.icosahedron()
    ups, faces = np.asarray(ball.vertices), np.asarray(ball.faces)
    heights = np.full(len(ups), vessel.position[2])
    displaced = vessel.mass / vessel.water.density / vessel.volume
    tolerance = max(_DRAFT_TOLERANCE * displaced, 1e-14)
    poses: list[FloatingPose] = []
    for level in range(_NEAR_BALANCE + 1):
        # each draft begins at that between its neighbours
        if level:
            chosen = None if level <= _EVERYWHERE else _find_near_balance(poses, faces)
            between = np.column_stack([ups, heights])
            between, faces = trimesh.remesh.subdivide(between, faces, chosen)
            ups, heights = between[:, :3], between[:, 3]
            ups = ups / np.linalg.norm(ups, axis=1)[:, None]

        new = slice(len(poses), None)
        for rotation, height in zip(_turn_upright(ups[new]), heights[new], strict=True):
            poses.append(find_heave_balance(vessel, rotation, height, tolerance))
        heights = np.array([pose.position[2] for pose in poses])
    edges = np.sort(trimesh.geometry.faces_to_edges(faces), axis=1)
    return poses, np.unique(edges, axis=0)


def _find_near_balance(
    poses: Sequence[FloatingPose], faces: NDArray[np.int64]
) -> NDArray[np.int64]:
    """Find the triangles of attitudes over which the torque changes by as much as it measures.

    Where it is as small as that of a turn that nothing resists, there is nothing to find.
    """
    scale = poses[0].vessel.weight * poses[0].vessel.radius
    corners = np.array([pose.rotation[2] for pose in poses])[faces]
    lengths = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)

    # in the axes of the vessel
    torques = np.array([[*pose.torque, 0.0] @ pose.rotation for pose in poses])[faces]
    changes = np.linalg.norm(torques - np.roll(torques, 1, axis=1), axis=2).max(axis=1)
    sizes = np.linalg.norm(torques, axis=2)
    resists = sizes.max(axis=1) > FREE * scale * lengths
    return np.flatnonzero(resists & (changes >= sizes.min(axis=1)))


def _turn_upright(ups: NDArray[np.float64]) -> NDArray[np.float64]:
    """Attitudes world_from_vessel (n, 3, 3) that turn directions of a vessel (n, 3) upright."""
    x = np.cross(ups, np.eye(3)[np.abs(ups).argmin(axis=1)])
    x /= np.linalg.norm(x, axis=1)[:, None]
    return np.stack([x, np.cross(ups, x), ups], axis=1)
