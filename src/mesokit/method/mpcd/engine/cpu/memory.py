"""The arrays of a fluid in memory, and the parameters of its physics as kernels take them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import RunError
from mesokit.kernels.packing import Packing
from mesokit.loops import layout
from mesokit.loops.layout import LANES, zeros
from mesokit.method.mpcd.engine.beads.allocate import allocate_beads
from mesokit.method.mpcd.engine.beads.registers import bead_size
from mesokit.method.mpcd.engine.bodies.allocate import allocate_bodies
from mesokit.method.mpcd.engine.cell_gradient import NeighbourSums
from mesokit.method.mpcd.engine.cpu.grid import Grid
from mesokit.method.mpcd.engine.cpu.groups import (
    Cells,
    FluidMemory,
    Particles,
    Scratch,
    Suspended,
    Taken,
    Walls,
)
from mesokit.method.mpcd.engine.cpu.near_solids import FEW
from mesokit.method.mpcd.engine.cpu.numbers import Numbers
from mesokit.method.mpcd.engine.cpu.sort import Order, sequence_of_cells
from mesokit.method.mpcd.engine.embedded.allocate import embedded_of
from mesokit.method.mpcd.engine.embedded.readings import energy_in_fluid
from mesokit.method.mpcd.engine.parameters import parameters_of
from mesokit.method.mpcd.engine.virtual.allocate import virtual_particles

Floats = NDArray[np.float64]
MOST = 2**31 - 2


class Memory:
    """A fluid in memory: its arrays, and the parameters of its physics.

    `step` steps have been done. Arrays of all threads are made here, so that memory is known.
    """

    def __init__(
        self,
        numbers: Numbers,
        threads: int,
        measures: Sequence[str],
        domain: Any = None,
        earlier: Memory | None = None,
    ) -> None:
        case, d = numbers.case, numbers.dimension
        self.numbers, self.threads, self.step = numbers, threads, 0
        self.measures, self.domain = frozenset(measures), domain
        self._packing = Packing()
        self._places, self._placed = np.zeros(0, np.int64), (0, numbers.beads)
        if earlier is None or (numbers.solids and earlier.domain.block != domain.block):
            self._parameters = parameters_of(numbers, None if domain is None else domain.held)
        else:  # tables of solids take long
            self._parameters = earlier._parameters
        self.physics = self._parameters.physics
        self._allocate()
        self.solutes: Any = ()
        if case.solutes is not None:
            embedded = embedded_of(case.solutes, numbers, threads)
            self.solutes = allocate_beads(case.solutes, self)._replace(embedded=embedded)
        self.bodies: Any = ()
        if case.bodies:
            self.bodies = allocate_bodies(numbers, threads, self.numbers_taken, domain)
        zero, cells = (0.0,) * d, tuple(float(n) for n in numbers.cells)
        self.grid: Any = Grid(zero, zero, cells, tuple(1.0 / n for n in cells))
        if domain is not None:
            self.grid = domain.grid(self.grid)

    @property
    def box(self) -> tuple:
        """The box as it is after the last step."""
        numbers = self.numbers
        time = self.step * numbers.timestep
        return numbers.case.box.kernel(numbers.closed, time, numbers.timestep)

    def groups(self) -> tuple[Any, ...]:
        """Physics, fluid, what moves in it, and walls as the step takes them."""
        suspended = Suspended(self.solutes, self.bodies)
        return self._packing(self.physics, self.fluid, suspended, self.walls)

    def _allocate(self) -> None:
        numbers, threads, d = self.numbers, self.threads, self.numbers.dimension
        filling, beads, room = numbers.filling, numbers.beads, numbers.filling.molecules
        self.cells, self.number_of_cells = numbers.cells, numbers.number_of_cells
        if self.domain is not None:
            filling, room = filling._replace(molecules=0), self.domain.room
            self.cells, self.number_of_cells = self.domain.region.known, self.domain.region.number
        self._require_few(room * beads)
        self.rows = 2 * d + (not numbers.uniform)
        self.strips = layout.strips_for(room, beads)
        lanes = layout.blocks_for(self.strips * LANES) * layout.BLOCK
        data, image = (
            zeros(lanes // layout.BLOCK * self.rows * layout.ROW),
            zeros((d, lanes), np.int32),
        )
        cell = zeros(lanes, np.int32)
        most = max(numbers.coefficient_count, 2 * d)
        bodies = len(numbers.solids.bodies) if numbers.solids else 0
        surfaces = 2 if numbers.slit else bodies
        strips = self.strips if "stress" in self.measures else 1
        self.fluid = FluidMemory(
            Particles(data, cell, np.arange(lanes), image, filling, self.rows),
            self._cells(),
            zeros((2, self.strips * (LANES // FEW))),
            Scratch(
                coefficients=zeros((threads, most * layout.SCRATCH_ROW)),
                terms=zeros(
                    (threads, (len(self.physics.terms) + 1) * layout.SCRATCH_ROW), np.int64
                ),
                marks=zeros((threads, LANES), np.int64),
                clear=zeros((threads, beads * layout.SCRATCH_ROW), np.int32),
                beads=zeros((threads, beads * bead_size(d) if beads > 1 else 1)),
            ),
            Taken(
                impulse=zeros((threads, surfaces * (d + (1 if d == 2 else 3))), np.int64),
                tensor=zeros((2 + (beads > 1), strips, 2 * d * d), np.int64),
                faults=zeros((threads, 8), np.int64),
            ),
        )
        self.fluid.particles.ident[self.places] = np.arange(filling.molecules * beads)
        spare, order = zeros(room * beads), zeros(room * beads, np.int32)
        ends = zeros((threads, self.number_of_cells + 1), np.int32)
        sequence = sequence_of_cells(self.cells, solids=numbers.solids is not None)
        self.order = Order(order, ends, spare, spare.view(np.int32), spare.view(np.int64), sequence)
        self.walls = self._walls()

    def _require_few(self, particles: int) -> None:
        """Raise RunError for more cells or particles than 32 bits can number, here or on a rank."""
        slots = 0 if self.domain is None else self.domain.slots
        cells = f"box.size: {self.number_of_cells} cells", self.number_of_cells + slots
        for what, number in (cells, (f"fluid.density: {particles} particles", particles)):
            if number >= MOST:
                raise RunError(
                    f"{what} are more than one process can number; expected several ranks, or more "
                    "of them"
                )

    @property
    def places(self) -> NDArray[np.int64]:
        """Where particles lie; among molecules some places are empty."""
        filling: Any = self.fluid.particles.filling
        molecules, beads = filling.molecules, self.numbers.beads
        if (molecules, beads) != self._placed:
            self._places = np.arange(molecules)
            if beads > 1:
                self._places = layout.places_of_beads(molecules, beads).ravel()
            self._placed = molecules, beads
        return self._places

    def _cells(self) -> Cells:
        # in the last, lanes that must not act leave their terms
        every = self.number_of_cells + 1
        width = layout.sums_length(len(self.physics.terms))
        shared = () if self.domain is None else self.domain.shared(self)
        slots = 0 if self.domain is None else self.domain.slots
        return Cells(
            self.number_of_cells,
            zeros((every + slots) * layout.record_length(self.numbers.coefficient_count)),
            zeros((self.threads, every * width), np.int64),
            self._field(),
            shared,
        )

    def _field(self) -> tuple:
        """Memory for the sum of which the rule needs the gradient."""
        numbers = self.numbers
        wanted = numbers.case.fluid.collision.gradient_of
        if wanted is None:
            return ()
        own = len(numbers.case.fluid.collision.own_sums(numbers.dimension))
        closed = tuple(int(shut) for shut in numbers.closed)
        term, values = len(numbers.scales) - own + wanted, zeros(self.number_of_cells)
        return NeighbourSums(term, values, tuple(self.cells), closed)

    def _walls(self) -> Walls:
        numbers, virtual = self.numbers, self.numbers.virtual
        if virtual == "none":
            return Walls((), (), ())
        return Walls(
            top_up=(1.0,) if virtual == "top-up" else (),
            gradient=(1.0,) if virtual == "extrapolate" else (),
            virtual=virtual_particles(numbers, self.threads, self.rows, self.domain),
        )

    @property
    def wall_rates(self) -> Floats:
        """How the fluid's velocity rises with the distance from surfaces; a view."""
        virtual = self.walls.virtual
        return virtual.rates if virtual else np.zeros((2, self.numbers.dimension))

    def put_wall_rates(self, rates: Floats) -> None:
        """Go on with these `wall_rates`."""
        self.wall_rates[:] = rates

    @property
    def faults(self) -> NDArray[np.int64]:
        """Steps and beads of the first bond that tore, of each thread (threads, 8)."""
        return self.fluid.taken.faults

    def clear_faults(self) -> None:
        """Forget bonds that tore."""
        self.fluid.taken.faults[:] = 0

    def clear_stress(self) -> None:
        """Set the terms of the stress to 0."""
        self.fluid.taken.tensor[:] = 0

    def fill(self, positions: Floats, velocities: Floats, images: Any = 0) -> None:
        """Write positions, velocities and images (n, d), given by particle number."""
        ids = self.fluid.particles.ident[self.places]
        images = np.broadcast_to(images, positions.shape)
        self.put(ids, positions[ids], velocities[ids], images[ids])

    def put(
        self,
        ids: NDArray[np.int64],
        positions: Floats,
        velocities: Floats,
        images: NDArray[Any],
        first: int = 0,
    ) -> None:
        """Store these particles (n,), whole molecules, from this molecule on in memory."""
        particles, d = self.fluid.particles, self.numbers.dimension
        start = first * self.numbers.beads
        data, places = particles.data, self.places[start : start + len(ids)]
        particles.ident[places] = ids
        for k in range(d):
            data[self.at(k, places)] = positions[:, k]
            data[self.at(d + k, places)] = velocities[:, k]
        particles.image[:, places] = images.T
        if self.rows > 2 * d:
            data[self.at(2 * d, places)] = self.numbers.masses_of(ids)
        self.fluid.room[:] = 0.0

    def read(self) -> tuple[Floats, Floats, NDArray[np.int32]]:
        """Positions and velocities as they lie in memory, and images (n, d), by particle number."""
        ids, rows = self.fluid.particles.ident[self.places], self.rows_of()
        positions, velocities, images = (np.empty(row.shape, row.dtype) for row in rows)
        positions[ids], velocities[ids], images[ids] = rows
        return positions, velocities, images

    def ids(self, places: NDArray[np.int64]) -> NDArray[np.int64]:
        """Numbers of the particles at these places."""
        ids: NDArray[np.int64] = self.fluid.particles.ident[places]
        return ids

    @property
    def numbers_taken(self) -> int:
        """How many numbers `taken_by_surfaces` gives."""
        return int(self.fluid.taken.impulse.shape[-1])

    def stress_terms(self) -> NDArray[np.int64]:
        """Terms of the stress of each strip, kinetic and collisional, at each part of a step."""
        return self.fluid.taken.tensor.swapaxes(0, 1)

    def energy_in_fluid(self) -> float:
        """Potential energy of all beads and particles of the fluid."""
        return energy_in_fluid(self)

    def taken_by_surfaces(self) -> NDArray[np.int64]:
        """What surfaces took since the last call, as whole numbers."""
        taken = self.fluid.taken.impulse.sum(axis=0)
        self.forget_surfaces()
        return taken

    def forget_surfaces(self) -> None:
        """Count anew what surfaces take."""
        self.fluid.taken.impulse[:] = 0

    @property
    def bytes_held(self) -> int:
        """Memory of all arrays."""
        fluid, order = self.fluid, self.order
        groups = (*fluid.particles, *fluid.cells, fluid.room, *fluid.scratch, *fluid.taken)
        arrays = (*groups, order.order, order.ends, order.spare, order.sequence)
        return sum(array.nbytes for array in arrays if isinstance(array, np.ndarray))

    def rows_of(self) -> tuple[Floats, Floats, NDArray[np.int32]]:
        """The same in the order of memory."""
        particles, d = self.fluid.particles, self.numbers.dimension
        out = np.empty((len(self.places), 2 * d))
        for k in range(2 * d):
            out[:, k] = particles.data[self.at(k)]
        return out[:, :d], out[:, d:], particles.image[:, self.places].T

    def columns(self, name: str, places: NDArray[np.int64]) -> NDArray[Any]:
        """Positions, velocities or images (n, d), by name, of those at these places in memory."""
        particles, d = self.fluid.particles, self.numbers.dimension
        if name == "images":
            return particles.image[:, places].T
        first = {"positions": 0, "velocities": d}[name]
        return np.stack([particles.data[self.at(first + k, places)] for k in range(d)], axis=1)

    def at(self, row: int, places: Any = None) -> NDArray[np.int64]:
        """Where a row's values lie in memory: those of all particles, or at these places."""
        places = self.places if places is None else places
        return (
            places // layout.BLOCK * (self.rows * layout.ROW)
            + row * layout.ROW
            + places % layout.BLOCK
        )
