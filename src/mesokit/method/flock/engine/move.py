"""Birds turn and move, a strip of them at a time.

What the loops over a strip need lies in rows of one array: the compiler then sees that they do not
overlap, and does several birds at once.
"""

from mesokit.geometry.protocol import Nothing, exposed, first_hit, happens, homed, settled, unmet
from mesokit.geometry.solids.bodies import RULE, SLIP, Bodies, part_normal, surface_number
from mesokit.geometry.solids.contact import MARGIN
from mesokit.kernels.kernel import inner
from mesokit.method.flock.engine.memory import HEADING, PULL, STRIP, has_cohesion, past, sum_rows
from mesokit.method.flock.noise.protocol import turned
from mesokit.scalar.fixed_point import ROUNDER, ROUNDER_BITS, bits
from mesokit.scalar.intrinsics import floor  # noqa: F401  in the text of `boxes_away`
from mesokit.scalar.jit import by_type, elementwise, for_each, generic, scalar, seldom
from mesokit.scalar.vector import added, added_scaled, chosen, dot, scaled

MOST_HITS = 256  # in one step, pieces of a long flight included


@generic
def flown(solid, r, displacement, heading):
    """Place and heading after a flight along `displacement` from r, in a step, with reflections."""


@flown.register(Nothing)
def _(solid, r, displacement, heading):
    return added(r, displacement), heading


@scalar
def mirrored(u, n):
    """A vector reflected at a plane with the normal n."""
    return added_scaled(u, -2.0 * dot(n, u), n)


@flown.register(Bodies)
def _(solid, r, displacement, heading):
    return reflected(solid, r, displacement, heading)


@seldom
def reflected(solid, r, displacement, heading):
    """The flight among solids, with a velocity of `displacement` in a time of 1.

    Surfaces with slip mirror it, others send it back the way it came. A heading that leads into
    the surface is turned as the flight is. A bird that rounding leaves in a solid, or that still
    flies after MOST_HITS, stays where it was.
    """
    still, time = scaled(0.0, displacement), 1.0
    x, v, flying = homed(solid, r), displacement, True
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


@elementwise
def load(strip, first, i, pattern):
    """Elements i of rows from `first` on."""
    return "strip[(first + {k}) * STRIP + i]"


@for_each
def store(strip, first, i, values):
    """Set elements i of rows from `first` on."""
    return "strip[(first + {k}) * STRIP + i] = values[{k}]"


@elementwise
def boxes_away(inverse, r):
    """The image count of a place along each axis."""
    return "floor(r[{k}] * inverse[{k}])"


@elementwise
def inside(size, away, r):
    """A place brought back by so many boxes; one that is rounded to the length becomes 0."""
    return "_inside(size[{k}], r[{k}] - away[{k}] * size[{k}], away[{k}])"


@scalar
def _inside(length, x, away):
    return 0.0 if (x >= length) & (away != 0.0) else x


@by_type
def wish(physics, strip, i, pattern):
    """The sum that a bird follows: headings in reach, and what cohesion adds."""
    if not has_cohesion(physics):
        return lambda physics, strip, i, pattern: scaled(1.0 / HEADING, load(strip, 0, i, pattern))

    def with_cohesion(physics, strip, i, pattern):
        d = len(pattern)
        weight = physics.cohesion[0].strength / PULL
        total = scaled(1.0 / HEADING, load(strip, 0, i, pattern))
        total = added(total, scaled(weight, load(strip, d + 1, i, pattern)))
        out = load(strip, 2 * d + 1, i, pattern)
        return chosen(dot(out, out) > 0.0, out, total)

    return with_cohesion


@inner
def move(physics, counter, birds, sums, strip, side, first, count):
    """Turn and move `count` birds from the bird `first` on."""
    pattern = physics.axes.size
    d, rows = len(pattern), sum_rows(physics)
    headings, places = birds.headings[side], birds.places[side]
    images, numbers = birds.images[side], birds.numbers[side]
    heading, place, away, number = rows, rows + d, rows + 2 * d, rows + 3 * d
    # Copy in, turn, fly, copy out. Rows of one scratch array are known not to overlap, so `turn`
    # and `fly` become loops over vectors; these copies are the price.
    for k in range(rows):
        for i in range(count):
            strip[k * STRIP + i] = float(sums[k, past(first, i)])
    for k in range(d):
        for i in range(count):
            strip[(heading + k) * STRIP + i] = headings[k, past(first, i)]
        for i in range(count):
            strip[(place + k) * STRIP + i] = places[k, past(first, i)]
    for i in range(count):
        strip[number * STRIP + i] = float(numbers[past(first, i)])
    turn(physics, counter, strip, rows, count, pattern)
    fly(physics, strip, rows, count, pattern)
    for k in range(d):
        for i in range(count):
            headings[k, past(first, i)] = strip[(heading + k) * STRIP + i]
        for i in range(count):
            places[k, past(first, i)] = strip[(place + k) * STRIP + i]
        for i in range(count):
            images[k, past(first, i)] += int(strip[(away + k) * STRIP + i])


@inner
def turn(physics, counter, strip, rows, count, pattern):
    """New headings, and the ways of the step."""
    d = len(pattern)
    heading, away, number = rows, rows + 2 * d, rows + 3 * d
    for i in range(count):
        old, total = load(strip, heading, i, pattern), wish(physics, strip, i, pattern)
        name = bits(strip[number * STRIP + i] + ROUNDER) - ROUNDER_BITS
        around = strip[d * STRIP + i]
        new = turned(physics.noise, counter, name, old, total, around)
        store(strip, heading, i, new)
        store(strip, away, i, scaled(physics.step_length, chosen(physics.follows, old, new)))


@inner
def fly(physics, strip, rows, count, pattern):
    """New places in the box, and how many boxes away they were."""
    axes, d = physics.axes, len(pattern)
    heading, place, away = rows, rows + d, rows + 2 * d
    for i in range(count):
        r, displacement = load(strip, place, i, pattern), load(strip, away, i, pattern)
        r, new = flown(physics.solid, r, displacement, load(strip, heading, i, pattern))
        if exposed(physics.solid):
            store(strip, heading, i, new)
        boxes = boxes_away(axes.inverse, r)
        store(strip, place, i, inside(axes.size, boxes, r))
        store(strip, away, i, boxes)
