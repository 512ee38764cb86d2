"""Equal geoms of an `Inspection` as one: eight thrusters are a line, not eight."""

import re
from collections.abc import Sequence
from typing import NamedTuple

import mujoco
import numpy as np

from buoyancy_mj.inspection.geoms import GeomInspection
from buoyancy_mj.inspection.inspection import Inspection


class GeomGroup(NamedTuple):
    """Geoms of one body that displace the same."""

    name: str
    """What they are called together: 'keel', '8 thrusters', '2 x foam'."""
    geoms: tuple[GeomInspection, ...]
    """Which they are."""
    volume: float
    """Volume that each displaces, on the mean [m^3]."""
    total: float
    """Volume that they displace together, if none is in another [m^3]."""


def group_geoms(inspection: Inspection) -> list[GeomGroup]:
    """Group the geoms that displace water, greatest volume first."""
    thrusters = _find_thrusters(inspection)
    alike: dict[tuple[object, ...], list[GeomInspection]] = {}
    for geom in inspection.geoms:
        if geom.mesh is None:
            continue
        volume, area = (float(f"{value:.3g}") for value in (geom.mesh.volume, geom.mesh.area))
        key = geom.body, geom.kind, geom.convex, geom.fill, volume, area, geom.name in thrusters
        alike.setdefault(key, []).append(geom)
    groups = []
    for geoms in alike.values():
        name = _name_group([one.name for one in geoms], thrusting=geoms[0].name in thrusters)
        total = sum(one.fill * one.mesh.volume for one in geoms if one.mesh is not None)
        groups.append(GeomGroup(name, tuple(geoms), total / len(geoms), total))
    return sorted(groups, key=lambda group: -group.total)


def _name_group(names: Sequence[str], *, thrusting: bool) -> str:
    """What geoms are called together."""
    if len(names) == 1:
        return names[0]
    if thrusting:
        return f"{len(names)} thrusters"
    first, *others = (re.split(r"[_ ]", name) for name in names)
    common = [word for word in first if all(word in words for words in others)]
    if common:
        return f"{len(names)} x {' '.join(common)}"
    return f"{names[0]} and {len(names) - 1} more"


def _find_thrusters(inspection: Inspection) -> set[str]:
    """Names of the geoms that stand where an actuator pushes at a site."""
    if not inspection.vessels:
        return set()
    model = inspection.vessels[0].vessel.model
    found = set()
    for actuator in np.flatnonzero(model.actuator_trntype == mujoco.mjtTrn.mjTRN_SITE):
        site = model.actuator_trnid[actuator, 0]
        near = np.linalg.norm(model.geom_pos - model.site_pos[site], axis=1)
        near[model.geom_bodyid != model.site_bodyid[site]] = np.inf
        geom = int(np.argmin(near))
        if near[geom] < model.geom_rbound[geom]:
            found.add(inspection.geoms[geom].name)
    return found
