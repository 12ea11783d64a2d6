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
from mesokit.method.spheres.rigid.engine.find import Room, find_contacts
from mesokit.method.spheres.rigid.engine.finish import bring, finish, fly, kick, push_back
from mesokit.method.spheres.rigid.engine.groups import (
    CHANGED,
    COUNT,
    DONE,
    FARTHEST,
    FASTEST,
    GOES_ON,
    MEAN,
    NO_ROOM,
    OLD_LISTS,
    RATIO,
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
from mesokit.scalar.vector import added_scaled


@kernel
def advance(worker, counter, steps, law, solver, motion, shear, world, found, order, noted, taken):
    """Do `steps` steps, or fewer where lists must be made anew or contacts have no room.

    `noted` (threads, 16) holds afterwards the number of steps done, and why there are no more; and
    of the last of them the number of sweeps and the largest change of an impulse over the mean.
    """
    n, flat = len(world.bodies.number), world.flat
    first, last = share(n, worker.thread, worker.threads)
    mine, most = noted[worker.thread], len(found.slot) // worker.threads
    lost = taken[worker.thread]
    mine[WHY] = GOES_ON
    done, afresh, total = 0, True, 0
    while done < steps:
        # All of a step as the comment of each stage says. Barriers are where a thread reads what
        # another has written. All threads see the same numbers, so they end together.
        now = Counter(counter.seed, counter.step + np.uint64(done))
        time = motion.step * float(now.step)
        box = box_in_step(shear, world.box, time, motion.step)
        there = World(world.bodies, box, world.lists, world.walls, world.motion, world.before, flat)
        # 1. How far grains have moved since lists were made, and how fast they are: t.
        mine[FARTHEST], mine[FASTEST] = farthest_and_fastest(there, first, last)
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
        count, changed = find_contacts(
            law, motion.step, time, ahead, (first, last), there, found, room
        )
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
            arrange(worker, solver, n, found, order, noted)
        # 4. Gravity: v freely to t + dt.
        for i in range(first, last):
            kick(motion, world.bodies, world.before, i, flat)
        keep_walls(world, found, worker.thread * most, count)
        barrier(worker)
        total = 0
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
            push_back(worker, law, there, order, total)
        barrier(worker)
        for i in range(first, last):
            fly(motion.step, world.bodies, box, i, flat)
        done += 1
        mine[STEPS] += float(swept)
        mine[WHY] = GOES_ON
    mine[DONE] = float(done)


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
def farthest_and_fastest(world, first, last):
    """The largest squared displacement since lists were made, and the largest speed."""
    bodies, farthest, fastest = world.bodies, 0.0, 0.0
    for i in range(first, last):
        gone = added_scaled(row(bodies.place, i), -1.0, row(world.lists.made_at, i))
        x, y, z = shortest(world.box, gone)
        square = x * x + y * y + z * z
        farthest = max(farthest, square if square >= 0.0 else np.inf)
        speed = 0.0
        for k in range(len(world.flat)):
            speed += bodies.motion[i, k] * bodies.motion[i, k]
        fastest = max(fastest, speed if speed >= 0.0 else np.inf)
    return farthest, math.sqrt(fastest)


@scalar
def keep_walls(world, found, start, count):
    """Walls move in the whole step as at its start."""
    n = len(world.bodies.number)
    for f in range(start, start + count):
        if found.pair[f, 1] >= n:
            for k in range(world.before.shape[1]):
                world.before[n + f, k] = world.motion[n + f, k]
