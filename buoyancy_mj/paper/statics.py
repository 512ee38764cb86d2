"""Studies of bodies at rest: volumes, areas and their errors."""

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.paper import solids
from buoyancy_mj.paper.study import Claim, Result, listed, percent, table_of, verdict
from buoyancy_mj.submersion.convex_hull import ConvexHull
from buoyancy_mj.submersion.cross_sections import cut_sections
from buoyancy_mj.submersion.exact import Exact
from buoyancy_mj.submersion.methods import Method
from buoyancy_mj.submersion.sections import Sections

HULL, CUT, SECTIONS = ConvexHull(), ConvexHull(cut=True, centroid="hull"), Sections()
METHODS: dict[str, Method] = {
    "exact": Exact(),
    "convex hull": HULL,
    "convex hull with cuts": CUT,
    "sections": SECTIONS,
    "sections, Simpson": Sections(rule="simpson"),
}
"""The methods that are compared, by the names of their columns."""
FIXED = Sections(axis=(0.0, 0.0, 1.0))
"""Sections along an axis that turns with the body."""
UPRIGHT = np.eye(3)
DENSITY = 1000.0


def volume(quick: bool) -> Result:
    """Volume of the hourglass against its immersion dz, by every method and by its closed form."""
    mesh = solids.hourglass()
    dz = np.linspace(0.0, 2.0 * solids.HALF_HEIGHT, 21 if quick else 161)
    places = [np.array([0.0, 0.0, solids.HALF_HEIGHT - t]) for t in dz]
    columns = {"dz [m]": dz, "closed form [m^3]": solids.hourglass_volume(dz, solids.SECTIONS)}
    truth, whole = columns["closed form [m^3]"], mesh.volume
    for name, method in METHODS.items():
        found = np.array([solids.wet_volume([mesh], place, UPRIGHT, method) for place in places])
        columns[f"{name} [m^3]"] = found
        columns[f"{name}, error [% of the whole]"] = 100.0 * (found - truth) / whole
    line = {name: _line(dz, columns[f"{name} [m^3]"]) for name in ("closed form", "convex hull")}
    (r2, off), (hull_r2, hull_off) = line["closed form"], line["convex hull"]
    hull, cut = columns["convex hull [m^3]"], columns["sections [m^3]"]
    deep = truth > 0.1 * whole
    neck = dz <= solids.HALF_HEIGHT
    claims = (
        Claim(
            "dz and volume of the hourglass correspond linearly",
            "linear",
            f"the volume is off the best line by up to {percent(off)} of the whole (R^2 {r2:.3f}), its slope falls "
            f"to {percent((solids.NECK_RADIUS / solids.BASE_RADIUS) ** 2)} at the neck; by the hull that fills the "
            f"neck by {percent(hull_off)} (R^2 {hull_r2:.3f})",
            verdict(off < 0.02),
        ),
        Claim(
            "sections agree with the hull method, hourglass",
            "within 3 %",
            f"where a tenth of the whole or more is wet the hull's volume is off the sections' by up to "
            f"{percent(_worst(hull, cut, deep & ~neck), sign=True)} past the neck, and "
            f"{percent(_worst(hull, cut, deep & neck), sign=True)} below it; the sections are within "
            f"{percent(np.abs(cut - truth).max() / whole)} of the closed form",
            verdict(abs(_worst(hull, cut, deep)) < 0.03),
        ),
    )
    return Result({"volume": columns}, claims)


def areas(quick: bool) -> Result:
    """Areas of cross-sections against z, of the hourglass with its closed form and of the AUV."""
    step = 0.02 if quick else 0.002
    mesh = solids.hourglass()
    s, rows, _ = cut_sections(mesh.vertices, mesh.faces, step, np.inf)
    truth = solids.hourglass_area(s + solids.HALF_HEIGHT, solids.SECTIONS)
    z = np.arange(
        min(m.bounds[0, 2] for m in solids.auv()),
        max(m.bounds[1, 2] for m in solids.auv()) + step,
        step,
    )
    auv = {"z [m]": z}
    for name, part in _parts().items():
        auv[f"{name} [m^2]"] = np.sum([_areas_at(m, z, step) for m in part], axis=0)
    return Result(
        {
            "areas_hourglass": {
                "z [m]": s,
                "sections [m^2]": rows[:, 0],
                "closed form [m^2]": truth,
            },
            "areas_auv": auv,
        },
        (),
    )


