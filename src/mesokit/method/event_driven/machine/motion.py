"""Free flight: where a sphere is at a time, and when two of them touch."""

import math

import numpy as np

from mesokit.method.event_driven.machine.groups import RADIUS, TIME, VELOCITY
from mesokit.scalar.elementary import rint
from mesokit.scalar.intrinsics import floor, mul_add, with_item
from mesokit.scalar.jit import elementwise, for_each, scalar
from mesokit.scalar.vector import added_scaled, dot


@elementwise
def entries(rows, i, start, like):
    """Consecutive entries of row i, as a tuple as long as `like`."""
    return "rows[i, start + {k}]"


@for_each
def put_entries(rows, i, start, values):
    """Write a tuple into row i."""
    return "rows[i, start + {k}] = values[{k}]"


@elementwise
def fallen(r, tau, v, g):
    """The place after a time in free flight."""
    return "mul_add(tau, mul_add(0.5 * tau, g[{k}], v[{k}]), r[{k}])"


@scalar
def place_at(world, state, i, time):
    """Where sphere i is at a time."""
    r, v = entries(state, i, 0, world.size), entries(state, i, VELOCITY, world.size)
    return fallen(r, time - state[i, TIME], v, world.gravity)


@scalar
def velocity_at(world, state, i, time):
    """How fast sphere i is at a time."""
    v = entries(state, i, VELOCITY, world.size)
    return added_scaled(v, time - state[i, TIME], world.gravity)


@scalar
def nearest_image(world, r):
    """The shortest of the vectors that differ from r by whole boxes."""
    for k in range(len(r)):
        r = with_item(r, k, r[k] - rint(r[k] * world.inverse[k]) * world.size[k])
    return r


@scalar
def bring_to(world, spheres, i, time):
    """Bring sphere i to a time, and into the box; its state there."""
    state = spheres.state
    v = velocity_at(world, state, i, time)
    r = place_at(world, state, i, time)
    for k in range(len(r)):
        away = floor(r[k] * world.inverse[k])
        spheres.boxes[i, k] += np.int32(away)
        r = with_item(r, k, r[k] - away * world.size[k])
    put_entries(state, i, 0, r)
    put_entries(state, i, VELOCITY, v)
    state[i, TIME] = time
    return r, v


@scalar
def meeting(world, state, i, j, now):
    """The time at which spheres i and j touch, infinite if they do not.

    It follows from the states of both at the later of their own times, and does not depend on when
    it is asked for. Of their images those are meant that are nearest `now`. Spheres that overlap by
    rounding and come nearer touch at once (Bannerman, Strobl, Formella and Poeschel 2014).
    """
    since = max(state[i, TIME], state[j, TIME])
    apart = added_scaled(place_at(world, state, i, since), -1.0, place_at(world, state, j, since))
    v = added_scaled(
        velocity_at(world, state, i, since), -1.0, velocity_at(world, state, j, since)
    )
    for k in range(len(apart)):
        then = mul_add(now - since, v[k], apart[k])
        boxes = rint(then * world.inverse[k])
        apart = with_item(apart, k, apart[k] - boxes * world.size[k])
    radii = state[i, RADIUS] + state[j, RADIUS]
    return since + touching(apart, v, mul_add(radii * world.growth, since, radii), radii * world.growth)


@scalar
def touching(r, v, reach, growth):
    """The time after which |r + v t| = reach + growth t from above, infinite if never."""
    a = dot(v, v) - growth * growth
    b = dot(r, v) - reach * growth
    c = dot(r, r) - reach * reach
    if c <= 0.0:
        return 0.0 if b < 0.0 else math.inf
    square = b * b - a * c
    if square < 0.0 or (b >= 0.0 and a >= 0.0):
        return math.inf
    root = math.sqrt(square)
    return c / (root - b) if b < 0.0 else (b + root) / -a
