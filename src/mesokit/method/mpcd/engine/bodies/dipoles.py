"""Forces and torques on bodies that the fluid nearby takes back: dumbbell swimmers and rotors.

The counter-force acts in equal parts on the particles in a ball at a place of the body. The
counter-torque turns those in a shell around the body rigidly about the mean of their places, so
that it adds no momentum. Impulses are whole numbers of quanta, and the body gets the opposite of
their sum and of their moment about its centre: momentum and angular momentum stay. In a step in
which no particle is there neither the body nor the fluid gets anything.
"""

from mesokit.kernels.part import stage
from mesokit.loops.layout import share
from mesokit.loops.threads import barrier
from mesokit.method.mpcd.engine.bodies.hits import give_opposite, moments_at, take_impulses
from mesokit.method.mpcd.engine.bodies.motion import end_turn
from mesokit.method.mpcd.engine.bodies.near import (
    bodies_near,
    body_near,
    box_at_start,
    is_in_ball,
    is_in_shell,
)
from mesokit.method.mpcd.engine.bodies.state import (
    BALL_FORCE,
    BALL_RADIUS,
    CELL,
    COUNT,
    FOUR,
    IN_BODY_FRAME,
    KICK,
    LANE,
    MEAN_SPIN,
    MEAN_VELOCITY,
    PLACE,
    SHELL,
    SHELL_TORQUE,
    SPIN,
    START,
    START_V,
    THREE,
    TURN,
    VELOCITY,
    add_threads,
    image_near,
    load,
    of_kind,
    rotated,
    store,
    swept,
)
from mesokit.method.mpcd.engine.cpu.groups import STREAM
from mesokit.method.mpcd.engine.cpu.physics import momentum_scale
from mesokit.method.mpcd.engine.cpu.strips.one import mass_in_lane
from mesokit.method.mpcd.engine.domains.messages.bodies import add_others
from mesokit.scalar.fixed_point import add_integers, added_quanta, floats, integers
from mesokit.scalar.jit import by_type, scalar, seldom
from mesokit.scalar.vector import added, added_scaled, scaled

# In the sums of a body: particles in its ball, and moments of those in its shell.
NUMBER, MOMENTS = 0, 1
LEAST = 1e-9  # of the size of a shell: moments below are those of one particle, or of a line


@stage
def kick_fluid(worker, now, physics, fluid, bodies):
    """Impulses at t, after the collision, on the fluid near bodies and on these."""
    if not now.flags & STREAM:
        return
    thread, mine = worker.thread, bodies.counters[worker.thread, COUNT]
    low, high = share(len(bodies.rows), thread, worker.threads)
    bodies.sums[thread] = 0
    bodies.taken[thread] = 0
    for j in range(mine):
        count_nearby(now, physics, fluid, bodies, thread, j)
    barrier(worker)
    add_others(worker, bodies, bodies.sums, 0)
    for i in range(low, high):
        share_kick(physics, bodies, i)
    barrier(worker)
    for j in range(mine):
        kick_if_nearby(now, physics, fluid, bodies, thread, j)
    barrier(worker)
    add_others(worker, bodies, bodies.taken, 0)
    for i in range(low, high):
        take_kick(physics, bodies, i)
    barrier(worker)


@scalar
def arm_of(bodies, box, i, r):
    """From the centre of the image of body i that is nearest to r."""
    x, _ = image_near(box, load(bodies.rows, i, PLACE, r), r)
    return added_scaled(r, -1.0, x)


@seldom
def count_nearby(now, physics, fluid, bodies, thread, j):
    """Add a particle near bodies to the sums of those whose ball or shell it is in."""
    r, cell = load(bodies.values[thread], j, START, physics.zero), bodies.numbers[thread, j, CELL]
    m = mass_in_lane(physics, fluid.particles, bodies.numbers[thread, j, LANE])
    box = box_at_start(now, physics)
    for n in range(bodies_near(bodies, cell)):
        i = body_near(bodies, cell, n)
        s, sums = arm_of(bodies, box, i, r), bodies.sums[thread, i]
        if is_in_ball(bodies, i, s):
            sums[NUMBER] += 1
        if is_in_shell(bodies, i, s):
            found = moments_at(m, scaled(1.0 / bodies.lever, s))
            units = added_quanta(found, bodies.mass_scale, integers(found))
            add_integers(sums[MOMENTS:], units)


