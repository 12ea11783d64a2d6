"""Hits of particles on bodies: all of a step on one body are one reflection.

A body moves in a straight line and turns uniformly throughout a timestep. Particles are reflected
about the mean of its velocities before and after the step, which follows from the sums over all
hits (`linear.solve_reflection`): energy and momentum are exact whatever the number of hits. Sums
are whole numbers, so their bits depend on no order. Particles that hit again do so in a next round,
with the velocity that the body has then.
"""

import math
from typing import NamedTuple

import numpy as np

from mesokit.case.box import fold
from mesokit.geometry.protocol import (
    Chance,
    facing,
    first_hit,
    happens,
    homed,
    lever,
    rebound,
    surface_of,
    unmet,
)
from mesokit.kernels.part import stage
from mesokit.loops.layout import LANES, share, strip_at
from mesokit.loops.threads import barrier
from mesokit.method.mpcd.engine.bodies import state
from mesokit.method.mpcd.engine.bodies.linear import solve_reflection, unlevered
from mesokit.method.mpcd.engine.bodies.motion import end_turn
from mesokit.method.mpcd.engine.bodies.near import (
    bodies_near,
    body_near,
    box_at_start,
)
from mesokit.method.mpcd.engine.bodies.put_back import put_all_back
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
    IS_BALL,
    IS_SLIP,
    LANE,
    LEFT,
    MEAN_SPIN,
    MEAN_VELOCITY,
    NO_BODY,
    NORMAL,
    PLACE,
    PUT_BACK,
    RADIUS,
    ROOT,
    SECOND_HITS,
    SHEAR,
    SPIN,
    START,
    START_V,
    SUMS,
    THREE,
    TIME,
    TORQUE,
    TURN,
    VELOCITY,
    R,
    V,
    after_turn,
    image_near,
    load,
    of_kind,
    place_at,
    rigid_velocity,
    rotated,
    rotated_back,
    spin_of,
    store,
    with_shear,
)
from mesokit.method.mpcd.engine.bodies.stress import AFTER, add_impulse, add_near_flux
from mesokit.method.mpcd.engine.bodies.swim import squirming
from mesokit.method.mpcd.engine.cpu.bounce import fly_among, take_sum
from mesokit.method.mpcd.engine.cpu.groups import MEASURE_STRESS, STREAM
from mesokit.method.mpcd.engine.cpu.physics import field_of, has_solid, momentum_scale
from mesokit.method.mpcd.engine.cpu.strips.rows import lane_mass
from mesokit.method.mpcd.engine.embedded.near import note
from mesokit.method.mpcd.engine.where import where
from mesokit.method.mpcd.field.none import Zero
from mesokit.method.mpcd.streaming import fall, halfway, vector
from mesokit.scalar.fixed_point import (
    add_integers,
    added_quanta,
    floats,
    integers,
    opposite,
    quanta,
)
from mesokit.scalar.intrinsics import with_item
from mesokit.scalar.jit import by_type, scalar, seldom
from mesokit.scalar.vector import added, added_scaled, dot, outer, scaled

ROUNDS = 8  # of hits of a particle in a timestep; then it flies on freely
ON_SURFACE = 1e-11  # cells: a flight that comes so close has arrived
SHORT_STEP = 1e-3  # cells: the least step of a search
MOST_TRIES = 100
PROJECTIONS = 8
BLOCK = 64  # numbers of hits that particles of walls take in a round
OUTSIDE = 1e-12  # cells: how far from a surface particles are put
FREE_STEP, FREE_TRIES = 0.05, 400


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
        total = 0
        for t in range(worker.threads):
            total += bodies.counters[t, HITS]
        if total == 0:
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
            for i in range(low, high):
                take_impulses(worker, physics, bodies, i)
            barrier(worker)
    for i in range(low, high):
        finish_body(bodies, i, now, physics)
    barrier(worker)
    finish_flights(worker, now, physics, fluid, bodies)
    if now.flags & MEASURE_STRESS:
        add_near_flux(thread, physics, now, fluid, bodies)
    put_all_back(worker, now, physics, fluid, bodies)
    barrier(worker)


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
    m, number = mass_of_lane(physics, fluid.particles, lane), fluid.particles.ident[lane]
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


