"""Collisions of spheres with one another and with walls."""

import math
from typing import Any, NamedTuple

import numpy as np

from mesokit.loops.neighbours import nearest_image
from mesokit.method.spheres.common.walls import MOVES, entries, outward, vibration
from mesokit.method.spheres.hard.collision.protocol import restitution, step_of_energy
from mesokit.method.spheres.hard.engine.groups import INERTIA, LAST, MASS, RADIUS, SPIN, VELOCITY
from mesokit.method.spheres.hard.engine.motion import bring_to, put_entries
from mesokit.scalar.jit import by_type, scalar
from mesokit.scalar.random import METHOD, Counter, normals, unit, words
from mesokit.scalar.vector import added_scaled, dot, outer, scaled

THERMAL = METHOD + np.uint64(70)  # purpose of the random numbers of thermal walls


# places in `Tally.counts`, in `Tally.sums`, and in `Flights.sums`
PAIRS, WALLS, ELASTIC, IN_A_ROW, COUNTS = 0, 1, 2, 3, 4
VIRIAL, SUMS = 0, 1
TIMES, SQUARES = 0, 1


class Flights(NamedTuple):
    """Free flights between collisions. per_time: bins in a unit of time; counts (bins + 1,), the
    last of all longer flights; sums (2,) of their times and of the squares."""

    per_time: float
    counts: Any
    sums: Any


class Tally(NamedTuple):
    """Counts and sums over events.

    counts (4,), sums (1,); impulse (walls, d): momentum that each wall has taken; flights: Flights,
    or () where no observable reads them, and nothing is compiled for it.
    """

    counts: Any
    sums: Any
    impulse: Any
    flights: Any


class Rules(NamedTuple):
    """pair: the collision rule of two spheres; tangential, friction: of a pair; at_walls (walls,
    4): restitution, tangential, friction and temperature (0: none) of each; seed."""

    pair: Any
    tangential: float
    friction: float
    at_walls: Any
    seed: np.uint64


@by_type
def spin_of(body, i, pattern):
    """Angular velocity: of one number in 2D, of three in 3D."""
    if len(pattern) == 2:
        return lambda body, i, pattern: (body[i, SPIN],)
    return lambda body, i, pattern: (body[i, SPIN], body[i, SPIN + 1], body[i, SPIN + 2])


@by_type
def rolled(spin, n):
    """The vector product of an angular velocity and a vector."""
    if len(n) == 2:
        return lambda spin, n: (-spin[0] * n[1], spin[0] * n[0])
    return lambda spin, n: outer(spin, n)


@scalar
def impulse_of(masses, levers, u, n, e, tangential, friction):
    """The impulse on the first of two surfaces: normal part, and vector along the surface.

    `masses` is the sum of inverse masses, `levers` that of R^2/I; u is the velocity of the first
    surface relative to the second, n leads from the second to the first (Walton 1993; Luding 1995).
    """
    closing = dot(u, n)
    normal = -(1.0 + e) * closing / masses
    slip = added_scaled(u, -closing, n)
    speed = math.sqrt(dot(slip, slip))
    along = (1.0 + tangential) * speed / (masses + levers)
    along = min(along, friction * normal)
    if speed > 0.0:
        return normal, scaled(-along / speed, slip)
    return normal, scaled(0.0, slip)


@scalar
def add_impulse(spheres, i, v, impulse, turned):
    """Add an impulse and an angular impulse to sphere i."""
    body = spheres.body
    put_entries(spheres.state, i, VELOCITY, added_scaled(v, 1.0 / body[i, MASS], impulse))
    if body[i, INERTIA] > 0.0:
        spin = added_scaled(spin_of(body, i, v), 1.0 / body[i, INERTIA], turned)
        put_entries(body, i, SPIN, spin)


@scalar
def surface_velocity(spheres, i, v, lever):
    """The velocity of the surface of sphere i at the end of a lever."""
    return added_scaled(v, 1.0, rolled(spin_of(spheres.body, i, v), lever))


@scalar
def collide_pair(world, rules, spheres, tally, i, j, time):
    """Two spheres touch, or are at a step of their potential: velocities and spins change at once.

    Both are brought from the times of their last events to `time`.
    """
    if spheres.number[j] < spheres.number[i]:
        i, j = j, i  # in order of their numbers
    state, body = spheres.state, spheres.body
    r_i, v_i = bring_to(world, spheres, i, time)
    r_j, v_j = bring_to(world, spheres, j, time)
    apart = nearest_image(world, added_scaled(r_i, -1.0, r_j))
    distance = math.sqrt(dot(apart, apart))
    n = scaled(1.0 / distance, apart)
    spheres.hits[i] += 1
    spheres.hits[j] += 1
    masses, radii = 1.0 / body[i, MASS] + 1.0 / body[j, MASS], state[i, RADIUS] + state[j, RADIUS]
    energy, is_step = step_of_energy(rules.pair, distance, radii)
    if is_step:
        total = scaled(over_step(masses, dot(added_scaled(v_i, -1.0, v_j), n), energy), n)
        put_entries(state, i, VELOCITY, added_scaled(v_i, 1.0 / body[i, MASS], total))
        put_entries(state, j, VELOCITY, added_scaled(v_j, -1.0 / body[j, MASS], total))
        tally.sums[VIRIAL] += dot(apart, total)
        return
    lever_i, lever_j = scaled(-state[i, RADIUS], n), scaled(state[j, RADIUS], n)
    u = added_scaled(
        surface_velocity(spheres, i, v_i, lever_i), -1.0, surface_velocity(spheres, j, v_j, lever_j)
    )
    levers = turning(state, body, i) + turning(state, body, j)
    closing = -dot(u, n)
    e, tangential, friction = restitution(rules.pair, closing), rules.tangential, rules.friction
    since = time - max(body[i, LAST], body[j, LAST])
    note_pause(world, tally, since)
    if since < world.lasting:
        e, tangential = 1.0, -1.0
        tally.counts[ELASTIC] += 1
    normal, along = impulse_of(masses, levers, u, n, e, tangential, friction)
    total = added_scaled(along, normal, n)
    # Surfaces of growing spheres move apart after a collision.
    total = added_scaled(total, 2.0 * (radii * world.growth / masses), n)
    # The normal part exerts no torque; leaving it out avoids rounding errors.
    add_impulse(spheres, i, v_i, total, outer(lever_i, along))
    add_impulse(spheres, j, v_j, scaled(-1.0, total), outer(lever_j, scaled(-1.0, along)))
    note_flight(tally.flights, time - body[i, LAST])
    note_flight(tally.flights, time - body[j, LAST])
    body[i, LAST] = body[j, LAST] = time
    tally.counts[PAIRS] += 1
    tally.sums[VIRIAL] += dot(apart, total)


