"""Distances of spheres from one another and from walls."""

from mesokit.loops.neighbours import nearest_image
from mesokit.method.spheres.common.contacts.groups import REACH, Box, SlidBox
from mesokit.method.spheres.common.walls import KIND, MOVES, PLANE, displaced, entries, outward
from mesokit.scalar.elementary import rint
from mesokit.scalar.jit import generic, scalar
from mesokit.scalar.vector import added_scaled


@scalar
def row(array, i):
    """The first three numbers of a row."""
    return array[i, 0], array[i, 1], array[i, 2]


@generic
def shortest(box, separation):
    """The shortest of the vectors that lead from images of one place to another."""


shortest.register(Box)(lambda box, separation: nearest_image(box, separation))


@shortest.register(SlidBox)
def _(box, separation):
    x, y, z = separation
    return nearest_image(box, (x - rint(y * box.inverse[1]) * box.offset, y, z))


@scalar
def from_to(box, place, j, r):
    """The vector that leads from sphere j to r: bit for bit minus that from r to j."""
    return shortest(box, added_scaled(r, -1.0, row(place, j)))


@scalar
def from_wall(rows, w, box, r, time):
    """Distance of a place from a wall, the normal out of it, and the velocity of its surface."""
    distance, normal = outward(rows, w, box, r)
    moves = entries(rows, w, MOVES, r)
    if rows[w, KIND] == PLANE:
        shift, speed = displaced(rows, w, time)
        return distance - shift, normal, added_scaled(moves, speed, normal)
    return distance, normal, moves


@scalar
def reach(bodies, i):
    """The reach of a sphere: its radius, or half of a cut-off."""
    return bodies.place[i, REACH]
