"""Sentences on a vessel: whether it floats, and what looks like a slip in its model."""

import math

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


def write_sentence(vessel: Vessel, rest: Equilibrium | None) -> str:
    """Write whether a vessel floats, and how.

    Args:
        vessel: the vessel where the model has it.
        rest: where it comes to rest; None if that is not known.
    """
    reserve = vessel.reserve
    tolerance = NEUTRAL * vessel.mass
    if reserve < -tolerance:
        return f"sinks: {-reserve:.3g} kg too heavy"
    if not vessel.free:
        return f"is held by its joints: free, it would float with {reserve:.3g} kg reserve"
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
    """List what looks like a slip in the masses or the sizes of a vessel."""
    doubts = []
    displacement = vessel.water.density * vessel.volume
    least, most = PLAUSIBLE
    if not least <= displacement / vessel.mass <= most:
        doubts.append(
            f"it weighs {vessel.mass:.4g} kg and would displace {displacement:.4g} kg of water; "
            "check the scale of its meshes "
            "(a mesh drawn in millimetres wants scale='0.001 0.001 0.001')"
        )
    if abs(vessel.mass - _STANDARD_DENSITY * vessel.volume) < 1e-3 * vessel.mass:
        doubts.append(
            f"it weighs just what {_STANDARD_DENSITY:g} kg/m^3 makes of its volume: MuJoCo's "
            "choice where a model states no mass; give its bodies <inertial>, or its geoms mass"
        )
    return doubts
