"""One pass over all particles: the pending collision, streaming, and the sums of the next cells.

Blocks are shared out among the threads in order; each thread adds to cell sums of its own.
"""

import numpy as np

from mesokit.box import peculiar
from mesokit.execute.layout import LANES, ROW, inner, load, mass_of, share
from mesokit.execute.stages import (
    add_block,
    bin_block,
    collide_block,
    fill_block,
    slide_block,
    stream_block,
)
from mesokit.geometry.protocol import exposed, side
from mesokit.scalar import added, scalar

COLLIDE, STREAM, MEASURE_STRESS, MEASURE_WALLS = 1, 2, 4, 8


@scalar
def wall_momentum(physics, block, count, impulse, scale, sign, like):
    """Add the momentum of virtual particles, as part of the wall behind which they lie."""
    d = len(like)
    for i in range(count):
        r, v = load(block, i, 0, like), load(block, i, d, like)
        surface = side(physics.solid, r)
        if surface < 2:
            m = mass_of(physics.masses, block, i, 2 * d)
            for k in range(d):
                impulse[surface * d + k] += np.int64(np.rint(sign * m * v[k] * scale))


@scalar
def momentum_flux(physics, box, grid, block, count, tensor, like):
    """Sums of m c c (c relative to the imposed flow) and of m v r (r relative to the cell)."""
    d = len(like)
    for i in range(count):
        r, v = load(block, i, 0, like), load(block, i, d, like)
        m = mass_of(physics.masses, block, i, 2 * d)
        c, x = peculiar(box, r, v), added(r, grid.shift)
        for j in range(d):
            for k in range(d):
                tensor[j * d + k] += m * c[j] * c[k]
                tensor[d * d + j * d + k] += m * v[j] * (x[k] - np.floor(x[k]))


@inner
def sweep(
    thread, threads, what, physics, box, counter, old, grid, particles, cells, scratch, like, c,
    terms, scales,
):  # fmt: skip
    """Do what the flags ask, in this order, for each block in turn.

    Time levels: velocities of step n before COLLIDE, after it; positions and velocities of
    step n + 1 after STREAM, with their cells and cell sums.
    """
    data, cell, ident, image, count, real_blocks, blocks, rows, spare_cell = particles
    coefficients, stride, sums = cells
    gathered, saved, hits, quanta, impulse, tensor = scratch
    gathered, saved, hits = gathered[thread], saved[thread], hits[thread]
    quanta, impulse = quanta[thread], impulse[thread]
    first, last = share(blocks, thread, threads)
    for b in range(first, last):
        block = data[b * rows * ROW : (b + 1) * rows * ROW]
        here = cell[b * LANES : (b + 1) * LANES]
        real = b < real_blocks
        number = b * LANES if real else (b - real_blocks) * LANES
        lanes = min(LANES, (count[0] if real else count[1]) - number)
        if what & COLLIDE and (real or what & MEASURE_WALLS):
            collide_block(physics, old, block, here, coefficients, stride, gathered, like, c)
            if not real:
                wall_momentum(physics, block, lanes, impulse, scales[0], 1.0, like)
            if what & MEASURE_STRESS and not what & STREAM:
                momentum_flux(physics, box, old, block, lanes, tensor[1, b], like)
        if what & STREAM:
            if real:
                stream_block(physics, block, lanes, hits, saved, impulse, scales, like)
                slide_block(box, grid, block, image[:, b * LANES : (b + 1) * LANES], like)
                if what & MEASURE_STRESS:
                    momentum_flux(physics, box, grid, block, lanes, tensor[0, b], like)
            else:
                fill_block(physics, counter, grid, block, number, like)
                if what & MEASURE_WALLS:
                    wall_momentum(physics, block, lanes, impulse, scales[0], -1.0, like)
            who = ident[b * LANES : (b + 1) * LANES]
            bin_block(physics, counter, grid, block, here, who, quanta, scales, like)
            if exposed(physics.solid) and not real:
                for i in range(lanes):
                    if side(physics.solid, load(block, i, 0, like)) == 2:
                        here[i] = spare_cell
            add_block(here, quanta, sums[thread], lanes, terms)
