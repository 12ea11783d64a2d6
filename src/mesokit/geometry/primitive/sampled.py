"""A signed distance given on a grid, linear between its points.

p[0:3] is the first point, p[3] the spacing, p[4:7] the points along each axis, p[7] where they
start among the samples (the last axis varies fastest), p[8] the steepest gradient, p[9:12] is 1
along an axis on which the grid repeats itself, 0 where beyond it there is only fluid.
"""

import math

import numpy as np

from mesokit.geometry.primitive.numbers import length, unit
from mesokit.scalar.intrinsics import floor, with_item
from mesokit.scalar.jit import scalar
from mesokit.scalar.pointer import real
from mesokit.scalar.vector import dot, scaled

CONVEX = False


@scalar
def inside_grid(p, r):
    """r in spacings from the first point, brought onto the grid, and how far it was off."""
    x, off = r, scaled(0.0, r)
    for k in range(len(r)):
        count = real(p, 4 + k)
        q = (r[k] - real(p, k)) / real(p, 3)
        if real(p, 9 + k) > 0.5:
            q -= count * floor(q / count)
        else:
            near = min(max(q, 0.0), count - 1.0)
            off = with_item(off, k, (q - near) * real(p, 3))
            q = near
        x = with_item(x, k, q)
    return x, off


@scalar
def corner(p, samples, base, which):
    """The sample at a corner of a cell of the grid: bit k of `which` is the step along axis k."""
    place = 0
    for k in range(len(base)):
        count = int(real(p, 4 + k))
        i = int(base[k]) + ((which >> k) & 1)
        i = (i - count if real(p, 9 + k) > 0.5 else count - 1) if i >= count else i
        place = place * count + i
    return real(samples, int(real(p, 7)) + place)


@scalar
def split(x):
    """The first point of the cell of the grid that x is in, and how far from it x is."""
    base, part = x, x
    for k in range(len(x)):
        base = with_item(base, k, floor(x[k]))
        part = with_item(part, k, x[k] - floor(x[k]))
    return base, part


@scalar
def interpolated(p, samples, x):
    """Value between the samples, and its gradient per spacing."""
    base, part = split(x)
    value, gradient = 0.0, scaled(0.0, x)
    # Multilinear interpolation over the 2^d corners. The gradient has the same weights, with the
    # one of its own axis replaced by the sign of the corner.
    for which in range(1 << len(x)):
        sample, weight = corner(p, samples, base, which), 1.0
        for k in range(len(x)):
            weight *= part[k] if (which >> k) & 1 else 1.0 - part[k]
        value += weight * sample
        for j in range(len(x)):
            share = 1.0 if (which >> j) & 1 else -1.0
            for k in range(len(x)):
                if k != j:
                    share *= part[k] if (which >> k) & 1 else 1.0 - part[k]
            gradient = with_item(gradient, j, gradient[j] + share * sample)
    return value, gradient


@scalar
def twist(p, samples, base, v):
    """A bound of the second derivative of the value along v within a cell, in spacings.

    Within a cell the value is linear along each axis: only mixed derivatives are not 0, and each is
    linear along the other axes.
    """
    total, d = 0.0, len(v)
    # Mixed derivatives of each pair of axes, from the four samples of a face. In 3D they are linear
    # along the third axis, so the larger of the two opposite faces is a bound.
    for j in range(d):
        for k in range(j + 1, d):
            most = 0.0
            for far in range(d - 1):  # of the axis that is neither, if there is one
                other = (7 ^ (1 << j) ^ (1 << k)) & ((1 << d) - 1) if far else 0
                mixed = corner(p, samples, base, other)
                mixed -= corner(p, samples, base, other | (1 << j))
                mixed -= corner(p, samples, base, other | (1 << k))
                mixed += corner(p, samples, base, other | (1 << j) | (1 << k))
                most = max(most, abs(mixed))
            total += 2.0 * most * abs(v[j] * v[k])
    return total


@scalar
def ahead(p, samples, r, v):
    """The value at a place, its slope along the flight, a bound of the change of slope within
    the cell of the grid, and the time until it leaves this.

    Beyond the grid, as if it flew straight to the solid.
    """
    x, off = inside_grid(p, r)
    if dot(off, off) > 0.0:
        steep = real(p, 8)
        return distance(p, samples, r) * steep, -steep * length(v), 0.0, np.inf
    value, gradient = interpolated(p, samples, x)
    base, part = split(x)
    per_time = scaled(1.0 / real(p, 3), v)
    leave = np.inf
    for k in range(len(v)):
        left = 1.0 - part[k] if v[k] > 0.0 else part[k]
        leave = min(leave, left / abs(per_time[k]) if v[k] != 0.0 else np.inf)
    return value, dot(gradient, per_time), twist(p, samples, base, per_time), leave


@scalar
def distance(p, samples, r):
    """No more than the distance of r, and of its sign.

    Beyond the grid, the way to the solid and the way to the grid make no acute angle there.
    """
    x, off = inside_grid(p, r)
    value, _ = interpolated(p, samples, x)
    beyond = dot(off, off)
    clear = value / real(p, 8)
    return math.sqrt(max(clear, 0.0) * max(clear, 0.0) + beyond) if beyond > 0.0 else clear


@scalar
def normal(p, samples, r):
    """Unit normal into the fluid: the direction in which the distance rises."""
    x, off = inside_grid(p, r)
    value, gradient = interpolated(p, samples, x)
    if dot(off, off) == 0.0:
        return unit(gradient)
    weight = max(value, 0.0) / (real(p, 8) * real(p, 8) * real(p, 3))
    for k in range(len(r)):
        if off[k] == 0.0:
            off = with_item(off, k, weight * gradient[k])
    return unit(off)
