"""Laws of contacts and of simple fluids beside integrals of their equations."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mesokit import theory


def collide(force, mass, ends):
    """Speed at the end of a contact that begins at speed 1, its duration and its deepest point."""

    def right(t, y):
        return [y[1], -force(y[0], y[1]) / mass]

    def end(t, y):
        return ends(y[0], y[1]) if t > 0 else 1.0

    end.terminal, end.direction = True, -1
    found = solve_ivp(
        right, (0, 10), [0.0, 1.0], "DOP853", events=end, rtol=1e-11, atol=1e-15, max_step=1e-4
    )
    return -found.y[1, -1], found.t[-1], found.y[0].max()


@pytest.mark.parametrize("damping", [20.0, 150.0, 400.0, 600.0])
@pytest.mark.parametrize("pulls", [True, False])
def test_spring_dashpot_beside_its_equation(damping, pulls):
    known = theory.spring_dashpot(1e5, damping, 0.5, pulls)
    if pulls and damping > 2 * math.sqrt(0.5e5):
        assert known == (0.0, math.inf)
        return

    def force(x, v):
        return 1e5 * x + damping * v

    ends = (lambda x, v: x) if pulls else force
    speed, duration, _ = collide(force, 0.5, ends)
    assert known.restitution == pytest.approx(speed, rel=1e-6)
    assert known.time == pytest.approx(duration, rel=1e-6)


def test_hertz_beside_its_equation():
    known = theory.hertz_contact(1e6, 0.5, 1.0)
    speed, duration, overlap = collide(lambda x, v: 1e6 * max(x, 0) ** 1.5, 0.5, lambda x, v: x)
    assert speed == pytest.approx(1.0, rel=1e-6)
    assert known.time == pytest.approx(duration, rel=1e-5)
    assert known.overlap == pytest.approx(overlap, rel=1e-4)


def test_second_virial_coefficient_of_lennard_jones():
    """Boyle's temperature is 3.417928 without a cut-off (Hirschfelder, Curtiss and Bird 1954)."""

    def energy(r):
        return 4 * (r**-12 - r**-6)

    unit = 2 * math.pi / 3
    assert theory.second_virial(energy, 3.417928, 60.0, 3) / unit == pytest.approx(0, abs=1e-4)
    assert theory.second_virial(energy, 1.0, 60.0, 3) / unit == pytest.approx(-2.538081, abs=1e-4)


def test_second_virial_coefficient_of_disks():
    def energy(r):
        return np.inf if r < 1 else 0.0

    assert theory.second_virial(energy, 1.0, 1.0, 2) == pytest.approx(math.pi / 2)


def test_tail_is_the_integral_beyond_the_cut_off():
    r = np.linspace(3, 300, 400_001)
    u, w = 4 * (r**-12.0 - r**-6.0), 24 * (2 * r**-12.0 - r**-6.0)
    tail = theory.lennard_jones_tail(0.8, 3.0)
    assert tail.energy == pytest.approx(0.8 / 2 * np.trapezoid(4 * np.pi * r**2 * u, r), rel=1e-4)
    pressure = 0.8**2 / 6 * np.trapezoid(4 * np.pi * r**2 * w, r)
    assert tail.pressure == pytest.approx(pressure, rel=1e-4)


def test_slope_at_the_limit_of_rolling():
    """At the steepest slope on which it rolls both accelerations are the same."""
    for kappa in (0.4, 0.5):
        angle = math.atan(0.3 * (1 + 1 / kappa))
        rolls = theory.down_slope(angle * (1 - 1e-12), 0.3, 9.8, kappa)
        slides = theory.down_slope(angle * (1 + 1e-12), 0.3, 9.8, kappa)
        assert rolls.rolls
        assert not slides.rolls
        assert rolls.acceleration == pytest.approx(slides.acceleration)
