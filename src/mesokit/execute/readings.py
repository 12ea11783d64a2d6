"""What observables ask of a fluid in memory."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mesokit.box import SLIDING
from mesokit.execute import measure
from mesokit.execute.fixed_point import ROUNDER_BITS
from mesokit.execute.layout import LANES, SCRATCH_ROW, sums_length, zeros
from mesokit.execute.memory import Floats, Memory
from mesokit.execute.solute_readings import SoluteReadings
from mesokit.execute.team import Team
from mesokit.mpcd import topology

if TYPE_CHECKING:
    from mesokit.case import Case
    from mesokit.potential import Bond, Pair

Moments = tuple[Floats, Floats, Floats, Floats]


class Readings(Memory):
    """A fluid in memory that can be looked at, by a team of threads."""

    def __init__(self, case: Case, threads: int, measures: Sequence[str]) -> None:
        super().__init__(case, threads, measures)
        self.team = Team(threads)
        self.wall_steps = 0
        self._asked: tuple[NDArray, NDArray[np.int32]] | None = None  # ids, and their slots
        self._seen: dict[tuple, Moments] = {}  # moments at this step, for several observables
        self.stress: dict[str, Floats] = {}
        self.dissolved = SoluteReadings(self) if self.solutes else None

    def totals(self) -> tuple[int, Floats, float]:
        """Number of particles, momentum (d,) and kinetic energy, beads of solutes included."""
        total = self._totals().sum(axis=0)
        number, momentum, energy = (
            self.n,
            total[: self.dimension],
            0.5 * float(total[self.dimension]),
        )
        if self.dissolved is not None:
            beads, theirs, more = self.dissolved.totals()
            number, momentum, energy = number + beads, momentum + theirs, energy + more
        return number, momentum, energy

    def _totals(self) -> Floats:
        out = np.zeros((self.strips[0], self.dimension + 2))
        self.team.run(
            measure.totals, self.physics, self.data, self.filling, self.rows, self.like, out
        )
        return out

    def moments(self, axes: tuple[int, ...], bins: tuple[int, ...]) -> Moments:
        """Number, mass, momentum (d, ...) and sum of m v^2 in bins along one or two axes."""
        key = axes, bins
        if key not in self._seen:
            self._seen[key] = self._moments(axes, bins)
        return self._seen[key]

    def _moments(self, axes: tuple[int, ...], bins: tuple[int, ...]) -> Moments:
        d, threads, size = self.dimension, self.threads, math.prod(bins)
        two = (axes + axes)[:2], tuple(float(n) for n in (*bins, 1)[:2])
        names = ["momentum"] * d + ["mass", "energy"]
        scales = tuple(self.units[name] for name in names)
        length = sums_length(d + 2)
        part = zeros((threads, size * length), np.int64)
        quanta = (
            np.zeros((threads, LANES), np.int32),
            np.zeros((threads, (d + 2) * SCRATCH_ROW), np.int64),
        )
        particles = self.physics, self.box_kernel, self.data, self.filling, self.rows, self.like
        self.team.run(measure.bin_sums, *particles, *two, scales, quanta, part)
        total = part.sum(axis=0).reshape(size, length)[:, : d + 3]
        number, sums = total[:, 0], total[:, 1:] - total[:, :1] * ROUNDER_BITS
        values = (sums / np.array(scales)).T.reshape(-1, *bins)
        return number.astype(float).reshape(bins), values[d], values[:d], values[d + 1]

    def modes(self, wavevectors: NDArray) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
        """Sums of m exp(-i k r) (K,) and of m v exp(-i k r) (K, d) for wave vectors (K, d)."""
        waves = np.ascontiguousarray(wavevectors, float) / (2.0 * math.pi)
        d, scale = self.dimension, self.units["momentum"]
        part = np.zeros((self.threads, len(waves), 2 + 2 * d), np.int64)
        particles = self.physics, self.box_kernel, self.data, self.filling, self.rows, self.like
        self.team.run(measure.modes, *particles, waves, scale, part)
        total = part.sum(axis=0) / scale
        return total[:, 0] + 1j * total[:, 1], total[:, 2 : 2 + d] + 1j * total[:, 2 + d :]

    def positions(self, ids: NDArray | None = None, unwrapped: bool = False) -> Floats:
        """Positions (n, d) by particle id, in the box or as if it had no bounds."""
        return self._gather(ids, unwrapped)[0]

    def velocities(self, ids: NDArray | None = None) -> Floats:
        """Velocities (n, d) by particle id."""
        return self._gather(ids, False)[1]

    def images(self, ids: NDArray | None = None) -> NDArray[np.int32]:
        """How many times each particle left the box along each axis (n, d), by particle id."""
        return self._gather(ids, False)[2]

    def masses(self, ids: NDArray | None = None) -> Floats:
        """Masses (n,) by particle id: kinds are numbered one after the other, then come solutes."""
        mass = np.repeat(self.masses_of_kinds, self.counts)
        if ids is None:
            return mass
        if self.dissolved is not None:
            mass = np.concatenate([mass, self.dissolved.masses()])
        return mass[ids]

    def species(self, ids: NDArray | None = None) -> NDArray[np.int64]:
        """Kind of each particle (n,), by particle id: its place in fluid.species, then those of
        solutes.polymers."""
        kind = np.repeat(np.arange(len(self.counts)), self.counts)
        if ids is None:
            return kind
        if self.dissolved is not None:
            kind = np.concatenate([kind, len(self.counts) + self.dissolved.kinds()])
        return kind[ids]

    def bonds(self) -> NDArray[np.int64]:
        """Particle ids (bonds, 2) of all pairs that are linked; molecule after molecule."""
        molecule = self.case.fluid.molecule
        links = np.array(molecule.bonds if molecule else (), np.int64).reshape(-1, 2)
        starts = np.arange(0, self.n, self.beads)
        return (starts[:, None, None] + links).reshape(-1, 2) if len(links) else links

    def bond_vectors(self) -> Floats:
        """From the first to the second particle of each bond (bonds, d)."""
        if self.dissolved is not None:
            return self.dissolved.bond_vectors()
        return self._between(self.bonds())

    def whole_positions(self, ids: NDArray | None = None) -> Floats:
        """Positions (n, d) by particle id, in the box but for beads that hang over its ends.

        Those are where their molecule has them, next to its first bead, which is in the box.
        `ids`, if given, name molecule after molecule with all of its beads.
        """
        if self.dissolved is not None and ids is not None:
            return self.dissolved.whole()[ids - self.n]
        r, _, image = self._gather(ids, False)
        if self.beads == 1:
            return r
        first = np.repeat(np.arange(0, len(r), self.beads), self.beads)
        return r[first] + self._way(r, image, first, np.arange(len(r)))

    def potential_energy(self) -> float:
        """Of all bonds, angles and pairs of beads, and of solutes near walls."""
        if self.dissolved is not None:
            return self.dissolved.potential_energy()
        molecule = self.case.fluid.molecule
        if molecule is None:
            return 0.0
        starts = np.arange(0, self.n, self.beads)[:, None, None]
        total = self._central_energy(molecule.bond, self.bonds())
        if molecule.pair is not None:
            pairs = (starts + np.array(topology.pairs(self.beads))).reshape(-1, 2)
            total += self._central_energy(molecule.pair, pairs)
        if molecule.bending is not None and molecule.angles:
            beads = (starts + np.array(molecule.angles)).reshape(-1, 3)
            before, after = self._between(beads[:, :2]), self._between(beads[:, 1:])
            out = np.zeros(len(beads))
            measure.angle_energies(molecule.bending.kernel(), before, after, self.like, out)
            total += float(out.sum())
        return total

    def _central_energy(self, potential: Bond | Pair, pairs: NDArray[np.int64]) -> float:
        out = (self._between(pairs) ** 2).sum(axis=1)
        measure.central_energies(potential.kernel(), out)
        return float(out.sum())

    def _between(self, pairs: NDArray[np.int64]) -> Floats:
        """Vectors (n, d) between beads of one molecule."""
        r, _, image = self._gather(None, False)
        return self._way(r, image, *pairs.T)

    def _way(self, r: Floats, image: NDArray, first: NDArray, second: NDArray) -> Floats:
        """From one bead to another, whatever images they lie in."""
        boxes = image[second] - image[first]
        way = r[second] - r[first] + boxes * self.box
        if isinstance(self.box_kernel, SLIDING):
            way[:, 0] += boxes[:, 1] * self.box_kernel.offset
        return way

    def _gather(self, ids: NDArray | None, unwrapped: bool) -> tuple[Floats, Floats, NDArray]:
        """Places, velocities, images by particle id; those of beads of solutes follow the fluid."""
        if self.dissolved is None or ids is None or (ids < self.n).all():
            return self._gather_fluid(ids, unwrapped)
        own = ids < self.n
        r, v, image = self.dissolved.folded()
        if unwrapped:
            r, v = self.dissolved.places, self.dissolved.velocities
        beads = np.where(own, 0, ids - self.n)
        r, v, image = r[beads], v[beads], image[beads]
        if own.any():
            r[own], v[own], image[own] = self._gather_fluid(ids[own], unwrapped)
        return r, v, image

    def _gather_fluid(self, ids: NDArray | None, unwrapped: bool) -> tuple[Floats, Floats, NDArray]:
        slots = np.arange(self.n, dtype=np.int32) if ids is None else self._slots(ids)
        shape = self.n if ids is None else len(ids), self.dimension
        out = np.zeros(shape), np.zeros(shape), np.zeros(shape, np.int32)
        particles = self.data, self.image, self.ident, slots, self.filling, self.rows, self.like
        self.team.run(measure.gather_by_id, self.box_kernel, *particles, unwrapped, *out)
        return out

    def _slots(self, ids: NDArray) -> NDArray[np.int32]:
        """Place of each particle in `ids`, by particle id, -1 if none; kept for the next time."""
        if self._asked is None or not np.array_equal(self._asked[0], ids):
            slots = np.full(self.n, -1, np.int32)
            slots[ids] = np.arange(len(ids))
            self._asked = ids.copy(), slots
        return self._asked[1]

    def _stress(self) -> None:
        """Stress of the step that ends now, positive where the fluid above drags the one below.

        Kinetic: momentum carried in the flight, which is the mean of the values before and after
        the collision. Collisional: momentum handed over within cells (Winkler and Huang 2009).
        Bond: momentum handed over within molecules, the mean over the flight.
        """
        d = self.dimension
        parts = self.tensor.sum(axis=1)
        if self.dissolved is not None:
            theirs = self.dissolved.state_of.tensor.sum(axis=1)
            parts = np.concatenate([parts[:2] + theirs[:2], theirs[2:]])
        before, after, *bond = parts.reshape(-1, 2, d, d)
        volume = math.prod(self.case.box.size)
        self.stress = {
            "kinetic": -0.5 * (before[0] + after[0]) / volume,
            "collisional": -(after[1] - before[1]) / (volume * self.timestep),
        }
        if bond:
            self.stress["bond"] = -bond[0][0] / (volume * self.timestep)

    @property
    def wall_impulse(self) -> Floats:
        """What surfaces took since the last call: momentum (d), then angular momentum (1 or 3).

        A row for each: the lower and upper plate of a slit, or the bodies in order.
        """
        columns = self.dimension + (1 if self.dimension == 2 else 3)
        taken = self.impulse.sum(axis=0).astype(float).reshape(-1, columns) / self.units["momentum"]
        self.impulse[:] = 0
        self.wall_steps = 0
        return taken
