"""Forces along the line between two centres, by a potential of mesokit: one loop over a list.

The loop has no branches, so the compiler makes vectors of neighbours. Terms are rounded to whole
quanta, so their sums are exact, whatever the order and the length of a list.
"""

from typing import Any, NamedTuple

import numpy as np

from mesokit.method.spheres.common.contacts.geometry import from_to, from_wall, reach, row
from mesokit.method.spheres.common.contacts.groups import OPENS
from mesokit.method.spheres.common.contacts.taken import take
from mesokit.method.spheres.soft.engine.acting import act, measure, turns
from mesokit.method.spheres.soft.engine.groups import ENERGY, NEAREST, VIRIAL
from mesokit.potential.protocol import central
from mesokit.scalar.fixed_point import ROUNDER_BITS, bits, fixed, quanta
from mesokit.scalar.jit import scalar
from mesokit.scalar.vector import dot, scaled

FAR = np.int64(0x7FF0000000000000)  # bits of infinity: those of positive numbers have their order


class Central(NamedTuple):
    """A potential, the force that counts as one, and its inverse; ahead: see `acting`."""

    potential: Any
    quantum: float
    scale: float
    ahead: float = 0.0


turns.register(Central)(lambda law: False)


@act.register(Central)
def _(law, mine, time, step, world, noted, room):
    low = FAR
    for i in range(mine[0], mine[1]):
        low = min(low, forces_from_list(law, i, world))
        low = min(low, forces_from_walls(law, i, time, world, room))
    noted[NEAREST] = min(noted[NEAREST], low)


@scalar
def forces_from_list(law, i, world):
    """The force on sphere i from others; bits of the square of the least distance."""
    bodies, box, lists = world.bodies, world.box, world.lists
    r = row(bodies.place, i)
    a, b, c, low = np.int64(0), np.int64(0), np.int64(0), FAR
    # Forces at t + dt. Each pair is computed twice, once for each sphere, so that no thread writes
    # to spheres of another. Terms are whole quanta, so neither the order nor the length of a list
    # matters. The list is filled up with the sphere itself, at distance 0, which adds nothing.
    for s in range(lists.count[i]):
        dx, dy, dz = from_to(box, bodies.place, lists.near[i, s], r)
        square = dx * dx + dy * dy + dz * dz
        _, force_over_r = central(law.potential, square)
        a += fixed(force_over_r * dx, law.scale)
        b += fixed(force_over_r * dy, law.scale)
        c += fixed(force_over_r * dz, law.scale)
        low = min(low, bits(square) if square > 0.0 else FAR)
    rounders = np.int64(lists.count[i]) * np.int64(ROUNDER_BITS)
    total = a - rounders, b - rounders, c - rounders
    bodies.force[i, 0], bodies.force[i, 1], bodies.force[i, 2] = total
    return low


@scalar
def forces_from_walls(law, i, time, world, room):
    """Add the force of walls on sphere i; bits of the square of the least distance."""
    bodies, box, walls = world.bodies, world.box, world.walls
    low, r = FAR, row(bodies.place, i)
    for w in range(len(walls.rows)):
        distance, out, _ = from_wall(walls.rows, w, box, r, time)
        if distance < 2.0 * reach(bodies, i) and time < walls.own[w, OPENS]:
            _, force_over_r = central(law.potential, distance * distance)
            low = min(low, bits(distance * distance) if distance > 0.0 else np.int64(0))
            f, scale = scaled(force_over_r * distance, out), law.scale
            counts = quanta(f[0], scale), quanta(f[1], scale), quanta(f[2], scale)
            for k in range(3):
                bodies.force[i, k] += counts[k]
            take(room.taken, w, counts)
    return low


@measure.register(Central)
def _(law, i, time, world, readings):
    bodies, box, lists, walls = world.bodies, world.box, world.lists, world.walls
    r = row(bodies.place, i)
    for s in range(lists.count[i]):
        j = lists.near[i, s]
        if j != i:
            separation = from_to(box, bodies.place, j, r)
            energy, force_over_r = central(law.potential, dot(separation, separation))
            readings[ENERGY] += quanta(energy, law.scale)
            add_product(readings, law.scale, scaled(force_over_r, separation), separation)
    for w in range(len(walls.rows)):
        distance, _, _ = from_wall(walls.rows, w, box, r, time)
        if distance < 2.0 * reach(bodies, i) and time < walls.own[w, OPENS]:
            energy, _ = central(law.potential, distance * distance)
            readings[ENERGY] += quanta(2.0 * energy, law.scale)


@scalar
def add_product(readings, scale, force, separation):
    """Add the products of a force and a vector to the virial of a sphere."""
    readings[VIRIAL] += quanta(force[0] * separation[0], scale)
    readings[VIRIAL + 1] += quanta(force[1] * separation[1], scale)
    readings[VIRIAL + 2] += quanta(force[2] * separation[2], scale)
    readings[VIRIAL + 3] += quanta(force[0] * separation[1], scale)
    readings[VIRIAL + 4] += quanta(force[0] * separation[2], scale)
    readings[VIRIAL + 5] += quanta(force[1] * separation[2], scale)
