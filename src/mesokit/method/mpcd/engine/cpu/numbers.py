"""The numbers that follow from a case before any memory is allocated: counts, masses, precision."""

import math
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.errors import RunError
from mesokit.geometry.solids.solids import slit_of, solids_of
from mesokit.loops.layout import Molecules, Singles
from mesokit.method.mpcd.engine.cpu.strips import cell_energy
from mesokit.method.mpcd.groups import fluid_volume

# Whole numbers of this many per thermal unit: 2^-42 of a thermal momentum, 2^-39 of kT.
MOMENTUM_BITS, MASS_BITS, ENERGY_BITS = 42, 44, 39
STRESS_BITS = 24  # forces between beads that overlap are large
FLOOR = 100.0  # of the rounding of a cell's energy: what a thermostat takes for no energy
SORT_DISTANCE_SQUARED = 0.5  # particles are sorted again after straying less than a cell

Floats = NDArray[np.float64]


class Numbers:
    """Numbers of a case: of its particles and cells, and of fixed-point sums.

    counts: particles of each kind; n of all; beads: of each molecule (1 for single particles).
    virtual: the rule of virtual particles, "none" where no surface needs them. cells: along each
    axis; coefficient_count: of each cell.
    units: whole numbers per unit of momentum, mass, energy and stress; fastest: the largest speed.
    """

    def __init__(self, case: Case) -> None:
        fluid, box = case.fluid, case.box
        self.case = case
        self.dimension = d = box.dimension
        self.box = np.array(box.size, float)
        self.timestep = fluid.timestep
        self.slit = slit_of(case)
        self.solids = solids_of(case) if case.walls else None
        self.closed = self.solids.room.closed if self.solids else (False,) * d
        bodies = self.solids.bodies if self.solids else []
        held = any(body.surface.rule != "slip" for body in bodies)
        self.virtual = case.walls[0].virtual if held else "none"

        room = fluid_volume(case)
        self.counts = [round(kind.density * room) for kind in fluid.kinds]
        self.beads = fluid.molecule.length if fluid.molecule else 1
        if self.beads > 1 or case.particles == 0:
            self.counts = [case.particles]
        self.n = sum(self.counts)
        if self.n == 0 and case.solutes is None:
            raise RunError(f"fluid.density = {fluid.density:g}: no particle in the box")
        molecules = self.n // self.beads
        self.filling = Molecules(molecules, self.beads) if fluid.molecule else Singles(molecules)
        self.cells = tuple(size + shut for size, shut in zip(box.size, self.closed, strict=True))
        self.number_of_cells = math.prod(self.cells)

        self.heaviest = max(kind.mass for kind in fluid.kinds)
        self.uniform = len({kind.mass for kind in fluid.kinds}) == 1
        self.units = units_of(case)
        self.fastest = 2.0**49 / self.units["momentum"] / self.heaviest
        self.energy = self._energy()
        names = ["momentum"] * d + ([] if self.uniform else ["mass"])
        names += ["energy"] * isinstance(self.energy, cell_energy.Column)
        names += fluid.collision.own_sums(d)
        self.scales = tuple(self.units[name] for name in names)
        # rounded so that sums of masses are exact in fixed point
        grid = self.units["mass"]
        self.masses_of_kinds = [round(kind.mass * grid) / grid for kind in fluid.kinds]
        self.coefficient_count = fluid.collision.coefficient_count(d, fluid.thermostat.needs_energy)
        steps = 2.0 * SORT_DISTANCE_SQUARED * fluid.mass / (fluid.kT * fluid.timestep**2)
        self.sort_every = int(min(max(steps, 10), 100))

    def _energy(self) -> cell_energy.NotNeeded | cell_energy.Column | cell_energy.WithCount:
        fluid = self.case.fluid
        sparse = self.uniform and fluid.density <= cell_energy.MOST_DENSITY
        if fluid.collision.needs_energy or (fluid.thermostat.needs_energy and not sparse):
            return cell_energy.Column()
        if fluid.thermostat.needs_energy:
            thermal = 2.0**ENERGY_BITS / self.units["energy"]
            return cell_energy.with_count(thermal, max(fluid.density, 1.0))
        return cell_energy.NotNeeded()

    @property
    def density(self) -> float:
        """Particles per cell, of all kinds."""
        return sum(kind.density for kind in self.case.fluid.kinds)

    @property
    def scales_of_motion(self) -> tuple[float, ...]:
        """Whole numbers per unit of momentum (d) and of m v^2, in sums over all particles."""
        return (self.units["momentum"],) * self.dimension + (self.units["energy"],)

    @property
    def least_energy(self) -> float:
        """Energy of a cell below which a thermostat takes it for 0."""
        unit = 1.0 / self.units["energy"]
        if isinstance(self.energy, cell_energy.WithCount):
            unit = 1.0 / self.energy.scale
        return FLOOR * unit * math.sqrt(self.n / self.case.box.volume + 1.0)

    @property
    def total_mass(self) -> float:
        """Of all particles, rounded once."""
        kinds = zip(self.masses_of_kinds, self.counts, strict=True)
        return float(sum((Fraction(mass) * count for mass, count in kinds), Fraction(0)))

    def masses(self) -> Floats:
        """Masses (n,) by particle number: kinds are numbered one after the other."""
        return np.repeat(self.masses_of_kinds, self.counts)

    def masses_of(self, ids: NDArray[np.int64]) -> Floats:
        """Masses of some particles."""
        return np.array(self.masses_of_kinds)[self.kinds_of(ids)]

    def kinds(self) -> NDArray[np.int64]:
        """The place of each particle's kind in fluid.species, by particle number."""
        return np.repeat(np.arange(len(self.counts)), self.counts)

    def kinds_of(self, ids: NDArray[np.int64]) -> NDArray[np.int64]:
        """The same of some particles."""
        return np.searchsorted(np.cumsum(self.counts), ids, side="right")


def units_of(case: Case) -> dict[str, float]:
    """How many units of fixed-point sums make one of momentum, mass, energy, stress."""
    fluid, box = case.fluid, case.box
    masses = [kind.mass for kind in fluid.kinds]
    heaviest = max(masses)
    speed = max(
        math.sqrt(fluid.kT / min(masses)),
        box.largest_rate * box.size[1] / 16.0,
        fastest_surface(case) / 16.0,
    )
    return {
        "momentum": 2.0 ** (MOMENTUM_BITS - math.ceil(math.log2(heaviest * speed))),
        "mass": 2.0 ** (MASS_BITS - math.ceil(math.log2(heaviest))),
        "energy": 2.0 ** (ENERGY_BITS - math.ceil(math.log2(heaviest * speed * speed))),
        "stress": 2.0 ** (STRESS_BITS - math.ceil(math.log2(heaviest * speed * speed))),
    }


def fastest_surface(case: Case) -> float:
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
