"""A catamaran of 4 m: the one that ships, 2.5 times as long, its masses by Froude's scaling."""

from pathlib import Path

import mujoco

from buoyancy_mj.scenes import catalog

LENGTH, SHIPPED = 4.0, 1.6
"""Length of its hulls, and of those of the one that ships [m]."""


def write_model(folder: Path) -> Path:
    """Write its MJCF file into a folder."""
    shipped = catalog.models()["catamaran"]
    spec = mujoco.MjSpec.from_file(str(shipped))
    spec.meshdir = str(shipped.parent / spec.meshdir)
    scale = LENGTH / SHIPPED
    for mesh in spec.meshes:
        mesh.scale = scale * mesh.scale
    for geom in spec.geoms:
        geom.pos, geom.size, geom.mass = scale * geom.pos, scale * geom.size, scale**3 * geom.mass
    for place in (*spec.sites, *spec.cameras):
        place.pos = scale * place.pos

    # its thrusts are those of the small one
    for key in list(spec.keys):
        spec.delete(key)
    path = folder / "catamaran_of_4_m.xml"
    path.write_text(spec.to_xml())
    return path
