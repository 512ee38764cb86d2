"""The entities of bodies and geoms in a recording."""

import mujoco
import rerun as rr

from buoyancy_mj.hulls.names import body_name, geom_name


def body_entity(model: mujoco.MjModel, body: int) -> str:
    """The entity of a body; that of all surroundings for 0, the world."""
    if body == 0:
        return "world/environment"
    return f"world/bodies/{rr.escape_entity_path_part(body_name(model, body))}"


def geom_entity(model: mujoco.MjModel, geom: int, body: int) -> str:
    """The entity of a geom that is drawn in the frame of a body."""
    return f"{body_entity(model, body)}/{rr.escape_entity_path_part(geom_name(model, geom))}"