@by_type
def note_flight(flights, lasted):
    """Count a flight that has ended; the first one of a sphere is infinite, as it had no start."""
    if len(flights) == 0:
        return lambda flights, lasted: None

    def note(flights, lasted):
        if lasted < np.inf:
            bins = len(flights.counts) - 1
            place = min(lasted * flights.per_time, float(bins))
            flights.counts[int(max(place, 0.0))] += 1
            flights.sums[TIMES] += lasted
            flights.sums[SQUARES] += lasted * lasted

    return note


@scalar
def note_pause(world, tally, since):
    """Count collisions in a row for which the time since the last of a sphere counts as none."""
    tally.counts[IN_A_ROW] = tally.counts[IN_A_ROW] + 1 if since < world.instant else 0


@scalar
def over_step(masses, parting, energy):
    """The impulse along the line of centres at a step of the potential, which is lower by `energy`
    within; `masses` is the sum of inverse masses, `parting` the velocity along the line."""
    sign = -1.0 if parting < 0.0 else 1.0
    after = parting * parting - sign * 2.0 * energy * masses
    return (sign * math.sqrt(after) - parting) / masses if after > 0.0 else -2.0 * parting / masses


@scalar
def turning(state, body, i):
    """R^2/I of sphere i."""
    return state[i, RADIUS] * state[i, RADIUS] / body[i, INERTIA]


@scalar
def collide_wall(world, rules, spheres, tally, i, w, time):
    """A sphere touches a wall at `time`, to which it is brought: it is reflected, or sent out."""
    state, body, walls = spheres.state, spheres.body, world.walls
    r, v = bring_to(world, spheres, i, time)
    _, n = outward(walls, w, world, r)
    _, speed, _ = vibration(walls, w, time)
    wall_velocity = added_scaled(entries(walls, w, MOVES, r), speed, n)
    tally.counts[WALLS] += 1
    spheres.hits[i] += 1
    if rules.at_walls[w, 3] > 0.0:
        after = sent_out(rules, spheres, i, n, rules.at_walls[w, 3])
        after = added_scaled(after, 1.0, wall_velocity)
        total = scaled(body[i, MASS], added_scaled(after, -1.0, v))
        put_entries(state, i, VELOCITY, after)
    else:
        lever = scaled(-state[i, RADIUS], n)
        u = added_scaled(surface_velocity(spheres, i, v, lever), -1.0, wall_velocity)
        e, tangential = rules.at_walls[w, 0], rules.at_walls[w, 1]
        if e < 0.0:  # as of two spheres
            e = restitution(rules.pair, -dot(u, n))
        note_pause(world, tally, time - body[i, LAST])
        if time - body[i, LAST] < world.lasting:
            e, tangential = 1.0, -1.0
            tally.counts[ELASTIC] += 1
        normal, along = impulse_of(
            1.0 / body[i, MASS], turning(state, body, i), u, n, e, tangential, rules.at_walls[w, 2]
        )
        total = added_scaled(along, normal, n)
        total = added_scaled(total, body[i, MASS] * state[i, RADIUS] * world.growth, n)
        add_impulse(spheres, i, v, total, outer(lever, along))
    note_flight(tally.flights, time - body[i, LAST])
    body[i, LAST] = time
    for k in range(len(n)):
        tally.impulse[w, k] -= total[k]


@scalar
def sent_out(rules, spheres, i, n, kT):
    """A random velocity of spheres that leave a wall in equilibrium, weighted by their flux."""
    number, hits = spheres.number[i], spheres.hits[i]
    a, b, c, d = words(Counter(rules.seed, np.uint64(hits)), THERMAL, number, 0)
    e, f, _, _ = words(Counter(rules.seed, np.uint64(hits)), THERMAL, number, 1)
    width = math.sqrt(kT / spheres.body[i, MASS])
    xi = normals(n, a, b, c, d)
    along = added_scaled(xi, -dot(xi, n), n)
    # 1 - u lies in (0, 1]
    speed = math.sqrt(-2.0 * math.log(1.0 - unit(e, f)))
    return scaled(width, added_scaled(along, speed, n))
