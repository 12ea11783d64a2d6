"""The sites in memory: an engine that does events one after the other, exactly."""

import math
from collections.abc import Collection
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.kernels.packing import Packing
from mesokit.method.kinetic_monte_carlo.engine.select import choice_of, clear
from mesokit.method.kinetic_monte_carlo.engine.events import (
    CLOCK,
    NEXT,
    TIME,
    Course,
    begin,
    events,
    numbers,
)
from mesokit.method.kinetic_monte_carlo.engine.pairs import count_pairs
from mesokit.method.kinetic_monte_carlo.lattice.grid import Sites, by_number, grid_of, length_of
from mesokit.method.kinetic_monte_carlo.start import kind_of
from mesokit.processes.signals import heard
from mesokit.seam.engine import Integers, Interrupted, State

AT_ONCE = 1_000_000  # events, some tenths of a second, after which a signal is looked for


class Events:
    """Engine of kinetic Monte Carlo (`mesokit.seam.engine.Engine`)."""

    def __init__(self, case: Case) -> None:
        given = case.lattice
        size, kind = tuple(map(int, case.box.size)), given.lattice
        closed = tuple(axis in given.ends for axis in case.box.axes)
        grid = grid_of(kind, size, closed)
        self.size, self.timestep, self.step = size, given.timestep, 0
        self.model, self.places = given.model.kernel(kind, any(closed)), by_number(grid)
        self.states = len(given.model.states())
        self.n, memory = len(self.places), length_of(grid)
        self.lattice = Sites(grid, np.zeros(memory, kind_of(case)), np.zeros(memory, np.uint16))
        self.choice = choice_of(given.select, self.model.rates, grid, 1)
        self._shape = len(given.model.events()), kind.neighbours + 1
        self.course = Course(
            np.uint64(case.run.seed),
            numbers(),
            np.zeros(CLOCK),
            np.zeros(1, np.uint64),
            np.zeros(self._shape[0] * self._shape[1], np.int64),
        )
        self.seconds, self._packing = {"events": 0.0}, Packing()
        events.compile_ahead(*self._arguments(), 0.0, AT_ONCE)

    def _arguments(self) -> tuple[Any, ...]:
        return self._packing(self.model, self.lattice, self.choice, self.course)

    def start(self, states: NDArray[Any]) -> None:
        """Put the sites in states (n,), by number."""
        self.lattice.states[self.places] = states
        self._begin()

    def _begin(self) -> None:
        clear(self.choice)
        begin(*self._arguments())

    def advance(self, steps: int, measure: Collection[str] = ()) -> None:
        """Run some steps: slices of time. Raises Interrupted on a signal."""
        began, goal = perf_counter(), self.step + steps
        until = goal * self.timestep
        while not events(*self._arguments(), until, AT_ONCE):
            if heard():  # some events of the next step may have happened
                done = math.floor(self.course.clock[TIME] / self.timestep)
                self.step = max(self.step, min(done, goal - 1))
                raise Interrupted
        self.step = goal
        self.seconds["events"] += perf_counter() - began

    @property
    def time(self) -> float:
        """Time since the start of the warm-up."""
        return self.step * self.timestep

    @property
    def absorbed(self) -> bool:
        """Whether nothing can happen any more."""
        return bool(self.course.clock[NEXT] == np.inf)

    def check(self) -> None:
        """Do nothing: no state is invalid."""

    def end_warmup(self) -> None:
        """Forget the events of the warm-up."""
        self.course.happened.fill(0)

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
        return self.course.happened.reshape(self._shape).copy()

    def state(self) -> State:
        """States by number of the site, the clock and the events so far."""
        course = self.course
        return {
            "states": self.sites(),
            "clock": course.clock,
            "drawn": course.drawn,
            "happened": self.happened(),
            "step": np.array(self.step),
        }

    def restore(self, state: State) -> None:
        """Go on from a state."""
        course = self.course
        course.clock[:], course.drawn[:] = state["clock"], state["drawn"]
        course.happened[:] = np.ravel(state["happened"])
        self.step = int(state["step"])
        self.start(state["states"])
