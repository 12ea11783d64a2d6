"""The step on a device: its stages in order, each a launch of as many threads as it has things."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.devices.device import words_of
from mesokit.method.mpcd.engine.cpu.groups import Course
from mesokit.method.mpcd.engine.cuda.bead_stages import BeadStages
from mesokit.method.mpcd.engine.cuda.embedded_stages import EmbeddedStages
from mesokit.method.mpcd.engine.cuda.kernels.beads.embedded import sweep_in_fluid
from mesokit.method.mpcd.engine.cuda.kernels.beads.molecules import sweep_molecule
from mesokit.method.mpcd.engine.cuda.kernels.cells import (
    collide_cell,
    collide_doubtful,
    fill_neighbour_sum,
)
from mesokit.method.mpcd.engine.cuda.kernels.particles import bounce_listed, sweep
from mesokit.method.mpcd.engine.cuda.launch import StepKernel
from mesokit.method.mpcd.engine.cuda.memory import WHOLE, DeviceMemory
from mesokit.method.mpcd.engine.cuda.plan import Plan
from mesokit.method.mpcd.engine.cuda.wall_stages import WallStages

Row = NDArray[np.uint64]
FEW = 2**13  # threads for what few particles or cells need, which they share out


class Steps:
    """The kernels of a case's steps, and their order."""

    def __init__(self, memory: DeviceMemory, course: Course) -> None:
        self.memory, self.device = memory, memory.device
        self._all: list[StepKernel] = []
        self.plan = Plan(memory.physics, memory.physics_there, course)
        physics = memory.physics_there._replace(field=self.plan.field)
        of_cells = physics._replace(field=(), solid=(), molecule=())
        self._sweep = self._of_step(*self._body(physics))
        self._collide = self._of_step(collide_cell, of_cells, memory.fluid)
        single = memory.numbers.beads == 1
        self.among_solids = memory.numbers.solids is not None and single
        if self.among_solids:
            self._bounce = self._of_step(bounce_listed, physics, memory.fluid, FEW)
        self._walls = None
        if memory.walls is not None:
            of_walls = physics._replace(thermostat=(), field=(), molecule=())

            def made(body: Any, *given: Any) -> StepKernel:
                return self._of_step(body, of_walls, *given)

            self._walls = WallStages(memory, memory.walls, made, FEW)
        self._beads = self._around = None
        if memory.beads is not None:

            def of_beads(body: Any, *given: Any) -> StepKernel:
                return self._of_step(body, physics, memory.fluid, *given)

            if memory.beads.near is None:
                self._beads = BeadStages(memory.beads, self.device, of_beads)
            else:
                self._around = EmbeddedStages(memory.beads, self.device, of_beads, FEW)
        if memory.has_doubts:
            self._doubt = self._of_step(collide_doubtful, of_cells, memory.fluid, FEW)
        if memory.fluid.neighbour_sums:
            self._sums = words_of(memory.number_of_cells, of_cells, memory.fluid)
            self._fill = self.device.kernel(fill_neighbour_sum, (of_cells, memory.fluid))

    def _body(self, physics: Any) -> tuple[Any, ...]:
        """What sweeps over particles, and what it takes."""
        memory = self.memory
        if memory.numbers.case.fluid.molecule:
            return sweep_molecule, physics, memory.fluid
        if memory.beads is not None and memory.beads.near is not None:
            return sweep_in_fluid, physics, memory.fluid, memory.beads.near
        return sweep, physics, memory.fluid

    def _of_step(self, body: Any, physics: Any, *more: Any) -> StepKernel:
        made = StepKernel(self.device, body, physics, self.plan, *more)
        self._all.append(made)
        return made

    def take_rows(self) -> None:
        """Go on with the rows of particles as they lie after a sort."""
        fluid = self.memory.fluid
        for kernel in self._all:
            kernel.take(fluid)

    def run(self, course: Course) -> None:
        """Some steps, and the collision of the last."""
        rows = self.plan.rows(course)
        for n in range(course.steps):
            self.step(rows[n])
        if course.steps:
            self._sweep(self.memory.fluid.molecules, rows[-1])  # v: the collision at the end
            if self._beads is not None:
                self._beads.collide(rows[-1])

    def step(self, row: Row) -> None:
        """One collision interval: r, v from t to t + dt."""
        memory = self.memory
        if self.among_solids:
            self.device.clear(memory.fluid.waiting, WHOLE)
        if self._around is not None:
            self._around.mark(row)  # cells around beads that act by a potential
        self._sweep(memory.fluid.molecules, row)  # v: the collision at t; r, v: t -> t + dt; sums
        if self._around is not None:
            self._around.choose(row)  # the same for those near marks that no bead can reach
        if self.among_solids:
            self._bounce(FEW, row)  # the same for those that may meet a surface
        if self._around is not None:
            self._around.move(row)  # r, v of beads and of those near them: t -> t + dt
        if self._beads is not None:
            self._beads.collide(row)  # v: the collision at t
            self._beads.move(row)  # r, v: t -> t + dt, in sub-steps
        if self._walls is not None:
            self._walls.fill(row)  # virtual particles at t + dt
            self._walls.follow(row)  # flow near surfaces, for the next step
            self._walls.top_up(row)  # virtual particles up to the mean number of a cell
        if memory.fluid.neighbour_sums:
            self.device.launch(self._fill, self._sums)  # sums for gradients over neighbours
        if self._beads is not None:
            self._beads.join(row)  # cells with solutes: coefficients from the sums of both
        if memory.has_doubts:
            self.device.clear(memory.fluid.doubts, WHOLE)
        self._collide(memory.number_of_cells, row)  # thermostat, rule at t + dt: coefficients
        if memory.has_doubts:
            self._doubt(FEW, row)  # the same where the thermostat must draw with care
        if self._beads is not None:
            self._beads.answer(row)  # they replace those of the fluid alone
        if self._walls is not None:
            self._walls.recoil(row)  # what the collision takes from virtual particles
