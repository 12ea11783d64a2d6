"""Walls with friction of their own beside soft spheres that have none among themselves."""

import numpy as np
import pytest

from mesokit import Case, CaseError, Plates, SphereKind, SpringDashpot, Surface, SurfaceContact
from mesokit.case.box import Box
from mesokit.case.run import Run
from mesokit.method.spheres.soft.section import SoftSpheres
from tests.helpers.soft_spheres import at_rest, soft

ROUGH = Surface(contact=SurfaceContact(friction=0.6))


@pytest.mark.parametrize("tangential", ["history", "viscous"])
def test_they_act_as_those_of_rough_spheres(tangential):
    """A wall remembers how far a sphere slid, whether or not spheres rub one another."""
    found = []
    for friction in (0.0, 0.2):
        law = SpringDashpot(0.3, contact_time=0.01, friction=friction, tangential=tangential)
        place = [[5.0, 0.4995]]
        engine = soft(
            [40.0, 5.0], walls=[Plates("y", lower=ROUGH)],
            given=at_rest(place, velocities=np.array([[0.8, 0.0]])), number=1, pair=law,
            kinds=[SphereKind(mass=1.0)], gravity=[0.0, -10.0],
        )  # fmt: skip
        engine.advance(3000)
        found.append((engine.velocities(), engine.spins()))
    for one, other in zip(*found, strict=True):
        np.testing.assert_array_equal(one, other)
    assert found[0][0][0, 0] == pytest.approx(0.8 / 1.5, rel=1e-3)  # it rolls


def test_friction_of_a_mirror_is_refused():
    wall = Plates("y", upper=Surface(rule="slip", contact=SurfaceContact(friction=0.3)))
    with pytest.raises(CaseError, match=r"wall\[#1\]\.upper\.contact\.friction = 0\.3: no effect"):
        Case(
            run=Run(1, method="soft-spheres"),
            box=Box([9, 9]),
            walls=[wall],
            spheres=SoftSpheres(number=4),
        )
