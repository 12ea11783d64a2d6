"""Cylinder without ends: a point of its axis in p[0:3], unit vector in p[3:6], radius in p[6]."""

from mesokit.geometry.primitive.numbers import length, offset, unit, vector
from mesokit.scalar.jit import scalar
from mesokit.scalar.pointer import real
from mesokit.scalar.vector import added_scaled, dot

CONVEX = True


@scalar
def from_axis(p, r):
    """r relative to the nearest point of the axis."""
    away, axis = offset(p, r), vector(p, 3, r)
    return added_scaled(away, -dot(away, axis), axis)


@scalar
def distance(p, samples, r):
    return length(from_axis(p, r)) - real(p, 6)


@scalar
def normal(p, samples, r):
    return unit(from_axis(p, r))
