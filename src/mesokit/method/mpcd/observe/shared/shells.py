"""Base of profiles in shells: particles are sorted by a distance, not by a coordinate."""

import math
from abc import abstractmethod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.method.mpcd.expected import setting
from mesokit.observe.shared.mode_chi_square import mode_chi_square
from mesokit.seam.engine import RunningFluid, Some, Terms
from mesokit.seam.estimate import Estimate, of_mean, of_ratio
from mesokit.seam.observable import BlockAccumulator
from mesokit.seam.result import Comparison
from mesokit.statistics import Blocks

Array = NDArray[np.floating[Any]]
NUMBER, MASS, ENERGY, MOMENTUM = 0, 1, 2, 3  # rows of the sums; momentum and what follows it


class ShellAccumulator(BlockAccumulator):
    """Block sums of number, mass, m v^2 and momentum along some directions in each shell."""

    def prepare_shells(self, inner: float, outer: float) -> None:
        """Make the sums, of shells of equal width and at least one."""
        per_cell, self.dimension = self.observable.bins_per_cell, self.case.box.dimension
        self.bins = max(round((outer - inner) * per_cell), 1)
        self.edges = np.linspace(inner, outer, self.bins + 1)
        self.centres = (self.edges[1:] + self.edges[:-1]) / 2
        self.blocks = Blocks((MOMENTUM + self.dimension, self.bins))

    @abstractmethod
    def locate(self, r: Array) -> tuple[Array, Array]:
        """Distance (n,) of each particle, and a vector (n, d) of its place that `along` needs.

        By its own row alone, as what `along` does: particles come in pieces, which are others for
        another number of processes.
        """

    @abstractmethod
    def along(self, place: Array, v: Array) -> Array:
        """Velocities (directions, n), the first d of them along directions at right angles."""

    def observe(self, fluid: RunningFluid) -> None:
        mass, kT = self.case.fluid.mass, self.case.fluid.kT
        units = [1.0, mass, kT, *[math.sqrt(mass * kT)] * self.dimension]  # about the size of each
        self.blocks.add(fluid.sums_of_particles(self.terms, self.bins, units))

    def terms(self, some: Some) -> Terms:
        """Shells of those particles that are in one, and what each adds there."""
        distance, place = self.locate(some.positions)
        first, last = self.edges[0], self.edges[-1]
        inside = np.flatnonzero((distance >= first) & (distance < last))
        shell = ((distance[inside] - first) * (self.bins / (last - first))).astype(np.int64)
        shell = np.minimum(shell, self.bins - 1)  # a product may round up
        v, m = some.velocities[inside], some.masses[inside]
        velocities = self.along(place[inside], v)
        return shell, [np.ones(len(m)), m, m * (v**2).sum(axis=1), *(m * velocities)]

    def velocity(self, direction: int) -> Estimate:
        """Mean velocity along one direction in each shell: momentum over mass."""
        sums, _ = self.blocks.sums()
        return of_ratio(sums[:, MOMENTUM + direction], sums[:, MASS])

    def density(self, volumes: Array) -> Estimate:
        """Particles per volume of fluid; nan where there is none."""
        every = of_mean(self.blocks)
        with np.errstate(divide="ignore", invalid="ignore"):
            scale = np.where(volumes > 0, 1 / volumes, np.nan)
        return Estimate(
            every.value[NUMBER] * scale, every.residuals[:, NUMBER] * scale, every.weights
        )

    def temperature(self) -> Estimate:
        """Kinetic energy about the mean velocity of the shell, over the whole run."""
        sums, _ = self.blocks.sums()
        total, moving = sums.sum(axis=0), sums[:, ENERGY].copy()
        for row in range(MOMENTUM, MOMENTUM + self.dimension):
            with np.errstate(divide="ignore", invalid="ignore"):
                u = np.nan_to_num(total[row] / total[MASS])
            moving += u * (u * sums[:, MASS] - 2 * sums[:, row])
        return of_ratio(moving, self.dimension * sums[:, NUMBER])

    @property
    def crowd(self) -> Array:
        """Particles seen in each shell, the weight of its value."""
        return np.asarray(self.blocks.sums()[0][:, NUMBER].sum(axis=0))

    def chi_square(self, estimate: Estimate, expected: Array, note: str) -> list[Comparison]:
        """Chi-square of the profile per degree of freedom: modes over shells, each weighted so that
        noise is the same everywhere."""
        root = np.sqrt(self.crowd)
        _, samples = self.blocks.sums()
        scaled = Estimate(estimate.value * root, estimate.residuals * root, samples.astype(float))
        return mode_chi_square(scaled, expected * root, periodic=False, note=note)


def periodic_lengths(case: Case) -> Array:
    """Length of the box along each axis, infinite where walls close it."""
    closed = np.isin(range(case.box.dimension), list(setting.closed_axes(case)))
    return np.where(closed, np.inf, np.array(case.box.size, float))


def nearest(away: Array, lengths: Array) -> Array:
    """Vectors (n, k) to the nearest image, of periods (k,) that may be infinite."""
    return away - np.where(np.isfinite(lengths), lengths, 0.0) * np.round(away / lengths)


def shell_volumes(
    edges: Array, distances: Array, shares: Array, side: float, dimension: int
) -> Array:
    """Volume of each shell, from cubes of this side: their distance (n,) and open part (n,).

    A cube lies partly below an edge that goes through it; the volume is good to second order in the
    side.
    """
    below = [(shares * np.clip(0.5 + (edge - distances) / side, 0.0, 1.0)).sum() for edge in edges]
    return np.diff(below) * side**dimension
