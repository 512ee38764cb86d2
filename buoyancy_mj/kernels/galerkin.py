"""Laplace's single and double layer between the flat triangles of a closed surface, by Galerkin.

The inner integral is exact: over a flat triangle the integrals of 1/r, of its normal derivative
and of both times a linear function consist of one solid angle and one logarithm for each edge
(Wilton et al. 1984, IEEE Trans. Antennas Propag. 32, 276; Graglia 1993, ibid. 41, 1448). The outer
integral is a rule at points of the other triangle: the nearer that one is, the more points.
"""

import math
from typing import NamedTuple

import numpy as np

from buoyancy_mj.kernels.arrays import Doubles, Words
from buoyancy_mj.kernels.compiling import njit

NEAR, MIDDLE, FAR = 1.0, 3.0, 8.0
"""Distance of two triangles, over the sum of their radii, up to which a finer rule sums.

Beyond the last each counts as its centre, to 1e-3 of what is between two of them.
"""


class Panels(NamedTuple):
    """Flat triangles that wind counter-clockwise seen from outside; edge e starts at corner e."""

    faces: Words
    """Vertices of each (m, 3)."""
    corners: Doubles
    """(m, 3, 3)."""
    normals: Doubles
    """Outward, of length 1 (m, 3)."""
    tangents: Doubles
    """Along each edge, of length 1 (m, 3, 3)."""
    outwards: Doubles
    """Across each edge, in the plane of the triangle, of length 1 (m, 3, 3)."""
    lengths: Doubles
    """Of each edge (m, 3)."""
    areas: Doubles
    """(m,)."""
    centres: Doubles
    """(m, 3)."""
    radii: Doubles
    """Distance of the farthest corner from the centre (m,)."""


class Rule(NamedTuple):
    """Points on a triangle and their weights."""

    points: Doubles
    """Barycentric coordinates (n, 3)."""
    weights: Doubles
    """(n,); their sum is 1."""


class Rules(NamedTuple):
    """Rules for triangles that are near, less near, and far."""

    near: Rule
    middle: Rule
    far: Rule


class Layers(NamedTuple):
    """What is summed. The six functions g are the normal velocities of a rigid body.

    They are n and x cross n. Green's function is 1 / (4 pi r).
    """

    single: Doubles
    """Single layer between triangles: integrals of Green's function over both (m, m)."""
    double: Doubles
    """g times the double layer of each vertex's hat function (n, 6)."""
    power: Doubles
    """g times the single layer of g (6, 6)."""


@njit(cache=True, error_model="numpy")
def integrate(panels, j, same, x, y, z, logs, layer, hats):
    """The layers of one triangle, times 4 pi, at a point.

    Args:
        panels: `Panels`.
        j: which triangle.
        same: whether the point lies on it.
        x: of the point.
        y: of the point.
        z: of the point.
        logs: room (3, 2).
        layer: is set to the single layer of the six g (6,).
        hats: is set to the double layer of the hat function of each corner (3,).

    Returns:
        The single layer of 1.
    """
    c, n, length = panels.corners[j], panels.normals[j], panels.lengths[j]
    tangent, outward = panels.tangents[j], panels.outwards[j]

    # from the point to the corners
    ax, ay, az = c[0, 0] - x, c[0, 1] - y, c[0, 2] - z
    bx, by, bz = c[1, 0] - x, c[1, 1] - y, c[1, 2] - z
    cx, cy, cz = c[2, 0] - x, c[2, 1] - y, c[2, 2] - z
    a = math.sqrt(ax * ax + ay * ay + az * az)
    b = math.sqrt(bx * bx + by * by + bz * bz)
    o = math.sqrt(cx * cx + cy * cy + cz * cz)

    # the solid angle, positive seen from inside (van Oosterom, Strackee 1983), and the height
    height, angle = 0.0, 0.0
    if not same:
        height = -(ax * n[0] + ay * n[1] + az * n[2])
        triple = ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
        ab = ax * bx + ay * by + az * bz
        bo = bx * cx + by * cy + bz * cz
        oa = cx * ax + cy * ay + cz * az
        angle = 2.0 * math.atan2(triple, a * b * o + ab * o + bo * a + oa * b)

    # along each edge the integrals of 1 / r and of r
    potential = height * angle
    ux, uy, uz, jx, jy, jz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for e in range(3):
        px, py, pz, r, s = ax, ay, az, a, b
        if e == 1:
            px, py, pz, r, s = bx, by, bz, b, o
        elif e == 2:
            px, py, pz, r, s = cx, cy, cz, o, a
        across = px * outward[e, 0] + py * outward[e, 1] + pz * outward[e, 2]
        start = px * tangent[e, 0] + py * tangent[e, 1] + pz * tangent[e, 2]
        both = r + s
        log = math.log((both + length[e]) / max(both - length[e], 1e-15 * length[e]))
        root = (start + length[e]) * s - start * r + (across * across + height * height) * log
        logs[e, 0], logs[e, 1] = log, across
        potential += across * log
        ux += outward[e, 0] * log
        uy += outward[e, 1] * log
        uz += outward[e, 2] * log
        jx += 0.5 * outward[e, 0] * root
        jy += 0.5 * outward[e, 1] * root
        jz += 0.5 * outward[e, 2] * root

    # g is linear over the triangle: its value under the point, and its slope
    layer[0], layer[1], layer[2] = n[0] * potential, n[1] * potential, n[2] * potential
    layer[3] = (y * n[2] - z * n[1]) * potential + jy * n[2] - jz * n[1]
    layer[4] = (z * n[0] - x * n[2]) * potential + jz * n[0] - jx * n[2]
    layer[5] = (x * n[1] - y * n[0]) * potential + jx * n[1] - jy * n[0]

    # so is the hat function of the corner opposite an edge
    twice = 2.0 * panels.areas[j]
    for e in range(3):
        slope = outward[e, 0] * ux + outward[e, 1] * uy + outward[e, 2] * uz
        hats[(e + 2) % 3] = (height * slope - logs[e, 1] * angle) * length[e] / twice
    return potential


