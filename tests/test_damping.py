"""Damping matrices, radiated waves and drag by panels: closed forms, limits, stable steps."""

import math

import mujoco
import numpy as np
import pytest

from buoyancy_mj import (
    Buoyancy,
    Damping,
    MethodError,
    ModelError,
    Panels,
    RegularWave,
    Silhouette,
    Water,
)
from buoyancy_mj.meshes import shapes
from tests.naive import panel_drag, roll

LINEAR = np.array(
    [
        [9.0, 1.0, 0.0, 0.0, 0.5, 0.0],
        [1.0, 12.0, 0.0, -0.4, 0.0, 1.5],
        [0.0, 0.0, 20.0, 0.0, -0.8, 0.0],
        [0.0, -0.4, 0.0, 0.6, 0.0, 0.0],
        [0.5, 0.0, -0.8, 0.0, 0.9, 0.1],
        [0.0, 1.5, 0.0, 0.0, 0.1, 0.8],
    ]
)
QUADRATIC = 3.0 * np.diag([5.0, 8.0, 11.0, 0.3, 0.4, 0.5]) + 0.2 * LINEAR


def of(custom, geom='<geom type="box" size=".3 .2 .1" mass="24"/>', pos="0 0 -2", option=""):
    """A free body 'b' with numerics."""
    text = "".join(
        f'<numeric name="{name}:b" data="{" ".join(map(str, np.ravel(data).tolist()))}"/>'
        for name, data in custom.items()
    )
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="0.001" {option}/><custom>{text}</custom>'
        f'<worldbody><body name="b" pos="{pos}"><freejoint/>'
        f'<inertial pos=".02 -.01 -.03" mass="24" diaginertia=".5 .8 1.1"/>{geom}'
        "</body></worldbody></mujoco>"
    )


def moving(model, velocity, turn=0.4):
    """Its data with the body at a velocity (6,) along its own axes, of its origin."""
    data = mujoco.MjData(model)
    data.qpos[3:7] = [math.cos(turn / 2), math.sin(turn / 2), 0.0, 0.0]
    data.qvel[:3], data.qvel[3:] = roll(turn) @ velocity[:3], velocity[3:]
    mujoco.mj_forward(model, data)
    return data


def test_matrices_act_as_fossen_has_them_at_the_origin():
    model, v = (
        of({"linear_damping": LINEAR, "quadratic_damping": QUADRATIC}),
        np.array([0.7, -0.3, 0.4, 0.5, -0.8, 0.2]),
    )
    data = moving(model, v)
    found = Buoyancy(model).evaluate(data).by_cause["drag"][1]
    # Fossen 2021, 6.4: D v + D_n(v) v
    expected = -(LINEAR + QUADRATIC * np.abs(v)) @ v
    turn = roll(0.4)
    force, torque = turn @ expected[:3], turn @ expected[3:]
    assert found[:3] == pytest.approx(force, rel=1e-12)
    assert found[3:] == pytest.approx(
        torque + np.cross(data.xpos[1] - data.xipos[1], force), rel=1e-12
    )


def test_a_diagonal_matrix_about_the_centroid_is_six_numbers():
    six = np.array([5.0, 8.0, 11.0, 0.3, 0.4, 0.5])
    v = np.array([0.7, -0.3, 0.4, 0.5, -0.8, 0.2])
    loads = []
    for linear, quadratic in ((six, 2.0 * six), (np.diag(six), 2.0 * six)):
        model = of({"linear_damping": linear, "quadratic_damping": quadratic})
        loads.append(Buoyancy(model).evaluate(moving(model, v)).by_cause["drag"][1])
    # the box is centred on the origin
    assert loads[1] == pytest.approx(loads[0], rel=1e-9)


