"""Filament's graphics: a context where they work, one sentence where they do not, and textures."""

import contextlib
import ctypes
import ctypes.util
import os
import sys
import tempfile
from collections.abc import Iterator
from typing import Any

import numpy as np
from mujoco import mjrf
from numpy.typing import NDArray

from buoyancy_mj.errors import DrawingError

MEND = (
    "install a driver, which may be one for the processor alone (apt install libvulkan1 "
    "mesa-vulkan-drivers), or draw with the classic renderer"
)
"""What to do where there is no Vulkan."""


class _InstanceInfo(ctypes.Structure):
    """VkInstanceCreateInfo, of which zeros are enough."""

    _fields_ = (
        ("kind", ctypes.c_int),
        ("next", ctypes.c_void_p),
        ("flags", ctypes.c_uint32),
        ("application", ctypes.c_void_p),
        ("layer_count", ctypes.c_uint32),
        ("layers", ctypes.c_void_p),
        ("extension_count", ctypes.c_uint32),
        ("extensions", ctypes.c_void_p),
    )


def open_context() -> Any:
    """A context of Filament that needs no display.

    On Linux it draws through Vulkan, on a GPU where there is one. Without Vulkan Filament would end
    the process.

    Raises:
        DrawingError: there is no Vulkan, or Filament cannot be loaded.
    """
    api = mjrf.GraphicsApi.GRAPHICS_API_DEFAULT
    if sys.platform.startswith("linux"):
        if not count_devices():
            raise DrawingError(f"Filament draws through Vulkan, and there is none here; {MEND}")
        api = mjrf.GraphicsApi.GRAPHICS_API_VULKAN
    try:
        # brings the materials, without which Filament ends the process
        import mujoco.studio.window  # noqa: F401
    except ImportError as error:
        raise DrawingError(
            f"Filament cannot be loaded: {error}; install it (pip install mujoco-studio), or draw "
            "with the classic renderer"
        ) from error
    with quiet():
        return mjrf.Context(mjrf.ContextConfig(graphics_api=api))


def count_devices() -> int:
    """How many devices draw by Vulkan here; 0 where there is no Vulkan at all."""
    try:
        vulkan = ctypes.CDLL(ctypes.util.find_library("vulkan") or "libvulkan.so.1")
    except OSError:
        return 0
    instance, count = ctypes.c_void_p(), ctypes.c_uint32()
    if vulkan.vkCreateInstance(ctypes.byref(_InstanceInfo(kind=1)), None, ctypes.byref(instance)):
        return 0
    vulkan.vkEnumeratePhysicalDevices(instance, ctypes.byref(count), None)
    vulkan.vkDestroyInstance(instance, None)
    return count.value


def upload_cube(context: Any, sides: NDArray[np.uint8]) -> Any:
    """A cube texture of six pictures (6, n, n, 3) in sRGB, see `drawing.sky`."""
    size = sides.shape[1]
    kind, space = mjrf.SamplerType.TEXTURE_CUBE, mjrf.ColorSpace.COLORSPACE_SRGB
    return _upload(context, sides, size, 6 * size, kind, space)


def upload_normals(context: Any, normals: NDArray[np.uint8]) -> Any:
    """A normal map (n, n, 3)."""
    kind, space = mjrf.SamplerType.TEXTURE_2D, mjrf.ColorSpace.COLORSPACE_LINEAR
    return _upload(context, normals, len(normals), len(normals), kind, space)


def _upload(
    context: Any, pixels: NDArray[np.uint8], width: int, height: int, kind: Any, space: Any
) -> Any:
    """A texture of pixels."""
    texture = context.create_texture(
        mjrf.TextureConfig(
            width=width,
            height=height,
            format=mjrf.PixelFormat.PIXEL_FORMAT_RGB8,
            color_space=space,
            sampler_type=kind,
        )
    )
    data = mjrf.TextureData()
    data.set_image(pixels.tobytes())
    texture.upload(data)
    return texture


@contextlib.contextmanager
def quiet() -> Iterator[None]:
    """Keep from the standard output what Filament says there of itself."""
    sys.stdout.flush()
    kept = os.dup(1)
    try:
        with tempfile.TemporaryFile() as nowhere:
            os.dup2(nowhere.fileno(), 1)
            yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
