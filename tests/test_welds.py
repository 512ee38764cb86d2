"""Bodies that welds hold together: their places, and drag that is that of one body."""

import math

import mujoco
import numpy as np
import pytest
import trimesh

from buoyancy_mj import Buoyancy, BuoyancyWarning, Damping, Panels, Silhouette, TriMesh, Water
from buoyancy_mj.hulls.geoms import find_hulls
from buoyancy_mj.hulls.welds import group_welded_bodies
from buoyancy_mj.kernels.rays import count_windings, see
from buoyancy_mj.loads.damping_arrays import resolve_damping
from buoyancy_mj.loads.exposure import measure_exposure
from buoyancy_mj.loads.silhouettes import measure_silhouettes
from buoyancy_mj.meshes import shapes
from buoyancy_mj.submersion.exact import PackedHulls
from buoyancy_mj.submersion.hull_set import HullSet

SIZES = np.array([0.4, 0.2, 0.1])
"""Half sides of the whole box [m], neutral in fresh water."""
WHOLE = [((0.0, 0.0, 0.0), SIZES)]


def split(axis, parts=2):
    """Centres and half sides of parts of the box along an axis."""
    half = SIZES.copy()
    half[axis] /= parts
    places = (2.0 * np.arange(parts) + 1.0 - parts) * half[axis]
    return [(tuple(place * np.eye(3)[axis]), half) for place in places]


def geom(half):
    volume = 8.0 * float(np.prod(half))
    return f'<geom type="box" size="{half[0]} {half[1]} {half[2]}" mass="{1000.0 * volume}"/>'


def build(parts, equality=None, custom="", below=""):
    """Boxes as free bodies 'b0', 'b1', ..., 3 m deep, with welds of all to the first."""
    bodies = "".join(
        f'<body name="b{i}" pos="{p[0]} {p[1]} {p[2] - 3.0}"><freejoint/>{geom(half)}{below}</body>'
        for i, (p, half) in enumerate(parts)
    )
    stiff = 'solref="0.004 1" solimp=".999 .9999 .001"'
    if equality is None:
        equality = "".join(f'<weld body1="b0" body2="b{i}" {stiff}/>' for i in range(1, len(parts)))
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="0.002"><flag contact="disable"/></option>'
        f"<custom>{custom}</custom>"
        f"<worldbody>{bodies}</worldbody><equality>{equality}</equality></mujoco>"
    )


def move(model, velocity, spin):
    """Its data, all bodies with the motion of one rigid body about 3 m deep."""
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    for body in range(1, model.nbody):
        dof = model.body_dofadr[body]
        data.qvel[dof : dof + 3] = velocity + np.cross(spin, data.xpos[body] - [0.0, 0.0, -3.0])
        data.qvel[dof + 3 : dof + 6] = spin
    mujoco.mj_forward(model, data)
    return data


def drag_of(model, data, viscous, current=(0.2, 0.1, 0.0)):
    """Drag of each body about its centre of mass (nbody, 6)."""
    water = Water(current=current)
    return Buoyancy(model, water, damping=Damping(viscous=viscous)).evaluate(data).by_cause["drag"]


def total(data, rows, about=(0.0, 0.0, -3.0)):
    """Force and torque (6,) of drag about a point."""
    torques = rows[:, 3:] + np.cross(data.xipos - np.array(about), rows[:, :3])
    return np.concatenate([rows[:, :3].sum(axis=0), torques.sum(axis=0)])


VELOCITY, SPIN = np.array([0.8, 0.3, -0.2]), np.array([0.5, -0.8, 1.2])


# what welds hold together