@scalar
def mass_of_lane(physics, particles, lane):
    """Mass of the particle in a lane, counted through the strips."""
    strip = particles.data[strip_at(lane // LANES, particles.rows)]
    return lane_mass(physics.masses, strip, lane % LANES, 2 * len(physics.zero))


class Flight(NamedTuple):
    """A flight in search of bodies: the box at the beginning of the step, the cell whose list is
    tried, the body that it has left, where the step began, the time since then, and the
    acceleration."""

    box: tuple
    cell: int
    left: int
    start: tuple
    begin: float
    a: tuple


class RandomHits(NamedTuple):
    """What random reflections by walls depend on: the step, the particle, its mass, and the first
    number of a hit."""

    counter: tuple
    number: int
    mass: float
    first: int


@by_type
def to_body(physics, bodies, flight, draws, r, v, impulse):
    """Time in the step, body, place and velocity of the next hit; NO_BODY at the end of the step.

    Walls reflect the particle on its way.
    """
    return _to_body_among_walls if has_solid(physics) else _to_body


def _to_body(physics, bodies, flight, draws, r, v, impulse):
    a, left = flight.a, physics.timestep - flight.begin
    time, i = first_body(bodies, flight, r, v, a, flight.begin, left)
    if i == NO_BODY:
        r, v = fall(r, v, of_field(physics, a), left)
        return physics.timestep, np.int64(NO_BODY), r, v
    r, v = fall(r, v, of_field(physics, a), time)
    return flight.begin + time, np.int64(i), r, v


@by_type
def of_field(physics, a):
    """The acceleration as the flight takes it: () without a field, for the same bits."""
    if field_of(physics, "field").instance_class is Zero:
        return lambda physics, a: ()
    return lambda physics, a: a


def _to_body_among_walls(physics, bodies, flight, draws, r, v, impulse):
    solid, begin, end = physics.solid, flight.begin, physics.timestep
    a, counter, number, m = flight.a, draws.counter, draws.number, draws.mass
    time, i = first_body(bodies, flight, r, v, a, begin, end - begin)
    if begin == 0.0 and i == NO_BODY:  # as a particle far from all bodies
        r, v = fly_among(physics, counter, (number, m), r, v, impulse)
        return end, np.int64(NO_BODY), r, v
    start = homed(solid, r)
    away, x, contact = added_scaled(r, -1.0, start), start, unmet(solid)
    # Wall after wall, until a body comes first or nothing is met any more.
    for k in range(BLOCK):
        until = time if i != NO_BODY else end - begin
        hit, contact = first_hit(solid, x, v, a, until, contact)
        if hit > until:
            break
        x, v = fall(x, v, a, hit)
        begin += hit
        if happens(solid, contact):
            chance = Chance(counter.seed, counter.step, number, draws.first + k, physics.kT / m)
            x, after = rebound(solid, contact, x, v, chance)
            lost = scaled(m, added_scaled(v, -1.0, after))
            given = lost + outer(lever(solid, contact, x), lost)
            take_sum(impulse, surface_of(solid, contact), given, momentum_scale(physics))
            v = after
            time, i = first_body(bodies, flight, added(x, away), v, a, begin, end - begin)
        elif i != NO_BODY:
            time -= hit
        at_home = homed(solid, x)
        away, x = added(away, added_scaled(x, -1.0, at_home)), at_home
    x, v = fall(x, v, a, time if i != NO_BODY else end - begin)
    return (begin + time if i != NO_BODY else end), np.int64(i), added(x, away), v


@seldom
def first_body(bodies, flight, r, v, a, begin, time):
    """The time until a flight from r meets a body, and which; NO_BODY if it meets none."""
    soonest, which = time, np.int64(NO_BODY)
    for n in range(bodies_near(bodies, flight.cell)):
        i = body_near(bodies, flight.cell, n)
        if i != flight.left:
            x, speed = image_near(flight.box, load(bodies.rows, i, PLACE, r), flight.start)
            y = added_scaled(r, -1.0, place_at(bodies, i, x, speed, begin))
            u = with_shear(load(bodies.rows, i, MEAN_VELOCITY, r), speed)
            w = added_scaled(v, -1.0, u)
            if of_kind(bodies, i, IS_BALL) > 0.5:
                t = time_to_ball(of_kind(bodies, i, RADIUS), y, w, a, soonest)
            else:
                t = time_to_shape(bodies, i, y, w, a, begin, soonest)
            if t < soonest:
                soonest, which = t, i
    return soonest, which


@seldom
def time_to_ball(radius, y, w, a, time):
    """When a flight from y with velocity w relative to its centre meets a ball; more than `time` if
    it does not."""
    late, t = 2.0 * time + 1.0, 0.0
    if dot(a, a) == 0.0:
        approach, c = dot(y, w), dot(y, y) - radius * radius
        square = approach * approach - dot(w, w) * c
        if approach >= 0.0 or square < 0.0:
            return late
        return max(c / (math.sqrt(square) - approach), 0.0)
    # Bent flights by tangent planes, as for fixed solids: no step enters the ball.
    for _ in range(MOST_TRIES):
        size = math.sqrt(dot(y, y))
        normal, c = scaled(1.0 / size, y), size - radius
        down = dot(normal, w)
        if c <= ON_SURFACE and down < 0.0:
            return t
        t += time_of_fall(max(c, 0.0), down, dot(normal, a), time - t)
        if t > time:
            return late
        step = time_of_fall(max(c, 0.0), down, dot(normal, a), time)
        y = added_scaled(added_scaled(y, step, w), 0.5 * step * step, a)
        w = added_scaled(w, step, a)
    return t


@scalar
def time_of_fall(height, v, a, time):
    """When a particle at a height above a plane reaches it; more than `time` if it does not."""
    square = v * v - 2.0 * a * height
    down, late = math.sqrt(max(square, 0.0)), 2.0 * time + 1.0
    if square < 0.0 or down == 0.0:
        return late
    if v < 0.0:
        return 2.0 * height / (down - v)
    return -(v + down) / a if a < 0.0 else late


@scalar
def clearance_of_flight(bodies, i, y, w, a, begin, t):
    """Distance from body i of a place on a flight, as the body has rotated by then."""
    x = added_scaled(added_scaled(y, t, w), 0.5 * t * t, a)
    spin = load(bodies.rows, i, MEAN_SPIN, THREE)
    q = after_turn(load(bodies.rows, i, TURN, FOUR), spin, begin + t)
    c, _ = state.clearance(bodies, bodies.kind[i], rotated_back(q, x))
    return c


@seldom
def time_to_shape(bodies, i, y, w, a, begin, time):
    """The same for any shape, which turns while it moves."""
    late, t = 2.0 * time + 1.0, 0.0
    spin, pull = load(bodies.rows, i, MEAN_SPIN, THREE), math.sqrt(dot(a, a))
    fast = math.sqrt(dot(w, w)) + pull * time
    path = fast * time
    c = clearance_of_flight(bodies, i, y, w, a, begin, 0.0)
    fast += math.sqrt(dot(spin, spin)) * (of_kind(bodies, i, RADIUS) + max(c, 0.0) + path)
    if c > fast * time:
        return late
    # No surface comes nearer faster than `fast`, so steps of the distance over it are safe. Near
    # the surface they are short; the first place inside brackets the hit.
    while t < time:
        step = min(t + max(c, SHORT_STEP) / (fast + 1e-300), time)
        above, c = c, clearance_of_flight(bodies, i, y, w, a, begin, step)
        if c < 0.0:
            if above <= ON_SURFACE and t == 0.0:  # it starts on the surface
                return 0.0 if descends(bodies, i, y, w, spin, begin) else late
            return time_of_crossing(bodies, i, (y, w, a), begin, (t, step), (max(above, 0.0), c))
        t = step
    return late


@scalar
def descends(bodies, i, y, w, spin, begin):
    """Whether a flight that starts on the surface of a body goes into it."""
    normal = normal_at(bodies, i, y, begin)
    return dot(normal, added_scaled(w, -1.0, state.swept(spin, y))) < 0.0


@seldom
def time_of_crossing(bodies, i, flight, begin, times, distances):
    """The last time found outside, when a flight crosses a surface between two times, at which its
    distances from it are positive and negative."""
    (y, w, a), (outside, inside), (above, below) = flight, times, distances
    # False position with half weights for the end that stays (Illinois), a bisection now and then.
    for n in range(MOST_TRIES):
        part = above / (above - below) if n % 8 < 7 else 0.5
        middle = outside + part * (inside - outside)
        if not outside < middle < inside:
            middle = 0.5 * (outside + inside)
            if not outside < middle < inside:
                break
        c = clearance_of_flight(bodies, i, y, w, a, begin, middle)
        if c < 0.0:
            inside, below, above = middle, c, 0.5 * above
        else:
            outside, above, below = middle, c, 0.5 * below
            if c < ON_SURFACE:
                break
    return outside


@seldom
def normal_at(bodies, i, s, time):
    """Unit normal out of body i at an arm, a time after the beginning of the step."""
    if of_kind(bodies, i, IS_BALL) > 0.5:
        return scaled(1.0 / math.sqrt(dot(s, s)), s)
    q = after_turn(load(bodies.rows, i, TURN, FOUR), load(bodies.rows, i, MEAN_SPIN, THREE), time)
    y = rotated_back(q, s)
    _, part = state.clearance(bodies, bodies.kind[i], y)
    return rotated(q, state.normal_of(bodies, part, y))


# --- the reflection -------------------------------------------------------------------------------


@seldom
def solve_body(worker, physics, bodies, i, scales, trial):
    """Solve for the change of the velocity of body i; the first of all threads' sums has the total.

    In a trial the mean motion of this step gets half of the change.
    """
    total, work, d = bodies.sums[0, i], bodies.work[worker.thread], len(physics.zero)
    for t in range(1, worker.threads):
        for k in range(SUMS):
            total[k] += bodies.sums[t, i, k]
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
    m, scale = mass_of_lane(physics, fluid.particles, lane), momentum_scale(physics)
    units = added_quanta(scaled(-2.0 * m, g), scale, integers(s))
    v = added_scaled(v, 1.0 / (scale * m), floats(units))
    store(values, j, V, v)
    p = scaled(1.0 / scale, floats(units))
    if now.flags & MEASURE_STRESS:
        add_impulse(thread, physics, bodies, AFTER, s, p)
    turn = scaled(1.0 / bodies.lever, outer(s, p))
    taken = bodies.taken[thread, i]
    add_integers(taken, opposite(units))
    add_integers(taken[len(s) :], opposite(added_quanta(turn, scale, integers(turn))))
    # A flight that does not lead away from the moving surface ends on it: it is put there later.
    mean = load(bodies.rows, i, MEAN_VELOCITY, s), load(bodies.rows, i, MEAN_SPIN, THREE)
    rise = dot(normal, added_scaled(v, -1.0, rigid_velocity(mean[0], mean[1], s, speed)))
    bodies.numbers[thread, j, LEFT] = NO_BODY if rise > 0.0 else i


@seldom
def take_impulses(worker, physics, bodies, i):
    """Give body i the impulses that particles gave it, in whole numbers, and forget these."""
    d, unit = len(physics.zero), 1.0 / momentum_scale(physics)
    turns = 1 if d == 2 else 3
    total = bodies.taken[0, i]
    for t in range(1, worker.threads):
        for k in range(d + turns):
            total[k] += bodies.taken[t, i, k]
    give_impulse(bodies, i, total, d, unit, 1.0 / physics.timestep)
    for t in range(worker.threads):
        for k in range(d + turns):
            bodies.taken[t, i, k] = 0


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
        if bodies.numbers[thread, j, GOING] != 0:
            v = load(values, j, V, physics.zero)
            r = added_scaled(r, physics.timestep - values[j, TIME], v)
        cell = bodies.numbers[thread, j, CELL]
        r, moved, free = put_outside(physics, now.box, bodies, cell, r)
        here[PUT_BACK] += np.int64(moved)
        if not free:
            note(bodies.faults[thread], now.counter.step, CAUGHT, fluid.particles.ident[lane] + 1)
        store(values, j, R, r)


@seldom
def put_outside(physics, box, bodies, cell, r):
    """The nearest place outside all bodies and walls, whether that is another one, and whether
    there is one."""
    start, moved = r, False
    # In turn out of the body and of the wall in which it is deepest. Where they touch that may go
    # on for ever, so places around are tried then, nearer ones first.
    for _ in range(PROJECTIONS):
        depth, out = deepest(box, bodies, cell, r)
        wall, away = in_wall(physics, r)
        if depth >= 0.0 and wall >= 0.0:
            return r, moved, True
        moved = True
        if depth < 0.0:
            r = added_scaled(r, OUTSIDE - depth, out)
        else:
            r = added_scaled(r, OUTSIDE - wall, away)
    for n in range(FREE_TRIES):
        r, rest = start, n % 27
        for k in range(len(r)):
            r = with_item(r, k, r[k] + FREE_STEP * (1 + n // 27) * (rest % 3 - 1.0))
            rest //= 3
        depth, _ = deepest(box, bodies, cell, r)
        wall, _ = in_wall(physics, r)
        if depth >= 0.0 and wall >= 0.0:
            return r, True, True
    return start, True, False


@seldom
def deepest(box, bodies, cell, r):
    """The least distance of r from the bodies on the list of a cell, 0 if it is in none, and the
    normal of that body."""
    least, out = 0.0, r
    for n in range(bodies_near(bodies, cell)):
        i = body_near(bodies, cell, n)
        x, _ = image_near(box, load(bodies.rows, i, PLACE, r), r)
        s = added_scaled(r, -1.0, x)
        radius = of_kind(bodies, i, RADIUS)
        if dot(s, s) < radius * radius:
            if of_kind(bodies, i, IS_BALL) > 0.5:
                c = math.sqrt(dot(s, s)) - radius
            else:
                y = rotated_back(load(bodies.rows, i, TURN, FOUR), s)
                c, _ = state.clearance(bodies, bodies.kind[i], y)
            if c < least:
                least, out = c, normal_at(bodies, i, s, 0.0)
    return least, out


@where("(0.0, r)", physics=has_solid)
def in_wall(physics, r):
    """The distance of r from walls where it is in one, else 0, and the normal out of them."""
    x = homed(physics.solid, r)
    distance, normal, _, _ = facing(physics.solid, 0.0, x)
    return min(distance, 0.0), normal