@seldom
def share_kick(physics, bodies, i):
    """From the sums of body i: the impulse on each particle in its ball, and the velocity w x s + c
    that those in its shell gain."""
    add_threads(bodies.sums, i)
    total, zero, time = bodies.sums[0, i], physics.zero, physics.timestep
    q, impulse, w, c = load(bodies.rows, i, TURN, FOUR), zero, THREE, zero
    if total[NUMBER] > 0:
        force = rotated(q, load(bodies.kinds, bodies.kind[i], BALL_FORCE, zero))
        impulse = scaled(-time / float(total[NUMBER]), force)
    if total[MOMENTS] > 0:
        torque = load(bodies.kinds, bodies.kind[i], SHELL_TORQUE, THREE)
        if of_kind(bodies, i, IN_BODY_FRAME) > 0.5:
            torque = rotated(q, torque)
        # sums in floats, of arms in levers
        torque = scaled(-time * bodies.mass_scale / (bodies.lever * bodies.lever), torque)
        middle, w = turn_of_shell(total[MOMENTS:], torque, zero)
        c = scaled(-bodies.lever, swept(w, middle))
    store(bodies.rows, i, KICK, impulse)
    store(bodies.rows, i, KICK + 3, w)
    store(bodies.rows, i, KICK + 6, c)


@by_type
def turn_of_shell(sums, torque, zero):
    """The mean of the arms of so many masses, and the angular velocity that a torque gives them
    about it; 0 where they are on a line. `sums` has m, m s and m s s^T (in 2D m s^2)."""
    if len(zero) == 2:

        def planar(sums, torque, zero):
            m = float(sums[0])
            middle = (float(sums[1]) / m, float(sums[2]) / m)
            square = float(sums[3])
            about = square - m * (middle[0] * middle[0] + middle[1] * middle[1])
            return middle, (0.0, 0.0, torque[2] / about if about > LEAST * square else 0.0)

        return planar

    def spatial(sums, torque, zero):
        m = float(sums[0])
        x, y, z = float(sums[1]) / m, float(sums[2]) / m, float(sums[3]) / m
        xx, yy, zz = (
            float(sums[4]) - m * x * x,
            float(sums[5]) - m * y * y,
            float(sums[6]) - m * z * z,
        )
        xy, xz, yz = (
            float(sums[7]) - m * x * y,
            float(sums[8]) - m * x * z,
            float(sums[9]) - m * y * z,
        )
        # the inverse of the moments of inertia by minors
        a, b, c, d, e, f = yy + zz, xx + zz, xx + yy, -xy, -xz, -yz
        aa, bb, cc = b * c - f * f, a * c - e * e, a * b - d * d
        dd, ee, ff = e * f - d * c, d * f - e * b, d * e - a * f
        determinant = a * aa + d * dd + e * ee
        size = float(sums[4]) + float(sums[5]) + float(sums[6])
        over = 1.0 / determinant if determinant > LEAST * size * size * size else 0.0
        p, q, r = torque
        w = (aa * p + dd * q + ee * r, dd * p + bb * q + ff * r, ee * p + ff * q + cc * r)
        return (x, y, z), scaled(over, w)

    return spatial


@seldom
def kick_if_nearby(now, physics, fluid, bodies, thread, j):
    """Change the velocity of a particle that is in the ball or the shell of a body."""
    values, cell = bodies.values[thread], bodies.numbers[thread, j, CELL]
    r, scale = load(values, j, START, physics.zero), momentum_scale(physics)
    m = mass_in_lane(physics, fluid.particles, bodies.numbers[thread, j, LANE])
    box = box_at_start(now, physics)
    for n in range(bodies_near(bodies, cell)):
        i = body_near(bodies, cell, n)
        s = arm_of(bodies, box, i, r)
        in_ball, in_shell = is_in_ball(bodies, i, s), is_in_shell(bodies, i, s)
        if not (in_ball or in_shell):
            continue
        given = scaled(0.0, r)
        if in_ball:
            given = load(bodies.rows, i, KICK, r)
        if in_shell:
            w, c = load(bodies.rows, i, KICK + 3, THREE), load(bodies.rows, i, KICK + 6, r)
            given = added_scaled(given, m, added(swept(w, s), c))
        units = added_quanta(given, scale, integers(r))
        v = added_scaled(load(values, j, START_V, r), 1.0 / (scale * m), floats(units))
        store(values, j, START_V, v)
        give_opposite(thread, now, physics, bodies, i, s, units)


@seldom
def take_kick(physics, bodies, i):
    """Give body i the opposite of its impulses; in this step it moves at the mean of its velocities
    before and after them."""
    if of_kind(bodies, i, BALL_RADIUS) == 0.0 and of_kind(bodies, i, SHELL) == 0.0:
        return
    rows = bodies.rows
    v, spin = load(rows, i, VELOCITY, THREE), load(rows, i, SPIN, THREE)
    take_impulses(physics, bodies, i)
    dv = added_scaled(load(rows, i, VELOCITY, THREE), -1.0, v)
    dw = added_scaled(load(rows, i, SPIN, THREE), -1.0, spin)
    store(rows, i, MEAN_VELOCITY, added_scaled(load(rows, i, MEAN_VELOCITY, THREE), 0.5, dv))
    store(rows, i, MEAN_SPIN, added_scaled(load(rows, i, MEAN_SPIN, THREE), 0.5, dw))
    end_turn(bodies, i, physics.timestep)
