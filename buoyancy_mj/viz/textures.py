"""`texture`: a picture on a mesh, apart from its corners."""

import numpy as np
import rerun as rr
from numpy.typing import NDArray


def texture(picture: NDArray[np.uint8], places: NDArray[np.floating]) -> rr.Mesh3D:
    """A picture for the corners of a mesh that is logged by itself.

    Args:
        picture: red, green and blue of its pixels (height, width, 3), with which the colours of the
            mesh are multiplied; beyond its edges it repeats.
        places: where each corner is in the picture (n, 2), from 0 to 1.
    """
    height, width, _ = picture.shape
    kind = rr.components.ImageFormat(
        width=width, height=height, color_model="RGB", channel_datatype="U8"
    )
    return rr.Mesh3D.from_fields(
        vertex_texcoords=places,
        albedo_texture_buffer=picture.tobytes(),
        albedo_texture_format=kind,
    )
