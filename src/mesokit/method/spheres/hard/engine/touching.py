"""When the surfaces of two spheres meet."""

import math

from mesokit.scalar.jit import scalar
from mesokit.scalar.vector import dot


@scalar
def touching(r, v, reach, growth):
    """The time after which |r + v t| = reach + growth t from above, infinite if never.

    Whether they meet is asked last, of numbers that are all there: a processor does many pairs at
    once as long as it need not guess.
    """
    a = dot(v, v) - growth * growth
    b = dot(r, v) - reach * growth
    c = dot(r, r) - reach * reach
    square = b * b - a * c
    root = math.sqrt(max(square, 0.0))
    if growth != 0.0 and b >= 0.0:
        return (b + root) / -a if c > 0.0 and a < 0.0 and square >= 0.0 else math.inf
    time = max(c, 0.0) / (root - b)
    return time if (b < 0.0) & (square >= 0.0) else math.inf
