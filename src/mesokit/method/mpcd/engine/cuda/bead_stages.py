"""The stages of a step for the beads of solutes, each a launch of its own."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from mesokit.devices.device import Device, words_of
from mesokit.method.mpcd.engine.cuda.bead_memory import WHOLE, BeadMemory
from mesokit.method.mpcd.engine.cuda.kernels.beads.meetings import (
    answer_cell,
    enter_members,
    join_cell,
    reserve_members,
)
from mesokit.method.mpcd.engine.cuda.kernels.beads.solutes import (
    bin_solute,
    collide_solute,
    drift_solute,
    kick_solute,
    renew_list,
    stay_solute,
)
from mesokit.method.mpcd.engine.cuda.launch import StepKernel
from mesokit.scalar.pointer import WORD

Row = NDArray[np.uint64]


class ListStages:
    """The kernels of neighbour lists; without lists nothing is launched."""

    def __init__(self, memory: BeadMemory, device: Device, made: Callable[..., StepKernel]) -> None:
        self._memory, self._device = memory, device
        if memory.lists is not None:
            beads = memory.group
            self._stay, self._renew = made(stay_solute, beads, 0), made(renew_list, beads, 0)

    def forget(self) -> None:
        """No bead has moved yet in this sub-step."""
        if self._memory.lists is not None:
            self._device.clear(self._memory.lists.moved, WORD)

    def stay(self, row: Row) -> None:
        """Before the first sub-step: how far beads have moved since their lists were made."""
        self.forget()
        if self._memory.lists is not None:
            self._stay(self._memory.number, row, 0)

    def renew(self, row: Row, n: int) -> None:
        """Make lists anew if any bead has moved too far."""
        if self._memory.lists is not None:
            self._renew(self._memory.number, row, n)


class BeadStages:
    """The kernels of solutes; `made` makes one of a body and what it takes beside the fluid."""

    def __init__(self, memory: BeadMemory, device: Device, made: Callable[..., StepKernel]) -> None:
        self._memory, self._device = memory, device
        beads, met = memory.group, memory.met
        self._collide = made(collide_solute, beads)
        self._drift, self._kick = made(drift_solute, beads, 0), made(kick_solute, beads, 0)
        self._lists = ListStages(memory, device, made)
        self._bin = made(bin_solute, beads, met)
        self._join, self._answer = made(join_cell, beads, met), made(answer_cell, beads, met)
        given = beads.cell, met
        self._reserve, self._enter = (
            device.kernel(body, given) for body in (reserve_members, enter_members)
        )
        self._words = words_of(memory.number, *given)

    def collide(self, row: Row) -> None:
        """The pending collision of all beads, if the step has one."""
        self._collide(self._memory.number, row)

    def move(self, row: Row) -> None:
        """Flights and kicks of all beads in sub-steps; their cells at t + dt."""
        memory = self._memory
        for n in range(memory.substeps + 1):
            if n > 0:
                self._lists.forget()
                self._drift(memory.number, row, n)
            else:
                self._lists.stay(row)
            self._lists.renew(row, n)
            self._kick(memory.number, row, n)
        self._bin(memory.number, row)

    def join(self, row: Row) -> None:
        """Cells with beads: coefficients from the sums of both."""
        self._device.clear(self._memory.met.taken, WHOLE)
        self._device.launch(self._reserve, self._words)
        self._device.launch(self._enter, self._words)
        self._join(self._memory.number, row)

    def answer(self, row: Row) -> None:
        """Their coefficients take the place of those of the fluid alone."""
        self._answer(self._memory.number, row)
