"""The haze of water in a scene of Filament, on while the camera is under water."""

import functools
import math
from typing import Any

import mujoco

from buoyancy_mj.drawing.looks import Look, to_linear
from buoyancy_mj.drawing.sea_mesh import HORIZON

SEEN = 0.05
"""How much still shows through the haze at the visibility."""


def set_haze(scene: Any, look: Look, visibility: float | None) -> None:
    """Fill a scene with haze, or clear it.

    Filament takes its options from numbers in the <custom> of a model: here, of one that has
    nothing else.

    Args:
        scene: an `mjrf.Scene`.
        look: its colour.
        visibility: distance at which the haze hides all but a twentieth [m]; None for none.
    """
    scene.configure_from_model(_haze_model(look, visibility))


@functools.lru_cache(maxsize=8)
def _haze_model(look: Look, visibility: float | None) -> mujoco.MjModel:
    """A model that holds options of Filament alone."""
    spec = mujoco.MjSpec()
    spec.add_numeric(name="filament.fog.enabled", data=[float(visibility is not None)])
    if visibility is not None:
        # the light that is left after x metres is e^(-density x)
        density = -math.log(SEEN) / visibility
        spec.add_numeric(name="filament.fog.density", data=[density])
        spec.add_numeric(name="filament.fog.color", data=to_linear(look.haze))
        spec.add_numeric(name="filament.fog.distance", data=[0.0])
        spec.add_numeric(name="filament.fog.maximum_opacity", data=[1.0])
        # not over the sky, which shows the depths there
        spec.add_numeric(name="filament.fog.cut_off_distance", data=[1.1 * HORIZON])
        # the same at every height
        spec.add_numeric(name="filament.fog.height_falloff", data=[0.0])
    return spec.compile()
