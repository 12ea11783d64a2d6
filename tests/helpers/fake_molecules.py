"""An engine of nothing but molecules that go where a test wants them."""

from __future__ import annotations

import numpy as np

from mesokit import Harmonic, Polymer, Solutes
from tests.helpers.small_fluids import make_case
from tests.helpers.whole_fluid import AtOnce


def case_with(observable, number=1, length=2, size=(20, 20), **parts):
    """Ideal chains (or monomers) in a random solvent."""
    bond = Harmonic(K=1.5) if length > 1 else None
    solutes = Solutes((Polymer(number, length=length),), mass=1.0, bond=bond, solvent="random")
    return make_case(size, [observable], solutes=solutes, **parts)


class Moved(AtOnce):
    """Beads (molecules, length, d) whose places are set before each sample."""

    def __init__(self, case):
        self.case, self.box = case, np.array(case.box.size, float)
        self.dimension, self.n, self.time, self.step = len(self.box), 0, 0.0, 0
        self.r = np.zeros((0, self.dimension))
        self.v = self.r

    def place(self, time, beads, velocities=None):
        self.time, self.r = time, np.reshape(beads, (-1, self.dimension))
        self.v = np.zeros_like(self.r) if velocities is None else velocities
        return self

    def positions(self, ids=None, unwrapped=False):
        r = self.r if ids is None else self.r[ids - self.case.particles]
        return r.copy() if unwrapped else r % self.box

    def whole_positions(self, ids=None):
        return self.positions(ids, unwrapped=True)

    def bond_vectors(self):
        """Of chains."""
        beads = self.r.reshape(-1, self.case.solutes.polymers[0].length, self.dimension)
        return np.diff(beads, axis=1).reshape(-1, self.dimension)

    def velocities(self, ids=None):
        return self.v if ids is None else self.v[ids - self.case.particles]


def followed(observable, case, times, beads):
    """What an observable says of molecules that are at `beads` (times, molecules, length, d)."""
    engine, accumulator = Moved(case), observable.accumulator(case)
    for time, r in zip(times, beads, strict=True):
        accumulator.observe(engine.place(time, r))
    return accumulator
