"""Everything on one side of a cosine: p[across] + amplitude cos(2 pi waves along / length).

p[0:3] is a place where the cosine is largest, moved by the amplitude to its mean height; p[3] and
p[4] number the axes along and across, p[5] is the amplitude, p[6] the waves per length, p[7] is 1
where the fluid lies above and -1 where it lies below.
"""

import math

from mesokit.scalar.elementary import sincos_turn
from mesokit.scalar.intrinsics import floor, with_item
from mesokit.scalar.jit import scalar
from mesokit.scalar.pointer import real
from mesokit.scalar.vector import scaled

CONVEX = False


@scalar
def height_and_slope(p, r):
    """Height above the curve, and the slope of the curve there."""
    along, across = int(real(p, 3)), int(real(p, 4))
    phase = (r[along] - real(p, along)) * real(p, 6)
    s, c = sincos_turn(phase - floor(phase))
    height = r[across] - real(p, across) - real(p, 5) * c
    return height, -real(p, 5) * 2.0 * math.pi * real(p, 6) * s


@scalar
def distance(p, samples, r):
    """No more than the distance of r, and of its sign: height over the steepest slope."""
    height, _ = height_and_slope(p, r)
    steepest = 2.0 * math.pi * real(p, 5) * real(p, 6)
    return real(p, 7) * height / math.sqrt(1.0 + steepest * steepest)


@scalar
def normal(p, samples, r):
    _, slope = height_and_slope(p, r)
    size = real(p, 7) / math.sqrt(1.0 + slope * slope)
    out = with_item(scaled(0.0, r), int(real(p, 4)), size)
    return with_item(out, int(real(p, 3)), -slope * size)
