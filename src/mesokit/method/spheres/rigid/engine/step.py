"""A step of contact dynamics: contacts, their order, sweeps, and flight, by all threads.

Velocities change by gravity and by the impulses of contacts, which are found for the velocities at
the end of the step; then places change by these velocities (Moreau 1988; Jean 1999).
"""

import math

import numpy as np

from mesokit.kernels.kernel import kernel
from mesokit.loops.layout import share
from mesokit.loops.neighbours import outdated
from mesokit.loops.threads import barrier
from mesokit.method.spheres.common.contacts.geometry import row, shortest
from mesokit.method.spheres.common.walls import AXIS, KIND, MOVES, PLANE, displaced, entries
from mesokit.method.spheres.rigid.engine.find import (
    Look,
    Room,
    alongside,
    find_contacts,
    spin_at,
    write,
)
from mesokit.method.spheres.rigid.engine.finish import bring, finish, fly, kick, push_back
from mesokit.method.spheres.rigid.engine.groups import (
    CHANGED,
    COUNT,
    DONE,
    FARTHEST,
    FASTEST,
    FORCE,
    GOES_ON,
    INVERSE,
    MEAN,
    NO_ROOM,
    OLD_LISTS,
    PER_MASS,
    PRESSURE,
    RATIO,
    SHIFT,
    SPEED,
    STEPS,
    SWEEPS,
    TOO_FAST,
    TOUCHING,
    WHY,
    World,
)
from mesokit.method.spheres.rigid.engine.order import arrange
from mesokit.method.spheres.rigid.engine.sliding import box_in_step, slip
from mesokit.method.spheres.rigid.engine.sweep import solve
from mesokit.scalar.jit import scalar
from mesokit.scalar.random import Counter
from mesokit.scalar.vector import added_scaled, dot, first

ZERO = (0.0, 0.0, 0.0)


@kernel
def advance(worker, counter, steps, rules, world, found, order, sums):
    """Do `steps` steps, or fewer where lists must be made anew or contacts have no room.

    `sums.noted` holds afterwards the number of steps done, and why there are no more; and of the
    last of them the number of sweeps and the largest change of an impulse over the mean.
    """
    law, solver, motion, shear = rules.law, rules.solver, rules.motion, rules.shear
    noted, taken = sums.noted, sums.taken
    n, flat = len(world.bodies.number), world.flat
    first_one, last = share(n, worker.thread, worker.threads)
    mine, most = noted[worker.thread], len(found.slot) // worker.threads
    lost = taken[worker.thread]
    mine[WHY] = GOES_ON
    done, afresh, total = 0, True, np.int64(0)
    while done < steps:
        # All of a step as the comment of each stage says. Barriers are where a thread reads what
        # another has written. All threads see the same numbers, so they end together.
        now = Counter(counter.seed, counter.step + np.uint64(done))
        time = motion.step * float(now.step)
        box = box_in_step(shear, world.box, time, motion.step)
        there = with_box(world, box)
        # 1. How far grains have moved since lists were made, and how fast they are: t.
        if worker.thread == 0:
            set_plates(world)
        mine[FARTHEST], mine[FASTEST] = farthest_and_fastest(there, first_one, last)
        barrier(worker)
        fastest = 0.0
        for t in range(worker.threads):
            fastest = max(fastest, noted[t, FASTEST])
        ahead = reach_of_step(law, motion, fastest)
        skin = world.lists.skin - ahead
        slid = slip(box, shear, time, motion.made)
        if not skin > 0.0:
            mine[WHY] = TOO_FAST
            break
        if outdated(noted, FARTHEST, worker.threads, slid, skin):
            mine[WHY] = OLD_LISTS
            break
        # 2. Contacts that may close within the step, at the places and velocities of t.
        room = Room(worker.thread * most, most, afresh)
        look = Look(law, motion.step, time, ahead)
        count, changed = find_contacts(look, (first_one, last), there, found, room)
        changed |= float(count) != mine[COUNT]
        mine[COUNT], mine[CHANGED] = float(count), 1.0 if changed else 0.0
        barrier(worker)
        longest, anew = 0.0, False
        for t in range(worker.threads):
            longest = max(longest, noted[t, COUNT])
            anew |= noted[t, CHANGED] != 0.0
        if longest > float(most):
            mine[WHY] = NO_ROOM
            break
        # 3. Their order, by the first thread; it stays while the contacts are the same.
        if anew and worker.thread == 0:
            arrange(worker, solver, n, world.plates.first, found, order, noted)
        # 4. Gravity: v freely to t + dt.
        for i in range(first_one, last):
            kick(motion, world.bodies, world.before, i, flat)
        if worker.thread == 0:
            push_plates(motion, time, world)
        barrier(worker)
        total = np.int64(0)
        for t in range(worker.threads):
            total += np.int64(noted[t, COUNT])
        # 5. Impulses for the velocities at t + dt, from those of the last step.
        bring(worker, there, found, order, count)
        barrier(worker)
        swept, ratio, mean, touching = solve(worker, law, solver, now, there, order, total, noted)
        afresh = False
        # 6. What is remembered and counted; then flight: r from t to t + dt.
        finish(worker, law, motion.step, there, order, total, lost)
        mine[SWEEPS], mine[RATIO], mine[MEAN] = float(swept), ratio, mean
        mine[TOUCHING] = float(touching)
        if law.push_back > 0.0:
            barrier(worker)
            push_back(worker, law, there, order)
        barrier(worker)
        if worker.thread == 0:
            move_plates(motion, world)
        for i in range(first_one, last):
            fly(motion.step, world.bodies, box, i, flat)
        done += 1
        mine[STEPS] += float(swept)
        mine[WHY] = GOES_ON
    mine[DONE] = float(done)


