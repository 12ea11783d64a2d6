"""Sweeps over all contacts: the impulse of each becomes what its law asks for."""

from typing import Any, NamedTuple

import numpy as np

from mesokit.loops.layout import share
from mesokit.loops.threads import barrier
from mesokit.method.spheres.common.walls import entries
from mesokit.method.spheres.rigid.engine.find import (
    INERTIA,
    LIMIT,
    ONE,
    OTHER,
    PULL,
    TORQUE,
    after_drag,
    alongside,
    spin_at,
    write,
)
from mesokit.method.spheres.rigid.engine.groups import (
    DRAG,
    INVERSE,
    LARGEST,
    LEAST,
    MASS,
    MOST_COLOURS,
    PUSH,
    SUM,
    TOP,
    TOUCHING,
)
from mesokit.method.spheres.rigid.engine.order import shuffle
from mesokit.method.spheres.rigid.law.coulomb import dragged
from mesokit.method.spheres.rigid.law.frame import impulse, sliding, turn
from mesokit.method.spheres.rigid.law.rolling import resisted
from mesokit.method.spheres.rigid.law.signorini import pushed
from mesokit.method.spheres.rigid.solver.protocol import RANDOM, TOGETHER
from mesokit.scalar.jit import by_type, scalar
from mesokit.scalar.vector import added, added_scaled, dot, scaled

FINE = 2.0**28  # parts of the largest impulse in which impulses are added up, without an order


class Draw(NamedTuple):
    """Where the random order of a sweep is drawn: counter of the step, and number of the sweep."""

    counter: Any
    sweep: int


class Seen(NamedTuple):
    """What a sweep has seen: largest change of an impulse, sum of impulses in parts, number of
    contacts with one, and the largest."""

    change: float
    sum: Any
    touching: int
    top: float


@scalar
def hit(motion, plates, i, j, normal, push, drag, per_turn):
    """Give an impulse to the two grains of a contact, or to a grain and a wall."""
    if j >= np.uint64(plates):
        hit_plate(motion, i, j, normal, push, drag, per_turn)
    else:
        hit_grains(motion, i, j, normal, push, drag, per_turn)


@scalar
def hit_grains(motion, i, j, normal, push, drag, per_turn):
    """Give an impulse to two grains, or to a grain and a wall that nothing moves."""
    spin = spin_at(normal)
    whole, spun = impulse(normal, push, drag), turn(normal, drag)
    one, other = motion[i, INVERSE], motion[j, INVERSE]
    write(motion, i, 0, added_scaled(entries(motion, i, 0, normal), one, whole))
    write(motion, j, 0, added_scaled(entries(motion, j, 0, normal), -other, whole))
    before = entries(motion, i, spin, spun), entries(motion, j, spin, spun)
    write(motion, i, spin, added_scaled(before[0], -one * per_turn, spun))
    write(motion, j, spin, added_scaled(before[1], -other * per_turn, spun))


@scalar
def hit_plate(motion, i, j, normal, push, drag, per_turn):
    """The same with a plate that is pushed, which moves along its normal alone."""
    spin, one, other = spin_at(normal), motion[i, INVERSE], motion[j, INVERSE]
    whole, spun = impulse(normal, push, drag), turn(normal, drag)
    write(motion, i, 0, added_scaled(entries(motion, i, 0, normal), one, whole))
    write(motion, j, 0, added_scaled(entries(motion, j, 0, normal), -other * push, normal))
    before = entries(motion, i, spin, spun)
    write(motion, i, spin, added_scaled(before, -one * per_turn, spun))


@scalar
def larger(change, vector):
    """The largest of a number and the sizes of the components of a vector."""
    for k in range(len(vector)):
        change = max(change, abs(vector[k]))
    return change


@by_type
def less_along_x(velocity, speed):
    """A velocity less a speed along x."""
    if len(velocity) == 2:
        return lambda velocity, speed: (velocity[0] - speed, velocity[1])
    return lambda velocity, speed: (velocity[0] - speed, velocity[1], velocity[2])


@scalar
def relative(motion, contact, c, i, j, normal):
    """Velocity of the one centre relative to the other, and the sum of the spins."""
    spin, along = spin_at(normal), alongside(normal)
    velocity = added_scaled(entries(motion, i, 0, normal), -1.0, entries(motion, j, 0, normal))
    slides = contact[c, after_drag(normal) + 1]
    rolled = added(entries(motion, i, spin, along), entries(motion, j, spin, along))
    return less_along_x(velocity, slides), rolled


class Coefficients(NamedTuple):
    """Those of `Law` that an update of a contact uses, out of memory that the loop may write to."""

    stick: float
    per_turn: float
    rolling: float


@scalar
def coefficients(law):
    """The coefficients of all contacts."""
    return Coefficients(law.stick, law.per_turn, law.rolling)


