"""Disk or sphere: centre in p[0:3], radius in p[6]."""

from mesokit.geometry.primitive.numbers import length, offset, unit
from mesokit.scalar.jit import scalar
from mesokit.scalar.pointer import real

CONVEX = True


@scalar
def distance(p, samples, r):
    """Signed distance of r."""
    return length(offset(p, r)) - real(p, 6)


@scalar
def normal(p, samples, r):
    """Unit normal into the fluid at r, or next to it."""
    return unit(offset(p, r))
