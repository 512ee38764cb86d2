"""A slow twin of `equilibria`: the energy of a floating mesh in every attitude, and its lows.

With f = t - h the depth of a point under a surface at the height t, and h its height over the
centre of gravity, Gauss gives the wet volume V(t) and its integral F(t) over the triangles,

    V = - int f_+ n_z dA,   F = int V dt = - 1/2 int f_+^2 n_z dA,

and the moment of the wet volume V0 is int h dV = max over t of V0 t - F(t), as F is convex. The
potential energy over the weight is minus that moment over V0: the height of G over B. Rest poses
are lows of it over the directions of the vertical, seen from the body.
"""

import numpy as np
from scipy.spatial import cKDTree


class Floating:
    """A mesh that floats, with its centre of gravity and the volume that it displaces."""

    def __init__(self, mesh, centre_of_gravity, volume):
        self.corners = (np.asarray(mesh.vertices) - centre_of_gravity)[mesh.faces]
        a, b, c = np.swapaxes(self.corners, 0, 1)
        self.vectors = 0.5 * np.cross(b - a, c - a)
        self.volume = volume

    def energies(self, ups, halvings=26):
        """Height of G over B (n,) [m], with the directions (n, 3) upright.

        Its error goes with the square of that of the level, for there the moment is greatest.
        """
        heights = np.einsum("fvi,ni->vnf", self.corners, ups)
        lids = -self.vectors @ ups.T
        low, high = heights.min(axis=(0, 2)), heights.max(axis=(0, 2))
        # halve the interval, then straight on by the slope over what is left of it
        for _ in range(halvings):
            middle = 0.5 * (low + high)
            deep = np.einsum("nf,fn->n", ramp(middle[:, None] - heights), lids) > self.volume
            low, high = np.where(deep, low, middle), np.where(deep, middle, high)
        level = 0.5 * (low + high)
        under = np.einsum("nf,fn->n", 0.5 * squared_ramp(level[:, None] - heights), lids)
        return -(self.volume * level - under) / self.volume

    def lows(self, count=4000):
        """Directions (n, 3) with less energy than all round, from so many directions."""
        ups = spiral(count)
        # to 1e-8 of the height
        energies = np.concatenate([self.energies(part, 13) for part in np.array_split(ups, 16)])
        _, near = cKDTree(ups).query(ups, 9)
        found = []
        for up in ups[energies <= energies[near].min(axis=1)]:
            up = self.descend(up)
            if not any(np.linalg.norm(up - other) < 0.02 for other in found):
                found.append(up)
        return np.array(found)

    def descend(self, up, stride=0.02):
        """The low below a direction: to the best of eight ways, or half as far."""
        turns = np.linspace(0.0, 2.0 * np.pi, 8, endpoint=False)
        ring = np.column_stack([np.cos(turns), np.sin(turns)])
        energy = self.energies(up[None])[0]
        while stride > 1e-5:
            across = np.linalg.svd(up[None])[2][1:]
            around = up + stride * ring @ across
            around /= np.linalg.norm(around, axis=1)[:, None]
            energies = self.energies(around)
            best = energies.argmin()
            if energies[best] < energy:
                up, energy = around[best], energies[best]
            else:
                stride *= 0.5
        return up


def ramp(f):
    """Mean over triangles of max(f, 0), with f (3, ...) at their corners."""
    return _over_wet_part(f, lambda f: f.mean(axis=0), lambda top: top / 3.0)


def squared_ramp(f):
    """Mean over triangles of max(f, 0)^2, with f (3, ...) at their corners."""
    return _over_wet_part(
        f,
        lambda f: (np.square(f).sum(axis=0) + np.square(f.sum(axis=0))) / 12.0,
        lambda top: top**2 / 6.0,
    )


def _over_wet_part(f, over_all, over_tip):
    """A mean over the part of triangles where f > 0: all, all but a dry tip, or a wet tip."""
    low, middle, high = np.sort(f, axis=0)

    def tip(top, one, other):
        return over_tip(top) * top**2 / ((top - one) * (top - other))

    with np.errstate(divide="ignore", invalid="ignore"):
        wet, dry = tip(high, middle, low), tip(low, middle, high)
    whole = over_all(f)
    # f and f^2 are even or odd under a change of sign, and so is the tip
    return np.where(
        low >= 0.0, whole, np.where(middle >= 0.0, whole - dry, np.where(high > 0.0, wet, 0.0))
    )


def spiral(count):
    """Directions (count, 3) all round, on the golden spiral."""
    z = 1.0 - (2.0 * np.arange(count) + 1.0) / count
    turn = np.arange(count) * np.pi * (3.0 - np.sqrt(5.0))
    r = np.sqrt(1.0 - z**2)
    return np.column_stack([r * np.cos(turn), r * np.sin(turn), z])
