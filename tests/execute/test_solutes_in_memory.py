"""Solutes have the same bits for any threads and any stops, and leave the fluid's loops alone."""

import numpy as np
import pytest
from laboratory import assert_same, fingerprint, make_case, make_fluid

from mesokit import FENE, WCA, ATPlusA, Bending, MaxwellBoltzmann
from mesokit.execute.cpu.engine import CPU
from mesokit.method.mpcd.solutes import Polymer, Solutes

CASES = {
    "sheared": {
        "size": (12, 12, 12), "density": 2, "shear_rate": 0.2, "thermostat": MaxwellBoltzmann(),
        "solutes": Solutes((Polymer(600), Polymer(20, length=9)), mass=3.0, bond=FENE(),
                           bending=Bending(kappa=2.0), pair=WCA(), substeps=30),
    },
    "by a rule that draws": {
        "size": (30, 30), "density": 2, "collision": ATPlusA(),
        "solutes": Solutes((Polymer(800),), mass=4.0),
    },
}  # fmt: skip
STEPS = 40


def everything(fluid):
    return [*fingerprint(fluid), fluid.solutes.places, fluid.solutes.velocities]


@pytest.fixture(scope="module", params=CASES.values(), ids=CASES.keys())
def case(request):
    return request.param


@pytest.fixture(scope="module")
def reference(case):
    fluid = make_fluid(**case, threads=1)
    fluid.advance(STEPS)
    return everything(fluid)


@pytest.mark.parametrize("threads", [2, 3])
def test_for_any_number_of_threads(case, reference, threads):
    fluid = make_fluid(**case, threads=threads)
    fluid.advance(STEPS)
    assert_same(everything(fluid), reference)


@pytest.mark.parametrize("cut", [1, 7])
def test_however_the_steps_are_divided(case, reference, cut):
    fluid = make_fluid(**case)
    while fluid.step < STEPS:
        fluid.advance(min(cut, STEPS - fluid.step))
        fluid.potential_energy()  # looking changes nothing
    assert_same(everything(fluid), reference)


@pytest.mark.parametrize("step", [0, 13])
def test_from_a_state(case, reference, step):
    fluid = make_fluid(**case)
    fluid.advance(step)
    other = CPU(make_case(**case), 3)
    other.restore(fluid.state())
    other.advance(STEPS - step)
    assert_same(everything(other), reference)


def test_beads_far_from_the_fluid_change_nothing():
    """Particles in cells without beads collide as if there were none."""
    found = []
    for solutes in (None, Solutes((Polymer(1),), mass=5.0)):
        fluid = make_fluid((30, 30), density=4, collision=ATPlusA(), solutes=solutes)
        if solutes is not None:
            plain = make_fluid((30, 30), density=4, collision=ATPlusA())
            velocity = plain.velocities()
            fluid.memory.fill(fluid.positions(), velocity, fluid.images())
            np.testing.assert_array_equal(fluid.velocities(), velocity)
            bead = fluid.solutes.places[0].copy()
        fluid.advance(1)
        found.append((fluid.positions(), fluid.velocities()))
    way = np.abs((found[0][0] - bead + 15) % 30 - 15)
    far = (way > 1.5).any(axis=1)
    assert 0 < (~far).sum() < 60
    np.testing.assert_array_equal(found[0][1][far], found[1][1][far])
    assert (found[0][1][~far] != found[1][1][~far]).any()
