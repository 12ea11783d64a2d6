"""Rotation of bodies: torques by quadrature over surfaces, lattice sums, equations of motion."""

import math

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from mesokit.theory import (
    angular_vacf_tail,
    jeffery_angle,
    jeffery_period,
    orientation_memory,
    rotational_friction,
    spin_in_shear,
)


@pytest.mark.parametrize("aspect", [0.4, 1.0, 2.0, 3.0])
def test_jeffery_solves_his_equation(aspect):
    """dphi/dt = rate (r^2 cos^2 + sin^2)/(r^2 + 1), phi from the gradient."""
    times = np.linspace(0, 40, 30)

    def turn(_, phi):
        return 0.7 * (aspect**2 * np.cos(phi) ** 2 + np.sin(phi) ** 2) / (aspect**2 + 1)

    solved = solve_ivp(turn, (0, 40), [0.0], t_eval=times, rtol=1e-10, atol=1e-10).y[0]
    assert jeffery_angle(times, aspect, 0.7) == pytest.approx(solved, abs=1e-6)
    whole = quad(lambda phi: 1 / turn(0, phi), 0, 2 * math.pi)[0]
    assert jeffery_period(aspect, 0.7) == pytest.approx(whole)
    assert jeffery_angle(whole, aspect, 0.7) == pytest.approx(2 * math.pi)


def torque(flow, d, share, viscosity, radius):
    """About z on a sphere or disk, with the share of the stress that is eta d_n u alone."""
    h = 1e-4
    nodes, weights = np.polynomial.legendre.leggauss(12)
    phi = 2 * np.pi * (np.arange(16) + 0.5) / 16
    z = nodes if d == 3 else np.zeros(1)
    area = np.repeat(weights if d == 3 else np.ones(1), 16) * 2 * np.pi / 16 * radius ** (d - 1)
    rho = np.sqrt(1 - z**2)
    parts = [np.outer(rho, np.cos(phi)), np.outer(rho, np.sin(phi)), np.outer(z, np.ones(16))]
    normal = np.stack(parts[:d], -1).reshape(-1, d)
    at = radius * normal
    slopes = np.stack([(flow(at + s) - flow(at - s)) / (2 * h) for s in h * np.eye(d)], -1)
    across = np.einsum("nij,nj->ni", slopes, normal)
    back = np.einsum("nji,nj->ni", slopes, normal)
    stress = viscosity * (across + (1 - share) * back)
    return (area * (at[:, 0] * stress[:, 1] - at[:, 1] * stress[:, 0])).sum()


def whirl(d, vorticity, strength):
    """Rigid rotation and the flow of a turning body, about z."""

    def flow(x):
        turn = np.zeros_like(x)
        turn[:, 0], turn[:, 1] = -x[:, 1], x[:, 0]
        r = np.linalg.norm(x, axis=1)[:, None]
        return turn * (vorticity / 2 + strength / r**d)

    return flow


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("share", [0.0, 0.6])
def test_friction_is_the_torque_on_the_surface(d, share):
    radius, eta, slip = 1.3, 0.7, 0.2
    found = -torque(whirl(d, 0.0, radius**d), d, share, eta, radius)
    assert rotational_friction(radius, eta, d, collisional_share=share) == pytest.approx(found)
    # slip is b/eta times the tangential stress, (d - c) eta for this flow
    slower = 1 + (d - share) * slip / radius
    assert rotational_friction(radius, eta, d, math.inf, slip, share) == pytest.approx(
        found / slower
    )


@pytest.mark.parametrize("d", [2, 3])
def test_spin_is_free_of_torque(d):
    share, vorticity = 0.8, -0.4  # a shear of rate 0.4, less its strain, which has no torque
    spin = -spin_in_shear(0.4, d, share)
    flow = whirl(d, vorticity, (spin - vorticity / 2) * 1.3**d)
    assert torque(flow, d, share, 0.7, 1.3) == pytest.approx(0, abs=1e-6)
    assert spin_in_shear(0.4, d) == pytest.approx(0.2)


