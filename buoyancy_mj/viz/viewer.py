"""MuJoCo's own interactive viewer, with the water acting and drawn in it."""

import time
import warnings
from typing import Any

import glfw
import mujoco
import mujoco.viewer
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import ModelError
from buoyancy_mj.scenes.run import place_at_start
from buoyancy_mj.scenes.simulation import Simulation
from buoyancy_mj.sea.water import Water
from buoyancy_mj.viz.framing import find_middle, measure_extent

CELLS = 24
"""Number of tiles along each side of the surface."""
TILE_COLOUR = np.array([0.25, 0.55, 0.85, 0.35], np.float32)
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
                draw_surface(viewer.user_scn, water, middle, size, data.time)
            viewer.sync()
            time.sleep(max(0.0, FRAME_TIME - (time.perf_counter() - started)))


def draw_surface(
    scene: mujoco.MjvScene, water: Water, centre: NDArray[np.float64], width: float, now: float
) -> None:
    """Replace the user geoms of a MuJoCo scene by tiles on the water's surface.

    Each tile leans as the surface does at its middle; on still water one tile is enough.

    Args:
        scene: what the viewer draws.
        water: the sea.
        centre: point around which the tiles lie (3,) [m].
        width: length of the sides of the surface [m].
        now: time [s].
    """
    scene.ngeom = 0
    if scene.maxgeom < 1:
        return

    # the middles of the tiles
    count = min(CELLS, int(np.sqrt(scene.maxgeom))) if water.waves else 1
    side = width / count
    corner = np.round(centre[:2] / side) * side - 0.5 * width
    middles = (np.arange(count) + 0.5) * side
    x, y = np.meshgrid(corner[0] + middles, corner[1] + middles, indexing="ij")
    z = water.elevation(x, y, now)

    # the slopes of the surface there
    step = 0.25 * side
    rise_x = water.elevation(x + step, y, now) - water.elevation(x - step, y, now)
    rise_y = water.elevation(x, y + step, now) - water.elevation(x, y - step, now)
    slope_x = rise_x / (2.0 * step)
    slope_y = rise_y / (2.0 * step)

    for i in np.ndindex(x.shape):
        middle = np.array([x[i], y[i], z[i]])
        tile = scene.geoms[scene.ngeom]
        _shape_tile(tile, middle, (float(slope_x[i]), float(slope_y[i])), side, 0.001 * width)
        scene.ngeom += 1


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


def _shape_tile(
    tile: mujoco.MjvGeom,
    middle: NDArray[np.float64],
    slopes: tuple[float, float],
    side: float,
    thickness: float,
) -> None:
    """Make a geom a tile whose top leans by `slopes` along x and y.

    Args:
        tile: the geom.
        middle: point on the surface over its middle (3,) [m].
        slopes: rise of the surface along x and along y.
        side: length of its sides, seen from above [m].
        thickness: its thickness [m].
    """
    # axes along the surface and across it
    slope_x, slope_y = slopes
    stretch = np.hypot(1.0, slope_x)
    along = np.array([1.0, 0.0, slope_x]) / stretch
    normal = np.array([-slope_x, -slope_y, 1.0])
    normal /= np.linalg.norm(normal)
    across = np.cross(normal, along)

    half = 0.5 * np.array([side * stretch, side * np.hypot(1.0, slope_y), thickness])
    position = middle - [0.0, 0.0, half[2]]
    rotation = np.column_stack([along, across, normal])
    box = mujoco.mjtGeom.mjGEOM_BOX
    mujoco.mjv_initGeom(tile, box, half, position, rotation.ravel(), TILE_COLOUR)
