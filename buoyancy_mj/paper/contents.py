"""The studies in their order: names, titles, captions, what computes them and what draws them."""

from collections.abc import Mapping

from buoyancy_mj.errors import BuoyancyError
from buoyancy_mj.paper.studies import accuracy, cost, forces, motion, volumes
from buoyancy_mj.paper.study import Study

try:
    from buoyancy_mj.paper.figures.accuracy import draw_density, draw_tilt
    from buoyancy_mj.paper.figures.forces import draw_distributed, draw_force, draw_rest
    from buoyancy_mj.paper.figures.motion import draw_cog, draw_oscillation
    from buoyancy_mj.paper.figures.volumes import draw_areas, draw_volume
except ModuleNotFoundError as error:
    if error.name is None or not error.name.startswith("matplotlib"):
        raise
    raise BuoyancyError(
        "the figures of the reproduction need matplotlib, which is not installed: "
        "pip install 'buoyancy_mj[charts]'"
    ) from error

_ALL = (
    Study(
        "volume",
        "Submerged volume of the hourglass against dz",
        volumes.measure_volume,
        draw_volume,
        "The curve is an S, flat at the neck. A hull fills the neck once both bells are wet, and "
        "then adds more than the hourglass itself has. Without the cuts its volume also grows in "
        "steps, from one ring of vertices to the next.",
    ),
    Study(
        "force",
        "Buoyancy against submersion",
        forces.measure_force,
        draw_force,
        "The dots of the upright drop lie on the curves: the force is that of the present pose.",
    ),
    Study(
        "areas",
        "Areas of cross-sections against z",
        volumes.measure_areas,
        draw_areas,
        "The method of sections integrates these areas.",
    ),
    Study(
        "distributed",
        "Forces distributed over the AUV's meshes",
        forces.measure_distributed,
        draw_distributed,
        "The AUV rests on still water, by the exact method. Each arrow starts at the centroid of "
        "the wet part of a mesh.",
    ),
    Study(
        "cog",
        "Centre of gravity over 5 s, on still water and on waves",
        motion.measure_cog,
        draw_cog,
        "The hull method lets the hourglass float too high, and the AUV even more so.",
    ),
    Study(
        "tilt",
        "Error against tilt",
        accuracy.measure_tilt,
        draw_tilt,
        "Each body keeps the height at which it floats upright. Sections along a vertical axis "
        "stay right at every tilt. Sections along an axis that is fixed in the body do not, and "
        "err by about what the paper says. The hull fills the neck, and the AUV's open frame and "
        "ducts.",
    ),
    Study(
        "density",
        "Error against the density of vertices",
        accuracy.measure_density,
        draw_density,
        "Each body has a draft of 0.6 of its height. Dense vertices remove what the hull lacks at "
        "the surface, but not what it adds in hollows. The AUV's meshes are taken one by one, or "
        "exported as one mesh.",
    ),
    Study(
        "oscillation",
        "What keeps the centre of gravity within 0.05 m on waves",
        motion.measure_oscillation,
        draw_oscillation,
        "The hourglass starts with its base at the surface. Damping against the world, which is "
        "what a physics engine's linear damping is, holds a body still while the water moves past "
        "it. The drag of water takes the body along.",
    ),
    Study(
        "rest",
        "Force at rest",
        forces.measure_rest,
        draw_rest,
        "The curves show the last 2 s of a drop on still water (60 s; 20 s for the AUV's hull). "
        "The volume of a hull of vertices jumps as vertices cross the surface, so the body never "
        "comes to rest.",
    ),
    Study("approximations", "Simple shapes for the AUV", volumes.measure_approximations),
    Study("work", "Iterations and vertex checks", cost.measure_work),
    Study("timing", "Wall time of an update", cost.measure_timing),
)
STUDIES: Mapping[str, Study] = {study.name: study for study in _ALL}
"""The studies by name, in the order in which they run."""
