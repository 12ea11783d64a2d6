"""When a sphere touches a wall, and where the wall is then.

Planes at rest are met in closed form; other walls are approached by steps that
are too short to come through: from a lower bound of the distance, a parabola.
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
from mesokit.method.spheres.hard.engine.groups import RADIUS, TIME, VELOCITY
from mesokit.method.spheres.hard.engine.motion import fallen
from mesokit.scalar.jit import scalar, seldom
from mesokit.scalar.vector import added_scaled, dot

CLOSE = 1e-13  # of the radius of a sphere: it touches
ROUNDING = 2e-15  # of the lengths that a gap is made of: no gap is known better
STEPS = 100_000  # of one search; those of a thousand turns of a plate are fewer


@seldom
def time_to_wall(world, state, i, w, until):
    """The time at which sphere i touches a wall, from its own state; infinite if not before
    `until`, NaN if it was not found.

    Each step ends before the sphere may touch: the larger of two lower bounds of that time.
    """
    walls, g, since = world.walls, world.gravity, state[i, TIME]
    r, v = entries(state, i, 0, g), entries(state, i, VELOCITY, g)
    radius = state[i, RADIUS]
    if walls[w, KIND] == PLANE and walls[w, AMPLITUDE] == 0.0 and world.growth == 0.0:
        distance, normal = outward(world.walls, w, world, r)
        return since + fall(distance - radius, dot(v, normal), dot(g, normal))
    tau = 0.0
    # March in steps that end before the contact. For the time `longest` the gap shrinks no faster
    # than a parabola, with the closing speed now and a bound of its growth. A vibrating plate does
    # not matter until the sphere is within its amplitude. A gap below rounding is a contact if it
    # closes.
    for _ in range(STEPS):
        gap, closing, bend, longest = approach(world, state, i, w, tau)
        if gap <= CLOSE * radius + unsure(world, state, i, w, tau):
            if closing > 0.0:
                return since + tau
            gap = 0.0
        tau += max(min(parabola(gap, closing, bend), longest), until_near(world, state, i, w, tau))
        if not since + tau < until:
            return math.inf
    return math.nan


@scalar
def unsure(world, state, i, w, tau):
    """The rounding error of the gap after a time: of places, and of times of fast spheres."""
    walls, g = world.walls, world.gravity
    r, v = entries(state, i, 0, g), entries(state, i, VELOCITY, g)
    place, pull, then = entries(walls, w, PLACE, g), math.sqrt(dot(g, g)), state[i, TIME] + tau
    lengths = math.sqrt(dot(r, r)) + math.sqrt(dot(place, place)) + walls[w, ROUND]
    speed = math.sqrt(dot(v, v)) + pull * tau + walls[w, AMPLITUDE] * walls[w, FREQUENCY]
    return ROUNDING * (lengths + speed * then)


@scalar
def until_near(world, state, i, w, tau):
    """The time until a sphere is within the amplitude of a vibrating plate; 0 for other walls."""
    walls, g = world.walls, world.gravity
    if walls[w, KIND] != PLANE or world.growth != 0.0:
        return 0.0
    r, v = entries(state, i, 0, g), entries(state, i, VELOCITY, g)
    distance, normal = outward(world.walls, w, world, fallen(r, tau, v, g))
    above = distance - walls[w, AMPLITUDE] - state[i, RADIUS]
    if above <= 0.0:
        return 0.0
    return fall(above, dot(added_scaled(v, tau, g), normal), dot(g, normal))


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
def approach(world, state, i, w, tau):
    """Gap between sphere i and a wall after a time, how fast it closes, a bound of how much faster
    it may do so per time, and how long that bound holds."""
    g, walls = world.gravity, world.walls
    r, v = entries(state, i, 0, g), entries(state, i, VELOCITY, g)
    then, radius = state[i, TIME] + tau, state[i, RADIUS]
    moving = added_scaled(v, tau, g)
    distance, normal = outward(world.walls, w, world, fallen(r, tau, v, g))
    shift, speed, bend = vibration(walls, w, then)
    gap = distance - shift - radius * (1.0 + world.growth * then)
    closing = speed + radius * world.growth - dot(moving, normal)
    pull, longest = math.sqrt(dot(g, g)), math.inf
    bend += pull
    if walls[w, KIND] == INSIDE:
        square, size = dot(moving, moving), walls[w, ROUND]
        if distance > 0.5 * size:  # near the middle a way is a bound, its direction is not
            closing = math.sqrt(square) + speed + radius * world.growth
        else:  # for as long as it does not come nearer to the middle than a quarter
            bend += (square + 0.5 * pull * size) / (0.25 * size)
            longest = parabola(0.25 * size, math.sqrt(square), pull)
    elif walls[w, KIND] == OUTSIDE:  # until it may have come to another image of the wall
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
