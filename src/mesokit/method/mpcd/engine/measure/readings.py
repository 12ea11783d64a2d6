"""Readings of a fluid in memory, for observables."""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.box import SLIDING
from mesokit.loops.layout import LANES, SCRATCH_ROW, strips_for, sums_length, zeros
from mesokit.method.mpcd.engine.beads.readings import SoluteReadings
from mesokit.method.mpcd.engine.bodies.readings import BodyReadings
from mesokit.method.mpcd.engine.cpu.memory import Floats
from mesokit.method.mpcd.engine.measure import sums as measure
from mesokit.scalar.fixed_point import ROUNDER_BITS, added_halves, halves, joined
from mesokit.statistics import Tally

Moments = tuple[Floats, Floats, Floats, Floats]
AT_ONCE = 2**10  # strips of a thread: sums of the terms of more particles may overflow


class Observed(NamedTuple):
    """Readings of some particles, a row for each."""

    positions: Floats
    velocities: Floats
    images: NDArray[np.int32]


class Readings:
    """Readings of a fluid in memory, by all threads together."""

    def __init__(self, memory: Any, threads: Any = None) -> None:
        self.memory, self.numbers, self.threads = memory, memory.numbers, threads
        numbers = memory.numbers
        self.n, self.beads, self.dimension = numbers.n, numbers.beads, numbers.dimension
        self.wall_steps = 0  # since the warm-up
        self._walls = Tally((memory.numbers_taken,), self.numbers.units["momentum"])
        self._asked: NDArray | None = None  # ids, for the next time
        self._slots_of_asked = np.zeros(0, np.int32)
        self._seen: dict[tuple, Moments] = {}  # moments at this step, for several observables
        self.stress: dict[str, Floats] = {}
        self.counts_solutes = True  # whether sums take the beads of solutes from here
        self.solutes = SoluteReadings(memory) if memory.solutes else None
        self.bodies = BodyReadings(memory) if memory.bodies else None

    @property
    def _vectors(self) -> tuple[tuple, tuple]:
        """The zero vector, and the mass of all or (): loops are compiled for these."""
        return self.memory.physics.zero, self.memory.physics.masses

    def forget(self) -> None:
        """The particles have moved on."""
        self._seen.clear()

    def totals(self) -> tuple[int, Floats, float]:
        """Number of particles, momentum (d,) and kinetic energy, beads and bodies included."""
        number, sums = self.n, self.motion()
        if self.solutes is not None:
            number, sums = number + self.solutes.shape[0], sums + self.solutes.motion()
        if self.bodies is not None:
            number, sums = number + self.bodies.number, sums + self.bodies.motion()
        return number, sums[:-1], 0.5 * float(sums[-1])

    def motion(self) -> Floats:
        """Momentum and sum of m v^2 of the fluid (d + 1,)."""
        sums, _ = self._motion_of_strips()
        return self.total(sums, np.array(self.numbers.scales_of_motion))

    def fastest(self) -> float:
        """The largest component of |v| of what is in this memory."""
        _, fastest = self._motion_of_strips()
        return float(fastest.max(initial=0.0))

    def _motion_of_strips(self) -> tuple[NDArray[np.int64], Floats]:
        scales = self.numbers.scales_of_motion
        sums = np.zeros((self.memory.strips, len(scales)), np.int64)
        fastest = np.zeros(self.memory.strips)
        _, masses = self._vectors
        particles = self.memory.fluid.particles
        self.threads.run(measure.totals, masses, particles, scales, sums, fastest)
        return sums, fastest

    def total(self, rows: NDArray[np.int64], scale: Any) -> Floats:
        """Sums over the rows (n, ...) of whole numbers, over the scale."""
        return self.joined(halves(rows), scale)

    def joined(self, parts: NDArray[np.int64], scale: Any) -> Floats:
        """Sums over all ranks, from their halves (see `total`), over the scale."""
        return joined(self.reduced(parts), scale)

    def reduced(self, numbers: NDArray[np.int64]) -> NDArray[np.int64]:
        """The sum over all ranks; here there is one."""
        return numbers

    def moments(self, axes: tuple[int, ...], bins: tuple[int, ...]) -> Moments:
        """Number, mass, momentum (d, ...) and sum of m v^2 in bins along one or two axes."""
        if (axes, bins) not in self._seen:
            self._seen[axes, bins] = self._moments(axes, bins)
        return self._seen[axes, bins]

    def _moments(self, axes: tuple[int, ...], bins: tuple[int, ...]) -> Moments:
        d, threads, size = self.dimension, self.threads.size, math.prod(bins)
        two = (axes + axes)[:2], tuple(float(n) for n in (*bins, 1)[:2])
        names = ["momentum"] * d + ["mass", "energy"]
        scales = tuple(self.numbers.units[name] for name in names)
        length = sums_length(d + 2)
        part = zeros((threads, size * length), np.int64)
        place = np.zeros((threads, LANES), np.int32)
        terms = np.zeros((threads, (d + 2) * SCRATCH_ROW), np.int64)
        where = self.memory.box, self.memory.fluid.particles
        filling: Any = self.memory.fluid.particles.filling
        strips = strips_for(filling.molecules, self.beads)
        sums = np.zeros((2, size, d + 3), np.int64)
        for first in range(0, strips, AT_ONCE * threads):
            part[:] = 0
            last = min(first + AT_ONCE * threads, strips)
            chosen = measure.Bins(*two, scales, place, terms, first, last)
            self.threads.run(measure.bin_sums, *self._vectors, *where, chosen, part)
            found = part.reshape(threads, size, length)[:, :, : d + 3]
            found[:, :, 1:] -= found[:, :, :1] * ROUNDER_BITS
            sums = added_halves(np.stack([sums, halves(found)]))
        values = self.joined(sums, np.array((1.0, *scales))).T.reshape(-1, *bins)
        return values[0], values[d + 1], values[1 : d + 1], values[d + 2]

    def modes(
        self, wavevectors: NDArray, first: int = 0, last: int | None = None
    ) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
        """Sums of m exp(-i k r) (K,) and of m v exp(-i k r) (K, d) for wave vectors (K, d), of all
        particles or of those from one number to before another."""
        turns = np.ascontiguousarray(wavevectors, float) / (2.0 * math.pi)
        d, scale = self.dimension, self.numbers.units["momentum"]
        sums = self._wave_sums(turns, scale, first, self.n if last is None else last)
        total = self.reduced(sums) / scale
        return total[:, 0] + 1j * total[:, 1], total[:, 2 : 2 + d] + 1j * total[:, 2 + d :]

    def _wave_sums(self, turns: Floats, scale: float, first: int, last: int) -> NDArray[np.int64]:
        """The same here, as whole numbers (K, 2 + 2 d)."""
        part = np.zeros((self.threads.size, len(turns), 2 + 2 * self.dimension), np.int64)
        waves, where = measure.Waves(turns, scale, first, last), self.memory.fluid.particles
        self.threads.run(measure.modes, *self._vectors, self.memory.box, where, waves, part)
        return part.sum(axis=0)

    def positions(self, ids: NDArray | None = None, unwrapped: bool = False) -> Floats:
        """Positions (n, d) by particle id, in the box or as if it had no bounds."""
        return self._gather(ids, unwrapped).positions

    def velocities(self, ids: NDArray | None = None) -> Floats:
        """Velocities (n, d) by particle id."""
        return self._gather(ids, False).velocities

    def images(self, ids: NDArray | None = None) -> NDArray[np.int32]:
        """How many times each particle left the box along each axis (n, d), by particle id."""
        return self._gather(ids, False).images

    def masses(self, ids: NDArray | None = None) -> Floats:
        """Masses (n,) by particle id: of kinds one after the other, then solutes, then bodies."""
        ids = self._all_beads(ids)
        if ids is None:
            return self.numbers.masses()
        mass, others = np.zeros(len(ids)), np.asarray(ids) >= self.n
        mass[~others] = self.numbers.masses_of(ids[~others])
        if others.any():
            found = []
            if self.solutes is not None:
                found.append(np.broadcast_to(self.solutes.masses(), self.solutes.shape[:1]))
            if self.bodies is not None:
                found.append(self.bodies.masses)
            mass[others] = np.concatenate(found)[ids[others] - self.n]
        return mass

    def species(self, ids: NDArray | None = None) -> NDArray[np.int64]:
        """Kind of each particle (n,), by particle id: its place in fluid.species, then those of
        solutes.polymers and of bodies."""
        ids = self._all_beads(ids)
        if ids is None:
            return self.numbers.kinds()
        kind = self.numbers.kinds_of(np.minimum(ids, max(self.n - 1, 0)))
        others = ids >= self.n
        if others.any():
            found, before = [], len(self.numbers.counts)
            if self.solutes is not None:
                found.append(before + self.solutes.kinds())
                before += len(self.numbers.case.solutes.polymers)
            if self.bodies is not None:
                found.append(before + self.bodies.kinds)
            kind[others] = np.concatenate(found)[ids[others] - self.n]
        return kind

    def orientations(self, ids: NDArray) -> Floats:
        """Unit quaternions (n, 4) of bodies, by particle id; beads have that of the box."""
        bodies, rows = self._rows_of_bodies(ids)
        return np.where(
            rows[:, None] < 0, [1.0, 0.0, 0.0, 0.0], bodies.orientations[np.maximum(rows, 0)]
        )

    def spins(self, ids: NDArray) -> Floats:
        """Angular velocities of bodies, by particle id: (n,) about z in 2D, (n, 3) in 3D; beads
        have none."""
        bodies, rows = self._rows_of_bodies(ids)
        found = np.where(rows[:, None] < 0, 0.0, bodies.spins[np.maximum(rows, 0)])
        return found[:, 2] if self.dimension == 2 else found

    def _rows_of_bodies(self, ids: NDArray) -> tuple[BodyReadings, NDArray[np.int64]]:
        assert self.bodies is not None
        beads = self.solutes.shape[0] if self.solutes is not None else 0
        return self.bodies, np.asarray(ids) - (self.n + beads)

    def bonds(self) -> NDArray[np.int64]:
        """Particle ids (bonds, 2) of all pairs that are linked; molecule after molecule, those of
        the fluid before those of solutes."""
        if self.solutes is None:
            return self._bonds_of_fluid()
        return np.concatenate([self._bonds_of_fluid(), self.n + self.solutes.bonds])

    def _bonds_of_fluid(self) -> NDArray[np.int64]:
        molecule = self.numbers.case.fluid.molecule
        links = np.array(molecule.bonds if molecule else (), np.int64).reshape(-1, 2)
        starts = np.arange(0, self.n, self.beads)
        return (starts[:, None, None] + links).reshape(-1, 2) if len(links) else links

    def bond_vectors(self) -> Floats:
        """From the first to the second particle of each of `bonds` (bonds, d)."""
        bonds = self._bonds_of_fluid()
        if self.solutes is None:
            return self._between(bonds)
        beads = self.solutes.bond_vectors()
        return np.concatenate([self._between(bonds), beads]) if len(bonds) else beads

    def whole_positions(self, ids: NDArray | None = None) -> Floats:
        """Positions (n, d) by particle id, in the box but for beads that hang over its ends.

        Those are where their molecule has them, next to its first bead, which is in the box.
        `ids`, if given, name molecule after molecule with all of its beads; without them they are
        those of the fluid.
        """
        if self.solutes is None or ids is None or (ids < self.n).all():
            return self._whole_in_fluid(ids)
        own = ids < self.n
        places = self.solutes.whole()[np.where(own, 0, ids - self.n)]
        if own.any():
            places[own] = self._whole_in_fluid(ids[own])
        return places

    def _whole_in_fluid(self, ids: NDArray | None) -> Floats:
        r, _, image = self._gather(ids, False)
        if self.beads == 1:
            return r
        first = np.repeat(np.arange(0, len(r), self.beads), self.beads)
        return r[first] + self.separation(r, image, first, np.arange(len(r)))

    def _between(self, pairs: NDArray[np.int64]) -> Floats:
        r, _, image = self._gather(None, False)
        return self.separation(r, image, *pairs.T)

    def separation(self, r: Floats, image: NDArray, first: NDArray, second: NDArray) -> Floats:
        """From one bead to another, whatever images they lie in."""
        return between(r, image, first, second, self.numbers.box, self.memory.box)

    def _gather(self, ids: NDArray | None, unwrapped: bool) -> Observed:
        """Places, velocities, images by particle id: beads of solutes follow the fluid, then come
        bodies."""
        ids = self._all_beads(ids)
        if ids is None or (ids < self.n).all():
            return self._gather_fluid(ids, unwrapped)
        own = ids < self.n
        others = np.where(own, 0, ids - self.n)
        seen = self.others(unwrapped)
        r, v, image = seen.positions[others], seen.velocities[others], seen.images[others]
        if own.any():
            r[own], v[own], image[own] = self._gather_fluid(ids[own], unwrapped)
        return Observed(r, v, image)

    def others(self, unwrapped: bool) -> Observed:
        """All beads of solutes, then all bodies."""
        found = []
        if self.solutes is not None:
            r, v, image = self.solutes.folded()
            if unwrapped:
                r, v = self.solutes.places, self.solutes.velocities
            found.append(Observed(r, v, image))
        if self.bodies is not None:
            one = self.bodies
            found.append(Observed(one.places(unwrapped), one.velocities, one.images))
        return Observed(
            np.concatenate([one.positions for one in found]),
            np.concatenate([one.velocities for one in found]),
            np.concatenate([one.images for one in found]),
        )

    def _all_beads(self, ids: NDArray | None) -> NDArray | None:
        """The same ids; in a random solvent, which has no particles, None stands for all beads."""
        if ids is not None or self.n or self.solutes is None:
            return ids
        return np.arange(len(self.solutes.kinds()))

    def _gather_fluid(self, ids: NDArray | None, unwrapped: bool) -> Observed:
        # Place of each particle in `ids`, by particle id, -1 if none; kept for the next time.
        if ids is not None and (self._asked is None or not np.array_equal(self._asked, ids)):
            self._slots_of_asked = np.full(self.n, -1, np.int32)
            self._slots_of_asked[ids] = np.arange(len(ids))
            self._asked = ids.copy()
        slots = np.arange(self.n, dtype=np.int32) if ids is None else self._slots_of_asked
        shape = self.n if ids is None else len(ids), self.dimension
        out = Observed(np.zeros(shape), np.zeros(shape), np.zeros(shape, np.int32))
        looked = measure.Looked(slots, *out)
        zero, _ = self._vectors
        where = self.memory.box, self.memory.fluid.particles
        self.threads.run(measure.gather_by_id, zero, *where, unwrapped, looked)
        return out

    def seen_at(self, places: NDArray[np.int64], unwrapped: bool) -> Observed:
        """Position, velocity and images of the particles at these places in memory."""
        shape, zero = (len(places), self.dimension), self.memory.physics.zero
        out = Observed(np.zeros(shape), np.zeros(shape), np.zeros(shape, np.int32))
        looked = measure.Looked(places, *out)
        where = self.memory.box, self.memory.fluid.particles
        self.threads.run(measure.gather_at, zero, *where, unwrapped, looked)
        return out

    def find_stress(self) -> None:
        """Stress of the step that ends now, positive where the fluid above drags the one below.

        Kinetic: momentum carried in the flight, which is the mean of the values before and after
        the collision. Collisional: momentum handed over within cells (Winkler and Huang 2009), and
        what bodies give and take, at their centres.
        Bond: momentum handed over within molecules of the fluid and between beads of solutes, the
        mean over the flight.
        """
        d = self.dimension
        unit = self.numbers.units["stress"]
        parts = self.total(self.memory.stress_terms(), unit)
        if self.solutes is not None:
            theirs = self.total(self.solutes.state_of.tensor.swapaxes(0, 1), unit)
            bonded = theirs[2:] + parts[2:] if len(parts) > 2 else theirs[2:]
            parts = np.concatenate([parts[:2] + theirs[:2], bonded])
        if self.bodies is not None:
            parts[:2] += self.total(self.bodies.state_of.tensor, unit)
        (flux, moment), (flux_after, moment_after), *rest = parts.reshape(-1, 2, d, d)
        volume = math.prod(self.numbers.case.box.size)
        self.stress = {
            "kinetic": -0.5 * (flux + flux_after) / volume,
            "collisional": -(moment_after - moment) / (volume * self.numbers.timestep),
        }
        for virial, _ in rest:
            self.stress["bond"] = -virial / (volume * self.numbers.timestep)

    @property
    def wall_tally(self) -> Tally:
        """Momentum (d), then angular momentum (1 or 3), that surfaces took since the warm-up.

        These for the lower and upper plate of a slit, or for the bodies in order, all in a row.
        """
        self._walls.add(self.reduced(self.memory.taken_by_surfaces()))
        return self._walls

    def restore_walls(self, state: Mapping[str, NDArray]) -> None:
        """Go on with what surfaces took from the state of an engine."""
        self.memory.forget_surfaces()
        self._walls.restore({name: state[f"walls/{name}"] for name in self._walls.state()})
        self.wall_steps = int(state["wall_steps"])

    def state_of_walls(self) -> dict[str, NDArray]:
        """The momentum that surfaces took, for the state of an engine."""
        taken = self.wall_tally.state().items()
        steps = {"wall_steps": np.array(self.wall_steps)}
        return {f"walls/{name}": array.copy() for name, array in taken} | steps

    def wall_rates(self) -> Floats:
        """Rates of the flow at all pieces of surface."""
        return self.memory.wall_rates.copy()

    def forget_walls(self) -> None:
        """Count anew what surfaces take."""
        self.memory.forget_surfaces()
        self._walls = Tally(self._walls.high.shape, self._walls.unit)
        self.wall_steps = 0


def between(
    r: Floats, image: NDArray, first: NDArray, second: NDArray, size: Floats, box: tuple
) -> Floats:
    """Vectors (n, d) from the first particles to the second, with the images in which they lie."""
    boxes = image[second] - image[first]
    separation: Floats = r[second] - r[first] + boxes * size
    if isinstance(box, SLIDING):
        separation[:, 0] += boxes[:, 1] * box.offset
    return separation
