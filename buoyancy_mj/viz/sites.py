"""`draw_sites`: the sites of a model as points in a recording, named when pointed at."""

import mujoco
import numpy as np
import rerun as rr

from buoyancy_mj.hulls.bodies import find_mocap_bodies, find_moving_bodies
from buoyancy_mj.viz.entities import body_entity
from buoyancy_mj.viz.log import Log
from buoyancy_mj.viz.visible_foils import find_visible_foils
from buoyancy_mj.viz.visible_geoms import SHOWN_GROUPS, choose_colour


def draw_sites(log: Log, model: mujoco.MjModel) -> None:
    """Draw every site that MuJoCo's viewer would show at first, in the frame of its body.

    Those that are foils are drawn as such.
    """
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    moves = find_moving_bodies(model) | find_mocap_bodies(model)
    foils = {visible.foil.name for visible in find_visible_foils(model)}
    sites: dict[int, list[int]] = {}
    colours = {}
    for site in np.flatnonzero(model.site_group < SHOWN_GROUPS).tolist():
        rgba = choose_colour(model, model.site_rgba[site], int(model.site_matid[site]))
        if rgba[3] > 0.0 and model.site(site).name not in foils:
            colours[site] = (255.0 * rgba).astype(np.uint8)
            body = int(model.site_bodyid[site])
            sites.setdefault(body if moves[body] else 0, []).append(site)
    for body, some in sites.items():
        # what does not move stands in the frame of the world
        still = body == 0
        log.keep(
            f"{body_entity(model, body)}/sites",
            rr.Points3D(
                data.site_xpos[some] if still else model.site_pos[some],
                radii=model.site_size[some, 0],
                colors=[colours[site] for site in some],
                labels=[model.site(site).name or f"site {site}" for site in some],
                show_labels=False,
            ),
        )
