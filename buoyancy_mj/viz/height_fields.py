"""`mesh_height_field`: the upper side of a height field, as triangles."""

import mujoco
import numpy as np
from numpy.typing import NDArray


def mesh_height_field(
    model: mujoco.MjModel, geom: int
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Corners (n, 3) [m] in the frame of a geom, and triangles (m, 3) seen from above."""
    field = int(model.geom_dataid[geom])
    rows, columns = int(model.hfield_nrow[field]), int(model.hfield_ncol[field])
    half_x, half_y, top, _ = model.hfield_size[field].tolist()
    start = int(model.hfield_adr[field])
    heights = top * model.hfield_data[start : start + rows * columns].astype(float)
    # rows lie along y
    x, y = np.meshgrid(np.linspace(-half_x, half_x, columns), np.linspace(-half_y, half_y, rows))
    a = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    b = a + columns
    faces = np.vstack([np.column_stack([a, a + 1, b + 1]), np.column_stack([a, b + 1, b])])
    return np.column_stack([x.ravel(), y.ravel(), heights]), faces
