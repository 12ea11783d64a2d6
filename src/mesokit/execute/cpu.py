"""Execution on the threads of one machine: owns the arrays, and knows the verbs of a step."""

from __future__ import annotations

import math
from collections.abc import Sequence
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import RunError
from mesokit.execute import measure
from mesokit.execute.cell_energy import (
    MOST_ENERGY,
    MOST_PARTICLES,
    Column,
    NotAsked,
    WithCount,
)
from mesokit.execute.clock import STAGES
from mesokit.execute.fixed_point import ROUNDER_BITS
from mesokit.execute.layout import (
    BLOCK,
    LANES,
    ROW,
    SCRATCH_ROW,
    STRIPS,
    blocks_for,
    record_length,
    strips_for,
    sums_length,
    zeros,
)
from mesokit.execute.sort import sort
from mesokit.execute.stages import Grid, Physics
from mesokit.execute.step import FINISH, SOLVE, SWEEP, advance
from mesokit.execute.sweep import MEASURE_STRESS, MEASURE_WALLS
from mesokit.execute.team import Team
from mesokit.geometry.none import Nothing

if TYPE_CHECKING:
    from mesokit.case import Case

# Whole numbers of this many per thermal unit: 2^-42 of a thermal momentum, 2^-39 of kT, and 2^-20
# of kT where the energy shares an integer with the count.
MOMENTUM_BITS, MASS_BITS, ENERGY_BITS, WITH_COUNT_BITS = 42, 44, 39, 20
SORT_DISTANCE_SQUARED = 0.5  # particles are sorted again after straying less than a cell

Floats = NDArray[np.float64]
Moments = tuple[Floats, Floats, Floats, Floats]