@scalar
def with_box(world, box):
    """The world with the box of a step."""
    memory = world.motion, world.before, world.plates, world.flat
    return World(world.bodies, box, world.lists, world.walls, *memory)


@scalar
def reach_of_step(law, motion, fastest):
    """The gap that two grains may close within a step: at twice the largest speed, more if they
    bounce."""
    pull = 0.0
    for k in range(len(motion.gravity)):
        pull += motion.gravity[k] * motion.gravity[k]
    speed = fastest + motion.step * math.sqrt(pull) + motion.walls
    return 2.0 * (1.0 + law.bounces) * speed * motion.step + law.within


@scalar
def farthest_and_fastest(world, first_one, last):
    """The largest squared displacement since lists were made, and the largest speed."""
    bodies, farthest, fastest = world.bodies, 0.0, 0.0
    for i in range(first_one, last):
        gone = added_scaled(row(bodies.place, i), -1.0, row(world.lists.made_at, i))
        x, y, z = shortest(world.box, gone)
        square = x * x + y * y + z * z
        farthest = max(farthest, square if square >= 0.0 else np.inf)
        speed = 0.0
        for k in range(len(world.flat)):
            speed += bodies.motion[i, k] * bodies.motion[i, k]
        fastest = max(fastest, speed if speed >= 0.0 else np.inf)
    if first_one == 0:  # the thread that moves plates
        for w in range(len(world.walls.rows)):
            fastest = max(fastest, world.plates.state[w, SPEED] * world.plates.state[w, SPEED])
    return farthest, math.sqrt(fastest)


@scalar
def set_plates(world):
    """Write rows of motion of plates that are pushed, with their velocities of t."""
    state, drive, rows = world.plates.state, world.plates.drive, world.walls.rows
    for w in range(len(rows)):
        if drive[w, PER_MASS] > 0.0:
            at, out = world.plates.first + w, first(entries(rows, w, AXIS, ZERO), world.flat)
            moves = first(entries(rows, w, MOVES, ZERO), world.flat)
            for motion in (world.motion, world.before):
                write(motion, at, 0, added_scaled(moves, state[w, SPEED], out))
                motion[at, INVERSE] = drive[w, PER_MASS]
                write(motion, at, spin_at(world.flat), alongside(world.flat))


@scalar
def push_plates(motion, time, world):
    """Add a step of their forces to the velocities of plates (v: t, freely to t + dt)."""
    drive, rows = world.plates.drive, world.walls.rows
    for w in range(len(rows)):
        if drive[w, PER_MASS] > 0.0:
            at, out = world.plates.first + w, first(entries(rows, w, AXIS, ZERO), world.flat)
            force = drive[w, FORCE] + drive[w, PRESSURE] * area(time, world, w)
            speed = motion.step * force * drive[w, PER_MASS]
            now = entries(world.motion, at, 0, world.flat)
            write(world.motion, at, 0, added_scaled(now, speed, out))


@scalar
def area(time, world, w):
    """Area of a plate, or length in 2D, between the plates across it as they have moved."""
    rows, found, sides = world.walls.rows, 1.0, world.box.size
    for k in range(len(world.flat)):
        if rows[w, AXIS + k] == 0.0:
            length = sides[k]
            for other in range(len(rows)):
                if rows[other, KIND] == PLANE and rows[other, AXIS + k] != 0.0:
                    shift, _ = displaced(rows, other, time)
                    length -= shift + world.plates.state[other, SHIFT]
            found *= length
    return found


@scalar
def move_plates(motion, world):
    """Move plates that are pushed by their new speeds: t -> t + dt."""
    state, rows = world.plates.state, world.walls.rows
    for w in range(len(rows)):
        if world.plates.drive[w, PER_MASS] > 0.0:
            out = first(entries(rows, w, AXIS, ZERO), world.flat)
            moves = first(entries(rows, w, MOVES, ZERO), world.flat)
            now = entries(world.motion, world.plates.first + w, 0, world.flat)
            state[w, SPEED] = dot(added_scaled(now, -1.0, moves), out)
            state[w, SHIFT] += motion.step * state[w, SPEED]
