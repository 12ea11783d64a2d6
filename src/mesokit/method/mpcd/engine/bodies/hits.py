"""Hits of particles on bodies: all of a step on one body are one reflection.

A body moves in a straight line and turns uniformly throughout a timestep. Particles are reflected
about the mean of its velocities before and after the step, which follows from the sums over all
hits (`linear.solve_reflection`): energy and momentum are exact whatever the number of hits. Sums
are whole numbers, so their bits depend on no order. Particles that hit again do so in a next round,
with the velocity that the body has then.
"""

import numpy as np

from mesokit.case.box import fold
from mesokit.kernels.part import stage
from mesokit.loops.layout import share
from mesokit.loops.threads import barrier
from mesokit.method.mpcd.engine.bodies.linear import solve_reflection, unlevered
from mesokit.method.mpcd.engine.bodies.motion import end_turn
from mesokit.method.mpcd.engine.bodies.near import box_at_start, lengthen_path
from mesokit.method.mpcd.engine.bodies.outside import put_outside
from mesokit.method.mpcd.engine.bodies.search import BLOCK, Flight, RandomHits, normal_at, to_body
from mesokit.method.mpcd.engine.bodies.state import (
    ANGLE,
    ARM,
    BODY,
    BOXES,
    CAUGHT,
    CELL,
    CHANGE,
    COUNT,
    END_TURN,
    FORCE,
    FOUR,
    GOING,
    HITS,
    IS_SLIP,
    LANE,
    LEFT,
    MEAN_SPIN,
    MEAN_VELOCITY,
    NO_BODY,
    NORMAL,
    PLACE,
    PUT_BACK,
    ROOT,
    SECOND_HITS,
    SHEAR,
    SPIN,
    START,
    START_V,
    STILL_HITTING,
    THREE,
    TIME,
    TORQUE,
    TURN,
    VELOCITY,
    R,
    V,
    add_threads,
    image_near,
    load,
    of_kind,
    place_at,
    rigid_velocity,
    spin_of,
    store,
)
from mesokit.method.mpcd.engine.bodies.stress import AFTER, add_impulse, add_near_flux
from mesokit.method.mpcd.engine.bodies.swim import squirming
from mesokit.method.mpcd.engine.cpu.groups import MEASURE_STRESS, STREAM
from mesokit.method.mpcd.engine.cpu.physics import momentum_scale
from mesokit.method.mpcd.engine.cpu.strips.one import mass_in_lane
from mesokit.method.mpcd.engine.domains.messages.bodies import add_others, hits_elsewhere
from mesokit.method.mpcd.engine.embedded.near import note
from mesokit.method.mpcd.streaming import halfway, vector
from mesokit.scalar.fixed_point import (
    add_integers,
    added_quanta,
    floats,
    integers,
    opposite,
    quanta,
)
from mesokit.scalar.jit import by_type, scalar, seldom
from mesokit.scalar.vector import added, added_scaled, dot, outer, scaled

ROUNDS = 8  # of hits of a particle in a timestep; then it flies on freely


@stage
def reflect_all(worker, now, physics, fluid, bodies):
    """Flight of the particles near bodies, t -> t + dt, and of the bodies: hits and impulses."""
    if not now.flags & STREAM:
        return
    thread, here = worker.thread, bodies.counters[worker.thread]
    mine = here[COUNT]
    low, high = share(len(bodies.rows), thread, worker.threads)
    scales = physics_scales(bodies, physics)
    bodies.sums[thread] = 0
    bodies.taken[thread] = 0
    # Round by round: each thread finds the next hit of its particles and adds it to its own sums;
    # after the gate each body is solved by one thread; after the next one particles are reflected.
    # With `twice` the first round only finds the mean motion with which hits are found once more.
    for n in range(ROUNDS + bodies.twice):
        trial = n < bodies.twice
        hits = 0
        for j in range(mine):
            if bodies.numbers[thread, j, GOING] != 0:
                hits += find_hit(worker, now, physics, fluid, bodies, j, n, trial)
        here[HITS] = hits
        barrier(worker)
        add_others(worker, bodies, bodies.sums, hits_of_threads(worker, bodies))
        if hits_of_threads(worker, bodies) + hits_elsewhere(bodies) == 0:
            break
        for i in range(low, high):
            solve_body(worker, physics, bodies, i, scales, trial)
        barrier(worker)
        for j in range(mine):
            if trial:
                begin_again(bodies, thread, j)
            elif bodies.numbers[thread, j, GOING] != 0:
                reflect(worker, now, physics, fluid, bodies, j)
                here[SECOND_HITS] += np.int64(n > bodies.twice)
        bodies.sums[thread] = 0
        barrier(worker)
        if not trial:
            add_others(worker, bodies, bodies.taken, 0)
            for i in range(low, high):
                take_impulses(physics, bodies, i)
            barrier(worker)
    for i in range(low, high):
        lengthen_path(bodies, i, now, physics.timestep)
        finish_body(bodies, i, now, physics)
    barrier(worker)
    finish_flights(worker, now, physics, fluid, bodies)
    if now.flags & MEASURE_STRESS:
        add_near_flux(thread, physics, now, fluid, bodies)


