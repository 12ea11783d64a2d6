"""When a flight meets a solid: parabolas against parts, terms and all that is near.

A flight starts at r, in the fluid or on a surface, with velocity v, and has the acceleration a.
Half-spaces have a formula. Convex parts are approached by their tangent planes: no flight reaches
the solid before it reaches the plane, so the time of the plane is safe. The next plane, at the
place reached, is nearer to the solid, quadratically as Newton's method. Sampled solids are crossed
cell by cell of their grid. Everything else is approached by steps no longer than the distance to
it, and the crossing is then bracketed.
"""

import math

from mesokit.geometry import primitive
from mesokit.geometry.primitive import WIDTH, sampled
from mesokit.geometry.primitive.numbers import length
from mesokit.geometry.solids.bodies import (
    FIRST,
    KINDS,
    NEAR,
    NO_TERM,
    NUMBERS,
    REACH,
    SAMPLES,
    SIGNS,
    near_places,
    part_clearance,
    part_normal,
    term_clearance,
)
from mesokit.scalar.jit import scalar, seldom
from mesokit.scalar.pointer import real, whole, word
from mesokit.scalar.vector import added_scaled, dot

ON_SURFACE = 1e-11  # cells: a flight that comes so close has arrived
SHORT_STEP = 1e-3  # cells: the least step of a march
MOST_TRIES = 100
SAMPLED = primitive.KINDS["sampled"]
_CONVEX_KINDS = sum(1 << kind for kind, convex in enumerate(primitive.CONVEX) if convex)


@scalar
def time_to_fall(height, v, a, time):
    """When a particle at a height >= 0 above a plate reaches it; more than `time` if it does not.

    Of the two roots of height + v t + a t^2 / 2 = 0 it is the one with a downward velocity, in the
    form without cancellation.
    """
    square = v * v - 2.0 * a * height
    down = math.sqrt(max(square, 0.0))
    late = 2.0 * time + 1.0
    if square < 0.0 or down == 0.0:
        return late
    if v < 0.0:
        return 2.0 * height / (down - v)
    return -(v + down) / a if a < 0.0 else late


@scalar
def is_convex(kind):
    """Whether primitives of that kind are convex."""
    return (_CONVEX_KINDS >> kind) & 1 == 1


@scalar
def at(r, v, a, t):
    """Place and velocity on the parabola."""
    return added_scaled(added_scaled(r, t, v), 0.5 * t * t, a), added_scaled(v, t, a)


@seldom
def approach(tables, part, r, v, a, time):
    """When the flight enters a convex part; more than `time` if it does not."""
    late, t = 2.0 * time + 1.0, 0.0
    x, u = r, v
    # Newton's method from outside: fly to the tangent plane of the nearest place, then take the
    # plane there. A convex part lies behind each of these planes, so no step enters it.
    for _ in range(MOST_TRIES):
        c, n = part_clearance(tables, part, x), part_normal(tables, part, x)
        if c <= ON_SURFACE and dot(n, u) < 0.0:
            return t
        t += time_to_fall(max(c, 0.0), dot(n, u), dot(n, a), time - t)
        if t > time:
            return late
        x, u = at(r, v, a, t)
    return t


@seldom
def traverse(tables, part, r, v, a, time):
    """When the flight enters a sampled part; more than `time` if it does not.

    From cell to cell of its grid; within one, no farther than where the value may be 0 at the
    soonest, which is where it is 0 unless the flight is bent.
    """
    p = word(tables, NUMBERS) + 8 * WIDTH * part
    samples, sign = word(tables, SAMPLES), real(word(tables, SIGNS), part)
    spacing, steep, pull = real(p, 3), real(p, 8), length(a)
    late, t = 2.0 * time + 1.0, 0.0
    x, u = r, v
    # Within one cell of the grid the value along the flight has a bounded second derivative. A
    # parabola with it is a safe step; at the end of a cell the slope is taken anew.
    for _ in range(MOST_TRIES + int(8.0 * REACH / spacing)):
        value, slope, bend, leave = sampled.ahead(p, samples, x, u)
        value, slope = sign * value, sign * slope
        if value <= ON_SURFACE * steep and slope < 0.0:
            return t
        value, bend = max(value, 0.0), bend + steep * pull
        root = math.sqrt(slope * slope + 2.0 * bend * value)
        if slope > 0.0:
            soonest = (slope + root) / (bend + 1e-300)
        else:
            soonest = 2.0 * value / (root - slope + 1e-300)
        hop = ON_SURFACE / (length(u) + 1e-300)  # over the end of the cell
        t += min(soonest, leave) + hop
        if t > time:
            return late
        x, u = at(r, v, a, t)
    return t


