"""Signed distance from a closed surface of triangles, or a closed outline of straight pieces.

Each simplex is measured from the points of the grid around it. Which side a point is on follows
from how often the line along the last axis that ends there crosses the surface.
"""

import math

import numpy as np
from numpy.typing import NDArray

from mesokit.scalar.intrinsics import floor, with_item
from mesokit.scalar.jit import scalar, seldom
from mesokit.scalar.vector import added, added_scaled, dot, outer, scaled

Floats = NDArray[np.float64]
ASIDE = 1e-7  # spacings that lines pass the grid's points by, so that they miss all edges


def signed_distance(
    simplices: Floats,
    origin: tuple[float, ...],
    counts: tuple[int, ...],
    spacing: float,
    reach: float,
) -> Floats:
    """Signed distance, at most `reach`, at the points of a grid, positive outside.

    simplices (n, d, d): the corners of each.

    >>> square = np.array([[[0, 0], [2, 0]], [[2, 0], [2, 2]], [[2, 2], [0, 2]], [[0, 2], [0, 0]]])
    >>> signed_distance(square.astype(float), (-1.0, 1.0), (5, 1), 1.0, 9.0).ravel().tolist()
    [1.0, 0.0, -1.0, 0.0, 1.0]
    """
    corners = np.ascontiguousarray((simplices - np.array(origin)) / spacing)
    squares = np.full(math.prod(counts), (reach / spacing) ** 2)
    crossings = np.zeros(math.prod(counts), np.uint8)
    pattern = (0.0,) * len(counts)
    measure(corners, counts, reach / spacing, squares, pattern)
    cross(corners - ASIDE * np.sqrt(np.arange(2.0, len(counts) + 2.0)), counts, crossings, pattern)
    inside = np.cumsum(crossings.reshape(counts), axis=-1) % 2 == 1
    distance = spacing * np.sqrt(squares).reshape(counts)
    return np.where(inside & (distance > 0.0), -distance, distance)


@scalar
def corner_of(corners, i, j, pattern):
    """Corner j of simplex i, as a tuple."""
    for k in range(len(pattern)):
        pattern = with_item(pattern, k, corners[i, j, k])
    return pattern


@scalar
def square_to_edge(r, a, b):
    """Square of the distance of r from the straight piece between a and b."""
    span, away = added_scaled(b, -1.0, a), added_scaled(r, -1.0, a)
    along = dot(away, span) / max(dot(span, span), 1e-300)
    off = added_scaled(away, -min(max(along, 0.0), 1.0), span)
    return dot(off, off)


@scalar
def square_to_face(r, a, b, c):
    """Square of the distance of r from a triangle."""
    least = min(square_to_edge(r, a, b), square_to_edge(r, b, c), square_to_edge(r, c, a))
    ab, bc, ca = added_scaled(b, -1.0, a), added_scaled(c, -1.0, b), added_scaled(a, -1.0, c)
    n, away = outer(ab, bc), added_scaled(r, -1.0, a)
    above = dot(outer(ab, away), n) >= 0.0
    above &= dot(outer(bc, added_scaled(r, -1.0, b)), n) >= 0.0
    above &= dot(outer(ca, added_scaled(r, -1.0, c)), n) >= 0.0
    size = dot(n, n)
    height = dot(n, away)
    return min(least, height * height / size) if above and size > 0.0 else least


@seldom
def measure(corners, counts, reach, squares, pattern):
    """Lower the squares of distances to those from each simplex."""
    d = len(pattern)
    # Simplex by simplex: only grid points in its bounding box, widened by the reach. So the work is
    # that of the surface, not of the volume. The least square is left at each point. Lengths are
    # spacings.
    for i in range(len(corners)):
        low, wide, total = counts, counts, 1
        for k in range(d):
            least, most = corners[i, 0, k], corners[i, 0, k]
            for j in range(1, d):
                least, most = min(least, corners[i, j, k]), max(most, corners[i, j, k])
            begin = max(int(np.ceil(least - reach)), 0)
            end = min(int(floor(most + reach)) + 1, counts[k])
            low, wide = with_item(low, k, begin), with_item(wide, k, max(end - begin, 0))
            total *= wide[k]
        a, b = corner_of(corners, i, 0, pattern), corner_of(corners, i, 1, pattern)
        for number in range(total):
            r, rest, place, stride = pattern, number, 0, 1
            for back in range(d):
                k = d - 1 - back
                n = low[k] + rest % wide[k]
                rest //= wide[k]
                r = with_item(r, k, float(n))
                place += n * stride
                stride *= counts[k]
            if d == 2:
                square = square_to_edge(r, a, b)
            else:
                square = square_to_face(r, a, b, corner_of(corners, i, d - 1, pattern))
            squares[place] = min(squares[place], square)


@seldom
def cross(corners, counts, crossings, pattern):
    """Count, at the first point beyond each crossing, where lines along the last axis cross."""
    d = len(pattern)
    # Lines of grid points along the last axis. Each crossing is counted at the first point above
    # it; the caller's running sum along the line is odd inside. Corners are moved by ASIDE, so that
    # no line passes through an edge and is counted twice or not at all.
    for i in range(len(corners)):
        low, wide, total = counts, counts, 1
        for k in range(d - 1):
            least, most = corners[i, 0, k], corners[i, 0, k]
            for j in range(1, d):
                least, most = min(least, corners[i, j, k]), max(most, corners[i, j, k])
            begin = max(int(np.ceil(least)), 0)
            end = min(int(floor(most)) + 1, counts[k])
            low, wide = with_item(low, k, begin), with_item(wide, k, max(end - begin, 0))
            total *= wide[k]
        a, b = corner_of(corners, i, 0, pattern), corner_of(corners, i, 1, pattern)
        c = corner_of(corners, i, d - 1, pattern)
        for number in range(total):
            x = float(low[0] + number % wide[0])
            y = float(low[1] + number // wide[0]) if d == 3 else 0.0
            hit, height = height_on_edge(x, a, b) if d == 2 else height_on_face(x, y, a, b, c)
            first = max(int(np.ceil(height)), 0) if hit else counts[d - 1]
            if first < counts[d - 1]:
                line = int(x) if d == 2 else int(x) * counts[1] + int(y)
                crossings[line * counts[d - 1] + first] += 1


@scalar
def height_on_edge(x, a, b):
    """Whether the line at x crosses a straight piece, and where."""
    hit = (a[0] <= x) != (b[0] <= x)
    share = (x - a[0]) / (b[0] - a[0]) if hit else 0.0
    return hit, a[1] + share * (b[1] - a[1])


@scalar
def height_on_face(x, y, a, b, c):
    """Whether the line at (x, y) crosses a triangle, and where."""
    ab = (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])
    bc = (c[0] - b[0]) * (y - b[1]) - (c[1] - b[1]) * (x - b[0])
    ca = (a[0] - c[0]) * (y - c[1]) - (a[1] - c[1]) * (x - c[0])
    area = ab + bc + ca
    hit = (min(ab, bc, ca) >= 0.0 or max(ab, bc, ca) <= 0.0) and area != 0.0
    top = added(added(scaled(bc, a), scaled(ca, b)), scaled(ab, c))
    return hit, top[len(top) - 1] / area if hit else 0.0
