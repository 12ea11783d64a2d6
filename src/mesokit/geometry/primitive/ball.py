"""Disk or sphere: centre in p[0:3], radius in p[6]."""

from mesokit.geometry.primitive.numbers import length, offset, unit
from mesokit.scalar.jit import scalar
from mesokit.scalar.pointer import real

CONVEX = True


@scalar
def distance(p, samples, r):
    return length(offset(p, r)) - real(p, 6)


@scalar
def normal(p, samples, r):
    return unit(offset(p, r))