def test_bodies_stand_where_the_engine_finds_their_welds_closed():
    model = mujoco.MjModel.from_xml_string("""
        <mujoco><worldbody>
          <body name="a"><freejoint/><geom size=".1"/>
            <body name="arm" pos=".2 .1 0" euler="20 0 40"><geom size=".1"/>
              <site name="on_arm" pos=".1 .2 .3" euler="10 20 30"/></body></body>
          <body name="b" pos="3 1 1" euler="10 0 0"><freejoint/><geom size=".1"/>
            <body name="hand" pos=".2 .1 0" euler="20 0 40"><geom size=".1"/></body></body>
          <body name="c" pos="-3 1 1"><freejoint/><geom size=".1"/>
            <site name="on_c" pos=".1 .2 .3" euler="1 2 30"/></body>
        </worldbody><equality>
          <weld body1="arm" body2="hand" relpose=".3 .2 .1 .8 .1 .2 .3" anchor=".1 .05 0"/>
          <weld site1="on_arm" site2="on_c"/>
        </equality></mujoco>""")
    (group,) = group_welded_bodies(model, [1, 3, 5])
    assert group.welds == (0, 1)
    data = mujoco.MjData(model)
    for i, place in enumerate(group.places.values()):
        data.qpos[7 * i : 7 * i + 3] = place.position
        mujoco.mju_mat2Quat(data.qpos[7 * i + 3 : 7 * i + 7], place.rotation.ravel())
    mujoco.mj_forward(model, data)
    equalities = data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY
    assert equalities.sum() == 12
    assert data.efc_pos[equalities] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    "equality",
    [
        "",
        '<connect body1="b0" body2="b1" anchor="0 0 0"/>',
        '<weld body1="b0" body2="b1" active="false"/>',
        '<weld body1="b0"/><weld body1="b1"/>',
    ],
)
def test_what_no_weld_joins_keeps_its_own_drag(equality):
    model = build(split(0), equality)
    assert not group_welded_bodies(model, [1, 2])
    rows = drag_of(model, move(model, VELOCITY, SPIN), Silhouette())
    alone = build(split(0)[:1])
    expected = drag_of(alone, move(alone, VELOCITY, SPIN), Silhouette())[1]
    assert rows[1] == pytest.approx(expected, rel=1e-12)


# drag of what is welded


@pytest.mark.parametrize("parts", [split(0), split(1), split(2), split(0, 3)])
def test_welded_parts_have_the_drag_of_the_whole(parts):
    whole, welded = build(WHOLE), build(parts)
    for viscous, spin in ((Silhouette(), SPIN), (Panels(), np.zeros(3))):
        data = move(whole, VELOCITY, spin)
        expected = total(data, drag_of(whole, data, viscous))
        data = move(welded, VELOCITY, spin)
        found = total(data, drag_of(welded, data, viscous))
        assert found == pytest.approx(expected, rel=1e-9, abs=1e-9)


def test_parts_that_are_drawn_apart_count_where_their_weld_holds_them():
    apart = split(0)
    apart[1] = ((5.0, 1.0, 0.0), apart[1][1])
    weld = '<weld body1="b0" body2="b1" relpose="0.4 0 0 1 0 0 0"/>'
    for viscous in (Silhouette(), Panels()):
        both = []
        for model in (build(split(0)), build(apart, weld)):
            data = move(model, VELOCITY, np.zeros(3))
            both.append(drag_of(model, data, viscous)[:, :3].sum(axis=0))
        assert both[1] == pytest.approx(both[0], rel=1e-9)


@pytest.mark.parametrize("native", [False, True])
@pytest.mark.parametrize("viscous", [Silhouette(), Panels()])
def test_welded_halves_drift_as_the_whole_does(viscous, native):
    ends = []
    for parts in (WHOLE, split(0)):
        model = build(parts)
        data = move(model, VELOCITY, np.zeros(3))
        buoyancy = Buoyancy(model, Water(current=(0.2, 0.1, 0)), damping=Damping(viscous=viscous))
        with buoyancy.installed(native=native):
            mujoco.mj_step(model, data, 500)
        ends.append(data.subtree_com[0].copy())
    assert ends[1] == pytest.approx(ends[0], abs=1e-6)
    assert np.linalg.norm(ends[0]) > 0.5


def test_a_weld_that_is_let_go_leaves_each_part_its_own_drag():
    model, free = build(split(0)), build(split(0), "")
    for viscous in (Silhouette(), Panels()):
        rows = []
        for of in (model, free):
            data = move(of, VELOCITY, SPIN)
            data.eq_active[:] = 0
            rows.append(drag_of(of, data, viscous))
            with Buoyancy(of, Water(), damping=Damping(viscous=viscous)).installed():
                mujoco.mj_step(of, data, 100)
            rows.append(data.qpos.copy())
        assert rows[0] == pytest.approx(rows[2], rel=1e-12)
        assert rows[1] == pytest.approx(rows[3], rel=1e-12)


