"""The sites in memory: events one after the other, exactly, or in sublattices on threads."""

import math
from collections.abc import Collection
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.kernels.packing import Packing
from mesokit.loops.threads import Threads
from mesokit.method.kinetic_monte_carlo.engine import bonds  # noqa: F401  registers exchanges
from mesokit.method.kinetic_monte_carlo.engine.classes import parts_of
from mesokit.method.kinetic_monte_carlo.engine.events import (
    CLOCK,
    NEXT,
    TIME,
    Course,
    begin,
    events,
    numbers_of,
)
from mesokit.method.kinetic_monte_carlo.engine.pairs import count_pairs
from mesokit.method.kinetic_monte_carlo.engine.record import LOST, record_of
from mesokit.method.kinetic_monte_carlo.engine.select import (
    choice_of,
    clear,
    order_of,
    set_order,
)
from mesokit.method.kinetic_monte_carlo.engine.sublattices import Blocks, cycles, sectors_of
from mesokit.method.kinetic_monte_carlo.lattice.grid import Sites, by_number, grid_of, length_of
from mesokit.method.kinetic_monte_carlo.start import kind_of
from mesokit.processes.signals import heard
from mesokit.seam.engine import Integers, Interrupted, State

TRACERS, WAITS = "tracers", "waits"  # what observables may have recorded
LINE = 8  # numbers of 64 bits in a line of the cache
AT_ONCE = 1_000_000  # events, some tenths of a second, after which a signal is looked for


