"""An `Inspection` as plain values for JSON."""

import dataclasses
import math
from typing import Any

import numpy as np

from buoyancy_mj.inspection.inspection import GeomInspection, Inspection, VesselInspection
from buoyancy_mj.statics.equilibrium import Equilibrium


def to_json(found: Inspection) -> dict[str, Any]:
    """The report as plain values for JSON: SI units, angles in radians, null for what is not a finite number."""
    return {
        "title": found.title,
        "water": {"density": found.water.density, "level": found.water.level},
        "geoms": [_plain_part(part) for part in found.geoms],
        "overlaps": [
            {"hulls": [one, two], "volume": _value(volume)} for one, two, volume in found.overlaps
        ],
        "floating": [_plain_floating(floating) for floating in found.vessels],
        "problems": list(found.problems),
    }


def _plain_part(part: GeomInspection) -> dict[str, Any]:
    mesh, found = part.mesh, part.diagnosis
    result: dict[str, Any] = {
        "name": part.name,
        "body": part.body,
        "kind": part.kind,
        "displaces": mesh is not None,
        "reason": part.reason,
        "hull": "convex" if part.convex else "mesh",
        "fill": part.fill,
        "notes": list(part.notes),
    }
    if mesh is not None:
        result |= {
            "volume": mesh.volume,
            "area": mesh.area,
            "centroid": mesh.centroid.tolist(),
            "triangles": len(mesh.faces),
        }
    if found is not None:
        fields = {
            field.name: getattr(found, field.name)
            for field in dataclasses.fields(found)
            if field.name not in ("mesh", "holes", "name")
        }
        result["mesh"] = fields | {"holes": [dataclasses.asdict(hole) for hole in found.holes]}
    return result


def _plain_floating(floating: VesselInspection) -> dict[str, Any]:
    total = floating.total
    return {
        "body": total.body,
        "sentence": floating.sentence,
        "mass": total.mass,
        "displaced": total.displacement,
        "reserve": total.reserve,
        "lift": total.lift,
        "centre_of_gravity": _value(floating.centre_of_gravity),
        "centre_of_buoyancy": _value(floating.centre_of_buoyancy),
        "bodies": [
            {
                "body": one.body,
                "mass": one.mass,
                "displaced": one.displacement,
                "gravity": one.gravity,
                "reserve": one.reserve,
            }
            for one in floating.bodies
        ],
        "rest": None if floating.rest is None else _plain_rest(floating.rest),
        "rests": [_plain_rest(one) for one in floating.rests],
        "righting": None
        if floating.righting is None
        else {
            name.name: _value(getattr(floating.righting, name.name))
            for name in dataclasses.fields(floating.righting)
        },
        "notes": list(floating.notes),
    }


def _plain_rest(found: Equilibrium) -> dict[str, Any]:
    at = found.hydrostatics
    names = [field.name for field in dataclasses.fields(at)]
    derived = (
        "displacement", "reserve", "draft", "KB", "KG", "BG", "BMt", "BMl", "KMt", "KMl", "GMt", "GMl", "GM",
    )  # fmt: skip
    return {
        "qpos": _value(found.qpos),
        "stability": found.stability,
        "eigenvalues": _value(found.eigenvalues),
        "energy": _value(found.energy),
        "hydrostatics": {name: _value(getattr(at, name)) for name in (*names, *derived)}
        | {"natural_periods": _value(at.natural_periods())},
    }


def _value(value: Any) -> Any:
    """Numbers as JSON knows them."""
    if isinstance(value, dict):
        return {name: _value(one) for name, one in value.items()}
    if isinstance(value, np.ndarray):
        return [_value(one) for one in value.tolist()]
    if isinstance(value, list):
        return [_value(one) for one in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
