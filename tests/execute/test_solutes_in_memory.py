"""Beads of solutes leave the fluid's loops alone."""

import numpy as np
from laboratory import make_fluid

from mesokit import ATPlusA
from mesokit.method.mpcd.solutes import Polymer, Solutes


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
