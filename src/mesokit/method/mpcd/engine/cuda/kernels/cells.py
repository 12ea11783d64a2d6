"""What one thread does for a cell in a step: from its sums to the coefficients of the collision."""

from mesokit.loops.layout import record_length, sums_length
from mesokit.method.mpcd.engine.cell_gradient import gradient_at
from mesokit.method.mpcd.engine.cpu.collide import needs_of_cell, sure_needs
from mesokit.method.mpcd.engine.cpu.strips.cell_energy import untangled
from mesokit.method.mpcd.engine.cpu.strips.terms import nothing_found
from mesokit.scalar.fixed_point import from_fixed
from mesokit.scalar.jit import scalar
from mesokit.scalar.pointer import (
    clear_words,
    put_real,
    put_reals,
    put_whole,
    take_number,
    whole,
    word,
    words_at,
)


@scalar
def collide_cell(cell, physics, now, fluid):
    """Coefficients of the collision at t + dt, and sums that are 0 for the next step.

    A cell whose thermostat must draw with care is only put on a list: that code needs many
    registers, which all cells would have to leave to it.
    """
    found, gradient = sums_and_gradient(cell, physics, fluid)
    needs, sure = needs_of_cell(physics, now.counter, cell, found, gradient, False)
    if sure:
        settle(cell, physics, fluid, needs)
    else:
        put_whole(fluid.doubtful, take_number(fluid.doubts, 0, 1), cell)


@scalar
def collide_doubtful(i, physics, now, fluid, threads):
    """The same for every cell on the list, of which this thread takes every `threads`th."""
    for j in range(i, whole(fluid.doubts, 0), threads):
        cell = whole(fluid.doubtful, j)
        found, gradient = sums_and_gradient(cell, physics, fluid)
        needs = sure_needs(physics, now.counter, cell, found, gradient)
        settle(cell, physics, fluid, needs)


@scalar
def sums_and_gradient(cell, physics, fluid):
    """The sums of a cell, and the gradient of one of them over its neighbours, if needed."""
    start, none = cell * sums_length(len(physics.terms)), nothing_found(physics.terms)
    return words_at(fluid.sums, start, none), gradient_at(fluid.neighbour_sums, cell)


@scalar
def settle(cell, physics, fluid, needs):
    """Store the coefficients of a cell, and clear its sums."""
    start, none = cell * sums_length(len(physics.terms)), nothing_found(physics.terms)
    clear_words(fluid.sums, start, none)
    put_reals(fluid.coefficients, cell * record_length(len(physics.coefficients)), needs)


@scalar
def fill_neighbour_sum(cell, physics, fluid):
    """The sum of which the rule needs the gradient; of all cells before any of them collides."""
    term, start = fluid.neighbour_sums.term, cell * sums_length(len(physics.terms))
    number, _ = untangled(physics.energy, word(fluid.sums, start))
    total = word(fluid.sums, start + 1 + term)
    put_real(fluid.neighbour_sums.values, cell, from_fixed(total, number, physics.scales[term]))
