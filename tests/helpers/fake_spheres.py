"""Cases of hard spheres and a fake of their engine, for what observables of spheres say."""

from __future__ import annotations

from contextlib import suppress

import numpy as np

from mesokit import Box, Case, HardSpheres, Plates, Run, SphereKind
from mesokit.errors import CaseError
from mesokit.method.spheres.common.engine import SphereEngine
from mesokit.method.spheres.common.made import made


def hard(observe, size=(9, 9), walls=(), **spheres):
    """A case of hard spheres."""
    given = {"number": 20, **spheres}
    return Case(
        run=Run(10, method="event-driven"),
        box=Box(list(size)),
        walls=list(walls),
        observe=list(observe),
        spheres=HardSpheres(**given),
    )


def hard_case_for(observable, **spheres):
    """A case in which it can be measured: plain, of two kinds, or in gravity between plates."""
    two = {"kinds": [SphereKind(1.0), SphereKind(0.5)]}
    fall = {"walls": [Plates("y")], "gravity": (0, -1)}
    for more in ({}, two):
        with suppress(CaseError):
            return hard([observable], **more, **spheres)
    return hard([observable], **fall, **spheres)


class FakeSpheres:
    """Independent spheres, thermal, anywhere in the box; collisions come as told."""

    def __init__(self, case, seed=1, rates=(3.0, 1.0, 0.5), kT=1.0):
        self.case, self.rng, self.rates, self.kT = case, np.random.default_rng(seed), rates, kT
        self.made, self.n = made(case), case.particles
        self.box, self.dimension = np.array(case.box.size, float), case.box.dimension
        self.step, self.collisions, self.virial = 0, (0, 0, 0), 0.0
        self.wall_impulse = np.zeros((2, self.dimension))  # of the two plates
        self.free_times = np.arange(257) / 64, np.zeros(257, int), np.zeros(2)
        self.advance(0)

    def advance(self, steps):
        self.step += steps
        shape = (self.n, self.dimension)
        self.v = self.rng.normal(size=shape) * np.sqrt(self.kT / self.made.masses)[:, None]
        self.r = self.rng.random(shape) * self.box
        events = self.rng.poisson(np.array(self.rates) * steps * self.n)
        self.collisions = tuple(int(x) for x in np.array(self.collisions) + events)
        self.wall_impulse = self.wall_impulse + self.rng.normal(size=(2, self.dimension))
        ended = self.rng.exponential(0.5, size=self.n * (steps + 1))
        edges, counts, sums = self.free_times
        place = np.minimum(ended * 64, 256).astype(int)
        counts = counts + np.bincount(place, minlength=257)
        self.free_times = edges, counts, sums + [ended.sum(), (ended**2).sum()]
        self.virial += self.rng.exponential(self.n * (steps + 1))

    @property
    def time(self):
        return 1.0 * self.step

    def positions(self, ids=None, unwrapped=False):
        return self.r if ids is None else self.r[ids]

    def velocities(self, ids=None):
        return self.v if ids is None else self.v[ids]

    def masses(self, ids=None):
        return self.made.masses if ids is None else self.made.masses[ids]

    def diameters(self, ids=None):
        return self.made.diameters

    def moments(self, axes, bins, ids=None):
        return SphereEngine.moments(self, axes, bins, ids)

    def energies(self):
        return {"translation": self.totals()[2], "rotation": 1.0, "potential": 0.0}

    def totals(self):
        m = self.made.masses
        return self.n, m @ self.v, 0.5 * float(m @ (self.v**2).sum(axis=1))
