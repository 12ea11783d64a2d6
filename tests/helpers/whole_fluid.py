"""What fluids of tests, which have all particles, answer where an engine goes piece by piece."""

from __future__ import annotations

import numpy as np


class All:
    """All of the particles that are asked for, as observables are shown some of them."""

    def __init__(self, fluid, ids):
        self.fluid, self.ids = fluid, ids

    def __getattr__(self, name):
        return getattr(self.fluid, name)(self.ids)


def in_bins(found, bins):
    place, terms = found
    return np.stack([np.bincount(place, term, bins) for term in terms])


class AtOnce:
    """A fluid in one piece."""

    def sums_of_particles(self, of, bins, units, first=0, last=None):
        return in_bins(of(All(self, np.arange(first, self.n if last is None else last))), bins)

    def sums_of_bonds(self, of, bins, units, kind):
        ways = self.bond_vectors()[kind]
        return in_bins(of(np.arange(len(ways)), ways), bins)