@scalar
def hits_of_threads(worker, bodies):
    """Hits of all threads in this round."""
    total = 0
    for t in range(worker.threads):
        total += bodies.counters[t, HITS]
    return total


@scalar
def physics_scales(bodies, physics):
    """Whole numbers per unit of mass and of momentum in the sums of a body."""
    return bodies.mass_scale, momentum_scale(physics)


@scalar
def begin_again(bodies, thread, j):
    """Forget the trial flight of a particle."""
    bodies.numbers[thread, j, GOING] = 1
    bodies.numbers[thread, j, BODY] = NO_BODY
    bodies.values[thread, j, TIME] = 0.0


# --- the next hit ---------------------------------------------------------------------------------


@seldom
def find_hit(worker, now, physics, fluid, bodies, j, n, trial):
    """Fly a particle to its next hit on a body, or to the end of the timestep; 1 if it hits.

    What the hit adds to the sums of the body is added to those of this thread.
    """
    thread, values, numbers = worker.thread, bodies.values[worker.thread], bodies.numbers
    r, v = load(values, j, START, physics.zero), load(values, j, START_V, physics.zero)
    begin, where_from = values[j, TIME], r
    a = vector(halfway(physics.field, r, v, physics.timestep), r)
    if begin > 0.0 or numbers[thread, j, BODY] != NO_BODY:
        r, v = load(values, j, R, physics.zero), load(values, j, V, physics.zero)
    box, cell, left = box_at_start(now, physics), numbers[thread, j, CELL], numbers[thread, j, LEFT]
    lane = numbers[thread, j, LANE]
    impulse = bodies.waste[thread] if trial else fluid.taken.impulse[thread]
    m, number = mass_in_lane(physics, fluid.particles, lane), fluid.particles.ident[lane]
    flight = Flight(box, cell, left, where_from, begin, a)
    draws = RandomHits(now.counter, number, m, n * BLOCK)
    time, i, r, v = to_body(physics, bodies, flight, draws, r, v, impulse)
    values[j, TIME] = time
    numbers[thread, j, BODY] = i
    if i == NO_BODY:
        numbers[thread, j, GOING] = 0
        store(values, j, R, r)
        store(values, j, V, v)
        return 0
    x, speed = image_near(box, load(bodies.rows, i, PLACE, r), where_from)
    s = added_scaled(r, -1.0, place_at(bodies, i, x, speed, time))
    normal = normal_at(bodies, i, s, time)
    store(values, j, R, r)
    store(values, j, V, v)
    store(values, j, ARM, s)
    store(values, j, NORMAL, normal)
    values[j, SHEAR] = speed
    u = wall_velocity(bodies, i, s, normal, speed)
    add_hit(bodies, bodies.sums[thread, i], i, m, s, normal, added_scaled(v, -1.0, u), physics)
    return 1


@seldom
def wall_velocity(bodies, i, s, normal, speed):
    """Velocity of the surface of body i at an arm: rigid motion, image and squirming."""
    v, spin = load(bodies.rows, i, VELOCITY, s), load(bodies.rows, i, SPIN, THREE)
    return added(rigid_velocity(v, spin, s, speed), squirming(bodies, i, s, normal))


