"""Solids of any shape, as compiled code sees them: unions of intersections of primitives.

A *part* is a primitive or its complement, a *term* the intersection of parts, a *body* one or more
terms with one surface. The solid is the union of all terms. Every periodic image that reaches into
the box is a term of its own, and every cell of the box has a list of the terms near it: a particle
meets only those.
"""

import math
from typing import NamedTuple

import numpy as np

from mesokit.geometry import primitive
from mesokit.geometry.primitive import WIDTH
from mesokit.geometry.primitive.numbers import vector
from mesokit.scalar.intrinsics import floor, mul_add, with_item
from mesokit.scalar.jit import elementwise, scalar, seldom
from mesokit.scalar.pointer import real, short, whole, word
from mesokit.scalar.vector import dot, scaled

REACH = 1.0  # lists hold the terms within this distance of a cell; flights are cut into such pieces
NO_TERM = -1


class Bodies(NamedTuple):
    """Parts, terms and bodies, and what is near each cell.

    size, inverse: lengths of the box and their inverses (0 along an axis that plates close).
    tables: address of the addresses of these tables (see `pointer`), in this order, as int64:

    - KINDS, SIGNS (parts,), NUMBERS (parts, WIDTH): primitive, 1 or -1 for its complement,
      parameters; SAMPLES: what sampled primitives interpolate;
    - FIRST (terms + 1,): where the parts of each term start; BODY (terms,); PIVOT (terms, 3);
    - SURFACES (bodies, 8): rule, velocity (3), rate of rotation (3), whether virtual particles act;
    - STARTS (cells + 1,), NEAR: the terms near each cell of the box, x varying fastest;
    - SIZE: not an address but the whole lengths of the box, 3 places.

    Tables hold float64 or, for numbers of things, int32.
    first, held: cubes of 1/parts, `parts` to a cell along each axis, of which more is known: from
    the first along each axis, so many, which may go on across an end of the box.
    clear (cubes + 1,): address of the square, float32, of a lower bound of the distance from all
    solids but plates in each of these cubes, x varying fastest; of all others, the last, it is 0.
    plane_of (cubes + 1,): address of the number, int32, of the plane of each cube, or -1; planes
    (planes, d + 1): address of normals and heights. No solid is above it, n r > height, as near as
    `reach` to the cube.
    stride: distance that hardly a particle flies beyond in a timestep.
    lowest, highest: coordinates between which a flight ends that does not hit a plate; plates are
    not in `clear`, for each flight can look itself.
    """

    size: tuple[float, ...]
    inverse: tuple[float, ...]
    tables: int
    parts: float
    first: tuple[float, ...]
    held: tuple[float, ...]
    clear: int
    plane_of: int
    planes: int
    reach: float
    stride: float
    lowest: tuple[float, ...]
    highest: tuple[float, ...]


KINDS, SIGNS, NUMBERS, SAMPLES, FIRST, BODY, PIVOT, SURFACES, STARTS, NEAR, SIZE = range(11)
RULE, VELOCITY, ROTATION, FILLS, COLUMNS = 0, 1, 4, 7, 8  # of `surfaces`
NO_SLIP, SLIP, DIFFUSE = 0.0, 1.0, 2.0


@scalar
def in_box(solid, r):
    """The image of r in the box."""
    for k in range(len(r)):
        image = r[k] - floor(r[k] * solid.inverse[k]) * solid.size[k]
        # a coordinate just below 0 rounds up to the length of the box, which is the same place
        wrapped = image >= solid.size[k] and solid.inverse[k] > 0.0
        r = with_item(r, k, 0.0 if wrapped else image)
    return r


@scalar
def cube_of(solid, r):
    """Number of the cube that holds the image of r in the box; the last for others than those of
    which more is known."""
    index, cubes, known = 0.0, 1.0, True
    for j in range(len(r)):
        k = len(r) - 1 - j
        along = solid.size[k] * solid.parts
        i = floor(r[k] * solid.parts)
        # half a cube keeps the quotient away from whole numbers, where it might round either way
        images = floor((i + 0.5) * (solid.inverse[k] * (1.0 / solid.parts)))
        i = min(max(mul_add(-along, images, i), 0.0), along - 1.0) - solid.first[k]
        i += along if i < 0.0 else 0.0
        index = mul_add(index, solid.held[k], i)
        known &= (i >= 0.0) & (i < solid.held[k])
        cubes *= solid.held[k]
    return np.int32(index if known else cubes)


