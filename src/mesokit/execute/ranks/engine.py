"""Execution on the ranks of MPI: each has the particles of a block of cells, on its threads."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import RunError
from mesokit.execute.cpu.clock import MOVE, SHARE, WAIT
from mesokit.execute.cpu.engine import CPU
from mesokit.execute.cpu.memory import Memory
from mesokit.execute.cpu.numbers import Floats, Numbers
from mesokit.execute.cpu.threads import Threads
from mesokit.execute.ranks.blocks.balance import Balance, Load, still_good
from mesokit.execute.ranks.blocks.parcels import given_away, packed, unpacked
from mesokit.execute.ranks.blocks.tree import Tree, divided
from mesokit.execute.ranks.blocks.window import Window
from mesokit.execute.ranks.domain import Domain, axes_to_cut, owners
from mesokit.execute.ranks.messages.shared import DONE, FAR, FAULTS, FULL, MOLECULES, STRETCHED
from mesokit.execute.ranks.readings import SharedReadings, SharedSolutes
from mesokit.scalar.system import TICK

if TYPE_CHECKING:
    from mesokit.case.case import Case


GROWTH = 1.3  # times as many molecules as there are, when arrays become too small


class Ranks(CPU):
    """The part of a fluid that is one rank's, and the verbs that all ranks do together.

    Parameters
    ----------
    case : Case
        What to simulate; the same on all ranks.
    threads : int
        Of this rank.
    measures : sequence of str
        As of `CPU`.
    comm : communicator of mpi4py
        Of all ranks.
    """

    def __init__(self, case: Case, threads: int, measures: Sequence[str], comm: Any) -> None:
        self.case, self.numbers, self.comm = case, Numbers(case), comm
        self.threads, self.measures = Threads(threads), measures
        self.n, self.dimension, self.box = self.numbers.n, self.numbers.dimension, self.numbers.box
        self.sort_seconds = 0.0
        self.balancing = Balance(comm, case.run.imbalance)
        self._window = Window()
        tree = divided(self.numbers.cells, comm.size, axes_to_cut(self.numbers))
        self._live_in(tree, self.numbers.filling.molecules // comm.size)

    def _live_in(self, tree: Tree, molecules: int) -> None:
        """New memory, for this rank's block in a tree."""
        size = self.threads.size
        earlier = self.memory if hasattr(self, "memory") else None
        self.domain = Domain(self.numbers, self.comm, tree, size, molecules)
        self.memory = Memory(self.numbers, size, self.measures, self.domain, earlier)
        steps = self.readings.wall_steps if earlier is not None else 0
        self.readings = SharedReadings(self.memory, self.threads, self.comm)
        self.readings.wall_steps = steps
        self.solutes = self.readings.solutes

    # --- running --------------------------------------------------------------------------------

    readings: SharedReadings

    def begin(self, positions: Floats, velocities: Floats) -> None:
        images = np.zeros(positions.shape, np.int32)
        self._take(np.arange(self.n), positions, velocities, images)
        self.sort()

    def _take(
        self, who: NDArray[np.int64], positions: Floats, velocities: Floats, images: NDArray
    ) -> None:
        """Of these molecules, whole, those that are in this rank's block."""
        beads = self.numbers.beads
        owner = self.domain.owners(positions[::beads])
        mine = np.repeat(owner == self.comm.rank, beads)
        self._hold(who[mine], positions[mine], velocities[mine], images[mine])

    def _hold(
        self, who: NDArray[np.int64], positions: Floats, velocities: Floats, images: NDArray
    ) -> None:
        """Have these particles, and no others."""
        molecules = len(who) // self.numbers.beads
        if molecules > self.domain.room:
            self._live_in(self.domain.tree, molecules)
        self._count(molecules)
        memory = self.memory
        memory.fluid.particles.ident[memory.places] = who
        memory.put(positions, velocities, images)

    def _count(self, molecules: int) -> None:
        """Have so many molecules in memory."""
        fluid = self.memory.fluid
        filling: Any = fluid.particles.filling
        filling = filling._replace(molecules=molecules)
        self.memory.fluid = fluid._replace(particles=fluid.particles._replace(filling=filling))
        fluid.cells.shared.noted[MOLECULES] = molecules

    def _make_room(self) -> None:
        """Larger arrays for what this rank has."""
        memory, rows = self.memory, self.memory.rows_of()
        who = memory.fluid.particles.ident[memory.places]
        self._live_in(self.domain.tree, int(GROWTH * len(who) / self.numbers.beads) + 1)
        self._go_on_from(memory)
        self._hold(who, *rows)

    def _go_on_from(self, memory: Memory) -> None:
        """Take over what is not of particles."""
        new = self.memory
        new.step = memory.step
        new.fluid.taken.impulse[:] = memory.fluid.taken.impulse
        new.wall_rates[:] = memory.wall_rates
        new.fluid.cells.shared.meter[:] = memory.fluid.cells.shared.meter

    def _steps(self, steps: int, what: int) -> None:
        left = steps
        while True:
            before = self.memory.step
            with self._window.timing(self):
                super()._steps(left, what)
            noted = self.memory.fluid.cells.shared.noted
            self.memory.step = before + int(noted[DONE])
            left -= int(noted[DONE])
            self._check_messages(noted)
            if steps:
                self._count(int(noted[MOLECULES]))
            if left <= 0:
                return
            self._make_room()

    # --- balance --------------------------------------------------------------------------------

    def sort(self) -> None:
        with self._window.timing(self):
            super().sort()
        if self.step > 0:
            self._balance()

    def _balance(self) -> None:
        """Move borders if the window before the last said so."""
        windows = self.balancing.heard()
        if windows:
            kept = still_good(self.domain.tree, windows, self.balancing.limit)
            if kept.nodes != self.domain.tree.nodes:
                self.cut_anew(kept)
        self.balancing.tell(self._window.work)
        self._window = Window()

    def cut_anew(self, kept: Tree | None = None) -> None:
        """Cut by what each cell has cost of late; nodes in `kept` stay."""
        load = Load(self.domain.block, self._costs(), self.comm)
        cells, weights = self.numbers.cells, axes_to_cut(self.numbers)
        tree = divided(cells, self.comm.size, weights, load.layers, kept)
        if tree.blocks != self.domain.tree.blocks:
            self.live_in(tree)
        self.balancing.moved(self.step, tree.blocks)

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

    def live_in(self, tree: Tree) -> None:
        """Have the blocks of another tree, and the particles that are there."""
        memory, rates = self.memory, self.readings.wall_rates()
        solutes = None if self.solutes is None else self.solutes.state()
        who = memory.fluid.particles.ident[memory.places]
        rows = packed(who, *memory.rows_of())
        leaders = memory.rows_of()[0][:: self.numbers.beads]
        owner = np.repeat(owners(tree.blocks, self.numbers, leaders), self.numbers.beads)
        rows = given_away(rows, owner, self.comm)
        self._live_in(tree, len(rows) // self.numbers.beads)
        self._go_on_from(memory)
        self.memory.wall_rates[:] = rates
        self._hold(*unpacked(rows))
        if self.solutes is not None and solutes is not None:
            self.solutes.restore(solutes)

    def balance(self) -> dict[str, Any]:
        """Most over mean of the ranks' work at first and of late, and the moves of borders."""
        known = self.balancing
        return {"first": known.first, "last": known.last, "moves": list(known.moves)}

    def _check_messages(self, noted: NDArray[np.int64]) -> None:
        faults, post = int(noted[FAULTS]), self.memory.fluid.cells.shared.post
        if post.flag[1]:
            raise RunError(f"step {self.step}: a message to another rank failed")
        if faults & FULL:
            raise RunError(
                f"step {self.step}: more particles beyond the cells around a rank's block than it "
                "has room for; expected fewer ranks"
            )
        if faults & STRETCHED:
            raise RunError(
                f"step {self.step}: a bead of solutes went farther in a step, or its bonds are "
                "longer, than ranks can follow; expected fewer ranks or a shorter fluid.timestep"
            )
        if faults & FAR:
            raise RunError(
                f"step {self.step}: a particle came to a cell of a rank that is no neighbour; "
                "expected fewer ranks"
            )

    @property
    def seconds(self) -> dict[str, float]:
        """Time spent so far in each stage, on this rank."""
        names = {"share": SHARE, "wait": WAIT, "move": MOVE}
        clock = self.threads.clock
        return super().seconds | {name: TICK * float(clock[3 + k]) for name, k in names.items()}

    def _check_sums(self, crowd: int) -> None:
        if len(self.memory.places):
            super()._check_sums(crowd)

    # --- its state ------------------------------------------------------------------------------

    def state(self) -> dict[str, Any]:
        self.check()
        everybody = np.arange(self.n)
        seen = self.readings.as_they_are(everybody)
        return {
            **(self.solutes.state() if self.solutes else {}),
            "positions": seen.positions,
            "velocities": seen.velocities,
            "images": seen.images,
            "step": np.int64(self.step),
            "impulse": self.readings.impulse,
            "wall_steps": np.int64(self.readings.wall_steps),
            "wall_rates": self.readings.wall_rates(),
        }
