"""What observables of hard spheres say of real ones, beside theory."""

import math

import numpy as np
import pytest

from mesokit import (
    Box,
    CollisionRate,
    HardCollision,
    HeightProfile,
    Kicks,
    KindTemperature,
    Langevin,
    LennardJones,
    Plates,
    Run,
    Simulation,
    SoftSpheres,
    SphereKind,
    VelocityCumulant,
    theory,
)
from tests.helpers.hard_spheres import gas


def observed(simulation):
    """The comparisons of its only observable, after the run."""
    simulation.run()
    (observable,) = simulation.case.observe
    return simulation[observable.label].comparisons


def test_elastic_disks_collide_as_often_as_their_pressure_says():
    rate, path = observed(
        gas([40, 40], 200, observe=[CollisionRate(every=1)], packing_fraction=0.4, timestep=0.5)
    )
    assert abs(path.measured / path.expected - 1) < 3 * path.error / path.expected
    assert abs(rate.measured / rate.expected - 1) < 3 * rate.error / rate.expected
    assert rate.error / rate.expected < 5e-3


@pytest.mark.parametrize(
    ("size", "steps", "fraction", "law"),
    [
        ([600, 600], 2000, 1.11e-3, math.pi / (4 * math.sqrt(2))),
        ([120] * 3, 300, 4.7e-4, math.sqrt(2) / 6),
    ],
)
def test_dilute_spheres_fly_five_hundred_radii(size, steps, fraction, law):
    """Maxwell's mean free path: 1/(sqrt(8) n d) of disks, 1/(sqrt(2) pi n d^2) of spheres."""
    _, path = observed(
        gas(size, steps, observe=[CollisionRate(every=1)], packing_fraction=fraction, timestep=20.0)
    )
    radii = 2 * path.measured
    assert law / fraction == pytest.approx(500, rel=5e-3)
    assert radii == pytest.approx(law / fraction, rel=0.02)
    assert 2 * path.error / radii < 0.01


@pytest.mark.parametrize("product", [0.1, 0.3])
def test_contact_time_makes_a_known_share_elastic(product):
    rate = 2 * 2 * (theory.compressibility(0.25, 2) - 1) / np.sqrt(np.pi)  # mass and kT are 1
    contact = HardCollision(1.0, contact_time=product / rate)
    pairs, elastic, _ = observed(
        gas(
            [80, 80],
            200,
            observe=[CollisionRate(every=1)],
            packing_fraction=0.25,
            timestep=0.5,
            collision=contact,
        )
    )
    share = elastic.measured / pairs.measured
    assert share == pytest.approx(theory.elastic_share(rate, product / rate), rel=0.02)


def test_few_elastic_collisions_have_the_error_of_poisson():
    """None seen is no measurement of a share of 1e-7, and of some ten it is 10 +- sqrt(10)."""
    for contact_time, expected in ((1e-8, False), (1e-3, True)):
        _, elastic, _ = observed(
            gas(
                [20, 20],
                50,
                observe=[CollisionRate(every=1)],
                packing_fraction=0.25,
                timestep=0.5,
                collision=HardCollision(contact_time=contact_time),
            )
        )
        assert np.isfinite(elastic.expected) == expected
        assert "seen" in elastic.note and "expected" in elastic.note
        if expected:
            assert abs(elastic.measured - elastic.expected) < 4 * elastic.error
            assert elastic.approximate and "Poisson" in elastic.note
            assert elastic.error > 0.15 * elastic.expected
        else:
            assert elastic.measured == 0 < elastic.error < 1e-3


def test_kicked_inelastic_spheres_have_the_fourth_cumulant_of_theory():
    simulation = gas(
        [40, 40, 40],
        100,
        observe=[VelocityCumulant(every=1)],
        packing_fraction=0.05,
        collision=HardCollision(0.2),
        heating=Kicks(1.0),
        timestep=0.5,
    )
    simulation.engine.advance(30)  # some 15 collisions of each
    (found,) = observed(simulation)
    # of spheres that cool it would be 0.15: it is the kicks that make it 0.057
    assert found.expected == pytest.approx(0.057, abs=1e-3) and found.error < 0.005
    assert abs(found.measured - found.expected) < 3 * found.error


@pytest.mark.parametrize("restitution", [1.0, 0.7])
def test_kinds_share_energy_where_collisions_are_elastic(restitution):
    simulation = gas(
        [40, 40],
        150,
        observe=[KindTemperature(every=1)],
        packing_fraction=0.2,
        kinds=[SphereKind(1.0, mass=10.0), SphereKind(1.0, mass=1.0)],
        collision=HardCollision(restitution),
        timestep=0.5,
    )
    heavy, light = observed(simulation)
    if restitution == 1:
        for found in (heavy, light):
            assert found.expected == 1 and found.error < 0.03
            assert abs(found.deviation) < 4
    else:  # the heavy ones stay warmer
        assert np.isnan(heavy.expected)
        assert heavy.measured - light.measured > 4 * np.hypot(heavy.error, light.error)


def test_a_dilute_gas_lies_as_the_barometric_law_says():
    simulation = gas(
        [200, 60],
        800,
        walls=[Plates("y")],
        observe=[HeightProfile(every=1)],
        number=400,
        packing_fraction=0.0005,
        gravity=(0, -0.05),
        timestep=20.0,
    )
    simulation.engine.advance(100)  # the lattice falls, and its waves die away
    (height,) = observed(simulation)
    # what disks take from one another is of the order of the fraction that they fill at the floor
    filled = 0.0005 * 60 / 20
    assert height.error < 0.003 * height.expected
    assert abs(height.measured - height.expected) < 3 * height.error + filled * height.expected


def test_a_liquid_in_a_bath_has_velocities_of_maxwell():
    simulation = Simulation(
        run=Run(4000, warmup=500, method="soft-spheres"),
        box=Box([9.0, 9.0, 9.0]),
        spheres=SoftSpheres(
            number=400, pair=LennardJones(), timestep=0.005, thermostat=Langevin(friction=2.0)
        ),
        observe=[VelocityCumulant(every=20)],
        threads=1,
    )
    (found,) = observed(simulation)
    assert found.expected == 0.0 and found.error < 0.01
    assert abs(found.measured) < 3.5 * found.error
