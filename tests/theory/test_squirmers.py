"""Squirmers: the flow obeys Stokes and the surface, and the speed is a mean of the surface."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from mesokit.theory import (
    squirmer_flow,
    squirmer_speed,
    squirmer_speed_in_box,
    squirmer_speed_inertial,
    swimmer_diffusion,
)

RADIUS, H = 1.3, 1e-3
AXES = {2: np.array([0.6, 0.8]), 3: np.array([0.36, 0.48, 0.8])}
strength = st.floats(-1, 1)


def nearby(d):
    """Some places outside the body."""
    return np.array([[1.9, 0.4, -0.7], [-1.1, 1.2, 0.5], [0.3, -2.4, 1.0]])[:, :d]


def surface_velocity(normal, e, B1, B2):
    cosine = normal @ e
    more = B2 * cosine * (1 if len(e) == 3 else 2)
    return (B1 + more)[:, None] * (cosine[:, None] * normal - e)


@pytest.mark.parametrize("d", [2, 3])
@given(B1=strength, B2=strength)
def test_flow_obeys_the_boundary_condition(d, B1, B2):
    normal = nearby(d) / np.linalg.norm(nearby(d), axis=1)[:, None]
    flow = squirmer_flow(normal * RADIUS * (1 + 1e-12), AXES[d], RADIUS, B1, B2)
    moved = squirmer_speed(B1, d) * AXES[d] + surface_velocity(normal, AXES[d], B1, B2)
    assert flow == pytest.approx(moved, abs=1e-9)


def differences(flow, places):
    """Slopes (n, i, j) = d_j u_i and Laplacian of a flow."""
    steps = H * np.eye(places.shape[1])
    ahead, behind = (np.stack([flow(places + s * x) for x in steps], -1) for s in (1, -1))
    return (ahead - behind) / (2 * H), (ahead + behind - 2 * flow(places)[..., None]).sum(-1) / H**2


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize(("B1", "B2"), [(1.0, 0.0), (0.0, 1.0), (0.4, -0.7)])
def test_flow_solves_stokes(d, B1, B2):
    def flow(places):
        return squirmer_flow(places, AXES[d], RADIUS, B1, B2)

    slopes, _ = differences(flow, nearby(d))
    assert np.trace(slopes, axis1=1, axis2=2) == pytest.approx(0, abs=1e-5)
    # grad p = Laplacian of u: its curl vanishes
    turned, _ = differences(lambda places: differences(flow, places)[1], nearby(d))
    assert turned == pytest.approx(np.swapaxes(turned, 1, 2), abs=2e-3)


@pytest.mark.parametrize("d", [2, 3])
def test_flow_in_far_places_falls_off_as_published(d):
    far = 1e3 * nearby(d)[0]
    for B1, B2, power in ((1.0, 0.0, d), (0.0, 1.0, d - 1)):
        near, twice = (
            np.linalg.norm(squirmer_flow(x, AXES[d], 1.0, B1, B2)) for x in (far, 2 * far)
        )
        assert near / twice == pytest.approx(2**power, rel=1e-4)


def test_the_body_moves_as_one():
    flow = squirmer_flow([[0.0, 0.0], [0.5, 0.1]], AXES[2], RADIUS, 1.0, 3.0)
    assert flow == pytest.approx(np.tile(0.5 * AXES[2], (2, 1)))


@pytest.mark.parametrize("aspect", [0.5, 0.999999, 1.0, 1.5, 2.0, 3.0])
@pytest.mark.parametrize("d", [2, 3])
def test_speed_is_minus_the_mean_over_the_surface(d, aspect):
    """Of (n.x) u.e over d volumes: the drag of an ellipsoid is spread as n.x."""
    nodes, weights = np.polynomial.legendre.leggauss(400)
    s = 0.5 * np.pi * (1 + nodes)  # x = aspect cos s, y = sin s
    stretch = np.hypot(aspect * np.sin(s), np.cos(s))
    tangent = aspect * np.sin(s) / stretch  # minus t.e
    support = aspect / stretch
    surface = 0.5 * np.pi * weights * stretch * (2 if d == 2 else 2 * np.pi * np.sin(s))
    volume = np.pi * aspect * (1 if d == 2 else 4 / 3)
    speed = (surface * support * tangent**2).sum() / (d * volume)
    assert squirmer_speed(0.7, d, aspect) == pytest.approx(0.7 * speed, rel=1e-9)


@pytest.mark.parametrize("aspect", [1.01, 2.0, 10.0])
def test_speed_of_prolate_spheroids_is_that_of_keller_and_wu(aspect):
    tau = 1 / np.sqrt(1 - aspect**-2)
    published = tau * (tau - (tau**2 - 1) * np.arctanh(1 / tau))
    assert squirmer_speed(1.0, 3, aspect) == pytest.approx(published, rel=1e-9)


@pytest.mark.parametrize("d", [2, 3])
def test_slip_on_top_of_the_surface_velocity(d):
    """The flow of the dipole D, r^-d, with u_theta = B1 sin - U sin + b shear at R = 1."""
    b, c = 0.3, 0.6
    # u_r = (d - 1) D cos, u_theta = D sin; the shear stress is (2 d - d c) D sin below eta
    dipole = 1 / (d + b * (2 * d - d * c))
    assert squirmer_speed_in_box(squirmer_speed(1.0, d), 0.0, b, c) == pytest.approx(
        (d - 1) * dipole
    )


@pytest.mark.parametrize(("d", "points"), [(2, 800), (3, 120)])
def test_speed_among_images(d, points):
    """The flow of all images at the centre, in the frame where the mean flow of a cell is zero.

    Sums over a ball of images add nothing to that mean, by the symmetry of its surface.
    """
    fraction, axis, reach = 0.1, np.eye(d)[0], 6
    side = (np.pi * (1 if d == 2 else 4 / 3) / fraction) ** (1 / d)
    lattice = np.stack(np.meshgrid(*[np.arange(-reach, reach + 1)] * d), -1).reshape(-1, d)
    away = np.linalg.norm(lattice, axis=1)
    images = lattice[(away > 0) & (away < reach)] * side
    pushed = squirmer_flow(images, axis, 1.0, 1.0, 0.5).sum(0)[0]
    middle = side * ((np.arange(points) + 0.5) / points - 0.5)
    cell = np.stack(np.meshgrid(*[middle] * d), -1)
    mean = squirmer_flow(cell, axis, 1.0, 1.0, 0.5)[..., 0].mean()
    speed = squirmer_speed(1.0, d)
    assert squirmer_speed_in_box(speed, fraction) == pytest.approx(speed + pushed - mean, rel=1e-3)


def fourier_flow(places, axis, side, B1, B2):
    """Flow of a lattice of squirmers of R = 1 as a sum over waves, in the frame without flux.

    Of a dipole and a stresslet with the density of a narrow Gaussian, of which `wide` is undone.
    """
    d, wide = len(axis), 0.25
    number = np.arange(-(n := int(5 / wide * side / (2 * np.pi)) + 1), n + 1)
    k = 2 * np.pi / side * np.stack(np.meshgrid(*[number] * d), -1).reshape(-1, d)
    square = (k**2).sum(1)
    k = k[(np.arange(len(k)) > len(k) // 2) & (square < (5 / wide) ** 2)]  # one of k and -k
    square = (k**2).sum(1)[:, None]
    speed, along = squirmer_speed(B1, d), (k @ axis)[:, None]
    dipole = -2 * np.pi * speed * k * along / square
    stretch = axis * along - k / d  # S.k
    stresslet = 4j * np.pi * B2 * (stretch - k * (along**2 / square - 1 / d)) / square
    stresslet *= 1 + square * (wide**2 / 2 - (1 / 4 if d == 2 else 1 / 6))
    waves = np.exp(-square * wide**2 / 2) * (dipole + stresslet) / side**d
    volume = np.pi if d == 2 else 4 * np.pi / 3
    back = d / (d - 1) * volume / side**d * speed * axis
    return 2 * (np.exp(1j * places @ k.T) @ waves).real - back


@pytest.mark.parametrize(("d", "side"), [(2, 14.0), (3, 12.0)])
def test_flow_among_images_is_a_mean_over_directions(d, side):
    """By Fourier's sum, over directions whose mean has no part of the symmetry of the lattice."""
    if d == 2:
        turns = [Rotation.from_euler("z", 0.125 * np.pi * i).as_matrix()[:2, :2] for i in range(4)]
    else:
        turns = Rotation.create_group("I").as_matrix()
    places = 1.5 * nearby(d)[:1] / np.linalg.norm(nearby(d)[0])
    axis = AXES[d]
    found = [fourier_flow(places @ t.T, t @ axis, side, 0.2, 0.4) @ t for t in turns]
    wide, known = (squirmer_flow(places, axis, 1.0, 0.2, 0.4, volume=v) for v in (None, side**d))
    assert np.mean(found, axis=0) == pytest.approx(known, abs=0.02 * abs(known - wide).max())


