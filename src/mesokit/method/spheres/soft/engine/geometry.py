"""Distances of spheres from one another and from walls."""

import math

from mesokit.method.spheres.common.walls import (
    AXIS,
    KIND,
    MOVES,
    PLACE,
    PLANE,
    ROUND,
    vibration,
)
from mesokit.method.spheres.soft.engine.groups import REACH
from mesokit.scalar.elementary import rint
from mesokit.scalar.jit import scalar
from mesokit.scalar.vector import added_scaled, dot, scaled


@scalar
def row(array, i):
    """The first three numbers of a row."""
    return array[i, 0], array[i, 1], array[i, 2]


@scalar
def nearest(box, separation):
    """A vector to the nearest image."""
    return (
        separation[0] - box.size[0] * rint(separation[0] * box.inverse[0]),
        separation[1] - box.size[1] * rint(separation[1] * box.inverse[1]),
        separation[2] - box.size[2] * rint(separation[2] * box.inverse[2]),
    )


@scalar
def from_to(box, place, j, r):
    """The vector that leads from sphere j to r: bit for bit minus that from r to j."""
    return nearest(box, added_scaled(r, -1.0, row(place, j)))


@scalar
def three(rows, w, column):
    """Three numbers of a wall, from a column on."""
    return rows[w, column], rows[w, column + 1], rows[w, column + 2]


@scalar
def from_wall(rows, w, box, r, time):
    """Distance of a place from a wall, the normal out of it, and the velocity of its surface."""
    separation, axis = added_scaled(r, -1.0, three(rows, w, PLACE)), three(rows, w, AXIS)
    moves = three(rows, w, MOVES)
    if rows[w, KIND] == PLANE:
        shift, speed, _ = vibration(rows, w, time)
        return dot(separation, axis) - shift, axis, added_scaled(moves, speed, axis)
    separation = nearest(box, separation)
    across = added_scaled(separation, -dot(separation, axis), axis)
    length = math.sqrt(dot(across, across))
    normal = scaled(rows[w, KIND] / length, across) if length > 0.0 else axis
    return rows[w, KIND] * (length - rows[w, ROUND]), normal, moves


@scalar
def reach(bodies, i):
    """The reach of a sphere: its radius, or half of a cut-off."""
    return bodies.place[i, REACH]
