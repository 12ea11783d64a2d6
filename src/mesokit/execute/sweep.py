"""One pass over all particles: the pending collision, streaming, and the sums of the next cells.

Blocks are shared out among the threads in order; each thread adds to cell sums of its own.
"""

import numpy as np

from mesokit.box import peculiar
from mesokit.execute.cache import inner
from mesokit.execute.cell_energy import tally
from mesokit.execute.layout import LANES, share, strip_of
from mesokit.execute.rows import load, mass_of
from mesokit.execute.stages import (
    add_strip,
    bin_strip,
    bounce_strip,
    collide_and_stream_strip,
    collide_strip,
    fill_strip,
    gather_strip,
    slide_strip,
    stream_strip,
)
from mesokit.geometry.protocol import exposed, side
from mesokit.scalar import added, scalar

COLLIDE, STREAM, MEASURE_STRESS, MEASURE_WALLS = 1, 2, 4, 8


@scalar
def wall_momentum(physics, strip, count, impulse, scale, sign, like):
    """Add the momentum of virtual particles, as part of the wall behind which they lie."""
    d = len(like)
    for i in range(count):
        r, v = load(strip, i, 0, like), load(strip, i, d, like)
        surface = side(physics.solid, r)
        if surface < 2:
            m = mass_of(physics.masses, strip, i, 2 * d)
            for k in range(d):
                impulse[surface * d + k] += np.int64(np.rint(sign * m * v[k] * scale))


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
    data, cell, ident, image, count, strips, first_virtual, rows, spare_cell = particles
    coefficients, sums = cells
    gathered, hits, quanta, impulse, tensor, rates = scratch
    gathered, hits = gathered[thread], hits[thread]
    quanta, impulse = quanta[thread], impulse[thread]
    first, last = share(strips[0], thread, threads)
    first_of_virtual, last_of_virtual = share(strips[1], thread, threads)
    for turn in range(last - first + last_of_virtual - first_of_virtual):
        real = turn < last - first
        s = first + turn if real else strips[0] + first_of_virtual + turn - (last - first)
        b = s if real else first_virtual + (s - strips[0])
        strip, here = strip_of(data, b, rows), cell[b * LANES : (b + 1) * LANES]
        number = s * LANES if real else (s - strips[0]) * LANES
        lanes = min(LANES, (count[0] if real else count[1]) - number)
        who = ident[b * LANES : (b + 1) * LANES]
        boxes = image[:, b * LANES : (b + 1) * LANES]
        collides = what & COLLIDE and (real or what & MEASURE_WALLS)
        measured = what & MEASURE_STRESS
        if collides:
            gather_strip(here, coefficients, gathered, c)
        behind = np.int64(0)
        if collides and what & STREAM and real and not measured:
            behind = collide_and_stream_strip(physics, old, strip, gathered, hits, like, c)
        else:
            if collides:
                collide_strip(physics, old, strip, gathered, like, c)
                if not real:
                    wall_momentum(physics, strip, lanes, impulse, scales[0], 1.0, like)
                if measured and not what & STREAM:
                    momentum_flux(physics, box, old, strip, lanes, tensor[1, s], like)
            if what & STREAM and real:
                behind = stream_strip(physics, strip, hits, like)
        if behind:
            bounce_strip(physics, strip, lanes, hits, impulse, scales, like)
        if what & STREAM:
            if real:
                slide_strip(box, grid, strip, boxes, like)
                if measured:
                    momentum_flux(physics, box, grid, strip, lanes, tensor[0, s], like)
            else:
                fill_strip(physics, counter, grid, strip, number, rates, like)
                if what & MEASURE_WALLS:
                    wall_momentum(physics, strip, lanes, impulse, scales[0], -1.0, like)
            bin_strip(physics, counter, grid, strip, here, who, quanta, scales, like)
            if exposed(physics.solid) and not real:
                for i in range(lanes):
                    if side(physics.solid, load(strip, i, 0, like)) == 2:
                        here[i] = spare_cell
            tallied = tally(physics.energy, 0.0, like)
            add_strip(here, quanta, sums[thread], lanes, terms, tallied)
