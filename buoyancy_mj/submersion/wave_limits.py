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
from buoyancy_mj.submersion.sea_tiles import lay_tiles, mean_wave_number

MOST_TRIANGLES = 200_000
"""Most triangles to which a mesh is refined for the waves, about."""
GENTLE = 1.0
"""Longest edge of a mesh in waves, times their wave number, see `sea_tiles.mean_wave_number`."""
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
) -> tuple[list[float], list[float]]:
    """Find the longest edge of each mesh, and how far off a straight edge in the surface may be.

    A chord of length e under a curve of curvature c is off by c e^2 / 12 on average. That matters
    only where the surface cuts triangles. No more than half the hull's area faces up or down
    (Cauchy's mean projected area). If all of that lay in the water's surface, the volume would be
    off by less than c e^2 / 12 times half the area, which must stay below the tolerance times the
    volume of all hulls of the body. Edges that are longer than this allows are halved where it
    matters, see `kernels.halving`; up to `GENTLE` over the wave number that is left to each pass.

    Args:
        meshes: of the hulls.
        bodies: the body of each (h,).
        water: the sea.
        tolerance: see `Exact.tolerance`.

    Returns:
        For each hull, both [m].
    """
    volumes = np.array([mesh.volume for mesh in meshes])
    areas = np.array([mesh.area for mesh in meshes])
    amplitudes, k = np.abs(water.rows[:, 0]), np.hypot(*water.rows[:, 1:3].T)
    waves = (amplitudes * k).any()
    gentle = GENTLE / mean_wave_number(amplitudes, k) if waves else math.inf
    edges, allowed, worst = [], [], tolerance
    for body in bodies:
        volume, area = volumes[bodies == body].sum(), areas[bodies == body].sum()
        off = 3.0 * tolerance * volume / area
        fine = math.sqrt(8.0 * off / water.curvature) if water.curvature else math.inf
        # no hull is refined beyond so many triangles, nor are these halved
        least = math.sqrt(4.0 * area / MOST_TRIANGLES)
        if least > max(fine, gentle):
            off = max(off, water.curvature * least**2 / 8.0)
            worst = max(worst, off * area / (3.0 * volume))
        edges.append(max(fine, gentle, least))
        allowed.append(off)
    if worst > 1.001 * tolerance:
        warnings.warn(
            f"the waves are so steep and short that {MOST_TRIANGLES:,} triangles keep the volume "
            f"of a hull to {worst:.2g} of it at worst, not to the tolerance {tolerance:g}; make "
            "the waves longer or lower",
            BuoyancyWarning,
            stacklevel=5,
        )
    return edges, allowed
