"""One pass over all particles: the pending collision, streaming, and the sums of the next cells.

The collision of a step is done while its particles are in the cache for the flight of the next.
Blocks are shared out among the threads in order; each thread adds to cell sums of its own.
"""

import numpy as np

from mesokit.case.box import at_time
from mesokit.kernels.part import stage
from mesokit.loops.layout import LANES, SCRATCH_ROW, groups_in, lanes_in, share, strip_at, strips_in
from mesokit.method.mpcd.engine.beads.molecules import Batch, fly_molecules
from mesokit.method.mpcd.engine.beads.registers import WIDTH, bead_at, bead_to_strip, strip_to_bead
from mesokit.method.mpcd.engine.cpu import stages
from mesokit.method.mpcd.engine.cpu.groups import COLLIDE, MEASURE_STRESS, STREAM
from mesokit.method.mpcd.engine.cpu.near_solids import forget, look_around_strip
from mesokit.method.mpcd.engine.cpu.physics import field_of, of_particles
from mesokit.method.mpcd.engine.cpu.stress import carried
from mesokit.method.mpcd.engine.cpu.strips.ahead import strip_after
from mesokit.method.mpcd.engine.cpu.strips.cell_energy import tally
from mesokit.method.mpcd.engine.cpu.strips.rows import lane_mass, load_particle
from mesokit.method.mpcd.engine.domains.messages.ghosts import note_ghosts
from mesokit.method.mpcd.engine.domains.messages.migrate import note_migrants
from mesokit.scalar.fixed_point import add_fixed, added_fixed, integers
from mesokit.scalar.jit import by_type, seldom
from mesokit.scalar.vector import products


@by_type
def stream_fluid(worker, now, physics, fluid):
    """Do the stages that the flags have, in this order, for each strip in turn.

    Time levels: velocities of step n before COLLIDE, after it; positions and velocities of
    step n + 1 after STREAM, with their cells and cell sums.
    """
    if len(field_of(physics, "molecule")) == 0:
        return lambda worker, now, physics, fluid: _stream_singles(
            worker, now, of_particles(physics), fluid
        )
    return lambda worker, now, physics, fluid: _stream_molecules(
        worker, now, of_particles(physics), fluid
    )


@stage  # two places call it
def _stream_singles(worker, now, physics, fluid):
    particles, scratch, zero = fluid.particles, fluid.scratch, physics.zero
    gathered, terms = scratch.coefficients[worker.thread], scratch.terms[worker.thread]
    clear, hits = scratch.clear[worker.thread], scratch.marks[worker.thread]
    impulse, tensor = fluid.taken.impulse[worker.thread], fluid.taken.tensor
    sums, measured = fluid.cells.sums[worker.thread], now.flags & MEASURE_STRESS
    first, last = share(strips_in(particles.filling), worker.thread, worker.threads)
    # Strip by strip, each in the cache for all stages. The pending collision (v at t) comes first,
    # then the flight (r, v: t -> t + dt) and the terms for the new cells. A thread writes its own
    # particles and its own sums, so there is no race. Sums are integers: their bits do not depend
    # on the shares.
    for s in range(first, last):
        lanes, places = lanes_in(particles.filling, s), slice(s * LANES, (s + 1) * LANES)
        strip, cell = particles.data[strip_at(s, particles.rows)], particles.cell[places]
        ids, image = particles.ident[places], particles.image[:, places]
        following = strip_after(fluid, physics, s, last)
        quiet, left = 0, np.int64(0)
        if now.flags & STREAM:
            quiet = look_around_strip(physics.solid, strip, s, fluid.room, clear, zero)
        if now.flags & COLLIDE:
            coefficients = fluid.cells.coefficients
            stages.gather_strip(cell, coefficients, gathered, physics.coefficients, following)
        if now.flags & COLLIDE and now.flags & STREAM and not measured:
            left = stages.collide_and_stream_strip(
                physics, now.old, strip, gathered, quiet, clear, hits
            )
        else:
            if now.flags & COLLIDE:
                stages.collide_strip(physics, now.old, strip, gathered)
                if measured and not now.flags & STREAM:
                    add_strip_flux(physics, now.box, now.old, strip, lanes, tensor[1, s])
            if now.flags & STREAM:
                left = stages.stream_strip(physics, strip, clear, hits)
        if left != 0:
            far = stages.bounce_strip(physics, now.counter, strip, lanes, left, ids, hits, impulse)
            forget(fluid.room, s, far)
        if now.flags & STREAM:
            stages.slide_strip(now.box, now.grid, strip, image, zero)
            if measured:
                add_strip_flux(physics, now.box, now.grid, strip, lanes, tensor[0, s])
            stages.bin_strip(physics, now, strip, cell, ids, terms)
            tallied = tally(physics.energy, 0.0, zero)
            stages.add_strip(cell, terms, sums, lanes, physics.terms, tallied, following)
            note_ghosts(worker, s, fluid, cell, terms, lanes, physics.terms, tallied)
            note_migrants(worker, now, physics, fluid, strip, s)


