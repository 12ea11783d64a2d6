"""Planes above which there is no solid near a place: a flight above one needs no search.

Loops run once when a case is built. Points come as rows of an array.
"""

import math

from mesokit.geometry.solids import bodies
from mesokit.geometry.solids.flight import curves_away
from mesokit.kernels.kernel import kernel
from mesokit.scalar.intrinsics import with_item
from mesokit.scalar.jit import by_type, seldom
from mesokit.scalar.pointer import whole, word
from mesokit.scalar.vector import added_scaled, dot, outer, row, scaled


@kernel
def planes_above(solid, pattern, away, columns, points, planes):
    """Normal and height n r of a plane above which no solid is within `away` of each point."""
    d = len(pattern)
    # The normal is that of the nearest surface. If nothing else is within `away` and the part is
    # convex, its tangent plane is the highest; else columns are probed.
    for i in range(len(points)):
        r = row(points, i, pattern)
        c, part, term = bodies.nearest(solid.tables, r)
        n = with_item(scaled(0.0, pattern), 0, 1.0)
        top = away
        if term != bodies.NO_TERM:
            n = bodies.part_normal(solid.tables, part, r)
            alone = True
            for j in bodies.near_places(solid.tables, r):
                other, _ = bodies.term_clearance(
                    solid.tables, whole(word(solid.tables, bodies.NEAR), j), r
                )
                alone &= other >= away or whole(word(solid.tables, bodies.NEAR), j) == term
            if alone and curves_away(solid.tables, part):
                top = -c
            else:
                top = highest(solid, r, n, away, columns)
        for k in range(d):
            planes[i, k] = n[k]
        planes[i, d] = dot(n, r) + top


@seldom
def highest(solid, r, n, away, columns):
    """A bound of the highest solid above r in the direction n, within a ball, from columns."""
    d, side = len(r), 2.0 * away / columns
    half = 0.5 * side * math.sqrt(d - 1.0)
    top = -away
    # Columns along n fill the ball. Each is followed down its axis by balls without solid: a ball
    # of radius c clears the column over sqrt(c^2 - half^2). It ends where the ball is not wider
    # than the column, or below the highest end so far.
    for number in range(columns ** (d - 1)):
        foot, rest = r, number
        for k in range(d - 1):
            step = side * (rest % columns + 0.5) - away
            foot = added_scaled(foot, step, across(n, k))
            rest //= columns
        t = away
        while t > top:
            c, _, _ = bodies.nearest(solid.tables, bodies.in_box(solid, added_scaled(foot, t, n)))
            if c <= 1.01 * half:
                break
            t -= math.sqrt(c * c - half * half)
        top = max(top, t)
    return top


@by_type
def across(n, k):
    """The kth direction at a right angle to n."""
    return (lambda n, k: (-n[1], n[0])) if len(n) == 2 else _across_3d


def _across_3d(n, k):
    least = 0
    for j in range(1, 3):
        least = j if abs(n[j]) < abs(n[least]) else least
    first = outer(n, with_item((0.0, 0.0, 0.0), least, 1.0))
    first = scaled(1.0 / math.sqrt(dot(first, first)), first)
    return first if k == 0 else outer(n, first)
