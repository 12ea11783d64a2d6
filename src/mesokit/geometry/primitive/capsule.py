"""All places within a radius p[6] of the straight line from p[0:3] to p[0:3] + p[3:6].

p[7] is one over the square of the line's length.
"""

from mesokit.geometry.primitive.numbers import length, offset, unit, vector
from mesokit.scalar.jit import scalar
from mesokit.scalar.pointer import real
from mesokit.scalar.vector import added_scaled, dot

CONVEX = True


@scalar
def from_line(p, r):
    """r relative to the nearest point of the line."""
    away, span = offset(p, r), vector(p, 3, r)
    along = min(max(dot(away, span) * real(p, 7), 0.0), 1.0)
    return added_scaled(away, -along, span)


@scalar
def distance(p, samples, r):
    return length(from_line(p, r)) - real(p, 6)


@scalar
def normal(p, samples, r):
    return unit(from_line(p, r))