@seldom
def march(tables, part, r, v, a, time):
    """When the flight enters any part; more than `time` if it does not."""
    late, t, pull = 2.0 * time + 1.0, 0.0, length(a)
    x, _ = at(r, v, a, time)
    room = real(word(tables, SIGNS), part) < 0.0 and is_convex(whole(word(tables, KINDS), part))
    # Within a convex room a straight flight that ends inside stays inside.
    if room and part_clearance(tables, part, x) >= 0.5 * pull * time * time:
        return late
    x, u = r, v
    c = part_clearance(tables, part, r)
    # A step is as long as the clearance allows at the highest speed that is left, so it cannot pass
    # through the part. Near the surface steps are SHORT_STEP; the first place inside brackets the
    # crossing.
    while t < time:
        ahead = max(c, SHORT_STEP) / (length(u) + pull * (time - t) + 1e-300)
        ahead = min(t + ahead, time)
        x, u = at(r, v, a, ahead)
        above, c = c, part_clearance(tables, part, x)
        if c < 0.0:
            return crossing(tables, part, (r, v, a), (t, ahead), (max(above, 0.0), c))
        t = ahead
    return late


@seldom
def crossing(tables, part, flight, times, distances):
    """The last time found outside, when a flight (place, velocity, acceleration) crosses the
    surface between two times, at which its distances from it are positive and negative."""
    (r, v, a), (outside, inside), (above, below) = flight, times, distances
    # False position; the end that stays is given half the weight (Illinois). Every eighth step is a
    # bisection, in case the distance is not smooth. `outside` is always in the fluid, so it is
    # safe.
    for n in range(MOST_TRIES):
        share = above / (above - below) if n % 8 < 7 else 0.5
        middle = outside + share * (inside - outside)
        if not outside < middle < inside:
            middle = 0.5 * (outside + inside)
            if not outside < middle < inside:
                break
        x, _ = at(r, v, a, middle)
        c = part_clearance(tables, part, x)
        if c < 0.0:
            inside, below, above = middle, c, 0.5 * above
        else:
            outside, above, below = middle, c, 0.5 * below
            if c < ON_SURFACE:
                break
    return outside


@scalar
def curves_away(tables, part):
    """Whether all of a part lies behind each of its tangent planes."""
    return real(word(tables, SIGNS), part) > 0.0 and is_convex(whole(word(tables, KINDS), part))


@scalar
def departs(tables, part, r, v, a, time):
    """Whether a flight that starts on the surface of a part surely does not come back to it."""
    if not curves_away(tables, part):
        return False
    n = part_normal(tables, part, r)
    return dot(n, v) + 0.5 * min(dot(n, a), 0.0) * time > 0.0


@seldom
def entry(tables, part, r, v, a, time):
    """When the flight enters a part; more than `time` if it does not."""
    if curves_away(tables, part):
        return approach(tables, part, r, v, a, time)
    if whole(word(tables, KINDS), part) == SAMPLED:
        return traverse(tables, part, r, v, a, time)
    return march(tables, part, r, v, a, time)


@seldom
def meeting(tables, term, r, v, a, time):
    """When the flight enters all parts of a term, and the part that it entered last.

    From place to place: as long as it is outside of a part, nothing happens before it enters that.
    """
    first = whole(word(tables, FIRST), term)
    if whole(word(tables, FIRST), term + 1) - first == 1:
        return entry(tables, first, r, v, a, time), first
    late, t = 2.0 * time + 1.0, 0.0
    x, u = r, v
    # A term is an intersection: a place outside of any part is outside of the term. So the flight
    # goes on to the entry into the part that it is farthest out of, until it is in all.
    for _ in range(MOST_TRIES):
        c, part = term_clearance(tables, term, x)
        if c <= ON_SURFACE and dot(part_normal(tables, part, x), u) < 0.0:
            return t, part
        t += entry(tables, part, x, u, a, time - t)
        if t > time:
            return late, first
        x, u = at(r, v, a, t)
    return t, first


@scalar
def may_reach(tables, term, r, path):
    """Whether a flight may reach a term; true where its time is found as quickly."""
    first = whole(word(tables, FIRST), term)
    quick = curves_away(tables, first) or whole(word(tables, KINDS), first) == SAMPLED
    if quick and whole(word(tables, FIRST), term + 1) - first == 1:
        return True
    c, _ = term_clearance(tables, term, r)
    return c <= path


@seldom
def first_meeting(tables, r, v, a, time, last_part, last_term):
    """The first hit of a flight that starts in the box: time, part and term.

    It starts on the surface of the last part and term, unless that is NO_TERM.
    A flight is followed no farther than REACH at a time: at the end of such a piece it is NO_TERM.
    The time is more than `time` if nothing is left to happen.
    """
    speed = length(v) + 0.5 * length(a) * time
    path, late = speed * time, 2.0 * time + 1.0
    part, term = 0, NO_TERM
    soonest = late
    if path > REACH:
        soonest = REACH / speed
        path, time = REACH, soonest
    # Terms in the list of the cell where the flight starts: it holds all within REACH, and the
    # flight is no longer. The term of the last hit is left out if the flight departs from it; its
    # clearance there is 0 but for rounding.
    for j in near_places(tables, r):
        candidate = whole(word(tables, NEAR), j)
        if candidate == last_term and departs(tables, last_part, r, v, a, time):
            continue
        if may_reach(tables, candidate, r, path):
            t, which = meeting(tables, candidate, r, v, a, time)
            if t <= time and t < soonest:
                soonest, part, term = t, which, candidate
    return soonest, part, term
