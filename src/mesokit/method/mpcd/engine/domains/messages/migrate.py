"""Migration: particles move to the owners of the cells that they are in, every so many steps.

They migrate after the coefficients of all cells are known and before the collision, together with
the coefficients of their cell. So no sum changes, and nothing is computed twice. Between two
migrations they stay with their rank, in its block or halo. Molecules migrate as a whole, with their
first bead.
"""

import numpy as np

from mesokit.case.box import SLIDING
from mesokit.kernels.group import writer
from mesokit.kernels.part import stage
from mesokit.loops.clock import MOVE, lap
from mesokit.loops.layout import LANES, beads_of, lanes_in, place, place_of_bead, record_length
from mesokit.loops.threads import barrier
from mesokit.method.mpcd.engine.cpu.grid import cell_in_box, in_block, moved_grid
from mesokit.method.mpcd.engine.cpu.near_solids import FEW
from mesokit.method.mpcd.engine.cpu.strips.rows import load_particle
from mesokit.method.mpcd.engine.domains.messages.ghosts import NO_OWNER, owner_of
from mesokit.method.mpcd.engine.domains.messages.mpi import finish
from mesokit.method.mpcd.engine.domains.messages.shared import (
    ARRIVED,
    DONE,
    HEADER,
    MOLECULES,
    MOVED,
    MOVED_WORDS,
    receive_rows,
    send_rows,
    shares,
)
from mesokit.method.mpcd.engine.where import where
from mesokit.scalar.fixed_point import bits, from_bits
from mesokit.scalar.jit import by_type, scalar, seldom
from mesokit.scalar.vector import scaled

PARTICLES = 4  # tag of messages


@where("True", fluid=shares)
def room_left(fluid):
    """Whether the arrays have room for all molecules that can arrive at once."""
    shared = fluid.cells.shared
    return fluid.particles.filling.molecules + shared.moved_in.shape[0] <= shared.room


@where(fluid=shares)
def note_done(worker, fluid, steps):
    """Note how many steps were done: fewer than requested if there was no room."""
    if worker.thread == 0:
        fluid.cells.shared.noted[DONE] = steps


@where("True", fluid=shares)
@stage
def migrate(worker, now, physics, fluid):
    """Migrate particles, if it is due; true if there was no migration in this step."""
    shared = fluid.cells.shared
    if np.int64(now.counter.step) % shared.every != 0:
        return True
    barrier(worker)
    if worker.thread == 0:
        for p in range(len(shared.ranks)):
            shared.moved_out[shared.moved_at[p] + HEADER, 0] = 0
        n = fluid.particles.filling.molecules
        # Lists of threads are in the order of memory. From the highest place down, the last of the
        # n molecules is never one that still has to leave, so it can fill the gap.
        for t in range(worker.threads - 1, -1, -1):
            for j in range(shared.left[t, 0] - 1, -1, -1):
                n = pack_molecule(fluid, physics, shared.leaving[t, j], shared.owner[t, j], n)
            shared.left[t, 0] = 0
        sent = receive_rows(shared, 0, shared.moved_in, shared.moved_at, PARTICLES)
        for p in range(len(shared.ranks)):
            first = shared.moved_at[p]
            rows = shared.moved_out[first + HEADER, 0]
            sent = send_rows(
                shared, sent, shared.moved_out, first, 1 + rows, p, PARTICLES, MOVED_WORDS
            )
            shared.meter[MOVED] += rows
        finish(shared.post, sent)
        shared.noted[ARRIVED] = 0
        # New molecules are appended. Their order in memory depends on the partners, but no bit
        # does: random numbers follow from ids, and sums are integers.
        for p in range(len(shared.ranks)):
            begin = shared.moved_at[p] + HEADER + 1
            for row in range(begin, begin + shared.moved_in[begin - 1, 0]):
                n = unpack_molecule(fluid, physics, shared.moved_in[row], n)
        shared.noted[MOLECULES] = n
    barrier(worker)
    lap(worker, MOVE)
    return False


@by_type
def owner_grid(box, grid, closed):
    """The cells that decide the owner of a particle: those without a shift.

    Under shear these are the cells of the step: only in them do particles have one image.
    """
    if box.instance_class in SLIDING:
        return lambda box, grid, closed: grid
    return lambda box, grid, closed: moved_grid(grid, scaled(0.0, grid.shift), closed)


