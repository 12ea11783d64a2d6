"""The arrays of a fluid in the memory of a device, and the parameters of its physics there."""

from __future__ import annotations

import weakref
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.devices.device import BLOCK, Device, words_of
from mesokit.devices.records import WordByWord, adding
from mesokit.loops.layout import record_length, sums_length
from mesokit.method.mpcd.engine.beads.allocate import allocate_beads
from mesokit.method.mpcd.engine.beads.interactions import SHARED, shared_fault
from mesokit.method.mpcd.engine.cell_gradient import NeighbourSums
from mesokit.method.mpcd.engine.cpu.grid import Grid
from mesokit.method.mpcd.engine.cpu.numbers import Floats, Numbers
from mesokit.method.mpcd.engine.cpu.physics import Physics
from mesokit.method.mpcd.engine.cuda.bead_memory import BeadMemory
from mesokit.method.mpcd.engine.cuda.kernels.beads.embedded import add_energy
from mesokit.method.mpcd.engine.cuda.kernels.groups import DeviceFluid, Kinds
from mesokit.method.mpcd.engine.cuda.kernels.sort import CHUNK
from mesokit.method.mpcd.engine.cuda.tables import Tables
from mesokit.method.mpcd.engine.cuda.wall_memory import WallMemory
from mesokit.method.mpcd.engine.embedded.allocate import embedded_of
from mesokit.method.mpcd.engine.parameters import parameters_of
from mesokit.method.mpcd.thermostat.protocol import draw
from mesokit.scalar.fixed_point import total

REAL, WHOLE = 8, 4  # bytes of a number


