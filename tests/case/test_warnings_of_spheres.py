"""What `mesokit check` warns of in cases of spheres."""

import pytest

from mesokit import (
    Box,
    Case,
    GaussSeidel,
    HardCollision,
    HardSpheres,
    Jacobi,
    LennardJones,
    Plates,
    RigidContact,
    RigidSpheres,
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
BOUNCING = Surface(contact=SurfaceContact(restitution=0.5))
RUBBING_FLOOR = Plates("y", lower=Surface(contact=SurfaceContact(friction=0.5)))


METHODS = {
    HardSpheres: "event-driven",
    SoftSpheres: "soft-spheres",
    RigidSpheres: "contact-dynamics",
}
BED = {**GRAINS, "gravity": [0, -1]}
ELASTIC = RigidContact(friction=0, restitution=1)
SMOOTH, BOUNCY = RigidContact(friction=0), RigidContact(restitution=0.5)


def warnings(spheres, walls):
    method = METHODS[type(spheres)]
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
        (RigidSpheres(**SLOPE, contact=SMOOTH), [Plates("y")], "falls along x"),
        (RigidSpheres(**BED, contact=BOUNCY), [Plates("y")], "in a chain"),
        (RigidSpheres(**BED), [Plates("y", lower=BOUNCING)], "in a chain"),
        (RigidSpheres(**BED, timestep=0.013, solver=GaussSeidel(sweeps=1)), [Plates("y")],
         "spheres.solver.sweeps = 1: too few"),
        (RigidSpheres(**BED, solver=GaussSeidel(tolerance=0)), [Plates("y")], "all 500 sweeps"),
        (RigidSpheres(**BED, solver=Jacobi()), [Plates("y")], "'jacobi': errors of forces grow"),
        (RigidSpheres(**BED, timestep=0.15), [Plates("y")], "takes 9.43 steps"),
        (RigidSpheres(**BED, timestep=0.02), [Plates("y")], "falls through the whole box"),
        (RigidSpheres(packing_fraction=0.75, kT=1.0, contact=ELASTIC), [], "times in a step"),
        (RigidSpheres(**GRAINS, kT=1.0, timestep=0.04), [], "move by 0.12 diameters in a step"),
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
        (RigidSpheres(**SLOPE), [Plates("y")]),
        (RigidSpheres(**SLOPE, contact=SMOOTH), [RUBBING_FLOOR]),
        (RigidSpheres(**BED), [Plates("y")]),
        (RigidSpheres(**BED, solver=Jacobi(relaxation=0.4)), [Plates("y")]),
        (RigidSpheres(**GRAINS, kT=1.0, contact=BOUNCY), []),
    ],
)
def test_nothing_is_said_without_a_reason(spheres, walls):
    said = warnings(spheres, walls)
    for words in (
        "falls along", "collisions elastic", "expected some", "in a chain", "too few", "sweeps",
        "errors of forces", "steps", "whole box", "in a step",
    ):  # fmt: skip
        assert words not in said
