"""Beams of sound as compiled code knows them."""

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.engine import library
from buoyancy_mj.kernels.vehicle.sensors.echoes import Echoes
from buoyancy_mj.vehicle.sensors.kinds import Place


def make_echoes(
    place: Place, beams: NDArray[np.float64], nearest: float, farthest: float
) -> Echoes:
    """The beams of one sensor of one mjData.

    Rays pass all that hangs on the body at the root of the sensor's: its own vehicle. A sensor that
    is fixed to the world passes nothing.

    Args:
        place: where the sensor is.
        beams: directions (n, 3), site's axes.
        nearest: least range [m].
        farthest: greatest range [m].
    """
    model, count = place.model, len(beams)
    return Echoes(
        ray=library.symbol("mj_ray"),
        excluded=place.body if place.body > 0 else -1,
        root=int(model.body_rootid[place.body]),
        nearest=nearest,
        farthest=farthest,
        geom_bodies=model.geom_bodyid.copy(),
        roots=model.body_rootid.copy(),
        beams=beams,
        ways=np.zeros((count, 3)),
        ranges=np.zeros(count),
        met=np.zeros(count, np.int32),
        point=np.zeros(3),
        hit=np.zeros(1, np.int32),
    )
