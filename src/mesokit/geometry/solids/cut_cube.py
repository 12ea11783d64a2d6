"""A unit cube cut by a plane: how much of it lies on either side, and how deep.

The height of a uniform point of the cube over the plane is a sum of uniform numbers of widths
|n_k|, whose distribution is known (Irwin 1927, Hall 1927): a sum over corners of powers of their
heights, with signs. Components of the normal that are 0 take their corners and a power with them.
"""

from mesokit.scalar.jit import by_type, elementwise, scalar
from mesokit.scalar.vector import added

FLAT = 1e-4  # components of the normal below this are taken for 0: they would cancel digits


@elementwise
def widths(n):
    """Size of each component, 0 for those that are taken for 0."""
    return "(abs(n[{k}]) if abs(n[{k}]) > FLAT else 0.0)"


@scalar
def powers(height, weight):
    """Weight times h, h^2/2, h^3/6 and h^4/24 of a positive height; 0 below."""
    h = max(height, 0.0)
    one = weight * h
    two = one * h * 0.5
    three = two * h * (1.0 / 3.0)
    return one, two, three, three * h * 0.25


@by_type
def corners(height, weight, sizes):
    """Sums of the powers over the corners, from the highest, at that height, down."""
    if len(sizes) == 0:
        return lambda height, weight, sizes: powers(height, weight)

    def both_ends(height, weight, sizes):
        below = -weight if sizes[0] > 0.0 else 0.0
        return added(
            corners(height, weight, sizes[1:]), corners(height - sizes[0], below, sizes[1:])
        )

    return both_ends


@scalar
def moments(c, n):
    """Volume of the part of the cube where the height over the plane is positive, and the integral
    of the height over it; c is the height of the middle."""
    sizes, total, product, live = widths(n), 0.0, 1.0, 0.0
    for k in range(len(n)):
        total += sizes[k]
        product *= sizes[k] if sizes[k] > 0.0 else 1.0
        live += 1.0 if sizes[k] > 0.0 else 0.0
    one, two, three, four = corners(c + 0.5 * total, 1.0, sizes)
    volume = one if live < 1.5 else two if live < 2.5 else three
    moment = two if live < 1.5 else three if live < 2.5 else four
    return volume / product, moment / product


@scalar
def share_beyond(c, n):
    """Part of the cube on the side to which the normal points, whose middle has the height c."""
    volume, _ = moments(c, n)
    return min(max(volume, 0.0), 1.0)


@scalar
def share_and_depth(c, n):
    """Part of the cube behind the plane, and the mean depth there (positive)."""
    deepest = -c
    for k in range(len(n)):
        deepest += 0.5 * abs(n[k])
    share, moment = moments(-c, n)  # the sizes of the components tell nothing of their signs
    some = share >= 1e-12
    depth = moment / (share if some else 1.0)  # of a tiny share, digits are lost
    depth = min(max(depth, 0.0), deepest)
    return min(share, 1.0) if some else 0.0, depth if some else 0.0
