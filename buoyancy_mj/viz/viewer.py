"""MuJoCo's own interactive viewer, with the water acting and drawn in it."""

import time
import warnings

import glfw
import mujoco
import mujoco.viewer
import numpy as np

from buoyancy_mj.errors import ModelError
from buoyancy_mj.scenes.simulation import Simulation
from buoyancy_mj.sea.water import Water

CELLS = 24
"""Tiles along each side of the drawn surface."""
TILE_COLOUR = np.array([0.25, 0.55, 0.85, 0.35], np.float32)
FRAME_TIME = 1.0 / 60.0
"""Wall time between two pictures [s]."""


def view_simulation(simulation: Simulation) -> None:
    """Open the viewer and run in real time until its window is closed.

    The mouse drags the vehicle as in any MuJoCo model; the scene's duration does not end the run.

    Raises:
        ModelError: there is no display.
        DivergenceError: see `Simulation.step`.
    """
    model, data = simulation.model, simulation.data
    # light enough where the vehicle's file brings no lamp
    model.vis.headlight.ambient[:] = np.maximum(model.vis.headlight.ambient, 0.35)
    # MuJoCo would end the process where there is no display
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if not glfw.init():
            raise ModelError(
                "MuJoCo's viewer needs a display, and there is none here; use 'run', which needs none"
            )
    try:
        handle = mujoco.viewer.launch_passive(model, data, show_left_ui=False, show_right_ui=False)
    except Exception as error:
        raise ModelError(
            f"MuJoCo's viewer could not be opened: {error}; use 'run', which needs none"
        ) from error
    with handle as viewer:
        size = 4.0 * max(
            float(np.linalg.norm(hull.position)) + hull.mesh.radius for hull in simulation.hulls
        )
        viewer.cam.lookat[:] = simulation.centre_of_mass(data)
        viewer.cam.distance = size
        viewer.cam.azimuth, viewer.cam.elevation = 140.0, -20.0
        while viewer.is_running():
            started, until = time.perf_counter(), data.time + FRAME_TIME
            with viewer.lock():
                while data.time < until:
                    simulation.step()
                draw_surface(
                    viewer.user_scn,
                    simulation.scene.water,
                    simulation.centre_of_mass(data),
                    size,
                    data.time,
                )
            viewer.sync()
            time.sleep(max(0.0, FRAME_TIME - (time.perf_counter() - started)))


def draw_surface(
    scene: mujoco.MjvScene, water: Water, centre: np.ndarray, width: float, now: float
) -> None:
    """Replace the user geoms of a scene by tiles on the water's surface around `centre` (3,) [m].

    Each tile leans as the surface does there; on still water one tile is enough.
    """
    count = min(CELLS, int(np.sqrt(scene.maxgeom))) if water.waves else 1
    tile = width / count
    corner = np.round(centre[:2] / tile) * tile - 0.5 * width
    scene.ngeom = 0
    if scene.maxgeom < 1:
        return
    middles = (np.arange(count) + 0.5) * tile
    x, y = np.meshgrid(corner[0] + middles, corner[1] + middles, indexing="ij")
    z = water.elevation(x, y, now)
    step = 0.25 * tile
    slope_x = (water.elevation(x + step, y, now) - water.elevation(x - step, y, now)) / (2.0 * step)
    slope_y = (water.elevation(x, y + step, now) - water.elevation(x, y - step, now)) / (2.0 * step)
    for place in np.ndindex(x.shape):
        along = np.array([1.0, 0.0, slope_x[place]])
        along_length = np.linalg.norm(along)
        normal = np.array([-slope_x[place], -slope_y[place], 1.0])
        normal /= np.linalg.norm(normal)
        along /= along_length
        across = np.cross(normal, along)
        half = np.array(
            [0.5 * tile * along_length, 0.5 * tile * np.hypot(1.0, slope_y[place]), 0.0005 * width]
        )
        mujoco.mjv_initGeom(
            scene.geoms[scene.ngeom],
            mujoco.mjtGeom.mjGEOM_BOX,
            half,
            np.array([x[place], y[place], z[place] - half[2]]),
            np.column_stack([along, across, normal]).ravel(),
            TILE_COLOUR,
        )
        scene.ngeom += 1
