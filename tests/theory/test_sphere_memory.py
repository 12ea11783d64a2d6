"""How a sphere forgets its velocity and its angular velocity in a viscous fluid."""

import math

import numpy as np
import pytest

from mesokit.theory import (
    angular_vacf_tail,
    sphere_angular_vacf,
    sphere_friction_in_cube,
    sphere_vacf,
    vacf_tail,
)

RADIUS, NU, RHO = 2.0, 0.4, 10.0
DISPLACED = RHO * 4 / 3 * math.pi * RADIUS**3


@pytest.mark.parametrize("heavy", [0.5, 0.625, 1.0, 4.0])  # 0.625: a double root
def test_velocity_begins_with_half_of_the_displaced_fluid_and_integrates_to_D(heavy):
    mass = heavy * DISPLACED
    t = np.geomspace(1e-9, 1e7, 3000)
    kept = sphere_vacf(t, RADIUS, NU, RHO, mass, kT=2.0)
    assert kept[0] == pytest.approx(2.0 / (mass + DISPLACED / 2), rel=2e-4)
    diffusion = np.trapezoid(kept * t, np.log(t))
    assert diffusion == pytest.approx(2.0 / (6 * math.pi * NU * RHO * RADIUS), rel=2e-3)
    assert diffusion == pytest.approx(
        2.0 / sphere_friction_in_cube(RADIUS, 1e9, NU * RHO), rel=2e-3
    )


@pytest.mark.parametrize("heavy", [0.5, 1.0, 4.0])
def test_angular_velocity_begins_at_equipartition_and_integrates_to_D_r(heavy):
    inertia = 0.4 * heavy * DISPLACED * RADIUS**2
    t = np.geomspace(1e-9, 1e7, 3000)
    kept = sphere_angular_vacf(t, RADIUS, NU, RHO, inertia, kT=2.0)
    assert kept[0] == pytest.approx(2.0 / inertia, rel=2e-4)
    turning = np.trapezoid(kept * t, np.log(t))
    assert turning == pytest.approx(2.0 / (8 * math.pi * NU * RHO * RADIUS**3), rel=2e-3)


@pytest.mark.parametrize("heavy", [1e3, 1e6, 1e9])
def test_heavy_spheres_lose_their_motion_as_fast_as_friction_says(heavy):
    """As exp(-zeta t/M), zeta of a steady motion: the fluid follows at once."""
    mass = heavy * DISPLACED
    inertia, t = 0.4 * mass * RADIUS**2, np.array([0.3, 1.0, 2.0]) * heavy
    lost = 6 * math.pi * NU * RHO * RADIUS / mass
    turned = 8 * math.pi * NU * RHO * RADIUS**3 / inertia
    near = 3 / math.sqrt(heavy)  # the first order of the memory
    kept = sphere_vacf(t, RADIUS, NU, RHO, mass) * mass
    assert kept == pytest.approx(np.exp(-lost * t), rel=near)
    kept = sphere_angular_vacf(t, RADIUS, NU, RHO, inertia) * inertia
    assert kept == pytest.approx(np.exp(-turned * t), rel=near)


def test_both_end_in_their_tails():
    t = np.array([1e5, 1e6])
    given = {"viscosity": NU, "diffusion": 0.0, "density": RHO, "dimension": 3}
    kept = sphere_vacf(t, RADIUS, NU, RHO, DISPLACED)
    assert kept == pytest.approx(vacf_tail(t, **given), rel=1e-3)
    turned = sphere_angular_vacf(t, RADIUS, NU, RHO, 0.4 * DISPLACED * RADIUS**2)
    assert turned == pytest.approx(angular_vacf_tail(t, **given), rel=1e-3)


@pytest.mark.parametrize("wrong", [{"radius": 0}, {"viscosity": -1}, {"density": 0}, {"kT": 0}])
def test_values_out_of_range_are_refused(wrong):
    given = {"radius": 2, "viscosity": 0.4, "density": 10, "kT": 1.0} | wrong
    (name,) = wrong
    with pytest.raises(ValueError, match=name):
        sphere_vacf(1.0, mass=300, **given)
    with pytest.raises(ValueError, match=name):
        sphere_angular_vacf(1.0, inertia=500, **given)
    with pytest.raises(ValueError, match="time"):
        sphere_vacf(0.0, 2, 0.4, 10, 300)
