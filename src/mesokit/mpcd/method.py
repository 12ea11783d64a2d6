"""Multi-particle collision dynamics: the step."""

from __future__ import annotations

from collections.abc import Sequence
from time import perf_counter
from typing import TYPE_CHECKING

from mesokit.execute.cpu import CPU

if TYPE_CHECKING:
    from mesokit.case import Case


class MPCD:
    """A fluid that streams and collides.

    Parameters
    ----------
    case : Case
        What to simulate.
    threads : int
        Threads to use; the results do not depend on it.
    measures : sequence of str
        What observables need of single steps: "stress", "walls".
    """

    def __init__(self, case: Case, threads: int = 1, measures: Sequence[str] = ()) -> None:
        self.fluid = CPU(case, threads, measures)
        self.seconds = {"sort": 0.0, "stream": 0.0, "solve": 0.0, "collide": 0.0}

    def advance(self, steps: int, measure_stress: bool = False) -> None:
        """Run some steps; afterwards velocities are those after the collision of the last."""
        for remaining in range(steps, 0, -1):
            self.step(measure_stress and remaining == 1)
        self._timed("collide", measure_stress)

    def step(self, measure_stress: bool = False) -> None:
        """One step, with the collision of the particles left pending for the next `stream`."""
        if self.fluid.step % self.fluid.sort_every == 0 and self.fluid.step > 0:
            self._timed("collide")
            self._timed("sort")
        self.fluid.shift_grid()  # cells for the collision at t + dt
        self._timed("stream", measure_stress)  # r, v: t -> t + dt, virtual particles, cell sums
        self._timed("solve")  # thermostat and collision rule of each cell, at t + dt

    def _timed(self, stage: str, *arguments: bool) -> None:
        start = perf_counter()
        getattr(self.fluid, stage)(*arguments)
        self.seconds[stage] += perf_counter() - start
