"""Runs of a scene, step by step: by any method, with any mass, with damping against the world."""

import dataclasses
from collections.abc import Iterator

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.kernels import clip
from buoyancy_mj.paper.methods import DENSITY
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.assembly import assemble
from buoyancy_mj.scenes.scene import Scene, read_scene
from buoyancy_mj.sea.water import Water
from buoyancy_mj.sea.waves import LevelOscillation, RegularWave
from buoyancy_mj.submersion.methods import Method

AMPLITUDE = 0.3
"""Amplitude of the paper's surface [m]."""
FREQUENCY = 0.5
"""Frequency of the paper's surface [Hz]."""
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
"""The surfaces on which bodies move, by name."""


@dataclasses.dataclass(frozen=True)
class Moment:
    """One step of a run."""

    time: float
    """Time at the beginning of the step [s]."""
    height: float
    """z of the centre of gravity [m]."""
    draft: float
    """Depth of the lowest point under the surface over the centre of gravity [m]."""
    force: float
    """Buoyancy [N]."""


def load_scene(name: str) -> Scene:
    """Load a scene that ships, by its name."""
    return read_scene(catalog.scenes()[name])


def run(
    scene: Scene, method: Method, mass: float | None = None, damping_rate: float = 0.0
) -> Iterator[Moment]:
    """Run a scene by a method, and yield each of its steps.

    Args:
        scene: what runs.
        method: that computes the submersion.
        mass: of the vehicle [kg], to which its inertia is scaled too; None keeps the model's.
        damping_rate: damping over mass, and over inertia [1/s], of all velocities of the vehicle's
            root relative to the world. Physics engines call it "linear damping".
    """
    for buoyancy, data, submersions in run_steps(scene, method, mass, damping_rate):
        # `data` holds the poses of the step's beginning and the time of its end
        time = float(data.time) - scene.timestep

        # the draft
        centre = buoyancy.centre_of_mass(data)
        level = float(buoyancy.water.elevation(centre[0], centre[1], time))
        lowest = min(
            float(
                (hull.mesh.vertices @ data.geom_xmat[hull.geom][6:]).min()
                + data.geom_xpos[hull.geom][2]
            )
            for hull in buoyancy.hulls
        )

        # the buoyancy
        force = scene.water.density * buoyancy.gravity * submersions[:, clip.VOLUME].sum()
        yield Moment(time, float(centre[2]), level - lowest, float(force))


def run_steps(
    scene: Scene, method: Method, mass: float | None = None, damping_rate: float = 0.0
) -> Iterator[tuple[Buoyancy, mujoco.MjData, NDArray[np.float64]]]:
    """Run a scene as `run` does, and yield the engine's state after each step.

    Yields:
        The water, the data with the poses of the step's beginning, and the submersions (h, 8) at
        these poses.
    """
    model, data, _ = assemble(scene)

    # another mass, and the inertia with it
    if mass is not None:
        factor = mass / model.body_mass.sum()
        model.body_mass *= factor
        model.body_inertia *= factor
        mujoco.mj_setConst(model, mujoco.MjData(model))

    # mass and inertia along and about the joint's axes
    model.dof_damping[:] = damping_rate * model.dof_M0

    # the callback in Python leaves the submersions in the method's results, the compiled one not
    buoyancy = Buoyancy(model, scene.water, damping=scene.damping, method=method)
    with buoyancy.installed(native=False):
        for _ in range(round(scene.duration / scene.timestep)):
            mujoco.mj_step(model, data)
            yield buoyancy, data, buoyancy.packed.results


def swing(heights: NDArray[np.float64], timestep: float) -> float:
    """Half the range of heights over the last period of the waves [m]."""
    return 0.5 * float(np.ptp(heights[-steps_per_period(timestep) :]))


def steps_per_period(timestep: float) -> int:
    """Number of steps in a period of the waves."""
    return round(1.0 / FREQUENCY / timestep)
