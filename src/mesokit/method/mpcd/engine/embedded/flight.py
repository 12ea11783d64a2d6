"""Beads and the particles of the fluid near them, moved together in sub-steps.

What a particle and a bead hand over is rounded to a whole number of units of momentum, which one
takes and the other loses: momentum is kept exactly, and forces on a bead are sums of whole numbers,
in whatever order and by however many threads they are found.
"""

from typing import Any, NamedTuple

import numpy as np

from mesokit.kernels.part import stage
from mesokit.loops.layout import share
from mesokit.loops.threads import barrier
from mesokit.method.mpcd.engine.beads import state
from mesokit.method.mpcd.engine.beads.moving import MovingBeads, accelerated
from mesokit.method.mpcd.engine.beads.neighbours import apart
from mesokit.method.mpcd.engine.beads.verlet import SUBSTEP_BITS, drift, flown, kick, verlet
from mesokit.method.mpcd.engine.cpu.groups import STREAM
from mesokit.method.mpcd.engine.cpu.physics import has_solid, momentum_scale
from mesokit.method.mpcd.engine.cpu.strips.one import mass_in_lane
from mesokit.method.mpcd.engine.cpu.strips.rows import load_values, store_values
from mesokit.method.mpcd.engine.embedded.near import has_left, note
from mesokit.method.mpcd.engine.embedded.state import (
    ALL_BEADS,
    COUNT,
    PARTNERS,
    TOO_FAR,
    TOO_HARD,
    Embedded,
)
from mesokit.method.mpcd.engine.where import where
from mesokit.potential.protocol import central
from mesokit.scalar.fixed_point import add_integers, added_quanta, floats, integers, opposite
from mesokit.scalar.jit import elementwise, scalar
from mesokit.scalar.vector import added, added_scaled, dot, scaled

MOST_UNITS = 2.0**52  # that a particle may hand over at once: a thousand thermal momenta


class Together(NamedTuple):
    """Beads and the particles near them, as one thread moves its share of both."""

    solutes: MovingBeads
    embedded: Embedded
    particles: Any


@stage
def move_in_fluid(worker, now, physics, fluid, beads):
    """r, v of beads and of the particles near them: t -> t + dt."""
    if now.flags & STREAM:
        (embedded,) = beads.embedded
        first, last = share(len(beads.cell), worker.thread, worker.threads)
        impulse = fluid.taken.impulse[worker.thread]
        solutes = MovingBeads(worker, beads, first, last, impulse, 0)
        moving = Together(solutes, embedded, fluid.particles)
        verlet(moving, now, physics, beads.potentials.substeps)


@drift.register(Together)
def _(moving, counter, physics, time):
    drift(moving.solutes, counter, physics, time)
    solutes, embedded, thread = moving.solutes, moving.embedded, moving.solutes.worker.thread
    for i in range(solutes.first, solutes.last):
        start = load_values(embedded.lists.made_at, np.uint64(i * len(physics.zero)), physics.zero)
        if has_left(start, state.load_place(solutes.beads, i, physics.zero), embedded.skin):
            step = np.int64(counter.step) & np.int64((1 << SUBSTEP_BITS) - 1)
            note(embedded.faults[thread], step, TOO_FAR, i + 1)
    for n in range(embedded.number[thread, COUNT]):
        drift_particle(moving, n, counter, physics, time)


@scalar
def drift_particle(moving, n, counter, physics, time):
    """Straight flight of one particle, with reflections."""
    embedded, thread, zero = moving.embedded, moving.solutes.worker.thread, physics.zero
    at = np.uint64(n * len(zero))
    r, v = load_values(embedded.r[thread], at, zero), load_values(embedded.v[thread], at, zero)
    r, v = moved(physics, time, counter, moving, embedded.lane[thread, n], r, v)
    store_values(embedded.r[thread], at, r)
    store_values(embedded.v[thread], at, v)
    start = load_values(embedded.start[thread], at, zero)
    if has_left(start, r, embedded.bound[thread, n]):  # pushed away: other beads may be near now
        embedded.partners[thread, n] = ALL_BEADS