@pytest.mark.parametrize("d", [2, 3])
@given(B1=strength, B2=strength, slip=st.floats(0, 1), share=st.floats(0, 1))
def test_slip_of_the_flow(d, B1, B2, slip, share):
    """u_theta at the surface is that of the swimming surface, and b times the shear stress.

    Where stress is not symmetric, the part c of it is that of the slope of u_theta alone.
    """
    e = AXES[d]

    def flow(places):
        return squirmer_flow(places, e, RADIUS, B1, B2, slip / RADIUS, collisional_share=share)

    normal = nearby(d) / np.linalg.norm(nearby(d), axis=1)[:, None]
    toward = (normal @ e)[:, None] * normal - e
    surface = RADIUS * normal * (1 + 2 * H)
    slopes, _ = differences(flow, surface)  # d_j u_i
    ahead = np.einsum("ni,nij,nj->n", toward, slopes, normal)
    whole = ahead + np.einsum("ni,nij,nj->n", normal, slopes, toward)
    stress = (1 - share) * whole + share * ahead
    own = surface_velocity(normal, e, B1, B2)
    body = flow(np.zeros((1, d)))
    slid = ((flow(surface) - body - own) * toward).sum(1)
    assert slid == pytest.approx(slip * stress, abs=0.02)


def test_inertia_slows_pullers():
    assert squirmer_speed_inertial(1.0, 1.0, 0.1) == pytest.approx(0.985)
    assert squirmer_speed_inertial(1.0, -1.0, 0.1) == pytest.approx(1.015)


@pytest.mark.parametrize("d", [2, 3])
def test_diffusion_of_swimmers_is_the_integral_of_their_velocity(d):
    turning, speed = 0.3, 0.7
    t = np.linspace(0, 60, 600001)
    kept = np.exp(-(d - 1) * turning * t)
    assert swimmer_diffusion(0.01, speed, turning, d) == pytest.approx(
        0.01 + speed**2 / d * np.trapezoid(kept, t), rel=1e-6
    )


def test_squirmers_refuse():
    with pytest.raises(ValueError, match="aspect = 0"):
        squirmer_speed(1.0, 3, 0.0)
    with pytest.raises(ValueError, match="expected at most 1"):
        squirmer_speed_in_box(1.0, 1.2)
    with pytest.raises(ValueError, match="reynolds = -1"):
        squirmer_speed_inertial(1.0, 1.0, -1)
    with pytest.raises(ValueError, match="places of"):
        squirmer_flow([1.0, 0.0, 0.0], [1.0, 0.0], 1.0, 1.0, 0.0)
    with pytest.raises(ValueError, match="rotational_diffusion = 0"):
        swimmer_diffusion(0.1, 0.1, 0, 3)
