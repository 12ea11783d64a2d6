"""One pass over a fluid with embedded solutes: those near a bead wait for the sub-steps.

Where solutes collide with the fluid, this costs nothing: it is another pass (see `cpu.sweep`).
"""

import numpy as np

from mesokit.kernels.part import stage
from mesokit.loops.layout import LANES, lanes_in, share, strip_at, strips_in
from mesokit.method.mpcd.engine.cpu import stages
from mesokit.method.mpcd.engine.cpu.groups import COLLIDE, STREAM
from mesokit.method.mpcd.engine.cpu.near_solids import forget, look_around_strip
from mesokit.method.mpcd.engine.cpu.strips.ahead import strip_after
from mesokit.method.mpcd.engine.cpu.strips.cell_energy import tally
from mesokit.method.mpcd.engine.cpu.strips.one import put_one
from mesokit.method.mpcd.engine.cpu.strips.rows import load_values
from mesokit.method.mpcd.engine.embedded.near import choose_near, find_beads
from mesokit.method.mpcd.engine.embedded.state import COUNT


@stage
def stream_around(worker, now, physics, fluid, beads):
    """Do the stages that the flags have (see `cpu.sweep`) for particles that no bead can reach.

    Of the others velocities are those after the collision; they are on the list of this thread.
    """
    particles, scratch, zero = fluid.particles, fluid.scratch, physics.zero
    gathered, terms = scratch.coefficients[worker.thread], scratch.terms[worker.thread]
    clear, marks = scratch.clear[worker.thread], scratch.marks[worker.thread]
    (embedded,) = beads.embedded
    chosen, impulse = embedded.chosen[worker.thread], fluid.taken.impulse[worker.thread]
    sums = fluid.cells.sums[worker.thread]
    if now.flags & STREAM:
        find_beads(worker, now.counter.step, now.box, beads, zero)
        embedded.number[worker.thread, COUNT] = 0
    first, last = share(strips_in(particles.filling), worker.thread, worker.threads)
    # As `cpu.sweep`, but particles near a bead are copied to a list with r and v at t, after the
    # collision. Their lanes fly with the others, for whole vectors, and do not count: their terms
    # go to the spare cell. `put_back` restores them at t + dt.
    for s in range(first, last):
        lanes, places = lanes_in(particles.filling, s), slice(s * LANES, (s + 1) * LANES)
        strip, cell = particles.data[strip_at(s, particles.rows)], particles.cell[places]
        ids = particles.ident[places]
        following = strip_after(fluid, physics, s, last)
        if now.flags & COLLIDE:
            coefficients = fluid.cells.coefficients
            stages.gather_strip(cell, coefficients, gathered, physics.coefficients, following)
            stages.collide_strip(physics, now.old, strip, gathered)
        if now.flags & STREAM:
            near = choose_near(worker, now, physics, beads, strip, s, lanes, chosen)
            look_around_strip(physics.solid, strip, s, fluid.room, clear, zero)
            left = stages.stream_strip(physics, strip, clear, marks)
            if left != 0:
                for j in range(near):  # they meet walls in sub-steps
                    marks[chosen[j]] = 0
                far = stages.bounce_strip(
                    physics, now.counter, strip, lanes, left, ids, marks, impulse
                )
                forget(fluid.room, s, far)
            stages.bin_strip(physics, now, strip, cell, ids, terms)
            for j in range(near):
                cell[chosen[j]] = fluid.cells.number  # which takes what must not act
            tallied = tally(physics.energy, 0.0, zero)
            stages.add_strip(cell, terms, sums, lanes, physics.terms, tallied, following)


@stage
def put_back(worker, now, physics, fluid, beads):
    """Bring the particles that were near beads back to their strips, and into their cells."""
    if now.flags & STREAM:
        (embedded,) = beads.embedded
        thread, zero = worker.thread, physics.zero
        for n in range(embedded.number[thread, COUNT]):
            at = np.uint64(n * len(zero))
            r, v = (
                load_values(embedded.r[thread], at, zero),
                load_values(embedded.v[thread], at, zero),
            )
            start = load_values(embedded.start[thread], at, zero)
            put_one(worker, now, physics, fluid, embedded.lane[thread, n], start, r, v)