def tilt(quick: bool) -> Result:
    """Error of the submerged volume against tilt, at the height at which each body floats upright."""
    angles = np.arange(0.0, 90.1, 15.0 if quick else 5.0)
    methods = METHODS | {"sections, axis of the body": FIXED}
    bodies = {"hourglass": (solids.hourglass(),), "AUV": solids.auv()}
    columns: dict[str, NDArray[np.float64]] = {"tilt [deg]": angles}
    claims = []
    for body, meshes in bodies.items():
        mass = float(
            solids.model_of("hourglass" if body == "hourglass" else "sauvc_auv").body_mass.sum()
        )
        place = np.array([0.0, 0.0, _floating(meshes, mass / DENSITY)])
        turns = Rotation.from_euler("y", angles[:, None], degrees=True).as_matrix()
        wet = {
            name: np.array([solids.wet_volume(meshes, place, turn, m) for turn in turns])
            for name, m in methods.items()
        }
        errors = {name: found / wet["exact"] - 1.0 for name, found in wet.items()}
        columns |= {
            f"{body}, {name}, error [%]": 100.0 * error
            for name, error in errors.items()
            if name != "exact"
        }
        low = angles <= 45.0
        free, fixed = (
            np.abs(errors[name][low]).max() for name in ("sections", "sections, axis of the body")
        )
        beyond = np.abs(errors["sections"]).max()
        far = np.abs(errors["sections, axis of the body"]).max()
        claims.append(
            Claim(
                f"sections along an axis free to turn up to 45 degrees, {body}",
                "below 3 %; fixed axes 10 %",
                f"axis kept vertical: {percent(free)} to 45 degrees, {percent(beyond)} to 90; axis fixed in the body: "
                f"{percent(fixed)} to 45, {percent(far)} to 90; "
                f"the hull: {percent(np.abs(errors['convex hull'][low]).max())}",
                verdict(free < 0.03 and fixed > 0.03, free < 0.03),
            )
        )
    return Result({"tilt": columns}, tuple(claims))


def density(quick: bool) -> Result:
    """Error of the submerged volume against the number of vertices, at a draft of 0.6 of the height."""
    approximate = [name for name in METHODS if name != "exact"]
    rows, claims, apart = [], [], {}
    for body, kind in solids.FAMILIES.items():
        for level in range(2 if quick else 3 if body.startswith("AUV") else 5):
            meshes = solids.family(body, level)
            place = solids.at_draft(meshes, 0.6, UPRIGHT)
            truth = solids.wet_volume(meshes, place, UPRIGHT)
            errors = {
                name: solids.wet_volume(meshes, place, UPRIGHT, METHODS[name]) / truth - 1.0
                for name in approximate
            }
            whole = (
                solids.wet_volume(meshes, place - [0.0, 0.0, 10.0], UPRIGHT, HULL)
                / sum(m.volume for m in meshes)
                - 1.0
            )
            count = sum(len(m.vertices) for m in meshes)
            rows.append(
                (body, float(count), *(100.0 * errors[name] for name in approximate), 100.0 * whole)
            )
        apart[body] = (1.0 + errors["sections"]) / (1.0 + errors["convex hull"]) - 1.0
        claims.append(
            Claim(
                f"the hull's error is negligible on dense meshes: {body}",
                "negligible",
                f"{kind}: {percent(errors['convex hull'], sign=True)} at {count:,} vertices, "
                f"{percent(whole, sign=True)} all under water; sections {percent(errors['sections'], sign=True)}",
                verdict(abs(errors["convex hull"]) < 0.01 and abs(whole) < 0.01),
            )
        )
    claims.append(
        Claim(
            "sections agree with the hull method, dense meshes",
            "within 3 %",
            "sections less hull: "
            + listed({body: percent(off, sign=True) for body, off in apart.items()}),
            verdict(max(map(abs, apart.values())) < 0.03, min(map(abs, apart.values())) < 0.03),
        )
    )
    names = [
        "body",
        "vertices",
        *(f"{name}, error [%]" for name in approximate),
        "convex hull, all under water, error [%]",
    ]
    return Result({"density": table_of(names, rows)}, tuple(claims))


