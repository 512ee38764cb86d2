"""The studies by name: what is computed, and how it is drawn."""

from collections.abc import Mapping

from buoyancy_mj.errors import BuoyancyError
from buoyancy_mj.paper import cost, motion, statics
from buoyancy_mj.paper.study import Study

try:
    from buoyancy_mj.paper import figures
except ModuleNotFoundError as error:
    if error.name is None or not error.name.startswith("matplotlib"):
        raise
    raise BuoyancyError(
        "the figures of the reproduction need matplotlib, which is not installed: pip install 'buoyancy_mj[paper]'"
    ) from error

_ALL = (
    Study(
        "volume",
        "Submerged volume of the hourglass against dz",
        statics.volume,
        figures.volume,
        "The curve is an S, flat at the neck. A hull fills the neck once both bells are wet, and what it then adds is more "
        "than the hourglass itself. Without the cuts it also goes in steps, from one ring of vertices to the next.",
    ),
    Study(
        "force",
        "Buoyancy against submersion",
        motion.force,
        figures.force,
        "The dots of the upright drop lie on the curves: the force is that of the present pose.",
    ),
    Study(
        "areas",
        "Areas of cross-sections against z",
        statics.areas,
        figures.areas,
        "What the sections integrate.",
    ),
    Study(
        "distributed",
        "Forces distributed over the AUV's meshes",
        motion.distributed,
        figures.distributed,
        "At rest on still water, by the exact method; arrows start at the centroid of what is wet of each mesh.",
    ),
    Study(
        "cog",
        "Centre of gravity over 5 s, on still water and on waves",
        motion.cog,
        figures.cog,
        "The hull carries the hourglass, and the AUV all the more, too high out of the water.",
    ),
    Study(
        "tilt",
        "Error against tilt",
        statics.tilt,
        figures.tilt,
        "At the height at which each floats upright. A vertical axis stays right at every tilt; one that is fixed in the "
        "body does not, and errs by about what the paper says. The hull fills the neck, and the AUV's open frame and ducts.",
    ),
    Study(
        "density",
        "Error against the density of vertices",
        statics.density,
        figures.density,
        "At a draft of 0.6 of the height. Dense vertices take away what the hull lacks at the surface; what it fills of "
        "hollows stays. AUV: each of its meshes by itself, or all exported as one mesh.",
    ),
    Study(
        "oscillation",
        "What keeps the centre of gravity within 0.05 m on waves",
        motion.oscillation,
        figures.oscillation,
        "The hourglass, started with its base at the surface. A damping against the world, as a physics engine's linear "
        "damping is, holds a body still while the water moves past it. Water's drag takes it along.",
    ),
    Study(
        "rest",
        "Force at rest",
        motion.rest,
        figures.rest,
        "Last 2 s of a drop on still water (60 s; the AUV's hull 20 s). The volume of a hull of vertices jumps as vertices "
        "cross the surface, so that the body never comes to rest.",
    ),
    Study("approximations", "Simple shapes for the AUV", statics.approximations),
    Study("work", "Iterations and vertex checks", cost.work),
    Study("timing", "Wall time of an update", cost.timing),
)
STUDIES: Mapping[str, Study] = {study.name: study for study in _ALL}
"""The studies by name, in the order in which they run."""
