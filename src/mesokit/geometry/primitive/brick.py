"""Rectangle or cuboid: centre in p[0:3], half its sides in p[3:6], turned about z.

Cosine and sine of the angle are in p[6] and p[7].
"""

import math
from collections.abc import Sequence

import numpy as np

from mesokit.geometry.primitive.moments import Integrals
from mesokit.geometry.primitive.numbers import offset, vector
from mesokit.scalar.intrinsics import with_item
from mesokit.scalar.jit import scalar
from mesokit.scalar.pointer import real
from mesokit.scalar.vector import scaled

CONVEX = True


@scalar
def turned(p, a, sine):
    """The vector a, turned by the angle whose sine is given."""
    x = real(p, 6) * a[0] - sine * a[1]
    y = sine * a[0] + real(p, 6) * a[1]
    return with_item(with_item(a, 0, x), 1, y)


@scalar
def distance(p, samples, r):
    x, half = turned(p, offset(p, r), -real(p, 7)), vector(p, 3, r)
    beyond, deepest = 0.0, -math.inf
    for k in range(len(r)):
        q = abs(x[k]) - half[k]
        beyond += max(q, 0.0) * max(q, 0.0)
        deepest = max(deepest, q)
    return math.sqrt(beyond) if beyond > 0.0 else deepest


@scalar
def normal(p, samples, r):
    """Unit normal into the fluid: of the nearest face or, beyond an edge, away from the edge."""
    x, half = turned(p, offset(p, r), -real(p, 7)), vector(p, 3, r)
    out, beyond = scaled(0.0, r), 0.0
    deepest, face = -math.inf, 0
    for k in range(len(r)):
        q = abs(x[k]) - half[k]
        out = with_item(out, k, math.copysign(max(q, 0.0), x[k]))
        beyond += max(q, 0.0) * max(q, 0.0)
        if q > deepest:
            deepest, face = q, k
    if beyond > 0.0:
        out = scaled(1.0 / math.sqrt(beyond), out)
    else:
        out = with_item(scaled(0.0, r), face, math.copysign(1.0, x[face]))
    return turned(p, out, real(p, 7))


def extent(p: Sequence[float]) -> float:
    """How far it reaches from its centre."""
    return math.hypot(*p[3:6])


def width(p: Sequence[float]) -> float:
    """Its least width."""
    return 2.0 * min(x for x in p[3:6] if x > 0)


def integrals(p: Sequence[float], d: int) -> Integrals:
    """Volume, centre and second moments about the centre, in d dimensions."""
    half = np.array(p[3:6])
    volume = float(np.prod(2.0 * half[:d]))
    turn = np.array([[p[6], -p[7], 0.0], [p[7], p[6], 0.0], [0.0, 0.0, 1.0]])
    return Integrals(volume, np.array(p[:3]), volume / 3.0 * turn @ np.diag(half**2) @ turn.T)
