"""One pass over a fluid with bodies: particles that may meet a body wait for it to move.

Without bodies this costs nothing: it is another pass (see `cpu.sweep`).
"""

import numpy as np

from mesokit.case.box import SLIDING
from mesokit.kernels.part import stage
from mesokit.loops.layout import LANES, lanes_in, share, strip_at, strips_in
from mesokit.method.mpcd.engine.bodies.near import choose_near_bodies
from mesokit.method.mpcd.engine.bodies.state import (
    COUNT,
    IMAGE,
    LANE,
    PUT_BACK,
    SECOND_HITS,
    START,
    STILL_HITTING,
    R,
    V,
    load,
)
from mesokit.method.mpcd.engine.bodies.stress import take_near_flux
from mesokit.method.mpcd.engine.cpu import stages
from mesokit.method.mpcd.engine.cpu.groups import COLLIDE, MEASURE_STRESS, STREAM
from mesokit.method.mpcd.engine.cpu.near_solids import forget, look_around_strip
from mesokit.method.mpcd.engine.cpu.strips.cell_energy import tally
from mesokit.method.mpcd.engine.cpu.strips.one import put_one
from mesokit.method.mpcd.engine.cpu.sweep import add_strip_flux
from mesokit.method.mpcd.engine.domains.messages.ghosts import note_ghosts
from mesokit.method.mpcd.engine.domains.messages.migrate import note_migrants
from mesokit.method.mpcd.engine.domains.messages.shared import shares
from mesokit.method.mpcd.engine.where import where
from mesokit.scalar.jit import scalar

KEEP, RESTORE = 0, 1
WAITING = -1  # the cell of a particle that has not flown yet


@where(box=lambda box: box.instance_class in SLIDING)
def keep_images(box, bodies, thread, near, chosen, image, what):
    """Keep the image counts of the particles near bodies, which are counted when they are put back,
    or restore them."""
    for j in range(near):
        n = bodies.counters[thread, COUNT] - near + j
        for k in range(len(image)):
            if what == KEEP:
                bodies.numbers[thread, n, IMAGE + k] = image[k, chosen[j]]
            else:
                image[k, chosen[j]] = np.int32(bodies.numbers[thread, n, IMAGE + k])


@stage
def stream_around_bodies(worker, now, physics, fluid, bodies):
    """Do the stages that the flags have (see `cpu.sweep`) for particles that no body can reach.

    Of the others velocities are those after the collision; they are on the list of this thread.
    """
    particles, scratch, zero = fluid.particles, fluid.scratch, physics.zero
    gathered, terms = scratch.coefficients[worker.thread], scratch.terms[worker.thread]
    clear, marks = scratch.clear[worker.thread], scratch.marks[worker.thread]
    chosen, impulse = bodies.chosen[worker.thread], fluid.taken.impulse[worker.thread]
    sums, here = fluid.cells.sums[worker.thread], bodies.counters[worker.thread]
    tensor, measured = fluid.taken.tensor, now.flags & MEASURE_STRESS
    if now.flags & STREAM:
        here[COUNT] = here[PUT_BACK] = here[SECOND_HITS] = here[STILL_HITTING] = 0
    first, last = share(strips_in(particles.filling), worker.thread, worker.threads)
    # As `cpu.sweep`, but particles near a body are copied to a list with r and v at t, after the
    # collision. Their lanes fly with the others, for whole vectors, and do not count: their terms
    # go to the spare cell. `put_all_back` restores them at t + dt.
    for s in range(first, last):
        lanes, places = lanes_in(particles.filling, s), slice(s * LANES, (s + 1) * LANES)
        strip, cell = particles.data[strip_at(s, particles.rows)], particles.cell[places]
        ids, image = particles.ident[places], particles.image[:, places]
        if now.flags & COLLIDE:
            stages.gather_strip(cell, fluid.cells.coefficients, gathered, physics.coefficients)
            stages.collide_strip(physics, now.old, strip, gathered)
            if measured and not now.flags & STREAM:
                add_strip_flux(physics, now.box, now.old, strip, lanes, tensor[1, s])
        if now.flags & STREAM:
            near = choose_near_bodies(worker, now, physics, bodies, strip, s, lanes, chosen)
            look_around_strip(physics.solid, strip, s, fluid.room, clear, zero)
            left = stages.stream_strip(physics, strip, clear, marks)
            if left != 0:
                for j in range(near):  # they meet walls later
                    marks[chosen[j]] = 0
                far = stages.bounce_strip(
                    physics, now.counter, strip, lanes, left, ids, marks, impulse
                )
                forget(fluid.room, s, far)
            keep_images(now.box, bodies, worker.thread, near, chosen, image, KEEP)
            stages.slide_strip(now.box, now.grid, strip, image, zero)
            keep_images(now.box, bodies, worker.thread, near, chosen, image, RESTORE)
            if measured:
                add_strip_flux(physics, now.box, now.grid, strip, lanes, tensor[0, s])
                take_near_flux(physics, now, strip, chosen, near, tensor[0, s])
            stages.bin_strip(physics, now, strip, cell, ids, terms)
            for j in range(near):
                cell[chosen[j]] = fluid.cells.number  # which takes what must not act
            tallied = tally(physics.energy, 0.0, zero)
            stages.add_strip(cell, terms, sums, lanes, physics.terms, tallied)
            for j in range(near):
                cell[chosen[j]] = WAITING
            note_ghosts(worker, s, fluid, cell, terms, lanes, physics.terms, tallied)


@scalar
def put_all_back(worker, now, physics, fluid, bodies):
    """All particles of this thread's list, at t + dt."""
    thread, values, zero = worker.thread, bodies.values[worker.thread], physics.zero
    for j in range(bodies.counters[thread, COUNT]):
        r, v = load(values, j, R, zero), load(values, j, V, zero)
        start = load(values, j, START, zero)
        put_one(worker, now, physics, fluid, bodies.numbers[thread, j, LANE], start, r, v)


@where(fluid=shares)
def note_all_migrants(worker, now, physics, fluid):
    """Note the particles that must change ranks in this step, when all have flown."""
    particles = fluid.particles
    first, last = share(strips_in(particles.filling), worker.thread, worker.threads)
    for s in range(first, last):
        strip = particles.data[strip_at(s, particles.rows)]
        note_migrants(worker, now, physics, fluid, strip, s)
