"""Cross-sections of a mesh: cut at heights along an axis, and integrated along it."""

import math

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.kernels import slices

DEFAULT_COUNT = 100
"""Sections across a hull if no step is given."""
FEWEST = 10
"""Least sections across a hull: a longer step is shortened, lest small hulls be lost."""
INSET = 1e-6
"""Fraction of the height by which sections at the ends lie inside them.

Flat ends count thus, though rounded."""


def cut_sections(
    points: NDArray[np.float64], faces: NDArray[np.int64], step: float | None, top: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], int]:
    """Cut a closed mesh perpendicular to its third coordinate, from its lowest point up to `top`.

    Args:
        points: vertices (v, 3) [m], along right-handed axes u, v, s.
        faces: indices of the corners of each triangle (f, 3).
        step: distance between sections [m], shortened where fewer than `FEWEST` would result; None
            for a 100th of the extent along s. The last section, at `top` or the highest point,
            comes sooner.
        top: highest s [m] of interest.

    Returns:
        Heights (n,) [m] of the sections. Rows (n, 4): area A [m^2] and its moments int u dA,
        int v dA, s A [m^3]. The number of triangles that the sections meet. There are no sections
        if the mesh lies above `top`.
    """
    low, high = points[:, 2].min(), points[:, 2].max()
    end = min(top, high)
    if not end > low:
        return np.zeros(0), np.zeros((0, 4)), 0

    # heights of the sections
    step = (high - low) / DEFAULT_COUNT if step is None else min(step, (high - low) / FEWEST)
    count = max(1, math.ceil((end - low) / step - 1e-9))
    s = np.append(low + step * np.arange(count), end)

    # areas and moments
    inset = INSET * (high - low)
    out = np.empty((len(s), 3))
    crossings = slices.sections(points, faces, np.clip(s, low + inset, high - inset), out)
    return s, np.column_stack([out, out[:, 0] * s]), int(crossings)


def integrate(rows: NDArray[np.float64], s: NDArray[np.float64], rule: str) -> NDArray[np.float64]:
    """Integrate rows (n, k) over s (n,), from its first value up to each (n, k).

    The last interval is shorter than the others, and always a trapezoid: a parabola through three
    points, two of them close together and an area's jump between them, could lead anywhere.

    Args:
        rows: values to integrate (n, k).
        s: heights (n,) [m], equally spaced but for the last.
        rule: "trapezoid" or "simpson".

    Returns:
        Integrals (n, k), the first of them zero; a single row of zeros for fewer than two heights.
    """
    from scipy.integrate import cumulative_simpson, cumulative_trapezoid

    if len(s) < 2:
        return np.zeros((1, rows.shape[1]))
    integrals: NDArray[np.float64] = cumulative_trapezoid(rows, s, axis=0, initial=0.0)
    if rule == "simpson" and len(s) > 3:
        integrals[-1] -= integrals[-2]
        integrals[:-1] = cumulative_simpson(rows[:-1], dx=s[1] - s[0], axis=0, initial=0.0)
        integrals[-1] += integrals[-2]
    return integrals


def complete_axes(axis: NDArray[np.float64]) -> NDArray[np.float64]:
    """Right-handed orthonormal axes (3, 3), as rows, the third of which is along `axis` (3,)."""
    # scaled first, so that the squares of tiny and huge numbers do not vanish or overflow
    third = axis / np.abs(axis).max()
    third = third / np.linalg.norm(third)
    first = np.cross(np.eye(3)[np.argmin(np.abs(third))], third)
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(third, first), third])