@pytest.mark.parametrize("native", [False, True])
@pytest.mark.parametrize("integrator", ["Euler", "implicitfast", "RK4"])
def test_however_strong_matrices_are_they_only_slow_down(native, integrator):
    model = of(
        {"linear_damping": 1e5 * LINEAR, "quadratic_damping": 1e5 * QUADRATIC},
        option=f'integrator="{integrator}"',
    )
    model.opt.timestep = 0.01
    model.opt.gravity[2] = 0.0
    data = moving(model, np.array([0.7, -0.3, 0.4, 0.5, -0.8, 0.2]))
    energies = []
    with Buoyancy(model).installed(native=native):
        for _ in range(100):
            mujoco.mj_step(model, data)
            mujoco.mj_energyVel(model, data)
            energies.append(data.energy[1])
    assert np.isfinite(energies).all()
    assert energies[-1] < 1e-3 * 8.0
    assert (np.diff(energies) <= 1e-12).all()


@pytest.mark.parametrize("panels", [False, True])
def test_compiled_and_python_passes_agree(panels):
    custom = {"radiation_damping": [50.0, 4.0, 6.0]}
    if not panels:
        custom |= {"linear_damping": LINEAR, "quadratic_damping": QUADRATIC}
    model = of(custom, pos="0 0 0.02", option='integrator="implicitfast"')
    water = Water(waves=RegularWave(0.05, period=2.0), current=(0.3, -0.1, 0.0))
    ends = []
    for native in (False, True):
        data = moving(model, np.array([0.3, -0.3, 0.2, 0.5, -0.8, 0.2]))
        buoyancy = Buoyancy(
            model, water, damping=Damping(viscous=Panels() if panels else Silhouette())
        )
        with buoyancy.installed(native=native):
            mujoco.mj_step(model, data, 200)
        ends.append(
            np.concatenate(
                [data.qpos, data.qvel, *(w[1] for w in buoyancy.loads(data).by_cause.values())]
            )
        )
    assert np.array_equal(*ends)


# waves made


def test_radiation_takes_from_heave_roll_and_pitch_at_the_surface_alone():
    model = of({"radiation_damping": [50.0, 4.0, 6.0]}, pos="0 0 0")
    v = np.array([0.2, 0.1, 0.3, 0.5, -0.8, 0.2])
    data = moving(model, v, turn=0.0)
    buoyancy = Buoyancy(model, damping=Damping(viscous=None))
    loads = buoyancy.evaluate(data)
    # half in the water: its whole waterplane, at the centroid 5 cm down
    at = v[:3] + np.cross(v[3:], [0.0, 0.0, -0.05])
    expected = np.array([0.0, 0.0, -50.0 * at[2], -4.0 * 0.5, 6.0 * 0.8, 0.0])
    found = loads.by_cause["radiation"][1]
    assert found[:3] == pytest.approx(expected[:3], abs=1e-9)
    arm = np.array([0.0, 0.0, -0.05]) - data.xipos[1]
    assert found[3:] == pytest.approx(expected[3:] + np.cross(arm, expected[:3]), abs=1e-9)
    assert not loads.by_cause["drag"].any()
    # far under the surface it makes no waves
    data.qpos[2] = -3.0
    mujoco.mj_forward(model, data)
    assert not buoyancy.evaluate(data).by_cause["radiation"].any()
    # and each can be switched off
    assert "radiation" not in Buoyancy(model, damping=Damping(radiation=False)).causes
    assert "radiation" not in Buoyancy(model, damping=None).causes
    assert "radiation" not in Buoyancy(of({})).causes


@pytest.mark.parametrize("method", ["sections", "convex_hull"])
def test_methods_that_know_no_waterplane_refuse_radiation_damping_by_the_body(method):
    model = of({"radiation_damping": [50.0, 4.0, 6.0]}, pos="0 0 0")
    with pytest.raises(MethodError) as caught:
        Buoyancy(model, Water(), method=method)
    assert str(caught.value) == (
        f"the radiation damping of body 'b' needs the method 'exact', not '{method}', "
        "which knows no waterplane; leave it out, Damping(radiation=False), "
        "in a scene damping.radiation = false"
    )
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    without = Buoyancy(model, Water(), method=method, damping=Damping(radiation=False))
    assert np.isfinite(without.evaluate(data).xfrc).all()


