"""Forces and torques on bodies that are not of the fluid: given ones, traps, and gaps."""

import math

import numpy as np

from mesokit.geometry import primitive
from mesokit.geometry.primitive import WIDTH
from mesokit.geometry.protocol import facing, homed
from mesokit.method.mpcd.engine.bodies.state import (
    ANGULAR_SPRING,
    DEPTH,
    DISPLACED,
    EVERY_BODY,
    FIRST_PART,
    FORCE_GIVEN,
    FOUR,
    HOME,
    IN_BODY_FRAME,
    IS_BALL,
    MASS,
    PARTS_END,
    PLACE,
    RADIUS,
    RANGE,
    SPRING,
    THREE,
    TORQUE_GIVEN,
    TOWARDS,
    TURN,
    image_near,
    load,
    of_kind,
    rotated,
    rotated_back,
    whole_spin,
)
from mesokit.method.mpcd.engine.cpu.bounce import add_recoil
from mesokit.method.mpcd.engine.cpu.physics import momentum_scale
from mesokit.method.mpcd.engine.domains.messages.bodies import counts_for_all
from mesokit.method.mpcd.engine.where import where
from mesokit.method.mpcd.field.protocol import acceleration
from mesokit.method.mpcd.streaming import vector
from mesokit.scalar.jit import by_type, scalar, seldom
from mesokit.scalar.vector import added, added_scaled, dot, first, outer, products, scaled

STEEPEST = 0.02  # of the range: where the gap is less, the force is that there
MOST_TRIES = 200
CLOSE = 1e-9  # cells: two steps of a search that differ by less have arrived


@seldom
def forces_on(bodies, physics, box, i, impulse, time):
    """Force and torque on body i where it is, and its half of the virial of gaps with others.

    Walls take the opposite of what they give it in a time.
    """
    zero = physics.zero
    kind, q, x = bodies.kind[i], load(bodies.rows, i, TURN, FOUR), load(bodies.rows, i, PLACE, zero)
    force = load(bodies.kinds, kind, FORCE_GIVEN, zero)
    torque, virial = (
        load(bodies.kinds, kind, TORQUE_GIVEN, THREE),
        products(scaled(0.0, zero), zero),
    )
    if bodies.kinds[kind, IN_BODY_FRAME] > 0.5:
        force, torque = rotated(q, force), rotated(q, torque)
    # The fluid's force acts on it as on the fluid in its place; all that balances other forces is
    # an acceleration of everything.
    displaced = bodies.kinds[kind, DISPLACED]
    force = added_scaled(force, displaced, vector(acceleration(physics.field, x), x))
    force = added_scaled(force, bodies.kinds[kind, MASS] - displaced, balance_at(bodies, zero))
    if bodies.kinds[kind, SPRING] > 0.0:
        home, _ = image_near(box, load(bodies.rows, i, HOME, zero), x)
        force = added_scaled(force, bodies.kinds[kind, SPRING], added_scaled(home, -1.0, x))
    if bodies.kinds[kind, ANGULAR_SPRING] > 0.0:
        axis = rotated(q, first((1.0, 0.0, 0.0), zero))
        twist = outer(axis, load(bodies.kinds, kind, TOWARDS, zero))
        torque = added_scaled(torque, bodies.kinds[kind, ANGULAR_SPRING], whole_spin(twist))
    if bodies.kinds[kind, DEPTH] > 0.0:
        number = bodies.partner_count[i]
        for n in range(len(bodies.rows) if number == EVERY_BODY else number):
            j = n if number == EVERY_BODY else np.int64(bodies.partners[i, n])
            if j != i:
                given, twist, apart = force_between(bodies, box, i, j, zero)
                force, torque = added(force, given), added(torque, twist)
                virial = added(virial, products(scaled(0.5, given), apart))
        given, twist = force_of_walls(bodies, physics, i, (x, q), impulse, time)
        force, torque = added(force, given), added(torque, twist)
    return force, torque, virial


