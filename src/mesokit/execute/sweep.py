"""One pass over all particles: the pending collision, streaming, and the sums of the next cells.

Blocks are shared out among the threads in order; each thread adds to cell sums of its own.
"""

import numpy as np

from mesokit.box import peculiar
from mesokit.execute.cache import inner
from mesokit.execute.cell_energy import tally
from mesokit.execute.flags import COLLIDE, MEASURE_STRESS, STREAM
from mesokit.execute.layers import fill_layers
from mesokit.execute.layout import LANES, share, strip_of
from mesokit.execute.rows import load, mass_of
from mesokit.execute.stages import (
    add_strip,
    bin_strip,
    bounce_strip,
    collide_and_stream_strip,
    collide_strip,
    gather_strip,
    look_around_strip,
    slide_strip,
    stream_strip,
)
from mesokit.scalar import added, scalar


@scalar
def momentum_flux(physics, box, grid, strip, count, tensor, like):
    """Sums of m c c (c relative to the imposed flow) and of m v r (r relative to the cell)."""
    d = len(like)
    for i in range(count):
        r, v = load(strip, i, 0, like), load(strip, i, d, like)
        m = mass_of(physics.masses, strip, i, 2 * d)
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
    """Do what the flags ask, in this order, for each strip in turn.

    Time levels: velocities of step n before COLLIDE, after it; positions and velocities of
    step n + 1 after STREAM, with their cells and cell sums.
    """
    data, cell, ident, image, count, strips, _, rows, _ = particles
    coefficients, sums = cells
    gathered, clear, calm, hits, quanta, impulse, tensor, rates = scratch
    gathered, clear, hits = gathered[thread], clear[thread], hits[thread]
    quanta, impulse = quanta[thread], impulse[thread]
    measured = what & MEASURE_STRESS
    first, last = share(strips[0], thread, threads)
    for s in range(first, last):
        strip, here = strip_of(data, s, rows), cell[s * LANES : (s + 1) * LANES]
        lanes = min(LANES, count[0] - s * LANES)
        who = ident[s * LANES : (s + 1) * LANES]
        boxes = image[:, s * LANES : (s + 1) * LANES]
        if what & STREAM:
            look_around_strip(physics.solid, old, what & COLLIDE, strip, s, here, calm, clear, like)
        if what & COLLIDE:
            gather_strip(here, coefficients, gathered, c)
        behind = np.int64(0)
        if what & COLLIDE and what & STREAM and not measured:
            behind = collide_and_stream_strip(physics, old, strip, gathered, clear, hits, like, c)
        else:
            if what & COLLIDE:
                collide_strip(physics, old, strip, gathered, like, c)
                if measured and not what & STREAM:
                    momentum_flux(physics, box, old, strip, lanes, tensor[1, s], like)
            if what & STREAM:
                behind = stream_strip(physics, strip, clear, hits, like)
        if behind:
            calm[s] = 0.0
            bounce_strip(physics, counter, strip, lanes, who, hits, impulse, scales, like)
        if what & STREAM:
            slide_strip(box, grid, strip, boxes, like)
            if measured:
                momentum_flux(physics, box, grid, strip, lanes, tensor[0, s], like)
            bin_strip(physics, counter, grid, strip, here, who, quanta, scales, like)
            add_strip(here, quanta, sums[thread], lanes, terms, tally(physics.energy, 0.0, like))
    fill_layers(
        thread, threads, what, physics, counter, old, grid, particles, cells, rates, gathered,
        quanta, impulse, like, c, terms, scales,
    )  # fmt: skip