def test_the_decay_of_heave_is_that_of_its_radiation():
    # (m + A) z'' + b z' + rho g S z = 0: ratio of a crest to the next exp(-pi b / (m_all w)) per
    # half period
    model = of(
        {"radiation_damping": [60.0, 0.0, 0.0], "added_mass": [0, 0, 36.0, 0, 0, 0]}, pos="0 0 0.01"
    )
    model.body_ipos[1], model.opt.timestep = [0.0, 0.0, -1e-3], 0.002
    data = mujoco.MjData(model)
    heights = []
    with Buoyancy(model, damping=Damping(viscous=None)).installed():
        for _ in range(1500):
            mujoco.mj_step(model, data)
            heights.append(data.qpos[2])
    heights = np.array(heights)
    # half of the added mass is wet, of 24 kg that float at half their 10 cm
    mass, b, c = 24.0 + 18.0, 60.0, 1000.0 * 9.81 * 0.6 * 0.4
    rate, omega = b / (2 * mass), math.sqrt(c / mass - (b / (2 * mass)) ** 2)
    turns = heights[1:-1][(np.diff(heights)[1:] * np.diff(heights)[:-1]) < 0]
    assert np.abs(turns[1:4] / turns[:3]) == pytest.approx(
        [math.exp(-rate * math.pi / omega)] * 3, rel=0.02
    )


# panels


def drag_of(geom, velocity, **options):
    """Drag on a body fully in the water at a velocity (6,)."""
    model = of({}, geom)
    data = moving(model, np.asarray(velocity, float), turn=0.0)
    return (
        Buoyancy(model, Water(density=1025.0), damping=Damping(viscous=Panels(**options)))
        .evaluate(data)
        .by_cause["drag"][1]
    )


@pytest.mark.parametrize("depth", [2.0, 0.05, -0.03])
def test_panels_are_as_one_by_one_on_a_hull_that_turns_in_the_surface(depth):
    model = of({}, '<geom type="capsule" size=".2 .3" mass="24"/>', pos=f"0 0 {-depth}")
    data = moving(model, np.array([0.5, -0.3, 0.2, 0.4, -0.7, 0.6]))
    data.qpos[2] = -depth
    mujoco.mj_forward(model, data)
    buoyancy = Buoyancy(model, Water(density=1025.0), damping=Damping(viscous=Panels()))
    found = buoyancy.evaluate(data)

    # friction by the speed at the middle of what is wet
    turn, origin, centre = data.geom_xmat[0].reshape(3, 3), data.geom_xpos[0], data.xipos[1]
    mesh, spin = shapes.capsule(0.2, 0.3), data.cvel[1, :3]
    velocity = data.cvel[1, 3:] + np.cross(spin, centre - data.subtree_com[1])
    length = np.ptp(mesh.vertices, axis=0).max()
    friction = 0.075 / (math.log10(np.linalg.norm(velocity) * length / 1.19e-6) - 2.0) ** 2
    one_by_one = panel_drag(
        mesh.vertices[mesh.faces] @ turn.T + origin,
        velocity,
        spin,
        centre,
        leading=1.05 * 2.0 / 3.0,
        trailing=1.05 / 3.0,
        friction=friction,
        density=1025.0,
    )
    assert found.by_cause["drag"][1] == pytest.approx(one_by_one, rel=1e-9, abs=1e-9)


def test_a_plate_across_the_flow_has_the_coefficient_of_a_flat_face():
    found = drag_of('<geom type="box" size=".001 .3 .2" mass="24"/>', [0.5, 0, 0, 0, 0, 0])
    assert found[0] == pytest.approx(-0.5 * 1025.0 * 1.05 * 0.24 * 0.25, rel=5e-3)


def test_along_the_flow_a_plate_has_the_skin_friction_of_the_ittc():
    speed, length = 2.0, 2.0
    found = drag_of(
        f'<geom type="box" size="{length / 2} .0001 .5" mass="24"/>', [speed, 0, 0, 0, 0, 0]
    )
    # ITTC 1957: Re 3.36e6, C_F 0.00366
    coefficient = 0.075 / (math.log10(speed * length / 1.19e-6) - 2.0) ** 2
    assert coefficient == pytest.approx(0.00366, rel=1e-2)
    sides = 2.0 * length * 1.0
    edges = 0.5 * 1025.0 * 1.05 * 0.0002 * 1.0 * speed**2
    assert found[0] == pytest.approx(
        -0.5 * 1025.0 * coefficient * sides * speed**2 - edges, rel=5e-3
    )


