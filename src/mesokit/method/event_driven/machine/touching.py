"""When the surfaces of two spheres meet."""

import math

from mesokit.scalar.jit import scalar
from mesokit.scalar.vector import dot


@scalar
def touching(r, v, reach, growth):
    """The time after which |r + v t| = reach + growth t from above, infinite if never."""
    a = dot(v, v) - growth * growth
    b = dot(r, v) - reach * growth
    c = dot(r, r) - reach * reach
    square = b * b - a * c
    if b >= 0.0:
        late = c > 0.0 and a < 0.0 and square >= 0.0
        return (b + math.sqrt(square)) / -a if late else math.inf
    if square < 0.0:
        return math.inf
    return max(c, 0.0) / (math.sqrt(square) - b)
