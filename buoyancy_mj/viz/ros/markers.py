"""Meshes and the water's surface as markers, which 3D panels and RViz draw."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.scenes.run import Run
from buoyancy_mj.sea.water import Water
from buoyancy_mj.viz.ros import messages as ros
from buoyancy_mj.viz.ros.names import body_frame
from buoyancy_mj.viz.visible_geoms import find_visible_geoms

MARKER = "visualization_msgs/msg/Marker"
"""Type of a marker."""
MARKERS = "visualization_msgs/msg/MarkerArray"
"""Type of several markers."""
CELLS = 16
"""Number of cells along each side of the sea."""
WIDTH = 4.0
"""Length of a side over the length of what floats on it."""
_TRIANGLES = 11
_WATER = np.array([70, 150, 215, 110], np.uint8)
_UPRIGHT = (1.0, 0.0, 0.0, 0.0)


def draw_geoms(run: Run) -> Any:
    """All geoms that MuJoCo's viewer would show, each in the frame of its body."""
    from scipy.spatial.transform import Rotation

    markers = []
    for geom in find_visible_geoms(run.model):
        corners = geom.vertices[geom.faces].reshape(-1, 3)
        attitude = Rotation.from_matrix(geom.rotation).as_quat(scalar_first=True)
        markers.append(
            _marker(
                0.0,
                body_frame(run.model, geom.body) if geom.moves else ros.WORLD,
                f"{geom.geom}",
                ros.pose(geom.position, attitude),
                corners,
                geom.colour,
            )
        )
    return ros.make(MARKERS, markers)


def draw_sea(water: Water, middle: NDArray[np.float64], size: float, time: float) -> Any:
    """The surface of the water around a point (3,) [m], for what is so long [m], at a time [s]."""
    cell = WIDTH * size / CELLS
    along = (np.arange(CELLS + 1) - 0.5 * CELLS) * cell
    centre = np.round(middle[:2] / cell) * cell
    x, y = np.meshgrid(centre[0] + along, centre[1] + along, indexing="ij")
    corners = np.stack([x, y, water.elevation(x, y, time)], axis=-1)

    # two triangles for each cell
    a, b = corners[:-1, :-1], corners[1:, :-1]
    c, d = corners[1:, 1:], corners[:-1, 1:]
    triangles = np.stack([a, b, c, a, c, d], axis=2).reshape(-1, 3)
    return _marker(
        time, ros.WORLD, "sea", ros.pose(np.zeros(3), _UPRIGHT), triangles, _WATER, locked=False
    )


def _marker(
    time: float,
    frame: str,
    name: str,
    pose: Any,
    corners: NDArray[np.float64],
    colour: NDArray[np.uint8],
    *,
    locked: bool = True,
) -> Any:
    """Triangles (3 n, 3) [m] as a marker that stays until it is drawn anew."""
    image = ros.make("sensor_msgs/msg/CompressedImage", ros.header(0.0, ""), "", _NOTHING)
    return ros.make(
        MARKER,
        ros.header(time, frame),
        name,
        0,
        _TRIANGLES,
        0,
        pose,
        ros.vector(np.ones(3)),
        ros.colour(colour),
        ros.make("builtin_interfaces/msg/Duration", 0, 0),
        locked,
        [ros.point(corner) for corner in corners],
        [],
        "",
        image,
        [],
        "",
        "",
        ros.make("visualization_msgs/msg/MeshFile", "", _NOTHING),
        False,
    )


_NOTHING = np.zeros(0, np.uint8)
