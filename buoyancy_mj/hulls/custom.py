"""What a model states of its bodies: numerics in `<custom>`, named 'QUANTITY:BODY'."""

from collections.abc import Mapping, Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import ModelError, choices
from buoyancy_mj.hulls.selection import body_name


def read_custom(
    model: mujoco.MjModel, quantity: str, bodies: Sequence[int]
) -> dict[int, NDArray[np.float64]]:
    """The numbers of a quantity, as 'added_mass', by the index of the body.

    Raises:
        ModelError: a body that is none of `bodies`.
    """
    found = {}
    for i in range(model.nnumeric):
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_NUMERIC, i) or ""
        if name.startswith(f"{quantity}:"):
            start = model.numeric_adr[i]
            values = np.array(model.numeric_data[start : start + model.numeric_size[i]])
            found[find_body(model, name.removeprefix(f"{quantity}:"), bodies, quantity)] = values
    return found


def find_body(model: mujoco.MjModel, name: str, bodies: Sequence[int], quantity: str) -> int:
    """Index of a body by its name.

    Raises:
        ModelError: it is none of `bodies`.
    """
    names: Mapping[str, int] = {body_name(model, body): body for body in bodies}
    if name not in names:
        raise ModelError(
            f"{quantity.replace('_', ' ')} is stated for body '{name}', which has no hull of its own; {choices(name, names)}"
        )
    return names[name]
