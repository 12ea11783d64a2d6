"""Spheres at walls of any shape, by the distance of their centres.

A sphere touches the nearest term of a solid and, in a corner, two others with other normals. Of two
terms with nearly the same normal, such as a wall and its periodic image, the nearer one acts alone.
"""

from typing import NamedTuple

import numpy as np

from mesokit.geometry.primitive import KINDS as NUMBER
from mesokit.geometry.solids.bodies import (
    BODY,
    KINDS,
    NEAR,
    NO_TERM,
    STARTS,
    home_cell,
    part_clearance,
    part_normal,
    surface_velocity,
    term_clearance,
)
from mesokit.method.spheres.common.contacts.groups import OPENS
from mesokit.method.spheres.common.contacts.remembered import NO_SPRINGS, keep
from mesokit.scalar.jit import by_type, elementwise, scalar, seldom
from mesokit.scalar.pointer import whole, word
from mesokit.scalar.vector import added_scaled, dot, scaled

MOST = 3  # surfaces that a sphere touches at once
ALIKE = 0.9  # cosine of the angle between two normals that are nearly the same
WAVE, SAMPLED = NUMBER["wave"], NUMBER["sampled"]  # they give a bound of the distance alone
FEET = 6  # steps to the nearest place of these
NEARER = 40  # steps of a ray to their surface


class Place(NamedTuple):
    """Distance from a term, the normal out of it, and the term, NO_TERM if there is none."""

    distance: float
    normal: tuple[float, float, float]
    term: int


@elementwise
def shortened(r, pattern):
    """The components of r along the axes of the box."""
    return "r[{k}]"


@by_type
def lengthened(x):
    """A vector of three numbers."""
    if len(x) == 2:
        return lambda x: (x[0], x[1], 0.0)
    return lambda x: x


@seldom
def nearest_place(tables, own, time, x, within, one, other):
    """The nearest term whose normal differs from these two: distance, normal and term.

    Bodies that have been taken away do not count, see `Solid.own`.
    """
    least, normal, term = within, scaled(0.0, x), NO_TERM
    cell = home_cell(tables, x)
    for j in range(whole(word(tables, STARTS), cell), whole(word(tables, STARTS), cell + 1)):
        candidate = whole(word(tables, NEAR), j)
        bound, part = term_clearance(tables, candidate, x)
        if bound < least and time < own[whole(word(tables, BODY), candidate), OPENS]:
            c, n = part_place(tables, part, x, bound)
            if c < least and dot(n, one) < ALIKE and dot(n, other) < ALIKE:
                least, normal, term = c, n, candidate
    return least, normal, term


@seldom
def part_place(tables, part, x, bound):
    """Distance of x from a part, and the normal there."""
    n = part_normal(tables, part, x)
    kind = whole(word(tables, KINDS), part)
    if kind != WAVE and kind != SAMPLED:
        return bound, n
    distance = bound
    # The nearest place of a bent surface: a ray from x along the normal meets the surface at a
    # foot, the normal there gives the next ray, and so on.
    for _ in range(FEET):
        distance = 0.0
        for _ in range(NEARER):
            c = part_clearance(tables, part, added_scaled(x, -distance, n))
            distance += c
            if abs(c) < 1e-13:
                break
        n = part_normal(tables, part, added_scaled(x, -distance, n))
    return distance, n


@scalar
def place_at_solid(solid, r, time, within, one, other):
    """The nearest term as `nearest_place` finds it, with vectors of three components."""
    tables, axes = solid.bodies.tables, solid.pattern
    x, a, b = shortened(r, axes), shortened(one, axes), shortened(other, axes)
    distance, normal, term = nearest_place(tables, solid.own, time, x, within, a, b)
    return Place(distance, lengthened(normal), term)


@scalar
def touched(solid, r, time, within):
    """The surfaces nearer than `within` to a place at a time: three at most."""
    nothing = (0.0, 0.0, 0.0)
    nowhere = Place(within, nothing, NO_TERM)
    first = place_at_solid(solid, r, time, within, nothing, nothing)
    second, third = nowhere, nowhere
    if first.term != NO_TERM:
        second = place_at_solid(solid, r, time, within, first.normal, nothing)
    if second.term != NO_TERM:
        third = place_at_solid(solid, r, time, within, first.normal, second.normal)
    return first, second, third


@scalar
def body_of(solid, term):
    """Number of the body that a term is of."""
    return whole(word(solid.bodies.tables, BODY), term)


@scalar
def moves_at(solid, r, place):
    """Velocity of the surface where it is nearest to a sphere at r."""
    foot = shortened(added_scaled(r, -place.distance, place.normal), solid.pattern)
    return lengthened(surface_velocity(solid.bodies.tables, place.term, foot))


@scalar
def contact_with(solid, i, term):
    """Number of the contact of sphere i with a term; a free one if it is new."""
    free = 0
    for s in range(MOST):
        if solid.terms[i, s] == term:
            return i * MOST + s
        if solid.terms[i, s] == NO_TERM:
            free = s
    keep(solid.springs, i * MOST + free, NO_SPRINGS)
    solid.terms[i, free] = np.int64(term)
    return i * MOST + free


@scalar
def forget_others(solid, i, one, two, three):
    """Free the contacts of sphere i with terms other than these."""
    for s in range(MOST):
        term = solid.terms[i, s]
        if term != one and term != two and term != three:
            solid.terms[i, s] = NO_TERM
