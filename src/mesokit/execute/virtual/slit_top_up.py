"""Virtual particles by the simpler rule: top up each cell that a plate cuts to the mean density."""

import numpy as np

from mesokit.execute.cpu.grid import in_cell
from mesokit.execute.cpu.strips.cell_energy import tally
from mesokit.execute.cpu.strips.layout import sums_length
from mesokit.execute.cpu.strips.rows import add_values
from mesokit.execute.cpu.strips.terms import number_in_cell, terms_of
from mesokit.execute.cpu.threads import meet
from mesokit.execute.virtual.gas import thermal
from mesokit.geometry.protocol import across, closes, side
from mesokit.method.mpcd.collision.protocol import contribute
from mesokit.scalar.cache import inner
from mesokit.scalar.intrinsics import floor, with_item
from mesokit.scalar.jit import optional
from mesokit.scalar.random import CELL_VIRTUAL, unit_open, words
from mesokit.scalar.vector import added, first


def top_up_slit(team, now, physics, fluid, walls):
    """Add virtual particles to the sums of cut cells that hold fewer than the mean density.

    A fractional density is met on average. Places are uniform in the solid part of the cell.
    """
    if team.thread == 0:
        _add_missing(now, physics, fluid, walls.top_up)
    meet(team)


@inner
def _add_missing(now, physics, fluid, top_up):
    counter, grid, zero = now.counter, now.grid, physics.zero
    number, sums, (density,) = fluid.cells.number, fluid.cells.sums, top_up
    width = sums_length(len(physics.terms))
    axis = across(physics.solid)
    layers, s = grid.cells[axis], grid.shift[axis]
    below = s - floor(s)
    (m,) = physics.masses
    for cell in range(number):
        index, rest = zero, cell
        for k in range(len(zero)):
            size = int(grid.cells[k])
            index = with_item(index, k, float(rest % size))
            rest //= size
        layer = index[axis]
        lower = layer < 0.5
        if (not lower and layer < layers - 1.5) or below == 0.0:
            continue
        present = number_in_cell(physics, sums, cell)
        a, _, _, _ = words(counter, CELL_VIRTUAL, cell, 0)
        missing = int(density + unit_open(a)) - present
        for j in range(missing):
            a, b, c, _ = words(counter, CELL_VIRTUAL, cell, 1 + 2 * j)
            u = first((unit_open(a), unit_open(b), unit_open(c)), zero)
            depth = u[axis]
            place = u
            for k in range(len(zero)):
                along = (index[k] - grid.shift[k] + u[k]) / physics.solid.size[k]
                inside = below * depth if lower else below + (1.0 - below) * depth
                place = with_item(place, k, inside if k == axis else along)
            r, drift = closes(physics.solid, place, grid.shift, zero, zero)
            if side(physics.solid, r) == 2:
                break
            v = added(drift, thermal(physics, m, counter, CELL_VIRTUAL, cell, 2 + 2 * j))
            # draw 0 of any index belongs to the particle of that number
            _, own = contribute(physics.rule, counter, (cell, 1 + j), m, v, in_cell(r, grid))
            start = np.uint64(cell * width)
            sums[0, start] += optional(tally(physics.energy, m, v), 1)
            add_values(sums[0], start + np.uint64(1), terms_of(physics, m, v, own))
