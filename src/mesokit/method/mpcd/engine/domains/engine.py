"""Execution on the ranks of MPI: each has the particles of a block of cells, on its threads."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.errors import RunError
from mesokit.loops.clock import FIRST, MOVE, SHARE, WAIT
from mesokit.loops.threads import Threads
from mesokit.method.mpcd.engine.cpu.engine import CPU
from mesokit.method.mpcd.engine.cpu.memory import Memory
from mesokit.method.mpcd.engine.cpu.numbers import Floats, Numbers
from mesokit.method.mpcd.engine.domains.blocks.balance import (
    Balance,
    Load,
    Window,
    still_good,
    waiting,
)
from mesokit.method.mpcd.engine.domains.blocks.tree import Tree, divided
from mesokit.method.mpcd.engine.domains.deal import distributed
from mesokit.method.mpcd.engine.domains.domain import Domain, axes_to_cut, owners
from mesokit.method.mpcd.engine.domains.messages import shared
from mesokit.method.mpcd.engine.domains.messages.mpi import crowded
from mesokit.method.mpcd.engine.domains.readings import Here, SharedReadings, SharedSolutes
from mesokit.method.mpcd.engine.pieces import (
    ROOT,
    SPREAD,
    Piece,
    Spread,
    pieces,
)
from mesokit.scalar.system import TICK


def pieces_of(memory: Memory) -> Iterator[Piece]:
    """The particles in a rank's memory, whole molecules."""
    ids = memory.fluid.particles.ident
    for first, last in pieces(0, len(memory.places), memory.numbers.beads):
        places = memory.places[first:last]
        columns = (memory.columns(name, places) for name in SPREAD)
        yield Piece(ids[places], *columns)


GROWTH = 1.1  # times as many molecules as there are, when arrays become too small
FAULT_TEXTS = {
    shared.FULL: "more particles beyond the cells around a rank's block than it has room for; "
    "expected fewer ranks",
    shared.STRETCHED: "a bead of solutes went farther in a step, or its bonds are longer, than "
    "ranks can follow; expected fewer ranks or a shorter fluid.timestep",
    shared.FAR: "a particle came to a cell of a rank that is no neighbour; expected fewer ranks",
}


