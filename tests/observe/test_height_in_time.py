"""Height in gravity in time: of a bouncing ball as theory says, of others without theory."""

import math

import numpy as np
import pytest

from mesokit import (
    Box,
    HardCollision,
    HardSpheres,
    HeightInTime,
    LatticeStart,
    Plates,
    Run,
    Simulation,
    SoftSpheres,
    Surface,
    SurfaceContact,
    theory,
)
from tests.helpers.comparisons import comparisons

CONTACT_TIMES = (0.0, 0.3, 0.01)


def bounced(contact_time, steps=1200, warmup=0, lower=None, gravity=-1.0, **spheres):
    simulation = Simulation(
        run=Run(steps, warmup=warmup, method="event-driven"),
        box=Box([3, 3]),
        walls=[Plates("y", **({} if lower is None else {"lower": lower}))],
        spheres=HardSpheres(
            **{
                "number": 1,
                "kT": 0,
                "gravity": (0, gravity),
                "timestep": 0.01,
                "start": LatticeStart("square"),
                "collision": HardCollision(0.8, contact_time=contact_time),
                **spheres,
            }
        ),
        observe=[HeightInTime(every=1)],
    )
    simulation.run()
    return simulation["height-in-time"]


@pytest.mark.parametrize("warmup", [0, 100, 333])
@pytest.mark.parametrize("contact_time", CONTACT_TIMES)
def test_a_ball_is_where_theory_has_it(contact_time, warmup):
    result = bounced(contact_time, 1200 - warmup, warmup)
    np.testing.assert_allclose(result.value, result.expected, atol=1e-9)
    for comparison in comparisons(result):
        assert comparison.measured == pytest.approx(comparison.expected, rel=1e-6)


def test_with_a_contact_time_it_goes_on_for_ever():
    result = bounced(0.3, steps=3000)
    np.testing.assert_allclose(result.value, result.expected, atol=1e-8)
    known = theory.bounce_height(1.0, 0.8, theory.dissipative_bounces(1.0, 1.0, 0.8, 0.3))
    assert result["height above"].measured == pytest.approx(known, rel=1e-6)
    assert result.value[1400:].max() - 0.5 == pytest.approx(known, rel=1e-2)


def test_the_floor_of_its_own_and_gravity_upwards():
    floor = Surface(contact=SurfaceContact(restitution=0.5))
    result = bounced(0.0, 400, lower=floor)
    np.testing.assert_allclose(result.value, result.expected, atol=1e-9)
    assert result.comparisons[1].expected == 0.25**4  # four bounces
    result = bounced(0.0, 400, gravity=1.0)
    np.testing.assert_allclose(result.value, result.expected, atol=1e-9)


def test_without_theory():
    floor = Surface(contact=SurfaceContact(amplitude=0.1, frequency=3.0))
    for result in (bounced(0.3, 50, lower=floor), bounced(0.3, 50, number=2)):
        assert result.expected is None
        assert math.isnan(result["height at the end"].expected)


def test_soft_spheres_have_a_centre_of_mass():
    simulation = Simulation(
        run=Run(100, method="soft-spheres"),
        box=Box([4, 8]),
        walls=[Plates("y")],
        spheres=SoftSpheres(number=5, kT=0, gravity=(0, -1), timestep=1e-3),
        observe=[HeightInTime(every=1)],
    )
    simulation.run()
    result = simulation["height-in-time"]
    fallen = result.value[0] - 0.5 * result.x["time"] ** 2
    np.testing.assert_allclose(result.value, fallen, atol=1e-9)
    np.testing.assert_allclose(result.extra["velocity"], -result.x["time"], atol=1e-9)
