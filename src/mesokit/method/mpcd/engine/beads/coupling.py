"""Cells that hold beads: coefficients of the collision for particles and beads together.

Cells add up the fluid alone, so beads cost nothing elsewhere. Here the sums of the few cells with
beads are completed, each by the thread that collides the cell. The coefficients of these sums
replace those that `collide` finds for the fluid alone.
"""

import math

import numpy as np

from mesokit.kernels.part import stage
from mesokit.loops.layout import LANES, record_length, share
from mesokit.method.mpcd.collision.protocol import Cell, contribute, freedom
from mesokit.method.mpcd.collision.protocol import coefficients as coefficients_of
from mesokit.method.mpcd.engine.beads.state import PRESENT, bead_of, mass_of, number_of
from mesokit.method.mpcd.engine.cpu.collide import as_many, draw_with_care
from mesokit.method.mpcd.engine.cpu.strips.cell_energy import needs_energy
from mesokit.method.mpcd.engine.cpu.strips.rows import load_values, store_values
from mesokit.method.mpcd.engine.cpu.strips.terms import read_sums, sums_of_cell
from mesokit.method.mpcd.engine.domains.messages.shared import key_of
from mesokit.method.mpcd.engine.embedded.state import collides
from mesokit.method.mpcd.engine.where import where
from mesokit.method.mpcd.thermostat.protocol import guess
from mesokit.scalar.gamma import gamma_number
from mesokit.scalar.jit import by_type, scalar
from mesokit.scalar.poisson import poisson_number
from mesokit.scalar.random import CELL, CELL_VIRTUAL, FIRST_BEAD, VIRTUAL_NUMBER, normals, words
from mesokit.scalar.vector import added, dot, scaled

NO_BEAD = -1


@scalar
def cells_of_thread(worker, number):
    """First and last + 1 of the cells of a thread in `collide`."""
    first, last = share((number + LANES - 1) // LANES, worker.thread, worker.threads)
    return first * LANES, min(last * LANES, number)


@where(beads=collides)
@stage
def join_beads(worker, now, physics, fluid, beads):
    """Coefficients for cells with beads, from sums that `collide` is about to clear."""
    cells = fluid.cells
    first, last = cells_of_thread(worker, cells.number)
    present = number_of(beads.halo, len(beads.cell), PRESENT)
    # Link the beads of each cell. Every thread reads all beads, but links only cells of its own
    # share of `collide`. Beads come by id, so each list has one order for any threads and ranks.
    for n in range(present):
        i = bead_of(beads.halo, PRESENT, n)
        cell = beads.cell[i]
        if first <= cell < last:
            beads.following[i] = beads.head[cell]
            beads.head[cell] = i
    # The bead at the head of each list stands for its cell: coefficients for fluid and beads
    # together are computed once for each. This must precede `collide`, which clears the sums of the
    # fluid.
    for n in range(present):
        i = bead_of(beads.halo, PRESENT, n)
        cell = beads.cell[i]
        if first <= cell < last:
            beads.leads[i] = beads.head[cell] == i
            if beads.leads[i]:
                answer = answer_for(beads, i, physics, now.counter, cells, cell)
                store_values(beads.answers, np.uint64(i * len(physics.coefficients)), answer)


@scalar
def answer_for(beads, leader, physics, counter, cells, cell):
    """The coefficients of the cell of a bead, the first of its list, with all beads in it."""
    found, key = sums_of_cell(cells.sums, cell, physics.terms), key_of(cells.shared, cell)
    total = without_beads(beads, physics, counter, key, found)
    i = leader
    # Sums of beads are floats, so their order matters: it is that of the list.
    while i != NO_BEAD:
        total = with_bead(beads, i, total, physics.zero)
        i = beads.following[i]
    return answer_to(physics, counter, key, total)


@scalar
def without_beads(beads, physics, counter, key, found):
    """The sums of a cell, from those of the fluid in it."""
    n, mass, momentum, energy, own = read_sums(physics, found)
    total = n, mass if n > 0.5 else 0.0, momentum, energy, own
    return with_random_solvent(beads.solvent, beads, physics, counter, key, total)


@scalar
def with_bead(beads, i, total, zero):
    """The same with one more bead."""
    n, mass, momentum, energy, own = total
    given = load_values(beads.given, np.uint64(i * len(beads.terms)), beads.terms)
    more, its_energy, its_own = parts_of(given, zero)
    n, mass, momentum = n + 1.0, mass + mass_of(beads, i), added(momentum, more)
    return n, mass, momentum, energy + its_energy, added(own, its_own)


@scalar
def answer_to(physics, counter, key, total):
    """The coefficients of the cell with these sums."""
    n, mass, momentum, energy, own = total
    chance = words(counter, CELL, key, 0)
    x, sure = guess(physics.thermostat, chance[2:], freedom(physics.rule, n))
    if not sure:
        x = draw_with_care(physics, counter, key, freedom(physics.rule, n))
    found = Cell(n, mass, momentum, energy, own)
    answer = coefficients_of(physics.rule, physics.thermostat, x, chance[:2], found)
    return as_many(answer, physics.coefficients)


@by_type
def parts_of(given, zero):
    """Momentum, m v^2 and the rule's own sums of a bead."""
    d, rest = len(zero), len(zero) + 1
    return lambda given, zero: (given[:d], given[d], given[rest:])


@where("total", solvent=len)
def with_random_solvent(solvent, beads, physics, counter, cell, total):
    """The sums with as many particles as a cell holds, whose momentum is drawn from a Maxwellian;
    nothing where there is a fluid."""
    mean, mass_of_one = solvent
    n, mass, momentum, energy, own = total
    zero = physics.zero
    d, number = len(zero), poisson_number(mean, counter, VIRTUAL_NUMBER, cell)
    if number > 0:
        m = number * mass_of_one
        a, b, e, f = words(counter, CELL_VIRTUAL, cell, 0)
        v = scaled(math.sqrt(physics.kT / m), normals(zero, a, b, e, f))
        n, mass, momentum = n + number, mass + m, added(momentum, scaled(m, v))
        if needs_energy(physics.energy):
            inner = gamma_number(float(d * (number - 1)), counter, VIRTUAL_NUMBER, cell)
            energy += m * dot(v, v) + 2.0 * physics.kT * inner
        key = (FIRST_BEAD + beads.number + np.int64(cell), 0)
        _, drawn = contribute(physics.rule, counter, key, m, v, scaled(0.0, zero))
        own = added(own, drawn)
    return n, mass, momentum, energy, own


@where(beads=collides)
def answer_beads(worker, now, physics, fluid, beads):
    """Replace the coefficients that `collide` found without beads."""
    cells = fluid.cells
    first, last = cells_of_thread(worker, cells.number)
    needed = physics.coefficients
    for n in range(number_of(beads.halo, len(beads.cell), PRESENT)):
        i = bead_of(beads.halo, PRESENT, n)
        cell = beads.cell[i]
        if first <= cell < last and beads.leads[i]:
            beads.head[cell] = NO_BEAD
            start = np.uint64(cell) * np.uint64(record_length(len(needed)))
            store_values(
                cells.coefficients,
                start,
                load_values(beads.answers, np.uint64(i * len(needed)), needed),
            )
