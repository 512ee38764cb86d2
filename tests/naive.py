"""Slow, obvious twins of the fast code, and the naval architecture that tests need."""

import itertools

import mujoco
import numpy as np
import trimesh
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.spatial import Delaunay, QhullError

from buoyancy_mj import TriMesh, submerge


def sliced(mesh, position, rotation, level=0.0):
    """Volume and centroid of the capped slice under a level, by trimesh."""
    solid = trimesh.Trimesh(mesh.vertices @ rotation.T + position, mesh.faces, process=False)
    if (solid.vertices[:, 2] >= level).all():
        # trimesh has no mesh of nothing
        return 0.0, np.full(3, np.nan)
    wet = solid.slice_plane([0.0, 0.0, level], [0.0, 0.0, -1.0], cap=True)
    return wet.volume, wet.center_mass


def elevation(rows, x, y, time):
    """Sum of cosines, one by one."""
    return sum(a * np.cos(kx * x + ky * y - w * time + phase) for a, kx, ky, w, phase, *_ in rows)


def head(rows, x, y, z, time):
    """Pressure over rho g in waves, with the height in still water by bisection."""
    amplitude, kx, ky, omega, phase, depth = rows.T[:6]
    k = np.hypot(kx, ky)
    eta = amplitude * np.cos(kx * x + ky * y - omega * time + phase)

    def narrow(height):
        """Sinh k (z + h) over sinh k h: the rise of the water."""
        ways = [_fade(np.sinh, np.sinh, *wave, height) for wave in zip(k, depth, strict=True)]
        return np.array(ways)

    def wide(height):
        """Cosh k (z + h) over cosh k h: the pressure."""
        ways = [_fade(np.cosh, np.cosh, *wave, height) for wave in zip(k, depth, strict=True)]
        return np.array(ways)

    def mean(height):
        """The mean of the vertical velocity's square, over g."""
        return (0.5 * amplitude**2 * k * np.tanh(k * depth) * narrow(height) ** 2).sum()

    deepest = -min(depth.min(), 50.0 + abs(z))
    still = brentq(lambda s: s + eta @ narrow(s) - z, deepest, 1e-9, xtol=1e-14)
    slope = eta @ (k * np.tanh(k * depth) * narrow(still))
    waves = k > 0.0
    square = (eta * waves) @ narrow(still) * slope - mean(still)
    far = 1.0 - mean(still) / mean(0.0) if waves.any() else 0.0
    return -still + eta @ (wide(still) - narrow(still)) + far * square


def _fade(above, below, k, depth, height):
    """A function of k (z + h) over one of k h: e^(k z) in deep water, 1 for an endless wave."""
    if k == 0.0 or np.isinf(depth):
        return np.exp(k * height)
    return above(k * (height + depth)) / below(k * depth)


def columns(half_sizes, position, water, time, cells=400):
    """Submerged volume and centroid of an upright box, one column of water at a time."""
    x = position[0] + half_sizes[0] * (2.0 * (np.arange(cells) + 0.5) / cells - 1.0)
    y = position[1] + half_sizes[1] * (2.0 * (np.arange(cells) + 0.5) / cells - 1.0)
    xs, ys = np.meshgrid(x, y, indexing="ij")
    bottom, top = position[2] - half_sizes[2], position[2] + half_sizes[2]
    surface = np.clip(water.elevation(xs, ys, time), bottom, top)
    heights = surface - bottom
    cell = 4.0 * half_sizes[0] * half_sizes[1] / cells**2
    moments = [(q * heights).sum() * cell for q in (1.0, xs, ys, 0.5 * (surface + bottom))]
    return moments[0], np.array(moments[1:]) / moments[0]


def floating(mesh, volume, rotation=None):
    """The height at which `mesh` has a submerged volume."""
    turn = np.eye(3) if rotation is None else rotation
    z = mesh.vertices @ turn.T[:, 2]
    return brentq(
        lambda h: submerge(mesh, (0, 0, h), turn).volume - volume, -z.max(), -z.min(), xtol=1e-14
    )


def righting_arm(mesh, centre_of_gravity, volume, heel):
    """GZ of a mesh heeled about x with its displacement kept; positive rights it."""
    turn = roll(heel)
    centroid = submerge(mesh, (0, 0, floating(mesh, volume, turn)), turn).centroid
    return np.sign(heel) * ((turn @ centre_of_gravity)[1] - centroid[1])


def metacentric_height(mesh, centre_of_gravity, volume, heel=1e-4):
    """GM from the righting arm at a small heel."""
    return righting_arm(mesh, centre_of_gravity, volume, heel) / abs(np.sin(heel))