def test_a_sphere_has_half_the_coefficient_and_no_torque():
    # int cos^3 over a hemisphere's silhouette is half of it
    found = drag_of('<geom type="sphere" size=".2" mass="24"/>', [0.0, 0, -0.5, 0, 0, 0])
    pressure = 0.5 * 1025.0 * 0.5 * 1.05 * math.pi * 0.04 * 0.25
    assert found[2] == pytest.approx(pressure, rel=0.05)
    assert found[2] > pressure * 0.99
    assert found[:2] == pytest.approx([0.0, 0.0], abs=1e-3 * pressure)


def test_half_in_the_water_a_hull_has_half_of_it():
    model = of({}, pos="0 0 0")
    water, options = Water(), Damping(viscous=Panels())
    half = Buoyancy(model, water, damping=options).evaluate(
        moving(model, np.array([0.5, 0, 0, 0, 0, 0]), 0.0)
    )
    model.body_pos[1] = [0, 0, -2.0]
    data = moving(model, np.array([0.5, 0, 0, 0, 0, 0]), 0.0)
    data.qpos[2] = -2.0
    mujoco.mj_forward(model, data)
    whole = Buoyancy(model, water, damping=options).evaluate(data)
    faces = 0.5 * 1000 * 1.05 * 0.08 * 0.25
    assert half.by_cause["drag"][1, 0] == pytest.approx(-0.5 * faces, rel=0.06)
    assert whole.by_cause["drag"][1, 0] == pytest.approx(-faces, rel=0.06)


@pytest.mark.parametrize("native", [False, True])
def test_panels_only_slow_a_light_body_down(native):
    model = of({}, '<geom type="box" size=".5 .5 .01" mass="1"/>')
    model.body_mass[1], model.body_inertia[1] = 0.2, [0.01, 0.01, 0.02]
    model.opt.timestep, model.opt.gravity[2] = 0.01, 0.0
    data = moving(model, np.array([0.5, 0.3, 8.0, 3.0, -9.0, 1.0]))
    energies = []
    with Buoyancy(model, damping=Damping(viscous=Panels())).installed(native=native):
        for _ in range(100):
            mujoco.mj_step(model, data)
            mujoco.mj_energyVel(model, data)
            energies.append(data.energy[1])
    assert np.isfinite(energies).all()
    assert max(energies) == energies[0]
    assert energies[-1] < 0.05 * energies[0]


# bad input


@pytest.mark.parametrize(
    ("custom", "message"),
    [
        (
            {"linear_damping": [1.0, 2.0]},
            r"the linear damping of body 'b' is \[1.0, 2.0\]; it must be 6 numbers .* or all 36",
        ),
        ({"linear_damping": [-1.0, 0, 0, 0, 0, 0]}, "it must be 6 numbers of at least 0"),
        ({"quadratic_damping": -QUADRATIC}, "has a negative eigenvalue, .*check the signs"),
        (
            {"radiation_damping": [1.0, 2.0]},
            "the radiation damping of body 'b' .* 3 numbers of at least 0: heave, roll, pitch",
        ),
    ],
)
def test_damping_that_makes_no_sense_is_refused(custom, message):
    with pytest.raises(ModelError, match=message):
        Buoyancy(of(custom))


def test_impossible_options_of_damping_are_refused():
    with pytest.raises(
        ModelError, match=r"damping viscous is 3; it must be Silhouette\(\), Panels\(\)"
    ):
        Damping(viscous=3)
    with pytest.raises(ModelError, match="damping radiation is 3; it must be true or false"):
        Damping(radiation=3)
    with pytest.raises(ModelError, match="damping viscosity is 0; panels need one"):
        Damping(viscous=Panels(viscosity=0.0))
    with pytest.raises(
        MethodError, match="drag by panels needs the method 'exact', not 'convex_hull'"
    ):
        Buoyancy(of({}), damping=Damping(viscous=Panels()), method="convex_hull")
