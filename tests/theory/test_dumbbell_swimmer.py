"""Swimmers with a counter-force on the fluid: the flow of a point force, and that among images."""

import itertools

import numpy as np
import pytest

from mesokit.theory import dumbbell_speed, rotne_prager_in_cube, sphere_friction_in_cube


def test_in_a_wide_fluid_it_is_the_flow_of_the_counter_force_over_the_body():
    """Faxen's law for a force spread over a ball, in closed form."""
    F, R, d, a, eta = 20.0, 2.0, 5.0, 1.5, 4.0
    wide = 1 / (6 * R) - 1 / (4 * d) + R**2 / (12 * d**3) + a**2 / (20 * d**3)
    speed = dumbbell_speed(F, R, d, eta, box_length=1e4, counter_radius=a)
    assert speed == pytest.approx(F / (np.pi * eta) * wide, rel=0.004)
    flat = np.log(d / R) - 0.5 + R**2 / (2 * d**2) + a**2 / (4 * d**2)
    speed = dumbbell_speed(F, R, d, eta, box_length=1e4, dimension=2, counter_radius=a)
    assert speed == pytest.approx(F / (4 * np.pi * eta) * flat, rel=0.004)


def test_in_a_box_it_has_the_flow_of_all_images():
    """By Ewald's sums for a sphere, whose second moment a ball sqrt(5/3) times as large has."""
    R, d, L, eta = 1.0, 3.0, 9.0, 2.0
    signs = [np.array(s) for s in itertools.product((-1, 0, 1), repeat=3) if any(s)]
    # 26 directions, exact for harmonics up to the seventh (Abramowitz and Stegun 25.4.65)
    weights = {1: 40 / 840, 2: 32 / 840, 3: 27 / 840}
    along = 0.0
    for s in signs:
        e = s / np.linalg.norm(s)
        along += weights[int(abs(s).sum())] * (e @ rotne_prager_in_cube(d * e, R, L) @ e)
    own = 1 / sphere_friction_in_cube(R, L, eta)
    expected = own - along / (6 * np.pi * eta * R)
    speed = dumbbell_speed(1.0, R, d, eta, L, counter_radius=R * np.sqrt(5 / 3))
    assert speed == pytest.approx(expected, rel=2e-3)  # as the directions
    assert abs(dumbbell_speed(1.0, R, d, eta, 1e3) / speed - 1) > 0.01  # the box matters


def test_slip_adds_to_the_part_of_its_own_force_alone():
    free, slips = (dumbbell_speed(1.0, 2.0, 5.0, 4.0, 24.0, slip=b) for b in (0.0, 0.2))
    gain = 1 / sphere_friction_in_cube(2, 24, 4, 0.2) - 1 / sphere_friction_in_cube(2, 24, 4)
    assert slips - free == pytest.approx(gain)


def test_a_ball_in_the_body_is_refused():
    with pytest.raises(ValueError, match=r"distance = 2.5: expected at least both radii, 3"):
        dumbbell_speed(1.0, 2.0, 2.5, 4.0, 24.0)