def roll(angle):
    """Rotation about x."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def period(potential, mass, low, high):
    """Exact period of an oscillation between two turning points of a potential.

    It is 2 int dz / sqrt(2 (E - U) / m).
    """
    energy = 0.5 * (potential(low) + potential(high))
    middle, half = 0.5 * (low + high), 0.5 * (high - low)

    def integrand(angle):
        # z = middle + half sin(angle) takes the square-root singularities away
        z = middle + half * np.sin(angle)
        gap = max(energy - potential(z), 1e-300)
        return half * np.cos(angle) / np.sqrt(2.0 * gap / mass)

    return 2.0 * quad(integrand, -0.5 * np.pi, 0.5 * np.pi, limit=200)[0]


def two_cones(radius, half_height, sections=512):
    """An hourglass of two cones, tips together at the origin, scaled to the true volume."""
    angle = np.arange(sections) * 2.0 * np.pi / sections
    # a polygon of the circle's area
    r = radius * np.sqrt(2.0 * np.pi / sections / np.sin(2.0 * np.pi / sections))
    ring = np.column_stack([r * np.cos(angle), r * np.sin(angle)])
    low = np.column_stack([ring, np.full(sections, -half_height)])
    high = np.column_stack([ring, np.full(sections, half_height)])
    vertices = np.vstack([low, high, [[0, 0, -half_height], [0, 0, half_height], [0, 0, 0]]])
    i = np.arange(sections)
    j = (i + 1) % sections
    bottom, top, tip = 2 * sections, 2 * sections + 1, 2 * sections + 2
    full = np.full(sections, 0)
    faces = np.vstack(
        [
            np.column_stack([j, i, full + bottom]),
            np.column_stack([i, j, full + tip]),
            np.column_stack([sections + i, sections + j, full + top]),
            np.column_stack([sections + j, sections + i, full + tip]),
        ]
    )
    return TriMesh(vertices, faces)


def cone(half_angle_radius, height, sections=512, apex_up=True):
    """A cone with its base's area exact, base or apex at z = 0."""
    angle = np.arange(sections) * 2.0 * np.pi / sections
    r = half_angle_radius * np.sqrt(2.0 * np.pi / sections / np.sin(2.0 * np.pi / sections))
    base, apex = (0.0, height) if apex_up else (height, 0.0)
    ring = np.column_stack([r * np.cos(angle), r * np.sin(angle), np.full(sections, base)])
    vertices = np.vstack([ring, [[0, 0, base], [0, 0, apex]]])
    i = np.arange(sections)
    j = (i + 1) % sections
    faces = np.vstack(
        [
            np.column_stack([j, i, np.full(sections, sections)]),
            np.column_stack([i, j, np.full(sections, sections + 1)]),
        ]
    )
    return TriMesh(vertices, faces if apex_up else faces[:, ::-1])


def trimesh_hull(solid):
    """A trimesh solid as a TriMesh."""
    return TriMesh(np.asarray(solid.vertices), np.asarray(solid.faces))


def hull_volume(points):
    """Volume of a convex hull as the sum of its Delaunay tetrahedra; flat sets have none."""
    try:
        cells = points[Delaunay(points).simplices]
    except QhullError:
        return 0.0
    return np.abs(np.linalg.det(cells[:, 1:] - cells[:, :1])).sum() / 6.0


def section(mesh, s):
    """Area and centroid (u, v) of one cross-section perpendicular to z, by trimesh and shapely."""
    solid = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
    path = solid.section(plane_origin=[0.0, 0.0, s], plane_normal=[0.0, 0.0, 1.0])
    if path is None:
        return 0.0, np.full(2, np.nan)
    planar, _ = path.to_2D(to_2D=trimesh.transformations.translation_matrix([0.0, 0.0, -s]))
    polygons = planar.polygons_full
    areas = np.array([polygon.area for polygon in polygons])
    centroids = np.array([polygon.centroid.coords[0] for polygon in polygons])
    return areas.sum(), areas @ centroids / areas.sum()


