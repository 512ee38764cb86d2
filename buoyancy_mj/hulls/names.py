"""Names of geoms and bodies, for messages and patterns; unnamed ones get a name too."""

import mujoco


def geom_name(model: mujoco.MjModel, geom: int) -> str:
    """The geom's own name, or 'BODY/TYPE INDEX'."""
    name = str(model.geom(geom).name)
    if name:
        return name
    return f"{body_name(model, int(model.geom_bodyid[geom]))}/{geom_kind(model, geom)} {geom}"


def geom_kind(model: mujoco.MjModel, geom: int) -> str:
    """The type of a geom as MJCF writes it: 'mesh', 'box', 'sphere', ..."""
    kind = mujoco.mjtGeom(int(model.geom_type[geom])).name
    return str(kind).removeprefix("mjGEOM_").lower()


def body_name(model: mujoco.MjModel, body: int) -> str:
    """The body's own name, or 'body INDEX'."""
    return str(model.body(body).name) or f"body {body}"
