"""What observables ask, where each rank has a part of the particles: all ranks answer together."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.execute.cpu.memory import Floats, Memory
from mesokit.execute.cpu.threads import Threads
from mesokit.execute.measure import sums as measure
from mesokit.execute.measure.readings import Readings, Seen

HALF = 32  # bits: high and low halves of whole numbers are added up apart, so that none overflows


class SharedReadings(Readings):
    """Readings of all ranks, the same on each: every one of them must ask, and in the same order."""

    def __init__(self, memory: Memory, threads: Threads, comm: Any) -> None:
        super().__init__(memory, threads)
        self.comm = comm
        self._sorted: tuple[NDArray[np.int64], NDArray[np.int64]] | None = None

    def forget(self) -> None:
        super().forget()
        self._sorted = None

    def total(self, rows: NDArray[np.int64], scale: Any) -> Floats:
        halves = np.stack([(rows >> HALF).sum(axis=0), (rows & (2**HALF - 1)).sum(axis=0)])
        high, low = self.reduced(halves)
        exact = high.astype(object) * 2**HALF + low
        return np.asarray(exact / scale, float)

    def added(self, numbers: NDArray[np.int64]) -> NDArray[np.int64]:
        return self.reduced(numbers.sum(axis=0))

    def reduced(self, numbers: NDArray[np.int64]) -> NDArray[np.int64]:
        """The sum over all ranks."""
        out = np.empty_like(np.ascontiguousarray(numbers))
        self.comm.Allreduce(np.ascontiguousarray(numbers), out)
        return out

    def own_rows(self, ids: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Which of the particles asked for are here: their places in `ids`, and among all here."""
        if self._sorted is None:
            who = self.memory.fluid.particles.ident[self.memory.places]
            order = np.argsort(who)
            self._sorted = who[order], order
        who, order = self._sorted
        at = np.minimum(np.searchsorted(who, ids), max(len(who) - 1, 0))
        here = np.flatnonzero(who[at] == ids) if len(who) else np.zeros(0, np.int64)
        return here, order[at[here]]

    def together(self, here: NDArray[np.int64], rows: Floats, number: int) -> Floats:
        """Rows (number, columns) of which each rank has those with these numbers."""
        words = 1 + rows.shape[1]
        sent = np.concatenate([here[:, None], np.ascontiguousarray(rows).view(np.int64)], axis=1)
        counts = np.array(self.comm.allgather(len(here)))
        whole = np.empty((counts.sum(), words), np.int64)
        self.comm.Allgatherv(np.ascontiguousarray(sent), [whole, counts * words])
        out = np.empty((number, rows.shape[1]))
        out[whole[:, 0]] = np.ascontiguousarray(whole[:, 1:]).view(float)
        return out

    def as_they_are(self, ids: NDArray[np.int64]) -> Seen:
        """Positions, velocities and images of particles as they lie in memory."""
        here, which = self.own_rows(ids)
        rows = np.concatenate([part[which] for part in self.memory.rows_of()], axis=1)
        return self._seen_of(self.together(here, rows, len(ids)))

    def _seen_of(self, rows: Floats) -> Seen:
        d = self.dimension
        return Seen(rows[:, :d], rows[:, d : 2 * d], rows[:, 2 * d :].astype(np.int32))

    def _gather_fluid(self, ids: NDArray | None, unwrapped: bool) -> Seen:
        asked = np.arange(self.n) if ids is None else np.asarray(ids, np.int64)
        here, which = self.own_rows(asked)
        rows = self.rows_at(self.memory.places[which], unwrapped)
        return self._seen_of(self.together(here, rows, len(asked)))

    def rows_at(self, places: NDArray[np.int64], unwrapped: bool) -> Floats:
        """Position, velocity and images (n, 3 d) of the particles at these places in memory."""
        d, zero = self.dimension, self.memory.physics.zero
        slots = np.full(len(self.memory.fluid.particles.cell), -1, np.int32)
        slots[places] = np.arange(len(places))
        out = Seen(*(np.zeros((len(places), d)) for _ in range(2)), np.zeros((len(places), d), np.int32))
        looked = measure.Looked(slots, *out)
        where = self.memory.box, self.memory.fluid.particles
        self.threads.run(measure.gather_by_place, zero, *where, unwrapped, looked)
        return np.concatenate([out.positions, out.velocities, out.images.astype(float)], axis=1)