class CPU:
    """A fluid in memory and the loops over it.

    Parameters
    ----------
    case : Case
        What to simulate.
    threads : int
        Threads to use; the results do not depend on it.
    measures : sequence of str
        "stress" and "walls", where an observable needs the stress of single steps or the momentum
        that the walls take.

    Examples
    --------
    >>> import mesokit
    >>> box, run = mesokit.Box([8, 8]), mesokit.Run(steps=1)
    >>> cpu = CPU(mesokit.Case(run=run, box=box, fluid=mesokit.Fluid()), 1)
    >>> cpu.n
    640
    """

    def __init__(self, case: Case, threads: int = 1, measures: Sequence[str] = ()) -> None:
        fluid, box = case.fluid, case.box
        self.case, self.threads, self.team = case, threads, Team(threads)
        self.dimension = d = box.dimension
        self.box = np.array(box.size, float)
        self.step, self.timestep = 0, fluid.timestep
        self.measures = frozenset(measures)
        wall = case.walls[0] if case.walls else None
        self.closed = tuple(wall is not None and wall.axis == axis for axis in box.axes)
        self.virtual = "none"
        if wall is not None and "no-slip" in (wall.lower.rule, wall.upper.rule):
            self.virtual = wall.virtual

        kinds = [(kind.mass, kind.density) for kind in fluid.species]
        kinds = kinds or [(fluid.mass, fluid.density)]
        heaviest = max(mass for mass, _ in kinds)
        self.counts = [round(density * box.volume) for _, density in kinds]
        self.n = sum(self.counts)
        if self.n == 0:
            raise RunError(f"fluid.density = {fluid.density:g}: no particle in the box")
        layer = math.prod(s for s, shut in zip(box.size, self.closed, strict=True) if not shut)
        self.n_virtual = (
            round(fluid.density * layer) if self.virtual in ("fill", "extrapolate") else 0
        )

        uniform = len({mass for mass, _ in kinds}) == 1
        rule = fluid.collision.kernel(d, fluid.kT)
        speed = max(
            math.sqrt(fluid.kT / min(mass for mass, _ in kinds)),
            abs(box.shear_rate) * box.size[1] / 16.0,
            *(
                abs(u) / 16.0
                for w in case.walls
                for s in (w.lower, w.upper)
                for u in s.velocity or ()
            ),
        )
        units = {
            "momentum": 2.0 ** (MOMENTUM_BITS - math.ceil(math.log2(heaviest * speed))),
            "mass": 2.0 ** (MASS_BITS - math.ceil(math.log2(heaviest))),
            "energy": 2.0 ** (ENERGY_BITS - math.ceil(math.log2(heaviest * speed * speed))),
        }
        self.units = units
        self.fastest = 2.0**49 / units["momentum"] / heaviest
        energy: NotAsked | Column | WithCount = NotAsked()
        if fluid.collision.needs_energy:
            energy = Column()
        elif fluid.thermostat.needs_energy:
            energy = WithCount(units["energy"] * 2.0 ** (WITH_COUNT_BITS - ENERGY_BITS))
            self.fastest = min(self.fastest, math.sqrt(MOST_ENERGY / energy.scale / heaviest))
        self.physics = Physics(
            rule,
            fluid.thermostat.kernel(fluid.kT),
            fluid.force.kernel(box.size),
            wall.kernel(box.size) if wall else Nothing(),
            (heaviest,) if uniform else (),
            energy,
            fluid.timestep,
            fluid.kT,
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

        self.cells = tuple(size + shut for size, shut in zip(box.size, self.closed, strict=True))
        self.number_of_cells = math.prod(self.cells)
        self.sort_every = int(
            min(
                max(2.0 * SORT_DISTANCE_SQUARED * fluid.mass / (fluid.kT * fluid.timestep**2), 10),
                100,
            )
        )
        self._allocate(uniform)
        self.box_kernel = box.kernel(self.closed, 0.0)
        zero, cells = (0.0,) * d, tuple(float(n) for n in self.cells)
        self.grid = Grid(zero, zero, cells, tuple(1.0 / n for n in cells))
        self.clock, self.sort_seconds = np.zeros(STAGES + 3, np.int64), 0.0
        self.wall_steps = 0
        self._asked: tuple[NDArray, NDArray[np.int32]] | None = None  # ids, and their slots
        self._seen: dict[tuple, Moments] = {}  # moments at this step, for several observables
        self.stress: dict[str, Floats] = {}

    def _allocate(self, uniform: bool) -> None:
        d, threads = self.dimension, self.threads
        self.rows = 2 * d + (not uniform)
        self.real_blocks = blocks_for(self.n)
        self.strips = strips_for(self.n), strips_for(self.n_virtual)
        blocks = self.real_blocks + blocks_for(self.n_virtual)
        lanes = blocks * BLOCK
        self.data = zeros(blocks * self.rows * ROW)
        self.cell = zeros(lanes, np.int32)
        self.ident = np.arange(lanes, dtype=np.int32)  # beyond n: virtual particles
        self.image = zeros((d, lanes), np.int32)
        self.order, self.spare = zeros(self.n, np.int32), zeros(self.n)
        self.ends = zeros((threads, self.number_of_cells), np.int32)
        spare_cell = self.number_of_cells  # where lanes that must not act leave their terms
        self.coefficients = zeros((spare_cell + 1) * record_length(self.coefficient_count))
        self.sums = zeros((threads, (spare_cell + 1) * sums_length(len(self.terms))), np.int64)
        most = max(self.coefficient_count, 2 * d)
        parts = self.strips[0] if "stress" in self.measures else 1
        self.impulse = zeros((threads, 2 * d), np.int64)
        self.wall_rates = zeros((2, d))
        self.tensor = zeros((2, parts, 2 * d * d))
        self.sweep_scratch = (
            zeros((threads, most * SCRATCH_ROW)),
            zeros((threads, LANES), np.int64),
            zeros((threads, (len(self.terms) + 1) * SCRATCH_ROW), np.int64),
            self.impulse,
            self.tensor,
            self.wall_rates,
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
            (self.n, self.n_virtual),
            self.strips,
            self.real_blocks * STRIPS,
            self.rows,
            spare_cell,
        )
        self.cell_arrays = (self.coefficients, self.sums)

    # --- the step -------------------------------------------------------------------------------

    @property
    def time(self) -> float:
        """Time since the start of the warm-up."""
        return self.step * self.timestep

    def advance(self, steps: int, measure_stress: bool = False) -> None:
        """Run some steps; velocities are then those after the collision of the last."""
        if steps == 0:
            self._advance(0, False)
        while steps > 0:
            due = self.sort_every - self.step % self.sort_every
            now = min(steps, due)
            self._advance(now, measure_stress and now == steps)
            steps -= now
            if now == due:
                self.sort()

    def _advance(self, steps: int, measure_stress: bool) -> None:
        self._seen.clear()
        what = MEASURE_WALLS * ("walls" in self.measures) + MEASURE_STRESS * measure_stress
        if measure_stress:
            self.tensor[:] = 0.0
        self.team.run(
            advance, self.clock, steps, self.step, self.case.run.seed, self.case.fluid.grid_shift,
            tuple(float(shut) for shut in self.closed), what,
            (self.case.fluid.density,) if self.virtual == "top-up" else (),
            (1.0,) if self.virtual == "extrapolate" else (),
            self.physics, self.box_kernel, self.grid, self.particles, self.cell_arrays,
            self.number_of_cells, self.sweep_scratch, self.cell_scratch, self.like, self.c,
            self.terms, self.scales,
        )  # fmt: skip
        self.step += steps
        self.wall_steps += steps
        self.box_kernel = self.case.box.kernel(self.closed, self.time)
        if measure_stress:
            self._stress()

    def sort(self) -> None:
        """Bring particles back into the box and those of one cell together in memory."""
        start = perf_counter()
        self.team.run(
            sort, self.box_kernel, self.grid, self.data, self.cell, self.ident, self.image, self.n,
            self.strips[0], self.rows, self.order, self.ends, self.spare,
            self.spare.view(np.int32), self.like,
        )  # fmt: skip
        self.sort_seconds += perf_counter() - start
        self._check_speed()
        self._check_crowd()

    def _check_crowd(self) -> None:
        """The last sort left in `ends` where each cell's particles end."""
        if self.n < MOST_PARTICLES or not isinstance(self.physics.energy, WithCount):
            return
        most = int(np.diff(self.ends[-1], prepend=0).max())
        if most >= MOST_PARTICLES:
            raise RunError(
                f"step {self.step}: {most} particles in one cell, more than the {MOST_PARTICLES} "
                "that a thermostat can count"
            )

    def _check_speed(self) -> None:
        totals = self._totals()
        fastest = totals[:, -1].max()
        if not (fastest < self.fastest and np.isfinite(totals).all()):
            raise RunError(
                f"step {self.step}: a particle moves at {fastest:g}, beyond the {self.fastest:g} "
                "that cell sums can hold; the fluid heats up: add a thermostat, or lower the force"
            )

    # --- what observables ask for ---------------------------------------------------------------

    def totals(self) -> tuple[int, Floats, float]:
        """Number of particles, momentum (d,) and kinetic energy."""
        total = self._totals().sum(axis=0)
        return self.n, total[: self.dimension], 0.5 * float(total[self.dimension])

    def _totals(self) -> Floats:
        out = np.zeros((self.strips[0], self.dimension + 2))
        self.team.run(measure.totals, self.physics, self.data, self.n, self.rows, self.like, out)
        return out

    def moments(self, axes: tuple[int, ...], bins: tuple[int, ...]) -> Moments:
        """Number, mass, momentum (d, ...) and sum of m v^2 in bins along one or two axes."""
        key = axes, bins
        if key not in self._seen:
            self._seen[key] = self._moments(axes, bins)
        return self._seen[key]

    def _moments(self, axes: tuple[int, ...], bins: tuple[int, ...]) -> Moments:
        d, threads, size = self.dimension, self.threads, math.prod(bins)
        two = (axes + axes)[:2], tuple(float(n) for n in (*bins, 1)[:2])
        names = ["momentum"] * d + ["mass", "energy"]
        scales = tuple(self.units[name] for name in names)
        length = sums_length(d + 2)
        part = zeros((threads, size * length), np.int64)
        quanta = (
            np.zeros((threads, LANES), np.int32),
            np.zeros((threads, (d + 2) * SCRATCH_ROW), np.int64),
        )
        particles = self.physics, self.box_kernel, self.data, self.n, self.rows, self.like
        self.team.run(measure.bin_sums, *particles, *two, scales, quanta, part)
        total = part.sum(axis=0).reshape(size, length)[:, : d + 3]
        number, sums = total[:, 0], total[:, 1:] - total[:, :1] * ROUNDER_BITS
        values = (sums / np.array(scales)).T.reshape(-1, *bins)
        return number.astype(float).reshape(bins), values[d], values[:d], values[d + 1]

    def modes(self, wavevectors: NDArray) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
        """Sums of m exp(-i k r) (K,) and of m v exp(-i k r) (K, d) for wave vectors (K, d)."""
        waves = np.ascontiguousarray(wavevectors, float) / (2.0 * math.pi)
        d, scale = self.dimension, self.units["momentum"]
        part = np.zeros((self.threads, len(waves), 2 + 2 * d), np.int64)
        particles = self.physics, self.box_kernel, self.data, self.n, self.rows, self.like
        self.team.run(measure.modes, *particles, waves, scale, part)
        total = part.sum(axis=0) / scale
        return total[:, 0] + 1j * total[:, 1], total[:, 2 : 2 + d] + 1j * total[:, 2 + d :]

    def positions(self, ids: NDArray | None = None, unwrapped: bool = False) -> Floats:
        """Positions (n, d) by particle id, in the box or as if it had no bounds."""
        return self._gather(ids, unwrapped)[0]

    def velocities(self, ids: NDArray | None = None) -> Floats:
        """Velocities (n, d) by particle id."""
        return self._gather(ids, False)[1]

    def images(self, ids: NDArray | None = None) -> NDArray[np.int32]:
        """How many times each particle left the box along each axis (n, d), by particle id."""
        return self._gather(ids, False)[2]

    def masses(self, ids: NDArray | None = None) -> Floats:
        """Masses (n,) by particle id: kinds are numbered one after the other."""
        mass = np.repeat(self.masses_of_kinds, self.counts)
        return mass if ids is None else mass[ids]

    def species(self, ids: NDArray | None = None) -> NDArray[np.int64]:
        """Kind of each particle (n,), by particle id: its place in fluid.species."""
        kind = np.repeat(np.arange(len(self.counts)), self.counts)
        return kind if ids is None else kind[ids]

    def _gather(self, ids: NDArray | None, unwrapped: bool) -> tuple[Floats, Floats, NDArray]:
        slots = np.arange(self.n, dtype=np.int32) if ids is None else self._slots(ids)
        shape = self.n if ids is None else len(ids), self.dimension
        out = np.zeros(shape), np.zeros(shape), np.zeros(shape, np.int32)
        particles = self.data, self.image, self.ident, slots, self.n, self.rows, self.like
        self.team.run(measure.gather_by_id, self.box_kernel, *particles, unwrapped, *out)
        return out

    def _slots(self, ids: NDArray) -> NDArray[np.int32]:
        """Place of each particle in `ids`, by particle id, -1 if none; kept for the next time."""
        if self._asked is None or not np.array_equal(self._asked[0], ids):
            slots = np.full(self.n, -1, np.int32)
            slots[ids] = np.arange(len(ids))
            self._asked = ids.copy(), slots
        return self._asked[1]

    def _stress(self) -> None:
        """Stress of the step that ends now, positive where the fluid above drags the one below.

        Kinetic: momentum carried in the flight, which is the mean of the values before and after
        the collision. Collisional: momentum handed over within cells (Winkler and Huang 2009).
        """
        d = self.dimension
        before, after = self.tensor.sum(axis=1).reshape(2, 2, d, d)
        volume = math.prod(self.case.box.size)
        self.stress = {
            "kinetic": -0.5 * (before[0] + after[0]) / volume,
            "collisional": -(after[1] - before[1]) / (volume * self.timestep),
        }

    @property
    def wall_impulse(self) -> Floats:
        """Momentum (2, d) that the lower and upper plate took since the last call."""
        taken = self.impulse.sum(axis=0).astype(float).reshape(2, -1) / self.units["momentum"]
        self.impulse[:] = 0
        self.wall_steps = 0
        return taken

    # --- state ----------------------------------------------------------------------------------

    def row(self, k: int) -> Floats:
        """Row k of every block of fluid particles, as a view (blocks, lanes)."""
        whole = self.data[: self.real_blocks * self.rows * ROW]
        return whole.reshape(self.real_blocks, self.rows, ROW)[:, k, :BLOCK]

    def virtual_row(self, k: int) -> Floats:
        """Row k of every block of virtual particles, as a view (blocks, lanes)."""
        whole = self.data[self.real_blocks * self.rows * ROW :]
        return whole.reshape(-1, self.rows, ROW)[:, k, :BLOCK]

    def state(self) -> dict[str, NDArray]:
        """Everything that the next step depends on. Raises RunError if sums have overflowed."""
        self._check_speed()
        return {
            "data": self.data[: self.real_blocks * self.rows * ROW].copy(),
            "ident": self.ident[: self.n].copy(),
            "image": self.image[:, : self.n].copy(),
            "step": np.int64(self.step),
            "impulse": self.impulse.sum(axis=0),
            "wall_steps": np.int64(self.wall_steps),
            "wall_rates": self.wall_rates.copy(),
        }

    def restore(self, state: dict[str, NDArray]) -> None:
        """Go on from a state, with the same bits whatever the number of threads was."""
        self._seen.clear()
        self.data[: state["data"].size] = state["data"]
        self.ident[: self.n] = state["ident"]
        self.image[:, : self.n] = state["image"]
        self.step = int(state["step"])
        self.impulse[:] = 0
        self.impulse[0] = state["impulse"]
        self.wall_steps = int(state["wall_steps"])
        self.wall_rates[:] = state["wall_rates"]
        self.box_kernel = self.case.box.kernel(self.closed, self.time)

    @property
    def seconds(self) -> dict[str, float]:
        """Time spent so far in each stage."""
        names = {"sweep": SWEEP, "cells": SOLVE, "finish": FINISH}
        seconds = {name: 1e-9 * float(self.clock[STAGES + k]) for name, k in names.items()}
        return seconds | {"sort": self.sort_seconds}

    @property
    def bytes_held(self) -> int:
        """Memory of all arrays."""
        arrays: list[NDArray] = [
            self.data, self.cell, self.ident, self.image, self.order, self.spare,
            self.coefficients, self.sums, self.tensor, *self.sweep_scratch, *self.cell_scratch,
        ]  # fmt: skip
        return sum(array.nbytes for array in arrays)


def _on_grid(mass: float, scale: float) -> float:
    """The mass rounded so that sums of masses are exact in fixed point."""
    return round(mass * scale) / scale
