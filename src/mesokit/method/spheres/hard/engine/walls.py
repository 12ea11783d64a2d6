"""The time at which a hard sphere touches a wall.

Planes at rest have a closed form. Other walls are approached in steps that are too short to pass
them: from a lower bound of the distance, a parabola.
"""

import math

from mesokit.method.spheres.common.walls import (
    AMPLITUDE,
    AXIS,
    FREQUENCY,
    INSIDE,
    KIND,
    OUTSIDE,
    PLACE,
    PLANE,
    ROUND,
    entries,
    outward,
    vibration,
)
from mesokit.method.spheres.hard.engine.motion import fallen
from mesokit.scalar.jit import scalar, seldom
from mesokit.scalar.vector import added_scaled, dot

CLOSE = 1e-13  # of the radius of a sphere: it touches
ROUNDING = 2e-15  # relative error of the lengths that a gap is made of
STEPS = 100_000  # of one search; those of a thousand turns of a plate are fewer


@seldom
def time_to_wall(world, one, w, until):
    """The time at which a sphere touches a wall, from its own state; infinite if not before
    `until`, NaN if it was not found."""
    walls, g = world.walls, world.gravity
    if walls[w, KIND] == PLANE and walls[w, AMPLITUDE] == 0.0 and world.growth == 0.0:
        distance, normal = outward(walls, w, world, one.r)
        return one.time + fall(distance - one.radius, dot(one.v, normal), dot(g, normal))
    tau = 0.0
    # March from the sphere's own time in steps that end before the contact: each is the larger of
    # two lower bounds. For the time `longest` the gap shrinks no faster than a parabola, with
    # the closing speed now and a bound of its growth. A vibrating plate does not matter until the
    # sphere is within its amplitude. A gap below rounding is a contact if it closes.
    for _ in range(STEPS):
        gap, closing, bend, longest = approach(world, one, w, tau)
        if gap <= CLOSE * one.radius + unsure(world, one, w, tau):
            if closing > 0.0:
                return one.time + tau
            gap = 0.0
        tau += max(min(parabola(gap, closing, bend), longest), until_near(world, one, w, tau))
        if not one.time + tau < until:
            return math.inf
    return math.nan


@scalar
def unsure(world, one, w, tau):
    """The rounding error of the gap after a time: of places, and of times of fast spheres."""
    walls, g, r, v = world.walls, world.gravity, one.r, one.v
    place, pull = entries(walls, w, PLACE, g), math.sqrt(dot(g, g))
    lengths = math.sqrt(dot(r, r)) + math.sqrt(dot(place, place)) + walls[w, ROUND]
    speed = math.sqrt(dot(v, v)) + pull * tau + walls[w, AMPLITUDE] * walls[w, FREQUENCY]
    return ROUNDING * (lengths + speed * (one.time + tau))


@scalar
def until_near(world, one, w, tau):
    """The time until a sphere is within the amplitude of a vibrating plate; 0 for other walls."""
    walls, g = world.walls, world.gravity
    if walls[w, KIND] != PLANE or world.growth != 0.0:
        return 0.0
    distance, normal = outward(walls, w, world, fallen(one.r, tau, one.v, g))
    above = distance - walls[w, AMPLITUDE] - one.radius
    if above <= 0.0:
        return 0.0
    return fall(above, dot(added_scaled(one.v, tau, g), normal), dot(g, normal))


@scalar
def fall(gap, v, g):
    """When gap + v t + g t^2/2 next comes down to 0; the plane at rest."""
    gap = max(gap, 0.0)
    if gap == 0.0 and v < 0.0:
        return 0.0
    if g >= 0.0:
        square = v * v - 2.0 * g * gap
        if v >= 0.0 or square < 0.0:
            return math.inf
        return 2.0 * gap / (math.sqrt(square) - v)
    if gap == 0.0 and v == 0.0:
        return 0.0
    root = math.sqrt(v * v - 2.0 * g * gap)
    return (v + root) / -g if v >= 0.0 else 2.0 * gap / (root - v)


@scalar
def approach(world, one, w, tau):
    """Gap between a sphere and a wall after a time, its closing speed, a bound of the growth of
    this speed per time, and how long the bound holds."""
    g, walls, then, radius = world.gravity, world.walls, one.time + tau, one.radius
    moving = added_scaled(one.v, tau, g)
    distance, normal = outward(walls, w, world, fallen(one.r, tau, one.v, g))
    shift, speed, bend = vibration(walls, w, then)
    gap = distance - shift - radius * (1.0 + world.growth * then)
    closing = speed + radius * world.growth - dot(moving, normal)
    pull, longest = math.sqrt(dot(g, g)), math.inf
    bend += pull
    if walls[w, KIND] == INSIDE:
        square, size = dot(moving, moving), walls[w, ROUND]
        if distance > 0.5 * size:  # near the middle, where the normal turns fast: a bound
            closing = math.sqrt(square) + speed + radius * world.growth
        else:  # until it may be within a quarter of the radius of the middle
            bend += (square + 0.5 * pull * size) / (0.25 * size)
            longest = parabola(0.25 * size, math.sqrt(square), pull)
    elif walls[w, KIND] == OUTSIDE:  # until it may be near another image of the wall
        between = next_image(world, w) - 2.0 * (walls[w, ROUND] + radius)
        longest = parabola(max(gap, between - gap), math.sqrt(dot(moving, moving)), pull)
    return gap, closing, bend, longest


@scalar
def next_image(world, w):
    """The distance of the nearest image of a round wall, infinite if there is none."""
    nearest = math.inf
    for k in range(len(world.size)):
        if world.inverse[k] > 0.0 and abs(world.walls[w, AXIS + k]) < 0.999:
            nearest = min(nearest, world.size[k])
    return nearest


@scalar
def parabola(gap, closing, bend):
    """When gap - closing t - bend t^2/2 is 0: a lower bound of when they touch."""
    root = math.sqrt(closing * closing + 2.0 * bend * gap)
    if closing >= 0.0:
        total = closing + root
        return 2.0 * gap / total if total > 0.0 else math.inf
    return (root - closing) / bend if bend > 0.0 else math.inf
