"""Beads beside bodies that move: both fly in the same sub-steps, and repel each other by the gap.

What a body and a bead hand over is rounded to a whole number of quanta of momentum, which one takes
and the other loses. So totals have no order, and momentum is exact.
"""

from typing import Any, NamedTuple

import numpy as np

from mesokit.kernels.part import stage
from mesokit.loops.clock import BEADS, lap
from mesokit.loops.layout import share
from mesokit.loops.threads import Worker, barrier
from mesokit.method.mpcd.engine.beads import state
from mesokit.method.mpcd.engine.beads.flight import (
    beads_of_thread,
    bin_beads,
    box_before,
    collide_beads,
    threads_for,
)
from mesokit.method.mpcd.engine.beads.moving import MovingBeads, forces_of_now, kick_bead
from mesokit.method.mpcd.engine.beads.verlet import drift, kick, verlet
from mesokit.method.mpcd.engine.bodies.forces import force_on_place
from mesokit.method.mpcd.engine.bodies.hits import give_opposite, take_impulses
from mesokit.method.mpcd.engine.bodies.motion import (
    begin_motions,
    drift_body,
    kick_body,
    note_beginning,
)
from mesokit.method.mpcd.engine.bodies.near import (
    PARTNERS_HOLD,
    SLID,
    bodies_near,
    body_near,
    box_at_start,
    cell_of,
    farthest_gap,
    list_of,
    slide_of,
)
from mesokit.method.mpcd.engine.bodies.state import (
    END_TURN,
    FOUR,
    PLACE,
    RADIUS,
    RANGE,
    TURN,
    MovingBodies,
    image_near,
    load,
    of_kind,
    store,
)
from mesokit.method.mpcd.engine.cpu.groups import MEASURE_STRESS, STREAM
from mesokit.method.mpcd.engine.cpu.physics import momentum_scale, of_bodies
from mesokit.method.mpcd.engine.domains.beads.halo import assign_beads
from mesokit.method.mpcd.engine.domains.messages.bodies import add_others
from mesokit.scalar.fixed_point import added_quanta, floats, integers
from mesokit.scalar.jit import scalar, seldom
from mesokit.scalar.vector import added, added_scaled, dot, scaled


class BesideBodies(NamedTuple):
    """Beads and bodies, as one thread moves its share of both in a step."""

    worker: Worker
    now: Any
    fluid: Any
    solutes: MovingBeads
    bodies: MovingBodies


@stage
def move_together(worker, now, physics, fluid, beads, bodies):
    """The pending collision of beads; r, v of beads and bodies: t -> t + dt without the fluid.

    Places and orientations of bodies stay those at t until the fluid has flown.
    """
    collide_beads(worker, now, physics, fluid, beads)
    if now.flags & STREAM:
        # ranks: owners and copies
        assign_beads(worker, now, physics, box_before(now, physics), fluid, beads)
        first, last = beads_of_thread(worker, threads_for(worker, beads), beads)
        impulse, measured = fluid.taken.impulse[worker.thread], now.flags & MEASURE_STRESS
        solutes = MovingBeads(worker, beads, first, last, impulse, measured)
        note_beginning(worker, now, of_bodies(physics), bodies)
        moving = BesideBodies(worker, now, fluid, solutes, bodies)
        verlet(moving, now, physics, bodies.substeps)
        begin_motions(worker, now, of_bodies(physics), bodies)
        bin_beads(now, physics, solutes)
    lap(worker, BEADS)


@drift.register(BesideBodies)
def _(moving, counter, physics, time):
    drift(moving.solutes, counter, physics, time)
    worker, bodies = moving.worker, moving.bodies
    first, last = share(len(bodies.rows), worker.thread, worker.threads)
    for i in range(first, last):
        drift_body(bodies, of_bodies(physics), i, time)


@kick.register(BesideBodies)
def _(moving, step, box, physics, time):
    worker, now, fluid, solutes, bodies = moving
    beads, few = solutes.beads, of_bodies(physics)
    force = forces_of_now(solutes, step, box, physics, time)  # threads meet: all places are known
    low, high = share(len(bodies.rows), worker.thread, worker.threads)
    for i in range(low, high):
        kick_body(worker, now, few, fluid, bodies, i, time)
    # Each bead takes its impulse, and the opposite goes to the thread's own sums of the bodies.
    # After the barrier each body takes the sums of all threads, and of all ranks.
    for n in range(solutes.first, solutes.last):
        i = state.bead_of(beads.halo, state.OWN, n)
        r = state.load_place(beads, i, physics.zero)
        given = force_of_bodies(worker.thread, now, few, bodies, box, r, time)
        kick_bead(force, given, beads, i, box, physics, time)
    barrier(worker)
    add_others(worker, bodies, bodies.taken, 0)
    for i in range(low, high):
        store(bodies.rows, i, END_TURN, load(bodies.rows, i, TURN, FOUR))
        take_impulses(few, bodies, i)


@scalar
def force_of_bodies(thread, now, physics, bodies, box, r, time):
    """Force on a bead at r by the bodies near it, which take the opposite impulse in a time."""
    start, scale, units = box_at_start(now, physics), momentum_scale(physics), integers(r)
    # Surfaces and images have gone on since lists were made.
    moved = PARTNERS_HOLD + bodies.work[thread, SLID] + slide_of(start) * physics.timestep
    here = np.int64(cell_of(bodies, start, r))
    cell = list_of(bodies, here, farthest_gap(bodies) + moved)
    for n in range(bodies_near(bodies, cell)):
        i = body_near(bodies, cell, n)
        x, _ = image_near(box, load(bodies.rows, i, PLACE, r), r)
        s = added_scaled(r, -1.0, x)
        reach = of_kind(bodies, i, RADIUS) + of_kind(bodies, i, RANGE)
        if dot(s, s) < reach * reach:
            units = added(units, pushed(thread, now, physics, bodies, i, s, time))
    return scaled(1.0 / (scale * time), floats(units))


@seldom
def pushed(thread, now, physics, bodies, i, s, time):
    """The impulse, in quanta, on a bead at an arm s from body i, which takes the opposite."""
    impulse = scaled(time, force_on_place(bodies, i, s))
    units = added_quanta(impulse, momentum_scale(physics), integers(s))
    give_opposite(thread, now, physics, bodies, i, s, units)
    return units
