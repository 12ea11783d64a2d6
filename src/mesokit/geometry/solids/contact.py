"""Solids of any shape in a step: hits, reflections, and what virtual particles need.

Implements `geometry.protocol` for `Bodies`. Lengths are in cells.
"""

import math

from mesokit.geometry import protocol
from mesokit.geometry.solids import bodies
from mesokit.geometry.solids.bodies import Bodies
from mesokit.geometry.solids.flight import first_meeting
from mesokit.scalar.elementary import log
from mesokit.scalar.jit import by_type, seldom
from mesokit.scalar.pointer import whole, word
from mesokit.scalar.random import DIFFUSE_WALL, Counter, normals, unit_open, words
from mesokit.scalar.vector import added, added_scaled, dot, scaled

MARGIN = 1e-9  # cells: particles are kept so far from surfaces, beyond the rounding of coordinates


@protocol.exposed.register(Bodies)
def _(solid):
    return True


@protocol.touches.register(Bodies)
def _(solid, clear, r, v, a, time):
    ahead = added_scaled(scaled(time, v), 0.5 * time * time, a)
    return beyond(solid, clear, r, ahead)


@by_type
def beyond(solid, clear, r, ahead):
    """Whether a displacement exceeds what is surely clear: a stride, or the distance in `clear`."""
    if len(clear) == 0:
        return lambda solid, clear, r, ahead: dot(ahead, ahead) >= solid.stride * solid.stride

    def looked(solid, clear, r, ahead):
        near = dot(ahead, ahead) >= clear[0]
        for k in range(len(r)):
            end = r[k] + ahead[k]
            near |= (min(r[k], end) < solid.lowest[k]) | (max(r[k], end) > solid.highest[k])
        return near

    return looked


@protocol.leaps.register(Bodies)
def _(solid, displacement):
    return dot(displacement, displacement) >= solid.stride * solid.stride


@protocol.free.register(Bodies)
def _(solid, r, v, a, time):
    displacement = added_scaled(scaled(time, v), 0.5 * time * time, a)
    past = bodies.between_plates(solid, r) & bodies.between_plates(solid, added(r, displacement))
    return past and bodies.sure_to_miss(solid, r, displacement)


@protocol.facing.register(Bodies)
def _(solid, away, r):
    x = bodies.in_box(solid, r)
    if bodies.sure_clearance(solid, r) >= away:
        return away, scaled(0.0, r), 0, r
    distance, part, term = bodies.nearest_within(solid.tables, away, x)
    if term == bodies.NO_TERM:
        return distance, scaled(0.0, r), 0, r
    surface = whole(word(solid.tables, bodies.BODY), term)
    out = bodies.part_normal(solid.tables, part, x)
    return distance, out, surface, bodies.from_pivot(solid.tables, term, x)


@protocol.homed.register(Bodies)
def _(solid, r):
    return bodies.in_box(solid, r)


@protocol.unmet.register(Bodies)
def _(solid):
    return 0, bodies.NO_TERM


@protocol.first_hit.register(Bodies)
def _(solid, r, v, a, time, last):
    hit, part, term = first_meeting(solid.tables, r, v, a, time, last[0], last[1])
    return hit, (part, term)


@protocol.happens.register(Bodies)
def _(solid, contact):
    return contact[1] != bodies.NO_TERM


@protocol.surface_of.register(Bodies)
def _(solid, contact):
    return whole(word(solid.tables, bodies.BODY), contact[1])


@protocol.lever.register(Bodies)
def _(solid, contact, r):
    return bodies.from_pivot(solid.tables, contact[1], r)


@protocol.rebound.register(Bodies)
def _(solid, contact, r, v, chance):
    return after_hit(solid.tables, contact[0], contact[1], r, v, chance)


@seldom
def after_hit(tables, part, term, r, v, chance):
    """Place and velocity after a hit: bounced back, mirrored, or drawn anew at the wall's kT.

    In the frame of the surface. A thermal wall sends particles out with a Maxwellian flux: normal
    velocities with density u exp(-m u^2 / 2 kT) (Lebowitz and Spohn 1978).
    """
    n = bodies.part_normal(tables, part, r)
    r = added_scaled(r, max(MARGIN - bodies.part_clearance(tables, part, r), 0.0), n)
    u = bodies.surface_velocity(tables, term, r)
    rule = bodies.surface_number(tables, term, bodies.RULE)
    coming = added_scaled(v, -1.0, u)
    if rule == bodies.SLIP:
        return r, added_scaled(v, -2.0 * dot(n, coming), n)
    if rule == bodies.DIFFUSE:
        counter = Counter(chance.seed, chance.step)
        a, b, c, d = words(counter, DIFFUSE_WALL, chance.number, 2 * chance.hit)
        along = normals(r, a, b, c, d)
        a, _, _, _ = words(counter, DIFFUSE_WALL, chance.number, 2 * chance.hit + 1)
        away = math.sqrt(-2.0 * log(unit_open(a)))
        drawn = added_scaled(along, away - dot(n, along), n)
        return r, added_scaled(u, math.sqrt(chance.kT_over_m), drawn)
    return r, added_scaled(u, -1.0, coming)


@protocol.settled.register(Bodies)
def _(solid, r):
    if bodies.between_plates(solid, r) and bodies.sure_to_miss(solid, r, scaled(0.0, r)):
        return r, True
    return put_back(solid, r)


@seldom
def put_back(solid, r):
    """r, moved off the surface by the margin if it is nearer; whether it is then in the fluid."""
    for _ in range(8):
        c, part, _ = bodies.nearest(solid.tables, r)
        if c >= 0.5 * MARGIN:
            return r, True
        if c < -1e-6:
            return r, False
        r = bodies.in_box(
            solid, added_scaled(r, MARGIN - c, bodies.part_normal(solid.tables, part, r))
        )
    return r, False


@protocol.nearest_surface.register(Bodies)
def _(solid, r):
    # A surface without virtual particles reports a clearance that is not negative.
    clear, part, term = bodies.nearest(solid.tables, r)
    if clear >= 0.0 or bodies.surface_number(solid.tables, term, bodies.FILLS) < 0.5:
        return abs(clear), term, r
    return (
        clear,
        term,
        bodies.in_box(solid, added_scaled(r, -clear, bodies.part_normal(solid.tables, part, r))),
    )


@protocol.surface_flow.register(Bodies)
def _(solid, term, r):
    return bodies.surface_velocity(solid.tables, term, r)


@protocol.distance_above.register(Bodies)
def _(solid, term, r):
    clear, _ = bodies.term_clearance(solid.tables, term, r)
    return clear


@protocol.is_clear_cell.register(Bodies)
def _(solid, r):
    # Half the diagonal of a cell. A cheap lower bound of the clearance comes before the search.
    room = 0.5 * math.sqrt(float(len(r)))
    if bodies.sure_clearance(solid, r) >= room:
        return True
    least, _, _ = bodies.nearest(solid.tables, bodies.in_box(solid, r))
    return least >= room


@protocol.unit_cell.register(Bodies)
def _(solid, r):
    return bodies.home_cell(solid.tables, r)


@protocol.surface_and_lever.register(Bodies)
def _(solid, term, r):
    return whole(word(solid.tables, bodies.BODY), term), bodies.from_pivot(solid.tables, term, r)
