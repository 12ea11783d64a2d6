"""The rigid motion of bodies in a timestep, and the forces on them that are not of the fluid.

Velocity Verlet in sub-steps moves bodies first. The fluid then sees one straight path and one
uniform turn in the whole timestep.
"""

import math

from mesokit.kernels.part import stage
from mesokit.loops.layout import share
from mesokit.loops.threads import barrier
from mesokit.method.mpcd.engine.bodies.forces import forces_on
from mesokit.method.mpcd.engine.bodies.near import box_at_start, keep_lists, note_paths
from mesokit.method.mpcd.engine.bodies.state import (
    BEGIN,
    BEGIN_TURN,
    END_TURN,
    FORCE,
    FOUR,
    HINGED,
    INERTIA,
    INVERSE_INERTIA,
    IS_BALL,
    MEAN_SPIN,
    MEAN_VELOCITY,
    PLACE,
    ROOT,
    SPIN,
    THREE,
    TORQUE,
    TUMBLES,
    TURN,
    VELOCITY,
    after_turn,
    apply_symmetric,
    load,
    of_kind,
    rotated,
    rotated_back,
    spin_of,
    store,
    turn_by,
)
from mesokit.method.mpcd.engine.bodies.stress import add_gaps
from mesokit.method.mpcd.engine.cpu.groups import MEASURE_STRESS, STREAM
from mesokit.scalar.elementary import sincos_turn
from mesokit.scalar.jit import scalar, seldom
from mesokit.scalar.random import BODY_TUMBLE, unit_open, words
from mesokit.scalar.vector import added, added_scaled, dot, scaled

ROUNDS_OF_TURN = 16


@stage
def begin_step(worker, now, physics, fluid, bodies):
    """Velocities of bodies at t + dt without the fluid, and their motion t -> t + dt.

    Place and orientation stay those at t until the fluid has flown.
    """
    if not now.flags & STREAM:
        return
    n = bodies.substeps
    first, last = share(len(bodies.rows), worker.thread, worker.threads)
    time = physics.timestep / n
    note_beginning(worker, now, physics, bodies)
    # Kick, drift, kick: forces at the beginning of a sub-step are those at the end of the last.
    # Threads meet after each drift, because forces need the places of all bodies.
    for i in range(first, last):
        kick_body(worker, now, physics, fluid, bodies, i, 0.5 * time)
    barrier(worker)
    for k in range(n):
        for i in range(first, last):
            drift_body(bodies, physics, i, time)
        barrier(worker)
        for i in range(first, last):
            kick_body(worker, now, physics, fluid, bodies, i, (0.5 if k == n - 1 else 1.0) * time)
        barrier(worker)
    begin_motions(worker, now, physics, bodies)


@scalar
def note_beginning(worker, now, physics, bodies):
    """Where the bodies of a thread are at t; lists of what is near them."""
    rows = bodies.rows
    first, last = share(len(rows), worker.thread, worker.threads)
    for i in range(first, last):
        store(rows, i, FORCE, THREE)
        store(rows, i, TORQUE, THREE)
        tumble(bodies, now.counter, i, physics.timestep, len(physics.zero) == 2)
        store(rows, i, BEGIN, load(rows, i, PLACE, THREE))
        store(rows, i, BEGIN_TURN, load(rows, i, TURN, FOUR))
    keep_lists(worker, now, physics, bodies)


@scalar
def begin_motions(worker, now, physics, bodies):
    """The motion of each body that the fluid sees, once all sub-steps are done."""
    first, last = share(len(bodies.rows), worker.thread, worker.threads)
    for i in range(first, last):
        begin_motion(bodies, physics, i)
    note_paths(worker, now, physics, bodies)
    barrier(worker)


@seldom
def kick_body(worker, now, physics, fluid, bodies, i, time):
    """Change of the velocities of body i by the forces where it is."""
    rows, kind, zero = bodies.rows, bodies.kind[i], physics.zero
    box, impulse = box_at_start(now, physics), fluid.taken.impulse[worker.thread]
    force, torque, virial = forces_on(bodies, physics, box, i, impulse, time)
    if now.flags & MEASURE_STRESS:
        add_gaps(worker.thread, physics, bodies, scaled(time, virial))
    part = time / physics.timestep
    for k in range(len(zero)):
        root = bodies.kinds[kind, ROOT + k]
        rows[i, VELOCITY + k] += time * root * root * force[k]
        rows[i, FORCE + k] += part * force[k]
    store(rows, i, TORQUE, added_scaled(load(rows, i, TORQUE, THREE), part, torque))
    change = spin_of(bodies, i, load(rows, i, TURN, FOUR), scaled(time, torque))
    store(rows, i, SPIN, added(load(rows, i, SPIN, THREE), change))


@seldom
def drift_body(bodies, physics, i, time):
    """Straight path and free turn of body i."""
    rows, zero = bodies.rows, physics.zero
    v, spin, q = (
        load(rows, i, VELOCITY, zero),
        load(rows, i, SPIN, THREE),
        load(rows, i, TURN, FOUR),
    )
    store(rows, i, PLACE, added_scaled(load(rows, i, PLACE, zero), time, v))
    hinged = of_kind(bodies, i, HINGED) > 0.5
    if of_kind(bodies, i, IS_BALL) > 0.5 or hinged or len(zero) == 2:  # its axis stays
        store(rows, i, TURN, after_turn(q, spin, time))
        store(rows, i, MEAN_SPIN, spin)
    else:
        turn_freely(bodies, i, time)


