"""How fine a mesh must be for the waves that cut it, and which waves are too short for it."""

import math
import warnings
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import BuoyancyWarning, WaterError
from buoyancy_mj.kernels import swell, tiles
from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.sea.water import Water
from buoyancy_mj.submersion.sea_tiles import lay_tiles

MOST_TRIANGLES = 200_000
"""Most triangles to which a mesh is refined for the waves."""
MOST_TURNS = swell.PANEL * swell.PANELS
"""Greatest change of a wave's phase from the middle of a hull to its corner [rad].

Shorter waves are not resolved, see `kernels.swell.PANELS`."""
MOST_PANELS = 100_000
"""Most short waves times panels, see `kernels.swell.PANELS`: passes would take many seconds."""


def check_waves(radius: float, waves: NDArray[np.float64]) -> None:
    """Refuse waves (w, 7) that no pass over a hull of a radius [m] resolves within its time.

    Raises:
        WaterError: the shortest wave is shorter than 2 pi / `MOST_TURNS` of the radius, or short
            waves are more than `MOST_PANELS` allows.
    """
    amplitudes, kx, ky = np.abs(waves[:, :3].T)
    steepest = float(np.hypot(kx, ky)[amplitudes > 0.0].max(initial=0.0))
    if steepest * radius > MOST_TURNS:
        raise WaterError(
            f"the water has waves {2.0 * math.pi / steepest:.3g} m long, too short for a hull "
            f"{2.0 * radius:.3g} m from corner to corner, over which waves must be at least "
            f"{2.0 * math.pi * radius / MOST_TURNS:.3g} m long; leave out shorter ones (a sea of "
            "fewer components has longer ones)"
        )

    # waves that are too short for tiles are summed one by one
    panels = math.ceil(steepest * radius / swell.PANEL)
    if panels * len(waves) <= MOST_PANELS:
        return
    short = len(waves) - int(lay_tiles(waves, [radius]).layout[tiles.HELD])
    if short * panels > MOST_PANELS:
        raise WaterError(
            f"the water has {short} waves that are short for a hull {2.0 * radius:.3g} m from "
            f"corner to corner; beside waves {2.0 * math.pi / steepest:.3g} m long it may have "
            f"{MOST_PANELS // panels} at most: give the sea fewer components"
        )


def find_longest_edges(
    meshes: Sequence[TriMesh], bodies: NDArray[np.int64], water: Water, tolerance: float
) -> list[float]:
    """Find the longest edge [m] of each mesh that follows the waves, see `_longest_edge`.

    It goes by the volume and the area of all meshes of the same body.
    """
    volumes = np.array([mesh.volume for mesh in meshes])
    areas = np.array([mesh.area for mesh in meshes])
    edges, worst = [], tolerance
    for body in bodies:
        volume, area = volumes[bodies == body].sum(), areas[bodies == body].sum()
        edge = _longest_edge(volume, area, water, tolerance)
        edges.append(edge)
        if math.isfinite(edge):
            worst = max(worst, edge**2 * area * water.curvature / (24.0 * volume))

    # where the triangles would be too many
    if worst > 1.001 * tolerance:
        warnings.warn(
            f"the waves are so steep and short that {MOST_TRIANGLES:,} triangles keep the volume "
            f"of a hull to {worst:.2g} of it at worst, not to the tolerance {tolerance:g}; make "
            "the waves longer or lower",
            BuoyancyWarning,
            stacklevel=5,
        )
    return edges


def _longest_edge(volume: float, area: float, water: Water, tolerance: float) -> float:
    """Longest edge [m] of triangles that follow the waves well enough.

    A chord of length e under a curve of curvature c is off by c e^2 / 12 on average. That matters
    only where the surface cuts triangles. No more than half the hull's area faces up or down
    (Cauchy's mean projected area). If all of that lay in the water's surface, the volume would be
    off by less than c e^2 / 12 times half the area, which must stay below the tolerance times the
    volume. No hull is refined beyond about `MOST_TRIANGLES`.

    Args:
        volume: volume of the body's hulls [m^3].
        area: surface area of the body's hulls [m^2].
        water: the sea.
        tolerance: see `Exact.tolerance`.
    """
    if water.curvature == 0.0:
        return math.inf
    fine = np.sqrt(24.0 * tolerance * volume / (area * water.curvature))
    return float(max(fine, np.sqrt(4.0 * area / MOST_TRIANGLES)))
