"""Everything behind a plane: a point of it in p[0:3], the unit normal into the fluid in p[3:6]."""

from mesokit.geometry.primitive.numbers import offset, vector
from mesokit.scalar.jit import scalar
from mesokit.scalar.vector import dot

CONVEX = True


@scalar
def distance(p, samples, r):
    return dot(offset(p, r), vector(p, 3, r))


@scalar
def normal(p, samples, r):
    return vector(p, 3, r)
