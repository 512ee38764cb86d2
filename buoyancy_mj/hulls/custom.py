"""What a model's `<custom>` gives: texts by name, and numerics 'QUANTITY:BODY' by body."""

from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import ModelError, choices
from buoyancy_mj.hulls.names import body_name


def read_texts(model: mujoco.MjModel, name: str) -> list[str]:
    """The texts of a name; several where vehicles were attached under a prefix, 'PREFIX/NAME'."""
    texts = []
    for i in range(model.ntext):
        full_name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_TEXT, i) or ""
        if full_name.rsplit("/", 1)[-1] == name:
            start = model.text_adr[i]
            data = bytes(model.text_data[start : start + model.text_size[i]])
            texts.append(data.split(b"\0")[0].decode())
    return texts


def read_numerics(
    model: mujoco.MjModel, quantity: str, bodies: Sequence[int]
) -> dict[int, NDArray[np.float64]]:
    """The numbers of a quantity, such as 'added_mass', by the index of the body.

    Raises:
        ModelError: the body of a numeric is none of `bodies`.
    """
    numbers = {}
    for i in range(model.nnumeric):
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_NUMERIC, i) or ""
        if name.startswith(f"{quantity}:"):
            body = find_body(model, name.removeprefix(f"{quantity}:"), bodies, quantity)
            start = model.numeric_adr[i]
            numbers[body] = np.array(model.numeric_data[start : start + model.numeric_size[i]])
    return numbers


def find_body(model: mujoco.MjModel, name: str, bodies: Sequence[int], quantity: str) -> int:
    """The index of a body by its name; `quantity` says in the message what is given for it.

    Raises:
        ModelError: it is none of `bodies`.
    """
    names = {body_name(model, body): body for body in bodies}
    if name not in names:
        raise ModelError(
            f"{quantity.replace('_', ' ')} is given for body '{name}', "
            f"which has no hull of its own; {choices(name, names)}"
        )
    return names[name]
