"""Virtual particles by the simpler rule: top up each cell that a plate cuts to the mean density."""

import math

import numpy as np
from numba.cpython.unsafe.tuple import tuple_setitem

from mesokit.execute.cell_energy import tally, untangled
from mesokit.execute.layout import sums_length
from mesokit.execute.rows import add_to
from mesokit.execute.stages import in_cell
from mesokit.execute.sums import terms_of
from mesokit.geometry.protocol import across, closes, side
from mesokit.mpcd.collision.protocol import contribute
from mesokit.random import CELL_VIRTUAL, normals, unit_open, words
from mesokit.scalar import added, by_type, first, optional, scaled


@by_type
def top_up(density, guests, thread, physics, counter, grid, cells, number, like, scales):
    """Do so if `density` is (density,) and there are no guests, who see to it themselves."""
    return _add_missing if len(density) == 1 and len(guests) == 0 else lambda *_: None


def _add_missing(density, guests, thread, physics, counter, grid, cells, number, like, scales):
    """Add virtual particles to the sums of cut cells that hold fewer than the mean density.

    A fractional density is met on average. Places are uniform in the solid part of the cell.
    """
    if thread != 0:
        return
    sums = cells[1]
    width = sums_length(len(scales))
    axis = across(physics.solid)
    layers, s = grid.cells[axis], grid.shift[axis]
    below = s - np.floor(s)
    m = physics.masses[0]
    for cell in range(number):
        index, rest = like, cell
        for k in range(len(like)):
            size = int(grid.cells[k])
            index = tuple_setitem(index, k, float(rest % size))
            rest //= size
        layer = index[axis]
        lower = layer < 0.5
        if (not lower and layer < layers - 1.5) or below == 0.0:
            continue
        present = 0
        for t in range(sums.shape[0]):
            present += untangled(physics.energy, sums[t, cell * width])[0]
        a, _, _, _ = words(counter, CELL_VIRTUAL, cell, 0)
        missing = int(density[0] + unit_open(a)) - present
        for j in range(missing):
            a, b, c, _ = words(counter, CELL_VIRTUAL, cell, 1 + 2 * j)
            u = first((unit_open(a), unit_open(b), unit_open(c)), like)
            depth = u[axis]
            place = u
            for k in range(len(like)):
                along = (index[k] - grid.shift[k] + u[k]) / physics.solid.size[k]
                inside = below * depth if lower else below + (1.0 - below) * depth
                place = tuple_setitem(place, k, inside if k == axis else along)
            zero = scaled(0.0, like)
            r, drift = closes(physics.solid, place, grid.shift, zero, zero)
            if side(physics.solid, r) == 2:
                break
            a, b, c, d = words(counter, CELL_VIRTUAL, cell, 2 + 2 * j)
            v = added(drift, scaled(math.sqrt(physics.kT / m), normals(like, a, b, c, d)))
            # draw 0 of any index belongs to the particle of that number
            _, own = contribute(physics.rule, counter, (cell, 1 + j), m, v, in_cell(r, grid))
            start = np.uint64(cell * width)
            sums[0, start] += optional(tally(physics.energy, m, v), 1)
            add_to(sums[0], start + np.uint64(1), terms_of(physics, m, v, own, scales))
