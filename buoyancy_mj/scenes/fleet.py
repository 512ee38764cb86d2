"""`Vehicle`: what floats by itself in a scene, with its hulls and what it weighs and displaces."""

import dataclasses
import functools
import warnings
from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.errors import BuoyancyWarning, ModelError
from buoyancy_mj.hulls.bodies import group_floating_bodies
from buoyancy_mj.hulls.gravity import find_weighing_masses, read_gravity
from buoyancy_mj.hulls.hull import Hull
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.scenes.parts import Afloat
from buoyancy_mj.statics.vessel import PLAUSIBLE


@dataclasses.dataclass(frozen=True, eq=False)
class Vehicle:
    """Bodies that float together, with what they carry; surroundings are none of them."""

    name: str
    """Name of the vehicle: that of its file or of its entry in the scene; that of its root body
    where several float in one file."""
    bodies: NDArray[np.int64]
    """Indices of its bodies, the root body first."""
    hulls: tuple[Hull, ...]
    """Its hulls."""
    rows: NDArray[np.int64]
    """Indices of its hulls among all that the water has, `Buoyancy.hulls`."""
    masses: NDArray[np.float64]
    """Mass of each of its bodies [kg]."""
    weighing_masses: NDArray[np.float64]
    """Mass of each of its bodies [kg], less what gravity compensation carries."""
    gravity: float
    """Downward acceleration [m/s^2]."""
    displacement: float
    """Mass of water that its hulls displace when fully under water [kg]."""

    @property
    def root(self) -> int:
        """Index of its root body."""
        return int(self.bodies[0])

    @functools.cached_property
    def mass(self) -> float:
        """Mass of all its bodies [kg]."""
        return float(self.masses.sum())

    @property
    def weight(self) -> float:
        """Weight of all its bodies [N], less what gravity compensation carries."""
        return float(self.weighing_masses.sum()) * self.gravity

    @property
    def length(self) -> float:
        """Length [m] of what holds all its hulls, about the root body's origin."""
        reach = max(float(np.linalg.norm(hull.position)) + hull.mesh.radius for hull in self.hulls)
        return 2.0 * reach

    def centre_of_mass(self, data: mujoco.MjData) -> NDArray[np.float64]:
        """Centre of mass (3,) [m], world frame."""
        centre: NDArray[np.float64] = self.masses @ data.xipos[self.bodies] / self.mass
        return centre


def build_vehicles(
    model: mujoco.MjModel, buoyancy: Buoyancy, afloat: Sequence[Afloat]
) -> dict[str, Vehicle]:
    """The vehicles of a scene by name, in the order of its model.

    Args:
        model: the model of the scene, with the masses that act.
        buoyancy: the water in which they are.
        afloat: what floats together.

    Raises:
        ModelError: a vehicle displaces no water, or absurdly much or little for its mass.
    """
    vehicles = {}
    for group in afloat:
        vehicle = vehicles[group.name] = _make_vehicle(model, buoyancy, group.name, group.bodies)
        subject = "the vehicle" if len(afloat) == 1 else f"vehicle '{group.name}'"
        _check_scale(vehicle, subject)
        _warn_of_compensation(vehicle, subject)
    _warn_of_second_drag(model, buoyancy, afloat)
    return vehicles


def find_vehicles(model: mujoco.MjModel, buoyancy: Buoyancy) -> dict[str, Vehicle]:
    """What floats in a model, by the names of root bodies, in the order of the model.

    Args:
        model: any model.
        buoyancy: the water in which it is.
    """
    wet = [hull.body for hull in buoyancy.hulls]
    return {
        body_name(model, int(bodies[0])): _make_vehicle(
            model, buoyancy, body_name(model, int(bodies[0])), bodies
        )
        for bodies in group_floating_bodies(model)
        if np.isin(bodies, wet).any()
    }


def _make_vehicle(
    model: mujoco.MjModel, buoyancy: Buoyancy, name: str, bodies: NDArray[np.int64]
) -> Vehicle:
    """The vehicle that bodies (n,) are, the root body first."""
    owners = np.array([hull.body for hull in buoyancy.hulls])
    rows = np.flatnonzero(np.isin(owners, bodies))
    hulls = tuple(buoyancy.hulls[row] for row in rows)
    return Vehicle(
        name=name,
        bodies=bodies,
        hulls=hulls,
        rows=rows,
        masses=model.body_mass[bodies],
        weighing_masses=find_weighing_masses(model)[bodies],
        gravity=read_gravity(model),
        displacement=float(buoyancy.water.density * sum(hull.displaced_volume for hull in hulls)),
    )


def _check_scale(vehicle: Vehicle, subject: str) -> None:
    """Refuse a slip of units, which gives a hull a thousand million times its volume."""
    lowest, highest = PLAUSIBLE
    if not lowest <= vehicle.displacement / vehicle.mass <= highest:
        raise ModelError(
            f"{subject} weighs {vehicle.mass:.4g} kg and would displace "
            f"{vehicle.displacement:.4g} kg of water; check the scale of its meshes "
            "(a mesh drawn in millimetres wants scale='0.001 0.001 0.001')"
        )


def _warn_of_second_drag(
    model: mujoco.MjModel, buoyancy: Buoyancy, afloat: Sequence[Afloat]
) -> None:
    """Warn of a model that sets MuJoCo's own fluid, whose drag adds to the scene's."""
    density = model.opt.density
    viscosity = model.opt.viscosity
    if buoyancy.settings.damping is None or not (density > 0.0 or viscosity > 0.0):
        return

    # the options of the first file hold for all
    subject = afloat[0].part.subject
    option = f"density='{density:g}'" if density > 0.0 else f"viscosity='{viscosity:g}'"
    warnings.warn(
        f"{subject} sets <option {option}>: MuJoCo's own fluid drag acts as well as ours; "
        "leave one out (damping = false in the scene)",
        BuoyancyWarning,
        stacklevel=4,
    )


def _warn_of_compensation(vehicle: Vehicle, subject: str) -> None:
    """Tell of gravity compensation, which lifts a vehicle as well as the water does."""
    carried = float((vehicle.masses - vehicle.weighing_masses).sum())
    if carried:
        warnings.warn(
            f"gravity compensation (gravcomp) carries {carried:.4g} kg of {subject}'s "
            f"{vehicle.mass:.4g} kg, and the water lifts it as well; the net weight counts both",
            BuoyancyWarning,
            stacklevel=4,
        )
