"""Flows that are known, as a run would have kept them, and a solid to draw in."""

from __future__ import annotations

import numpy as np

from mesokit import DensityField, FlowFrames, VelocityField
from tests.helpers.fake_fluid import FakeFluid

SPIN = 0.25


class Rotating(FakeFluid):
    """Particles that turn about the middle of the box like a rigid body."""

    def velocities(self, ids=None):
        x, y = (self.positions() - self.box / 2)[:, :2].T
        v = np.zeros((self.n, self.dimension))
        v[:, 0], v[:, 1] = -SPIN * y, SPIN * x
        return v if ids is None else v[ids]


class Disk:
    """A disk, or a cylinder along z, of radius 3 about (6, 5)."""

    def distance(self, points):
        return np.linalg.norm(points[:, :2] - (6, 5), axis=1) - 3


def results_of(case, samples=20, fluid=None):
    """Results of the observables of a case, by name."""
    fluid = fluid or Rotating(case)
    accumulators = {observable.label: observable.accumulator(case) for observable in case.observe}
    for _ in range(samples):
        fluid.jump(10)
        for accumulator in accumulators.values():
            accumulator.observe(fluid)
    return {name: accumulator.result() for name, accumulator in accumulators.items()}


FRAMES = FlowFrames(window=50)
MAPS = (VelocityField(), DensityField())