class DeviceMemory:
    """A fluid in the memory of a device. `step` steps have been done.

    `physics` has addresses of tables of this process, `physics_there` those of the device.
    """

    def __init__(self, numbers: Numbers, device: Device, measures: Sequence[str]) -> None:
        d = numbers.dimension
        self.numbers, self.device, self.step = numbers, device, 0
        self.threads, self.domain = 1, None  # of what readings hold in this process
        self.measures = frozenset(measures)
        self._parameters = parameters_of(numbers)
        self.physics = self._parameters.physics
        self._held: set[int] = set()  # addresses, which are given back with this memory
        weakref.finalize(self, _give_back_all, device, self._held).atexit = False
        self.tables = Tables(device, self._held)
        self.physics_there = self.tables.there(self.physics)
        self.n, self.number_of_cells = numbers.n, numbers.number_of_cells
        self.bytes_held = 0
        self.fluid = self._allocate()
        self.walls = None
        if numbers.virtual != "none":
            self.walls = WallMemory(numbers, device, self.room, "walls" in self.measures)
        self.solutes, self.beads = self._solutes()
        self.bodies = ()  # which devices refuse
        zero, cells = (0.0,) * d, tuple(float(n) for n in numbers.cells)
        self.grid: Any = Grid(zero, zero, cells, tuple(1.0 / n for n in cells))

    def _solutes(self) -> tuple[Any, BeadMemory | None]:
        """Beads of solutes as readings know them, and on the device."""
        given = self.numbers.case.solutes
        if given is None:
            return (), None
        beads = allocate_beads(given, self)._replace(embedded=embedded_of(given, self.numbers, 1))
        return beads, BeadMemory(beads, self.numbers, self.device, self.tables, self.room)

    @property
    def plain(self) -> tuple[Physics, DeviceFluid]:
        """Physics and fluid without what tells kinds of case apart: readings and sorts are compiled
        once for all of them."""
        names = "rule", "thermostat", "field", "solid", "energy", "molecule"
        nothing: dict[str, Any] = dict.fromkeys((*names, "coefficients", "terms", "scales"), ())
        physics = self.physics_there._replace(**nothing)
        return physics, self.fluid._replace(adds=WordByWord(), neighbour_sums=(), tensor=())

    @property
    def box(self) -> tuple:
        """The box as it is after the last step."""
        numbers = self.numbers
        time = self.step * numbers.timestep
        return numbers.case.box.kernel(numbers.closed, time, numbers.timestep)

    def room(self, size: int) -> int:
        """The address of so many bytes, set to 0."""
        size = max(size, REAL)
        address = self.device.allocate(size)
        self._held.add(address)
        self.device.clear(address, size)
        self.bytes_held += size
        return address

    def give_back(self, address: int, size: int) -> None:
        """Free what `room` gave for so many bytes."""
        self._held.discard(address)
        self.device.free(address)
        self.bytes_held -= max(size, REAL)

    def _allocate(self) -> DeviceFluid:
        n, d, every = self.n, self.numbers.dimension, self.number_of_cells + 1
        self.spare, self.spare_short = self.room(n * REAL), self.room(n * WHOLE)
        self.order = self.room(n * WHOLE)
        self.counts, length = [self.room(every * WHOLE)], every
        self.lengths = [every]
        while length > 1:  # sums of chunks, of chunks of chunks, ...
            length = -(-length // CHUNK)
            self.lengths.append(length)
            self.counts.append(self.room(length * WHOLE))
        self.most = self.room(REAL)
        self.surfaces = 2 if self.numbers.slit else len(self._bodies())
        self.of_surface = d + (1 if d == 2 else 3)
        among_solids = self.numbers.solids is not None
        return DeviceFluid(
            r=tuple(self.room(n * REAL) for _ in range(d)),
            v=tuple(self.room(n * REAL) for _ in range(d)),
            image=tuple(self.room(n * WHOLE) for _ in range(d)),
            ident=self.room(n * WHOLE),
            kinds=self._kinds(),
            coefficients=self.room(every * record_length(self.numbers.coefficient_count) * REAL),
            sums=self.room(every * sums_length(len(self.physics.terms)) * REAL),
            adds=adding(self.device.chip, sums_length(len(self.physics.terms))),
            neighbour_sums=self._neighbour_sums(),
            impulse=self.room(self.surfaces * self.of_surface * REAL),
            listed=self.room(n * WHOLE if among_solids else 0),
            waiting=self.room(WHOLE),
            doubtful=self.room(every * WHOLE if self.has_doubts else 0),
            doubts=self.room(WHOLE),
            tensor=self._tensor(),
            molecules=n // self.numbers.beads,
            faults=self.room(SHARED * REAL),
        )

    @property
    def has_doubts(self) -> bool:
        """Whether the thermostat may have to draw again."""
        return type(self.physics.thermostat) in draw.implementations

    def _tensor(self) -> tuple[int, ...]:
        """A row for each block of threads, as readings of all have."""
        if "stress" not in self.measures:
            return ()
        parts = 2 + (self.numbers.beads > 1)
        return tuple(self.room(self._stress_numbers * REAL) for _ in range(parts))

    @property
    def _stress_numbers(self) -> int:
        return -(-self.n // BLOCK) * 2 * self.numbers.dimension**2

    def _bodies(self) -> list:
        return list(self.numbers.solids.bodies) if self.numbers.solids else []

    def _kinds(self) -> Kinds | tuple[()]:
        if self.numbers.uniform:
            return ()
        ends = np.cumsum(self.numbers.counts).astype(np.int64)
        masses = np.array(self.numbers.masses_of_kinds, float)
        ends_there, masses_there = (self.room(x.nbytes) for x in (ends, masses))
        self.device.write(ends_there, ends)
        self.device.write(masses_there, masses)
        return Kinds(ends_there, masses_there)

    def _neighbour_sums(self) -> tuple:
        numbers = self.numbers
        wanted = numbers.case.fluid.collision.gradient_of
        if wanted is None:
            return ()
        own = len(numbers.case.fluid.collision.own_sums(numbers.dimension))
        closed = tuple(int(shut) for shut in numbers.closed)
        values = self.room(self.number_of_cells * REAL)
        return NeighbourSums(len(numbers.scales) - own + wanted, values, numbers.cells, closed)

    # --- particles ------------------------------------------------------------------------------

    def put(
        self,
        ids: NDArray[np.int64],
        positions: Floats,
        velocities: Floats,
        images: NDArray[Any],
        first: int = 0,
    ) -> None:
        """Store these particles (n,), whole molecules, from this molecule on in memory."""
        fluid, beads = self.fluid, self.numbers.beads
        for bead in range(beads):
            start = first + bead * fluid.molecules
            self._write_row(fluid.ident, start, ids[bead::beads], np.int32)
            for k in range(self.numbers.dimension):
                self._write_row(fluid.r[k], start, positions[bead::beads, k], np.float64)
                self._write_row(fluid.v[k], start, velocities[bead::beads, k], np.float64)
                self._write_row(fluid.image[k], start, images[bead::beads, k], np.int32)

    def _write_row(self, row: int, start: int, values: NDArray[Any], kind: Any) -> None:
        values = np.ascontiguousarray(values, kind)
        self.device.write(row + start * values.itemsize, values)

    def row(self, address: int, kind: Any, first: int = 0, last: int | None = None) -> NDArray[Any]:
        """Numbers of a row, from one place in memory to before another."""
        last = self.n if last is None else last
        values = np.empty(last - first, kind)
        self.device.read(address + first * values.itemsize, values)
        return values

    def read(self) -> tuple[Floats, Floats, NDArray[np.int32]]:
        """Positions and velocities as they lie in memory, and images (n, d), by particle number."""
        fluid, shape = self.fluid, (self.n, self.numbers.dimension)
        ids = self.row(fluid.ident, np.int32)
        found = np.empty(shape), np.empty(shape), np.empty(shape, np.int32)
        for rows, out in zip((fluid.r, fluid.v, fluid.image), found, strict=True):
            for k, address in enumerate(rows):
                out[ids, k] = self.row(address, out.dtype)
        return found

    # --- surfaces, stress and faults ------------------------------------------------------------

    @property
    def places(self) -> NDArray[np.int64]:
        """Where particles lie, molecule after molecule."""
        first = np.arange(self.fluid.molecules)[:, None]
        return (first + np.arange(self.numbers.beads) * self.fluid.molecules).ravel()

    def ids(self, places: NDArray[np.int64]) -> NDArray[np.int64]:
        """Numbers of the particles at these places."""
        return self.row(self.fluid.ident, np.int32)[places].astype(np.int64)

    @property
    def wall_rates(self) -> Floats:
        """How the fluid's velocity rises with the distance from surfaces."""
        if self.walls is None:
            return np.zeros((2, self.numbers.dimension))
        return self.walls.rates

    def put_wall_rates(self, rates: Floats) -> None:
        """Go on with these `wall_rates`."""
        if self.walls is not None:
            self.walls.put_rates(rates)

    @property
    def numbers_taken(self) -> int:
        """How many numbers `taken_by_surfaces` gives."""
        return self.surfaces * self.of_surface

    def energy_in_fluid(self) -> float:
        """Potential energy of all beads that act by a potential and particles of the fluid."""
        assert self.beads is not None
        rows, scale = -(-self.n // BLOCK), self.numbers.units["energy"]
        physics, fluid = self.plain
        found, address = np.zeros((rows, 1), np.int64), self.room(rows * REAL)
        given = physics, self.box, fluid, self.beads.group, self.beads.near, scale, address
        self.device.launch(self.device.kernel(add_energy, given), words_of(self.n, *given))
        self.device.read(address, found)
        self.give_back(address, rows * REAL)
        return float(total(found, scale)[0])

    def clear_stress(self) -> None:
        """Set the terms of the stress to 0."""
        for address in self.fluid.tensor:
            self.device.clear(address, self._stress_numbers * REAL)

    def stress_terms(self) -> NDArray[np.int64]:
        """Terms of the stress of each block, kinetic and collisional, at each part of a step."""
        last = self._stress_numbers
        parts = [self.row(address, np.int64, 0, last) for address in self.fluid.tensor]
        return (
            np.stack(parts, axis=1)
            .reshape(-1, 2 * self.numbers.dimension**2, len(parts))
            .swapaxes(1, 2)
        )

    @property
    def faults(self) -> NDArray[np.int64]:
        """Step and beads of the first bond that tore (1, 3)."""
        return np.array([shared_fault(self.row(self.fluid.faults, np.int64, 0, SHARED))])

    def clear_faults(self) -> None:
        """Forget bonds that tore."""
        self.device.clear(self.fluid.faults, SHARED * REAL)

    def taken_by_surfaces(self) -> NDArray[np.int64]:
        """What surfaces took since the last call, as whole numbers."""
        counts = np.zeros(self.surfaces * self.of_surface, np.int64)
        self.device.read(self.fluid.impulse, counts)
        self.forget_surfaces()
        return counts

    def forget_surfaces(self) -> None:
        """Count anew what surfaces take."""
        self.device.clear(self.fluid.impulse, self.surfaces * self.of_surface * REAL)


def _give_back_all(device: Device, held: set[int]) -> None:
    for address in held:
        device.free(address)