@by_type
def balance_at(bodies, zero):
    """The uniform acceleration of everything, 0 where there is none."""
    from mesokit.method.mpcd.engine.cpu.physics import field_of

    if len(field_of(bodies, "pull")) == 0:
        return lambda bodies, zero: zero
    return lambda bodies, zero: bodies.pull


@scalar
def force_of_gap(depth, reach, gap):
    """Force of a gap: of depth 4 e [(s/g)^12 - (s/g)^6 + 1/4] up to reach = 2^(1/6) s."""
    if gap >= reach:
        return 0.0
    x = reach / max(gap, STEEPEST * reach)
    x3 = x * x * x
    x6 = x3 * x3  # twice the sixth power of s/g
    return 12.0 * depth * x6 * (x6 - 1.0) / max(gap, STEEPEST * reach)


@seldom
def force_on_place(bodies, i, s):
    """Force on a point at an arm s from body i: repulsion by the gaps to all of its parts."""
    depth, reach = of_kind(bodies, i, DEPTH), of_kind(bodies, i, RANGE)
    if of_kind(bodies, i, IS_BALL) > 0.5:
        distance = math.sqrt(dot(s, s))
        gap = distance - of_kind(bodies, i, RADIUS)
        return scaled(force_of_gap(depth, reach, gap) / distance, s)
    force, q = scaled(0.0, s), load(bodies.rows, i, TURN, FOUR)
    y = rotated_back(q, s)
    for part in range(int(of_kind(bodies, i, FIRST_PART)), int(of_kind(bodies, i, PARTS_END))):
        p, code = bodies.parts + 8 * WIDTH * part, bodies.part_code[part]
        size = force_of_gap(depth, reach, primitive.distance(code, p, bodies.parts, y))
        if size > 0.0:
            force = added_scaled(force, size, primitive.normal(code, p, bodies.parts, y))
    return rotated(q, force)


@seldom
def force_between(bodies, box, i, j, x):
    """Force and torque on body i by body j, and the separation of their centres.

    The force on the body of the higher number is the opposite of that on the other one, to the last
    bit: both are found as seen from the lower one.
    """
    if i < j:
        force, torque, _, away = forces_of_pair(bodies, box, i, j, x)
        return force, torque, away
    force, _, torque, away = forces_of_pair(bodies, box, j, i, x)
    return scaled(-1.0, force), torque, scaled(-1.0, away)


@seldom
def forces_of_pair(bodies, box, i, j, zero):
    """Force on body i by body j, repulsion by the gap of all pairs of parts; the torques on both,
    and the separation of their centres."""
    depth, x = bodies.kinds[bodies.kind[j], DEPTH], load(bodies.rows, i, PLACE, zero)
    force, torque, turning = scaled(0.0, x), THREE, THREE
    if depth == 0.0:
        return force, torque, turning, force
    depth = math.sqrt(depth * of_kind(bodies, i, DEPTH))
    reach = 0.5 * (of_kind(bodies, i, RANGE) + of_kind(bodies, j, RANGE))
    other, _ = image_near(box, load(bodies.rows, j, PLACE, x), x)
    away = added_scaled(x, -1.0, other)
    distance = math.sqrt(dot(away, away))
    gap = distance - of_kind(bodies, i, RADIUS) - of_kind(bodies, j, RADIUS)
    if gap >= reach:
        return force, torque, turning, away
    if of_kind(bodies, i, IS_BALL) > 0.5 and of_kind(bodies, j, IS_BALL) > 0.5:
        given = scaled(force_of_gap(depth, reach, gap) / distance, away)
        return given, torque, turning, away
    q, p = load(bodies.rows, i, TURN, FOUR), load(bodies.rows, j, TURN, FOUR)
    for a in range(int(of_kind(bodies, i, FIRST_PART)), int(of_kind(bodies, i, PARTS_END))):
        for b in range(int(of_kind(bodies, j, FIRST_PART)), int(of_kind(bodies, j, PARTS_END))):
            mine, theirs = nearest_places(bodies, a, x, q, b, other, p)
            given = force_along(mine, theirs, depth, reach)
            arm, others = added_scaled(mine, -1.0, x), added_scaled(theirs, -1.0, other)
            force, torque = added(force, given), added(torque, whole_spin(outer(arm, given)))
            turning = added_scaled(turning, -1.0, whole_spin(outer(others, given)))
    return force, torque, turning, away


