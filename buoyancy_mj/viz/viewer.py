"""MuJoCo's own interactive viewer, with the water acting and drawn in it."""

import time
import warnings
from typing import Any

import glfw
import mujoco
import mujoco.viewer
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.drawing.classic.sea import Eye, add_sea
from buoyancy_mj.errors import ModelError
from buoyancy_mj.scenes.run import place_at_start
from buoyancy_mj.scenes.simulation import Simulation
from buoyancy_mj.viz.framing import find_middle, measure_extent

FRAME_TIME = 1.0 / 60.0
"""Wall time between two pictures [s]."""
AMBIENT = 0.35
"""Least ambient light, for a vehicle whose file brings no lamp."""


def view_simulation(simulation: Simulation) -> None:
    """Open the viewer and run in real time until its window is closed.

    The mouse drags the vehicle as in any MuJoCo model; the scene's duration does not end the run.

    Raises:
        ModelError: there is no display.
        DivergenceError: a position, velocity or acceleration left the finite numbers.
    """
    data = simulation.data
    vehicles = simulation.vehicles.values()
    size = 2.0 * measure_extent(vehicles, place_at_start(simulation))
    ambient = simulation.model.vis.headlight.ambient
    ambient[:] = np.maximum(ambient, AMBIENT)
    with _open_viewer(simulation) as viewer:
        # the camera
        middle = find_middle(vehicle.centre_of_mass(data) for vehicle in vehicles)
        viewer.cam.lookat[:] = middle
        viewer.cam.distance = size
        viewer.cam.azimuth = 140.0
        viewer.cam.elevation = -20.0

        # each picture
        while viewer.is_running():
            started = time.perf_counter()
            end = data.time + FRAME_TIME
            with viewer.lock():
                while data.time < end:
                    simulation.step()
                water = simulation.buoyancy.water
                middle = find_middle(vehicle.centre_of_mass(data) for vehicle in vehicles)
                scene, eye = viewer.user_scn, Eye(_find_eye(viewer.cam))
                scene.ngeom = 0
                add_sea(scene, water, middle, data.time, radius=0.5 * size, eye=eye)
            viewer.sync()
            time.sleep(max(0.0, FRAME_TIME - (time.perf_counter() - started)))


def _open_viewer(simulation: Simulation) -> Any:
    """Open MuJoCo's viewer, which would end the process where there is no display."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if not glfw.init():
            raise ModelError(
                "MuJoCo's viewer needs a display, and there is none here; "
                "use 'run', which needs none"
            )
    try:
        return mujoco.viewer.launch_passive(
            simulation.model, simulation.data, show_left_ui=False, show_right_ui=False
        )
    except Exception as error:
        raise ModelError(
            f"MuJoCo's viewer could not be opened: {error}; use 'run', which needs none"
        ) from error


def _find_eye(camera: mujoco.MjvCamera) -> NDArray[np.float64]:
    """Where a free camera stands (3,) [m]."""
    azimuth, elevation = np.radians([camera.azimuth, camera.elevation])
    flat = np.cos(elevation)
    forward = np.array([flat * np.cos(azimuth), flat * np.sin(azimuth), np.sin(elevation)])
    return np.asarray(camera.lookat - camera.distance * forward)
