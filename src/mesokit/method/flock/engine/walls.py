"""Birds among solids: from hit to hit."""

from __future__ import annotations

from mesokit.geometry.protocol import first_hit, happens, homed, settled, unmet
from mesokit.geometry.solids.bodies import (
    RULE,
    SLIP,
    Bodies,
    part_normal,
    surface_number,
)
from mesokit.geometry.solids.contact import MARGIN
from mesokit.geometry.solids.none import Nothing
from mesokit.scalar.jit import generic, scalar, seldom
from mesokit.scalar.vector import added, added_scaled, dot, scaled

MOST_HITS = 256  # in one step, pieces of a long flight included


@generic
def flown(solid, r, way, heading):
    """Place and heading after a flight along `way` from r, in a step, with reflections."""


@flown.register(Nothing)
def _(solid, r, way, heading):
    return added(r, way), heading


@scalar
def mirrored(u, n):
    """A vector reflected at a plane with the normal n."""
    return added_scaled(u, -2.0 * dot(n, u), n)


@flown.register(Bodies)
def _(solid, r, way, heading):
    return reflected(solid, r, way, heading)


@seldom
def reflected(solid, r, way, heading):
    """The flight among solids, with a velocity of `way` in a time of 1.

    Surfaces with slip mirror it, others send it back the way it came. A heading that leads into
    the surface is turned as the flight is. A bird that rounding leaves in a solid, or that still
    flies after MOST_HITS, stays where it was.
    """
    still, time = scaled(0.0, way), 1.0
    x, v, flying = homed(solid, r), way, True
    away = added_scaled(r, -1.0, x)
    contact = unmet(solid)
    for _ in range(MOST_HITS):
        hit, contact = first_hit(solid, x, v, still, time, contact)
        if hit > time:
            flying = False
            break
        x = added_scaled(x, hit, v)
        time -= hit
        if happens(solid, contact):
            n = part_normal(solid.tables, contact[0], x)
            x = added_scaled(x, MARGIN, n)
            slips = surface_number(solid.tables, contact[1], RULE) == SLIP
            v = mirrored(v, n) if slips else scaled(-1.0, v)
            if dot(n, heading) < 0.0:
                heading = mirrored(heading, n) if slips else scaled(-1.0, heading)
        at_home = homed(solid, x)
        away = added(away, added_scaled(x, -1.0, at_home))
        x = at_home
    x = added_scaled(x, time, v)
    at_home = homed(solid, x)
    away = added(away, added_scaled(x, -1.0, at_home))
    place, good = settled(solid, at_home)
    if flying or not good:
        return r, heading
    return added(place, away), heading
