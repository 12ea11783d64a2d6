"""The virtual particles of walls in the memory of a device."""

from collections.abc import Callable
from typing import Any

import numpy as np

from mesokit.devices.device import Device
from mesokit.method.mpcd.engine.cpu.numbers import Floats, Numbers
from mesokit.method.mpcd.engine.cuda.kernels.groups import DeviceWalls, Planes
from mesokit.method.mpcd.engine.cuda.kernels.one_by_one import record_of_particle
from mesokit.method.mpcd.engine.cuda.kernels.virtual import record_of_cell
from mesokit.method.mpcd.engine.cuda.tables import copied
from mesokit.method.mpcd.engine.virtual.allocate import most_particles, tables_of
from mesokit.method.mpcd.engine.virtual.gradient import EVERY
from mesokit.scalar.pointer import WORD


class WallMemory:
    """Tables of virtual particles on a device, and what they leave there in a step.

    most: cut cells at any offset of the grid, at most. turns: pieces of surface, at most, that have
    their turn at a step. per_cell: whether all of a cell are drawn at once.
    """

    def __init__(
        self, numbers: Numbers, device: Device, room: Callable[[int], int], measured: bool
    ) -> None:
        self._device, self._room, self.measured = device, room, measured
        self.top_up, self.extrapolate = (numbers.virtual == r for r in ("top-up", "extrapolate"))
        tables, planes = tables_of(numbers)
        zero, density = (0.0,) * numbers.dimension, numbers.case.fluid.density
        self.per_cell = bool(planes)
        self.most = int(np.diff(tables["starts"]).max(initial=0))
        self._shape = tables["rates"].shape
        self.turns = -(-self._shape[0] // EVERY)
        records = self.most if planes else most_particles(density, self.most)
        width = record_of_cell(zero) if planes else record_of_particle(zero)
        if planes:
            tables |= {"corners": (), "pieces": (), "masses": ()}  # of particles one by one
        self.group = DeviceWalls(
            density=density,
            **{name: self._copied(table) for name, table in tables.items()},
            number_of_pieces=self._shape[0],
            planes=self._planes(planes),
            records=room(records * width * WORD if measured else 0),
            room=records,
            held=room(WORD),
        )

    def _planes(self, planes: dict[str, Any]) -> Planes | tuple[()]:
        if not planes:
            return ()
        there = {name: self._copied(table) for name, table in planes.items()}
        return Planes(len(planes["heights"]), **there)

    def _copied(self, table: Any) -> int:
        """The address of a table of float64 or int64 numbers on the device."""
        return copied(self._device, self._room, table, np.int64)

    @property
    def rates(self) -> Floats:
        """How the fluid's velocity rises with the distance from each piece of surface."""
        found = np.zeros(self._shape)
        if found.size:
            self._device.read(self.group.rates, found)
        return found

    def put_rates(self, rates: Floats) -> None:
        """Go on with these `rates`."""
        if rates.size:
            self._device.write(self.group.rates, np.ascontiguousarray(rates, np.float64))
