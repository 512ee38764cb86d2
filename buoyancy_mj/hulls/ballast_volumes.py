"""What the ballast of a model holds, as a user states it."""

from collections.abc import Mapping, Sequence

import mujoco
from numpy.typing import ArrayLike

from buoyancy_mj.errors import ModelError, choices, describe
from buoyancy_mj.hulls.placed_ballasts import ROUNDING, PlacedBallast
from buoyancy_mj.values import read_array, read_number


def read_volumes(
    model: mujoco.MjModel,
    placed: Sequence[PlacedBallast],
    ballast: Mapping[str, float] | ArrayLike | None,
) -> list[float]:
    """What all ballast of a model holds [m^3], in its order.

    Args:
        model: any model.
        placed: its ballast.
        ballast: volumes [m^3] by name, others being empty; or the states of actuators (na,), as
            `data.act` has them; None for empty.

    Raises:
        ModelError: an unknown name, a volume beyond the capacity, or another number of states.
    """
    if isinstance(ballast, Mapping):
        names = [one.name for one in placed]
        for name in ballast:
            if name not in names:
                raise ModelError(
                    f"the model has no ballast {describe(name)}; {choices(name, names)}"
                )
        volumes = [ballast.get(one.name, 0.0) for one in placed]
    elif ballast is not None:
        states = read_array(ModelError, "ballast", ballast, (model.na,))
        volumes = [float(states[one.state]) for one in placed]
    else:
        volumes = [0.0] * len(placed)
    return [
        min(
            read_number(
                ModelError,
                f"the volume of ballast '{one.name}'",
                volume,
                least=0.0,
                most=(1.0 + ROUNDING) * one.capacity,
            ),
            one.capacity,
        )
        for one, volume in zip(placed, volumes, strict=True)
    ]
