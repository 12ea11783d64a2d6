"""The end of a step: impulses are remembered, walls and losses counted, and grains moved."""

import numpy as np

from mesokit.geometry.protocol import Nothing
from mesokit.loops.layout import share
from mesokit.loops.threads import barrier
from mesokit.method.spheres.common.contacts.groups import Solid
from mesokit.method.spheres.common.contacts.remembered import NO_SPRINGS, Springs, keep, kept
from mesokit.method.spheres.common.contacts.solid import MOST, body_of
from mesokit.method.spheres.common.contacts.taken import take
from mesokit.method.spheres.common.walls import entries
from mesokit.method.spheres.rigid.engine.find import (
    GAP,
    KINDS,
    ONE,
    OTHER,
    PAIR,
    PULL,
    ROW,
    TORQUE,
    after_drag,
    alongside,
    spin_at,
    write,
)
from mesokit.method.spheres.rigid.engine.groups import DRAG, INVERSE, MOST_COLOURS, PUSH
from mesokit.method.spheres.rigid.engine.sliding import across
from mesokit.method.spheres.rigid.engine.sweep import pair_of, part_of, relative, turns
from mesokit.method.spheres.rigid.law.coulomb import cut
from mesokit.method.spheres.rigid.law.frame import impulse, parts, sliding
from mesokit.scalar.fixed_point import quanta
from mesokit.scalar.jit import by_type, generic, scalar
from mesokit.scalar.vector import added, added_scaled, dot, first, outer, scaled

IMPACT, FRICTION, ROLLING = range(3)  # energy that contacts take, in the last row of `taken`


@by_type
def in_space(vector):
    """A vector of three, of one of two, or of the one component of a spin in 2D."""
    if len(vector) == 1:
        return lambda vector: (0.0, 0.0, vector[0])
    if len(vector) == 2:
        return lambda vector: (vector[0], vector[1], 0.0)
    return lambda vector: vector


@scalar
def bring(worker, world, found, order, count):
    """Copy the contacts that this thread has found to their places in the order of sweeps, with
    the impulses of the last step."""
    most, flat = len(found.slot) // worker.threads, world.flat
    d, start = len(flat), worker.thread * most
    for f in range(start, start + count):
        c = order.at[f]
        for k in range(2):
            order.pair[c, k], order.beside[c, k] = np.int32(found.pair[f, k]), found.beside[f, k]
        order.slot[c] = found.slot[f]
        for k in range(found.contact.shape[1]):
            order.contact[c, k] = found.contact[f, k]
        for k in range(found.roll.shape[1] if len(found.roll) > 0 else 0):
            order.roll[c, k] = found.roll[f, k]
        last, normal = kept_at(world, found.slot[f]), entries(found.contact, f, 0, flat)
        push, drag = parts(normal, first(last.sliding, flat))
        push = max(push, 0.0)
        order.contact[c, d + PUSH] = push
        most_drag = found.contact[f, after_drag(flat)] * push  # the normal has turned since
        write(order.contact, c, d + DRAG, cut(drag, most_drag))
        if len(found.roll) > 0:
            write(order.roll, c, TORQUE, untwisted(normal, last.rolling))


@by_type
def untwisted(normal, rolling):
    """The angular impulse of which `twisted` is remembered."""
    if len(normal) == 2:
        return lambda normal, rolling: (normal[0] * rolling[1] - normal[1] * rolling[0],)
    return lambda normal, rolling: scaled(-1.0, outer(normal, rolling))


@by_type
def twisted(normal, torque):
    """The normal times the angular impulse: the same as seen from both grains."""
    if len(normal) == 2:
        return lambda normal, torque: (-normal[1] * torque[0], normal[0] * torque[0], 0.0)
    return lambda normal, torque: outer(normal, torque)


@scalar
def kept_at(world, slot):
    """What a contact remembers of the last step."""
    s, kind = slot // KINDS, slot % KINDS
    if kind == PAIR:
        return kept(world.lists.springs, s)
    if kind == ROW:
        return kept(world.walls.springs, s)
    return kept_beside(world.walls.solid, s)


@scalar
def keep_at(world, slot, now):
    """Store what a contact remembers."""
    s, kind = slot // KINDS, slot % KINDS
    if kind == PAIR:
        keep(world.lists.springs, s, now)
    elif kind == ROW:
        keep(world.walls.springs, s, now)
    else:
        keep_beside(world.walls.solid, s, now)


@generic
def kept_beside(solid, s):
    """What the contact number s with walls of any shape remembers."""


kept_beside.register(Nothing)(lambda solid, s: NO_SPRINGS)
kept_beside.register(Solid)(lambda solid, s: kept(solid.springs, s))


@generic
def keep_beside(solid, s, now):
    """Store what the contact number s with walls of any shape remembers."""


keep_beside.register(Nothing)(lambda solid, s, now: None)


@keep_beside.register(Solid)
def _(solid, s, now):
    keep(solid.springs, s, now)


@generic
def body_beside(solid, s):
    """Number of the body of the contact number s with walls of any shape."""


