"""Forces of walls of any shape on spheres that touch them."""

from mesokit.geometry.solids.bodies import NOBODY
from mesokit.geometry.solids.none import Nothing
from mesokit.method.soft_spheres.machine.acting import ahead, beside, tell_beside
from mesokit.method.soft_spheres.machine.contact import (
    answer,
    at_wall,
    surface,
    tell_wall,
    with_wall,
)
from mesokit.method.soft_spheres.machine.geometry import reach, row
from mesokit.method.soft_spheres.machine.groups import Solid
from mesokit.method.soft_spheres.machine.solid import (
    Place,
    body_of,
    forget_others,
    place_at_solid,
    slot_of,
    solid_moves,
)
from mesokit.scalar.jit import scalar

FACELESS = (0.0, 0.0, 0.0)


@beside.register(Nothing)
def _(solid, law, i, step, world, sums):
    return sums


@tell_beside.register(Nothing)
def _(solid, law, i, world, told):
    return


@scalar
def touched(law, solid, bodies, i):
    """The surfaces that sphere i touches, or is about to: three at most."""
    r, within = row(bodies.place, i), reach(bodies, i) + ahead(law)
    nowhere = Place(within, FACELESS, NOBODY)
    first = place_at_solid(solid, r, within, FACELESS, FACELESS)
    second, third = nowhere, nowhere
    if first.term != NOBODY:
        second = place_at_solid(solid, r, within, first.normal, FACELESS)
    if second.term != NOBODY:
        third = place_at_solid(solid, r, within, first.normal, second.normal)
    return first, second, third


@scalar
def surface_at(solid, bodies, i, place):
    """The surface at a place beside sphere i."""
    body = body_of(solid, place.term)
    moves = solid_moves(solid, place.term, row(bodies.place, i))
    return surface(place.distance, place.normal, moves, solid.own, body)


@beside.register(Solid)
def _(solid, law, i, step, world, sums):
    places = touched(law, solid, world.bodies, i)
    forget_others(solid, i, places[0].term, places[1].term, places[2].term)
    for place in places:
        if place.term != NOBODY:
            there = surface_at(solid, world.bodies, i, place)
            touch = at_wall(world.bodies, world.bodies.seen, 0.5 * step, i, there)
            slot = slot_of(solid, i, place.term)
            sums = with_wall(law, touch, answer(law, touch, solid.springs, i, slot, step), sums)
    return sums


@tell_beside.register(Solid)
def _(solid, law, i, world, told):
    for place in touched(law, solid, world.bodies, i):
        if place.term != NOBODY and place.distance < reach(world.bodies, i):
            there = surface_at(solid, world.bodies, i, place)
            touch = at_wall(world.bodies, world.bodies.velocity, 0.0, i, there)
            tell_wall(law, touch, solid.springs, i, slot_of(solid, i, place.term), told)
