"""The stages of a step for solutes that act by a potential, each a launch of its own."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from mesokit.devices.device import Device
from mesokit.method.mpcd.engine.cuda.bead_memory import WHOLE, BeadMemory
from mesokit.method.mpcd.engine.cuda.bead_stages import ListStages
from mesokit.method.mpcd.engine.cuda.kernels.beads.embedded import (
    bring_back,
    choose_candidates,
    drift_in_fluid,
    drift_near,
    kick_near,
    mark_bead,
    take_impulse,
)
from mesokit.method.mpcd.engine.cuda.kernels.beads.solutes import kick_solute
from mesokit.method.mpcd.engine.cuda.launch import StepKernel

Row = NDArray[np.uint64]


class EmbeddedStages:
    """The kernels of such solutes; `made` makes one of a body and what it takes beside the fluid.

    `few` threads share out the particles near beads.
    """

    def __init__(
        self, memory: BeadMemory, device: Device, made: Callable[..., StepKernel], few: int
    ) -> None:
        self._memory, self._device, self._few = memory, device, few
        beads, near = memory.group, memory.near
        self._lists = ListStages(memory, device, made)
        self._mark = made(mark_bead, beads, near)
        self._choose = made(choose_candidates, beads, near, few)
        self._drift, self._kick = made(drift_in_fluid, beads, near, 0), made(kick_solute, beads, 0)
        self._drift_near = made(drift_near, beads, near, few, 0)
        self._kick_near = made(kick_near, beads, near, few, 0)
        self._take = made(take_impulse, beads, near)
        self._bring = made(bring_back, near, few)

    def mark(self, row: Row) -> None:
        """Mark the cells around beads, before the sweep."""
        self._device.clear(self._memory.near.waiting, WHOLE)
        self._device.clear(self._memory.near.number, WHOLE)
        self._mark(self._memory.number, row)

    def choose(self, row: Row) -> None:
        """Particles that no bead can reach fly as all others; the rest waits for the sub-steps."""
        self._choose(self._few, row)

    def move(self, row: Row) -> None:
        """Flights and kicks of beads and of the particles near them, in sub-steps."""
        number = self._memory.number
        for n in range(self._memory.substeps + 1):
            if n > 0:
                self._lists.forget()
                self._drift(number, row, n)
                self._drift_near(self._few, row, n)
            else:
                self._lists.stay(row)
            self._lists.renew(row, n)
            self._kick(number, row, n)
            self._kick_near(self._few, row, n)
            self._take(number, row)
        self._bring(self._few, row)
