"""Many vessels in one sea: how fast they are stepped in one model, on one thread and on several."""

import mujoco
import numpy as np
import trimesh
from numpy.typing import NDArray

from buoyancy_mj import JonswapSea, Settings, Water, add_water

Results = dict[str, dict[str, float]]
"""Values by number of threads, and of the engine alone."""
VESSELS, WAVES = 500, 260
"""Vessels of the fleet, and components of its sea."""
TIMESTEP = 0.02
"""[s]."""
BERTH = 15.0
"""Distance between vessels [m]."""
DENSITY = 1025.0
"""Of the water [kg/m^3]."""


def make_fleet(vessels: int, threads: int = 1, *, with_water: bool = True) -> mujoco.MjModel:
    """Compile a model of different free vessels of 480 triangles each, in rows, without contacts.

    Args:
        vessels: how many.
        threads: on which the water works.
        with_water: whether there is any.
    """
    spec = mujoco.MjSpec()
    spec.option.timestep = TIMESTEP
    random = np.random.default_rng(1)
    side = int(np.ceil(np.sqrt(vessels)))
    for n in range(vessels):
        _add_vessel(spec, n, BERTH * np.array([n // side, n % side, 0.0]), random)
    if with_water:
        sea = JonswapSea(1.0, 6.0, components=WAVES, spreading=10.0, seed=1)
        water = Water(density=DENSITY, waves=sea)
        add_water(spec, Settings(water=water, added_mass="ellipsoid", threads=threads))
    return spec.compile()


def _add_vessel(
    spec: mujoco.MjSpec, n: int, place: NDArray[np.float64], random: np.random.Generator
) -> None:
    """Add an ellipsoid under a flat deck, of its own size, to float at its greatest breadth."""
    length, breadth, depth = random.uniform((4.0, 1.5, 0.8), (8.0, 2.5, 1.2))
    ball = trimesh.creation.uv_sphere(radius=1.0, count=[12, 12])
    vertices = ball.vertices * [0.5 * length, 0.5 * breadth, depth]
    vertices[:, 2] = np.minimum(vertices[:, 2], 0.5 * depth)
    spec.add_mesh(
        name=f"hull {n}", uservert=vertices.ravel(), userface=ball.faces.ravel(), inertia=_INERTIA
    )
    heading = random.uniform(0.0, 2.0 * np.pi)
    mass = DENSITY * np.pi / 3.0 * length * breadth * depth / 2.0
    body = spec.worldbody.add_body(
        name=f"vessel {n}",
        pos=place,
        quat=[np.cos(heading / 2.0), 0.0, 0.0, np.sin(heading / 2.0)],
        mass=mass,
        ipos=[0.0, 0.0, -0.3 * depth],
        inertia=mass / 12.0 * np.array([breadth**2, length**2, length**2]),
        explicitinertial=True,
    )
    body.add_freejoint()
    body.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=f"hull {n}", contype=0, conaffinity=0)


_INERTIA = mujoco.mjtMeshInertia.mjMESH_INERTIA_EXACT
