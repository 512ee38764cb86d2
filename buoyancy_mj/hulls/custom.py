"""What a model's `<custom>` gives: texts by name, foils, and numerics 'QUANTITY:BODY' by body."""

import re
from collections.abc import Sequence
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import ModelError, choices
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.hulls.replicas import find_originals

QUANTITIES = ("added_mass", "linear_damping", "quadratic_damping", "radiation_damping")
"""Quantities of the numerics 'QUANTITY:BODY' by which a file states what it knows of a body."""


FOIL = "foil"
"""What the texts 'foil:NAME' begin with, by which a file states that a geom or a site is a foil."""


class FoilText(NamedTuple):
    """A text 'foil:NAME'."""

    name: str
    """Its name in the model, with what an attachment put around it."""
    target: str
    """The name of its geom or site in the model."""
    text: str
    """What it says."""


class BodyNumeric(NamedTuple):
    """A numeric 'QUANTITY:BODY'."""

    name: str
    """Its name in the model, with what an attachment put around it."""
    quantity: str
    """One of `QUANTITIES`."""
    body_name: str
    """The name of its body in the model."""
    bodies: tuple[int, ...]
    """Its body, or all copies that `<replicate>` made of it; none if there is no such body."""
    numbers: NDArray[np.float64]
    """Its numbers."""


def read_all_texts(model: mujoco.MjModel) -> dict[str, str]:
    """All texts of `<custom>` by name."""
    texts = {}
    for i in range(model.ntext):
        start = model.text_adr[i]
        data = bytes(model.text_data[start : start + model.text_size[i]])
        name = _name(model, mujoco.mjtObj.mjOBJ_TEXT, i)
        texts[name] = data.split(b"\0")[0].decode(errors="replace")
    return texts


def read_all_numerics(model: mujoco.MjModel) -> dict[str, NDArray[np.float64]]:
    """All numerics of `<custom>` by name."""
    numerics = {}
    for i in range(model.nnumeric):
        start = model.numeric_adr[i]
        numbers = np.array(model.numeric_data[start : start + model.numeric_size[i]])
        numerics[_name(model, mujoco.mjtObj.mjOBJ_NUMERIC, i)] = numbers
    return numerics


def read_tuple_names(model: mujoco.MjModel) -> list[str]:
    """The names of all tuples of `<custom>`."""
    return [_name(model, mujoco.mjtObj.mjOBJ_TUPLE, i) for i in range(model.ntuple)]


def split_quantity(name: str) -> tuple[str, str] | None:
    """The quantity of a name 'QUANTITY:BODY', and the name of its body; None of another name.

    What an attachment put around the name stands around that of the body too:
    'rov1_added_mass:hull' is given for the body 'rov1_hull'.
    """
    match = re.search(rf"({'|'.join(QUANTITIES)}):", name)
    return (match[1], name[: match.start()] + name[match.end() :]) if match else None


def split_foil(name: str) -> str | None:
    """The name of the geom or site of a name 'foil:NAME'; None of another name.

    What an attachment put around the name stands around that of the geom too, as for
    `split_quantity`.
    """
    before, found, after = name.partition(f"{FOIL}:")
    return before + after if found else None


def read_foil_texts(model: mujoco.MjModel) -> list[FoilText]:
    """All texts 'foil:NAME' of a model, whether there is such a geom or site or not."""
    return [
        FoilText(name, target, text)
        for name, text in read_all_texts(model).items()
        if (target := split_foil(name)) is not None
    ]


def read_body_numerics(model: mujoco.MjModel) -> list[BodyNumeric]:
    """All numerics 'QUANTITY:BODY' of a model, whether there is such a body or not."""
    names = {body_name(model, body): body for body in range(model.nbody)}
    copies = find_originals(names)
    body_numerics = []
    for name, numbers in read_all_numerics(model).items():
        if split := split_quantity(name):
            quantity, body = split
            copied = (i for full, i in names.items() if body in copies.get(full, ()))
            bodies = (names[body],) if body in names else tuple(copied)
            body_numerics.append(BodyNumeric(name, quantity, body, bodies, numbers))
    return body_numerics


def read_numerics(
    model: mujoco.MjModel, quantity: str, bodies: Sequence[int]
) -> dict[int, NDArray[np.float64]]:
    """The numbers of a quantity, such as 'added_mass', by the index of the body.

    `hulls.words.check_words` judges those that are given for none of `bodies`; here they are left
    out. What is given for a body by its own name wins over what is given for it as a copy.
    """
    numbers: dict[int, NDArray[np.float64]] = {}
    for numeric in sorted(read_body_numerics(model), key=lambda one: -len(one.bodies)):
        if numeric.quantity == quantity:
            numbers |= {body: numeric.numbers for body in numeric.bodies if body in bodies}
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
            f"which has no hull of its own; {choices(str(name), names)}"
        )
    return names[name]


def _name(model: mujoco.MjModel, kind: mujoco.mjtObj, index: int) -> str:
    """The name of a custom element."""
    return mujoco.mj_id2name(model, kind, index) or ""