def directly(mesh, position, turn, water, time):
    """Volume and first moments (3,) about the position, by -d n_z over every triangle.

    The depth d is linear on each triangle, which is cut at d = 0.
    """
    points = mesh.vertices @ turn.T
    depths = water.depth(points + position, time)
    volume, moments = 0.0, np.zeros(3)
    for face in mesh.faces:
        polygon = [(*points[i], depths[i]) for i in face]
        wet = []
        for one, other in zip(polygon, polygon[1:] + polygon[:1], strict=True):
            one, other = np.array(one), np.array(other)
            if one[3] > 0.0:
                wet.append(one)
            if (one[3] > 0.0) != (other[3] > 0.0):
                wet.append(one + one[3] / (one[3] - other[3]) * (other - one))
        for b, c in itertools.pairwise(wet[1:]):
            corners = np.array([wet[0], b, c])
            area = (
                0.5 * np.cross(corners[1, :3] - corners[0, :3], corners[2, :3] - corners[0, :3])[2]
            )
            # a rule of degree two: the middles of the edges
            for m in 0.5 * (corners + np.roll(corners, 1, axis=0)):
                volume -= area / 3.0 * m[3]
                moments -= area / 3.0 * m[3] * np.array([m[0], m[1], m[2] + 0.5 * m[3]])
    return volume, moments


def reaction(model, buoyancy, data, slamming=False, step=1e-6):
    """Force and torque (6,) of added mass about `xipos` on a body that floats free and unforced.

    Of the body alone, but for what goes with its acceleration: -s (A (dv - du) + C v) - ds/dt A v
    + 1/2 (v'A v) grad s, by differences of the submerged volume; the acceleration of the velocity's
    components along the body's axes is -w x v.
    """
    added = buoyancy.added_mass
    matrix, volume, body = added.matrices[0].reshape(6, 6), added.volumes[0], added.bodies[0]
    turn, origin = data.xmat[body].reshape(3, 3), data.xpos[body]

    # the wet share, its gradient along the axes of the free joint, and its rate at rest
    def share(push, later=0.0):
        moved = mujoco.MjData(model)
        moved.qpos[:], moved.time = data.qpos, data.time + later
        mujoco.mj_integratePos(model, moved.qpos, np.asarray(push, float), 1.0)
        mujoco.mj_forward(model, moved)
        return buoyancy.evaluate(moved).total.volume / volume

    pushes = step * np.eye(6)
    gradient = np.array([(share(push) - share(-push)) / (2.0 * step) for push in pushes])
    gradient[:3] = turn.T @ gradient[:3]
    rate = (share(np.zeros(6), step) - share(np.zeros(6), -step)) / (2.0 * step)
    absolute = np.concatenate([turn.T @ data.qvel[:3], data.qvel[3:]])
    growth = gradient @ absolute + rate

    # relative to the water at the centroid of what is wet
    loads = buoyancy.evaluate(data)
    centroid, spin = loads.body.centroid[body], absolute[3:]
    water = turn.T @ buoyancy.water.velocity(centroid, time=data.time)
    rush = turn.T @ buoyancy.water.acceleration(centroid, time=data.time)
    v = absolute - np.concatenate([water, np.zeros(3)])
    change = np.concatenate(
        [-np.cross(spin, absolute[:3]) - (rush - np.cross(spin, water)), [0] * 3]
    )
    p, h = np.split(matrix @ v, 2)
    coriolis = np.concatenate([np.cross(spin, p), np.cross(v[:3], p) + np.cross(spin, h)])
    force = -share(np.zeros(6)) * (matrix @ change + coriolis) - growth * (matrix @ v)
    if not (slamming and growth > 0.0):
        force += 0.5 * (v @ matrix @ v) * gradient

    # about the centre of mass, in the world's axes
    push, torque = turn @ force[:3], turn @ force[3:]
    return np.concatenate([push, torque + np.cross(origin - data.xipos[body], push)])


def foil_polar(angle, *, slope, camber, induced, crossflow, lost, stall, blend, drag, cd90, tips):
    """Lift, drag and the camber's normal force of a foil at an angle of attack [rad]."""
    sine, cosine = np.sin(angle), np.cos(angle)
    fold = np.arctan2(abs(sine), abs(cosine))
    share = np.clip((fold - stall + blend) / (2.0 * blend), 0.0, 1.0)
    stalled = 3.0 * share**2 - 2.0 * share**3

    # as vectors along the chord and along the normal; the foil moves along (cos, -sin)
    along_lift, along_drag = np.array([sine, cosine]), np.array([-cosine, sine])
    straight = slope * sine * cosine
    cambered = -slope * camber * cosine * abs(cosine)
    force = (straight + cambered) * along_lift + induced * (straight + cambered) ** 2 * along_drag
    force = force + [0.0, crossflow * sine * abs(sine)]
    suction = (straight * along_lift + induced * straight**2 * along_drag)[0]
    force = force - [lost * suction, 0.0]
    plate = np.array([0.0, cd90 * (1.0 / (0.56 + 0.44 * abs(sine)) - tips) * sine])
    force = (1.0 - stalled) * force + stalled * plate + drag * along_drag
    normal_of_camber = (1.0 - stalled) * cambered * cosine
    centre = _pressure_centre(sine, cosine, stalled, slope, crossflow, plate[1])
    return force @ along_lift, force @ along_drag, normal_of_camber, centre


