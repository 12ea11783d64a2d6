"""The stages of a step for the virtual particles of walls, each a launch of its own."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.method.mpcd.engine.cuda.kernels.one_by_one import (
    fill_cell_one_by_one,
    recoil_particle,
    top_up_cell,
)
from mesokit.method.mpcd.engine.cuda.kernels.virtual import fill_cell, follow, recoil_cell
from mesokit.method.mpcd.engine.cuda.launch import StepKernel
from mesokit.method.mpcd.engine.cuda.memory import WHOLE, DeviceMemory
from mesokit.method.mpcd.engine.cuda.wall_memory import WallMemory

Row = NDArray[np.uint64]


class WallStages:
    """The kernels of virtual particles; `made` makes one of a body and its arguments.

    The number of cells that are cut at a step follows from the shift of the grid: there are as many
    threads as there may be cells, and those beyond do nothing.
    """

    def __init__(
        self, memory: DeviceMemory, walls: WallMemory, made: Callable[..., StepKernel], few: int
    ) -> None:
        self._memory, self._walls, self._few = memory, walls, few
        given: tuple[Any, ...] = memory.fluid, walls.group
        if walls.top_up:
            self._fill = made(top_up_cell, *given)
        else:
            self._fill = made(fill_cell if walls.per_cell else fill_cell_one_by_one, *given)
        if walls.extrapolate:
            self._follow = made(follow, *given)
        if walls.measured and walls.per_cell:
            self._recoil = made(recoil_cell, *given)
        elif walls.measured:
            self._recoil = made(recoil_particle, *given, few)

    def fill(self, row: Row) -> None:
        """Virtual particles at t + dt, and their part in the sums of the cells that walls cut."""
        if not self._walls.top_up:
            self._fill_cells(row)

    def follow(self, row: Row) -> None:
        """The flow near surfaces, for the next step."""
        if self._walls.extrapolate:
            self._follow(self._walls.turns, row)

    def top_up(self, row: Row) -> None:
        """Virtual particles up to the mean number of a cell."""
        if self._walls.top_up:
            self._fill_cells(row)

    def _fill_cells(self, row: Row) -> None:
        if not self._walls.per_cell:
            self._memory.device.clear(self._walls.group.held, WHOLE)
        self._fill(self._walls.most, row)

    def recoil(self, row: Row) -> None:
        """The impulse that walls take by the collision of the virtual particles in them."""
        if self._walls.measured:
            self._recoil(self._walls.most if self._walls.per_cell else self._few, row)
