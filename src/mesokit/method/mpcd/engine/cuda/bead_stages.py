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


class BeadStages:
    """The kernels of solutes; `made` makes one of a body and what it takes beside the fluid."""

    def __init__(self, memory: BeadMemory, device: Device, made: Callable[..., StepKernel]) -> None:
        self._memory, self._device = memory, device
        beads, met = memory.group, memory.met
        self._collide = made(collide_solute, beads)
        self._drift, self._kick = made(drift_solute, beads, 0), made(kick_solute, beads, 0)
        if memory.lists is not None:
            self._stay, self._renew = made(stay_solute, beads, 0), made(renew_list, beads, 0)
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
        memory, lists = self._memory, self._memory.lists
        for n in range(memory.substeps + 1):
            if lists is not None:
                self._device.clear(lists.moved, WORD)
            if n > 0:
                self._drift(memory.number, row, n)
            elif lists is not None:
                self._stay(memory.number, row, n)
            if lists is not None:
                self._renew(memory.number, row, n)
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
