"""Where something may be added to a vessel, and the least that must be: a linear program."""

import dataclasses
import fnmatch
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import OptimizeResult, linprog

from buoyancy_mj.errors import BallastError, ModelError, choices
from buoyancy_mj.meshes.surface import winding_number
from buoyancy_mj.statics.floating_pose import FloatingPose
from buoyancy_mj.statics.vessel import Vessel

LEAST = 1e-6
"""Part of the mass of the vessel below which nothing is added."""


@dataclasses.dataclass(frozen=True, eq=False)
class BallastSite:
    """Where something may be added."""

    kind: str
    name: str
    point: NDArray[np.float64]
    """In the vessel's axes."""
    density: float
    displaces: bool
    lift: float
    """Mass of water displaced there for each kilogram added, at the wanted pose."""


def find_ballast_sites(
    pose: FloatingPose, kind: str, where: str | Sequence[str] | ArrayLike, density: float
) -> list[BallastSite]:
    """The sites that match, or the corners of a box."""
    vessel = pose.vessel
    words = [where] if isinstance(where, str) else list(where)  # type: ignore[arg-type]
    if all(isinstance(word, str) for word in words):
        found: dict[str, NDArray[np.float64]] = {}
        for word in map(str, words):
            matching = {
                name: at for name, at in vessel.sites.items() if fnmatch.fnmatchcase(name, word)
            }
            if not matching and word != f"{kind}*":
                raise ModelError(
                    f"no site of the vessel matches '{word}'; {choices(word, vessel.sites)}"
                )
            found |= matching
        return [_place(pose, kind, name, at, at, density) for name, at in found.items()]
    box = np.asarray(where, float)
    if box.shape != (2, 3) or not np.isfinite(box).all() or (box[0] > box[1]).any():
        raise ModelError(
            f"a box for {kind} is {box.tolist()}; it must be its lowest and highest corner (2, 3) [m]"
        )
    middle = box.mean(axis=0) - vessel.centre_of_gravity
    corners = np.array(np.meshgrid(*box.T)).reshape(3, -1).T - vessel.centre_of_gravity
    return [_place(pose, kind, "box", corner, middle, density) for corner in corners]


def _place(
    pose: FloatingPose,
    kind: str,
    name: str,
    point: NDArray[np.float64],
    middle: NDArray[np.float64],
    density: float,
) -> BallastSite:
    """A place, in or out of the hulls as `middle` is."""
    vessel = pose.vessel
    inside = [
        (hull.fill, hull.name)
        for hull, mesh in zip(vessel.hulls, vessel.meshes, strict=True)
        if (np.abs(middle - mesh.bounds.mean(axis=0)) <= 0.5 * mesh.extents).all()
        and winding_number(mesh.vertices, mesh.faces, middle) > 0.5
    ]
    taken, hull = max(inside, default=(0.0, ""))
    if kind == "foam" and taken == 1.0:
        raise BallastError(
            f"foam at '{name}' lies inside hull '{hull}', where it displaces nothing more; put it outside"
        )
    wet = pose.position[2] + pose.rotation[2] @ point < vessel.water.level
    return BallastSite(
        kind,
        name,
        point,
        density,
        taken < 1.0,
        (1.0 - taken) * float(wet) * vessel.water.density / density,
    )


def find_least_masses(
    pose: FloatingPose, places: Sequence[BallastSite], reserve: float, bg: float | None
) -> NDArray[np.float64]:
    """The least masses at the places (n,) [kg]."""
    vessel = pose.vessel
    displaced = vessel.water.density * pose.volume
    arms = np.array([pose.rotation @ place.point for place in places]).reshape(-1, 3)
    net = np.array([1.0 - place.lift for place in places])
    # weights and moments about the centre of gravity of the vessel as it is
    rows = np.vstack([net, net * arms[:, 0], net * arms[:, 1]])
    wanted = np.array([displaced - reserve - vessel.mass, *(displaced * pose.arm[:2])])
    if bg is not None:
        # sum of m z less that of the water displaced is -bg times the mass
        rows = np.vstack([rows, net * arms[:, 2] + bg])
        wanted = np.append(wanted, displaced * pose.arm[2] - bg * vessel.mass)
    if (
        np.abs(wanted[0]) <= LEAST * vessel.mass
        and np.abs(wanted[1:]).max() <= LEAST * vessel.mass * vessel.radius
    ):
        return np.zeros(len(places))
    if not places:
        raise BallastError(
            f"{wanted[0]:+.4g} kg are wanted, and there is no place for them; name sites 'ballast...' and 'foam...', or "
            "give masses or foam a box"
        )
    cost = np.array([1.0 + place.lift for place in places])
    found = _solved(cost, rows, wanted)
    if found.status == 0:
        return np.asarray(found.x)
    raise BallastError(_impossible(vessel, places, rows, wanted, bg))


def _solved(
    cost: NDArray[np.float64], rows: NDArray[np.float64], wanted: NDArray[np.float64]
) -> OptimizeResult:
    return linprog(cost, A_eq=rows, b_eq=wanted, bounds=(0.0, None), method="highs")


def _impossible(
    vessel: Vessel,
    places: Sequence[BallastSite],
    rows: NDArray[np.float64],
    wanted: NDArray[np.float64],
    bg: float | None,
) -> str:
    """What these places could do, as a sentence."""
    zero = np.zeros(len(places))
    if _solved(zero, rows[:1], wanted[:1]).status != 0:
        if wanted[0] < 0.0:
            return f"it is {-wanted[0]:.4g} kg too heavy for that; give foam a place under water, or take mass out"
        return f"it is {wanted[0]:.4g} kg too light for that; give masses a place"
    if _solved(zero, rows[:3], wanted[:3]).status != 0:
        # the least moments that must be left, either way
        n = len(places)
        slack = np.zeros((3, 4))
        slack[1:] = np.kron(np.eye(2), [1.0, -1.0])
        best = _solved(
            np.append(np.zeros(n), np.ones(4)), np.hstack([rows[:3], slack]), wanted[:3]
        ).x
        left = slack[1:] @ best[n:]
        return (
            f"these places cannot level it: {left[0]:+.4g} kg m along x and {left[1]:+.4g} kg m along y would be left; give "
            "places farther out on that side"
        )
    # the mass is not fixed by the rest, since foam may hold up ballast: the heights that can be reached are a ratio
    assert bg is not None
    heights = rows[3] - bg
    total = wanted[3] + bg * vessel.mass
    reach = [_ratio(vessel, rows[:3], wanted[:3], heights, total, way) for way in (1.0, -1.0)]
    return (
        f"these places give a BG of {reach[0]:.4g} to {reach[1]:.4g} m, not {bg:.4g}; give masses a lower place, or foam a "
        "higher one"
    )


def _ratio(
    vessel: Vessel,
    rows: NDArray[np.float64],
    wanted: NDArray[np.float64],
    heights: NDArray[np.float64],
    total: float,
    way: float,
) -> float:
    """The least or greatest BG = (total - heights x) / (mass + sum x), by Charnes and Cooper's linear program (1962)."""
    # y = x t and t = 1 / (mass + sum x)
    n = rows.shape[1]
    matrix = np.vstack([np.column_stack([rows, -wanted]), np.append(np.ones(n), vessel.mass)])
    found = _solved(way * np.append(-heights, total), matrix, np.append(np.zeros(len(wanted)), 1.0))
    return way * float(found.fun) if found.status == 0 else way * -math.inf
