"""Beads of solutes leave the fluid's loops alone."""

import numpy as np

from mesokit import ATPlusA, Box, Case, Harmonic, Run
from mesokit.method.mpcd.derived import BYTES, derive
from mesokit.method.mpcd.solutes import Polymer, Solutes
from tests.helpers.small_fluids import make_fluid


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


def test_all_that_a_random_solvent_has_are_beads():
    solutes = Solutes((Polymer(7, length=3, bond=Harmonic(K=1.0)),), mass=5.0, solvent="random")
    engine = make_fluid((9, 8), solutes=solutes)
    every = np.arange(engine.n, engine.n + 21)
    assert engine.n == 0
    for read in (engine.positions, engine.velocities, engine.images, engine.masses):
        np.testing.assert_array_equal(read(), read(every))
    assert engine.positions().shape == (21, 2) and engine.masses().tolist() == [5.0] * 21


def test_cells_of_a_random_solvent_take_little_memory():
    parts = {"run": Run(1), "box": Box([90, 80, 70])}
    fluid = Case(solutes=Solutes((Polymer(50),)), **parts)
    random = Case(solutes=Solutes((Polymer(50),), solvent="random"), **parts)
    many = derive(fluid, 1).memory - BYTES["program"] - fluid.particles * BYTES["particle 3D"]
    assert derive(random, 1).memory - BYTES["program"] < 0.3 * many