def background(d, n):
    """Angular velocity at the place of one of a lattice of unit torques, in a unit box, eta = 1.

    Half the vorticity of torques that are spread as Gaussians, less that of the one alone.
    """
    k = 2 * np.pi * np.stack(np.meshgrid(*[np.arange(-n, n + 1)] * d, indexing="ij"), -1)
    square = (k**2).sum(-1)
    flat = square - (k[..., 2] ** 2 if d == 3 else 0)
    weight = np.where(square > 0, 0.25 * flat / np.where(square > 0, square, 1), 0)
    width = 0.08
    own = 0.25 * (2 / 3 if d == 3 else 1) / (4 * np.pi * width**2) ** (d / 2)
    return (weight * np.exp(-square * width**2)).sum() - own


@pytest.mark.parametrize("d", [2, 3])
def test_images_turn_the_fluid_back(d):
    box, radius, eta = 10.0, 0.5, 0.7
    free = 1 / rotational_friction(radius, eta, d)
    change = 1 / rotational_friction(radius, eta, d, box) - free
    assert change == pytest.approx(background(d, 8) / (eta * box**d), rel=1e-3)
    # a torque T leaves the vorticity 2 T change far away, with which a body spins as in a shear
    share = 0.9
    alone = 1 / rotational_friction(radius, eta, d, math.inf, 0.1, share)
    spin = spin_in_shear(2 * change, d, share) / (1 - share / d)
    found = 1 / rotational_friction(radius, eta, d, box, 0.1, share)
    assert found - alone == pytest.approx(spin, rel=5e-2)
    assert found - alone != pytest.approx(change, rel=0.3)


@pytest.mark.parametrize("d", [2, 3])
def test_spin_in_a_box_balances_the_torques(d):
    """The one of the body against the fluid, and the one of a fluid that turns with it."""
    box, radius, share = 6.0, 1.0, 0.9
    fraction = (math.pi if d == 2 else 4 / 3 * math.pi) / box**d
    spin = spin_in_shear(2.0, d, share, fraction)
    against = rotational_friction(radius, 1.0, d, box) * (spin - 1)
    along = share / d * rotational_friction(radius, 1.0, d) * spin
    assert against == pytest.approx(along)


@pytest.mark.parametrize("d", [2, 3])
def test_tail_is_half_the_vorticity_of_all_modes(d):
    time, nu, diffusion, density, kT, mass = 7.0, 0.6, 0.1, 5, 1.3, 2.0
    around = 2 * np.pi if d == 2 else 4 * np.pi
    per_mode = 0.25 * kT / (density * mass) * (1 if d == 2 else 2 / 3)
    modes = quad(lambda k: k ** (d + 1) * np.exp(-(nu + diffusion) * k**2 * time), 0, np.inf)[0]
    expected = per_mode * around * modes / (2 * np.pi) ** d
    found = angular_vacf_tail(time, nu, diffusion, density, d, kT, mass)
    assert found == pytest.approx(expected)


@pytest.mark.parametrize("d", [2, 3])
def test_memory_of_an_orientation(d):
    """Small turns about each of the axes across, one after the other."""
    step, diffusion = 0.05, 0.3
    nodes, weights = np.polynomial.hermite_e.hermegauss(20)
    angle = np.sqrt(2 * diffusion * step) * nodes
    kept = (weights @ np.cos(angle) / weights.sum()) ** (d - 1)
    assert orientation_memory(20 * step, diffusion, d) == pytest.approx(kept**20, rel=1e-9)


def test_turning_refuses():
    with pytest.raises(ValueError, match="aspect = 0"):
        jeffery_period(0.0, 1.0)
    with pytest.raises(ValueError, match="shear_rate = -1"):
        jeffery_angle(1.0, 2.0, -1)
    with pytest.raises(ValueError, match="at most 1"):
        spin_in_shear(1.0, 3, 1.5)
    with pytest.raises(ValueError, match="box_length = 1"):
        rotational_friction(1.0, 1.0, 3, 1)
    with pytest.raises(ValueError, match="time"):
        angular_vacf_tail(0.0, 1, 1, 5, 2)
    with pytest.raises(ValueError, match="time = -1"):
        orientation_memory(-1, 1, 2)
