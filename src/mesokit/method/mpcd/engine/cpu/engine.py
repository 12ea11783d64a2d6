"""Execution on the threads of one machine: runs of steps, and the state between two of them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mesokit.case.case import Case
from mesokit.loops.clock import BEADS, CELLS, FINISH, FIRST, SORT, SWEEP
from mesokit.loops.threads import Threads
from mesokit.method.mpcd.engine.cpu.memory import Memory
from mesokit.method.mpcd.engine.cpu.numbers import Numbers
from mesokit.method.mpcd.engine.cpu.sort import sort
from mesokit.method.mpcd.engine.cpu.step import advance
from mesokit.method.mpcd.engine.measure.readings import Readings
from mesokit.method.mpcd.engine.running import Running
from mesokit.scalar.system import TICK


class CPU(Running):
    """A fluid in memory, whose steps the threads of a processor do.

    Parameters
    ----------
    case : Case
        What to simulate.
    threads : int
        Threads to use; the results do not depend on it.
    measures : sequence of str
        "stress" and "walls", where an observable needs the stress of single steps or the momentum
        that the walls take.

    Examples
    --------
    >>> import mesokit
    >>> box, run = mesokit.Box([8, 8]), mesokit.Run(steps=1)
    >>> cpu = CPU(mesokit.Case(run=run, box=box, fluid=mesokit.Fluid()), 1)
    >>> cpu.n
    640
    """

    def __init__(self, case: Case, threads: int = 1, measures: Sequence[str] = ()) -> None:
        self.case, self.numbers = case, Numbers(case)
        self.threads = Threads(threads)
        self.memory = Memory(self.numbers, threads, measures)
        self.readings = Readings(self.memory, self.threads)
        self.solutes, self.bodies = self.readings.solutes, self.readings.bodies
        self.n, self.dimension, self.box = self.numbers.n, self.numbers.dimension, self.numbers.box
        self.threads.compile_ahead(advance, self._course(0, 0), *self.memory.groups())

    def _steps(self, steps: int, what: int) -> None:
        self.threads.run(advance, self._course(steps, what), *self.memory.groups())
        self.memory.step += steps

    def _sorted(self) -> int:
        memory = self.memory
        where = memory.box, memory.grid, memory.fluid.particles
        self.threads.run(sort, memory.physics.zero, *where, memory.order)
        memory.fluid.room[:] = 0.0  # other particles are in the strips now
        if self.numbers.beads == 1:
            crowds = np.diff(memory.order.ends[-1, :-1], prepend=0)
        else:
            crowds = np.bincount(memory.fluid.particles.cell[memory.places], minlength=1)
        return int(crowds.max())

    @property
    def seconds(self) -> dict[str, float]:
        """Time spent so far in each stage."""
        beads = {"beads": BEADS} if self.solutes is not None else {}
        names = {"sweep": SWEEP, "cells": CELLS, "finish": FINISH, **beads, "sort": SORT}
        return {name: TICK * float(self.threads.clock[FIRST + k]) for name, k in names.items()}
