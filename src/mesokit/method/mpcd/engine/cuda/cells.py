"""What one thread does for a cell in a step: from its sums to the coefficients of the collision."""

from mesokit.loops.layout import record_length, sums_length
from mesokit.method.mpcd.engine.cell_gradient import gradient_at
from mesokit.method.mpcd.engine.cpu.collide import needs_of_cell, sure_needs
from mesokit.method.mpcd.engine.cpu.strips.cell_energy import untangled
from mesokit.method.mpcd.engine.cpu.strips.terms import nothing_found
from mesokit.scalar.fixed_point import from_fixed
from mesokit.scalar.jit import scalar
from mesokit.scalar.pointer import clear_words, put_real, put_reals, word, words_at


@scalar
def collide_cell(cell, physics, now, fluid):
    """Coefficients of the collision at t + dt, and sums that are 0 for the next step."""
    none = nothing_found(physics.terms)
    start = cell * sums_length(len(physics.terms))
    found, gradient = words_at(fluid.sums, start, none), gradient_at(fluid.neighbour_sums, cell)
    clear_words(fluid.sums, start, none)
    needs, sure = needs_of_cell(physics, now.counter, cell, found, gradient, False)
    if not sure:
        needs = sure_needs(physics, now.counter, cell, found, gradient)
    put_reals(fluid.coefficients, cell * record_length(len(physics.coefficients)), needs)


@scalar
def fill_neighbour_sum(cell, physics, fluid):
    """The sum of which the rule needs the gradient; of all cells before any of them collides."""
    term, start = fluid.neighbour_sums.term, cell * sums_length(len(physics.terms))
    number, _ = untangled(physics.energy, word(fluid.sums, start))
    total = word(fluid.sums, start + 1 + term)
    put_real(fluid.neighbour_sums.values, cell, from_fixed(total, number, physics.scales[term]))
