"""Sentences on a vessel: whether it floats, and what looks like a slip in its model."""

import math
from collections.abc import Sequence

from buoyancy_mj.hulls.tethers import list_springs
from buoyancy_mj.statics.balance import NEUTRAL, find_heave_balance
from buoyancy_mj.statics.equilibrium import Equilibrium, move_to_rest
from buoyancy_mj.statics.vessel import PLAUSIBLE, Vessel

LEVELLED = 1e-4
"""Fall of energy, over weight times radius, below which a vessel rests as drawn."""
_STANDARD_DENSITY = 1000.0
"""Density [kg/m^3] that MuJoCo gives to geoms without a mass."""
_LEAST_LEAN = 0.1
"""Angle of the vertical [degrees] below which a vessel counts as upright."""
_MOST_TURN = 5.0
"""Angle of the vertical [degrees] from its pose in the model from which on it has tipped over."""


def write_sentence(vessel: Vessel, rest: Equilibrium | None, refused: Sequence[str] = ()) -> str:
    """Write whether a vessel floats, and how.

    Args:
        vessel: the vessel where the model has it.
        rest: where it comes to rest; None if that is not known.
        refused: names of its geoms whose meshes are refused.
    """
    if refused:
        return f"not known before {join_names(refused)} can displace water, see the problems"
    reserve = vessel.reserve
    if not vessel.mass > 0.0:
        return (
            f"rises out of the water: {reserve * vessel.gravity:.3g} N lift it under water, "
            f"since gravity compensation carries {vessel.carried_mass:.4g} kg of its "
            f"{vessel.whole_mass:.4g} kg"
        )
    tolerance = NEUTRAL * vessel.mass
    sinks = reserve < -tolerance
    if vessel.tether is not None:
        fate = (
            f"sink, {-reserve:.3g} kg too heavy"
            if sinks
            else f"float with {reserve:.3g} kg reserve"
        )
        return f"body '{vessel.tether.body}' {vessel.tether.how}: free, it would {fate}"
    if sinks:
        return f"sinks: {-reserve:.3g} kg too heavy"
    if rest is None:
        return f"floats: {reserve:.3g} kg reserve, but no rest pose was found"
    at = rest.hydrostatics
    if reserve <= tolerance:
        return f"hovers: neutral, BG {at.BG:.3g} m"
    return (
        f"floats: {reserve:.3g} kg reserve, draft {at.draft:.3g} m, {rest.stability}, "
        f"GM {at.GM:.3g} m{_describe_lean(vessel, rest)}"
    )


def _describe_lean(vessel: Vessel, rest: Equilibrium) -> str:
    """Heel and trim at rest where the vessel leans, and whether it tips over on the way there."""
    # a ball rests as well in its pose in the model
    fall = find_heave_balance(vessel, vessel.rotation).energy - rest.energy
    if fall < LEVELLED * vessel.weight * vessel.radius:
        return ""

    heel, trim = rest.hydrostatics.heel, rest.hydrostatics.trim
    upright = max(-1.0, min(1.0, math.cos(heel) * math.cos(trim)))
    words = ""
    if math.degrees(math.acos(upright)) > _LEAST_LEAN:
        degrees = [round(math.degrees(angle), 1) + 0.0 for angle in (heel, trim)]
        words = f", heel {degrees[0]:.1f}, trim {degrees[1]:.1f} degrees"

    turn = vessel.rotation[2] @ move_to_rest(vessel, rest).rotation[2]
    if turn <= math.cos(math.radians(_MOST_TURN)):
        words += ", not as drawn"
    return words


def list_doubts(vessel: Vessel) -> list[str]:
    """List what looks like a slip in a vessel, or counts in its statics unseen."""
    doubts = []
    if vessel.mass > 0.0 and vessel.carried_mass:
        doubts.append(
            f"gravity compensation (gravcomp) carries {vessel.carried_mass:.4g} kg of its "
            f"{vessel.whole_mass:.4g} kg: reserve, draft and metacentric heights are those of the "
            "rest, and CG is where that weighs"
        )
    if vessel.freedoms:
        doubts.append(
            f"its connects leave it {vessel.freedoms} ways to move within itself; "
            "statics hold it in the shape in which the model draws it"
        )
    springs = list_springs(vessel.model, vessel.bodies)
    if springs:
        doubts.append(
            f"{' and '.join(springs)} may pull at it in a run; its statics leave that out"
        )

    # units, and masses that nobody stated
    displacement = vessel.water.density * vessel.volume
    least, most = PLAUSIBLE
    if not least <= displacement / vessel.whole_mass <= most:
        doubts.append(
            f"it weighs {vessel.whole_mass:.4g} kg and would displace {displacement:.4g} kg of "
            "water; check the scale of its meshes "
            "(a mesh drawn in millimetres wants scale='0.001 0.001 0.001')"
        )
    if abs(vessel.whole_mass - _STANDARD_DENSITY * vessel.volume) < 1e-3 * vessel.whole_mass:
        doubts.append(
            f"it weighs just what {_STANDARD_DENSITY:g} kg/m^3 makes of its volume: MuJoCo's "
            "choice where a model states no mass; give its bodies <inertial>, or its geoms mass"
        )
    return doubts


def join_names(names: Sequence[str]) -> str:
    """Quoted names as a sentence lists them."""
    quoted = [f"'{name}'" for name in names]
    return quoted[0] if len(quoted) == 1 else f"{', '.join(quoted[:-1])} and {quoted[-1]}"
