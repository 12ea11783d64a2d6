"""Solids of any shape in a step: hits, reflections, places in the fluid."""

import math

from mesokit.geometry.protocol import (
    exposed,
    facing,
    first_hit,
    free,
    happens,
    homed,
    leaps,
    lever,
    rebound,
    settled,
    surface_of,
    touches,
    unmet,
)
from mesokit.geometry.solids.bodies import (
    BODY,
    DIFFUSE,
    NO_TERM,
    RULE,
    SLIP,
    Bodies,
    between_plates,
    from_pivot,
    in_box,
    nearest,
    nearest_within,
    part_clearance,
    part_normal,
    sure_clearance,
    sure_to_miss,
    surface_number,
    surface_velocity,
)
from mesokit.geometry.solids.flight import first_meeting
from mesokit.scalar.elementary import log
from mesokit.scalar.jit import by_type, seldom
from mesokit.scalar.pointer import whole, word
from mesokit.scalar.random import DIFFUSE_WALL, Counter, normals, unit_open, words
from mesokit.scalar.vector import added, added_scaled, dot, scaled

MARGIN = 1e-9  # cells: particles are kept so far from surfaces, beyond the rounding of coordinates


@exposed.register(Bodies)
def _(solid):
    return True


@touches.register(Bodies)
def _(solid, clear, r, v, a, time):
    ahead = added_scaled(scaled(time, v), 0.5 * time * time, a)
    return beyond(solid, clear, r, ahead)


@by_type
def beyond(solid, clear, r, ahead):
    """Whether a way leads farther than is known to be clear: a stride, or what `clear` says."""
    if len(clear) == 0:
        return lambda solid, clear, r, ahead: dot(ahead, ahead) >= solid.stride * solid.stride

    def looked(solid, clear, r, ahead):
        near = dot(ahead, ahead) >= clear[0]
        for k in range(len(r)):
            end = r[k] + ahead[k]
            near |= (min(r[k], end) < solid.lowest[k]) | (max(r[k], end) > solid.highest[k])
        return near

    return looked


@leaps.register(Bodies)
def _(solid, displacement):
    return dot(displacement, displacement) >= solid.stride * solid.stride


@free.register(Bodies)
def _(solid, r, v, a, time):
    displacement = added_scaled(scaled(time, v), 0.5 * time * time, a)
    past = between_plates(solid, r) & between_plates(solid, added(r, displacement))
    return past and sure_to_miss(solid, r, displacement)


@facing.register(Bodies)
def _(solid, away, r):
    x = in_box(solid, r)
    if sure_clearance(solid, r) >= away:
        return away, scaled(0.0, r), 0, r
    distance, part, term = nearest_within(solid.tables, away, x)
    if term == NO_TERM:
        return distance, scaled(0.0, r), 0, r
    surface = whole(word(solid.tables, BODY), term)
    out = part_normal(solid.tables, part, x)
    return distance, out, surface, from_pivot(solid.tables, term, x)


@homed.register(Bodies)
def _(solid, r):
    return in_box(solid, r)


@unmet.register(Bodies)
def _(solid):
    return 0, NO_TERM


@first_hit.register(Bodies)
def _(solid, r, v, a, time, last):
    hit, part, term = first_meeting(solid.tables, r, v, a, time, last[0], last[1])
    return hit, (part, term)


@happens.register(Bodies)
def _(solid, contact):
    return contact[1] != NO_TERM


@surface_of.register(Bodies)
def _(solid, contact):
    return whole(word(solid.tables, BODY), contact[1])


@lever.register(Bodies)
def _(solid, contact, r):
    return from_pivot(solid.tables, contact[1], r)


@rebound.register(Bodies)
def _(solid, contact, r, v, chance):
    return after_hit(solid.tables, contact[0], contact[1], r, v, chance)


@seldom
def after_hit(tables, part, term, r, v, chance):
    """Place and velocity after a hit: bounced back, mirrored, or drawn anew at the wall's kT.

    In the frame of the surface. A thermal wall sends particles out with a Maxwellian flux: normal
    velocities with density u exp(-m u^2 / 2 kT) (Lebowitz and Spohn 1978).
    """
    n = part_normal(tables, part, r)
    r = added_scaled(r, max(MARGIN - part_clearance(tables, part, r), 0.0), n)
    u = surface_velocity(tables, term, r)
    rule = surface_number(tables, term, RULE)
    coming = added_scaled(v, -1.0, u)
    if rule == SLIP:
        return r, added_scaled(v, -2.0 * dot(n, coming), n)
    if rule == DIFFUSE:
        counter = Counter(chance.seed, chance.step)
        a, b, c, d = words(counter, DIFFUSE_WALL, chance.number, 2 * chance.hit)
        along = normals(r, a, b, c, d)
        a, _, _, _ = words(counter, DIFFUSE_WALL, chance.number, 2 * chance.hit + 1)
        away = math.sqrt(-2.0 * log(unit_open(a)))
        drawn = added_scaled(along, away - dot(n, along), n)
        return r, added_scaled(u, math.sqrt(chance.kT_over_m), drawn)
    return r, added_scaled(u, -1.0, coming)


@settled.register(Bodies)
def _(solid, r):
    if between_plates(solid, r) and sure_to_miss(solid, r, scaled(0.0, r)):
        return r, True
    return put_back(solid, r)


@seldom
def put_back(solid, r):
    """r, moved off the surface by the margin if it is nearer; whether it is then in the fluid."""
    for _ in range(8):
        c, part, _ = nearest(solid.tables, r)
        if c >= 0.5 * MARGIN:
            return r, True
        if c < -1e-6:
            return r, False
        r = in_box(solid, added_scaled(r, MARGIN - c, part_normal(solid.tables, part, r)))
    return r, False
