"""Distances of spheres from one another and from walls."""

from mesokit.loops.neighbours import nearest_image
from mesokit.method.spheres.common.walls import KIND, MOVES, PLANE, entries, outward, vibration
from mesokit.method.spheres.soft.engine.groups import REACH
from mesokit.scalar.jit import scalar
from mesokit.scalar.vector import added_scaled


@scalar
def row(array, i):
    """The first three numbers of a row."""
    return array[i, 0], array[i, 1], array[i, 2]


@scalar
def from_to(box, place, j, r):
    """The vector that leads from sphere j to r: bit for bit minus that from r to j."""
    return nearest_image(box, added_scaled(r, -1.0, row(place, j)))


@scalar
def from_wall(rows, w, box, r, time):
    """Distance of a place from a wall, the normal out of it, and the velocity of its surface."""
    distance, normal = outward(rows, w, box, r)
    moves = entries(rows, w, MOVES, r)
    if rows[w, KIND] == PLANE:
        shift, speed, _ = vibration(rows, w, time)
        return distance - shift, normal, added_scaled(moves, speed, normal)
    return distance, normal, moves


@scalar
def reach(bodies, i):
    """The reach of a sphere: its radius, or half of a cut-off."""
    return bodies.place[i, REACH]