@scalar
def wanted(law, motion, contact, c, i, j, flat):
    """The normal, and the changes of the impulses along it and along the surface."""
    d = len(flat)
    normal = entries(contact, c, 0, flat)
    mass, push = contact[c, d + MASS], contact[c, d + PUSH]
    drag, friction = entries(contact, c, d + DRAG, alongside(flat)), contact[c, after_drag(flat)]
    velocity, rolled = relative(motion, contact, c, i, j, normal)
    new = pushed(push, mass, dot(normal, velocity), contact[c, d + LEAST])
    pulled = drag
    if friction > 0.0:
        along = sliding(normal, velocity, rolled)
        pulled = dragged(drag, mass * law.stick, along, friction * new)
    return normal, new - push, added_scaled(pulled, -1.0, drag)


@scalar
def update(law, motion, plates, contact, roll, c, both, flat):
    """Update the impulse of a contact; the largest change, and the impulse along the normal.

    both: places of its two grains.
    """
    d, (i, j) = len(flat), both
    normal, push, drag = wanted(law, motion, contact, c, i, j, flat)
    hit(motion, plates, i, j, normal, push, drag, law.per_turn)
    new = contact[c, d + PUSH] + push
    contact[c, d + PUSH] = new
    write(contact, c, d + DRAG, added(entries(contact, c, d + DRAG, drag), drag))
    change = larger(abs(push), drag)
    if law.rolling > 0.0:
        update_roll(law, motion, roll, c, i, j, new, flat)
    return change, new


@scalar
def update_roll(law, motion, roll, c, i, j, push, flat):
    """Update the angular impulse against rolling."""
    along, spin = alongside(flat), spin_at(flat)
    one, other = roll[c, ONE], roll[c, OTHER]
    turning = turns(motion, i, j, one, other, along, spin)
    torque = entries(roll, c, TORQUE, along)
    new = resisted(torque, roll[c, INERTIA], turning, roll[c, LIMIT] * push)
    write(roll, c, TORQUE, new)
    twist(motion, i, j, added_scaled(new, -1.0, torque), one, other, law.per_turn, spin)


@scalar
def turns(motion, i, j, one, other, along, spin):
    """Difference of angular velocities, of inverse radii `one` and `other`.

    Both products are rounded alike, so that it only changes its sign with the order of the two.
    """
    first, second = entries(motion, i, spin, along), entries(motion, j, spin, along)
    return added(scaled(one, first), scaled(-other, second))


@scalar
def twist(motion, i, j, torque, one, other, per_turn, spin):
    """Give an angular impulse to the two grains of a contact, of inverse radii `one`, `other`."""
    spins = entries(motion, i, spin, torque), entries(motion, j, spin, torque)
    each = motion[i, INVERSE] * one * per_turn, motion[j, INVERSE] * other * per_turn
    write(motion, i, spin, added_scaled(spins[0], each[0], torque))
    write(motion, j, spin, added_scaled(spins[1], -each[1], torque))


@scalar
def pair_of(pair, c):
    """Places of the two grains of a contact in memory."""
    return np.uint64(pair[c, 0]), np.uint64(pair[c, 1])


@scalar
def begin_sweeps(worker, law, world, order):
    """Give the impulses of the last step, and those of cohesion, to all grains."""
    for k in range(MOST_COLOURS + 1):
        first, last = order.colours[k], order.colours[k + 1]
        if first < last:
            first, last = part_of(worker, k, first, last)
            give(law, world, order, first, last)
            barrier(worker)


@scalar
def part_of(worker, k, first, last):
    """The contacts of a colour that a thread updates; those without a colour are of the first."""
    if k < MOST_COLOURS:
        low, high = share(last - first, worker.thread, worker.threads)
        return first + low, first + high
    return first, (last if worker.thread == 0 else first)


@scalar
def give(law, world, order, first, last):
    """Give the impulses that some contacts begin with to their grains."""
    motion, contact, roll, d = world.motion, order.contact, order.roll, len(world.flat)
    plates = world.plates.first
    for c in range(np.uint64(first), np.uint64(last)):
        i, j = pair_of(order.pair, c)
        normal = entries(contact, c, 0, world.flat)
        push = contact[c, d + PUSH] - order.beside[c, PULL]
        hit(
            motion,
            plates,
            i,
            j,
            normal,
            push,
            entries(contact, c, d + DRAG, alongside(normal)),
            law.per_turn,
        )
        if law.rolling > 0.0:
            torque = entries(roll, c, TORQUE, alongside(normal))
            twist(motion, i, j, torque, roll[c, ONE], roll[c, OTHER], law.per_turn, spin_at(normal))


@scalar
def sweep_some(law, world, order, first, last, scale, seen):
    """Update the contacts from number `first` to before `last`, one after another."""
    motion, contact, roll = world.motion, order.contact, order.roll
    pair, plates, known = order.pair, world.plates.first, coefficients(law)
    change, total, touching, top = seen.change, seen.sum, seen.touching, seen.top
    for c in range(np.uint64(first), np.uint64(last)):
        both = pair_of(pair, c)
        changed, push = update(known, motion, plates, contact, roll, c, both, world.flat)
        change, top = max(change, changed), max(top, push)
        total += np.int64(push * scale)
        touching += 1 if push > 0.0 else 0
    return Seen(change, total, touching, top)