body_beside.register(Nothing)(lambda solid, s: 0)
body_beside.register(Solid)(lambda solid, s: body_of(solid, solid.terms[s // MOST, s % MOST]))


@scalar
def finish(worker, law, step, world, order, total, taken):
    """Remember the impulses of the contacts, and count what walls take and what energy is lost."""
    d, flat, contact = len(world.flat), world.flat, order.contact
    first_contact, last = share(total, worker.thread, worker.threads)
    for c in range(np.uint64(first_contact), np.uint64(last)):
        normal = entries(contact, c, 0, flat)
        push, drag = contact[c, d + PUSH], entries(contact, c, d + DRAG, alongside(flat))
        rolling = (0.0, 0.0, 0.0)
        if law.rolling > 0.0:
            rolling = twisted(normal, entries(order.roll, c, TORQUE, alongside(flat)))
        keep_at(world, order.slot[c], Springs(in_space(impulse(normal, push, drag)), rolling))
        pushed = push - order.beside[c, PULL]
        count_losses(law, world, order, c, push, drag, taken)  # a pull has potential energy
        kind = order.slot[c] % KINDS
        if kind != PAIR:
            rows, s = len(world.walls.rows), order.slot[c] // KINDS
            w = s % rows if kind == ROW else rows + body_beside(world.walls.solid, s)
            whole = in_space(impulse(normal, pushed, drag))
            take(taken, w, counted(whole, law.scale))


@scalar
def counted(vector, scale):
    """A vector in whole quanta."""
    return quanta(vector[0], scale), quanta(vector[1], scale), quanta(vector[2], scale)


@scalar
def count_losses(law, world, order, c, push, drag, taken):
    """Count the energy that a contact takes: minus its impulse times the mean of the velocities at
    the start and at the end of the step."""
    flat, contact = world.flat, order.contact
    i, j = pair_of(order.pair, c)
    normal = entries(contact, c, 0, flat)
    now = relative(world.motion, contact, c, i, j, normal)
    then = relative(world.before, contact, c, i, j, normal)
    velocity, rolled = scaled(0.5, added(now[0], then[0])), scaled(0.5, added(now[1], then[1]))
    impact = -push * dot(normal, velocity)
    friction, rolling = -dot(drag, sliding(normal, velocity, rolled)), 0.0
    if law.rolling > 0.0:
        along, spin = alongside(flat), spin_at(flat)
        one, other = order.roll[c, ONE], order.roll[c, OTHER]
        torque = entries(order.roll, c, TORQUE, along)
        now_turns = turns(world.motion, i, j, one, other, along, spin)
        then_turns = turns(world.before, i, j, one, other, along, spin)
        turned = scaled(0.5, added(now_turns, then_turns))
        rolling = -dot(torque, turned)
    take(taken, len(taken) - 1, counted((-impact, -friction, -rolling), law.energy_scale))


@scalar
def push_back(worker, law, world, order):
    """Move grains that overlap apart, by a share of their overlap, as if each had no neighbours."""
    for k in range(MOST_COLOURS + 1):
        low, high = order.colours[k], order.colours[k + 1]
        if low < high:
            low, high = part_of(worker, k, low, high)
            push_some_back(law, world, order, low, high)
            barrier(worker)


@scalar
def push_some_back(law, world, order, low, high):
    """The same of the contacts from number `low` to before `high`."""
    place, motion, flat, n = world.bodies.place, world.motion, world.flat, len(world.bodies.number)
    # Gaps and places at t. Each of two moves by its share of the inverse mass, so that walls stay.
    for c in range(np.uint64(low), np.uint64(high)):
        i, j = pair_of(order.pair, c)
        if order.beside[c, GAP] < 0.0:
            both = motion[i, INVERSE] + motion[j, INVERSE]
            depth = -law.push_back * order.beside[c, GAP] / both
            normal = entries(order.contact, c, 0, flat)
            shift = depth * motion[i, INVERSE]
            write(place, i, 0, added_scaled(entries(place, i, 0, flat), shift, normal))
            if j < np.uint64(n):
                shift = -depth * motion[j, INVERSE]
                write(place, j, 0, added_scaled(entries(place, j, 0, flat), shift, normal))


@scalar
def kick(motion, bodies, before, i, flat):
    """Remember the velocities at the start of the step, and add a step of gravity (v: t, freely to
    t + dt)."""
    for k in range(before.shape[1]):
        before[i, k] = bodies.motion[i, k]
    for k in range(len(flat)):
        bodies.motion[i, k] += motion.step * motion.gravity[k]


@scalar
def fly(step, bodies, box, i, flat):
    """Move a grain by its new velocity (r: t -> t + dt), and back into the box."""
    for k in range(len(flat)):
        x = bodies.place[i, k] + step * bodies.motion[i, k]
        if box.inverse[k] != 0.0 and (x < 0.0 or x >= box.size[k]):
            boxes = np.int32(1) if x >= box.size[k] else np.int32(-1)
            x -= float(boxes) * box.size[k]
            if x >= box.size[k]:  # it was so little below 0 that it has not left
                x, boxes = 0.0, np.int32(0)
            bodies.images[i, k] += boxes
            if k == 1:
                shift, speed = across(box, float(boxes), step)
                fold_x(bodies, box, i, shift)
                bodies.motion[i, 0] += speed
        bodies.place[i, k] = x


@scalar
def fold_x(bodies, box, i, shift):
    """Move a grain along x, and back into the box."""
    if shift != 0.0:
        x = bodies.place[i, 0] + shift
        while x < 0.0:
            x += box.size[0]
            bodies.images[i, 0] -= np.int32(1)
        while x >= box.size[0]:
            x -= box.size[0]
            bodies.images[i, 0] += np.int32(1)
        bodies.place[i, 0] = x
