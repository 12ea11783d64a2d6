"""The solids near each cell: tables by which particles skip the search for solids.

Loops over cells and terms, run once when a case is built. Points come as rows of an array.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from mesokit.geometry.solids import bodies
from mesokit.geometry.solids.bodies import REACH, Bodies
from mesokit.geometry.solids.cut_cube import share_beyond
from mesokit.kernels.later import kernel
from mesokit.scalar.intrinsics import floor, with_item
from mesokit.scalar.jit import scalar, seldom
from mesokit.scalar.vector import dot, row, scaled

SLACK = 1e-9  # cells: sums of lengths are rounded


class Blocks(NamedTuple):
    """Cubes of cells that fill the box, and the terms that may matter to a cell of each."""

    edge: int  # cells
    starts: Any  # where the list of each begins in `near`
    near: Any
    least: Any  # clearance of the middle of each: a bound of the distance, from below


@scalar
def block_centre(block, edge, solid, pattern):
    """Middle of a cube of cells; x varies fastest."""
    for k in range(len(pattern)):
        along = -(-int(solid.size[k]) // edge)
        pattern = with_item(pattern, k, (block % along + 0.5) * edge)
        block //= along
    return pattern


@scalar
def block_at(r, edge, solid):
    """Number of the cube of cells around a place."""
    block, stride = 0, 1
    for k in range(len(r)):
        block += int(r[k]) // edge * stride
        stride *= -(-int(solid.size[k]) // edge)
    return block


@kernel
def near_blocks(solid, pattern, away, above, blocks):
    """Count the terms near each block of cells, or list them once `near` has room.

    A term is near if it may be within `away` of any part of a cell, or the nearest to the middle of
    one; only terms near the block above are tried. A clearance is at most the distance, and changes
    no faster than the place: all other terms are farther away from every cell of the block.
    """
    span = 0.5 * math.sqrt(float(len(pattern)))
    inside = span * (blocks.edge - 1)  # from the middle of the block to that of a cell
    # Coarse to fine: a block looks only at the terms of the larger block above it. It runs twice,
    # to count (`near` is empty) and to write. The bound must hold for all cells of the block, hence
    # the distance from its middle to theirs is added.
    for block in range(len(blocks.starts) - 1):
        r = block_centre(block, blocks.edge, solid, pattern)
        parent = block_at(r, above.edge, solid)
        first, last = above.starts[parent], above.starts[parent + 1]
        if len(blocks.near) == 0:
            closest = math.inf
            for place in range(first, last):
                c, _ = bodies.term_clearance(solid.tables, above.near[place], r)
                closest = min(closest, c)
            # nothing that was left out of the list is nearer than this
            blocks.least[block] = min(
                closest, above.least[parent] + SLACK + span * (above.edge - 1)
            )
        limit = span + away + inside
        if blocks.edge > 1:
            limit = max(limit, blocks.least[block] + 2.0 * inside)
        found = 0
        for place in range(first, last):
            term = above.near[place]
            c, _ = bodies.term_clearance(solid.tables, term, r)
            if c <= limit:
                if len(blocks.near) > 0:
                    blocks.near[blocks.starts[block] + found] = term
                found += 1
        if len(blocks.near) == 0:
            blocks.starts[block + 1] = blocks.starts[block] + found


@kernel
def term_clearances(solid, r, out):
    """Clearance of one place from each term."""
    for term in range(len(out)):
        out[term], _ = bodies.term_clearance(solid.tables, term, r)


@kernel
def clearances(solid, least, pattern, points, out):
    """A lower bound of the distance of each point from the solid, exact within REACH."""
    for i in range(len(points)):
        out[i] = bound(solid, least, bodies.in_box(solid, row(points, i, pattern)), pattern)


@seldom
def bound(solid, least, r, pattern):
    """Clearance of r, in the box; far from all solids, what the middle of its cell lets it have."""
    c, _, _ = bodies.nearest(solid.tables, r)
    if c < REACH:
        return c
    cell, stride, away = 0, 1, 0.0
    for k in range(len(pattern)):
        length = int(solid.size[k])
        i = min(max(int(floor(r[k])), 0), length - 1)
        cell += i * stride
        stride *= length
        away += (r[k] - i - 0.5) ** 2
    return max(c, least[cell] - math.sqrt(away))


def nearest_surfaces(solid: Bodies, points: Any, away: float = REACH) -> tuple[Any, Any, Any]:
    """Nearest term (-1: none so near), clearance (n,) and normal (n, d) at points (n, d).

    They are exact up to `away` if the lists of the solid reach so far.
    """
    terms, clearance = np.zeros(len(points), np.int64), np.zeros(len(points))
    normals = np.zeros(points.shape)
    find_nearest(solid, (0.0,) * points.shape[1], away, points, terms, clearance, normals)
    return terms, clearance, normals


@kernel
def find_nearest(solid, pattern, away, points, terms, clearance, normals):
    """Loop of `nearest_surfaces`."""
    for i in range(len(points)):
        r = bodies.in_box(solid, row(points, i, pattern))
        c, part, term = bodies.nearest_within(solid.tables, away, r)
        terms[i], clearance[i] = term, c
        n = bodies.part_normal(solid.tables, part, r) if term >= 0 else scaled(0.0, pattern)
        for k in range(len(pattern)):
            normals[i, k] = n[k]


@kernel
def cut(solid, pattern, points, half, pieces, out):
    """Whether cubes of half a side `half` about the points hold both fluid and solid, as far as
    pieces of them, so many along each axis, can tell; 1 if they may, else 0."""
    d = len(pattern)
    small = half / pieces
    corner = small * math.sqrt(float(d))
    # A clearance changes no more than the place does. So a cube is all fluid or all solid if its
    # middle is farther from the surface than its corners. Else its small cubes decide in the same
    # way.
    for i in range(len(points)):
        c, _, _ = bodies.nearest(solid.tables, bodies.in_box(solid, row(points, i, pattern)))
        whole = half * math.sqrt(float(d))
        if abs(c) > whole:
            out[i] = 0
            continue
        fluid, inside = False, False
        for number in range(pieces**d):
            r, rest = row(points, i, pattern), number
            for k in range(d):
                step = 2.0 * (rest % pieces) + 1.0 - pieces
                r = with_item(r, k, r[k] + small * step)
                rest //= pieces
            c, _, _ = bodies.nearest(solid.tables, bodies.in_box(solid, r))
            fluid |= c > -corner
            inside |= c < corner
        out[i] = 1 if fluid and inside else 0


@kernel
def open_volume(solid, pattern, points, side, out):
    """Part of cubes about the points that is fluid: cubes cut by a plane, the nearest surface."""
    for i in range(len(points)):
        r = bodies.in_box(solid, row(points, i, pattern))
        c, part, term = bodies.nearest(solid.tables, r)
        if term < 0:
            out[i] = 1.0
            continue
        n = bodies.part_normal(solid.tables, part, r)
        out[i] = share_beyond(c / side, n)


class Planes(NamedTuple):
    """Results of `planes` for each cube: normal of its plane, height of its middle over the plane,
    term of the surface (-1 for none), and place on the surface nearest to the middle."""

    normals: Any
    heights: Any
    terms: Any
    feet: Any


@kernel
def planes(solid, pattern, away, shifts, points, open_share, found):
    """The plane that cuts unit cubes about the points as the solid does: it has the normal of the
    surface nearest to the middle, and leaves `open_share` of the cube to the fluid in the mean over
    the shifts. Terms are -1 where no surface is within `away`.
    """
    # One cut cell at a time. The fluid's share rises with the height of the middle over the plane,
    # so bisection finds this height; 40 halvings of 4 cells leave 4e-12. The share is right in the
    # mean over shifts, not for each shift.
    for i in range(len(points)):
        r = bodies.in_box(solid, row(points, i, pattern))
        c, part, term = bodies.nearest_within(solid.tables, away, r)
        found.terms[i] = term
        if term < 0:
            continue
        n = bodies.part_normal(solid.tables, part, r)
        low, high = -2.0, 2.0  # no corner of a shifted cube is farther from the middle
        for _ in range(40):
            middle, share = 0.5 * (low + high), 0.0
            for j in range(len(shifts)):
                share += share_beyond(middle - dot(n, row(shifts, j, pattern)), n)
            if share < open_share[i] * len(shifts):
                low = middle
            else:
                high = middle
        found.heights[i] = 0.5 * (low + high)
        for k in range(len(pattern)):
            found.normals[i, k] = n[k]
            found.feet[i, k] = r[k] - c * n[k]
