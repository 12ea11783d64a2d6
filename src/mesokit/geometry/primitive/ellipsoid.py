"""Ellipse or ellipsoid of revolution: centre in p[0:3], unit vector of the axis in p[3:6].

p[6] is half its length along the axis, p[7] half its width across it. With e the shorter half and
f the longer, and y and z the coordinates of r along them, the nearest place is (e Y, f Z) with
Y = y / (e w), Z = z f / (e^2 (w + k)), where k = (f / e)^2 - 1 and w > 0 makes it a unit vector.
"""

import math
from collections.abc import Sequence

import numpy as np

from mesokit.geometry.primitive.moments import Integrals, plane
from mesokit.geometry.primitive.numbers import length, offset, vector
from mesokit.scalar.intrinsics import with_item
from mesokit.scalar.jit import scalar, seldom
from mesokit.scalar.pointer import real
from mesokit.scalar.vector import added_scaled, dot, scaled

CONVEX = True
ROUND = True
LEAST = 1e-20  # halves: no place counts as nearer to the plane across the shorter half
MOST_TRIES = 100
CONVERGED = 1e-9  # relative: the step after one so small would be less than rounding


@scalar
def across_axis(a, axis):
    """The part of a vector across a unit vector."""
    return added_scaled(a, -dot(a, axis), axis)


@seldom
def nearest(short, long, y, z):
    """Signed distance of (y, z), both >= 0, from the ellipse with these halves, and its normal."""
    ratio = (long / short) * (long / short)
    k, y, z = ratio - 1.0, max(y / short, LEAST), ratio * (z / long)
    w = max(y, z - k)
    # Newton's method for 1 / |(Y, Z)| = 1. The left side rises with w, and bends downwards: from
    # the start, where it is at most 1, all steps go up, and none goes too far.
    for _ in range(MOST_TRIES):
        a, b = y / w, z / (w + k)
        square = a * a + b * b
        step = square * (math.sqrt(square) - 1.0) / (a * a / w + b * b / (w + k))
        w = max(w + step, y)
        if abs(step) < CONVERGED * w:
            break
    a, b = y / w / short, z / (w + k) / long
    steep = math.sqrt(a * a + b * b)
    return (w - 1.0) * short * short * steep, a / steep, b / steep


@scalar
def from_surface(p, height, radius):
    """Signed distance from the surface, and the normal there along and across the axis.

    The place is that far from the centre along the axis, and from the axis.
    """
    along, across = real(p, 6), real(p, 7)
    if along < across:
        return nearest(along, across, abs(height), radius)
    c, n, m = nearest(across, along, radius, abs(height))
    return c, m, n


@scalar
def distance(p, samples, r):
    away, axis = offset(p, r), vector(p, 3, r)
    c, _, _ = from_surface(p, dot(away, axis), length(across_axis(away, axis)))
    return c


@scalar
def nearer(p, samples, r, reach):
    """Whether the distance is below a reach: by bounds of it, and by itself between these.

    Where r is 1 + x times as far from the centre as the surface on the same ray, the distance has
    the sign of x. Its size is at least |x| times the shorter half, and at most the rest of the ray.
    """
    away, axis = offset(p, r), vector(p, 3, r)
    height, out = dot(away, axis), length(across_axis(away, axis))
    along, across = height / real(p, 6), out / real(p, 7)
    times = math.sqrt(along * along + across * across)
    rest = length(away) * (1.0 - 1.0 / max(times, 1e-300))
    least = (times - 1.0) * min(real(p, 6), real(p, 7))
    if min(least, rest) >= reach:
        return False
    if max(least, rest) < reach:
        return True
    c, _, _ = from_surface(p, height, out)
    return c < reach


@scalar
def normal(p, samples, r):
    _, out = facing(p, samples, r)
    return out


@scalar
def facing(p, samples, r):
    away, axis = offset(p, r), vector(p, 3, r)
    height, out = dot(away, axis), across_axis(away, axis)
    radius = length(out)
    if radius <= 1e-15 * abs(height):  # on the axis: the axis of the box that is most across it
        most = 0
        for k in range(1, len(r)):
            most = k if abs(axis[k]) < abs(axis[most]) else most
        out = with_item(scaled(0.0, r), most, 1.0)
    out = across_axis(out, axis)  # again: what is left of a place near the axis is rounded
    c, n, m = from_surface(p, height, radius)
    return c, added_scaled(scaled(math.copysign(n, height), axis), m / length(out), out)


def extent(p: Sequence[float]) -> float:
    """How far it reaches from its centre."""
    return max(p[6], p[7])


def width(p: Sequence[float]) -> float:
    """Its least width."""
    return 2.0 * min(p[6], p[7])


def integrals(p: Sequence[float], d: int) -> Integrals:
    """Volume, centre and second moments about the centre, in d dimensions."""
    volume = math.pi * p[6] * p[7] * (1.0 if d == 2 else 4.0 / 3.0 * p[7])
    along = np.outer(p[3:6], p[3:6])
    second = p[6] ** 2 * along + p[7] ** 2 * (plane(d) - along)
    return Integrals(volume, np.array(p[:3]), volume / (d + 2) * second)