@njit(cache=True, error_model="numpy")
def concentrate(panels, j, x, y, z, layer, hats):
    """The layers of one triangle that is far away, as `integrate` gives them."""
    c, n, area = panels.centres[j], panels.normals[j], panels.areas[j]
    dx, dy, dz = c[0] - x, c[1] - y, c[2] - z
    inverse = 1.0 / math.sqrt(dx * dx + dy * dy + dz * dz)
    potential = area * inverse
    layer[0], layer[1], layer[2] = n[0] * potential, n[1] * potential, n[2] * potential
    layer[3] = (c[1] * n[2] - c[2] * n[1]) * potential
    layer[4] = (c[2] * n[0] - c[0] * n[2]) * potential
    layer[5] = (c[0] * n[1] - c[1] * n[0]) * potential
    hats[:] = -(dx * n[0] + dy * n[1] + dz * n[2]) * inverse * inverse * potential / 3.0
    return potential


@njit(cache=True, error_model="numpy")
def sum_layers(panels, rules, layers):
    """Sum the layers of all triangles over all triangles.

    Args:
        panels: `Panels`.
        rules: `Rules`.
        layers: `Layers` of zeros, is filled.
    """
    single, double, power = layers
    faces, centres, radii, areas = panels.faces, panels.centres, panels.radii, panels.areas
    logs, layer, hats, g = np.empty((3, 2)), np.empty(6), np.empty(3), np.empty(6)
    unit = 0.25 / math.pi
    for i in range(areas.shape[0]):
        corners, n = panels.corners[i], panels.normals[i]
        g[:3] = n
        for j in range(areas.shape[0]):
            dx, dy = centres[i, 0] - centres[j, 0], centres[i, 1] - centres[j, 1]
            dz = centres[i, 2] - centres[j, 2]
            apart = math.sqrt(dx * dx + dy * dy + dz * dz) / (radii[i] + radii[j])
            rule = rules.far
            if apart < NEAR:
                rule = rules.near
            elif apart < MIDDLE:
                rule = rules.middle

            for q in range(rule.weights.shape[0]):
                p = rule.points[q]
                x = p[0] * corners[0, 0] + p[1] * corners[1, 0] + p[2] * corners[2, 0]
                y = p[0] * corners[0, 1] + p[1] * corners[1, 1] + p[2] * corners[2, 1]
                z = p[0] * corners[0, 2] + p[1] * corners[1, 2] + p[2] * corners[2, 2]
                if apart < FAR:
                    potential = integrate(panels, j, i == j, x, y, z, logs, layer, hats)
                else:
                    potential = concentrate(panels, j, x, y, z, layer, hats)
                weight = unit * rule.weights[q] * areas[i]
                single[i, j] += weight * potential
                g[3], g[4], g[5] = y * n[2] - z * n[1], z * n[0] - x * n[2], x * n[1] - y * n[0]
                for k in range(6):
                    for m in range(6):
                        power[k, m] += weight * g[k] * layer[m]
                    for corner in range(3):
                        double[faces[j, corner], k] += weight * hats[corner] * g[k]
