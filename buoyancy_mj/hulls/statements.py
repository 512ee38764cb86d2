"""Whether everything that files state in `<custom>` finds what it holds for."""

from collections.abc import Collection, Mapping

import mujoco

from buoyancy_mj.errors import ModelError, choices
from buoyancy_mj.hulls.bodies import find_moving_bodies
from buoyancy_mj.hulls.custom import BodyNumeric, read_body_numerics
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.hulls.patterns import pool_of_file, split_assignment
from buoyancy_mj.hulls.selection import Selection
from buoyancy_mj.hulls.words import FileWords


def check_statements(
    model: mujoco.MjModel,
    words: FileWords,
    selection: Selection,
    geoms: Collection[int],
    refusals: Mapping[int, str],
) -> None:
    """Refuse what files state of geoms and bodies that are not there, or displace nothing.

    Args:
        model: any model.
        words: the choices of its files.
        selection: the user's choice, which takes the place of theirs.
        geoms: those that displace water; where the user chooses, all that could.
        refusals: why others never can, by their index.

    Raises:
        ModelError: a pattern matches none of `geoms`, or a numeric 'QUANTITY:BODY' names a body
            without them.
    """
    # shapes and fills
    idle = {g: "it displaces nothing" for g in range(model.ngeom) if g not in geoms}
    for field in ("hull", "fill"):
        for choice in words.of_field(field) if getattr(selection, field) is None else ():
            pool = pool_of_file(model, words, choice, idle | dict(refusals))
            for word in choice.words:
                pool.match(split_assignment(word)[0])

    # numbers of bodies
    bodies = {int(model.body_weldid[model.geom_bodyid[g]]) for g in geoms}
    given: dict[tuple[str, int], str] = {}
    for numeric in read_body_numerics(model):
        _check_bodies(model, numeric, bodies)
        if len(numeric.bodies) == 1:
            key = numeric.quantity, numeric.bodies[0]
            if key in given:
                raise ModelError(
                    f"'{given[key]}' and '{numeric.name}' both give the "
                    f"{numeric.quantity.replace('_', ' ')} of body '{numeric.body_name}'; "
                    "remove one of them"
                )
            given[key] = numeric.name


def _check_bodies(model: mujoco.MjModel, numeric: BodyNumeric, bodies: Collection[int]) -> None:
    """Refuse a numeric whose body is none of those that displace water."""
    possible = [body_name(model, body) for body in bodies]
    what = f"{numeric.quantity.replace('_', ' ')} is given for body '{numeric.body_name}'"
    if not numeric.bodies:
        raise ModelError(
            f"{what}, which the model does not have; {choices(numeric.body_name, possible)}"
        )
    moving = find_moving_bodies(model)
    for body in numeric.bodies:
        carrier = int(model.body_weldid[body])
        if body in bodies:
            continue
        if not moving[body]:
            raise ModelError(f"{what}, which cannot move; {choices('', possible)}")
        if carrier in bodies:
            raise ModelError(
                f"{what}, which moves with body '{body_name(model, carrier)}'; give it for that one"
            )
        raise ModelError(f"{what}, which has no hull of its own; {choices('', possible)}")
