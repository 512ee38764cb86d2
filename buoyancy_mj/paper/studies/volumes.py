"""Studies of volumes and areas of bodies at rest, beside their closed forms."""

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.paper import solids
from buoyancy_mj.paper.methods import METHODS
from buoyancy_mj.paper.study import Claim, Result, judge, tabulate
from buoyancy_mj.paper.wording import itemize, percent
from buoyancy_mj.submersion.cross_sections import cut_sections


def measure_volume(quick: bool) -> Result:
    """Compare the hourglass's volume against immersion by every method with its closed form."""
    mesh = solids.hourglass()
    dz, positions = solids.immersions(21 if quick else 161)
    exact = solids.hourglass_volume(dz, solids.SIDES)
    columns = {"dz [m]": dz, "closed form [m^3]": exact}

    # volume and error by each method
    for name, method in METHODS.items():
        volumes = np.array(
            [solids.submerged_volume([mesh], p, solids.UPRIGHT, method) for p in positions]
        )
        columns[f"{name} [m^3]"] = volumes
        columns[f"{name}, error [% of the whole]"] = 100.0 * (volumes - exact) / mesh.volume
    claims = (_check_line(dz, columns), _check_sections(dz, columns, mesh.volume))
    return Result({"volume": columns}, claims)


def _check_line(dz: NDArray[np.float64], columns: dict[str, NDArray[np.float64]]) -> Claim:
    """Check the claim that the volume grows linearly with immersion."""
    r2, off = _fit_line(dz, columns["closed form [m^3]"])
    hull_r2, hull_off = _fit_line(dz, columns["convex hull [m^3]"])
    neck_slope = (solids.NECK_RADIUS / solids.BASE_RADIUS) ** 2
    return Claim(
        "dz and volume of the hourglass correspond linearly",
        "linear",
        f"the volume differs from the best line by up to {percent(off)} of the whole "
        f"(R^2 {r2:.3f}), and its slope falls to {percent(neck_slope)} at the neck; "
        "by the hull method, which fills the neck, the volume differs by "
        f"{percent(hull_off)} (R^2 {hull_r2:.3f})",
        judge(off < 0.02),
    )


def _check_sections(
    dz: NDArray[np.float64], columns: dict[str, NDArray[np.float64]], whole: float
) -> Claim:
    """Check the claim that sections and the convex hull agree."""
    exact = columns["closed form [m^3]"]
    hull = columns["convex hull [m^3]"]
    cut = columns["sections [m^3]"]

    # where they differ most, below the neck and past it
    deep = exact > 0.1 * whole
    below_neck = dz <= solids.HALF_HEIGHT
    past = percent(_largest_error(hull, cut, deep & ~below_neck), sign=True)
    below = percent(_largest_error(hull, cut, deep & below_neck), sign=True)
    return Claim(
        "sections agree with the hull method, hourglass",
        "within 3 %",
        "where a tenth of the whole or more is wet, the hull's volume differs from the sections' "
        f"by up to {past} past the neck, and {below} below it; the sections are within "
        f"{percent(np.abs(cut - exact).max() / whole)} of the closed form",
        judge(abs(_largest_error(hull, cut, deep)) < 0.03),
    )


def _fit_line(x: NDArray[np.float64], y: NDArray[np.float64]) -> tuple[float, float]:
    """R^2 of the best line, and the largest distance from it as a fraction of the last value."""
    off = y - np.polyval(np.polyfit(x, y, 1), x)
    r2 = 1.0 - off @ off / ((y - y.mean()) @ (y - y.mean()))
    return float(r2), float(np.abs(off).max() / y[-1])


def _largest_error(
    values: NDArray[np.float64], reference: NDArray[np.float64], where: NDArray[np.bool_]
) -> float:
    """Largest relative error of values, with its sign."""
    errors = values[where] / reference[where] - 1.0
    return float(errors[np.abs(errors).argmax()])


