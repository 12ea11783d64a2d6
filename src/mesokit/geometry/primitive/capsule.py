"""All places within a radius p[6] of the straight line from p[0:3] to p[0:3] + p[3:6].

p[7] is one over the square of the line's length.
"""

import math
from collections.abc import Sequence

import numpy as np

from mesokit.geometry.primitive.moments import Integrals, plane
from mesokit.geometry.primitive.numbers import length, offset, unit, vector
from mesokit.scalar.jit import scalar
from mesokit.scalar.pointer import real
from mesokit.scalar.vector import added_scaled, dot

CONVEX = True
ROUND = True


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


def extent(p: Sequence[float]) -> float:
    """How far it reaches from its centre."""
    return 0.5 * math.hypot(*p[3:6]) + p[6]


def width(p: Sequence[float]) -> float:
    """Its least width."""
    return 2.0 * p[6]


def integrals(p: Sequence[float], d: int) -> Integrals:
    """Volume, centre and second moments about the centre: of a rod and two halves of a ball."""
    span, radius, all_axes = np.array(p[3:6]), p[6], plane(d)
    length = float(np.hypot.reduce(span))
    along, half = np.outer(span, span) / length**2, 0.5 * length
    if d == 2:
        rod, ends = 2.0 * radius * length, math.pi * radius**2
        middle, own, wide = 4.0 * radius / (3.0 * math.pi), radius**2 / 4.0, radius**2 / 3.0
    else:
        rod, ends = math.pi * radius**2 * length, 4.0 / 3.0 * math.pi * radius**3
        middle, own, wide = 3.0 / 8.0 * radius, radius**2 / 5.0, radius**2 / 4.0
    most = rod * half**2 / 3.0 + ends * (own + half**2 + 2.0 * half * middle)
    second = most * along + (rod * wide + ends * own) * (all_axes - along)
    return Integrals(rod + ends, np.array(p[:3]) + 0.5 * span, second)
