"""`describe_sea`: a sea in a few words, for a picture of it."""

import math

import numpy as np

from buoyancy_mj.sea.irregular import IrregularSea
from buoyancy_mj.sea.water import Water


def describe_sea(water: Water) -> str:
    """Height and period of the waves, and the current: 'Hs 0.30 m, Tp 3.5 s, current 0.26 m/s'."""
    parts = [_describe_waves(water)]
    if isinstance(water.current, tuple) and any(water.current):
        parts.append(f"current {math.hypot(*water.current):.2g} m/s")
    return ", ".join(parts)


def _describe_waves(water: Water) -> str:
    """Height and period of the waves."""
    rows = water.rows
    energies = rows[:, 0] ** 2
    if not energies.any():
        return "still water"
    waves = water.waves if isinstance(water.waves, tuple) else (water.waves,)
    if len(rows) == 1:
        what = "waves" if np.hypot(rows[0, 1], rows[0, 2]) > 0.0 else "level up and down"
        return f"{what} {2.0 * rows[0, 0]:.2f} m, {2.0 * math.pi / rows[0, 3]:.1f} s"
    height = f"Hs {4.0 * math.sqrt(0.5 * energies.sum()):.2f} m"
    (peak,) = {getattr(wave, "peak_period", None) for wave in waves[:1]}
    if len(waves) == 1 and isinstance(waves[0], IrregularSea) and peak:
        return f"{height}, Tp {peak:.1f} s"
    mean = 2.0 * math.pi * energies.sum() / (energies @ np.abs(rows[:, 3]))
    return f"{height}, Tm {mean:.1f} s"