class Events:
    """Engine of kinetic Monte Carlo (`mesokit.seam.engine.Engine`)."""

    def __init__(self, case: Case, threads: int = 1, measures: Collection[str] = ()) -> None:
        given = case.lattice
        size, kind = tuple(map(int, case.box.size)), given.lattice
        closed = tuple(axis in given.ends for axis in case.box.axes)
        grid = grid_of(kind, size, closed)
        self.size, self.timestep, self.step = size, given.timestep, 0
        self.model, self.places = given.model.kernel(kind, any(closed)), by_number(grid)
        self.states = len(given.model.states())
        self.n, memory = len(self.places), length_of(grid)
        self._kind = kind
        record = record_of(memory, len(size), self.states, TRACERS in measures, WAITS in measures)
        states, around = np.zeros(memory, kind_of(case)), np.zeros(memory, np.uint16)
        self.lattice = Sites(grid, states, around, record)
        self._shape = len(given.model.events()), kind.neighbours + 1
        number, seed = int(np.prod(self._shape)), np.uint64(case.run.seed)
        self.course = Course(
            seed,
            numbers_of(1),
            np.zeros(CLOCK),
            np.zeros(1, np.uint64),
            np.zeros(1, np.int64),
            np.zeros(number, np.int64),
        )
        self.seconds, self._packing = {"events": 0.0}, Packing()
        self.blocks: Blocks | None = None
        self._began: NDArray[Any] = np.zeros(0, states.dtype)
        home = None
        if given.sublattices is not None:
            block = given.sublattices.of(len(size))
            home, rim = sectors_of(grid, block)
            # whole cycles in a step of the run
            self.per_step = max(1, math.ceil(given.timestep / given.cycle(self.model.rates)))
            self.threads = Threads(min(threads, self.n // block ** len(size)))
            self.blocks = Blocks(
                seed,
                2 ** len(size),
                self.n // block ** len(size),
                given.timestep / self.per_step,
                rim.ravel(),
                rim.shape[1],
                numbers_of(self.threads.size),
                np.zeros(self.threads.size * (number + 2 * LINE), np.int64),
            )
        self.choice = choice_of(given.select, self.model, grid, home)
        begin.compile_ahead(*self._arguments())
        if self.blocks is None:
            events.compile_ahead(*self._arguments(), 0.0, AT_ONCE)
        else:
            self.threads.compile_ahead(cycles, *self._in_blocks(), 0, 0)

    def _arguments(self) -> tuple[Any, ...]:
        return self._packing(self.model, self.lattice, self.choice, self.course)

    def _in_blocks(self) -> tuple[Any, ...]:
        return self._packing(self.model, self.lattice, self.choice, self.blocks)

    def start(self, states: NDArray[Any]) -> None:
        """Put the sites in states (n,), by number."""
        self.lattice.states[self.places] = states
        # rates follow from the states: as if no site had ever had another
        clear(self.choice)
        begin(*self._arguments())
        self._tag()

    def _tag(self) -> None:
        """Begin to record: each particle has come no way, each site has just taken its state."""
        record = self.lattice.record
        if record.on:
            self._began = self.sites()
        if len(record.tags):
            record.tags.fill(LOST)
            record.tags[self.places] = np.arange(self.n)
            record.moved.fill(0)
        record.since.fill(self.time)
        record.waits.fill(0)
        record.sums.fill(0.0)

    def advance(self, steps: int, measure: Collection[str] = ()) -> None:
        """Run some steps: slices of time. Raises Interrupted on a signal."""
        began, goal = perf_counter(), self.step + steps
        if self.blocks is None:
            self._in_turn(goal)
        else:
            while self.step < goal:
                first = self.step * self.per_step
                last = first + self.per_step
                self.threads.run(cycles, *self._in_blocks(), first, last)
                self.step += 1
                if heard() and self.step < goal:
                    raise Interrupted
        self.step = goal
        self.seconds["events"] += perf_counter() - began

    def _in_turn(self, goal: int) -> None:
        until = goal * self.timestep
        while not events(*self._arguments(), until, AT_ONCE):
            if heard():  # some events of the next step may have happened
                done = math.floor(self.course.clock[TIME] / self.timestep)
                self.step = max(self.step, min(done, goal - 1))
                raise Interrupted

    @property
    def time(self) -> float:
        """Time since the start of the warm-up."""
        return self.step * self.timestep

    @property
    def absorbed(self) -> bool:
        """Whether nothing can happen any more."""
        if self.blocks is None:
            return bool(self.course.clock[NEXT] == np.inf)
        able = self.choice.numbers.reshape(parts_of(self.choice), -1)[:, :-1]
        return not able.any()

    def check(self) -> None:
        """Do nothing: no state is invalid."""

    def end_warmup(self) -> None:
        """Forget the events of the warm-up."""
        self.course.happened.fill(0)
        if self.blocks is not None:
            self.blocks.happened.fill(0)
        self._tag()

    def sites(self, ids: Integers | None = None) -> NDArray[np.integer]:
        """States (n,) of all sites, or of some, by number."""
        return self.lattice.states[self.places if ids is None else self.places[ids]]

    def pairs(self) -> NDArray[np.int64]:
        """Pairs of neighbours, seen from both: (states, states + 1) by the states of the two, the
        last column of sites without a neighbour in a direction."""
        found = np.zeros((self.states, self.states + 1), np.int64)
        count_pairs(self._packing(self.lattice)[0], self.places, found)
        return found

    def happened(self) -> NDArray[np.int64]:
        """Events (processes, directions + 1) since the warm-up, the last column of those without a
        neighbour."""
        found = self.course.happened.copy()
        if self.blocks is not None:
            found += self.blocks.happened.reshape(self.threads.size, -1)[:, : len(found)].sum(
                axis=0
            )
        return found.reshape(self._shape)

    def began(self) -> NDArray[np.integer]:
        """States (n,) of all sites after the warm-up, by number, where anything is recorded."""
        return self._began

    def tracers(self, ids: Integers | None = None) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """How far the particle that was at each site after the warm-up, or at some, has come since
        (n, d), in distances of neighbours; and whether it is still there (n,)."""
        grid, record, kind = self.lattice.grid, self.lattice.record, self._kind
        ids = np.arange(self.n) if ids is None else ids
        d, parity = len(self.size), np.array(kind.parity)
        moved = record.moved.reshape(-1, d)[ids]
        first = np.stack(np.unravel_index(ids, grid.size), axis=-1)
        odd = [(r @ parity) % 2 for r in (first, first + moved)]
        shifts = (odd[1] - odd[0])[:, None] * np.array(kind.shift)
        there = record.tags[self.places]
        kept = np.zeros(self.n, bool)
        kept[there[there >= 0]] = True
        return moved * np.array(kind.spacing) + shifts, kept[ids]

    def waits(self) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """How many sites have left each state after times in each bin (states, bins), and the sums
        of these times and of their squares (states, 2)."""
        record = self.lattice.record
        return record.waits.reshape(self.states, -1), record.sums.reshape(self.states, 2)

    def waiting(self) -> NDArray[np.float64]:
        """How long sites have been in their states, the sum over all in each state (states,)."""
        now = self.time - self.lattice.record.since[self.places]
        return np.bincount(self.sites(), now, minlength=self.states).astype(float)

    def state(self) -> State:
        """States by number of the site, the clock, the events so far and the order of lists."""
        course = self.course
        return {
            "states": self.sites(),
            "clock": course.clock,
            "drawn": course.drawn,
            "vain": course.vain,
            "happened": self.happened(),
            "step": np.array(self.step),
            **order_of(self.choice),
            **self._recorded(),
        }

    def _recorded(self) -> State:
        record = self.lattice.record
        state: State = {"began": self._began} if record.on else {}
        if len(record.tags):
            moved = record.moved[: self.n * len(self.size)]
            state |= {"tags": record.tags[self.places], "moved": moved}
        if len(record.since):
            since = record.since[self.places]
            state |= {"since": since, "waits": record.waits, "sums": record.sums}
        return state

    def restore(self, state: State) -> None:
        """Go on from a state."""
        course = self.course
        course.clock[:], course.drawn[:] = state["clock"], state["drawn"]
        course.vain[:] = state["vain"]
        course.happened[:] = np.ravel(state["happened"])
        if self.blocks is not None:
            self.blocks.happened.fill(0)
        self.step = int(state["step"])
        order = {name: np.array(state[name]) for name in order_of(self.choice)}
        self.start(state["states"])
        set_order(self.choice, order)
        record = self.lattice.record
        if record.on:
            self._began = np.array(state["began"])
        if len(record.tags):
            record.tags[self.places] = state["tags"]
            record.moved[: len(state["moved"])] = state["moved"]
        if len(record.since):
            record.since[self.places] = state["since"]
            record.waits[:], record.sums[:] = state["waits"], state["sums"]