@where("(added_scaled(r, time, v), v)", physics=has_solid)
def moved(physics, time, counter, moving, lane, r, v):
    """Place and velocity of the particle in a lane after a sub-step without forces."""
    m, number = mass_in_lane(physics, moving.particles, lane), moving.particles.ident[lane]
    return flown(physics, time, counter, number, m, r, v, moving.solutes.impulse)


@kick.register(Together)
def _(moving, step, box, physics, time):
    kick(moving.solutes, step, box, physics, time)  # threads meet: all places are known
    solutes, embedded, zero = moving.solutes, moving.embedded, physics.zero
    worker, beads = solutes.worker, solutes.beads
    embedded.taken[worker.thread] = 0
    # First the particles of this thread: each gets its impulse, and the opposite goes to the
    # thread's own sums of the beads. After the barrier each bead adds up the sums of all threads.
    # Impulses are whole units of momentum, so totals have no order and momentum is exact.
    for n in range(embedded.number[worker.thread, COUNT]):
        kick_particle(moving, n, step, box, physics, time)
    barrier(worker)
    unit = 1.0 / momentum_scale(physics)
    for i in range(solutes.first, solutes.last):
        total = integers(zero)
        for t in range(worker.threads):
            total = plus(embedded.taken[t], i * len(zero), total)
        v = added_scaled(
            state.load_velocity(beads, i, zero),
            unit * state.inverse_mass_of(beads, i),
            floats(total),
        )
        state.store_velocity(beads, i, v)


@scalar
def pull_of(embedded, beads, box, r, j):
    """From bead j to a particle at r, and the force on the particle over their distance."""
    separation = apart(box, state.load_place(beads, j, r), r)
    _, force_over_r = central(embedded.potential, dot(separation, separation))
    return separation, force_over_r


@scalar
def is_too_hard(impulse, scale):
    """Whether a particle would hand over more at once than whole numbers can hold."""
    return not dot(impulse, impulse) * scale * scale < MOST_UNITS * MOST_UNITS


@scalar
def kick_particle(moving, n, step, box, physics, time):
    """Change of the velocity of one particle by the beads near it, which take the opposite."""
    embedded, thread, zero = moving.embedded, moving.solutes.worker.thread, physics.zero
    beads, at, d = moving.solutes.beads, np.uint64(n * len(zero)), len(zero)
    r, v = load_values(embedded.r[thread], at, zero), load_values(embedded.v[thread], at, zero)
    count, given, scale = embedded.partners[thread, n], integers(zero), momentum_scale(physics)
    # Beads on the particle's list, or all beads where a list does not hold. Beads beyond the reach
    # of the potential add nothing, so both give the same bits.
    for k in range(count if count != ALL_BEADS else len(beads.cell)):
        j = embedded.beads[thread, n * PARTNERS + k] if count != ALL_BEADS else k
        separation, force_over_r = pull_of(embedded, beads, box, r, j)
        if force_over_r != 0.0:
            impulse = scaled(time * force_over_r, separation)
            if is_too_hard(impulse, scale):
                note(embedded.faults[thread], step, TOO_HARD, j + 1)
            else:
                units = added_quanta(impulse, scale, integers(zero))
                given = added(given, units)
                add_integers(embedded.taken[thread, j * d : (j + 1) * d], opposite(units))
    m = mass_in_lane(physics, moving.particles, embedded.lane[thread, n])
    v = added_scaled(v, 1.0 / (scale * m), floats(given))
    store_values(embedded.v[thread], at, accelerated(physics.field, time, r, v))


@elementwise
def plus(values, start, total):
    """A vector of whole numbers to which consecutive values of an array are added."""
    return "total[{k}] + values[start + {k}]"
