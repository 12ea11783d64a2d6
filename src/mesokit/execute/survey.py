"""What is near which cell: the tables that spare particles the search for solids.

Loops over cells and terms, run once when a case is built. Points come as rows of an array.
"""

import math

import numpy as np
from numba.cpython.unsafe.tuple import tuple_setitem

from mesokit.execute.cache import kernel
from mesokit.geometry.bodies import (
    NEAR,
    REACH,
    STARTS,
    home_cell,
    in_box,
    nearest,
    part_normal,
    term_clearance,
)
from mesokit.geometry.cut_cube import share_beyond
from mesokit.pointer import whole, word
from mesokit.scalar import scalar, scaled, seldom


@scalar
def point(points, i, like):
    """Row i as a tuple."""
    for k in range(len(like)):
        like = tuple_setitem(like, k, points[i, k])
    return like


@scalar
def centre_of(cell, solid, like):
    """Middle of a unit cell of the box; x varies fastest."""
    for k in range(len(like)):
        length = int(solid.size[k])
        like = tuple_setitem(like, k, cell % length + 0.5)
        cell //= length
    return like


@kernel
def near_cells(solid, terms, like, away, starts, near, least):
    """Count, or list once `near` has room, the terms `away` or nearer from any part of each cell;
    and the least clearance of its middle."""
    reach = 0.5 * math.sqrt(float(len(like))) + away
    cells = len(starts) - 1
    for cell in range(cells):
        r, found, closest = centre_of(cell, solid, like), 0, math.inf
        for term in range(terms):
            c, _ = term_clearance(solid.tables, term, r)
            closest = min(closest, c)
            if c <= reach:
                if len(near) > 0:
                    near[starts[cell] + found] = term
                found += 1
        least[cell] = closest
        if len(near) == 0:
            starts[cell + 1] = starts[cell] + found


@kernel
def term_clearances(solid, r, out):
    """Clearance of one place from each term."""
    for term in range(len(out)):
        out[term], _ = term_clearance(solid.tables, term, r)


@kernel
def clearances(solid, least, like, points, out):
    """A lower bound of the distance of each point from the solid, exact within REACH."""
    for i in range(len(points)):
        out[i] = bound(solid, least, in_box(solid, point(points, i, like)), like)


@seldom
def bound(solid, least, r, like):
    """Clearance of r, in the box; far from all solids, what the middle of its cell lets it have."""
    c, _, _ = nearest(solid.tables, r)
    if c < REACH:
        return c
    cell, stride, away = 0, 1, 0.0
    for k in range(len(like)):
        length = int(solid.size[k])
        i = min(max(int(np.floor(r[k])), 0), length - 1)
        cell += i * stride
        stride *= length
        away += (r[k] - i - 0.5) ** 2
    return max(c, least[cell] - math.sqrt(away))


@kernel
def who_is_near(solid, like, points, terms, clearance, normals):
    """Nearest term (-1: none within reach), clearance and normal at each point."""
    for i in range(len(points)):
        r = in_box(solid, point(points, i, like))
        c, part, term = nearest(solid.tables, r)
        terms[i], clearance[i] = term, c
        n = part_normal(solid.tables, part, r) if term >= 0 else scaled(0.0, like)
        for k in range(len(like)):
            normals[i, k] = n[k]


@kernel
def depths(solid, like, away, points, terms, clearance, normals):
    """Nearest term (-1: none so near), clearance and normal at each point, exact up to `away` if
    the lists of the solid are."""
    for i in range(len(points)):
        r = in_box(solid, point(points, i, like))
        cell, least, part, term = home_cell(solid.tables, r), away, 0, -1
        starts = word(solid.tables, STARTS)
        for j in range(whole(starts, cell), whole(starts, cell + 1)):
            candidate = whole(word(solid.tables, NEAR), j)
            c, which = term_clearance(solid.tables, candidate, r)
            if c < least:
                least, part, term = c, which, candidate
        terms[i], clearance[i] = term, least
        n = part_normal(solid.tables, part, r) if term >= 0 else scaled(0.0, like)
        for k in range(len(like)):
            normals[i, k] = n[k]


@kernel
def cut(solid, like, points, half, pieces, out):
    """Whether cubes of half a side `half` about the points hold both fluid and solid, as far as
    pieces of them, so many along each axis, can tell; 1 if they may, else 0."""
    d = len(like)
    small = half / pieces
    corner = small * math.sqrt(float(d))
    for i in range(len(points)):
        c, _, _ = nearest(solid.tables, in_box(solid, point(points, i, like)))
        whole = half * math.sqrt(float(d))
        if abs(c) > whole:
            out[i] = 0
            continue
        fluid, inside = False, False
        for number in range(pieces**d):
            r, rest = point(points, i, like), number
            for k in range(d):
                step = 2.0 * (rest % pieces) + 1.0 - pieces
                r = tuple_setitem(r, k, r[k] + small * step)
                rest //= pieces
            c, _, _ = nearest(solid.tables, in_box(solid, r))
            fluid |= c > -corner
            inside |= c < corner
        out[i] = 1 if fluid and inside else 0


@kernel
def open_volume(solid, like, points, side, out):
    """Part of cubes about the points that is fluid: cubes cut by a plane, the nearest surface."""
    for i in range(len(points)):
        r = in_box(solid, point(points, i, like))
        c, part, term = nearest(solid.tables, r)
        if term < 0:
            out[i] = 1.0
            continue
        n = part_normal(solid.tables, part, r)
        out[i] = share_beyond(c / side, n)


@kernel
def planes(solid, like, points, open_share, normals, heights, terms, feet):
    """The plane that cuts unit cubes about the points as the solid does: it has the normal of the
    surface nearest to the middle, and leaves `open_share` of the cube to the fluid."""
    for i in range(len(points)):
        r = in_box(solid, point(points, i, like))
        c, part, term = nearest(solid.tables, r)
        n = part_normal(solid.tables, part, r)
        low, high = -1.0, 1.0  # no corner of the cube is farther from its middle
        for _ in range(50):
            middle = 0.5 * (low + high)
            if share_beyond(middle, n) < open_share[i]:
                low = middle
            else:
                high = middle
        heights[i], terms[i] = 0.5 * (low + high), term
        for k in range(len(like)):
            normals[i, k] = n[k]
            feet[i, k] = r[k] - c * n[k]
