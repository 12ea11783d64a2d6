"""The flight of a particle that may hit a surface, from hit to hit."""

from mesokit.geometry.primitive.numbers import length
from mesokit.geometry.protocol import (
    Chance,
    first_hit,
    free,
    happens,
    homed,
    lever,
    rebound,
    settled,
    surface_and_lever,
    surface_of,
    unmet,
)
from mesokit.method.mpcd.engine.cpu.physics import momentum_scale
from mesokit.method.mpcd.streaming import fall, halfway, vector
from mesokit.scalar.fixed_point import add_quanta, added_quanta, integers
from mesokit.scalar.jit import by_type, scalar, seldom
from mesokit.scalar.pointer import add_words
from mesokit.scalar.vector import added, added_scaled, outer, scaled

DRIVEN = 1.0 + 1e-9  # of the speed that surfaces at rest can leave: more is not rounding
MOST_HITS = 256  # within one timestep, pieces of a long flight included


@scalar
def add_recoil(impulse, surface, r, p, scale):
    """Add the momentum p, taken at r relative to the pivot, to what a surface took."""
    take_sum(impulse, surface, p + outer(r, p), scale)


@scalar
def body_takes(impulse, solid, term, r, p, scale):
    """Add the momentum p, taken at r, to what the surface of a term took."""
    surface, lever = surface_and_lever(solid, term, r)
    add_recoil(impulse, surface, lever, p, scale)


@by_type
def take_sum(impulse, surface, given, scale):
    """Add momentum and angular momentum to what a surface took, as whole numbers.

    `impulse` is an array of one thread, or the address of numbers to which all threads add.
    """
    from numba import types

    return _to_all if isinstance(impulse, types.Integer) else _to_own


def _to_own(impulse, surface, given, scale):
    add_quanta(impulse[surface * len(given) :], scale, given)


def _to_all(impulse, surface, given, scale):
    add_words(impulse, surface * len(given), added_quanta(given, scale, integers(given)))


@scalar
def fly_among(physics, counter, particle, r, v, impulse):
    """Position and velocity a timestep later of a particle that may hit a surface."""
    a = vector(halfway(physics.field, r, v, physics.timestep), r)
    if free(physics.solid, r, v, a, physics.timestep):
        return fall(r, v, a, physics.timestep)
    return bounce(physics, physics.timestep, counter, particle, r, v, a, impulse)


@seldom
def bounce(physics, timestep, counter, particle, r, v, a, impulse):
    """Position and velocity a timestep later, with reflections; surfaces take the momentum lost.

    `particle` is its number and its mass.

    A particle that rounding leaves in a solid, or that still flies after MOST_HITS, stays where it
    was, with the velocity that its hits left it: no particle is ever in a solid. Between surfaces
    that touch and move they may have driven it to any speed: then it turns back with its own.
    """
    solid, time, (number, m) = physics.solid, timestep, particle
    start = homed(solid, r)
    away = added_scaled(r, -1.0, start)
    x, u, flying, touched = start, v, True, False
    # hits on one surface are added before they are rounded: there may be many small ones
    surface, given = 0, scaled(0.0, v + outer(v, v))
    contact = last = unmet(solid)
    # Hit after hit, until no surface is met in the time that is left. A long flight comes in pieces
    # of REACH, which end without a hit. The place stays in the box; `away` adds up its jumps by
    # whole boxes. Random numbers follow from id and hit, so the order of particles is free.
    for n in range(MOST_HITS):
        hit, contact = first_hit(solid, x, u, a, time, contact)
        if hit > time:
            flying = False
            break
        x, u = fall(x, u, a, hit)
        time -= hit
        if happens(solid, contact):
            touched, last = True, contact
            chance = Chance(counter.seed, counter.step, number, n, physics.kT / m)
            x, left = rebound(solid, contact, x, u, chance)
            lost = scaled(m, added_scaled(u, -1.0, left))
            hit_now = surface_of(solid, contact)
            if hit_now != surface:
                take_sum(impulse, surface, given, momentum_scale(physics))
                surface, given = hit_now, scaled(0.0, given)
            given = added(given, lost + outer(lever(solid, contact, x), lost))
            u = left
        at_home = homed(solid, x)
        away = added(away, added_scaled(x, -1.0, at_home))
        x = at_home
    if touched:
        x, u = fall(x, u, a, time)
    else:  # the same bits as for a particle that was seen to be far from all solids
        x, u = fall(r, v, a, timestep)
        away = scaled(0.0, r)
    at_home = homed(solid, x)
    place, good = settled(solid, at_home)
    caught = flying or not good
    if touched:
        if caught and length(u) > DRIVEN * (length(v) + length(a) * timestep):
            lost = scaled(m, added(u, v))
            given = added(given, lost + outer(lever(solid, last, start), lost))
            u = scaled(-1.0, v)
        take_sum(impulse, surface, given, momentum_scale(physics))
    if caught:
        return r, u
    return added(added(x, away), added_scaled(place, -1.0, at_home)), u