@scalar
def force_along(mine, theirs, depth, reach):
    """The force by the gap between two places, on the body of the first."""
    between = added_scaled(mine, -1.0, theirs)
    gap = math.sqrt(dot(between, between))
    return scaled(force_of_gap(depth, reach, gap) / max(gap, 1e-300), between)


@seldom
def nearest_places(bodies, a, x, q, b, other, p):
    """The nearest places of two convex parts, by projection on one and the other in turn."""
    theirs = other
    mine = on_part(bodies, a, x, q, theirs)
    for _ in range(MOST_TRIES):
        theirs = on_part(bodies, b, other, p, mine)
        before, mine = mine, on_part(bodies, a, x, q, theirs)
        step = added_scaled(mine, -1.0, before)
        if dot(step, step) < CLOSE * CLOSE:
            break
    return mine, theirs


@scalar
def on_part(bodies, part, x, q, r):
    """The place of a part, of a body at x, that is nearest to r."""
    y = rotated_back(q, added_scaled(r, -1.0, x))
    p, code = bodies.parts + 8 * WIDTH * part, bodies.part_code[part]
    c = primitive.distance(code, p, bodies.parts, y)
    n = primitive.normal(code, p, bodies.parts, y)
    return added(x, rotated(q, added_scaled(y, -c, n)))


@where("(scaled(0.0, pose[0]), THREE)", bodies=lambda bodies: has_walls(bodies))
def force_of_walls(bodies, physics, i, pose, impulse, time):
    """Force and torque on body i by the gap between it and the nearest wall, which takes the
    opposite."""
    x, q = pose
    (solid,) = bodies.solid
    depth, reach = of_kind(bodies, i, DEPTH), of_kind(bodies, i, RANGE)
    radius = of_kind(bodies, i, RADIUS)
    here = homed(solid, x)
    distance, normal, surface, lever = facing(solid, radius + reach, here)
    force, torque = scaled(0.0, x), THREE
    if distance >= radius + reach:
        return force, torque
    if of_kind(bodies, i, IS_BALL) > 0.5:
        force = scaled(force_of_gap(depth, reach, distance - radius), normal)
        wall_takes(bodies, physics, impulse, surface, lever, scaled(-time, force))
        return force, torque
    for a in range(int(of_kind(bodies, i, FIRST_PART)), int(of_kind(bodies, i, PARTS_END))):
        wall = added_scaled(here, -distance, normal)
        mine = wall
        # Projection on the part and on the wall in turn.
        for _ in range(MOST_TRIES):
            before, mine = mine, on_part(bodies, a, here, q, wall)
            away, out, surface, lever = facing(solid, radius + reach, homed(solid, mine))
            if away >= radius + reach:
                break
            wall = added_scaled(mine, -away, out)
            step = added_scaled(mine, -1.0, before)
            if dot(step, step) < CLOSE * CLOSE:
                break
        given, arm = force_along(mine, wall, depth, reach), added_scaled(mine, -1.0, here)
        force, torque = added(force, given), added(torque, whole_spin(outer(arm, given)))
        wall_takes(bodies, physics, impulse, surface, lever, scaled(-time, given))
    return force, torque


@scalar
def wall_takes(bodies, physics, impulse, surface, lever, p):
    """Add an impulse to what a surface took; one rank counts for all."""
    if counts_for_all(bodies):
        add_recoil(impulse, surface, lever, p, momentum_scale(physics))


def has_walls(bodies):
    """Whether there are walls, from the numba type of `MovingBodies`."""
    from mesokit.method.mpcd.engine.cpu.physics import field_of

    return len(field_of(bodies, "solid")) > 0
