"""How fast the fluid's velocity rises with the distance from a plate.

Virtual particles at rest with the plate drag the fluid as if the plate lay deeper: in the part of a
cell that is solid the fluid's linear profile would go on, to velocities beyond the plate's. With
the rate of the profile known they can move like that; the plate is then where it should be.
"""

import numpy as np
from numba.cpython.unsafe.tuple import tuple_setitem

from mesokit.execute.layout import sums_length
from mesokit.execute.near_flow import follow_pieces
from mesokit.execute.rows import fetch
from mesokit.execute.sums import nothing_found, read_sums
from mesokit.geometry.protocol import across
from mesokit.scalar import added, by_type

MEMORY = 1.0 / 32.0  # weight of one step; the mean must not follow the noise of single steps


@by_type
def follow(
    wanted, guests, thread, threads, physics, counter, grid, sums, rates, like, terms, scales
):
    """Update the rates (2, d) of the lower and upper plate, or those of guests; if wanted."""
    if len(wanted) == 0:
        return lambda *_: None
    return _update if len(guests) == 0 else _update_pieces


def _update_pieces(
    wanted, guests, thread, threads, physics, counter, grid, sums, rates, like, terms, scales
):
    follow_pieces(guests, thread, threads, physics, counter, grid, sums, like, terms, scales)


def _update(
    wanted, guests, thread, threads, physics, counter, grid, sums, rates, like, terms, scales
):
    """From the cells next to the cut ones, which hold no virtual particles, at this step."""
    if thread != 0:
        return
    solid = physics.solid
    axis = across(solid)
    layers, s = int(grid.cells[axis]), grid.shift[axis]
    below = s - np.floor(s)
    stride, beside = 1, 1
    for k in range(len(like)):  # cells are numbered with x fastest
        if k == axis:
            beside = stride
        stride *= int(grid.cells[k])
    columns = stride // layers
    for surface in range(2):
        # Heights of the layer's middle: cells end at k - shift.
        layer = 1 if surface == 0 else layers - 2
        height = 1.5 - below if surface == 0 else 0.5 + below
        mass, momentum = 0.0, like
        for column in range(columns):
            cell = column // beside * beside * layers + layer * beside + column % beside
            found = nothing_found(terms)
            for t in range(sums.shape[0]):
                start = np.uint64(cell * sums_length(len(terms)))
                found = added(found, fetch(sums[t], start, found))
            n, m, p, _, _ = read_sums(physics.masses, physics.energy, found, like, scales)
            mass += m if n > 0.0 else 0.0
            for k in range(len(like)):
                momentum = tuple_setitem(momentum, k, momentum[k] + p[k])
        for k in range(len(like)):
            u = solid.lower_velocity[k] if surface == 0 else solid.upper_velocity[k]
            rate = (momentum[k] / max(mass, 1e-300) - u) / height if mass > 0.0 else 0.0
            rate = 0.0 if k == axis else rate
            rates[surface, k] += MEMORY * (rate - rates[surface, k])
