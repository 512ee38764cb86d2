"""`BallastItem`: one thing added to a vessel; and the vessel with it."""

import dataclasses
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.meshes import shapes
from buoyancy_mj.statics.ballast_program import NEGLIGIBLE
from buoyancy_mj.statics.ballast_sites import BallastSite
from buoyancy_mj.statics.vessel import Vessel, VesselHull
from buoyancy_mj.statics.weights import Weight, add_weights


@dataclasses.dataclass(frozen=True, eq=False)
class BallastItem:
    """One thing added to a vessel, as a ball."""

    kind: str
    """'ballast' or 'foam'."""
    name: str
    """Name of its site, or 'box'."""
    position: NDArray[np.float64]
    """Middle of the ball in the frame of the root body (3,) [m], the joints as they were."""
    mass: float
    """Mass [kg]."""
    density: float
    """Density [kg/m^3]."""
    displaces: bool
    """Whether it lies outside of the hulls, where it displaces water of its own."""

    @property
    def label(self) -> str:
        """Name of its body."""
        return self.name if self.name.startswith(self.kind) else f"{self.kind}_{self.name}"

    @property
    def radius(self) -> float:
        """Radius of the ball [m]."""
        return float((self.mass / self.density * 0.75 / math.pi) ** (1.0 / 3.0))

    @property
    def inertia(self) -> float:
        """Inertia of the ball about its middle [kg m^2]."""
        return 0.4 * self.mass * self.radius**2


def merge_sites(
    vessel: Vessel, sites: Sequence[BallastSite], masses: NDArray[np.float64]
) -> tuple[BallastItem, ...]:
    """Merge masses (n,) [kg] at sites (n) into one item for each site or box, at their centre."""
    items = []
    for kind, name in dict.fromkeys((site.kind, site.name) for site in sites):
        shares = [
            (site, mass)
            for site, mass in zip(sites, masses, strict=True)
            if (site.kind, site.name) == (kind, name)
        ]
        mass = sum(share for _, share in shares)
        if mass > NEGLIGIBLE * vessel.whole_mass:
            middle = sum((share / mass * site.point for site, share in shares), np.zeros(3))
            first, _ = shares[0]
            position = middle + vessel.centre_of_gravity
            items.append(
                BallastItem(kind, name, position, float(mass), first.density, first.displaces)
            )
    return tuple(items)


def add_items(vessel: Vessel, items: Sequence[BallastItem]) -> Vessel:
    """A copy of a vessel with things added to it."""
    points = [item.position - vessel.centre_of_gravity for item in items]
    pairs = list(zip(items, points, strict=True))
    shift, heavy = add_weights(
        vessel, [Weight(item.mass, point, item.inertia * np.eye(3)) for item, point in pairs]
    )

    # the balls that displace
    balls = [
        VesselHull(item.label, shapes.sphere(item.radius), point - shift, np.eye(3), 1.0)
        for item, point in pairs
        if item.displaces
    ]
    return dataclasses.replace(heavy, hulls=(*heavy.hulls, *balls))