@seldom
def add_hit(bodies, sums, i, m, s, normal, g, physics):
    """Add m B^T B and m B^T g of a hit at an arm s with a relative velocity g."""
    by_mass, by_momentum = physics_scales(bodies, physics)
    arm = scaled(1.0 / bodies.lever, s)
    if of_kind(bodies, i, IS_SLIP) > 0.5:
        c = normal + outer(arm, normal)
        first = 0
        for a in range(len(c)):
            for b in range(a, len(c)):
                sums[first] += quanta(m * c[a] * c[b], by_mass)
                first += 1
        p = scaled(m * dot(normal, g), normal)
        both = p + outer(arm, p)
        add_integers(sums[first:], added_quanta(both, by_momentum, integers(both)))
    else:
        p = scaled(m, g)
        found = moments_at(m, arm) + p + outer(arm, p)
        add_moments(sums, found, s, (by_mass, by_momentum))


@by_type
def moments_at(m, arm):
    """m, m s and m s s^T (in 2D m s^2)."""
    if len(arm) == 2:
        return lambda m, arm: (
            m,
            m * arm[0],
            m * arm[1],
            m * (arm[0] * arm[0] + arm[1] * arm[1]),
        )

    def spatial(m, arm):
        x, y, z = arm
        squares = (m * x * x, m * y * y, m * z * z, m * x * y, m * x * z, m * y * z)
        return (m, m * x, m * y, m * z) + squares

    return spatial


@by_type
def no_moments(pattern):
    """The moments and momenta of nothing."""
    nothing = (0.0,) * (7 if len(pattern) == 2 else 16)
    return lambda pattern: nothing


@by_type
def add_moments(sums, found, pattern, scales):
    """Add moments and momenta to the sums of a body, in whole numbers."""
    moments = 4 if len(pattern) == 2 else 10

    def add(sums, found, pattern, scales):
        some, rest = found[:moments], found[moments:]
        add_integers(sums, added_quanta(some, scales[0], integers(some)))
        add_integers(sums[moments:], added_quanta(rest, scales[1], integers(rest)))

    return add


# --- the reflection -------------------------------------------------------------------------------


@seldom
def solve_body(worker, physics, bodies, i, scales, trial):
    """Solve for the change of the velocity of body i.

    In a trial the mean motion of this step gets half of the change.
    """
    add_threads(bodies.sums, i)
    total, work, d = bodies.sums[0, i], bodies.work[worker.thread], len(physics.zero)
    dv, dw = THREE, THREE
    if total[0] != 0:  # a mass, which every hit adds to
        solve_reflection(bodies, i, total, d, scales, work)
        dv, dw = unlevered(bodies, d, work)
    store(bodies.rows, i, CHANGE, dv)
    store(bodies.rows, i, CHANGE + 3, dw)
    if trial:
        u, w = load(bodies.rows, i, MEAN_VELOCITY, THREE), load(bodies.rows, i, MEAN_SPIN, THREE)
        store(bodies.rows, i, MEAN_VELOCITY, added_scaled(u, 0.5, dv))
        store(bodies.rows, i, MEAN_SPIN, added_scaled(w, 0.5, dw))
        end_turn(bodies, i, physics.timestep)


@seldom
def reflect(worker, now, physics, fluid, bodies, j):
    """Velocity of a particle after its hit; the body takes the opposite of its impulse."""
    thread, values = worker.thread, bodies.values[worker.thread]
    i, lane = bodies.numbers[thread, j, BODY], bodies.numbers[thread, j, LANE]
    v, s = load(values, j, V, physics.zero), load(values, j, ARM, physics.zero)
    normal, speed = load(values, j, NORMAL, physics.zero), values[j, SHEAR]
    u = wall_velocity(bodies, i, s, normal, speed)
    dv, dw = load(bodies.rows, i, CHANGE, s), load(bodies.rows, i, CHANGE + 3, THREE)
    u = added_scaled(u, 0.5, rigid_velocity(dv, dw, s, 0.0))
    g = added_scaled(v, -1.0, u)
    if of_kind(bodies, i, IS_SLIP) > 0.5:
        g = scaled(dot(normal, g), normal)
    m, scale = mass_in_lane(physics, fluid.particles, lane), momentum_scale(physics)
    units = added_quanta(scaled(-2.0 * m, g), scale, integers(s))
    v = added_scaled(v, 1.0 / (scale * m), floats(units))
    store(values, j, V, v)
    give_opposite(thread, now, physics, bodies, i, s, units)
    # A flight that does not lead away from the moving surface ends on it: it is put there later.
    mean = load(bodies.rows, i, MEAN_VELOCITY, s), load(bodies.rows, i, MEAN_SPIN, THREE)
    rise = dot(normal, added_scaled(v, -1.0, rigid_velocity(mean[0], mean[1], s, speed)))
    bodies.numbers[thread, j, LEFT] = NO_BODY if rise > 0.0 else i


