"""Bodies drawn through a box: the flow about one that slips, limits, and the dilute series."""

import math

import numpy as np
import pytest

from mesokit.theory import (
    cubic_array_drag,
    disk_friction_in_square,
    einstein_diffusion,
    slip_sphere_diffusion,
    sphere_friction_in_cube,
    square_array_drag,
)


def mobility(radius, box, slip=0.0):
    """Over that of Stokes."""
    return 6 * math.pi * radius / sphere_friction_in_cube(radius, box, 1.0, slip)


@pytest.mark.parametrize("ratio", [0.02, 0.1, 0.2])
def test_without_slip_it_is_the_array_of_fixed_spheres(ratio):
    fraction = 4 / 3 * math.pi * ratio**3
    found = mobility(3.0, 3.0 / ratio)
    assert found == pytest.approx(1 / cubic_array_drag(fraction))
    series = 1 - 2.8373 * ratio + fraction - 27.4 * ratio**6
    assert found == pytest.approx(series, rel=2e-3)


def flow_of_slipping_sphere(x, slip):
    """(1 + s R^2/6 Laplacian) of the flow of a point force along z, with R = eta = 1."""
    r = np.linalg.norm(x, axis=1)[:, None]
    out = x / r
    along = np.array([0.0, 0.0, 1.0])
    s = 1 / (1 + 2 * slip)
    oseen = (along + out[:, 2:] * out) / r
    return (oseen + s / 3 * (along - 3 * out[:, 2:] * out) / r**3) / (8 * math.pi)


@pytest.mark.parametrize("slip", [0.0, 0.1, 2.0])
def test_slip_of_a_sphere_obeys_its_surface(slip):
    """It has no flow through it, and slips by b times the shear: so the speed and the form of its
    images are right, which by reciprocity have the same factor s twice."""
    n = np.array([[0.6, 0.0, 0.8], [0.48, 0.64, 0.6], [1.0, 0.0, 0.0]])
    h = 1e-5
    speed = np.array([0.0, 0.0, 1 / sphere_friction_in_cube(1.0, 1e8, 1.0, slip)])
    flow = flow_of_slipping_sphere(n, slip)
    slopes = np.stack(
        [
            (flow_of_slipping_sphere(n + d, slip) - flow_of_slipping_sphere(n - d, slip)) / (2 * h)
            for d in h * np.eye(3)
        ],
        -1,
    )
    stress = np.einsum("nij,nj->ni", slopes + np.swapaxes(slopes, 1, 2), n)
    along = stress - (stress * n).sum(1)[:, None] * n
    assert flow - speed == pytest.approx(slip * along, abs=1e-8)


@pytest.mark.parametrize("slip", [0.1, 2.0])
def test_third_term_of_a_sphere_that_slips(slip):
    """The images of point forces and what s makes of their curvature: 4 pi/3 s (R/L)^3."""
    ratio = 0.05
    rest = mobility(1.0, 1 / ratio, slip) - (1 + 3 * slip) / (1 + 2 * slip) + 2.837297 * ratio
    assert rest == pytest.approx(4 / 3 * math.pi * ratio**3 / (1 + 2 * slip), rel=0.02)


def test_perfect_slip():
    smooth = slip_sphere_diffusion(1.0, viscosity=2.0, box_length=25.0, kT=1.3)
    friction = sphere_friction_in_cube(1.0, 25.0, 2.0, slip=1e9)
    assert einstein_diffusion(friction, 1.3) == pytest.approx(smooth, rel=1e-5)


@pytest.mark.parametrize("slip", [0.0, 0.05, 0.5, 1e6])
@pytest.mark.parametrize("fraction", [0.001, 0.01])
def test_disks_that_slip(fraction, slip):
    dilute = -0.5 * math.log(fraction) - 0.738 + slip / (1 + 2 * slip) + fraction / (1 + 2 * slip)
    found = square_array_drag(fraction, slip)
    assert found == pytest.approx(4 * math.pi / dilute, rel=3e-4)
    box = 3.0 * math.sqrt(math.pi / fraction)
    assert disk_friction_in_square(3.0, box, 1.7, 3.0 * slip) == pytest.approx(1.7 * found)


def test_drawn_bodies_refuse():
    with pytest.raises(ValueError, match="slip = -1"):
        sphere_friction_in_cube(1, 10, 1, -1)
    with pytest.raises(ValueError, match=r"^radius = 6, box_length = 10: .* at most 0\.5 of"):
        sphere_friction_in_cube(6, 10, 1)
    with pytest.raises(ValueError, match=r"^radius = 5, box_length = 10: .* at most 0\.472 of"):
        disk_friction_in_square(5, 10, 1)
    with pytest.raises(ValueError, match="slip = -1"):
        disk_friction_in_square(1, 10, 1, -1)
    with pytest.raises(ValueError, match="friction = 0"):
        einstein_diffusion(0)