@scalar
def sure_clearance(solid, r):
    """A lower bound of the clearance of r: of the cube that holds it, and from plates."""
    bound = math.sqrt(short(solid.clear, np.int64(cube_of(solid, r))))
    for k in range(len(r)):
        bound = min(bound, min(r[k] - solid.lowest[k], solid.highest[k] - r[k]))
    return bound


@scalar
def between_plates(solid, r):
    """Whether r is surely between the plates."""
    inside = True
    for k in range(len(r)):
        inside &= (r[k] > solid.lowest[k]) & (r[k] < solid.highest[k])
    return inside


@seldom
def sure_to_miss(solid, r, displacement):
    """Whether a displacement from r surely leads into no solid, plates not counted.

    Both ends are above the plane of the cube that holds r, or it is shorter than what is clear.
    """
    cube, path = np.int64(cube_of(solid, r)), dot(displacement, displacement)
    plane, d = whole(solid.plane_of, cube), len(r)
    if plane < 0:
        return path < short(solid.clear, cube)
    place = solid.planes + 8 * (d + 1) * plane
    n = vector(place, 0, r)
    start = dot(n, in_box(solid, r)) - real(place, d)
    return min(start, start + dot(n, displacement)) > 0.0 and path < solid.reach * solid.reach


@scalar
def home_cell(tables, r):
    """Number of the unit cell of the box that holds r, which is in the box."""
    cell, stride = 0, 1
    for k in range(len(r)):
        length = word(tables, SIZE + k)
        cell += min(max(int(floor(r[k])), 0), length - 1) * stride
        stride *= length
    return cell


@seldom
def part_clearance(tables, part, r):
    """Distance of r from one part, positive outside of it."""
    p = word(tables, NUMBERS) + 8 * WIDTH * part
    kind = whole(word(tables, KINDS), part)
    return real(word(tables, SIGNS), part) * primitive.distance(kind, p, word(tables, SAMPLES), r)


@seldom
def part_normal(tables, part, r):
    """Unit normal of one part, out of it."""
    p = word(tables, NUMBERS) + 8 * WIDTH * part
    kind = whole(word(tables, KINDS), part)
    return scaled(
        real(word(tables, SIGNS), part), primitive.normal(kind, p, word(tables, SAMPLES), r)
    )


@seldom
def term_clearance(tables, term, r):
    """Distance of r from a term, and the part that gives it: the one that r is farthest out of."""
    widest, which = -np.inf, 0
    for part in range(whole(word(tables, FIRST), term), whole(word(tables, FIRST), term + 1)):
        c = part_clearance(tables, part, r)
        if c > widest:
            widest, which = c, part
    return widest, which


@scalar
def near_places(tables, r):
    """Places in the list of terms near the cell of r, which is in the box."""
    cell = home_cell(tables, r)
    return range(whole(word(tables, STARTS), cell), whole(word(tables, STARTS), cell + 1))


@scalar
def nearest_within(tables, away, r):
    """Clearance of r, which is in the box, and the part and term it is measured from.

    Where nothing is nearer than `away`, which the lists of the tables must reach, that is the
    clearance, and the term is NO_TERM.
    """
    least, part, term = away, 0, NO_TERM
    for j in near_places(tables, r):
        candidate = whole(word(tables, NEAR), j)
        c, which = term_clearance(tables, candidate, r)
        if c < least:
            least, part, term = c, which, candidate
    return least, part, term


@seldom
def nearest(tables, r):
    """Nearest term, part and clearance, as far as any list has terms: nearer than REACH."""
    return nearest_within(tables, REACH, r)


@elementwise
def from_pivot(tables, term, r):
    """r relative to the pivot of a term."""
    return "r[{k}] - real(word(tables, PIVOT), 3 * term + {k})"


@scalar
def surface_number(tables, term, column):
    """A number of the surface of the body that a term belongs to."""
    return real(word(tables, SURFACES), whole(word(tables, BODY), term) * COLUMNS + column)


@scalar
def surface_velocity(tables, term, r):
    """Velocity of the surface of a body at r: along itself, and round its pivot."""
    u, arm = scaled(0.0, r), from_pivot(tables, term, r)
    for k in range(len(r)):
        u = with_item(u, k, surface_number(tables, term, VELOCITY + k))
    about_z = surface_number(tables, term, ROTATION + 2)
    if len(r) == 2:
        return (u[0] - about_z * arm[1], u[1] + about_z * arm[0])
    about_x = surface_number(tables, term, ROTATION)
    about_y = surface_number(tables, term, ROTATION + 1)
    return (
        u[0] + about_y * arm[2] - about_z * arm[1],
        u[1] + about_z * arm[0] - about_x * arm[2],
        u[2] + about_x * arm[1] - about_y * arm[0],
    )