def measure_areas(quick: bool) -> Result:
    """Compute areas of cross-sections against z, of the hourglass and of the AUV."""
    step = 0.02 if quick else 0.002

    # the hourglass, beside its closed form
    mesh = solids.hourglass()
    z, rows, _ = cut_sections(mesh.vertices, mesh.faces, step, np.inf)
    exact = solids.hourglass_area(z + solids.HALF_HEIGHT, solids.SIDES)
    hourglass = {"z [m]": z, "sections [m^2]": rows[:, 0], "closed form [m^2]": exact}

    # the AUV, the meshes of each kind together
    low = min(mesh.bounds[0, 2] for mesh in solids.auv())
    high = max(mesh.bounds[1, 2] for mesh in solids.auv())
    auv = {"z [m]": np.arange(low, high + step, step)}
    for kind, meshes in solids.auv_parts().items():
        areas = [_section_areas(mesh, auv["z [m]"], step) for mesh in meshes]
        auv[f"{kind} [m^2]"] = np.sum(areas, axis=0)
    return Result({"areas_hourglass": hourglass, "areas_auv": auv})


def _section_areas(mesh: TriMesh, z: NDArray[np.float64], step: float) -> NDArray[np.float64]:
    """Areas [m^2] of a mesh's sections at heights z, zero above and below the mesh."""
    heights, rows, _ = cut_sections(mesh.vertices, mesh.faces, step, np.inf)
    areas: NDArray[np.float64] = np.interp(z, heights, rows[:, 0], left=0.0, right=0.0)
    return areas


def measure_approximations(_quick: bool) -> Result:
    """Compare volumes of simple shapes with the true ones, for the AUV and its parts."""
    # fractions of the box that the shape fills; the cylinder lies along any of its sides
    fractions = {
        "bounding box": 1.0,
        "inscribed ellipsoid": np.pi / 6.0,
        "inscribed cylinder": np.pi / 4.0,
    }

    # volumes of boxes, and true volumes
    whole = sum(mesh.volume for mesh in solids.auv())
    bodies = {
        "AUV as one": (_box_volume(solids.auv()), whole),
        "AUV, mesh by mesh": (sum(_box_volume((mesh,)) for mesh in solids.auv()), whole),
    }
    for kind, meshes in solids.auv_parts().items():
        boxes = sum(_box_volume((mesh,)) for mesh in meshes)
        bodies[kind] = (boxes, sum(mesh.volume for mesh in meshes))

    # their table
    errors = {
        name: [fraction * box / true - 1.0 for fraction in fractions.values()]
        for name, (box, true) in bodies.items()
    }
    rows = [
        (
            name,
            true,
            *(fraction * box for fraction in fractions.values()),
            *(100.0 * error for error in errors[name]),
        )
        for name, (box, true) in bodies.items()
    ]
    names = [
        "body",
        "true [m^3]",
        *(f"{shape} [m^3]" for shape in fractions),
        *(f"{shape}, error [%]" for shape in fractions),
    ]
    claim = _check_approximations(list(fractions), errors)
    return Result({"approximations": tabulate(names, rows)}, (claim,))


def _check_approximations(shapes: list[str], errors: dict[str, list[float]]) -> Claim:
    """Check the claim that simple shapes come close to the AUV's volume."""
    parts = []
    for name in ("AUV as one", "AUV, mesh by mesh", "pressure hull"):
        signed = [percent(error, sign=True) for error in errors[name]]
        parts.append(f"{name}: {itemize(dict(zip(shapes, signed, strict=True)))}")
    return Claim(
        "simple shapes are up to 15 % off the AUV's volume",
        "up to 15 %",
        "; ".join(parts),
        judge(
            max(map(abs, errors["AUV as one"] + errors["AUV, mesh by mesh"])) < 0.15,
            min(map(abs, errors["pressure hull"])) < 0.15,
        ),
    )


def _box_volume(meshes: tuple[TriMesh, ...]) -> float:
    """Volume [m^3] of the bounding box of all meshes together."""
    return float(np.prod(np.ptp(np.vstack([mesh.vertices for mesh in meshes]), axis=0)))
