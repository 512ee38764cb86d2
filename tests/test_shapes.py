import numpy as np
import pytest

from buoyancy_mj import shapes, submerge


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
