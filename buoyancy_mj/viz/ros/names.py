"""Names of topics and frames: of the letters that ROS 2 allows."""

import re

import mujoco

from buoyancy_mj.hulls.names import body_name


def topic(*parts: str) -> str:
    """A topic of parts; what ROS allows in none of them becomes '_'."""
    return "".join(f"/{_clean(part)}" for part in "/".join(parts).split("/") if part)


def body_frame(model: mujoco.MjModel, body: int) -> str:
    """The frame of a body: its name."""
    return body_name(model, body)


def site_frame(model: mujoco.MjModel, site: int) -> str:
    """The frame of a site: its name, beside that of its body, since both may be alike."""
    body = body_name(model, int(model.site_bodyid[site]))
    name = str(model.site(site).name) or f"site {site}"
    # sites of one attached vehicle bear its prefix already
    return f"{body}/{name.rsplit('/', 1)[-1]}"


def _clean(part: str) -> str:
    """A part of a topic in letters, digits and '_', not beginning with a digit."""
    part = re.sub(r"\W", "_", part, flags=re.ASCII)
    return f"_{part}" if part[:1].isdigit() else part
