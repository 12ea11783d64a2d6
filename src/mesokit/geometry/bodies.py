"""Solids of any shape, as compiled code sees them: unions of intersections of primitives.

A *part* is a primitive or its complement, a *term* the intersection of parts, a *body* one or more
terms with one surface. The solid is the union of all terms. Every periodic image that reaches into
the box is a term of its own, and every cell of the box has a list of the terms near it: a particle
meets only those.
"""

from typing import NamedTuple

import numpy as np
from numba.cpython.unsafe.tuple import tuple_setitem

from mesokit.geometry import primitive
from mesokit.geometry.primitive import WIDTH
from mesokit.pointer import real, whole
from mesokit.scalar import elementwise, scalar, scaled, seldom

REACH = 1.0  # lists hold the terms within this distance of a cell; flights are cut into such pieces
NOBODY = -1


class Bodies(NamedTuple):
    """Parts, terms and bodies, and what is near each cell: addresses of tables (see `pointer`).

    size, inverse: tuples, lengths of the box and their inverses (0 along an axis that plates close).
    kinds, signs (parts,), numbers (parts, WIDTH): primitive, 1 or -1 for its complement, parameters.
    samples: what sampled primitives interpolate.
    first (terms + 1,): where the parts of each term start. body (terms,), pivot (terms, 3).
    surfaces (bodies, 8): rule, velocity (3), rate of rotation (3), whether virtual particles act.
    starts (cells + 1,), near: the terms near each cell of the box, x varying fastest.
    clear (offsets, collision cells + 1): square of the distance that every particle of a cell may
    fly before it meets a solid, for each offset of the grid (see `offset_of`).
    Tables hold float64 or, for numbers of things, int32; `clear` holds float32.
    """

    size: tuple[float, ...]
    inverse: tuple[float, ...]
    kinds: int
    signs: int
    numbers: int
    samples: int
    first: int
    body: int
    pivot: int
    surfaces: int
    starts: int
    near: int
    clear: int
    terms: int  # how many
    stride: float  # what hardly a particle flies beyond in a timestep


RULE, VELOCITY, ROTATION, FILLS, COLUMNS = 0, 1, 4, 7, 8  # of `surfaces`
NO_SLIP, SLIP, DIFFUSE = 0.0, 1.0, 2.0


@scalar
def in_box(solid, r):
    """The image of r in the box."""
    for k in range(len(r)):
        image = r[k] - np.floor(r[k] * solid.inverse[k]) * solid.size[k]
        # a coordinate just below 0 rounds up to the length of the box, which is the same place
        wrapped = image >= solid.size[k] and solid.inverse[k] > 0.0
        r = tuple_setitem(r, k, 0.0 if wrapped else image)
    return r


@scalar
def home_cell(solid, r):
    """Number of the unit cell of the box that holds r, which is in the box."""
    cell, stride = 0, 1
    for k in range(len(r)):
        length = int(solid.size[k])
        cell += min(max(int(np.floor(r[k])), 0), length - 1) * stride
        stride *= length
    return cell


@seldom
def part_clearance(solid, part, r):
    """Distance of r from one part, positive outside of it."""
    p = solid.numbers + 8 * WIDTH * part
    kind = whole(solid.kinds, part)
    return real(solid.signs, part) * primitive.distance(kind, p, solid.samples, r)


@seldom
def part_normal(solid, part, r):
    """Unit normal of one part, out of it."""
    p = solid.numbers + 8 * WIDTH * part
    kind = whole(solid.kinds, part)
    return scaled(real(solid.signs, part), primitive.normal(kind, p, solid.samples, r))


@seldom
def term_clearance(solid, term, r):
    """Distance of r from a term, and the part that gives it: the one that r is farthest out of."""
    widest, which = -np.inf, 0
    for part in range(whole(solid.first, term), whole(solid.first, term + 1)):
        c = part_clearance(solid, part, r)
        if c > widest:
            widest, which = c, part
    return widest, which


@seldom
def nearest(solid, r):
    """Clearance of r, which is in the box, and the part and term it is measured from.

    Where nothing is near, the clearance is REACH, a lower bound, and the term is NOBODY.
    """
    least, part, term = REACH, 0, NOBODY
    cell = home_cell(solid, r)
    for j in range(whole(solid.starts, cell), whole(solid.starts, cell + 1)):
        candidate = whole(solid.near, j)
        c, which = term_clearance(solid, candidate, r)
        if c < least:
            least, part, term = c, which, candidate
    return least, part, term


@elementwise
def from_pivot(solid, term, r):
    """r relative to the pivot of a term."""
    return "r[{k}] - real(solid.pivot, 3 * term + {k})"


@scalar
def surface_number(solid, term, column):
    """A number of the surface of the body that a term belongs to."""
    return real(solid.surfaces, whole(solid.body, term) * COLUMNS + column)


@scalar
def surface_velocity(solid, term, r):
    """Velocity of the surface of a body at r: along itself, and round its pivot."""
    u, arm = scaled(0.0, r), from_pivot(solid, term, r)
    for k in range(len(r)):
        u = tuple_setitem(u, k, surface_number(solid, term, VELOCITY + k))
    about_z = surface_number(solid, term, ROTATION + 2)
    if len(r) == 2:
        return (u[0] - about_z * arm[1], u[1] + about_z * arm[0])
    about_x = surface_number(solid, term, ROTATION)
    about_y = surface_number(solid, term, ROTATION + 1)
    return (
        u[0] + about_y * arm[2] - about_z * arm[1],
        u[1] + about_z * arm[0] - about_x * arm[2],
        u[2] + about_x * arm[1] - about_y * arm[0],
    )
