"""An `Inspection` as plain values for JSON."""

import dataclasses
import math
from typing import Any

import numpy as np

from buoyancy_mj.inspection.geoms import GeomInspection
from buoyancy_mj.inspection.inspection import Inspection
from buoyancy_mj.inspection.vessels import BuoyancyBudget, VesselInspection
from buoyancy_mj.loads.foil_arrays import PlacedFoil
from buoyancy_mj.statics.equilibrium import Equilibrium

_DERIVED = (
    "displacement", "reserve", "draft", "KB", "KG", "BG", "BMt", "BMl", "KMt", "KMl", "GMt", "GMl",
    "GM",
)  # fmt: skip
"""Properties of `Hydrostatics` that are written beside its fields."""


def to_json(inspection: Inspection) -> dict[str, Any]:
    """Write the report as plain values for JSON.

    Units are SI, angles in radians; what is not a finite number becomes null.
    """
    return {
        "title": inspection.title,
        "water": {"density": inspection.water.density, "level": inspection.water.level},
        "geoms": [_convert_geom(geom) for geom in inspection.geoms],
        "overlaps": [
            {"hulls": [one, other], "volume": _convert(volume)}
            for one, other, volume in inspection.overlaps
        ],
        "foils": [_convert_foil(foil) for foil in inspection.foils],
        "ballast": [
            {
                "name": one.name,
                "kind": one.ballast.kind,
                "capacity": one.capacity,
                "volume": volume,
            }
            for one, volume in inspection.ballast
        ],
        "floating": [_convert_vessel(vessel) for vessel in inspection.vessels],
        "added_mass": {
            body: _convert(_read_fields(estimate))
            for body, estimate in inspection.added_mass.items()
        },
        "problems": list(inspection.problems),
    }


def _convert_geom(geom: GeomInspection) -> dict[str, Any]:
    """A geom, with its volume if it displaces, and with the faults of its mesh if it has one."""
    result: dict[str, Any] = {
        "name": geom.name,
        "body": geom.body,
        "kind": geom.kind,
        "displaces": geom.mesh is not None,
        "reason": geom.reason,
        "hull": "convex" if geom.convex else "mesh",
        "fill": geom.fill,
        "notes": list(geom.notes),
    }
    if geom.mesh is not None:
        result |= {
            "volume": geom.mesh.volume,
            "area": geom.mesh.area,
            "centroid": geom.mesh.centroid.tolist(),
            "triangles": len(geom.mesh.faces),
        }
    if geom.diagnosis is not None:
        holes = [dataclasses.asdict(hole) for hole in geom.diagnosis.holes]
        faults = _read_fields(geom.diagnosis, leave_out=("mesh", "holes", "name"))
        result["mesh"] = faults | {"holes": holes}
    return result


def _convert_foil(foil: PlacedFoil) -> dict[str, Any]:
    """A foil: its size, and how it lifts."""
    return {
        "name": foil.name,
        "span": foil.span,
        "chord": foil.chord,
        "area": foil.area,
        "aspect_ratio": _convert(foil.aspect_ratio),
        "lift_slope": foil.lift_slope,
        "stall": foil.stall,
    }


def _convert_vessel(inspection: VesselInspection) -> dict[str, Any]:
    """A vessel, its rest poses and its righting arms."""
    righting = None if inspection.righting is None else _convert(_read_fields(inspection.righting))
    known = not inspection.refused
    return {
        **_convert_budget(inspection.total, known=known),
        "lift": inspection.total.lift if known else None,
        "roots": list(inspection.root_names),
        "refused": list(inspection.refused),
        "sentence": inspection.sentence,
        "centre_of_gravity": _convert(inspection.centre_of_gravity),
        "centre_of_buoyancy": _convert(inspection.centre_of_buoyancy) if known else None,
        "bodies": [
            _convert_budget(budget, known=known) | {"gravity": budget.gravity}
            for budget in inspection.bodies
        ],
        "rest": None if inspection.rest is None else _convert_rest(inspection.rest),
        "rests": [_convert_rest(rest) for rest in inspection.rests],
        "righting": righting,
        "notes": list(inspection.notes),
    }


def _convert_budget(budget: BuoyancyBudget, *, known: bool) -> dict[str, Any]:
    """What a body weighs and displaces; None where that is not known."""
    return {
        "body": budget.body,
        "mass": budget.mass,
        "carried": budget.carried,
        "displaced": budget.displacement if known else None,
        "reserve": budget.reserve if known else None,
    }


def _convert_rest(rest: Equilibrium) -> dict[str, Any]:
    """A rest pose and its hydrostatics."""
    at = rest.hydrostatics
    hydrostatics = _read_fields(at) | {name: getattr(at, name) for name in _DERIVED}
    return {
        "qpos": _convert(rest.qpos),
        "stability": rest.stability,
        "eigenvalues": _convert(rest.eigenvalues),
        "energy": _convert(rest.energy),
        "hydrostatics": _convert(hydrostatics | {"natural_periods": at.natural_periods()}),
    }


def _read_fields(record: Any, leave_out: tuple[str, ...] = ()) -> dict[str, Any]:
    """Values of the fields of a dataclass, by name."""
    names = [field.name for field in dataclasses.fields(record)]
    return {name: getattr(record, name) for name in names if name not in leave_out}


def _convert(value: Any) -> Any:
    """A value as JSON knows it."""
    if isinstance(value, dict):
        return {name: _convert(one) for name, one in value.items()}
    if isinstance(value, np.ndarray):
        return _convert(value.tolist())
    if isinstance(value, list):
        return [_convert(one) for one in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
