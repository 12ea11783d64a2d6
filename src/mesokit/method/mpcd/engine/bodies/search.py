"""The search for the next hit of a particle on a body, between hits on walls.

A ball that moves straight is met at a root of a quadratic equation, or by tangent planes where a
force bends the flight. Every other shape is approached by steps that no surface can outrun.
"""

import math
from typing import NamedTuple

import numpy as np

from mesokit.geometry.protocol import (
    Chance,
    first_hit,
    happens,
    homed,
    lever,
    rebound,
    surface_of,
    unmet,
)
from mesokit.geometry.solids.flight import MOST_TRIES, ON_SURFACE, SHORT_STEP, time_to_fall
from mesokit.method.mpcd.engine.bodies import state
from mesokit.method.mpcd.engine.bodies.near import (
    bodies_near,
    body_near,
)
from mesokit.method.mpcd.engine.bodies.state import (
    FOUR,
    IS_BALL,
    MEAN_SPIN,
    MEAN_VELOCITY,
    NO_BODY,
    PLACE,
    RADIUS,
    THREE,
    TURN,
    after_turn,
    image_near,
    load,
    of_kind,
    place_at,
    rate_of,
    rotated,
    rotated_back,
    turned_on,
    with_shear,
)
from mesokit.method.mpcd.engine.cpu.bounce import fly_among, take_sum
from mesokit.method.mpcd.engine.cpu.physics import field_of, has_solid, momentum_scale
from mesokit.method.mpcd.field.none import Zero
from mesokit.method.mpcd.streaming import fall
from mesokit.scalar.jit import by_type, scalar, seldom
from mesokit.scalar.vector import added, added_scaled, dot, outer, scaled

ROUNDED = 1e-9  # cells: more than heights are rounded by
BLOCK = 64  # numbers of hits that particles of walls take in a round


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
        t += time_to_fall(max(c, 0.0), down, dot(normal, a), time - t)
        if t > time:
            return late
        step = time_to_fall(max(c, 0.0), down, dot(normal, a), time)
        y = added_scaled(added_scaled(y, step, w), 0.5 * step * step, a)
        w = added_scaled(w, step, a)
    return t


@scalar
def clearance_of_flight(bodies, i, flight, rate, begin, t):
    """Distance from body i, which turns at a rate, of a place on a flight (y, w, a)."""
    y, w, a = flight
    x = added_scaled(added_scaled(y, t, w), 0.5 * t * t, a)
    spin = load(bodies.rows, i, MEAN_SPIN, THREE)
    q = turned_on(load(bodies.rows, i, TURN, FOUR), spin, rate, begin + t)
    return state.clearance(bodies, bodies.kind[i], rotated_back(q, x))


@seldom
def time_to_shape(bodies, i, y, w, a, begin, time):
    """The same for any shape, which turns while it moves."""
    late, t = 2.0 * time + 1.0, 0.0
    spin, pull = load(bodies.rows, i, MEAN_SPIN, THREE), math.sqrt(dot(a, a))
    flight, rate = (y, w, a), rate_of(spin)
    fast, radius = math.sqrt(dot(w, w)) + pull * time, of_kind(bodies, i, RADIUS)
    path = fast * time
    q = turned_on(load(bodies.rows, i, TURN, FOUR), spin, rate, begin)
    straight = rotated_back(q, scaled(time, w))
    c, lowest = state.heights_on_flight(bodies, bodies.kind[i], rotated_back(q, y), straight)
    # Most flights stay above planes that touch the body, by more than a force bends them and than
    # the body turns.
    if lowest > time * (rate[0] * radius + 0.5 * pull * time) + ROUNDED:
        return late
    fast += math.sqrt(dot(spin, spin)) * (radius + max(c, 0.0) + path)
    # No surface comes nearer faster than `fast`, so steps of the distance over it are safe. Near
    # the surface they are short; the first place inside brackets the hit.
    while t < time:
        step = min(t + max(c, SHORT_STEP) / (fast + 1e-300), time)
        above, c = c, clearance_of_flight(bodies, i, flight, rate, begin, step)
        if c < 0.0:
            if above <= ON_SURFACE and t == 0.0:  # it starts on the surface
                return 0.0 if descends(bodies, i, y, w, spin, begin) else late
            crossing = (t, step), (max(above, 0.0), c)
            return time_of_crossing(bodies, i, flight, rate, begin, crossing[0], crossing[1])
        t = step
    return late


@scalar
def descends(bodies, i, y, w, spin, begin):
    """Whether a flight that starts on the surface of a body goes into it."""
    normal = normal_at(bodies, i, y, begin)
    return dot(normal, added_scaled(w, -1.0, state.swept(spin, y))) < 0.0


@seldom
def time_of_crossing(bodies, i, flight, rate, begin, times, distances):
    """The last time found outside, when a flight crosses a surface between two times, at which its
    distances from it are positive and negative."""
    (outside, inside), (above, below) = times, distances
    # False position with half weights for the end that stays (Illinois), a bisection now and then.
    for n in range(MOST_TRIES):
        part = above / (above - below) if n % 8 < 7 else 0.5
        middle = outside + part * (inside - outside)
        if not outside < middle < inside:
            middle = 0.5 * (outside + inside)
            if not outside < middle < inside:
                break
        c = clearance_of_flight(bodies, i, flight, rate, begin, middle)
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
    _, normal = state.facing(bodies, bodies.kind[i], y)
    return rotated(q, normal)
