"""Forces of walls of any shape on spheres that touch them."""

from mesokit.geometry.protocol import Nothing
from mesokit.geometry.solids.bodies import NO_TERM
from mesokit.method.spheres.soft.engine.acting import ahead, beside, measure_beside
from mesokit.method.spheres.soft.engine.contact.force import at_wall, body, surface
from mesokit.method.spheres.soft.engine.contact.remembered import kept
from mesokit.method.spheres.soft.engine.contact.walls import add_force, measure_wall
from mesokit.method.spheres.soft.engine.geometry import reach, row
from mesokit.method.spheres.soft.engine.groups import Solid
from mesokit.method.spheres.soft.engine.solid import (
    Place,
    body_of,
    contact_with,
    forget_others,
    place_at_solid,
    solid_moves,
)
from mesokit.method.spheres.soft.engine.taken import take
from mesokit.scalar.jit import scalar

FACELESS = (0.0, 0.0, 0.0)


@beside.register(Nothing)
def _(solid, law, i, step, world, room):
    return 0.0


@measure_beside.register(Nothing)
def _(solid, law, i, world, readings):
    return


@scalar
def touched(law, solid, bodies, i):
    """The surfaces that sphere i touches, or is about to: three at most."""
    r, within = row(bodies.place, i), reach(bodies, i) + ahead(law)
    nowhere = Place(within, FACELESS, NO_TERM)
    first = place_at_solid(solid, r, within, FACELESS, FACELESS)
    second, third = nowhere, nowhere
    if first.term != NO_TERM:
        second = place_at_solid(solid, r, within, first.normal, FACELESS)
    if second.term != NO_TERM:
        third = place_at_solid(solid, r, within, first.normal, second.normal)
    return first, second, third


@scalar
def surface_at(solid, bodies, i, place):
    """The surface at a place beside sphere i."""
    body = body_of(solid, place.term)
    moves = solid_moves(solid, place.term, row(bodies.place, i))
    return surface(place.distance, place.normal, moves, solid.own, body)


@beside.register(Solid)
def _(solid, law, i, step, world, room):
    bodies, largest = world.bodies, 0.0
    places = touched(law, solid, bodies, i)
    forget_others(solid, i, places[0].term, places[1].term, places[2].term)
    for place in places:
        if place.term != NO_TERM:
            there, c = surface_at(solid, bodies, i, place), contact_with(solid, i, place.term)
            bound, counts = add_force(law, i, there, solid.springs, c, step, bodies)
            take(room.taken, len(world.walls.rows) + body_of(solid, place.term), counts)
            largest = max(largest, bound)
    return largest


@measure_beside.register(Solid)
def _(solid, law, i, world, readings):
    for place in touched(law, solid, world.bodies, i):
        if place.term != NO_TERM and place.distance < reach(world.bodies, i):
            there = surface_at(solid, world.bodies, i, place)
            touch = at_wall(0.0, body(world.bodies, world.bodies.velocity, i), there)
            springs = kept(solid.springs, contact_with(solid, i, place.term))
            measure_wall(law, touch, springs, readings)