@seldom
def turn_freely(bodies, i, time):
    """A turn of body i without torque, which keeps its energy and angular momentum to rounding.

    In the body's frame it is the implicit midpoint rule for Euler's equations: angular momentum
    turns about the angular velocity of the mean of its values before and after (Austin,
    Krishnaprasad and Wang 1993). In the box that is one uniform turn of the body.
    """
    rows, kind = bodies.rows, bodies.kind[i]
    q, spin = load(rows, i, TURN, FOUR), load(rows, i, SPIN, THREE)
    before = rotated_back(q, turn_by(bodies, i, q, INERTIA, spin))
    after, half = before, THREE
    # The angle of a step is small, so each round gains a digit or two.
    for _ in range(ROUNDS_OF_TURN):
        mean = scaled(0.5, added(before, after))
        half = scaled(0.5 * time, apply_symmetric(bodies.kinds, kind, INVERSE_INERTIA, mean))
        after = rotated_back(unit_turn(half), before)
    turn = unit_turn(half)
    q_after = joined_turns(q, turn)
    size = math.sqrt(dot(half, half))
    mean_spin = scaled(2.0 / time * angle_over_tangent(size), rotated(q, half))
    store(rows, i, TURN, q_after)
    store(rows, i, MEAN_SPIN, mean_spin)
    own = apply_symmetric(bodies.kinds, kind, INVERSE_INERTIA, after)
    store(rows, i, SPIN, rotated(q_after, own))


@scalar
def unit_turn(half):
    """The turn about a vector by twice the angle of which its length is the tangent."""
    w = 1.0 / math.sqrt(1.0 + dot(half, half))
    return (w, w * half[0], w * half[1], w * half[2])


@scalar
def joined_turns(q, p):
    """First the turn p, then the turn q; a unit quaternion again."""
    w = (
        q[0] * p[0] - q[1] * p[1] - q[2] * p[2] - q[3] * p[3],
        q[0] * p[1] + q[1] * p[0] + q[2] * p[3] - q[3] * p[2],
        q[0] * p[2] + q[2] * p[0] + q[3] * p[1] - q[1] * p[3],
        q[0] * p[3] + q[3] * p[0] + q[1] * p[2] - q[2] * p[1],
    )
    return scaled(1.0 / math.sqrt(dot(w, w)), w)


@scalar
def angle_over_tangent(t):
    """arctan(t) / t: the series for half of the angle, which is small enough."""
    u = 1.0 / (1.0 + math.sqrt(1.0 + t * t))
    z = (t * u) * (t * u)
    series = 1.0 + z * (
        -1.0 / 3.0 + z * (1.0 / 5.0 + z * (-1.0 / 7.0 + z * (1.0 / 9.0 - z / 11.0)))
    )
    return 2.0 * u * series


@seldom
def begin_motion(bodies, physics, i):
    """The one motion that the fluid sees, from the place before to that after all sub-steps."""
    rows, zero, time = bodies.rows, physics.zero, physics.timestep
    path = added_scaled(load(rows, i, PLACE, zero), -1.0, load(rows, i, BEGIN, zero))
    store(rows, i, MEAN_VELOCITY, scaled(1.0 / time, path))
    store(rows, i, END_TURN, load(rows, i, TURN, FOUR))
    if bodies.substeps > 1:
        turn = turn_between(load(rows, i, BEGIN_TURN, FOUR), load(rows, i, TURN, FOUR))
        store(rows, i, MEAN_SPIN, scaled(1.0 / time, turn))
    store(rows, i, PLACE, load(rows, i, BEGIN, zero))
    store(rows, i, TURN, load(rows, i, BEGIN_TURN, FOUR))


@seldom
def end_turn(bodies, i, time):
    """Orientation of body i after its mean motion, which has changed. Its energy is kept: the
    angular velocity stays the same in the body's frame."""
    rows, old = bodies.rows, load(bodies.rows, i, END_TURN, FOUR)
    q = after_turn(load(rows, i, TURN, FOUR), load(rows, i, MEAN_SPIN, THREE), time)
    store(rows, i, END_TURN, q)
    if of_kind(bodies, i, IS_BALL) < 0.5:
        own = rotated_back(old, load(rows, i, SPIN, THREE))
        store(rows, i, SPIN, rotated(q, own))


@scalar
def turn_between(q, p):
    """The vector of the turn, less than half a turn, from one orientation to another."""
    w = p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3]
    x = p[1] * q[0] - p[0] * q[1] - p[2] * q[3] + p[3] * q[2]
    y = p[2] * q[0] - p[0] * q[2] - p[3] * q[1] + p[1] * q[3]
    z = p[3] * q[0] - p[0] * q[3] - p[1] * q[2] + p[2] * q[1]
    s = math.sqrt(x * x + y * y + z * z)
    # The tangent of a quarter of the angle is s / (1 + |w|).
    t = s / (1.0 + abs(w))
    size = 4.0 / (1.0 + abs(w)) * angle_over_tangent(t)
    size = -size if w < 0.0 else size
    return (size * x, size * y, size * z)


@seldom
def tumble(bodies, counter, i, time, planar):
    """Turn a body that runs and tumbles to a new direction, at random times."""
    rate = of_kind(bodies, i, TUMBLES)
    if rate == 0.0:
        return
    a, b, c, _ = words(counter, BODY_TUMBLE, i, 0)
    if unit_open(a) < rate * time:
        s, co = sincos_turn(unit_open(b))
        height = 1.0 - 2.0 * unit_open(c)
        if planar:
            store(bodies.rows, i, TURN, (co, 0.0, 0.0, s))
        else:
            # the shortest turn of axis x to a direction that is uniform on the sphere
            w = math.sqrt(0.5 * (1.0 + height))
            side = math.sqrt(max(0.5 * (1.0 - height), 0.0))
            store(bodies.rows, i, TURN, (w, 0.0, side * co, side * s))
