"""Readings of a fluid in the memory of a device: sums and looks are kernels, the rest is shared."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.devices.device import BLOCK, words_of
from mesokit.method.mpcd.engine.cpu.numbers import Floats
from mesokit.method.mpcd.engine.cuda.kernels import sums
from mesokit.method.mpcd.engine.cuda.memory import DeviceMemory
from mesokit.method.mpcd.engine.measure.readings import Moments, Observed, Readings
from mesokit.scalar.fixed_point import HALF, LOW
from mesokit.scalar.pointer import WORD

MANY = 2**15  # numbers that threads add to at least: fewer would be waited for


class DeviceReadings(Readings):
    """The readings of `Readings`, by a device."""

    memory: DeviceMemory

    def __init__(self, memory: DeviceMemory) -> None:
        super().__init__(memory)

    def _run(self, body: Callable, threads: int, *given: Any) -> None:
        if threads:
            device = self.memory.device
            device.launch(device.kernel(body, given), words_of(threads, *given))

    def _summed(self, shape: tuple[int, ...], fill: Callable[[int], None]) -> NDArray[np.int64]:
        """Whole numbers that kernels add up at an address, which `fill` is given."""
        found, device = np.zeros(shape, np.int64), self.memory.device
        address = self.memory.room(found.nbytes)
        try:
            fill(address)
            device.read(address, found)
        finally:
            self.memory.give_back(address, found.nbytes)
        return found

    @property
    def _blocks(self) -> int:
        return -(-self.n // BLOCK)

    def _motion_of_strips(self) -> tuple[NDArray[np.int64], Floats]:
        scales, rows = self.numbers.scales_of_motion, self._blocks
        size = rows * len(scales)

        def fill(address: int) -> None:
            physics, fluid = self.memory.plain
            given = physics, scales, fluid, address, address + WORD * size
            self._run(sums.add_motion, self.n, *given)

        found = self._summed((rows * (len(scales) + 1),), fill)
        fastest = found[size:].view(np.float64)
        return found[:size].reshape(rows, len(scales)), np.where(np.isnan(fastest), np.inf, fastest)

    def _moments(self, axes: tuple[int, ...], bins: tuple[int, ...]) -> Moments:
        d, size = self.dimension, math.prod(bins)
        two = (axes + axes)[:2], tuple(float(n) for n in (*bins, 1)[:2])
        scales = tuple(self.numbers.units[name] for name in ["momentum"] * d + ["mass", "energy"])
        copies = max(min(MANY // size, self._blocks), 1)

        def fill(address: int) -> None:
            physics, fluid = self.memory.plain
            where = physics, self.memory.box, fluid
            self._run(
                sums.add_to_bin, self.n, *where, sums.SpreadBins(*two, scales, copies, address)
            )

        found = self._summed((copies, size, d + 3, 2), fill).sum(axis=0)
        high, low = found[..., 0], found[..., 1]
        parts = np.stack([high + (low >> HALF), low & LOW])
        values = self.joined(parts, np.array((1.0, *scales))).T.reshape(-1, *bins)
        return values[0], values[d + 1], values[1 : d + 1], values[d + 2]

    def _wave_sums(self, turns: Floats, scale: float, first: int, last: int) -> NDArray[np.int64]:
        copies = max(min(MANY // max(len(turns), 1), self._blocks), 1)
        device = self.memory.device
        there = self.memory.room(turns.nbytes)
        device.write(there, turns)

        def fill(address: int) -> None:
            waves = there, len(turns), scale, first, last
            physics, fluid = self.memory.plain
            where = physics, self.memory.box, fluid
            self._run(sums.add_to_waves, self.n, *where, waves, copies, address)

        try:
            shape = copies, len(turns), 2 + 2 * self.dimension
            return self._summed(shape, fill).sum(axis=0)
        finally:
            self.memory.give_back(there, turns.nbytes)

    def _gather_fluid(self, ids: NDArray | None, unwrapped: bool) -> Observed:
        number = self.n if ids is None else len(ids)
        slots = np.arange(self.n, dtype=np.int32)
        if ids is not None:
            slots[:] = -1
            slots[ids] = np.arange(number)
        return self._looked(sums.look_by_slot, self.n, slots, number, unwrapped)

    def seen_at(self, places: NDArray[np.int64], unwrapped: bool) -> Observed:
        where = np.ascontiguousarray(places, np.int64)
        return self._looked(sums.look_at_place, len(where), where, len(where), unwrapped)

    def _looked(
        self, body: Callable, threads: int, chosen: NDArray, number: int, unwrapped: bool
    ) -> Observed:
        """What a kernel writes of those that are chosen."""
        memory, shape = self.memory, (number, self.dimension)
        out = Observed(np.zeros(shape), np.zeros(shape), np.zeros(shape, np.int32))
        arrays: list[NDArray[Any]] = list(out)
        sizes = [chosen.nbytes, *(array.nbytes for array in arrays)]
        rooms = [memory.room(size) for size in sizes]
        memory.device.write(rooms[0], chosen)
        physics, fluid = memory.plain
        given = physics, memory.box, fluid, int(unwrapped), rooms[0], tuple(rooms[1:])
        self._run(body, threads, *given)
        for room, array in zip(rooms[1:], arrays, strict=True):
            memory.device.read(room, array)
        for room, size in zip(rooms, sizes, strict=True):
            memory.give_back(room, size)
        return out
