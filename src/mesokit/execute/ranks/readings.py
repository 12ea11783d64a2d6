"""What observables ask, where each rank has a part of the particles: all ranks answer together."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.execute.cpu.memory import Floats, Memory
from mesokit.execute.cpu.threads import Threads
from mesokit.execute.measure import sums as measure
from mesokit.execute.measure.readings import Readings, Seen


class SharedReadings(Readings):
    """Readings of all ranks, the same on each: every one of them must ask, and in the same order."""

    def __init__(self, memory: Memory, threads: Threads, comm: Any) -> None:
        super().__init__(memory, threads)
        self.comm = comm
        self._sorted: tuple[NDArray[np.int64], NDArray[np.int64]] | None = None

    def forget(self) -> None:
        super().forget()
        self._sorted = None

    def reduced(self, numbers: NDArray[np.int64]) -> NDArray[np.int64]:
        out = np.empty_like(np.ascontiguousarray(numbers))
        self.comm.Allreduce(np.ascontiguousarray(numbers), out)
        return out

    def own_rows(self, ids: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Which of the particles asked for are here: their places in `ids`, and among all here."""
        who, order = self._by_number()
        at = np.minimum(np.searchsorted(who, ids), max(len(who) - 1, 0))
        here = np.flatnonzero(who[at] == ids) if len(who) else np.zeros(0, np.int64)
        return here, order[at[here]]

    def _by_number(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """The numbers of all that are here, rising, and their places among all here."""
        if self._sorted is None:
            who = self.memory.fluid.particles.ident[self.memory.places]
            order = np.argsort(who)
            self._sorted = who[order], order
        return self._sorted

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

    def numbers_here(self, first: int, last: int) -> NDArray[np.int64]:
        """Who is here of the particles from one number to before another, rising."""
        who, _ = self._by_number()
        return who[slice(*np.searchsorted(who, (first, last)))].copy()

    def rows_in_memory(self, name: str, first: int, last: int) -> tuple[NDArray, NDArray]:
        """Of the particles from one number to before another, who is here, and their positions,
        velocities or images as they lie in memory."""
        who, order = self._by_number()
        part = slice(*np.searchsorted(who, (first, last)))
        return who[part], self.memory.columns(name, self.memory.places[order[part]])

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
        seen = self.seen_at(places, unwrapped)
        return np.concatenate([seen.positions, seen.velocities, seen.images.astype(float)], axis=1)

    def seen_at(self, places: NDArray[np.int64], unwrapped: bool) -> Seen:
        """The same, each by itself."""
        shape, zero = (len(places), self.dimension), self.memory.physics.zero
        out = Seen(np.zeros(shape), np.zeros(shape), np.zeros(shape, np.int32))
        looked = measure.Looked(places, *out)
        where = self.memory.box, self.memory.fluid.particles
        self.threads.run(measure.gather_at, zero, *where, unwrapped, looked)
        return out
