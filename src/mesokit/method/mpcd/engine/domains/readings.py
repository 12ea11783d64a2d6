"""What observables ask, where each rank has a part of the particles: all ranks answer together."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.loops.threads import Threads
from mesokit.method.mpcd.engine.beads.readings import SoluteReadings, energy_in
from mesokit.method.mpcd.engine.beads.state import OWN
from mesokit.method.mpcd.engine.cpu.memory import Floats, Memory
from mesokit.method.mpcd.engine.domains.state import ROOT
from mesokit.method.mpcd.engine.measure.readings import Readings, Seen


class SharedReadings(Readings):
    """Readings of all ranks, the same on each: every one must ask, and in the same order."""

    def __init__(self, memory: Memory, threads: Threads, comm: Any) -> None:
        super().__init__(memory, threads)
        self.comm = comm
        self.tells_solutes = comm.rank == ROOT  # all ranks know all beads: those of one count
        if memory.solutes:
            self.solutes = SharedSolutes(memory, comm)
        self._sorted: tuple[NDArray[np.int64], NDArray[np.int64]] | None = None

    def forget(self) -> None:
        super().forget()
        self._sorted = None
        if isinstance(self.solutes, SharedSolutes):
            self.solutes.known = False

    def go_on_from(self, earlier: SharedReadings | None) -> None:
        """Take over what is counted from readings of memory that was given up."""
        if earlier is not None:
            self.wall_steps, self._walls = earlier.wall_steps, earlier._walls
            if isinstance(self.solutes, SharedSolutes):
                self.solutes.known = getattr(earlier.solutes, "known", True)

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

    def wall_rates(self) -> Floats:
        """How the flow rises from all pieces of surface, each as the rank nearby has it."""
        virtual = self.memory.walls.virtual
        if not virtual or not len(virtual.rates):
            return self.memory.wall_rates.copy()
        mine = self.memory.domain.owners(virtual.probes) == self.comm.rank
        bits = np.where(mine[:, None], virtual.rates.view(np.int64), 0)
        return self.reduced(bits).view(float)

    def _gather_fluid(self, ids: NDArray | None, unwrapped: bool) -> Seen:
        asked = np.arange(self.n) if ids is None else np.asarray(ids, np.int64)
        here, which = self.own_rows(asked)
        rows = self.rows_at(self.memory.places[which], unwrapped)
        return self._seen_of(self.together(here, rows, len(asked)))

    def rows_at(self, places: NDArray[np.int64], unwrapped: bool) -> Floats:
        """The same as `seen_at` in one array (n, 3 d)."""
        seen = self.seen_at(places, unwrapped)
        return np.concatenate([seen.positions, seen.velocities, seen.images.astype(float)], axis=1)


class SharedSolutes(SoluteReadings):
    """The beads of all ranks; places and velocities are fetched when somebody asks."""

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
        """Places of this rank's own beads, in the box."""
        beads = self.state_of
        own = beads.roster.who[OWN, : beads.roster.count[OWN]]
        return self.folded_of(beads.r.reshape(self.shape), beads.v.reshape(self.shape))[0][own]

    def fetch(self) -> None:
        """Get those of all ranks, unless nothing has moved since."""
        if self.known:
            return
        beads, d = self.state_of, self.shape[1]
        r, v = beads.r.reshape(self.shape), beads.v.reshape(self.shape)
        own = beads.roster.who[OWN, : beads.roster.count[OWN]]
        sent = np.concatenate([own[:, None].astype(float), r[own], v[own]], axis=1)
        counts = np.array(self.comm.allgather(len(own))) * (1 + 2 * d)
        whole = np.empty((counts.sum() // (1 + 2 * d), 1 + 2 * d))
        self.comm.Allgatherv(np.ascontiguousarray(sent), [whole, counts])
        who = whole[:, 0].astype(np.int64)
        r[who], v[who] = whole[:, 1 : 1 + d], whole[:, 1 + d :]
        self.known = True

    def potential_energy(self) -> float:
        self.fetch()
        self.forget_lists()  # those of this rank know of beads around its block alone
        energy = energy_in(self.memory, self.state_of._replace(roster=()), self.places)
        self.forget_lists()
        return energy

    def state(self) -> dict[str, NDArray[Any]]:
        self.fetch()
        return super().state()

    def begin(self, places: Floats, velocities: Floats) -> None:
        self.known = True
        super().begin(places, velocities)
        self.share_out()

    def restore(self, state: dict[str, NDArray[Any]]) -> None:
        self.known = True
        super().restore(state)
        self.share_out()

    def share_out(self) -> None:
        """Each rank takes the beads in its block."""
        owner = self.memory.domain.owners(self.folded()[0])
        own, roster = np.flatnonzero(owner == self.comm.rank), self.state_of.roster
        roster.who[OWN, : len(own)], roster.count[OWN] = own, len(own)
        roster.seen[:] = -9