class Ranks(CPU):
    """The part of a fluid in the block of one rank; all ranks call its methods together.

    Parameters are those of `CPU`, with the threads of this rank, and the communicator (mpi4py).
    """

    readings: SharedReadings

    def __init__(self, case: Case, threads: int, measures: Sequence[str], comm: Any) -> None:
        self.case, self.numbers, self.comm = case, Numbers(case), comm
        self.threads, self.measures = Threads(threads), measures
        self.n, self.dimension, self.box = self.numbers.n, self.numbers.dimension, self.numbers.box
        self.balancing = Balance(comm, case.run.imbalance)
        self._crowded = crowded(comm, threads)
        self._window = Window()
        tree = divided(self.numbers.cells, comm.size, axes_to_cut(self.numbers))
        self._allocate(tree, self.numbers.filling.molecules // comm.size)

    def _allocate(self, tree: Tree, molecules: int) -> None:
        size = self.threads.size
        earlier = self.memory if hasattr(self, "memory") else None
        self.domain = Domain(self.numbers, self.comm, tree, size, molecules, self._crowded)
        self.memory = Memory(self.numbers, size, self.measures, self.domain, earlier)
        before = self.readings if earlier is not None else None
        self.readings = SharedReadings(self.memory, self.threads, self.comm)
        self.readings.go_on_from(before)
        self.solutes, self.bodies = self.readings.solutes, self.readings.bodies

    # --- running --------------------------------------------------------------------------------

    def parts(self, by_first: bool = False) -> Iterator[tuple[int, int]]:
        beads, molecules = self.numbers.beads, self.n // self.numbers.beads
        first, last = (molecules * (self.comm.rank + k) // self.comm.size for k in (0, 1))
        if by_first:
            first, last = 0, molecules if self.comm.rank == ROOT else 0
        return pieces(first * beads, last * beads, beads)

    def _take(self, particles: Iterable[Piece]) -> None:
        """Store the particles of this block, out of these and those of other ranks."""
        beads, held = self.numbers.beads, 0
        self._count(0)
        owners = self.domain.owners
        for piece in distributed(self.comm, particles, owners, beads, self.dimension):
            first, held = held, held + len(piece.ids) // beads
            if held > self.domain.room:
                self._make_room(held)
            self._count(held)
            self.memory.put(*piece, first=first)

    def _count(self, molecules: int) -> None:
        fluid = self.memory.fluid
        filling: Any = fluid.particles.filling
        filling = filling._replace(molecules=molecules)
        self.memory.fluid = fluid._replace(particles=fluid.particles._replace(filling=filling))
        fluid.cells.shared.noted[shared.MOLECULES] = molecules

    def _make_room(self, least: int = 0) -> None:
        """Allocate larger arrays, for the particles of this rank and at least so many molecules."""
        memory, rows = self.memory, self.memory.rows_of()
        ids = memory.fluid.particles.ident[memory.places]
        molecules = int(GROWTH * len(ids) / self.numbers.beads) + 1
        self._allocate(self.domain.tree, max(molecules, least))
        self._go_on_from(memory)
        if (held := len(ids) // self.numbers.beads) > self.domain.room:
            self._allocate(self.domain.tree, held)
        self._count(held)
        self.memory.put(ids, *rows)

    def _go_on_from(self, memory: Memory) -> None:
        """Copy all that belongs to no particle of the fluid from earlier memory."""
        new = self.memory
        new.step = memory.step
        new.fluid.taken.impulse[:] = memory.fluid.taken.impulse
        new.wall_rates[:] = memory.wall_rates
        new.fluid.cells.shared.meter[:] = memory.fluid.cells.shared.meter
        if memory.solutes:
            beads, before = new.solutes, memory.solutes
            beads.r[:], beads.v[:] = before.r, before.v
            beads.halo.numbers[:], beads.halo.count[:] = before.halo.numbers, before.halo.count
        if self.readings.bodies is not None:
            new.bodies.rows[:] = memory.bodies.rows
            new.bodies.faults[:] = memory.bodies.faults
            self.readings.bodies.forget_lists()

    def _steps(self, steps: int, what: int) -> None:
        left = steps
        # The kernel ends before `steps` if the next migration might not fit into its arrays.
        # Partners then wait for this rank's next message, so no rank repeats a step.
        while True:
            before = self.memory.step
            with self._window.timing(self):
                super()._steps(left, what)
            noted = self.memory.fluid.cells.shared.noted
            self.memory.step = before + int(noted[shared.DONE])
            left -= int(noted[shared.DONE])
            self._check_messages(noted)
            if steps:
                self._count(int(noted[shared.MOLECULES]))
            if left <= 0:
                return
            self._make_room()

    # --- balance --------------------------------------------------------------------------------

    def sort(self) -> None:
        with self._window.timing(self):
            super().sort()
        if self.step == 0:
            return
        # Borders move if the last two windows were unbalanced.
        if windows := self.balancing.received_times():
            kept = still_good(self.domain.tree, windows, self.balancing.limit)
            if kept.nodes != self.domain.tree.nodes:
                self.rebalance(kept)
        self.balancing.send_time(self._window.work)
        self._window = Window()

    def rebalance(self, kept: Tree | None = None) -> None:
        """Cut the cells anew by the work of each in the last window; nodes in `kept` stay."""
        load = Load(self.domain.block, self._costs(), self.comm)
        cells, weights = self.numbers.cells, axes_to_cut(self.numbers)
        tree = divided(cells, self.comm.size, weights, load.layers, kept)
        if tree.blocks != self.domain.tree.blocks:
            self.move_borders(tree)
        self.balancing.moved()

    def _costs(self) -> Floats:
        """Seconds of this rank's work in each of its cells, x varying fastest."""
        block, window = self.domain.block, self._window
        lengths = np.array(block.lengths)

        def counted(places: Floats) -> Floats:
            where = np.floor(places).astype(np.int64) - np.array(block.low)
            where = np.clip(where % np.array(self.numbers.cells), 0, lengths - 1)
            number = np.ravel_multi_index(tuple(where.T[::-1]), tuple(lengths[::-1]))
            return np.bincount(number, minlength=lengths.prod()).astype(float)

        particles = counted(self.memory.rows_of()[0])
        costs = np.full(lengths.prod(), window.cells / lengths.prod())
        costs += window.particles * particles / max(particles.sum(), 1.0)
        if isinstance(self.solutes, SharedSolutes):
            beads = counted(self.solutes.own_places())
            costs += window.beads * beads / max(beads.sum(), 1.0)
        return costs

    def move_borders(self, tree: Tree) -> None:
        """Take the block of another tree, and exchange the particles between ranks."""
        memory, rates = self.memory, self.readings.wall_rates()
        solutes = None if self.solutes is None else self.solutes.state()
        leaders = memory.rows_of()[0][:: self.numbers.beads]
        here = np.bincount(owners(tree.blocks, self.numbers, leaders), minlength=self.comm.size)
        self._allocate(tree, int(self.readings.reduced(here)[self.comm.rank]))
        self._go_on_from(memory)
        self.memory.wall_rates[:] = rates
        self._take(pieces_of(memory))
        if self.solutes is not None and solutes is not None:
            self.solutes.restore(solutes)

    def balance(self) -> dict[str, Any]:
        """Number of moves of borders, and most over mean of the ranks' work at first and lately."""
        known, found = self.balancing, {"borders moved": self.balancing.moves}
        if np.isnan(known.first):
            return found
        return found | {"most over mean at first": known.first, "of late": known.last}

    def _check_messages(self, noted: NDArray[np.int64]) -> None:
        faults, post = int(noted[shared.FAULTS]), self.memory.fluid.cells.shared.post
        if post.flag[1]:
            raise RunError(f"step {self.step}: a message to another rank failed")
        for fault, text in FAULT_TEXTS.items():
            if faults & fault:
                raise RunError(f"step {self.step}: {text}")

    @property
    def here(self) -> Here:
        """Readings of this rank's own particles, without messages."""
        return Here(self.readings)

    @property
    def seconds(self) -> dict[str, float]:
        """Time spent so far in each stage, on this rank; waiting for beads is waiting."""
        names = {"share": SHARE, "wait": WAIT, "move": MOVE}
        clock = self.threads.clock
        found = super().seconds | {
            name: TICK * float(clock[FIRST + k]) for name, k in names.items()
        }
        for post in waiting(self.memory)[1:]:
            waited = min(TICK * float(post[2]), found["beads"])
            found["beads"], found["wait"] = found["beads"] - waited, found["wait"] + waited
        return found

    # --- its state ------------------------------------------------------------------------------

    def _state_of_particles(self) -> dict[str, Any]:
        """Positions, velocities and images that come piece by piece, until the next step."""
        shape, rows = (self.n, self.dimension), self.readings.rows_in_memory
        kinds = dict.fromkeys(SPREAD, np.float64) | {"images": np.int32}
        return {
            name: Spread(self.comm, shape, kind, partial(rows, name))
            for name, kind in kinds.items()
        }

    def restore(self, state: Mapping[str, Any]) -> None:
        """Continue from a state, which only the first rank needs."""
        root = self.comm.rank == ROOT
        plain = {k: np.asarray(v) for k, v in state.items() if k not in SPREAD} if root else None
        self._restore(self.comm.bcast(plain, ROOT), self._given(state) if root else ())
