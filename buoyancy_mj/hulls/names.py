"""Names of geoms and bodies, for messages and patterns; unnamed ones get a name too."""

import mujoco


def geom_name(model: mujoco.MjModel, geom: int) -> str:
    """The geom's own name, or 'BODY/TYPE INDEX'."""
    name = str(model.geom(geom).name)
    return name or f"{body_name(model, int(model.geom_bodyid[geom]))}/{unnamed_geom(model, geom)}"


def unnamed_geom(model: mujoco.MjModel, geom: int) -> str:
    """What an unnamed geom is called in its body: 'TYPE INDEX', where the body's first has 0.

    Whatever joins the model beside the body leaves this name as it is.
    """
    index = geom - int(model.body_geomadr[model.geom_bodyid[geom]])
    return f"{geom_kind(model, geom)} {index}"


def geom_kind(model: mujoco.MjModel, geom: int) -> str:
    """The type of a geom as MJCF writes it: 'mesh', 'box', 'sphere', ..."""
    kind = mujoco.mjtGeom(int(model.geom_type[geom])).name
    return str(kind).removeprefix("mjGEOM_").lower()


def body_name(model: mujoco.MjModel, body: int) -> str:
    """The body's own name, or 'body INDEX'."""
    return str(model.body(body).name) or f"body {body}"
