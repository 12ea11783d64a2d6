"""A unit cube cut by a plane: how much of it lies on either side, and how deep.

The height of a uniform point of the cube over the plane is a sum of uniform numbers of widths
|n_k|, whose distribution is known (Irwin 1927, Hall 1927).
"""

from numba.cpython.unsafe.tuple import tuple_setitem

from mesokit.scalar import seldom

FLAT = 1e-4  # components of the normal below this are taken for 0: they would cancel digits


@seldom
def heights(c, n, power):
    """Integral of (height)^(power - live) / (power - live)! over the part of the cube where the
    height is positive, c the height of the middle, live the components of n that are not 0."""
    total, product = 0.0, 1.0
    for k in range(len(n)):
        if abs(n[k]) > FLAT:
            total += abs(n[k])
            product *= abs(n[k])
    x, volume = c + 0.5 * total, 0.0
    for corner in range(1 << len(n)):
        shift, sign, counts = 0.0, 1.0, True
        for k in range(len(n)):
            if (corner >> k) & 1:
                counts = counts and abs(n[k]) > FLAT
                shift += abs(n[k])
                sign = -sign
        if counts and x > shift:
            step = x - shift
            term = sign
            for j in range(power):
                term *= step / (j + 1.0)
            volume += term
    return volume / product


@seldom
def live(n):
    """How many components are not 0."""
    found = 0
    for k in range(len(n)):
        if abs(n[k]) > FLAT:
            found += 1
    return found


@seldom
def share_beyond(c, n):
    """Part of the cube on the side to which the normal points, whose middle has the height c."""
    return min(max(heights(c, n, live(n)), 0.0), 1.0)


@seldom
def share_and_depth(c, n):
    """Part of the cube behind the plane, and the mean depth there (positive)."""
    back, deepest = n, -c
    for k in range(len(n)):
        back = tuple_setitem(back, k, -n[k])
        deepest += 0.5 * abs(n[k])
    powers = live(n)
    share = heights(-c, back, powers)
    if share < 1e-12:
        return 0.0, 0.0
    depth = heights(-c, back, powers + 1) / share  # of a tiny share, digits are lost
    return min(share, 1.0), min(max(depth, 0.0), deepest)
