"""What `mesokit check` warns of in cases of spheres."""

import pytest

from mesokit import (
    Box,
    Case,
    HardCollision,
    HardSpheres,
    LennardJones,
    Plates,
    Run,
    SoftSpheres,
    SpringDashpot,
    Surface,
    SurfaceContact,
)
from mesokit.seam.method import method_of

GRAINS = {"number": 300}
SLOPE = {**GRAINS, "gravity": [1, -1]}
ROUGH_FLOOR = Plates("y", lower=Surface(contact=SurfaceContact(tangential=0.5)))
RUBBING_FLOOR = Plates("y", lower=Surface(contact=SurfaceContact(friction=0.5)))


def warnings(spheres, walls):
    method = "event-driven" if isinstance(spheres, HardSpheres) else "soft-spheres"
    case = Case(run=Run(1000, method=method), box=Box((40, 40)), spheres=spheres, walls=walls)
    return "\n".join(method_of(case).summary(case, 1).warnings)


@pytest.mark.parametrize(
    ("spheres", "walls", "words"),
    [
        (HardSpheres(**SLOPE), [Plates("y")], "nothing holds what falls along x"),
        (SoftSpheres(**SLOPE, pair=SpringDashpot(friction=0)), [Plates("y")], "falls along x"),
        (HardSpheres(**GRAINS, collision=HardCollision(0.9, contact_time=1e3)), [],
         "makes 100 % of the collisions elastic"),
        (SoftSpheres(number=300, pair=LennardJones(), timestep=0.1), [], "expected some 0.005"),
    ],
)  # fmt: skip
def test_they_are_told(spheres, walls, words):
    assert words in warnings(spheres, walls)


@pytest.mark.parametrize(
    ("spheres", "walls"),
    [
        (HardSpheres(**SLOPE), [ROUGH_FLOOR]),
        (HardSpheres(**SLOPE), [Plates("y"), Plates("x")]),
        (SoftSpheres(**SLOPE, pair=SpringDashpot(friction=0.5)), [Plates("y")]),
        (SoftSpheres(**SLOPE, pair=SpringDashpot(friction=0)), [RUBBING_FLOOR]),
        (HardSpheres(**GRAINS, collision=HardCollision(0.9, contact_time=1e-3)), []),
        (HardSpheres(**GRAINS, collision=HardCollision(1.0, contact_time=1e3)), []),
        (SoftSpheres(number=300, pair=LennardJones(), timestep=0.01), []),
    ],
)
def test_nothing_is_said_without_a_reason(spheres, walls):
    said = warnings(spheres, walls)
    for words in ("falls along", "collisions elastic", "expected some"):
        assert words not in said
