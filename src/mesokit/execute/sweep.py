"""One pass over all particles: the pending collision, streaming, and the sums of the next cells.

Blocks are shared out among the threads in order; each thread adds to cell sums of its own.
"""

import numpy as np

from mesokit.box import at_time, peculiar
from mesokit.execute.beads import WIDTH, bead_of, put_bead, take_bead
from mesokit.execute.cache import inner
from mesokit.execute.cell_energy import tally
from mesokit.execute.flags import COLLIDE, MEASURE_STRESS, STREAM
from mesokit.execute.layers import fill_layers
from mesokit.execute.layout import LANES, SCRATCH_ROW, groups_in, lanes_in, share, strip_at
from mesokit.execute.look_around import forget, look_around_strip
from mesokit.execute.rows import load, mass_of
from mesokit.execute.stages import (
    add_strip,
    bin_strip,
    bounce_strip,
    collide_and_stream_strip,
    collide_strip,
    gather_strip,
    slide_strip,
    stream_strip,
)
from mesokit.execute.verlet import Flock, fly_molecules
from mesokit.scalar import added, by_type_with_views, scalar


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
    sweep_fluid(
        thread, threads, what, physics, box, counter, old, grid, particles, cells, scratch, like,
        c, terms, scales,
    )  # fmt: skip
    fill_layers(
        thread, threads, what, physics, counter, old, grid, particles, cells, scratch[7],
        scratch[0][thread], scratch[4][thread], scratch[5][thread], like, c, terms, scales,
    )  # fmt: skip


@by_type_with_views
def sweep_fluid(
    thread, threads, what, physics, box, counter, old, grid, particles, cells, scratch, like, c,
    terms, scales,
):  # fmt: skip
    """The fluid's own particles: strip by strip, or a group of strips of molecules at a time."""
    molecule = physics.types[physics.fields.index("molecule")]
    chosen = _sweep_singles if len(molecule) == 0 else _sweep_molecules

    def pass_over(
        thread, threads, what, physics, box, counter, old, grid, particles, cells, scratch, like,
        c, terms, scales,
    ):  # fmt: skip
        chosen(
            thread, threads, what, physics, box, counter, old, grid, particles, cells, scratch,
            like, c, terms, scales,
        )  # fmt: skip

    return pass_over


@inner
def _sweep_singles(
    thread, threads, what, physics, box, counter, old, grid, particles, cells, scratch, like, c,
    terms, scales,
):  # fmt: skip
    data, cell, ident, image, count, strips, _, rows, _ = particles
    coefficients, sums = cells
    gathered, clear, calm, hits, quanta, impulse, tensor = scratch[:7]
    gathered, clear, hits = gathered[thread], clear[thread], hits[thread]
    quanta, impulse = quanta[thread], impulse[thread]
    measured = what & MEASURE_STRESS
    first, last = share(strips[0], thread, threads)
    for s in range(first, last):
        strip, here = data[strip_at(s, rows)], cell[s * LANES : (s + 1) * LANES]
        lanes = lanes_in(count[0], s)
        who = ident[s * LANES : (s + 1) * LANES]
        boxes = image[:, s * LANES : (s + 1) * LANES]
        quiet, behind = 0, np.int64(0)
        if what & STREAM:
            quiet = look_around_strip(physics.solid, strip, s, calm, clear, like)
        if what & COLLIDE:
            gather_strip(here, coefficients, gathered, c)
        if what & COLLIDE and what & STREAM and not measured:
            behind = collide_and_stream_strip(
                physics, old, strip, gathered, quiet, clear, hits, like, c
            )
        else:
            if what & COLLIDE:
                collide_strip(physics, old, strip, gathered, like, c)
                if measured and not what & STREAM:
                    momentum_flux(physics, box, old, strip, lanes, tensor[1, s], like)
            if what & STREAM:
                behind = stream_strip(physics, strip, clear, hits, like)
        if behind != 0:
            far = bounce_strip(
                physics, counter, strip, lanes, behind, who, hits, impulse, scales, like
            )
            forget(calm, s, far)
        if what & STREAM:
            slide_strip(box, grid, strip, boxes, like)
            if measured:
                momentum_flux(physics, box, grid, strip, lanes, tensor[0, s], like)
            bin_strip(physics, counter, grid, strip, here, who, quanta, scales, like)
            add_strip(here, quanta, sums[thread], lanes, terms, tally(physics.energy, 0.0, like))


@inner
def _sweep_molecules(
    thread, threads, what, physics, box, counter, old, grid, particles, cells, scratch, like, c,
    terms, scales,
):  # fmt: skip
    data, cell, ident, image, count, _, _, rows, _ = particles
    coefficients, sums = cells
    gathered, clear, calm, hits, quanta, impulse, tensor, _, work, faults = scratch
    gathered, clear, hits, work = gathered[thread], clear[thread], hits[thread], work[thread]
    quanta, impulse, faults = quanta[thread], impulse[thread], faults[thread]
    beads, measured = physics.molecule.beads, what & MEASURE_STRESS
    before = at_time(box, (counter.step - 1) * physics.timestep)  # in which images were counted
    first, last = share(groups_in(count[0]), thread, threads)
    for g in range(first, last):
        lanes = lanes_in(count[0], g * beads)
        for k in range(beads):  # velocities of step n, after the collision
            s = g * beads + k
            strip, here = data[strip_at(s, rows)], cell[s * LANES : (s + 1) * LANES]
            if what & STREAM:
                near = clear[k * SCRATCH_ROW : (k + 1) * SCRATCH_ROW]
                look_around_strip(physics.solid, strip, s, calm, near, like)
            if what & COLLIDE:
                gather_strip(here, coefficients, gathered, c)
                collide_strip(physics, old, strip, gathered, like, c)
                if measured and not what & STREAM:
                    momentum_flux(physics, box, old, strip, lanes, tensor[1, s], like)
        if not what & STREAM:
            continue
        for start in range(0, lanes, WIDTH):  # positions and velocities of step n + 1
            flock = Flock(g * beads, start, min(WIDTH, lanes - start))
            leader = image[:, g * beads * LANES + start : (g * beads + 1) * LANES]
            for k in range(beads - 1, -1, -1):  # the leader's counts of boxes stay to the end
                s = g * beads + k
                boxes = image[:, s * LANES + start : (s + 1) * LANES]
                strip = data[strip_at(s, rows)][start:]
                take_bead(before, strip, boxes, leader, bead_of(work, k, like), like)
            fly_molecules(
                physics, flock, counter, work, ident, clear, calm, hits, impulse, faults, measured,
                tensor[2, g], scales, like,
            )  # fmt: skip
            for k in range(beads):
                strip = data[strip_at(g * beads + k, rows)][start:]
                put_bead(strip, bead_of(work, k, like), like)
        for k in range(beads):  # cells and their sums of step n + 1
            s = g * beads + k
            strip, here = data[strip_at(s, rows)], cell[s * LANES : (s + 1) * LANES]
            who = ident[s * LANES : (s + 1) * LANES]
            slide_strip(box, grid, strip, image[:, s * LANES : (s + 1) * LANES], like)
            if measured:
                momentum_flux(physics, box, grid, strip, lanes, tensor[0, s], like)
            bin_strip(physics, counter, grid, strip, here, who, quanta, scales, like)
            add_strip(here, quanta, sums[thread], lanes, terms, tally(physics.energy, 0.0, like))