@where(fluid=shares)
def note_migrants(worker, now, physics, fluid, strip, s):
    """Note the first beads in strip s, which is in the cache, that must migrate in this step."""
    shared, away, marks = fluid.cells.shared, np.int64(0), fluid.scratch.marks[worker.thread]
    if np.int64(now.counter.step) % shared.every == 0:
        grid = owner_grid(now.box, now.grid, shared.closed)
        for i in range(LANES):
            r = load_particle(strip, i, 0, physics.zero)
            marks[i] = np.int64(not in_block(shared.limits, cell_in_box(r, grid)))
            away |= marks[i]
        if away != 0:
            note_leaving(worker.thread, fluid, strip, s, grid, physics.zero)


@seldom
def note_leaving(thread, fluid, strip, s, grid, zero):
    """Note the marked molecules of a strip and their owners, as long as there is room."""
    shared, marks, filling = (
        fluid.cells.shared,
        fluid.scratch.marks[thread],
        fluid.particles.filling,
    )
    found, first = shared.left[thread, 0], s // beads_of(filling) * LANES
    for i in range(lanes_in(filling, s)):
        if marks[i] != 0 and found < shared.leaving.shape[1]:
            r = load_particle(strip, i, 0, zero)
            owner, _ = owner_of(shared, cell_in_box(r, grid))
            if owner != NO_OWNER:
                shared.leaving[thread, found], shared.owner[thread, found] = first + i, owner
                found += 1
    shared.left[thread, 0] = found


@scalar
def pack_molecule(fluid, physics, molecule, p, n):
    """Write a molecule into the message to a partner; the last of n molecules takes its place."""
    shared, particles = fluid.cells.shared, fluid.particles
    first = shared.moved_at[p]
    rows = shared.moved_out[first + HEADER, 0]
    if first + HEADER + 1 + rows >= shared.moved_at[p + 1]:
        return n  # no room: it stays until the next migration
    shared.moved_out[first + HEADER, 0] = rows + 1
    out, at = shared.moved_out[first + HEADER + 1 + rows], 0
    numbers, d = len(physics.coefficients), len(physics.zero)
    length = np.uint64(record_length(numbers))
    # Each bead has its id, the bits of position (t + dt) and velocity (before the collision), and
    # images. The coefficients of its cell follow: with them the new owner does the pending
    # collision.
    for bead in range(beads_of(particles.filling)):
        i = place_of_bead(particles.filling, molecule, bead)
        last = place_of_bead(particles.filling, n - 1, bead)
        out[at] = particles.ident[i]
        at += 1
        for row in range(particles.rows):
            here = place(i, particles.rows, row)
            out[at] = bits(particles.data[here])
            particles.data[here] = particles.data[place(last, particles.rows, row)]
            at += 1
        for k in range(d):
            out[at] = particles.image[k, i]
            particles.image[k, i] = particles.image[k, last]
            at += 1
        start = np.uint64(particles.cell[i]) * length
        for k in range(numbers):
            out[at] = bits(fluid.cells.coefficients[start + np.uint64(k)])
            at += 1
        particles.ident[i], particles.cell[i] = particles.ident[last], particles.cell[last]
        forget_part(fluid, i)
    return n - 1


@scalar
def forget_part(fluid, i):
    """Set the clearance of this part of a strip to 0, as other particles are in it now."""
    part = i // FEW
    fluid.room[0, part] = fluid.room[1, part] = 0.0


@scalar
def unpack_molecule(fluid, physics, given, n):
    """Append a molecule from a message; the coefficients of its cells get records of their own."""
    shared, particles, at = fluid.cells.shared, fluid.particles, 0
    numbers, d = len(physics.coefficients), len(physics.zero)
    length = np.uint64(record_length(numbers))
    # A bead that arrives may lie in a cell whose record here was not filled. So its coefficients
    # go to a record behind the cells, for this one collision.
    for bead in range(beads_of(particles.filling)):
        i = place_of_bead(particles.filling, n, bead)
        particles.ident[i] = given[at]
        at += 1
        for row in range(particles.rows):
            particles.data[place(i, particles.rows, row)] = from_bits(given[at])
            at += 1
        for k in range(d):
            particles.image[k, i] = np.int32(given[at])
            at += 1
        slot = fluid.cells.number + 1 + shared.slots + shared.noted[ARRIVED]
        shared.noted[ARRIVED] += 1
        particles.cell[i] = np.int32(slot)
        for k in range(numbers):
            fluid.cells.coefficients[np.uint64(slot) * length + np.uint64(k)] = from_bits(given[at])
            at += 1
        forget_part(fluid, i)
    return n + 1


set_molecules = writer("filling")  # particles, number of molecules


@where(fluid=shares)
def count_molecules(fluid):
    """Update the number of molecules after a migration."""
    set_molecules(fluid.particles, fluid.cells.shared.noted[MOLECULES])
