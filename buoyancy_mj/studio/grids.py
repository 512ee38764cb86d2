"""Triangles of a grid of vertices, which the sea and the sky of a browser are made of."""

import numpy as np
from numpy.typing import NDArray


def list_faces(rows: int, columns: int) -> NDArray[np.int32]:
    """Triangles (m, 3) between `rows` times `columns` vertices, which stand row by row.

    Where row after row goes along x, and each row along y, they are counterclockwise from above.
    """
    corner = np.arange(rows * columns).reshape(rows, columns)
    a, b = corner[:-1, :-1].ravel(), corner[1:, :-1].ravel()
    c, d = corner[1:, 1:].ravel(), corner[:-1, 1:].ravel()
    faces = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    return faces.astype(np.int32)
