"""The least ballast that brings a vessel to a pose: a linear program."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from buoyancy_mj.errors import BallastError
from buoyancy_mj.statics.ballast_sites import BallastSite
from buoyancy_mj.statics.floating_pose import FloatingPose
from buoyancy_mj.statics.vessel import Vessel

NEGLIGIBLE = 1e-6
"""Part of the mass of a vessel below which nothing is added."""
_WEIGHT, _LEVEL, _HEIGHT = slice(0, 1), slice(0, 3), 3
"""Rows of `_Equations`: weight; weight and moments; height of B over G, if one is asked for."""


class _Equations(NamedTuple):
    """Linear equations for the masses at the sites: rows @ masses = targets."""

    rows: NDArray[np.float64]
    """What a kilogram at each site does (3 or 4, n)."""
    targets: NDArray[np.float64]
    """What all of them must do (3 or 4,): mass [kg], moments along x and y, and height [kg m]."""

    def select(self, rows: slice) -> "_Equations":
        """Select some of the equations."""
        return _Equations(self.rows[rows], self.targets[rows])


def find_least_masses(
    pose: FloatingPose, sites: Sequence[BallastSite], reserve: float, bg: float | None
) -> NDArray[np.float64]:
    """Find the least masses at the sites (n,) [kg] that balance a vessel in a pose.

    Args:
        pose: the target pose.
        sites: where masses may be added (n).
        reserve: lift left over [kg].
        bg: height of B over G [m]; None for any.

    Raises:
        BallastError: no masses at these sites do that; the message says what they could.
    """
    vessel = pose.vessel
    equations = _set_up_equations(pose, sites, reserve, bg)

    # nothing is missing
    missing, moments = equations.targets[0], equations.targets[1:]
    if (
        np.abs(missing) <= NEGLIGIBLE * vessel.whole_mass
        and np.abs(moments).max() <= NEGLIGIBLE * vessel.whole_mass * vessel.radius
    ):
        return np.zeros(len(sites))
    if not sites:
        raise BallastError(
            f"{missing:+.4g} kg are wanted, and there is no place for them; "
            "name sites 'ballast...' and 'foam...', or give masses or foam a box"
        )

    # the least mass, of what is added and of the water that it displaces
    cost = np.array([1.0 + site.lift for site in sites])
    solution = _solve(cost, equations)
    if solution.status != 0:
        raise BallastError(_explain(vessel, equations, bg))
    return np.asarray(solution.x)


def _set_up_equations(
    pose: FloatingPose, sites: Sequence[BallastSite], reserve: float, bg: float | None
) -> _Equations:
    """Set up weights, and moments about the centre of gravity of the vessel as it is."""
    vessel = pose.vessel
    displacement = vessel.water.density * pose.volume
    arms = np.array([pose.rotation @ site.point for site in sites]).reshape(-1, 3)
    net = np.array([1.0 - site.lift for site in sites])
    rows = np.vstack([net, net * arms[:, 0], net * arms[:, 1]])
    targets = np.array([displacement - reserve - vessel.mass, *(displacement * pose.lever[:2])])
    if bg is None:
        return _Equations(rows, targets)

    # the sum of m z, less that of the water displaced, is -bg times the mass
    return _Equations(
        rows=np.vstack([rows, net * arms[:, 2] + bg]),
        targets=np.append(targets, displacement * pose.lever[2] - bg * vessel.mass),
    )


def _solve(cost: NDArray[np.float64], equations: _Equations) -> "scipy.optimize.OptimizeResult":
    """Find the masses of least cost, none of them negative."""
    return scipy.optimize.linprog(
        cost, A_eq=equations.rows, b_eq=equations.targets, bounds=(0.0, None), method="highs"
    )


def _explain(vessel: Vessel, equations: _Equations, bg: float | None) -> str:
    """Say in a sentence what the sites could do instead."""
    anything = np.zeros(equations.rows.shape[1])
    if _solve(anything, equations.select(_WEIGHT)).status != 0:
        missing = equations.targets[0]
        if missing < 0.0:
            return (
                f"it is {-missing:.4g} kg too heavy for that; "
                "give foam a place under water, or take mass out"
            )
        return f"it is {missing:.4g} kg too light for that; give masses a place"
    if _solve(anything, equations.select(_LEVEL)).status != 0:
        along, across = _find_least_moments(equations)
        return (
            f"these places cannot level it: {along:+.4g} kg m along x and "
            f"{across:+.4g} kg m along y would be left; give places farther out on that side"
        )
    assert bg is not None
    low, high = (_find_extreme_bg(vessel, equations, bg, way) for way in (1.0, -1.0))
    return (
        f"these places give a BG of {low:.4g} to {high:.4g} m, not {bg:.4g}; "
        "give masses a lower place, or foam a higher one"
    )


def _find_least_moments(equations: _Equations) -> NDArray[np.float64]:
    """Least moments along x and y (2,) [kg m] that must be left, with the weight right."""
    rows, targets = equations.select(_LEVEL)
    count = rows.shape[1]

    # what is left of each moment, as a positive and a negative part
    slack = np.zeros((3, 4))
    slack[1:] = np.kron(np.eye(2), [1.0, -1.0])
    cost = np.append(np.zeros(count), np.ones(4))
    best = _solve(cost, _Equations(np.hstack([rows, slack]), targets)).x
    return np.asarray(slack[1:] @ best[count:], float)


def _find_extreme_bg(vessel: Vessel, equations: _Equations, bg: float, way: float) -> float:
    """Find the least (`way` 1) or the greatest (-1) BG [m] that the sites reach.

    It is the ratio BG = (total - heights x) / (mass + sum x), since foam may hold up ballast and so
    the rest does not fix the mass; hence the linear program of Charnes and Cooper (1962), in
    y = x t and t = 1 / (mass + sum x).
    """
    rows, targets = equations.select(_LEVEL)
    heights = equations.rows[_HEIGHT] - bg
    total = equations.targets[_HEIGHT] + bg * vessel.mass

    matrix = np.vstack(
        [np.column_stack([rows, -targets]), np.append(np.ones(rows.shape[1]), vessel.mass)]
    )
    values = np.append(np.zeros(len(targets)), 1.0)
    solution = _solve(way * np.append(-heights, total), _Equations(matrix, values))
    return way * float(solution.fun) if solution.status == 0 else way * -math.inf
