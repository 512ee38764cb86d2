import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from buoyancy_mj import submerge
from buoyancy_mj.meshes import shapes


@pytest.mark.parametrize(
    ("mesh", "volume"),
    [
        (shapes.box((0.3, 0.2, 0.1)), 0.048),
        (shapes.sphere(0.7), 4.0 / 3.0 * np.pi * 0.343),
        (shapes.ellipsoid((0.5, 0.3, 0.2)), 4.0 / 3.0 * np.pi * 0.03),
        (shapes.cylinder(0.2, 0.5), np.pi * 0.04),
        (shapes.capsule(0.2, 0.5), np.pi * 0.04 * (1.0 + 4.0 / 3.0 * 0.2)),
    ],
)
def test_a_primitive_has_its_true_volume_about_its_middle(mesh, volume):
    assert mesh.volume == pytest.approx(volume, rel=1e-12)
    assert mesh.centroid == pytest.approx(np.zeros(3), abs=1e-12)


@pytest.mark.parametrize("draft", [0.2, 0.5, 1.0, 1.5])
def test_a_cap_of_the_sphere_is_right_to_a_thousandth(draft):
    # pi h^2 (3 R - h) / 3
    wet = submerge(shapes.sphere(1.0), (0.0, 0.0, 1.0 - draft))
    assert wet.volume == pytest.approx(np.pi * draft**2 * (3.0 - draft) / 3.0, abs=1e-3 * 4.18879)


def test_a_cylinder_and_a_capsule_stand_along_z():
    assert np.ptp(shapes.cylinder(0.2, 0.5).vertices[:, 2]) == pytest.approx(1.0)
    assert np.ptp(shapes.capsule(0.2, 0.5).vertices[:, 2]) == pytest.approx(1.4)


size = st.floats(-4.0, 3.0).map(lambda exponent: 10.0**exponent)


@given(size, size, size)
def test_any_size_and_slenderness_is_a_closed_solid_of_the_true_volume(a, b, c):
    for mesh, volume in (
        (shapes.box((a, b, c)), 8.0 * a * b * c),
        (shapes.ellipsoid((a, b, c)), 4.0 / 3.0 * np.pi * a * b * c),
        (shapes.cylinder(a, b), 2.0 * np.pi * a**2 * b),
        (shapes.capsule(a, b), np.pi * a**2 * (2.0 * b + 4.0 / 3.0 * a)),
    ):
        assert mesh.volume == pytest.approx(volume, rel=1e-9)


@pytest.mark.parametrize("draft", [0.1, 0.3, 0.55])
def test_a_standing_capsule_and_cylinder_have_their_volume_to_a_thousandth(draft):
    # cap and tube of a capsule of radius 0.2 and half length 0.3
    tube = max(draft - 0.2, 0.0)
    h = min(draft, 0.2)
    capsule = np.pi * h**2 * (0.6 - h) / 3.0 + np.pi * 0.04 * tube
    whole = np.pi * 0.04 * (0.6 + 0.8 / 3.0)
    assert submerge(shapes.capsule(0.2, 0.3), (0, 0, 0.5 - draft)).volume == pytest.approx(
        capsule, abs=1e-3 * whole
    )
    assert submerge(shapes.cylinder(0.2, 0.3), (0, 0, 0.3 - draft)).volume == pytest.approx(
        np.pi * 0.04 * draft, rel=1e-12
    )