def test_drag_that_the_model_states_stays_that_of_its_body():
    custom = '<numeric name="quadratic_damping:b1" data="50 60 70 1 2 3"/>'
    model = build(split(0, 3), custom=custom)
    damping = resolve_damping(Damping(), model, find_hulls(model), 1000.0)
    assert damping.group.tolist() == [0, -1, 0]
    assert damping.quadratic[1].tolist() == [50, 60, 70, 1, 2, 3]
    data = move(model, VELOCITY, np.zeros(3))
    found = drag_of(model, data, Silhouette(), current=(0, 0, 0))[2, 0]
    assert found == pytest.approx(-50.0 * 0.8**2)


@pytest.mark.parametrize("viscous", [Silhouette(), Panels()])
def test_shares_of_the_drag_move_all_members_as_one(viscous):
    model = build(split(0, 3))
    model.body_mass[2], model.body_inertia[2] = 0.01, [1e-5, 2e-5, 2e-5]
    data = move(model, VELOCITY, SPIN)
    rows = drag_of(model, data, viscous)[1:]
    angular = np.linalg.solve(np.diag(model.body_inertia[1]), rows[0, 3:])
    for row, mass, inertia, at in zip(
        rows, model.body_mass[1:], model.body_inertia[1:], data.xipos[1:], strict=True
    ):
        linear = rows[0, :3] / model.body_mass[1] + np.cross(angular, at - data.xipos[1])
        assert row[:3] / mass == pytest.approx(linear, rel=1e-9)
        assert row[3:] / inertia == pytest.approx(angular, rel=1e-9)


def test_however_members_move_drag_takes_energy_from_them():
    model = build(split(0, 3))
    model.body_mass[2], model.body_inertia[2] = 0.01, [1e-5, 2e-5, 2e-5]
    buoyancy = Buoyancy(model, Water())
    data = mujoco.MjData(model)
    random = np.random.default_rng(4)
    for _ in range(50):
        data.qvel[:] = random.normal(size=model.nv)
        mujoco.mj_forward(model, data)
        rows = buoyancy.evaluate(data).by_cause["drag"]
        velocity = np.zeros(6)
        power = 0.0
        for body in range(1, model.nbody):
            mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_BODY, body, velocity, 0)
            power += rows[body, 3:] @ velocity[:3] + rows[body, :3] @ velocity[3:]
        assert power < 0.0


# which faces are seen, and which meet water


def test_the_faces_that_rays_see_first_are_those_that_trimesh_finds():
    mesh = shapes.capsule(0.1, 0.2).transformed(_turn(0.7), [0.0, 0.1, 0.0])
    seen = np.full((2, 12, 12), -1, np.int64)
    low, step = np.array([-0.3, -0.2]), np.array([0.05, 0.05])
    x, y, z = mesh.vertices.T
    see(x, y, z, mesh.faces, low, step, seen)
    u, v = np.meshgrid(*(low[i] + (np.arange(12) + 0.5) * step[i] for i in range(2)), indexing="ij")
    solid = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
    for index, height in enumerate((-1.0, 1.0)):
        origins = np.column_stack([u.ravel(), v.ravel(), np.full(u.size, height)])
        expected = solid.ray.intersects_first(origins, np.tile([0.0, 0.0, -height], (u.size, 1)))
        assert (expected >= 0).sum() > 20
        assert seen[index].ravel().tolist() == expected.tolist()


def test_windings_say_which_points_a_mesh_encloses():
    mesh = shapes.capsule(0.1, 0.2).transformed(_turn(0.7))
    random = np.random.default_rng(2)
    points = random.uniform(-0.3, 0.3, (500, 3))
    points = points[np.argsort(points[:, 0])]
    windings = np.empty(500, np.int64)
    count_windings(mesh.vertices, mesh.faces, points, windings)
    inside = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False).contains(points)
    assert inside.sum() > 20
    assert windings.tolist() == inside.astype(int).tolist()


