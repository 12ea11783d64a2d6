"""The fourth cumulant of cooling spheres whose collisions a contact time hardly changes."""

import math

import pytest

from mesokit import Box, Case, HardSpheres, Run, theory
from mesokit.method.spheres.common.observe.velocity_cumulant import VelocityCumulant
from mesokit.method.spheres.hard.collision.hard import HardCollision


def known(contact_time):
    collision = HardCollision(0.85, contact_time=contact_time)
    spheres = HardSpheres(number=100, packing_fraction=0.2, collision=collision)
    case = Case(run=Run(0, method="event-driven"), box=Box([20, 20]), spheres=spheres)
    return VelocityCumulant().accumulator(case).theory.value


def test_only_where_it_makes_few_elastic():
    expected = theory.fourth_cumulant(0.85, 2, heated=False)
    for short in (0.0, 1e-8, 1e-3):
        assert known(short) == pytest.approx(expected)
    assert math.isnan(known(0.1))
