"""Disk or sphere: centre in p[0:3], radius in p[6]."""

import math
from collections.abc import Sequence

import numpy as np

from mesokit.geometry.primitive.moments import Integrals, plane
from mesokit.geometry.primitive.numbers import length, offset, unit
from mesokit.scalar.jit import scalar
from mesokit.scalar.pointer import real

CONVEX = True
ROUND = True


@scalar
def distance(p, samples, r):
    return length(offset(p, r)) - real(p, 6)


@scalar
def normal(p, samples, r):
    return unit(offset(p, r))


def extent(p: Sequence[float]) -> float:
    """How far it reaches from its centre."""
    return p[6]


def width(p: Sequence[float]) -> float:
    """Its least width."""
    return 2.0 * p[6]


def integrals(p: Sequence[float], d: int) -> Integrals:
    """Volume, centre and second moments about the centre, in d dimensions."""
    volume = math.pi * p[6] ** 2 if d == 2 else 4.0 / 3.0 * math.pi * p[6] ** 3
    return Integrals(volume, np.array(p[:3]), volume * p[6] ** 2 / (d + 2) * plane(d))
