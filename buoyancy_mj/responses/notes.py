"""How responses were measured, in sentences."""

import math

from buoyancy_mj.responses import irregular, regular
from buoyancy_mj.responses.extremes import Sea
from buoyancy_mj.responses.plans import Plan
from buoyancy_mj.responses.stations import SOFTNESS
from buoyancy_mj.responses.subject import Subject

_PRESSURES = {
    "archimedes": "The pressure is that of still water under the waves ('archimedes'), right for "
    "long waves alone",
    "hydrostatic": "The pressure is that of the depth under the surface ('hydrostatic'), right for "
    "long waves alone",
    "froude-krylov": "The pressure is that of the undisturbed waves ('froude-krylov')",
}


def write_notes(plan: Plan, subject: Subject, sea: Sea | None) -> tuple[str, ...]:
    """The waves, the loads, and what holds the vehicle."""
    return (
        f"{_describe_waves(plan, sea)}.",
        f"{_describe_loads(plan, subject)}.",
        f"{_describe_hold(plan, subject, sea)}.",
    )


def _describe_waves(plan: Plan, sea: Sea | None) -> str:
    deep = "deep water" if math.isinf(plan.depth) else f"water {plan.depth:g} m deep"
    if sea is not None:
        return (
            f"Measured in an irregular sea of {sea.significant_height:.3g} m at "
            f"{sea.peak_period:.3g} s, {deep}, for {irregular.LENGTH:g} peak periods; "
            f"cross-spectra by Welch's method, in segments of {irregular.SEGMENT:g}"
        )
    low, high = plan.amplitudes.min(), plan.amplitudes.max()
    size = f"{low:.3g} m" if low == high else f"{low:.3g} to {high:.3g} m"
    return (
        f"Measured in regular waves of an amplitude of {size}, {deep}, until the first "
        f"harmonic over whole periods changes by less than {100.0 * regular.SETTLED:g} %"
    )


def _describe_loads(plan: Plan, subject: Subject) -> str:
    added = plan.scene.added_mass
    source = f"'{added}'" if isinstance(added, str) else "as given" if added else "none"
    pressure = _PRESSURES[plan.scene.pressure]
    causes = ", ".join(subject.simulation.buoyancy.causes)
    return f"{pressure}; added mass: {source}; what acts: {causes}"


def _describe_hold(plan: Plan, subject: Subject, sea: Sea | None) -> str:
    if subject.tether:
        return f"Nothing holds it but what its model says: {subject.tether}"
    if plan.scene.control:
        return "The scene's own controller holds it"
    what = "wave period" if sea is None else "peak period"
    return (
        f"A station holds place and heading by the mean of a {what}, so that it has no part in the "
        f"motions in waves; its own period is {SOFTNESS:g} times as long"
    )
