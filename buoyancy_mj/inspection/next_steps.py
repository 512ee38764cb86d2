"""What to do next with a model that was inspected."""

import shlex
from collections.abc import Sequence

from buoyancy_mj.inspection.inspection import Inspection
from buoyancy_mj.inspection.vessels import VesselInspection
from buoyancy_mj.statics.vessel import Vessel

DIVER = 0.2
"""Reserve over mass up to which a vehicle looks as if it were to dive."""


def list_next_steps(
    inspection: Inspection, model: str, water: Sequence[str] = (), *, details: bool
) -> list[tuple[str, str]]:
    """List what may come next: what for, and a command or what to change.

    Args:
        inspection: what was found.
        model: the model as the command line has it.
        water: the still water, likewise.
        details: whether the report has its details already.
    """
    name = shlex.quote(model)
    in_water = "".join(f" --water {shlex.quote(setting)}" for setting in water)
    steps = []
    repaired = [geom for geom in inspection.geoms if geom.diagnosis and geom.diagnosis.repaired]
    if any(geom.displaces and geom.mesh is None for geom in inspection.geoms):
        hull = f"buoyancy-mj inspect {name} --hull convex"
        steps.append(("close the mesh that is refused, or try its convex hull", hull))
    elif repaired:
        mend = f"buoyancy-mj inspect {name} --repair mended/{inspection.title}.xml"
        steps.append(("write the model with its meshes mended", mend))
    if len(inspection.vessels) == 1 and not inspection.vessels[0].refused:
        steps += _list_trials(inspection.vessels[0], name, in_water)
    if not details:
        steps.append(("all geoms, meshes and rest poses", f"buoyancy-mj inspect {name} --details"))
    steps.append(("plots and a report", f"buoyancy-mj inspect {name} --plot {inspection.title}"))
    return steps


def _list_trials(inspection: VesselInspection, name: str, in_water: str) -> list[tuple[str, str]]:
    """What may be tried with a vessel; `in_water` are the flags of its water."""
    vessel = inspection.vessel
    if vessel.tether is not None:
        return [("let it float", f"give body '{vessel.tether.body}' a free joint")]
    if inspection.sentence.startswith("sinks"):
        litres = -1e3 * vessel.reserve / vessel.water.density
        wanted = f"take out {-vessel.reserve:.3g} kg, or add {litres:.3g} l that displace water"
        return [("make it hover", wanted)]
    steps = [("run it in waves", f"buoyancy-mj run auv_waves --vehicle {name}")]
    if 0.0 < vessel.reserve < DIVER * vessel.mass:
        hover = f"buoyancy-mj ballast {name} --reserve 0 --box {_find_keel_box(vessel)}{in_water}"
        steps.append(("make it hover", hover))
    return steps


def _find_keel_box(vessel: Vessel) -> str:
    """Two corners of the lower half of a vessel, without its rim, in the frame of its root body."""
    points = vessel.points + vessel.centre_of_gravity
    low, high = points.min(axis=0), points.max(axis=0)
    middle, half = 0.5 * (low + high), 0.25 * (high - low)
    corners = [*(middle - half), *(middle + half)]
    corners[5] = middle[2]
    return " ".join(f"{value:.2g}" for value in corners)
