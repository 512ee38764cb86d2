"""Rules over the nodes of a tree against integrals in closed form."""

import itertools

import numpy as np
import pytest

from buoyancy_mj.kernels import rules, tree
from buoyancy_mj.meshes import shapes
from buoyancy_mj.meshes.refinement import refine
from buoyancy_mj.meshes.tree import build_tree, find_rules

SIZE = np.array([0.7, 0.4, 0.3])
"""Half sides of a box [m]."""
MIDDLE = np.array([0.2, -0.1, 0.05])
"""Where its middle is [m]."""
POWERS = [powers for powers in itertools.product(range(6), repeat=3) if sum(powers) <= 4]


@pytest.fixture(scope="module")
def box():
    """The tree of a box, its rules (n, 3, p), and their points (n, p, 3)."""
    mesh = shapes.box(SIZE)
    fine = build_tree(*refine(mesh.vertices + MIDDLE, mesh.faces, 0.1))
    assert len(fine.spans) > 50
    middles, halves = fine.boxes[:, None, :3], fine.boxes[:, None, 3:]
    points = middles + halves * rules.STENCIL.T
    return fine, find_rules(fine).reshape(len(fine.spans), 3, rules.POINTS), points


def over_a_side(powers, axis, sign):
    """Integral of x^m y^n z^p over a side of the box."""
    at = (MIDDLE[axis] + sign * SIZE[axis]) ** powers[axis]
    ends = [(MIDDLE - SIZE), (MIDDLE + SIZE)]
    lengths = [
        (ends[1][c] ** (powers[c] + 1) - ends[0][c] ** (powers[c] + 1)) / (powers[c] + 1)
        for c in range(3)
        if c != axis
    ]
    return at * np.prod(lengths)


@pytest.mark.parametrize("powers", POWERS)
def test_a_rule_is_exact_up_to_degree_4(box, powers):
    _, found, points = box
    total = found[0] @ np.prod(points[0] ** powers, axis=1)
    expected = [over_a_side(powers, c, 1.0) - over_a_side(powers, c, -1.0) for c in range(3)]
    assert total == pytest.approx(expected, abs=1e-12)


def test_it_is_not_exact_beyond(box):
    _, found, points = box
    total = found[0] @ points[0, :, 0] ** 6
    expected = over_a_side((6, 0, 0), 0, 1.0) - over_a_side((6, 0, 0), 0, -1.0)
    assert abs(total[0] - expected) > 1e-4


def test_rules_of_nodes_add_up_to_that_of_the_node_above(box):
    fine, found, points = box
    for node in np.flatnonzero(fine.spans[:, tree.BEHIND] > np.arange(len(fine.spans)) + 1):
        first = node + 1
        second = fine.spans[first, tree.BEHIND]
        for powers in ((0, 0, 0), (1, 0, 2), (2, 2, 0), (0, 1, 3)):
            whole, *parts = (
                found[n] @ np.prod(points[n] ** powers, axis=1) for n in (node, first, second)
            )
            assert sum(parts) == pytest.approx(whole, abs=1e-13)


def test_points_lie_in_the_box_of_their_node_on_flat_sides_too(box):
    fine, _, points = box
    assert (np.abs(points - fine.boxes[:, None, :3]) <= fine.boxes[:, None, 3:] + 1e-15).all()
    # a leaf on one side of the box is flat
    assert (fine.boxes[:, 3:].min(axis=1) == 0.0).any()
