"""Velocity Verlet, by all threads, until the lists are outdated.

Half a kick and the drift, the forces at the new places, half a kick. Dashpots along the normal
take the velocities at the end of the step, others those of the half step. Forces are whole numbers
of quanta, so that their sums have no order. With a bath, velocities are drawn between two halves of
the drift (BAOAB; Leimkuhler and Matthews 2013).
"""

import math

import numpy as np

from mesokit.kernels.kernel import kernel
from mesokit.loops.layout import share
from mesokit.loops.neighbours import nearest_image, outdated
from mesokit.loops.threads import barrier
from mesokit.method.spheres.common.contacts.geometry import row
from mesokit.method.spheres.common.contacts.groups import INVERSE
from mesokit.method.spheres.soft.engine.acting import act, turns
from mesokit.method.spheres.soft.engine.contact.room import room_of_thread
from mesokit.method.spheres.soft.engine.groups import DONE, FARTHEST, PENDING
from mesokit.scalar.jit import scalar
from mesokit.scalar.random import METHOD, Counter, normals, words
from mesokit.scalar.vector import added_scaled

BATH, BATH_OF_SPINS = METHOD + np.uint64(1), METHOD + np.uint64(2)


@kernel
def advance(worker, counter, steps, law, motion, world, noted, rooms):
    """Do `steps` steps, or fewer where lists must be made anew.

    `noted` (threads, 8) holds, before and after, whether forces at the new places are due first,
    and after, the number of steps done.
    """
    first, last = share(len(world.bodies.number), worker.thread, worker.threads)
    mine = noted[worker.thread]
    room = room_of_thread(rooms, worker.thread)
    done, pending = 0, mine[PENDING] != 0.0
    # Half a kick (v: t -> t + dt/2), the drift (r: t -> t + dt), forces at t + dt, half a kick.
    # Each thread writes its own spheres; the barriers are before and after forces, which read those
    # of others. All threads find the same longest displacement, so they return for new lists
    # together. Then forces are pending: the call with new lists begins with them.
    while done < steps:
        now = Counter(counter.seed, counter.step + np.uint64(done))
        if not pending:
            farthest = 0.0
            for i in range(first, last):
                kick(law, motion, world.bodies, i)
                drift(motion, now, world.bodies, world.box, i)
                foresee(law, motion, world.bodies, i)
                farthest = max(farthest, moved(world.bodies, world.box, world.lists, i))
            mine[FARTHEST] = farthest
            barrier(worker)
            skin = world.lists.skin - law.ahead
            if outdated(noted, FARTHEST, worker.threads, 0.0, skin):
                pending = True
                break
        time = motion.step * float(now.step + np.uint64(1))
        clear(law, world.bodies, first, last)
        act(law, (first, last), time, motion.step, world, mine, room)
        barrier(worker)
        for i in range(first, last):
            kick(law, motion, world.bodies, i)
        pending = False
        done += 1
    mine[DONE], mine[PENDING] = float(done), 1.0 if pending else 0.0


@kernel
def find_forces(worker, time, law, world, noted, rooms):
    """The forces on spheres at the start; springs of contacts do not change."""
    first, last = share(len(world.bodies.number), worker.thread, worker.threads)
    clear(law, world.bodies, first, last)
    for i in range(len(world.bodies.number)):
        for k in range(3):
            world.bodies.seen[i, k] = world.bodies.velocity[i, k]
    room = room_of_thread(rooms, worker.thread)
    act(law, (first, last), time, 0.0, world, noted[worker.thread], room)


@scalar
def clear(law, bodies, first, last):
    """Set forces to zero, for laws that add to them from both sides of a contact."""
    if turns(law):
        bodies.force[first:last] = 0
        bodies.torque[first:last] = 0


@scalar
def kick(law, motion, bodies, i):
    """Change velocity and angular velocity by half a step of forces and torques."""
    half = 0.5 * motion.step
    per_mass = bodies.velocity[i, INVERSE] * law.quantum
    for k in range(3):
        acceleration = float(bodies.force[i, k]) * per_mass + motion.gravity[k]
        bodies.velocity[i, k] += half * acceleration
    if turns(law):
        per_inertia = bodies.spin[i, INVERSE] * law.quantum
        for k in range(3):
            bodies.spin[i, k] += half * (float(bodies.torque[i, k]) * per_inertia)


@scalar
def foresee(law, motion, bodies, i):
    """Estimate the velocity at the end of the step, with the forces of its start."""
    if turns(law):
        per_mass = bodies.velocity[i, INVERSE] * law.quantum
        for k in range(3):
            acceleration = float(bodies.force[i, k]) * per_mass + motion.gravity[k]
            bodies.seen[i, k] = bodies.velocity[i, k] + 0.5 * motion.step * acceleration


@scalar
def drift(motion, counter, bodies, box, i):
    """Move sphere i by a step, with the bath in the middle of it."""
    if motion.decay == 1.0:
        for k in range(3):
            fly(bodies, box, i, k, motion.step)
        return
    for k in range(3):
        fly(bodies, box, i, k, 0.5 * motion.step)
    bathe(motion, counter, bodies, i)
    for k in range(3):
        fly(bodies, box, i, k, 0.5 * motion.step)


@scalar
def bathe(motion, counter, bodies, i):
    """The exact solution of friction and noise over a step."""
    number = bodies.number[i]
    noise = math.sqrt((1.0 - motion.decay * motion.decay) * motion.kT)
    a, b, c, d = words(counter, BATH, number, 0)
    xi = normals((0.0, 0.0, 0.0), a, b, c, d)
    spread = noise * math.sqrt(bodies.velocity[i, INVERSE])
    for k in range(3):
        v = motion.decay * bodies.velocity[i, k] + spread * xi[k]
        bodies.velocity[i, k] = motion.axes[k] * v
    if motion.turns[2] != 0.0:
        a, b, c, d = words(counter, BATH_OF_SPINS, number, 0)
        xi = normals((0.0, 0.0, 0.0), a, b, c, d)
        spread = noise * math.sqrt(bodies.spin[i, INVERSE])
        for k in range(3):
            w = motion.decay * bodies.spin[i, k] + spread * xi[2 - k]
            bodies.spin[i, k] = motion.turns[k] * w


@scalar
def fly(bodies, box, i, k, time):
    """Move sphere i along axis k, and back into the box."""
    x = bodies.place[i, k] + time * bodies.velocity[i, k]
    if box.inverse[k] != 0.0:
        if x < 0.0:
            x += box.size[k]
            if x < box.size[k]:
                bodies.images[i, k] -= np.int32(1)
            else:  # it was so little below 0 that it has not left
                x = 0.0
        elif x >= box.size[k]:
            x -= box.size[k]
            bodies.images[i, k] += np.int32(1)
    bodies.place[i, k] = x


@scalar
def moved(bodies, box, lists, i):
    """Square of the displacement since lists were made; infinite if it is not a number."""
    gone = added_scaled(row(bodies.place, i), -1.0, row(lists.made_at, i))
    x, y, z = nearest_image(box, gone)
    square = x * x + y * y + z * z
    return square if square >= 0.0 else np.inf
