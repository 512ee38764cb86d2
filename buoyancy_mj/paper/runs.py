"""Runs of a scene, step by step, for the studies: by any method, with any mass, with a damping against the world."""

import dataclasses
from collections.abc import Iterator

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.kernels import clip
from buoyancy_mj.paper.statics import DENSITY
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.assembly import assemble
from buoyancy_mj.scenes.scene import Scene, read_scene
from buoyancy_mj.sea.water import Water
from buoyancy_mj.sea.waves import LevelOscillation, RegularWave
from buoyancy_mj.submersion.methods import Method

AMPLITUDE, FREQUENCY = 0.3, 0.5
"""The paper's surface: +-0.3 m at 0.5 Hz."""
SURFACES = {
    "still": Water(density=DENSITY),
    # both begin at the mean level, going up
    "moving level": Water(
        density=DENSITY, waves=LevelOscillation(AMPLITUDE, FREQUENCY, phase=np.pi / 2.0)
    ),
    "travelling wave": Water(
        density=DENSITY, waves=RegularWave(AMPLITUDE, frequency=FREQUENCY, phase=np.pi / 2.0)
    ),
}


@dataclasses.dataclass(frozen=True)
class Moment:
    """One step of a run."""

    time: float
    """[s]."""
    height: float
    """z of the centre of gravity [m]."""
    draft: float
    """Depth of the lowest point under the surface over the centre of gravity [m]."""
    force: float
    """Buoyancy [N]."""


def run(
    scene: Scene, method: Method, mass: float | None = None, rate: float = 0.0
) -> Iterator[Moment]:
    """Steps of a scene by a method.

    Args:
        scene: what runs.
        method: how the submersion is found.
        mass: of the vehicle [kg], its inertia scaled along; None for its own.
        rate: damping [1/s] of all velocities of its root relative to the world, per mass and inertia, as
            physics engines have it ("linear damping").
    """
    for buoyancy, data, wet in steps(scene, method, mass, rate):
        now = float(data.time) - scene.timestep
        centre = buoyancy.centre_of_mass(data)
        level = float(scene.water.elevation(centre[0], centre[1], now))
        heights = [
            h.mesh.vertices @ data.geom_xmat[h.geom][6:] + data.geom_xpos[h.geom][2]
            for h in buoyancy.hulls
        ]
        force = scene.water.density * buoyancy.gravity * wet[:, clip.VOLUME].sum()
        yield Moment(
            now, float(centre[2]), level - min(float(z.min()) for z in heights), float(force)
        )


def steps(
    scene: Scene, method: Method, mass: float | None = None, rate: float = 0.0
) -> Iterator[tuple[Buoyancy, mujoco.MjData, NDArray[np.float64]]]:
    """Each step of a scene: the water, the data with the poses of its beginning, and what was wet then (h, 6)."""
    model, data, _ = assemble(scene)
    if mass is not None:
        factor = mass / model.body_mass.sum()
        model.body_mass *= factor
        model.body_inertia *= factor
        mujoco.mj_setConst(model, mujoco.MjData(model))
    # mass and inertia along and about the joint's axes
    model.dof_damping[:] = rate * model.dof_M0
    buoyancy = Buoyancy(model, scene.water, damping=scene.damping, method=method)
    # in Python, which leaves what was wet in the method's own results
    with buoyancy.installed(native=False):
        for _ in range(round(scene.duration / scene.timestep)):
            mujoco.mj_step(model, data)
            yield buoyancy, data, buoyancy.packed.results


def swing(heights: NDArray[np.float64], timestep: float) -> float:
    """Half the range of heights over the last period of the waves [m]."""
    last = heights[-round(1.0 / FREQUENCY / timestep) :]
    return 0.5 * float(np.ptp(last))


def scene_of(name: str) -> Scene:
    """A scene that ships."""
    return read_scene(catalog.scenes()[name])