@scalar
def give_opposite(thread, now, physics, bodies, i, s, units):
    """Note the opposite of the impulse on a particle at an arm, in quanta, for body i to take."""
    scale, taken = momentum_scale(physics), bodies.taken[thread, i]
    p = scaled(1.0 / scale, floats(units))
    if now.flags & MEASURE_STRESS:
        add_impulse(thread, physics, bodies, AFTER, s, p)
    turn = scaled(1.0 / bodies.lever, outer(s, p))
    add_integers(taken, opposite(units))
    add_integers(taken[len(s) :], opposite(added_quanta(turn, scale, integers(turn))))


@seldom
def take_impulses(physics, bodies, i):
    """Give body i the impulses that particles gave it, in whole numbers, and forget these."""
    d, unit = len(physics.zero), 1.0 / momentum_scale(physics)
    add_threads(bodies.taken, i)
    give_impulse(bodies, i, bodies.taken[0, i], d, unit, 1.0 / physics.timestep)
    bodies.taken[:, i] = 0


@seldom
def give_impulse(bodies, i, total, d, unit, per_time):
    """Change velocity and angular velocity of body i by an impulse in whole numbers."""
    rows, kind = bodies.rows, bodies.kind[i]
    for k in range(d):
        impulse = unit * float(total[k])
        rows[i, FORCE + k] += per_time * impulse
        root = bodies.kinds[kind, ROOT + k]
        rows[i, VELOCITY + k] += root * root * impulse
    twist = (0.0, 0.0, unit * float(total[2]) * bodies.lever)
    if d == 3:
        size = unit * bodies.lever
        twist = (size * float(total[3]), size * float(total[4]), size * float(total[5]))
    store(rows, i, TORQUE, added_scaled(load(rows, i, TORQUE, THREE), per_time, twist))
    q, spin = load(rows, i, END_TURN, FOUR), load(rows, i, SPIN, THREE)
    store(rows, i, SPIN, added(spin, spin_of(bodies, i, q, twist)))


# --- the end of the flight ------------------------------------------------------------------------


@seldom
def finish_body(bodies, i, now, physics):
    """Place and orientation of body i at the end of the step, and its image in the box."""
    rows, zero, time = bodies.rows, physics.zero, physics.timestep
    u, w = load(rows, i, MEAN_VELOCITY, zero), load(rows, i, MEAN_SPIN, THREE)
    x, v = added_scaled(load(rows, i, PLACE, zero), time, u), load(rows, i, VELOCITY, zero)
    x, v, boxes = fold(now.box, x, v, scaled(0.0, x))
    store(rows, i, PLACE, x)
    store(rows, i, VELOCITY, v)
    store(rows, i, BOXES, added(load(rows, i, BOXES, zero), boxes))
    store(rows, i, TURN, load(rows, i, END_TURN, FOUR))
    store(rows, i, ANGLE, added_scaled(load(rows, i, ANGLE, THREE), time, w))


@scalar
def finish_flights(worker, now, physics, fluid, bodies):
    """Let particles that have hit most often fly on, and put those in a body on its surface."""
    thread, values = worker.thread, bodies.values[worker.thread]
    here = bodies.counters[thread]
    for j in range(here[COUNT]):
        r, lane = load(values, j, R, physics.zero), bodies.numbers[thread, j, LANE]
        if bodies.numbers[thread, j, GOING] != 0:  # it has hit in the last round
            here[STILL_HITTING] += 1
            v = load(values, j, V, physics.zero)
            r = added_scaled(r, physics.timestep - values[j, TIME], v)
        cell = bodies.numbers[thread, j, CELL]
        r, moved, free = put_outside(physics, now.box, bodies, cell, r)
        here[PUT_BACK] += np.int64(moved)
        if not free:
            note(bodies.faults[thread], now.counter.step, CAUGHT, fluid.particles.ident[lane] + 1)
        store(values, j, R, r)
