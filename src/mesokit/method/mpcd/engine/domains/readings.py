"""Readings where each rank has a part of the particles, of all ranks together or of one alone."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.loops.threads import Threads
from mesokit.method.mpcd.engine.beads.readings import SoluteReadings, energy_in
from mesokit.method.mpcd.engine.beads.state import OWN
from mesokit.method.mpcd.engine.bodies.readings import BodyReadings
from mesokit.method.mpcd.engine.cpu.memory import Floats, Memory
from mesokit.method.mpcd.engine.measure.readings import Observed, Readings
from mesokit.method.mpcd.engine.pieces import ROOT, Spread, pieces


def rows_of_all(
    comm: Any, here: NDArray[np.int64], rows: Floats
) -> tuple[NDArray[np.int64], Floats]:
    """Numbers (n,) and rows (n, columns) of all ranks, of which this one has some."""
    words = 1 + rows.shape[1]
    sent = np.concatenate([here[:, None], np.ascontiguousarray(rows).view(np.int64)], axis=1)
    counts = np.array(comm.allgather(len(here)))
    whole = np.empty((counts.sum(), words), np.int64)
    comm.Allgatherv(np.ascontiguousarray(sent), [whole, counts * words])
    return whole[:, 0], np.ascontiguousarray(whole[:, 1:]).view(float)


class SharedReadings(Readings):
    """Readings of all ranks, the same on each: all ranks must call them, in the same order."""

    def __init__(self, memory: Memory, threads: Threads, comm: Any) -> None:
        super().__init__(memory, threads)
        self.comm = comm
        self.counts_solutes = comm.rank == ROOT  # beads are read on all ranks and counted on one
        if memory.solutes:
            self.solutes = SharedSolutes(memory, comm)
        if self.bodies is not None:
            self.bodies = BodyReadings(memory, self.reduced)
        self._sorted: tuple[NDArray[np.int64], NDArray[np.int64]] | None = None

    def forget(self) -> None:
        super().forget()
        self._sorted = None
        if isinstance(self.solutes, SharedSolutes):
            self.solutes.known = False

    def go_on_from(self, earlier: SharedReadings | None) -> None:
        """Continue the counts of earlier readings, whose memory is replaced."""
        if earlier is not None:
            self.wall_steps, self._walls = earlier.wall_steps, earlier._walls
            if isinstance(self.solutes, SharedSolutes):
                self.solutes.known = getattr(earlier.solutes, "known", True)

    def reduced(self, numbers: NDArray[np.int64]) -> NDArray[np.int64]:
        out = np.empty_like(np.ascontiguousarray(numbers))
        self.comm.Allreduce(np.ascontiguousarray(numbers), out)
        return out

    def own_rows(self, ids: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Particles of this rank among `ids`: their places in `ids`, and among all of this rank."""
        own_ids, order = self._by_number()
        at = np.minimum(np.searchsorted(own_ids, ids), max(len(own_ids) - 1, 0))
        here = np.flatnonzero(own_ids[at] == ids) if len(own_ids) else np.zeros(0, np.int64)
        return here, order[at[here]]

    def _by_number(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Ids of all particles of this rank, rising, and their places among them."""
        if self._sorted is None:
            own_ids = self.memory.fluid.particles.ident[self.memory.places]
            order = np.argsort(own_ids)
            self._sorted = own_ids[order], order
        return self._sorted

    def together(self, here: NDArray[np.int64], rows: Floats, number: int) -> Floats:
        """Gather rows (number, columns) on all ranks; this one has those with numbers `here`."""
        numbers, every = rows_of_all(self.comm, here, rows)
        out = np.empty((number, rows.shape[1]))
        out[numbers] = every
        return out

    def numbers_here(self, first: int, last: int) -> NDArray[np.int64]:
        """Ids of the particles of this rank from `first` to before `last`, rising."""
        own_ids, _ = self._by_number()
        return own_ids[slice(*np.searchsorted(own_ids, (first, last)))].copy()

    def rows_in_memory(self, name: str, first: int, last: int) -> tuple[NDArray, NDArray]:
        """Ids of this rank from `first` to before `last`, and positions, velocities or images in
        the order of memory."""
        own_ids, order = self._by_number()
        part = slice(*np.searchsorted(own_ids, (first, last)))
        return own_ids[part], self.memory.columns(name, self.memory.places[order[part]])

    def wall_rates(self) -> Floats:
        """Rates of the flow at all pieces of surface, each from the owner of its probe."""
        virtual = self.memory.walls.virtual
        if not virtual or not len(virtual.rates):
            return super().wall_rates()
        mine = self.memory.domain.owners(virtual.probes) == self.comm.rank
        bits = np.where(mine[:, None], virtual.rates.view(np.int64), 0)
        return self.reduced(bits).view(float)

    def _gather_fluid(self, ids: NDArray | None, unwrapped: bool) -> Observed:
        wanted = np.arange(self.n) if ids is None else np.asarray(ids, np.int64)
        here, which = self.own_rows(wanted)
        seen = self.seen_at(self.memory.places[which], unwrapped)
        columns = [seen.positions, seen.velocities, seen.images.astype(float)]
        rows = self.together(here, np.concatenate(columns, axis=1), len(wanted))
        r, v, images = np.split(rows, 3, axis=1)
        return Observed(r, v, images.astype(np.int32))


class SharedSolutes(SoluteReadings):
    """The beads of all ranks; places and velocities are gathered when they are read."""

    def __init__(self, memory: Memory, comm: Any) -> None:
        super().__init__(memory)
        self.comm, self.known = comm, True

    @property
    def places(self) -> Floats:
        self.fetch()
        return self.state_of.r.reshape(self.shape)

    @property
    def velocities(self) -> Floats:
        self.fetch()
        return self.state_of.v.reshape(self.shape)

    def own_places(self) -> Floats:
        """Places of own beads, in the box."""
        beads = self.state_of
        own = beads.halo.numbers[OWN, : beads.halo.count[OWN]]
        return self.folded_of(beads.r.reshape(self.shape), beads.v.reshape(self.shape))[0][own]

    def fetch(self) -> None:
        """Gather places and velocities of all ranks, unless they are up to date."""
        if self.known:
            return
        beads, d = self.state_of, self.shape[1]
        r, v = beads.r.reshape(self.shape), beads.v.reshape(self.shape)
        own = beads.halo.numbers[OWN, : beads.halo.count[OWN]]
        ids, rows = rows_of_all(self.comm, own, np.concatenate([r[own], v[own]], axis=1))
        r[ids], v[ids] = rows[:, :d], rows[:, d:]
        self.known = True

    def potential_energy(self) -> float:
        self.fetch()
        self.forget_lists()  # those of this rank have only beads around its block
        energy = energy_in(self.memory, self.state_of._replace(halo=()), self.places)
        self.forget_lists()
        return energy

    def state(self) -> dict[str, NDArray[Any]]:
        self.fetch()
        return super().state()

    def begin(self, places: Floats, velocities: Floats) -> None:
        self.known = True
        super().begin(places, velocities)
        self.assign_owners()

    def restore(self, state: dict[str, NDArray[Any]]) -> None:
        self.known = True
        super().restore(state)
        self.assign_owners()

    def assign_owners(self) -> None:
        """Make each rank the owner of the beads in its block."""
        owner = self.memory.domain.owners(self.folded()[0])
        own, halo = np.flatnonzero(owner == self.comm.rank), self.state_of.halo
        halo.numbers[OWN, : len(own)], halo.count[OWN] = own, len(own)
        halo.seen[:] = -9


class Here:
    """Readings of the particles of this rank, by id, without messages to other ranks.

    Positions in the box, velocities and image counts (n, d) are those of some particles `ids`.
    Beads of solutes and bodies, which all ranks can read, count as those of the first rank.
    """

    def __init__(self, readings: SharedReadings) -> None:
        self.readings = readings

    def ids(self, first: int, last: int) -> NDArray[np.int64]:
        """Ids of the particles of this rank from `first` to before `last`, rising."""
        readings, n = self.readings, self.readings.n
        own = readings.numbers_here(min(first, n), min(last, n))
        beads = np.arange(max(first, n), max(last, n) if readings.comm.rank == ROOT else 0)
        return np.concatenate([own, beads])

    def _of(self, name: str, ids: NDArray[np.int64]) -> NDArray[Any]:
        readings, kind = self.readings, np.int32 if name == "images" else np.float64
        out = np.empty((len(ids), readings.dimension), kind)
        own = int(np.searchsorted(ids, readings.n))
        _, which = readings.own_rows(ids[:own])
        for first, last in pieces(0, own):
            places = readings.memory.places[which[first:last]]
            out[first:last] = getattr(readings.seen_at(places, False), name)
        if own < len(ids):
            others = readings.others(False)
            out[own:] = getattr(others, name)[ids[own:] - readings.n]
        return out

    def orientations(self, ids: NDArray[np.int64]) -> Floats:
        """Unit quaternions of bodies, by particle id."""
        return self.readings.orientations(ids)

    def spins(self, ids: NDArray[np.int64]) -> Floats:
        """Angular velocities of bodies, by particle id."""
        return self.readings.spins(ids)

    positions = functools.partialmethod(_of, "positions")
    velocities = functools.partialmethod(_of, "velocities")
    images = functools.partialmethod(_of, "images")

    def spread(self, number: int, places: NDArray[np.int64], rows: NDArray[Any]) -> Spread:
        """An array of `number` rows, of which this rank has `rows` at these places (rising)."""

        def some(first: int, last: int) -> tuple[NDArray[np.int64], NDArray[Any]]:
            part = slice(*np.searchsorted(places, (first, last)))
            return places[part], rows[part]

        return Spread(self.readings.comm, (number, *rows.shape[1:]), rows.dtype, some)
