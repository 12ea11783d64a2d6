"""The sums of cells over their particles: their number, and fixed-point numbers."""

# ruff: noqa: F401  lines written out as text use what is imported here

import numpy as np

from mesokit.loops.layout import sums_length
from mesokit.method.mpcd.collision.protocol import Cell, contribute
from mesokit.method.mpcd.engine.cpu.grid import in_cell
from mesokit.method.mpcd.engine.cpu.physics import field_of
from mesokit.method.mpcd.engine.cpu.strips.cell_energy import Column, energy_term, tally, untangled
from mesokit.method.mpcd.engine.cpu.strips.rows import load_values
from mesokit.scalar.fixed_point import from_fixed, integers, rounded
from mesokit.scalar.jit import by_type, elementwise, scalar
from mesokit.scalar.pointer import word, words_at
from mesokit.scalar.vector import added, scaled


@scalar
def nothing_found(terms):
    """The sums of a cell without particles: their number, and so many terms."""
    return (np.int64(0),) + integers(terms)


@by_type
def sums_of_cell(sums, cell, terms):
    """The sums of a cell: the number of particles, and the terms.

    `sums` is an array (threads, ...) over which they are added up, or the address of those of all.
    """
    from numba import types

    return _of_all_threads if isinstance(sums, types.Array) else _of_all


def _of_all_threads(sums, cell, terms):
    found, start = nothing_found(terms), np.uint64(cell) * np.uint64(sums_length(len(terms)))
    for t in range(sums.shape[0]):
        found = added(found, load_values(sums[t], start, found))
    return found


def _of_all(sums, cell, terms):
    return words_at(sums, np.int64(cell) * sums_length(len(terms)), nothing_found(terms))


@by_type
def number_in_cell(physics, sums, cell):
    """The number of particles in a cell, from the same."""
    from numba import types

    return _number_of_all_threads if isinstance(sums, types.Array) else _number_of_all


def _number_of_all_threads(physics, sums, cell):
    number, start = np.int64(0), cell * sums_length(len(physics.terms))
    for t in range(sums.shape[0]):
        number += untangled(physics.energy, sums[t, start])[0]
    return number


def _number_of_all(physics, sums, cell):
    start = np.int64(cell) * sums_length(len(physics.terms))
    return untangled(physics.energy, word(sums, start))[0]


@scalar
def terms_of(physics, m, v, own):
    """The terms of a particle in the sums of its cell; `own` are those of the collision rule."""
    terms = scaled(m, v) + _mass_term(physics.masses, m) + energy_term(physics.energy, m, v) + own
    return rounded(terms, physics.scales)


@scalar
def brought(physics, now, number, m, r, v):
    """What a particle brings to the cell that it is in: the velocity that it keeps until it
    collides, its terms in the sums, and that in the integer that counts (see `tally`).

    Positions at t + dt, velocities before the collision at t + dt. Terms are rounded to integers
    here, one by one, so that later sums have no order.
    """
    kept, own = contribute(physics.rule, now.counter, (number, 0), m, v, in_cell(r, now.grid))
    return kept, terms_of(physics, m, v, own), tally(physics.energy, m, v)


@by_type
def _mass_term(masses, m):
    """(m,) where particles differ in mass, so that cells must add it up; () where they do not."""
    if len(masses) == 1:
        return lambda masses, m: ()
    return lambda masses, m: (m,)


@by_type
def read_sums(physics, found):
    """Sums of a cell as floats: its number, mass, momentum, sum of m v^2 (0 if not needed), and the
    rule's own sums."""
    d, uniform = len(field_of(physics, "zero")), len(field_of(physics, "masses")) == 1
    needed = field_of(physics, "energy").instance_class is Column
    at_energy = d if uniform else d + 1
    own = at_energy + 1 if needed else at_energy

    def read(physics, found):
        n, with_count = untangled(physics.energy, found[0])
        values = _floats(n, found, physics.scales)
        mass = max(float(n), 1.0) * physics.masses[0] if uniform else max(values[d], 1e-300)
        m_v_squared = values[at_energy] if needed else with_count
        return Cell(float(n), mass, values[:d], m_v_squared, values[own:])

    return read


@elementwise
def _floats(n, found, scales):
    return "from_fixed(found[{k} + 1], n, scales[{k}])"