def _pressure_centre(sine, cosine, stalled, slope, crossflow, plate):
    """Where the force of a foil without camber acts, in chords before the middle."""
    # below, products of numbers so small would be rounded to 0
    if abs(sine) < 1e-300:
        return 0.25 * np.sign(cosine)
    parts = [
        ((1.0 - stalled) * slope * sine * cosine**2, 0.25 * np.sign(cosine)),
        ((1.0 - stalled) * crossflow * sine * abs(sine), 0.0),
        (stalled * plate, 0.75 * cosine / (4.0 + np.pi * abs(sine))),
    ]
    return sum(f * x for f, x in parts) / sum(f for f, _ in parts)


def differentiate_step(model, data, step=1e-6):
    """A and B of the tangent space (2 nv, 2 nv) and (2 nv, nu), by whole steps of the engine."""
    start = data.qpos.copy(), data.qvel.copy(), data.ctrl.copy()
    other = mujoco.MjData(model)

    def run(change):
        mujoco.mj_resetData(model, other)
        moved, faster, pushed = np.split(change, [model.nv, 2 * model.nv])
        other.time = data.time
        other.qpos[:] = start[0]
        mujoco.mj_integratePos(model, other.qpos, moved, 1.0)
        other.qvel[:] = start[1] + faster
        other.ctrl[:] = start[2] + pushed
        mujoco.mj_step(model, other)
        return other.qpos.copy(), other.qvel.copy()

    columns = []
    for change in step * np.eye(2 * model.nv + model.nu):
        (ahead, faster), (behind, slower) = run(change), run(-change)
        way = np.zeros(model.nv)
        mujoco.mj_differentiatePos(model, way, 2.0 * step, behind, ahead)
        columns.append(np.append(way, (faster - slower) / (2.0 * step)))
    return np.split(np.array(columns).T, [2 * model.nv], axis=1)


def wet_disc(depth, axis, radius, slopes, cells=2000):
    """Share of a disc under a plane of the surface, by points over the disc.

    The middle of the disc is `depth` under the plane, along z; `slopes` are those of the plane.
    """
    axis = np.asarray(axis, float) / np.linalg.norm(axis)
    one = np.cross(axis, [1.0, 0.0, 0.0] if abs(axis[0]) < 0.5 else [0.0, 1.0, 0.0])
    one /= np.linalg.norm(one)
    two = np.cross(axis, one)
    places = (np.arange(cells) + 0.5) / cells
    radii = radius * np.sqrt(places[:, None])
    angles = 2.0 * np.pi * places[None, ::10]
    points = [radii * (np.cos(angles) * one[k] + np.sin(angles) * two[k]) for k in range(3)]
    return float(np.mean(depth + slopes[0] * points[0] + slopes[1] * points[1] - points[2] > 0.0))


def panel_drag(corners, velocity, spin, centre, *, leading, trailing, friction, density):
    """Force and torque about a centre on triangles (n, 3, 3) that still water at z = 0 wets.

    `velocity` is that of the centre, all in the world's axes.
    """
    force, torque = np.zeros(3), np.zeros(3)
    for triangle in corners:
        # what is wet of it, from the areas of the polygon under the surface
        wet, following = [], np.roll(triangle, -1, axis=0)
        for p, q in zip(triangle, following, strict=True):
            if p[2] < 0.0:
                wet.append(p)
            if (p[2] < 0.0) != (q[2] < 0.0):
                wet.append(p + p[2] / (p[2] - q[2]) * (q - p))
        if not wet:
            continue
        fan = [np.cross(b - wet[0], c - wet[0]) / 2.0 for b, c in itertools.pairwise(wet[1:])]
        area = np.linalg.norm(np.sum(fan, axis=0))
        a, b, c = triangle
        normal = np.cross(b - a, c - a)
        normal /= np.linalg.norm(normal)

        # pressure along the normal, and friction along the face
        arm = triangle.mean(axis=0) - centre
        u = velocity + np.cross(spin, arm)
        into = u @ normal
        along = u - into * normal
        coefficient = leading if into > 0.0 else trailing
        push = -coefficient * abs(into) * into * normal
        push -= friction * np.linalg.norm(along) * along
        force += 0.5 * density * area * push
        torque += np.cross(arm, 0.5 * density * area * push)
    return np.concatenate([force, torque])
