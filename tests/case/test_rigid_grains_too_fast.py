"""Rigid grains too fast for a step, or without room: the run ends in a line with the cause."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from mesokit import Plates, RunError, Surface, SurfaceContact
from mesokit.method.spheres.rigid.engine.ended import Now, too_fast
from mesokit.method.spheres.rigid.solver.jacobi import Jacobi
from mesokit.seam.method import method_of
from tests.helpers.rigid_grains import at_rest, rigid

ROW = [[0.5 + i, 0.5] for i in range(8)]
STEPS = 2000
HEAP = ROW + [[1 + i, 0.5 + np.sqrt(0.75)] for i in range(7)]
DRIVEN = Surface(contact=SurfaceContact(speed=0.5))
FAST = Surface(contact=SurfaceContact(speed=1.2))
LIGHT = Surface(contact=SurfaceContact(force=1e4, mass=1e-3))


def ended(places=HEAP, walls=(), velocity=None, **spheres):
    """What check warns of, and the line in which the run ends."""
    given = at_rest(places)
    given["velocities"][0] = velocity or (0.0, 0.0)
    spheres = {"timestep": 0.01, **spheres}
    engine = rigid((8, 8), [Plates("x"), *walls], given=given, **spheres)
    with pytest.raises(RunError) as refused:
        for _ in range(STEPS // 100):
            engine.advance(100)
            engine.check()
    case = replace(engine.case, run=replace(engine.case.run, steps=STEPS))
    return "\n".join(method_of(case).summary(case, 1).warnings), str(refused.value)


CASES = {
    "jacobi": (
        {"solver": Jacobi(sweeps=200), "gravity": (0, -1), "walls": [Plates("y")]},
        "errors of forces grow from sweep to sweep",
        "spheres.solver.rule = 'jacobi'; expected a smaller relaxation",
    ),
    "plate without end": (
        {"walls": [Plates("y", upper=DRIVEN)]},
        "wall[#2].upper.contact.speed: plates leave grains too little room",
        "expected a smaller wall[#2].upper.contact.travel",
    ),
    "floor that opens": (
        {"walls": [Plates("y", opens=0.1)], "gravity": (0, -1)},
        "wall[#2].opens = 0.1: nothing ends the fall along y afterwards",
        "nothing ends the fall along y since wall[#2] has opened; expected a wall below",
    ),
    "light plate": (
        {"walls": [Plates("y", upper=LIGHT)]},
        "",
        "wall[#2].upper, which is pushed, moves at",
    ),
    "fast grain": (
        {"velocity": (3.0, 30.0)},
        "",
        "grain 0 moves at 30.1, so fast that it passes others within a step: expected a "
        "spheres.timestep below 0.00",
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_the_cause_is_named(name):
    given, warned, said = CASES[name]
    warnings, line = ended(**given)
    assert warned in warnings and said in line and "\n" not in line


@pytest.mark.parametrize(("filled", "expected"), [(0.76, "press grains together"), (0.5, "below")])
def test_plates_are_the_cause_from_when_grains_bear_forces_all_through(filled, expected):
    walls = [Plates("x"), Plates("y", upper=FAST)]
    case = rigid((8, 8), walls, given=at_rest(HEAP), timestep=0.01).case
    now = Now(3.0, np.array([0.1, 19.9]), np.zeros(4), filled)
    assert expected in too_fast(case, now)
