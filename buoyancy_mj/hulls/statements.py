"""Whether everything that files state in `<custom>` finds what it holds for."""

from collections.abc import Collection, Mapping

import mujoco

from buoyancy_mj.errors import ModelError, choices
from buoyancy_mj.hulls.bodies import find_moving_bodies
from buoyancy_mj.hulls.custom import BodyNumeric, read_body_numerics
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.hulls.patterns import pool_of_file, split_assignment
from buoyancy_mj.hulls.scopes import BASE, Scope, explain_missing, find_scope
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
    geoms = set(geoms)
    idle = {g: "it displaces nothing" for g in range(model.ngeom) if g not in geoms}
    for field in ("hull", "fill"):
        for choice in words.of_field(field) if getattr(selection, field) is None else ():
            pool = pool_of_file(model, words, choice, idle | dict(refusals))
            for word in choice.words:
                pool.match(split_assignment(word)[0])

    # numbers of bodies
    bodies = {int(model.body_weldid[model.geom_bodyid[g]]) for g in geoms}
    given: dict[tuple[str, str], str] = {}
    for numeric in read_body_numerics(model):
        _check_bodies(model, numeric, bodies)
        other = given.setdefault((numeric.quantity, numeric.body_name), numeric.name)
        if other != numeric.name:
            raise ModelError(
                f"'{other}' and '{numeric.name}' both give the "
                f"{numeric.quantity.replace('_', ' ')} of body '{numeric.body_name}'; "
                "remove one of them"
            )


def _check_bodies(model: mujoco.MjModel, numeric: BodyNumeric, bodies: Collection[int]) -> None:
    """Refuse a numeric whose body is none of those that displace water."""
    wrong = [body for body in numeric.bodies if body not in bodies]
    if numeric.bodies and not wrong:
        return
    what = f"{numeric.quantity.replace('_', ' ')} is given for body '{numeric.body_name}'"
    possible = choices(numeric.body_name, [body_name(model, body) for body in bodies])
    if not wrong:
        scope = find_scope(numeric.name, f"{numeric.quantity}:") or BASE
        hint = explain_missing(Scope(scope.prefix))
        raise ModelError(f"{what}, which the model does not have; {possible}{hint}")
    if not find_moving_bodies(model)[wrong[0]]:
        raise ModelError(f"{what}, which cannot move; {possible}")
    carrier = int(model.body_weldid[wrong[0]])
    if carrier in bodies:
        raise ModelError(
            f"{what}, which moves with body '{body_name(model, carrier)}'; give it for that one"
        )
    raise ModelError(f"{what}, which has no hull of its own; {possible}")
