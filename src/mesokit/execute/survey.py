"""What is near which cell: the tables that spare particles the search for solids.

Loops over cells and terms, run once when a case is built. Points come as rows of an array.
"""

import math

import numpy as np
from numba.cpython.unsafe.tuple import tuple_setitem

from mesokit.execute.cache import kernel
from mesokit.geometry.bodies import (
    REACH,
    in_box,
    nearest,
    nearest_within,
    part_normal,
    term_clearance,
)
from mesokit.geometry.cut_cube import share_beyond
from mesokit.scalar import dot, scalar, scaled, seldom


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
        c, part, term = nearest_within(solid.tables, away, r)
        terms[i], clearance[i] = term, c
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
def planes(solid, like, away, shifts, points, open_share, normals, heights, terms, feet):
    """The plane that cuts unit cubes about the points as the solid does: it has the normal of the
    surface nearest to the middle, and leaves `open_share` of the cube to the fluid in the mean over
    the shifts. Terms are -1 where no surface is within `away`.
    """
    for i in range(len(points)):
        r = in_box(solid, point(points, i, like))
        c, part, term = nearest_within(solid.tables, away, r)
        terms[i] = term
        if term < 0:
            continue
        n = part_normal(solid.tables, part, r)
        low, high = -2.0, 2.0  # no corner of a shifted cube is farther from the middle
        for _ in range(40):
            middle, share = 0.5 * (low + high), 0.0
            for j in range(len(shifts)):
                share += share_beyond(middle - dot(n, point(shifts, j, like)), n)
            if share < open_share[i] * len(shifts):
                low = middle
            else:
                high = middle
        heights[i] = 0.5 * (low + high)
        for k in range(len(like)):
            normals[i, k] = n[k]
            feet[i, k] = r[k] - c * n[k]
