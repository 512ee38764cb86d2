"""The foils of a model that are sites, as they act: plates of their span, chord and thickness."""

import dataclasses
from collections.abc import Iterator

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.loads.foil_arrays import PlacedFoil, find_foils
from buoyancy_mj.meshes import shapes
from buoyancy_mj.viz.triangles import SmoothMesh, smooth_mesh
from buoyancy_mj.viz.visible_geoms import SHOWN_GROUPS, choose_colour


@dataclasses.dataclass(frozen=True)
class VisibleFoil:
    """A foil as it is drawn."""

    foil: PlacedFoil
    """What it is like, and where it stands on its body."""
    colour: NDArray[np.uint8]
    """Red, green, blue, alpha (4,), of the site or of its material."""
    mesh: SmoothMesh
    """Its triangles in its own frame."""


def find_visible_foils(model: mujoco.MjModel) -> Iterator[VisibleFoil]:
    """Find every foil whose site MuJoCo's viewer would show at first; those of geoms are geoms."""
    for foil in find_foils(model):
        if foil.geom is not None:
            continue
        site = model.site(foil.name).id
        rgba = choose_colour(model, model.site_rgba[site], model.site_matid[site])
        if model.site_group[site] >= SHOWN_GROUPS or rgba[3] == 0.0:
            continue
        half = 0.5 * np.array([foil.chord, foil.span, foil.thickness])
        mesh = shapes.ellipsoid(half) if foil.elliptic else shapes.box(half)
        yield VisibleFoil(
            foil, (255.0 * rgba).astype(np.uint8), smooth_mesh(mesh.vertices, mesh.faces)
        )
