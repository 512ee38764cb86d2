"""Vessels that several tests float, as MuJoCo models and as meshes."""

import gzip
import io
from pathlib import Path

import mujoco
import numpy as np
import trimesh

from buoyancy_mj import TriMesh, repair
from buoyancy_mj.meshes.surface import boundary_edges
from tests.naive import trimesh_hull

DATA = Path(__file__).parent / "data"


def of_geoms(geoms, inertial="", options='gravity="0 0 -9.81"'):
    """A free body with geoms, in MJCF."""
    return mujoco.MjModel.from_xml_string(
        f"""<mujoco><option {options}/><worldbody>
        <body name="hull"><freejoint/>{inertial}{geoms}</body></worldbody></mujoco>"""
    )


def box(half_sizes=(1.0, 0.5, 0.3), mass=600.0):
    """A homogeneous box; by default 2 x 1 x 0.6 m floating at half its height in fresh water."""
    size = " ".join(str(half) for half in half_sizes)
    return of_geoms(f'<geom type="box" size="{size}" mass="{mass}"/>')


def of_mesh(mesh, mass, centre=(0.0, 0.0, 0.0), inertia=None):
    """A free body with one mesh, its mass at `centre`."""
    spec = mujoco.MjSpec()
    spec.option.gravity = [0.0, 0.0, -9.81]
    spec.add_mesh(
        name="hull",
        uservert=mesh.vertices.ravel(),
        userface=mesh.faces.ravel(),
        inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
    )
    body = spec.worldbody.add_body(name="hull", mass=mass, ipos=list(centre), explicitinertial=True)
    body.inertia = list(inertia or [mass * np.square(mesh.extents).sum() / 12.0] * 3)
    body.add_freejoint()
    body.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname="hull", name="hull")
    return spec.compile()


def dented(seed, size=1.0):
    """A closed mesh that nobody designed: a ball with random dents, stretched at random."""
    rng = np.random.default_rng(seed)
    ball = trimesh.creation.icosphere(subdivisions=2)
    radii = 1.0 + 0.35 * np.sin(
        ball.vertices @ rng.normal(0.0, 2.0, (3, 4)) + rng.uniform(0, 6, 4)
    ).mean(axis=1)
    return TriMesh(ball.vertices * radii[:, None] * rng.uniform(0.4, 1.0, 3) * size, ball.faces)


def wigley(length=2.5, beam=0.25, draft=0.15625, freeboard=0.1, stations=200, waterlines=100):
    """Wigley's parabolic hull y = (B / 2) (1 - (2 x / L)^2) (1 - (z / T)^2).

    Above z = 0 its sides are straight.
    """
    x = np.linspace(-1.0, 1.0, stations + 1)
    z = np.append(np.linspace(-1.0, 0.0, waterlines + 1), freeboard / draft)
    half = 0.5 * beam * (1.0 - x[:, None] ** 2) * (1.0 - np.minimum(z, 0.0) ** 2)
    places = np.broadcast_arrays(0.5 * length * x[:, None], half, draft * z)
    port = np.stack(places, axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(stations), np.arange(waterlines + 1), indexing="ij")
    a = (i * (waterlines + 2) + j).ravel()
    b, c, d = a + waterlines + 2, a + waterlines + 3, a + 1
    shell = np.vstack([np.column_stack([a, c, b]), np.column_stack([a, d, c])])
    count = len(port)
    rim = (np.arange(stations + 1) * (waterlines + 2)) + waterlines + 1
    p, q = rim[:-1], rim[1:]
    deck = np.vstack(
        [np.column_stack([p, p + count, q]), np.column_stack([q, p + count, q + count])]
    )
    faces = np.vstack([shell, shell[:, ::-1] + count, deck])
    return repair(np.vstack([port, port * [1.0, -1.0, 1.0]]), faces)[0]


def tanker(freeboard=5.0):
    """Vertices and faces of the tanker of the MSS toolbox, which are not closed.

    It has straight sides above the water, and a deck.
    """
    lines = (
        gzip.decompress((DATA / "mss_tanker" / "tanker.gdf.gz").read_bytes()).decode().splitlines()
    )
    count = int(lines[3])
    panels = np.array([line.split() for line in lines[4 : 4 + 4 * count]], float).reshape(
        count, 4, 3
    )
    panels = np.concatenate([panels, panels[:, ::-1] * [1.0, -1.0, 1.0]])
    corners = np.arange(8 * count).reshape(-1, 4)
    places, index = np.unique(np.round(panels.reshape(-1, 3), 5), axis=0, return_inverse=True)
    faces = index.ravel()[np.vstack([corners[:, :3], corners[:, [0, 2, 3]]])]
    faces = faces[
        (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    ]
    edges = boundary_edges(faces)
    a, b = edges[(places[edges, 2] > -1e-6).all(axis=1)].T
    n = len(places)
    vertices = np.vstack([places, places + [0.0, 0.0, freeboard], [[0.0, 0.0, freeboard]]])
    middle = np.full(len(a), 2 * n)
    walls = [
        np.column_stack([b, a, a + n]),
        np.column_stack([b, a + n, b + n]),
        np.column_stack([b + n, a + n, middle]),
    ]
    return vertices, np.vstack([faces, *walls])


def rm3_float():
    """The float of the RM3 wave energy converter."""
    text = gzip.decompress((DATA / "rm3" / "rm3_float.stl.gz").read_bytes())
    solid = trimesh.load_mesh(io.BytesIO(text), file_type="stl")
    return trimesh_hull(solid)