def _turn(angle):
    """Rotation about y."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def test_halves_of_a_sphere_show_what_the_sphere_shows():
    ball = shapes.sphere(0.2)
    solid = trimesh.Trimesh(ball.vertices, ball.faces)
    halves = [
        solid.slice_plane([0.0, 0.0, 0.0], [side, 0.0, 0.0], cap=True) for side in (-1.0, 1.0)
    ]
    whole = measure_silhouettes([ball], np.zeros(3))
    both = measure_silhouettes([TriMesh(h.vertices, h.faces) for h in halves], np.zeros(3))
    # a sphere's mean square cosine is 1/2, and int sin^2 over it 8/3 pi r^2
    assert whole.bluffness == pytest.approx([0.5] * 3, rel=1e-2)
    assert whole.walls == pytest.approx([8.0 / 3.0 * math.pi * 0.04] * 3, rel=1e-2)
    assert both.bluffness == pytest.approx(whole.bluffness, rel=1e-3)
    assert both.walls == pytest.approx(whole.walls, rel=1e-2)


def exposure_of(model):
    """Exposed area of each hull [m^2], as it meets water alone and welded (h, 2)."""
    hulls = find_hulls(model)
    packed = PackedHulls(
        HullSet(
            [hull.mesh for hull in hulls],
            frames=[hull.geom for hull in hulls],
            bodies=np.array([hull.body for hull in hulls]),
            turns=[hull.body_from_geom for hull in hulls],
            fills=[1.0] * len(hulls),
        ),
        Water(),
    ).hulls
    groups = group_welded_bodies(model, sorted({hull.body for hull in hulls}))
    exposure = measure_exposure(packed, hulls, groups)
    exposed = exposure.parts * packed.sizes[exposure.faces, None]
    spans = packed.spans[packed.nodes] + exposure.shifts[:, None]
    return np.array([exposed[first:end].sum(axis=0) for first, end in spans[:, :2]])


def test_faces_between_welded_halves_do_not_meet_water():
    # each half is 0.4 x 0.4 x 0.2 m, and 0.4 x 0.2 m of it lie against the other
    assert exposure_of(build(split(0))) == pytest.approx(
        np.array([[0.64, 0.56], [0.64, 0.56]]), rel=1e-9
    )


def test_a_face_that_is_covered_in_part_meets_water_with_the_rest():
    # a cube of 10 cm on a plate of 40 x 40 x 20 cm
    model = build([((0, 0, 0), (0.2, 0.2, 0.1)), ((0.02, 0.01, 0.15), (0.05, 0.05, 0.05))])
    plate, cube = exposure_of(model)[:, 1]
    assert cube == pytest.approx(0.05, rel=1e-9)
    assert plate == pytest.approx(0.64 - 0.01, abs=0.01)


def test_hulls_of_one_body_that_touch_have_the_drag_of_one():
    drags = []
    for parts in (WHOLE, split(1)):
        geoms = "".join(
            geom(half).replace("<geom", f'<geom pos="{p[0]} {p[1]} {p[2]}"') for p, half in parts
        )
        model = mujoco.MjModel.from_xml_string(
            f"<mujoco><worldbody><body><freejoint/>{geoms}</body></worldbody></mujoco>".replace(
                "<body>", '<body pos="0 0 -3">'
            )
        )
        for viscous in (Silhouette(), Panels()):
            data = move(model, VELOCITY, np.zeros(3))
            drags.append(total(data, drag_of(model, data, viscous)))
    assert drags[2] == pytest.approx(drags[0], rel=1e-9, abs=1e-9)
    assert drags[3] == pytest.approx(drags[1], rel=1e-9, abs=1e-9)


def test_added_mass_that_is_estimated_of_welded_bodies_one_by_one_is_told():
    spec = mujoco.MjSpec.from_string(
        "<mujoco><worldbody>"
        '<body name="port" pos="0 .2 0"><freejoint/><geom type="sphere" size=".1"/></body>'
        '<body name="starboard" pos="0 -.2 0"><freejoint/><geom type="sphere" size=".1"/></body>'
        '</worldbody><equality><weld body1="port" body2="starboard"/></equality></mujoco>'
    )
    model = spec.compile()
    with pytest.warns(BuoyancyWarning) as told:
        Buoyancy(model, added_mass="ellipsoid")
    assert str(told[0].message) == (
        "the added mass of bodies 'port', 'starboard' is estimated for each of them alone, and "
        "welds hold them together; make them one body, or state it by numerics 'added_mass:BODY'"
    )
    # what is stated is not told of
    Buoyancy(model, added_mass={"port": [2.0] * 3 + [0.0] * 3, "starboard": [2.0] * 3 + [0.0] * 3})
