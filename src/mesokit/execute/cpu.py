"""Execution on the threads of one machine: the verbs of a step, and the state between two."""

from __future__ import annotations

from collections.abc import Sequence
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import RunError
from mesokit.execute.cell_energy import MOST_PARTICLES, ONE_PARTICLE, WithCount
from mesokit.execute.clock import STAGES
from mesokit.execute.flags import MEASURE_STRESS, MEASURE_WALLS
from mesokit.execute.layout import LANES, ROW
from mesokit.execute.readings import Readings
from mesokit.execute.sort import sort
from mesokit.execute.step import FINISH, SOLVE, SWEEP, advance

if TYPE_CHECKING:
    from mesokit.case import Case


class CPU(Readings):
    """A fluid in memory and the loops over it.

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
        super().__init__(case, threads, measures)
        self.clock, self.sort_seconds = np.zeros(STAGES + 3, np.int64), 0.0

    @property
    def time(self) -> float:
        """Time since the start of the warm-up."""
        return self.step * self.timestep

    def advance(self, steps: int, measure_stress: bool = False) -> None:
        """Run some steps; velocities are then those after the collision of the last."""
        if steps == 0:
            self._advance(0, False)
        while steps > 0:
            due = self.sort_every - self.step % self.sort_every
            now = min(steps, due)
            self._advance(now, measure_stress and now == steps)
            steps -= now
            if now == due:
                self.sort()

    def _advance(self, steps: int, measure_stress: bool) -> None:
        self._seen.clear()
        what = MEASURE_WALLS * ("walls" in self.measures) + MEASURE_STRESS * measure_stress
        if measure_stress:
            self.tensor[:] = 0.0
            if self.dissolved is not None:
                self.dissolved.state_of.tensor[:] = 0.0
        self.team.run(
            advance, self.clock, steps, self.step, self.case.run.seed, self.case.fluid.grid_shift,
            tuple(float(shut) for shut in self.closed), what,
            (self.case.fluid.density,) if self.virtual == "top-up" else (),
            (1.0,) if self.virtual == "extrapolate" else (), self.guests, self.solutes,
            self.physics, self.box_kernel, self.grid, self.particles, self.cell_arrays,
            self.number_of_cells, self.sweep_scratch, self.cell_scratch, self.like, self.c,
            self.terms, self.scales,
        )  # fmt: skip
        self.step += steps
        self.wall_steps += steps
        self.box_kernel = self.case.box.kernel(self.closed, self.time)
        self._check_bonds()
        if self.dissolved is not None:
            self.dissolved.check()
        if measure_stress:
            self._stress()

    def _check_bonds(self) -> None:
        """That no bond was torn in the last steps."""
        torn = self.faults[self.faults[:, 0] > 0]
        molecule = self.case.fluid.molecule
        if len(torn) == 0 or molecule is None:
            return
        step, first, second = min(map(tuple, torn[:, :3].tolist()))
        raise RunError(
            f"step {step}: the bond of particles {first} and {second} is longer than the "
            f"{molecule.bond.longest:g} that it can be; take more sub-steps than "
            f"{self.substeps} (fluid.molecule.substeps), a stiffer bond, or start "
            "from particles that are not so far apart"
        )

    def sort(self) -> None:
        """Bring particles back into the box and those of one cell together in memory."""
        start = perf_counter()
        self.team.run(
            sort, self.box_kernel, self.grid, self.data, self.cell, self.ident, self.image,
            self.filling, self.rows, self.order, self.ends, self.spare,
            self.spare.view(np.int32), self.like,
        )  # fmt: skip
        self.calm[:] = 0.0  # other particles are in the strips now
        self.sort_seconds += perf_counter() - start
        self._check_sums(self._largest_crowd())

    def _largest_crowd(self) -> int:
        """Particles in the fullest cell, just after the sort."""
        if self.beads == 1:
            return int(np.diff(self.ends[-1], prepend=0).max())
        strips = self.cell[: self.places].reshape(-1, LANES)
        full, last = strips[: -self.beads], strips[-self.beads :]
        last = last[:, : (self.filling.molecules - 1) % LANES + 1]
        return int(np.bincount(np.concatenate([full.ravel(), last.ravel()])).max())

    def _check_sums(self, crowd: int) -> None:
        """That a cell of so many particles of the fastest kind cannot make its sums overflow."""
        totals = self._totals()
        fastest = totals[:, -1].max(initial=0.0)
        if not (fastest < self.fastest and np.isfinite(totals).all()):
            reason = (
                "fluid.start: give slower particles"
                if self.step == 0
                else "the fluid heats up: add a thermostat, or lower the force or the velocity of "
                "the surfaces"
            )
            raise RunError(
                f"step {self.step}: a particle moves at {fastest:g}, beyond the {self.fastest:g} "
                f"that cell sums can hold; {reason}"
            )
        heaviest, energy = max(self.masses_of_kinds), self.physics.energy
        full = crowd * heaviest * fastest * self.units["momentum"] > 2.0**61
        if isinstance(energy, WithCount):
            full |= crowd > MOST_PARTICLES
            full |= crowd * heaviest * fastest**2 * energy.scale > ONE_PARTICLE
        if full:
            raise RunError(
                f"step {self.step}: {crowd} particles in one cell, some as fast as {fastest:g}: "
                "more than cell sums can hold"
            )

    def state(self) -> dict[str, NDArray]:
        """Everything that the next step depends on. Raises RunError if sums have overflowed."""
        self._check_sums(1)
        return {
            **(self.dissolved.state() if self.dissolved else {}),
            "data": self.data[: self.real_blocks * self.rows * ROW].copy(),
            "ident": self.ident[: self.places].copy(),
            "image": self.image[:, : self.places].copy(),
            "step": np.int64(self.step),
            "impulse": self.impulse.sum(axis=0),
            "wall_steps": np.int64(self.wall_steps),
            "wall_rates": self.wall_rates.copy(),
        }

    def restore(self, state: dict[str, NDArray]) -> None:
        """Go on from a state, with the same bits whatever the number of threads was."""
        self._seen.clear()
        self.faults[:] = 0
        self.data[: state["data"].size] = state["data"]
        self.ident[: self.places] = state["ident"]
        self.image[:, : self.places] = state["image"]
        self.step = int(state["step"])
        self.impulse[:] = 0
        self.impulse[0] = state["impulse"]
        self.wall_steps = int(state["wall_steps"])
        self.wall_rates[:] = state["wall_rates"]
        self.calm[:] = 0.0
        self.box_kernel = self.case.box.kernel(self.closed, self.time)
        if self.dissolved is not None:
            self.dissolved.restore(state)

    @property
    def seconds(self) -> dict[str, float]:
        """Time spent so far in each stage."""
        names = {"sweep": SWEEP, "cells": SOLVE, "finish": FINISH}
        seconds = {name: 1e-9 * float(self.clock[STAGES + k]) for name, k in names.items()}
        return seconds | {"sort": self.sort_seconds}