def approximations(quick: bool) -> Result:
    """Volumes of a bounding box, an ellipsoid and a cylinder in it against the true one, for the AUV and its parts."""
    # fractions of the box that the shape fills; the cylinder lies along any of its sides
    shapes = {
        "bounding box": 1.0,
        "inscribed ellipsoid": np.pi / 6.0,
        "inscribed cylinder": np.pi / 4.0,
    }
    whole = sum(m.volume for m in solids.auv())
    bodies = {
        "AUV as one": (_box(solids.auv()), whole),
        "AUV, mesh by mesh": (sum(_box((m,)) for m in solids.auv()), whole),
    }
    for name, part in _parts().items():
        bodies[name] = (sum(_box((m,)) for m in part), sum(m.volume for m in part))
    errors = {
        name: [fill * box / true - 1.0 for fill in shapes.values()]
        for name, (box, true) in bodies.items()
    }
    rows = [
        (
            name,
            true,
            *(fill * box for fill in shapes.values()),
            *(100.0 * error for error in errors[name]),
        )
        for name, (box, true) in bodies.items()
    ]
    names = [
        "body",
        "true [m^3]",
        *(f"{shape} [m^3]" for shape in shapes),
        *(f"{shape}, error [%]" for shape in shapes),
    ]
    told = []
    for name in ("AUV as one", "AUV, mesh by mesh", "pressure hull"):
        signed = {
            shape: percent(error, sign=True)
            for shape, error in zip(shapes, errors[name], strict=True)
        }
        told.append(f"{name}: {listed(signed)}")
    return Result(
        {"approximations": table_of(names, rows)},
        (
            Claim(
                "simple shapes are up to 15 % off the AUV's volume",
                "up to 15 %",
                "; ".join(told),
                verdict(
                    max(map(abs, errors["AUV as one"] + errors["AUV, mesh by mesh"])) < 0.15,
                    min(map(abs, errors["pressure hull"])) < 0.15,
                ),
            ),
        ),
    )


def _line(x: NDArray[np.float64], y: NDArray[np.float64]) -> tuple[float, float]:
    """R^2 of the best line, and the largest distance from it as a fraction of the last value."""
    off = y - np.polyval(np.polyfit(x, y, 1), x)
    return float(1.0 - off @ off / ((y - y.mean()) @ (y - y.mean()))), float(
        np.abs(off).max() / y[-1]
    )


def _worst(a: NDArray[np.float64], b: NDArray[np.float64], where: NDArray[np.bool_]) -> float:
    """Largest relative difference of a from b, signed."""
    off = a[where] / b[where] - 1.0
    return float(off[np.abs(off).argmax()])


def _floating(meshes: tuple[TriMesh, ...], wanted: float) -> float:
    """Height of the frame [m] at which meshes, upright, displace a volume [m^3]."""
    z = np.concatenate([mesh.vertices[:, 2] for mesh in meshes])

    def excess(height: float) -> float:
        return solids.wet_volume(meshes, np.array([0.0, 0.0, height]), UPRIGHT) - wanted

    return float(brentq(excess, -z.max(), -z.min(), xtol=1e-10))


def _parts() -> dict[str, list[TriMesh]]:
    """The AUV's meshes by kind."""
    names = [
        "pressure hull",
        "battery pod",
        "frame",
        "foam",
        "foam",
        "ballast",
        "ballast",
        *["thrusters"] * 8,
    ]
    parts: dict[str, list[TriMesh]] = {}
    for name, mesh in zip(names, solids.auv(), strict=True):
        parts.setdefault(name, []).append(mesh)
    return parts


def _areas_at(mesh: TriMesh, z: NDArray[np.float64], step: float) -> NDArray[np.float64]:
    """Areas of a mesh's sections at heights z, nothing above and below it."""
    s, rows, _ = cut_sections(mesh.vertices, mesh.faces, step, np.inf)
    return np.interp(z, s, rows[:, 0], left=0.0, right=0.0)


def _box(meshes: tuple[TriMesh, ...]) -> float:
    """Volume of the bounding box of all [m^3]."""
    return float(np.prod(np.ptp(np.vstack([mesh.vertices for mesh in meshes]), axis=0)))
