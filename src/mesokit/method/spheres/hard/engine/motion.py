"""Free flight: the place of a sphere at a time, and the time at which two spheres touch."""

from typing import NamedTuple

import numpy as np

from mesokit.method.spheres.common.walls import entries
from mesokit.method.spheres.hard.collision.protocol import next_contact
from mesokit.method.spheres.hard.engine.groups import RADIUS, TIME, VELOCITY
from mesokit.scalar.elementary import rint
from mesokit.scalar.intrinsics import floor, mul_add, with_item
from mesokit.scalar.jit import elementwise, for_each, scalar
from mesokit.scalar.vector import added_scaled


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
    """The place of sphere i at a time."""
    r, v = entries(state, i, 0, world.size), entries(state, i, VELOCITY, world.size)
    return fallen(r, time - state[i, TIME], v, world.gravity)


@scalar
def velocity_at(world, state, i, time):
    """The velocity of sphere i at a time."""
    v = entries(state, i, VELOCITY, world.size)
    return added_scaled(v, time - state[i, TIME], world.gravity)


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


class Mover(NamedTuple):
    """A sphere at its own time: place, velocity (d,), that time and its radius."""

    r: tuple[float, ...]
    v: tuple[float, ...]
    time: float
    radius: float


@elementwise
def in_column(columns, a, start, pattern):
    """Consecutive entries of column a, as a tuple as long as `pattern`."""
    return "columns[start + {k}, a]"


@scalar
def of_column(columns, a, pattern):
    """A sphere whose state is a column."""
    r, v = in_column(columns, a, 0, pattern), in_column(columns, a, VELOCITY, pattern)
    return Mover(r, v, columns[TIME, a], columns[RADIUS, a])


@scalar
def of_row(state, i, pattern):
    """Sphere i as it is in memory."""
    r, v = entries(state, i, 0, pattern), entries(state, i, VELOCITY, pattern)
    return Mover(r, v, state[i, TIME], state[i, RADIUS])


@scalar
def pair_event_time(world, rule, one, other, now, growth):
    """The time of the next event of two spheres, infinite without one.

    Diameters grow by the part `growth` per time. The result follows from the states of both at the
    later of their own times, so it does not depend on when it is computed. `now` selects images:
    those that are nearest then. Spheres that overlap by rounding and come nearer touch at once
    (Bannerman, Strobl, Formella and Poeschel 2014).
    """
    g, since = world.gravity, max(one.time, other.time)
    mine, its = since - one.time, since - other.time
    apart = added_scaled(fallen(one.r, mine, one.v, g), -1.0, fallen(other.r, its, other.v, g))
    v = added_scaled(added_scaled(one.v, mine, g), -1.0, added_scaled(other.v, its, g))
    # The image of `apart` that is nearest at the time `now`.
    for k in range(len(apart)):
        boxes = rint(mul_add(now - since, v[k], apart[k]) * world.inverse[k])
        apart = with_item(apart, k, apart[k] - boxes * world.size[k])
    reach = one.radius + other.radius
    growth = reach * growth if growth != 0.0 else 0.0
    return since + next_contact(rule, apart, v, mul_add(growth, since, reach), growth)
