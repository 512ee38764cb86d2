"""The methods that the studies compare, by the names of their columns; and the water."""

from buoyancy_mj.submersion.convex_hull import ConvexHull
from buoyancy_mj.submersion.exact import Exact
from buoyancy_mj.submersion.methods import Method
from buoyancy_mj.submersion.sections import Sections

DENSITY = 1000.0
"""Density of the water in all studies [kg/m^3]."""
SPECIFIC_WEIGHT = DENSITY * 9.81
"""Weight of a cubic metre of that water [N/m^3]."""

METHODS: dict[str, Method] = {
    "exact": Exact(),
    "convex hull": ConvexHull(),
    "convex hull with cuts": ConvexHull(cut=True, centroid="hull"),
    "sections": Sections(),
    "sections, Simpson": Sections(rule="simpson"),
}
"""All methods whose sections keep a vertical axis."""
BASIC_METHODS = {name: METHODS[name] for name in ("exact", "convex hull", "sections")}
"""The exact method and the two of the paper."""
FIXED_AXIS = Sections(axis=(0.0, 0.0, 1.0))
"""Sections along an axis that turns with the body."""
ALL_METHODS = METHODS | {"sections, axis of the body": FIXED_AXIS}
"""`METHODS`, and sections along an axis that turns with the body."""