@stage
def _stream_molecules(worker, now, physics, fluid):
    particles, scratch, zero = fluid.particles, fluid.scratch, physics.zero
    gathered, terms = scratch.coefficients[worker.thread], scratch.terms[worker.thread]
    clear, work = scratch.clear[worker.thread], scratch.beads[worker.thread]
    tensor, sums = fluid.taken.tensor, fluid.cells.sums[worker.thread]
    beads, measured = physics.molecule.beads, now.flags & MEASURE_STRESS
    # The box in which images were counted.
    before = at_time(now.box, (now.counter.step - 1) * physics.timestep)
    first, last = share(groups_in(particles.filling), worker.thread, worker.threads)
    # A group is one strip for each bead of 128 molecules. Strips collide on their own. For the
    # flight with its sub-steps, WIDTH molecules at a time are copied to rows that stay in the
    # first-level cache. Then strips find their cells, as for single particles.
    for g in range(first, last):
        lanes = lanes_in(particles.filling, g * beads)
        for k in range(beads):  # velocities of step n, after the collision
            s = g * beads + k
            places = slice(s * LANES, (s + 1) * LANES)
            strip, cell = particles.data[strip_at(s, particles.rows)], particles.cell[places]
            if now.flags & STREAM:
                near = clear[k * SCRATCH_ROW : (k + 1) * SCRATCH_ROW]
                look_around_strip(physics.solid, strip, s, fluid.room, near, zero)
            if now.flags & COLLIDE:
                coefficients = fluid.cells.coefficients
                stages.gather_strip(cell, coefficients, gathered, physics.coefficients, ())
                stages.collide_strip(physics, now.old, strip, gathered)
                if measured and not now.flags & STREAM:
                    add_strip_flux(physics, now.box, now.old, strip, lanes, tensor[1, s])
        if not now.flags & STREAM:
            continue
        for start in range(0, lanes, WIDTH):  # positions and velocities of step n + 1
            batch = Batch(g, g * beads, start, min(WIDTH, lanes - start))
            leader = particles.image[:, g * beads * LANES + start : (g * beads + 1) * LANES]
            # Under shear each bead returns to the image of the first bead, by the image counts of
            # both. The first bead comes last, because the others still need its counts.
            for k in range(beads - 1, -1, -1):
                s = g * beads + k
                image = particles.image[:, s * LANES + start : (s + 1) * LANES]
                strip = particles.data[strip_at(s, particles.rows)][start:]
                strip_to_bead(before, strip, image, leader, work[bead_at(k, zero)], zero)
            fly_molecules(worker, now, physics, fluid, batch)
            for k in range(beads):
                strip = particles.data[strip_at(g * beads + k, particles.rows)][start:]
                bead_to_strip(strip, work[bead_at(k, zero)], zero)
        for k in range(beads):  # cells and their sums of step n + 1
            s = g * beads + k
            places = slice(s * LANES, (s + 1) * LANES)
            strip, cell = particles.data[strip_at(s, particles.rows)], particles.cell[places]
            stages.slide_strip(now.box, now.grid, strip, particles.image[:, places], zero)
            if measured:
                add_strip_flux(physics, now.box, now.grid, strip, lanes, tensor[0, s])
            stages.bin_strip(physics, now, strip, cell, particles.ident[places], terms)
            tallied = tally(physics.energy, 0.0, zero)
            stages.add_strip(cell, terms, sums, lanes, physics.terms, tallied, ())
            note_ghosts(worker, s, fluid, cell, terms, lanes, physics.terms, tallied)
            if k == 0:
                note_migrants(worker, now, physics, fluid, strip, s)


@seldom
def add_strip_flux(physics, box, grid, strip, count, tensor):
    """Add the part of the particles of a strip in the stress."""
    zero = physics.zero
    d, sums = len(zero), integers(products(zero, zero) + products(zero, zero))
    # Kinetic part: m c c with the velocity c relative to the shear flow. Collisional part: m v
    # times the place in its cell, of which the caller takes the difference over a collision.
    for i in range(count):
        r, v = load_particle(strip, i, 0, zero), load_particle(strip, i, d, zero)
        m = lane_mass(physics.masses, strip, i, 2 * d)
        sums = added_fixed(carried(box, grid, m, r, v), physics.stress_scale, sums)
    add_fixed(tensor, count, sums)
