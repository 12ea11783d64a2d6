"""Sums over particles that are read piece by piece, never all at once.

Each rank has pieces of its own, and so has each order of particles in memory. The terms of a
particle must be the same in any piece: operations act on its own row alone. So there are no matrix
products, and no library functions that take the last few rows in another way than the others. The
sums are exact, so that nothing depends on the pieces.
"""

from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.method.mpcd import topology
from mesokit.method.mpcd.engine.cpu.memory import Floats
from mesokit.method.mpcd.engine.measure import sums as measure
from mesokit.method.mpcd.engine.measure.readings import Observed, Readings
from mesokit.method.mpcd.engine.pieces import pieces
from mesokit.method.mpcd.molecule import Molecule
from mesokit.potential import Bond, Pair
from mesokit.scalar.bin_sums import BinSums

Integers = NDArray[np.int64]
Terms = tuple[Integers, Sequence[NDArray[Any]]]  # bins (m,), and terms (m,) of each kind in them


class Some(NamedTuple):
    """Some particles, whole molecules: numbers (n,), places in the box and velocities (n, d), how
    often each left the box along each axis (n, d), masses (n,)."""

    ids: Integers
    positions: Floats
    velocities: Floats
    images: NDArray[np.int32]
    masses: Floats


class ByPieces:
    """Readings that are found piece by piece; all ranks must call them."""

    def __init__(self, readings: Readings) -> None:
        self.readings, self.memory = readings, readings.memory
        self.n, self.beads = readings.n, readings.beads

    def sums_of_particles(
        self,
        of: Callable[[Some], Terms],
        bins: int,
        units: Sequence[float],
        first: int = 0,
        last: int | None = None,
    ) -> Floats:
        """Sums (terms, bins) of what `of` finds of the particles of the fluid, or of those from one
        number to before another."""
        sums = BinSums(bins, units)
        for some in self._particles(first, self.n if last is None else last):
            sums.add(*of(some))
        return sums.values(self.readings.reduced)

    def sums_of_bonds(
        self,
        of: Callable[[Integers, Floats], Terms],
        bins: int,
        units: Sequence[float],
        kind: slice,
    ) -> Floats:
        """The same of bonds of a kind, counted from 0, and the vectors (n, d) along them."""
        sums = BinSums(bins, units)
        for numbers, separations in self._bonds(kind):
            sums.add(*of(numbers, separations))
        return sums.values(self.readings.reduced)

    def potential_energy(self) -> float:
        """Energy of all bonds, angles and pairs of beads, and of solutes near walls."""
        solutes, molecule = self.readings.solutes, self.readings.numbers.case.fluid.molecule
        beads = 0.0 if solutes is None else solutes.potential_energy()
        if molecule is None:
            return beads
        sums = BinSums(1, [self.readings.numbers.case.fluid.kT])
        for energies in self._energies(molecule):
            sums.add(np.zeros(len(energies), np.int64), [energies])
        return beads + float(sums.values(self.readings.reduced)[0, 0])

    def _particles(self, first: int, last: int) -> Iterator[Some]:
        readings = self.readings
        for molecules in self._molecules(self.beads) if first < self.n else ():
            places = molecules.ravel()
            ids = self.memory.ids(places)
            inside = (ids >= first) & (ids < last)
            places, ids = places[inside], ids[inside]
            yield Some(ids, *readings.seen_at(places, False), readings.masses(ids))
        if last > self.n and readings.solutes is not None:
            beads = readings.solutes.folded()
            ids = np.arange(max(first, self.n), last if readings.counts_solutes else 0)
            r, v, images = (row[ids - self.n] for row in beads)
            yield Some(ids, r, v, images, readings.masses(ids))

    def _molecules(self, each: int) -> Iterator[Integers]:
        """Places in memory (molecules, beads), so many at a time that things of which each molecule
        has so many are no more than a piece."""
        places = self.memory.places.reshape(-1, self.beads)
        for first, last in pieces(0, len(places) * each, each):
            yield places[first // each : last // each]

    def _bonds(self, kind: slice) -> Iterator[tuple[Integers, Floats]]:
        """Numbers of bonds from the first of a kind on, and the vectors."""
        molecule, solutes = self.readings.numbers.case.fluid.molecule, self.readings.solutes
        links = np.array(molecule.bonds if molecule else (), np.int64).reshape(-1, 2)
        own = len(links) * (self.n // self.beads)
        for molecules in self._molecules(max(self.beads, len(links))) if kind.start < own else ():
            numbers = self.memory.ids(molecules[:, 0]) // self.beads * len(links)
            separations = self._between(self._seen(molecules), links)
            yield (numbers[:, None] + np.arange(len(links))).ravel(), separations
        if kind.stop > own and solutes is not None:
            separations = solutes.bond_vectors()[kind.start - own : kind.stop - own]
            number = len(separations) if self.readings.counts_solutes else 0
            yield np.arange(number), separations[:number]

    def _seen(self, molecules: Integers) -> Observed:
        return self.readings.seen_at(molecules.ravel(), False)

    def _between(self, seen: Observed, links: Integers) -> Floats:
        first = np.arange(0, len(seen.positions), self.beads)[:, None, None]
        pairs = (first + links).reshape(-1, 2)
        return self.readings.separation(seen.positions, seen.images, *pairs.T)

    def _energies(self, molecule: Molecule) -> Iterator[Floats]:
        bonds, angles = np.array(molecule.bonds), np.array(molecule.angles or ())
        pairs = np.array(topology.pairs(self.beads) if molecule.pair is not None else ())
        for molecules in self._molecules(max(self.beads, len(bonds), len(angles), len(pairs))):
            seen = self._seen(molecules)
            yield _central(molecule.bond, self._between(seen, bonds))
            if molecule.pair is not None:
                yield _central(molecule.pair, self._between(seen, pairs))
            if molecule.bending is not None and len(angles):
                before, after = (self._between(seen, angles[:, k : k + 2]) for k in range(2))
                out, zero = np.zeros(len(before)), self.memory.physics.zero
                measure.angle_energies(molecule.bending.kernel(), before, after, zero, out)
                yield out


def _central(potential: Bond | Pair, separations: Floats) -> Floats:
    """Energies (n,) of pairs that are so far apart (n, d)."""
    out = np.asarray((separations**2).sum(axis=1))
    measure.central_energies(potential.kernel(), out)
    return out
