"""What a fluid is made of in memory: the numbers that follow from its case, and its arrays."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import RunError
from mesokit.execute.beads import bead_size
from mesokit.execute.cell_energy import MOST_DENSITY, Column, NotAsked, WithCount, with_count
from mesokit.execute.dissolve import dissolved
from mesokit.execute.invite import charted, guests_of
from mesokit.execute.layout import (
    BLOCK,
    LANES,
    ROW,
    SCRATCH_ROW,
    STRIPS,
    Molecules,
    Singles,
    blocks_for,
    places_of_beads,
    record_length,
    strips_for,
    sums_length,
    zeros,
)
from mesokit.execute.look_around import FEW
from mesokit.execute.stages import Grid, Physics
from mesokit.geometry.none import Nothing
from mesokit.solids import free_volume, slit_of, solids_of

if TYPE_CHECKING:
    from mesokit.case import Case
    from mesokit.execute.guests import Guests

# Whole numbers of this many per thermal unit: 2^-42 of a thermal momentum, 2^-39 of kT.
MOMENTUM_BITS, MASS_BITS, ENERGY_BITS = 42, 44, 39
FLOOR = 100.0  # of the rounding of a cell's energy: what a thermostat takes for no energy
SORT_DISTANCE_SQUARED = 0.5  # particles are sorted again after straying less than a cell

Floats = NDArray[np.float64]


class Memory:
    """The arrays of a fluid, and what the kernels must know of its case."""

    def __init__(self, case: Case, threads: int, measures: Sequence[str]) -> None:
        fluid, box = case.fluid, case.box
        self.case, self.threads = case, threads
        self.dimension = d = box.dimension
        self.box = np.array(box.size, float)
        self.step, self.timestep = 0, fluid.timestep
        self.measures = frozenset(measures)
        self.slit = slit_of(case)
        self.solids = solids_of(case) if case.walls else None
        self.closed = self.solids.room.closed if self.solids else (False,) * d
        bodies = self.solids.bodies if self.solids else []
        self.virtual = "none"
        if any(body.surface.rule != "slip" for body in bodies):
            self.virtual = case.walls[0].virtual

        kinds = [(kind.mass, kind.density) for kind in fluid.species]
        kinds = kinds or [(fluid.mass, fluid.density)]
        heaviest = max(mass for mass, _ in kinds)
        self.counts = [round(density * free_volume(case)) for _, density in kinds]
        self.beads = fluid.molecule.length if fluid.molecule else 1
        if self.beads > 1 or case.particles == 0:
            self.counts = [case.particles]
        self.n = sum(self.counts)
        molecules = self.n // self.beads
        self.filling = Molecules(molecules, self.beads) if fluid.molecule else Singles(molecules)
        if self.n == 0 and case.solutes is None:
            raise RunError(f"fluid.density = {fluid.density:g}: no particle in the box")
        layer = math.prod(s for s, shut in zip(box.size, self.closed, strict=True) if not shut)
        self.n_virtual = (
            round(fluid.density * layer)
            if self.slit is not None and self.virtual in ("fill", "extrapolate")
            else 0
        )

        self.cells = tuple(size + shut for size, shut in zip(box.size, self.closed, strict=True))
        self.number_of_cells = math.prod(self.cells)

        uniform = len({mass for mass, _ in kinds}) == 1
        self.units = units = units_of(case)
        self.fastest = 2.0**49 / units["momentum"] / heaviest
        energy: NotAsked | Column | WithCount = NotAsked()
        unit = 1.0 / units["energy"]
        sparse = uniform and fluid.density <= MOST_DENSITY
        if fluid.collision.needs_energy or (fluid.thermostat.needs_energy and not sparse):
            energy = Column()
        elif fluid.thermostat.needs_energy:
            energy = with_count(2.0**ENERGY_BITS * unit, max(fluid.density, 1.0))
            unit = 1.0 / energy.scale
        noise = unit * math.sqrt(self.n / box.volume + 1.0)
        self.physics = Physics(
            fluid.collision.kernel(d, fluid.kT),
            fluid.thermostat.kernel(fluid.kT, FLOOR * noise),
            fluid.force.kernel(box.size),
            self._solid(),
            (heaviest,) if uniform else (),
            energy,
            fluid.timestep,
            fluid.kT,
            self._molecule(),
        )

        names = ["momentum"] * d + ([] if uniform else ["mass"])
        names += ["energy"] * isinstance(energy, Column)
        names += fluid.collision.own_sums(d)
        self.scales = tuple(units[name] for name in names)
        self.masses_of_kinds = [_on_grid(mass, units["mass"]) for mass, _ in kinds]
        self.like = (0.0,) * d
        self.terms = (0,) * len(names)
        self.coefficient_count = fluid.collision.coefficient_count(d, fluid.thermostat.needs_energy)
        self.c = (0.0,) * self.coefficient_count

        steps = 2.0 * SORT_DISTANCE_SQUARED * fluid.mass / (fluid.kT * fluid.timestep**2)
        self.sort_every = int(min(max(steps, 10), 100))
        self._allocate(uniform)
        self.box_kernel = box.kernel(self.closed, 0.0)
        self.solutes = dissolved(case.solutes, self) if case.solutes else ()
        zero, cells = (0.0,) * d, tuple(float(n) for n in self.cells)
        self.grid = Grid(zero, zero, cells, tuple(1.0 / n for n in cells))

    def _solid(self) -> tuple:
        """Parameters of the solids; plates alone have a kernel of their own."""
        if self.solids is None:
            return Nothing()
        if self.slit is not None:
            return self.slit.kernel(self.case.box.size)
        bodies, self._clear = charted(self.case, self.solids)
        return bodies

    def _molecule(self) -> tuple:
        """Parameters of what holds molecules together."""
        fluid = self.case.fluid
        if fluid.molecule is None:
            return ()
        given = self.dimension, fluid.timestep, fluid.kT, fluid.mass
        self.substeps = fluid.molecule.number_of_substeps(*given)
        kernel, self._links = fluid.molecule.kernel(*given)
        return kernel

    def _allocate(self, uniform: bool) -> None:
        d, threads = self.dimension, self.threads
        self.rows = 2 * d + (not uniform)
        beads, molecules = self.beads, self.filling.molecules
        self.strips = strips_for(molecules, beads), strips_for(self.n_virtual)
        self.real_blocks = blocks_for(self.strips[0] * LANES)
        # up to the last particle; among molecules some places are empty
        self.places = self.n if beads == 1 else self.strips[0] * LANES
        blocks = self.real_blocks + blocks_for(self.n_virtual)
        lanes = blocks * BLOCK
        self.data = zeros(blocks * self.rows * ROW)
        self.cell = zeros(lanes, np.int32)
        self.ident = np.arange(lanes, dtype=np.int32)  # beyond n: virtual particles
        if beads > 1:
            self.ident[places_of_beads(molecules, beads).ravel()] = np.arange(self.n)
        self.image = zeros((d, lanes), np.int32)
        self.order, self.spare = zeros(self.n, np.int32), zeros(self.n)
        self.ends = zeros((threads, self.number_of_cells), np.int32)
        spare_cell = self.number_of_cells  # where lanes that must not act leave their terms
        self.coefficients = zeros((spare_cell + 1) * record_length(self.coefficient_count))
        self.sums = zeros((threads, (spare_cell + 1) * sums_length(len(self.terms))), np.int64)
        most = max(self.coefficient_count, 2 * d)
        parts = self.strips[0] if "stress" in self.measures else 1
        surfaces = 2 if self.slit else len(self.solids.bodies) if self.solids else 0
        self.impulse = zeros((threads, surfaces * (d + (1 if d == 2 else 3))), np.int64)
        self.wall_rates = zeros((2, d))
        self.calm = zeros((2, self.strips[0] * (LANES // FEW)))
        self.guests: Guests | tuple[()] = ()
        if self.solids and self.slit is None and self.virtual != "none":
            masses = np.repeat(self.masses_of_kinds, self.counts)
            self.guests = guests_of(self.case, self.solids, self.cells, threads, self.rows, masses)
            self.wall_rates = self.guests.rates
        self.tensor = zeros((2 + (beads > 1), parts, 2 * d * d))
        self.faults = zeros((threads, 8), np.int64)
        self.sweep_scratch = (
            zeros((threads, most * SCRATCH_ROW)),
            zeros((threads, beads * SCRATCH_ROW), np.int32),
            self.calm,
            zeros((threads, LANES), np.int64),
            zeros((threads, (len(self.terms) + 1) * SCRATCH_ROW), np.int64),
            self.impulse,
            self.tensor,
            self.wall_rates,
            zeros((threads, beads * bead_size(d) if beads > 1 else 1)),
            self.faults,
        )
        self.cell_scratch = (
            zeros((threads, most * SCRATCH_ROW)),
            zeros((threads, LANES), np.int64),
            zeros((threads, (len(self.terms) + 1) * SCRATCH_ROW), np.int64),
        )
        self.particles = (
            self.data,
            self.cell,
            self.ident,
            self.image,
            (self.filling, self.n_virtual),
            self.strips,
            self.real_blocks * STRIPS,
            self.rows,
            spare_cell,
        )
        self.cell_arrays = (self.coefficients, self.sums)

    def row(self, k: int) -> Floats:
        """Row k of every block of fluid particles, as a view (blocks, lanes)."""
        whole = self.data[: self.real_blocks * self.rows * ROW]
        return whole.reshape(self.real_blocks, self.rows, ROW)[:, k, :BLOCK]

    def put(self, k: int, values: Floats) -> None:
        """Write a number for each particle, by particle id, into row k; ids are still in order."""
        places = np.arange(self.n) if self.beads == 1 else self._places_by_id()
        self.row(k)[places // BLOCK, places % BLOCK] = values

    def _places_by_id(self) -> NDArray[np.int64]:
        return places_of_beads(self.filling.molecules, self.beads).ravel()

    def virtual_row(self, k: int) -> Floats:
        """Row k of every block of virtual particles, as a view (blocks, lanes)."""
        whole = self.data[self.real_blocks * self.rows * ROW :]
        return whole.reshape(-1, self.rows, ROW)[:, k, :BLOCK]

    @property
    def bytes_held(self) -> int:
        """Memory of all arrays."""
        arrays: list[NDArray] = [
            self.data, self.cell, self.ident, self.image, self.order, self.spare,
            self.coefficients, self.sums, self.tensor, *self.sweep_scratch, *self.cell_scratch,
        ]  # fmt: skip
        return sum(array.nbytes for array in arrays)


def units_of(case: Case) -> dict[str, float]:
    """How many units of fixed-point sums make one of momentum, mass and energy."""
    fluid, box = case.fluid, case.box
    masses = [kind.mass for kind in fluid.species] or [fluid.mass]
    heaviest = max(masses)
    speed = max(
        math.sqrt(fluid.kT / min(masses)),
        abs(box.shear_rate) * box.size[1] / 16.0,
        _fastest_surface(case) / 16.0,
    )
    return {
        "momentum": 2.0 ** (MOMENTUM_BITS - math.ceil(math.log2(heaviest * speed))),
        "mass": 2.0 ** (MASS_BITS - math.ceil(math.log2(heaviest))),
        "energy": 2.0 ** (ENERGY_BITS - math.ceil(math.log2(heaviest * speed * speed))),
    }


def _fastest_surface(case: Case) -> float:
    """A bound of the speed of all surfaces."""
    bodies = solids_of(case).bodies if case.walls else []
    return max(
        (
            math.hypot(*(body.surface.velocity or ()))
            + math.hypot(*body.rotation) * math.hypot(*case.box.size)
            for body in bodies
        ),
        default=0.0,
    )


def _on_grid(mass: float, scale: float) -> float:
    """The mass rounded so that sums of masses are exact in fixed point."""
    return round(mass * scale) / scale
