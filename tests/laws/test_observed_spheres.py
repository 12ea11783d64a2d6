"""What observables of hard spheres say of real ones, beside theory."""

import numpy as np
import pytest
from hard_spheres import gas

from mesokit import (
    CollisionRate,
    HardCollision,
    HeightProfile,
    Kicks,
    Plates,
    VelocityCumulant,
    theory,
)


def observed(simulation):
    """The comparisons of its only observable, after the run."""
    simulation.run()
    (observable,) = simulation.case.observe
    return simulation[observable.label].comparisons


def test_elastic_disks_collide_as_often_as_their_pressure_says():
    (rate,) = observed(
        gas([40, 40], 200, observe=[CollisionRate(every=1)], packing_fraction=0.4, timestep=0.5)
    )
    assert abs(rate.measured / rate.expected - 1) < 3 * rate.error / rate.expected
    assert rate.error / rate.expected < 5e-3


@pytest.mark.parametrize("product", [0.1, 0.3])
def test_contact_time_makes_a_known_share_elastic(product):
    rate = 2 * 2 * (theory.compressibility(0.25, 2) - 1) / np.sqrt(np.pi)  # mass and kT are 1
    contact = HardCollision(1.0, contact_time=product / rate)
    pairs, elastic = observed(
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


def test_kicked_inelastic_spheres_have_the_fourth_cumulant_of_theory():
    case = {"collision": HardCollision(0.4), "heating": Kicks(1.0), "timestep": 0.5}
    (found,) = observed(
        gas(
            [40, 40, 40],
            100,
            observe=[VelocityCumulant(every=1)],
            packing_fraction=0.05,
            **case,
        )
    )
    assert found.error < 0.004
    assert abs(found.measured - found.expected) < 3 * found.error + 0.1 * found.expected


def test_a_dilute_gas_lies_as_the_barometric_law_says():
    (height,) = observed(
        gas(
            [200, 60],
            150,
            walls=[Plates("y")],
            observe=[HeightProfile(every=1)],
            number=400,
            packing_fraction=0.0005,
            gravity=(0, -0.05),
            timestep=20.0,
        )
    )
    assert abs(height.measured - height.expected) < 3 * height.error + 0.01 * height.expected
