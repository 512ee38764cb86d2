"""Make the OBJ meshes of the models that ship, from a few named dimensions [m].

Run `.venv/bin/python scripts/make_models.py` from anywhere; commit the meshes that it writes.
"""

from pathlib import Path

import numpy as np
import trimesh
from trimesh import Trimesh
from trimesh.creation import box, cylinder, revolve

from buoyancy_mj.paper import solids

MODELS = Path(__file__).resolve().parent.parent / "models"
UPRIGHT_TO_X = trimesh.transformations.rotation_matrix(np.pi / 2.0, [0.0, 1.0, 0.0])

# the AUV's parts, each about its own middle, see models/sauvc_auv/README.md [m]
HULL_RADIUS = 0.090
HULL_CYLINDER = 0.450
HULL_DOME = 0.075
POD_RADIUS = 0.057
POD_CYLINDER = 0.300
POD_DOME = 0.030
PLATE_LENGTH = 0.600
PLATE_HEIGHT = 0.352
PLATE_THICKNESS = 0.012
PLATE_SPACING = 0.470
WINDOW_LENGTH = 0.230
WINDOW_HEIGHT = 0.230
WINDOW_OFFSET = 0.135
BAR_WIDTH = 0.030
BAR_THICKNESS = 0.012
BAR_OFFSET = 0.100
FOAM_SIZE = (0.340, 0.090, 0.035)
DUCT_OUTER_RADIUS = 0.0485
DUCT_INNER_RADIUS = 0.0380
DUCT_LENGTH = 0.045
MOTOR_RADIUS = 0.020
MOTOR_LENGTH = 0.080
STRUT_WIDTH = 0.006

# a hull of the catamaran about the middle of its waterline, see models/catamaran/README.md [m]
DEMIHULL_LENGTH = 1.600
DEMIHULL_BEAM = 0.200
DEMIHULL_DRAFT = 0.150
DEMIHULL_FREEBOARD = 0.120


def hourglass() -> Trimesh:
    """The hourglass that the reproduction of the source paper measures, z up, about its middle."""
    mesh = solids.hourglass()
    return Trimesh(mesh.vertices, mesh.faces, process=False)


def capped_tube(radius: float, length: float, dome: float) -> Trimesh:
    """A cylinder along x with half an ellipsoid of revolution at each end."""
    angle = np.linspace(0.0, np.pi / 2.0, 13)
    dome_profile = np.column_stack([radius * np.cos(angle), 0.5 * length + dome * np.sin(angle)])
    dome_profile[-1, 0] = 0.0  # on the axis
    profile = np.vstack([dome_profile[::-1] * [1.0, -1.0], dome_profile])
    return revolve(profile, sections=64).apply_transform(UPRIGHT_TO_X)


def frame() -> Trimesh:
    """Two upright plates with two windows each, joined by four bars across."""
    parts = []

    # the plates
    for side in (-0.5, 0.5):
        plate = box([PLATE_LENGTH, PLATE_THICKNESS, PLATE_HEIGHT])
        windows = [
            box([WINDOW_LENGTH, 1.0, WINDOW_HEIGHT]).apply_translation([x, 0.0, 0.0])
            for x in (-WINDOW_OFFSET, WINDOW_OFFSET)
        ]
        parts.append(plate.difference(windows).apply_translation([0.0, side * PLATE_SPACING, 0.0]))

    # the bars
    for x in (-BAR_OFFSET, BAR_OFFSET):
        for z in (-0.5, 0.5):
            bar = box([BAR_WIDTH, PLATE_SPACING, BAR_THICKNESS])
            parts.append(bar.apply_translation([x, 0.0, z * (PLATE_HEIGHT - BAR_THICKNESS)]))
    return trimesh.boolean.union(parts)


def thruster() -> Trimesh:
    """A duct along z with a motor in it, on three struts."""
    duct = trimesh.creation.annulus(DUCT_INNER_RADIUS, DUCT_OUTER_RADIUS, DUCT_LENGTH, sections=48)
    motor = cylinder(MOTOR_RADIUS, MOTOR_LENGTH, sections=32)

    # from the axis into the duct's wall
    struts = []
    reach = 0.5 * (DUCT_INNER_RADIUS + DUCT_OUTER_RADIUS)
    for turn in np.arange(3) * 2.0 * np.pi / 3.0:
        strut = box([reach, STRUT_WIDTH, STRUT_WIDTH]).apply_translation([0.5 * reach, 0.0, 0.0])
        rotation = trimesh.transformations.rotation_matrix(turn, [0.0, 0.0, 1.0])
        struts.append(strut.apply_transform(rotation))
    return trimesh.boolean.union([duct, motor, *struts])


def demihull(stations: int = 32, waterlines: int = 10) -> Trimesh:
    """Wigley's parabolic hull, y = (B / 2) (1 - (2 x / L)^2) (1 - (z / T)^2), and straight sides.

    Args:
        stations: number of strips along its length.
        waterlines: number of strips between keel and waterline.
    """
    # the port side, stations by heights
    x = np.cos(np.linspace(0.0, np.pi, stations + 1))
    z = np.append(np.linspace(-1.0, 0.0, waterlines + 1), DEMIHULL_FREEBOARD / DEMIHULL_DRAFT)
    half = 0.5 * DEMIHULL_BEAM * (1.0 - x[:, None] ** 2) * (1.0 - np.minimum(z, 0.0) ** 2)
    places = np.broadcast_arrays(0.5 * DEMIHULL_LENGTH * x[:, None], half, DEMIHULL_DRAFT * z)
    port = np.stack(places, axis=-1)

    # both sides as one strip around each station, from deck to keel to deck, and the deck between
    starboard = (port * [1.0, -1.0, 1.0])[:, ::-1]
    strip = np.concatenate([starboard, port[:, 1:]], axis=1)
    count = strip.shape[1]
    i, j = np.meshgrid(np.arange(stations), np.arange(count), indexing="ij")
    a, b = (i * count + j).ravel(), (i * count + (j + 1) % count).ravel()
    c, d = a + count, b + count
    faces = np.vstack([np.column_stack([a, b, d]), np.column_stack([a, d, c])])

    # stem, stern and keel are edges: their vertices coincide
    mesh = Trimesh(strip.reshape(-1, 3), faces, process=False)
    mesh.merge_vertices()
    mesh.update_faces(mesh.nondegenerate_faces())
    mesh.remove_unreferenced_vertices()
    mesh.fix_normals()
    return mesh


def main() -> None:
    """Write every mesh, and print its volume."""
    meshes = {
        "hourglass/assets/hourglass": hourglass(),
        "sauvc_auv/assets/pressure_hull": capped_tube(HULL_RADIUS, HULL_CYLINDER, HULL_DOME),
        "sauvc_auv/assets/battery_pod": capped_tube(POD_RADIUS, POD_CYLINDER, POD_DOME),
        "sauvc_auv/assets/frame": frame(),
        "sauvc_auv/assets/foam": box(FOAM_SIZE),
        "sauvc_auv/assets/thruster": thruster(),
        "catamaran/assets/demihull": demihull(),
    }
    for name, mesh in meshes.items():
        if not (mesh.is_watertight and mesh.volume > 0.0):
            raise SystemExit(f"{name} is not watertight")
        text = mesh.export(file_type="obj", include_normals=False, header=None, digits=7)
        (MODELS / f"{name}.obj").write_text(text)
        print(f"{name}: {len(mesh.faces)} triangles, {mesh.volume * 1000.0:.3f} l")


if __name__ == "__main__":
    main()
