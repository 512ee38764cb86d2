"""Studies of the error of the submerged volume: against tilt, and against density of vertices."""

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.paper import solids
from buoyancy_mj.paper.methods import ALL_METHODS, DENSITY, METHODS
from buoyancy_mj.paper.study import Claim, Result, judge, tabulate
from buoyancy_mj.paper.wording import itemize, percent

_DRAFT = 0.6
"""Draft of the bodies of growing density, over their height."""
_DEEP = np.array([0.0, 0.0, -10.0])
"""A displacement that takes any of the bodies wholly under water [m]."""


def measure_tilt(quick: bool) -> Result:
    """Measure errors against tilt, at the height at which each body floats upright."""
    angles = np.arange(0.0, 90.1, 15.0 if quick else 5.0)
    rotations = Rotation.from_euler("y", angles[:, None], degrees=True).as_matrix()
    bodies = {
        "hourglass": ("hourglass", (solids.hourglass(),)),
        "AUV": ("sauvc_auv", solids.auv()),
    }

    columns: dict[str, NDArray[np.float64]] = {"tilt [deg]": angles}
    claims = []
    for body, (model, meshes) in bodies.items():
        # volumes at the height that the body has upright
        mass = float(solids.load_model(model).body_mass.sum())
        position = np.array([0.0, 0.0, floating_height(meshes, mass / DENSITY)])
        volumes = {
            name: np.array(
                [solids.submerged_volume(meshes, position, turn, method) for turn in rotations]
            )
            for name, method in ALL_METHODS.items()
        }

        # their errors
        errors = {
            name: values / volumes["exact"] - 1.0
            for name, values in volumes.items()
            if name != "exact"
        }
        columns |= {f"{body}, {name}, error [%]": 100.0 * error for name, error in errors.items()}
        claims.append(_check_tilt(body, angles, errors))
    return Result({"tilt": columns}, tuple(claims))


def floating_height(meshes: tuple[TriMesh, ...], volume: float) -> float:
    """Height of the frame [m] at which meshes, upright, displace a volume [m^3]."""
    z = np.concatenate([mesh.vertices[:, 2] for mesh in meshes])

    def excess(height: float) -> float:
        position = np.array([0.0, 0.0, height])
        return solids.submerged_volume(meshes, position, solids.UPRIGHT) - volume

    return float(brentq(excess, -z.max(), -z.min(), xtol=1e-10))


def _check_tilt(
    body: str, angles: NDArray[np.float64], errors: dict[str, NDArray[np.float64]]
) -> Claim:
    """Check the claim that sections along a vertical axis are right at every tilt."""
    moderate = angles <= 45.0
    vertical = np.abs(errors["sections"])
    fixed = np.abs(errors["sections, axis of the body"])
    hull = np.abs(errors["convex hull"])
    vertical_error = vertical[moderate].max()
    fixed_error = fixed[moderate].max()
    return Claim(
        f"sections along an axis free to turn up to 45 degrees, {body}",
        "below 3 %; fixed axes 10 %",
        f"axis kept vertical: {percent(vertical_error)} to 45 degrees, "
        f"{percent(vertical.max())} to 90; axis fixed in the body: {percent(fixed_error)} to 45, "
        f"{percent(fixed.max())} to 90; the hull: {percent(hull[moderate].max())}",
        judge(vertical_error < 0.03 and fixed_error > 0.03, vertical_error < 0.03),
    )


def measure_density(quick: bool) -> Result:
    """Measure errors against the number of vertices, at a draft of 0.6 of the height."""
    names = [name for name in METHODS if name != "exact"]
    rows: list[tuple[str | float, ...]] = []
    claims = []
    differences: dict[str, float] = {}
    for body in solids.FAMILIES:
        # from few vertices to many
        for level in range(_levels(body, quick)):
            meshes = solids.family(body, level)
            count = sum(len(mesh.vertices) for mesh in meshes)
            errors, deep_error = _density_errors(meshes, names)
            percentages = (100.0 * errors[name] for name in names)
            rows.append((body, float(count), *percentages, 100.0 * deep_error))

        # claims about the densest
        claims.append(_check_density(body, count, errors, deep_error))
        differences[body] = (1.0 + errors["sections"]) / (1.0 + errors["convex hull"]) - 1.0

    # sections beside the hull, all bodies
    signed = {body: percent(value, sign=True) for body, value in differences.items()}
    sizes = [abs(value) for value in differences.values()]
    claims.append(
        Claim(
            "sections agree with the hull method, dense meshes",
            "within 3 %",
            "sections less hull: " + itemize(signed),
            judge(max(sizes) < 0.03, min(sizes) < 0.03),
        )
    )
    header = [
        "body",
        "vertices",
        *(f"{name}, error [%]" for name in names),
        "convex hull, all under water, error [%]",
    ]
    return Result({"density": tabulate(header, rows)}, tuple(claims))


def _levels(body: str, quick: bool) -> int:
    """How many densities of a body are tried; the AUV has many vertices from the start."""
    if quick:
        return 2
    return 3 if body.startswith("AUV") else 5


def _density_errors(
    meshes: tuple[TriMesh, ...], names: list[str]
) -> tuple[dict[str, float], float]:
    """Relative errors by method at the draft, and of the convex hull wholly under water."""
    position = solids.position_at_draft(meshes, _DRAFT, solids.UPRIGHT)
    exact = solids.submerged_volume(meshes, position, solids.UPRIGHT)
    errors = {
        name: solids.submerged_volume(meshes, position, solids.UPRIGHT, METHODS[name]) / exact - 1.0
        for name in names
    }
    deep = solids.submerged_volume(meshes, position + _DEEP, solids.UPRIGHT, METHODS["convex hull"])
    return errors, deep / sum(mesh.volume for mesh in meshes) - 1.0


def _check_density(body: str, count: int, errors: dict[str, float], deep_error: float) -> Claim:
    """Check the claim that the hull's error is negligible on a dense mesh."""
    hull_error = errors["convex hull"]
    return Claim(
        f"the hull's error is negligible on dense meshes: {body}",
        "negligible",
        f"{solids.FAMILIES[body]}: {percent(hull_error, sign=True)} at {count:,} vertices, "
        f"{percent(deep_error, sign=True)} all under water; "
        f"sections {percent(errors['sections'], sign=True)}",
        judge(abs(hull_error) < 0.01 and abs(deep_error) < 0.01),
    )