@scalar
def sweep_shuffled(law, world, order, total, scale, seen):
    """Update all contacts in the order that was drawn."""
    motion, contact, roll = world.motion, order.contact, order.roll
    plates = world.plates.first
    known = coefficients(law)
    change, summed, touching, top = seen.change, seen.sum, seen.touching, seen.top
    for q in range(np.uint64(total)):
        c = np.uint64(order.shuffled[q])
        both = pair_of(order.pair, c)
        changed, push = update(known, motion, plates, contact, roll, c, both, world.flat)
        change, top = max(change, changed), max(top, push)
        summed += np.int64(push * scale)
        touching += 1 if push > 0.0 else 0
    return Seen(change, summed, touching, top)


@scalar
def sweep(worker, law, solver, draw, world, order, total, scale):
    """One sweep of all threads; what this thread has seen."""
    seen = Seen(0.0, np.int64(0), 0, 0.0)
    if solver.order == TOGETHER:
        return sweep_together(worker, law, solver, world, order, total, scale, seen)
    if solver.order == RANDOM:
        if worker.thread == 0:
            shuffle(draw.counter, draw.sweep, total, order.shuffled)
            seen = sweep_shuffled(law, world, order, total, scale, seen)
        barrier(worker)
        return seen
    # Threads share the contacts of a colour, and wait for one another before the next.
    for k in range(MOST_COLOURS + 1):
        first, last = order.colours[k], order.colours[k + 1]
        if first < last:
            first, last = part_of(worker, k, first, last)
            seen = sweep_some(law, world, order, first, last, scale, seen)
            barrier(worker)
    return seen


@scalar
def sweep_together(worker, law, solver, world, order, total, scale, seen):
    """Update all contacts at once: first all changes, by the velocities of before, then give them
    to the grains, colour after colour."""
    motion, contact, d = world.motion, order.contact, len(world.flat)
    plates = world.plates.first
    change, summed, touching, top = seen.change, seen.sum, seen.touching, seen.top
    first, last = share(total, worker.thread, worker.threads)
    for c in range(np.uint64(first), np.uint64(last)):
        i, j = pair_of(order.pair, c)
        _, push, drag = wanted(law, motion, contact, c, i, j, world.flat)
        push, drag = solver.relaxation * push, scaled(solver.relaxation, drag)
        new = contact[c, d + PUSH] + push
        contact[c, d + PUSH] = new
        write(contact, c, d + DRAG, added(entries(contact, c, d + DRAG, drag), drag))
        order.change[c, 0] = push
        write(order.change, c, 1, drag)
        change, top = larger(max(change, abs(push)), drag), max(top, new)
        summed += np.int64(new * scale)
        touching += 1 if new > 0.0 else 0
    barrier(worker)
    for k in range(MOST_COLOURS + 1):
        first, last = order.colours[k], order.colours[k + 1]
        if first < last:
            first, last = part_of(worker, k, first, last)
            for c in range(np.uint64(first), np.uint64(last)):
                i, j = pair_of(order.pair, c)
                normal = entries(contact, c, 0, world.flat)
                drag = entries(order.change, c, 1, alongside(normal))
                hit(motion, plates, i, j, normal, order.change[c, 0], drag, law.per_turn)
            barrier(worker)
    return Seen(change, summed, touching, top)


@scalar
def solve(worker, law, solver, counter, world, order, total, noted):
    """Sweep until impulses hardly change, or as often as allowed: sweeps done, largest change of
    the last one over the mean impulse, the mean, and the number of contacts with an impulse."""
    mine = noted[worker.thread]
    begin_sweeps(worker, law, world, order)
    done, ratio, mean, touching, scale = 0, 0.0, 0.0, np.int64(0), 0.0
    # Sums of impulses are whole parts of the largest one of the sweep before, so that they have no
    # order. All threads see the same numbers, and end together.
    while done < solver.sweeps and total > 0:
        seen = sweep(worker, law, solver, Draw(counter, done), world, order, total, scale)
        mine[LARGEST], mine[TOP] = seen.change, seen.top
        mine[SUM], mine[TOUCHING] = float(seen.sum), float(seen.touching)
        barrier(worker)
        change, top, parts, touching = 0.0, 0.0, 0.0, np.int64(0)
        for t in range(worker.threads):
            change, top = max(change, noted[t, LARGEST]), max(top, noted[t, TOP])
            parts += noted[t, SUM]
            touching += np.int64(noted[t, TOUCHING])
        barrier(worker)
        done += 1
        # relative to the mean impulse
        mean = parts / (scale * touching) if scale > 0.0 and touching > 0 else 0.0
        ratio = change / mean if mean > 0.0 else (np.inf if change > 0.0 else 0.0)
        known, scale = scale > 0.0 or top == 0.0, (FINE / top if top > 0.0 else 0.0)
        if known and ratio <= solver.tolerance and solver.tolerance > 0.0:
            break
    return done, ratio, mean, touching
