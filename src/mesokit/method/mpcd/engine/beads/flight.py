"""Beads of solutes: their flight through a timestep, and their part in the collisions.

Beads keep the image that they started in: bonds are plain differences. Each bead adds up the forces
on it in one order, so that threads share the beads without sharing sums; few beads are one
thread's.
"""

import numpy as np

from mesokit.case.box import at_time, fold, peculiar, unfold
from mesokit.kernels.part import stage
from mesokit.loops.layout import record_length, share
from mesokit.loops.threads import Worker
from mesokit.method.mpcd.collision.protocol import collide, contribute
from mesokit.method.mpcd.engine.beads import state
from mesokit.method.mpcd.engine.beads.moving import MovingBeads
from mesokit.method.mpcd.engine.beads.verlet import verlet
from mesokit.method.mpcd.engine.cpu.grid import cell_index, in_cell
from mesokit.method.mpcd.engine.cpu.groups import COLLIDE, MEASURE_STRESS, STREAM
from mesokit.method.mpcd.engine.cpu.stress import add_terms, flux
from mesokit.method.mpcd.engine.cpu.strips.rows import load_values, store_values
from mesokit.method.mpcd.engine.domains.beads.halo import assign_beads
from mesokit.method.mpcd.engine.where import where
from mesokit.scalar.jit import scalar
from mesokit.scalar.pointer import entry, put_entry
from mesokit.scalar.random import FIRST_BEAD
from mesokit.scalar.vector import added, dot, scaled

LEAST = 4  # groups for a thread: fewer do not pay for the gate


@where(beads=len)
@stage
def move_solutes(worker, now, physics, fluid, beads):
    """Do the stages that the flags have: the pending collision, the flight, the cells."""
    collide_beads(worker, now, physics, fluid, beads)
    if now.flags & STREAM:  # r, v: t -> t + dt; cells at t + dt
        # ranks: owners and copies
        assign_beads(worker, now, physics, box_before(now, physics), fluid, beads)
        together = threads_for(worker, beads)
        first, last = beads_of_thread(worker, together, beads)
        if worker.thread >= together:
            return
        some = Worker(worker.thread, together, worker.gate, worker.clock)
        impulse, measured = fluid.taken.impulse[worker.thread], now.flags & MEASURE_STRESS
        moving = MovingBeads(some, beads, first, last, impulse, measured)
        verlet(moving, now, physics, beads.potentials.substeps)
        bin_beads(now, physics, moving)


@scalar
def collide_beads(worker, now, physics, fluid, beads):
    """The pending collision of the beads of a thread, if there is one."""
    first, last = beads_of_thread(worker, threads_for(worker, beads), beads)
    measured, halo, tensor = now.flags & MEASURE_STRESS, beads.halo, beads.tensor
    box = box_before(now, physics)
    if now.flags & COLLIDE:  # v: the collision at t
        # Beads take the coefficients of their cells, like particles of the fluid. Each bead belongs
        # to one thread.
        for n in range(first, last):
            i = state.bead_of(halo, state.OWN, n)
            collide_bead(beads, i, physics, box, now.old, fluid.cells.coefficients)
        if measured and not now.flags & STREAM:
            for n in range(first, last):
                add_bead_flux(
                    tensor[1, n // state.GROUP], beads, n, physics, now.box, now.old.shift
                )


@scalar
def bin_beads(now, physics, moving):
    """The cells of the beads of a thread at t + dt."""
    beads = moving.beads
    if moving.measured:
        for n in range(moving.first, moving.last):
            row = beads.tensor[0, n // state.GROUP]
            add_bead_flux(row, beads, n, physics, now.box, now.grid.shift)
    for n in range(moving.first, moving.last):
        bin_bead(beads, state.bead_of(beads.halo, state.OWN, n), physics, now)


@scalar
def box_before(now, physics):
    """The box in which the pending collision is."""
    before = now.counter.step - (1 if now.flags & STREAM else 0)
    return at_time(now.box, before * physics.timestep)


@scalar
def threads_for(worker, beads):
    """The number of threads that move the beads: all, or one if there are few beads."""
    number = state.number_of(beads.halo, len(beads.cell), state.OWN)
    groups = (number + state.GROUP - 1) // state.GROUP
    return worker.threads if groups >= LEAST * worker.threads else 1


@scalar
def beads_of_thread(worker, together, beads):
    """First and last + 1 of the beads that a thread moves."""
    number = state.number_of(beads.halo, len(beads.cell), state.OWN)
    groups = (number + state.GROUP - 1) // state.GROUP
    first, last = share(groups, min(worker.thread, together), together)
    return first * state.GROUP, (
        min(last * state.GROUP, number) if worker.thread < together else first * state.GROUP
    )


@scalar
def collide_bead(beads, i, physics, box, grid, coefficients):
    """Velocity after the collision in its cell."""
    r, v, boxes = state.load_folded(beads, i, box, grid.shift)
    start = np.uint64(entry(beads.cell, i)) * np.uint64(record_length(len(physics.coefficients)))
    needed = load_values(coefficients, start, physics.coefficients)
    v = collide(physics.rule, needed, v, in_cell(r, grid))
    _, v = unfold(box, r, v, boxes)
    state.store_velocity(beads, i, v)


@scalar
def bin_bead(beads, i, physics, now):
    """The cell of a bead, and what it adds to the sums of that cell."""
    r, v, boxes = state.load_folded(beads, i, now.box, now.grid.shift)
    put_entry(beads.cell, i, cell_index(r, now.grid))
    key, m = (FIRST_BEAD + i, 0), state.mass_of(beads, i)
    kept, own = contribute(physics.rule, now.counter, key, m, v, in_cell(r, now.grid))
    _, kept = unfold(now.box, r, kept, boxes)
    state.store_velocity(beads, i, kept)
    terms = scaled(m, v) + (m * dot(v, v),) + own
    store_values(beads.given, np.uint64(i * len(terms)), terms)


@scalar
def add_bead_flux(tensor, beads, n, physics, box, shift):
    """Add the part of the nth bead in the stress, with its velocity in the image of its cell."""
    i = state.bead_of(beads.halo, state.OWN, n)
    r, v, _ = state.load_folded(beads, i, box, scaled(0.0, shift))
    place, u, _ = fold(box, r, v, shift)
    carried = flux(state.mass_of(beads, i), peculiar(box, r, v), u, added(place, shift))
    add_terms(tensor, physics.stress_scale, carried)
