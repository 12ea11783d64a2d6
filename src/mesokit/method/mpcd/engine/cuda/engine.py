"""Execution on a device: a fluid in its memory, whose steps are launches of kernels."""

from __future__ import annotations

from collections.abc import Sequence
from time import perf_counter

import numpy as np

from mesokit.case.case import Case
from mesokit.devices.device import Device, words_of
from mesokit.method.mpcd.engine.cpu.numbers import Numbers
from mesokit.method.mpcd.engine.cuda.kernels import sort as order
from mesokit.method.mpcd.engine.cuda.kernels.particles import wrap_molecule
from mesokit.method.mpcd.engine.cuda.memory import REAL, WHOLE, DeviceMemory
from mesokit.method.mpcd.engine.cuda.readings import DeviceReadings
from mesokit.method.mpcd.engine.cuda.step import Steps
from mesokit.method.mpcd.engine.running import Running


class CUDA(Running):
    """A fluid in the memory of a device, with the bits of `CPU`.

    Parameters
    ----------
    case : Case
        What to simulate.
    device : Device
        What runs the kernels: a card, or what stands for one (see `mesokit.devices`).
    measures : sequence of str
        As of `CPU`.
    """

    memory: DeviceMemory

    def __init__(self, case: Case, device: Device, measures: Sequence[str] = ()) -> None:
        self.case, self.numbers, self.device = case, Numbers(case), device
        self.memory = DeviceMemory(self.numbers, device, measures)
        self.readings = DeviceReadings(self.memory)
        self.solutes = self.readings.solutes
        self.n, self.dimension, self.box = self.numbers.n, self.numbers.dimension, self.numbers.box
        self._stages = Steps(self.memory, self._course(0, 0))
        self._seconds = {"steps": 0.0, "sort": 0.0}

    def _steps(self, steps: int, what: int) -> None:
        began = perf_counter()
        beads = self.memory.beads
        if beads is not None:
            beads.send(what)
        self._stages.run(self._course(steps, what))
        self.memory.step += steps
        if beads is not None:
            beads.fetch(what)
        self.device.wait()
        self._seconds["steps"] += perf_counter() - began

    def _sorted(self) -> int:
        began, memory, fluid = perf_counter(), self.memory, self.memory.fluid
        zero, lengths, molecules = memory.physics.zero, memory.lengths, fluid.molecules
        grid, counts, rank = memory.grid, memory.counts, memory.spare_short
        _, plain = memory.plain
        self._launch(wrap_molecule, molecules, self.numbers.filling, zero, memory.box, plain)
        most = self._counted(memory.n)
        if molecules < memory.n:  # these are sorted by their first beads
            self._counted(molecules)
        for level in range(len(counts) - 1):
            given = counts[level], lengths[level], counts[level + 1]
            self._launch(order.add_up_chunk, lengths[level + 1], *given)
        for level in reversed(range(len(counts) - 2)):
            self._launch(order.lift_by_chunk, lengths[level], counts[level], counts[level + 1])
        where = counts[0], rank, memory.order
        self._launch(order.place_in_order, molecules, zero, grid, fluid.r, *where)
        self._reorder()
        self.device.wait()
        self._seconds["sort"] += perf_counter() - began
        return most

    def _counted(self, places: int) -> int:
        """Count those at so many places in their cells; the most of one cell."""
        memory, counts = self.memory, self.memory.counts[0]
        self.device.clear(counts, memory.lengths[0] * WHOLE)
        where = memory.physics.zero, memory.grid, memory.fluid.r, counts, memory.spare_short
        self._launch(order.count_in_cell, places, *where)
        self.device.clear(memory.most, REAL)
        chunks = -(-memory.number_of_cells // order.CHUNK)
        self._launch(order.most_in_cell, chunks, counts, memory.number_of_cells, memory.most)
        return int(memory.row(memory.most, np.int64, 0, 1)[0])

    def _reorder(self) -> None:
        """Gather every row into a spare one, which takes its place."""
        memory, fluid = self.memory, self.memory.fluid
        moved: dict[int, int] = {}
        for row in (*fluid.r, *fluid.v):
            given = row, memory.order, fluid.molecules, memory.spare
            self._launch(order.gather_reals, memory.n, *given)
            moved[row], memory.spare = memory.spare, row
        for row in (*fluid.image, fluid.ident):
            given = row, memory.order, fluid.molecules, memory.spare_short
            self._launch(order.gather_wholes, memory.n, *given)
            moved[row], memory.spare_short = memory.spare_short, row
        memory.fluid = fluid._replace(
            r=tuple(moved[row] for row in fluid.r),
            v=tuple(moved[row] for row in fluid.v),
            image=tuple(moved[row] for row in fluid.image),
            ident=moved[fluid.ident],
        )
        self._stages.take_rows()

    def _launch(self, body: object, threads: int, *given: object) -> None:
        if threads:
            words = words_of(threads, *given)
            self.device.launch(self.device.kernel(body, given), words)  # type: ignore[arg-type]

    @property
    def seconds(self) -> dict[str, float]:
        """Time spent so far in steps and sorts, of which readings are no part."""
        return dict(self._seconds)
